//! The scene printed for a person, with units.

use std::fmt::Write;

use super::error::printable;
use super::profile::ProfileSpec;
use super::{BeamTable, ConductionTable, FoundationTable, LoadTable, MeshTable, PotentialTable, SceneFile};

/// Entries of a long list which are shown.
const SHOWN: usize = 6;

/// The widest value which takes part in the alignment of the units.
const WIDEST: usize = 28;

/// A field, its value and its unit.
struct Row {
    field: String,
    value: String,
    unit: String,
}

/// The rows of the description.
#[derive(Default)]
struct Rows(Vec<Row>);

impl SceneFile {
    /// The scene as aligned lines of fields, values and units.
    pub fn describe(&self) -> String {
        format!("scene {}\n{}", printable(&self.name), self.rows().aligned())
    }

    /// Fields and their values with units, without the mesh and what the scene does not have, or has as anyone
    /// would expect.
    pub fn facts(&self) -> Vec<(String, String)> {
        let bound = self.conduction.as_ref().and_then(|conduction| conduction.potential_truncation);
        let plain = |row: &Row| match row.field.as_str() {
            "foundation.exponent" => row.value == "1",
            "conduction.potential_truncation" => bound.is_none(),
            field => {
                row.value == "none"
                    || field.starts_with("mesh")
                    || (field.ends_with(".moment") && row.value == "0")
            }
        };
        let rows = self.rows().0.into_iter();
        rows.filter(|row| !plain(row))
            .map(|row| (row.field, format!("{} {}", row.value, row.unit).trim_end().to_owned()))
            .collect()
    }

    fn rows(&self) -> Rows {
        let mut rows = Rows::default();
        rows.add("length", number(self.length), "m");
        rows.beam(&self.beam);
        match &self.foundation {
            Some(foundation) => rows.foundation(foundation),
            None => rows.add("foundation", "none", ""),
        }
        match &self.conduction {
            Some(conduction) => rows.conduction(conduction),
            None => rows.add("conduction", "none", ""),
        }
        rows.load(&self.load);
        match &self.potential {
            Some(potential) => rows.potential(potential),
            None => rows.add("potential", "none", ""),
        }
        rows.mesh(&self.mesh);
        rows
    }
}

impl Rows {
    fn add(&mut self, field: &str, value: impl Into<String>, unit: &str) {
        self.0.push(Row { field: field.to_owned(), value: value.into(), unit: unit.to_owned() });
    }

    fn profile(&mut self, field: &str, value: Option<&ProfileSpec>, unit: &str) {
        if let Some(value) = value {
            self.add(field, profile(value), unit);
        }
    }

    fn beam(&mut self, beam: &BeamTable) {
        self.profile("beam.bending", Some(&beam.bending), "N m^2");
        self.profile("beam.axial", beam.axial.as_ref(), "N");
        self.profile("beam.piezo", beam.piezo.as_ref(), "N m/V");
        self.profile("beam.permittivity", beam.permittivity.as_ref(), "N m^2/V^2");
    }

    fn foundation(&mut self, foundation: &FoundationTable) {
        let power = 1.0 + foundation.exponent;
        let unit = format!("N/m^{power}");
        self.profile("foundation.stiffness", Some(&foundation.stiffness), &unit);
        self.add("foundation.exponent", number(foundation.exponent), "");
        match &foundation.gap {
            Some(gap) => self.add("foundation.gap", profile(gap), "m"),
            None => self.add("foundation.gap", "none", ""),
        }
    }

    fn conduction(&mut self, conduction: &ConductionTable) {
        for (field, value) in [("conduction.mu1", &conduction.mu1), ("conduction.mu2", &conduction.mu2)] {
            let value = value.as_ref().map_or("0".to_owned(), profile);
            self.add(field, value, "N/(V m^2)");
        }
        self.add("conduction.truncation", number(conduction.truncation), "m");
        let potential = conduction.potential_truncation;
        let potential = potential.unwrap_or(conduction.truncation);
        self.add("conduction.potential_truncation", number(potential), "V");
    }

