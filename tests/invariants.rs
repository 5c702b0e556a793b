//! What holds of every scene: random scenes, biased to what is hard.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{Shape, points, solved, tolerances as tol};
use piezobeam::{
    Beam, Conduction, Fields, Foundation, HeapWorkspace, Law, Load, Mesh, Model, Potential, Power, Problem,
    Report, Scene, Settings, Status,
};
use proptest::prelude::*;
use std::cell::Cell;

/// A load in steps on a beam of length and stiffness 1.
#[derive(Clone, Debug)]
struct Steps {
    breaks: Vec<f64>,
    values: Vec<f64>,
}

impl Steps {
    fn shape(&self) -> Shape {
        let polynomials = self.values.iter().map(|&v| vec![v]).collect();
        Shape::Pieces { breaks: self.breaks.clone(), polynomials }
    }

    /// Integral of its product with a function.
    fn times(&self, f: impl Fn(f64) -> f64) -> f64 {
        let ends: Vec<f64> = [0.0].iter().chain(&self.breaks).chain(&[1.0]).copied().collect();
        let part = |(ends, value): (&[f64], &f64)| {
            let (from, step) = (ends[0], (ends[1] - ends[0]) / 40.0);
            // Simpson's rule.
            let weight = |i: u32| if i == 0 || i == 40 { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
            (0..=40).map(|i| weight(i) * f(from + step * f64::from(i))).sum::<f64>() * step / 3.0 * value
        };
        ends.windows(2).zip(&self.values).map(part).sum()
    }

    fn minus(&self, other: &Self) -> Self {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a - b).collect();
        Self { breaks: self.breaks.clone(), values }
    }
}

/// A scene that bends on a foundation.
#[derive(Clone, Debug)]
struct Setup {
    load: Steps,
    gap: Shape,
    /// Powers of ten of the stiffness.
    stiffness: f64,
    exponent: f64,
    n: usize,
}

impl Setup {
    fn scene(&self) -> impl Model<f64> + use<> {
        let law = Power { stiffness: Shape::Number(10.0_f64.powf(self.stiffness)), exponent: self.exponent };
        Scene::new(1.0, Beam::elastic(1.0)).foundation(Foundation { law, gap: self.gap.clone() }).load(Load {
            transverse: self.load.shape(),
            axial: (),
            points: (),
        })
    }

    fn solve<R>(&self, look: impl FnOnce(&Report<f64>, &dyn Fn(f64) -> Fields<f64>) -> R) -> R {
        solved(self.scene(), Mesh::uniform(self.n), |s| look(s.report(), &|x| s.at(x)))
    }

    /// The same with some load everywhere. Where a part of the beam without any lies on a stiff foundation, contact
    /// and lift-off alternate with amplitudes that die out like powers: which is which may not be found in
    /// bounded work.
    fn pressed_or_lifted(mut self) -> Self {
        for f in &mut self.load.values {
            if *f == 0.0 {
                *f = 50.0;
            }
        }
        self
    }

    fn equilibrium_error(&self) -> f64 {
        solved(self.scene(), Mesh::uniform(self.n), |s| s.resultants().equilibrium_error)
    }

    /// Integral of the squared penetration.
    fn penetration(&self) -> f64 {
        self.solve(|_, at| {
            let x = points(2000, 1.0);
            x.iter().map(|&x| at(x)).map(|f| (f.bending - f.gap.unwrap_or(0.0)).max(0.0).powi(2)).sum::<f64>()
                / 2000.0
        })
    }
}

fn steps() -> impl Strategy<Value = Steps> {
    let value = prop_oneof![Just(0.0), 1.0..1000.0, -1000.0..-1.0, 100.0..101.0];
    (prop::collection::vec(value, 1..6), prop::collection::vec(0.05..1.0, 6)).prop_map(
        |(mut values, widths)| {
            values[0] += 150.0;
            let sum: f64 = widths[..values.len()].iter().sum();
            let ends = widths.iter().scan(0.0, |x, w| {
                *x += w / sum;
                Some(*x)
            });
            Steps { breaks: ends.take(values.len() - 1).collect(), values }
        },
    )
}

/// No gap, or one that vanishes with its slope at the clamps.
fn resting() -> impl Strategy<Value = Shape> {
    prop_oneof![
        Just(Shape::Number(0.0)),
        (0.1..10.0).prop_map(|a| Shape::Pieces {
            breaks: vec![],
            polynomials: vec![vec![0.0, 0.0, a, -2.0 * a, a]]
        }),
    ]
}

