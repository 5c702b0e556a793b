//! Bounds and estimates of the error, and meshes made for an accuracy.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on fails")]

mod common;

use common::random::{Visit, scenes};
use common::{named, points, relative, suite, tolerances as tol};
use piezobeam::{
    Adaptive, Beam, Certificate, Conduction, Error, Fields, Foundation, HeapWorkspace, Law, Linear, Load,
    Mesh, Model, PointLoad, Potential, Problem, Reached, Scene, Settings, Status, Steps,
};

fn settings() -> Settings<f64> {
    Settings::default()
}

#[test]
fn bounds_hold_and_are_near_and_estimates_are_the_error() {
    let mut complaints = vec![];
    for case in suite() {
        for n in [50, 100, 400] {
            let problem = Problem::new(&case.scene, Mesh::uniform(n)).expect("a scene");
            let finest = Problem::new(&case.scene, Mesh::uniform(16 * n)).expect("a scene");
            let (mut a, mut b, mut c) = (HeapWorkspace::new(), HeapWorkspace::new(), HeapWorkspace::new());
            let solution = problem.solve(&mut a, &settings()).expect("settings");
            let reference = finest.solve(&mut b, &settings()).expect("settings");
            let found = solution.certify(&mut c, &settings()).expect("memory");
            if let (Some(bound), Some(error)) = (found.bending_bound, solution.distance(&reference)) {
                let ratio = bound / error;
                if !(1.0..tol::EFFECTIVITY).contains(&ratio) {
                    complaints.push(format!("{} N = {n}: bound {bound:e}, error {error:e}", case.name));
                }
            }
            let margins = solution.uniqueness();
            assert_eq!(found.bending_bound.is_some(), margins.certified, "{} N = {n}", case.name);

            // At the reference's points, and in the middle between them.
            let x = case.column("x");
            let got: Vec<f64> = x.iter().map(|&x| solution.at(x).bending).collect();
            let error = relative(&got, &case.column("xi"));
            let between: Vec<f64> =
                (0..8 * n).map(|i| case.scene.length * (i as f64 + 0.5) / (8 * n) as f64).collect();
            let at = |s: &piezobeam::Solution<'_, f64, _>| {
                between.iter().map(|&x| s.at(x).bending).collect::<Vec<f64>>()
            };
            let error = error.max(relative(&at(&solution), &at(&reference)));
            let floor = tol::ESTIMATE_FLOOR;
            let (low, high) = (error / tol::ESTIMATE - floor, error * tol::ESTIMATE + floor);
            if !(low..=high).contains(&found.bending_estimate) {
                complaints.push(format!(
                    "{} N = {n}: estimate {:e}, error {error:e}",
                    case.name, found.bending_estimate
                ));
            }
        }
    }
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

/// The certificate of a solve on `n` elements, its fields at `x` and those on 32 times as many elements.
fn certified<M: Model<f64>>(scene: &M, n: usize, x: &[f64]) -> (Certificate<f64>, [Vec<Fields<f64>>; 2]) {
    let fields = |n: usize, x: &[f64]| {
        let problem = Problem::new(scene, Mesh::uniform(n)).expect("a scene");
        let (mut a, mut b) = (HeapWorkspace::new(), HeapWorkspace::new());
        let solution = problem.solve(&mut a, &settings()).expect("settings");
        assert_eq!(solution.report().status, Status::Converged);
        let found = solution.certify(&mut b, &settings()).expect("memory");
        (found, x.iter().map(|&x| solution.at(x)).collect::<Vec<_>>())
    };
    let (found, coarse) = fields(n, x);
    (found, [coarse, fields(32 * n, x).1])
}

#[test]
fn the_bound_falls_with_the_square_of_the_elements() {
    let scene = named("partial").scene;
    let bound = |n| certified(&scene, n, &[]).0.bending_bound.expect("a bound");
    let orders = [50, 100, 200].map(|n| (bound(n) / bound(2 * n)).log2());
    assert!(orders.iter().all(|order| (order - 2.0).abs() < 0.05), "{orders:?}");
}

