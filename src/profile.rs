//! Functions of x: constants, polynomials, steps, piecewise polynomials, tables and closures.
//!
//! A coefficient of the model is any [`Profile`]; what a scene lacks is `()`, which is zero, takes no
//! memory and compiles to nothing. Profiles may jump at their *breaks*, where the mesh sets nodes: inside
//! an element every profile is smooth. A point at a break belongs to two pieces; `mid`, a point of the
//! element that asks, says which is meant.
//!
//! Before a solve each profile is sampled once per element into its [`Piece`]: one number where it is
//! constant between breaks, else the cubic through its values at the four Gauss points, whose integral
//! over the element is exact to degree 7 and whose error inside is of the elements' own order h^4.

use crate::cubic::Cubic;
use crate::error::{Error, Place, expect};
use crate::quadrature::gauss;
use crate::real::Real;

/// A profile on one element, as a function of t: 0 at the right node, 1 at the left one.
pub trait Piece<T>: Copy + Default + PartialEq + core::fmt::Debug {
    /// Is it one number on any element?
    const FLAT: bool;

    /// From the values at the four Gauss points, in ascending t.
    fn from_samples(samples: [T; 4]) -> Self;
    /// Value at t.
    fn at(&self, t: T) -> T;
    /// Mean over the element.
    fn mean(&self) -> T;
    /// The value, where it is the same on the whole element.
    fn constant(&self) -> Option<T>;
    /// Integral over [0, t] with respect to t.
    fn integral(&self, t: T) -> T;

    /// The piece that can hold a function of this one and of a `P`: the rougher of the two.
    type Join<P: Piece<T>>: Piece<T>;
    /// The rougher of this piece and [`Flat`].
    type Flattened: Piece<T>;
    /// P, or nothing where this piece is nothing.
    type Gate<P: Piece<T>>: Piece<T>;
}

/// The piece of a profile that is constant between its breaks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flat<T>(pub T);

impl<T: Real> Piece<T> for () {
    const FLAT: bool = true;
    type Join<P: Piece<T>> = P;
    type Flattened = Flat<T>;
    type Gate<P: Piece<T>> = ();
    #[inline(always)]
    fn from_samples(_: [T; 4]) -> Self {}
    #[inline(always)]
    fn at(&self, _: T) -> T {
        T::zero()
    }
    #[inline(always)]
    fn mean(&self) -> T {
        T::zero()
    }
    #[inline(always)]
    fn constant(&self) -> Option<T> {
        Some(T::zero())
    }
    #[inline(always)]
    fn integral(&self, _: T) -> T {
        T::zero()
    }
}

impl<T: Real> Piece<T> for Flat<T> {
    const FLAT: bool = true;
    type Join<P: Piece<T>> = P::Flattened;
    type Flattened = Flat<T>;
    type Gate<P: Piece<T>> = P;
    #[inline(always)]
    fn from_samples(samples: [T; 4]) -> Self {
        Self(samples[0])
    }
    #[inline(always)]
    fn at(&self, _: T) -> T {
        self.0
    }
    #[inline(always)]
    fn mean(&self) -> T {
        self.0
    }
    #[inline(always)]
    fn constant(&self) -> Option<T> {
        Some(self.0)
    }
    #[inline(always)]
    fn integral(&self, t: T) -> T {
        self.0 * t
    }
}

impl<T: Real> Piece<T> for Cubic<T> {
    const FLAT: bool = false;
    type Join<P: Piece<T>> = Cubic<T>;
    type Flattened = Cubic<T>;
    type Gate<P: Piece<T>> = P;
    /// Newton's divided differences through the Gauss points, expanded in powers of t.
    fn from_samples(f: [T; 4]) -> Self {
        let [z0, z1, z2, z3] = gauss::<4>().map(|(z, _)| T::of(z));
        if f[1] == f[0] && f[2] == f[0] && f[3] == f[0] {
            return Self([f[0], T::zero(), T::zero(), T::zero()]);
        }
        let (a, b, c) = ((f[1] - f[0]) / (z1 - z0), (f[2] - f[1]) / (z2 - z1), (f[3] - f[2]) / (z3 - z2));
        let (d, e) = ((b - a) / (z2 - z0), (c - b) / (z3 - z1));
        let g = (e - d) / (z3 - z0);
        // f0 + a (t - z0) + d (t - z0)(t - z1) + g (t - z0)(t - z1)(t - z2)
        Self([
            f[0] - a * z0 + d * z0 * z1 - g * z0 * z1 * z2,
            a - d * (z0 + z1) + g * (z0 * z1 + z0 * z2 + z1 * z2),
            d - g * (z0 + z1 + z2),
            g,
        ])
    }
    #[inline(always)]
    fn at(&self, t: T) -> T {
        Self::at(self, t)
    }
    #[inline(always)]
    fn mean(&self) -> T {
        self.integral(T::one())
    }
    #[inline(always)]
    fn constant(&self) -> Option<T> {
        let [c0, c1, c2, c3] = self.0;
        (c1 == T::zero() && c2 == T::zero() && c3 == T::zero()).then_some(c0)
    }
    #[inline(always)]
    fn integral(&self, t: T) -> T {
        let [c0, c1, c2, c3] = self.0;
        t * (c0 + t * (T::of(0.5) * c1 + t * (T::of(1.0 / 3.0) * c2 + t * (T::of(0.25) * c3))))
    }
}