/// Gaps of all kinds: resting ones, constants above and below zero, tents.
fn gap() -> impl Strategy<Value = Shape> {
    let tent = |(x, slope): (f64, f64)| {
        let down = slope * x / (1.0 - x);
        Shape::Pieces { breaks: vec![x], polynomials: vec![vec![0.05, slope], vec![0.05 + down, -down]] }
    };
    prop_oneof![
        3 => resting(),
        1 => (0.001..0.3).prop_map(Shape::Number),
        1 => (0.001..0.3).prop_map(|preload: f64| Shape::Number(-preload)),
        1 => (0.1..0.9, 0.01..1.0).prop_map(tent),
    ]
}

fn setups(
    gap: impl Strategy<Value = Shape>,
    stiffness: std::ops::Range<f64>,
) -> impl Strategy<Value = Setup> {
    let exponent = prop_oneof![3 => Just(1.0), 1 => Just(1.5), 1 => 1.0..3.0];
    let n = prop_oneof![4_usize..32, 32_usize..200];
    (steps(), gap, stiffness, exponent, n).prop_map(|(load, gap, stiffness, exponent, n)| Setup {
        load,
        gap,
        stiffness,
        exponent,
        n,
    })
}

fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// Converged, or kept from it by the rounding of a foundation that is all but rigid.
fn is_solved(report: &Report<f64>, stiffness: f64) -> Result<(), TestCaseError> {
    if stiffness >= tol::RESOLVABLE.log10() && report.status == Status::ToleranceBelowFloor {
        prop_assert!(report.residual <= tol::RIGID_FLOOR, "{:?}", report);
    } else {
        prop_assert_eq!(report.status, Status::Converged, "{:?}", report);
    }
    Ok(())
}

/// Solved, finite, nowhere pulled, and in equilibrium.
fn is_sound(setup: &Setup) -> Result<(), TestCaseError> {
    setup.solve(|report, at| {
        is_solved(report, setup.stiffness)?;
        for x in points(100, 1.0) {
            let f = at(x);
            prop_assert!(f.pressure >= Some(0.0), "{:?}", f);
            prop_assert!(f.bending.is_finite() && f.moment.is_finite() && f.shear.is_finite());
        }
        Ok(())
    })?;
    let error = setup.equilibrium_error();
    // The force of a foundation that is all but rigid is k times the rounding of a penetration.
    let rigid = setup.stiffness >= tol::RESOLVABLE.log10();
    prop_assert!(rigid || error <= tol::RANDOM_EQUILIBRIUM, "{:e}", error);
    Ok(())
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn a_monotone_foundation_is_solved_and_never_pulls(setup in setups(resting(), 0.0..8.0)) {
        is_sound(&setup)?;
    }

    #[test]
    fn a_monotone_foundation_is_solved_whatever_the_gap(setup in setups(gap(), 0.0..8.0)) {
        is_sound(&setup)?;
    }

    #[test]
    fn a_monotone_foundation_is_solved_whatever_its_stiffness(setup in setups(resting(), 8.0..16.0)) {
        is_sound(&setup.pressed_or_lifted())?;
    }

    #[test]
    fn the_foundation_never_pulls_whatever_the_gap_and_the_stiffness(setup in setups(gap(), 0.0..16.0)) {
        setup.solve(|report, at| {
            // Not converging is said; what is returned is finite all the same.
            prop_assert!(report.status == Status::Converged || report.residual > 1e-10, "{:?}", report);
            for x in points(100, 1.0) {
                let f = at(x);
                prop_assert!(f.pressure >= Some(0.0) && f.bending.is_finite(), "{:?}", f);
            }
            Ok(())
        })?;
    }
}

