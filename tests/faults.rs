//! Faults inside a solve: a callback that fails at the n-th call, memory that ends at the n-th place, work that is cut off
//! at the n-th visit, for every n. Each ends as an error or a status that says so, and leaves nothing behind:
//! the next solve in the same memory gives the bits of one in fresh memory.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{honest, plain, points, tolerances as tol};
use piezobeam::{
    Beam, Compliance, Conduction, Curve, Error, Foundation, Function, HeapWorkspace, History, Law, Linear,
    Load, Mesh, Model, Potential, Problem, Reached, Report, Scene, Settings, Solution, Status, StoragePlace,
};
use std::cell::Cell;

/// Counts calls; the one that is due fails.
#[derive(Default)]
struct Fuse {
    calls: Cell<usize>,
    due: Cell<usize>,
}

impl Fuse {
    /// The next `due`-th call will fail; with 0 none.
    fn set(&self, due: usize) {
        self.calls.set(0);
        self.due.set(due);
    }

    fn blows(&self) -> bool {
        self.calls.set(self.calls.get() + 1);
        self.calls.get() == self.due.get()
    }

    fn or(&self, bad: f64, good: f64) -> f64 {
        if self.blows() { bad } else { good }
    }
}

/// All bits of a solution that a user can see.
fn bits<M: Model<f64>>(solution: &Solution<'_, f64, M>) -> (Report<f64>, Vec<u64>) {
    let mut bits = Vec::new();
    for x in points(24, solution.scene().length()) {
        let f = solution.at(x);
        let perhaps = [f.stretching, f.potential, f.axial_force, f.electric_displacement, f.pressure];
        bits.extend([f.bending, f.slope, f.moment, f.shear].map(f64::to_bits));
        bits.extend(perhaps.into_iter().flatten().map(f64::to_bits));
    }
    (*solution.report(), bits)
}

/// What is called converged is; nothing else is asked of other ends, but that they have a name.
fn is_honest<M: Model<f64>>(solution: &Solution<'_, f64, M>) {
    let report = *solution.report();
    if report.status == Status::Converged {
        let found = honest::departure(solution);
        let worst = [found.moment, found.bending, found.flux, found.electric, found.law];
        assert!(found.finite && worst.into_iter().all(|d| d <= tol::HONEST), "{found:?} {report:?}");
        assert!(found.tension <= 0.0, "{found:?} {report:?}");
    }
    assert!(!report.status.name().is_empty());
}

/// Solves with the fuse due at every call in turn, and after each without it in the same memory; returns the ends.
fn blow_at_every_call<M: Model<f64>>(
    scene: &M,
    fuse: &Fuse,
    mesh: Mesh<'_, f64>,
) -> Vec<Result<Status, Error>> {
    let settings = Settings::default();
    let problem = Problem::new(scene, mesh).expect("a scene");
    fuse.set(0);
    let mut fresh = HeapWorkspace::new();
    let solution = problem.solve(&mut fresh, &settings).expect("a solution");
    let calls = fuse.calls.get();
    assert_eq!(solution.report().status, Status::Converged);
    let want = bits(&solution);
    let mut memory = HeapWorkspace::new();
    let mut ends = Vec::new();
    for due in 1..=calls {
        fuse.set(due);
        let solution = problem.solve(&mut memory, &settings);
        fuse.set(0);
        ends.push(solution.map(|solution| {
            is_honest(&solution);
            solution.report().status
        }));
        let again = problem.solve(&mut memory, &settings).expect("a solution");
        assert!(bits(&again) == want, "the solve after call {due} failed is another");
    }
    ends
}

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn profiles_that_fail_at_any_call() {
    for bad in BAD {
        for which in 0..6 {
            let fuse = Fuse::default();
            // Only one of the callbacks is on the fuse.
            let at = |i: usize, good: f64| if i == which { fuse.or(bad, good) } else { good };
            let scene = Scene::new(
                1.0,
                Beam {
                    bending: Function(|x: f64| at(0, 5000.0 + 100.0 * x)),
                    axial: Function(|x: f64| at(1, 1e5 + x)),
                    piezo: 100.0,
                    permittivity: Function(|x: f64| at(2, 1.0 + x)),
                },
            )
            .foundation(Foundation {
                law: Linear(Function(|x: f64| at(3, 1e8 + x))),
                gap: Curve(|x: f64| [at(4, 1e-3 * x), 1e-3, 0.0]),
            })
            .conduction(Conduction::new(Function(|x: f64| at(5, 1.0 + x)), 1.0, 1.0))
            .load(Load { transverse: Function(|x: f64| 1e6 * (1.0 - 2.0 * x)), axial: 1e6, points: () })
            .potential(Potential { left: 1.0, right: 0.0 });
            let fields = [
                "beam.bending",
                "beam.axial",
                "beam.permittivity",
                "foundation.stiffness",
                "foundation.gap",
                "conduction.mu1",
            ];
            let ends = blow_at_every_call(&scene, &fuse, Mesh::uniform(6));
            let mut refused = 0;
            for end in ends {
                if let Err(error) = end {
                    assert!(error.to_string().starts_with(fields[which]), "{error}");
                    refused += 1;
                }
            }
            // Four samples of an element, those of a gap's value at two nodes.
            let least = if which == 4 { 2 * 6 } else { 4 * 6 };
            assert!(refused >= least, "{}: {refused}", fields[which]);
        }
    }
}

