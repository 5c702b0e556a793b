//! The answer: fields at any x, contact zones, resultants.
//!
//! Between nodes nothing is read off the elements' cubics. Moment and shear follow from equilibrium,
//! starting with the force and moment that the relative unknowns give at the element's left node; the
//! curvature is moment over stiffness, and two integrations of it give slope and bending; u and q are
//! integrals of the fluxes through K^-1. So fields between nodes are as accurate as at nodes.

use crate::certificate::{self, Uniqueness, Warning};
use crate::cubic::{Cubic, Side};
use crate::electric::{self, Ratio};
use crate::element::Element;
use crate::element::contact::{Contact, Fault, Splits, kinks, parts};
use crate::element::hermite::Motion;
use crate::element::linear::{Inverse, invert};
use crate::law::{Compliance, truncate, truncate_positive};
use crate::newton::Report;
use crate::newton::nested::Answer;
use crate::profile::{Profile, Slot, Smooth};
use crate::quadrature::integrate;
use crate::real::{Pair, Real, Sum};
use crate::scene::Model;
use crate::storage::{Node, Place};
use arrayvec::ArrayVec;

/// The fields at one x. What the scene has not is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fields<T> {
    /// Where \[m\].
    pub x: T,
    /// Bending xi, positive towards the foundation \[m\].
    pub bending: T,
    /// Slope xi' \[1\].
    pub slope: T,
    /// Moment C xi'' \[N m\].
    pub moment: T,
    /// Shear (C xi'')' \[N\]; its rounding is that of the moments over the element's length.
    pub shear: T,
    /// Stretching u \[m\].
    pub stretching: Option<T>,
    /// Potential q \[V\].
    pub potential: Option<T>,
    /// Axial force sigma = EA u' - P q' \[N\].
    pub axial_force: Option<T>,
    /// Electric displacement D = P u' + eps q' \[C\].
    pub electric_displacement: Option<T>,
    /// Gap s \[m\].
    pub gap: Option<T>,
    /// Pressure of the foundation p(x, eta) \[N/m\].
    pub pressure: Option<T>,
}

/// Forces and moments of the whole beam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resultants<T> {
    /// Integral of the foundation's pressure \[N\].
    pub contact_force: T,
    /// Integral of mu1 R(q) R~(eta) \[N\].
    pub conduction_force: T,
    /// Transverse load, concentrated forces included \[N\].
    pub load: T,
    /// Force of the left clamp on the beam, positive towards the foundation \[N\].
    pub left_force: T,
    /// Force of the right clamp on the beam, positive towards the foundation \[N\].
    pub right_force: T,
    /// Moment C xi'' at the left clamp \[N m\].
    pub left_moment: T,
    /// Moment C xi'' at the right clamp \[N m\].
    pub right_moment: T,
    /// 1/2 integral of C xi''^2 \[J\].
    pub bending_energy: T,
    /// What is left of the sum of all transverse forces, over the sum of their sizes.
    pub equilibrium_error: T,
}

/// A solved scene.
pub struct Solution<'s, T: Real, M: Model<T>> {
    pub(crate) scene: &'s M,
    pub(crate) places: &'s [Place<T, M>],
    report: Report<T>,
    pub(crate) state: usize,
    pub(crate) left: Node<T, M>,
    /// The foundation was taken as one that is rigid to the elements.
    pub(crate) rigid: bool,
}

/// An element in its solved state.
pub(crate) struct Solved<'s, T: Real, M: Model<T>> {
    pub(crate) scene: &'s M,
    pub(crate) element: &'s Element<T, M>,
    pub(crate) motion: Motion<T>,
    pub(crate) eta: Cubic<T>,
    pub(crate) q: Cubic<T>,
    pub(crate) left: &'s Node<T, M>,
    pub(crate) right: &'s Node<T, M>,
    pub(crate) mid: T,
    rigid: bool,
    /// Nowhere in contact, but for rounding.
    free: bool,
    /// Its contact force is rounding of its load: so where at a clamp without a gap rounding puts a crossing.
    light: bool,
    pub(crate) ratio: Ratio<T>,
    /// Force and moment at the left node: shear and minus the moment.
    pub(crate) held: T::Vec2,
    /// Kinks of the forces inside the element, in t.
    pub(crate) splits: Splits<T>,
}

