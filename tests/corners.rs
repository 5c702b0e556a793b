//! Paths that few scenes take: each ends as the common ones do.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{fields, halves, named, plain, points, relative, tolerances as tol};
use piezobeam::{
    Adaptive, Batch, Beam, Conduction, Error, Fields, Foundation, Function, Grazing, HeapWorkspace, History,
    Linear, Load, Mesh, Method, Model, Output, Parameter, PointLoad, Polynomial, Potential, Power, Problem,
    Reached, Resultants, Scene, SensitivityError, Settings, Solution, Status, Steps, StoragePlace, Table,
};

fn capped(most: usize) -> Settings<f64> {
    Settings { max_visits: Some(most), ..Settings::default() }
}

fn bending(fields: &[Fields<f64>]) -> Vec<f64> {
    fields.iter().map(|f| f.bending).collect()
}

fn sampled<M: Model<f64>>(solution: &Solution<'_, f64, M>) -> Vec<f64> {
    points(40, solution.scene().length()).iter().map(|&x| solution.at(x).bending).collect()
}

/// The bending of a scene solved from nothing.
fn alone<M: Model<f64>>(scene: M, n: usize) -> Vec<f64> {
    let x = points(40, scene.length());
    let (report, fields) = fields(scene, Mesh::uniform(n), &x);
    assert_eq!(report.status, Status::Converged, "{report:?}");
    bending(&fields)
}

#[test]
fn a_mesh_that_runs_out_of_visits_says_so_and_the_next_one_does_not_suffer() {
    let (first, second) = (halves(1e10), halves(1e8));
    let mut reference = HeapWorkspace::new();
    let problem = Problem::new(second, Mesh::uniform(400)).expect("a scene");
    let want = sampled(&problem.solve(&mut reference, &Settings::default()).expect("settings"));
    let mut ends = [0; 2];
    for most in (0..4000).step_by(53) {
        let mut memory = HeapWorkspace::new();
        let mut adaptive = Adaptive::new(Mesh::uniform(16), &mut memory);
        let start = adaptive.solve(&first, 1e-6, &Settings::default()).expect("a tolerance");
        assert_eq!(start.reached, Reached::Tolerance);
        let found = adaptive.solve(&second, 1e-8, &capped(most)).expect("a tolerance");
        let solved = found.solution.report().status == Status::Converged;
        assert_eq!(found.reached == Reached::Tolerance, solved, "{most}: {:?}", found.solution.report());
        assert!(solved || found.reached == Reached::Unsolved, "{most}: {:?}", found.reached);
        ends[usize::from(solved)] += 1;
        let again = adaptive.solve(&second, 1e-8, &Settings::default()).expect("a tolerance");
        assert_eq!(again.reached, Reached::Tolerance, "{most}");
        let error = relative(&sampled(&again.solution), &want);
        assert!(error < tol::ESTIMATE * 1e-8, "{most}: {error:e}");
    }
    assert!(ends.iter().all(|&n| n > 0), "{ends:?}");
}

#[test]
fn a_mesh_that_is_too_fine_for_the_next_scene_grows_coarse() {
    let scene = halves(1e8);
    let mut memory = HeapWorkspace::new();
    let mut adaptive = Adaptive::new(Mesh::uniform(16), &mut memory);
    let mut elements = |tolerance: f64| {
        let found = adaptive.solve(&scene, tolerance, &Settings::default()).expect("a tolerance");
        assert_eq!(found.reached, Reached::Tolerance);
        found.solution.report().elements
    };
    let (fine, coarse) = (elements(1e-10), elements(1e-4));
    assert!(4 * coarse < 3 * fine, "{coarse} {fine}");
}

