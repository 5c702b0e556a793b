//! The monolithic Newton method on (w, theta, u, q), for where the potential acts on bending.
//!
//! u and q follow from the penetration without any error ([`crate::electric`]), so the residual is one of
//! bending alone. Its derivative needs u and q as unknowns to stay local: the 4x4 blocks of
//! [`crate::element::coupled`], condensed from the left in the same recursion as bending. A sweep solves for
//! an increment, whose data are what is open of compatibility and of equilibrium, as [`Level::polish`] does.
//!
//! *When.* While the fixed point (u, q from the last penetration, one Newton step for bending) gains a digit a
//! round it is cheaper, and is kept; [`Level::descend`] gives up where it does not and the coupling may be why.
//!
//! *Globalised by work.* No norm of the residual serves as a merit: where the conduction force outweighs the
//! foundation (mu1 R(q) < -k) the beam snaps towards it, and on the way every norm grows. But the work of the
//! residual along a step says whether the step goes where the forces pull: with the potential as it is it is
//! the derivative of the energy. A Newton step along which the residual would do positive work leads back to an unstable
//! equilibrium, or to the ghost of one; then the step with the tangent's nondecreasing part alone is
//! taken, which is symmetric, positive definite but for the coupling, and always downhill: the concave part
//! of the energy is taken as linear (the convex-concave procedure). Either step goes as far as the forces
//! pull, beyond its full length too, so that a snap through takes a few steps. A solution exists, as the
//! terms that are not monotone are bounded; beyond (2.15) it need not be the only one.

use super::{Context, Count, Halt, Level, Outcome, Residual};
use crate::electric;
use crate::element::contact::{Contact, Tangent};
use crate::element::coupled::Coupling;
use crate::element::hermite::Motion;
use crate::law::{Compliance, truncate, truncate_positive};
use crate::profile::{Piece, Profile, Slot};
use crate::real::{Pair, Quad, Real};
use crate::scene::Model;
use crate::storage::{Place, State};
use crate::sweep::quad::Coupled;
use crate::sweep::{Condensed, End};

/// Share of a change that comes back through the potential from which on slow progress is laid to it.
const TIED: f64 = 0.1;
/// A step is never taken farther than so many times its length, however far the forces pull.
const FARTHEST: f64 = 1e6;
/// Share of the work at its start that a searched step may leave.
const SLACK: f64 = 0.2;
/// Evaluations to find where a step's work ends.
const SEARCHES: usize = 20;

/// The state at some length of a step.
#[derive(Clone, Copy)]
struct Trial<T: Real> {
    residual: Residual<T>,
    /// Of the residual along the step; negative where the forces pull on.
    work: T,
    /// By how much the left end has to move.
    open: T::Vec2,
}

impl<T: Real, M: Model<T>> Level<'_, '_, T, M> {
    /// Is bending tied to the potential so closely that the fixed point may be slow, or does the foundation
    /// attract the beam more than the beam resists? If neither, slow progress is that of the contact's edge.
    ///
    /// The first by an estimate of the share of a change of the penetration that comes back through the
    /// potential in a round: a current 2 mu2 R~ eta lifts the potential by at most L^2 / (8 eps) times it, that
    /// makes a force mu1 R~ q, which bends a clamped beam by at most L^4 / (384 C) times it.
    pub(super) fn is_tied(&self) -> bool {
        let Context { model, ref onto, into, .. } = *self.context;
        if !M::Mu1::PRESENT || onto.is_none() {
            return false;
        }
        let bounds = model.conduction();
        let zero = T::zero();
        let (mut drive, mut current, mut resistance, mut attraction) = (zero, zero, zero, zero);
        let mut softest = T::infinity();
        let mut left = self.node.q.get();
        for Place { element, work } in self.places.iter() {
            let right = work.node.q.get();
            let least = truncate(left.min(right), bounds.potential_truncation).0;
            let law = if M::Law::LINEAR { element.law.mean() } else { zero };
            attraction = attraction.max(-(law + element.mu1.mean() * least));
            let State { e, d } = work.states[self.current];
            let r = truncate_positive(d.x().max(d.x() + e.x()), bounds.truncation).0;
            drive = drive.max(element.mu1.mean() * r);
            current = current.max(element.mu2.mean() * r);
            resistance = resistance.max(element.flexibility.mean().qq);
            softest = softest.min(element.stiffness());
            left = right;
        }
        let square = model.length() * model.length();
        let lift = if into { current * resistance * square / T::of(4.0) } else { zero };
        let moved = |force: T| force * square / T::of(384.0) * square > T::of(TIED) * softest;
        moved(drive * lift) || moved(attraction)
    }

