//! The library's complaint about a value, said of the scene file.

use super::{FileError, SceneFile};
use piezobeam::{Error, Place};

impl SceneFile {
    /// The same complaint with the file's name, the line of the field and what to do about it.
    pub fn complaint(&self, error: &Error) -> FileError {
        let (field, hint) = match *error {
            Error::Value { field: "load.points", place: Place::Index(i), .. } => {
                (format!("load.points[{i}].x"), "concentrated loads stand between the clamps".into())
            }
            Error::Value { field: "stop", .. } => {
                return FileError::new("--stop", error.to_string());
            }
            Error::Value { field: field @ ("omega" | "mu" | "rho"), .. } => {
                return FileError::new(&format!("--{field}"), error.to_string());
            }
            Error::Value { field, .. } => (field.into(), unit(field)),
            Error::Jump { field, .. } => (field.into(), "give pieces whose values meet at the break".into()),
            Error::Missing { field, needed_by } => (field.into(), format!("add it, or take {needed_by} out")),
            Error::Length { field, .. } => (field.into(), String::new()),
            _ => ("mesh".into(), "ask for fewer elements".into()),
        };
        let complaint = FileError::new(&self.name, error.to_string()).at_line(self.line_of(&field));
        if hint.is_empty() { complaint } else { complaint.hint(hint) }
    }
}

fn unit(field: &str) -> String {
    let unit = match field {
        "beam.bending" => "N m^2",
        "beam.axial" => "N",
        "beam.permittivity" => "N m^2/V^2",
        "foundation.stiffness" => "N/m^2",
        "conduction.mu1" | "conduction.mu2" => "N/(V m^2)",
        "foundation.gap" | "length" | "mesh.nodes" => "m",
        _ => return String::new(),
    };
    format!("it is in {unit}")
}
