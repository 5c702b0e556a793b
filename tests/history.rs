//! Scenes one after the other, each from the last solution.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{fields, points, tolerances as tol};
use piezobeam::{
    Beam, Conduction, Error, Fields, Foundation, HeapWorkspace, History, Linear, Load, Mesh, Model,
    Polynomial, Potential, Report, Scene, Settings, Status, Steps,
};
use proptest::prelude::*;

const N: usize = 1000;

/// Report and fields of a scene that follows others.
fn follow<M: Model<f64>>(
    history: &mut History<'_, f64, M, HeapWorkspace<f64, M>>,
    scene: &M,
) -> Result<(Report<f64>, Vec<Fields<f64>>), Error> {
    let solution = history.solve(scene, &Settings::default())?;
    let at = points(40, scene.length()).iter().map(|&x| solution.at(x)).collect();
    Ok((*solution.report(), at))
}

/// Largest difference of bending and moment, each over its largest value.
fn differ(a: &[Fields<f64>], b: &[Fields<f64>]) -> f64 {
    [|f: &Fields<f64>| f.bending, |f: &Fields<f64>| f.moment].iter().fold(0.0, |worst: f64, get| {
        let (a, b): (Vec<f64>, Vec<f64>) = (a.iter().map(get).collect(), b.iter().map(get).collect());
        worst.max(common::relative(&a, &b))
    })
}

#[test]
fn nothing_new_costs_the_check_alone() {
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e8), gap: () })
        .load(Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () });
    let mut memory = HeapWorkspace::new();
    let mut history = History::new(Mesh::uniform(N), &mut memory);
    let (cold, first) = follow(&mut history, &scene).expect("a scene");
    let (warm, again) = follow(&mut history, &scene).expect("a scene");
    assert_eq!((cold.status, warm.status), (Status::Converged, Status::Converged));
    assert!(cold.element_visits > 2 * N, "{cold:?}");
    assert!(warm.element_visits <= 2 * N, "{warm:?}");
    assert_eq!(warm.iterations, 0);
    assert_eq!(first, again);
}

#[test]
fn a_patch_of_load_that_moves_costs_the_patch_and_the_check() {
    let base = Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e8), gap: () });
    // All breaks stay, so that the nodes do; the load moves by a hundredth.
    let breaks: Vec<f64> = (1..100).map(|i| f64::from(i) / 100.0).collect();
    let patch = |at: usize| -> Vec<f64> { (0..100).map(|i| if i == at { 2e4 } else { 1e3 }).collect() };
    let patches: Vec<Vec<f64>> = (40..60).map(patch).collect();
    let mut memory = HeapWorkspace::new();
    let mut history = History::new(Mesh::uniform(N), &mut memory);
    for (at, values) in patches.iter().enumerate() {
        let load = Load { transverse: Steps { breaks: &breaks, values }, axial: (), points: () };
        let scene = base.load(load);
        let (warm, fields) = follow(&mut history, &scene).expect("a scene");
        let (_, want) = common::fields(scene, Mesh::uniform(N), &points(40, 1.0));
        // The residual is checked everywhere; the first steps condense what the cold start left.
        assert!(at < 3 || warm.element_visits <= N + 100, "{at}: {warm:?}");
        assert_eq!(warm.status, Status::Converged, "{warm:?}");
        assert!(differ(&fields, &want) < tol::HISTORY, "{at}: {:e}", differ(&fields, &want));
    }
}

#[test]
fn a_change_that_is_wrong_is_an_error_and_the_next_scene_starts_anew() {
    let scene = |stiffness: f64| {
        Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(stiffness), gap: () })
            .load(Load { transverse: 1e6, axial: (), points: () })
    };
    let mut memory = HeapWorkspace::new();
    let mut history = History::new(Mesh::uniform(100), &mut memory);
    let (cold, want) = follow(&mut history, &scene(1e8)).expect("a scene");
    assert!(follow(&mut history, &scene(-1.0)).is_err());
    let (again, got) = follow(&mut history, &scene(1e8)).expect("a scene");
    assert_eq!((cold, want), (again, got));
    history.forget();
    let (again, _) = follow(&mut history, &scene(1e8)).expect("a scene");
    assert_eq!(cold, again);
}

