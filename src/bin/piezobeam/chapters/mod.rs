//! The report: what the project claims and what it found, computed anew, a chapter for each subject.
//!
//! A chapter solves scenes, compares what they come to with what is said of them, and says whether that holds. It is
//! plain data: `render::html` makes the page of it.

mod left_out;
mod measure;
mod naive;
mod paper;
mod reference;
mod scenes;
mod stability;
mod work;

use crate::render::plot::Plot;
use crate::render::{html, significant};
use indicatif::ProgressBar;
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A subject of the report.
pub struct Chapter {
    /// What it is called in links.
    pub name: &'static str,
    pub title: &'static str,
    /// Paragraphs below the title; what stands between backticks is code.
    pub introduction: Vec<String>,
    pub claims: Vec<Claim>,
    pub sections: Vec<Section>,
}

pub struct Section {
    pub title: String,
    pub text: Vec<String>,
    pub figures: Vec<Figure>,
    pub tables: Vec<Table>,
}

/// A picture and its data.
pub struct Figure {
    /// Of its file, without extension.
    pub name: String,
    pub caption: String,
    pub plot: Plot,
}

pub struct Table {
    /// Of its file, without extension.
    pub name: String,
    pub caption: String,
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

/// Something that is said, and what was found of it.
pub struct Claim {
    /// Who says it.
    pub by: &'static str,
    pub said: &'static str,
    pub found: String,
    /// What is seen is there, but not for the reason it is taken for.
    pub artefact: bool,
    /// What the finding says is so in this run.
    pub holds: bool,
    /// What was assumed to check it; empty where nothing was.
    pub assumes: &'static str,
}

/// Says what the paper says.
const PAPER: &str = "The paper";
/// Says what this project says.
const OURS: &str = "This project";

impl Claim {
    pub fn verdict(&self) -> &'static str {
        match (self.holds, self.artefact) {
            (false, _) => "Does not hold in this run.",
            (true, true) => "An artefact.",
            (true, false) => "Holds.",
        }
    }
}

/// All of the report.
pub struct Document {
    pub introduction: String,
    /// On what and how it was made.
    pub made: String,
    pub chapters: Vec<Chapter>,
}

/// The picture that is also written as a file of its own.
const HEADLINE: &str = "work-partial-bending";

/// How much is done, and how far it is.
pub struct Effort<'p> {
    /// Some seconds, not minutes.
    pub quick: bool,
    bar: &'p ProgressBar,
}

impl Effort<'_> {
    /// One of [`steps`] is done.
    fn step(&self) {
        self.bar.inc(1);
    }

    fn pick<T>(&self, quick: T, full: T) -> T {
        if self.quick { quick } else { full }
    }
}

/// Computes all chapters; `quick` leaves out what takes more than some seconds.
///
/// # Errors
/// A scene of the project's own that is none.
pub fn run(quick: bool, bar: &ProgressBar) -> Result<Document, Box<dyn Error>> {
    let effort = Effort { quick, bar };
    bar.set_length(work::STEPS + paper::STEPS + stability::STEPS + left_out::STEPS);
    let chapters = vec![
        work::chapter(&effort)?,
        paper::chapter(&effort)?,
        stability::chapter(&effort)?,
        left_out::chapter(&effort)?,
    ];
    let option = if quick { " --quick" } else { "" };
    let introduction = format!(
        "What the solver costs and what it gives for it, beside the methods of the paper: Rodríguez-Arós, Cao-Rial \
         and Sofonea, A piezoelectric elastic beam model with normal compliance contact. Everything on this page was \
         computed by `piezobeam report{option}`; each picture's numbers are in the CSV file named below it."
    );
    Ok(Document { introduction, made: measure::machine(), chapters })
}

impl Document {
    /// The page, the data of each picture and table, and the headline picture.
    pub fn files(&self, out: &Path) -> Vec<(PathBuf, String)> {
        let mut files = vec![(out.join("report.html"), html::page(self))];
        for section in self.chapters.iter().flat_map(|chapter| &chapter.sections) {
            for figure in &section.figures {
                files.push((out.join(format!("{}.csv", figure.name)), figure.plot.csv()));
                if figure.name == HEADLINE {
                    let svg = crate::render::chart::alone(&figure.plot.svg());
                    files.push((out.join(format!("{HEADLINE}.svg")), svg));
                }
            }
            files.extend(section.tables.iter().map(|t| (out.join(format!("{}.csv", t.name)), t.csv())));
        }
        files
    }

