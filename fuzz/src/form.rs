//! A profile of any form.

use crate::number::{self, Number, Position};
use arbitrary::Arbitrary;
use piezobeam::{Cubic, Error, Flat, Pieces, Polynomial, Profile, Real, Smooth, Steps, Table};

/// What a byte string spells.
#[derive(Arbitrary, Clone, Debug)]
pub enum Form {
    Number(Number),
    Polynomial([Number; 3]),
    Steps { breaks: [Position; 2], values: [Number; 3] },
    Pieces { at: Position, polynomials: [[Number; 2]; 2] },
    Table { x: [Position; 2], y: [Number; 4] },
    Mismatched { breaks: Vec<Position>, values: Vec<Number> },
}

impl Form {
    /// The first number, for scenes of numbers.
    pub fn number(&self) -> Number {
        match self {
            Self::Number(n) | Self::Polynomial([n, ..]) => *n,
            Self::Steps { values, .. } => values[0],
            Self::Pieces { polynomials, .. } => polynomials[0][0],
            Self::Table { y, .. } => y[0],
            Self::Mismatched { values, .. } => values.first().copied().unwrap_or(Number::Nominal),
        }
    }
}

/// The profile itself.
#[derive(Clone, Debug)]
pub enum Any<T> {
    Number(T),
    Polynomial(Vec<T>),
    Steps { breaks: Vec<T>, values: Vec<T> },
    Pieces { breaks: Vec<T>, polynomials: [Vec<T>; 2] },
    Table { x: Vec<T>, y: Vec<T> },
}

impl<T: Real> Any<T> {
    pub fn new(form: &Form, nominal: f64, length: T) -> Self {
        let of = |n: &Number| n.of(nominal);
        match form {
            Form::Number(n) => Self::Number(of(n)),
            Form::Polynomial(c) => {
                let scaled = |(i, n): (usize, &Number)| n.of(nominal / length.f64().powi(i as i32));
                Self::Polynomial(c.iter().enumerate().map(scaled).collect())
            }
            Form::Steps { breaks, values } => Self::Steps {
                breaks: number::positions(breaks, length),
                values: values.iter().map(of).collect(),
            },
            Form::Pieces { at, polynomials: [a, b] } => {
                let list = |c: &[Number; 2]| vec![c[0].of(nominal), c[1].of(nominal / length.f64())];
                Self::Pieces { breaks: number::positions(&[*at], length), polynomials: [list(a), list(b)] }
            }
            Form::Table { x, y } => {
                let mut x = number::positions(x, length);
                x.insert(0, T::zero());
                x.push(length);
                Self::Table { x, y: y.iter().map(of).collect() }
            }
            Form::Mismatched { breaks, values } => Self::Steps {
                breaks: number::positions(&breaks[..breaks.len().min(8)], length),
                values: values.iter().map(of).collect(),
            },
        }
    }
}

/// The library's own profile `$p` in `$call`, whatever the form.
macro_rules! with {
    ($self:ident, $p:ident => $call:expr, $number:ident => $constant:expr) => {
        match $self {
            Any::Number($number) => $constant,
            Any::Polynomial(c) => {
                let $p = Polynomial(c);
                $call
            }
            Any::Steps { breaks, values } => {
                let $p = Steps { breaks, values };
                $call
            }
            Any::Pieces { breaks, polynomials: [a, b] } => {
                let polynomials: [&[T]; 2] = [a, b];
                let $p = Pieces { breaks, polynomials: &polynomials };
                $call
            }
            Any::Table { x, y } => {
                let $p = Table { x, y };
                $call
            }
        }
    };
}

impl<T: Real> Profile<T> for Any<T> {
    type Piece = Cubic<T>;
    type Slot = Flat<T>;
    fn value(&self, x: T, mid: T) -> T {
        with!(self, p => p.value(x, mid), n => *n)
    }
    fn breaks(&self) -> &[T] {
        match self {
            Self::Number(_) | Self::Polynomial(_) => &[],
            Self::Steps { breaks, .. } | Self::Pieces { breaks, .. } => breaks,
            Self::Table { x, .. } => &x[1..x.len() - 1],
        }
    }
    fn validate(&self, field: &'static str, length: T) -> Result<(), Error> {
        with!(self, p => p.validate(field, length), _n => Ok(()))
    }
}

impl<T: Real> Smooth<T> for Any<T> {
    fn jet(&self, x: T, mid: T) -> [T; 3] {
        with!(self, p => p.jet(x, mid), n => [*n, T::zero(), T::zero()])
    }
}
