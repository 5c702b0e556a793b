//! Scenes at the edges of what can be asked, what is expected of each, and how it ended.
//!
//! A case is data: a scene, meshes, what its end has to be, and what its bending is compared with. `judge` solves
//! it and says whether it ended so; a row that did not is wrong, and the command says so by its exit status.

mod cases;
mod electric;
mod judge;
mod known;
mod scenes;

use crate::cli::Precision;
use crate::scene_file::SceneFile;
pub use known::rigid_halves;
use serde::Serialize;

/// Meshes of more elements are left out of a quick run.
const QUICK: usize = 100;

/// What a scene's fields should be.
enum Reference {
    /// Only how the solve ends is judged.
    None,
    /// A formula.
    Closed(&'static str, Closed),
    /// Sixteen digits by collocation in 200-bit arithmetic: the text of a file of the reference suite.
    Suite(&'static str, &'static str),
    /// Our own solution of this scene on a much finer mesh.
    Finer,
    /// Our own solution of another scene on a much finer mesh, in units of its own.
    Other { what: &'static str, scene: Box<SceneFile>, bending: f64 },
}

type Closed = Box<dyn Fn(f64) -> Known>;

/// Bending, and u and q where they are known too.
struct Known {
    bending: f64,
    electric: Option<[f64; 2]>,
}

/// How a solve has to end.
#[derive(Clone, Copy)]
enum Expected {
    /// Converged, with errors of at most `at_100` on 100 elements, which fall like h^order down to `floor`.
    Converged { at_100: f64, order: i32, floor: f64 },
    /// A typed error that names this field.
    Refused(&'static str),
    /// This status.
    Ends(&'static str),
    /// Any status but converged.
    Fails,
}

struct Case {
    what: String,
    scene: SceneFile,
    /// Elements; none: the scene's own nodes.
    meshes: Vec<usize>,
    reference: Reference,
    expected: Expected,
    /// The same in single precision, on up to [`QUICK`] elements.
    single: Option<Expected>,
    /// Contact zones, where their number is known.
    zones: Option<usize>,
    /// Element visits allowed: so many per element and so many beside.
    visits: (usize, usize),
    /// The residual may be at its rounding floor, above the tolerance, if the solve says so.
    floor: bool,
}

struct Group {
    name: &'static str,
    comment: &'static str,
    cases: Vec<Case>,
}

/// What a row says in the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// It ended as expected.
    Ok,
    /// It was refused by a typed error, as expected.
    Refused,
    /// It did not end as expected.
    Wrong,
}

impl Verdict {
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Refused => "refused",
            Self::Wrong => "wrong",
        }
    }
}

/// One case on one mesh in one precision.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    pub case: String,
    /// Elements of the mesh; asked for, where the scene was refused.
    pub elements: usize,
    pub precision: &'static str,
    pub expected: String,
    pub status: String,
    pub residual: Option<f64>,
    /// What bending (and u and q) are compared with.
    pub reference: String,
    /// Largest error of bending over the largest bending.
    pub error: Option<f64>,
    /// The same of u and q, the larger of the two.
    pub electric_error: Option<f64>,
    pub element_visits: Option<usize>,
    /// The most visits allowed.
    pub visits_cap: usize,
    pub verdict: Verdict,
    /// The message of an error or a status, and what is wrong.
    pub remarks: Vec<String>,
}

/// Rows that have an extreme in common.
#[derive(Debug, Clone, Serialize)]
pub struct Section {
    pub name: &'static str,
    pub comment: &'static str,
    pub rows: Vec<Row>,
}

/// The whole table.
#[derive(Debug, Clone, Serialize)]
pub struct Extremes {
    pub quick: bool,
    pub rows: usize,
    pub wrong: usize,
    pub groups: Vec<Section>,
}

/// Solves and judges all cases.
pub fn run(quick: bool) -> Extremes {
    let groups = cases::groups().into_iter().chain(electric::groups());
    let groups: Vec<_> = groups.map(|group| section(&group, quick)).collect();
    let rows = || groups.iter().flat_map(|group| &group.rows);
    let wrong = rows().filter(|row| row.verdict == Verdict::Wrong).count();
    Extremes { quick, rows: rows().count(), wrong, groups }
}

fn section(group: &Group, quick: bool) -> Section {
    let mut rows = Vec::new();
    for case in &group.cases {
        let judge = judge::Judge::new(case, quick);
        let small = |n: &usize| *n <= QUICK;
        let mut meshes: Vec<_> =
            case.meshes.iter().filter(|n| !quick || small(n)).map(|&n| Some(n)).collect();
        if case.meshes.is_empty() {
            meshes.push(None);
        }
        rows.extend(meshes.iter().map(|&n| judge.row(n, Precision::F64, case.expected)));
        if let Some(single) = case.single {
            let coarsest = meshes.first().copied().flatten();
            rows.push(judge.row(coarsest, Precision::F32, single));
        }
    }
    Section { name: group.name, comment: group.comment, rows }
}

/// Meshes of most cases.
const MESHES: [usize; 3] = [100, 1000, 10_000];

/// Errors in double precision below which nothing is asked: what the residual's default bound allows.
const FLOOR: f64 = 1e-10;

impl Case {
    /// A case that has to converge to 1e-6 on 100 elements of what it is on a finer mesh.
    fn new(what: impl Into<String>, scene: SceneFile) -> Self {
        Self {
            what: what.into(),
            scene,
            meshes: MESHES.to_vec(),
            reference: Reference::Finer,
            expected: Expected::Converged { at_100: 1e-6, order: 3, floor: FLOOR },
            single: None,
            zones: None,
            visits: (10, 3000),
            floor: false,
        }
    }

    fn against(self, reference: Reference) -> Self {
        Self { reference, ..self }
    }

    /// The error that 100 elements may have; it falls by 1000 on ten times as many.
    fn within(self, at_100: f64) -> Self {
        self.falling(at_100, 3)
    }

    fn falling(self, at_100: f64, order: i32) -> Self {
        Self { expected: Expected::Converged { at_100, order, floor: FLOOR }, ..self }
    }

    /// The error that any mesh may have.
    fn flat(self, error: f64) -> Self {
        Self { expected: Expected::Converged { at_100: error, order: 0, floor: 0.0 }, ..self }
    }

    /// Also in single precision, with this error.
    fn single(self, error: f64) -> Self {
        Self { single: Some(Expected::Converged { at_100: error, order: 0, floor: 0.0 }), ..self }
    }

    fn refused(self, field: &'static str) -> Self {
        let meshes = vec![10];
        Self { expected: Expected::Refused(field), reference: Reference::None, meshes, ..self }
    }

    fn ends(self, status: &'static str) -> Self {
        let meshes = vec![100];
        Self { expected: Expected::Ends(status), reference: Reference::None, meshes, ..self }
    }

    fn fails(self) -> Self {
        Self { expected: Expected::Fails, ..self.ends("") }
    }

    fn on(self, meshes: &[usize]) -> Self {
        Self { meshes: meshes.to_vec(), ..self }
    }

    fn zones(self, zones: usize) -> Self {
        Self { zones: Some(zones), ..self }
    }

    fn or_at_the_floor(self) -> Self {
        Self { floor: true, ..self }
    }

    fn visits(self, per_element: usize, beside: usize) -> Self {
        Self { visits: (per_element, beside), ..self }
    }
}
