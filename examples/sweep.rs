//! A sweep over the foundation's stiffness by the library, on all cores: each thread has a memory of its own. The
//! command line's `sweep` does it for any number of a scene file.

use piezobeam::{
    Beam, Error, Foundation, HeapWorkspace, Linear, Load, Mesh, Problem, Scene, Settings, Status, Steps,
};
use std::thread;

/// Down on the left half, up on the right one.
const LOAD: Load<Steps<'static, f64>> =
    Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () };

/// Bending in the middle \[m\] and contact force \[N\] for each stiffness \[N/m^2\].
fn solve(stiffness: &[f64]) -> Result<Vec<(f64, f64)>, Error> {
    let mut memory = HeapWorkspace::new();
    let mut found = Vec::new();
    for &k in stiffness {
        let foundation = Foundation { law: Linear(k), gap: () };
        let scene = Scene::new(1.0, Beam::elastic(5e3)).foundation(foundation).load(LOAD);
        let problem = Problem::new(scene, Mesh::uniform(1000))?;
        let solution = problem.solve(&mut memory, &Settings::default())?;
        assert_eq!(solution.report().status, Status::Converged);
        found.push((solution.at(0.5).bending, solution.resultants().contact_force));
    }
    Ok(found)
}

fn main() -> Result<(), Error> {
    let stiffness: Vec<f64> = (0..=16).map(|decade| 10f64.powi(decade)).collect();
    let share = stiffness.len().div_ceil(thread::available_parallelism().map_or(1, Into::into));
    let parts: Vec<_> = thread::scope(|scope| {
        let threads: Vec<_> = stiffness.chunks(share).map(|part| scope.spawn(|| solve(part))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap_or(Ok(Vec::new()))).collect()
    });
    let found = parts.into_iter().collect::<Result<Vec<_>, _>>()?.concat();
    println!("k [N/m^2], bending in the middle [m], contact force [N]");
    for (k, (bending, force)) in stiffness.iter().zip(&found) {
        println!("{k:e}, {bending:.8}, {force:.1}");
    }
    // Of the reference suite, `sweep-1e08` and `sweep-1e16`, where conduction changes the eighth digit.
    assert_eq!(found.len(), 17);
    assert!((found[8].0 + 0.063_713_78).abs() < 1e-8);
    assert!((found[16].0 + 0.069_178_756).abs() < 1e-8);
    assert!(found.windows(2).all(|pair| pair[0].1 < pair[1].1), "the stiffer, the more it carries");
    Ok(())
}

#[test]
fn holds() -> Result<(), Error> {
    main()
}