    /// Newton's steps from the current state until the relative residual is at most `stop`.
    pub(super) fn descend_coupled(
        &mut self,
        scale: T,
        stop: T,
        most: usize,
        count: &mut Count,
    ) -> Result<Outcome, Halt> {
        let mut here = self.trial(scale, count)?;
        let mut rounds_since_best = 0;
        for _ in 0..most {
            let before = here.residual;
            self.best = Some((self.current, before));
            if before.relative() <= stop {
                return Ok(Outcome::Converged);
            }
            if before.relative() <= T::of(4.0) * before.floor() && rounds_since_best >= 2 {
                return Ok(Outcome::Floor);
            }
            let mut start = match self.coupled_step(here.open, scale, Tangent::Whole, count) {
                Err(Halt::Breakdown(_)) => T::zero(),
                start => start?,
            };
            if start >= T::zero() {
                start = self.coupled_step(here.open, scale, Tangent::Nondecreasing, count)?;
            }
            here = self.go(T::one(), scale, count)?;
            if here.residual.mismatch > T::of(0.5) * before.mismatch && start < T::zero() {
                here = self.search(start, here, scale, count)?;
            }
            let better = here.residual.mismatch < T::of(0.9) * before.mismatch;
            rounds_since_best = if better { 0 } else { rounds_since_best + 1 };
        }
        self.best = Some((self.current, here.residual));
        Ok(if here.residual.relative() <= stop { Outcome::Converged } else { Outcome::Stalled })
    }

    /// What the current state leaves open, and the work of that along the last step.
    fn trial(&mut self, scale: T, count: &mut Count) -> Result<Trial<T>, Halt> {
        count.spend(self.places.len())?;
        let open = self.join_nodes();
        self.renew();
        let residual = self.balance(scale)?;
        let work = self.places.iter().fold(T::zero(), |sum, Place { work, .. }| {
            sum + work.link().map_or(T::zero(), |link| work.open.times(link.step.e))
        });
        Ok(Trial { residual, work, open })
    }

    /// The state a share t of the last step away from the best one.
    fn go(&mut self, t: T, scale: T, count: &mut Count) -> Result<Trial<T>, Halt> {
        let base = self.best.map_or(self.current, |(best, _)| best);
        let target = 1 - base;
        for Place { work, .. } in self.places.iter_mut() {
            let step = work.link().map_or_else(State::default, |link| link.step);
            work.states[target] = work.states[base].plus(step, t);
        }
        (self.current, self.located) = (target, false);
        self.trial(scale, count)
    }

    /// Goes along the last step, whose work was `start` at its beginning and that of `end` at its full length,
    /// to where it has no more work to do: the root of the work, bracketed by doubling and found by the
    /// Illinois method.
    fn search(&mut self, start: T, mut end: Trial<T>, scale: T, count: &mut Count) -> Result<Trial<T>, Halt> {
        let small = T::of(SLACK) * start.abs();
        let (two, half) = (T::of(2.0), T::of(0.5));
        let (mut low, mut high) = ((T::zero(), start), (T::one(), end.work));
        while high.1 < -small && high.0 < T::of(FARTHEST) {
            low = high;
            end = self.go(two * high.0, scale, count)?;
            high = (two * high.0, end.work);
        }
        for round in 0..SEARCHES {
            if end.work.abs() <= small || high.1 <= T::zero() {
                break;
            }
            let falsi = low.0 - low.1 * ((high.0 - low.0) / (high.1 - low.1));
            let bisect = round % 3 == 2 || !(falsi > low.0 && falsi < high.0);
            let t = if bisect { half * (low.0 + high.0) } else { falsi };
            end = self.go(t, scale, count)?;
            // Illinois: the end that stays is weighted less, so that it does not stay for good.
            if end.work < T::zero() {
                low = (t, end.work);
                high.1 = half * high.1;
            } else {
                high = (t, end.work);
                low.1 = half * low.1;
            }
        }
        Ok(end)
    }

