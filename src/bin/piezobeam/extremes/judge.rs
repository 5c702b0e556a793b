//! Solves a case and compares how it ended with what is expected.

use super::{Case, Expected, Known, Reference, Row, Verdict};
use crate::cli::Precision;
use crate::model::{self, Task};
use crate::report::CONVERGED;
use crate::scene_file::SceneFile;
use piezobeam::{Error, Fields, HeapWorkspace, Model, Problem, Real, Settings};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Intervals between the points at which fields are compared.
const SAMPLES: u32 = 256;

/// A reference mesh has so many times the elements of the finest mesh that is compared with it.
const FINER: usize = 4;

/// Solve, and look at the fields at these points.
struct Look<'a> {
    at: &'a [f64],
}

/// What a solve ended with.
struct Found {
    status: &'static str,
    message: String,
    elements: usize,
    residual: f64,
    stop: f64,
    visits: usize,
    zones: usize,
    finite: bool,
    /// Some force of the foundation pulls.
    pulls: bool,
    known: Vec<Known>,
}

impl Task for Look<'_> {
    type Output = Found;
    fn run<T: Real, M: Model<T>>(self, problem: Problem<'_, T, M>) -> Result<Found, Error> {
        let mut memory = HeapWorkspace::new();
        let settings = Settings::default();
        let solution = problem.solve(&mut memory, &settings)?;
        let report = *solution.report();
        let fields: Vec<Fields<T>> = self.at.iter().map(|&x| solution.at(T::of(x))).collect();
        let pressed = fields.iter().filter_map(|f| f.pressure);
        let force = solution.resultants().contact_force;
        Ok(Found {
            status: report.status.name(),
            message: report.status.to_string(),
            elements: report.elements,
            residual: report.residual.f64(),
            stop: settings.stop.f64(),
            visits: report.element_visits,
            zones: solution.zones().len(),
            finite: fields.iter().all(finite),
            pulls: pressed.chain([force]).any(|p| p < T::zero()),
            known: fields.iter().map(known).collect(),
        })
    }
}

fn finite<T: Real>(f: &Fields<T>) -> bool {
    let optional = [f.stretching, f.potential, f.axial_force, f.electric_displacement, f.gap, f.pressure];
    let all = [f.bending, f.slope, f.moment, f.shear];
    all.into_iter().chain(optional.into_iter().flatten()).all(T::is_finite)
}

fn known<T: Real>(f: &Fields<T>) -> Known {
    let electric = f.stretching.zip(f.potential).map(|(u, q)| [u.f64(), q.f64()]);
    Known { bending: f.bending.f64(), electric }
}

/// A solve that may be refused, or panic.
fn solve(
    scene: &SceneFile,
    elements: Option<usize>,
    precision: Precision,
    at: &[f64],
) -> Result<Result<Found, Error>, String> {
    let look = AssertUnwindSafe(|| model::with(scene, elements, precision, Look { at }));
    catch_unwind(look).map_err(|_| "panicked".to_owned())
}

/// A case with the fields that it should have.
pub(super) struct Judge<'c> {
    case: &'c Case,
    at: Vec<f64>,
    name: String,
    known: Result<Vec<Known>, String>,
}

impl<'c> Judge<'c> {
    pub(super) fn new(case: &'c Case, quick: bool) -> Self {
        let length = case.scene.length;
        let uniform = (0..=SAMPLES).map(|i| length * (f64::from(i) / f64::from(SAMPLES)));
        let mut at: Vec<f64> = uniform.collect();
        let finest = case.meshes.iter().filter(|n| !quick || **n <= super::QUICK).max();
        let finer = FINER * finest.copied().unwrap_or(0).max(1000);
        let (name, known) = match &case.reference {
            Reference::None => (String::new(), Ok(Vec::new())),
            Reference::Closed(name, closed) => {
                ((*name).to_owned(), Ok(at.iter().map(|&x| closed(x)).collect()))
            }
            Reference::Suite(name, text) => {
                let (x, known) = suite(text);
                at = x;
                (format!("suite: {name}"), known)
            }
            Reference::Finer => (format!("finer mesh: {finer}"), reference(&case.scene, finer, &at, 1.0)),
            Reference::Other { what, scene, bending } => {
                let at: Vec<f64> = at.iter().map(|x| x / length * scene.length).collect();
                ((*what).to_owned(), reference(scene, finer, &at, *bending))
            }
        };
        Self { case, at, name, known }
    }

