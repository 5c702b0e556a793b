//! The numbers of a scene file as entries that can be given other values: for sweeps.
//!
//! An entry is replaced in the text, and the text is read anew, so that a scene with other numbers is judged like any
//! other, and said to be wrong where it stands.

use std::ops::Range;
use std::path::Path;

use toml::de::{DeTable, DeValue};

use super::error::{FileError, listed, quoted};
use super::lines::{LineStarts, joined};
use super::{SceneFile, nesting, number, parse, source, suggestion, syntax};

/// Names which a message lists at most.
const LISTED: usize = 24;

/// The text of a scene file and where its numbers stand.
#[derive(Clone, Debug)]
pub struct Entries {
    name: String,
    text: String,
    numbers: Vec<(String, Range<usize>)>,
    /// Paths of formulas, tables and arrays, and what they are.
    others: Vec<(String, &'static str)>,
}

/// A number of a scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry(Range<usize>);

impl Entries {
    /// Reads the scene file at `path`; it has to be a scene as it is.
    ///
    /// # Errors
    ///
    /// As [`super::read`].
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let (name, text) = source::load(path)?;
        Self::of(&text, &name)
    }

    /// The same for the `text` of a file which messages call `name`.
    pub fn of(text: &str, name: &str) -> Result<Self, FileError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        parse(text, name)?;
        nesting::check(text, name)?;
        let root = DeTable::parse(text).map_err(|e| syntax(&e, text, name, &LineStarts::new(text)))?;
        let mut entries =
            Self { name: name.to_owned(), text: text.to_owned(), numbers: Vec::new(), others: Vec::new() };
        entries.add_table("", root.get_ref());
        // In the order of the file: the parser sorts its tables by name.
        entries.numbers.sort_by_key(|(_, place)| place.start);
        Ok(entries)
    }

    /// The text, for telling one file from another.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The number at a dotted path such as `load.points[0].x`.
    ///
    /// # Errors
    ///
    /// When no number stands there; the message says what does, or what was probably meant.
    pub fn entry(&self, path: &str) -> Result<Entry, FileError> {
        if let Some((_, place)) = self.numbers.iter().find(|(name, _)| name == path) {
            return Ok(Entry(place.clone()));
        }
        let error = |message: &str| FileError::new(&self.name, message).in_field(path);
        let inside: Vec<&str> = self.names().filter(|name| self.is_inside(name, path)).collect();
        if let Some((_, what)) = self.others.iter().find(|(name, _)| name == path) {
            let message = format!("expected a number to vary, found {what}");
            return Err(match inside.is_empty() {
                true => error(&message).hint("give it as a number, a polynomial or steps"),
                false => error(&message).hint(format!("its numbers are {}", some(&inside))),
            });
        }
        if suggestion::is_key(path) {
            return Err(error("the file does not give this number").hint("add it to the file to vary it"));
        }
        let missing = error("the scene has no such number");
        let last = |name: &str| name.rsplit('.').next() == path.rsplit('.').next();
        let same: Vec<&str> = self.names().filter(|name| last(name)).collect();
        let nearest = suggestion::nearest(path, self.names());
        Err(match (nearest, same.as_slice()) {
            (_, [only]) => missing.hint(format!("did you mean {}?", quoted(only))),
            (Some(near), _) => missing.hint(format!("did you mean {}?", quoted(near))),
            (None, []) => missing.hint(format!("it has {}", some(&self.names().collect::<Vec<_>>()))),
            (None, same) => missing.hint(format!("did you mean one of {}?", some(same))),
        })
    }

    /// The scene with other values at some entries, no two of them the same.
    ///
    /// # Errors
    ///
    /// When the values make it none.
    pub fn with(&self, values: &[(Entry, f64)]) -> Result<SceneFile, FileError> {
        let mut values: Vec<_> = values.iter().collect();
        values.sort_by_key(|(Entry(place), _)| place.start);
        let mut text = String::with_capacity(self.text.len() + 24 * values.len());
        let mut from = 0;
        for (Entry(place), value) in values {
            text += self.text.get(from..place.start).unwrap_or_default();
            text += &written(*value);
            from = place.end;
        }
        text += self.text.get(from..).unwrap_or_default();
        parse(&text, &self.name)
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.numbers.iter().map(|(name, _)| name.as_str())
    }

    fn is_inside(&self, name: &str, path: &str) -> bool {
        name.strip_prefix(path).is_some_and(|rest| rest.starts_with(['.', '[']))
    }

    // The depth of the recursion is that of the document, which is bounded.
    fn add_table(&mut self, path: &str, table: &DeTable<'_>) {
        for (key, value) in table {
            self.add(joined(path, key.get_ref()), value.get_ref(), value.span());
        }
    }

    fn add(&mut self, path: String, value: &DeValue<'_>, place: Range<usize>) {
        match value {
            DeValue::Integer(_) | DeValue::Float(_) if number::finite(value).is_ok() => {
                self.numbers.push((path, place));
            }
            DeValue::Table(table) => {
                self.add_table(&path, table);
                self.others.push((path, "a table"));
            }
            DeValue::Array(array) => {
                for (index, element) in array.iter().enumerate() {
                    self.add(format!("{path}[{index}]"), element.get_ref(), element.span());
                }
                self.others.push((path, "an array"));
            }
            DeValue::String(_) => self.others.push((path, "a formula")),
            _ => {}
        }
    }
}

