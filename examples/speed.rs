//! Times of whole solves from nothing, and of load steps that follow one another, on one core:
//! `cargo run --release --example speed [elements ..]`. The best of many, as other programs share the machine.

use piezobeam::{
    Beam, Conduction, Curve, Error, Foundation, HeapWorkspace, History, Linear, Load, Mesh, Model, Potential,
    Problem, Scene, Settings, Status, Steps,
};
use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

/// Down on the left half, up on the right one.
const HALVES: Steps<'static, f64> = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
/// What the paper's example has beside bending and contact.
const PAPER: Beam<f64, f64, f64, f64> = Beam { bending: 5e3, axial: 1e5, piezo: 100.0, permittivity: 1.0 };
const ENDS: Potential<f64> = Potential { left: 1.0, right: 1.0 };

/// 0.4 sin^2(pi x)
fn wave(x: f64) -> [f64; 3] {
    let angle = 2.0 * PI * x;
    [0.2 * (1.0 - angle.cos()), 0.4 * PI * angle.sin(), 0.8 * PI * PI * angle.cos()]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let asked: Vec<usize> = std::env::args().skip(1).map(|n| n.parse()).collect::<Result<_, _>>()?;
    let sizes = if asked.is_empty() { vec![100, 1000, 10_000] } else { asked };
    println!("| scene | elements | best us | visits | iterations | ns per visit | ns per element |");
    println!("|---|--:|--:|--:|--:|--:|--:|");
    for &n in &sizes {
        let uniform = Load { transverse: 1e6, axial: (), points: () };
        let halves = Load { transverse: HALVES, axial: (), points: () };
        let stretched = Load { transverse: 1e6, axial: 1e6, points: () };
        let turned = Load { transverse: HALVES, axial: 1e6, points: () };
        let conduction = Conduction::new(1.0, 1.0, 1.0);
        cold("bending", Scene::new(1.0, Beam::elastic(5e3)).load(uniform), n)?;
        for (k, name) in [(1e8, "1e8"), (1e16, "1e16")] {
            let flat = Foundation { law: Linear(k), gap: () };
            let waved = Foundation { law: Linear(k), gap: Curve(wave) };
            let plain = Scene::new(1.0, Beam::elastic(5e3)).foundation(flat);
            cold(&format!("full contact, {name}"), plain.load(uniform), n)?;
            cold(&format!("halves, {name}"), plain.load(halves), n)?;
            let scene = Scene::new(1.0, PAPER).conduction(conduction).potential(ENDS);
            cold(&format!("full contact with u and q, {name}"), scene.foundation(flat).load(stretched), n)?;
            cold(&format!("halves with u and q, {name}"), scene.foundation(flat).load(turned), n)?;
            cold(&format!("gap with u and q, {name}"), scene.foundation(waved).load(stretched), n)?;
        }
        steps(n)?;
    }
    Ok(())
}

/// Best time of `run`, in ns, over half a second or so.
fn best(mut run: impl FnMut() -> Result<(), Error>) -> Result<f64, Error> {
    let (mut least, start) = (f64::INFINITY, Instant::now());
    while start.elapsed().as_secs_f64() < 0.3 {
        let begun = Instant::now();
        run()?;
        least = least.min(begun.elapsed().as_secs_f64() * 1e9);
    }
    Ok(least)
}

fn row(name: &str, n: usize, least: f64, visits: usize, iterations: usize) {
    println!(
        "| {name} | {n} | {:.2} | {visits} | {iterations} | {:.1} | {:.1} |",
        least * 1e-3,
        least / visits as f64,
        least / n as f64
    );
}

#[inline(never)]
fn cold<M: Model<f64>>(name: &str, scene: M, n: usize) -> Result<(), Error> {
    let problem = Problem::new(scene, Mesh::uniform(n))?;
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory)?;
    let mut report = prepared.solve(&Settings::default())?;
    assert_eq!(report.status, Status::Converged, "{name}: {report:?}");
    let least = best(|| {
        report = black_box(&mut prepared).solve(black_box(&Settings::default()))?;
        Ok(())
    })?;
    row(name, n, least, report.element_visits, report.iterations);
    Ok(())
}

/// A control loop: the step of a load in the middle of the beam moves to and fro, and with it the contact's edge.
fn steps(n: usize) -> Result<(), Error> {
    let beam = Scene::new(1.0, Beam::elastic(5e3)).foundation(Foundation { law: Linear(1e8), gap: () });
    let loads = [[1e6, 1e6, -1e6], [1e6, 0.9e6, -1e6]];
    let mut memory = HeapWorkspace::new();
    let mut history = History::new(Mesh::uniform(n), &mut memory);
    let (mut visits, mut iterations, mut turn) = (0, 0, 0);
    let least = best(|| {
        turn += 1;
        let values = &loads[turn % 2];
        let load = Load { transverse: Steps { breaks: &[0.4, 0.42], values }, axial: (), points: () };
        let scene = beam.load(load);
        let solution = history.solve(black_box(&scene), &Settings::default())?;
        assert_eq!(solution.report().status, Status::Converged);
        (visits, iterations) = (solution.report().element_visits, solution.report().iterations);
        Ok(())
    })?;
    row("load step", n, least, visits, iterations);
    Ok(())
}
