//! One element: what it keeps of the scene, and how elements are merged into coarser ones.
//!
//! Inside an element everything is a function of t, which runs from 0 at the right node to 1 at the left
//! one: x = x_right - h t. No matrix is stored: an element keeps samples of its coefficients, and its
//! matrices are formed when the sweep passes.

pub(crate) mod contact;
pub(crate) mod coupled;
pub(crate) mod hermite;
pub(crate) mod linear;

use crate::cubic::Cubic;
use crate::error::{Error, Place, expect};
use crate::law::Compliance;
use crate::profile::{Piece, Profile, Slot, Smooth};
use crate::quadrature::{POINTS, gauss};
use crate::real::{Pair, Real, Sum};
use crate::scene::{Model, points_at};
use crate::sweep::pair::Symmetric;
use hermite::Motion;
use linear::{AxialLoad, Flexibility};

type SlotOf<T, P> = <P as Profile<T>>::Slot;

/// What an element keeps of the gap: how far it is from rigid, as the relative unknowns measure it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct GapBend<S> {
    /// s_left - T s_right, in value ...
    w: S,
    /// ... and slope, from integrals of s'', not from differences of s.
    theta: S,
    /// Jump of s' at the left node, from left to right.
    kink: S,
}

impl<S> GapBend<S> {
    /// s_left - T s_right
    #[inline(always)]
    pub(crate) fn bend<T: Real>(&self) -> T::Vec2
    where
        S: Slot<T>,
    {
        T::Vec2::of(self.w.get(), self.theta.get())
    }

    /// Jump of the penetration's slope at the left node, seen from right to left.
    #[inline(always)]
    pub(crate) fn kink<T: Real>(&self) -> T::Vec2
    where
        S: Slot<T>,
    {
        T::Vec2::of(T::zero(), self.kink.get())
    }
}

/// An element and its samples of the scene.
pub(crate) struct Element<T: Real, M: Model<T>> {
    /// x of the right node \[m\].
    pub(crate) right: T,
    /// Length \[m\].
    pub(crate) h: T,
    /// Bending energy 1/2 e'K e of the relative unknowns e of xi.
    pub(crate) bending: Symmetric<T>,
    /// Loads on e and on the rigid motion with the right node.
    pub(crate) fe: T::Vec2,
    pub(crate) fr: T::Vec2,
    pub(crate) gap: GapBend<SlotOf<T, M::Gap>>,
    pub(crate) law: <M::Law as Compliance<T>>::Piece,
    pub(crate) mu1: <M::Mu1 as Profile<T>>::Piece,
    pub(crate) mu2: <M::Mu2 as Profile<T>>::Piece,
    pub(crate) flexibility: Flexibility<T, M>,
    pub(crate) axial: AxialLoad<T, M>,
    /// A break or a concentrated load stands at the right node.
    pub(crate) stop: bool,
    /// How many finer elements this one stands for.
    pub(crate) children: u8,
}

impl<T: Real, M: Model<T>> Clone for Element<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for Element<T, M> {}

impl<T: Real, M: Model<T>> AsRef<Self> for Element<T, M> {
    #[inline(always)]
    fn as_ref(&self) -> &Self {
        self
    }
}

impl<T: Real, M: Model<T>> Element<T, M> {
    /// An element that stands for nothing yet: workspaces are made of these.
    pub(crate) fn blank() -> Self {
        Self {
            right: T::zero(),
            h: T::one(),
            bending: Symmetric::default(),
            fe: T::Vec2::default(),
            fr: T::Vec2::default(),
            gap: GapBend::default(),
            law: Default::default(),
            mu1: Default::default(),
            mu2: Default::default(),
            flexibility: Flexibility::default(),
            axial: AxialLoad::default(),
            stop: false,
            children: 0,
        }
    }