/// A beam with everything, pressed down on its left half.
fn conducting(mu1: f64, mu2: f64, volts: f64) -> impl Model<f64> + Copy {
    Scene::new(1.0, Beam { bending: 1.0, axial: 3.0, piezo: 0.7, permittivity: 0.5 })
        .foundation(Foundation { law: Linear(200.0), gap: () })
        .conduction(Conduction { mu1, mu2, truncation: 1.0, potential_truncation: 10.0 })
        .load(Load { transverse: Steps { breaks: &[0.5], values: &[100.0, -60.0] }, axial: 2.0, points: () })
        .potential(Potential { left: volts, right: volts })
}

#[test]
fn stretching_and_potential_are_within_their_bound() {
    let n = 40;
    let x: Vec<f64> = (0..n * 100).map(|i| (i as f64 + 0.5) / (n * 100) as f64).collect();
    for (mu1, mu2) in [(0.0, 3.0), (0.3, 3.0), (0.3, 0.0), (0.0, 0.0)] {
        let scene = conducting(mu1, mu2, 0.3);
        let (found, [coarse, fine]) = certified(&scene, n, &x);
        let (mut error, mut size) = (0.0_f64, 0.0_f64);
        for (a, b) in coarse.iter().zip(&fine) {
            // (u', q') from the fluxes: [eps, P; -P, EA] (sigma, D) / det.
            let gradients = |sigma: f64, charge: f64| {
                let det = 3.0 * 0.5 + 0.7 * 0.7;
                ((0.5 * sigma + 0.7 * charge) / det, (3.0 * charge - 0.7 * sigma) / det)
            };
            let fluxes =
                |f: &Fields<f64>| (f.axial_force.expect("it stretches"), f.electric_displacement.expect("D"));
            let energy = |(u, q): (f64, f64)| (3.0 * u * u + 0.5 * q * q) / x.len() as f64;
            let ((sa, da), (sb, db)) = (fluxes(a), fluxes(b));
            error += energy(gradients(sa - sb, da - db));
            size += energy(gradients(sb, db));
        }
        let (error, bound) = ((error / size).sqrt(), found.electric_bound.expect("a bound"));
        assert!(bound >= error, "mu = {mu1}, {mu2}: bound {bound:e}, error {error:e}");
        assert!(mu2 > 0.0 || bound < tol::EXACT, "without a current there is no error: {bound:e}");
        for (estimate, get) in [
            (found.bending_estimate, (|f| f.bending) as fn(&Fields<f64>) -> f64),
            (found.stretching_estimate.expect("it stretches"), |f| f.stretching.unwrap_or(0.0)),
            (found.potential_estimate.expect("a potential"), |f| f.potential.unwrap_or(0.0)),
        ] {
            let column = |list: &[Fields<f64>]| list.iter().map(get).collect::<Vec<f64>>();
            let error = relative(&column(&coarse), &column(&fine));
            let floor = tol::ESTIMATE_FLOOR;
            let range = error / tol::ESTIMATE - floor..=error * tol::ESTIMATE + floor;
            assert!(range.contains(&estimate), "mu = {mu1}, {mu2}: estimate {estimate:e}, error {error:e}");
        }
    }
}

#[test]
fn a_potential_that_pulls_costs_the_bound_its_strength_and_then_its_proof() {
    let ratio = |mu1: f64, volts: f64| {
        let scene = conducting(mu1, 0.0, volts);
        let [problem, finest] = [40, 640].map(|n| Problem::new(&scene, Mesh::uniform(n)).expect("a scene"));
        let (mut a, mut b, mut c) = (HeapWorkspace::new(), HeapWorkspace::new(), HeapWorkspace::new());
        let solution = problem.solve(&mut a, &settings()).expect("settings");
        let reference = finest.solve(&mut b, &settings()).expect("settings");
        let found = solution.certify(&mut c, &settings()).expect("memory");
        found.bending_bound.map(|bound| bound / solution.distance(&reference).expect("nested meshes"))
    };
    // k + mu1 R(q) > 0 is monotone still.
    let plain = ratio(50.0, -2.0).expect("monotone");
    assert!(plain > 1.0 && plain < tol::EFFECTIVITY, "{plain}");
    // The beam holds up to 500 C / L^4 more.
    let pulled = ratio(60.0, -9.0).expect("the beam holds it");
    assert!(pulled > plain && pulled < 2.0, "{pulled} {plain}");
    assert_eq!(ratio(80.0, -9.5), None);
}

