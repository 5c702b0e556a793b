//! What results, warnings and refusals say to people and to machines: each of them, so that none is mute.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

use piezobeam::{
    Beam, Conduction, Curve, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, Pieces, Polynomial,
    Potential, Power, Problem, Reached, Scene, SensitivityError, Settings, Status, Steps, Warning,
};
use std::collections::HashSet;

/// Names are lower snake case and no two are alike; sentences have no end and say what `parts` ask for.
fn says(all: &[(&str, String, &[&str])]) {
    let names: HashSet<_> = all.iter().map(|(name, ..)| name).collect();
    assert_eq!(names.len(), all.len());
    for (name, sentence, parts) in all {
        assert!(!name.is_empty() && name.chars().all(|c| c.is_ascii_lowercase() || c == '_'), "{name}");
        assert!(!sentence.is_empty() && !sentence.ends_with('.'), "{name}: {sentence}");
        for part in *parts {
            assert!(sentence.contains(part), "{name}: {sentence}");
        }
    }
}

#[test]
fn every_status_has_a_name_and_a_sentence_with_its_numbers() {
    let all: [(Status, &[&str]); 10] = [
        (Status::Converged, &["converged"]),
        (Status::VisitLimit, &["max_visits"]),
        (Status::Stagnation, &["stopped reducing the residual"]),
        (Status::Breakdown { element: 17 }, &["element 17", "singular or not finite"]),
        (Status::LawNotFinite { element: 18 }, &["element 18", "not finite"]),
        (Status::LawNotMonotone { element: 19 }, &["element 19", "negative pressure or slope"]),
        (Status::ToleranceBelowFloor, &["rounding", "larger stop"]),
        (Status::FoundationPulls { element: 20 }, &["element 20", "pulls", "no equilibrium"]),
        (Status::Cycle { period: 21 }, &["every 21 iterations"]),
        (Status::OwnEquations, &["its own equations"]),
    ];
    says(&all.map(|(status, parts)| (status.name(), status.to_string(), parts)));
}

#[test]
fn every_end_of_a_search_for_a_mesh_has_a_name_and_a_sentence() {
    let all: [(Reached, &[&str]); 4] = [
        (Reached::Tolerance, &["what was asked for"]),
        (Reached::Floor, &["rounding"]),
        (Reached::Capacity, &["memory"]),
        (Reached::Unsolved, &["not converged"]),
    ];
    says(&all.map(|(reached, parts)| (reached.name(), reached.to_string(), parts)));
}

#[test]
fn every_reason_for_no_derivative_says_where_and_what_to_do() {
    let all: [(&str, SensitivityError, &[&str]); 6] = [
        ("unsolved", SensitivityError::Unsolved, &["solve first"]),
        ("status", SensitivityError::NotConverged(Status::Stagnation), &["stagnation"]),
        ("absent", SensitivityError::Absent, &["lacks"]),
        ("length", SensitivityError::Length { expected: 6, found: 5 }, &["6 derivatives", "found 5"]),
        ("breakdown", SensitivityError::Breakdown { element: 7 }, &["element 7", "singular"]),
        ("law", SensitivityError::Law { element: 8 }, &["element 8", "not monotone"]),
    ];
    says(&all.map(|(name, error, parts)| (name, error.to_string(), parts)));
}

