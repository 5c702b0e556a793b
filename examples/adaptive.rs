#![allow(missing_docs, clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "x")]
#[path = "../tests/common/mod.rs"]
mod common;
use common::suite;
use piezobeam::{Error, HeapWorkspace, Mesh, Problem, Settings};
fn main() -> Result<(), Error> {
    let only = std::env::args().nth(1);
    for case in suite() {
        if only.as_ref().is_some_and(|o| !case.name.contains(o.as_str())) {
            continue;
        }
        for tol in (4..=24).map(|i| 10f64.powf(-f64::from(i) / 2.0)) {
            let problem = Problem::new(&case.scene, Mesh::uniform(16))?;
            let mut a = HeapWorkspace::new();
            let found = problem.solve_to(&mut a, tol, &Settings::default())?;
            let want = case.column("xi");
            let size = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let error = case
                .column("x")
                .iter()
                .zip(&want)
                .fold(0.0_f64, |m, (x, w)| m.max((found.solution.at(*x).bending - w).abs()))
                / size;
            let n = found.solution.report().elements;
            println!(
                "{:16} {tol:.0e} n {n:5} passes {} visits {:6} ({:.1}/el, {}) estimate {:.1e} true {error:.1e} {:?} {} {}",
                case.name,
                found.passes,
                found.solution.report().element_visits,
                found.solution.report().element_visits as f64 / n as f64,
                if found.solution.report().element_visits <= 6 * n + 2000 { "ok" } else { "OVER" },
                found.estimate,
                found.reached,
                found.solution.report().status.name(),
                if error > tol { "MISSED" } else { "" }
            );
        }
    }
    Ok(())
}