/// The bound on the error of a mesh of `N` elements, with any number of visits and with little memory.
fn bounded<M: Model<f64>, const N: usize, const FOUR: usize, const MORE: usize>(scene: &M) {
    let problem = Problem::new(scene, Mesh::uniform(N)).expect("a scene");
    let finest = Problem::new(scene, Mesh::uniform(64 * N)).expect("a scene");
    let (mut memory, mut other) = (HeapWorkspace::new(), HeapWorkspace::new());
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings");
    let reference = finest.solve(&mut other, &Settings::default()).expect("settings");
    assert_eq!(reference.report().status, Status::Converged);
    let error = solution.distance(&reference).expect("meshes that divide each other");
    let mut bounds = Vec::new();
    for most in (0..60).map(|i| 37 * i * i) {
        let found = solution.certify(&mut HeapWorkspace::new(), &capped(most)).expect("memory");
        assert!(found.report.element_visits <= most, "{most}: {:?}", found.report);
        bounds.extend(found.bending_bound);
    }
    let best = bounds.last().copied().unwrap_or(f64::INFINITY);
    assert!(bounds.len() > 30 && best < tol::EFFECTIVITY * error, "{best:e} of {error:e}: {bounds:?}");
    let settings = Settings::default();
    bounds
        .extend(solution.certify(&mut problem.workspace::<FOUR>(), &settings).expect("memory").bending_bound);
    bounds
        .extend(solution.certify(&mut problem.workspace::<MORE>(), &settings).expect("memory").bending_bound);
    for bound in &bounds {
        assert!(*bound >= error, "{bound:e} of {error:e}");
    }
}

/// Layers that the mesh does not resolve: a certificate divides them as far as it may.
#[test]
fn a_bound_holds_also_where_visits_or_memory_end_it() {
    bounded::<_, 10, 40, 45>(&halves(3e14));
    bounded::<_, 50, 200, 210>(&named("rigid").scene);
}

/// Layers at the clamps that four times the mesh does not resolve either: what a second finer mesh is made for.
#[test]
fn a_certificate_with_room_divides_layers_until_its_bound_is_near() {
    for (k, n) in [(1e10, 5), (1e12, 10), (1e14, 50)] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(k), gap: () })
            .load(plain(1e6));
        let problem = Problem::new(scene, Mesh::uniform(n)).expect("a scene");
        let finest = Problem::new(scene, Mesh::uniform(256 * n)).expect("a scene");
        let (mut memory, mut other) = (HeapWorkspace::new(), HeapWorkspace::new());
        let solution = problem.solve(&mut memory, &Settings::default()).expect("settings");
        let reference = finest.solve(&mut other, &Settings::default()).expect("settings");
        let error = solution.distance(&reference).expect("meshes that divide each other");
        let mut places = vec![StoragePlace::default(); 8 * n];
        let mut found = [(0, 0.0); 2];
        for (found, room) in found.iter_mut().zip([8 * n, 4 * n]) {
            let certificate = solution.certify(&mut places[..room], &Settings::default()).expect("memory");
            *found = (certificate.report.elements, certificate.bending_bound.expect("the theory holds"));
        }
        let [(elements, bound), (least, undivided)] = found;
        assert!((4 * n + 1..=8 * n).contains(&elements) && least == 4 * n, "{elements} {least}");
        assert!(bound >= error && bound < tol::EFFECTIVITY * error, "{bound:e} of {error:e}");
        assert!(undivided > tol::EFFECTIVITY * error, "{undivided:e} of {error:e}");
    }
}

#[test]
fn meshes_that_do_not_divide_each_other_have_no_distance() {
    let problem = |nodes: &'static [f64]| {
        Problem::new(Scene::new(1.0, Beam::elastic(1.0)).load(plain(1.0)), Mesh::Nodes(nodes))
            .expect("a scene")
    };
    let whole = problem(&[0.0, 1.0]);
    let mut memory = HeapWorkspace::new();
    let solution = whole.solve(&mut memory, &Settings::default()).expect("settings");
    // Halves of the element as long as they should be, but between its quarters.
    for (nodes, divides) in [(&[0.0, 0.5, 1.0][..], true), (&[0.0, 0.25, 0.75, 1.0], false)] {
        let (finer, mut memory) = (problem(nodes), HeapWorkspace::new());
        let finer = finer.solve(&mut memory, &Settings::default()).expect("settings");
        assert_eq!(solution.distance(&finer).is_some(), divides, "{nodes:?}");
    }
}

