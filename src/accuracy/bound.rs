//! A guaranteed bound on the error of a discrete solution in the energy norm, from statics.
//!
//! Let v be a deflection that satisfies the clamps, delta = xi - v its error, and m^ a moment in equilibrium with the
//! load and the contact forces of v: m^'' = f - p(x, v - s) - mu1 R(q) R~(v - s). Then (subtract the weak forms)
//!
//! ```text
//!     integral C delta''^2 + (contact forces of xi less those of v) delta = integral (m^ - C v'') delta''
//! ```
//!
//! Where the contact force is monotone the second term is not negative, and the energy norm of delta is at most that
//! of (m^ - C v'') / C: Prager and Synge's hypercircle, here the duality gap of the convex problem at the dual pressure
//! p(x, v - s), for which Fenchel's inequality is an equality. Where the potential acts on bending the term is at least
//! -(1 - kappa) times the first, with kappa from Poincare's inequalities ([`Robustness`]), and the bound is divided by
//! kappa.
//!
//! In one dimension m^ is an integral, up to a straight line; the line that makes the bound least is taken.

use crate::certificate;
use crate::cubic::Cubic;
use crate::electric;
use crate::element::contact::parts;
use crate::law::{Compliance, truncate};
use crate::newton::nested::Answer;
use crate::profile::{Piece, Profile, Smooth};
use crate::quadrature::{POINTS, gauss};
use crate::real::{Pair, Real, Sum};
use crate::scene::{self, Model};
use crate::solution::{Solution, Solved};
use crate::storage::Place;
use arrayvec::ArrayVec;

/// What bounds the errors of a solution, and the solution's own size: energy norms \[J^(1/2)\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds<T> {
    pub(super) bending: T,
    pub(super) bending_size: T,
    pub(super) electric: T,
    pub(super) electric_size: T,
}

/// The two sides of the bound: energy norms, the root of an integral of moments squared over C \[J^(1/2)\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Imbalance<T> {
    /// Of the statical moment less that of the deflection, and what rounding may hide of it.
    pub(super) mismatch: T,
    /// The latter.
    pub(super) rounding: T,
    /// Of the deflection.
    pub(super) size: T,
}

/// How much of the energy norm a change of the contact forces leaves: 1 where they are monotone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Robustness<T> {
    pub(super) bending: T,
    pub(super) electric: T,
}

/// Moment and shear along the beam, from the left \[N m, N\].
struct Statics<T> {
    moment: Sum<T>,
    shear: Sum<T>,
}

/// The statical moment against that of the deflection s + eta, in the states that `answer` left in `places`. Each
/// element's part of the mismatch, squared, goes into its spare state.
///
/// # Cost
/// One pass; four evaluations of the load and the contact force and five of the stiffness between two kinks.
pub(super) fn imbalance<T: Real, M: Model<T>>(
    scene: &M,
    places: &mut [Place<T, M>],
    answer: &Answer<T, M>,
) -> Imbalance<T> {
    let length = scene.length();
    let mut statics = Statics { moment: Sum::default(), shear: Sum::default() };
    let (mut size, mut mismatch, mut largest) = (Sum::<T>::default(), Sum::<T>::default(), T::zero());
    // Of the straight line a + b x: what 1, x do to each other and to the mismatch.
    let (mut grams, mut works) = ([Sum::<T>::default(); 3], [Sum::<T>::default(); 2]);
    for i in 0..places.len() {
        let solution = Solution::new(scene, &*places, *answer);
        let solved = solution.solved(i);
        let (element, h) = (solved.element, solved.element.h);
        if i == 0 {
            statics = Statics { moment: Sum::from(-solved.held.y()), shear: Sum::from(solved.held.x()) };
        }
        let mut own = T::zero();
        let mut splits = solved.splits.clone();
        let pieces: ArrayVec<(T, T), 15> = parts(&mut splits).collect();
        for &(a, b) in pieces.iter().rev() {
            let t = |z: f64| a + (b - a) * T::of(z);
            let piece = h * (b - a);
            let net = Cubic::from_samples(gauss::<POINTS>().map(|(z, _)| net(&solved, t(z))));
            let along = Along::new(&net, piece, &statics);
            for (z, weight) in gauss::<5>() {
                let (t, x) = (t(z), element.x(t(z)));
                let c = scene.beam().bending.value(x, solved.mid);
                let curvature =
                    scene.foundation().gap.jet(x, solved.mid)[2] + solved.eta.curvature(t) / h / h;
                let (bent, moment) = (c * curvature, along.moment(T::of(z)));
                let (open, part) = (moment - bent, T::of(weight) * piece / c);
                largest = largest.max(moment.abs());
                size.add(part * bent * bent);
                own = own + part * open * open;
                let line = x / length;
                for (sum, power) in grams.iter_mut().zip([T::one(), line, line * line]) {
                    sum.add(part * power);
                }
                for (sum, power) in works.iter_mut().zip([T::one(), line]) {
                    sum.add(part * power * open);
                }
            }
            along.carry(&mut statics);
        }
        mismatch.add(own);
        for point in scene::points_at(scene, element.right - element.h, element.right) {
            statics.shear.add(point.force);
            statics.moment.add(-point.moment);
        }
        places[i].work.states[1 - answer.state].e = T::Vec2::of(own, T::zero());
    }
    let [one, x, xx] = grams.map(Sum::value);
    let [by_one, by_x] = works.map(Sum::value);
    let spared =
        (by_one * by_one * xx - T::of(2.0) * by_one * by_x * x + by_x * by_x * one) / (one * xx - x * x);
    let rounding = answer.report.floor * largest * one.sqrt();
    Imbalance {
        mismatch: (mismatch.value() - spared).max(T::zero()).sqrt() + rounding,
        rounding,
        size: size.value().sqrt(),
    }
}

