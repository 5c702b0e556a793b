//! Derivatives: against differences of solves, closed forms, and each other.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on fails")]

mod common;

use common::strong::{Numbers, numbers};
use common::{Full, Shape, named, suite, tolerances as tol};
use piezobeam::{
    Beam, Conduction, Curve, Foundation, Grazing, HeapWorkspace, Law, Linear, Load, Mesh, Model, Output,
    Parameter, PointLoad, Potential, Power, Prepared, Problem, Scene, SensitivityError, Settings, Solution,
    Status, Steps,
};
use proptest::prelude::*;
use std::cell::Cell;

/// A scene of the suite with concentrated loads.
type Loaded = Scene<
    f64,
    Beam<Shape, Shape, Shape, Shape>,
    Foundation<Power<f64, Shape>, Shape>,
    Conduction<f64, Shape, Shape>,
    Load<Shape, Shape, [PointLoad<f64>; 2]>,
    Potential<f64>,
>;

const TIGHT: Settings<f64> = Settings { stop: 1e-13, max_visits: None };

fn scaled(shape: &Shape, factor: f64) -> Shape {
    match shape {
        Shape::Number(v) => Shape::Number(factor * v),
        Shape::Pieces { breaks, polynomials } => Shape::Pieces {
            breaks: breaks.clone(),
            polynomials: polynomials.iter().map(|p| p.iter().map(|c| factor * c).collect()).collect(),
        },
    }
}

/// The scene with two small concentrated loads, where the scene's size puts them.
fn loaded(scene: &Full) -> Loaded {
    let Scene { length, beam, foundation, conduction, load, potential } = scene.clone();
    let size = match &load.transverse {
        Shape::Number(v) => v.abs(),
        Shape::Pieces { polynomials, .. } => {
            polynomials.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()))
        }
    };
    let force = 0.01 * size * length;
    let points = [
        PointLoad { x: 0.23 * length, force, moment: 0.01 * force * length },
        PointLoad { x: 0.71 * length, force: -0.5 * force, moment: 0.02 * force * length },
    ];
    let load = Load { transverse: load.transverse, axial: load.axial, points };
    Scene { length, beam, foundation, conduction, load, potential }
}

/// Shares of conduction: none, onto the beam, into the potential, both.
const CONDUCTIONS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];

fn conducting(scene: &Loaded, [mu1, mu2]: [f64; 2]) -> Loaded {
    let mut scene = scene.clone();
    scene.conduction.mu1 = scaled(&scene.conduction.mu1, mu1);
    scene.conduction.mu2 = scaled(&scene.conduction.mu2, mu2);
    scene
}

/// The scene with a parameter moved by `step`, and what the step is in the parameter's unit.
fn moved(scene: &Loaded, parameter: Parameter<f64>, step: f64) -> (Loaded, f64) {
    let mut scene = scene.clone();
    let factor = 1.0 + step;
    let mut by = step;
    match parameter {
        Parameter::Bending => scene.beam.bending = scaled(&scene.beam.bending, factor),
        Parameter::Axial => scene.beam.axial = scaled(&scene.beam.axial, factor),
        Parameter::Piezo => scene.beam.piezo = scaled(&scene.beam.piezo, factor),
        Parameter::Permittivity => scene.beam.permittivity = scaled(&scene.beam.permittivity, factor),
        Parameter::Stiffness => {
            scene.foundation.law.stiffness = scaled(&scene.foundation.law.stiffness, factor);
        }
        Parameter::Gap => scene.foundation.gap = scaled(&scene.foundation.gap, factor),
        Parameter::Mu1 => scene.conduction.mu1 = scaled(&scene.conduction.mu1, factor),
        Parameter::Mu2 => scene.conduction.mu2 = scaled(&scene.conduction.mu2, factor),
        Parameter::Transverse => scene.load.transverse = scaled(&scene.load.transverse, factor),
        Parameter::AxialLoad => scene.load.axial = scaled(&scene.load.axial, factor),
        Parameter::PointForce(i) => {
            by = step * scene.load.points[0].force;
            scene.load.points[i].force += by;
        }
        Parameter::PointMoment(i) => {
            by = step * scene.load.points[0].force * scene.length;
            scene.load.points[i].moment += by;
        }
        Parameter::LeftPotential => scene.potential.left += step,
        Parameter::RightPotential => scene.potential.right += step,
        other => panic!("{other:?} is no number of the scene"),
    }
    (scene, by)
}

const PARAMETERS: [Parameter<f64>; 16] = [
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
    Parameter::PointForce(0),
    Parameter::PointForce(1),
    Parameter::PointMoment(0),
    Parameter::PointMoment(1),
    Parameter::LeftPotential,
    Parameter::RightPotential,
];

/// Outputs of a beam of this length: at nodes, and between them.
fn outputs(length: f64) -> Vec<Output<f64>> {
    let mut list = vec![
        Output::ContactForce,
        Output::LeftForce,
        Output::RightForce,
        Output::LeftMoment,
        Output::RightMoment,
    ];
    for share in [0.25, 0.5, 0.6137] {
        let x = share * length;
        list.extend([
            Output::Bending(x),
            Output::Slope(x),
            Output::Moment(x),
            Output::Shear(x),
            Output::Stretching(x),
            Output::Potential(x),
            Output::AxialForce(x),
            Output::ElectricDisplacement(x),
        ]);
    }
    list
}

