//! How far a solution may be trusted: a guaranteed bound on its error, and an estimate of it.

mod adapt;
mod bound;
mod distance;
mod divide;
mod share;

pub use adapt::{Adapted, Adaptive, Reached};

use crate::error::Error;
use crate::newton::{Report, Settings, nested};
use crate::profile::Profile;
use crate::real::Real;
use crate::scene::Model;
use crate::solution::Solution;
use crate::storage::{self, Storage};
use bound::Bounds;
use distance::Distance;
use divide::Shares;

/// How many elements of the finer mesh a certificate divides an element into.
const PARTS: usize = 4;

/// What is known of the error of a solution against the continuous problem.
///
/// The energy norms are (integral of C xi''^2)^(1/2) for bending and (integral of EA u'^2 + eps q'^2)^(1/2) for
/// stretching and potential; all numbers are relative to the solution's own.
///
/// The bounds take for granted that the scene's functions are what their samples say: integrals are Gauss's, exact for
/// polynomials of degree seven and less between the kinks. Rounding is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate<T> {
    /// Guaranteed bound on the error of the discrete bending xi_h = s + eta_h in the energy norm. `None` where the
    /// theory gives none: conduction in both directions beyond (2.15), a foundation that was taken as rigid
    /// ([`Warning::Rigid`](crate::Warning::Rigid)), numbers that are not finite.
    ///
    /// xi_h is cubic in each element and of second order in this norm. The fields that [`Solution::at`] gives are
    /// those of its statics, of fourth order: the estimates below are of these.
    pub bending_bound: Option<T>,
    /// Guaranteed bound on the error of stretching and potential in their energy norm; `None` as above, or where the
    /// scene has neither.
    pub electric_bound: Option<T>,
    /// Estimate of the largest error of bending, over the largest bending.
    pub bending_estimate: T,
    /// The same of the stretching.
    pub stretching_estimate: Option<T>,
    /// The same of the potential.
    pub potential_estimate: Option<T>,
    /// How the solve on the finer mesh went.
    pub report: Report<T>,
}

