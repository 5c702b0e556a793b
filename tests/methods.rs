//! The paper's own methods: how well they do, and that none says converged of what is no solution.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{fixed, halves, named, tolerances as tol};
use piezobeam::{
    Beam, BermudezMoreno, Compared, Conduction, Foundation, HeapWorkspace, Law, Linear, Load, Mesh, Method,
    Model, Potential, Power, Prepared, Problem, Real, Scene, SensitivityError, Settings, Status, Steps,
    Tabulated,
};
use proptest::prelude::*;

const DUAL: Method<f64> = Method::BermudezMoreno(BermudezMoreno { omega: None, mu: None, rho: None });
const METHODS: [Method<f64>; 3] = [Method::Elementwise, Method::Gauss, DUAL];

/// One load over one gap.
fn gap() -> impl Model<f64> {
    Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e9), gap: 0.3 }).load(Load {
        transverse: 2e6,
        axial: (),
        points: (),
    })
}

fn prepared<T: Real, M: Model<T>, R>(
    scene: M,
    elements: usize,
    look: impl FnOnce(&mut Prepared<'_, T, M>) -> R,
) -> R {
    let problem = Problem::new(scene, Mesh::uniform(elements)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory).expect("memory that grows");
    look(&mut prepared)
}

/// How a method went, and the bending at k L / 8, k = 1 .. 7. The solver's own where there is none.
fn bent<M: Model<f64>>(scene: M, elements: usize, method: Option<Method<f64>>) -> (Compared<f64>, [f64; 7]) {
    let length = scene.length();
    prepared(scene, elements, |beam| {
        let settings = Settings::default();
        let found = match method {
            Some(method) => beam.solve_by(&method, &settings).expect("settings in range"),
            None => {
                let report = beam.solve(&settings).expect("settings in range");
                Compared { report, own_residual: 0.0, lowest_pressure: 0.0, highest_pressure: 0.0 }
            }
        };
        let solution = beam.last().expect("just solved");
        (found, [1, 2, 3, 4, 5, 6, 7].map(|k| solution.at(length * f64::from(k) / 8.0).bending))
    })
}

fn differ(got: &[f64], want: &[f64]) -> f64 {
    common::relative(got, want)
}

#[test]
fn where_the_kink_is_integrated_decides_the_order() {
    let (_, exact) = bent(gap(), 4096, None);
    let meshes = [16, 32, 64, 128, 256, 512];
    let errors = |method| meshes.map(|n| differ(&bent(gap(), n, method).1, &exact));
    // The slope of a line through the logarithms: single steps go up and down with where the edge lies.
    let order = |errors: [f64; 6]| {
        let y = errors.map(f64::log2);
        (0..6).fold(0.0, |sum, i| sum - (i as f64 - 2.5) * y[i]) / 17.5
    };
    let [ours, points, elements, dual] =
        [None, Some(Method::Gauss), Some(Method::Elementwise), Some(DUAL)].map(errors);
    assert!(order(ours) > tol::ORDER, "{ours:?}");
    for list in [points, elements] {
        let order = order(list);
        assert!(tol::ORDER_ACROSS_KINKS.contains(&order), "{order}: {list:?}");
    }
    for i in 0..6 {
        assert!(elements[i] > points[i] && points[i] > ours[i], "{elements:?} {points:?} {ours:?}");
        assert!((dual[i] - points[i]).abs() < tol::METHODS * (1.0 + points[i]), "{dual:?} {points:?}");
    }
}

#[test]
fn quiet_false_ends_of_the_set_by_elements_are_named() {
    for (k, n, iterations, xi) in
        [(1e8, 96, 6, -0.06368), (1e12, 24, 3, -0.000_315), (1e16, 96, 3, -0.000_001_576)]
    {
        let (found, bending) = bent(halves(k), n, Some(Method::Elementwise));
        // Nothing changes any more ...
        assert_eq!(found.report.iterations, iterations, "{k:e}: {found:?}");
        assert!(found.own_residual < 1e-14, "{found:?}");
        assert!((bending[3] / xi - 1.0).abs() < 1e-3, "{k:e}: {}", bending[3]);
        // ... and the foundation pulls.
        assert!(
            matches!(found.report.status, Status::FoundationPulls { element } if element < n),
            "{found:?}"
        );
        assert_eq!(found.report.status.name(), "foundation_pulls");
        assert!(found.report.status.to_string().contains("the foundation pulls the beam"));
        assert!(found.lowest_pressure < -1e4 && found.report.residual > 1e-4, "{found:?}");
        let (ours, exact) = bent(halves(k), n, None);
        assert_eq!(ours.report.status, Status::Converged);
        let (error, least) = (differ(&bending, &exact), if k < 1e12 { 1e-4 } else { 0.7 });
        assert!(error > least, "{k:e}: {error:e}");
    }
}

#[test]
fn circles_are_found_and_named() {
    for (method, k, n, period) in [
        (Method::Elementwise, 1e12, 28, 2),
        (Method::Gauss, 1e14, 14, 10),
        (Method::Elementwise, 1e14, 100, 3),
    ] {
        let (found, _) = bent(halves(k), n, Some(method));
        assert_eq!(found.report.status, Status::Cycle { period }, "{found:?}");
        assert!(found.own_residual > 1e-3, "{found:?}");
        assert_eq!(found.report.status.name(), "cycle");
        assert!(found.report.status.to_string().contains(&format!("every {period} iterations")));
    }
}

#[test]
fn without_an_edge_inside_elements_all_methods_converge_to_the_same() {
    for name in ["free", "paper", "coupled", "sweep-1e02"] {
        let scene = &named(name).scene;
        let (_, exact) = bent(scene, 100, None);
        for method in METHODS {
            let (found, bending) = bent(scene, 100, Some(method));
            assert_eq!(found.report.status, Status::Converged, "{name} {method:?}: {found:?}");
            assert!(found.report.residual <= 1e-10 && found.own_residual <= 1e-10);
            assert!(differ(&bending, &exact) < tol::METHODS, "{name} {method:?}");
        }
    }
}

#[test]
fn a_loose_stop_is_kept_by_moments_too() {
    for k in [1e6, 1e8, 1e10, 1e12] {
        for stop in [1e-2, 1e-4, 1e-8] {
            // All of the beam is in contact: no edge inside elements.
            let scene = Scene::new(1.0, Beam::elastic(5000.0))
                .foundation(Foundation { law: Linear(k), gap: () })
                .load(Load { transverse: 1e6, axial: (), points: () });
            let settings = Settings { stop, ..Settings::default() };
            let found = prepared(scene, 100, |beam| beam.solve_by(&DUAL, &settings)).expect("in range");
            assert_eq!(found.report.status, Status::Converged, "{k:e} {stop:e}: {found:?}");
            assert!(found.own_residual <= stop && found.report.residual <= stop);
        }
    }
}

#[test]
fn what_solves_the_methods_own_equations_only_says_so() {
    let (found, bending) = bent(halves(1e8), 96, Some(Method::Gauss));
    assert_eq!(found.report.status, Status::OwnEquations, "{found:?}");
    assert_eq!(found.report.status.name(), "own_equations");
    assert!(found.report.status.to_string().contains("its own equations"));
    assert!(found.own_residual < 1e-12 && found.report.residual > 1e-6, "{found:?}");
    let (dual, same) = bent(halves(1e8), 96, Some(DUAL));
    assert_eq!(dual.report.status, Status::OwnEquations, "{dual:?}");
    assert!(differ(&same, &bending) < tol::METHODS, "the fixed point is that of the Gauss points");
    prepared(halves(1e8), 96, |beam| {
        let found = beam.solve_by(&Method::Gauss, &Settings::default()).expect("settings in range");
        let refused = beam.grazing().map(drop);
        assert_eq!(refused, Err(SensitivityError::NotConverged(found.report.status)));
    });
}

#[test]
fn duality_takes_the_iterations_of_its_rate_and_no_parameters_take_much_less() {
    // s = sqrt(a1 / k), a1 = 4.73^4 C / L^4; errors fall by 1 / (1 + 2 s).
    let iterations = |k, stop, method: BermudezMoreno<f64>| {
        prepared(halves(k), 96, |beam| {
            let settings = Settings { stop, ..Settings::default() };
            let method = Method::BermudezMoreno(method);
            beam.solve_by(&method, &settings).expect("settings in range").report.iterations as f64
        })
    };
    for (k, stop) in [(1e8_f64, 1e-10_f64), (1e10, 1e-10), (1e12, 1e-10), (1e12, 1e-3)] {
        let s = (500.563_901_740_433 * 5000.0 / k).sqrt();
        let expected = (1.0 / stop).ln() / (1.0 + 2.0 * s).ln();
        let got = iterations(k, stop, BermudezMoreno::default());
        assert!(tol::DUAL_ITERATIONS.contains(&(got / expected)), "{k:e} {stop:e}: {got} for {expected}");
    }
    assert!(iterations(1e12, 1e-3, BermudezMoreno::default()) > 1000.0, "as the paper has it");
    let (k, stop) = (1e10, 1e-8);
    let least = iterations(k, stop, BermudezMoreno::default());
    let omega = (500.563_901_740_433 * 5000.0 * k).sqrt();
    for factor in [0.1, 0.25, 4.0, 10.0] {
        for rho in [None, Some(0.5), Some(1.0)] {
            let got = iterations(k, stop, BermudezMoreno { omega: Some(factor * omega), mu: None, rho });
            assert!(got > 1.2 * least, "{factor} {rho:?}: {got} and {least}");
        }
    }
    let smaller = BermudezMoreno { mu: Some(0.25 / omega), ..BermudezMoreno::default() };
    let got = iterations(k, stop, smaller);
    assert!(got < 10_000.0 && got != least, "{got}: a smaller mu settles, too");
}

#[test]
fn parameters_out_of_range_are_refused() {
    let refused = |omega, mu, rho| {
        let method = Method::BermudezMoreno(BermudezMoreno { omega, mu, rho });
        let found = prepared(halves(1e8), 8, |beam| beam.solve_by(&method, &Settings::default()));
        found.err().map_or(String::new(), |error| error.to_string())
    };
    assert_eq!(refused(Some(0.0), None, None), "omega: expected a finite number > 0, found 0");
    assert_eq!(refused(Some(f64::NAN), None, None), "omega: expected a finite number > 0, found NaN");
    let mu = "mu: expected a number above 0 and at most 1 / (2 omega), found";
    assert_eq!(refused(Some(100.0), Some(0.006), None), format!("{mu} 0.006"));
    assert_eq!(refused(Some(100.0), Some(0.005), None), "");
    assert_eq!(refused(None, Some(-1.0), None), format!("{mu} -1"));
    assert_eq!(refused(None, None, Some(1.5)), "rho: expected a number above 0 and at most 1, found 1.5");
    assert_eq!(refused(None, None, Some(0.0)), "rho: expected a number above 0 and at most 1, found 0");
}

#[test]
fn a_cap_on_visits_is_kept() {
    for method in METHODS {
        for most in [0, 1, 99, 100, 250] {
            let settings = Settings { max_visits: Some(most), ..Settings::default() };
            let found =
                prepared(halves(1e12), 100, |beam| beam.solve_by(&method, &settings)).expect("in range");
            assert_eq!(found.report.status, Status::VisitLimit, "{method:?} {most}");
            assert!(found.report.element_visits <= most && found.report.residual.is_finite());
        }
    }
    let found =
        prepared(halves(1e16), 96, |beam| beam.solve_by(&DUAL, &Settings::default())).expect("in range");
    assert_eq!((found.report.status, found.report.iterations), (Status::VisitLimit, 10_000));
}

#[test]
fn a_method_leaves_nothing_behind() {
    prepared(halves(1e30), 100, |beam| {
        let settings = Settings::default();
        let first = beam.solve(&settings).expect("settings in range");
        let before = METHODS.map(|method| beam.solve_by(&method, &settings).expect("settings in range"));
        assert_eq!(beam.solve(&settings).expect("settings in range"), first);
        let after = METHODS.map(|method| beam.solve_by(&method, &settings).expect("settings in range"));
        assert_eq!(before, after);
    });
}

#[test]
fn methods_allocate_nothing() {
    for method in METHODS {
        prepared(&named("partial").scene, 60, |beam| {
            let mut found = None;
            let counted = allocation_counter::measure(|| {
                found = beam.solve_by(&method, &Settings::default()).ok();
            });
            assert_eq!(counted.count_total, 0, "{method:?}");
            assert!(found.is_some());
        });
    }
}

#[test]
fn other_laws_and_precisions_are_seen_too() {
    let table = Tabulated { penetration: &[0.0, 1e-3, 2e-3], pressure: &[0.0, 1e4, 4e5] };
    let load = Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () };
    let beam = || Scene::new(1.0, Beam::elastic(5000.0)).load(load);
    let hertz = Power { stiffness: 1e9, exponent: 1.5 };
    let near = |got: [[f64; 7]; 3], exact: [f64; 7]| {
        for (bending, method) in got.iter().zip(METHODS) {
            assert!(differ(bending, &exact) < tol::ACROSS_KINKS, "{method:?}: {bending:?} {exact:?}");
        }
    };
    let scene = beam().foundation(Foundation { law: hertz, gap: () });
    near(METHODS.map(|m| bent(scene, 200, Some(m)).1), bent(scene, 200, None).1);
    let scene = beam().foundation(Foundation { law: table, gap: 1e-3 });
    near(METHODS.map(|m| bent(scene, 200, Some(m)).1), bent(scene, 200, None).1);

    let falling = Law(|_: f64, r: f64| (1e6 * r, -1.0));
    let scene = beam().foundation(Foundation { law: falling, gap: () });
    for method in METHODS {
        let status = bent(scene, 20, Some(method)).0.report.status;
        assert!(matches!(status, Status::LawNotMonotone { .. }), "{method:?}: {status:?}");
    }

    let single = Scene::new(1.0_f32, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e8), gap: () })
        .load(Load { transverse: 1e6, axial: (), points: () });
    let dual = Method::BermudezMoreno(BermudezMoreno::default());
    for method in [Method::Elementwise, Method::Gauss, dual] {
        let found =
            prepared(&single, 32, |beam| beam.solve_by(&method, &Settings::default())).expect("in range");
        assert_eq!(found.report.status, Status::Converged, "{method:?}: {found:?}");
    }
}

