//! Bounds and estimates against true errors.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    reason = "the reference suite is part of the repository"
)]

#[path = "../tests/common/mod.rs"]
mod common;

use common::suite;
use piezobeam::{Error, Fields, HeapWorkspace, Mesh, Problem, Settings, Status};

fn main() -> Result<(), Error> {
    println!(
        "| scene | elements | bound | true | effectivity | estimate | true | ratio | visits solve | visits certificate |"
    );
    let mut all = vec![];
    for case in suite() {
        for n in [50, 100, 200, 400, 1000] {
            let problem = Problem::new(&case.scene, Mesh::uniform(n))?;
            let finest = Problem::new(&case.scene, Mesh::uniform(16 * n))?;
            let (mut a, mut b, mut c) = (HeapWorkspace::new(), HeapWorkspace::new(), HeapWorkspace::new());
            let solution = problem.solve(&mut a, &Settings::default())?;
            let certificate = solution.certify(&mut b, &Settings::default())?;
            let reference = finest.solve(&mut c, &Settings::default())?;
            let truth = solution.distance(&reference).unwrap_or(f64::NAN);
            let x = case.column("x");
            let want = case.column("xi");
            let _ = &x;
            let size = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            let mut worst = 0.0_f64;
            for i in 0..=4 * n {
                let x = case.scene.length * i as f64 / (4 * n) as f64;
                worst = worst.max((solution.at(x).bending - reference.at(x).bending).abs());
            }
            let error = worst / size;
            let bound = certificate.bending_bound;
            let eff = bound.map_or(f64::NAN, |b| b / truth);
            if !eff.is_nan() {
                all.push(eff);
            }
            println!(
                "| {} | {n} | {:.2e} | {:.2e} | {:.3} | {:.1e} | {:.1e} | {:.2} | {} {} | {} {} | {:?} {}",
                case.name,
                bound.unwrap_or(f64::NAN),
                truth,
                eff,
                certificate.bending_estimate,
                error,
                certificate.bending_estimate / error,
                solution.report().element_visits,
                solution.report().status.name(),
                certificate.report.element_visits,
                certificate.report.status.name(),
                certificate.electric_bound,
                reference.report().status.name()
            );
        }
    }
    all.sort_by(f64::total_cmp);
    println!("min {} median {} max {}", all[0], all[all.len() / 2], all[all.len() - 1]);
    Ok(())
}