    fn load(&mut self, load: &LoadTable) {
        let LoadTable { transverse, axial, points } = load;
        if transverse.is_none() && axial.is_none() && points.is_empty() {
            self.add("load", "none", "");
        }
        self.profile("load.transverse", transverse.as_ref(), "N/m");
        self.profile("load.axial", axial.as_ref(), "N/m");
        for (index, point) in points.iter().enumerate().take(SHOWN) {
            let field = |key: &str| format!("load.points[{index}].{key}");
            self.add(&field("x"), number(point.x), "m");
            self.add(&field("force"), number(point.force), "N");
            self.add(&field("moment"), number(point.moment), "N m");
        }
        if points.len() > SHOWN {
            let more = format!("{} more", points.len() - SHOWN);
            self.add("load.points", more, "");
        }
    }

    fn potential(&mut self, potential: &PotentialTable) {
        self.add("potential.left", number(potential.left), "V");
        self.add("potential.right", number(potential.right), "V");
    }

    fn mesh(&mut self, mesh: &MeshTable) {
        if let Some(elements) = mesh.elements {
            self.add("mesh.elements", elements.to_string(), "");
        }
        if let Some(nodes) = &mesh.nodes {
            self.add("mesh.nodes", list(nodes), "m");
        }
        if mesh.elements.is_none() && mesh.nodes.is_none() {
            self.add("mesh", "automatic", "");
        }
    }

    fn aligned(&self) -> String {
        let widest = |width: fn(&Row) -> usize| self.0.iter().map(width).max().unwrap_or(0);
        let fields = widest(|row| row.field.chars().count());
        let values = widest(|row| row.value.chars().count().min(WIDEST));
        let mut text = String::new();
        for row in &self.0 {
            let line = format!("{:fields$}  {:values$}  {}", row.field, row.value, row.unit);
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {}", line.trim_end());
        }
        text
    }
}

/// A number, in powers of ten where it is very large or very small.
fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) { format!("{value:e}") } else { value.to_string() }
}

/// A list of numbers, of which the middle is left out when it is long.
fn list(values: &[f64]) -> String {
    let numbers = |values: &[f64]| {
        let shown: Vec<String> = values.iter().copied().map(number).collect();
        shown.join(", ")
    };
    match values {
        [first @ .., last] if first.len() > SHOWN => {
            format!("{}, ..., {} ({} numbers)", numbers(&first[..SHOWN - 1]), number(*last), values.len())
        }
        _ => numbers(values),
    }
}

fn profile(profile: &ProfileSpec) -> String {
    match profile {
        ProfileSpec::Number(value) => number(*value),
        ProfileSpec::Polynomial(coefficients) => polynomial(coefficients),
        ProfileSpec::Steps { breaks, values } => pieces(breaks, values.len(), |index| number(values[index])),
        ProfileSpec::Pieces { breaks, polynomials } => {
            pieces(breaks, polynomials.len(), |index| polynomial(&polynomials[index]))
        }
        ProfileSpec::Table { x, y } => format!("lines with y = {} at x = {}", list(y), list(x)),
        ProfileSpec::Expression(expression) => {
            let words: Vec<&str> = expression.text().split_whitespace().collect();
            printable(&words.join(" "))
        }
    }
}

/// The pieces in turn, each with the position it reaches to.
fn pieces(breaks: &[f64], count: usize, piece: impl Fn(usize) -> String) -> String {
    let mut shown: Vec<String> = (0..count.min(SHOWN)).map(piece).collect();
    for (piece, &end) in shown.iter_mut().zip(breaks) {
        *piece = format!("{piece} to x = {}", number(end));
    }
    if count > SHOWN {
        shown.push(format!("... ({count} pieces)"));
    }
    shown.join(", then ")
}

