//! Many scenes at once are each solved as alone.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use allocation_counter::measure;
use common::{fields, fixed, points, tolerances as tol};
use piezobeam::{
    Batch, Beam, Conduction, Error, Fields, Foundation, Law, Linear, Load, Mesh, Model, Polynomial,
    Potential, Power, Scene, Settings, Status, Steps, Warning,
};
use proptest::prelude::*;

const SETTINGS: Settings<f64> = Settings { stop: 1e-10, max_visits: None };

/// A status, and fields at some points.
type Found = Result<(Status, Vec<Fields<f64>>), Error>;

/// All scenes solved in a batch.
fn together<M: Model<f64>, const L: usize>(scenes: &[M], mesh: &Mesh<'_, f64>) -> Vec<Found> {
    let mut batch = Batch::<f64, M, L>::new();
    let mut found = Vec::new();
    batch
        .solve(scenes, mesh, &SETTINGS, |i, solution| {
            assert_eq!(i, found.len());
            found.push(solution.map(|solution| {
                let x = points(30, solution.scene().length());
                (solution.report().status, x.iter().map(|&x| solution.at(x)).collect())
            }));
        })
        .expect("settings in range");
    found
}

/// Largest difference of bending, moment and potential, each over its largest value.
fn differ(a: &[Fields<f64>], b: &[Fields<f64>]) -> f64 {
    let columns: [fn(&Fields<f64>) -> f64; 3] =
        [|f| f.bending, |f| f.moment, |f| f.potential.unwrap_or_default()];
    columns.iter().fold(0.0, |worst: f64, get| {
        let column = |fields: &[Fields<f64>]| fields.iter().map(get).collect::<Vec<_>>();
        worst.max(common::relative(&column(a), &column(b)))
    })
}

/// Is each scene solved as alone?
fn as_alone<M: Model<f64> + Copy, const L: usize>(scenes: &[M], mesh: Mesh<'_, f64>) {
    for (scene, found) in scenes.iter().zip(together::<M, L>(scenes, &mesh)) {
        let (report, alone) = fields(*scene, mesh, &points(30, scene.length()));
        let (status, found) = found.expect("a sound scene");
        assert_eq!(status, report.status);
        let worst = differ(&found, &alone);
        assert!(worst < tol::BATCH, "{worst:e}");
    }
}

type Numbers = (f64, f64, [f64; 2], f64, f64);

proptest! {
    #![proptest_config(fixed(60))]

    #[test]
    fn scenes_of_all_stiffnesses_are_solved_as_alone(
        numbers in prop::collection::vec(
            (0.5..2.0_f64, -4.0..12.0_f64, prop::array::uniform2(-1.0..1.0_f64), -3.0..0.0_f64, -1.0..1.0_f64),
            1..12,
        ),
        n in 2..150_usize,
    ) {
        let numbers: Vec<Numbers> = numbers;
        let loads: Vec<[f64; 2]> = numbers.iter().map(|(_, _, [a, b], ..)| [1e3 * a, 1e3 * b]).collect();
        let humps: Vec<[f64; 5]> = numbers
            .iter()
            .map(|(.., size, sign)| [0.0, 0.0, 16.0, -32.0, 16.0].map(|c| c * sign * 10f64.powf(*size)))
            .collect();
        let scenes: Vec<_> = (numbers.iter().zip(&loads).zip(&humps))
            .map(|(((bending, stiffness, ..), values), hump)| {
                Scene::new(1.0, Beam::elastic(*bending))
                    .foundation(Foundation { law: Linear(10f64.powf(*stiffness)), gap: Polynomial(&hump[..]) })
                    .load(Load { transverse: Steps { breaks: &[0.4], values: &values[..] }, axial: (), points: () })
            })
            .collect();
        as_alone::<_, 4>(&scenes, Mesh::uniform(n));
        as_alone::<_, 3>(&scenes, Mesh::Graded { elements: n, ratio: 30.0 });
    }
}

/// The paper's beam with loads that differ, on a foundation of stiffness k.
fn soft(k: f64, load: f64) -> impl Model<f64> + Copy {
    Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(k), gap: () }).load(Load {
        transverse: load,
        axial: (),
        points: (),
    })
}