#[test]
fn a_curved_law_under_a_potential_that_pulls_has_a_bound_that_holds() {
    let scene = Scene::new(1.0, Beam { bending: 5e3, axial: (), piezo: (), permittivity: 1.0 })
        .foundation(Foundation { law: Power { stiffness: 1e6, exponent: 1.5 }, gap: () })
        .conduction(Conduction { mu1: 1e5, mu2: (), truncation: 1.0, potential_truncation: 1.0 })
        .load(plain(1e4))
        .potential(Potential { left: -1.0, right: -0.5 });
    let solve = |n: usize, look: &mut dyn FnMut(&Solution<'_, f64, _>)| {
        let problem = Problem::new(scene, Mesh::uniform(n)).expect("a scene");
        look(&problem.solve(&mut HeapWorkspace::new(), &Settings::default()).expect("settings"));
    };
    solve(10, &mut |solution| {
        let found = solution.certify(&mut HeapWorkspace::new(), &Settings::default()).expect("memory");
        let bound = found.bending_bound.expect("the beam resists more than the potential pulls");
        solve(320, &mut |finer| {
            let error = solution.distance(finer).expect("meshes that divide each other");
            // The pull is not known to be resisted by a curved law: the bound pays for all of it.
            assert!((1.0..tol::EFFECTIVITY).contains(&(bound / error)), "{bound:e} of {error:e}");
        });
    });
}

/// Statuses and bending of all scenes in one batch, and how many go in lockstep.
fn together<M: Model<f64> + Copy>(scenes: &[M], n: usize, stop: f64) -> (usize, Vec<(Status, Vec<f64>)>) {
    let mut batch = Batch::<f64, M, 4>::new();
    let mut group = batch.prepare(scenes, &Mesh::uniform(n)).expect("room");
    let joined = group.in_lockstep();
    group.solve(&Settings { stop, max_visits: None }).expect("settings");
    let found = (0..scenes.len()).map(|i| {
        let solution = group.solution(i).expect("a sound scene");
        (solution.report().status, sampled(&solution))
    });
    (joined, found.collect())
}

fn as_alone<M: Model<f64> + Copy>(scenes: &[M], n: usize, joined: usize) {
    let (lockstep, found) = together(scenes, n, 1e-10);
    assert_eq!(lockstep, joined);
    for (scene, (status, got)) in scenes.iter().zip(found) {
        let (report, want) = fields(*scene, Mesh::uniform(n), &points(40, scene.length()));
        assert_eq!(status, report.status);
        let same = relative(&got, &bending(&want)) < tol::BATCH;
        assert!(same || status != Status::Converged, "{got:?}");
    }
}

#[test]
fn scenes_of_a_batch_differ_in_all_that_their_kind_allows() {
    // No foundation: one sweep.
    let free = [1e3, -1e6, 0.0, 1e-3].map(|load| Scene::new(1.0, Beam::elastic(5000.0)).load(plain(load)));
    as_alone(&free, 50, 4);
    // Breaks so near each other that they make an element more.
    for n in [10, 200] {
        let breaks = [[0.5, 0.7], [0.5, 0.5001], [0.5, 0.7], [0.5, 0.6]];
        let stepped: Vec<_> = breaks
            .iter()
            .map(|breaks| {
                let transverse = Steps { breaks, values: &[1e6, -1e6, 1e5] };
                Scene::new(1.0, Beam::elastic(5000.0))
                    .foundation(Foundation { law: Linear(1e6), gap: () })
                    .load(Load { transverse, axial: (), points: () })
            })
            .collect();
        as_alone(&stepped, n, 2);
    }
}