fn value<M: Model<f64>>(solution: &Solution<'_, f64, M>, output: Output<f64>) -> f64 {
    let all = solution.resultants();
    let electric = |value: Option<f64>| value.expect("a scene with everything");
    match output {
        Output::Bending(x) => solution.at(x).bending,
        Output::Slope(x) => solution.at(x).slope,
        Output::Moment(x) => solution.at(x).moment,
        Output::Shear(x) => solution.at(x).shear,
        Output::Stretching(x) => electric(solution.at(x).stretching),
        Output::Potential(x) => electric(solution.at(x).potential),
        Output::AxialForce(x) => electric(solution.at(x).axial_force),
        Output::ElectricDisplacement(x) => electric(solution.at(x).electric_displacement),
        Output::ContactForce => all.contact_force,
        Output::LeftForce => all.left_force,
        Output::RightForce => all.right_force,
        Output::LeftMoment => all.left_moment,
        Output::RightMoment => all.right_moment,
        other => panic!("{other:?} is new"),
    }
}

/// The outputs; `None` where the solve ended above what differences can bear.
fn values(scene: &Loaded, n: usize, outputs: &[Output<f64>]) -> Option<Vec<f64>> {
    let problem = Problem::new(scene, Mesh::uniform(n)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &TIGHT).expect("settings in range");
    let good = matches!(solution.report().status, Status::Converged | Status::ToleranceBelowFloor);
    good.then(|| outputs.iter().map(|&output| value(&solution, output)).collect())
}

/// Calls `look` with the scene, solved.
fn prepared<M: Model<f64>, R>(
    scene: M,
    mesh: Mesh<'_, f64>,
    settings: &Settings<f64>,
    look: impl FnOnce(&mut Prepared<'_, f64, M>) -> R,
) -> R {
    let problem = Problem::new(scene, mesh).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let mut prepared = problem.prepare(&mut memory).expect("memory that grows");
    let report = prepared.solve(settings).expect("settings in range");
    assert_eq!(report.status, Status::Converged, "{report:?}");
    look(&mut prepared)
}

/// Derivatives of `outputs` by differences of order four, from one and two steps on both sides, and what order two
/// is off by.
fn differences(
    scene: &Loaded,
    n: usize,
    parameter: Parameter<f64>,
    step: f64,
    outputs: &[Output<f64>],
) -> Option<(Vec<f64>, Vec<f64>)> {
    let at = |share: f64| values(&moved(scene, parameter, share * step).0, n, outputs);
    let by = moved(scene, parameter, step).1;
    let (one, minus_one, two, minus_two) = (at(1.0)?, at(-1.0)?, at(2.0)?, at(-2.0)?);
    let narrow = |i: usize| (one[i] - minus_one[i]) / (2.0 * by);
    let wide = |i: usize| (two[i] - minus_two[i]) / (4.0 * by);
    let all = 0..outputs.len();
    let best = all.clone().map(|i| (4.0 * narrow(i) - wide(i)) / 3.0).collect();
    Some((best, all.map(|i| (narrow(i) - wide(i)).abs() / 3.0).collect()))
}

/// The unit in which an output's derivatives are compared: outputs of one kind have one.
fn kind(output: Output<f64>) -> usize {
    match output {
        Output::Bending(_) => 0,
        Output::Slope(_) => 1,
        Output::Moment(_) | Output::LeftMoment | Output::RightMoment => 2,
        Output::Shear(_) | Output::LeftForce | Output::RightForce | Output::ContactForce => 3,
        Output::Stretching(_) => 4,
        Output::Potential(_) => 5,
        Output::AxialForce(_) => 6,
        Output::ElectricDisplacement(_) => 7,
        other => panic!("{other:?} is new"),
    }
}

/// Elements of the suite's scenes here.
const SAMPLES: usize = 200;

/// For each output the largest of `values` among those of its kind.
fn sizes(outputs: &[Output<f64>], values: &[f64]) -> Vec<f64> {
    let size = |output: &Output<f64>| {
        let alike = outputs.iter().zip(values).filter(|(other, _)| kind(**other) == kind(*output));
        alike.fold(0.0_f64, |most, (_, value)| most.max(value.abs()))
    };
    outputs.iter().map(size).collect()
}

/// Sizes of the outputs themselves; forces, stretching and fluxes count what cancels in them.
fn levels(scene: &Loaded, outputs: &[Output<f64>], values: &[f64]) -> Vec<f64> {
    let mut levels = sizes(outputs, values);
    let most = |shape: &Shape| match shape {
        Shape::Number(v) => v.abs(),
        Shape::Pieces { polynomials, .. } => {
            polynomials.iter().map(|p| p.iter().sum::<f64>().abs()).fold(0.0, f64::max)
        }
    };
    let gap = match &scene.foundation.gap {
        Shape::Number(_) => 0.0,
        Shape::Pieces { polynomials, .. } => {
            polynomials.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs()))
        }
    };
    let potential =
        outputs.iter().zip(values).filter(|(o, _)| kind(**o) == 5).fold(0.0_f64, |m, (_, v)| m.max(v.abs()));
    for (level, output) in levels.iter_mut().zip(outputs) {
        *level += match kind(*output) {
            2 | 3 => most(&scene.beam.bending) * gap,
            4 => most(&scene.beam.piezo) * potential / most(&scene.beam.axial),
            6 => most(&scene.beam.piezo) * potential / scene.length,
            7 => most(&scene.beam.permittivity) * potential / scene.length,
            _ => 0.0,
        };
    }
    levels
}