    /// Is each coefficient one number on any element? Then parts that are merged, between breaks, have the same.
    const FLAT: bool = <<M::Law as Compliance<T>>::Piece as Piece<T>>::FLAT
        && <<M::Mu1 as Profile<T>>::Piece as Piece<T>>::FLAT
        && <<M::Mu2 as Profile<T>>::Piece as Piece<T>>::FLAT
        && !Flexibility::<T, M>::VARIES;

    /// Samples the scene on [left, right].
    pub(crate) fn sample(model: &M, left: T, right: T, stop: bool) -> Result<Self, Error> {
        let mut element = Self::blank();
        element.lay(model, left, right, stop).map(|()| element)
    }

    /// The same in place: an element in a result would be copied more than it is worked on.
    pub(crate) fn lay(&mut self, model: &M, left: T, right: T, stop: bool) -> Result<(), Error> {
        let h = right - left;
        let mid = left + T::of(0.5) * h;
        let span = Span { right, h, mid };
        let (beam, foundation) = (model.beam(), model.foundation());
        let (conduction, load) = (model.conduction(), model.load());

        // Forces of a foundation on an element have its square and cube in them: without digits there, none is left in what
        // balances, and no balance shows it.
        let what = "elements long enough for the cube of their length to be a normal number";
        expect(h * h * h >= T::min_positive_value(), "length", Place::At(mid.f64()), what, h)?;
        let stiffness = span.positive(beam.bending, "beam.bending")?;
        let bending = hermite::bending(h, stiffness);
        // An element's stiffness is 12 C / h^3, which has to be a number.
        let fits = bending.xx.is_finite() && bending.xx > T::zero();
        let what = "a stiffness C for which C / h^3 fits the number format";
        expect(fits, "beam.bending", Place::At(mid.f64()), what, stiffness[0])?;
        let transverse = span.samples::<<M::Transverse as Profile<T>>::Piece>("load.transverse", |x| {
            load.transverse.value(x, mid)
        })?;
        let (fe, mut fr) = hermite::loads(h, transverse);
        // Loads at one place may cancel: their sum first, and with what is rounded off.
        let (mut force, mut moment) = (Sum::<T>::default(), Sum::<T>::default());
        for point in points_at(model, left, right) {
            force.add(point.force);
            moment.add(point.moment);
        }
        fr += T::Vec2::of(force.value(), moment.value());
        let law = span.not_negative("foundation.stiffness", |x| foundation.law.coefficient(x, mid))?;
        let mu1 = span.not_negative("conduction.mu1", |x| conduction.mu1.value(x, mid))?;
        let mu2 = span.not_negative("conduction.mu2", |x| conduction.mu2.value(x, mid))?;
        let gap = if M::Gap::PRESENT {
            span.gap_bend::<M>(foundation.gap, model.length())?
        } else {
            GapBend::default()
        };
        let flexibility = Flexibility::sample(model, &span)?;
        let axial = AxialLoad::sample(model, &span, &flexibility)?;
        *self = Self { right, h, bending, fe, fr, gap, law, mu1, mu2, flexibility, axial, stop, children: 1 };
        Ok(())
    }

    /// The bending stiffness, its mean in the last entry of the bending energy, 4 C / h \[N m^2\].
    pub(crate) fn stiffness(&self) -> T {
        self.bending.yy * self.h * T::of(0.25)
    }

    /// C / h^4, the stiffness of a foundation that gives way like this element \[N/m^2\].
    pub(crate) fn own(&self) -> T {
        // 4 C / h is the last entry of the bending energy.
        T::of(0.25) * self.bending.yy / self.h / self.h / self.h
    }

    /// The stiffness of a foundation that is rigid to this element \[N/m^2\].
    pub(crate) fn rigid(&self) -> T {
        self.own() * T::of(RIGID).min(T::of(1e-3) / T::epsilon())
    }

    /// Takes the law's coefficient for one that is at most as stiff as `most`.
    pub(crate) fn soften(&mut self, law: &M::Law, most: T) {
        let samples = gauss::<POINTS>().map(|(t, _)| law.at_most(self.law.at(T::of(t)), most));
        self.law = Piece::from_samples(samples);
    }