#[test]
fn a_batch_that_is_asked_for_more_digits_than_there_are_says_so() {
    let (joined, found) = together(&[halves(1e6), halves(1e7)], 100, 1e-18);
    assert_eq!(joined, 2);
    for ((status, got), k) in found.iter().zip([1e6, 1e7]) {
        assert_eq!(*status, Status::ToleranceBelowFloor);
        assert!(relative(got, &alone(halves(k), 100)) < tol::BATCH);
    }
}

#[test]
fn a_lane_that_overflows_does_not_spoil_the_others() {
    // Pressures that are no number where the contact has an edge, and where the stiffness varies.
    for load in [1e300, 1e304, 1e306, 1e307] {
        let scenes = [1e3, load, 2e3].map(|load| {
            Scene::new(1.0, Beam::elastic(Polynomial(&[1e-3])))
                .foundation(Foundation { law: Linear(Polynomial(&[90.0, 1.0])), gap: () })
                .load(plain(load))
        });
        let (_, found) = together(&scenes, 30, 1e-10);
        for (i, scene) in scenes.iter().enumerate() {
            let (report, want) = fields(*scene, Mesh::uniform(30), &points(40, 1.0));
            assert_eq!(found[i].0, report.status, "{load:e}, scene {i}");
            assert!(i == 1 || relative(&found[i].1, &bending(&want)) < tol::BATCH, "{load:e}, scene {i}");
        }
    }
}

#[test]
fn a_history_sees_whatever_changes() {
    type Numbers = (f64, &'static [f64], f64, f64);
    const GAPS: [&[f64]; 2] = [&[0.0, 0.0, 1e-3, -2e-3, 1e-3], &[0.0, 0.0, 3e-3, -6e-3, 3e-3]];
    let scene = |(force, gap, k, mu1): Numbers| {
        Scene::new(1.0, Beam { bending: 5e3, axial: (), piezo: (), permittivity: 1.0 })
            .foundation(Foundation { law: Linear(k), gap: Polynomial(gap) })
            .conduction(Conduction { mu1, mu2: (), truncation: 1.0, potential_truncation: 1.0 })
            .load(Load { transverse: 1e5, axial: (), points: [PointLoad { x: 0.5, force, moment: 0.0 }] })
            .potential(Potential { left: 1.0, right: 0.5 })
    };
    let last = (1e4, GAPS[0], 1e6, 1e5);
    let (force, gap, k, mu1) = last;
    for next in [(2e4, gap, k, mu1), (force, GAPS[1], k, mu1), (force, gap, 1e7, mu1), (force, gap, k, 1e7)] {
        for n in [1, 2, 3, 60] {
            let mut memory = HeapWorkspace::new();
            let mut history = History::new(Mesh::uniform(n), &mut memory);
            for numbers in [last, next, last] {
                let scene = scene(numbers);
                let solution = history.solve(&scene, &Settings::default()).expect("a scene");
                assert_eq!(solution.report().status, Status::Converged, "{numbers:?} {n}");
                let error = relative(&sampled(&solution), &alone(scene, n));
                assert!(error < tol::HISTORY, "{numbers:?} {n}: {error:e}");
            }
        }
    }
}

#[test]
fn a_history_asked_for_more_digits_of_the_same_scene_finds_them() {
    let mut coarse = 0;
    for exponent in [1.0, 2.0, 3.0] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Power { stiffness: 1e9, exponent }, gap: () })
            .load(Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () });
        let mut memory = HeapWorkspace::new();
        let mut history = History::new(Mesh::uniform(30), &mut memory);
        let mut last = 0.0;
        for stop in [0.5, 1e-1, 1e-2, 1e-4, 1e-7, 1e-10] {
            let settings = Settings { stop, max_visits: None };
            let report = *history.solve(&scene, &settings).expect("a scene").report();
            assert_eq!(report.status, Status::Converged, "{stop:e}");
            assert!(report.residual <= stop, "{report:?}");
            coarse += usize::from(last > stop);
            last = report.residual;
        }
    }
    assert!(coarse > 0, "all had all digits at once");
}

