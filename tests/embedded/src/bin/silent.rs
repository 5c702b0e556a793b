//! Solves without any text: whatever can panic in this image can panic in a solve. `panics.sh` looks.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;
use piezobeam::{
    Beam, Conduction, Foundation, History, Linear, Load, Mesh, Model, Polynomial, Potential, Power, Problem,
    Real, Scene, Settings, Steps, Workspace,
};
use piezobeam_embedded::bits::Number;

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}

/// A solve from nothing.
#[inline(never)]
fn solve<T: Real, M: Model<T>>(scene: M) -> Option<T> {
    let problem = Problem::new(black_box(scene), Mesh::uniform(black_box(20))).ok()?;
    let mut memory: Workspace<T, M, 40> = Workspace::new();
    let mut prepared = problem.prepare(&mut memory).ok()?;
    Some(prepared.solve(&Settings::default()).ok()?.residual)
}

/// One that follows another.
#[inline(never)]
fn follow<T: Real, M: Model<T>>(scene: M) -> Option<T> {
    let mut memory: Workspace<T, M, 40> = Workspace::new();
    let mut history = History::new(Mesh::uniform(black_box(20)), &mut memory);
    history.solve(&black_box(scene), &Settings::default()).ok().map(|solution| solution.report().residual)
}

type Half<T> = Load<Steps<'static, T>, T>;

/// Down on the left half, up on the right one.
trait Halves: Number {
    const LOAD: Half<Self>;
}

impl Halves for f32 {
    const LOAD: Half<f32> =
        Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: 1e6, points: () };
}

impl Halves for f64 {
    const LOAD: Half<f64> =
        Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: 1e6, points: () };
}

fn bending<T: Halves>() -> impl Model<T> {
    let load = Load { transverse: T::LOAD.transverse, axial: (), points: () };
    Scene::new(T::one(), Beam::elastic(T::of(5e3))).load(load)
}

fn pressed<T: Halves>() -> impl Model<T> {
    let load = Load { transverse: T::LOAD.transverse, axial: (), points: () };
    let foundation = Foundation { law: Linear(T::of(1e8)), gap: () };
    Scene::new(T::one(), Beam::elastic(T::of(5e3))).load(load).foundation(foundation)
}

fn curved<T: Halves>(gap: &[T]) -> impl Model<T> {
    let load = Load { transverse: T::LOAD.transverse, axial: (), points: () };
    let law = Power { stiffness: T::of(1e8), exponent: T::of(1.5) };
    let foundation = Foundation { law, gap: Polynomial(gap) };
    Scene::new(T::one(), Beam::elastic(T::of(5e3))).load(load).foundation(foundation)
}

fn electric<T: Halves>() -> impl Model<T> {
    let beam = Beam { bending: T::of(5e3), axial: T::of(1e5), piezo: T::of(100.0), permittivity: T::one() };
    Scene::new(T::one(), beam)
        .foundation(Foundation { law: Linear(T::of(1e8)), gap: () })
        .conduction(Conduction::new(T::one(), T::one(), T::one()))
        .load(T::LOAD)
        .potential(Potential { left: T::one(), right: T::one() })
}

/// All of them.
fn all<T: Halves>() -> [bool; 8] {
    let gap = [T::zero(), T::of(0.1), T::of(-0.1)];
    [
        solve(bending::<T>()).is_some(),
        solve(pressed::<T>()).is_some(),
        solve(curved(&gap)).is_some(),
        solve(electric::<T>()).is_some(),
        follow(bending::<T>()).is_some(),
        follow(pressed::<T>()).is_some(),
        follow(curved(&gap)).is_some(),
        follow(electric::<T>()).is_some(),
    ]
}

#[unsafe(no_mangle)]
pub extern "C" fn _start() -> ! {
    black_box([all::<f32>(), all::<f64>()]);
    loop {}
}

/// An entry for each kind of scene: what `flash.sh` links by itself.
macro_rules! entry {
    ($($name:ident: $solves:expr;)*) => {$(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name() -> bool {
            $solves.is_some()
        }
    )*};
}

entry! {
    bending_f32: solve(bending::<f32>());
    pressed_f32: solve(pressed::<f32>());
    control_f32: follow(pressed::<f32>());
    electric_f32: solve(electric::<f32>());
    bending_f64: solve(bending::<f64>());
    pressed_f64: solve(pressed::<f64>());
    control_f64: follow(pressed::<f64>());
    electric_f64: solve(electric::<f64>());
}
