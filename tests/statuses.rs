//! How a solve ends when it cannot converge, and what is said of bad input.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{named, plain, points, tolerances as tol};
use piezobeam::{
    Beam, Conduction, Curve, Foundation, Function, HeapWorkspace, Law, Linear, Load, Mesh, Model, PointLoad,
    Polynomial, Potential, Power, Problem, Real, Report, Scene, Settings, Status, Steps, Table, Tabulated,
    Warning,
};
use std::cell::Cell;

/// Solves, and checks what holds of every end: a name, a sentence, finite fields.
fn ends<T: Real, M: Model<T>>(scene: M, mesh: Mesh<'_, T>, settings: Settings<T>) -> Report<T> {
    let problem = Problem::new(scene, mesh).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &settings).expect("settings in range");
    let report = *solution.report();
    for x in points(32, problem.scene().length().f64()) {
        let f = solution.at(T::of(x));
        let finite = [f.bending, f.slope, f.moment, f.shear].into_iter().all(T::is_finite);
        assert!(finite, "{report:?}: {f:?}");
    }
    let name = report.status.name();
    assert!(name.chars().all(|c| c.is_ascii_lowercase() || c == '_'), "{name}");
    assert!(!report.status.to_string().is_empty());
    report
}

/// A stop and the default cap.
fn stop<T: Real>(stop: T) -> Settings<T> {
    Settings { stop, ..Settings::default() }
}

#[test]
fn a_cap_on_visits_is_kept_and_said() {
    let case = named("sweep-1e16");
    for most in [0, 1, 49, 100, 500, 1000, 2000] {
        let settings = Settings { max_visits: Some(most), ..Settings::default() };
        let report = ends(&case.scene, Mesh::uniform(1000), settings);
        assert_eq!(report.status, Status::VisitLimit, "{most}");
        assert_eq!(report.status.name(), "visit_limit");
        assert!(report.element_visits <= most, "{} > {most}", report.element_visits);
        assert!(report.residual > Settings::<f64>::default().stop);
    }
}

#[test]
fn a_halted_solve_knows_the_residual_of_what_it_returns() {
    let case = named("sweep-1e08");
    let settings = Settings { max_visits: Some(500), ..Settings::default() };
    let report = ends(&case.scene, Mesh::uniform(1000), settings);
    assert!(report.residual.is_finite(), "{report:?}");
}

#[test]
fn a_law_whose_slope_is_not_its_own_is_stagnation() {
    for slope in [0.0, 1e3] {
        // The pressure of 1e6 r with another slope: no step fits.
        let law = Law(move |_: f64, r: f64| (1e6 * r, slope));
        let beam = Beam { bending: 5.0, axial: 1.0, piezo: 0.0, permittivity: 1.0 };
        let scene = Scene::new(1.0, beam)
            .foundation(Foundation { law, gap: () })
            .conduction(Conduction::new(1.0, 1.0, 1.0))
            .load(plain(1e3))
            .potential(Potential { left: 1.0, right: 1.0 });
        let report = ends(scene, Mesh::uniform(30), Settings::default());
        assert_eq!(report.status, Status::Stagnation, "{report:?}");
        assert!(report.residual > 1e-3);
    }
    assert_eq!(Status::Stagnation.name(), "stagnation");
    assert!(Status::Stagnation.to_string().starts_with("iterations stopped reducing the residual"));
}

#[test]
fn a_foundation_that_no_mesh_resolves_is_taken_as_rigid_and_that_is_said() {
    let transverse = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
    let scene =
        |k: f64| {
            Scene::new(1.0, Beam::elastic(5000.0))
                .foundation(Foundation { law: Linear(k), gap: () })
                .load(Load { transverse, axial: (), points: () })
        };
    let is_rigid = |warnings: &[Warning<f64>]| warnings.iter().any(|w| matches!(w, Warning::Rigid { .. }));
    let middle = |scene| {
        let problem = Problem::new(scene, Mesh::uniform(100)).expect("a scene without mistakes");
        let mut memory = HeapWorkspace::new();
        let mut prepared = problem.prepare(&mut memory).expect("memory that grows");
        let first = prepared.solve(&Settings::default()).expect("settings in range");
        // Again the same, also where the first time ended with another law than it began with.
        let solution = prepared.solution(&Settings::default()).expect("settings in range");
        assert_eq!(first, *solution.report());
        assert_eq!(first.status, Status::Converged, "{first:?}");
        assert!(solution.resultants().equilibrium_error < tol::RANDOM_EQUILIBRIUM);
        (solution.at(0.5).bending, is_rigid(&solution.warnings()))
    };
    let (stiff, warned) = middle(scene(1e18));
    assert!(!warned, "1e18 is solved as it is");
    for k in [1e30, 1e100, 1e300] {
        let (rigid, warned) = middle(scene(k));
        assert!(warned, "{k:e}");
        assert!((rigid / stiff - 1.0).abs() < tol::RIGID_LIMIT, "{k:e}: {rigid} and {stiff}");
    }
}