#[test]
fn other_nodes_are_another_beginning() {
    let base = Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e8), gap: () });
    let mut memory = HeapWorkspace::new();
    let mut history = History::new(Mesh::uniform(64), &mut memory);
    for breaks in &[[0.5], [0.3], [0.7], [0.75]] {
        let load = Load { transverse: Steps { breaks, values: &[1e6, -1e6] }, axial: (), points: () };
        let (report, got) = follow(&mut history, &base.load(load)).expect("a scene");
        let (fresh, want) = fields(base.load(load), Mesh::uniform(64), &points(40, 1.0));
        assert_eq!(report, fresh);
        assert_eq!(got, want);
    }
}

#[derive(Clone, Debug)]
struct Step {
    stiffness: f64,
    gap: f64,
    load: [f64; 2],
    ends: [f64; 2],
    truncation: f64,
}

prop_compose! {
    fn step()(
        stiffness in prop_oneof![Just(0.0), (2.0..10.0_f64).prop_map(|x| 10f64.powf(x))],
        gap in prop_oneof![Just(0.0), -1e-2..1e-1_f64],
        load in prop::array::uniform2(-1e6..1e6_f64),
        ends in prop::array::uniform2(-2.0..2.0_f64),
        truncation in 0.01..1.0_f64,
    ) -> Step {
        Step { stiffness, gap, load, ends, truncation }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn any_start_ends_in_the_one_solution(
        steps in prop::collection::vec(step(), 2..6),
        n in 4..200_usize,
        mu1 in prop_oneof![Just(0.0), Just(1.0)],
        mu2 in prop_oneof![Just(0.0), Just(1.0)],
    ) {
        let shapes: Vec<[f64; 5]> =
            steps.iter().map(|s| [0.0, 0.0, 16.0 * s.gap, -32.0 * s.gap, 16.0 * s.gap]).collect();
        let mut memory = HeapWorkspace::new();
        let mut history = History::new(Mesh::uniform(n), &mut memory);
        for (s, gap) in steps.iter().zip(&shapes) {
            let scene = Scene::new(
                1.0,
                Beam { bending: 5000.0, axial: 1e5, piezo: 100.0, permittivity: 1.0 },
            )
            .foundation(Foundation { law: Linear(s.stiffness), gap: Polynomial(gap) })
            .conduction(Conduction::new(mu1, mu2, s.truncation))
            .load(Load { transverse: Steps { breaks: &[0.4], values: &s.load }, axial: 1e5, points: () })
            .potential(Potential { left: s.ends[0], right: s.ends[1] });
            let (report, got) = follow(&mut history, &scene).expect("a scene");
            let (fresh, want) = fields(scene, Mesh::uniform(n), &points(40, 1.0));
            prop_assert_eq!(fresh.status, Status::Converged);
            prop_assert_eq!(report.status, Status::Converged);
            let gap = differ(&got, &want);
            prop_assert!(gap < tol::HISTORY, "{gap:e}");
        }
    }
}

#[test]
fn one_element_takes_the_gap_at_its_clamps_from_each_scene() {
    let mut memory = HeapWorkspace::new();
    let mut history = History::new(Mesh::uniform(1), &mut memory);
    for gap in [0.0, 1.0, 100.0] {
        let scene = Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e4), gap });
        let (report, at) = follow(&mut history, &scene).expect("a scene");
        assert_eq!(report.status, Status::Converged, "{report:?}");
        assert!(at.iter().all(|f| f.bending.abs() <= 1e-12 * gap), "{gap}");
    }
}

#[test]
fn a_cap_on_visits_holds_for_both_attempts_together() {
    let scene = |load: f64| {
        Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e8), gap: 1e-3 })
            .load(Load { transverse: load, axial: (), points: () })
    };
    let mut memory = HeapWorkspace::new();
    let mut history = History::new(Mesh::uniform(100), &mut memory);
    for cap in [150, 250, 400, 1000] {
        for load in [1e6, -1e6, 1.2e6, 0.0] {
            let settings = Settings { max_visits: Some(cap), ..Settings::default() };
            let scene = scene(load);
            let report = *history.solve(&scene, &settings).expect("a scene").report();
            assert!(report.element_visits <= cap, "{cap}: {report:?}");
        }
    }
}