/// Complaints about tangents that are not differences of solves.
fn against_differences(
    name: &str,
    scene: &Loaded,
    n: usize,
    step: f64,
    tolerance: f64,
) -> Option<Vec<String>> {
    let outputs = outputs(scene.length);
    let mut complaints = Vec::new();
    let levels = levels(scene, &outputs, &values(scene, n, &outputs)?);
    prepared(scene, Mesh::uniform(n), &Settings::default(), |beam| {
        for parameter in PARAMETERS {
            let tangent = beam.tangent(parameter).unwrap_or_else(|e| panic!("{name} {parameter:?}: {e}"));
            let (want, doubt) = differences(scene, n, parameter, step, &outputs)?;
            let by = moved(scene, parameter, step).1.abs();
            let (sizes, doubts) = (sizes(&outputs, &want), sizes(&outputs, &doubt));
            for (i, (&output, want)) in outputs.iter().zip(&want).enumerate() {
                let got = tangent.of(output).expect("an output of the scene");
                // Next to a touch solves are not smooth enough for order four, which order two shows.
                let own = if tolerance == tol::DERIVATIVE_RANDOM { doubts[i] } else { 0.0 };
                let allowed = tolerance * sizes[i] + tol::DIFFERENCE * levels[i] / by + own;
                if got.is_nan() || (got - want).abs() > allowed {
                    complaints.push(format!("{name}: d {output:?} / d {parameter:?} = {got:e}, differences {want:e} +- {allowed:.0e}"));
                }
            }
        }
        Some(complaints)
    })
}