proptest! {
    #![proptest_config(fixed(256))]
    #[test]
    fn converged_is_said_of_solutions_only(
        stiffness in 0.0..16.0_f64,
        split in 0.1..0.9_f64,
        left in -1e6..1e6_f64,
        right in -1e6..1e6_f64,
        gap in prop_oneof![Just(0.0), -0.01..0.05_f64],
        elements in 4_usize..80,
    ) {
        let breaks = [split];
        let values = [left, right];
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(10f64.powf(stiffness)), gap })
            .load(Load { transverse: Steps { breaks: &breaks, values: &values }, axial: (), points: () });
        let (ours, exact) = bent(scene, elements, None);
        for method in METHODS {
            let settings = Settings { max_visits: Some(2000 * elements), ..Settings::default() };
            let (found, bending) = prepared(&scene, elements, |beam| {
                let found = beam.solve_by(&method, &settings).expect("settings in range");
                let solution = beam.last().expect("just solved");
                (found, [1, 2, 3, 4, 5, 6, 7].map(|k| solution.at(f64::from(k) / 8.0).bending))
            });
            let Compared { report, lowest_pressure, highest_pressure, .. } = found;
            prop_assert!(bending.iter().all(|xi| xi.is_finite()));
            let size = highest_pressure.max(left.abs()).max(right.abs());
            if report.status == Status::Converged {
                prop_assert!(report.residual <= settings.stop && lowest_pressure >= -2.0 * settings.stop * size);
                prop_assert!(ours.report.status != Status::Converged || differ(&bending, &exact) < tol::METHODS_RANDOM);
            }
            let pulls = matches!(report.status, Status::FoundationPulls { .. });
            prop_assert!(!pulls || lowest_pressure < 0.0);
            let settled = matches!(report.status, Status::OwnEquations | Status::Converged);
            prop_assert!(!settled || lowest_pressure >= -2.0 * settings.stop * size);
        }
    }
}

