//! Scenes made to break global convergence: bending alone on a monotone foundation has one solution, and it is
//! to be found whatever the numbers. The seed is fixed.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{Shape, fixed, halves, plain, points, relative, solved, tolerances as tol};
use piezobeam::{
    Beam, Compliance, Foundation, HeapWorkspace, Law, Linear, Load, Mesh, Model, Power, Problem, Report,
    Scene, Settings, Status, Steps, Warning,
};
use proptest::prelude::*;

/// A scene whose numbers are powers of ten.
#[derive(Clone, Debug)]
struct Hard {
    length: f64,
    bending: f64,
    stiffness: f64,
    exponent: f64,
    /// Loads in steps that bend the free beam by so many lengths.
    breaks: Vec<f64>,
    bends: Vec<f64>,
    /// Coefficients of the gap over the length, in x over the length.
    gap: Vec<f64>,
    n: usize,
    ratio: f64,
}

impl Hard {
    fn scene(&self) -> impl Model<f64> + use<> {
        self.on(Power { stiffness: self.stiffness, exponent: self.exponent })
    }

    /// The same on a foundation with the law `law`.
    fn on<W: Compliance<f64> + Copy>(&self, law: W) -> impl Model<f64> + use<W> {
        let Self { length, bending, .. } = *self;
        // f L^4 / (384 C) is what a clamped beam bends.
        let unit = 384.0 * bending / length.powi(3);
        let loads = self.bends.iter().map(|b| vec![b * unit]).collect();
        let gap = self.gap.iter().enumerate().map(|(i, c)| c * length / length.powi(i as i32)).collect();
        let breaks = self.breaks.iter().map(|x| x * length).collect();
        Scene::new(length, Beam::elastic(bending))
            .foundation(Foundation { law, gap: Shape::Pieces { breaks: vec![], polynomials: vec![gap] } })
            .load(Load { transverse: Shape::Pieces { breaks, polynomials: loads }, axial: (), points: () })
    }

    fn mesh(&self) -> Mesh<'static, f64> {
        Mesh::Graded { elements: self.n, ratio: self.ratio }
    }

    /// The foundation's stiffness against the beam's: k r^(a - 1) L^4 / C at a penetration of a hundredth.
    fn rigidity(&self) -> f64 {
        self.stiffness * (0.01 * self.length).powf(self.exponent - 1.0) * self.length.powi(4) / self.bending
    }
}

fn power_of_ten(exponents: std::ops::Range<f64>) -> impl Strategy<Value = f64> + Clone {
    exponents.prop_map(|exponent| 10.0_f64.powf(exponent))
}

