//! Memory: what is absent costs nothing, and a solve allocates nothing.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use allocation_counter::measure;
use common::named;
use piezobeam::{
    Beam, Conduction, Error, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, Output, Parameter,
    PointLoad, Potential, Power, Prepared, Problem, Report, Scene, Settings, Status, Steps, Storage,
    Workspace,
};

/// Bytes per element of a scene of this type.
fn per_element<M: Model<f64>>(_: &M) -> usize {
    assert_eq!(Workspace::<f64, M, 7>::BYTES_PER_ELEMENT, HeapWorkspace::<f64, M>::BYTES_PER_ELEMENT);
    assert_eq!(size_of::<Workspace<f64, M, 7>>(), 7 * Workspace::<f64, M, 7>::BYTES_PER_ELEMENT);
    Workspace::<f64, M, 7>::BYTES_PER_ELEMENT
}

/// Solves twice what was prepared, and counts allocations.
fn solve_counted<M: Model<f64>>(
    prepared: &mut Prepared<'_, f64, M>,
    settings: &Settings<f64>,
) -> Report<f64> {
    let mut reports = [None; 2];
    let counted = measure(|| {
        for report in &mut reports {
            *report = prepared.solve(settings).ok();
        }
    });
    assert_eq!(counted.count_total, 0, "allocations during a solve");
    assert_eq!(reports[0], reports[1]);
    reports[0].expect("settings in range")
}

fn full() -> impl Model<f64> {
    let beam = Beam { bending: 1.0, axial: 1.0, piezo: 0.5, permittivity: 1.0 };
    Scene::new(1.0, beam)
        .foundation(Foundation { law: Power { stiffness: 50.0, exponent: 1.5 }, gap: 0.01 })
        .conduction(Conduction::new(10.0, 4.0, 0.05))
        .load(Load {
            transverse: Steps { breaks: &[0.6], values: &[300.0, -400.0] },
            axial: 1.0,
            points: [PointLoad { x: 0.3, force: 1.0, moment: 1.0 }],
        })
        .potential(Potential { left: 0.2, right: 0.9 })
}

#[test]
fn the_counter_counts() {
    assert!(measure(|| drop(std::hint::black_box(vec![1_u8; 100]))).count_total > 0);
}

#[test]
fn a_solve_with_memory_on_the_heap_allocates_nothing() {
    let problem = Problem::new(full(), Mesh::uniform(300)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory).expect("memory that grows");
    let report = solve_counted(&mut prepared, &Settings::default());
    assert_eq!(report.status, Status::Converged, "{report:?}");
    assert_eq!(report.elements, 300);
}