#[test]
fn a_law_that_is_not_finite_once_is_named_with_its_element() {
    for nth in [1, 2, 10, 100, 1000] {
        let calls = Cell::new(0);
        let law = Law(|_: f64, r: f64| {
            calls.set(calls.get() + 1);
            (if calls.get() == nth { f64::NAN } else { 1e6 * r }, 1e6)
        });
        let scene =
            Scene::new(1.0, Beam::elastic(5.0)).foundation(Foundation { law, gap: () }).load(plain(1e3));
        let report = ends(scene, Mesh::uniform(30), Settings::default());
        let Status::LawNotFinite { element } = report.status else {
            // The call may be one that only looks for the largest slope.
            assert_eq!(report.status, Status::Converged, "call {nth}");
            continue;
        };
        assert!(element < 30);
        assert_eq!(report.status.name(), "law_not_finite");
    }
    for law in [
        |_: f64, _: f64| (f64::INFINITY, 1.0),
        |_: f64, r: f64| (r, f64::INFINITY),
        |_: f64, r: f64| (r, f64::NAN),
    ] {
        let scene = Scene::new(1.0, Beam::elastic(5.0)).foundation(Foundation { law: Law(law), gap: 0.1 });
        let report = ends(scene.load(plain(1e3)), Mesh::uniform(30), Settings::default());
        assert!(matches!(report.status, Status::LawNotFinite { .. }), "{report:?}");
    }
}

#[test]
fn a_law_that_decreases_is_named_with_its_element() {
    for law in [|_: f64, r: f64| (-r, 1.0), |_: f64, r: f64| (r, -1.0)] {
        let scene = Scene::new(1.0, Beam::elastic(5.0)).foundation(Foundation { law: Law(law), gap: () });
        let report = ends(scene.load(plain(1e3)), Mesh::uniform(10), Settings::default());
        let Status::LawNotMonotone { element } = report.status else { unreachable!("{report:?}") };
        assert!(element < 10);
        assert_eq!(report.status.name(), "law_not_monotone");
    }
}

#[test]
fn a_stop_below_rounding_is_said_and_the_best_state_kept() {
    let scene = Scene::new(1.0, Beam::elastic(5.0)).load(plain(1e3));
    let single =
        Scene::new(1.0_f32, Beam::elastic(5.0)).load(Load { transverse: 3.0_f32, axial: (), points: () });
    for n in [3, 10, 100, 1000] {
        for small in [1e-15, 1e-16, 1e-17] {
            let report = ends(scene, Mesh::uniform(n), stop(small));
            if report.status != Status::Converged {
                assert_eq!(report.status, Status::ToleranceBelowFloor, "N = {n}, {small:e}: {report:?}");
                assert!(report.residual <= tol::FLOOR, "{report:?}");
            }
        }
        // Three elements may balance to the last bit.
        let report = ends(single, Mesh::uniform(n), stop(1e-9));
        let expected = if report.residual == 0.0 { Status::Converged } else { Status::ToleranceBelowFloor };
        assert_eq!(report.status, expected, "N = {n}: {report:?}");
    }
    let report = ends(&named("partial").scene, Mesh::uniform(1000), stop(1e-17));
    assert_eq!(report.status, Status::ToleranceBelowFloor, "{report:?}");
}

#[test]
fn a_stop_below_rounding_is_never_converged() {
    let scene = Scene::new(1.0, Beam::elastic(5.0)).load(plain(1e3));
    for n in [100, 1000] {
        let report = ends(scene, Mesh::uniform(n), stop(1e-17));
        assert_ne!(report.status, Status::Converged, "{report:?}");
        assert!(report.residual > 1e-17);
    }
    assert_eq!(Status::ToleranceBelowFloor.name(), "tolerance_below_floor");
}

#[test]
fn coefficients_beyond_the_number_format_are_a_breakdown() {
    for stiffness in [1e-308, 1e-307] {
        let problem =
            Problem::new(Scene::new(1.0, Beam::elastic(stiffness)).load(plain(1e3)), Mesh::uniform(100));
        let problem = problem.expect("a scene without mistakes");
        let mut memory = HeapWorkspace::new();
        let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
        assert!(matches!(solution.report().status, Status::Breakdown { .. }), "{:?}", solution.report());
        assert_eq!(solution.report().status.name(), "numerical_breakdown");
    }
}

