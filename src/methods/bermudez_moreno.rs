//! The algorithm (3.3) of Bermúdez and Moreno, *Duality methods for solving variational inequalities* (1981).
//!
//! The law p = G(eta) is written as omega eta plus a multiplier, p - omega eta, so that every iteration solves a
//! beam on a foundation of stiffness omega which also holds where it is lifted:
//!
//! ```text
//!     (C xi_n'')'' + omega eta_n  = f - p_n - conduction
//!     p_(n+1) = p_n + rho (G_mu(eta_n + mu p_n) - p_n)
//! ```
//!
//! with the Yosida regularisation of G - omega, by its resolvent y:
//!
//! ```text
//!     G_mu(r) = (r - y) / mu,   y the root of  (1 - mu omega) y + mu G(y) = r
//! ```
//!
//! p = G_mu(eta + mu p) is the same as p = G(eta) - omega eta, so a fixed point is a solution, whatever omega and mu.
//! G lives at the Gauss points, which decides contact there: the fixed point is that of [`super::gauss`].
//!
//! *Stability.* As G does not decrease, the slope of G_mu is at least -omega / (1 - mu omega) and below 1 / mu. It
//! is between -1 / mu and 1 / mu just if mu omega <= 1/2, which is required.
//!
//! *The rate, and the defaults.* Take mu = 1 / (2 omega). A mode of the beam with the stiffness a per length answers
//! p with -1 / (a + omega), so eta + mu p has the factor mu (a - omega) / (a + omega), and G_mu has (g - omega) /
//! (g + omega) / mu, where g is k in contact and 0 elsewhere. An iteration multiplies an error by
//!
//! ```text
//!     1 - rho + rho (g - omega) / (g + omega) (a - omega) / (a + omega)
//! ```
//!
//! a runs from the first mode's a1 = 4.73^4 C / L^4 to infinity. Slow are low modes where the beam is lifted,
//! 1 - 2 rho a1 / (a1 + omega), and high ones in contact, 1 - 2 rho omega / (k + omega): the same for
//! omega = sqrt(a1 k). High modes where the beam is lifted give 1 - 2 rho, which is of the same size for
//!
//! ```text
//!     rho = (1 + s) / (1 + 2 s),   s = sqrt(a1 / k)
//! ```
//!
//! Then all are at most 1 / (1 + 2 s): about ln(1 / stop) / (2 s) iterations, 7000 for k L^4 / C = 2e8 and 1e-10. A
//! foundation softer than the beam, k < a1, is taken for one of a1: errors fall to a third at least.

use super::{Linear, Sight};
use crate::element::contact::Fault;
use crate::error::{Error, Place as At, expect};
use crate::law::Compliance;
use crate::profile::Piece;
use crate::quadrature::POINTS;
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::storage::Place;

/// What the algorithm (3.3) leaves open; `None` is the default, which depends on the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BermudezMoreno<T> {
    /// Stiffness omega > 0 that the linear problems have everywhere \[N/m^2\]. Default sqrt(a1 k): a1 =
    /// 4.73^4 C / L^4 is the stiffness of the clamped beam's first mode, C the largest bending stiffness, k the
    /// largest stiffness of the foundation and at least a1.
    pub omega: Option<T>,
    /// Parameter mu > 0 of the Yosida regularisation \[m^2/N\], at most and by default 1 / (2 omega).
    pub mu: Option<T>,
    /// Share rho of each update that is taken, above 0 and at most 1. Default (1 + s) / (1 + 2 s), s = sqrt(a1 / k).
    pub rho: Option<T>,
}

/// The parameters in numbers.
pub(super) struct Parameters<T> {
    omega: T,
    mu: T,
    rho: T,
}

/// 4.730040744862704^4: the first root of the clamped beam.
const FIRST_MODE: f64 = 500.563_901_740_433_3;
/// Halvings and Newton steps for one resolvent.
const STEPS: usize = 200;

impl<T: Real> BermudezMoreno<T> {
    /// The parameters in the scene that was laid into `places`.
    pub(super) fn parameters<M: Model<T>>(
        &self,
        model: &M,
        places: &[Place<T, M>],
    ) -> Result<Parameters<T>, Error> {
        let one = T::one();
        let bending = places.iter().fold(T::zero(), |most, place| {
            most.max(place.element.bending.yy * place.element.h * T::of(0.25))
        });
        let first = T::of(FIRST_MODE) * bending / model.length().powi(4);
        let stiffness = stiffness(model, places).max(first);
        let omega = self.omega.unwrap_or(first.sqrt() * stiffness.sqrt());
        let positive = |value: T| value > T::zero() && value.is_finite();
        expect(positive(omega), "omega", At::Whole, "a finite number > 0", omega)?;
        let most = T::of(0.5) / omega;
        let mu = self.mu.unwrap_or(most);
        let within = positive(mu) && mu <= most * (one + T::of(8.0) * T::epsilon());
        expect(within, "mu", At::Whole, "a number above 0 and at most 1 / (2 omega)", mu)?;
        let s = (first / stiffness).sqrt();
        let rho = self.rho.unwrap_or((one + s) / (one + s + s));
        expect(rho > T::zero() && rho <= one, "rho", At::Whole, "a number above 0 and at most 1", rho)?;
        Ok(Parameters { omega, mu, rho })
    }
}