#[test]
fn a_foundation_taken_as_rigid_has_an_estimate_and_no_bound() {
    let load = Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () };
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e30), gap: () })
        .load(load);
    let (found, [coarse, fine]) = certified(&scene, 100, &points(500, 1.0));
    assert_eq!(found.bending_bound, None);
    let column = |list: &[Fields<f64>]| list.iter().map(|f| f.bending).collect::<Vec<f64>>();
    let error = relative(&column(&coarse), &column(&fine));
    assert!(found.bending_estimate > error / tol::ESTIMATE && found.bending_estimate < tol::ESTIMATE * error);
}

#[test]
fn a_certificate_needs_four_times_the_memory_and_says_so() {
    let scene = named("partial").scene;
    let problem = Problem::new(&scene, Mesh::uniform(20)).expect("a scene");
    let (mut memory, mut less, mut enough) =
        (problem.workspace::<64>(), problem.workspace::<79>(), problem.workspace::<80>());
    let solution = problem.solve(&mut memory, &settings()).expect("settings");
    let refused = solution.certify(&mut less, &settings()).map(|_| ());
    assert_eq!(refused, Err(Error::Capacity { needed: 80, available: 79 }));
    assert!(solution.certify(&mut enough, &settings()).is_ok());
}

#[test]
fn meshes_are_made_for_the_accuracy_asked_for() {
    let mut complaints = vec![];
    for case in suite() {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let problem = Problem::new(&case.scene, Mesh::uniform(16)).expect("a scene");
            let mut memory = HeapWorkspace::new();
            let found = problem.solve_to(&mut memory, tolerance, &settings()).expect("a tolerance");
            let report = *found.solution.report();
            let got: Vec<f64> = case.column("x").iter().map(|&x| found.solution.at(x).bending).collect();
            let error = relative(&got, &case.column("xi"));
            let (per_element, beside) = tol::ADAPTIVE_VISITS;
            let within = report.element_visits <= per_element * report.elements + beside;
            if found.reached != Reached::Tolerance
                || error > tolerance
                || found.estimate > tolerance
                || !within
            {
                complaints.push(format!(
                    "{} to {tolerance:e}: error {error:e}, {:?}, estimate {:e}, {report:?}",
                    case.name, found.reached, found.estimate
                ));
            }
        }
    }
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

