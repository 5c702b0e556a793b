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
            Error::Value { field: "stop", found, .. } => {
                let message =
                    format!("expected a number between 0 and 1 in the precision of the solve, found {found}");
                return FileError::new("--stop", message)
                    .hint("ask for a larger one, or for --precision f64");
            }
            Error::Value { field, found, .. } if !found.is_finite() => (
                field.into(),
                "it has to be finite on the whole beam; --precision f32 holds numbers up to 3.4e38".into(),
            ),
            Error::Value { field: field @ ("omega" | "mu" | "rho"), .. } => {
                return FileError::new(&format!("--{field}"), error.to_string());
            }
            Error::Value { field, .. } => {
                (field.into(), unit(field).map_or(String::new(), |unit| format!("it is in {unit}")))
            }
            Error::Jump { field, .. } => (field.into(), "give pieces whose values meet at the break".into()),
            Error::Missing { field, needed_by } => (field.into(), format!("add it, or take {needed_by} out")),
            Error::Length { field, .. } => (field.into(), String::new()),
            _ => ("mesh".into(), "ask for fewer elements".into()),
        };
        let complaint = FileError::new(&self.name, error.to_string()).at_line(self.line_of(&field));
        if hint.is_empty() { complaint } else { complaint.hint(hint) }
    }
}

/// The unit of a field, or of the numbers in it.
pub fn unit(field: &str) -> Option<&'static str> {
    let inside = field.find(".values[").or_else(|| field.find(".y["));
    let field = inside.map_or(field, |at| &field[..at]);
    let point = field.strip_prefix("load.points[").and_then(|rest| rest.split_once("].")).map(|(_, key)| key);
    let unit = match point.unwrap_or(field) {
        "beam.bending" => "N m^2",
        "beam.axial" => "N",
        "beam.permittivity" => "N m^2/V^2",
        "foundation.stiffness" => "N/m^2",
        "conduction.mu1" | "conduction.mu2" => "N/(V m^2)",
        "foundation.gap" | "length" | "mesh.nodes" => "m",
        "beam.piezo" => "N m/V",
        "load.transverse" | "load.axial" => "N/m",
        "potential.left" | "potential.right" | "conduction.potential_truncation" => "V",
        "conduction.truncation" | "x" => "m",
        "force" => "N",
        "moment" => "N m",
        _ => return None,
    };
    Some(unit)
}

#[cfg(test)]
mod tests {
    use super::unit;

    #[test]
    fn fields_and_the_numbers_in_them_have_one_unit() {
        for (field, expected) in [
            ("foundation.stiffness", Some("N/m^2")),
            ("load.transverse.values[1]", Some("N/m")),
            ("load.transverse.breaks[0]", None),
            ("load.points[12].moment", Some("N m")),
            ("mesh.elements", None),
        ] {
            assert_eq!(unit(field), expected, "{field}");
        }
    }
}