fn settle(complaints: &[String]) {
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

#[test]
fn tangents_are_differences_of_solves_on_the_suite() {
    let mut complaints = Vec::new();
    for case in suite().iter().filter(|case| case.stiffness < tol::RIGID) {
        for shares in CONDUCTIONS {
            let tolerance = if case.name == "hertz" { tol::DERIVATIVE_HERTZ } else { tol::DERIVATIVE };
            let scene = conducting(&loaded(&case.scene), shares);
            let name = format!("{} {shares:?}", case.name);
            complaints
                .extend(against_differences(&name, &scene, SAMPLES, 1e-3, tolerance).expect("solutions"));
        }
    }
    settle(&complaints);
}

/// Complaints about adjoints that are not tangents, also with forces at these shares of the length; `None` where
/// there is no solution.
fn against_tangents(name: &str, scene: &Loaded, n: usize, forces: [f64; 4]) -> Option<Vec<String>> {
    let outputs = outputs(scene.length);
    let mut complaints = Vec::new();
    let levels = levels(scene, &outputs, &values(scene, n, &outputs)?);
    prepared(scene, Mesh::uniform(n), &Settings::default(), |beam| {
        let mut parameters = PARAMETERS.to_vec();
        parameters.extend(forces.map(|x| Parameter::Force(x * scene.length)));
        let columns = parameters.len();
        let mut rows = vec![0.0; outputs.len() * columns];
        for (&output, row) in outputs.iter().zip(rows.chunks_mut(columns)) {
            let adjoint = beam.adjoint(output).expect("an output of the scene");
            for (value, &parameter) in row.iter_mut().zip(&parameters) {
                *value = adjoint.to(parameter).expect("a parameter of the scene");
            }
        }
        for (j, &parameter) in parameters.iter().enumerate() {
            let tangent = beam.tangent(parameter).expect("a parameter of the scene");
            let want: Vec<f64> = outputs.iter().map(|&o| tangent.of(o).expect("an output")).collect();
            for (i, size) in sizes(&outputs, &want).into_iter().enumerate() {
                let got = rows[i * columns + j];
                // A number per newton is small where the scene's forces are large.
                let unit = match parameter {
                    Parameter::PointForce(_) | Parameter::Force(_) => scene.load.points[0].force,
                    Parameter::PointMoment(_) => scene.load.points[0].force * scene.length,
                    _ => 1.0,
                };
                let allowed =
                    tol::TRANSPOSED * size + tol::TRANSPOSED_FLOOR * levels[i] / unit.abs().max(1e-300);
                if got.is_nan() || (got - want[i]).abs() > allowed {
                    complaints.push(format!(
                        "{name}: d {:?} / d {parameter:?}: adjoint {got:e}, tangent {:e} +- {allowed:.0e}",
                        outputs[i], want[i]
                    ));
                }
            }
        }
    });
    Some(complaints)
}

#[test]
fn adjoints_are_tangents() {
    let mut complaints = Vec::new();
    for case in suite() {
        for shares in CONDUCTIONS {
            let scene = conducting(&loaded(&case.scene), shares);
            let name = format!("{} {shares:?}", case.name);
            let forces = [0.1, 0.25, 0.5013, 0.99];
            complaints.extend(against_tangents(&name, &scene, SAMPLES, forces).expect("a solution"));
        }
    }
    settle(&complaints);
}

/// Elements of random scenes.
const RANDOM: usize = 96;

/// Does the scene have a solution, at no kink of the forces?
fn is_smooth(scene: &Loaded) -> bool {
    let problem = Problem::new(scene, Mesh::uniform(RANDOM)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory).expect("memory that grows");
    let report = beam.solve(&TIGHT).expect("settings in range");
    report.status == Status::Converged && beam.grazing() == Ok(None)
}

/// As [`against_differences`], of a random scene: a kink within a step is none for a smaller one.
fn against_close_differences(scene: &Loaded) -> Option<Vec<String>> {
    let complaints = |step| against_differences("random", scene, RANDOM, step, tol::DERIVATIVE_RANDOM);
    complaints(1e-3).and_then(|wide| if wide.is_empty() { Some(wide) } else { complaints(3e-6) })
}

/// Random scenes with everything in them.
fn scenes() -> impl Strategy<Value = Loaded> {
    let list = |least: f64, most: f64, n: usize| prop::collection::vec(least..most, n..=n);
    let beam = (list(1.0, 3.0, 2), list(1.0, 3.0, 1), -1.0..1.0_f64, list(0.5, 2.0, 2));
    let ground = (1.0..4.5_f64, -0.3..0.6_f64, -0.5..0.5_f64, any::<bool>());
    let loads = (list(-1.0, 1.0, 3), -2.0..2.0_f64, list(-1.0, 1.0, 2));
    let electric = (0.0..1.0_f64, 0.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64, 0.3..3.0_f64);
    (beam, ground, loads, electric, 0.5..2.0_f64).prop_map(
        |(
            (bending, axial, piezo, permittivity),
            (k, gap, tilt, kinked),
            (f, axial_load, points),
            q,
            length,
        )| {
            let (mu1, mu2, left, right, truncation) = q;
            // Deflections of about 0.1.
            let scale = 40.0 / length.powi(4);
            let straight = vec![0.05 * gap, 0.05 * tilt];
            let gap = if kinked {
                let x = 0.37 * length;
                let back = vec![straight[0] + 2.0 * straight[1] * x, -straight[1]];
                Shape::Pieces { breaks: vec![x], polynomials: vec![straight, back] }
            } else {
                Shape::Pieces { breaks: vec![], polynomials: vec![straight] }
            };
            let steps = f.iter().map(|f| vec![scale * f]).collect();
            let number = Shape::Number;
            let slope = |c: Vec<f64>| Shape::Pieces {
                breaks: vec![],
                polynomials: vec![vec![c[0], 0.5 * (c[1] - c[0]) / length]],
            };
            Scene::new(
                length,
                Beam {
                    bending: slope(bending),
                    axial: number(axial[0]),
                    piezo: number(piezo),
                    permittivity: slope(permittivity),
                },
            )
            .foundation(Foundation {
                law: Power { stiffness: number(10f64.powf(k) / length.powi(4)), exponent: 1.0 },
                gap,
            })
            .conduction(Conduction::new(number(20.0 * mu1), number(20.0 * mu2), 0.1 * truncation))
            .load(Load {
                transverse: Shape::Pieces { breaks: vec![0.31 * length, 0.62 * length], polynomials: steps },
                axial: number(axial_load),
                points: [0.23, 0.71].map(|x| PointLoad {
                    x: x * length,
                    force: 0.1 * scale * length * points[usize::from(x > 0.5)],
                    moment: 0.02 * scale * length * length * points[usize::from(x < 0.5)],
                }),
            })
            .potential(Potential { left, right })
        },
    )
}

/// A scene with everything, by its numbers.
fn strong(n: &Numbers) -> Loaded {
    let pieces = |breaks: &[f64], values: &[f64]| Shape::Pieces {
        breaks: breaks.to_vec(),
        polynomials: values.iter().map(|&v| vec![v]).collect(),
    };
    let number = Shape::Number;
    let Beam { bending, axial, piezo, permittivity } = n.beam;
    let gap = [0.0, 0.0, 16.0, -32.0, 16.0].map(|c| c * n.gap).to_vec();
    loaded(
        &Scene::new(
            1.0,
            Beam {
                bending: number(bending),
                axial: number(axial),
                piezo: number(piezo),
                permittivity: number(permittivity),
            },
        )
        .foundation(Foundation {
            law: Power { stiffness: number(n.stiffness), exponent: 1.0 },
            gap: Shape::Pieces { breaks: vec![], polynomials: vec![gap] },
        })
        .conduction(Conduction {
            mu1: number(n.mu[0]),
            mu2: number(n.mu[1]),
            truncation: n.truncation,
            potential_truncation: n.potential_truncation,
        })
        .load(Load { transverse: pieces(&n.step, &n.load), axial: number(0.0), points: () })
        .potential(Potential { left: n.ends[0], right: n.ends[1] }),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]
    #[test]
    fn tangents_are_differences_of_solves_on_random_scenes(
        scene in scenes(),
        shares in prop::sample::select(CONDUCTIONS.to_vec()),
    ) {
        let scene = conducting(&scene, shares);
        prop_assume!(scene.load.points[0].force.abs() > 0.1 && is_smooth(&scene));
        let left = against_close_differences(&scene);
        prop_assume!(left.is_some());
        settle(&left.unwrap_or_default());
    }

    #[test]
    fn strong_coupling_has_derivatives_too(n in numbers(1.0)) {
        let scene = strong(&n);
        prop_assume!(n.stiffness <= tol::RESOLVABLE * n.beam.bending && is_smooth(&scene));
        let left = against_close_differences(&scene);
        prop_assume!(left.is_some());
        settle(&left.unwrap_or_default());
        // No force is in the element of an output, where a contact edge is integrated as the force divides it.
        settle(&against_tangents("random", &scene, RANDOM, [0.1, 0.28, 0.53, 0.99]).unwrap_or_default());
    }

    #[test]
    fn influence_is_reciprocal(scene in scenes(), x in 0.0..1.0_f64, y in 0.0..1.0_f64) {
        // One force for all: conduction into the potential does not act back, and that onto the beam is a
        // force of the penetration.
        let scene = conducting(&scene, [1.0, 0.0]);
        let n = 100;
        let problem = Problem::new(&scene, Mesh::uniform(n)).expect("a scene without mistakes");
        let mut memory = HeapWorkspace::new();
        let mut beam = problem.prepare(&mut memory).expect("memory that grows");
        beam.solve(&Settings::default()).expect("settings in range");
        prop_assume!(beam.last().is_some_and(|s| s.report().status == Status::Converged));
        let nodes: Vec<f64> = beam.last().map_or(vec![], |s| s.nodes().collect());
        let at = |share: f64| nodes[1 + (share * (nodes.len() - 2) as f64) as usize];
        let (x, y) = (at(x), at(y));
        let line = |beam: &mut Prepared<'_, f64, _>, to: f64, of: f64| {
            beam.adjoint(Output::Bending(to)).expect("a derivative").influence(of)
        };
        let (there, back) = (line(&mut beam, x, y), line(&mut beam, y, x));
        let size = (line(&mut beam, x, x) * line(&mut beam, y, y)).abs().sqrt();
        prop_assert!((there - back).abs() <= tol::RECIPROCAL * size, "{there:e} {back:e}");
    }

    #[test]
    fn loads_and_gap_together_scale_the_solution(scene in scenes()) {
        // Euler: with a linear law the solution without conduction is homogeneous of degree one in loads and
        // gap; and of degree zero in stiffnesses and loads.
        let scene = conducting(&scene, [0.0, 0.0]);
        let outputs = outputs(scene.length);
        let values = values(&scene, 64, &outputs).expect("a solution");
        let levels = levels(&scene, &outputs, &values);
        prepared(&scene, Mesh::uniform(64), &Settings::default(), |beam| {
            for ((&output, value), level) in outputs.iter().zip(&values).zip(levels) {
                let adjoint = beam.adjoint(output).expect("an output of the scene");
                let to = |parameter| adjoint.to(parameter).expect("a parameter of the scene");
                let points: f64 = (0..2).map(|i| {
                    let point = scene.load.points[i];
                    point.force * to(Parameter::PointForce(i)) + point.moment * to(Parameter::PointMoment(i))
                }).sum();
                let potentials = scene.potential.left * to(Parameter::LeftPotential)
                    + scene.potential.right * to(Parameter::RightPotential);
                let loads = to(Parameter::Transverse) + points;
                let one = loads + to(Parameter::Gap) + to(Parameter::AxialLoad) + potentials;
                assert!((one - value).abs() <= tol::EULER * level, "{output:?}: {one:e} for {value:e}");
                let stiffness = to(Parameter::Bending) + to(Parameter::Stiffness);
                if let Output::Bending(_) | Output::Slope(_) = output {
                    assert!((stiffness + loads).abs() <= tol::EULER * level, "{output:?}: {stiffness:e} {loads:e}");
                }
                if let Output::Stretching(_) | Output::Potential(_) = output {
                    let coefficients =
                        to(Parameter::Axial) + to(Parameter::Piezo) + to(Parameter::Permittivity);
                    let rest = coefficients + to(Parameter::AxialLoad);
                    assert!(rest.abs() <= tol::EULER * level, "{output:?}: {rest:e}");
                }
            }
        });
    }
}

