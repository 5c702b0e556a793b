//! One function, written down in several ways, is one scene.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{fields, fixed, points, relative, tolerances as tol};
use piezobeam::{
    Adaptive, Batch, Beam, BermudezMoreno, Compliance, Conduction, Cubic, Error, Fields, Flat, Foundation,
    HeapWorkspace, History, Linear, Load, Mesh, Method, Model, Output, Parameter, Pieces, Place, Polynomial,
    Potential, Power, Problem, Profile, Reached, Scene, Settings, Smooth, Status, Steps, Table, Tabulated,
};
use proptest::prelude::*;

/// A beam with a stiffness, gap, foundation and load by these profiles.
fn solved(
    stiffness: impl Profile<f64>,
    gap: impl Smooth<f64>,
    k: impl Profile<f64>,
    load: impl Profile<f64>,
) -> Vec<Fields<f64>> {
    let scene = Scene::new(1.0, Beam { bending: stiffness, axial: (), piezo: (), permittivity: () })
        .foundation(Foundation { law: Linear(k), gap })
        .load(Load { transverse: load, axial: (), points: () });
    let (report, fields) = fields(scene, Mesh::uniform(64), &points(37, 1.0));
    assert_eq!(report.status, Status::Converged);
    fields
}

/// The largest difference of bending and moment, over their largest values.
fn differ(a: &[Fields<f64>], b: &[Fields<f64>]) -> f64 {
    let column =
        |fields: &[Fields<f64>], get: fn(&Fields<f64>) -> f64| fields.iter().map(get).collect::<Vec<_>>();
    let by = |get| relative(&column(a, get), &column(b, get));
    by(|f| f.bending).max(by(|f| f.moment))
}

proptest! {
    #![proptest_config(fixed(40))]

    /// A polynomial cut at nodes of the mesh is the polynomial.
    #[test]
    fn pieces_of_one_polynomial_are_the_polynomial(
        c in [1.0_f64..2.0, -0.5..0.5, -0.3..0.3],
        rise in 0.0_f64..0.3,
        load in 1e4_f64..1e6,
        cut in 1..63_u32,
    ) {
        let at = [f64::from(cut) / 64.0];
        let scaled = |by: f64| c.map(|c| c * by);
        let (stiff, k, pushed) = (scaled(5e3), scaled(1e7), scaled(load));
        // A gap that vanishes with its slope at both clamps.
        let gap = [0.0, 0.0, rise, -2.0 * rise, rise];
        let twice = |c| [c, c];
        let whole = solved(Polynomial(&stiff), Polynomial(&gap), Polynomial(&k), Polynomial(&pushed));
        let cut = solved(
            Pieces { breaks: &at, polynomials: &twice(&stiff[..]) },
            Pieces { breaks: &at, polynomials: &twice(&gap[..]) },
            Pieces { breaks: &at, polynomials: &twice(&k[..]) },
            Pieces { breaks: &at, polynomials: &twice(&pushed[..]) },
        );
        let worst = differ(&whole, &cut);
        prop_assert!(worst < tol::SAME_FUNCTION, "{worst:e}");
    }

    /// Steps that do not step, and tables of a line, are constants and lines.
    #[test]
    fn steps_and_tables_of_a_constant_are_the_constant(
        stiffness in 1e3_f64..1e4,
        gap in -0.01_f64..0.05,
        k in 1e5_f64..1e9,
        load in 1e4_f64..1e6,
    ) {
        let constant = solved(stiffness, gap, k, load);
        let steps = |v: &[f64; 2]| *v;
        let [c, s, f, g] = [[stiffness; 2], [k; 2], [load; 2], [gap; 2]];
        let stepped = solved(
            Steps { breaks: &[0.5], values: &steps(&c) },
            Steps { breaks: &[0.25], values: &steps(&g) },
            Steps { breaks: &[0.75], values: &steps(&s) },
            Steps { breaks: &[0.5], values: &steps(&f) },
        );
        let x = &[0.0, 0.5, 1.0];
        let [c, s, f, g] = [[stiffness; 3], [k; 3], [load; 3], [gap; 3]];
        let tabled = solved(Table { x, y: &c }, Table { x, y: &g }, Table { x, y: &s }, Table { x, y: &f });
        let worst = differ(&constant, &stepped).max(differ(&constant, &tabled));
        prop_assert!(worst < tol::SAME_FUNCTION, "{worst:e}");
    }
}

