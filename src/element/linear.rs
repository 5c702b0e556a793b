//! Stretching and potential on one element: P1 nodes, exact inside.
//!
//! The fluxes sigma = EA u' - P q' and D = P u' + eps q' have given derivatives, so
//!
//! ```text
//!     (u', q')' = K^-1 (sigma, D)',   K = [[EA, -P], [P, eps]],   K^-1 = [[uu, uq], [-uq, qq]]
//!     uu = eps / det,  uq = P / det,  qq = EA / det,  det = EA eps + P^2 > 0
//! ```
//!
//! and integrals of K^-1 and of K^-1 times the load inside the element are all that nodes need. Where the
//! coefficients are constant on the element this is the P1 Galerkin solution of the paper's Problem 4;
//! where they vary, Galerkin takes the inverse of the mean of K instead of the mean of the inverse and
//! is off by O(h^2), while this stays exact at nodes.

use super::contact::{put, touching};
use super::hermite::Motion;
use super::{Element, POINTS, Span};
use crate::cubic::Side;
use crate::error::{Error, Place, expect};
use crate::law::truncate_positive;
use crate::profile::{Piece, Profile, Slot};
use crate::quadrature::gauss;
use crate::real::Real;
use crate::scene::Model;
use arrayvec::ArrayVec;

type PieceOf<T, P> = <P as Profile<T>>::Piece;
/// The roughest of the three coefficients' pieces.
type Joint<T, M> = <PieceOf<T, <M as Model<T>>::Axial> as Piece<T>>::Join<
    <PieceOf<T, <M as Model<T>>::Piezo> as Piece<T>>::Join<PieceOf<T, <M as Model<T>>::Permittivity>>,
>;
/// That piece, or nothing where the profile P is absent.
type Where<T, P, M> = <PieceOf<T, P> as Piece<T>>::Gate<Joint<T, M>>;

/// K^-1 on an element. What the scene lacks takes no room.
pub(crate) struct Flexibility<T: Real, M: Model<T>> {
    pub(crate) uu: Where<T, M::Axial, M>,
    pub(crate) uq: Where<T, M::Piezo, M>,
    pub(crate) qq: Where<T, M::Permittivity, M>,
}

impl<T: Real, M: Model<T>> Clone for Flexibility<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for Flexibility<T, M> {}

impl<T: Real, M: Model<T>> Default for Flexibility<T, M> {
    fn default() -> Self {
        Self { uu: Default::default(), uq: Default::default(), qq: Default::default() }
    }
}

/// uu, uq, qq as numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inverse<T> {
    pub(crate) uu: T,
    pub(crate) uq: T,
    pub(crate) qq: T,
}

/// K^-1 from its coefficients, by eliminating u: no product of EA and eps is formed, so that units as far
/// apart as a micro-beam's keep clear of under- and overflow.
pub(crate) fn invert<T: Real, M: Model<T>>(axial: T, piezo: T, permittivity: T) -> Inverse<T> {
    let zero = T::zero();
    if !M::Axial::PRESENT {
        let qq = if M::Permittivity::PRESENT { T::one() / permittivity } else { zero };
        return Inverse { uu: zero, uq: zero, qq };
    }
    if !M::Permittivity::PRESENT {
        return Inverse { uu: T::one() / axial, uq: zero, qq: zero };
    }
    let ratio = piezo / axial;
    let whole = permittivity + piezo * ratio;
    Inverse { uu: permittivity / whole / axial, uq: ratio / whole, qq: T::one() / whole }
}

/// Refuses a coupling that would be lost where only its part uq of K^-1, or P / eps, is below the normal numbers, and names
/// the coefficient that makes it so small.
#[inline(always)]
fn coupled<T: Real>(inverse: &Inverse<T>, [piezo, axial, permittivity]: [T; 3], mid: T) -> Result<(), Error> {
    let least = T::min_positive_value();
    let (by_axial, by_permittivity) = (piezo.abs() < least * axial, piezo.abs() < least * permittivity);
    let lost = inverse.uq.abs() < least || by_permittivity;
    if !lost || inverse.qq < least || (by_axial && by_permittivity) {
        return Ok(());
    }
    let (field, found) = if piezo.abs().recip() > axial.max(permittivity) {
        ("beam.piezo", piezo)
    } else if axial > permittivity {
        ("beam.axial", axial)
    } else {
        ("beam.permittivity", permittivity)
    };
    expect(
        false,
        field,
        Place::At(mid.f64()),
        "numbers for which P / (EA eps) and P / eps fit the number format",
        found,
    )
}

