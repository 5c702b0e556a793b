//! The complaint about a scene file: where it stands, what is wrong, what to do.

use std::error::Error;
use std::fmt;

/// Characters of a user's text which a message repeats at most.
const SHOWN_LENGTH: usize = 60;

/// What is wrong with a scene file.
///
/// It is displayed as `file:line:column: field: message; hint`, where the line,
/// the column, the field and the hint are left out when there are none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError(Box<Parts>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Parts {
    name: String,
    line: Option<usize>,
    column: Option<usize>,
    field: Option<String>,
    message: String,
    hint: Option<String>,
}

impl FileError {
    /// A complaint about the file as a whole.
    pub(super) fn new(name: &str, message: impl Into<String>) -> Self {
        Self(Box::new(Parts {
            name: name.to_owned(),
            line: None,
            column: None,
            field: None,
            message: message.into(),
            hint: None,
        }))
    }

    /// Adds the 1-based line.
    pub(super) fn at_line(mut self, line: Option<usize>) -> Self {
        self.0.line = line;
        self
    }

    /// Adds the 1-based column, which is shown only after a line.
    pub(super) fn at_column(mut self, column: usize) -> Self {
        self.0.column = Some(column);
        self
    }

    /// Adds the dotted path of the field.
    pub(super) fn in_field(mut self, field: &str) -> Self {
        self.0.field = Some(field.to_owned());
        self
    }

    /// Adds what the user can do about it.
    pub(super) fn hint(mut self, hint: impl Into<String>) -> Self {
        self.0.hint = Some(hint.into());
        self
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = &self.0;
        write!(f, "{}", printable(&parts.name))?;
        if let Some(line) = parts.line {
            write!(f, ":{line}")?;
            if let Some(column) = parts.column {
                write!(f, ":{column}")?;
            }
        }
        if let Some(field) = &parts.field {
            write!(f, ": {}", printable(&cut(field)))?;
        }
        write!(f, ": {}", parts.message)?;
        if let Some(hint) = &parts.hint {
            write!(f, "; {hint}")?;
        }
        Ok(())
    }
}

impl Error for FileError {}

/// The text with control characters, line separators and characters that turn
/// the direction of writing replaced by their escapes.
pub fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if hidden(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    shown
}

/// The text in double quotes, printable and cut when it is long.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", printable(&cut(text)))
}

/// The text, or its beginning when it is long.
pub(super) fn cut(text: &str) -> String {
    let mut shown: String = text.chars().take(SHOWN_LENGTH).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    shown
}

/// A character which a terminal would obey rather than show.
fn hidden(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}'
        )
}

/// `a`, `a and b`, `a, b and c`.
pub(super) fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_is_optional() {
        let error = FileError::new("a.toml", "broken");
        assert_eq!(error.to_string(), "a.toml: broken");
        let error = error.at_line(Some(3)).in_field("beam").hint("mend it");
        assert_eq!(error.to_string(), "a.toml:3: beam: broken; mend it");
        let error = error.at_column(7);
        assert_eq!(error.to_string(), "a.toml:3:7: beam: broken; mend it");
    }

    #[test]
    fn terminals_are_not_commanded() {
        let error = FileError::new("a\u{1b}[2J.toml", "broken").in_field("x\ny");
        assert_eq!(error.to_string(), "a\\u{1b}[2J.toml: x\\ny: broken");
        assert_eq!(quoted("a\u{202e}b\t"), "\"a\\u{202e}b\\t\"");
        assert_eq!(quoted("Stützweite"), "\"Stützweite\"");
    }

    #[test]
    fn long_texts_are_cut() {
        let shown = quoted(&"é".repeat(100));
        assert_eq!(shown.chars().count(), SHOWN_LENGTH + 3);
        let error = FileError::new("a", "broken").in_field(&"x".repeat(1_000_000));
        assert_eq!(error.to_string(), format!("a: {}…: broken", "x".repeat(SHOWN_LENGTH)));
    }

    #[test]
    fn lists_read_as_english() {
        assert_eq!(listed(&["a"]), "a");
        assert_eq!(listed(&["a", "b"]), "a and b");
        assert_eq!(listed(&["a", "b", "c"]), "a, b and c");
    }
}