#[test]
fn a_reference_to_a_profile_is_the_profile() {
    let (stiff, gap) = (
        Polynomial(&[5e3, 1e3]),
        Pieces { breaks: &[0.5], polynomials: &[&[0.0, 0.0, 0.1], &[0.0, 0.0, 0.1]] },
    );
    let (k, load) =
        (Steps { breaks: &[0.25], values: &[1e7, 1e8] }, Table { x: &[0.0, 1.0], y: &[1e5, 2e5] });
    // The same bits.
    let (by_stiff, by_gap, by_k, by_load) = (&stiff, &gap, &k, &load);
    assert_eq!(solved(stiff, gap, k, load), solved(by_stiff, by_gap, by_k, by_load));
    let short = Steps { breaks: &[0.5], values: &[1.0] };
    assert_eq!(Profile::validate(&&short, "gap", 1.0), short.validate("gap", 1.0));
    assert!(short.validate("gap", 1.0).is_err());
}

#[test]
fn pieces_of_a_wrong_shape_are_named() {
    let (line, bad): (&[f64], &[f64]) = (&[1.0, 2.0], &[1.0, f64::NAN]);
    let check = |breaks: &[f64], polynomials: &[&[f64]]| Pieces { breaks, polynomials }.validate("load", 1.0);
    assert_eq!(check(&[0.5], &[line, line]), Ok(()));
    assert!(matches!(
        check(&[0.5], &[line]),
        Err(Error::Length { field: "load", expected: 2, found: 1, .. })
    ));
    let value = |found| matches!(found, Err(Error::Value { field: "load", place: Place::Index(_), .. }));
    assert!(value(check(&[1.5], &[line, line])));
    assert!(value(check(&[0.5], &[line, bad])));
}

#[test]
fn what_was_not_validated_is_no_number_rather_than_a_panic() {
    let steps = Steps { breaks: &[0.5_f64], values: &[1.0] };
    assert!(steps.value(0.7, 0.7).is_nan());
    let pieces = Pieces { breaks: &[0.5_f64], polynomials: &[&[1.0]] };
    assert!(pieces.value(0.7, 0.7).is_nan() && pieces.jet(0.7, 0.7)[1].is_nan());
    assert_eq!(pieces.jet(0.2, 0.2), [1.0, 0.0, 0.0]);
    for (x, y) in [(&[] as &[f64], &[] as &[f64]), (&[0.0], &[1.0]), (&[0.0, 1.0], &[1.0])] {
        assert!(Table { x, y }.value(0.5, 0.5).is_nan());
        let (p, slope) = Tabulated { penetration: x, pressure: y }.pressure(0.0, 0.5, 0.5);
        assert!(p.is_nan() && slope.is_nan());
    }
}

/// A line with a break, on [0, 2], that insists on what a profile is promised: points on the piece that is meant.
#[derive(Clone, Copy)]
struct Strict {
    breaks: [f64; 1],
    at_zero: f64,
    slope: f64,
}