impl<'s, T: Real, M: Model<T>> Solution<'s, T, M> {
    pub(crate) fn new(scene: &'s M, places: &'s [Place<T, M>], answer: Answer<T, M>) -> Self {
        let Answer { report, state, left, rigid, .. } = answer;
        Self { scene, places, report, state, left, rigid }
    }

    /// How the solve went: status, residual, work.
    #[must_use]
    pub fn report(&self) -> &Report<T> {
        &self.report
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &'s M {
        self.scene
    }

    /// Nodes from left to right \[m\].
    pub fn nodes(&self) -> impl Iterator<Item = T> + '_ {
        core::iter::once(T::zero()).chain(self.places.iter().map(|p| p.element.right))
    }

    /// The fields at x, which is moved into [0, L] if it is outside. At a concentrated load the shear and
    /// the moment of its left side are given.
    ///
    /// # Cost
    /// A bisection for the element and a few dozen evaluations of the scene's profiles.
    #[must_use]
    pub fn at(&self, x: T) -> Fields<T> {
        let x = x.max(T::zero()).min(self.scene.length());
        let i = self.places.partition_point(|p| p.element.right < x).min(self.places.len() - 1);
        self.solved(i).fields(x)
    }

    /// Calls `zone(a, b)` for every contact zone [a, b] in \[m\], from left to right: where the penetration
    /// is positive.
    pub fn for_each_zone(&self, mut zone: impl FnMut(T, T)) {
        if !M::Law::PRESENT && !M::Mu1::PRESENT && !M::Mu2::PRESENT {
            return;
        }
        let mut open: Option<(T, T)> = None;
        for i in 0..self.places.len() {
            let Place { element, work } = &self.places[i];
            let state = work.states[self.state];
            let eta = Motion::new(element.h, state.e, state.d).cubic();
            for &(from, to) in Element::<T, M>::contact_parts(&eta).iter().rev() {
                // t runs from right to left. At a clamp without a gap the penetration is zero with its slope,
                // and rounding may put a crossing beside it: on an element of a thousand at the root of 1e-16 over
                // 1e-6.
                let clamped = |here: bool| if here { T::of(1e-5) } else { T::zero() };
                let (at_left, at_right) = (clamped(i == 0), clamped(i == self.places.len() - 1));
                if from > T::one() - at_left || to < at_right {
                    continue;
                }
                let far = to >= T::one() - at_left;
                let near = from <= at_right;
                let start = if far { element.right - element.h } else { element.x(to) };
                let end = if near { element.right } else { element.x(from) };
                open = match open {
                    Some((a, b)) if start <= b + T::of(1e-9) * element.h => Some((a, end)),
                    Some((a, b)) => {
                        zone(a, b);
                        Some((start, end))
                    }
                    None => Some((start, end)),
                };
            }
        }
        if let Some((a, b)) = open {
            zone(a, b);
        }
    }

    /// The contact zones [a, b] in \[m\], from left to right.
    #[cfg(feature = "alloc")]
    #[must_use]
    pub fn zones(&self) -> alloc::vec::Vec<[T; 2]> {
        let mut zones = alloc::vec::Vec::new();
        self.for_each_zone(|a, b| zones.push([a, b]));
        zones
    }

    /// Forces, reactions, energy and the equilibrium of the whole beam.
    ///
    /// A clamp's force is the shear of an element less the forces between it and the clamp. The shear's rounding is
    /// that of the moments over the element's length, so the element is a long one of the clamp's half of the beam.
    ///
    /// # Cost
    /// One pass over all elements.
    #[must_use]
    pub fn resultants(&self) -> Resultants<T> {
        let (mut contact, mut conduction) = (Sum::<T>::default(), Sum::<T>::default());
        let (mut load, mut energy) = (Sum::<T>::default(), Sum::<T>::default());
        let mut size = T::zero();
        let mut sum = Resultants::default();
        let last = self.places.len() - 1;
        let [from_left, from_right] = self.held_by();
        let (mut before, mut after) = (Sum::<T>::default(), Sum::<T>::default());
        for i in 0..=last {
            let solved = self.solved(i);
            let element = solved.element;
            let [p, drive] = solved.contact_forces();
            contact.add(p);
            conduction.add(drive);
            load.add(element.fr.x());
            size = size + p.abs() + drive.abs() + element.fr.x().abs();
            let bend = solved.bend();
            energy.add(T::of(0.5) * bend.times(element.bending.times(bend)));
            let net = [element.fr.x(), -p, -drive];
            if i == 0 {
                sum.left_moment = -solved.held.y();
            }
            if i < from_left {
                net.into_iter().for_each(|force| before.add(force));
            } else if i == from_left {
                sum.left_force = solved.held.x() - before.value();
            }
            if i == from_right {
                after.add(solved.held.x());
            }
            if i >= from_right {
                net.into_iter().for_each(|force| after.add(force));
            }
            if i == last {
                sum.right_moment = solved.statics(T::zero()).0;
            }
        }
        sum.right_force = -after.value();
        sum.contact_force = contact.value();
        sum.conduction_force = conduction.value();
        sum.load = load.value();
        sum.bending_energy = energy.value();
        let rest = sum.left_force + sum.right_force + sum.load - sum.contact_force - sum.conduction_force;
        size = size + sum.left_force.abs() + sum.right_force.abs();
        sum.equilibrium_error = if size > T::zero() { rest.abs() / size } else { T::zero() };
        sum
    }

    /// The elements whose shear gives the left clamp's force and the right one's: the nearest to it but for those
    /// twice as long that reach into its half of the beam.
    fn held_by(&self) -> [usize; 2] {
        let half = T::of(0.5) * self.scene.length();
        let h = |i: usize| self.places.get(i).map_or(T::zero(), |place| place.element.h);
        let longer = |best: usize, i: usize| if h(i) > T::of(2.0) * h(best) { i } else { best };
        let n = self.places.len();
        let begins_left = |i: &usize| self.places.get(*i).is_some_and(|p| p.element.x(T::one()) < half);
        let ends_right = |i: &usize| self.places.get(*i).is_some_and(|p| p.element.right > half);
        [
            (0..n).take_while(begins_left).fold(0, longer),
            (0..n).rev().take_while(ends_right).fold(n.saturating_sub(1), longer),
        ]
    }

    /// The uniqueness condition (2.15) with both margins.
    #[must_use]
    pub fn uniqueness(&self) -> Uniqueness<T> {
        certificate::uniqueness(self.scene, self.places)
    }

    /// Departures from the paper's hypotheses, and results that the model's small strains do not cover.
    #[must_use]
    pub fn warnings(&self) -> ArrayVec<Warning<T>, 8> {
        let mut warnings = certificate::hypotheses(self.scene, &self.uniqueness());
        let mut stretch = (T::zero(), T::zero());
        let mut turn = (T::zero(), T::zero());
        let mut rigid: Option<T> = None;
        let law = self.scene.foundation().law;
        for i in 0..self.places.len() {
            let solved = self.solved(i);
            let (asked, taken) = (law.coefficient(solved.mid, solved.mid), solved.stiffness(solved.mid));
            if taken < asked && rigid.is_none_or(|least| taken < least) {
                rigid = Some(taken);
            }
            for x in [solved.element.x(T::one()), solved.element.right] {
                let strain = solved.axial_strain(x);
                if strain.abs() > stretch.0.abs() {
                    stretch = (strain, x);
                }
            }
            // The left node is the last one's right node, or a clamp, which does not turn.
            let (slope, x) = (solved.slope_at_right(), solved.element.right);
            if slope.abs() > turn.0.abs() {
                turn = (slope, x);
            }
        }
        if let Some(stiffness) = rigid {
            let _ = warnings.try_push(Warning::Rigid { stiffness });
        }
        if stretch.0.abs() > T::of(0.05) {
            let _ = warnings.try_push(Warning::LargeStrain { strain: stretch.0, x: stretch.1 });
        }
        if T::of(0.5) * turn.0 * turn.0 > T::of(0.05) {
            let _ = warnings.try_push(Warning::LargeSlope { slope: turn.0, x: turn.1 });
        }
        warnings
    }

    pub(crate) fn solved(&self, i: usize) -> Solved<'_, T, M> {
        let Place { element, work } = &self.places[i];
        let left = match i.checked_sub(1) {
            Some(before) => &self.places[before].work.node,
            None => &self.left,
        };
        let state = work.states[self.state];
        let motion = Motion::new(element.h, state.e, state.d);
        let eta = motion.cubic();
        let ratio = Ratio::of(&self.places[0].element);
        let q = if M::Permittivity::PRESENT {
            electric::potential(element, left, &work.node, &ratio)
        } else {
            Cubic::default()
        };
        let splits = kinks(self.scene, &eta, (M::Mu1::PRESENT || M::Mu2::PRESENT).then_some(&q));
        let mid = element.x(T::of(0.5));
        let right = &work.node;
        let (held, rigid, light) = (T::Vec2::default(), self.rigid, false);
        let free = eta.side(T::zero()) == Side::Below;
        let mut solved = Solved {
            scene: self.scene,
            element,
            motion,
            eta,
            q,
            left,
            right,
            mid,
            rigid,
            free,
            light,
            ratio,
            held,
            splits,
        };
        // A state without a converged law may not be linearised: then the law's force is left out, as the
        // status says.
        let (force, whole) = solved
            .contact()
            .map_or_else(|_| (T::Vec2::default(), T::Vec2::default()), |c| c.force(&motion, element.h));
        solved.light = whole.x().abs() <= T::of(64.0) * T::epsilon() * element.fr.x().abs();
        solved.held = element.bending.times(solved.bend()) + force - element.fe;
        solved
    }
}