#[test]
fn a_solve_that_fails_allocates_nothing() {
    for (name, most) in [("stubborn", None), ("sweep-1e16", Some(500))] {
        let case = named(name);
        let problem = Problem::new(&case.scene, Mesh::uniform(100)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let mut prepared = problem.prepare(&mut memory).expect("memory that grows");
        let report = solve_counted(&mut prepared, &Settings { max_visits: most, ..Settings::default() });
        assert!(name == "stubborn" || report.status == Status::VisitLimit, "{report:?}");
    }
}

#[test]
fn derivatives_allocate_nothing() {
    let problem = Problem::new(full(), Mesh::uniform(100)).expect("a scene");
    let mut memory = problem.workspace::<140>();
    let mut prepared = problem.prepare(&mut memory).expect("room");
    let report = prepared.solve(&Settings::default()).expect("settings in range");
    assert_eq!(report.status, Status::Converged, "{report:?}");
    let mut found = [0.0; 4];
    let counted = measure(|| {
        let (outputs, parameters) =
            ([Output::Bending(0.5), Output::ContactForce], [Parameter::Gap, Parameter::PointMoment(0)]);
        if prepared.derivatives(&outputs, &parameters, &mut found).is_err() {
            return;
        }
        let Ok(adjoint) = prepared.adjoint(Output::Potential(0.3)) else { return };
        found[3] = adjoint.influence(0.7) + adjoint.to(Parameter::Mu1).unwrap_or_default();
        if prepared.grazing() != Ok(None) {
            found = [0.0; 4];
        }
    });
    assert_eq!(counted.count_total, 0);
    assert!(found.iter().all(|&v| v != 0.0), "{found:?}");
}

#[test]
fn with_memory_on_the_stack_nothing_at_all_is_allocated() {
    let mut middle = None;
    let counted = measure(|| {
        let Ok(problem) = Problem::new(full(), Mesh::uniform(100)) else { return };
        let mut memory = problem.workspace::<140>();
        let Ok(solution) = problem.solve(&mut memory, &Settings::default()) else { return };
        let mut zones = 0;
        solution.for_each_zone(|_, _| zones += 1);
        let unique = solution.uniqueness().certified;
        let warnings = solution.warnings().len();
        let nodes = solution.nodes().count();
        let force = solution.resultants().contact_force;
        middle =
            Some((solution.report().status, solution.at(0.3).bending, zones, unique, warnings, nodes, force));
    });
    assert_eq!(counted.count_total, 0);
    let (status, bending, zones, _, _, nodes, force) = middle.expect("a solution");
    assert_eq!((status, zones, nodes), (Status::Converged, 1, 101));
    assert!(bending > 0.0 && force > 0.0);
}

#[test]
fn stack_and_heap_give_the_same_bits() {
    let problem = Problem::new(full(), Mesh::uniform(100)).expect("a scene");
    let (mut stack, mut heap) = (problem.workspace::<200>(), HeapWorkspace::new());
    let on = |memory: &mut dyn Storage<f64, _>| {
        let solution = problem.solve(memory, &Settings::default()).expect("enough memory");
        (*solution.report(), [0.1, 0.33, 0.8].map(|x| solution.at(x)))
    };
    assert_eq!(on(&mut stack), on(&mut heap));
}

#[test]
fn memory_for_the_mesh_alone_is_enough() {
    let problem = Problem::new(full(), Mesh::uniform(100)).expect("a scene");
    let mut memory = problem.workspace::<100>();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("enough memory");
    assert_eq!(solution.report().status, Status::Converged, "{:?}", solution.report());
}

#[test]
fn an_element_takes_more_room_the_more_the_scene_has() {
    let bending = Scene::new(1.0, Beam::elastic(1.0)).load(Load { transverse: 1.0, axial: (), points: () });
    let contact = bending.foundation(Foundation { law: Linear(1.0), gap: () });
    let gap = bending.foundation(Foundation { law: Linear(1.0), gap: 0.1 });
    let sizes = [per_element(&bending), per_element(&contact), per_element(&gap), per_element(&full())];
    assert!(sizes.is_sorted_by(|a, b| a < b), "{sizes:?}");
    // A law without coefficients to sample, loads and potentials cost an element nothing.
    assert_eq!(per_element(&bending), per_element(&Scene::new(1.0, Beam::elastic(1.0))));
    assert_eq!(per_element(&bending), per_element(&bending.potential(Potential { left: 1.0, right: 2.0 })));
    let single = Scene::new(1.0_f32, Beam::elastic(1.0_f32));
    fn per_single<M: Model<f32>>(_: &M) -> usize {
        Workspace::<f32, M, 1>::BYTES_PER_ELEMENT
    }
    assert!(per_single(&single) < per_element(&bending));
}

#[test]
fn absent_parts_take_no_room() {
    let number = size_of::<f64>();
    assert_eq!(size_of_val(&Beam::elastic(1.0)), number);
    assert_eq!(size_of_val(&Scene::new(1.0, Beam::elastic(1.0))), 2 * number);
    let scene = Scene::new(1.0, Beam::elastic(1.0)).foundation(Foundation { law: Linear(1.0), gap: () });
    assert_eq!(size_of_val(&scene), 3 * number);
    assert_eq!(size_of_val(&scene.load(Load { transverse: 1.0, axial: (), points: () })), 4 * number);
    assert_eq!(size_of_val(&Load { transverse: (), axial: (), points: () }), 0);
    assert_eq!(size_of_val(&Foundation { law: (), gap: () }), 0);
}

#[test]
fn default_memory_is_new_memory() {
    let scene = full();
    let problem = Problem::new(&scene, Mesh::uniform(40)).expect("a scene without mistakes");
    let report = |memory: &mut dyn Storage<f64, _>| {
        *problem.solve(memory, &Settings::default()).expect("settings in range").report()
    };
    let mut fixed = Workspace::<f64, _, 128>::default();
    let mut heap = HeapWorkspace::default();
    assert_eq!(report(&mut fixed), report(&mut heap));
}

#[test]
fn a_problem_moves_to_another_mesh_and_checks_it() {
    let on = |elements: usize| {
        Problem::new(full(), Mesh::uniform(4)).and_then(|problem| problem.on(Mesh::uniform(elements)))
    };
    let moved = on(60).expect("a mesh");
    let made = Problem::new(full(), Mesh::uniform(60)).expect("a scene without mistakes");
    let (mut one, mut other) = (HeapWorkspace::new(), HeapWorkspace::new());
    let settings = Settings::default();
    let moved = moved.solve(&mut one, &settings).expect("settings in range");
    let made = made.solve(&mut other, &settings).expect("settings in range");
    assert_eq!((moved.report(), moved.at(0.3)), (made.report(), made.at(0.3)));
    assert!(matches!(on(0).err(), Some(Error::Value { field: "mesh.elements", .. })));
}

#[test]
fn what_nothing_touches_has_no_contact_zone() {
    let scene = Scene::new(1.0, Beam::elastic(1.0)).load(Load { transverse: 1.0, axial: (), points: () });
    let problem = Problem::new(scene, Mesh::uniform(4)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    solution.for_each_zone(|a, b| unreachable!("{a} {b}"));
    assert!(solution.zones().is_empty());
}
