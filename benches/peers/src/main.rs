//! piezobeam beside maintained Rust linear algebra, on the same scenes in one process: a table of times.
//!
//! `cargo run --release --manifest-path benches/peers/Cargo.toml [elements ..]`. Solves start from nothing; laying out
//! meshes, sampling profiles and analysing patterns are done before, on all sides. It ends with an error where
//! piezobeam's answer differs from a converged peer's by more than the peer's discretisation and rounding explain.

mod cholesky;
mod peer;
mod scene;

use cholesky::{Cholesky, Faer, Nalgebra};
use cpu_time::ThreadTime;
use peer::Peer;
use piezobeam::{HeapWorkspace, Mesh, Model, Problem, Settings, Solution, Status};
use scene::{BENDING, Scene};
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

/// Bending, stretching and potential at each node.
type Answer = Vec<[f64; 3]>;

/// How a peer's solve ended.
struct Solved {
    /// Newton's.
    steps: usize,
    converged: bool,
    answer: Answer,
}

fn main() -> Result<(), Box<dyn Error>> {
    let asked: Vec<usize> = std::env::args().skip(1).map(|n| n.parse()).collect::<Result<_, _>>()?;
    let sizes = if asked.is_empty() { vec![100, 1000, 10_000] } else { asked };
    if let Some(odd) = sizes.iter().find(|n| *n % 2 == 1) {
        return Err(format!("{odd} elements: half as many are compared with, so give an even number").into());
    }
    println!(
        "| contact | k | elements | faer us (steps) | nalgebra us (steps) | piezobeam us | ratio | peers' error | \
         piezobeam's error |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|");
    for elements in sizes {
        for stiffness in [1e8, 1e16] {
            let [full, partial] = [false, true].map(|partial| Scene { stiffness, partial });
            row(&full, full.full(), elements)?;
            row(&partial, partial.partial(), elements)?;
        }
    }
    Ok(())
}

fn row<M: Model<f64> + Copy>(scene: &Scene, model: M, elements: usize) -> Result<(), Box<dyn Error>> {
    let (mut faer, mut nalgebra) =
        (Peer::<Faer>::new(*scene, elements), Peer::<Nalgebra>::new(*scene, elements));
    let peers = [solved(&mut faer), solved(&mut nalgebra)];
    let problem = Problem::new(model, Mesh::uniform(elements))?;
    let (mut memory, settings) = (HeapWorkspace::new(), Settings::default());
    let mut prepared = problem.prepare(&mut memory)?;
    let solution = prepared.solution(&settings)?;
    converged(&solution)?;
    let ours = sample(&solution, elements);

    let exact = reference(model, elements)?;
    let mut error: Option<f64> = None;
    for peer in peers.iter().filter(|peer| peer.converged) {
        agree(scene, &ours, &peer.answer)?;
        error = Some(distance(&peer.answer, &exact)[0].max(error.unwrap_or(0.0)));
    }
    let [by_faer, by_nalgebra, by_piezobeam] = race([
        &mut || {
            black_box(faer.solve());
        },
        &mut || {
            black_box(nalgebra.solve());
        },
        &mut || {
            let _ = black_box(prepared.solve(&settings));
        },
    ]);
    // Of those with an answer, if any has one.
    let timed = [by_faer, by_nalgebra].into_iter().zip(&peers);
    let answered = timed.filter(|(_, peer)| peer.converged || error.is_none());
    let fastest = answered.map(|(time, _)| time).fold(f64::INFINITY, f64::min);
    let cell = |time: f64, peer: &Solved| {
        let end = if peer.converged { "" } else { ", not converged" };
        format!("{time:.1} ({}{end})", peer.steps)
    };
    println!(
        "| {} | {:e} | {elements} | {} | {} | {by_piezobeam:.1} | {}{:.1} | {} | {:.0e} |",
        if scene.partial { "partial" } else { "full" },
        scene.stiffness,
        cell(by_faer, &peers[0]),
        cell(by_nalgebra, &peers[1]),
        if error.is_none() { "> " } else { "" },
        fastest / by_piezobeam,
        error.map_or("-".into(), |error| format!("{error:.0e}")),
        distance(&ours, &exact)[0],
    );
    Ok(())
}

