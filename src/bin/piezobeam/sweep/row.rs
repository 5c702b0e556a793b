//! A row of the table: what a scene came to, its columns, and how it is written.

use super::Vary;
use crate::cli::MethodArgs;
use crate::model::Task;
use crate::tasks;
use csv::{Writer, WriterBuilder};
use piezobeam::{Error, HeapWorkspace, Model, Problem, Real, Solution};
use serde::Serialize;
use std::cmp::Ordering;
use std::fmt::Display;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Number,
    Count,
    Text,
}

/// The columns after those of the varied numbers, in the order of [`Found`]'s fields: name, unit, kind.
pub const COLUMNS: [(&str, &str, Kind); 16] = [
    ("status", "", Kind::Text),
    ("residual", "", Kind::Number),
    ("iterations", "", Kind::Count),
    ("visits", "", Kind::Count),
    ("elements", "", Kind::Count),
    ("max_bending", "m", Kind::Number),
    ("max_bending_x", "m", Kind::Number),
    ("contact_force", "N", Kind::Number),
    ("contact_length", "m", Kind::Number),
    ("left_force", "N", Kind::Number),
    ("left_moment", "N m", Kind::Number),
    ("right_force", "N", Kind::Number),
    ("right_moment", "N m", Kind::Number),
    ("bending_energy", "J", Kind::Number),
    ("certified", "", Kind::Text),
    ("warnings", "", Kind::Text),
];

/// What a scene came to; empty cells are what it does not have.
#[derive(Debug, Default, Serialize)]
pub struct Found {
    status: String,
    residual: Option<f64>,
    iterations: Option<usize>,
    visits: Option<usize>,
    elements: Option<usize>,
    /// The largest in size, with its sign.
    max_bending: Option<f64>,
    max_bending_x: Option<f64>,
    contact_force: Option<f64>,
    /// Of all contact zones together.
    contact_length: Option<f64>,
    left_force: Option<f64>,
    left_moment: Option<f64>,
    right_force: Option<f64>,
    right_moment: Option<f64>,
    bending_energy: Option<f64>,
    /// The solution is known to be the only one.
    certified: Option<bool>,
    warnings: String,
}

/// The status of a scene that is none.
const BAD_INPUT: &str = "bad_input";

impl Found {
    /// What is wrong with a scene takes the place of the warnings.
    pub fn bad(error: &impl Display) -> Self {
        Self { status: BAD_INPUT.into(), warnings: on_one_line(error.to_string()), ..Self::default() }
    }

    fn of<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>) -> Self {
        let number = |value: T| Some(value.f64()).filter(|value| value.is_finite());
        let (report, sums) = (solution.report(), solution.resultants());
        let (x, bending) = summit(solution);
        let pressed = solution.zones().into_iter().map(|[from, to]| to - from);
        let has_foundation = solution.at(T::zero()).gap.is_some();
        let warnings: Vec<_> = solution.warnings().iter().map(ToString::to_string).collect();
        Self {
            status: report.status.name().into(),
            residual: number(report.residual),
            iterations: Some(report.iterations),
            visits: Some(report.element_visits),
            elements: Some(report.elements),
            max_bending: number(bending),
            max_bending_x: number(x),
            contact_force: number(sums.contact_force).filter(|_| has_foundation),
            contact_length: number(pressed.fold(T::zero(), |sum, part| sum + part))
                .filter(|_| has_foundation),
            left_force: number(sums.left_force),
            left_moment: number(sums.left_moment),
            right_force: number(sums.right_force),
            right_moment: number(sums.right_moment),
            bending_energy: number(sums.bending_energy),
            certified: Some(solution.uniqueness().certified),
            warnings: on_one_line(warnings.join("; ")),
        }
    }
}

fn on_one_line(text: String) -> String {
    text.replace(['\n', '\r'], " ")
}

/// Parts of the beam at least at whose ends the bending is looked at, before it is found exactly between two of them.
const PARTS: usize = 128;
/// Of the summits within 1 % of the highest of these points, so many are compared exactly.
const SUMMITS: usize = 3;
const NEAR: f64 = 0.99;
/// Halvings that reach the last digit.
const HALVINGS: usize = 60;