proptest! {
    #![proptest_config(cases(100))]

    #[test]
    fn a_stiffer_foundation_is_penetrated_less(setup in setups(resting(), 0.0..6.0), times in 0.1..2.0) {
        let setup = Setup { exponent: 1.0, n: setup.n + 100, ..setup };
        let stiffer = Setup { stiffness: setup.stiffness + times, ..setup.clone() };
        let (soft, stiff) = (setup.penetration(), stiffer.penetration());
        prop_assert!(stiff <= soft * (1.0 + tol::MONOTONE_IN_K) + tol::UNTOUCHED, "{:e} > {:e}", stiff, soft);
    }

    #[test]
    fn a_finer_mesh_agrees(setup in setups(resting(), 0.0..6.0)) {
        let setup = Setup { n: setup.n.max(20), ..setup };
        let fine = Setup { n: 4 * setup.n, ..setup.clone() };
        let x = points(20, 1.0);
        let bending = |s: &Setup| s.solve(|_, at| x.iter().map(|&x| at(x).bending).collect::<Vec<_>>());
        let error = common::relative(&bending(&setup), &bending(&fine));
        prop_assert!(error <= tol::REFINED, "{:e}", error);
    }

    #[test]
    fn bending_depends_continuously_and_monotonically_on_the_load(
        setup in setups(resting(), 0.0..8.0),
        changes in prop::collection::vec(-100.0..100.0, 6),
        small in prop_oneof![Just(1.0), Just(1e-3)],
    ) {
        let mut other = setup.clone();
        for (value, change) in other.load.values.iter_mut().zip(&changes) {
            *value += small * change;
        }
        let problems = [setup.scene(), other.scene()].map(|s| Problem::new(s, Mesh::uniform(setup.n)).expect("a scene"));
        let mut memory = [HeapWorkspace::new(), HeapWorkspace::new()];
        let [first, second] = &mut memory;
        let one = problems[0].solve(first, &Settings::default()).expect("settings");
        let two = problems[1].solve(second, &Settings::default()).expect("settings");
        let load = setup.load.minus(&other.load);
        let moved = |x: f64| one.at(x).bending - two.at(x).bending;
        // (f1 - f2, xi1 - xi2) >= 0, as the energy of the difference is its lower bound.
        let work = load.times(moved);
        let size = load.times(|_| 1.0).abs().max(load.values.iter().fold(0.0, |m, v| v.abs().max(m)))
            * one.nodes().fold(0.0_f64, |m, x| m.max(one.at(x).bending.abs()));
        prop_assert!(work >= -tol::MONOTONE * size, "{:e} of {:e}", work, size);
        // C |w''|^2 <= |f| |w|, |w| <= c2 |w''|, max |w| <= (L^3 / 192)^(1/2) |w''|.
        let norm = Steps { values: load.values.iter().map(|v| v * v).collect(), ..load }.times(|_| 1.0).sqrt();
        let bound = norm / 4.730_040_744_862_704_f64.powi(2) / 192.0_f64.sqrt();
        let most = one.nodes().map(|x| moved(x).abs()).fold(0.0, f64::max);
        prop_assert!(most <= bound * (1.0 + tol::CONTINUITY) + tol::CONTINUITY * size, "{:e} > {:e}", most, bound);
    }
}

/// Conduction both ways, with numbers that keep both margins of (2.15) above `margin`.
#[derive(Clone, Debug)]
struct Conducting {
    setup: Setup,
    share: f64,
    margin: f64,
    ends: [f64; 2],
    bounds: [f64; 2],
    piezo: f64,
}

impl Conducting {
    fn scene(&self) -> impl Model<f64> + use<> {
        let Self { setup, share, margin, ends, bounds: [m, mq], piezo } = self.clone();
        // The right sides of (2.15) for mu1 = share, mu2 = 1 - share, C = eps = 1.
        let (c1, c2) = (std::f64::consts::PI.recip(), 4.730_040_744_862_704_f64.powi(-2));
        let bending = c2 * c2 * (share * (mq + 0.5 * m) + (1.0 - share) * m);
        let electric = c1 * c1 * (share * 0.5 * m + (1.0 - share) * m);
        let most = 1.0 / (margin * bending.max(electric));
        let law = Power { stiffness: 10.0_f64.powf(setup.stiffness), exponent: setup.exponent };
        let mut conduction = Conduction::new(share * most, (1.0 - share) * most, m);
        conduction.potential_truncation = mq;
        Scene::new(1.0, Beam { bending: 1.0, axial: 1.0, piezo, permittivity: 1.0 })
            .foundation(Foundation { law, gap: setup.gap.clone() })
            .conduction(conduction)
            .load(Load { transverse: setup.load.shape(), axial: 1.0, points: () })
            .potential(Potential { left: ends[0], right: ends[1] })
    }
}

