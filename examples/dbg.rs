#![allow(missing_docs, clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "x")]
#[path = "../tests/common/mod.rs"]
mod common;
use common::named;
use piezobeam::{Error, HeapWorkspace, Mesh, Problem, Settings};
fn main() -> Result<(), Error> {
    for (name, tol) in [("rigid", 3e-5), ("graded", 3e-7), ("sweep-1e14", 3e-6)] {
        let case = named(name);
        let fine = Problem::new(&case.scene, Mesh::uniform(8000))?;
        let mut b = HeapWorkspace::new();
        let r = fine.solve(&mut b, &Settings::default())?;
        let problem = Problem::new(&case.scene, Mesh::uniform(16))?;
        let mut a = HeapWorkspace::new();
        let found = problem.solve_to(&mut a, tol, &Settings::default())?;
        let x: Vec<f64> = found.solution.nodes().collect();
        let size = 0.07;
        for w in x.windows(2) {
            let e: Vec<String> = (0..=4)
                .map(|i| {
                    let x = w[0] + (w[1] - w[0]) * f64::from(i) / 4.0;
                    format!("{:.1e}", (found.solution.at(x).bending - r.at(x).bending) / size)
                })
                .collect();
            println!("{:.5} {:.5} {:?}", w[0], w[1] - w[0], e);
        }
        println!("{:?} {:?}", found.solution.zones(), r.zones());
    }
    Ok(())
}