    pub(super) fn row(&self, elements: Option<usize>, precision: Precision, expected: Expected) -> Row {
        let case = self.case;
        let (per_element, beside) = case.visits;
        let mut row = Row {
            case: case.what.clone(),
            elements: elements.unwrap_or(0),
            precision: if precision == Precision::F64 { "f64" } else { "f32" },
            expected: String::new(),
            status: String::new(),
            residual: None,
            reference: self.name.clone(),
            error: None,
            electric_error: None,
            element_visits: None,
            visits_cap: per_element * elements.unwrap_or(0) + beside,
            verdict: Verdict::Ok,
            remarks: Vec::new(),
        };
        let mut wrong = Vec::new();
        match solve(&case.scene, elements, precision, &self.at) {
            Err(panicked) => {
                row.status.clone_from(&panicked);
                wrong.push(panicked);
            }
            Ok(Err(error)) => {
                row.status = "refused".into();
                row.remarks.push(error.to_string());
            }
            Ok(Ok(found)) => {
                row.visits_cap = per_element * found.elements + beside;
                self.compare(&found, &mut row, &mut wrong);
            }
        }
        let met = match expected {
            Expected::Refused(field) => {
                row.expected = format!("refused: {field}");
                row.verdict = Verdict::Refused;
                row.status == "refused" && row.remarks[0].starts_with(field)
            }
            Expected::Ends(status) => {
                status.clone_into(&mut row.expected);
                row.status == status
            }
            Expected::Fails => {
                row.expected = "not converged".into();
                row.status != CONVERGED && row.status != "refused"
            }
            Expected::Converged { at_100, order, floor } => {
                let share = 100.0 / row.elements.max(1) as f64;
                let allowed = (at_100 * share.powi(order)).max(floor).min(at_100.max(floor));
                let floor = if self.case.floor { ", or at the floor" } else { "" };
                row.expected = format!("error <= {allowed:.0e}{floor}");
                for error in row.error.iter().chain(&row.electric_error) {
                    if error.is_nan() || *error > allowed {
                        wrong.push(format!("error {error:.1e}, allowed {allowed:.0e}"));
                    }
                }
                if let Err(why) = &self.known {
                    wrong.push(format!("its reference {why}"));
                }
                row.status == CONVERGED || (self.case.floor && row.status == "tolerance_below_floor")
            }
        };
        if !met {
            wrong.push(format!("ended as {}", row.status));
        }
        if !wrong.is_empty() {
            row.verdict = Verdict::Wrong;
            row.remarks.splice(0..0, wrong);
        }
        row
    }

    /// Fills in what was found, and says what must not be whatever is expected.
    fn compare(&self, found: &Found, row: &mut Row, wrong: &mut Vec<String>) {
        found.status.clone_into(&mut row.status);
        row.elements = found.elements;
        row.residual = Some(found.residual);
        row.element_visits = Some(found.visits);
        let converged = found.status == CONVERGED;
        if found.visits > row.visits_cap {
            wrong.push(format!("{} element visits, allowed {}", found.visits, row.visits_cap));
        }
        if found.pulls {
            wrong.push("the foundation pulls".into());
        }
        if !converged {
            row.remarks.push(found.message.clone());
            return;
        }
        if !found.finite {
            wrong.push("a field is not finite".into());
        }
        if found.residual.is_nan() || found.residual > found.stop {
            wrong.push(format!("residual {:.1e} above {:.0e}", found.residual, found.stop));
        }
        if let Some(zones) = self.case.zones
            && zones != found.zones
        {
            wrong.push(format!("{} contact zones, expected {zones}", found.zones));
        }
        let Ok(known) = &self.known else { return };
        if known.is_empty() {
            return;
        }
        row.error = Some(relative(&found.known, known, |k| Some(k.bending)));
        if known[0].electric.is_some() && found.known[0].electric.is_some() {
            let of = |which: usize| relative(&found.known, known, |k| k.electric.map(|e| e[which]));
            let (u, q) = (of(0), of(1));
            row.electric_error = Some(if u.is_nan() { u } else { q.max(u) });
        }
    }
}

/// Largest difference over the largest value that is known; not a number where something is not.
fn relative(found: &[Known], known: &[Known], get: impl Fn(&Known) -> Option<f64>) -> f64 {
    let value = |k: &Known| get(k).unwrap_or(f64::NAN);
    let worst = |a: f64, b: f64| if b.is_nan() || b > a { b } else { a };
    let size = known.iter().map(|k| value(k).abs()).fold(0.0, worst);
    let pairs = found.iter().zip(known);
    // Over the size first: differences of numbers near the ends of the format leave it.
    let share = |a: f64, b: f64| if size > 0.0 { (a / size - b / size).abs() } else { (a - b).abs() };
    pairs.map(|(a, b)| share(value(a), value(b))).fold(0.0, worst)
}

/// Our own solution, in double precision, with bending multiplied.
fn reference(scene: &SceneFile, elements: usize, at: &[f64], bending: f64) -> Result<Vec<Known>, String> {
    let found = match solve(scene, Some(elements), Precision::F64, at)? {
        Ok(found) if found.status == CONVERGED => found,
        Ok(found) => return Err(format!("ended as {}", found.status)),
        Err(error) => return Err(format!("was refused: {error}")),
    };
    let scaled = |k: Known| Known { bending: k.bending * bending, ..k };
    Ok(found.known.into_iter().map(scaled).collect())
}

/// Abscissae and fields of a file of the reference suite.
fn suite(text: &str) -> (Vec<f64>, Result<Vec<Known>, String>) {
    let read = || {
        let whole: serde_json::Value = serde_json::from_str(text).ok()?;
        let column = |name: &str| -> Option<Vec<f64>> {
            whole["reference"][name].as_array()?.iter().map(serde_json::Value::as_f64).collect()
        };
        let (xi, u, q) = (column("xi")?, column("u")?, column("q")?);
        let fields = xi.iter().zip(u.iter().zip(&q));
        let known = fields.map(|(&bending, (&u, &q))| Known { bending, electric: Some([u, q]) });
        Some((column("x")?, known.collect()))
    };
    match read() {
        Some((x, known)) => (x, Ok(known)),
        None => (Vec::new(), Err("cannot be read".into())),
    }
}