fn conducting(setup: impl Strategy<Value = Setup>) -> impl Strategy<Value = Conducting> {
    let share = prop_oneof![Just(0.0), Just(1.0), 0.0..1.0];
    let bounds = [0.01..1.0, 0.01..10.0];
    (setup, share, 2.0..10.0, [-2.0..2.0, -2.0..2.0], bounds, prop_oneof![Just(0.0), -2.0..2.0]).prop_map(
        |(setup, share, margin, ends, bounds, piezo)| Conducting {
            setup,
            share,
            margin,
            ends,
            bounds,
            piezo,
        },
    )
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn a_scene_with_margins_of_two_is_certified_and_solved(scene in conducting(setups(resting(), 0.0..8.0))) {
        is_certified_and_solved(&scene)?;
    }

    #[test]
    fn a_scene_with_margins_of_two_is_solved_whatever_gap_and_stiffness(scene in conducting(setups(gap(), 0.0..11.0))) {
        let setup = scene.setup.clone().pressed_or_lifted();
        is_certified_and_solved(&Conducting { setup, ..scene })?;
    }

    #[test]
    fn used_memory_gives_the_bits_of_fresh_memory(scene in conducting(setups(gap(), 0.0..16.0)), n in 4_usize..200) {
        let problem = Problem::new(scene.scene(), Mesh::uniform(scene.setup.n)).expect("a scene");
        let other = Problem::new(scene.scene(), Mesh::uniform(n)).expect("a scene");
        let x = points(10, 1.0);
        let mut fresh = HeapWorkspace::new();
        let want = answer(&problem, &mut fresh, &x, Settings::default());
        let mut used = HeapWorkspace::new();
        for settings in [
            Settings::default(),
            Settings { max_visits: Some(3 * n), ..Settings::default() },
            Settings { stop: 1e-17, max_visits: Some(50 * n + 1000) },
        ] {
            let _ = other.solve(&mut used, &settings).expect("settings");
            prop_assert_eq!(&answer(&problem, &mut used, &x, Settings::default()), &want);
        }
        // Once laid, solved again and again.
        let mut prepared = problem.prepare(&mut used).expect("memory");
        let _ = prepared.solve(&Settings { max_visits: Some(100), ..Settings::default() });
        let again = prepared.solution(&Settings::default()).expect("settings");
        prop_assert_eq!(&bits(again.report(), x.iter().map(|&x| again.at(x))), &want);
    }
}

fn is_certified_and_solved(scene: &Conducting) -> Result<(), TestCaseError> {
    solved(scene.scene(), Mesh::uniform(scene.setup.n), |s| {
        let unique = s.uniqueness();
        prop_assert!(unique.certified, "{:?}", unique);
        is_solved(s.report(), scene.setup.stiffness)?;
        prop_assert!(points(50, 1.0).into_iter().all(|x| s.at(x).pressure >= Some(0.0)));
        Ok(())
    })
}

fn answer<M: Model<f64>>(
    problem: &Problem<'_, f64, M>,
    memory: &mut HeapWorkspace<f64, M>,
    x: &[f64],
    settings: Settings<f64>,
) -> (String, Vec<u64>) {
    let solution = problem.solve(memory, &settings).expect("settings");
    bits(solution.report(), x.iter().map(|&x| solution.at(x)))
}

fn bits(report: &Report<f64>, at: impl Iterator<Item = Fields<f64>>) -> (String, Vec<u64>) {
    let numbers = at.flat_map(|f| [f.bending, f.slope, f.moment, f.shear, f.potential.unwrap_or(0.0)]);
    (format!("{report:?}"), numbers.map(f64::to_bits).collect())
}

#[test]
fn memory_is_as_good_as_fresh_after_a_law_that_failed() {
    let (broken, calls) = (Cell::new(0), Cell::new(0_usize));
    let law = Law(|_: f64, r: f64| {
        calls.set(calls.get() + 1);
        match broken.get() {
            1 if calls.get() > 300 => (f64::NAN, 1.0),
            2 if calls.get() > 300 => (-1.0, 1.0),
            _ => (1e6 * r, 1e6),
        }
    });
    let load = Load { transverse: 100.0, axial: (), points: () };
    let scene = Scene::new(1.0, Beam::elastic(1.0)).foundation(Foundation { law, gap: 0.01 }).load(load);
    let problem = Problem::new(scene, Mesh::uniform(150)).expect("a scene");
    let x = points(10, 1.0);
    let want = answer(&problem, &mut HeapWorkspace::new(), &x, Settings::default());
    let mut used = HeapWorkspace::new();
    for way in [1, 2] {
        broken.set(way);
        calls.set(0);
        let status = problem.solve(&mut used, &Settings::default()).expect("settings").report().status;
        assert!(matches!(status, Status::LawNotFinite { .. } | Status::LawNotMonotone { .. }), "{status:?}");
        broken.set(0);
        assert_eq!(answer(&problem, &mut used, &x, Settings::default()), want);
    }
}
