//! A table and a field of the parsed document, each knowing its path and line,
//! so that whatever is wrong with them can be said where it stands.

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use super::error::{FileError, cut, printable, quoted};
use super::lines::{LineStarts, joined};
use super::{number, suggestion};

/// The file being read.
pub(super) struct Document<'a> {
    pub(super) name: &'a str,
    pub(super) starts: LineStarts,
}

/// A table of the document.
pub(super) struct Table<'a> {
    document: &'a Document<'a>,
    path: String,
    line: Option<usize>,
    content: &'a DeTable<'a>,
}

/// A value of the document.
pub(super) struct Field<'a> {
    document: &'a Document<'a>,
    path: String,
    line: usize,
    value: &'a DeValue<'a>,
}

impl<'a> Table<'a> {
    /// The whole document.
    pub(super) fn root(document: &'a Document<'a>, content: &'a DeTable<'a>) -> Self {
        Self { document, path: String::new(), line: None, content }
    }

    /// Refuses any key but the `allowed` ones.
    pub(super) fn allow(&self, allowed: &[&str]) -> Result<(), FileError> {
        let unknown = self.content.keys().filter(|key| {
            let key: &str = key.get_ref();
            !allowed.contains(&key)
        });
        let Some(key) = unknown.min_by_key(|key| key.span().start) else {
            return Ok(());
        };
        let line = self.document.starts.line(key.span().start);
        Err(FileError::new(self.document.name, "unknown key")
            .at_line(Some(line))
            .in_field(&joined(&self.path, key.get_ref()))
            .hint(suggestion::for_key(key.get_ref(), &self.path, allowed)))
    }

    /// Whether the key is there.
    pub(super) fn has(&self, key: &str) -> bool {
        self.content.contains_key(key)
    }

    /// The field of this key, when it is there.
    pub(super) fn field(&self, key: &str) -> Option<Field<'a>> {
        let (key, value) = self.content.get_key_value(key)?;
        Some(Field {
            document: self.document,
            path: joined(&self.path, key.get_ref()),
            line: self.document.starts.line(key.span().start),
            value: value.get_ref(),
        })
    }

    /// The field of this key, which has to be there.
    pub(super) fn required(&self, key: &str, hint: &str) -> Result<Field<'a>, FileError> {
        self.field(key).ok_or_else(|| {
            FileError::new(self.document.name, "missing")
                .at_line(self.line)
                .in_field(&joined(&self.path, key))
                .hint(hint)
        })
    }

    /// The table of this key, when it is there.
    pub(super) fn table(&self, key: &str) -> Result<Option<Table<'a>>, FileError> {
        self.field(key).map(|field| field.table()).transpose()
    }

    /// The number of this key, when it is there.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, FileError> {
        self.field(key).map(|field| field.number()).transpose()
    }
}

impl<'a> Field<'a> {
    /// A complaint about this field.
    pub(super) fn error(&self, message: impl Into<String>) -> FileError {
        FileError::new(self.document.name, message).at_line(Some(self.line)).in_field(&self.path)
    }

    pub(super) fn value(&self) -> &'a DeValue<'a> {
        self.value
    }

    /// What stands here instead of what was expected.
    pub(super) fn expected(&self, what: &str) -> FileError {
        self.error(format!("expected {what}, found {}", described(self.value)))
    }

    /// The field as a finite number.
    pub(super) fn number(&self) -> Result<f64, FileError> {
        number::finite(self.value).map_err(|problem| match problem {
            number::Problem::NotANumber => match self.value {
                DeValue::String(text) if text.trim().parse::<f64>().is_ok() => {
                    self.expected("a number").hint(format!("remove the quotes: {}", text.trim()))
                }
                _ => self.expected("a number"),
            },
            number::Problem::NotFinite(text) => {
                self.error(format!("{text} is not a finite number")).hint("give the value itself")
            }
            number::Problem::TooLarge(text) => self
                .error(format!("{text} is beyond the range of double precision"))
                .hint("use numbers up to about 1.8e308"),
            number::Problem::TooSmall(text) => self
                .error(format!("{text} is too small for double precision"))
                .hint("write 0, or numbers from about 5e-324 on"),
        })
    }

    /// The field as a whole number from 1 to `most`.
    pub(super) fn count(&self, most: usize) -> Result<usize, FileError> {
        let what = format!("a whole number from 1 to {most}");
        let DeValue::Integer(integer) = self.value else {
            return Err(self.expected(&what));
        };
        let value = usize::from_str_radix(integer.as_str(), integer.radix());
        match value {
            Ok(count) if (1..=most).contains(&count) => Ok(count),
            _ => Err(self.expected(&what)),
        }
    }

    /// The field as an array of numbers with at least one element.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, FileError> {
        let DeValue::Array(array) = self.value else {
            return Err(self.expected("an array of numbers"));
        };
        if array.is_empty() {
            return Err(self.error("expected an array of numbers, found an empty one"));
        }
        self.elements(array).map(|element| element.number()).collect()
    }

    /// The fields in an array, which are called `path[0]`, `path[1]`, ...
    pub(super) fn elements(&self, array: &'a DeArray<'a>) -> impl Iterator<Item = Field<'a>> {
        array.iter().enumerate().map(|(index, element)| Field {
            document: self.document,
            path: format!("{}[{index}]", self.path),
            line: self.line_of(element),
            value: element.get_ref(),
        })
    }

    fn line_of(&self, element: &Spanned<DeValue<'_>>) -> usize {
        self.document.starts.line(element.span().start)
    }

    /// The field as a table.
    pub(super) fn table(&self) -> Result<Table<'a>, FileError> {
        let what = format!("the table [{}]", self.path);
        match self.value {
            DeValue::Table(content) => {
                Ok(Table { document: self.document, path: self.path.clone(), line: Some(self.line), content })
            }
            DeValue::Array(array) if array.iter().all(|e| e.get_ref().is_table()) => {
                Err(self.expected(&what).hint(format!("write [{}] once, in single brackets", self.path)))
            }
            _ => Err(self.expected(&what)),
        }
    }
}

/// A value as a message calls it.
fn described(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text {}", quoted(text)),
        DeValue::Integer(integer) => format!("the number {}", printable(&cut(&integer.to_string()))),
        DeValue::Float(float) => format!("the number {}", printable(&cut(float.as_str()))),
        DeValue::Boolean(truth) => format!("the boolean {truth}"),
        DeValue::Datetime(_) => "a date or time".to_owned(),
        DeValue::Array(array) => match array.len() {
            0 => "an empty array".to_owned(),
            1 => "an array of 1 element".to_owned(),
            count => format!("an array of {count} elements"),
        },
        DeValue::Table(_) => "a table".to_owned(),
    }
}
