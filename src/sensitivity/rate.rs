//! Rates on one element: the derivative of all that [`Solved`] computes from an element's state and data.
//!
//! A rate is taken along a direction: one parameter, and the rates of the element's own unknowns. Every formula
//! here is the exact derivative of the one in [`crate::solution`]; with the unknowns at rest it gives the
//! residual's derivative to the parameter, which loads the tangent system, and with the parameter at rest the
//! tangent itself. Contact edges move, but the forces are zero there, so integrals between them need no term at
//! their ends.

use super::{Output, Parameter};
use crate::cubic::Cubic;
use crate::element::contact::points;
use crate::element::hermite::{self, Motion, work};
use crate::element::linear::Inverse;
use crate::law::{Compliance, truncate, truncate_positive};
use crate::profile::{Piece, Profile, Slot, Smooth};
use crate::quadrature::{POINTS, add_moments, gauss, integrate};
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::solution::{Fields, Solved};
use crate::storage::Node;
use core::array::from_fn;

/// Rates at a node: u, q, tau and D; or the weights of these in an output.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Flow<T> {
    pub(super) u: T,
    pub(super) q: T,
    pub(super) tau: T,
    pub(super) charge: T,
}

impl<T: Real> Flow<T> {
    pub(super) fn of([u, q, tau, charge]: [T; 4]) -> Self {
        Self { u, q, tau, charge }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            u: self.u + other.u,
            q: self.q + other.q,
            tau: self.tau + other.tau,
            charge: self.charge + other.charge,
        }
    }
}

/// The parameter that moves, if one does, and where it acts if that is at one place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Direction<T> {
    pub(super) parameter: Option<Parameter<T>>,
    /// The element of a concentrated force or moment, and where in it.
    pub(super) element: usize,
    pub(super) t: T,
}

impl<T: Real> Direction<T> {
    /// No parameter moves: rates of the unknowns alone.
    pub(super) fn rest() -> Self {
        Self { parameter: None, element: usize::MAX, t: T::zero() }
    }

    fn is(&self, parameter: Parameter<T>) -> bool {
        self.parameter == Some(parameter)
    }
}

/// Rates of the unknowns that an element sees; or their weights in an output.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Variation<T: Real> {
    pub(super) e: T::Vec2,
    pub(super) d: T::Vec2,
    pub(super) left: Flow<T>,
    pub(super) right: Flow<T>,
}

/// What an element's rates add to the sums of [`crate::electric`]: load and current in all, and the rates of
/// u and q across the element that they and the coefficients make.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<T> {
    pub(super) load: T,
    pub(super) current: T,
    pub(super) u: T,
    pub(super) q: T,
}

/// An element whose state and data move.
pub(super) struct Rate<'a, 's, T: Real, M: Model<T>> {
    solved: &'a Solved<'s, T, M>,
    along: Direction<T>,
    /// A concentrated force of this element.
    force: Option<T>,
    /// A concentrated force or moment at its right node.
    node: T::Vec2,
    by: Variation<T>,
    eta: Cubic<T>,
    q: Cubic<T>,
}

impl<'a, 's, T: Real, M: Model<T>> Rate<'a, 's, T, M> {
    pub(super) fn new(solved: &'a Solved<'s, T, M>, i: usize, along: Direction<T>, by: Variation<T>) -> Self {
        let (zero, one) = (T::zero(), T::one());
        let eta = Motion::new(solved.element.h, by.e, by.d).cubic();
        let here = along.element == i;
        let force = match along.parameter {
            Some(Parameter::Force(_)) if here => Some(along.t),
            _ => None,
        };
        let node = match along.parameter {
            Some(Parameter::PointForce(_)) if here => T::Vec2::of(one, zero),
            Some(Parameter::PointMoment(_)) if here => T::Vec2::of(zero, one),
            _ => T::Vec2::default(),
        };
        let mut rate = Self { solved, along, force, node, by, eta, q: Cubic::default() };
        if M::Mu1::PRESENT && M::Permittivity::PRESENT {
            rate.q = Cubic::hermite(
                by.right.q,
                rate.slope_of_q(zero, solved.right, by.right),
                by.left.q,
                rate.slope_of_q(one, solved.left, by.left),
            );
        }
        rate
    }

    /// Rate of dq/dt at a node, as the cubic of the potential takes it.
    fn slope_of_q(&self, t: T, node: &Node<T, M>, by: Flow<T>) -> T {
        let solved = self.solved;
        let k = solved.element.flexibility.at(t);
        let gradients = solved.ratio.gradients::<M>(&k, node.tau.get(), node.charge.get());
        let moved = solved.ratio.gradients::<M>(&k, by.tau, by.charge).1;
        -(solved.element.h * (moved + self.softening(solved.element.x(t), &k, gradients).1))
    }