#[test]
fn meshes_that_breaks_keep_from_growing_coarse_are_solved_as_they_are() {
    // A break at every node but one in five.
    let breaks: Vec<f64> = (1..120).filter(|i| i % 5 != 0).map(|i| f64::from(i) / 120.0).collect();
    let values: Vec<f64> =
        (0..=breaks.len()).map(|i| if i <= breaks.len() / 2 { 1e6 } else { -1e6 }).collect();
    let scene = Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e8), gap: () });
    let load = Load { transverse: Steps { breaks: &breaks, values: &values }, axial: (), points: () };
    let middle = breaks[breaks.len() / 2];
    let whole = Load { transverse: Steps { breaks: &[middle], values: &[1e6, -1e6] }, axial: (), points: () };
    let nodes: Vec<f64> = (0..=120).map(|i| f64::from(i) / 120.0).collect();
    let x = points(40, 1.0);
    let (report, got) = fields(scene.load(load), Mesh::uniform(120), &x);
    assert_eq!(report.status, Status::Converged);
    let (_, want) = fields(scene.load(whole), Mesh::Nodes(&nodes), &x);
    let error = relative(&bending(&got), &bending(&want));
    assert!(error < tol::HISTORY, "{error:e}");
}

#[test]
fn a_method_that_comes_back_to_its_own_state_has_settled() {
    let mut settled = 0;
    for k in [1e4, 1e5, 1e6, 1e7] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Power { stiffness: k, exponent: 1.5 }, gap: () })
            .load(plain(1e6));
        let problem = Problem::new(scene, Mesh::uniform(20)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let mut beam = problem.prepare(&mut memory).expect("memory");
        let settings = Settings { stop: 1e-300, max_visits: None };
        let found = beam.solve_by(&Method::Gauss, &settings).expect("settings");
        assert!(found.report.iterations < 500 && found.own_residual < tol::FLOOR, "{found:?}");
        match found.report.status {
            Status::Cycle { period } => assert!(period > 1, "{found:?}"),
            status => {
                assert_eq!(status, Status::ToleranceBelowFloor, "{found:?}");
                settled += 1;
            }
        }
    }
    assert!(settled > 0);
}

/// q' is a difference of D / eps and P u' / eps, some 1e18 times as large.
fn without_digits(transverse: f64) -> impl Model<f64> + Copy {
    Scene::new(1.0, Beam { bending: 1.0, axial: 1e5, piezo: 100.0, permittivity: 1e-19 })
        .foundation(Foundation { law: Linear(1e3), gap: () })
        .conduction(Conduction { mu1: (), mu2: 1.0, truncation: 1.0, potential_truncation: 1.0 })
        .load(Load { transverse, axial: 1e6, points: () })
        .potential(Potential { left: 1.0, right: 1.0 })
}

#[test]
fn what_the_potential_has_lost_is_said_by_batches_and_methods_too() {
    let scenes = [1e3, 2e3].map(without_digits);
    as_alone(&scenes, 20, 2);
    let problem = Problem::new(scenes[0], Mesh::uniform(20)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory).expect("memory");
    let report = beam.solve(&Settings::default()).expect("settings");
    assert_eq!(report.status, Status::ToleranceBelowFloor, "{report:?}");
    let found = beam.solve_by(&Method::Gauss, &Settings::default()).expect("settings");
    assert_eq!(found.report.status, Status::ToleranceBelowFloor, "{found:?}");
    // Without a field there are no digits to lose.
    let still = Scene::new(1.0, Beam { bending: 1.0, axial: 1e5, piezo: 100.0, permittivity: 1e-19 })
        .load(plain(1e3))
        .potential(Potential { left: 0.0, right: 0.0 });
    let problem = Problem::new(still, Mesh::uniform(20)).expect("a scene");
    let report = problem.prepare(&mut HeapWorkspace::new()).expect("memory").solve(&Settings::default());
    assert_eq!(report.map(|report| report.status), Ok(Status::Converged));
}

