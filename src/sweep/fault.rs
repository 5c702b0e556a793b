//! The n-th factorisation made to fail, for every n: a solve ends with a status that says so, or goes another way, and
//! the next solve in the same memory gives the bits of one in fresh memory. In tests only.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use crate::{
    Beam, Conduction, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, Output, Parameter, Potential,
    Problem, Reached, Report, Scene, SensitivityError, Settings, Solution, Status, Steps,
};
use std::cell::Cell;
use std::vec::Vec;

std::thread_local! {
    /// Factorisations so far, and the one that fails; 0: none.
    static COUNT: Cell<(usize, usize)> = const { Cell::new((0, 0)) };
}

/// `None` at the factorisation that is due to fail.
pub(crate) fn strike() -> Option<()> {
    let (count, due) = COUNT.get();
    COUNT.set((count + 1, due));
    (count + 1 != due).then_some(())
}

/// From now on the `due`-th factorisation fails, and with 0 none; returns how many there were before.
fn set(due: usize) -> usize {
    COUNT.replace((0, due)).0
}

fn bits<M: Model<f64>>(solution: &Solution<'_, f64, M>) -> (Report<f64>, Vec<u64>) {
    let mut bits = Vec::new();
    for i in 0..=16 {
        let f = solution.at(f64::from(i) / 16.0 * solution.scene().length());
        bits.extend([f.bending, f.slope, f.moment, f.shear].map(f64::to_bits));
        bits.extend(f.potential.map(f64::to_bits));
    }
    (*solution.report(), bits)
}

/// Solves, and differentiates, with every factorisation failing in turn.
fn fail_each<M: Model<f64>>(scene: &M, elements: usize) {
    let settings = Settings::default();
    let problem = Problem::new(scene, Mesh::uniform(elements)).unwrap();
    let mut fresh = HeapWorkspace::new();
    set(0);
    let solution = problem.solve(&mut fresh, &settings).unwrap();
    let count = set(0);
    assert_eq!(solution.report().status, Status::Converged);
    let want = bits(&solution);
    let mut memory = HeapWorkspace::new();
    let mut broken = 0;
    for due in 1..=count {
        set(due);
        let status = problem.solve(&mut memory, &settings).unwrap().report().status;
        set(0);
        match status {
            Status::Breakdown { element } => {
                assert!(element < elements);
                broken += 1;
            }
            // Stages of the continuation, and steps that have a way back, may fail without harm.
            other => assert_eq!(other, Status::Converged, "factorisation {due} of {count}"),
        }
        let again = problem.solve(&mut memory, &settings).unwrap();
        assert!(bits(&again) == want, "the solve after factorisation {due} failed is another");
    }
    assert!(broken > 0, "none of {count} factorisations was missed");

    let mut prepared = problem.prepare(&mut memory).unwrap();
    prepared.solve(&settings).unwrap();
    set(0);
    let derivatives = |prepared: &mut crate::Prepared<'_, f64, &M>| {
        let by_load = prepared.tangent(Parameter::Transverse)?.of(Output::LeftMoment);
        let of_moment = prepared.adjoint(Output::LeftMoment)?.to(Parameter::Transverse);
        Ok::<_, SensitivityError>([by_load, of_moment].map(|d: Option<f64>| d.map(f64::to_bits)))
    };
    let want = derivatives(&mut prepared).unwrap();
    let count = set(0);
    for due in 1..=count {
        set(due);
        let failed = derivatives(&mut prepared);
        set(0);
        assert!(failed.is_err(), "factorisation {due} of {count}");
        assert_eq!(derivatives(&mut prepared).unwrap(), want, "after factorisation {due}");
    }
    assert!(bits(&prepared.last().unwrap()) == bits(&problem.solve(&mut fresh, &settings).unwrap()));

    // A mesh for an accuracy: of these many, some.
    set(0);
    let found = problem.solve_to(&mut fresh, 1e-6, &settings).unwrap();
    let (want, count) = (bits(&found.solution), set(0));
    assert_eq!(found.reached, Reached::Tolerance);
    for due in (1..=count).step_by(count / 50 + 1) {
        set(due);
        let found = problem.solve_to(&mut memory, 1e-6, &settings).unwrap();
        set(0);
        match found.solution.report().status {
            Status::Breakdown { .. } => assert_eq!(found.reached, Reached::Unsolved),
            status => assert_eq!((status, found.reached), (Status::Converged, Reached::Tolerance)),
        }
        let again = problem.solve_to(&mut memory, 1e-6, &settings).unwrap();
        assert!(bits(&again.solution) == want, "the mesh after factorisation {due} failed is another");
    }
}

#[test]
fn of_bending() {
    let transverse = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
    let load = Load { transverse, axial: (), points: () };
    let scene = Scene::new(1.0, Beam::elastic(5000.0)).load(load);
    fail_each(&scene, 7);
    for (stiffness, elements) in [(1e8, 7), (1e12, 50)] {
        let law = Linear(stiffness);
        fail_each(&scene.foundation(Foundation { law, gap: 1e-4 }), elements);
    }
}

#[test]
fn of_bending_and_potential() {
    let beam = Beam { bending: 50.0, axial: 1e5, piezo: 100.0, permittivity: 1.0 };
    for (mu1, left) in [(1.0, 1.0), (1e5, -1.0)] {
        let scene = Scene::new(1.0, beam)
            .foundation(Foundation { law: Linear(1e6), gap: 0.0 })
            .conduction(Conduction::new(mu1, 10.0, 1.0))
            .load(Load { transverse: 1e4, axial: 1e4, points: () })
            .potential(Potential { left, right: 1.0 });
        fail_each(&scene, 8);
    }
}