/// Where the bending is largest in size, and the bending there. Nodes cost little, points between them an integral each.
fn summit<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>) -> (T, T) {
    let bending = |x: T| solution.at(x).bending;
    let nodes: Vec<T> = solution.nodes().collect();
    let parts = PARTS.div_ceil(nodes.len() - 1) as u32;
    let share = |i: u32| T::of(f64::from(i) / f64::from(parts));
    let inner = nodes.windows(2).flat_map(|pair| (1..=parts).map(move |i| (pair, i)));
    let points =
        inner.map(|(pair, i)| if i == parts { pair[1] } else { pair[0] + (pair[1] - pair[0]) * share(i) });
    let looked: Vec<(T, T)> = [nodes[0]].into_iter().chain(points).map(|x| (x, bending(x))).collect();
    let most = looked.iter().fold(T::zero(), |most, &(_, w)| most.max(w.abs()));
    let height = |three: &[(T, T)]| three[1].1.abs();
    let is_summit = |three: &&[(T, T)]| {
        let (before, here, after) = (three[0].1.abs(), height(three), three[2].1.abs());
        here > T::zero() && here >= before && here >= after && here >= T::of(NEAR) * most
    };
    let mut summits: Vec<_> = looked.windows(3).filter(is_summit).collect();
    summits.sort_by(|a, b| height(b).partial_cmp(&height(a)).unwrap_or(Ordering::Equal));
    let mut highest = (T::zero(), T::zero());
    for three in summits.into_iter().take(SUMMITS) {
        let found = three[1];
        // The size grows on the left of its summit and shrinks on the right.
        let grows = |x: T| solution.at(x).slope * found.1 > T::zero();
        let (mut low, mut high) = (three[0].0, three[2].0);
        for _ in 0..HALVINGS {
            let middle = T::of(0.5) * (low + high);
            *(if grows(middle) { &mut low } else { &mut high }) = middle;
        }
        let x = T::of(0.5) * (low + high);
        for (x, w) in [found, (x, bending(x))] {
            if w.abs() > highest.1.abs() {
                highest = (x, w);
            }
        }
    }
    highest
}

/// Solve, and keep what a row holds.
pub struct Solve {
    /// `None`: the library's default.
    pub stop: Option<f64>,
    pub method: MethodArgs,
}

impl Task for Solve {
    type Output = Found;
    fn run<T: Real, M: Model<T>>(self, problem: Problem<'_, T, M>) -> Result<Found, Error> {
        let mut memory = HeapWorkspace::new();
        let mut prepared = problem.prepare(&mut memory)?;
        tasks::solve_by(&self.method, &mut prepared, self.stop)?;
        Ok(prepared.last().map_or_else(Found::default, |solution| Found::of(&solution)))
    }
}

/// The header, with its line's end.
pub fn header(vary: &[Vary]) -> String {
    let names = vary.iter().map(|one| one.path.as_str()).chain(COLUMNS.map(|(name, ..)| name));
    written(|writer| writer.write_record(names))
}

/// A row, with its line's end.
pub fn line(values: &[f64], found: &Found) -> String {
    written(|writer| writer.serialize((values, found)))
}

fn written(write: impl FnOnce(&mut Writer<Vec<u8>>) -> csv::Result<()>) -> String {
    let mut writer = WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    write(&mut writer).expect("numbers and words go into memory as CSV");
    let bytes = writer.into_inner().expect("memory takes all bytes");
    String::from_utf8(bytes).expect("numbers and words are UTF-8")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_the_fields() {
        let value = serde_json::to_value(Found::default()).unwrap();
        let fields: std::collections::BTreeSet<_> = value.as_object().unwrap().keys().cloned().collect();
        assert_eq!(fields, COLUMNS.iter().map(|(name, ..)| (*name).to_owned()).collect());
        // And in their order: the header's cells over a row's.
        let found =
            Found { status: "a".into(), elements: Some(5), warnings: "b, c".into(), ..Found::default() };
        assert_eq!(line(&[1e16, -0.5], &found), "1e16,-0.5,a,,,,5,,,,,,,,,,,\"b, c\"\n");
        let vary: Vary = "load.axial=1,2".parse().unwrap();
        let header = header(&[vary]);
        assert!(header.starts_with("load.axial,status,residual,iterations,visits,elements,max_bending,"));
        assert_eq!(header.matches(',').count(), 16);
    }

    #[test]
    fn a_bad_scene_is_a_row() {
        let row = line(&[0.0], &Found::bad(&"a.toml:1: length:\nexpected more"));
        assert_eq!(row, "0.0,bad_input,,,,,,,,,,,,,,,a.toml:1: length: expected more\n");
    }
}