#[test]
fn a_method_that_overflows_breaks_down() {
    let scene = |load: f64| {
        Scene::new(1.0, Beam::elastic(1.0))
            .foundation(Foundation { law: Linear(1e2), gap: () })
            .load(plain(load))
    };
    for load in [1e300, 1e305, 1e307, 1.7e308] {
        let problem = Problem::new(scene(load), Mesh::uniform(20)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let mut beam = problem.prepare(&mut memory).expect("memory");
        for method in [Method::Gauss, Method::Elementwise] {
            let found = beam.solve_by(&method, &Settings::default()).expect("settings");
            let fine = found.report.status == Status::Converged;
            assert_eq!(fine, load < 1e304, "{load:e}: {found:?}");
        }
    }
}

#[test]
fn a_stretch_that_just_rests_is_found_inside_the_beam() {
    let gap = Table { x: &[0.0, 0.15, 0.3, 0.7, 0.85, 1.0], y: &[0.0, 1e-3, 0.0, 0.0, 1e-3, 0.0] };
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e8), gap })
        .load(plain(0.0));
    let problem = Problem::new(scene, Mesh::uniform(100)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory).expect("memory");
    beam.solve(&Settings::default()).expect("settings");
    assert_eq!(beam.grazing(), Ok(Some(Grazing::Stretch { from: 0.3, to: 0.7 })));
}

#[test]
fn nodes_that_rounding_puts_together_are_one() {
    let scene = Scene::new(1.0_f32, Beam::elastic(1.0)).load(Load { transverse: 1.0, axial: (), points: () });
    let problem = Problem::new(scene, Mesh::uniform(20_000_000)).expect("a scene");
    let refused = problem.prepare(&mut problem.workspace::<4>()).err();
    // Numbers next to 1 are 6e-8 apart, which is more than a length.
    let fewer = matches!(refused, Some(Error::Capacity { needed: 8_000_000..20_000_000, available: 4 }));
    assert!(fewer, "{refused:?}");
}