    /// What the coefficients' own rates do to u' and q' where the fluxes stay: -K^-1 dK (u', q')'.
    fn softening(&self, x: T, k: &Inverse<T>, (u, q): (T, T)) -> (T, T) {
        let (beam, mid) = (self.solved.scene.beam(), self.solved.mid);
        match self.along.parameter {
            Some(Parameter::Axial) => {
                let s = beam.axial.value(x, mid) * u;
                (-(s * k.uu), s * k.uq)
            }
            Some(Parameter::Piezo) => {
                let p = beam.piezo.value(x, mid);
                (p * (k.uu * q - k.uq * u), -(p * (k.uq * q + k.qq * u)))
            }
            Some(Parameter::Permittivity) => {
                let s = beam.permittivity.value(x, mid) * q;
                (-(s * k.uq), -(s * k.qq))
            }
            _ => (T::zero(), T::zero()),
        }
    }

    /// Rates of pressure and conduction force at t \[N/m\].
    fn forces(&self, t: T) -> [T; 2] {
        let solved = self.solved;
        let (element, r) = (solved.element, solved.eta.at(t));
        if r <= T::zero() {
            return [T::zero(); 2];
        }
        let moved = self.eta.at(t);
        let mut p = T::zero();
        if M::Law::PRESENT {
            let (value, slope) = solved.scene.foundation().law.pressure(element.law.at(t), element.x(t), r);
            p = slope * moved;
            if self.along.is(Parameter::Stiffness) {
                p = p + value;
            }
        }
        let mut drive = T::zero();
        if M::Mu1::PRESENT {
            let bounds = solved.scene.conduction();
            let (potential, by_potential) = truncate(solved.q.at(t), bounds.potential_truncation);
            let (depth, by_depth) = truncate_positive(r, bounds.truncation);
            drive = potential * by_depth * moved + by_potential * self.q.at(t) * depth;
            if self.along.is(Parameter::Mu1) {
                drive = drive + potential * depth;
            }
            drive = element.mu1.at(t) * drive;
        }
        [p, drive]
    }

    /// Rate of the residual on (e, d): internal less external forces.
    pub(super) fn residual(&self) -> (T::Vec2, T::Vec2) {
        let solved = self.solved;
        let (element, h) = (solved.element, solved.element.h);
        let mut bend = self.by.e;
        if M::Gap::PRESENT && self.along.is(Parameter::Gap) {
            bend += element.gap.bend::<T>();
        }
        if self.along.is(Parameter::Bending) {
            bend += solved.bend();
        }
        let (mut on_e, mut on_d) = (element.bending.times(bend), -self.node);
        if M::Law::PRESENT || M::Mu1::PRESENT {
            let (e, d) = work::<T>(
                h,
                moments(solved, |t| {
                    let [p, drive] = self.forces(t);
                    p + drive
                }),
            );
            on_e += e;
            on_d += d;
        }
        if self.along.is(Parameter::Transverse) {
            let load = solved.scene.load();
            let samples =
                gauss::<POINTS>().map(|(t, _)| load.transverse.value(element.x(T::of(t)), solved.mid));
            let (e, d) = hermite::loads(h, samples);
            on_e += -e;
            on_d += -d;
        }
        if let Some(t) = self.force {
            let (e, d) = shapes(h, t);
            on_e += -e;
            on_d += -d;
        }
        (on_e, on_d)
    }

    /// Rates of the transverse load less contact at t, concentrated forces left out \[N/m\].
    fn net(&self, t: T) -> T {
        let [p, drive] = self.forces(t);
        let solved = self.solved;
        let load = if self.along.is(Parameter::Transverse) {
            solved.scene.load().transverse.value(solved.element.x(t), solved.mid)
        } else {
            T::zero()
        };
        load - p - drive
    }

    /// Rates of moment and shear at t; `held` is the residual's rate on e.
    fn statics(&self, held: T::Vec2, t: T) -> (T, T) {
        let (h, one) = (self.solved.element.h, T::one());
        let mut shear = held.x() + h * self.solved.between(t, one, |y| self.net(y));
        let lever = h * h * self.solved.between(t, one, |y| (y - t) * self.net(y));
        let mut moment = held.x() * (h * (one - t)) - held.y() + lever;
        if let Some(y) = self.force
            && y > t
        {
            shear = shear + one;
            moment = moment + h * (y - t);
        }
        (moment, shear)
    }

