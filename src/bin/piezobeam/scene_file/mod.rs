//! Scene files: a beam, its foundation and its loads as TOML text in SI units.
//!
//! This module judges the form of a file only: the types of the values, missing
//! and unknown keys, the lengths of arrays, the order of positions, formulas.
//! Whether the quantities make physical sense is decided where they are used.
//! Every complaint names the file, the line and the field, says what was found
//! there and what to write instead.

mod complaint;
mod describe;
mod entries;
mod error;
mod expression;
mod lines;
mod nesting;
mod number;
mod profile;
mod profile_form;
mod sections;
pub mod source;
mod suggestion;
mod table;

use toml::de::DeTable;

pub use complaint::unit;
pub use entries::{Entries, Entry};
pub use error::{FileError, printable};

pub use profile::ProfileSpec;
pub use sections::{BeamTable, ConductionTable, FoundationTable, LoadTable, MeshTable, PotentialTable};
pub use source::read;

use error::quoted;
use lines::{FieldLines, LineStarts};
use table::{Document, Table};

/// The keys at the top of a scene file.
const ROOT_KEYS: &[&str] = &["length", "beam", "foundation", "conduction", "load", "potential", "mesh"];

/// The content of a scene file.
#[derive(Clone, Debug)]
pub struct SceneFile {
    /// The file, as messages call it.
    pub name: String,
    /// Length of the beam, m.
    pub length: f64,
    /// The material of the beam.
    pub beam: BeamTable,
    /// The foundation, when there is one.
    pub foundation: Option<FoundationTable>,
    /// The electric contact with the foundation, when there is one.
    pub conduction: Option<ConductionTable>,
    /// The loads.
    pub load: LoadTable,
    /// The potential at the ends, when it is given.
    pub potential: Option<PotentialTable>,
    /// The mesh.
    pub mesh: MeshTable,
    lines: FieldLines,
}

impl SceneFile {
    /// A beam that only bends, without a file.
    pub fn beam(length: f64, bending: ProfileSpec) -> Self {
        Self {
            name: String::new(),
            length,
            beam: BeamTable { bending, axial: None, piezo: None, permittivity: None },
            foundation: None,
            conduction: None,
            load: LoadTable::default(),
            potential: None,
            mesh: MeshTable::default(),
            lines: FieldLines::default(),
        }
    }

    /// The 1-based line of a field such as `beam.bending` or
    /// `load.points[2].x`, with points counted from 0.
    ///
    /// A field which is absent has the line of the innermost table around it
    /// which stands in the file.
    pub fn line_of(&self, field: &str) -> Option<usize> {
        self.lines.line_of(field)
    }
}

/// Reads a scene from the `text` of a file which messages call `name`.
///
/// # Errors
///
/// When the text is not TOML, or not a scene.
pub fn parse(text: &str, name: &str) -> Result<SceneFile, FileError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    if text.trim().is_empty() {
        return Err(FileError::new(name, "the file is empty")
            .hint("a scene has at least length and [beam] with bending"));
    }
    nesting::check(text, name)?;
    let starts = LineStarts::new(text);
    let root = DeTable::parse(text).map_err(|error| syntax(&error, text, name, &starts))?;
    let lines = FieldLines::new(root.get_ref(), &starts);
    let document = Document { name, starts };
    scene(&Table::root(&document, root.get_ref()), name, lines)
}

/// A complaint of the TOML parser.
fn syntax(error: &toml::de::Error, text: &str, name: &str, starts: &LineStarts) -> FileError {
    let Some(span) = error.span() else {
        return FileError::new(name, invalid(error.message()));
    };
    // What is missing at the end of the text is missing on its last line.
    let offset = span.start.min(text.trim_end_matches(['\n', '\r']).len());
    let found = text.get(span).map_or("", str::trim);
    let at = |message: &str| {
        FileError::new(name, invalid(message))
            .at_line(Some(starts.line(offset)))
            .at_column(starts.column(text, offset))
    };
    match error.message() {
        "duplicate key" if !found.is_empty() => {
            at(&format!("{} is given twice", quoted(found))).hint("give every key and every [table] once")
        }
        message if message.starts_with("string values must be quoted") => {
            if found.is_empty() {
                at("expected a value, found nothing").hint("write one after the = sign")
            } else {
                at(&format!("expected a value, found {}", quoted(found)))
                    .hint("write texts and formulas in quotes")
            }
        }
        message => at(message),
    }
}

fn invalid(message: &str) -> String {
    format!("not valid TOML: {}", error::printable(message))
}

fn scene(root: &Table<'_>, name: &str, lines: FieldLines) -> Result<SceneFile, FileError> {
    root.allow(ROOT_KEYS)?;
    let field = root.required("length", "add length = <number>, in m, at the top")?;
    let length = field.number()?;
    if length <= 0.0 {
        return Err(field
            .error(format!("expected a positive length, found {length}"))
            .hint("give the length of the beam in m"));
    }
    let beam = root.required("beam", "add [beam] with bending = <number>, in N m^2")?;
    let foundation = root.table("foundation")?;
    let conduction = root.table("conduction")?;
    let load = root.table("load")?;
    let potential = root.table("potential")?;
    let mesh = root.table("mesh")?;
    Ok(SceneFile {
        name: name.to_owned(),
        length,
        beam: sections::beam(&beam.table()?, length)?,
        foundation: foundation.map(|table| sections::foundation(&table, length)).transpose()?,
        conduction: conduction.map(|table| sections::conduction(&table, length)).transpose()?,
        load: match load {
            Some(table) => sections::load(&table, length)?,
            None => LoadTable::default(),
        },
        potential: potential.map(|table| sections::potential(&table)).transpose()?,
        mesh: match mesh {
            Some(table) => sections::mesh(&table)?,
            None => MeshTable::default(),
        },
        lines,
    })
}

#[cfg(test)]
mod tests;
