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

/// A solve from nothing, and one that follows it.
#[inline(never)]
fn solve<T: Real, M: Model<T> + Copy>(scene: M) -> Option<T> {
    let settings = Settings::default();
    let problem = Problem::new(black_box(scene), Mesh::uniform(black_box(20))).ok()?;
    let mut memory: Workspace<T, M, 40> = Workspace::new();
    let mut prepared = problem.prepare(&mut memory).ok()?;
    let cold = prepared.solve(&settings).ok()?;
    let mut history = History::new(Mesh::uniform(black_box(20)), &mut memory);
    let scene = black_box(scene);
    let warm = history.solve(&scene, &settings).ok()?.report().residual;
    Some(cold.residual + warm)
}

#[inline(never)]
fn scenes<T: Number>() -> Option<T> {
    let (breaks, values) = ([T::of(0.5)], [T::of(1e6), T::of(-1e6)]);
    let load = Load { transverse: Steps { breaks: &breaks, values: &values }, axial: (), points: () };
    let bending = Scene::new(T::one(), Beam::elastic(T::of(5e3))).load(load);
    let mut sum = solve::<T, _>(bending.foundation(Foundation { law: Linear(T::of(1e8)), gap: () }))?;
    let gap = [T::zero(), T::of(0.1), T::of(-0.1)];
    let law = Power { stiffness: T::of(1e8), exponent: T::of(1.5) };
    sum = sum + solve::<T, _>(bending.foundation(Foundation { law, gap: Polynomial(&gap) }))?;
    let full = Beam { bending: T::of(5e3), axial: T::of(1e5), piezo: T::of(100.0), permittivity: T::one() };
    let scene = Scene::new(T::one(), full)
        .foundation(Foundation { law: Linear(T::of(1e8)), gap: () })
        .conduction(Conduction::new(T::one(), T::one(), T::one()))
        .load(Load { transverse: load.transverse, axial: T::of(1e6), points: () })
        .potential(Potential { left: T::one(), right: T::one() });
    sum = sum + solve::<T, _>(scene)?;
    Some(sum)
}

#[unsafe(no_mangle)]
pub extern "C" fn _start() -> ! {
    let done = [scenes::<f32>().is_some(), scenes::<f64>().is_some()];
    black_box(done);
    loop {}
}
