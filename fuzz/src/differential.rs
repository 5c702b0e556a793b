//! One scene, solved in two ways: on a mesh and a finer one, in double and in single precision, after other scenes,
//! together with them and alone, on a mesh made for it and on a uniform one.

use crate::honest;
use arbitrary::{Arbitrary, Unstructured};
use piezobeam::{
    Batch, Beam, Compliance, Conduction, Foundation, HeapWorkspace, History, Linear, Load, Mesh, Model,
    Potential, Problem, Profile, Reached, Real, Scene, Settings, Smooth, Solution, Status, Steps,
    StoragePlace, Warning,
};
use std::fmt::Debug;

/// A beam on a foundation at a distance, in numbers that any of the ways can do, and how it changes.
#[derive(Arbitrary, Clone, Copy, Debug)]
struct Input {
    elements: u8,
    /// Sums of one input in four, as they take longer than all else.
    sums: u8,
    way: Way,
    /// The beam conducts.
    electric: bool,
    scene: State,
    /// What was before, for histories; for batches, what is at once.
    past: [Change; 3],
}

#[derive(Arbitrary, Clone, Copy, Debug, PartialEq)]
enum Way {
    Refined,
    Single,
    History,
    Adaptive,
    Certified,
    Batch,
}

#[derive(Arbitrary, Clone, Copy, Debug)]
pub struct State {
    /// k L^4 / C in parts of 10 decades from 1e-2 on.
    rigidity: u8,
    /// The gap over what the load bends.
    gap: i8,
    /// Loads on three thirds.
    load: [i8; 3],
    /// Potentials of the ends.
    ends: [i8; 2],
    /// Conduction, over what (2.15) allows, and its truncation.
    mu: [u8; 2],
    truncation: u8,
}

/// What was other, one step before.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Change {
    Nothing,
    Load([i8; 3]),
    Rigidity(i8),
    Gap(i8),
    Ends([i8; 2]),
    All(State),
}

impl Change {
    fn of(self, after: State) -> State {
        let mut before = after;
        match self {
            Self::Nothing => {}
            Self::Load(by) => before.load = std::array::from_fn(|i| before.load[i].saturating_add(by[i] / 4)),
            Self::Rigidity(by) => before.rigidity = before.rigidity.saturating_add_signed(by / 4),
            Self::Gap(by) => before.gap = before.gap.saturating_add(by / 4),
            Self::Ends(by) => before.ends = std::array::from_fn(|i| before.ends[i].saturating_add(by[i] / 4)),
            Self::All(other) => before = other,
        }
        before
    }
}

/// Either precision.
trait Number: Real + Profile<Self> + Smooth<Self> {}
impl<T: Real + Profile<T> + Smooth<T>> Number for T {}

/// What fields of two states of one mesh may be apart, over the largest one: each has a residual of 1e-10 at most.
const STATES: f64 = 1e-6;

/// Nodes of meshes whose elements are a multiple of four.
const BREAKS: [f64; 2] = [0.25, 0.75];

#[derive(Clone, Copy, Debug)]
pub struct Data<T> {
    pub breaks: [T; 2],
    pub values: [T; 3],
    pub stiffness: T,
    pub gap: T,
    pub ends: [T; 2],
    pub mu: [T; 2],
    pub truncation: T,
}

impl State {
    pub fn data<T: Real>(&self) -> Data<T> {
        let truncation = 10f64.powf(f64::from(self.truncation) / 128.0 - 1.0);
        // Both margins of (2.15), for a permittivity and a bending stiffness of 1, are at least 2.
        let most = 2.0 / truncation;
        Data {
            breaks: BREAKS.map(T::of),
            values: self.load.map(|f| T::of(f64::from(f))),
            stiffness: T::of(10f64.powf(f64::from(self.rigidity) / 255.0 * 10.0 - 2.0)),
            gap: T::of(f64::from(self.gap) / 384.0),
            ends: self.ends.map(|q| T::of(f64::from(q) / 64.0)),
            mu: self.mu.map(|mu| T::of(f64::from(mu) / 256.0 * most)),
            truncation: T::of(truncation),
        }
    }
}

fn elastic<T: Number>(data: &Data<T>) -> impl Model<T> + Debug {
    Scene::new(T::one(), Beam::elastic(T::one()))
        .foundation(Foundation { law: Linear(data.stiffness), gap: data.gap })
        .load(Load {
            transverse: Steps { breaks: &data.breaks, values: &data.values },
            axial: (),
            points: (),
        })
}

fn electric<T: Number>(data: &Data<T>) -> impl Model<T> + Debug {
    let [mu1, mu2] = data.mu;
    let [left, right] = data.ends;
    let beam = Beam { bending: T::one(), axial: T::of(3.0), piezo: T::of(0.7), permittivity: T::one() };
    Scene::new(T::one(), beam)
        .foundation(Foundation { law: Linear(data.stiffness), gap: data.gap })
        .conduction(Conduction {
            mu1,
            mu2,
            truncation: data.truncation,
            potential_truncation: data.truncation,
        })
        .load(Load {
            transverse: Steps { breaks: &data.breaks, values: &data.values },
            axial: data.values[0],
            points: (),
        })
        .potential(Potential { left, right })
}