    /// Rates of the integrals of the curvature from the right node to t.
    fn curvature(&self, held: T::Vec2, t: T) -> (T, T) {
        let solved = self.solved;
        let h = solved.element.h;
        let stiffness = solved.scene.beam().bending;
        let kappa = |y: T| {
            let mut moment = self.statics(held, y).0;
            if self.along.is(Parameter::Bending) {
                moment = moment - solved.statics(y).0;
            }
            moment / stiffness.value(solved.element.x(y), solved.mid)
        };
        // Under a concentrated force the moment has a kink.
        let kink = self.force.unwrap_or(t).min(t).max(T::zero());
        let integral = |g: &dyn Fn(T) -> T| {
            let far = if kink < t { integrate::<T, 4>(kink, t, g) } else { T::zero() };
            let near = if kink > T::zero() { integrate::<T, 4>(T::zero(), kink, g) } else { T::zero() };
            near + far
        };
        (h * integral(&kappa), h * h * integral(&|y| (t - y) * kappa(y)))
    }

    /// Rates of bending and slope at x.
    fn bend(&self, x: T) -> (T, T) {
        let solved = self.solved;
        let (h, t) = (solved.element.h, solved.t(x));
        let held = self.residual().0;
        let (turn, lift) = self.curvature(held, t);
        let (whole_turn, whole_lift) = self.curvature(held, T::one());
        let mut bend = self.by.e;
        let (mut w, mut theta) = (self.by.d.x(), self.by.d.y());
        if M::Gap::PRESENT && self.along.is(Parameter::Gap) {
            bend += solved.element.gap.bend::<T>();
            let [s, slope, _] = solved.scene.foundation().gap.jet(solved.element.right, solved.mid);
            (w, theta) = (w + s, theta + slope);
        }
        let rest = bend - T::Vec2::of(whole_lift, -whole_turn);
        let rest = Motion::new(h, rest, T::Vec2::default()).cubic();
        (w - h * t * theta + lift + rest.at(t), theta - turn - rest.slope(t) / h)
    }

    /// Rate of the current mu2 R~(eta)^2 at t.
    fn current(&self, t: T) -> T {
        let solved = self.solved;
        let (r, slope) = truncate_positive(solved.eta.at(t), solved.scene.conduction().truncation);
        let mut rate = T::of(2.0) * r * slope * self.eta.at(t);
        if self.along.is(Parameter::Mu2) {
            rate = rate + r * r;
        }
        solved.element.mu2.at(t) * rate
    }

    /// Rates of tau and D at t.
    fn fluxes(&self, t: T) -> (T, T) {
        let solved = self.solved;
        let (h, one) = (solved.element.h, T::one());
        let (mut tau, mut charge) = (self.by.left.tau, self.by.left.charge);
        if M::AxialLoad::PRESENT && self.along.is(Parameter::AxialLoad) {
            let f = |y: T| solved.scene.load().axial.value(solved.element.x(y), solved.mid);
            tau = tau - h * solved.between(t, one, f);
        }
        if M::Mu2::PRESENT {
            let current = h * solved.between(t, one, |y| self.current(y));
            charge = charge - current;
            tau = tau - solved.ratio.charge(current);
        }
        (tau, charge)
    }

    /// Rates of u' and q' at t.
    fn gradients(&self, t: T) -> (T, T) {
        let solved = self.solved;
        let x = solved.element.x(t);
        let k = solved.inverse(x);
        let (tau, charge) = self.fluxes(t);
        let (u, q) = solved.ratio.gradients::<M>(&k, tau, charge);
        if !self.softens() {
            return (u, q);
        }
        let (du, dq) = self.softening(x, &k, solved.gradients(t));
        (u + du, q + dq)
    }

    fn softens(&self) -> bool {
        matches!(self.along.parameter, Some(Parameter::Axial | Parameter::Piezo | Parameter::Permittivity))
    }

    fn stretching(&self, x: T) -> T {
        let (h, t) = (self.solved.element.h, self.solved.t(x));
        self.by.right.u - h * integrate::<T, 4>(T::zero(), t, |y| self.gradients(y).0)
    }

    fn potential(&self, x: T) -> T {
        let (h, t) = (self.solved.element.h, self.solved.t(x));
        self.by.right.q - h * integrate::<T, 4>(T::zero(), t, |y| self.gradients(y).1)
    }