    /// A line for each claim, and one for each thing that is missing.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for Claim { by, said, found, holds, artefact, .. } in self.claims() {
            let verdict = match (holds, artefact) {
                (false, _) => "FAILS",
                (true, true) => "artefact",
                (true, false) => "holds",
            };
            let _ = writeln!(text, "{verdict}: {} ({}): {found}", said, by.to_lowercase());
        }
        for lack in self.lacks() {
            let _ = writeln!(text, "FAILS: no data in {lack}");
        }
        text.replace('`', "")
    }

    /// How many claims hold.
    pub fn tally(&self) -> String {
        let count = |holds: bool, artefact: bool| {
            self.claims()
                .filter(|claim| claim.holds == holds && (claim.artefact == artefact || !holds))
                .count()
        };
        let (well, artefacts, failed) = (count(true, false), count(true, true), count(false, false));
        format!(
            "Of {} things that the paper or this project says and that are checked below, {well} hold, {artefacts} \
             are artefacts of how they were measured, {failed} do not hold in this run.",
            self.claims().count()
        )
    }

    /// Does every claim hold, and is there data for all?
    pub fn holds(&self) -> bool {
        self.claims().all(|claim| claim.holds) && self.lacks().is_empty()
    }

    fn claims(&self) -> impl Iterator<Item = &Claim> {
        self.chapters.iter().flat_map(|chapter| &chapter.claims)
    }

    /// What has no data.
    fn lacks(&self) -> Vec<String> {
        let mut lacks = Vec::new();
        for section in self.chapters.iter().flat_map(|chapter| &chapter.sections) {
            if section.figures.is_empty() && section.tables.is_empty() {
                lacks.push(section.title.clone());
            }
            let figures = section.figures.iter().filter(|f| !f.plot.has_data()).map(|f| f.name.clone());
            let tables = section.tables.iter().filter(|t| t.rows.is_empty()).map(|t| t.name.clone());
            lacks.extend(figures.chain(tables));
        }
        lacks
    }
}

impl Table {
    fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let rows = std::iter::once(&self.header).chain(&self.rows);
        let wrote: csv::Result<()> = rows.into_iter().try_for_each(|row| writer.write_record(row));
        wrote.expect("text goes into memory as CSV");
        String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
    }
}

/// A header of a table.
fn header(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

/// The exponent p of y = c x^p through points, by least squares of their logarithms.
fn exponent(points: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let logs: Vec<_> = points.into_iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (over, under) = logs
        .iter()
        .fold((0.0, 0.0), |(over, under), (x, y)| (over + (x - mx) * (y - my), under + (x - mx) * (x - mx)));
    over / under
}

/// An error as people write it.
fn rough(error: f64) -> String {
    significant(error, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::plot::{Axis, Curve};

    #[test]
    fn exponents() {
        let found = exponent((1..6).map(|i| (f64::from(i), 3.0 * f64::from(i).powf(-4.0))));
        assert!((found + 4.0).abs() < 1e-12);
    }

    #[test]
    fn a_document_without_data_does_not_hold() {
        let claim =
            |holds| Claim { by: OURS, said: "a", found: "b".into(), artefact: false, holds, assumes: "" };
        let figure = |points: usize| Figure {
            name: "figure".into(),
            caption: "c".into(),
            plot: Plot {
                title: "t".into(),
                x: Axis::linear("x", "m", "x"),
                y: Axis::linear("y", "m", "y"),
                curves: vec![Curve::line("one", 0, (0..points).map(|i| (i as f64, 1.0)))],
            },
        };
        let document = |holds, points| Document {
            introduction: "All of `it`".into(),
            made: String::new(),
            chapters: vec![Chapter {
                name: "one",
                title: "One",
                introduction: vec!["1 < 2".into()],
                claims: vec![claim(holds)],
                sections: vec![Section {
                    title: "data".into(),
                    text: Vec::new(),
                    figures: vec![figure(points)],
                    tables: Vec::new(),
                }],
            }],
        };
        assert!(document(true, 3).holds());
        assert!(!document(false, 3).holds() && document(false, 3).summary().starts_with("FAILS: a"));
        assert!(!document(true, 0).holds() && document(true, 0).summary().contains("no data in figure"));
        let files = document(true, 3).files(Path::new("out"));
        assert_eq!(files.len(), 2);
        assert!(files[0].1.contains("<code>it</code>") && files[0].1.contains("1 &lt; 2"));
    }
}
