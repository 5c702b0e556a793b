//! The report: what the project claims and what it found, computed anew, a chapter for each subject.
//!
//! A chapter solves scenes, compares what they come to with what is said of them, and says whether that holds. The
//! document is Markdown with pictures beside it.

mod paper;

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A subject of the report.
pub struct Chapter {
    pub title: &'static str,
    /// Markdown below the title.
    pub text: String,
    /// Pictures, and where they go.
    pub files: Vec<(PathBuf, String)>,
    pub claims: Vec<Claim>,
}

/// Something that is said, and what was found of it.
pub struct Claim {
    pub said: &'static str,
    pub found: String,
    pub holds: bool,
}

/// What the command writes.
pub struct Document {
    pub files: Vec<(PathBuf, String)>,
    /// A line for each claim.
    pub summary: String,
    pub holds: bool,
}

/// Computes all chapters, for a document in the folder `out`; `quick` leaves out what takes more than some seconds.
///
/// # Errors
/// A scene of the project's own that is none.
pub fn run(quick: bool, out: &Path) -> Result<Document, Box<dyn Error>> {
    let mut text = format!("# Report\n\n`cargo beam report{}`\n", if quick { " --quick" } else { "" });
    let (mut files, mut summary, mut holds) = (Vec::new(), String::new(), true);
    for chapter in [paper::chapter(quick, out)?] {
        let _ = write!(text, "\n## {}\n\n{}\n", chapter.title, chapter.text);
        text += &table(&["what is said", "what was found", "holds"], chapter.claims.iter().map(Claim::row));
        for Claim { said, found, holds: so } in &chapter.claims {
            let _ = writeln!(summary, "{}: {said}: {found}", if *so { "holds" } else { "FAILS" });
            holds &= so;
        }
        files.extend(chapter.files);
    }
    files.push((out.join("report.md"), text));
    Ok(Document { files, summary, holds })
}

impl Claim {
    fn row(&self) -> Vec<String> {
        vec![self.said.into(), self.found.clone(), if self.holds { "yes" } else { "**no**" }.into()]
    }
}

/// A table in Markdown.
fn table(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut out = format!("| {} |\n|{}\n", header.join(" | "), "---|".repeat(header.len()));
    for row in rows {
        let cells: Vec<_> = row.iter().map(|cell| cell.replace('|', "\\|")).collect();
        let _ = writeln!(out, "| {} |", cells.join(" | "));
    }
    out
}