/// The warnings of a solution, as they are and in words.
fn warned<M: Model<f64>>(scene: M) -> (Vec<Warning<f64>>, Vec<String>) {
    let problem = Problem::new(scene, Mesh::uniform(40)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    let warnings = solution.warnings();
    (warnings.to_vec(), warnings.iter().map(ToString::to_string).collect())
}

fn plain(f: f64) -> Load<f64> {
    Load { transverse: f, axial: (), points: () }
}

#[test]
fn hypotheses_that_fail_are_warned_of_with_their_numbers() {
    let beam = Scene::new(1.0, Beam::elastic(5000.0)).load(plain(1e3));
    let (none, _) = warned(beam.foundation(Foundation { law: Linear(1e6), gap: () }));
    assert_eq!(none, []);

    let law = Power { stiffness: 1e6, exponent: 1.5 };
    let (found, said) = warned(beam.foundation(Foundation { law, gap: () }));
    assert_eq!(found, [Warning::LawNotLipschitz]);
    assert!(said[0].contains("not Lipschitz continuous") && said[0].contains("(2.7)"));

    // A gap of 0.1 + 0.2 x does not vanish at a clamp, nor does its slope.
    let (found, said) =
        warned(beam.foundation(Foundation { law: Linear(1e6), gap: Polynomial(&[0.1, 0.25]) }));
    let at = |x: f64| Warning::GapAtClamp { x, gap: 0.1 + 0.25 * x, slope: 0.25 };
    assert_eq!(found, [at(0.0), at(1.0)]);
    assert!(said[1].contains("x = 1 (gap 0.35, slope 0.25)"), "{}", said[1]);
}

#[test]
fn a_kink_of_the_gap_is_warned_of_and_a_break_without_one_is_not() {
    let beam = Scene::new(1.0, Beam::elastic(5000.0)).load(plain(1e3));
    let gapped = |size: f64, right: [f64; 3]| {
        let (left, right) = ([0.0, 0.0, size], right.map(|c| size * c));
        let gap = Pieces { breaks: &[0.25, 0.5], polynomials: &[&left, &left, &right] };
        let (found, said) = warned(beam.foundation(Foundation { law: Linear(1e6), gap }));
        let is_kink = |warning: &Warning<f64>| matches!(warning, Warning::GapKink { .. });
        (found.iter().position(is_kink).map(|i| (found[i], said[i].clone())), found.len())
    };
    // However small the slopes are.
    for size in [1.0, 1e-9] {
        // x^2 throughout: it does not vanish at the right clamp, and that is all. Rounding is no kink.
        assert_eq!(gapped(size, [0.0, 0.0, 1.0]), (None, 1));
        assert_eq!(gapped(size, [0.0, 0.0, 1.0 + f64::EPSILON]), (None, 1));
        // (1 - x)^2 from the middle on has the opposite slope there.
        let (kink, warnings) = gapped(size, [1.0, -2.0, 1.0]);
        let (kink, said) = kink.expect("a kink");
        assert_eq!((kink, warnings), (Warning::GapKink { x: 0.5 }, 1));
        assert!(said.contains("kink at x = 0.5"), "{said}");
    }
}

#[test]
fn failing_uniqueness_is_warned_of_with_the_smaller_margin() {
    let scene = |mu: f64| {
        Scene::new(1.0, Beam { bending: 5000.0, axial: (), piezo: (), permittivity: 1.0 })
            .foundation(Foundation { law: Linear(1e6), gap: () })
            .conduction(Conduction::new(mu, (), 1.0))
            .potential(Potential { left: 0.1, right: 0.1 })
            .load(plain(1e3))
    };
    assert_eq!(warned(scene(1.0)).0, []);
    // min eps / (c1^2 M) over mu1 / 2: pi^2 / (mu1 / 2)
    let (found, said) = warned(scene(100.0));
    let Some(&Warning::NotUnique { margin }) = found.first() else { unreachable!("{found:?}") };
    assert!((margin - std::f64::consts::PI.powi(2) / 50.0).abs() < 1e-15);
    assert!(said[0].contains("(2.15) fails (margin 0.197, 1 needed)"), "{}", said[0]);
}

#[test]
fn the_largest_conduction_counts_for_uniqueness_wherever_it_is() {
    let margins = |mu1: Polynomial<'_, f64>, stiffness: Steps<'_, f64>| {
        let scene = Scene::new(1.0, Beam { bending: stiffness, axial: (), piezo: (), permittivity: 1.0 })
            .foundation(Foundation { law: Linear(1e6), gap: () })
            .conduction(Conduction::new(mu1, (), 1.0))
            .potential(Potential { left: 0.1, right: 0.1 })
            .load(plain(1e3));
        let problem = Problem::new(scene, Mesh::uniform(10)).expect("a scene without mistakes");
        let mut memory = HeapWorkspace::new();
        let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
        solution.uniqueness()
    };
    let soft = Steps { breaks: &[0.9], values: &[5000.0, 1000.0] };
    let growing = margins(Polynomial(&[1.0, 2.0]), soft);
    let constant = margins(Polynomial(&[3.0]), Steps { breaks: &[], values: &[1000.0] });
    assert_eq!(growing, constant);
}

#[test]
fn large_strains_and_slopes_are_warned_of_where_they_are() {
    // u' = f (L / 2 - x) / EA is largest at a clamp: 10 %.
    let scene = Scene::new(1.0, Beam { bending: 5000.0, axial: 10.0, piezo: (), permittivity: () })
        .load(Load { transverse: 0.0, axial: 2.0, points: () });
    let (found, said) = warned(scene);
    let Some(&Warning::LargeStrain { strain, x }) = found.first() else { unreachable!("{found:?}") };
    assert!((strain.abs() - 0.1).abs() < 1e-12 && (x == 0.0 || x == 1.0), "{strain} at {x}");
    assert!(said[0].contains("10.000 % at x = "), "{}", said[0]);

    // f x (1 - x)(1 - 2x) / 12 C is largest at (3 - 3^(1/2)) / 6: f 3^(1/2) / 216 C.
    let scene = Scene::new(1.0, Beam::elastic(1.0)).load(plain(216.0));
    let (found, said) = warned(scene);
    let Some(&Warning::LargeSlope { slope, x }) = found.first() else { unreachable!("{found:?}") };
    assert!(slope.abs() > 1.7 && slope.abs() <= 3f64.sqrt() + 1e-12, "{slope} at {x}");
    assert!((x.min(1.0 - x) - 0.211).abs() < 0.02, "{x}");
    assert!(said[0].contains("the slope reaches") && said[0].contains("small rotations"), "{}", said[0]);
}

#[test]
fn a_foundation_taken_as_rigid_says_how_stiff_it_was_taken() {
    let transverse = Steps { breaks: &[0.5], values: &[1e6, -1e6] };
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e300), gap: () })
        .load(Load { transverse, axial: (), points: () });
    let (found, said) = warned(scene);
    let rigid = found.iter().position(|warning| matches!(warning, Warning::Rigid { .. })).expect("a warning");
    let Warning::Rigid { stiffness } = found[rigid] else { unreachable!() };
    // k h^4 / C = 1e7
    assert!((stiffness / (1e7 * 5000.0 * 40f64.powi(4)) - 1.0).abs() < 1e-9, "{stiffness:e}");
    assert!(said[rigid].contains(&format!("{stiffness:.1e} N/m^2")), "{}", said[rigid]);
}

#[test]
fn a_gap_by_a_curve_has_its_slope_at_the_clamps() {
    let gap = Curve(|x: f64| [0.01 * x, 0.01, 0.0]);
    let scene = Scene::new(1.0, Beam::elastic(5000.0)).load(plain(1e3));
    let (found, _) = warned(scene.foundation(Foundation { law: Linear(1e6), gap }));
    assert_eq!(found.len(), 2);
}
