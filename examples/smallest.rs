//! A beam that its load presses onto a foundation on the left half and lifts off it on the right one.
use piezobeam::{
    Beam, Error, Foundation, HeapWorkspace, Linear, Load, Mesh, Problem, Scene, Settings, Steps,
};

fn main() -> Result<(), Error> {
    let load = Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () };
    let foundation = Foundation { law: Linear(1e8), gap: () };
    let scene = Scene::new(1.0, Beam::elastic(5e3)).foundation(foundation).load(load);
    let problem = Problem::new(scene, Mesh::uniform(1000))?;
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default())?;
    let (deflection, zones): (f64, Vec<[f64; 2]>) = (solution.at(0.25).bending, solution.zones());
    println!("deflection at a quarter of the beam: {deflection} m, contact on {zones:?} m");
    // The scene `partial` of the reference suite, whose conduction changes the eighth digit.
    assert!((deflection - 0.008_731_467_57).abs() < 1e-9);
    assert!(zones.len() == 1 && (zones[0][1] - 0.318_538_04).abs() < 1e-7);
    Ok(())
}

#[test]
fn holds() -> Result<(), Error> {
    main()
}