impl Profile<f64> for Strict {
    type Piece = Cubic<f64>;
    type Slot = Flat<f64>;
    fn value(&self, x: f64, mid: f64) -> f64 {
        let [at] = self.breaks;
        let (from, to) = if mid < at { (0.0, at) } else { (at, 2.0) };
        assert!(mid > from && mid < to, "{mid} is inside no piece");
        // Rounding of a point in the element beside the break.
        assert!(x > from - 1e-12 && x < to + 1e-12, "{x} is not on the piece of {mid}");
        self.at_zero + self.slope * x
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
}

impl Smooth<f64> for Strict {
    fn jet(&self, x: f64, mid: f64) -> [f64; 3] {
        [self.value(x, mid), self.slope, 0.0]
    }
}

fn strict(at: f64, at_zero: f64, slope: f64) -> Strict {
    Strict { breaks: [at], at_zero, slope }
}

/// Everything that can be asked of a scene.
fn ask<M: Model<f64> + Copy>(scene: M) {
    let settings = Settings::default();
    let problem = Problem::new(scene, Mesh::uniform(12)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory).expect("memory");
    assert_eq!(beam.solve(&settings).expect("settings").status, Status::Converged);
    let parameters = [
        Parameter::Bending,
        Parameter::Axial,
        Parameter::Piezo,
        Parameter::Permittivity,
        Parameter::Stiffness,
        Parameter::Gap,
        Parameter::Mu1,
        Parameter::Mu2,
        Parameter::Transverse,
        Parameter::AxialLoad,
        Parameter::Force(0.3),
    ];
    for parameter in parameters {
        if parameter.is_in(&scene) {
            let tangent = beam.tangent(parameter).expect("a derivative");
            assert!(points(31, 2.0).iter().all(|&x| tangent.at(x).bending.is_finite()));
            assert!(tangent.of(Output::ContactForce).is_some_and(f64::is_finite));
        }
    }
    for output in [Output::ContactForce, Output::LeftMoment, Output::Bending(0.9)] {
        let adjoint = beam.adjoint(output).expect("a derivative");
        assert!(parameters.iter().filter_map(|&p| adjoint.to(p)).all(f64::is_finite));
    }
    beam.grazing().expect("a solution");
    let solution = beam.last().expect("a solution");
    assert!(points(31, 2.0).iter().all(|&x| solution.at(x).bending.is_finite()));
    assert!(solution.resultants().bending_energy > 0.0);
    assert!(!solution.warnings().is_empty(), "the gap does not vanish at the clamps");
    let mut finer = HeapWorkspace::new();
    assert!(solution.certify(&mut finer, &settings).expect("memory").bending_estimate < 1e-2);
    for method in [Method::Gauss, Method::Elementwise, Method::BermudezMoreno(BermudezMoreno::default())] {
        beam.solve_by(&method, &settings).expect("settings");
    }
    let (mut one, mut two) = (HeapWorkspace::new(), HeapWorkspace::new());
    let found = Adaptive::new(Mesh::uniform(6), &mut one).solve(&scene, 1e-6, &settings).map(|f| f.reached);
    assert_eq!(found, Ok(Reached::Tolerance));
    let mut history = History::new(Mesh::uniform(12), &mut two);
    for _ in 0..2 {
        assert!(history.solve(&scene, &settings).is_ok());
    }
    let mut batch = Batch::<f64, _, 4>::new();
    let all = [scene; 4];
    batch
        .solve(&all, &Mesh::uniform(12), &settings, |_, solution| assert!(solution.is_ok()))
        .expect("settings");
}

#[test]
fn profiles_are_asked_for_points_of_the_piece_that_is_meant_and_of_no_other() {
    let beam = Beam {
        bending: strict(0.3, 5e3, 1e3),
        axial: strict(0.5, 1e5, 1e4),
        piezo: strict(0.7, 1e2, 10.0),
        permittivity: strict(0.9, 1.0, 0.1),
    };
    let (stiffness, gap) = (strict(1.1, 1e6, 1e6), strict(1.3, 1e-3, 1e-3));
    let load = Load { transverse: strict(1.7, 1e5, -6e4), axial: strict(1.9, 1e4, 1e4), points: () };
    let scene = || Scene::new(2.0, beam).load(load).potential(Potential { left: 1.0, right: 2.0 });
    let linear = scene().foundation(Foundation { law: Linear(stiffness), gap });
    ask(linear);
    let mu = strict(1.5, 1.0, 0.5);
    let (truncation, potential_truncation) = (1e-2, 0.5);
    ask(linear.conduction(Conduction { mu1: mu, mu2: (), truncation, potential_truncation }));
    ask(linear.conduction(Conduction { mu1: (), mu2: mu, truncation, potential_truncation }));
    let curved = scene().foundation(Foundation { law: Power { stiffness, exponent: 1.5 }, gap });
    ask(curved.conduction(Conduction { mu1: mu, mu2: mu, truncation, potential_truncation }));
}
