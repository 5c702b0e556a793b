//! What each element adds to the error of bending.
//!
//! Nodal values of bending are exact but for three things: the contact force inside an element follows its cubic and
//! not the solution; the stiffness varies inside it; Gauss's rule misses a load that is no polynomial, or the force of a
//! curved law at its edge, and a gap's curvature. Each is a small force or kink. How far a force here moves the beam anywhere follows from how
//! far the beam yields here to a uniform load (Maxwell and Betti).

use crate::element::contact::parts;
use crate::element::hermite::Motion;
use crate::law::Compliance;
use crate::profile::{Profile, Smooth};
use crate::quadrature::{POINTS, gauss, integrate};
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::solution::Solved;
use crate::storage::State;

/// Parts that an element is divided into in one pass at most.
const MOST_PARTS: usize = 8;

/// What an element adds to the error of bending anywhere, and how that shrinks when it is divided.
#[derive(Clone, Copy)]
pub(super) struct Share<T> {
    /// The deflection \[m\].
    pub(super) error: T,
    /// Stiffness of the foundation against that of the element: where it is large the error is not yet that of small
    /// elements.
    pub(super) stiff: T,
}

impl<T: Real> Share<T> {
    /// What is left of it on `n` parts together: as 1 / n^4.
    pub(super) fn divided(&self, n: usize) -> T {
        let fourth = T::from(n).unwrap_or(T::one()).powi(-4);
        self.error * fourth * (T::one() + self.stiff) / (T::one() + self.stiff * fourth)
    }

    /// The least number of parts none of which has more than `most`.
    pub(super) fn parts(&self, most: T) -> usize {
        let fits = |n: &usize| self.divided(*n) <= most * T::from(*n).unwrap_or(T::one());
        (1..MOST_PARTS).find(fits).unwrap_or(MOST_PARTS)
    }

    /// That of one element for two neighbours.
    pub(super) fn joined(&self, other: &Self) -> Self {
        let sixteen = T::of(16.0);
        Self { error: sixteen * (self.error + other.error), stiff: sixteen * self.stiff.max(other.stiff) }
    }
}