/// A function of x on [0, L].
pub trait Profile<T: Real> {
    /// Is there anything? Only `()` says no.
    const PRESENT: bool = true;
    /// What an element keeps of the profile.
    type Piece: Piece<T>;
    /// A number per node that belongs to this profile, or nothing where the profile is absent.
    type Slot: Slot<T>;

    /// Value at x \[m\], on the smooth piece that holds the point `mid`.
    fn value(&self, x: T, mid: T) -> T;

    /// Where the profile or its derivatives may jump, ascending \[m\].
    fn breaks(&self) -> &[T] {
        &[]
    }

    /// The profile's own shape: lengths of lists, order of breaks.
    ///
    /// # Errors
    /// The field, the place, what was expected and what was found.
    fn validate(&self, field: &'static str, length: T) -> Result<(), Error> {
        breaks_inside(self.breaks(), field, length)
    }
}

/// Room for one number at each node, or none.
pub trait Slot<T>: Copy + Default + PartialEq + core::fmt::Debug {
    /// Keeps x, if there is room.
    fn of(x: T) -> Self;
    /// The number kept, or zero.
    fn get(self) -> T;
    /// Room for an X that is of use only where the profile is there.
    type Room<X: Copy + Default>: Room<X>;
}

/// Room for an X, or none.
pub trait Room<X>: Copy + Default {
    /// The X kept, if there is room.
    fn look(&self) -> Option<&X>;
    /// The X kept, if there is room.
    fn open(&mut self) -> Option<&mut X>;
}

impl<X> Room<X> for () {
    #[inline(always)]
    fn look(&self) -> Option<&X> {
        None
    }
    #[inline(always)]
    fn open(&mut self) -> Option<&mut X> {
        None
    }
}

/// Room that is there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Kept<X>(X);

impl<X: Copy + Default> Room<X> for Kept<X> {
    #[inline(always)]
    fn look(&self) -> Option<&X> {
        Some(&self.0)
    }
    #[inline(always)]
    fn open(&mut self) -> Option<&mut X> {
        Some(&mut self.0)
    }
}

impl<T: Real> Slot<T> for () {
    type Room<X: Copy + Default> = ();
    #[inline(always)]
    fn of(_: T) -> Self {}
    #[inline(always)]
    fn get(self) -> T {
        T::zero()
    }
}

impl<T: Real> Slot<T> for Flat<T> {
    type Room<X: Copy + Default> = Kept<X>;
    #[inline(always)]
    fn of(x: T) -> Self {
        Self(x)
    }
    #[inline(always)]
    fn get(self) -> T {
        self.0
    }
}

/// A profile with two derivatives, as a gap needs: its slope sets the penetration's slope at nodes, its
/// curvature the relative unknowns.
pub trait Smooth<T: Real>: Profile<T> {
    /// Value, first and second derivative at x, on the smooth piece that holds `mid`.
    fn jet(&self, x: T, mid: T) -> [T; 3];
}

/// Breaks are finite, ascending and strictly inside (0, length).
fn breaks_inside<T: Real>(breaks: &[T], field: &'static str, length: T) -> Result<(), Error> {
    let mut last = T::zero();
    for (i, &b) in breaks.iter().enumerate() {
        let ok = b > last && b < length;
        expect(ok, field, Place::Index(i), "breaks that increase strictly inside (0, length)", b)?;
        last = b;
    }
    Ok(())
}

/// The number of the piece that holds `mid`.
fn piece_of<T: Real>(breaks: &[T], mid: T) -> usize {
    breaks.partition_point(|&b| b <= mid)
}

fn horner<T: Real>(c: &[T], x: T) -> T {
    c.iter().rev().fold(T::zero(), |sum, &c| sum * x + c)
}

