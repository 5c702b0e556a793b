//! Quantities which vary along the beam.

use super::expression::Expression;

/// A function of the position `x` on the beam.
#[derive(Clone, Debug)]
pub enum ProfileSpec {
    /// The same everywhere.
    Number(f64),
    /// The coefficients of the powers of `x`, from the constant one on.
    Polynomial(Vec<f64>),
    /// A value between each two breaks, before the first and after the last.
    Steps { breaks: Vec<f64>, values: Vec<f64> },
    /// A polynomial in `x` between each two breaks, before the first and after
    /// the last.
    Pieces { breaks: Vec<f64>, polynomials: Vec<Vec<f64>> },
    /// Values at positions from one end of the beam to the other, with straight
    /// lines between them.
    Table { x: Vec<f64>, y: Vec<f64> },
    /// A formula.
    Expression(Expression),
}

impl From<f64> for ProfileSpec {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl ProfileSpec {
    /// The positions inside the beam where one piece ends and the next begins.
    pub fn breaks(&self) -> &[f64] {
        match self {
            Self::Number(_) | Self::Polynomial(_) | Self::Expression(_) => &[],
            Self::Steps { breaks, .. } | Self::Pieces { breaks, .. } => breaks,
            Self::Table { x, .. } => x.get(1..x.len().saturating_sub(1)).unwrap_or_default(),
        }
    }

    /// The value at `x` of the piece which contains `mid`.
    ///
    /// The point `mid` tells which of two pieces is meant when `x` is the break
    /// between them.
    pub fn value(&self, x: f64, mid: f64) -> f64 {
        match self {
            Self::Expression(expression) => expression.value(x),
            _ => self.jet(x, mid)[0],
        }
    }

    /// The value and the first two derivatives at `x` of the piece which
    /// contains `mid`.
    pub fn jet(&self, x: f64, mid: f64) -> [f64; 3] {
        let piece = self.breaks().partition_point(|&start| start <= mid);
        match self {
            Self::Number(value) => [*value, 0.0, 0.0],
            Self::Polynomial(coefficients) => polynomial(coefficients, x),
            Self::Steps { values, .. } => match values.get(piece) {
                Some(&value) => [value, 0.0, 0.0],
                None => [f64::NAN; 3],
            },
            Self::Pieces { polynomials, .. } => match polynomials.get(piece) {
                Some(coefficients) => polynomial(coefficients, x),
                None => [f64::NAN; 3],
            },
            Self::Table { x: xs, y: ys } => line(xs, ys, piece, x),
            Self::Expression(expression) => expression.jet(x),
        }
    }

    /// Whether the profile is written as a number or as steps of numbers.
    pub fn stepwise(&self) -> bool {
        matches!(self, Self::Number(_) | Self::Steps { .. })
    }

    /// Whether the profile is zero everywhere and this is plain to see; a
    /// formula such as `x - x` is not examined.
    pub fn is_zero(&self) -> bool {
        let zeros = |numbers: &[f64]| numbers.iter().all(|&number| number == 0.0);
        match self {
            Self::Number(value) => zeros(&[*value]),
            Self::Polynomial(coefficients) => zeros(coefficients),
            Self::Steps { values, .. } => zeros(values),
            Self::Pieces { polynomials, .. } => polynomials.iter().all(|piece| zeros(piece)),
            Self::Table { y, .. } => zeros(y),
            Self::Expression(expression) => expression.is_zero(),
        }
    }
}

/// The value and the first two derivatives by Horner's rule.
fn polynomial(coefficients: &[f64], x: f64) -> [f64; 3] {
    let [mut value, mut first, mut half_second] = [0.0; 3];
    for coefficient in coefficients.iter().rev() {
        half_second = half_second * x + first;
        first = first * x + value;
        value = value * x + coefficient;
    }
    [value, first, 2.0 * half_second]
}

/// The straight line over the interval of this number.
fn line(xs: &[f64], ys: &[f64], piece: usize, x: f64) -> [f64; 3] {
    let (Some([x0, x1]), Some([y0, y1])) = (pair(xs, piece), pair(ys, piece)) else {
        return [f64::NAN; 3];
    };
    let (run, rise) = (x1 - x0, y1 - y0);
    // Starting from the nearer end makes the line meet both points exactly. A slope may be below the number format where
    // the values are not.
    let value = if x - x0 <= x1 - x { y0 + (x - x0) / run * rise } else { y1 - (x1 - x) / run * rise };
    [value, rise / run, 0.0]
}

fn pair(numbers: &[f64], index: usize) -> Option<[f64; 2]> {
    let pair = numbers.get(index..)?.first_chunk::<2>()?;
    Some(*pair)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same(found: [f64; 3], expected: [f64; 3]) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
    }

    #[test]
    fn polynomials_have_all_derivatives() {
        let profile = ProfileSpec::Polynomial(vec![0.0, 0.0, 4.0, -8.0, 4.0]);
        same(profile.jet(0.5, 0.1), [0.25, 0.0, -4.0]);
        same(profile.jet(0.0, 0.1), [0.0, 0.0, 8.0]);
        same(ProfileSpec::Number(3.0).jet(0.5, 0.1), [3.0, 0.0, 0.0]);
    }

    #[test]
    fn the_piece_is_the_one_around_mid() {
        let steps = ProfileSpec::Steps { breaks: vec![0.5], values: vec![1.0, -1.0] };
        same(steps.jet(0.5, 0.4), [1.0, 0.0, 0.0]);
        same(steps.jet(0.5, 0.6), [-1.0, 0.0, 0.0]);
        let pieces =
            ProfileSpec::Pieces { breaks: vec![0.5], polynomials: vec![vec![1.0, 2.0], vec![0.0, 0.0, 3.0]] };
        same(pieces.jet(0.5, 0.4), [2.0, 2.0, 0.0]);
        same(pieces.jet(0.5, 0.6), [0.75, 3.0, 6.0]);
        let table = ProfileSpec::Table { x: vec![0.0, 0.5, 1.0], y: vec![0.0, 2.0, 1.0] };
        same(table.jet(0.5, 0.4), [2.0, 4.0, 0.0]);
        same(table.jet(0.5, 0.6), [2.0, -2.0, 0.0]);
        same(table.jet(1.0, 0.6), [1.0, -2.0, 0.0]);
        assert_eq!(table.breaks(), [0.5]);
        assert_eq!(pieces.breaks(), [0.5]);
        assert!((table.value(0.25, 0.1) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn malformed_profiles_are_not_numbers() {
        let steps = ProfileSpec::Steps { breaks: vec![0.5], values: vec![1.0] };
        assert!(steps.value(0.7, 0.7).is_nan());
        let table = ProfileSpec::Table { x: vec![], y: vec![1.0] };
        assert!(table.value(0.7, 0.7).is_nan());
        assert!(table.breaks().is_empty());
    }

    #[test]
    fn zeros_and_steps_are_recognised() {
        assert!(ProfileSpec::Number(-0.0).is_zero());
        assert!(ProfileSpec::Polynomial(vec![0.0, 0.0]).is_zero());
        assert!(!ProfileSpec::Polynomial(vec![0.0, 1.0]).is_zero());
        let steps = ProfileSpec::Steps { breaks: vec![0.5], values: vec![0.0, 0.0] };
        assert!(steps.is_zero() && steps.stepwise());
        let pieces = ProfileSpec::Pieces { breaks: vec![0.5], polynomials: vec![vec![0.0], vec![1.0]] };
        assert!(!pieces.is_zero() && !pieces.stepwise());
        assert!(ProfileSpec::Number(1.0).stepwise());
    }
}
