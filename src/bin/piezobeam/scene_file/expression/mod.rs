//! Profiles given as formulas in the position `x`, such as `"0.4*sin(pi*x/L)^2"`.
//!
//! The usual rules of mathematics hold: a power binds tighter than a sign, so that `-x^2` is the negative of
//! the square, and `2^3^2` is `2^(3^2)`. `winnow`, which also parses the TOML around the formula, parses it
//! by the precedence of its operators into a short program without branches. The program is run on plain
//! numbers for the value, and on the dual numbers of `num-dual` where the exact first two derivatives are
//! needed.
//!
//! The library `exmex` would do both, but version 0.21 was found to read `-x^2` as the square of `-x` and
//! `2^3^2` as 64, and its symbolic second derivatives overflow a stack of 2 MiB from six chained quotients
//! `(x/(1 + x))/(1 + x)...` (nine nested ones `1/(1 + 1/(1 + ...))`) on, in an optimised build.

mod parser;
mod program;
#[cfg(test)]
mod tests;

use num_dual::Dual2_64;
use program::Program;

/// A formula in the position `x`.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    program: Program,
}

/// Why a text is not a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ExpressionError {
    /// The 1-based character of the text, where the trouble has a place.
    pub(super) at: Option<usize>,
    pub(super) message: String,
    pub(super) hint: String,
}

impl Expression {
    /// Reads a formula in which `L` is the `length` of the beam.
    pub(super) fn parse(text: &str, length: f64) -> Result<Self, ExpressionError> {
        Ok(Self { text: text.to_owned(), program: parser::parse(text, length)? })
    }

    /// The formula as the user wrote it.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The value at `x`; NaN where the formula is not defined.
    pub fn value(&self, x: f64) -> f64 {
        self.program.run(x)
    }

    /// The value and the first two derivatives at `x`; NaN, or infinite, where the formula does not have them.
    pub fn jet(&self, x: f64) -> [f64; 3] {
        let Dual2_64 { re, v1, v2 } = self.program.run(Dual2_64::from_re(x).derivative());
        if re.is_nan() { [f64::NAN; 3] } else { [re, v1, v2] }
    }

    /// The first function in the formula whose graph has kinks.
    pub(super) fn kinked(&self) -> Option<&'static str> {
        self.program.kinked()
    }

    /// Whether the formula is zero without depending on `x`.
    pub(super) fn is_zero(&self) -> bool {
        self.program.constant() == Some(0.0)
    }
}
