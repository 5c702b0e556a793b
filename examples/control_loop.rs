//! A control loop: an actuator in the middle of the beam holds the contact force at 300 kN while another force on it
//! comes and goes. Each solve starts from the last solution.

use piezobeam::{
    Beam, Error, Foundation, HeapWorkspace, History, Linear, Load, Mesh, PointLoad, Problem, Scene, Settings,
    Status,
};
use std::f64::consts::PI;

/// What the contact force is to be \[N\].
const WANTED: f64 = 300e3;
/// Contact force per force of the actuator, about.
const GAIN: f64 = 0.9;

fn main() -> Result<(), Error> {
    let foundation = Foundation { law: Linear(1e9), gap: 2e-3 };
    let beam = Scene::new(1.0, Beam::elastic(5e3)).foundation(foundation);
    let settings = Settings::default();
    let (mut memory, mut fresh) = (HeapWorkspace::new(), HeapWorkspace::new());
    let mut history = History::new(Mesh::uniform(200), &mut memory);
    let (mut actuator, mut worst, mut warm, mut cold) = (0.0, 0.0_f64, 0, 0);
    for step in 0..200 {
        let disturbance = 40e3 * (2.0 * PI * f64::from(step) / 100.0).sin();
        let points =
            [(0.3, disturbance), (0.5, actuator)].map(|(x, force)| PointLoad { x, force, moment: 0.0 });
        let scene = beam.load(Load { transverse: 4e5, axial: (), points });

        let solution = history.solve(&scene, &settings)?;
        assert_eq!(solution.report().status, Status::Converged);
        let force = solution.resultants().contact_force;
        warm += solution.report().element_visits;
        if step >= 20 {
            worst = worst.max((force / WANTED - 1.0).abs());
        }
        actuator += (WANTED - force) / GAIN;

        let problem = Problem::new(scene, Mesh::uniform(200))?;
        let alone = problem.solve(&mut fresh, &settings)?;
        assert!((alone.resultants().contact_force - force).abs() < 1e-8 * force);
        cold += alone.report().element_visits;
    }
    println!(
        "contact force held to {:.1} %; visits per step: {} warm, {} cold",
        100.0 * worst,
        warm / 200,
        cold / 200
    );
    assert!(worst < 0.02, "{worst}");
    assert!(4 * warm < 3 * cold, "{warm} {cold}");
    Ok(())
}

#[test]
fn holds() -> Result<(), Error> {
    main()
}
