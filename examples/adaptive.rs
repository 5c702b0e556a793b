//! Meshes made for an accuracy: `cargo run --release --example adaptive` on the reference suite, as a table in Markdown;
//! `.. -- random 1000` on random scenes, against solutions to 1e-12 that start from 256 elements.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    reason = "the reference suite is part of the repository"
)]

#[path = "../tests/common/mod.rs"]
mod common;

use common::random::{Visit, scenes};
use common::{points, relative, suite};
use piezobeam::{Error, HeapWorkspace, Mesh, Model, Problem, Reached, Settings};

const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];

fn on_suite() -> Result<(), Error> {
    println!("| scene | tolerance | error | estimate | elements | meshes | element visits |");
    println!("|---|---|---|---|---|---|---|");
    for case in suite() {
        for tolerance in TOLERANCES {
            let problem = Problem::new(&case.scene, Mesh::uniform(16))?;
            let mut memory = HeapWorkspace::new();
            let found = problem.solve_to(&mut memory, tolerance, &Settings::default())?;
            let got: Vec<f64> = case.column("x").iter().map(|&x| found.solution.at(x).bending).collect();
            let report = found.solution.report();
            println!(
                "| {} | {tolerance:.0e} | {:.0e} | {:.0e} | {} | {} | {} |",
                case.name,
                relative(&got, &case.column("xi")),
                found.estimate,
                report.elements,
                found.passes,
                report.element_visits,
            );
        }
    }
    Ok(())
}

/// Of random scenes, how many were solved to each tolerance, and the largest error over it.
#[derive(Default)]
struct OnRandom {
    solved: [usize; TOLERANCES.len()],
    missed: [usize; TOLERANCES.len()],
    worst: [f64; TOLERANCES.len()],
    over: usize,
    without: usize,
}

impl Visit for OnRandom {
    fn scene<M: Model<f64>>(&mut self, i: usize, scene: &M, _: usize) {
        let settings = Settings::default();
        let at = points(500, scene.length());
        let finest = Problem::new(scene, Mesh::uniform(256)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let found = finest.solve_to(&mut memory, 1e-12, &settings).expect("a tolerance");
        let reference = found.solution;
        let unique = reference.uniqueness().certified;
        if found.reached != Reached::Tolerance || !unique {
            self.without += 1;
            return;
        }
        let want: Vec<f64> = at.iter().map(|&x| reference.at(x).bending).collect();
        for (j, &tolerance) in TOLERANCES.iter().enumerate() {
            let problem = Problem::new(scene, Mesh::uniform(16)).expect("a scene");
            let mut memory = HeapWorkspace::new();
            let found = problem.solve_to(&mut memory, tolerance, &settings).expect("a tolerance");
            if found.reached != Reached::Tolerance {
                println!("scene {i} to {tolerance:e}: {:?}, {:?}", found.reached, found.solution.report());
                continue;
            }
            let got: Vec<f64> = at.iter().map(|&x| found.solution.at(x).bending).collect();
            let share = relative(&got, &want) / tolerance;
            let report = found.solution.report();
            if share > 1.0 {
                println!("scene {i} to {tolerance:e}: {share:.2} times the tolerance, {report:?}");
            }
            self.solved[j] += 1;
            self.missed[j] += usize::from(share > 1.0);
            self.worst[j] = self.worst[j].max(share);
            self.over += usize::from(report.element_visits > 6 * report.elements + 2000);
        }
    }
}

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.as_slice() {
        [] => on_suite(),
        [random, count] if random == "random" => {
            let mut seen = OnRandom::default();
            scenes(count.parse().expect("a number of scenes"), &mut seen);
            for (j, tolerance) in TOLERANCES.iter().enumerate() {
                println!(
                    "{tolerance:e}: {} solved, {} missed, worst {:.2} times the tolerance",
                    seen.solved[j], seen.missed[j], seen.worst[j]
                );
            }
            println!("more than 6 visits of each element and 2000: {}", seen.over);
            println!("left out (reference not reached, or not certainly unique): {}", seen.without);
            Ok(())
        }
        _ => panic!("nothing, or: random COUNT"),
    }
}