fn signed(size: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = f64> + Clone {
    (size, any::<bool>()).prop_map(|(size, up)| if up { size } else { -size })
}

fn hard(rigidity: std::ops::Range<f64>) -> impl Strategy<Value = Hard> {
    let beam = (power_of_ten(-4.0..2.0), power_of_ten(-6.0..9.0));
    let exponent =
        prop_oneof![3 => Just(1.0), 1 => 1.0..4.0_f64, 1 => prop::sample::select(vec![1.5, 2.0, 3.0])];
    let load = (
        prop::collection::vec(0.01..0.99_f64, 0..4),
        prop::collection::vec(signed(power_of_ten(-5.0..0.0)), 4),
    );
    let depth = || signed(power_of_ten(-7.0..-0.5));
    let gap = prop_oneof![
        Just(vec![0.0]),
        depth().prop_map(|g| vec![g]),
        depth().prop_map(|g| vec![0.0, 0.0, 16.0 * g, -32.0 * g, 16.0 * g]),
        depth().prop_map(|g| vec![g, -4.0 * g, 4.0 * g]),
        (depth(), depth()).prop_map(|(g, slope)| vec![g, slope]),
    ];
    let mesh =
        (prop_oneof![1_usize..20, 1_usize..300], prop_oneof![2 => Just(1.0), 1 => power_of_ten(-2.0..2.0)]);
    (beam, power_of_ten(rigidity), exponent, load, gap, mesh).prop_map(
        |((length, bending), rigidity, exponent, (mut breaks, mut bends), gap, (n, ratio))| {
            breaks.sort_by(f64::total_cmp);
            breaks.dedup();
            bends.truncate(breaks.len() + 1);
            let per_stiffness = (0.01 * length).powf(exponent - 1.0) * length.powi(4) / bending;
            let stiffness = (rigidity / per_stiffness).clamp(1e-2, 1e18);
            Hard { length, bending, stiffness, exponent, breaks, bends, gap, n, ratio }
        },
    )
}

/// Solved, nowhere pulled, and with bounded work.
fn is_found<M: Model<f64>>(hard: &Hard, scene: M) -> Result<(), TestCaseError> {
    solved(scene, hard.mesh(), |s| {
        let report = *s.report();
        if report.status == Status::ToleranceBelowFloor {
            prop_assert!(report.residual <= tol::FLOORS * report.floor, "{:?}", report);
            prop_assert!(hard.rigidity() >= tol::RESOLVABLE, "{:e} {:?}", hard.rigidity(), report);
        } else {
            prop_assert_eq!(report.status, Status::Converged, "{:?}", report);
            prop_assert!(report.residual <= Settings::default().stop, "{:?}", report);
        }
        let (per_element, beside) = tol::HARD_VISITS;
        prop_assert!(report.element_visits <= per_element * report.elements + beside, "{:?}", report);
        for x in points(20, hard.length) {
            let f = s.at(x);
            prop_assert!(f.pressure >= Some(0.0), "{:?}", f);
            prop_assert!(f.bending.is_finite() && f.moment.is_finite(), "{:?}", f);
        }
        Ok(())
    })
}

/// Bending at `x`, if the solve converged; not of a foundation that was taken as rigid: the penetration is another there.
fn ends<M: Model<f64>>(scene: M, mesh: Mesh<'_, f64>, x: &[f64]) -> Option<Vec<f64>> {
    solved(scene, mesh, |s| {
        let rigid = s.warnings().iter().any(|warning| matches!(warning, Warning::Rigid { .. }));
        let sound = s.report().status == Status::Converged && !rigid;
        sound.then(|| x.iter().map(|&x| s.at(x).bending).collect())
    })
}

proptest! {
    #![proptest_config(fixed(2000))]

    #[test]
    fn a_foundation_of_any_stiffness_is_solved(hard in hard(-4.0..12.0)) {
        is_found(&hard, hard.scene())?;
    }

    #[test]
    fn a_foundation_that_is_all_but_rigid_is_solved(hard in hard(12.0..16.0)) {
        is_found(&hard, hard.scene())?;
    }

    // Under a linear law the contact's edges are iterated alone within a step, which a power of one does not know.
    #[test]
    fn a_linear_foundation_of_any_stiffness_is_solved_as_by_full_steps(hard in hard(-4.0..16.0)) {
        let hard = Hard { exponent: 1.0, ..hard };
        is_found(&hard, hard.on(Linear(hard.stiffness)))?;
        let x = points(20, hard.length);
        let alone = ends(hard.on(Linear(hard.stiffness)), hard.mesh(), &x);
        let full = ends(hard.scene(), hard.mesh(), &x);
        if let (Some(alone), Some(full)) = (alone, full) {
            let error = relative(&alone, &full);
            prop_assert!(error <= tol::ALONE, "{error:e}");
        }
    }
}

#[test]
fn edges_alone_take_few_full_steps() {
    for k in [1e8, 1e12, 1e16] {
        for n in [100, 1000] {
            let steps = |report: Report<f64>| report.iterations;
            let alone = solved(halves(k), Mesh::uniform(n), |s| *s.report());
            let full = Scene::new(1.0, Beam::elastic(5000.0))
                .foundation(Foundation { law: Power { stiffness: k, exponent: 1.0 }, gap: () })
                .load(plain(Steps { breaks: &[0.5], values: &[1e6, -1e6] }));
            let full = solved(full, Mesh::uniform(n), |s| *s.report());
            assert!(alone.status == Status::Converged && full.status == Status::Converged, "{k:e} {n}");
            assert!(steps(alone) <= tol::FULL_STEPS && 2 * steps(alone) <= steps(full) + 2, "{k:e} {n}");
        }
    }
}

#[test]
fn a_law_that_overflows_under_the_free_beam_is_solved() {
    for bending in [1.0, 1e-3] {
        for gap in [0.0, 0.1] {
            for n in [10, 100, 1000] {
                // The free beam bends by 1e3 / (384 C): e^(50 r) is no number there.
                let law = Law(|_: f64, r: f64| ((50.0 * r).exp() - 1.0, 50.0 * (50.0 * r).exp()));
                let scene = Scene::new(1.0, Beam::elastic(bending))
                    .foundation(Foundation { law, gap })
                    .load(Load { transverse: 1e3, axial: (), points: () });
                let problem = Problem::new(scene, Mesh::uniform(n)).expect("a scene");
                let mut memory = HeapWorkspace::new();
                let solution = problem.solve(&mut memory, &Settings::default()).expect("settings");
                let report = solution.report();
                assert_eq!(report.status, Status::Converged, "C = {bending}, gap {gap}, N = {n}: {report:?}");
                // In the middle the foundation carries the load: e^(50 r) - 1 = f.
                let middle = gap + 1e3_f64.ln() / 50.0;
                assert!((solution.at(0.5).bending - middle).abs() < 0.1 * middle);
            }
        }
    }
}

#[test]
fn single_precision_converges_or_says_that_it_cannot() {
    for n in [1000, 10_000, 30_000] {
        for stiffness in [1e2, 1e8, 1e12] {
            let load = piezobeam::Steps { breaks: &[0.5_f32], values: &[1e6, -1e6] };
            let scene = Scene::new(1.0_f32, Beam::elastic(5000.0))
                .foundation(Foundation { law: piezobeam::Linear(stiffness), gap: () })
                .load(Load { transverse: load, axial: (), points: () });
            let problem = Problem::new(scene, Mesh::uniform(n)).expect("a scene");
            let mut memory = HeapWorkspace::new();
            let report = *problem.solve(&mut memory, &Settings::default()).expect("settings").report();
            let ends = [Status::Converged, Status::ToleranceBelowFloor];
            assert!(ends.contains(&report.status), "k = {stiffness:e}, N = {n}: {report:?}");
        }
    }
}