/// Two ways agree where both say that they converged; each is in equilibrium, and nowhere pulled.
pub fn differential(data: &[u8]) {
    let Ok(input) = Input::arbitrary(&mut Unstructured::new(data)) else { return };
    let [a, b, c] = input.past;
    // The scene itself is the last one.
    let one = b.of(c.of(input.scene));
    let mut states = [a.of(one), one, c.of(input.scene), input.scene];
    if input.way == Way::Batch && input.sums % 2 == 1 {
        // Scenes whose potential acts on bending are not solved in lockstep.
        states.iter_mut().for_each(|state| state.mu[0] = 0);
    }
    let double = states.map(|state| state.data::<f64>());
    let single = input.scene.data::<f32>();
    if input.electric {
        compare(&input, &double.each_ref().map(electric), &electric(&single));
    } else {
        compare(&input, &double.each_ref().map(elastic), &elastic(&single));
    }
}

fn compare<M: Model<f64> + Debug, N: Model<f32>>(input: &Input, scenes: &[M; 4], single: &N) {
    let scene = &scenes[3];
    // Few elements, now and then more; for meshes that lie in one another a multiple of four.
    let coarse = match usize::from(input.elements) {
        few @ 0..192 => 4 + few % 5,
        some @ 192..248 => 8 + some % 9,
        more => 4 * (more - 236),
    };
    let coarse = if input.way == Way::Certified { coarse.min(11) / 4 * 4 } else { coarse };
    let sums = input.sums.is_multiple_of(4);
    let mu2 = scenes.iter().map(|scene| scene.conduction().mu2.value(0.5, 0.5)).fold(0.0, f64::max);
    let agree = |what: &str, a: &Looked, b: &Looked, allowed: f64, digits: f64| {
        // A foundation that is taken as rigid in one way need not be so in the other.
        let same = !a.rigid && !b.rigid;
        if same && a.status == Status::Converged && b.status == Status::Converged {
            a.assert_near(b, allowed, digits, mu2, || format!("{what}: {input:?} {scene:?}"));
        }
    };
    let rigidity = scene.foundation().law.coefficient(0.5, 0.5);
    let layers = |elements: usize| -> f64 { rigidity / (elements as f64).powi(4) };
    if input.way == Way::History {
        let mut memory = HeapWorkspace::new();
        let mut history = History::new(Mesh::uniform(coarse), &mut memory);
        for scene in scenes {
            let after =
                history.solve(scene, &Settings::default()).map(|s| Looked::at(&s, sums)).expect("a scene");
            let fresh = solved(scene, coarse, false);
            assert!(after.is_solved() && fresh.is_solved(), "{after:?} {fresh:?}: {input:?}");
            agree("history", &fresh, &after, STATES, f64::EPSILON);
        }
        return;
    }
    if input.way == Way::Batch {
        let mut seen = 0;
        // Three of four at a time: a full group and one that is not.
        let mut batch = Batch::<f64, &M, 3>::new();
        let scenes: Vec<&M> = scenes.iter().collect();
        let solved_all = batch.solve(&scenes, &Mesh::uniform(coarse), &Settings::default(), |i, found| {
            let together = Looked::at(&found.expect("a scene"), sums);
            let alone = solved(scenes[i], coarse, false);
            assert!(together.is_solved() && alone.is_solved(), "{together:?} {alone:?}: {input:?}");
            agree("batch", &alone, &together, STATES, f64::EPSILON);
            seen += 1;
        });
        assert!(solved_all.is_ok() && seen == scenes.len(), "{seen} seen: {input:?}");
        return;
    }
    let problem = Problem::new(scene, Mesh::uniform(coarse)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default()).expect("settings in range");
    let looked = Looked::at(&solution, sums);
    assert!(looked.is_solved(), "{looked:?}: {input:?}");
    match input.way {
        // Order four, where an element resolves the foundation's boundary layer; from 16 on beams
        // that are pressed in at a clamp have been 0.72 wrong.
        Way::Refined => {
            let allowed = 1e-2 * (1.0 + layers(coarse));
            let allowed = if coarse < 16 { allowed } else { allowed.min(1.0) };
            agree("refined", &looked, &solved(scene, 4 * coarse, false), allowed, f64::EPSILON);
        }
        // A residual is one of moments: what `stop` of those of the load alone bends a free beam by is not seen on a stiff
        // foundation.
        Way::Single => {
            let load = scene.load().transverse;
            let most = [0.1, 0.5, 0.9].map(|x| load.value(x, x).abs()).into_iter().fold(0.0, f64::max);
            let unseen = f64::from(Settings::<f32>::default().stop) * most / 96.0;
            let allowed = 1e-2 + unseen / largest(&looked.bending);
            agree("single", &looked, &solved(single, coarse, sums), allowed, f32::EPSILON.into());
        }
        Way::Adaptive => {
            const TOLERANCE: f64 = 1e-4;
            const FINE: usize = 32;
            let mut memory = vec![StoragePlace::default(); 128];
            let found = problem.solve_to(memory.as_mut_slice(), TOLERANCE, &Settings::default());
            let found = found.expect("a tolerance");
            let looked = Looked::at(&found.solution, sums);
            assert!(looked.is_solved(), "{looked:?}: {input:?}");
            if found.reached != Reached::Tolerance {
                return;
            }
            let fine = solved(scene, FINE, false);
            let allowed = 0.5_f64.min(10.0 * TOLERANCE + 1e-2 * layers(FINE));
            agree("adaptive", &looked, &fine, allowed, f64::EPSILON);
        }
        Way::Certified => {
            // Both are within their bounds of the solution, so they are within the sum of each other.
            let finer = Problem::new(scene, Mesh::uniform(2 * coarse)).expect("a scene without mistakes");
            let mut memory = HeapWorkspace::new();
            let finer = finer.solve(&mut memory, &Settings::default()).expect("settings in range");
            // Without any bending there is nothing to compare with.
            let bent = finer.nodes().any(|x| finer.at(x).bending != 0.0);
            if let (Some(a), Some(b)) = (bound(&solution), bound(&finer))
                && b < 1.0
                && bent
            {
                let distance = solution.distance(&finer).expect("meshes in one another");
                assert!(distance <= (a + b) / (1.0 - b) + 1e-9, "{distance:e}, {a:e}, {b:e}: {input:?}");
            }
        }
        Way::History | Way::Batch => {}
    }
}