#[test]
fn a_beam_without_contact_has_the_textbooks_influence_lines() {
    let (length, c, f) = (2.0_f64, 300.0, 70.0);
    let scene = Scene::new(length, Beam::elastic(c)).load(Load { transverse: f, axial: (), points: () });
    prepared(scene, Mesh::uniform(7), &Settings::default(), |beam| {
        // Clamped at both ends, unit force at a: reaction b^2 (3 a + b) / L^3, moment a b^2 / L^2 on the left.
        for share in [0.0, 0.1, 0.4, 0.5, 0.77, 1.0] {
            let (a, b) = (share * length, (1.0 - share) * length);
            let left = beam.adjoint(Output::LeftForce).expect("a reaction").influence(a);
            assert!((left + b * b * (3.0 * a + b) / length.powi(3)).abs() < 1e-12, "{share} {left}");
            let moment = beam.adjoint(Output::LeftMoment).expect("a moment").influence(a);
            assert!((moment - a * b * b / length.powi(2)).abs() < 1e-12, "{share} {moment}");
            let right = beam.adjoint(Output::RightForce).expect("a reaction").influence(a);
            assert!((right + a * a * (3.0 * b + a) / length.powi(3)).abs() < 1e-12, "{share} {right}");
            // a^3 b^3 / (3 C L^3) under the force, also inside an element.
            let under = beam.adjoint(Output::Bending(a)).expect("a deflection").influence(a);
            assert!((under - (a * b).powi(3) / (3.0 * c * length.powi(3))).abs() < 1e-15, "{share} {under}");
        }
        let tangent = beam.tangent(Parameter::Transverse).expect("a load");
        let solution = tangent.solution().at(0.3);
        let rate = tangent.at(0.3);
        for (rate, value) in [(rate.bending, solution.bending), (rate.moment, solution.moment)] {
            assert!((rate - value).abs() < 1e-13 * value.abs());
        }
    });
}

#[test]
fn a_long_beam_on_its_foundation_answers_as_an_infinite_one() {
    let (length, c, k) = (40.0, 1.0, 4.0_f64);
    let beta = (k / (4.0 * c)).powf(0.25);
    let scene = Scene::new(length, Beam::elastic(c))
        .foundation(Foundation { law: Linear(k), gap: () })
        .load(Load { transverse: 1.0, axial: (), points: () });
    prepared(scene, Mesh::uniform(2000), &Settings::default(), |beam| {
        let adjoint = beam.adjoint(Output::Bending(20.0)).expect("a deflection");
        for x in [20.0, 20.5, 21.37, 19.0] {
            let y: f64 = beta * (x - 20.0_f64).abs();
            let want = beta / (2.0 * k) * (-y).exp() * (y.cos() + y.sin());
            assert!((adjoint.influence(x) - want).abs() < 1e-8 * beta / k, "{x}");
        }
        // Far from the clamps xi = f / k.
        assert!((adjoint.to(Parameter::Transverse).expect("a load") - 1.0 / k).abs() < 1e-8);
        assert!((adjoint.to(Parameter::Stiffness).expect("a law") + 1.0 / k).abs() < 1e-7);
        assert!(adjoint.to(Parameter::Bending).expect("a stiffness").abs() < 1e-7);
        // All of a further force goes to the foundation.
        let contact = beam.adjoint(Output::ContactForce).expect("contact").influence(20.0);
        assert!((contact - 1.0).abs() < 1e-7, "{contact}");
    });
}

#[test]
fn a_force_at_a_node_is_a_concentrated_load_there() {
    let scene = conducting(&loaded(&named("coupled-partial").scene), [1.0, 0.0]);
    prepared(&scene, Mesh::uniform(50), &Settings::default(), |beam| {
        let x = scene.load.points[0].x;
        for output in outputs(scene.length) {
            let of = |beam: &mut Prepared<'_, f64, _>, parameter| {
                beam.tangent(parameter).expect("a force").of(output).expect("an output")
            };
            let (load, force) = (of(beam, Parameter::PointForce(0)), of(beam, Parameter::Force(x)));
            assert!((load - force).abs() <= 1e-12 * load.abs(), "{output:?} {load:e} {force:e}");
        }
    });
}

