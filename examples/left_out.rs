//! Solves of one scene as often as asked: what `benches/count.sh` counts the instructions of.
//!
//! `left_out <scene> <solves> [elements]` prints the element visits of a solve and the bytes per element. A scene is one
//! of `benches/scenes/mod.rs`, solved from nothing each time, or `step`: a `History` whose load moves to and fro.

#[path = "../benches/scenes/mod.rs"]
mod scenes;

use piezobeam::{Error, HeapWorkspace, History, Mesh, Model, Problem, Report, Settings, Status};
use scenes::Visit;
use std::hint::black_box;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "full".into());
    let solves = arguments.next().map_or(Ok(1), |n| n.parse())?;
    let elements = arguments.next().map_or(Ok(1000), |n| n.parse())?;
    let mut asked = Asked { name: &name, solves, elements, outcome: None };
    if name == "step" {
        asked.outcome = Some(steps(solves, elements));
    } else {
        scenes::each_and_rigid(&mut asked);
    }
    asked
        .outcome
        .ok_or_else(|| format!("no scene {name}: there are those of benches/scenes/mod.rs, and step"))??;
    Ok(())
}

struct Asked<'a> {
    name: &'a str,
    solves: usize,
    elements: usize,
    outcome: Option<Result<(), Error>>,
}

impl Visit<f64> for Asked<'_> {
    fn visit<M: Model<f64>>(&mut self, name: &str, scene: M) {
        if name == self.name {
            self.outcome = Some(run(scene, self.solves, self.elements));
        }
    }
}

// One function per scene, so that each is compiled as in a program that has no other.
#[inline(never)]
fn run<M: Model<f64>>(scene: M, solves: usize, elements: usize) -> Result<(), Error> {
    let problem = Problem::new(scene, Mesh::uniform(elements))?;
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory)?;
    let mut visits = 0;
    for _ in 0..solves {
        visits = visits_of(&black_box(&mut prepared).solve(black_box(&Settings::default()))?);
    }
    println!("{visits} {}", HeapWorkspace::<f64, M>::BYTES_PER_ELEMENT);
    Ok(())
}

#[inline(never)]
fn steps(solves: usize, elements: usize) -> Result<(), Error> {
    let mut memory = HeapWorkspace::new();
    let bytes = bytes(&memory);
    let mut history = History::new(Mesh::uniform(elements), &mut memory);
    let mut visits = 0;
    for turn in 0..solves {
        let scene = scenes::step(turn);
        visits = visits_of(history.solve(black_box(&scene), &Settings::default())?.report());
    }
    println!("{visits} {bytes}");
    Ok(())
}

fn visits_of(report: &Report<f64>) -> usize {
    assert_eq!(report.status, Status::Converged);
    report.element_visits
}

fn bytes<M: Model<f64>>(_: &HeapWorkspace<f64, M>) -> usize {
    HeapWorkspace::<f64, M>::BYTES_PER_ELEMENT
}