#[test]
fn a_rigid_foundation_needs_fewer_elements_where_they_are_needed() {
    let scene = named("rigid").scene;
    let problem = Problem::new(&scene, Mesh::uniform(16)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let found = problem.solve_to(&mut memory, 1e-10, &settings()).expect("a tolerance");
    assert!(found.solution.report().elements <= 150, "{:?}", found.solution.report());
}

#[test]
fn meshes_resolve_what_is_left_of_beams_and_loads() {
    let load =
        [PointLoad { x: 0.37, force: 200.0, moment: 0.0 }, PointLoad { x: 0.71, force: 0.0, moment: 30.0 }];
    let uneven = |x: f64| 1.0 + 0.8 * (9.0 * x).sin();
    let scene = Scene::new(1.0, Beam::elastic(piezobeam::Function(uneven)))
        .foundation(Foundation { law: Law(|_: f64, r: f64| (1e6 * r * r, 2e6 * r)), gap: 0.01 })
        .load(Load {
            transverse: piezobeam::Function(|x: f64| 100.0 * (20.0 * x).cos()),
            axial: (),
            points: load,
        });
    let at = points(400, 1.0);
    let column =
        |found: &piezobeam::Solution<'_, f64, _>| at.iter().map(|&x| found.at(x).bending).collect::<Vec<_>>();
    let finest = Problem::new(&scene, Mesh::uniform(8000)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let want = column(&finest.solve(&mut memory, &settings()).expect("settings"));
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9] {
        let problem = Problem::new(&scene, Mesh::uniform(16)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let found = problem.solve_to(&mut memory, tolerance, &settings()).expect("a tolerance");
        assert_eq!(found.reached, Reached::Tolerance);
        let error = relative(&column(&found.solution), &want);
        assert!(error <= tolerance, "{error:e} for {tolerance:e}, {:?}", found.solution.report());
    }
}

#[test]
fn meshes_resolve_gaps_that_are_no_polynomials() {
    let wave = |x: f64| {
        let angle = 2.0 * std::f64::consts::PI * x;
        [
            0.2 * (1.0 - angle.cos()),
            0.4 * std::f64::consts::PI * angle.sin(),
            0.8 * std::f64::consts::PI.powi(2) * angle.cos(),
        ]
    };
    let scene = Scene::new(1.0, Beam::elastic(5e3))
        .foundation(Foundation { law: Linear(1e8), gap: piezobeam::Curve(wave) })
        .load(Load { transverse: 1e6, axial: (), points: () });
    let at = points(400, 1.0);
    let column =
        |found: &piezobeam::Solution<'_, f64, _>| at.iter().map(|&x| found.at(x).bending).collect::<Vec<_>>();
    let finest = Problem::new(&scene, Mesh::uniform(5000)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let want = column(&finest.solve(&mut memory, &settings()).expect("settings"));
    for (first, tolerance) in [(100, 1e-12), (64, 1e-10), (12, 1e-8), (12, 1e-11)] {
        let problem = Problem::new(&scene, Mesh::uniform(first)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let found = problem.solve_to(&mut memory, tolerance, &settings()).expect("a tolerance");
        assert_eq!(found.reached, Reached::Tolerance);
        let error = relative(&column(&found.solution), &want);
        assert!(error <= tolerance, "{error:e} for {tolerance:e}, {:?}", found.solution.report());
    }
}

#[test]
fn accuracy_ends_at_rounding_and_at_the_memory_and_says_so() {
    let scene = named("partial").scene;
    let problem = Problem::new(&scene, Mesh::uniform(16)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let found = problem.solve_to(&mut memory, 1e-17, &settings()).expect("a tolerance");
    assert_eq!(found.reached, Reached::Floor);
    assert!(found.estimate > 1e-17 && found.estimate < 1e-13, "{:e}", found.estimate);

    let mut memory = problem.workspace::<48>();
    let found = problem.solve_to(&mut memory, 1e-10, &settings()).expect("a tolerance");
    assert_eq!((found.reached, found.solution.report().status), (Reached::Capacity, Status::Converged));
    let reference = named("partial");
    let got: Vec<f64> = reference.column("x").iter().map(|&x| found.solution.at(x).bending).collect();
    let error = relative(&got, &reference.column("xi"));
    assert!(
        error > 1e-10 && error < 1e-7 && error <= tol::ESTIMATE * found.estimate,
        "{error:e} {:e}",
        found.estimate
    );

    for tolerance in [0.0, 1.0, -1e-3, f64::NAN] {
        let refused = problem.solve_to(&mut HeapWorkspace::new(), tolerance, &settings()).err();
        assert!(
            refused
                .is_some_and(|e| e.to_string().starts_with("tolerance: expected a number between 0 and 1"))
        );
    }
}

#[test]
fn a_certificate_does_not_divide_rounding() {
    // Exact but for rounding, on any mesh.
    let points = [PointLoad { x: 0.37, force: 100.0, moment: 30.0 }];
    let scene = Scene::new(1.0, Beam::elastic(5000.0)).load(Load { transverse: (), axial: (), points });
    let (found, _) = certified(&scene, 100, &[]);
    assert_eq!(found.report.elements, 400);
    assert!(found.bending_bound.is_some_and(|bound| bound < tol::EXACT));

    let scene = Scene::new(1.0_f32, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e8), gap: () })
        .load(Load { transverse: 1e6, axial: (), points: () });
    let problem = Problem::new(scene, Mesh::uniform(1000)).expect("a scene");
    let (mut memory, mut finer) = (HeapWorkspace::new(), HeapWorkspace::new());
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings");
    let found = solution.certify(&mut finer, &Settings::default()).expect("memory");
    assert_eq!(found.report.elements, 4000);
    assert!(found.bending_bound.is_some_and(|bound| bound < 1e-2));
}

#[test]
fn meshes_resolve_loads_that_no_first_mesh_sees() {
    // The fourth derivative of C xi is sin(w x): xi is sin(w x) / w^4 and the cubic that clamps it.
    let w = 200.0_f64;
    let transverse = piezobeam::Function(move |x: f64| (w * x).sin());
    let scene = Scene::new(1.0, Beam::elastic(1.0)).load(Load { transverse, axial: (), points: () });
    let (sin, cos) = w.sin_cos();
    let b = -1.0 / w.powi(3);
    let (value, slope) = (-sin / w.powi(4) - b, -cos / w.powi(3) - b);
    let exact = |x: f64| {
        let cubic = b + x * (3.0 * value - slope + x * (slope - 2.0 * value));
        (w * x).sin() / w.powi(4) + x * cubic
    };
    let problem = Problem::new(scene, Mesh::uniform(8)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let found = problem.solve_to(&mut memory, 1e-6, &settings()).expect("a tolerance");
    assert_eq!(found.reached, Reached::Tolerance);
    let at = points(1000, 1.0);
    let got: Vec<f64> = at.iter().map(|&x| found.solution.at(x).bending).collect();
    let want: Vec<f64> = at.iter().map(|&x| exact(x)).collect();
    assert!(relative(&got, &want) <= 1e-6, "{:e}", relative(&got, &want));
}

#[test]
fn one_element_hides_no_law_and_has_room_or_says_so() {
    let load = Load { transverse: 1e6, axial: (), points: () };
    let beam = Scene::new(1.0, Beam::elastic(5000.0)).load(load);
    // The one element's cubic is straight: what the law is shows on a finer mesh.
    let scene = beam.foundation(Foundation { law: Law(|_: f64, _: f64| (f64::NAN, f64::NAN)), gap: () });
    let problem = Problem::new(scene, Mesh::uniform(1)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let found = problem.solve_to(&mut memory, 1e-6, &settings()).expect("a tolerance");
    assert_eq!(found.reached, Reached::Unsolved);

    let scene = beam.foundation(Foundation { law: Linear(1e30), gap: () });
    let problem = Problem::new(scene, Mesh::uniform(1)).expect("a scene");
    let mut memory = problem.workspace::<1>();
    let found = problem.solve_to(&mut memory, 1e-6, &settings()).expect("a tolerance");
    assert_eq!(found.reached, Reached::Capacity);
}

#[test]
fn a_warm_start_refuses_the_tolerances_that_a_cold_one_does() {
    let scene = named("partial").scene;
    let mut memory = HeapWorkspace::new();
    let mut adaptive = Adaptive::new(Mesh::uniform(16), &mut memory);
    for tolerance in [0.0, 1.0, -1e-3, f64::NAN] {
        assert!(adaptive.solve(&scene, 1e-4, &settings()).is_ok());
        let refused = adaptive.solve(&scene, tolerance, &settings()).err();
        assert!(refused.is_some_and(|e| e.to_string().starts_with("tolerance: expected")), "{tolerance}");
    }
}

#[test]
fn a_beam_at_rest_needs_no_mesh() {
    let scene = Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e8), gap: () });
    let problem = Problem::new(scene, Mesh::uniform(4)).expect("a scene");
    let (mut memory, mut finer) = (HeapWorkspace::new(), HeapWorkspace::new());
    let found = problem.solve_to(&mut memory, 1e-8, &settings()).expect("a tolerance");
    assert_eq!((found.reached, found.solution.report().elements), (Reached::Tolerance, 4));
    let certificate = found.solution.certify(&mut finer, &settings()).expect("memory");
    assert_eq!(certificate.bending_bound, Some(0.0));
    assert!(certificate.bending_estimate < tol::EXACT);
}

#[test]
fn single_precision_is_bounded_and_adapted_as_far_as_it_goes() {
    let load = Load { transverse: Steps { breaks: &[0.5_f32], values: &[1e6, -1e6] }, axial: (), points: () };
    let scene = Scene::new(1.0_f32, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e8), gap: () })
        .load(load);
    let problem = Problem::new(scene, Mesh::uniform(16)).expect("a scene");
    let (mut memory, mut finer) = (HeapWorkspace::new(), HeapWorkspace::new());
    let settings = Settings::<f32>::default();
    let found = problem.solve_to(&mut memory, 1e-3, &settings).expect("a tolerance");
    assert_eq!(found.reached, Reached::Tolerance);
    assert!((found.solution.at(0.5).bending + 0.063_713_78).abs() < 1e-3 * 0.1);
    let bound =
        found.solution.certify(&mut finer, &settings).expect("memory").bending_bound.expect("monotone");
    assert!(bound > 1e-3 && bound < 0.5, "{bound}");
    let found = problem.solve_to(&mut memory, 1e-9, &settings).expect("a tolerance");
    assert_eq!(found.reached, Reached::Floor);
}