#[test]
fn laws_that_fail_at_any_call() {
    for bad in BAD {
        for (of_pressure, of_slope) in [(true, true), (true, false), (false, true)] {
            let fuse = Fuse::default();
            let law = Law(|_: f64, r: f64| {
                let (p, slope) = (1e8 * r, 1e8);
                match fuse.blows() {
                    true => (if of_pressure { bad } else { p }, if of_slope { bad } else { slope }),
                    false => (p, slope),
                }
            });
            let scene = Scene::new(1.0, Beam::elastic(5000.0))
                .foundation(Foundation { law, gap: 1e-3 })
                .load(plain(1e6));
            let ends = blow_at_every_call(&scene, &fuse, Mesh::uniform(6));
            let named = ends.iter().filter(|end| matches!(end, Ok(Status::LawNotFinite { .. })));
            // The other calls only look for how steep the law is, and pass over what says nothing.
            assert!(named.count() >= 20, "{ends:?}");
            let known = |end: &Result<Status, Error>| {
                matches!(end, Ok(Status::LawNotFinite { .. } | Status::Converged))
                    || (bad < 0.0 && matches!(end, Ok(Status::LawNotMonotone { .. })))
            };
            assert!(ends.iter().all(known), "{ends:?}");
        }
    }
}

/// Conduction both ways, at a potential that attracts the beam at one end.
fn attracted<W: Compliance<f64>>(law: W) -> impl Model<f64> {
    let beam = Beam { bending: 50.0, axial: 1e5, piezo: 100.0, permittivity: 1.0 };
    Scene::new(1.0, beam)
        .foundation(Foundation { law, gap: 0.0 })
        .conduction(Conduction::new(1e5, 10.0, 1.0))
        .load(Load { transverse: 1e4, axial: 1e4, points: () })
        .potential(Potential { left: -1.0, right: 1.0 })
}

#[test]
fn laws_that_fail_in_a_coupled_scene_at_any_call() {
    let fuse = Fuse::default();
    let law = Law(|_: f64, r: f64| (fuse.or(f64::NAN, 1e6 * r), 1e6));
    let ends = blow_at_every_call(&attracted(law), &fuse, Mesh::uniform(5));
    assert!(ends.iter().any(|end| matches!(end, Ok(Status::LawNotFinite { .. }))));
}

