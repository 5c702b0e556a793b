//! Solves of one scene after another with more in it each time, as often as asked: what `benches/left_out.sh`
//! counts the instructions of.
//!
//! `left_out <bending|contact|stretching|full> <solves> [elements]` prints the element visits of a solve and
//! the bytes per element.

use piezobeam::{
    Beam, Conduction, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, Potential, Problem, Scene,
    Settings, Status, Steps, Workspace,
};
use std::error::Error;
use std::hint::black_box;

type Half = Steps<'static, f64>;

/// Down on the left half, up on the right one.
const TRANSVERSE: Half = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
const FOUNDATION: Foundation<Linear<f64>> = Foundation { law: Linear(1e8), gap: () };

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "full".into());
    let solves = arguments.next().map_or(Ok(1), |n| n.parse())?;
    let elements = arguments.next().map_or(Ok(1000), |n| n.parse())?;
    let bending = Load { transverse: TRANSVERSE, axial: (), points: () };
    let both = Load { transverse: TRANSVERSE, axial: 1e6, points: () };
    let stretching = Beam { bending: 5e3, axial: 1e5, piezo: (), permittivity: () };
    let full = Beam { bending: 5e3, axial: 1e5, piezo: 100.0, permittivity: 1.0 };
    match name.as_str() {
        "bending" => run(Scene::new(1.0, Beam::elastic(5e3)).load(bending), solves, elements),
        "contact" => {
            let scene = Scene::new(1.0, Beam::elastic(5e3)).foundation(FOUNDATION).load(bending);
            run(scene, solves, elements)
        }
        "stretching" => run(Scene::new(1.0, stretching).foundation(FOUNDATION).load(both), solves, elements),
        "full" => {
            let scene = Scene::new(1.0, full)
                .foundation(FOUNDATION)
                .conduction(Conduction::new(1.0, 1.0, 1.0))
                .load(both)
                .potential(Potential { left: 1.0, right: 1.0 });
            run(scene, solves, elements)
        }
        other => Err(format!("no scene {other}: bending, contact, stretching or full").into()),
    }
}

// One function per scene, so that each is compiled as in a program that has no other.
#[inline(never)]
fn run<M: Model<f64>>(scene: M, solves: usize, elements: usize) -> Result<(), Box<dyn Error>> {
    let problem = Problem::new(scene, Mesh::uniform(elements))?;
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory)?;
    let mut visits = 0;
    for _ in 0..solves {
        let report = black_box(&mut prepared).solve(black_box(&Settings::default()))?;
        assert_eq!(report.status, Status::Converged);
        visits = report.element_visits;
    }
    println!("{visits} {}", Workspace::<f64, M, 1>::BYTES_PER_ELEMENT);
    Ok(())
}
