//! Which line a byte, or a field, of the scene stands on.

use std::collections::HashMap;

use toml::de::{DeTable, DeValue};

/// Where the lines of a text begin.
#[derive(Clone, Debug)]
pub(super) struct LineStarts(Vec<usize>);

impl LineStarts {
    pub(super) fn new(text: &str) -> Self {
        let newlines = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n');
        let mut starts = vec![0];
        starts.extend(newlines.map(|(at, _)| at + 1));
        Self(starts)
    }

    /// The 1-based line of the byte at `offset`.
    pub(super) fn line(&self, offset: usize) -> usize {
        self.0.partition_point(|&start| start <= offset)
    }

    /// The 1-based column, in characters, of the byte at `offset` of `text`.
    pub(super) fn column(&self, text: &str, offset: usize) -> usize {
        let start = self.0[self.line(offset) - 1];
        let before = text.get(start..offset.min(text.len()));
        1 + before.map_or(0, |before| before.chars().count())
    }
}

/// The lines of all fields of a scene file.
#[derive(Clone, Debug, Default)]
pub(super) struct FieldLines {
    fields: HashMap<String, usize>,
    elements: HashMap<String, Vec<usize>>,
}

impl FieldLines {
    pub(super) fn new(root: &DeTable<'_>, starts: &LineStarts) -> Self {
        let mut lines = Self::default();
        lines.add_table("", root, starts);
        lines
    }

    /// The line of `field`, or of the innermost part of its path which stands
    /// in the file.
    pub(super) fn line_of(&self, field: &str) -> Option<usize> {
        let mut path = field;
        loop {
            if let Some(line) = self.exact(path) {
                return Some(line);
            }
            path = &path[..path.rfind(['.', '['])?];
        }
    }

    fn exact(&self, path: &str) -> Option<usize> {
        if let Some(&line) = self.fields.get(path) {
            return Some(line);
        }
        let (array, index) = path.strip_suffix(']')?.rsplit_once('[')?;
        let lines = self.elements.get(array)?;
        lines.get(index.parse::<usize>().ok()?).copied()
    }

    // The depth of the recursion is that of the document, which is bounded.
    fn add_table(&mut self, path: &str, table: &DeTable<'_>, starts: &LineStarts) {
        for (key, value) in table {
            let path = joined(path, key.get_ref());
            self.add_value(&path, value.get_ref(), starts);
            self.fields.insert(path, starts.line(key.span().start));
        }
    }

    fn add_value(&mut self, path: &str, value: &DeValue<'_>, starts: &LineStarts) {
        match value {
            DeValue::Table(table) => self.add_table(path, table, starts),
            DeValue::Array(array) => {
                let lines = array.iter().map(|element| starts.line(element.span().start));
                self.elements.insert(path.to_owned(), lines.collect());
                for (index, element) in array.iter().enumerate() {
                    if matches!(element.get_ref(), DeValue::Table(_) | DeValue::Array(_)) {
                        self.add_value(&format!("{path}[{index}]"), element.get_ref(), starts);
                    }
                }
            }
            _ => {}
        }
    }
}

/// The dotted path of `key` within `path`.
pub(super) fn joined(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> FieldLines {
        let root = DeTable::parse(text).expect("valid TOML");
        FieldLines::new(root.get_ref(), &LineStarts::new(text))
    }

    #[test]
    fn offsets_become_lines_and_columns() {
        let text = "ab\nçd\n";
        let starts = LineStarts::new(text);
        assert_eq!(starts.line(0), 1);
        assert_eq!(starts.line(2), 1);
        assert_eq!(starts.line(3), 2);
        assert_eq!(starts.column(text, 5), 2);
        assert_eq!(starts.line(99), 3);
        assert_eq!(starts.column(text, 99), 1);
    }

    #[test]
    fn fields_are_found_however_they_are_written() {
        let lines = lines(
            "length = 1\nmesh.nodes = [0,\n 0.5,\n 1]\nbeam = { bending = 1,\n axial = 2 }\n\
             [foundation]\n# comment\nstiffness = 2\n[foundation.gap]\npolynomial = [1]\n",
        );
        assert_eq!(lines.line_of("length"), Some(1));
        assert_eq!(lines.line_of("mesh"), Some(2));
        assert_eq!(lines.line_of("mesh.nodes"), Some(2));
        assert_eq!(lines.line_of("mesh.nodes[1]"), Some(3));
        assert_eq!(lines.line_of("beam.bending"), Some(5));
        assert_eq!(lines.line_of("beam.axial"), Some(6));
        assert_eq!(lines.line_of("foundation"), Some(7));
        assert_eq!(lines.line_of("foundation.stiffness"), Some(9));
        assert_eq!(lines.line_of("foundation.gap"), Some(10));
        assert_eq!(lines.line_of("foundation.gap.polynomial[0]"), Some(11));
    }

    #[test]
    fn tables_in_arrays_have_their_own_lines() {
        let lines = lines("[[load.points]]\nx = 1\n\n[[load.points]]\nforce = 2\nx = 3\n");
        assert_eq!(lines.line_of("load.points[0]"), Some(1));
        assert_eq!(lines.line_of("load.points[0].x"), Some(2));
        assert_eq!(lines.line_of("load.points[1]"), Some(4));
        assert_eq!(lines.line_of("load.points[1].x"), Some(6));
    }

    #[test]
    fn absent_fields_have_the_line_of_their_table() {
        let lines = lines("[beam]\nbending = 1\n");
        assert_eq!(lines.line_of("beam.axial"), Some(1));
        assert_eq!(lines.line_of("beam.bending.values[3]"), Some(2));
        assert_eq!(lines.line_of("conduction.mu1"), None);
        assert_eq!(lines.line_of(""), None);
        assert_eq!(lines.line_of("][.é[x]"), None);
    }
}