impl<T: Real, M: Model<T>> Solution<'_, T, M> {
    /// Bounds on the errors of bending, and of stretching and potential.
    ///
    /// u and q are exact for the penetration at hand, so only its error delta reaches them, through the current:
    /// the energy of their error is the integral of mu2 (R~(eta)^2 - R~(v - s)^2) (q - q_h), the skew coupling by P
    /// cancels. The current's error is at most 2 mu2 A |delta|, A the mean penetration of both.
    pub(super) fn bounds(
        &self,
        Imbalance { mismatch, size, .. }: Imbalance<T>,
        kappa: Robustness<T>,
    ) -> Bounds<T> {
        let bending = mismatch / kappa.bending;
        let electric = match (electric::conducts_onto(self.places), electric::conducts_into(self.places)) {
            (_, false) => T::zero(),
            (true, true) => T::of(0.5) * mismatch / (kappa.bending * kappa.electric).sqrt(),
            (false, true) => {
                let (beam, conduction) = (self.scene().beam(), self.scene().conduction());
                let length = self.scene().length();
                // A force at midspan bends a clamped beam most: by F L^3 / (192 C).
                let softest = certificate::range(beam.bending, self.places).0;
                let largest = bending * (length * length * length / (T::of(192.0) * softest)).sqrt();
                let deepest = (self.deepest() + T::of(0.5) * largest).min(conduction.truncation);
                let current =
                    T::of(2.0) * certificate::range(conduction.mu2, self.places).1 * deepest * bending;
                let c1 = certificate::poincare(length)[0];
                let permittivity = certificate::range(beam.permittivity, self.places).0;
                c1 * current * (self.held_by_beam() / permittivity).sqrt()
            }
        };
        let electric_size = self.electric_size();
        Bounds {
            bending,
            bending_size: size,
            electric: electric + self.report().floor * electric_size,
            electric_size,
        }
    }

    /// The largest penetration, from above: by control values \[m\].
    fn deepest(&self) -> T {
        (0..self.places.len()).fold(T::zero(), |most, i| most.max(self.solved(i).eta.hull()))
    }

    /// The energy norm of stretching and potential.
    fn electric_size(&self) -> T {
        let mut size = Sum::<T>::default();
        for i in 0..self.places.len() {
            let solved = self.solved(i);
            for (z, weight) in gauss::<POINTS>() {
                let energy = density(&solved, T::of(z), solved.gradients(T::of(z)));
                size.add(T::of(weight) * solved.element.h * energy);
            }
        }
        size.value().sqrt()
    }

    /// The constants of monotonicity; `None` where the theory gives none.
    ///
    /// With conduction in both directions they are 1 - 1 / margin of both parts of (2.15). Where the potential does not
    /// feel the beam it is known, and bending is monotone where k + mu1 R(q) >= 0; what is missing is held by the
    /// beam, as the integral of delta^2 is at most c2^2 times that of delta''^2.
    pub(super) fn robustness(&self) -> Option<Robustness<T>> {
        let one = T::one();
        let (onto, into) = (electric::conducts_onto(self.places), electric::conducts_into(self.places));
        let (bending, electric) = match (onto, into) {
            (false, _) => (one, one),
            (true, false) => (one - self.pull() * self.held_by_beam(), one),
            (true, true) => {
                let margins = self.uniqueness();
                let spared = |margin: Option<T>| one - margin.map_or(T::zero(), T::recip);
                (spared(margins.margin_bending), spared(margins.margin_electric))
            }
        };
        (bending > T::zero() && electric > T::zero()).then_some(Robustness { bending, electric })
    }

    /// The largest integral of delta^2 whose energy norm is one: c2^2 / min C \[m^2/J m\].
    pub(super) fn held_by_beam(&self) -> T {
        let c2 = certificate::poincare(self.scene().length())[1];
        c2 * c2 / certificate::range(self.scene().beam().bending, self.places).0
    }

    /// The largest stiffness with which the foundation pulls where the potential is negative \[N/m^2\].
    fn pull(&self) -> T {
        let bounds = self.scene().conduction();
        let mut most = T::zero();
        for i in 0..self.places.len() {
            let solved = self.solved(i);
            for t in [0.0, 0.25, 0.5, 0.75, 1.0].map(T::of) {
                let x = solved.element.x(t);
                let drive =
                    bounds.mu1.value(x, solved.mid) * truncate(solved.q.at(t), bounds.potential_truncation).0;
                // Beyond its truncation the potential's part does not grow, and a curved law need not resist at first.
                let k = if M::Law::LINEAR { solved.element.law.at(t) } else { T::zero() };
                most = most.max(-(drive + k));
            }
        }
        most
    }
}