fn solved<C: Cholesky>(peer: &mut Peer<C>) -> Solved {
    let end = peer.solve();
    Solved { steps: end.steps, converged: end.converged, answer: peer.answer() }
}

/// Microseconds of each run, in processor time of this thread: other programs share the machine. Turns of a tenth of a
/// second, so that none has the quiet ones alone; of all times the tenth percentile, as the clock itself is at times
/// corrected by more than a short run takes.
fn race<const N: usize>(mut runs: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut times = [const { Vec::new() }; N];
    for _ in 0..10 {
        for (run, times) in runs.iter_mut().zip(&mut times) {
            let start = Instant::now();
            while {
                let begun = ThreadTime::now();
                run();
                times.push(begun.elapsed().as_secs_f64() * 1e6);
                start.elapsed().as_secs_f64() < 0.1
            } {}
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 10]
    })
}

/// piezobeam on a mesh four times finer at least, where errors are 256 times smaller.
fn reference<M: Model<f64>>(model: M, elements: usize) -> Result<Answer, Box<dyn Error>> {
    let problem = Problem::new(model, Mesh::uniform((4 * elements).max(40_000)))?;
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default())?;
    converged(&solution)?;
    Ok(sample(&solution, elements))
}

fn converged<M: Model<f64>>(solution: &Solution<'_, f64, M>) -> Result<(), String> {
    match solution.report().status {
        Status::Converged => Ok(()),
        other => Err(format!("piezobeam on {} elements: {other}", solution.report().elements)),
    }
}

fn sample<M: Model<f64>>(solution: &Solution<'_, f64, M>, elements: usize) -> Answer {
    let at = |node: usize| {
        let fields = solution.at(node as f64 / elements as f64);
        [fields.bending, fields.stretching.unwrap_or(f64::NAN), fields.potential.unwrap_or(f64::NAN)]
    };
    (0..=elements).map(at).collect()
}

/// Do piezobeam and a peer solve the same problem? They differ by no more than the peer's errors: by rounding, and by
/// discretisation, which the peer on half as many elements shows.
fn agree(scene: &Scene, ours: &Answer, peer: &Answer) -> Result<(), String> {
    let elements = peer.len() - 1;
    let mut half = Peer::<Nalgebra>::new(*scene, elements / 2);
    if !half.solve().converged {
        return Err(format!("{elements} elements: half as many have no solution to compare with"));
    }
    let every_other: Answer = peer.iter().step_by(2).copied().collect();
    let found = distance(ours, peer);
    let coarse = distance(&half.answer(), &every_other);
    for (field, name) in ["bending", "stretching", "potential"].iter().enumerate() {
        // With order p the finer mesh has 1 / (2^p - 1) of the difference left; twice for layers that neither resolves.
        let allowed = 2.0 * coarse[field] + rounding(scene, elements);
        let close = found[field] <= allowed;
        if !close {
            return Err(format!(
                "{elements} elements, {name}: {:e} apart, allowed {allowed:e}",
                found[field]
            ));
        }
    }
    Ok(())
}

/// Epsilon times the condition number of the peers' bending: the largest eigenvalue is 24 C / h^3, that of a node's
/// deflection, the smallest h times what holds the beam against an even load.
fn rounding(scene: &Scene, elements: usize) -> f64 {
    /// Fourth power of the clamped beam's first root.
    const CLAMPED: f64 = 500.564;
    let foundation = if scene.partial { 0.0 } else { scene.stiffness };
    f64::EPSILON * 24.0 * BENDING * (elements as f64).powi(4) / (CLAMPED * BENDING + foundation)
}

/// Of each field the largest difference over the largest value of `to`.
fn distance(of: &Answer, to: &Answer) -> [f64; 3] {
    [0, 1, 2].map(|field| {
        let size = largest(to.iter().map(|at| at[field].abs()));
        largest(of.iter().zip(to).map(|(a, b)| (a[field] - b[field]).abs())) / size
    })
}

/// The largest of numbers that are not negative; what is no number is larger than all.
fn largest(of: impl Iterator<Item = f64>) -> f64 {
    of.fold(0.0, |most, value| if most.is_nan() || value <= most { most } else { value })
}