    /// Rates of all fields at x.
    pub(super) fn fields(&self, x: T) -> Fields<T> {
        let solved = self.solved;
        let t = solved.t(x);
        let (moment, shear) = self.statics(self.residual().0, t);
        let (bending, slope) = self.bend(x);
        let (tau, charge) = self.fluxes(t);
        let grounded = M::Law::PRESENT || M::Gap::PRESENT || M::Mu1::PRESENT || M::Mu2::PRESENT;
        let gap = || match self.along.parameter {
            Some(Parameter::Gap) => solved.scene.foundation().gap.value(x, solved.mid),
            _ => T::zero(),
        };
        Fields {
            x,
            bending,
            slope,
            moment,
            shear,
            stretching: M::Axial::PRESENT.then(|| self.stretching(x)),
            potential: M::Permittivity::PRESENT.then(|| self.potential(x)),
            axial_force: M::Axial::PRESENT.then(|| solved.ratio.sigma(tau, charge)),
            electric_displacement: M::Permittivity::PRESENT.then_some(charge),
            gap: grounded.then(gap),
            pressure: M::Law::PRESENT.then(|| self.forces(t)[0]),
        }
    }

    /// Rate of the element's part in an output.
    pub(super) fn output(&self, output: Output<T>) -> T {
        let (h, zero) = (self.solved.element.h, T::zero());
        let t = |x| self.solved.t(x);
        match output {
            Output::Bending(x) => self.bend(x).0,
            Output::Slope(x) => self.bend(x).1,
            Output::Moment(x) => self.statics(self.residual().0, t(x)).0,
            Output::Shear(x) => self.statics(self.residual().0, t(x)).1,
            Output::Stretching(x) => self.stretching(x),
            Output::Potential(x) => self.potential(x),
            Output::AxialForce(x) => {
                let (tau, charge) = self.fluxes(t(x));
                self.solved.ratio.sigma(tau, charge)
            }
            Output::ElectricDisplacement(x) => self.fluxes(t(x)).1,
            Output::ContactForce => h * moments(self.solved, |t| self.forces(t)[0])[0],
            Output::LeftForce => self.residual().0.x(),
            Output::LeftMoment => -self.residual().0.y(),
            Output::RightForce => {
                // A force on the clamp itself goes into it.
                let direct = if self.force == Some(zero) { T::one() } else { zero };
                -(self.statics(self.residual().0, zero).1 + direct)
            }
            Output::RightMoment => self.statics(self.residual().0, zero).0,
        }
    }

    /// What the element's rates add to the sums of the fluxes.
    pub(super) fn source(&self) -> Source<T> {
        let solved = self.solved;
        let (element, h, zero) = (solved.element, solved.element.h, T::zero());
        let mut source = Source { load: zero, current: zero, u: zero, q: zero };
        if M::AxialLoad::PRESENT && self.along.is(Parameter::AxialLoad) {
            let axial = element.axial.get();
            source = Source { load: axial.total, u: -axial.stretch, q: axial.charge, ..source };
        }
        if element.conducts_into() {
            // The same points and weights as those of `charging`, of which this is the transposed.
            for (t, weight) in points(&mut solved.splits.clone()) {
                let part = h * weight * self.current(t);
                let (stretch, charge) = element.flexibility.integral(t);
                source.current = source.current + part;
                source.u = source.u - h * part * stretch;
                source.q = source.q - h * part * charge;
            }
        }
        if self.softens() {
            let softening = |t: T| {
                let x = element.x(t);
                self.softening(x, &solved.inverse(x), solved.gradients(t))
            };
            source.u = source.u + h * solved.between(zero, T::one(), |t| softening(t).0);
            source.q = source.q + h * solved.between(zero, T::one(), |t| softening(t).1);
        }
        source
    }