#[test]
fn a_mesh_follows_its_scenes() {
    let steps = [[0.5], [0.4]];
    let scene = |stiffness: f64, step: usize| {
        Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(stiffness), gap: () })
            .load(Load {
                transverse: Steps { breaks: &steps[step], values: &[1e6, -1e6] },
                axial: (),
                points: (),
            })
    };
    // Stiff, a little stiffer, soft, stiff again, and with a break at another place.
    let path = [(1e14, 0), (1.1e14, 0), (1e2, 0), (1e14, 0), (1e8, 1)].map(|(k, step)| scene(k, step));
    let at = points(200, 1.0);
    let mut memory = HeapWorkspace::new();
    let mut adaptive = Adaptive::new(Mesh::uniform(16), &mut memory);
    let mut reports = vec![];
    for (i, scene) in path.iter().enumerate() {
        let problem = Problem::new(scene, Mesh::uniform(8000)).expect("a scene");
        let mut finest = HeapWorkspace::new();
        let reference = problem.solve(&mut finest, &settings()).expect("settings");
        let want: Vec<f64> = at.iter().map(|&x| reference.at(x).bending).collect();
        let found = adaptive.solve(scene, 1e-8, &settings()).expect("a tolerance");
        assert_eq!(found.reached, Reached::Tolerance);
        let got: Vec<f64> = at.iter().map(|&x| found.solution.at(x).bending).collect();
        let error = relative(&got, &want);
        assert!(error <= 1e-8, "step {i}: {error:e}");
        reports.push(*found.solution.report());
    }
    let [elements, visits] =
        [|r: &piezobeam::Report<f64>| r.elements, |r: &piezobeam::Report<f64>| r.element_visits]
            .map(|get| reports.iter().map(get).collect::<Vec<usize>>());
    assert!(visits[1] < visits[0] / 2, "a small change is cheap: {visits:?}");
    assert!(elements[2] < elements[1] - elements[1] / 5, "elements are joined: {elements:?}");
    assert!(elements[3] > elements[2], "and divided: {elements:?}");
    adaptive.forget();
    let again = *adaptive.solve(&path[0], 1e-8, &settings()).expect("a tolerance").solution.report();
    assert_eq!(again, reports[0], "a forgetful history starts from nothing");
}