/// The bound with the memory that it asks for, but not for ever finer meshes.
fn bound<M: Model<f64>>(solution: &Solution<'_, f64, M>) -> Option<f64> {
    let mut memory = vec![StoragePlace::default(); 64];
    solution.certify(memory.as_mut_slice(), &Settings::default()).expect("memory").bending_bound
}

fn solved<T: Real, M: Model<T>>(scene: &M, elements: usize, sums: bool) -> Looked {
    let problem = Problem::new(scene, Mesh::uniform(elements)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    Looked::at(&problem.solve(&mut memory, &Settings::default()).expect("settings in range"), sums)
}

fn largest(fields: &[f64]) -> f64 {
    fields.iter().fold(f64::MIN_POSITIVE, |most, field| most.max(field.abs()))
}

/// Status and fields of a solution.
#[derive(Debug)]
struct Looked {
    status: Status,
    rigid: bool,
    bending: Vec<f64>,
    /// Stretching and potential.
    electric: Vec<f64>,
    gap: f64,
    /// Nodes, and the bending there.
    nodes: Vec<[f64; 2]>,
}

impl Looked {
    /// Of a solution that is, with `sums`, what it is called.
    fn at<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>, sums: bool) -> Self {
        let status = solution.report().status;
        if sums
            && status == Status::Converged
            && let Err(what) = honest::check(solution)
        {
            panic!("{what}");
        }
        let fields: Vec<_> = (1..8).map(|i| solution.at(T::of(f64::from(i) / 8.0))).collect();
        let electric = fields.iter().flat_map(|f| [f.stretching, f.potential]).flatten();
        let rigid = solution.warnings().iter().any(|w| matches!(w, Warning::Rigid { .. }));
        Self {
            status,
            rigid,
            bending: fields.iter().map(|f| f.bending.f64()).collect(),
            electric: electric.map(Real::f64).collect(),
            gap: fields[0].gap.map_or(0.0, Real::f64).abs(),
            nodes: solution.nodes().map(|x| [x.f64(), solution.at(x).bending.f64()]).collect(),
        }
    }

    fn is_solved(&self) -> bool {
        matches!(self.status, Status::Converged | Status::ToleranceBelowFloor)
    }

    /// The fields are those of `other`, but for so much of the largest and the rounding of what they are differences of.
    /// Such bending makes another current, mu2 times a square.
    fn assert_near(&self, other: &Self, allowed: f64, digits: f64, mu2: f64, said: impl Fn() -> String) {
        let size = largest(&self.bending);
        let off = allowed * size + 256.0 * digits * self.gap;
        let electric = allowed * largest(&self.electric) + mu2 * (size + self.gap) * off;
        // On one mesh nodes are compared: between them what bends a free element is added to its cubic, and not to that of
        // one that touches, so that beams that only just touch may differ by it.
        let pairs = || self.nodes.iter().zip(&other.nodes);
        let same = self.nodes.len() == other.nodes.len() && pairs().all(|(a, b)| (a[0] - b[0]).abs() < 1e-6);
        let (one, two) = if same {
            pairs().map(|(a, b)| (a[1], b[1])).unzip()
        } else {
            (self.bending.clone(), other.bending.clone())
        };
        for (one, two, off) in [(&one, &two, off), (&self.electric, &other.electric, electric)] {
            for (a, b) in one.iter().zip(two) {
                assert!((a - b).abs() <= off, "{a:e} and {b:e}, {off:e} allowed: {}", said());
            }
        }
    }
}