/// The foundation's largest stiffness: a linear law's own; of another law p / r where it would carry the mean load.
fn stiffness<T: Real, M: Model<T>>(model: &M, places: &[Place<T, M>]) -> T {
    let load = places.iter().fold(T::zero(), |sum, place| sum + place.element.fr.x().abs()) / model.length();
    places.iter().fold(T::zero(), |most, Place { element, .. }| {
        let middle = T::of(0.5);
        let k = element.law.at(middle);
        if M::Law::LINEAR {
            return most.max(k);
        }
        let pressure = |r: T| model.foundation().law.pressure(k, element.x(middle), r).0;
        // Bisection in the exponent, between penetrations that no scene goes beyond.
        let (mut low, mut high) = (T::of(1e-15) * model.length(), T::of(1e3) * model.length());
        for _ in 0..60 {
            let r = (low * high).sqrt();
            *(if pressure(r) < load { &mut low } else { &mut high }) = r;
        }
        let found = pressure(high) / high;
        if found.is_finite() { most.max(found) } else { most }
    })
}

impl<T: Real> Parameters<T> {
    /// Stiffness omega and the force of multiplier and conduction, the latter of the last penetration.
    pub(super) fn linear<M: Model<T>>(
        &self,
        sight: &Sight<'_, T, M>,
        multiplier: [T; POINTS],
    ) -> Result<Linear<T>, Fault> {
        sight.map(|point, r| {
            let force = multiplier[point] + sight.conduction(point, r.max(T::zero())).0;
            Ok((self.omega, -force))
        })
    }

    /// The next multiplier, of the new penetration.
    pub(super) fn update<M: Model<T>>(
        &self,
        sight: &Sight<'_, T, M>,
        multiplier: [T; POINTS],
    ) -> Result<[T; POINTS], Fault> {
        sight.map(|point, eta| {
            let p = multiplier[point];
            let yosida = self.yosida(eta + self.mu * p, |r| sight.law(point, r))?;
            Ok(p + self.rho * (yosida - p))
        })
    }

    /// p = omega eta + multiplier.
    pub(super) fn pressures<M: Model<T>>(
        &self,
        sight: &Sight<'_, T, M>,
        multiplier: [T; POINTS],
    ) -> [T; POINTS] {
        let mut pressures = sight.penetration();
        for (pressure, p) in pressures.iter_mut().zip(multiplier) {
            *pressure = self.omega * *pressure + p;
        }
        pressures
    }

    /// G_mu(r), where `law` is (p, dp/dr).
    fn yosida(&self, r: T, law: impl Fn(T) -> Result<(T, T), Fault>) -> Result<T, Fault> {
        let slack = T::one() - self.mu * self.omega;
        if r <= T::zero() {
            // y = r / (1 - mu omega), written without a difference.
            return Ok(-(self.omega / slack) * r);
        }
        // (1 - mu omega) y + mu G(y) - r rises from -r at 0; at r / (1 - mu omega) it is mu G >= 0.
        let (mut low, mut high) = (T::zero(), r / slack);
        let mut y = high;
        for _ in 0..STEPS {
            let (p, slope) = law(y)?;
            let value = slack * y + self.mu * p - r;
            *(if value > T::zero() { &mut high } else { &mut low }) = y;
            let newton = y - value / (slack + self.mu * slope);
            let next = if newton >= low && newton <= high { newton } else { T::of(0.5) * (low + high) };
            if (next - y).abs() <= T::epsilon() * next {
                y = next;
                break;
            }
            y = next;
        }
        // (r - y) / mu = G(y) - omega y
        Ok(law(y)?.0 - self.omega * y)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
    use super::*;
    use proptest::prelude::*;

    /// k r^a, as a law that a resolvent sees: for r > 0 only.
    fn power(k: f64, a: f64) -> impl Fn(f64) -> Result<(f64, f64), Fault> {
        move |r| {
            assert!(r > 0.0);
            Ok((k * r.powf(a), k * a * r.powf(a - 1.0)))
        }
    }

    proptest! {
        #[test]
        fn a_fixed_point_is_the_law_and_the_regularisation_is_lipschitz(
            k in -3.0..12.0_f64,
            a in 1.0..3.0_f64,
            omega in -2.0..8.0_f64,
            share in 0.01..1.0_f64,
            eta in -2.0..2.0_f64,
            other in -2.0..2.0_f64,
        ) {
            let (k, omega) = (10f64.powf(k), 10f64.powf(omega));
            let with = Parameters { omega, mu: 0.5 * share / omega, rho: 1.0 };
            let law = power(k, a);
            let force = |eta: f64| if eta > 0.0 { k * eta.powf(a) } else { 0.0 };
            // p = G(eta) - omega eta  <=>  p = G_mu(eta + mu p)
            let p = force(eta) - omega * eta;
            let size = force(eta) + omega * eta.abs();
            let got = with.yosida(eta + with.mu * p, &law).unwrap();
            prop_assert!((got - p).abs() <= 1e-12 * size, "{got} for {p}");
            // |G_mu(r) - G_mu(r')| <= |r - r'| / mu
            let (r, s) = (with.yosida(eta, &law).unwrap(), with.yosida(other, &law).unwrap());
            let slack = 1e-12 * (r.abs() + s.abs());
            prop_assert!((r - s).abs() <= (eta - other).abs() / with.mu + slack);
        }
    }

    #[test]
    fn a_linear_law_has_the_regularisation_of_the_book() {
        let with = Parameters { omega: 3.0, mu: 1.0 / 8.0, rho: 1.0 };
        let slope = (7.0 - 3.0) / (1.0 - 3.0 / 8.0 + 7.0 / 8.0);
        assert!((with.yosida(2.0, power(7.0, 1.0)).unwrap() - 2.0 * slope).abs() < 1e-14);
        assert!((with.yosida(-2.0, power(7.0, 1.0)).unwrap() - 2.0 * 3.0 / (1.0 - 3.0 / 8.0)).abs() < 1e-14);
    }
}
