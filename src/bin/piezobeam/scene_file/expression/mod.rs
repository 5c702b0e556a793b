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

/// Intervals between the points where poles are looked for.
const POINTS: usize = 1024;

/// Growth between two of these points that no function which a mesh can resolve has.
const UNBOUNDED: f64 = 1e8;

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

    /// A position on the beam of this length where the formula grows without bound, if one is found: from every peak
    /// among evenly spaced points it is followed upwards.
    pub(super) fn pole(&self, length: f64) -> Option<f64> {
        let at = |i: usize| length * (i as f64 / POINTS as f64);
        let values: Vec<f64> = (0..=POINTS).map(|i| self.value(at(i))).collect();
        let size = |i: usize| values[i].abs();
        (0..=POINTS).find_map(|i| {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(POINTS));
            if values[i].is_infinite() {
                return Some(at(i));
            }
            let peak = size(i) > 0.0 && !(size(before) > size(i) || size(after) > size(i));
            if peak { self.climb(at(before), at(after), values[i]) } else { None }
        })
    }

    /// The way up to a pole between a and b, by thirds, from where the formula has the value `base`.
    fn climb(&self, mut a: f64, mut b: f64, base: f64) -> Option<f64> {
        let mut first = 0.0;
        for step in 0..100 {
            let third = (b - a) / 3.0;
            let (left, right) = (a + third, b - third);
            let [low, high] = [left, right].map(|x| self.value(x));
            let rise = (low - base).abs().max((high - base).abs());
            match step {
                0 => first = rise,
                // Hundred times nearer to a pole, even to a weak one, there is more of it than from afar.
                12 if rise < 4.0 * first => break,
                _ if rise > UNBOUNDED * first => {
                    return Some(if low.abs() > high.abs() { left } else { right });
                }
                _ => {}
            }
            (a, b) = if low.abs() > high.abs() { (a, right) } else { (left, b) };
        }
        None
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
