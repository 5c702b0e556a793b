//! One scene, solved in two ways: on a mesh and a finer one, in double and in single precision, alone and after another.

use crate::honest;
use arbitrary::{Arbitrary, Unstructured};
use piezobeam::{
    Beam, Foundation, HeapWorkspace, History, Linear, Load, Mesh, Model, Problem, Real, Scene, Settings,
    Solution, Status, Steps,
};

/// A bending beam on a foundation at a distance, in numbers that any of the ways can do.
#[derive(Arbitrary, Clone, Copy, Debug)]
struct Input {
    elements: u8,
    /// k L^4 / C in parts of 10 decades from 1e-2 on.
    rigidity: u8,
    /// The gap over what the load bends.
    gap: i8,
    /// Loads on three thirds, and by how much they change for the history.
    load: [i8; 3],
    change: [i8; 3],
    way: u8,
}

const BREAKS: [f64; 2] = [0.3125, 0.6875];

struct Data<T> {
    breaks: [T; 2],
    values: [T; 3],
    stiffness: T,
    gap: T,
}

impl Input {
    fn data<T: Real>(&self, load: [i8; 3]) -> Data<T> {
        Data {
            breaks: BREAKS.map(T::of),
            values: load.map(|f| T::of(f64::from(f))),
            stiffness: T::of(10f64.powf(f64::from(self.rigidity) / 255.0 * 10.0 - 2.0)),
            gap: T::of(f64::from(self.gap) / 384.0),
        }
    }

    fn changed(&self) -> [i8; 3] {
        std::array::from_fn(|i| self.load[i].saturating_add(self.change[i] / 16))
    }
}

macro_rules! scene {
    ($data:ident, $t:ty) => {
        Scene::new(1.0, Beam::<$t>::elastic(1.0))
            .foundation(Foundation { law: Linear($data.stiffness), gap: $data.gap })
            .load(Load {
                transverse: Steps { breaks: &$data.breaks, values: &$data.values },
                axial: (),
                points: (),
            })
    };
}

/// Two ways agree where both say that they converged; each is in equilibrium, and nowhere pulled.
pub fn differential(data: &[u8]) {
    let Ok(input) = Input::arbitrary(&mut Unstructured::new(data)) else { return };
    let coarse = 16 + usize::from(input.elements % 48);
    let double = input.data::<f64>(input.load);
    let scene = scene!(double, f64);
    let (status, bending) = solved(&scene, coarse);
    assert!(matches!(status, Status::Converged | Status::ToleranceBelowFloor), "{status:?}: {input:?}");
    if status != Status::Converged {
        return;
    }
    // What one unit of load bends, or the gap does.
    let size = bending.iter().fold(f64::MIN_POSITIVE, |m, w| m.max(w.abs()));
    let (what, other, allowed) = match input.way % 3 {
        // Order four, where an element resolves the foundation's boundary layer; else it is half wrong at most.
        0 => {
            let layers = double.stiffness / (coarse as f64).powi(4);
            ("refined", solved(&scene, 4 * coarse), (1e-2 * (1.0 + layers)).min(0.5))
        }
        1 => {
            let single = input.data::<f32>(input.load);
            ("single", solved(&scene!(single, f32), coarse), 1e-2)
        }
        _ => {
            let other = input.data::<f64>(input.changed());
            let first = scene!(other, f64);
            let mut memory = HeapWorkspace::new();
            let mut history = History::new(Mesh::uniform(coarse), &mut memory);
            assert!(history.solve(&first, &Settings::default()).is_ok());
            let after = history.solve(&scene, &Settings::default()).map(|s| look(&s));
            ("history", after.expect("a scene"), 1e-6)
        }
    };
    if other.0 == Status::Converged {
        // Without a load there is the gap's rounding.
        let digits = if what == "single" { f64::from(f32::EPSILON) } else { f64::EPSILON };
        let rounding = 256.0 * digits * double.gap.abs();
        for (a, b) in bending.iter().zip(&other.1) {
            assert!(
                (a - b).abs() <= allowed * size + rounding,
                "{what}: {a:e} and {b:e} of {size:e}: {input:?}"
            );
        }
    }
}

fn solved<T: Real, M: Model<T>>(scene: &M, elements: usize) -> (Status, Vec<f64>) {
    let problem = Problem::new(scene, Mesh::uniform(elements)).expect("a scene without mistakes");
    let mut memory = HeapWorkspace::new();
    look(&problem.solve(&mut memory, &Settings::default()).expect("settings in range"))
}

/// Status and bending of a solution that is what it is called.
fn look<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>) -> (Status, Vec<f64>) {
    let report = solution.report();
    let found = honest::departure(solution);
    if report.status == Status::Converged {
        let allowed = 1e-4_f64.max(1e3 * report.residual.max(report.floor).f64());
        let worst = [found.moment, found.bending, found.law].into_iter().all(|d| d <= allowed);
        assert!(found.finite && worst && found.tension <= 0.0, "{found:?} {report:?}");
    }
    let at = |i: u32| solution.at(T::of(f64::from(i) / 16.0)).bending.f64();
    (report.status, (0..=16).map(at).collect())
}