/// Bounds hold, and errors are what was asked for at most.
struct Held;

impl Visit for Held {
    fn scene<M: Model<f64>>(&mut self, i: usize, scene: &M, n: usize) {
        let finer = 16 * n * 64_usize.div_ceil(n);
        let [problem, finest] = [n, finer].map(|n| Problem::new(scene, Mesh::uniform(n)).expect("a scene"));
        let (mut a, mut b, mut c) = (HeapWorkspace::new(), HeapWorkspace::new(), HeapWorkspace::new());
        let solution = problem.solve(&mut a, &settings()).expect("settings");
        let reference = finest.solve(&mut b, &settings()).expect("settings");
        let found = solution.certify(&mut c, &settings()).expect("memory");
        let converged = |s: &piezobeam::Solution<'_, f64, &M>| s.report().status == Status::Converged;
        if let (Some(bound), Some(error)) = (found.bending_bound, solution.distance(&reference))
            && converged(&solution)
            && converged(&reference)
        {
            assert!(
                bound >= error * (1.0 - tol::REFERENCE),
                "scene {i}, {n} elements: bound {bound:e}, error {error:e}"
            );
        }
        if !solution.uniqueness().certified {
            return;
        }
        let coarse = Problem::new(scene, Mesh::uniform(16)).expect("a scene");
        let other = Problem::new(scene, Mesh::uniform(60)).expect("a scene");
        let (mut a, mut b) = (HeapWorkspace::new(), HeapWorkspace::new());
        let found = coarse.solve_to(&mut a, 1e-7, &settings()).expect("a tolerance");
        let reference = other.solve_to(&mut b, 1e-9, &settings()).expect("a tolerance");
        let at = points(100, scene.length());
        let column =
            |s: &piezobeam::Solution<'_, f64, &M>| at.iter().map(|&x| s.at(x).bending).collect::<Vec<f64>>();
        let error = relative(&column(&found.solution), &column(&reference.solution));
        if found.reached == Reached::Tolerance && reference.reached == Reached::Tolerance {
            assert!(error <= 1e-7, "scene {i}: {error:e}, {:?}", found.solution.report());
        }
    }
}

