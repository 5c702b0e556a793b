//! Errors against the reference suite (`tests/reference`, 16 digits by collocation in 200-bit arithmetic), as a
//! table in Markdown: `cargo run --release --example accuracy`.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    reason = "the reference suite is part of the repository"
)]

#[path = "../tests/common/mod.rs"]
mod common;

use common::{named, relative};
use piezobeam::{Error, Fields, HeapWorkspace, Mesh, Problem, Settings};

const SCENES: [&str; 7] = ["free", "paper", "partial", "const-gap", "rigid", "coupled-partial", "mems"];
const ELEMENTS: [usize; 4] = [50, 100, 1000, 10_000];

fn main() -> Result<(), Error> {
    println!("| scene | elements | bending | moment | u | q | element visits |");
    println!("|---|---|---|---|---|---|---|");
    for name in SCENES {
        let case = named(name);
        for n in ELEMENTS {
            let problem = Problem::new(&case.scene, Mesh::uniform(n))?;
            let mut memory = HeapWorkspace::new();
            let solution = problem.solve(&mut memory, &Settings::default())?;
            let fields: Vec<Fields<f64>> = case.column("x").iter().map(|&x| solution.at(x)).collect();
            let error = |column: &str, get: fn(&Fields<f64>) -> f64| {
                relative(&fields.iter().map(get).collect::<Vec<_>>(), &case.column(column))
            };
            println!(
                "| {name} | {n} | {:.0e} | {:.0e} | {:.0e} | {:.0e} | {} |",
                error("xi", |f| f.bending),
                error("moment", |f| f.moment),
                error("u", |f| f.stretching.unwrap_or(f64::NAN)),
                error("q", |f| f.potential.unwrap_or(f64::NAN)),
                solution.report().element_visits,
            );
        }
    }
    Ok(())
}