#[test]
fn the_matrix_is_the_same_row_by_row_and_column_by_column() {
    let scene = conducting(&loaded(&named("partial").scene), [1.0, 0.0]);
    prepared(&scene, Mesh::uniform(50), &Settings::default(), |beam| {
        let outputs = [Output::Bending(0.5), Output::ContactForce];
        let parameters = [Parameter::Bending, Parameter::Stiffness, Parameter::Transverse];
        let mut wide = [0.0; 6];
        beam.derivatives(&outputs, &parameters, &mut wide).expect("room for six");
        for (j, &parameter) in parameters.iter().enumerate() {
            let mut column = [0.0; 2];
            beam.derivatives(&outputs, &[parameter], &mut column).expect("room for two");
            for i in 0..2 {
                let differ = (column[i] - wide[3 * i + j]).abs();
                assert!(differ <= 1e-10 * column[i].abs(), "{:?} {parameter:?}", outputs[i]);
            }
        }
        let error = SensitivityError::Length { expected: 6, found: 5 };
        assert_eq!(beam.derivatives(&outputs, &parameters, &mut [0.0; 5]), Err(error));
        beam.derivatives(&[], &[], &mut []).expect("nothing is asked for");
        beam.derivatives(&outputs, &[], &mut []).expect("nothing is asked for");
        beam.derivatives(&[], &parameters, &mut []).expect("nothing is asked for");
    });
}

#[test]
fn what_is_not_there_has_no_derivative() {
    let scene = Scene::new(1.0, Beam::elastic(1.0)).load(Load { transverse: 1.0, axial: (), points: () });
    let problem = Problem::new(scene, Mesh::uniform(4)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory).expect("memory that grows");
    assert!(beam.last().is_none());
    assert!(matches!(beam.tangent(Parameter::Bending), Err(SensitivityError::Unsolved)));
    assert_eq!(beam.grazing(), Err(SensitivityError::Unsolved));
    beam.solve(&Settings::default()).expect("settings in range");
    for absent in [Parameter::Piezo, Parameter::Gap, Parameter::PointForce(0), Parameter::LeftPotential] {
        assert!(matches!(beam.tangent(absent), Err(SensitivityError::Absent)), "{absent:?}");
    }
    assert!(matches!(beam.adjoint(Output::Potential(0.5)), Err(SensitivityError::Absent)));
    assert!(matches!(beam.adjoint(Output::Bending(f64::NAN)), Err(SensitivityError::Absent)));
    let tangent = beam.tangent(Parameter::Bending).expect("a stiffness");
    assert_eq!(tangent.of(Output::ContactForce), None);
    assert_eq!(tangent.at(0.5).potential, None);
    let capped = Settings { max_visits: Some(1), ..Settings::default() };
    beam.solve(&capped).expect("settings in range");
    let refused = beam.tangent(Parameter::Bending).err().expect("no solution");
    assert_eq!(refused, SensitivityError::NotConverged(Status::VisitLimit));
    assert!(refused.to_string().contains("visit_limit"));
}

#[test]
fn the_solution_survives_its_derivatives() {
    let scene = loaded(&named("coupled-partial").scene);
    prepared(&scene, Mesh::uniform(100), &Settings::default(), |beam| {
        let fields = |beam: &Prepared<'_, f64, _>| {
            beam.last().map(|s| (*s.report(), [0.1, 0.33, 0.8].map(|x| s.at(x)), s.resultants()))
        };
        let before = fields(beam);
        let _ = beam.tangent(Parameter::Gap).expect("a gap").at(0.4);
        assert_eq!(fields(beam), before);
        let _ = beam.adjoint(Output::Potential(0.4)).expect("a potential").influence(0.3);
        assert_eq!(fields(beam), before);
        beam.solve(&Settings::default()).expect("settings in range");
        assert_eq!(fields(beam), before);
    });
}

#[test]
fn single_precision_has_derivatives() {
    let scene = Scene::new(
        1.0_f32,
        Beam { bending: 5000.0_f32, axial: 1e5_f32, piezo: 100.0_f32, permittivity: 1.0_f32 },
    )
    .foundation(Foundation { law: Linear(1e6_f32), gap: () })
    .conduction(Conduction::new(10.0_f32, 0.0_f32, 1.0))
    .load(Load {
        transverse: Steps { breaks: &[0.5_f32], values: &[1e6_f32, -1e6] },
        axial: 1e6_f32,
        points: (),
    })
    .potential(Potential { left: 1.0, right: 1.0 });
    let problem = Problem::new(scene, Mesh::uniform(64)).expect("a scene");
    let mut memory = HeapWorkspace::new();
    let mut beam = problem.prepare(&mut memory).expect("memory that grows");
    let report = beam.solve(&Settings::default()).expect("settings in range");
    assert_eq!(report.status, Status::Converged);
    let double = Scene::new(1.0, Beam { bending: 5000.0, axial: 1e5, piezo: 100.0, permittivity: 1.0 })
        .foundation(Foundation { law: Linear(1e6), gap: () })
        .conduction(Conduction::new(10.0, 0.0, 1.0))
        .load(Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: 1e6, points: () })
        .potential(Potential { left: 1.0, right: 1.0 });
    prepared(double, Mesh::uniform(64), &Settings::default(), |want| {
        for (single, double) in [
            (Parameter::Bending, Parameter::Bending),
            (Parameter::Stiffness, Parameter::Stiffness),
            (Parameter::Transverse, Parameter::Transverse),
        ] {
            for (output, precise) in [
                (Output::Bending(0.25), Output::Bending(0.25)),
                (Output::ContactForce, Output::ContactForce),
                (Output::RightMoment, Output::RightMoment),
            ] {
                let want = want.tangent(double).expect("a derivative").of(precise).expect("an output");
                let got = beam.tangent(single).expect("a derivative").of(output).expect("an output");
                let back = beam.adjoint(output).expect("a derivative").to(single).expect("a parameter");
                for got in [got, back] {
                    let error = (f64::from(got) - want).abs();
                    assert!(
                        error < tol::DERIVATIVE_SINGLE * want.abs(),
                        "{output:?} {single:?} {got} {want}"
                    );
                }
            }
        }
        assert_eq!(beam.grazing(), Ok(None));
    });
}

