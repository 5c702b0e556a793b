//! What a solve costs on a board: memory, stack beyond it, instructions.

use crate::bits::{Number, name};
use crate::fixed::{Pressed, command, places, pressed, room};
use core::fmt::{Error, Result, Write};
use piezobeam::{History, Mesh, Problem, Settings, Workspace};

/// Instructions and stack of a piece of work.
pub struct Cost {
    /// Instructions.
    pub instructions: u64,
    /// Bytes of stack.
    pub stack: usize,
}

/// Prints a table of a solve from nothing and of a step of a control loop.
///
/// # Errors
/// What `out` says, or a scene that is refused.
pub fn table(out: &mut impl Write, measure: impl Fn(&mut dyn FnMut()) -> Cost) -> Result {
    writeln!(out, "# | | elements | RAM, bytes | stack beyond it | instructions | a step of control |")?;
    writeln!(out, "# |---|--:|--:|--:|--:|--:|")?;
    row::<f32, { room(8) }>(out, 8, &measure)?;
    row::<f32, { room(16) }>(out, 16, &measure)?;
    row::<f32, { room(32) }>(out, 32, &measure)?;
    row::<f32, { room(64) }>(out, 64, &measure)?;
    row::<f32, { room(128) }>(out, 128, &measure)?;
    row::<f64, { room(8) }>(out, 8, &measure)?;
    row::<f64, { room(16) }>(out, 16, &measure)?;
    row::<f64, { room(32) }>(out, 32, &measure)?;
    row::<f64, { room(64) }>(out, 64, &measure)?;
    row::<f64, { room(128) }>(out, 128, &measure)
}

fn row<T: Number, const ROOM: usize>(
    out: &mut impl Write,
    n: usize,
    measure: &impl Fn(&mut dyn FnMut()) -> Cost,
) -> Result {
    let breaks = places::<T>();
    let commands: [[T; 4]; 9] = core::array::from_fn(command);
    let problem = Problem::new(pressed(&breaks, &commands[0]), Mesh::uniform(n)).map_err(crate::refused)?;
    let mut memory: Workspace<T, Pressed<'_, T>, ROOM> = Workspace::new();
    let mut prepared = problem.prepare(&mut memory).map_err(crate::refused)?;
    let mut good = true;
    let mut cold = measure(&mut || good = prepared.solve(&Settings::default()).is_ok());
    // Eight steps: the load goes once back and forth.
    let mut history = History::new(Mesh::uniform(n), &mut memory);
    let mut steps = 0;
    for (step, values) in commands.iter().enumerate() {
        let scene = pressed(&breaks, values);
        let cost = measure(&mut || good = good && history.solve(&scene, &Settings::default()).is_ok());
        steps += if step > 0 { cost.instructions } else { 0 };
        cold.stack = cold.stack.max(cost.stack);
    }
    if !good {
        return Err(Error);
    }
    let Cost { instructions, stack } = cold;
    let ram = size_of::<Workspace<T, Pressed<'_, T>, ROOM>>();
    writeln!(out, "# | {} | {n} | {ram} | {stack} | {instructions} | {} |", name::<T>(), steps / 8)
}
