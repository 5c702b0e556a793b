//! How long a solve takes, and how wrong it is.

use super::scenes::{Number, Numbers, Whole};
use crate::report::CONVERGED;
use piezobeam::{
    BermudezMoreno, Error, HeapWorkspace, Mesh, Method, Problem, Report, Settings, Solution, Status,
};
use std::hint::black_box;
use std::time::Instant;

/// How a scene is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    Elementwise,
    BermudezMoreno,
    Gauss,
    /// Kinks integrated exactly, on a uniform mesh.
    Exact,
    /// Kinks integrated exactly, on a mesh made for an accuracy.
    Adaptive,
}

pub const METHODS: [How; 5] = [How::Elementwise, How::BermudezMoreno, How::Gauss, How::Exact, How::Adaptive];

impl How {
    pub fn name(self) -> &'static str {
        match self {
            Self::Elementwise => "by elements",
            Self::BermudezMoreno => "Bermúdez-Moreno",
            Self::Gauss => "Gauss points",
            Self::Exact => "exact kinks",
            Self::Adaptive => "adaptive",
        }
    }

    /// One look for all pictures.
    pub fn look(self) -> usize {
        METHODS.iter().position(|&how| how == self).unwrap_or(0)
    }

    /// The method of the paper, if it is one.
    fn method<T>(self) -> Option<Method<T>> {
        match self {
            Self::Elementwise => Some(Method::Elementwise),
            Self::Gauss => Some(Method::Gauss),
            Self::BermudezMoreno => {
                Some(Method::BermudezMoreno(BermudezMoreno { omega: None, mu: None, rho: None }))
            }
            Self::Exact | Self::Adaptive => None,
        }
    }
}

/// What a mesh is made by.
#[derive(Clone, Copy, Debug)]
pub enum Size {
    Elements(usize),
    /// Relative error of bending that is asked for, from 16 elements on.
    Tolerance(f64),
}

/// Points at which fields are compared: none is a node of the meshes measured, but the middle.
const POINTS: usize = 101;

/// Bending, stretching and potential.
pub type Field = [f64; 3];

/// What is found of a scene.
#[derive(Clone, Debug)]
pub struct Found {
    pub elements: usize,
    pub visits: usize,
    pub iterations: usize,
    pub residual: f64,
    pub status: &'static str,
    /// The iteration ended at what it looks for, be it the wrong thing.
    pub settled: bool,
    /// The lowest contact pressure where the method says [N/m].
    pub lowest: Option<f64>,
    /// At [`points`], or where it was asked for.
    pub fields: Vec<Field>,
}

impl Found {
    pub fn converged(&self) -> bool {
        self.status == CONVERGED
    }

    /// Not what the scene's solution is, by its own status.
    pub fn hollow(&self) -> bool {
        !self.settled
    }
}

/// Where fields are compared.
pub fn points() -> Vec<f64> {
    (0..POINTS).map(|i| (i as f64 + 0.5) / POINTS as f64).collect()
}

/// Largest difference to `reference` over the largest value of that, of each field.
pub fn errors(found: &[Field], reference: &[Field]) -> Field {
    [0, 1, 2].map(|field| {
        let size = reference.iter().fold(0.0_f64, |most, r| most.max(r[field].abs()));
        let worst = found.iter().zip(reference).fold(0.0_f64, |most, (f, r)| {
            let off = (f[field] - r[field]).abs();
            if off.is_nan() || off > most { off } else { most }
        });
        worst / size
    })
}

/// Solves a scene again and again in one memory.
pub struct Bench<'a, T: Number> {
    scene: &'a Whole<'a, T>,
    memory: HeapWorkspace<T, &'a Whole<'a, T>>,
    settings: Settings<T>,
}

impl<'a, T: Number> Bench<'a, T> {
    pub fn new(scene: &'a Whole<'a, T>) -> Self {
        Self { scene, memory: HeapWorkspace::new(), settings: Settings::default() }
    }

    pub fn stopping_at(mut self, stop: f64) -> Self {
        self.settings.stop = T::of(stop);
        self
    }

