//! What can be wrong with an input. Not converging is no error but a [`Status`](crate::Status).

use core::fmt;

/// Where in a field a value stands.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Place {
    /// The field is one number.
    Whole,
    /// Entry of a list, counted from 0.
    Index(usize),
    /// A function of x, at this x in metres.
    At(f64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Index(i) => write!(f, "[{i}]"),
            Self::At(x) => write!(f, " at x = {}", Number(*x)),
        }
    }
}

/// Bad input: which field, where in it, what was expected, what was found.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A number out of its range.
    Value {
        /// Dotted name of the field, as in a scene file.
        field: &'static str,
        /// Where in the field.
        place: Place,
        /// What the field takes.
        expected: &'static str,
        /// What it has.
        found: f64,
    },
    /// A list of the wrong length.
    Length {
        /// Dotted name of the field.
        field: &'static str,
        /// What the length has to be, in words.
        what: &'static str,
        /// The length that fits.
        expected: usize,
        /// The length found.
        found: usize,
    },
    /// A function that has to be continuous jumps.
    Jump {
        /// Dotted name of the field.
        field: &'static str,
        /// Where it jumps, in metres.
        x: f64,
        /// Value to the left.
        left: f64,
        /// Value to the right.
        right: f64,
    },
    /// A part of the scene needs another one.
    Missing {
        /// Dotted name of the field that lacks.
        field: &'static str,
        /// What needs it.
        needed_by: &'static str,
    },
    /// The mesh with its nodes at breaks and point loads does not fit into the workspace.
    Capacity {
        /// Elements of the mesh.
        needed: usize,
        /// Elements that the workspace holds.
        available: usize,
    },
}

/// A number as a person writes it: with an exponent where it is very large or very small.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        if size == 0.0 || (1e-4..1e7).contains(&size) || !size.is_finite() {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:e}", self.0)
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Value { field, place, expected, found } => {
                write!(f, "{field}{place}: expected {expected}, found {}", Number(found))
            }
            Self::Length { field, what, expected, found } => {
                write!(f, "{field}: {what}: expected {expected}, found {found}")
            }
            Self::Jump { field, x, left, right } => write!(
                f,
                "{field} at x = {}: expected a continuous function, found a jump from {} to {}",
                Number(x),
                Number(left),
                Number(right)
            ),
            Self::Missing { field, needed_by } => {
                write!(f, "{field}: expected because of {needed_by}, found nothing")
            }
            Self::Capacity { needed, available } => write!(
                f,
                "workspace: expected room for {needed} elements or more (breaks and point loads add nodes), \
                 found {available}"
            ),
        }
    }
}

impl core::error::Error for Error {}

/// `Ok` where `value` satisfies `ok`, else the error that says so.
pub(crate) fn expect<T: crate::Real>(
    ok: bool,
    field: &'static str,
    place: Place,
    expected: &'static str,
    value: T,
) -> Result<(), Error> {
    if ok { Ok(()) } else { Err(Error::Value { field, place, expected, found: value.f64() }) }
}