#[test]
fn a_beam_without_any_load_is_in_equilibrium() {
    let problem = Problem::new(Scene::new(1.0, Beam::elastic(5000.0)), Mesh::uniform(10)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings");
    assert_eq!(solution.report().status, Status::Converged);
    assert_eq!(solution.resultants(), Resultants::default());
}

/// What differences of solves say of the derivative of `output` to the transverse load.
fn by_differences<M: Model<f64>>(scene: &dyn Fn(f64) -> M, output: Output<f64>) -> [f64; 3] {
    let value = |load: f64| {
        let scene = scene(load);
        let problem = Problem::new(&scene, Mesh::uniform(40)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let solution =
            problem.solve(&mut memory, &Settings { stop: 1e-13, max_visits: None }).expect("settings");
        assert!(solution.resultants().equilibrium_error < tol::RANDOM_EQUILIBRIUM);
        match output {
            Output::Bending(x) => solution.at(x).bending,
            _ => solution.at(0.5).potential.unwrap_or_default(),
        }
    };
    let base = scene(1.0);
    let problem = Problem::new(&base, Mesh::uniform(40)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory).expect("memory");
    assert_eq!(beam.solve(&Settings::default()).expect("settings").status, Status::Converged);
    assert_eq!(beam.adjoint(Output::AxialForce(0.5)).err(), Some(SensitivityError::Absent));
    let tangent = beam.tangent(Parameter::Transverse).expect("smooth");
    let (Output::Bending(x) | Output::Potential(x)) = output else { return [f64::NAN; 3] };
    let at = tangent.at(x);
    let field = if let Output::Bending(_) = output { at.bending } else { at.potential.unwrap_or_default() };
    let tangent = tangent.of(output).expect("an output");
    assert!((field - tangent).abs() <= tol::EXACT * tangent.abs(), "{field} {tangent}");
    let adjoint = beam.adjoint(output).expect("smooth").to(Parameter::Transverse).expect("a parameter");
    let step = 1e-4;
    [(value(1.0 + step) - value(1.0 - step)) / (2.0 * step), tangent, adjoint]
}

fn zones<M: Model<f64>>(scene: M) -> Vec<[f64; 2]> {
    let problem = Problem::new(scene, Mesh::uniform(40)).expect("a scene");
    problem.solve(&mut HeapWorkspace::new(), &Settings::default()).expect("settings").zones()
}

#[test]
fn conduction_without_compliance_is_a_foundation_of_its_own() {
    let beam = Beam { bending: 1.0, axial: (), piezo: (), permittivity: 1.0 };
    let ends = Potential { left: 0.5, right: 0.8 };
    let agree = |[difference, tangent, adjoint]: [f64; 3]| {
        let near = |a: f64| (a - difference).abs() <= tol::DERIVATIVE * difference.abs();
        assert!(difference != 0.0 && near(tangent) && near(adjoint), "{difference} {tangent} {adjoint}");
    };
    // The potential holds the beam; it charges the beam; both, behind a gap.
    let held = |load: f64| {
        Scene::new(1.0, beam)
            .conduction(Conduction { mu1: 300.0, mu2: (), truncation: 1.0, potential_truncation: 1.0 })
            .load(plain(50.0 * load))
            .potential(ends)
    };
    agree(by_differences(&held, Output::Bending(0.5)));
    let charged = |load: f64| {
        Scene::new(1.0, beam)
            .conduction(Conduction { mu1: (), mu2: 3.0, truncation: 1.0, potential_truncation: 1.0 })
            .load(plain(50.0 * load))
            .potential(ends)
    };
    agree(by_differences(&charged, Output::Potential(0.5)));
    let gap = Polynomial(&[0.0, 0.0, 0.5, -1.0, 0.5]);
    let varied = Beam { bending: 1.0, axial: (), piezo: (), permittivity: Function(|x: f64| 1.0 + x) };
    let both = |load: f64| {
        Scene::new(1.0, varied)
            .foundation(Foundation { law: (), gap })
            .conduction(Conduction { mu1: 300.0, mu2: 3.0, truncation: 1.0, potential_truncation: 1.0 })
            .load(plain(50.0 * load))
            .potential(ends)
    };
    agree(by_differences(&both, Output::Bending(0.5)));
    agree(by_differences(&both, Output::Potential(0.5)));
    assert_eq!(zones(held(1.0)), [[0.0, 1.0]]);
    assert!(zones(charged(-1.0)).is_empty());
    // Wherever there is any of a foundation, the gap is a field.
    let gaps = |fields: Vec<Fields<f64>>| fields.iter().map(|f| f.gap).collect::<Vec<_>>();
    assert_eq!(gaps(fields(held(1.0), Mesh::uniform(4), &[0.3]).1), [Some(0.0)]);
    assert_eq!(gaps(fields(charged(1.0), Mesh::uniform(4), &[0.3]).1), [Some(0.0)]);
    let free = Scene::new(1.0, beam).load(plain(1.0));
    assert_eq!(gaps(fields(free, Mesh::uniform(4), &[0.3]).1), [None]);
}

#[test]
fn contact_up_to_both_clamps_is_one_zone() {
    for k in [1e4, 1e8, 1e12] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(k), gap: Polynomial(&[0.0, 0.0, 1e-3, -2e-3, 1e-3]) })
            .load(Load { transverse: Function(|x: f64| 1e6 * (0.2 + x)), axial: (), points: () });
        let problem = Problem::new(scene, Mesh::uniform(50)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let solution = problem.solve(&mut memory, &Settings::default()).expect("settings");
        assert_eq!(solution.zones(), [[0.0, 1.0]], "{k:e}");
    }
}