    /// Solves from nothing; sampling the scene is part of it.
    pub fn run<R>(
        &mut self,
        how: How,
        size: Size,
        look: impl FnOnce(&Report<T>, Option<T>, Option<&Solution<'_, T, &'a Whole<'a, T>>>) -> R,
    ) -> Result<R, Error> {
        let Self { scene, memory, settings } = self;
        let elements = match size {
            Size::Elements(elements) => elements,
            Size::Tolerance(_) => 16,
        };
        let problem = Problem::new(black_box(*scene), Mesh::uniform(elements))?;
        if let Size::Tolerance(tolerance) = size {
            let found = problem.solve_to(memory, T::of(tolerance), settings)?;
            return Ok(look(found.solution.report(), None, Some(&found.solution)));
        }
        let mut prepared = problem.prepare(memory)?;
        let (report, lowest) = match how.method() {
            None => (prepared.solve(settings)?, None),
            Some(method) => {
                let found = prepared.solve_by(&method, settings)?;
                (found.report, Some(found.lowest_pressure))
            }
        };
        Ok(look(&report, lowest, prepared.last().as_ref()))
    }

    /// What it finds, fields at `at`.
    pub fn find(&mut self, how: How, size: Size, at: &[f64]) -> Result<Found, Error> {
        self.run(how, size, |report, lowest, solution| {
            let fields = solution.map_or(Vec::new(), |solution| {
                let fields = at.iter().map(|&x| solution.at(T::of(x)));
                let electric = |value: Option<T>| value.map_or(f64::NAN, |v| v.f64());
                fields.map(|f| [f.bending.f64(), electric(f.stretching), electric(f.potential)]).collect()
            });
            Found {
                elements: report.elements,
                visits: report.element_visits,
                iterations: report.iterations,
                residual: report.residual.f64(),
                status: report.status.name(),
                settled: matches!(
                    report.status,
                    Status::Converged | Status::OwnEquations | Status::ToleranceBelowFloor
                ),
                lowest: lowest.map(|p| p.f64()),
                fields,
            }
        })
    }

    /// Times solves for `budget` seconds.
    pub fn time(&mut self, how: How, size: Size, budget: f64) -> Result<Times, Error> {
        Times::of(budget, || {
            self.run(how, size, |report, _, _| {
                black_box(report);
            })
        })
    }
}

/// Seconds of a solve.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    pub best: f64,
    /// Three solves in four took no longer.
    pub slow: f64,
    pub solves: usize,
}

impl Times {
    /// Of as many runs as fit into `budget` seconds, three at least.
    pub fn of(budget: f64, mut run: impl FnMut() -> Result<(), Error>) -> Result<Self, Error> {
        let mut seconds = Vec::new();
        let start = Instant::now();
        while seconds.len() < 3 || (start.elapsed().as_secs_f64() < budget && seconds.len() < 10_000) {
            let begun = Instant::now();
            run()?;
            seconds.push(begun.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        let at = |share: f64| seconds[((seconds.len() - 1) as f64 * share) as usize];
        Ok(Self { best: at(0.0), slow: at(0.75), solves: seconds.len() })
    }
}

/// A scene solved and timed.
#[derive(Clone, Debug)]
pub struct Measured {
    pub found: Found,
    pub times: Times,
    /// Relative, of each field.
    pub errors: Field,
}

/// What `how` finds on meshes of these sizes, each timed for `budget` seconds, up to the first with more than `most`
/// element visits: a bound in seconds would be another one in each run.
pub fn measure<T: Number>(
    numbers: &Numbers,
    how: How,
    sizes: &[Size],
    reference: &[Field],
    (budget, most): (f64, usize),
) -> Result<Vec<Measured>, Error> {
    let given = numbers.in_precision::<T>();
    let scene = given.scene();
    let mut bench = Bench::new(&scene);
    let mut all = Vec::new();
    let at = points();
    for &size in sizes {
        let found = bench.find(how, size, &at)?;
        let visits = found.visits;
        let times = bench.time(how, size, budget)?;
        all.push(Measured { errors: errors(&found.fields, reference), times, found });
        if visits > most {
            break;
        }
    }
    Ok(all)
}

/// On what times were measured.
pub fn machine() -> String {
    let model = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    format!(
        "piezobeam {}, {}, {} {}, {cores} cores, one of them used. Times are the best of many solves from nothing; \
         sampling the scene and laying out the mesh are part of them, allocation is not. The line to the right of a \
         mark ends where three solves in four had ended.",
        env!("CARGO_PKG_VERSION"),
        model.as_deref().unwrap_or("a processor that does not say its name"),
        std::env::consts::ARCH,
        std::env::consts::OS,
    )
}