    /// The weights of the unknowns in an output that `output` gives of a rate.
    pub(super) fn weights(solved: &'a Solved<'s, T, M>, i: usize, output: Output<T>) -> Variation<T> {
        let (zero, one) = (T::zero(), T::one());
        let rest = Direction::rest();
        if output == Output::ContactForce {
            // The force depends on the penetration alone, and is its own gradient's integral.
            let ones = Cubic([one, zero, zero, zero]);
            let unit = Rate { eta: ones, ..Rate::new(solved, i, rest, Variation::default()) };
            let (e, d) = work::<T>(solved.element.h, moments(solved, |t| unit.forces(t)[0]));
            return Variation { e, d, ..Variation::default() };
        }
        // Everything is linear: unit rates give the weights.
        let of = |by: Variation<T>| Rate::new(solved, i, rest, by).output(output);
        let along = |e: T::Vec2, d: T::Vec2| of(Variation { e, d, ..Variation::default() });
        let (none, x, y) = (T::Vec2::default(), T::Vec2::of(one, zero), T::Vec2::of(zero, one));
        let mut weights = Variation {
            e: T::Vec2::of(along(x, none), along(y, none)),
            d: T::Vec2::of(along(none, x), along(none, y)),
            ..Variation::default()
        };
        if M::Axial::PRESENT || M::Permittivity::PRESENT {
            let unit = |j: usize| Flow::of(from_fn(|i| if i == j { one } else { zero }));
            weights.left = Flow::of(from_fn(|j| of(Variation { left: unit(j), ..Variation::default() })));
            weights.right = Flow::of(from_fn(|j| of(Variation { right: unit(j), ..Variation::default() })));
        }
        weights
    }
}

/// Moments over t, in the powers 0 to 3, of a force per length.
fn moments<T: Real, M: Model<T>>(solved: &Solved<'_, T, M>, mut force: impl FnMut(T) -> T) -> [T; 4] {
    let mut moments = [T::zero(); 4];
    for (t, weight) in points(&mut solved.splits.clone()) {
        add_moments(&mut moments, t, weight * force(t));
    }
    moments
}

/// Work of a unit force at t on (e, d).
pub(super) fn shapes<T: Real>(h: T, t: T) -> (T::Vec2, T::Vec2) {
    let one = T::one();
    let t2 = t * t;
    let e = T::Vec2::of(t2 * (T::of(3.0) - (t + t)), h * t2 * (one - t));
    (e, T::Vec2::of(one, -(h * t)))
}

/// The weights of the potential's rates at an element's nodes in the work of the conduction force's rate on
/// the deflection `lambda`, with the sign of a load.
pub(super) fn conduction<T: Real, M: Model<T>>(
    solved: &Solved<'_, T, M>,
    lambda: &Cubic<T>,
) -> (Flow<T>, Flow<T>) {
    let (zero, one, element) = (T::zero(), T::one(), solved.element);
    let (mut left, mut right) = (Flow::default(), Flow::default());
    if !element.conducts_onto() {
        return (left, right);
    }
    let bounds = solved.scene.conduction();
    // Hermite's cubics of right value, right slope, left value, left slope.
    let shapes = [
        Cubic::hermite(one, zero, zero, zero),
        Cubic::hermite(zero, one, zero, zero),
        Cubic::hermite(zero, zero, one, zero),
        Cubic::hermite(zero, zero, zero, one),
    ];
    let mut weights = [zero; 4];
    for (t, weight) in points(&mut solved.splits.clone()) {
        let depth = truncate_positive(solved.eta.at(t), bounds.truncation).0;
        let slope = truncate(solved.q.at(t), bounds.potential_truncation).1;
        let part = element.h * weight * element.mu1.at(t) * slope * depth;
        for (weight, shape) in weights.iter_mut().zip(&shapes) {
            *weight = *weight - part * lambda.at(t) * shape.at(t);
        }
    }
    let slope = |t: T, weight: T| {
        let k = element.flexibility.at(t);
        let by = |tau, charge| -(element.h * weight * solved.ratio.gradients::<M>(&k, tau, charge).1);
        (by(one, zero), by(zero, one))
    };
    (right.q, left.q) = (weights[0], weights[2]);
    (right.tau, right.charge) = slope(zero, weights[1]);
    (left.tau, left.charge) = slope(one, weights[3]);
    (left, right)
}

/// The weights of the penetration's rates in the sums of the current, where the rates of u and q across the
/// element weigh `m_u` and `m_q` and the current itself `r`: the transposed of [`Rate::source`].
pub(super) fn charging<T: Real, M: Model<T>>(
    solved: &Solved<'_, T, M>,
    [m_u, m_q, r]: [T; 3],
) -> (T::Vec2, T::Vec2) {
    let (h, element) = (solved.element.h, solved.element);
    if !element.conducts_into() {
        return (T::Vec2::default(), T::Vec2::default());
    }
    let bound = solved.scene.conduction().truncation;
    let force = |t: T| {
        let (depth, slope) = truncate_positive(solved.eta.at(t), bound);
        let (stretch, charge) = element.flexibility.integral(t);
        let worth = r + h * (m_u * stretch + m_q * charge);
        element.mu2.at(t) * (T::of(2.0) * depth * slope) * worth
    };
    work::<T>(h, moments(solved, force))
}