fn horner_jet<T: Real>(c: &[T], x: T) -> [T; 3] {
    let [mut f, mut d, mut dd] = [T::zero(); 3];
    for &c in c.iter().rev() {
        dd = dd * x + d;
        d = d * x + f;
        f = f * x + c;
    }
    [f, d, dd + dd]
}

fn finite<T: Real>(values: &[T], field: &'static str) -> Result<(), Error> {
    for (i, &v) in values.iter().enumerate() {
        expect(v.is_finite(), field, Place::Index(i), "a finite number", v)?;
    }
    Ok(())
}

fn same_length(field: &'static str, what: &'static str, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found { Ok(()) } else { Err(Error::Length { field, what, expected, found }) }
}

/// Absent: zero everywhere, no memory, no instruction.
impl<T: Real> Profile<T> for () {
    const PRESENT: bool = false;
    type Piece = ();
    type Slot = ();
    #[inline(always)]
    fn value(&self, _: T, _: T) -> T {
        T::zero()
    }
}

impl<T: Real> Smooth<T> for () {
    #[inline(always)]
    fn jet(&self, _: T, _: T) -> [T; 3] {
        [T::zero(); 3]
    }
}

macro_rules! constant {
    ($t:ty) => {
        /// Constant.
        impl Profile<$t> for $t {
            type Piece = Flat<$t>;
            type Slot = Flat<$t>;
            #[inline(always)]
            fn value(&self, _: $t, _: $t) -> $t {
                *self
            }
        }
        impl Smooth<$t> for $t {
            #[inline(always)]
            fn jet(&self, _: $t, _: $t) -> [$t; 3] {
                [*self, 0.0, 0.0]
            }
        }
    };
}
constant!(f32);
constant!(f64);

/// c0 + c1 x + c2 x^2 + ...
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial<'a, T>(pub &'a [T]);

impl<T: Real> Profile<T> for Polynomial<'_, T> {
    type Piece = Cubic<T>;
    type Slot = Flat<T>;
    fn value(&self, x: T, _: T) -> T {
        horner(self.0, x)
    }
    fn validate(&self, field: &'static str, _: T) -> Result<(), Error> {
        finite(self.0, field)
    }
}

impl<T: Real> Smooth<T> for Polynomial<'_, T> {
    fn jet(&self, x: T, _: T) -> [T; 3] {
        horner_jet(self.0, x)
    }
}

/// `values[i]` between `breaks[i - 1]` and `breaks[i]`: one value more than breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps<'a, T> {
    /// Where the value changes \[m\].
    pub breaks: &'a [T],
    /// The values.
    pub values: &'a [T],
}

impl<T: Real> Profile<T> for Steps<'_, T> {
    type Piece = Flat<T>;
    type Slot = Flat<T>;
    fn value(&self, _: T, mid: T) -> T {
        self.values.get(piece_of(self.breaks, mid)).copied().unwrap_or(T::nan())
    }
    fn breaks(&self) -> &[T] {
        self.breaks
    }
    fn validate(&self, field: &'static str, length: T) -> Result<(), Error> {
        breaks_inside(self.breaks, field, length)?;
        same_length(field, "one value more than breaks", self.breaks.len() + 1, self.values.len())?;
        finite(self.values, field)
    }
}

impl<T: Real> Smooth<T> for Steps<'_, T> {
    fn jet(&self, x: T, mid: T) -> [T; 3] {
        [self.value(x, mid), T::zero(), T::zero()]
    }
}

/// `polynomials[i]`, in powers of x, between `breaks[i - 1]` and `breaks[i]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pieces<'a, T> {
    /// Where the polynomial changes \[m\].
    pub breaks: &'a [T],
    /// Coefficients of 1, x, x^2, ... of each piece.
    pub polynomials: &'a [&'a [T]],
}

impl<T: Real> Profile<T> for Pieces<'_, T> {
    type Piece = Cubic<T>;
    type Slot = Flat<T>;
    fn value(&self, x: T, mid: T) -> T {
        self.polynomials.get(piece_of(self.breaks, mid)).map_or(T::nan(), |c| horner(c, x))
    }
    fn breaks(&self) -> &[T] {
        self.breaks
    }
    fn validate(&self, field: &'static str, length: T) -> Result<(), Error> {
        breaks_inside(self.breaks, field, length)?;
        let pieces = self.breaks.len() + 1;
        same_length(field, "one polynomial more than breaks", pieces, self.polynomials.len())?;
        self.polynomials.iter().try_for_each(|c| finite(c, field))
    }
}