/// A slope at the end of the numbers makes a pivot that is none, in the sweep at hand alone.
#[test]
fn factorisations_that_fail_at_any_call() {
    let fuse = Fuse::default();
    let law = Law(|_: f64, r: f64| (1e8 * r, fuse.or(f64::MAX, 1e8)));
    let scene =
        Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law, gap: 1e-3 }).load(plain(1e6));
    let ends = blow_at_every_call(&scene, &fuse, Mesh::uniform(6));
    let broken = |end: &Result<Status, Error>| matches!(end, Ok(Status::Breakdown { .. }));
    assert!(ends.iter().any(broken), "{ends:?}");
    let law = Law(|_: f64, r: f64| (1e6 * r, fuse.or(f64::MAX, 1e6)));
    let ends = blow_at_every_call(&attracted(law), &fuse, Mesh::uniform(5));
    assert!(ends.iter().any(broken), "{ends:?}");
}

#[test]
fn a_prepared_scene_and_a_history_forget_a_fault() {
    let fuse = Fuse::default();
    let law = Law(|_: f64, r: f64| (fuse.or(f64::NAN, 1e8 * r), 1e8));
    let scene = |f: f64| {
        Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law, gap: 1e-3 }).load(plain(f))
    };
    let settings = Settings::default();
    let mesh = Mesh::uniform(6);
    let last = scene(1.1e6);
    let problem = Problem::new(&last, mesh).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let want = bits(&problem.solve(&mut memory, &settings).expect("a solution"));
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory).expect("memory");
    for due in (1..).take_while(|due| *due == 1 || fuse.calls.get() + 1 >= *due) {
        fuse.set(due);
        prepared.solve(&settings).expect("settings");
        let blown = fuse.calls.get() >= due;
        fuse.set(0);
        let after = prepared.solution(&settings).expect("settings");
        assert!(bits(&after) == want, "prepared, call {due}");
        if !blown {
            break;
        }
    }
    let (first, second) = (scene(1e6), scene(1.05e6));
    for due in 1..400 {
        let mut memory = HeapWorkspace::new();
        let mut history = History::new(mesh, &mut memory);
        fuse.set(0);
        assert_eq!(history.solve(&first, &settings).expect("a solution").report().status, Status::Converged);
        fuse.set(due);
        let status = history.solve(&second, &settings).expect("a solution").report().status;
        fuse.set(0);
        let after = history.solve(&last, &settings).expect("a solution");
        if status == Status::Converged {
            is_honest(&after);
        } else {
            assert!(bits(&after) == want, "history, call {due}");
        }
    }
}

/// A scene with all parts, on which the tests below cut memory and work.
fn whole() -> impl Model<f64> {
    let beam = Beam { bending: 5000.0, axial: 1e5, piezo: 100.0, permittivity: 1.0 };
    Scene::new(1.0, beam)
        .foundation(Foundation { law: Linear(1e12), gap: 1e-4 })
        .conduction(Conduction::new(1.0, 1.0, 1.0))
        .load(Load {
            transverse: piezobeam::Steps { breaks: &[0.5], values: &[1e6, -1e6] },
            axial: 1e6,
            points: (),
        })
        .potential(Potential { left: 1.0, right: 1.0 })
}

#[test]
fn memory_that_ends_anywhere() {
    let scene = whole();
    let settings = Settings::default();
    let elements = 90;
    let problem = Problem::new(&scene, Mesh::uniform(elements)).expect("a scene");
    let fresh = |room: usize| {
        let mut memory = vec![StoragePlace::default(); room];
        problem.solve(memory.as_mut_slice(), &settings).map(|solution| bits(&solution))
    };
    let mut memory = vec![StoragePlace::default(); 200];
    for room in (0..=200).rev() {
        // Memory is what earlier solves have left.
        let end = problem.solve(&mut memory[..room], &settings).map(|solution| {
            is_honest(&solution);
            bits(&solution)
        });
        assert!(end == fresh(room), "room for {room}");
        match end {
            Ok((report, _)) => {
                assert!(room >= elements && report.status == Status::Converged, "{room}: {report:?}");
            }
            Err(error) => assert_eq!(error, Error::Capacity { needed: elements, available: room }),
        }
    }
}

/// How a search for a mesh ended, and all bits of its solution.
type Search = Result<(Reached, (Report<f64>, Vec<u64>)), Error>;