    /// Takes back what [`Element::soften`] did.
    pub(crate) fn harden(&mut self, law: &M::Law) {
        let mid = self.x(T::of(0.5));
        self.law =
            Piece::from_samples(gauss::<POINTS>().map(|(t, _)| law.coefficient(self.x(T::of(t)), mid)));
    }

    /// Force and moment at the left end by the deformation e of the penetration, less the element's load.
    #[inline(always)]
    pub(crate) fn deforming_force(&self, e: T::Vec2) -> T::Vec2 {
        // The gap's bend is added to e before anything is multiplied: their sum, xi's own, is what bends.
        let bend = if M::Gap::PRESENT { e + self.gap.bend::<T>() } else { e };
        self.bending.times(bend) - self.fe
    }

    /// The larger one of the moments at both ends, without the contact's part inside the element.
    #[inline(always)]
    pub(crate) fn largest_moment(&self, e: T::Vec2) -> T {
        self.moments(self.deforming_force(e))
    }

    /// The larger one of the moments at both ends by force and moment at the left one.
    #[inline(always)]
    pub(crate) fn moments(&self, force: T::Vec2) -> T {
        let (left, right) = (force.y().abs(), (force.y() - self.h * force.x()).abs());
        if left > right { left } else { right }
    }

    /// Has `other` the same nodes?
    pub(crate) fn covers(&self, other: &Self) -> bool {
        self.right == other.right && self.h == other.h && self.stop == other.stop
    }

    /// Makes `other`, with the same nodes, the same equations of bending wherever the beam is?
    pub(crate) fn bends_like(&self, other: &Self) -> bool {
        self.bending == other.bending
            && self.fe == other.fe
            && self.fr == other.fr
            && self.gap == other.gap
            && self.law == other.law
            && self.mu1 == other.mu1
    }

    /// x at t \[m\].
    #[inline(always)]
    pub(crate) fn x(&self, t: T) -> T {
        self.right - self.h * t
    }

    /// The element that covers `parts`, adjacent and from left to right: energies and loads of its cubic
    /// are exactly those of the parts (Galerkin), coefficients are sampled from theirs.
    pub(crate) fn merge<P: AsRef<Self>>(parts: &[P]) -> Self {
        let mut whole = Self::blank();
        let (Some(first), Some(last)) = (parts.first(), parts.last()) else { return whole };
        let (first, last, count) = (first.as_ref(), last.as_ref(), parts.len());
        let parts = || parts.iter().map(AsRef::as_ref);
        let h = parts().fold(T::zero(), |sum, part| sum + part.h);
        whole.right = last.right;
        whole.h = h;
        whole.stop = last.stop;
        whole.children = u8::try_from(count).unwrap_or(u8::MAX);

        // Which part holds t, and where in it.
        let locate = |t: T| {
            let mut far = T::one();
            for part in parts() {
                let near = far - part.h / h;
                if t >= near {
                    return (part, ((t - near) * (h / part.h)).min(T::one()));
                }
                far = near;
            }
            (last, t * (h / last.h))
        };
        let spots =
            gauss::<POINTS>().map(|(t, _)| if Self::FLAT { (last, T::zero()) } else { locate(T::of(t)) });
        whole.law = Piece::from_samples(spots.map(|(part, t)| part.law.at(t)));
        whole.mu1 = Piece::from_samples(spots.map(|(part, t)| part.mu1.at(t)));
        whole.mu2 = Piece::from_samples(spots.map(|(part, t)| part.mu2.at(t)));
        whole.flexibility = Flexibility::from_points(spots.map(|(part, t)| part.flexibility.at(t)));
        whole.axial = AxialLoad::merge(parts());

        let (zero, one) = (T::zero(), T::one());
        let mut gap_force = T::Vec2::default();
        let mut right = T::one();
        for part in parts() {
            right = (right - part.h / h).max(zero);
            // Motion of the part for e = (1, 0) and (0, 1); with the whole's right node it moves rigidly.
            let motion = |e: T::Vec2| Motion::new(h, e, T::Vec2::default()).part(right, part.h / h);
            let (e1, e2) = (motion(T::Vec2::of(one, zero)), motion(T::Vec2::of(zero, one)));
            let k = &part.bending;
            let (k1, k2) = (k.times(e1.e), k.times(e2.e));
            whole.bending = whole.bending + Symmetric::of(e1.e.times(k1), e2.e.times(k1), e2.e.times(k2));
            let work = |m: &Motion<T>| m.e.times(part.fe) + m.d.times(part.fr);
            whole.fe += T::Vec2::of(work(&e1), work(&e2));
            whole.fr += T::Vec2::of(part.fr.x(), part.fr.y() - h * right * part.fr.x());
            if M::Gap::PRESENT {
                let pull = k.times(part.gap.bend::<T>());
                gap_force += T::Vec2::of(e1.e.times(pull), e2.e.times(pull));
            }
        }
        if M::Gap::PRESENT {
            // A stiffness is a number, and positive definite; its determinant may be beyond the number format.
            let bend = whole.bending.inverse().map_or(T::Vec2::default(), |k| k.times(gap_force));
            whole.gap = GapBend { w: Slot::of(bend.x()), theta: Slot::of(bend.y()), kink: first.gap.kink };
        }
        whole
    }
}