#[test]
fn contact_edges_are_no_grazing_and_touches_are() {
    for case in suite() {
        for shares in CONDUCTIONS {
            for n in [50, 1000] {
                let scene = conducting(&loaded(&case.scene), shares);
                let found = prepared(&scene, Mesh::uniform(n), &Settings::default(), |beam| beam.grazing());
                assert_eq!(found, Ok(None), "{} {shares:?} {n}", case.name);
            }
        }
    }
    let grazing = |load: f64, gap: f64| {
        let scene = Scene::new(1.0, Beam::elastic(5000.0))
            .foundation(Foundation { law: Linear(1e8), gap })
            .load(Load { transverse: load, axial: (), points: () });
        prepared(scene, Mesh::uniform(100), &Settings::default(), |beam| beam.grazing())
    };
    let whole = Grazing::Stretch { from: 0.0, to: 1.0 };
    assert_eq!(grazing(0.0, 0.0), Ok(Some(whole)));
    // Midspan just reaches the gap.
    let reach = 1e6 / (384.0 * 5000.0);
    match grazing(1e6, reach * (1.0 + 1e-12)) {
        Ok(Some(Grazing::Touch { x })) => assert!((x - 0.5).abs() < 1e-3, "{x}"),
        other => panic!("{other:?}"),
    }
    assert_eq!(grazing(1e6, reach * 1.01), Ok(None));
    assert_eq!(grazing(1e6, reach * 0.99), Ok(None));
    // A law that starts without a slope has no kink, and its tangent is the free beam's.
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Power { stiffness: 1e8, exponent: 2.0 }, gap: () })
        .load(Load { transverse: 0.0, axial: (), points: () });
    prepared(scene, Mesh::uniform(100), &Settings::default(), |beam| {
        assert_eq!(beam.grazing(), Ok(None));
        let under = beam.adjoint(Output::Bending(0.5)).expect("a deflection").influence(0.5);
        assert!((under - 1.0 / (192.0 * 5000.0)).abs() < 1e-15);
    });
    // A potential that stays at its truncation where the beam touches.
    let scene = Scene::new(1.0, Beam { bending: 1.0, axial: (), piezo: (), permittivity: 1.0 })
        .foundation(Foundation { law: Linear(10.0), gap: () })
        .conduction(Conduction::new(1.0, (), 0.5))
        .load(Load { transverse: 1.0, axial: (), points: () });
    let ends = |v: f64| scene.potential(Potential { left: v, right: v });
    let found = |v: f64| prepared(ends(v), Mesh::uniform(100), &Settings::default(), |beam| beam.grazing());
    assert!(matches!(found(0.5), Ok(Some(Grazing::Stretch { .. }))));
    assert_eq!(found(0.4), Ok(None));
    assert_eq!(found(0.6), Ok(None));
}

#[test]
fn stretching_alone_has_the_derivatives_of_its_closed_form() {
    // u = f x (L - x) / 2 EA: per relative change of EA it falls by itself, per relative change of f it grows so.
    let beam = Beam { bending: 1.0, axial: 50.0, piezo: (), permittivity: () };
    let scene = Scene::new(2.0, beam).load(Load { transverse: (), axial: 30.0, points: () });
    prepared(scene, Mesh::uniform(16), &Settings::default(), |beam| {
        for x in [0.25, 0.8, 1.5] {
            let u = 30.0 * x * (2.0 - x) / 100.0;
            let stiffer = beam.tangent(Parameter::Axial).expect("a stiffness").at(x).stretching;
            assert!((stiffer.expect("stretching") + u).abs() < tol::EXACT, "{x}: {stiffer:?}");
            let adjoint = beam.adjoint(Output::Stretching(x)).expect("stretching");
            let (axial, load) = (adjoint.to(Parameter::Axial), adjoint.to(Parameter::AxialLoad));
            assert!(axial.is_some_and(|by| (by + u).abs() < tol::EXACT), "{x}: {axial:?}");
            assert!(load.is_some_and(|by| (by - u).abs() < tol::EXACT), "{x}: {load:?}");
        }
    });
}

#[test]
fn a_potential_alone_has_the_derivatives_of_its_closed_form() {
    // q is the straight line between its ends.
    let beam = Beam { bending: 1.0, axial: (), piezo: (), permittivity: 3.0 };
    let scene = Scene::new(2.0, beam).potential(Potential { left: 1.0, right: -2.0 });
    prepared(scene, Mesh::uniform(16), &Settings::default(), |beam| {
        let near = |found: Option<f64>, want: f64| {
            assert!(found.is_some_and(|found| (found - want).abs() < tol::EXACT), "{found:?} {want}");
        };
        for x in [0.25, 0.8, 1.5] {
            for (end, share) in
                [(Parameter::LeftPotential, 1.0 - 0.5 * x), (Parameter::RightPotential, 0.5 * x)]
            {
                near(beam.tangent(end).expect("a potential").at(x).potential, share);
                near(beam.adjoint(Output::Potential(x)).expect("a potential").to(end), share);
            }
            near(beam.tangent(Parameter::Permittivity).expect("a permittivity").at(x).potential, 0.0);
            let adjoint = beam.adjoint(Output::Potential(x)).expect("a potential");
            near(adjoint.to(Parameter::Permittivity), 0.0);
            for absent in [Parameter::Axial, Parameter::Gap, Parameter::Mu1, Parameter::PointForce(0)] {
                assert_eq!(adjoint.to(absent), None, "{absent:?}");
            }
            near(adjoint.solution().at(x).potential, 1.0 - 1.5 * x);
        }
        // Nothing touches, so nothing is at a kink.
        assert_eq!(beam.grazing(), Ok(None));
    });
}