impl<T: Real, M: Model<T>> Solved<'_, T, M> {
    /// What this element adds to the error of bending. `moved` is how far it moves under the uniform load `load`.
    pub(super) fn share(&self, load: T, moved: &State<T>) -> Share<T> {
        let (element, h) = (self.element, self.element.h);
        let length = self.scene.length();
        let points = [0.0, 0.125, 0.25, 0.5, 0.75, 0.875, 1.0].map(T::of);
        let c = element.stiffness();
        // The foundation's tangent stiffness, and what the penetration's cubic leaves of the load: C eta'''' is the net
        // load less what bends the beam like the gap. Where both cancel the larger one is taken: they may do so by chance.
        let (mut stiffness, mut open) = (T::zero(), T::zero());
        let gap = c * self.gap_bends();
        for t in points {
            let loads = [self.net(t), self.net(t) - gap];
            let net = if loads[1].abs() > loads[0].abs() { loads[1] } else { loads[0] };
            // Between its nodes the beam departs from the cubic; that may be where it touches.
            let room = t * (T::one() - t);
            let depth =
                self.eta.at(t).max(self.eta.at(t) + net * h.powi(4) * room * room / (T::of(24.0) * c));
            let tangent = self.tangent(t, depth);
            // A law that is no number there, or falls, is not for a mesh to hide.
            stiffness = stiffness.max(if tangent.is_nan() { T::infinity() } else { tangent.abs() });
            open = open.max(net.abs());
        }
        let stiff = stiffness * h.powi(4) / (T::of(504.0) * c);
        // The departure is open h^4 t^2 (1 - t)^2 / 24 C; its mean is a thirtieth of that without t.
        let force = stiffness * open * h.powi(5) / (T::of(720.0) * c * (T::one() + stiff));
        // How much a load here moves the beam where it moves most: its mean over the beam is known, and where the
        // beam is held on both sides by the foundation it moves within the layer's width only.
        let yielding = Motion::new(h, moved.e, moved.d).cubic();
        let mean = points.into_iter().fold(T::zero(), |m, t| m.max(yielding.at(t).abs())) / load;
        let mut weight = T::of(3.0) * mean / length;
        if stiff > T::one() && !self.eta.crossings(T::zero()).is_empty() {
            // A contact edge that is not resolved is not yet in its place, and the beam does not yet yield as it will:
            // anywhere in the element there may be the support of a span of the beam's length.
            weight = (T::of(16.0) * weight).max(h * h * length / (T::of(16.0) * c));
        }
        if stiffness > T::zero() {
            let layer = (T::of(4.0) * c / stiffness).sqrt().sqrt().min(length);
            weight = weight.max(layer.powi(3) / (T::of(8.0) * c));
        }
        Share { error: (force + self.misjudged()) * weight + self.unevenness() + self.gap_missed(), stiff }
    }

    /// By how much Gauss's rule misses the load and the force of a curved law: against the rule on halves \[N\].
    fn misjudged(&self) -> T {
        let load = self.scene.load().transverse;
        let [first, rest @ ..] =
            gauss::<POINTS>().map(|(t, _)| load.value(self.element.x(T::of(t)), self.mid));
        let mut sum = T::zero();
        if rest.iter().any(|value| *value != first) {
            sum = missed(T::zero(), T::one(), |t| load.value(self.element.x(t), self.mid));
        }
        if !M::Law::LINEAR {
            let mut splits = self.splits.clone();
            sum = parts(&mut splits).fold(sum, |sum, (a, b)| sum + missed(a, b, |t| self.forces(t)[0]));
        }
        self.element.h * sum
    }

    /// s'''' in the element, by differences of s''.
    fn gap_bends(&self) -> T {
        if !M::Gap::PRESENT {
            return T::zero();
        }
        let gap = self.scene.foundation().gap;
        let curvature = |t: f64| gap.jet(self.element.x(T::of(t)), self.mid)[2];
        let (middle, half) = (curvature(0.5), T::of(0.5) * self.element.h);
        ((curvature(0.0) - middle) - (middle - curvature(1.0))) / (half * half)
    }

    /// By how much Gauss's rule misses the bend of a gap that is no polynomial, as a deflection.
    fn gap_missed(&self) -> T {
        if !M::Gap::PRESENT {
            return T::zero();
        }
        let (h, gap, mid) = (self.element.h, self.scene.foundation().gap, self.mid);
        let curvature = |t: T| gap.jet(self.element.x(t), mid)[2];
        let turn = h * missed(T::zero(), T::one(), curvature);
        let lift = h * h * missed(T::zero(), T::one(), |t| (T::one() - t) * curvature(t));
        self.deflection(lift, turn)
    }

    /// How far a jump of the deflection by `lift` and a kink by `turn` move the beam.
    fn deflection(&self, lift: T, turn: T) -> T {
        // A kink moves the middle of a clamped beam by a quarter of what it would a cantilever's end.
        lift.abs() + T::of(0.25) * self.scene.length() * turn.abs()
    }

    /// What a stiffness that varies inside the element bends it otherwise than its cubic does, as a deflection: the
    /// curvature is the statical moment over the stiffness.
    fn unevenness(&self) -> T {
        let (mid, stiffness) = (self.mid, self.scene.beam().bending);
        let [first, rest @ ..] =
            gauss::<POINTS>().map(|(t, _)| stiffness.value(self.element.x(T::of(t)), mid));
        if rest.iter().all(|c| *c == first) {
            return T::zero();
        }
        let (turn, lift) = self.curvature(T::one());
        let apart = self.bend() - T::Vec2::of(lift, -turn);
        self.deflection(apart.x(), apart.y())
    }
}

/// By how much Gauss's rule on [from, to] misses the integral of `force`: against the rule on halves, but for rounding.
fn missed<T: Real>(from: T, to: T, force: impl Fn(T) -> T) -> T {
    let integral = |from, to| integrate::<T, POINTS>(from, to, &force);
    let (mid, whole) = (from + T::of(0.5) * (to - from), integral(from, to));
    let missed = (integral(from, mid) + integral(mid, to) - whole).abs();
    if missed <= T::of(8.0) * T::epsilon() * whole.abs() { T::zero() } else { missed }
}
