//! The paper's scene and its variant with partial contact: a short table and the four field pictures of its
//! Figs. 1-4.

use crate::cli::{MethodArgs, Precision};
use crate::render::{figures, quantity};
use crate::report::{CONVERGED, Picture};
use crate::{PICTURE_SAMPLES, model, picture, scene_file, tasks};
use comfy_table::{CellAlignment, Table, presets};
use std::path::{Path, PathBuf};

/// Name of the folder, what it is, and the scene.
const SCENES: [(&str, &str, &str); 2] = [
    ("paper", "the paper's scene", include_str!("../../../scenes/paper.toml")),
    ("halves", "its load turned round on the right half", include_str!("../../../scenes/halves.toml")),
];

/// What the command shows and writes.
pub struct Paper {
    pub table: String,
    /// Pictures and where they go.
    pub files: Vec<(PathBuf, String)>,
    pub converged: bool,
}

/// Solves both scenes.
pub fn run(out: &Path) -> Result<Paper, Box<dyn std::error::Error>> {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header([
        "scene",
        "status",
        "elements",
        "visits",
        "deepest bending",
        "highest",
        "contact",
        "contact force",
        "u at L/2",
        "q at L/2",
    ]);
    let (mut files, mut converged) = (Vec::new(), true);
    let mut notes = String::new();
    for (name, what, text) in SCENES {
        let file = scene_file::parse(text, &format!("{name}.toml"))?;
        let task = tasks::Solve {
            stop: None,
            tolerance: None,
            samples: PICTURE_SAMPLES,
            sensitivities: false,
            method: MethodArgs::default(),
        };
        let solved = model::with(&file, None, Precision::F64, task).map_err(|e| file.complaint(&e))?;
        let mut page = picture(&file, solved);
        page.title = format!("{name}: {what}");
        table.add_row(row(name, &page));
        converged &= page.report.status == CONVERGED;
        notes += &format!("{name}: {what}\n");
        for (figure, svg) in figures::all(&page) {
            files.push((out.join(format!("{name}-{figure}")), svg));
        }
    }
    for column in table.column_iter_mut().skip(2) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let table: String = table.lines().map(|line| format!("{}\n", line.trim_end())).collect();
    let table = format!(
        "{notes}\n{table}\nBending is positive towards the foundation. The paper does not print the truncation M, the\n\
         gap, the end potentials and the stiffness of these figures: M = 1, no gap, 1 V at both ends and\n\
         1e8 N/m^2 are assumed.\n{} pictures in {}\n",
        files.len(),
        scene_file::printable(&out.to_string_lossy())
    );
    Ok(Paper { table, files, converged })
}

fn row(name: &str, page: &Picture) -> Vec<String> {
    let report = &page.report;
    let middle = |values: &Option<Vec<f64>>, unit: &str| {
        values.as_ref().map_or("-".into(), |v| quantity(v[v.len() / 2], unit, 8))
    };
    let bending = report.samples.bending.as_deref().unwrap_or(&[]);
    let most = bending.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = bending.iter().copied().fold(f64::INFINITY, f64::min);
    let zones: Vec<String> =
        (report.contact.iter().flat_map(|c| &c.zones)).map(|[a, b]| format!("{a:.6}..{b:.6} m")).collect();
    let force = report.contact.as_ref().map_or(0.0, |c| c.force);
    vec![
        name.into(),
        report.status.clone(),
        report.elements.to_string(),
        report.element_visits.to_string(),
        quantity(most, "m", 6),
        quantity(least, "m", 6),
        zones.join(", "),
        quantity(force, "N", 8),
        middle(&report.samples.stretching, "m"),
        middle(&report.samples.potential, "V"),
    ]
}