#[test]
fn a_coefficient_that_all_but_vanishes_at_an_end_is_a_breakdown() {
    // Moments balance, but their quotient by the stiffness at the end is no number.
    let taper = |least| Table { x: &[0.0, 1.0], y: if least { &[5e3, 1e-306] } else { &[5e3, 50.0] } };
    let status = |least, load| {
        let scene = Scene::new(1.0, Beam::elastic(taper(least))).load(plain(load));
        let problem = Problem::new(scene, Mesh::uniform(3)).expect("a scene without mistakes");
        problem.solve(&mut HeapWorkspace::new(), &Settings::default()).expect("settings").report().status
    };
    assert_eq!(status(false, 1e6), Status::Converged);
    assert_eq!(status(true, 1e6), Status::Breakdown { element: 2 });
    // Between the ends, where P^2 passes EA eps, K^-1 is largest.
    let beam = Beam { bending: 5e3, axial: 1e5, piezo: Polynomial(&[1e-309, 100.0]), permittivity: 7.5e-304 };
    let scene = Scene::new(1.0, beam)
        .foundation(Foundation { law: Linear(1e8), gap: -1e-3 })
        .conduction(Conduction::new(1.0, 1.0, 1.0))
        .load(Load { transverse: 1e6, axial: 1e6, points: () })
        .potential(Potential { left: 1.0, right: 1.0 });
    let problem = Problem::new(scene, Mesh::uniform(1)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    assert_ne!(solution.report().status, Status::Converged, "q = {:?}", solution.at(0.0).potential);
}

#[test]
fn a_potential_without_digits_is_below_the_floor() {
    // q' is a difference of D / eps and P u' / eps, some 1e18 times as large.
    let beam = Beam { bending: 1.0_f32, axial: 1e5, piezo: 100.0, permittivity: 1e-19 };
    let scene = Scene::new(1.0, beam)
        .foundation(Foundation { law: Linear(1e8), gap: 1e-3 })
        .conduction(Conduction::new(1.0, 1.0, 1.0))
        .load(Load { transverse: 1e6, axial: 1e6, points: () })
        .potential(Potential { left: 1.0, right: 1.0 });
    let report = ends(scene, Mesh::uniform(3), Settings::default());
    assert_eq!(report.status, Status::ToleranceBelowFloor, "{report:?}");
    assert!(report.residual > 1.0, "{report:?}");
    // A stop that leaves room for what is lost is reached.
    let beam = Beam { piezo: 1e3, permittivity: 1e-3, ..beam };
    let scene = Scene { beam, ..scene };
    assert_eq!(ends(scene, Mesh::uniform(3), stop(1e-3)).status, Status::Converged);
}

#[test]
fn a_stiffness_that_no_element_can_hold_is_refused() {
    let scene = Scene::new(1.0, Beam::elastic(1e305)).load(plain(1e3));
    let problem = Problem::new(scene, Mesh::uniform(100)).expect("the numbers themselves are fine");
    let said = problem.solve(&mut HeapWorkspace::new(), &Settings::default()).err().map(|e| e.to_string());
    let expected = "expected a stiffness C for which C / h^3 fits the number format, found 1e305";
    assert!(said.is_some_and(|said| said.starts_with("beam.bending at x = ") && said.ends_with(expected)));
}

#[test]
fn elements_whose_length_has_no_cube_are_refused() {
    // All else is in the middle of the numbers: it is the beam of length 1 in units of 1e-105 m.
    let scene = Scene::new(1e-105, Beam::elastic(1e-300))
        .foundation(Foundation { law: Linear(1e122), gap: () })
        .load(plain(1e124));
    refused(
        scene,
        "length at x = 5e-106: expected elements long enough for the cube of their length to be a normal number, found 1e-105",
    );
}

#[test]
fn fields_of_a_beam_whose_curvature_is_below_the_numbers_are_those_of_any_other() {
    // Powers of two, so that all digits are the same.
    let at = |length: f64, deflection: f64| {
        let load = length.powi(-2) / length / length * deflection;
        let scene = Scene::new(length, Beam::elastic(1.0)).load(plain(load));
        let problem = Problem::new(scene, Mesh::uniform(3)).expect("a scene without mistakes");
        let mut memory = HeapWorkspace::new();
        let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
        assert_eq!(solution.report().status, Status::Converged);
        [0.125, 0.25, 0.5, 0.625].map(|x| solution.at(x * length).bending / deflection)
    };
    let (near, far) = (at(1.0, 1.0), at(2f64.powi(150), 2f64.powi(-300)));
    for (near, far) in near.into_iter().zip(far) {
        assert!((near - far).abs() <= 1e-12 * near.abs(), "{near:e} {far:e}");
    }
}

#[test]
fn fluxes_below_the_normal_numbers_are_said() {
    let status = |axial: f64, permittivity: f64, load: f64| {
        let beam = Beam { bending: 1.0, axial, piezo: (), permittivity };
        let scene = Scene::new(1.0, beam)
            .load(Load { transverse: 1.0, axial: load, points: () })
            .potential(Potential { left: 0.0, right: 1e-10 });
        ends(scene, Mesh::uniform(3), Settings::default()).status
    };
    assert_eq!(status(1e5, 1e-280, 1.0), Status::Converged);
    // The displacement is 1e-317 N/V: what it is rounded to changes the potential.
    assert_eq!(status(1e5, 1e-307, 1.0), Status::ToleranceBelowFloor);
    // The stretching is 1e-322 m: that it ends with zero tells nothing of the axial force.
    assert_eq!(status(1e300, 1.0, 1e-22), Status::ToleranceBelowFloor);
}

#[test]
fn an_overflow_is_never_converged() {
    for (stiffness, f) in [(1e-300, 1e300), (1e-308, 1e3)] {
        let scene = Scene::new(1.0, Beam::elastic(stiffness)).load(plain(f));
        let problem = Problem::new(scene, Mesh::uniform(100)).expect("a scene without mistakes");
        let mut memory = HeapWorkspace::new();
        let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
        assert_ne!(solution.report().status, Status::Converged, "xi = {}", solution.at(0.5).bending);
    }
    // A prescribed potential at the end of the numbers: between the nodes it is beyond it.
    for (left, right) in [(f64::MAX, 0.0), (0.0, f64::MAX)] {
        let scene = beam(5000.0, 1e11, 1e-14, 1e-16)
            .load(Load { transverse: 1e6, axial: 1.0, points: () })
            .potential(Potential { left, right });
        let report = ends(scene, Mesh::uniform(1), Settings::default());
        assert_ne!(report.status, Status::Converged, "{left:e}, {right:e}");
    }
}

#[test]
fn a_foundation_stiffer_than_any_mesh_resolves_is_converged_in_equilibrium_or_not_at_all() {
    let transverse = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
    for stiffness in [1e20, 1e60, 1e100] {
        for n in [100, 1000] {
            let scene = Scene::new(1.0, Beam::elastic(5000.0))
                .foundation(Foundation { law: Linear(stiffness), gap: () })
                .load(Load { transverse, axial: (), points: () });
            let problem = Problem::new(scene, Mesh::uniform(n)).expect("a scene without mistakes");
            let mut memory = HeapWorkspace::new();
            let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
            let error = solution.resultants().equilibrium_error;
            let converged = solution.report().status == Status::Converged;
            assert!(!converged || error < tol::RANDOM_EQUILIBRIUM, "k = {stiffness:e}, N = {n}: {error:e}");
        }
    }
}

#[test]
fn a_gap_far_above_the_bending_converges_on_fine_meshes() {
    // Of the penetration most is the gap's own rigid motion, whose rounding is in the forces that sweeps compare.
    let tent = Table { x: &[0.0, 0.45, 0.5, 0.55, 1.0], y: &[0.05, 0.05, 0.005, 0.05, 0.05] };
    for n in [1000, 4000, 10_000, 40_000] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e8), gap: tent })
            .load(plain(2e4));
        let report = ends(scene, Mesh::uniform(n), Settings::default());
        assert_eq!(report.status, Status::Converged, "N = {n}: {report:?}");
        assert!(report.element_visits <= 16 * n, "N = {n}: {report:?}");
    }
    // Slopes of 1e5 on elements of 5e-7.
    let tip = Table { x: &[0.0, 0.4999995, 0.5, 0.5000005, 1.0], y: &[0.05, 0.05, 0.005, 0.05, 0.05] };
    for n in [2, 100, 1000] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e8), gap: tip })
            .load(plain(2e4));
        let report = ends(scene, Mesh::uniform(n), Settings::default());
        assert_eq!(report.status, Status::Converged, "N = {n}: {report:?}");
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let problem = Problem::new(Scene::new(1.0, Beam::elastic(1.0)), Mesh::uniform(2)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    for (bad, found) in [(0.0, "0"), (-1.0, "-1"), (1.0, "1"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")] {
        let error = problem.solve(&mut memory, &stop(bad)).err().expect("a refusal");
        assert_eq!(error.to_string(), format!("stop: expected a number between 0 and 1, found {found}"));
    }
}

/// What is said of a scene on a mesh, if it is refused.
fn refusal<M: Model<f64>>(scene: M, mesh: Mesh<'_, f64>) -> String {
    let said = match Problem::new(scene, mesh) {
        Err(error) => Some(error.to_string()),
        Ok(problem) => problem.prepare(&mut HeapWorkspace::new()).err().map(|e| e.to_string()),
    };
    said.unwrap_or_else(|| "nothing".to_owned())
}

fn refused<M: Model<f64>>(scene: M, said: &str) {
    assert_eq!(refusal(scene, Mesh::uniform(1)), said);
}

fn beam(bending: f64, axial: f64, piezo: f64, permittivity: f64) -> Scene<f64, Beam<f64, f64, f64, f64>> {
    Scene::new(1.0, Beam { bending, axial, piezo, permittivity })
}

/// Where the only element of [0, 1] looks at what is one number.
const AT: &str = "at x = 0.5: expected a";
/// And first at a function.
const AT_POINT: &str = "at x = 0.9305681557970262: expected a";
const NAN: f64 = f64::NAN;
const INF: f64 = f64::INFINITY;

#[test]
fn bad_beams_are_refused_by_field_place_and_value() {
    for (length, found) in [(0.0, "0"), (-1.0, "-1"), (NAN, "NaN"), (INF, "inf")] {
        let said = format!("length: expected a finite number > 0, found {found}");
        refused(Scene::new(length, Beam::elastic(1.0)), &said);
    }
    for (bad, kind, found) in [
        (-1.0, "number > 0", "-1"),
        (0.0, "number > 0", "0"),
        (NAN, "finite number", "NaN"),
        (INF, "finite number", "inf"),
    ] {
        refused(beam(bad, 1.0, 1.0, 1.0), &format!("beam.bending {AT} {kind}, found {found}"));
        refused(beam(1.0, bad, 1.0, 1.0), &format!("beam.axial {AT} {kind}, found {found}"));
        refused(beam(1.0, 1.0, 1.0, bad), &format!("beam.permittivity {AT} {kind}, found {found}"));
    }
    let divides = format!("{AT} number > 0 whose reciprocal is finite, found 1e-320");
    refused(beam(1e-320, 1.0, 1.0, 1.0), &format!("beam.bending {divides}"));
    refused(beam(1.0, 1e-320, 1.0, 1.0), &format!("beam.axial {divides}"));
    refused(beam(1.0, 1.0, 1.0, 1e-320), &format!("beam.permittivity {divides}"));
    refused(
        Scene::new(1.0, Beam::elastic(Table { x: &[0.0, 1.0], y: &[5e3, 1e-309] })),
        "beam.bending at x = 1: expected a number > 0 whose reciprocal is finite, found 1e-309",
    );
    refused(beam(1.0, 1.0, NAN, 1.0), &format!("beam.piezo {AT} finite number, found NaN"));
    let kept = "expected numbers for which P / (EA eps) and P / eps fit the number format, found";
    refused(beam(1.0, 1e203, 1.0, 1e204), &format!("beam.permittivity at x = 0.5: {kept} 1e204"));
    refused(beam(1.0, 1e204, 1.0, 1e203), &format!("beam.axial at x = 0.5: {kept} 1e204"));
    refused(beam(1.0, 1e-198, 1e-201, 1e277), &format!("beam.permittivity at x = 0.5: {kept} 1e277"));
    refused(beam(1.0, 1e100, 1e-280, 1.0), &format!("beam.piezo at x = 0.5: {kept} 1e-280"));
    // To the last number: a coupling that is just kept, by P / eps and P / (EA eps), and one that is lost by P / eps alone.
    let least = f64::MIN_POSITIVE;
    for scene in [beam(1.0, 1.0, 2.0 * least, 2.0), beam(1.0, 2.0, 4.0 * least, 2.0)] {
        let mut memory = HeapWorkspace::new();
        assert!(
            Problem::new(scene, Mesh::uniform(1)).is_ok_and(|problem| problem.prepare(&mut memory).is_ok())
        );
    }
    refused(beam(1.0, 2.0, 2.0 * least, 4.0), &format!("beam.piezo at x = 0.5: {kept} {:e}", 2.0 * least));
    refused(
        Scene::new(1.0, Beam::elastic(Polynomial(&[1.0, NAN]))),
        "beam.bending[1]: expected a finite number, found NaN",
    );
    let steps = |breaks, values| Scene::new(1.0, Beam::elastic(Steps { breaks, values }));
    let order = "expected breaks that increase strictly inside (0, length), found";
    refused(steps(&[0.5, 0.5], &[1.0; 3]), &format!("beam.bending[1]: {order} 0.5"));
    refused(steps(&[0.0], &[1.0; 2]), &format!("beam.bending[0]: {order} 0"));
    refused(steps(&[1.0], &[1.0; 2]), &format!("beam.bending[0]: {order} 1"));
    refused(steps(&[NAN], &[1.0; 2]), &format!("beam.bending[0]: {order} NaN"));
    refused(steps(&[0.5], &[1.0; 3]), "beam.bending: one value more than breaks: expected 2, found 3");
    let table = |x, y| Scene::new(1.0, Beam::elastic(Table { x, y }));
    refused(table(&[0.0, 1.0], &[1.0]), "beam.bending: as many y as x: expected 2, found 1");
    refused(table(&[0.0], &[1.0]), "beam.bending: a table of two points at least: expected 2, found 1");
    refused(table(&[0.1, 1.0], &[1.0; 2]), "beam.bending[0]: expected a table that starts at 0, found 0.1");
    refused(
        table(&[0.0, 0.5, 0.5, 1.0], &[1.0; 4]),
        "beam.bending[2]: expected abscissae that increase, found 0.5",
    );
}

#[test]
fn bad_foundations_are_refused_by_field_place_and_value() {
    let on = |stiffness, exponent| {
        beam(1.0, 1.0, 1.0, 1.0).foundation(Foundation { law: Power { stiffness, exponent }, gap: () })
    };
    refused(on(-1.0, 1.0), &format!("foundation.stiffness {AT} number >= 0, found -1"));
    refused(on(NAN, 1.0), &format!("foundation.stiffness {AT} finite number, found NaN"));
    // At nodes, too, but for what rounding makes of zero.
    let on_ramp = |ramp| {
        Scene::new(1.0, Beam::elastic(1.0))
            .foundation(Foundation { law: Linear(Polynomial(ramp)), gap: () })
            .load(plain(1.0))
    };
    refused(on_ramp(&[-1.0, 1e3]), "foundation.stiffness at x = 0: expected a number >= 0, found -1");
    let mut memory = HeapWorkspace::new();
    let problem = Problem::new(on_ramp(&[-1e-12, 1e3]), Mesh::uniform(1)).expect("a scene without mistakes");
    let solution = problem.solve(&mut memory, &Settings::default()).expect("zero but for rounding");
    assert_eq!(solution.at(0.0).pressure, Some(0.0));
    for (bad, found) in [(0.999, "0.999"), (NAN, "NaN"), (INF, "inf")] {
        refused(on(1.0, bad), &format!("foundation.exponent: expected a finite number >= 1, found {found}"));
    }
    let scene = Scene::new(1.0, Beam::elastic(1.0));
    let law = Linear(1.0);
    refused(
        scene.foundation(Foundation { law, gap: NAN }),
        "foundation.gap at x = 0: expected a finite number, found NaN",
    );
    let gap = Curve(|x: f64| [x, 1.0, NAN]);
    refused(
        scene.foundation(Foundation { law, gap }),
        &format!("foundation.gap {AT_POINT} finite number, found NaN"),
    );
    let gap = Steps { breaks: &[0.5], values: &[0.0, 1.0] };
    let said = "foundation.gap at x = 0.5: expected a continuous function, found a jump from 0 to 1";
    refused(scene.foundation(Foundation { law, gap }), said);
    let tabulated = |penetration, pressure, said: &str| {
        let law = Tabulated { penetration, pressure };
        refused(scene.foundation(Foundation { law, gap: () }), &format!("foundation.law{said}"));
    };
    tabulated(&[0.0], &[0.0], ": as many pressures as penetrations, two at least: expected 2, found 1");
    tabulated(
        &[0.0, 1.0, 2.0],
        &[0.0, 1.0],
        ": as many pressures as penetrations, two at least: expected 3, found 2",
    );
    tabulated(&[0.1, 1.0], &[0.0, 1.0], "[0]: expected a law that is zero at penetration zero, found 0.1");
    tabulated(&[0.0, 1.0], &[0.2, 1.0], "[0]: expected a law that is zero at penetration zero, found 0.2");
    tabulated(&[0.0, 1.0, 2.0], &[0.0, 1.0, 0.5], "[2]: expected pressures that do not decrease, found 0.5");
    tabulated(&[0.0, 1.0, 1.0], &[0.0, 1.0, 2.0], "[2]: expected penetrations that increase, found 1");
    tabulated(&[0.0, NAN], &[0.0, 1.0], "[1]: expected penetrations that increase, found NaN");
    tabulated(&[0.0, 1.0], &[0.0, INF], "[1]: expected pressures that do not decrease, found inf");
}

#[test]
fn bad_conduction_and_potentials_are_refused_by_field_place_and_value() {
    let with = |mu1, mu2, truncation, potential_truncation| {
        beam(1.0, 1.0, 1.0, 1.0).conduction(Conduction { mu1, mu2, truncation, potential_truncation })
    };
    refused(with(-1.0, 1.0, 1.0, 1.0), &format!("conduction.mu1 {AT} number >= 0, found -1"));
    refused(with(1.0, -2.0, 1.0, 1.0), &format!("conduction.mu2 {AT} number >= 0, found -2"));
    refused(with(NAN, 1.0, 1.0, 1.0), &format!("conduction.mu1 {AT} finite number, found NaN"));
    refused(with(1.0, INF, 1.0, 1.0), &format!("conduction.mu2 {AT} finite number, found inf"));
    for (bad, found) in [(0.0, "0"), (-1.0, "-1"), (NAN, "NaN"), (INF, "inf")] {
        let said = format!("expected a finite number > 0, found {found}");
        refused(with(1.0, 1.0, bad, 1.0), &format!("conduction.truncation: {said}"));
        refused(with(1.0, 1.0, 1.0, bad), &format!("conduction.potential_truncation: {said}"));
    }
    let between = |left, right| beam(1.0, 1.0, 1.0, 1.0).potential(Potential { left, right });
    refused(between(NAN, 0.0), "potential.left: expected a finite number, found NaN");
    refused(between(0.0, INF), "potential.right: expected a finite number, found inf");
}

#[test]
fn bad_loads_are_refused_by_field_place_and_value() {
    let scene = Scene::new(1.0, Beam { bending: 1.0, axial: 1.0, piezo: (), permittivity: () });
    refused(scene.load(plain(NAN)), &format!("load.transverse {AT} finite number, found NaN"));
    refused(
        scene.load(Load { transverse: (), axial: INF, points: () }),
        &format!("load.axial {AT} finite number, found inf"),
    );
    let pole = Load { transverse: Function(|x: f64| 1.0 / (x - x)), axial: (), points: () };
    refused(scene.load(pole), &format!("load.transverse {AT_POINT} finite number, found inf"));
    let at = |x, force, moment| {
        scene.load(Load { transverse: (), axial: (), points: [PointLoad { x, force, moment }] })
    };
    for (bad, found) in [(0.0, "0"), (1.0, "1"), (-0.1, "-0.1"), (NAN, "NaN")] {
        let said = "load.points[0]: expected positions in ascending order strictly inside (0, length), found";
        refused(at(bad, 1.0, 0.0), &format!("{said} {found}"));
    }
    refused(at(0.5, NAN, 0.0), "load.points[0]: expected finite numbers, found NaN");
    refused(at(0.5, 0.0, INF), "load.points[0]: expected finite numbers, found inf");
}

#[test]
fn parts_that_need_others_say_which() {
    let bending = Scene::new(1.0, Beam::elastic(1.0));
    let said = "beam.axial: expected because of load.axial, found nothing";
    refused(bending.load(Load { transverse: (), axial: 1.0, points: () }), said);
    let said = "beam.permittivity: expected because of conduction, found nothing";
    refused(bending.conduction(Conduction::new(1.0, (), 1.0)), said);
    refused(bending.conduction(Conduction::new((), 1.0, 1.0)), said);
    let beam = Beam { bending: 1.0, axial: 1.0, piezo: 1.0, permittivity: () };
    refused(Scene::new(1.0, beam), "beam.permittivity: expected because of beam.piezo, found nothing");
    let beam = Beam { bending: 1.0, axial: (), piezo: 1.0, permittivity: 1.0 };
    refused(Scene::new(1.0, beam), "beam.axial: expected because of beam.piezo, found nothing");
}

#[test]
fn bad_meshes_are_refused_by_field_place_and_value() {
    fn said(mesh: Mesh<'_, f64>) -> String {
        refusal(Scene::new(1.0, Beam::elastic(1.0)), mesh)
    }
    assert_eq!(said(Mesh::uniform(0)), "mesh.elements: expected 1 to 100 000 000 elements, found 0");
    let graded = |elements, ratio| said(Mesh::Graded { elements, ratio });
    assert_eq!(graded(0, 1.0), "mesh.elements: expected 1 to 100 000 000 elements, found 0");
    for (bad, found) in [(0.0, "0"), (-1.0, "-1"), (NAN, "NaN"), (INF, "inf")] {
        assert_eq!(graded(4, bad), format!("mesh.ratio: expected a finite number > 0, found {found}"));
    }
    let nodes = |nodes: &[f64]| said(Mesh::Nodes(nodes));
    assert_eq!(nodes(&[]), "mesh.nodes: two nodes at least: expected 2, found 0");
    assert_eq!(nodes(&[0.0]), "mesh.nodes: two nodes at least: expected 2, found 1");
    assert_eq!(nodes(&[0.1, 1.0]), "mesh.nodes[0]: expected a first node at 0, found 0.1");
    assert_eq!(nodes(&[0.0, 0.9]), "mesh.nodes[1]: expected a last node at the beam's length, found 0.9");
    for (middle, found) in [([0.5, 0.5], "0.5"), ([0.6, 0.4], "0.4"), ([0.5, NAN], "NaN")] {
        let said = nodes(&[0.0, middle[0], middle[1], 1.0]);
        assert_eq!(said, format!("mesh.nodes[2]: expected nodes that increase, found {found}"));
    }
}

#[test]
fn a_workspace_too_small_says_how_much_it_takes() {
    let steps = Steps { breaks: &[0.25, 0.5], values: &[1.0, 2.0, 3.0] };
    let problem = Problem::new(Scene::new(1.0, Beam::elastic(steps)), Mesh::uniform(2)).expect("a scene");
    let mut memory = problem.workspace::<2>();
    let error = problem.solve(&mut memory, &Settings::default()).err().expect("too little memory");
    let said = "workspace: expected room for 3 elements or more (breaks and point loads add nodes), found 2";
    assert_eq!(error.to_string(), said);
}

#[test]
fn a_beam_without_load_above_its_foundation_is_straight() {
    for (gap, n) in [(1e-6, 10), (1e-3, 100), (1.0, 1000)] {
        for load in [0.0, 1e-300] {
            let scene = Scene::new(1.0, Beam::elastic(5000.0))
                .foundation(Foundation { law: Linear(1e8), gap })
                .load(plain(load));
            let report = ends(scene, Mesh::uniform(n), Settings::default());
            assert_eq!(report.status, Status::Converged, "{report:?}");
        }
    }
}

#[test]
fn a_load_without_digits_does_not_converge_to_them() {
    // 570 units of the smallest number: what they are rounded to in an element bends the beam 0.4 % off.
    let at = |load: f64| {
        let scene = Scene::new(1.0, Beam::elastic(5e-240)).load(plain(load));
        ends(scene, Mesh::uniform(1), Settings::default())
    };
    let lost = at(2.816e-321);
    assert_eq!(lost.status, Status::ToleranceBelowFloor, "{lost:?}");
    assert!(lost.residual > 1e-3 && lost.residual == lost.floor, "{lost:?}");
    // Nine digits that are left, and all.
    let nine = at(1e-313);
    assert_eq!(nine.status, Status::ToleranceBelowFloor, "{nine:?}");
    assert_eq!(at(1e-306).status, Status::Converged);
}

#[test]
fn a_load_below_the_normal_numbers_acts_on_the_length_twice() {
    let scene = Scene::new(1e6_f32, Beam::elastic(5000.0)).load(Load {
        transverse: -9.1e-44_f32,
        axial: (),
        points: (),
    });
    let problem = Problem::new(scene, Mesh::uniform(5)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    assert_eq!(solution.report().status, Status::ToleranceBelowFloor, "{:?}", solution.report());
}

#[test]
fn a_law_far_steeper_than_its_slope_has_the_floor_of_its_secants() {
    let at = |k: f64, nodes| {
        let law = Law(move |_: f64, r: f64| (k * r, 1e8));
        let scene =
            Scene::new(1.0, Beam::elastic(5e3)).foundation(Foundation { law, gap: 1e-3 }).load(plain(1e6));
        ends(scene, Mesh::Nodes(nodes), Settings { stop: 1e-10, max_visits: Some(500) })
    };
    // Were called converged: the penetration is rounding, and so is all that balances the load.
    let nodes: [&[f64]; 2] = [
        &[0.0, 1.648_814_032_928_26e-8, 0.003_891_050_583_657_587_6, 1.0],
        &[0.0, 0.003_891_050_583_657_587_6, 1.0],
    ];
    for (k, nodes) in [(2.760_698_538_716_225e72, nodes[0]), (1.159_638_750_323_592_2e45, nodes[1])] {
        let report = at(k, nodes);
        assert_eq!(report.status, Status::ToleranceBelowFloor, "{report:?}");
        assert!(report.floor > 1e-2, "{report:?}");
    }
}

#[test]
fn forces_inside_an_element_do_not_count_as_its_moment() {
    // A force beside the left clamp of a beam of 18 000 km on a rigid foundation: h times the contact force of the
    // element beside it, 1e6 times the largest moment, hid that the moments had no digits.
    let points = [PointLoad { x: 20.179_515_029_868_26, force: 1e12, moment: -1e11 }];
    let length = 17_782_794.100_389_227;
    let scene = Scene::new(length, Beam::elastic(5e3))
        .foundation(Foundation { law: Linear(5_623_413_251_903.491), gap: () })
        .load(Load { transverse: 1e-10, axial: (), points: points.as_slice() });
    let report = ends(scene, Mesh::uniform(1), Settings { stop: 1e-6, max_visits: Some(500) });
    assert_eq!(report.status, Status::ToleranceBelowFloor, "{report:?}");
    assert!(report.floor > 1e-2, "{report:?}");
}

#[test]
fn a_moment_on_the_clamp_itself_hides_no_residual() {
    let at = |moment: f64| {
        let points = [PointLoad { x: 1.0 - f64::EPSILON, force: 0.0, moment }];
        let load = Load { transverse: 1e6, axial: (), points: points.as_slice() };
        let scene = Scene::new(1.0, Beam::elastic(5e3))
            .foundation(Foundation { law: Linear(1e8), gap: 1e-3 })
            .load(load);
        ends(scene, Mesh::uniform(64), Settings::default())
    };
    // Was 2e-307, over the moment that acts on the clamp alone.
    assert!(at(1e300).residual > 1e-17, "{:?}", at(1e300));
}

#[test]
fn loads_closer_than_rounding_act_once() {
    // Two nodes: the load between them is within rounding of both.
    let tiny = 16.0 * f32::EPSILON;
    let points = [0.5, 0.5 + 0.95 * tiny, 0.5 + 1.9 * tiny].map(|x| PointLoad { x, force: 1.0, moment: 0.0 });
    let load = Load { transverse: 0.0_f32, axial: (), points: points.as_slice() };
    let problem =
        Problem::new(Scene::new(1.0, Beam::elastic(1.0)).load(load), Mesh::uniform(2)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    let all = solution.resultants();
    assert_eq!(solution.nodes().count(), 4);
    assert!(
        (all.load - 3.0).abs() < 1e-5 && (all.left_force + all.right_force + 3.0).abs() < 1e-4,
        "{all:?}"
    );
}

#[test]
fn a_load_at_the_end_of_the_numbers_is_a_breakdown_on_a_foundation() {
    // The pressure is larger than the load somewhere.
    let scene = Scene::new(0.1, Beam::elastic(5e3)).foundation(Foundation { law: Linear(1e14), gap: 1e-3 });
    let report = |load: f64| ends(scene.load(plain(load)), Mesh::uniform(5), Settings::default());
    assert!(matches!(report(f64::MAX).status, Status::Breakdown { .. }), "{:?}", report(f64::MAX));
    assert_eq!(report(1e290).status, Status::Converged);
}

#[test]
fn a_pressure_beyond_the_numbers_is_a_breakdown_also_where_its_force_is_none() {
    // Lengths of 1e-59 m: the pressure times one is 1e249 N.
    let two = |exponent: i32| 2.0_f64.powi(exponent);
    let status = |stiffness: f64, bending: f64| {
        let foundation = Foundation { law: Linear(stiffness), gap: -0.01 * two(255) };
        let scene = Scene::new(two(-195), Beam::elastic(bending)).foundation(foundation);
        ends(scene.load(plain(0.0)), Mesh::uniform(10), Settings::default()).status
    };
    assert!(matches!(status(two(804), 0.1 * two(24)), Status::Breakdown { .. }));
    assert_eq!(status(two(704), 0.1 * two(-76)), Status::Converged);
}

#[test]
fn loads_that_cancel_leave_the_rest_its_digits() {
    // Moments 1e13 times those of the load between the nodes.
    let bent = |moment: f64| {
        let points = [moment, -moment].map(|moment| PointLoad { x: 1.5e-8, force: 0.0, moment });
        let load = Load { transverse: 1e6, axial: (), points: points.as_slice() };
        let problem =
            Problem::new(Scene::new(3e-8, Beam::elastic(5e3)).load(load), Mesh::uniform(8)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        problem.solve(&mut memory, &Settings::default()).expect("settings in range").at(1e-8).bending
    };
    assert_eq!(bent(1e4).to_bits(), bent(0.0).to_bits());
    // Others between them, that are a few units in the last place of those.
    let bent = |moments: &[f32]| {
        let points: Vec<_> =
            moments.iter().map(|&moment| PointLoad { x: 0.25, force: 0.0, moment }).collect();
        let load = Load { transverse: (), axial: (), points: points.as_slice() };
        let problem = Problem::new(Scene::new(1.0, Beam::elastic(5e3_f32)).load(load), Mesh::uniform(1));
        let mut memory = HeapWorkspace::new();
        let problem = problem.expect("a scene");
        problem.solve(&mut memory, &Settings::default()).expect("settings in range").at(0.25).slope
    };
    assert_eq!(bent(&[-5.6e10, 1e4, 1e4, 5.6e10]).to_bits(), bent(&[2e4]).to_bits());
}

#[test]
fn a_halted_solve_of_two_way_conduction_has_its_own_potential() {
    let case = named("coupled-partial");
    let settings = Settings { max_visits: Some(300), ..Settings::default() };
    let problem = Problem::new(&case.scene, Mesh::uniform(300)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory).expect("memory that grows");
    let halted =
        |solution: piezobeam::Solution<'_, f64, _>| (*solution.report(), solution.at(0.3), solution.at(1.0));
    let fresh = halted(prepared.solution(&settings).expect("settings in range"));
    let _ = prepared.solve(&Settings::default()).expect("settings in range");
    let again = halted(prepared.solution(&settings).expect("settings in range"));
    assert_eq!(fresh.0.status, Status::VisitLimit);
    assert_eq!(fresh, again);
    let end = case.scene.potential.right;
    assert_eq!(fresh.2.potential, Some(end));
}
