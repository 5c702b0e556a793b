//! What the integration tests share: the reference suite and a profile of any shape.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses its own part")]

use piezobeam::{
    Beam, Conduction, Cubic, Error, Fields, Flat, Foundation, HeapWorkspace, Linear, Load, Mesh, Model,
    Potential, Power, Problem, Profile, Real, Report, Scene, Settings, Smooth, Solution, Steps,
};
use proptest::test_runner::{Config as ProptestConfig, RngAlgorithm, RngSeed};
use serde_json::Value;

pub mod honest;
pub mod random;
pub mod strong;
pub mod tolerances;

/// A profile of any of the suite's shapes.
#[derive(Clone, Debug)]
pub enum Shape {
    Number(f64),
    Pieces { breaks: Vec<f64>, polynomials: Vec<Vec<f64>> },
}

impl Shape {
    pub fn of(value: &Value) -> Self {
        let list = |v: &Value| -> Vec<f64> {
            v.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
        };
        if let Some(number) = value.as_f64() {
            return Self::Number(number);
        }
        if let Some(c) = value.get("poly") {
            return Self::Pieces { breaks: vec![], polynomials: vec![list(c)] };
        }
        let breaks = list(&value["breaks"]);
        let polynomials = match value.get("steps") {
            Some(steps) => list(steps).into_iter().map(|v| vec![v]).collect(),
            None => value["polys"].as_array().expect("polynomials").iter().map(list).collect(),
        };
        Self::Pieces { breaks, polynomials }
    }

    fn jet_at(&self, x: f64, mid: f64) -> [f64; 3] {
        match self {
            Self::Number(v) => [*v, 0.0, 0.0],
            Self::Pieces { breaks, polynomials } => {
                let c = &polynomials[breaks.partition_point(|&b| b <= mid)];
                let mut jet = [0.0; 3];
                for &c in c.iter().rev() {
                    jet = [jet[0] * x + c, jet[1] * x + jet[0], jet[2] * x + 2.0 * jet[1]];
                }
                jet
            }
        }
    }
}

impl Profile<f64> for Shape {
    type Piece = Cubic<f64>;
    type Slot = Flat<f64>;
    fn value(&self, x: f64, mid: f64) -> f64 {
        self.jet_at(x, mid)[0]
    }
    fn breaks(&self) -> &[f64] {
        match self {
            Self::Number(_) => &[],
            Self::Pieces { breaks, .. } => breaks,
        }
    }
    fn validate(&self, _: &'static str, _: f64) -> Result<(), Error> {
        Ok(())
    }
}

impl Smooth<f64> for Shape {
    fn jet(&self, x: f64, mid: f64) -> [f64; 3] {
        self.jet_at(x, mid)
    }
}

/// A scene of the suite with everything in it.
pub type Full = Scene<
    f64,
    Beam<Shape, Shape, Shape, Shape>,
    Foundation<Power<f64, Shape>, Shape>,
    Conduction<f64, Shape, Shape>,
    Load<Shape, Shape>,
    Potential<f64>,
>;

pub struct Case {
    pub name: String,
    pub scene: Full,
    pub stiffness: f64,
    pub reference: Value,
    pub whole: Value,
}

impl Case {
    pub fn column(&self, name: &str) -> Vec<f64> {
        let list = self.reference[name].as_array().expect("a column");
        list.iter().map(|v| v.as_f64().expect("a number")).collect()
    }
}

/// All scenes of the suite, by name.
pub fn suite() -> Vec<Case> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("the suite").map(|f| f.expect("a file").path()).collect();
    files.sort();
    files.iter().map(|path| case(&std::fs::read_to_string(path).expect("a scene"))).collect()
}

pub fn named(name: &str) -> Case {
    let path = format!("{}/tests/reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
    case(&std::fs::read_to_string(path).expect("a scene"))
}

fn case(text: &str) -> Case {
    let whole: Value = serde_json::from_str(text).expect("json");
    let s = &whole["scene"];
    let number = |key: &str| s[key].as_f64().expect("a number");
    let shape = |key: &str| Shape::of(&s[key]);
    let scene = Scene::new(
        number("length"),
        Beam {
            bending: shape("bending"),
            axial: shape("axial"),
            piezo: shape("piezo"),
            permittivity: shape("permittivity"),
        },
    )
    .foundation(Foundation {
        law: Power { stiffness: shape("stiffness"), exponent: number("exponent") },
        gap: shape("gap"),
    })
    .conduction(Conduction::new(shape("mu1"), shape("mu2"), number("truncation")))
    .load(Load { transverse: shape("f_perp"), axial: shape("f_bar"), points: () })
    .potential(Potential { left: number("q0"), right: number("qL") });
    let name = whole["name"].as_str().expect("a name").to_owned();
    let stiffness = number("stiffness");
    let reference = whole["reference"].clone();
    Case { name, scene, stiffness, reference, whole }
}

/// Largest difference of two columns over the largest value of the second.
pub fn relative(got: &[f64], want: &[f64]) -> f64 {
    let size = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let error = got.iter().zip(want).fold(0.0_f64, |m, (g, w)| m.max((g - w).abs()));
    if size == 0.0 { error } else { error / size }
}

/// Solves a scene with fresh memory and default settings, and looks at the solution.
pub fn solved<T: Real, M: Model<T>, R>(
    scene: M,
    mesh: Mesh<'_, T>,
    look: impl FnOnce(&Solution<'_, T, M>) -> R,
) -> R {
    let problem = Problem::new(scene, mesh).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    look(&solution)
}

/// Report and fields at `x` of a scene.
pub fn fields<T: Real, M: Model<T>>(scene: M, mesh: Mesh<'_, T>, x: &[T]) -> (Report<T>, Vec<Fields<T>>) {
    solved(scene, mesh, |s| (*s.report(), x.iter().map(|&x| s.at(x)).collect()))
}

/// A transverse load alone.
pub fn plain<F>(transverse: F) -> Load<F> {
    Load { transverse, axial: (), points: () }
}

/// The load that presses the left half onto the foundation and lifts the right one, of the tables in the design of the
/// method.
pub fn halves(k: f64) -> impl Model<f64> + Copy {
    Scene::new(1.0, Beam::elastic(5000.0))
        .foundation(Foundation { law: Linear(k), gap: () })
        .load(plain(Steps { breaks: &[0.5], values: &[1e6, -1e6] }))
}

/// `n` + 1 points from 0 to `length`.
pub fn points(n: u32, length: f64) -> Vec<f64> {
    (0..=n).map(|i| length * f64::from(i) / f64::from(n)).collect()
}

/// So many random cases with a fixed seed, so that a run repeats.
pub fn fixed(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_algorithm: RngAlgorithm::ChaCha,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    }
}