/// k h^4 / C of a foundation that is rigid to an element: it gives way by 1e-7 of what the element would bend
/// under the same pressure, far less than the error of its cubic. (With less than double precision, as much as
/// rounding lets it.)
const RIGID: f64 = 1e7;

/// Where an element samples.
pub(crate) struct Span<T> {
    right: T,
    h: T,
    mid: T,
}

impl<T: Real> Span<T> {
    /// Where a profile with such pieces is looked at: at the Gauss points in ascending t, or, where it is one number, once.
    fn points<P: Piece<T>>(&self) -> impl Iterator<Item = T> + use<T, P> {
        let (right, h, mid) = (self.right, self.h, self.mid);
        let x = move |(t, _)| if P::FLAT { mid } else { right - h * T::of(t) };
        gauss::<POINTS>().into_iter().take(if P::FLAT { 1 } else { POINTS }).map(x)
    }

    /// Values at the Gauss points in ascending t; each has to be finite.
    #[inline(always)]
    pub(crate) fn samples<P: Piece<T>>(
        &self,
        field: &'static str,
        f: impl Fn(T) -> T,
    ) -> Result<[T; POINTS], Error> {
        let mut values = [T::zero(); POINTS];
        for (value, x) in values.iter_mut().zip(self.points::<P>()) {
            *value = f(x);
            expect(value.is_finite(), field, Place::At(x.f64()), "a finite number", *value)?;
        }
        Ok(if P::FLAT { [values[0]; POINTS] } else { values })
    }

    /// Both nodes, at which fields are asked for too.
    fn ends(&self) -> [T; 2] {
        [(self.right - self.h).max(T::zero()), self.right]
    }

    /// As [`Span::samples`], of a coefficient that has to be positive, and far enough from zero to be divided by.
    pub(crate) fn positive<P: Profile<T>>(
        &self,
        profile: &P,
        field: &'static str,
    ) -> Result<[T; POINTS], Error> {
        let values = self.samples::<P::Piece>(field, |x| profile.value(x, self.mid))?;
        let least = T::max_value().recip();
        let positive = |x: T, value: T| {
            if value > least && value.is_finite() {
                return Ok(());
            }
            let faint = value > T::zero() && value <= least;
            let what = if faint { "a number > 0 whose reciprocal is finite" } else { "a number > 0" };
            expect(false, field, Place::At(x.f64()), what, value)
        };
        for (value, x) in values.iter().zip(self.points::<P::Piece>()) {
            positive(x, *value)?;
        }
        if !P::Piece::FLAT {
            for x in self.ends() {
                positive(x, profile.value(x, self.mid))?;
            }
        }
        Ok(values)
    }