#[test]
fn soft_scenes_on_one_mesh_go_in_lockstep_and_stiff_ones_alone() {
    let mut batch = Batch::new();
    let joined = |batch: &mut Batch<f64, _, 4>, ks: &[f64]| {
        let scenes: Vec<_> = ks.iter().map(|&k| soft(k, 1e6)).collect();
        batch.prepare(&scenes, &Mesh::uniform(100)).expect("room").in_lockstep()
    };
    assert_eq!(joined(&mut batch, &[1e5, 1e6, 1e7, 1e8]), 4);
    assert_eq!(joined(&mut batch, &[1e16, 1e6, 1e12, 1e8]), 2);
    assert_eq!(joined(&mut batch, &[1e16]), 0);
    assert_eq!(joined(&mut batch, &[]), 0);
    as_alone::<_, 4>(&[1e16, 1e6, 1e12, 1e8, 0.0, 1e300].map(|k| soft(k, 1e6)), Mesh::uniform(100));
    as_alone::<_, 8>(&[0.0, 0.0, -1e6, 1e-300].map(|load| soft(1e8, load)), Mesh::uniform(33));
}

/// A lane without an answer in lockstep is solved alone and has those visits beside.
fn end_together<M: Model<f64>>(scenes: &[M; 4]) {
    let mesh = Mesh::uniform(100);
    let settings = Settings::default();
    let alone: usize =
        scenes.iter().map(|scene| fields(scene, mesh, &[]).0.element_visits).max().unwrap_or(0);
    let mut batch = Batch::<f64, _, 4>::new();
    let mut work = vec![];
    batch
        .solve(scenes, &mesh, &settings, |_, solution| {
            let report = *solution.expect("a scene").report();
            assert_eq!(report.status, Status::Converged);
            work.push((report.iterations, report.element_visits));
        })
        .expect("settings");
    assert!(work.iter().all(|of| *of == work[0]), "{work:?}");
    assert!(work[0].1 <= 2 * alone, "{work:?}, alone {alone}");
}

#[test]
fn soft_scenes_end_in_lockstep() {
    let loads = [1e6, -1e6, 2e5, 1e4];
    end_together(&loads.map(|load| soft(1e7, load)));
    end_together(&loads.map(|load| {
        Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e7), gap: 1e-3 })
            .load(Load { transverse: load, axial: (), points: () })
    }));
}

#[test]
fn what_cannot_go_in_lockstep_is_solved_alone() {
    let hertz = [1e6, 2e6].map(|load| {
        Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Power { stiffness: 1e9, exponent: 1.5 }, gap: () })
            .load(Load { transverse: load, axial: (), points: () })
    });
    as_alone::<_, 4>(&hertz, Mesh::uniform(50));
    let beam = Beam { bending: 5e3, axial: 1e5, piezo: 100.0, permittivity: 1.0 };
    let conducting = [1e6, 2e6].map(|load| {
        Scene::new(1.0, beam)
            .foundation(Foundation { law: Linear(1e8), gap: () })
            .conduction(Conduction::new(1.0, 1.0, 1.0))
            .potential(Potential { left: 1.0, right: 1.0 })
            .load(Load { transverse: load, axial: 1e6, points: () })
    });
    as_alone::<_, 4>(&conducting, Mesh::uniform(50));
    let charged = [1e6, 2e6].map(|load| {
        Scene::new(1.0, beam)
            .foundation(Foundation { law: Linear(1e8), gap: () })
            .conduction(Conduction { mu1: (), mu2: 1.0, truncation: 1.0, potential_truncation: 1.0 })
            .potential(Potential { left: 1.0, right: 1.0 })
            .load(Load { transverse: load, axial: 1e6, points: () })
    });
    as_alone::<_, 4>(&charged, Mesh::uniform(50));
    // Lengths, and so nodes, that differ.
    let lengths = [1.0, 2.0, 1.0].map(|length| {
        Scene::new(length, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e4), gap: 1e-3 })
            .load(Load { transverse: 1e4, axial: (), points: () })
    });
    as_alone::<_, 4>(&lengths, Mesh::uniform(50));
}

