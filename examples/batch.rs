//! Many scenes at once against one after the other, on one core: `cargo run --release --example batch [elements ..]`, and
//! the same with `RUSTFLAGS='-C target-cpu=native'` for the widest registers that this machine has.
//!
//! Down on the left half and up on the right one, k = 1e8 N/m^2, loads that differ from scene to scene.

use piezobeam::{
    Batch, Beam, Compliance, Error, Foundation, HeapWorkspace, Linear, Load, Mesh, Problem, Profile, Real,
    Scene, Settings, Status, Steps,
};
use std::hint::black_box;
use std::time::Instant;

const SCENES: usize = 256;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let asked: Vec<usize> = std::env::args().skip(1).map(|n| n.parse()).collect::<Result<_, _>>()?;
    println!(
        "| scalar | elements | lanes | us alone | us in a batch | with sampling: alone | in a batch | scenes per second |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    for n in if asked.is_empty() { vec![64, 100, 1000] } else { asked } {
        compare::<f64, 4>(n)?;
        compare::<f64, 8>(n)?;
        compare::<f32, 8>(n)?;
        compare::<f32, 16>(n)?;
    }
    Ok(())
}

/// Best time of `run` in microseconds, over some tenths of a second.
fn best(mut run: impl FnMut() -> Result<(), Error>) -> Result<f64, Error> {
    let (mut least, start) = (f64::INFINITY, Instant::now());
    while start.elapsed().as_secs_f64() < 0.3 {
        let begun = Instant::now();
        run()?;
        least = least.min(begun.elapsed().as_secs_f64() * 1e6);
    }
    Ok(least)
}

fn compare<T: Real + Profile<T>, const L: usize>(n: usize) -> Result<(), Error>
where
    Linear<T>: Compliance<T>,
{
    let share = |i: usize| i as f64 / SCENES as f64;
    let loads: Vec<[T; 2]> =
        (0..SCENES).map(|i| [T::of(1e6 * (1.0 + share(i))), T::of(-1e6 * (1.0 - 0.5 * share(i)))]).collect();
    let middle = [T::of(0.5)];
    let scenes: Vec<_> = loads
        .iter()
        .map(|values| {
            let transverse = Steps { breaks: &middle, values: &values[..] };
            Scene::new(T::one(), Beam::elastic(T::of(5e3)))
                .foundation(Foundation { law: Linear(T::of(1e8)), gap: () })
                .load(Load { transverse, axial: (), points: () })
        })
        .collect();
    let (mesh, settings) = (Mesh::uniform(n), Settings::default());
    let group = &scenes[..L];

    let mut memory = HeapWorkspace::new();
    let [mut alone, mut sampled_alone] = [0.0, 0.0];
    for scene in group {
        let problem = Problem::new(*scene, mesh)?;
        alone += {
            let mut prepared = problem.prepare(&mut memory)?;
            best(|| converged(black_box(&mut prepared).solve(&settings)?.status))? / L as f64
        };
        sampled_alone +=
            best(|| converged(black_box(&problem).solve(&mut memory, &settings)?.report().status))?
                / L as f64;
    }
    let mut batch = Batch::<T, _, L>::new();
    let mut prepared = batch.prepare(group, &mesh)?;
    assert_eq!(prepared.in_lockstep(), L);
    let together = best(|| black_box(&mut prepared).solve(&settings))? / L as f64;
    for lane in 0..L {
        converged(prepared.solution(lane)?.report().status)?;
    }
    let mut failed = None;
    let sampled = best(|| {
        batch.solve(black_box(&scenes), &mesh, &settings, |_, solution| {
            failed = solution.and_then(|solution| converged(solution.report().status)).err().or(failed);
        })
    })? / SCENES as f64;
    assert_eq!(failed, None);
    println!(
        "| {} | {n} | {L} | {alone:.2} | {together:.2} | {sampled_alone:.2} | {sampled:.2} | {:.0} |",
        std::any::type_name::<T>(),
        1e6 / together
    );
    Ok(())
}

fn converged(status: Status) -> Result<(), Error> {
    assert_eq!(status, Status::Converged);
    Ok(())
}