#[test]
fn bounds_and_meshes_hold_on_random_scenes() {
    scenes(200, &mut Held);
}

#[test]
fn unbent_beams_are_not_apart() {
    let bent = |load: f64, n| {
        (Scene::new(1.0, Beam::elastic(1.0)).load(Load { transverse: load, axial: (), points: () }), n)
    };
    let distance = |(one, n), (other, m)| {
        let one = Problem::new(one, Mesh::uniform(n)).expect("a scene");
        let other = Problem::new(other, Mesh::uniform(m)).expect("a scene");
        let (mut a, mut b) = (HeapWorkspace::new(), HeapWorkspace::new());
        let (one, other) = (one.solve(&mut a, &settings()), other.solve(&mut b, &settings()));
        one.expect("settings").distance(&other.expect("settings"))
    };
    assert_eq!(distance(bent(0.0, 2), bent(0.0, 4)), Some(0.0));
    assert_eq!(distance(bent(1.0, 2), bent(0.0, 4)), Some(f64::INFINITY));
    assert_eq!(distance(bent(0.0, 2), bent(0.0, 5)), None);
}

#[test]
fn elements_that_cannot_be_divided_have_no_certificate() {
    // Beside 1 the next numbers are 1e-16 apart.
    let nodes = [0.0, 1.0 - 8.0 * f64::EPSILON, 1.0 - 4.0 * f64::EPSILON, 1.0];
    for most in [4.0, 64.0] {
        let scene =
            Scene::new(1.0, Beam::elastic(1.0)).load(Load { transverse: most, axial: (), points: () });
        let Ok(problem) = Problem::new(scene, Mesh::Nodes(&nodes)) else { continue };
        let (mut memory, mut finer) = (HeapWorkspace::new(), HeapWorkspace::new());
        let solution = problem.solve(&mut memory, &settings()).expect("settings");
        // Refused, or a bound that holds: f^2 L^5 / 720 C is the energy, the mesh is one element.
        match solution.certify(&mut finer, &settings()) {
            Ok(found) => assert!(found.bending_bound.is_none_or(|bound| bound > 0.1), "{found:?}"),
            Err(error) => assert!(matches!(error, Error::Capacity { .. } | Error::Value { .. }), "{error}"),
        }
    }
}

#[test]
fn a_mesh_does_not_follow_to_another_length() {
    let scene = |length: f64| {
        Scene::new(length, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e8), gap: () })
            .load(Load { transverse: 1e6, axial: (), points: () })
    };
    let (mut memory, mut other) = (HeapWorkspace::new(), HeapWorkspace::new());
    let mut adaptive = Adaptive::new(Mesh::uniform(16), &mut memory);
    let mut alone = Adaptive::new(Mesh::uniform(16), &mut other);
    let end = |adaptive: &mut Adaptive<'_, f64, _, _>, length: f64| {
        let scene = scene(length);
        let found = adaptive.solve(&scene, 1e-6, &settings()).expect("a tolerance");
        assert_eq!(found.reached, Reached::Tolerance);
        *found.solution.report()
    };
    end(&mut adaptive, 1.0);
    // As from nothing.
    assert_eq!(end(&mut adaptive, 2.0), end(&mut alone, 2.0));
}