    /// The piece of a coefficient that must not be negative; at nodes, where many a one ends with zero, but for
    /// rounding.
    #[inline(always)]
    fn not_negative<P: Piece<T>>(&self, field: &'static str, f: impl Fn(T) -> T) -> Result<P, Error> {
        let values = self.samples::<P>(field, &f)?;
        for (value, x) in values.iter().zip(self.points::<P>()) {
            expect(*value >= T::zero(), field, Place::At(x.f64()), "a number >= 0", *value)?;
        }
        if !P::FLAT {
            let most = values.iter().fold(T::zero(), |most, value| most.max(*value));
            for x in self.ends() {
                let value = f(x);
                let ok = value >= T::of(-64.0) * T::epsilon() * most && value.is_finite();
                expect(ok, field, Place::At(x.f64()), "a number >= 0", value)?;
            }
        }
        Ok(P::from_samples(values))
    }

    pub(crate) fn mid(&self) -> T {
        self.mid
    }

    pub(crate) fn h(&self) -> T {
        self.h
    }

    /// The gap's departure from rigid, by integrals of its curvature:
    /// s_left - (s_right - h s'_right) = h^2 integral of (1 - t) s'' dt, s'_left - s'_right = -h integral
    /// of s'' dt. Differences of s itself would lose its curvature to rounding on short elements.
    fn gap_bend<M: Model<T>>(&self, gap: &M::Gap, length: T) -> Result<GapBend<SlotOf<T, M::Gap>>, Error> {
        let field = "foundation.gap";
        let curvature = self.samples::<Cubic<T>>(field, |x| gap.jet(x, self.mid)[2])?;
        let (mut w, mut theta) = (T::zero(), T::zero());
        for (value, (t, weight)) in curvature.iter().zip(gauss::<POINTS>()) {
            let part = *value * T::of(weight);
            theta = theta - part;
            w = w + part * T::of(1.0 - t);
        }
        let left = self.right - self.h;
        for x in self.ends() {
            for number in gap.jet(x, self.mid) {
                expect(number.is_finite(), field, Place::At(x.f64()), "a finite number", number)?;
            }
        }
        let tiny = T::of(16.0) * T::epsilon() * length;
        let breaks = gap.breaks();
        let near = breaks.partition_point(|&b| b < left - tiny);
        let kink = match breaks.get(near) {
            Some(&b) if (b - left).abs() <= tiny => {
                let before = if near == 0 { T::zero() } else { breaks[near - 1] };
                let mid = T::of(0.5) * (before + b);
                gap.jet(b, self.mid)[1] - gap.jet(b, mid)[1]
            }
            _ => T::zero(),
        };
        Ok(GapBend {
            w: Slot::of(self.h * self.h * w),
            theta: Slot::of(self.h * theta),
            kink: Slot::of(kink),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
    use super::*;
    use crate::{
        Beam, Conduction, Curve, Foundation, Function, Linear, Load, PointLoad, Polynomial, Scene, Steps,
    };
    use glam::DVec2;
    use proptest::prelude::*;
    use std::vec::Vec;

    const CUBIC: Polynomial<'static, f64> = Polynomial(&[3.0, 1.0, -0.8, 0.25]);
    const LINE: Polynomial<'static, f64> = Polynomial(&[2.0, -0.5]);

    /// Ends of elements in (0.2, 1.2), from the shares of [0, 1] that they take.
    fn nodes(shares: &[f64]) -> Vec<f64> {
        let total: f64 = shares.iter().sum();
        let mut nodes = std::vec![0.2];
        let mut sum = 0.0;
        for share in shares {
            sum += share;
            nodes.push(0.2 + sum / total);
        }
        nodes
    }

    /// One element on all of `nodes`, and the merge of those between them.
    fn both<M: Model<f64>>(model: &M, nodes: &[f64]) -> [Element<f64, M>; 2] {
        let sample = |left, right| Element::sample(model, left, right, true).unwrap();
        let parts: Vec<_> = nodes.windows(2).map(|pair| sample(pair[0], pair[1])).collect();
        [sample(nodes[0], nodes[nodes.len() - 1]), Element::merge(&parts)]
    }

    fn same(got: f64, want: f64, size: f64) -> bool {
        (got - want).abs() <= 1e-12 * size
    }

    fn same_pairs(got: DVec2, want: DVec2) -> bool {
        let size = want.x.abs().max(want.y.abs());
        same(got.x, want.x, size) && same(got.y, want.y, size)
    }

    fn same_energies(got: &Symmetric<f64>, want: &Symmetric<f64>) -> bool {
        let size = want.xx.abs().max(want.yy.abs());
        same(got.xx, want.xx, size) && same(got.xy, want.xy, size) && same(got.yy, want.yy, size)
    }

    fn shares() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(0.02..1.0_f64, 1..=4)
    }

    proptest! {
        #[test]
        fn constants_merge_to_what_the_whole_samples(shares in shares()) {
            let scene = Scene::new(2.0, Beam { bending: 3.0, axial: 5.0, piezo: 0.7, permittivity: 0.2 })
                .foundation(Foundation { law: Linear(11.0), gap: Polynomial(&[0.1, -0.2, 0.3, 0.4]) })
                .conduction(Conduction::new(13.0, 17.0, 1.0))
                .load(Load { transverse: 19.0, axial: 23.0, points: () });
            let [whole, merged] = both(&scene, &nodes(&shares));
            prop_assert!(same(merged.h, whole.h, 1.0) && merged.right == whole.right && merged.stop);
            prop_assert_eq!(usize::from(merged.children), shares.len());
            prop_assert!(same_energies(&merged.bending, &whole.bending));
            prop_assert!(same_pairs(merged.fe, whole.fe) && same_pairs(merged.fr, whole.fr));
            prop_assert!(same_pairs(merged.gap.bend::<f64>(), whole.gap.bend::<f64>()));
            prop_assert_eq!(merged.law, whole.law);
            prop_assert_eq!(merged.mu1, whole.mu1);
            prop_assert_eq!(merged.mu2, whole.mu2);
            let (got, want) = (merged.flexibility.mean(), whole.flexibility.mean());
            prop_assert_eq!((got.uu, got.uq, got.qq), (want.uu, want.uq, want.qq));
            let (got, want) = (merged.axial.get(), whole.axial.get());
            prop_assert!(same(got.total, want.total, 23.0));
            prop_assert!(same(got.stretch, want.stretch, want.stretch));
            prop_assert!(same(got.charge, want.charge, want.charge));
        }

        #[test]
        fn cubic_coefficients_merge_to_what_the_whole_samples(shares in shares()) {
            let scene = Scene::new(2.0, Beam::elastic(CUBIC))
                .foundation(Foundation { law: Linear(CUBIC), gap: Polynomial(&[0.1, -0.2, 0.3, 0.4]) })
                .conduction(Conduction::new(CUBIC, LINE, 1.0))
                .load(Load { transverse: CUBIC, axial: (), points: () });
            let [whole, merged] = both(&scene, &nodes(&shares));
            prop_assert!(same_energies(&merged.bending, &whole.bending));
            prop_assert!(same_pairs(merged.fe, whole.fe) && same_pairs(merged.fr, whole.fr));
            prop_assert!(same_pairs(merged.gap.bend::<f64>(), whole.gap.bend::<f64>()));
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                prop_assert!(same(merged.law.at(t), CUBIC.value(whole.x(t), 1.0), 10.0));
                prop_assert!(same(merged.mu1.at(t), whole.mu1.at(t), 10.0));
                prop_assert!(same(merged.mu2.at(t), LINE.value(whole.x(t), 1.0), 10.0));
            }
        }

        #[test]
        fn a_merged_element_has_the_energy_and_work_of_its_parts(
            shares in shares(),
            x in prop::array::uniform4(-1.0..1.0_f64),
        ) {
            // Nothing here is a polynomial, and it jumps where the parts meet.
            let nodes = nodes(&shares);
            let breaks = &nodes[1..nodes.len() - 1];
            let values = [3.0, 400.0, 0.05, 7.0];
            let curve = Curve(|x: f64| [x.sin(), x.cos(), -x.sin()]);
            let scene = Scene::new(2.0, Beam::elastic(Steps { breaks, values: &values[..shares.len()] }))
                .foundation(Foundation { law: (), gap: curve })
                .load(Load {
                    transverse: Function(|x: f64| (5.0 * x).exp().cos()),
                    axial: (),
                    points: [PointLoad { x: nodes[1], force: 2.0, moment: -3.0 }],
                });
            let sample = |pair: &[f64]| Element::sample(&scene, pair[0], pair[1], false).unwrap();
            let parts: Vec<_> = nodes.windows(2).map(sample).collect();
            let merged = Element::merge(&parts);
            let whole = Motion::new(merged.h, DVec2::new(x[0], x[1]), DVec2::new(x[2], x[3]));
            let (mut energy, mut work, mut pull) = (0.0, 0.0, 0.0);
            let (mut right, mut sizes) = (1.0, 0.0);
            for part in &parts {
                right -= part.h / merged.h;
                let motion = whole.part(right, part.h / merged.h);
                energy += motion.e.dot(part.bending.times(motion.e));
                work += motion.e.dot(part.fe) + motion.d.dot(part.fr);
                pull += motion.e.dot(part.bending.times(part.gap.bend::<f64>()));
                sizes += motion.e.abs().dot(part.fe.abs()) + motion.d.abs().dot(part.fr.abs());
            }
            prop_assert!(same(whole.e.dot(merged.bending.times(whole.e)), energy, 10.0 * energy));
            prop_assert!(same(whole.e.dot(merged.fe) + whole.d.dot(merged.fr), work, 10.0 * sizes.max(1.0)));
            let bend = merged.gap.bend::<f64>();
            let scale = (energy * bend.dot(merged.bending.times(bend))).sqrt();
            prop_assert!(same(whole.e.dot(merged.bending.times(bend)), pull, 100.0 * scale));
        }

        #[test]
        fn a_gap_of_any_shape_bends_the_whole_as_it_bends_the_parts(left in 0.2..0.9_f64, h in 0.1..0.4_f64) {
            // Nodal values are the best there are where the stiffness is constant.
            let gap = Curve(|x: f64| [(2.0 * x).sin(), 2.0 * (2.0 * x).cos(), -4.0 * (2.0 * x).sin()]);
            let scene = Scene::new(2.0, Beam::elastic(3.0)).foundation(Foundation { law: (), gap });
            let (mid, right) = (left + 0.5 * h, left + h);
            let [whole, merged] = both(&scene, &[left, mid, right]);
            let (got, want) = (merged.gap.bend::<f64>(), whole.gap.bend::<f64>());
            // Four points in each half are better than four in both.
            prop_assert!((got - want).abs().max_element() < 1e-8, "{got} {want}");
            let value = |x: f64| [(2.0 * x).sin(), 2.0 * (2.0 * x).cos()];
            let ([sl, tl], [sr, tr]) = (value(left), value(right));
            let exact = DVec2::new(sl - (sr - h * tr), tl - tr);
            prop_assert!((got - exact).abs().max_element() < 1e-10, "{got} {exact}");
            prop_assert!((want - exact).abs().max_element() < 1e-8, "{want} {exact}");
        }
    }

    #[test]
    fn an_element_keeps_the_gaps_kink_at_its_left_node() {
        let gap = crate::Table { x: &[0.0, 0.5, 2.0], y: &[0.0, 1.0, 0.25] };
        let scene = Scene::new(2.0, Beam::elastic(3.0)).foundation(Foundation { law: (), gap });
        let element = |left, right| Element::<f64, _>::sample(&scene, left, right, false).unwrap();
        assert_eq!(element(0.5, 0.75).gap.kink::<f64>(), DVec2::new(0.0, -0.5 - 2.0));
        assert_eq!(element(0.25, 0.5).gap.kink::<f64>(), DVec2::ZERO);
        assert_eq!(element(0.75, 1.0).gap.kink::<f64>(), DVec2::ZERO);
        let merged = Element::merge(&[element(0.5, 0.75), element(0.75, 1.0)]);
        assert_eq!(merged.gap.kink::<f64>(), DVec2::new(0.0, -2.5));
    }

    #[test]
    fn a_merged_gap_is_a_number_where_the_determinant_of_the_stiffness_is_none() {
        for stiffness in [5e23_f32, 5e-23] {
            let scene = Scene::new(1.0, Beam::elastic(stiffness))
                .foundation(Foundation { law: (), gap: Polynomial(&[0.0, 0.0, 1.0]) });
            let element = |left, right| Element::<f32, _>::sample(&scene, left, right, false).unwrap();
            let merged = Element::merge(&[element(0.0, 0.01), element(0.01, 0.02)]).gap.bend::<f32>();
            let whole = element(0.0, 0.02).gap.bend::<f32>();
            assert!(
                (merged - whole).abs().max_element() < 1e-5 * whole.abs().max_element(),
                "{merged} {whole}"
            );
        }
    }

    #[test]
    fn a_point_load_belongs_to_the_element_on_its_left() {
        let points = [PointLoad { x: 0.5, force: 2.0, moment: -3.0 }];
        let scene = Scene::new(2.0, Beam::elastic(3.0)).load(Load { transverse: (), axial: (), points });
        let element = |left, right| Element::<f64, _>::sample(&scene, left, right, false).unwrap();
        assert_eq!(element(0.25, 0.5).fr, DVec2::new(2.0, -3.0));
        assert_eq!(element(0.25, 0.5).fe, DVec2::ZERO);
        assert_eq!(element(0.5, 0.75).fr, DVec2::ZERO);
        // Half of the way along the whole, it does half of the work of a whole that turns about its right end.
        let merged = Element::merge(&[element(0.0, 0.5), element(0.5, 1.0)]);
        assert_eq!(merged.fr, DVec2::new(2.0, -3.0 - 0.5 * 2.0));
        assert_eq!(merged.fe, DVec2::new(2.0 * 0.5 - 3.0 * -1.5, 2.0 * 0.125 - 3.0 * -0.25));
    }

    #[test]
    fn samples_out_of_range_name_field_and_place() {
        let text = |stiffness: f64| {
            let bend = Function(move |x: f64| if x > 0.5 { stiffness } else { 1.0 });
            let scene = Scene::new(1.0, Beam::elastic(bend));
            std::format!("{}", Element::sample(&scene, 0.5, 0.75, false).err().unwrap())
        };
        assert!(text(-2.0).ends_with(": expected a number > 0, found -2"));
        assert!(text(-2.0).starts_with("beam.bending at x = 0.7"));
        assert!(text(f64::NAN).ends_with(": expected a finite number, found NaN"));
        let scene = Scene::new(1.0, Beam::elastic(1.0)).foundation(Foundation { law: Linear(-1.0), gap: () });
        let text = std::format!("{}", Element::sample(&scene, 0.0, 1.0, false).err().unwrap());
        assert!(
            text.starts_with("foundation.stiffness at x = ") && text.ends_with("a number >= 0, found -1")
        );
    }
}