fn search<'a, M: Model<f64>>(scene: &'a M, memory: &mut [StoragePlace<f64, &'a M>]) -> Search {
    let problem = Problem::new(scene, Mesh::uniform(8)).expect("a scene");
    let found = problem.solve_to(memory, 1e-4, &Settings::default())?;
    Ok((found.reached, bits(&found.solution)))
}

#[test]
fn memory_for_a_mesh_that_ends_anywhere() {
    let scene = whole();
    let most = 150;
    let mut memory = vec![StoragePlace::default(); most];
    let mut ends = [0; 3];
    for room in (0..=most).rev() {
        let end = search(&scene, &mut memory[..room]);
        assert!(end == search(&scene, &mut vec![StoragePlace::default(); room]), "room for {room}");
        match end {
            Ok((reached, (report, _))) => {
                assert!(report.elements <= room && report.status == Status::Converged, "{room}: {report:?}");
                assert!(matches!(reached, Reached::Tolerance | Reached::Capacity), "{room}: {reached}");
                ends[usize::from(reached == Reached::Capacity)] += 1;
            }
            Err(error) => {
                assert_eq!(error, Error::Capacity { needed: 8, available: room });
                ends[2] += 1;
            }
        }
    }
    assert!(ends.into_iter().all(|count| count > 0), "{ends:?}");

    let problem = Problem::new(&scene, Mesh::uniform(8)).expect("a scene");
    let (mut places, settings) = (HeapWorkspace::new(), Settings::default());
    let solution = problem.solve(&mut places, &settings).expect("a solution");
    for room in (0..=most).rev() {
        let end = solution.certify(&mut memory[..room], &settings);
        let mut fresh = vec![StoragePlace::default(); room];
        assert_eq!(end, solution.certify(fresh.as_mut_slice(), &settings), "room for {room}");
        assert_eq!(end.is_ok(), room >= 32, "{end:?}");
    }
}

#[test]
fn profiles_that_fail_in_a_search_for_a_mesh() {
    let fuse = Fuse::default();
    let law = Linear(Function(|x: f64| fuse.or(f64::NAN, 1e10 + x)));
    let scene = Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law, gap: () }).load(Load {
        transverse: Function(|x: f64| 1e6 * (1.0 - 2.0 * x)),
        axial: (),
        points: (),
    });
    let mut memory = vec![StoragePlace::default(); 400];
    let want = search(&scene, &mut memory);
    assert!(matches!(want, Ok((Reached::Tolerance, _))), "{want:?}");
    let calls = fuse.calls.get();
    assert!(calls > 200, "{calls}");
    for due in 1..=calls {
        fuse.set(due);
        let end = search(&scene, &mut memory);
        fuse.set(0);
        match end {
            Err(error) => assert!(error.to_string().starts_with("foundation.stiffness"), "{error}"),
            // Looked at between nodes only.
            Ok((_, (report, _))) => assert!(report.element_visits > 0),
        }
        assert!(search(&scene, &mut memory) == want, "the search after call {due} failed is another");
    }
}

#[test]
fn work_that_ends_anywhere() {
    let scene = whole();
    let problem = Problem::new(&scene, Mesh::uniform(60)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("a solution");
    let want = bits(&solution);
    let visits = solution.report().element_visits;
    for most in 0..=visits + 1 {
        let settings = Settings { max_visits: Some(most), ..Settings::default() };
        let solution = problem.solve(&mut memory, &settings).expect("a solution");
        is_honest(&solution);
        let report = *solution.report();
        assert!(report.element_visits <= most);
        match report.status {
            // The last three passes refine what has converged.
            Status::Converged => assert!(most + 3 * 60 >= visits, "{most} of {visits}"),
            status => assert_eq!(status, Status::VisitLimit, "{most} of {visits}"),
        }
        if most % 16 == 0 {
            let again = problem.solve(&mut memory, &Settings::default()).expect("a solution");
            assert!(bits(&again) == want, "after {most} visits");
        }
    }
}