#[test]
fn one_bad_scene_does_not_keep_the_others() {
    let scenes = [1e6, f64::NAN, 2e6].map(|load| soft(1e8, load));
    let found = together::<_, 4>(&scenes, &Mesh::uniform(20));
    assert!(matches!(found[1], Err(Error::Value { field: "load.transverse", .. })), "{:?}", found[1]);
    assert!(found[0].is_ok() && found[2].is_ok());
}

#[test]
fn more_scenes_than_lanes_are_refused_and_settings_checked() {
    let scenes = [1e6; 5].map(|load| soft(1e8, load));
    let mut batch = Batch::<f64, _, 4>::new();
    let mesh = Mesh::uniform(20);
    assert!(matches!(batch.prepare(&scenes, &mesh), Err(Error::Capacity { needed: 5, available: 4 })));
    let bad = Settings { stop: 2.0, max_visits: None };
    assert!(matches!(batch.solve(&scenes, &mesh, &bad, |_, _| ()), Err(Error::Value { field: "stop", .. })));
    let mut group = batch.prepare(&scenes[..2], &mesh).expect("room");
    assert!(group.solution(0).is_err(), "not solved yet");
    let few = Settings { max_visits: Some(30), ..SETTINGS };
    group.solve(&few).expect("settings in range");
    let report = *group.solution(1).expect("solved").report();
    assert!(report.status == Status::VisitLimit && report.element_visits <= 30, "{report:?}");
    assert!(group.solution(2).is_err() && !group.is_empty());
}

#[test]
fn a_group_is_solved_again_with_the_same_bits_and_without_an_allocation() {
    let scenes = [1e6, 2e6, -1e6, 1e5].map(|load| soft(1e8, load));
    let mut batch = Batch::<f64, _, 4>::new();
    let mesh = Mesh::uniform(100);
    let mut group = batch.prepare(&scenes, &mesh).expect("room");
    group.solve(&SETTINGS).expect("settings in range");
    let before: Vec<_> = (0..4).map(|l| group.solution(l).map(|s| s.at(0.3))).collect();
    let counted = measure(|| {
        let _ = group.solve(&SETTINGS);
    });
    assert_eq!(counted.count_total, 0);
    let after: Vec<_> = (0..4).map(|l| group.solution(l).map(|s| s.at(0.3))).collect();
    assert_eq!(before, after);
}

#[test]
fn single_precision_goes_in_lockstep_too() {
    let scenes = [1e6_f32, 2e6, 3e6].map(|load| {
        Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e8), gap: () })
            .load(Load { transverse: load, axial: (), points: () })
    });
    let mut batch = Batch::<f32, _, 8>::new();
    let mut group = batch.prepare(&scenes, &Mesh::uniform(40)).expect("room");
    group.solve(&Settings::default()).expect("settings in range");
    assert_eq!(group.in_lockstep(), 3);
    for (l, load) in [1e6, 2e6, 3e6].into_iter().enumerate() {
        let solution = group.solution(l).expect("solved");
        assert_eq!(solution.report().status, Status::Converged);
        let (_, double) = fields(soft(1e8, load), Mesh::uniform(40), &[0.5]);
        assert!((f64::from(solution.at(0.5).bending) / double[0].bending - 1.0).abs() < 1e-4);
    }
}

#[test]
fn the_cap_on_visits_holds_on_a_mesh_too_small_for_coarser_ones() {
    let scenes = [1e6, -1e6, 1e4].map(|load| soft(1e8, load));
    let mut batch = Batch::<f64, _, 4>::new();
    for most in (40..1100).step_by(35) {
        let mut group = batch.prepare(&scenes, &Mesh::uniform(40)).expect("room");
        group.solve(&Settings { max_visits: Some(most), ..SETTINGS }).expect("settings in range");
        for l in 0..3 {
            let report = *group.solution(l).expect("solved").report();
            assert!(report.element_visits <= most, "{most}: {report:?}");
        }
    }
}

#[test]
fn a_default_batch_is_a_new_one_and_a_group_of_none_is_empty() {
    let scenes = [1e6; 4].map(|load| soft(1e8, load));
    let mut batch = Batch::<f64, _, 4>::default();
    assert_eq!(batch.prepare(&scenes[..0], &Mesh::uniform(20)).map(|group| group.len()), Ok(0));
    assert_eq!(batch.prepare(&scenes, &Mesh::uniform(20)).map(|group| group.len()), Ok(4));
}

