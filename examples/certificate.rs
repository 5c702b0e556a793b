//! Guaranteed bounds and estimates against true errors: `cargo run --release --example certificate` on the reference
//! suite, `.. -- random 10000` on random scenes. References are solutions on meshes 16 times as fine, of 2000 elements
//! at least.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::panic,
    reason = "the reference suite is part of the repository"
)]

#[path = "../tests/common/mod.rs"]
mod common;

use common::random::{Visit, scenes};
use common::suite;
use piezobeam::{Error, HeapWorkspace, Mesh, Model, Problem, Settings, Status};

/// What is known of one solution's error, and what it is.
struct Row {
    bound: Option<f64>,
    distance: f64,
    estimate: f64,
    error: f64,
    /// The smaller margin of (2.15) where bending and potential act on each other.
    margin: f64,
}

/// `None` where the solve, or the reference, does not converge, or the mesh of the reference does not divide the other.
fn row<M: Model<f64>>(scene: &M, n: usize) -> Result<Option<Row>, Error> {
    let settings = Settings::default();
    let finer = 16 * n * 128_usize.div_ceil(n);
    let (problem, finest) =
        (Problem::new(scene, Mesh::uniform(n))?, Problem::new(scene, Mesh::uniform(finer))?);
    let (mut a, mut b, mut c) = (HeapWorkspace::new(), HeapWorkspace::new(), HeapWorkspace::new());
    let solution = problem.solve(&mut a, &settings)?;
    let reference = finest.solve(&mut b, &settings)?;
    let good = |status| status == Status::Converged;
    let (true, true, Some(distance)) =
        (good(solution.report().status), good(reference.report().status), solution.distance(&reference))
    else {
        return Ok(None);
    };
    let found = solution.certify(&mut c, &settings)?;
    let margins = solution.uniqueness();
    let margin =
        margins.margin_bending.into_iter().chain(margins.margin_electric).fold(f64::INFINITY, f64::min);
    let (mut error, mut size) = (0.0_f64, 0.0_f64);
    for i in 0..=4 * n {
        let x = scene.length() * i as f64 / (4 * n) as f64;
        let (got, want) = (solution.at(x).bending, reference.at(x).bending);
        (error, size) = (error.max((got - want).abs()), size.max(want.abs()));
    }
    let error = if error == 0.0 { 0.0 } else { error / size };
    Ok(Some(Row { bound: found.bending_bound, distance, estimate: found.bending_estimate, error, margin }))
}

/// Bounds over errors, estimates over errors; what is below `ROUNDING` is left out of the latter.
#[derive(Default)]
struct Ratios {
    bounds: Vec<f64>,
    /// Those of weak coupling, or none.
    weak: Vec<f64>,
    estimates: Vec<f64>,
    without: usize,
}

const ROUNDING: f64 = 1e-13;

impl Ratios {
    fn add(&mut self, row: &Row) {
        match row.bound {
            Some(bound) if row.distance > ROUNDING => {
                self.bounds.push(bound / row.distance);
                if row.margin >= 2.0 {
                    self.weak.push(bound / row.distance);
                }
            }
            Some(_) => {}
            None => self.without += 1,
        }
        // Where there may be several solutions the reference may be another one.
        if row.error > ROUNDING && row.margin > 1.0 {
            self.estimates.push(row.estimate / row.error);
        }
    }

    fn print(&mut self) {
        let lists = [
            ("bound / error", &mut self.bounds),
            ("... with margins of 2 and more", &mut self.weak),
            ("estimate / error", &mut self.estimates),
        ];
        for (name, list) in lists {
            list.sort_by(f64::total_cmp);
            let at = |share: f64| list[((list.len() - 1) as f64 * share) as usize];
            println!(
                "{name}: {} cases, least {:.3}, 1 % {:.3}, median {:.3}, 99 % {:.3}, largest {:.3}",
                list.len(),
                at(0.0),
                at(0.01),
                at(0.5),
                at(0.99),
                at(1.0)
            );
        }
        println!("without a bound: {}", self.without);
    }
}

fn on_suite() -> Result<(), Error> {
    let mut ratios = Ratios::default();
    println!("| scene | elements | bound | error | ratio | estimate | error | ratio |");
    println!("|---|---|---|---|---|---|---|---|");
    for case in suite() {
        for n in [50, 100, 200, 400, 1000] {
            let Some(row) = row(&case.scene, n)? else { continue };
            ratios.add(&row);
            let bound = row.bound.map_or(["none".into(), String::new()], |bound| {
                [format!("{bound:.2e}"), format!("{:.2}", bound / row.distance)]
            });
            println!(
                "| {} | {n} | {} | {:.2e} | {} | {:.1e} | {:.1e} | {:.2} |",
                case.name,
                bound[0],
                row.distance,
                bound[1],
                row.estimate,
                row.error,
                row.estimate / row.error
            );
        }
    }
    ratios.print();
    Ok(())
}

/// The rows of random scenes; those whose bound or estimate is off are printed.
#[derive(Default)]
struct OnRandom {
    ratios: Ratios,
    left_out: usize,
}

impl Visit for OnRandom {
    fn scene<M: Model<f64>>(&mut self, i: usize, scene: &M, n: usize) {
        let Some(row) = row(scene, n).expect("a scene") else {
            self.left_out += 1;
            return;
        };
        self.ratios.add(&row);
        let off = |bound: f64| bound < row.distance || (row.margin >= 2.0 && bound > 3.0 * row.distance);
        let ratio = row.estimate / row.error;
        if row.bound.is_some_and(off)
            || (row.error > ROUNDING && row.margin > 1.0 && !(1.0 / 3.0..3.0).contains(&ratio))
        {
            println!(
                "scene {i}, {n} elements: bound {:?}, error {:.3e}; estimate {:.2e}, error {:.2e}",
                row.bound, row.distance, row.estimate, row.error
            );
        }
    }
}

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.as_slice() {
        [] => on_suite(),
        [random, count] if random == "random" => {
            let mut rows = OnRandom::default();
            scenes(count.parse().expect("a number of scenes"), &mut rows);
            println!("left out (not converged, or no nested mesh): {}", rows.left_out);
            rows.ratios.print();
            Ok(())
        }
        _ => panic!("nothing, or: random COUNT"),
    }
}