/// Twice the energy per length EA u'^2 + eps q'^2 of gradients (u', q') at t \[N\].
pub(super) fn density<T: Real, M: Model<T>>(solved: &Solved<'_, T, M>, t: T, (u, q): (T, T)) -> T {
    let (beam, x) = (solved.scene.beam(), solved.element.x(t));
    beam.axial.value(x, solved.mid) * u * u + beam.permittivity.value(x, solved.mid) * q * q
}

/// Transverse load less contact at t, with the potential as it is and not its cubic \[N/m\].
fn net<T: Real, M: Model<T>>(solved: &Solved<'_, T, M>, t: T) -> T {
    solved.net_by(t, || if solved.element.conducts_onto() { solved.potential(t) } else { T::zero() })
}

/// A stretch of the beam between two kinks, z = 0 at its right end and 1 at its left one.
struct Along<T> {
    net: Cubic<T>,
    length: T,
    /// At the left end.
    moment: T,
    shear: T,
}

impl<T: Real> Along<T> {
    fn new(net: &Cubic<T>, length: T, left: &Statics<T>) -> Self {
        Self { net: *net, length, moment: left.moment.value(), shear: left.shear.value() }
    }

    /// The integral over [0, z] of the integral of the load.
    fn twice(&self, z: T) -> T {
        let [c0, c1, c2, c3] = self.net.0;
        let n = |x: f64| T::of(1.0 / x);
        z * z * (n(2.0) * c0 + z * (n(6.0) * c1 + z * (n(12.0) * c2 + z * (n(20.0) * c3))))
    }

    /// The integral over [z, 1] of the shear that the load adds from the left end on, over the length.
    fn lever(&self, z: T) -> T {
        let whole = Piece::integral(&self.net, T::one());
        whole * (T::one() - z) - (self.twice(T::one()) - self.twice(z))
    }

    fn moment(&self, z: T) -> T {
        self.moment + self.length * (self.shear * (T::one() - z) + self.length * self.lever(z))
    }

    /// On to the right end.
    fn carry(&self, statics: &mut Statics<T>) {
        statics.moment.add(self.length * self.shear);
        statics.moment.add(self.length * self.length * self.lever(T::zero()));
        statics.shear.add(self.length * Piece::integral(&self.net, T::one()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statics_integrate_the_load_twice() {
        // n = 1 + 2 z - 3 z^2 + 4 z^3 over a length of 2, from the left end, z = 1, on.
        let net = Cubic([1.0, 2.0, -3.0, 4.0]);
        let mut statics = Statics { moment: Sum::from(5.0), shear: Sum::from(-7.0) };
        let along = Along::new(&net, 2.0, &statics);
        let steps = 20_000;
        let (mut moment, mut shear) = (5.0, -7.0);
        for i in 0..steps {
            let dx = 2.0 / f64::from(steps);
            let z = 1.0 - (f64::from(i) + 0.5) / f64::from(steps);
            moment += dx * (shear + 0.5 * dx * net.at(z));
            shear += dx * net.at(z);
            if i == steps / 2 - 1 {
                assert!((along.moment(0.5) - moment).abs() < 1e-7);
            }
        }
        along.carry(&mut statics);
        assert!((statics.moment.value() - moment).abs() < 1e-7);
        assert!((statics.shear.value() - shear).abs() < 1e-7);
        assert!((along.moment(0.0) - statics.moment.value()).abs() < 1e-14);
    }
}
