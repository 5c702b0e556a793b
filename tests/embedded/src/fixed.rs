//! A beam that is pressed down on one half and lifted on the other, and a control loop that moves its load.

use crate::bits::{Hash, Number, name};
use core::fmt::{Result, Write};
use piezobeam::{
    Beam, Foundation, History, Linear, Load, Mesh, Model, Problem, Scene, Settings, Solution, Steps,
    Workspace,
};

/// A beam on a one-way foundation under a load in steps.
pub type Pressed<'a, T> = Scene<T, Beam<T>, Foundation<Linear<T>>, (), Load<Steps<'a, T>>>;

/// The scene under the load `values` between `breaks`.
pub fn pressed<'a, T: Number>(breaks: &'a [T], values: &'a [T]) -> Pressed<'a, T> {
    Scene::new(T::one(), Beam::elastic(T::of(5000.0)))
        .foundation(Foundation { law: Linear(T::of(1e8)), gap: () })
        .load(Load { transverse: Steps { breaks, values }, axial: (), points: () })
}

/// Places for so many elements and the coarser meshes.
pub const fn room(elements: usize) -> usize {
    if elements <= 40 { elements } else { elements + elements / 3 + 12 }
}

/// The load of step `step` of the control loop: a force that goes back and forth on the beam's left half.
pub fn command<T: Number>(step: usize) -> [T; 4] {
    let share = T::of([0.0, 0.25, 0.5, 0.75, 1.0, 0.75, 0.5, 0.25][step % 8]);
    let whole = T::of(1e6);
    [whole * (T::one() - share), whole * share, -whole, -whole]
}

/// Where that load changes.
pub fn places<T: Number>() -> [T; 3] {
    [T::of(0.25), T::of(0.5), T::of(0.75)]
}

fn print<T: Number, M: Model<T>>(
    out: &mut impl Write,
    what: &str,
    n: usize,
    solution: &Solution<'_, T, M>,
) -> Result {
    let report = solution.report();
    let mut hash = Hash::default();
    hash.solution(solution);
    let middle = solution.at(T::of(0.5)).bending.f64();
    write!(
        out,
        "{what} {} {n}: {} in {} visits, ",
        name::<T>(),
        report.status.name(),
        report.element_visits
    )?;
    writeln!(out, "bending {:016x} ({middle:.9e} m), all {hash}", middle.to_bits())
}

/// The half pressed, half lifted beam on meshes of 8 to 128 elements.
///
/// # Errors
/// What `out` says, or a scene that is refused.
pub fn press<T: Number>(out: &mut impl Write) -> Result {
    fn on<T: Number, const ROOM: usize>(out: &mut impl Write, n: usize) -> Result {
        let (breaks, values) = ([T::of(0.5)], [T::of(1e6), T::of(-1e6)]);
        let problem = Problem::new(pressed(&breaks, &values), Mesh::uniform(n)).map_err(crate::refused)?;
        let mut memory: Workspace<T, _, ROOM> = Workspace::new();
        let solution = problem.solve(&mut memory, &Settings::default()).map_err(crate::refused)?;
        print(out, "pressed", n, &solution)
    }
    on::<T, { room(8) }>(out, 8)?;
    on::<T, { room(32) }>(out, 32)?;
    on::<T, { room(128) }>(out, 128)
}

/// Sixteen steps of a control loop on 48 elements.
///
/// # Errors
/// What `out` says, or a scene that is refused.
pub fn control<T: Number>(out: &mut impl Write) -> Result {
    let breaks = places::<T>();
    let commands: [[T; 4]; 16] = core::array::from_fn(command);
    let mut memory: Workspace<T, Pressed<'_, T>, { room(48) }> = Workspace::new();
    let mut history = History::new(Mesh::uniform(48), &mut memory);
    for (step, values) in commands.iter().enumerate() {
        let scene = pressed(&breaks, values);
        let solution = history.solve(&scene, &Settings::default()).map_err(crate::refused)?;
        print(out, "control", step, &solution)?;
    }
    Ok(())
}