#[test]
fn a_law_that_is_no_number_ends_a_method_with_its_name() {
    for (law, negative) in [
        ((|_: f64, r: f64| (r, f64::NAN)) as fn(f64, f64) -> (f64, f64), false),
        (|_, _| (f64::INFINITY, 1.0), false),
        (|_, r| (-r, 1.0), true),
        (|_, r| (r, -1.0), true),
    ] {
        let scene = Scene::new(1.0, Beam::elastic(5.0))
            .foundation(Foundation { law: Law(law), gap: () })
            .load(Load { transverse: 1e3, axial: (), points: () });
        for method in METHODS {
            let (found, _) = bent(scene, 16, Some(method));
            let named = match found.report.status {
                Status::LawNotMonotone { element } => negative && element < 16,
                Status::LawNotFinite { element } => !negative && element < 16,
                _ => false,
            };
            assert!(named, "{method:?}: {:?}", found.report);
        }
    }
}

#[test]
fn a_method_that_has_settled_at_rounding_says_so() {
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e4), gap: () })
        .load(Load { transverse: 1e6, axial: (), points: () });
    prepared(scene, 200, |beam| {
        let settings = Settings { stop: 1e-17, ..Settings::default() };
        let found = beam.solve_by(&Method::Gauss, &settings).expect("settings in range");
        assert_eq!(found.report.status, Status::ToleranceBelowFloor, "{found:?}");
        assert!(found.report.residual <= tol::FLOOR);
    });
}

#[test]
fn a_method_whose_potential_overflows_has_not_converged() {
    let scene = Scene::new(1.0, Beam { bending: 5e3, axial: (), piezo: (), permittivity: 1e-300 })
        .foundation(Foundation { law: Linear(1e6), gap: () })
        .conduction(Conduction { mu1: (), mu2: 1e300, truncation: 1.0, potential_truncation: 1.0 })
        .potential(Potential { left: 1.0, right: 1.0 })
        .load(Load { transverse: 1e6, axial: (), points: () });
    for method in METHODS {
        prepared(scene, 32, |beam| {
            let found = beam.solve_by(&method, &Settings::default()).expect("settings in range");
            assert_ne!(found.report.status, Status::Converged, "{method:?}");
            if method == Method::Gauss {
                assert!(matches!(found.report.status, Status::Breakdown { .. }), "{found:?}");
            }
        });
    }
}