#[test]
fn the_gap_moves_with_the_gap_alone() {
    let scene = Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(1e8), gap: 0.01 })
        .load(Load { transverse: 1e6, axial: (), points: () });
    prepared(scene, Mesh::uniform(20), &Settings::default(), |beam| {
        assert_eq!(beam.tangent(Parameter::Gap).expect("a gap").at(0.4).gap, Some(0.01));
        assert_eq!(beam.tangent(Parameter::Bending).expect("a stiffness").at(0.4).gap, Some(0.0));
    });
}

#[test]
fn a_law_that_changes_its_mind_has_no_derivative_and_is_named() {
    for bad in [(f64::NAN, 1.0), (1.0, f64::INFINITY), (-1.0, 1.0), (1.0, -1.0)] {
        let changed = Cell::new(false);
        let law = Law(|_: f64, r: f64| if changed.get() { bad } else { (1e6 * r, 1e6) });
        let scene = Scene::new(1.0, Beam::elastic(5.0)).foundation(Foundation { law, gap: () }).load(Load {
            transverse: 1e3,
            axial: (),
            points: (),
        });
        prepared(scene, Mesh::uniform(8), &Settings::default(), |beam| {
            changed.set(true);
            let refused = beam.tangent(Parameter::Bending).err();
            assert_eq!(refused, Some(SensitivityError::Law { element: 0 }), "{bad:?}");
            let refused = beam.adjoint(Output::Bending(0.5)).err();
            assert_eq!(refused, Some(SensitivityError::Law { element: 0 }), "{bad:?}");
            changed.set(false);
            assert!(beam.tangent(Parameter::Bending).is_ok());
        });
    }
}

#[test]
fn a_derivative_beyond_the_number_format_is_a_breakdown() {
    // L^3 / 192 C and what goes with it overflow before an element's own stiffness does: the derivative's own number,
    // or a breakdown.
    for exponent in -303..-290 {
        let (length, stiffness) = (1e4_f64, 10_f64.powi(exponent));
        let scene = Scene::new(length, Beam::elastic(stiffness)).load(Load {
            transverse: 0.0,
            axial: (),
            points: (),
        });
        let problem = Problem::new(scene, Mesh::uniform(64)).expect("a scene");
        let mut memory = HeapWorkspace::new();
        let mut beam = problem.prepare(&mut memory).expect("memory that grows");
        if beam.solve(&Settings::default()).expect("settings in range").status != Status::Converged {
            continue;
        }
        match beam.adjoint(Output::Bending(0.5 * length)) {
            Ok(adjoint) => {
                let (found, want) =
                    (adjoint.influence(0.5 * length), length / 192.0 * (length / stiffness * length));
                assert!((found / want - 1.0).abs() < 1e-6, "{found:e}, {want:e}");
            }
            Err(SensitivityError::Breakdown { element }) => {
                assert!(element < 64);
            }
            Err(other) => panic!("{other:?}"),
        }
    }
}

#[test]
fn the_first_of_several_touches_is_found_and_a_stretch_that_ends_inside() {
    // No load: the penetration is the gap's negative, which touches zero at 0.2 and at 0.6.
    let angle = 5.0 * std::f64::consts::PI;
    let wave = Curve(|x: f64| {
        let (sine, cosine): (f64, f64) = (angle * x).sin_cos();
        [1.0 + cosine, -angle * sine, -angle * angle * cosine].map(|value| 1e-3 * value)
    });
    let scene = Scene::new(1.0, Beam::elastic(5000.0)).foundation(Foundation { law: Linear(1e3), gap: wave });
    let scene = scene.load(Load { transverse: 0.0, axial: (), points: () });
    prepared(scene, Mesh::uniform(200), &Settings::default(), |beam| match beam.grazing() {
        Ok(Some(Grazing::Touch { x })) => assert!((x - 0.2).abs() < 1e-3, "{x}"),
        other => panic!("{other:?}"),
    });
    // A potential at its truncation counts where the beam is pressed, here on the left.
    let transverse = Steps { breaks: &[0.5], values: &[1.0, -1.0] };
    let scene = Scene::new(1.0, Beam { bending: 1.0, axial: (), piezo: (), permittivity: 1.0 })
        .conduction(Conduction::new(1.0, (), 0.5))
        .potential(Potential { left: 0.5, right: 0.5 })
        .load(Load { transverse, axial: (), points: () });
    let found = |touches: bool| {
        let none = Scene { ..scene };
        if touches {
            let scene = none.foundation(Foundation { law: Linear(10.0), gap: () });
            prepared(scene, Mesh::uniform(100), &Settings::default(), |beam| beam.grazing())
        } else {
            // The potential presses without a foundation's law, too.
            prepared(none, Mesh::uniform(100), &Settings::default(), |beam| beam.grazing())
        }
    };
    // A current has no kink at the contact's edge, its truncation is far away.
    let scene =
        scene.conduction(Conduction { mu1: (), mu2: 1.0, truncation: 0.5, potential_truncation: 0.5 });
    let current = prepared(scene, Mesh::uniform(100), &Settings::default(), |beam| beam.grazing());
    assert_eq!(current, Ok(None));
    for touches in [true, false] {
        match found(touches) {
            Ok(Some(Grazing::Stretch { from, to })) => assert!(from == 0.0 && to < 0.6, "{from} {to}"),
            other => panic!("{other:?}"),
        }
    }
}