/// The terms which are not zero.
fn polynomial(coefficients: &[f64]) -> String {
    let mut text = String::new();
    let terms = coefficients.iter().enumerate();
    let terms: Vec<_> = terms.filter(|&(_, &value)| value != 0.0).collect();
    for &(power, &value) in terms.iter().take(SHOWN) {
        let (sign, size) = match (text.is_empty(), value < 0.0) {
            (true, _) => ("", value),
            (false, false) => (" + ", value),
            (false, true) => (" - ", -value),
        };
        text.push_str(sign);
        text.push_str(&number(size));
        // Writing to a string cannot fail.
        let _ = match power {
            0 => Ok(()),
            1 => write!(text, " x"),
            _ => write!(text, " x^{power}"),
        };
    }
    match terms.len() {
        0 => "0".to_owned(),
        count if count > SHOWN => format!("{text} + ... ({count} terms)"),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;

    fn described(text: &str) -> String {
        match parse(text, "scene.toml") {
            Ok(scene) => scene.describe(),
            Err(error) => panic!("{error}"),
        }
    }

    #[test]
    fn facts_are_what_is_special() {
        let text = "length = 2.0\nbeam.bending = 3.0\nfoundation.stiffness = 1e8\n[[load.points]]\nx = 1\nforce = 5\n";
        let facts = parse(text, "scene.toml").expect("a scene").facts();
        let fields: Vec<_> = facts.iter().map(|(field, value)| format!("{field} {value}")).collect();
        let expected = ["length 2 m", "beam.bending 3 N m^2", "foundation.stiffness 1e8 N/m^2"];
        assert_eq!(fields[..3], expected);
        assert_eq!(fields[3..], ["load.points[0].x 1 m", "load.points[0].force 5 N"]);
    }

    #[test]
    fn everything_is_shown_with_its_unit() {
        let text = described(super::super::tests::EXAMPLE);
        let expected = "\
scene scene.toml
  length                           1                             m
  beam.bending                     5000                          N m^2
  beam.axial                       100000                        N
  beam.piezo                       100                           N m/V
  beam.permittivity                1                             N m^2/V^2
  foundation.stiffness             1e8                           N/m^2
  foundation.exponent              1
  foundation.gap                   4 x^2 - 8 x^3 + 4 x^4         m
  conduction.mu1                   1                             N/(V m^2)
  conduction.mu2                   1                             N/(V m^2)
  conduction.truncation            1                             m
  conduction.potential_truncation  1                             V
  load.transverse                  1e6 to x = 0.5, then -1e6     N/m
  load.axial                       1e6                           N/m
  load.points[0].x                 0.3                           m
  load.points[0].force             1000                          N
  load.points[0].moment            0                             N m
  potential.left                   1                             V
  potential.right                  1                             V
  mesh.elements                    100
";
        // The column of the units follows the widest value.
        let squeeze = |text: &str| {
            let lines = text.lines().map(|line| {
                let words: Vec<&str> = line.split_whitespace().collect();
                words.join(" ")
            });
            lines.collect::<Vec<_>>()
        };
        assert_eq!(squeeze(&text), squeeze(expected));
        let unit = |line: &str| line.find(" N/m").or(line.find(" m"));
        let columns: Vec<_> = text
            .lines()
            .filter(|line| line.ends_with(" m") && !line.ends_with("N m") || line.ends_with(" N/m"))
            .map(unit)
            .collect();
        assert!(columns.len() > 3 && columns.windows(2).all(|pair| pair[0] == pair[1]));
    }

    #[test]
    fn absent_parts_are_named() {
        let text = described("length = 2.5\n[beam]\nbending = \"5e3*(1 + x)\"\n");
        assert_eq!(
            text,
            "scene scene.toml\n  \
             length        2.5          m\n  \
             beam.bending  5e3*(1 + x)  N m^2\n  \
             foundation    none\n  \
             conduction    none\n  \
             load          none\n  \
             potential     none\n  \
             mesh          automatic\n"
        );
    }

    #[test]
    fn long_lists_are_cut() {
        let many: Vec<f64> = (0..100).map(f64::from).collect();
        assert_eq!(list(&many), "0, 1, 2, 3, 4, ..., 99 (100 numbers)");
        assert_eq!(polynomial(&[0.0]), "0");
        assert_eq!(polynomial(&[-1.0, 0.0, -2e-9]), "-1 - 2e-9 x^2");
        assert_eq!(polynomial(&many), "1 x + 2 x^2 + 3 x^3 + 4 x^4 + 5 x^5 + 6 x^6 + ... (99 terms)");
        assert_eq!(
            pieces(&many, 101, |index| index.to_string()),
            "0 to x = 0, then 1 to x = 1, then 2 to x = 2, then 3 to x = 3, \
             then 4 to x = 4, then 5 to x = 5, then ... (101 pieces)"
        );
    }
}