impl<T: Real, M: Model<T>> Flexibility<T, M> {
    /// May it be other than one number on an element?
    pub(crate) const VARIES: bool = !<Joint<T, M> as Piece<T>>::FLAT;

    pub(crate) fn sample(model: &M, span: &Span<T>) -> Result<Self, Error> {
        let beam = model.beam();
        let one = [T::one(); POINTS];
        let axial = if M::Axial::PRESENT { span.positive(beam.axial, "beam.axial")? } else { one };
        let permittivity = if M::Permittivity::PRESENT {
            span.positive(beam.permittivity, "beam.permittivity")?
        } else {
            one
        };
        let piezo =
            span.samples::<PieceOf<T, M::Piezo>>("beam.piezo", |x| beam.piezo.value(x, span.mid()))?;
        let mut points = [Inverse { uu: T::zero(), uq: T::zero(), qq: T::zero() }; POINTS];
        let coefficients = axial.into_iter().zip(piezo).zip(permittivity);
        for (point, ((axial, piezo), permittivity)) in points.iter_mut().zip(coefficients) {
            *point = invert::<T, M>(axial, piezo, permittivity);
            if M::Piezo::PRESENT {
                coupled(point, [piezo, axial, permittivity], span.mid())?;
            }
        }
        Ok(Self::from_points(points))
    }

    pub(crate) fn from_points(points: [Inverse<T>; POINTS]) -> Self {
        Self {
            uu: Piece::from_samples(points.map(|p| p.uu)),
            uq: Piece::from_samples(points.map(|p| p.uq)),
            qq: Piece::from_samples(points.map(|p| p.qq)),
        }
    }

    #[inline(always)]
    pub(crate) fn at(&self, t: T) -> Inverse<T> {
        Inverse { uu: self.uu.at(t), uq: self.uq.at(t), qq: self.qq.at(t) }
    }

    /// Integrals over [0, t] of what a current between there and the left node does to u and q.
    #[inline(always)]
    pub(crate) fn integral(&self, t: T) -> (T, T) {
        (self.uq.integral(t), self.qq.integral(t))
    }

    /// uq and qq, if they are the same on all of the element.
    #[inline(always)]
    fn constant(&self) -> Option<(T, T)> {
        self.uq.constant().zip(self.qq.constant())
    }

    /// Means over the element.
    #[inline(always)]
    pub(crate) fn mean(&self) -> Inverse<T> {
        Inverse { uu: self.uu.mean(), uq: self.uq.mean(), qq: self.qq.mean() }
    }
}

type AxialSlot<T, M> = <<M as Model<T>>::AxialLoad as Profile<T>>::Slot;

/// The axial load F(x) = integral of f_bar from the left node, as nodes feel it.
pub(crate) struct AxialLoad<T: Real, M: Model<T>> {
    /// F at the right node.
    total: AxialSlot<T, M>,
    /// Integrals over the element of uu F and uq F.
    stretch: AxialSlot<T, M>,
    charge: AxialSlot<T, M>,
}

impl<T: Real, M: Model<T>> Clone for AxialLoad<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for AxialLoad<T, M> {}

impl<T: Real, M: Model<T>> Default for AxialLoad<T, M> {
    fn default() -> Self {
        Self { total: Slot::of(T::zero()), stretch: Slot::of(T::zero()), charge: Slot::of(T::zero()) }
    }
}