    /// The step at the current state, into the links; `open` is by how much the left end has to move. The work of
    /// the residual at its beginning.
    #[inline(never)]
    fn coupled_step(
        &mut self,
        open: T::Vec2,
        scale: T,
        tangent: Tangent,
        count: &mut Count,
    ) -> Result<T, Halt> {
        count.spend(self.places.len())?;
        count.iterations += 1;
        self.locate();
        let Context { model, ref onto, .. } = *self.context;
        let clamped = |value: T::Vec2| End::<T, Coupled> {
            held: [true; 4],
            value: T::Vec4::of([value.x(), value.y(), T::zero(), T::zero()]),
            condensed: Condensed::default(),
        };
        let (left, right) = (clamped(open), clamped(T::Vec2::default()));
        let (current, last) = (self.current, self.places.len() - 1);
        let scale = self.scaling(scale);
        let mut node = self.node;
        let mut part = left.condensed;
        for (i, Place { element, work }) in self.places.iter_mut().enumerate() {
            let State { e, d } = work.states[current];
            let motion = Motion::new(element.h, e, d);
            let q = onto.as_ref().map(|ratio| electric::potential(element, &node, &work.node, ratio));
            let q = q.unwrap_or_default();
            let contact = match tangent {
                Tangent::Whole => {
                    Contact::touching(work.touch(), model, element, &motion, Some(|| q), scale(i))
                }
                Tangent::Nondecreasing => Contact::nondecreasing(model, element, &motion, &q, scale(i)),
            }
            .map_err(|fault| Halt::Law(i, fault))?;
            let coupling = Coupling::at(model, element, &motion.cubic(), &q);
            let stamp = coupling.stamp(element, &contact, -work.open);
            let h = element.h;
            let absorbed = if i == 0 { left.join(&part, &stamp, h) } else { part.absorb(&stamp, h) };
            let (next, factor) = absorbed.ok_or(Halt::Breakdown(i))?;
            part = next;
            node = work.node;
            if let Some(link) = work.link_mut() {
                link.factor = factor;
            }
        }
        let mut near = right.close(&part).ok_or(Halt::Breakdown(last))?;
        let mut along = T::zero();
        for Place { element, work } in self.places.iter_mut().rev() {
            let open = work.open;
            if let Some(link) = work.link_mut() {
                let (e, far) = link.factor.substitute(near, element.h);
                let ([ew, et, ..], [w, theta, ..]) = (e.array(), near.array());
                link.step = State { e: T::Vec2::of(ew, et), d: T::Vec2::of(w, theta) };
                along = along + open.times(link.step.e);
                near = far;
            }
        }
        Ok(along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::electric::Ratio;
    use crate::element::Element;
    use crate::newton::nested::clamp;
    use crate::{
        Beam, Conduction, Foundation, Function, Linear, Load, Mesh, Polynomial, Potential, Power, Scene,
    };
    use std::vec::Vec;

    /// A level of `model` on a uniform mesh, in a state with eta = 0, eta = M and q = -Mq inside.
    fn on_level<M: Model<f64>>(model: &M, n: usize, look: impl FnOnce(&mut Level<'_, '_, f64, M>)) {
        let mut places: Vec<Place<f64, M>> = Vec::new();
        Mesh::uniform(n)
            .lay(model, |left, right, stop| {
                let element = Element::sample(model, left, right, stop)?;
                places.push(Place { element, ..Place::default() });
                Ok(())
            })
            .unwrap();
        let context = Context {
            model,
            left: clamp(model, 0.0, 0.1),
            right: clamp(model, model.length(), 0.9),
            onto: Some(Ratio::of(&places[0].element)),
            into: true,
            quiet: 0.0,
        };
        let mut level = Level::new(&context, &mut places);
        let mut count = Count { iterations: 0, visits: 0, most_visits: 1_000_000 };
        assert!(level.free(&mut count).is_ok());
        look(&mut level);
    }

    /// F(x + t step) + (t - 1) F(x), over F(x): of the order t^2 if and only if the tangent is exact.
    fn departure<M: Model<f64>>(level: &mut Level<'_, '_, f64, M>, t: f64) -> f64 {
        let mut count = Count { iterations: 0, visits: 0, most_visits: 1_000_000 };
        level.best = None;
        let here = level.trial(1.0, &mut count).unwrap();
        level.best = Some((level.current, here.residual));
        level.coupled_step(here.open, 1.0, Tangent::Whole, &mut count).unwrap();
        let loads =
            |level: &Level<'_, '_, f64, M>| -> Vec<_> { level.places.iter().map(|p| p.work.open).collect() };
        let before = loads(level);
        level.go(t, 1.0, &mut count).unwrap();
        let after = loads(level);
        let worst = |list: &mut dyn Iterator<Item = f64>| list.fold(0.0_f64, |m, x| m.max(x.abs()));
        let size = worst(&mut before.iter().map(|load| load.y));
        let gap = worst(&mut before.iter().zip(&after).map(|(b, a)| a.y + (t - 1.0) * b.y));
        level.current = 1 - level.current;
        gap / size
    }

    fn is_exact<M: Model<f64>>(model: &M) {
        on_level(model, 13, |level| {
            let (far, near) = (departure(level, 1e-3), departure(level, 1e-4));
            assert!(far < 1e-3, "{far:e}");
            assert!(near < 0.02 * far, "{far:e} {near:e}");
        });
    }

    #[test]
    fn the_tangent_is_the_derivative_of_the_residual() {
        let load = Load { transverse: Function(|x: f64| 900.0 * (5.0 * x).sin()), axial: 3.0, points: () };
        let ends = Potential { left: -1.5, right: 0.8 };
        let gap = Polynomial(&[0.0, 0.0, 0.4, -0.8, 0.4]);
        let varied = Scene::new(
            1.0,
            Beam {
                bending: Function(|x: f64| 1.0 + 0.3 * x),
                axial: Function(|x: f64| 2.0 + (3.0 * x).sin()),
                piezo: Function(|x: f64| 0.7 - 1.1 * x),
                permittivity: Function(|x: f64| 0.5 + 0.2 * (2.0 * x).cos()),
            },
        )
        .foundation(Foundation { law: Power { stiffness: 40.0, exponent: 1.5 }, gap })
        .conduction(Conduction {
            mu1: Function(|x: f64| 5.0 + x),
            mu2: Function(|x: f64| 3.0 - x),
            truncation: 0.5,
            potential_truncation: 0.7,
        })
        .load(load)
        .potential(ends);
        is_exact(&varied);
        let uniform = Scene::new(1.0, Beam { bending: 1.0, axial: 2.0, piezo: -1.3, permittivity: 0.4 })
            .foundation(Foundation { law: Linear(40.0), gap: () })
            .conduction(Conduction::new(5.0, 3.0, 0.6))
            .load(load)
            .potential(ends);
        is_exact(&uniform);
        let stiff = Scene::new(1.0, Beam { bending: 1.0, axial: (), piezo: (), permittivity: 0.4 })
            .foundation(Foundation { law: Linear(40.0), gap })
            .conduction(Conduction::new(5.0, 3.0, 0.6))
            .load(load)
            .potential(ends);
        is_exact(&stiff);
    }

    #[test]
    fn a_step_with_the_nondecreasing_tangent_goes_downhill() {
        let scene = Scene::new(1.0, Beam { bending: 1.0, axial: 2.0, piezo: 0.1, permittivity: 0.4 })
            .foundation(Foundation { law: Linear(4.0), gap: () })
            .conduction(Conduction { mu1: 5e3, mu2: 0.1, truncation: 1.0, potential_truncation: 1.0 })
            .load(Load { transverse: 3.0, axial: (), points: () })
            .potential(Potential { left: -1.0, right: -1.0 });
        on_level(&scene, 20, |level| {
            let mut count = Count { iterations: 0, visits: 0, most_visits: 1_000_000 };
            let here = level.trial(1.0, &mut count).unwrap();
            level.best = Some((level.current, here.residual));
            // The whole tangent leads uphill: the foundation pulls more than the beam holds.
            assert!(level.coupled_step(here.open, 1.0, Tangent::Whole, &mut count).unwrap() > 0.0);
            assert!(level.coupled_step(here.open, 1.0, Tangent::Nondecreasing, &mut count).unwrap() < 0.0);
        });
    }
}