impl<T: Real> Smooth<T> for Pieces<'_, T> {
    fn jet(&self, x: T, mid: T) -> [T; 3] {
        self.polynomials.get(piece_of(self.breaks, mid)).map_or([T::nan(); 3], |c| horner_jet(c, x))
    }
}

/// Linear between the points `(x[i], y[i])`, which cover the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table<'a, T> {
    /// Abscissae, ascending; the first at most 0, the last at least the length \[m\].
    pub x: &'a [T],
    /// Values at the abscissae.
    pub y: &'a [T],
}

impl<T: Real> Table<'_, T> {
    /// Value and slope on the line that holds `mid`.
    fn line(&self, x: T, mid: T) -> [T; 2] {
        let upper = piece_of(self.x, mid).clamp(1, self.x.len().max(2) - 1);
        match (self.x.get(upper - 1..=upper), self.y.get(upper - 1..=upper)) {
            (Some(&[x0, x1]), Some(&[y0, y1])) => {
                let (run, rise) = (x1 - x0, y1 - y0);
                // From the nearer end, so that the table's own values come out exactly; by the share of the way, as a
                // slope may be below the number format where the values are not.
                let near = if x - x0 < x1 - x { (x0, y0) } else { (x1, y1) };
                [near.1 + (x - near.0) / run * rise, rise / run]
            }
            _ => [T::nan(); 2],
        }
    }
}

impl<T: Real> Profile<T> for Table<'_, T> {
    type Piece = Cubic<T>;
    type Slot = Flat<T>;
    fn value(&self, x: T, mid: T) -> T {
        self.line(x, mid)[0]
    }
    fn breaks(&self) -> &[T] {
        self.x.get(1..self.x.len().max(2) - 1).unwrap_or(&[])
    }
    fn validate(&self, field: &'static str, length: T) -> Result<(), Error> {
        same_length(field, "as many y as x", self.x.len(), self.y.len())?;
        if self.x.len() < 2 {
            let found = self.x.len();
            return Err(Error::Length { field, what: "a table of two points at least", expected: 2, found });
        }
        finite(self.x, field)?;
        finite(self.y, field)?;
        let last = self.x.len() - 1;
        expect(self.x[0] <= T::zero(), field, Place::Index(0), "a table that starts at 0", self.x[0])?;
        expect(
            self.x[last] >= length,
            field,
            Place::Index(last),
            "a table that reaches the beam's length",
            self.x[last],
        )?;
        for i in 1..=last {
            let ok = self.x[i] > self.x[i - 1];
            expect(ok, field, Place::Index(i), "abscissae that increase", self.x[i])?;
        }
        Ok(())
    }
}

impl<T: Real> Smooth<T> for Table<'_, T> {
    fn jet(&self, x: T, mid: T) -> [T; 3] {
        let [value, slope] = self.line(x, mid);
        [value, slope, T::zero()]
    }
}

/// A closure x -> value, smooth on [0, L].
#[derive(Clone, Copy, Debug)]
pub struct Function<F>(pub F);

impl<T: Real, F: Fn(T) -> T> Profile<T> for Function<F> {
    type Piece = Cubic<T>;
    type Slot = Flat<T>;
    fn value(&self, x: T, _: T) -> T {
        (self.0)(x)
    }
}

/// A closure x -> [value, first derivative, second derivative], smooth on [0, L]: a gap.
#[derive(Clone, Copy, Debug)]
pub struct Curve<F>(pub F);

impl<T: Real, F: Fn(T) -> [T; 3]> Profile<T> for Curve<F> {
    type Piece = Cubic<T>;
    type Slot = Flat<T>;
    fn value(&self, x: T, _: T) -> T {
        (self.0)(x)[0]
    }
}

impl<T: Real, F: Fn(T) -> [T; 3]> Smooth<T> for Curve<F> {
    fn jet(&self, x: T, _: T) -> [T; 3] {
        (self.0)(x)
    }
}

impl<T: Real, P: Profile<T>> Profile<T> for &P {
    const PRESENT: bool = P::PRESENT;
    type Piece = P::Piece;
    type Slot = P::Slot;
    #[inline(always)]
    fn value(&self, x: T, mid: T) -> T {
        P::value(self, x, mid)
    }
    fn breaks(&self) -> &[T] {
        P::breaks(self)
    }
    fn validate(&self, field: &'static str, length: T) -> Result<(), Error> {
        P::validate(self, field, length)
    }
}