/// A number as TOML: whole ones as integers, which counts have to be.
fn written(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 { format!("{value:.0}") } else { format!("{value:?}") }
}

/// The first names of a list that may be long.
fn some(names: &[&str]) -> String {
    match names.len().saturating_sub(LISTED) {
        0 => listed(names),
        more => format!("{} and {more} more", names[..LISTED].join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "\u{feff}length = 1.0\nmesh.elements = 0x10\n[beam]\nbending = 5e3 # EI\n[foundation]\n\
                         stiffness = { breaks = [0.5], values = [1e8, 2e8] }\ngap = \"0.1*x\"\n\
                         [[load.points]]\nx = 0.3\nforce = -1_000\n[[load.points]]\nx = 0.6\n";

    fn entries() -> Entries {
        Entries::of(SCENE, "a.toml").expect("a scene")
    }

    fn refusal(path: &str) -> String {
        entries().entry(path).expect_err("a refusal").to_string()
    }

    #[test]
    fn all_numbers_are_entries_in_the_order_of_the_file() {
        let entries = entries();
        let names: Vec<_> = entries.names().collect();
        let expected = [
            "length",
            "mesh.elements",
            "beam.bending",
            "foundation.stiffness.breaks[0]",
            "foundation.stiffness.values[0]",
            "foundation.stiffness.values[1]",
            "load.points[0].x",
            "load.points[0].force",
            "load.points[1].x",
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn other_values_make_other_scenes() {
        let entries = entries();
        let at = |path: &str| entries.entry(path).expect("an entry");
        let values = [
            (at("load.points[0].force"), 2.5e-7),
            (at("beam.bending"), 4e16),
            (at("mesh.elements"), 12.0),
            (at("foundation.stiffness.values[1]"), -0.0),
        ];
        let scene = entries.with(&values).expect("a scene");
        assert_eq!(scene.load.points[0].force.to_bits(), 2.5e-7_f64.to_bits());
        assert_eq!(scene.beam.bending.value(0.2, 0.2).to_bits(), 4e16_f64.to_bits());
        assert_eq!(scene.mesh.elements, Some(12));
        assert_eq!(scene.foundation.expect("one").stiffness.value(0.7, 0.7).abs().to_bits(), 0);
        assert_eq!(scene.load.points[1].x.to_bits(), 0.6_f64.to_bits());
    }

    #[test]
    fn values_that_make_no_scene_are_said_with_their_line() {
        let entries = entries();
        let elements = entries.entry("mesh.elements").expect("an entry");
        let error = entries.with(&[(elements, 12.5)]).expect_err("no count").to_string();
        assert!(error.starts_with("a.toml:2: mesh.elements: expected a whole number"), "{error}");
    }

    #[test]
    fn what_is_no_number_is_said() {
        assert_eq!(
            refusal("foundation.gap"),
            "a.toml: foundation.gap: expected a number to vary, found a formula; \
             give it as a number, a polynomial or steps"
        );
        assert_eq!(
            refusal("foundation.stiffness"),
            "a.toml: foundation.stiffness: expected a number to vary, found a table; its numbers are \
             foundation.stiffness.breaks[0], foundation.stiffness.values[0] and foundation.stiffness.values[1]"
        );
        assert_eq!(
            refusal("foundation.exponent"),
            "a.toml: foundation.exponent: the file does not give this number; add it to the file to vary it"
        );
    }

    #[test]
    fn names_that_are_wrong_are_mended() {
        for (wrong, meant) in [
            ("beam.bendin", "beam.bending"),
            ("bending", "beam.bending"),
            ("foundation.bending", "beam.bending"),
            ("load.point[0].x", "load.points[0].x"),
            ("elements", "mesh.elements"),
        ] {
            let message = refusal(wrong);
            assert!(message.ends_with(&format!("did you mean \"{meant}\"?")), "{message}");
        }
        let message = refusal("colour");
        assert!(message.contains("; it has length, mesh.elements, beam.bending, "), "{message}");
    }
}