impl<T: Real, M: Model<T>> Solved<'_, T, M> {
    /// Relative unknowns of xi itself.
    pub(crate) fn bend(&self) -> T::Vec2 {
        if M::Gap::PRESENT { self.motion.e + self.element.gap.bend::<T>() } else { self.motion.e }
    }

    /// The contact, linearised at this state.
    pub(crate) fn contact(&self) -> Result<Contact<T>, Fault> {
        Contact::at(self.scene, self.element, &self.motion, Some(|| self.q), T::one())
    }

    pub(crate) fn t(&self, x: T) -> T {
        ((self.element.right - x) / self.element.h).max(T::zero()).min(T::one())
    }

    /// The law's coefficient at x, as the element has it.
    pub(crate) fn stiffness(&self, x: T) -> T {
        let law = self.scene.foundation().law;
        // At a node what is zero but for rounding may be less.
        let k = law.coefficient(x, self.mid).max(T::zero());
        if self.rigid { law.at_most(k, self.element.rigid()) } else { k }
    }

    /// Pressure p and conduction force mu1 R(q) R~(eta) at t \[N/m\].
    pub(crate) fn forces(&self, t: T) -> [T; 2] {
        self.forces_by(t, || self.q.at(t))
    }

    /// How fast the contact's forces grow at t with the penetration, if that is r \[N/m^2\].
    pub(crate) fn tangent(&self, t: T, r: T) -> T {
        if r <= T::zero() {
            return T::zero();
        }
        let (foundation, x) = (self.scene.foundation(), self.element.x(t));
        let resists =
            if M::Law::PRESENT { foundation.law.pressure(self.stiffness(x), x, r).1 } else { T::zero() };
        let bounds = self.scene.conduction();
        let drives = if M::Mu1::PRESENT && r < bounds.truncation {
            bounds.mu1.value(x, self.mid) * truncate(self.q.at(t), bounds.potential_truncation).0.abs()
        } else {
            T::zero()
        };
        resists + drives
    }

    /// The same under the potential `q`.
    fn forces_by(&self, t: T, q: impl FnOnce() -> T) -> [T; 2] {
        let r = self.eta.at(t);
        if self.free || r <= T::zero() {
            return [T::zero(); 2];
        }
        let foundation = self.scene.foundation();
        let x = self.element.x(t);
        let k = self.stiffness(x);
        let p = if M::Law::PRESENT { foundation.law.pressure(k, x, r).0 } else { T::zero() };
        // A law that is not finite ended the solve and is its status; the best iterate is shown without it.
        let p = if p.is_finite() { p } else { T::zero() };
        let bounds = self.scene.conduction();
        let drive = if M::Mu1::PRESENT {
            bounds.mu1.value(x, self.mid)
                * truncate(q(), bounds.potential_truncation).0
                * truncate_positive(r, bounds.truncation).0
        } else {
            T::zero()
        };
        [p, drive]
    }

    /// Integral over t from `from` to `to` of g, part by part between the kinks.
    pub(crate) fn between(&self, from: T, to: T, mut g: impl FnMut(T) -> T) -> T {
        let mut splits = self.splits.clone();
        let mut sum = T::zero();
        for (a, b) in parts(&mut splits) {
            let (a, b) = (a.max(from), b.min(to));
            if b > a {
                sum = sum + integrate::<T, 4>(a, b, &mut g);
            }
        }
        sum
    }

    /// Contact and conduction force of the element \[N\].
    fn contact_forces(&self) -> [T; 2] {
        [0, 1].map(|which| self.element.h * self.between(T::zero(), T::one(), |t| self.forces(t)[which]))
    }

    /// Transverse load less contact at t \[N/m\].
    pub(crate) fn net(&self, t: T) -> T {
        self.net_by(t, || self.q.at(t))
    }

    /// The same under the potential `q`.
    pub(crate) fn net_by(&self, t: T, q: impl FnOnce() -> T) -> T {
        let [p, drive] = self.forces_by(t, q);
        // Forces of the foundation first: an attraction may all but cancel a pressure far larger than the load.
        self.scene.load().transverse.value(self.element.x(t), self.mid) - (p + drive)
    }

    /// Moment and shear at t, from the left node by equilibrium.
    pub(crate) fn statics(&self, t: T) -> (T, T) {
        let h = self.element.h;
        let shear = self.held.x() + h * self.between(t, T::one(), |y| self.net(y));
        let lever = h * (h * self.between(t, T::one(), |y| (y - t) * self.net(y)));
        let moment = self.held.x() * (h * (T::one() - t)) - self.held.y() + lever;
        (moment, shear)
    }

    /// Integrals of the curvature from the right node to t: of kappa, and of kappa times the distance to
    /// t, over x.
    pub(crate) fn curvature(&self, t: T) -> (T, T) {
        let h = self.element.h;
        let stiffness = self.scene.beam().bending;
        // Curvature times h: itself it may be below the normal numbers where slopes are not.
        let turned = |y: T| self.statics(y).0 / (stiffness.value(self.element.x(y), self.mid) / h);
        let turn = integrate::<T, 4>(T::zero(), t, turned);
        let lift = h * integrate::<T, 4>(T::zero(), t, |y| (t - y) * turned(y));
        (turn, lift)
    }

    /// How much of what integrating the curvature adds to the element's own cubic is to be believed, from 0 to 1.
    ///
    /// Integrating is one step of a fixed point for the bending between the nodes: it multiplies the error of
    /// the penetration by k h^4 / (4.73^4 C), k with what conduction adds to it, 4.73 the first root of the clamped beam. Where that is above one and
    /// the element is in contact the cubic is better; where it is free, what is added must not lead into the
    /// foundation. (So fields depend continuously on the state.)
    fn trust(&self) -> T {
        if !M::Law::PRESENT && !M::Mu1::PRESENT {
            return T::one();
        }
        let (law, conduction) = (self.scene.foundation().law, self.scene.conduction());
        let stiffness = self.scene.beam().bending.value(self.mid, self.mid);
        let h = self.element.h;
        let soft = stiffness / h / h / h / h;
        let points = [0.0, 0.25, 0.5, 0.75, 1.0].map(T::of);
        let held = |t: T| {
            let x = self.element.x(t);
            let r = self.eta.at(t).abs();
            // A law of the caller's need not have the slope that it says.
            let (p, slope) = law.pressure(self.stiffness(x), x, r);
            let mut slope = slope.max(p / r);
            if M::Mu1::PRESENT {
                let drive = truncate(self.q.at(t), conduction.potential_truncation).0;
                slope = slope + (conduction.mu1.value(x, self.mid) * drive).abs();
            }
            slope > T::of(500.6) * soft
        };
        if !points.into_iter().any(held) {
            return T::one();
        }
        // In contact the cubic; else as much of the bubble 16 t^2 (1 - t)^2 added, if it leads towards the
        // foundation, as there is room for.
        let added = self.net(T::of(0.5)) / (T::of(384.0) * soft);
        let lifted = self.free || self.light;
        if !lifted || added <= T::zero() {
            return if lifted { T::one() } else { T::zero() };
        }
        [0.125, 0.25, 0.5, 0.75, 0.875].into_iter().fold(T::one(), |trust, t| {
            let bubble = added * T::of(16.0 * t * t * (1.0 - t) * (1.0 - t));
            trust.min(-self.eta.at(T::of(t)) / bubble)
        })
    }

    /// The slope at the right node.
    fn slope_at_right(&self) -> T {
        self.motion.d.y() + self.scene.foundation().gap.jet(self.element.right, self.mid)[1]
    }

    pub(crate) fn inverse(&self, x: T) -> Inverse<T> {
        let beam = self.scene.beam();
        invert::<T, M>(
            beam.axial.value(x, self.mid),
            beam.piezo.value(x, self.mid),
            beam.permittivity.value(x, self.mid),
        )
    }

    /// Fluxes tau and D at t, from the left node.
    fn fluxes(&self, t: T) -> (T, T) {
        let h = self.element.h;
        let load = self.scene.load();
        let conduction = self.scene.conduction();
        let mut tau = self.left.tau.get();
        if M::AxialLoad::PRESENT {
            let f = |y: T| load.axial.value(self.element.x(y), self.mid);
            tau = tau - h * self.between(t, T::one(), f);
        }
        let mut displacement = self.left.charge.get();
        if M::Mu2::PRESENT && !self.free {
            let g = |y: T| {
                let r = truncate_positive(self.eta.at(y), conduction.truncation).0;
                conduction.mu2.value(self.element.x(y), self.mid) * r * r
            };
            let current = h * self.between(t, T::one(), g);
            displacement = displacement - current;
            if M::Piezo::PRESENT {
                tau = tau - self.ratio.charge(current);
            }
        }
        (tau, displacement)
    }

    /// u' and q' at t.
    pub(crate) fn gradients(&self, t: T) -> (T, T) {
        let k = self.inverse(self.element.x(t));
        let (tau, displacement) = self.fluxes(t);
        self.ratio.gradients::<M>(&k, tau, displacement)
    }

    /// The integral of u' or q' over x from t to the right node.
    fn gathered(&self, t: T, gradient: fn((T, T)) -> T) -> T {
        if t == T::zero() {
            return t;
        }
        let gradient = |y: T| gradient(self.gradients(y));
        // The current makes kinks of the gradients where the contact has its own.
        let integral = if M::Mu2::PRESENT {
            self.between(T::zero(), t, gradient)
        } else {
            integrate::<T, 4>(T::zero(), t, gradient)
        };
        self.element.h * integral
    }

    /// Potential at t.
    pub(crate) fn potential(&self, t: T) -> T {
        self.right.q.get() - self.gathered(t, |(_, q)| q)
    }

    fn axial_strain(&self, x: T) -> T {
        if M::Axial::PRESENT { self.gradients(self.t(x)).0 } else { T::zero() }
    }

    pub(crate) fn fields(&self, x: T) -> Fields<T> {
        let (element, h) = (self.element, self.element.h);
        let t = self.t(x);
        let (zero, one) = (T::zero(), T::one());
        let (moment, shear) = self.statics(t);

        let gap = self.scene.foundation().gap;
        let [s, turn, _] = gap.jet(x, self.mid);
        let (mut bending, mut slope) = (s + self.eta.at(t), turn - self.eta.slope(t) / h);
        // A node has the values of its unknowns.
        let trust = if t == zero { zero } else { self.trust() };
        if t == zero {
            slope = turn + self.motion.d.y();
        } else if trust > zero {
            // Two integrations of the curvature from the right node; what the element's own relative unknowns
            // differ by is laid over the element as its cubic, so that both nodes keep their values.
            let (turn, lift) = self.curvature(t);
            let (whole_turn, whole_lift) = self.curvature(one);
            let rest = self.bend() - T::Vec2::of(whole_lift, -whole_turn);
            let rest = Motion::new(h, rest, T::Vec2::default()).cubic();
            let [s_right, slope_right, _] = gap.jet(element.right, self.mid);
            let (w, theta) = (self.motion.d.x() + s_right, self.motion.d.y() + slope_right);
            let integrated = (w - h * t * theta + lift + rest.at(t), theta - turn - rest.slope(t) / h);
            if trust >= one {
                (bending, slope) = integrated;
            } else {
                bending = bending + trust * (integrated.0 - bending);
                slope = slope + trust * (integrated.1 - slope);
            }
        }

        let (tau, displacement) = self.fluxes(t);
        let sigma = self.ratio.sigma(tau, displacement);
        let stretching = M::Axial::PRESENT.then(|| self.right.u.get() - self.gathered(t, |(u, _)| u));
        let potential = M::Permittivity::PRESENT.then(|| self.potential(t));
        let grounded = M::Law::PRESENT || M::Gap::PRESENT || M::Mu1::PRESENT || M::Mu2::PRESENT;
        Fields {
            x,
            bending,
            slope,
            moment,
            shear,
            stretching,
            potential,
            axial_force: M::Axial::PRESENT.then_some(sigma),
            electric_displacement: M::Permittivity::PRESENT.then_some(displacement),
            gap: grounded.then(|| gap.value(x, self.mid)),
            pressure: M::Law::PRESENT.then(|| self.forces(t)[0]),
        }
    }
}