#[test]
fn a_group_on_a_rigid_foundation_is_solved_again_with_the_same_bits() {
    let transverse = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
    let scenes =
        [1e6, 1e300].map(|k| {
            Scene::new(1.0, Beam::elastic(5000.0))
                .foundation(Foundation { law: Linear(k), gap: () })
                .load(Load { transverse, axial: (), points: () })
        });
    let mut batch = Batch::<f64, _, 2>::new();
    let mut group = batch.prepare(&scenes, &Mesh::uniform(40)).expect("room");
    let mut once = || {
        group.solve(&SETTINGS).expect("settings in range");
        [0, 1].map(|lane| {
            let solution = group.solution(lane).expect("solved");
            (
                *solution.report(),
                solution.at(0.3),
                solution.warnings().iter().any(|warning| matches!(warning, Warning::Rigid { .. })),
            )
        })
    };
    let first = once();
    assert!(first.iter().all(|(report, ..)| report.status == Status::Converged));
    assert!(first[1].2, "taken as rigid, and said");
    assert_eq!(once(), first);
}

#[test]
fn abrupt_meshes_go_in_lockstep_too() {
    // From short elements to long ones: the part on the left outweighs the next element.
    let nodes: Vec<f64> = (0..=20)
        .map(|i| 1e-5 * f64::from(i))
        .chain((1..=20).map(|i| 2e-4 + 0.04999 * f64::from(i)))
        .collect();
    let last = nodes.len() - 1;
    let nodes: Vec<f64> = nodes.iter().enumerate().map(|(i, &x)| if i == last { 1.0 } else { x }).collect();
    let scenes = [1e6, 5e5, -1e6].map(|load| soft(1e6, load));
    let mut batch = Batch::<f64, _, 4>::new();
    let mesh = Mesh::Nodes(&nodes);
    assert_eq!(batch.prepare(&scenes, &mesh).expect("room").in_lockstep(), 3);
    as_alone::<_, 4>(&scenes, mesh);
}

#[test]
fn a_law_that_fails_in_one_lane_does_not_spoil_the_others() {
    let scenes = [1e3, 2e3, 3e4].map(|load| {
        // No number where the third beam presses.
        let law = Law(|_: f64, r: f64| if r > 5.0 { (f64::NAN, 1.0) } else { (r, 1.0) });
        Scene::new(1.0, Beam::elastic(5.0)).foundation(Foundation { law, gap: () }).load(Load {
            transverse: load,
            axial: (),
            points: (),
        })
    });
    let ends = |found: &Found| found.as_ref().map(|(status, _)| *status).map_err(|&error| error);
    let found = together::<_, 4>(&scenes, &Mesh::uniform(32));
    assert_eq!(ends(&found[0]), Ok(Status::Converged));
    assert_eq!(ends(&found[1]), Ok(Status::Converged));
    assert!(matches!(ends(&found[2]), Ok(Status::LawNotFinite { .. })), "{:?}", ends(&found[2]));
    as_alone::<_, 4>(&scenes[..2], Mesh::uniform(32));
}

#[test]
fn a_potential_beyond_the_number_format_is_no_solution_in_a_batch_either() {
    let scenes = [1e6, 5e5].map(|load| {
        Scene::new(1.0, Beam { bending: 5e3, axial: (), piezo: (), permittivity: 1e-300 })
            .foundation(Foundation { law: Linear(1e6), gap: () })
            .conduction(Conduction { mu1: (), mu2: 1e300, truncation: 1.0, potential_truncation: 1.0 })
            .potential(Potential { left: 1.0, right: 1.0 })
            .load(Load { transverse: load, axial: (), points: () })
    });
    for (scene, found) in scenes.iter().zip(together::<_, 2>(&scenes, &Mesh::uniform(32))) {
        let (status, _) = found.expect("a sound scene");
        let (report, _) = fields(*scene, Mesh::uniform(32), &[0.5]);
        assert_eq!(status, report.status);
        assert!(matches!(status, Status::Breakdown { .. }), "{status:?}");
    }
}