impl<T: Real, M: Model<T>> Solution<'_, T, M> {
    /// The energy norm of the difference of two discrete bendings, (integral of C (xi_h - xi_H)''^2)^(1/2), over that
    /// of `finer`; zero where neither is bent, infinite where `finer` alone is not. `None` unless the mesh of `finer`
    /// divides each element of this one into equal parts.
    #[must_use]
    pub fn distance(&self, finer: &Solution<'_, T, M>) -> Option<T> {
        let Distance { bending, size, .. } = Distance::between(self, finer)?;
        Some(if bending == T::zero() { bending } else { bending / size })
    }

    /// Bounds and estimates the error by a solve on a mesh four times as fine, which starts from this solution.
    ///
    /// Let v be the deflection on this mesh and w that on the finer one. The distance of v to w is known, that of
    /// w to the solution is bounded by statics: ||xi - v|| <= ||w - v|| + ||m^ - C w''||, where the moment m^ is in
    /// equilibrium with the contact forces of w. The second term is small beside the first, so that the sum is little
    /// more than the error. It is a bound whatever w is, also where the finer solve has not converged.
    ///
    /// ```
    /// use piezobeam::{Beam, Foundation, HeapWorkspace, Linear, Load, Mesh, Problem, Scene, Settings};
    ///
    /// let scene = Scene::new(1.0_f64, Beam::elastic(5000.0))
    ///     .foundation(Foundation { law: Linear(1e8), gap: () })
    ///     .load(Load { transverse: 1e6, axial: (), points: () });
    /// let problem = Problem::new(scene, Mesh::uniform(100))?;
    /// let (mut memory, mut finer) = (HeapWorkspace::new(), HeapWorkspace::new());
    /// let solution = problem.solve(&mut memory, &Settings::default())?;
    /// let certificate = solution.certify(&mut finer, &Settings::default())?;
    /// // Of the energy norm, a guarantee; of the deflection itself, an estimate.
    /// assert!(certificate.bending_bound.is_some_and(|bound| bound < 1e-2));
    /// assert!(certificate.bending_estimate < 1e-6);
    /// # Ok::<(), piezobeam::Error>(())
    /// ```
    ///
    /// # Errors
    /// A profile's value out of its range at a point of the finer mesh; less memory than four times the elements;
    /// settings out of range.
    ///
    /// # Cost
    /// Memory for four times the elements; more where they do not resolve the contact's layers, as far as there is, and
    /// no more elements than a 16th of the visits that are left ([`Settings::max_visits`], of the mesh four times as
    /// fine, caps all finer meshes together): by default some 100 for each element of this mesh, and 6000.
    /// A solve on the finer mesh, five visits of each of its elements as a rule (they are in the report), and about as
    /// much again for the norms.
    pub fn certify<S: Storage<T, M> + ?Sized>(
        &self,
        memory: &mut S,
        settings: &Settings<T>,
    ) -> Result<Certificate<T>, Error> {
        settings.validate()?;
        let (scene, needed) = (self.scene(), PARTS * self.places.len());
        let places = memory.places(needed);
        let available = places.len();
        let places = places.get_mut(..needed).ok_or(Error::Capacity { needed, available })?;
        let mut left = T::zero();
        for (whole, parts) in self.places.iter().zip(places.chunks_exact_mut(PARTS)) {
            for (j, place) in parts.iter_mut().enumerate() {
                *place = divide::part(scene, whole, left, (j, PARTS), self.state)?;
            }
            left = whole.element.right;
        }
        // One cap for all passes.
        let most_visits = nested::budget(settings, needed).most_visits;
        let (mut elements, mut visits, mut pass) = (needed, 0, 1);
        let mut last = None;
        loop {
            let places = storage::first(memory, elements);
            let left = Settings { max_visits: Some(most_visits - visits), ..*settings };
            let mut answer = nested::sharpen(scene, places, self.rigid, T::one(), &left);
            visits += answer.report.element_visits;
            answer.report.element_visits = visits;
            let imbalance = bound::imbalance(scene, places, &answer);
            let finer = Solution::new(scene, &*places, answer);
            // Parts so short that rounding moves their nodes say no more than those before.
            let Some(distance) = Distance::between(self, &finer) else {
                return last.ok_or(Error::Capacity { needed, available });
            };
            let bounds =
                finer.robustness().filter(|_| !self.rigid).map(|kappa| finer.bounds(imbalance, kappa));
            let certificate = Certificate::of::<M>(&distance, bounds, answer.report);
            // Where layers of the contact are not resolved the second term outweighs the first: finer there. Rounding
            // is not divided.
            let allowed = (T::of(SECOND) * distance.bending).max(T::of(2.0) * imbalance.rounding);
            if bounds.is_none()
                || imbalance.mismatch <= allowed
                || !answer.report.is_solved()
                || pass == PASSES
            {
                return Ok(certificate);
            }
            let shares = Shares { places, shares: 1 - answer.state, join: false };
            // No more elements than the visits that are left allow a solve on.
            let room = (most_visits - visits) / VISITS;
            let plan = shares.plan(T::of(0.25) * allowed * allowed, room);
            if !(elements + 1..=room).contains(&plan.elements)
                || memory.places(plan.elements).len() < plan.elements
            {
                return Ok(certificate);
            }
            divide::remesh(scene, memory, elements, answer.state, plan)?;
            (elements, pass, last) = (plan.elements, pass + 1, Some(certificate));
        }
    }
}

/// The second term of the bound over the first, above which it is lowered.
const SECOND: f64 = 0.2;
/// Visits of each element that a solve on a finer mesh may take.
const VISITS: usize = 16;
/// Finer meshes at most.
const PASSES: usize = 8;

impl<T: Real> Certificate<T> {
    fn of<M: Model<T>>(distance: &Distance<T>, bounds: Option<Bounds<T>>, report: Report<T>) -> Self {
        let finite = |bound: T| bound.is_finite().then_some(bound);
        let relative = |distance: T, bound: T, size: T| {
            let whole = distance + bound;
            finite(if whole == T::zero() { whole } else { whole / (size - bound).max(T::zero()) })
        };
        let estimate = |(error, size): (T, T)| {
            // What rounding leaves of both solutions is in neither's difference to the other.
            T::of(4.0) * T::epsilon() + if error == T::zero() { error } else { error / size }
        };
        Self {
            bending_bound: bounds.and_then(|b| relative(distance.bending, b.bending, b.bending_size)),
            electric_bound: bounds
                .filter(|_| crate::electric::present::<T, M>())
                .and_then(|b| relative(distance.electric, b.electric, b.electric_size)),
            bending_estimate: estimate(distance.fields[0]),
            stretching_estimate: M::Axial::PRESENT.then(|| estimate(distance.fields[1])),
            potential_estimate: M::Permittivity::PRESENT.then(|| estimate(distance.fields[2])),
            report,
        }
    }
}