impl<T: Real, P: Smooth<T>> Smooth<T> for &P {
    #[inline(always)]
    fn jet(&self, x: T, mid: T) -> [T; 3] {
        P::jet(self, x, mid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cubic_of_an_element_takes_the_values_at_its_gauss_points() {
        let f = |t: f64| 3.0 - 2.0 * t + 0.5 * t * t - 7.0 * t * t * t;
        let piece = Cubic::from_samples(gauss::<4>().map(|(z, _)| f(z)));
        for t in [0.0, 0.1, 0.5, 0.9, 1.0] {
            assert!((piece.at(t) - f(t)).abs() < 1e-14);
        }
        assert!((piece.mean() - (3.0 - 1.0 + 0.5 / 3.0 - 7.0 / 4.0)).abs() < 1e-14);
        assert_eq!(Cubic::from_samples([2.0_f64; 4]).constant(), Some(2.0));
        // One sample that is another is no constant.
        for odd in 0..4 {
            let mut samples = [2.0_f64; 4];
            samples[odd] = 3.0;
            let piece = Cubic::from_samples(samples);
            let off = gauss::<4>().into_iter().zip(samples).map(|((z, _), f)| (piece.at(z) - f).abs());
            assert!(off.fold(0.0, f64::max) < 1e-13, "{samples:?}: {piece:?}");
        }
        for power in 1..4 {
            let mut cubic = Cubic([2.0, 0.0, 0.0, 0.0]);
            cubic.0[power] = 1.0;
            assert_eq!(cubic.constant(), None);
        }
    }

    #[test]
    fn room_is_there_for_what_is_there() {
        assert_eq!((Room::<f64>::look(&()), Room::<f64>::open(&mut ())), (None, None));
        let mut kept = Kept(1.0);
        if let Some(number) = kept.open() {
            *number = 2.0;
        }
        assert_eq!(kept.look(), Some(&2.0));
    }

    #[test]
    fn the_middle_decides_which_piece_a_break_belongs_to() {
        let steps = Steps { breaks: &[0.5], values: &[1.0, 2.0] };
        assert_eq!(steps.value(0.5, 0.4), 1.0);
        assert_eq!(steps.value(0.5, 0.6), 2.0);
        let table = Table { x: &[0.0, 0.4, 1.0], y: &[1.0, 3.0, 0.0] };
        assert_eq!(table.jet(0.4, 0.2), [3.0, 5.0, 0.0]);
        assert_eq!(table.jet(0.4, 0.7), [3.0, -5.0, 0.0]);
        assert_eq!(table.breaks(), [0.4]);
    }

    #[test]
    fn a_table_whose_slope_is_below_the_number_format_is_no_step() {
        let table = Table { x: &[0.0, 1e122], y: &[0.0, 3e-304] };
        assert_eq!((table.value(2.5e121, 1.0), table.value(7.5e121, 1.0)), (0.75e-304, 2.25e-304));
    }

    #[test]
    fn jets_are_derivatives() {
        let p = Polynomial(&[1.0, -2.0, 3.0, 4.0]);
        assert_eq!(p.jet(2.0, 2.0), [1.0 - 4.0 + 12.0 + 32.0, -2.0 + 12.0 + 48.0, 6.0 + 48.0]);
    }

    #[test]
    fn wrong_shapes_name_field_place_and_found() {
        let text =
            |e: Result<(), Error>| e.map_or_else(|e| std::format!("{e}"), |()| std::string::String::new());
        let steps = Steps { breaks: &[0.5, 0.4], values: &[1.0, 2.0, 3.0] };
        assert_eq!(
            text(steps.validate("load.transverse", 1.0)),
            "load.transverse[1]: expected breaks that increase strictly inside (0, length), found 0.4"
        );
        let steps = Steps { breaks: &[0.5], values: &[1.0] };
        assert_eq!(
            text(steps.validate("load.transverse", 1.0)),
            "load.transverse: one value more than breaks: expected 2, found 1"
        );
        let table = Table { x: &[0.0, 0.5], y: &[0.0, f64::NAN] };
        assert_eq!(
            text(table.validate("foundation.gap", 1.0)),
            "foundation.gap[1]: expected a finite number, found NaN"
        );
        let table = Table { x: &[0.0, 0.5], y: &[0.0, 0.0] };
        assert_eq!(
            text(table.validate("foundation.gap", 1.0)),
            "foundation.gap[1]: expected a table that reaches the beam's length, found 0.5"
        );
        let table = Table { x: &[0.0], y: &[0.0] };
        assert!(text(table.validate("foundation.gap", 1.0)).contains("two points"));
    }
}