impl<T: Real, M: Model<T>> AxialLoad<T, M> {
    pub(crate) fn sample(model: &M, span: &Span<T>, flexibility: &Flexibility<T, M>) -> Result<Self, Error> {
        if !M::AxialLoad::PRESENT {
            return Ok(Self::default());
        }
        let load = model.load();
        let f =
            span.samples::<PieceOf<T, M::AxialLoad>>("load.axial", |x| load.axial.value(x, span.mid()))?;
        let (mut total, mut stretch, mut charge) = (T::zero(), T::zero(), T::zero());
        for (f, (t, weight)) in f.iter().zip(gauss::<POINTS>()) {
            // integral over x of uu F = h^2 integral over t of f(t) integral_0^t uu
            let (t, part) = (T::of(t), span.h() * T::of(weight) * *f);
            total = total + part;
            // Neither product is far from what the sums are: the load times the length twice may be.
            stretch = stretch + part * (span.h() * flexibility.uu.integral(t));
            charge = charge + part * (span.h() * flexibility.uq.integral(t));
        }
        Ok(Self { total: Slot::of(total), stretch: Slot::of(stretch), charge: Slot::of(charge) })
    }

    pub(crate) fn merge<'a>(parts: impl Iterator<Item = &'a Element<T, M>>) -> Self
    where
        M: 'a,
    {
        let (mut total, mut stretch, mut charge) = (T::zero(), T::zero(), T::zero());
        for element in parts {
            let (mean, load) = (element.flexibility.mean(), element.axial);
            stretch = stretch + load.stretch.get() + total * (element.h * mean.uu);
            charge = charge + load.charge.get() + total * (element.h * mean.uq);
            total = total + load.total.get();
        }
        Self { total: Slot::of(total), stretch: Slot::of(stretch), charge: Slot::of(charge) }
    }

    #[inline(always)]
    pub(crate) fn get(&self) -> Source<T> {
        Source { total: self.total.get(), stretch: self.stretch.get(), charge: self.charge.get() }
    }
}

/// A load on the fluxes from the left node: its total, and the integrals of two flexibilities times it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Source<T> {
    pub(crate) total: T,
    /// Integral of (uu or uq) times the load so far: what it does to u.
    pub(crate) stretch: T,
    /// Integral of (uq or qq) times the load so far: what it does to q.
    pub(crate) charge: T,
}

/// The conduction current mu2 R~(eta)^2 of an element (3), integrated exactly at eta = 0 and eta = M.
#[inline]
pub(crate) fn current<T: Real, M: Model<T>>(
    model: &M,
    element: &Element<T, M>,
    motion: &Motion<T>,
) -> Source<T> {
    let zero = T::zero();
    let mut source = Source { total: zero, stretch: zero, charge: zero };
    if !element.conducts_into() {
        return source;
    }
    let most = model.conduction().truncation;
    let eta = motion.cubic();
    let side = eta.side(zero);
    if side == Side::Below {
        return source;
    }
    let k = element.flexibility.constant();
    if let (Side::Above, Some(mu2), Some((stretch, charge))) = (side, element.mu2.constant(), k)
        && eta.side(most) == Side::Below
    {
        // K^-1 stands before the integrals, which are of a polynomial that four points integrate. mu2 does not: the
        // square of a small penetration may be none where mu2 is as large.
        let (mut square, mut lever) = (zero, zero);
        for (t, weight) in gauss::<POINTS>() {
            let r = eta.at(T::of(t));
            let part = T::of(weight) * (mu2 * r * r);
            square = square + part;
            lever = lever + T::of(t) * part;
        }
        let (h, lever) = (element.h, element.h * lever);
        source.total = h * square;
        (source.stretch, source.charge) = (lever * (h * stretch), lever * (h * charge));
        return source;
    }
    let mut splits: ArrayVec<T, 6> = ArrayVec::new();
    put(&mut splits, eta.crossings(zero));
    put(&mut splits, eta.crossings(most));
    touching(&eta, &mut splits).for_each(|(t, weight)| {
        let r = truncate_positive(eta.at(t), most).0;
        let part = element.h * weight * (element.mu2.at(t) * r * r);
        source.total = source.total + part;
        let (stretch, charge) = element.flexibility.integral(t);
        source.stretch = source.stretch + part * (element.h * stretch);
        source.charge = source.charge + part * (element.h * charge);
    });
    source
}
