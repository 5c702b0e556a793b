//! The paper's own methods, to compare with: the active set by elements (3.7)-(3.8), the same by Gauss points,
//! and the algorithm of Bermúdez and Moreno (3.3).
//!
//! All three see the contact at the four Gauss points of each element and make of it, in every iteration, a
//! stiffness and a force there; they differ in how:
//!
//! | method | stiffness and force at a point |
//! |---|---|
//! | [`elementwise`] | those of the law, if the element's midpoint is in contact, also where the beam is lifted |
//! | [`gauss`] | those of the law, if the point itself is in contact |
//! | [`bermudez_moreno`] | omega everywhere, and a multiplier that is updated between iterations |
//!
//! The rest is theirs in common and is the paper's loop:
//!
//! ```text
//!     u, q, sigma, D  from the penetration                                         (2), (3)
//!     sweep           from left to right, and the new state back                   (3.8)
//!     until neither the moments nor the forces at the points change any more
//! ```
//!
//! *What such an end is worth.* The loop ends at a solution of the method's own equations. These integrate the
//! contact across its edge, so they are not those of the law, and by elements they may have solutions in which the
//! foundation pulls the beam. So the state is judged like any other: the residual in the report is that of statics
//! with the law integrated up to its edges, and [`Status::Converged`] says that it is small. Else the status tells
//! a foundation that pulls ([`Status::FoundationPulls`]), an iteration that goes in circles ([`Status::Cycle`]), and
//! a state that solves only the method's equations ([`Status::OwnEquations`]).

mod bermudez_moreno;
mod cycle;
mod elementwise;
mod gauss;

pub use bermudez_moreno::BermudezMoreno;

use crate::cubic::Cubic;
use crate::electric;
use crate::element::Element;
use crate::element::contact::{Contact, Fault};
use crate::element::hermite::Motion;
use crate::error::Error;
use crate::law::{Compliance, truncate};
use crate::newton::nested::{self, Answer};
use crate::newton::{Context, Count, Halt, Level, Report, Settings, Status};
use crate::problem::Prepared;
use crate::profile::{Piece, Profile};
use crate::quadrature::{POINTS, gauss as rule};
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::storage::{Node, Place, State, States};
use bermudez_moreno::Parameters;
use cycle::Cycle;

/// A method of the paper, for [`Prepared::solve_by`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method<T> {
    /// Newton's method (3.8) with the active set (3.7) by elements: one is in contact as a whole where the beam
    /// penetrates at its midpoint.
    Elementwise,
    /// Newton's method (3.8) with contact decided at each of four Gauss points per element.
    Gauss,
    /// The algorithm (3.3) of Bermúdez and Moreno.
    BermudezMoreno(BermudezMoreno<T>),
}

/// How a method of the paper went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared<T> {
    /// The end, judged like that of [`Prepared::solve`]: its residual is not the method's own but that of statics
    /// with the law integrated up to the contact's edges.
    pub report: Report<T>,
    /// The method's own residual, relative: what the contact forces at the Gauss points were when the state was found
    /// against what it makes them, the moments of this difference, or the last change of the moments, whichever is
    /// largest.
    pub own_residual: T,
    /// The lowest of the method's contact pressures p \[N/m\]: negative where the foundation pulls.
    pub lowest_pressure: T,
    /// The highest \[N/m\].
    pub highest_pressure: T,
}

/// Iterations that a method may take where [`Settings::max_visits`] does not say.
const ITERATIONS: usize = 10_000;

impl<T: Real, M: Model<T>> Prepared<'_, T, M> {
    /// Solves from nothing by a method of the paper, on the mesh itself; [`Prepared::last`] gives the fields.
    ///
    /// The methods are there to compare with. They find less than [`Prepared::solve`] does, at a higher cost; what
    /// they find is held to the same test.
    ///
    /// ```
    /// use piezobeam::{Beam, Foundation, HeapWorkspace, Linear, Load, Mesh, Method, Problem, Scene, Settings, Status, Steps};
    ///
    /// let scene = Scene::new(1.0_f64, Beam::elastic(5000.0))
    ///     .foundation(Foundation { law: Linear(1e16), gap: () })
    ///     .load(Load { transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] }, axial: (), points: () });
    /// let problem = Problem::new(scene, Mesh::uniform(96))?;
    /// let mut memory = HeapWorkspace::new();
    /// let mut beam = problem.prepare(&mut memory)?;
    /// let found = beam.solve_by(&Method::Elementwise, &Settings::default())?;
    /// // Three iterations and no change left, but the foundation holds the half that is lifted.
    /// assert_eq!((found.report.iterations, found.own_residual), (3, 0.0));
    /// assert!(matches!(found.report.status, Status::FoundationPulls { .. }));
    /// assert!(found.lowest_pressure < -1e9);
    /// # Ok::<(), piezobeam::Error>(())
    /// ```
    ///
    /// # Errors
    /// Settings or parameters out of range.
    ///
    /// # Cost
    /// One sweep over the mesh for each iteration, 10 000 at most where [`Settings::max_visits`] is `None`; no
    /// allocation, no panic.
    pub fn solve_by(&mut self, method: &Method<T>, settings: &Settings<T>) -> Result<Compared<T>, Error> {
        settings.validate()?;
        self.restore();
        let elements = self.elements();
        let places = self.places.get_mut(..elements).unwrap_or_default();
        let rule = match method {
            Method::Elementwise => Rule::Elementwise,
            Method::Gauss => Rule::Gauss,
            Method::BermudezMoreno(given) => Rule::BermudezMoreno(given.parameters(self.scene, places)?),
        };
        for Place { work, .. } in places.iter_mut() {
            work.states = States::default();
        }
        let most_visits = settings.max_visits.unwrap_or(ITERATIONS.saturating_mul(elements));
        let mut count = Count { iterations: 0, visits: 0, most_visits };
        let context = nested::context(self.scene, places, settings.stop);
        let mut paper = Paper { context: &context, places, node: Node::default(), rule };
        let (end, last) = paper.iterate(settings.stop, &mut count);
        let (compared, answer) = paper.judge(end, last, settings.stop, &count);
        self.answer = Some(answer);
        Ok(compared)
    }
}

/// A method, its parameters known.
enum Rule<T> {
    Elementwise,
    Gauss,
    BermudezMoreno(Parameters<T>),
}

/// At each Gauss point, of the contact force: a stiffness, and an offset such that the force is
/// stiffness . eta - offset.
type Linear<T> = [(T, T); POINTS];

/// An iteration that runs; the iterate is the first of each element's two states.
struct Paper<'a, 'b, T: Real, M: Model<T>> {
    context: &'b Context<'a, T, M>,
    places: &'b mut [Place<T, M>],
    /// Fields at the left end.
    node: Node<T, M>,
    rule: Rule<T>,
}

/// How an iteration ended.
enum End {
    /// Nothing changes any more.
    Settled,
    /// It came back to an earlier state, after so many iterations.
    Circles(usize),
    Halted(Halt),
}

/// What an iteration changed, and what to compare it with.
#[derive(Clone, Copy)]
struct Change<T> {
    moment: T,
    largest_moment: T,
    force: T,
    /// Of the loads, too: there need be no contact.
    largest_force: T,
}

impl<T: Real> Change<T> {
    fn none() -> Self {
        let zero = T::zero();
        Self { moment: zero, largest_moment: zero, force: zero, largest_force: zero }
    }

    /// The larger one of both relative changes; not a number where one of them is not.
    fn relative(&self) -> T {
        let over = |part: T, whole: T| if part == T::zero() { part } else { part / whole };
        let (moment, force) = (over(self.moment, self.largest_moment), over(self.force, self.largest_force));
        if moment.is_nan() || moment > force { moment } else { force }
    }
}

impl<T: Real, M: Model<T>> Paper<'_, '_, T, M> {
    /// Iterates from the beam without contact until the relative change is at most `stop`; the end, and the last
    /// change.
    fn iterate(&mut self, stop: T, count: &mut Count) -> (End, Change<T>) {
        let mut cycle = Cycle::default();
        let mut last = Change { moment: T::infinity(), ..Change::none() };
        loop {
            match self.step(count) {
                Ok(change) => last = change,
                Err(halt) => return (End::Halted(halt), last),
            }
            if last.relative() <= stop {
                return (End::Settled, last);
            }
            let states = self.places.iter().flat_map(|place| [place.work.states[0], place.work.states[1]]);
            if let Some(period) = cycle.see(states.flat_map(|State { e, d }| [e.x(), e.y(), d.x(), d.y()])) {
                // A state that leads to itself, by more than `stop` off for rounding.
                let end = if period == 1 { End::Settled } else { End::Circles(period) };
                return (end, last);
            }
        }
    }

    /// One iteration.
    fn step(&mut self, count: &mut Count) -> Result<Change<T>, Halt> {
        count.spend(self.places.len())?;
        if self.context.onto.is_some() {
            self.electric();
        }
        let Context { model, left, right, .. } = *self.context;
        let mut part = left.condensed;
        let mut node = self.node;
        for i in 0..self.places.len() {
            let linear = self.linear(i, &node)?;
            let Place { element, work } = &mut self.places[i];
            let stamp = Contact::at_points(linear).stamp(element);
            if M::Gap::PRESENT {
                part = part.shift(element.gap.kink::<T>());
            }
            let h = element.h;
            let absorbed = if i == 0 { left.join(&part, &stamp, h) } else { part.absorb(&stamp, h) };
            (part, work.factor) = absorbed.ok_or(Halt::Breakdown(i))?;
            node = work.node;
        }
        count.iterations += 1;
        let last = self.places.len().saturating_sub(1);
        let mut near = right.close(&part).ok_or(Halt::Breakdown(last))?;
        let mut change = Change::none();
        // Force and moment, at the node at hand, of the forces that are out of balance to its right.
        let (mut force, mut moment) = (T::zero(), T::zero());
        for i in (0..self.places.len()).rev() {
            let node = match i.checked_sub(1) {
                Some(before) => self.places[before].work.node,
                None => self.node,
            };
            let linear = self.linear(i, &node)?;
            let Place { element, work } = &mut self.places[i];
            let (e, far) = work.factor.substitute(near, element.h);
            let bent = element.bending.times(e - work.states[0].e);
            work.states[0] = State { e, d: near };
            let h = element.h;
            for moment in [bent.y(), bent.y() - h * bent.x()] {
                change.moment = larger(change.moment, moment.abs());
            }
            let motion = Motion::new(h, e, near);
            let held = element.deforming_force(e) + Contact::at_points(linear).force(&motion, h).0;
            for moment in [held.y(), held.y() - h * held.x()] {
                change.largest_moment = larger(change.largest_moment, moment.abs());
            }
            change.largest_force = larger(change.largest_force, element.fr.x().abs() / h);
            near = if M::Gap::PRESENT { far + element.gap.kink::<T>() } else { far };

            // The law's forces in the new state against those that it was found with.
            let sight = Sight::new(model, &self.places[i], &node, self.context);
            let law = self.decided(&sight).map_err(|fault| Halt::Law(i, fault))?;
            moment = moment + h * force;
            for (point, (t, weight)) in rule::<POINTS>().into_iter().enumerate() {
                let (found, law) = (linear[point], law[point]);
                let t = T::of(t);
                let r = sight.eta.at(t);
                let pressure = law.0 * r - law.1;
                let open = found.0 * r - found.1 - pressure;
                change.force = larger(change.force, open.abs());
                change.largest_force = larger(change.largest_force, pressure.abs());
                let part = T::of(weight) * h * open;
                force = force + part;
                moment = moment + part * h * (T::one() - t);
            }
            // Statics may lay it to either end, which makes it up to twice as much elsewhere.
            change.moment = larger(change.moment, T::of(2.0) * moment.abs());
            if let Rule::BermudezMoreno(parameters) = &self.rule {
                let multiplier = parameters.update(&sight, multiplier(&self.places[i]));
                let [a, b, c, d] = multiplier.map_err(|fault| Halt::Law(i, fault))?;
                self.places[i].work.states[1] = State { e: T::Vec2::of(a, b), d: T::Vec2::of(c, d) };
            }
        }
        if change.relative().is_nan() { Err(Halt::Breakdown(0)) } else { Ok(change) }
    }

    /// What the method makes of the contact of an element, for the next solve.
    fn linear(&self, i: usize, left: &Node<T, M>) -> Result<Linear<T>, Halt> {
        let place = &self.places[i];
        let sight = Sight::new(self.context.model, place, left, self.context);
        let linear = match &self.rule {
            Rule::BermudezMoreno(parameters) => parameters.linear(&sight, multiplier(place)),
            _ => self.decided(&sight),
        };
        linear.map_err(|fault| Halt::Law(i, fault))
    }

    /// The law, decided as the method decides it.
    fn decided(&self, sight: &Sight<'_, T, M>) -> Result<Linear<T>, Fault> {
        match self.rule {
            Rule::Elementwise => elementwise::linear(sight),
            Rule::Gauss | Rule::BermudezMoreno(_) => gauss::linear(sight),
        }
    }

    fn electric(&mut self) {
        self.node = electric::solve::<T, M, true>(self.context.model, self.places, 0);
    }

    /// What the iterate is worth.
    fn judge(mut self, end: End, last: Change<T>, stop: T, count: &Count) -> (Compared<T>, Answer<T, M>) {
        self.electric();
        let (lowest, highest) = self.pressures();
        let mut level = Level::new(self.context, &mut *self.places);
        level.node = self.node;
        level.assess();
        let found = level.best.map(|(_, residual)| residual);
        let residual = found.map_or(T::infinity(), |found| found.relative());
        let pulls = lowest.1 < -stop * last.largest_force;
        let unseen = found.map_or(T::zero(), |found| {
            nested::unseen(self.context.model, self.places, 0, &self.node, &found, stop)
        });
        let status = match end {
            End::Halted(halt) => halt.into(),
            End::Circles(period) => Status::Cycle { period },
            End::Settled if pulls => Status::FoundationPulls { element: lowest.0 },
            End::Settled if residual <= stop => {
                match nested::beyond(self.context.model, self.places, 0, &self.node, found.as_ref()) {
                    Some(element) => Status::Breakdown { element },
                    None if unseen > stop => Status::ToleranceBelowFloor,
                    None => Status::Converged,
                }
            }
            End::Settled if found.is_some_and(|found| nested::is_rounding(&found)) => {
                Status::ToleranceBelowFloor
            }
            End::Settled => Status::OwnEquations,
        };
        let report = Report {
            status,
            residual,
            floor: found.map_or(T::zero(), |found| found.floor()),
            iterations: count.iterations,
            element_visits: count.visits,
            elements: self.places.len(),
        };
        let compared = Compared {
            report,
            own_residual: last.relative(),
            lowest_pressure: lowest.1,
            highest_pressure: highest,
        };
        (compared, Answer { report, state: 0, left: self.node, meeting: None, size: T::zero(), rigid: false })
    }

    /// The lowest pressure at any Gauss point and its element, and the highest; neither beyond zero where there is
    /// none beyond it.
    fn pressures(&self) -> ((usize, T), T) {
        let (mut lowest, mut highest) = ((0, T::zero()), T::zero());
        let mut node = self.node;
        for (i, place) in self.places.iter().enumerate() {
            let sight = Sight::new(self.context.model, place, &node, self.context);
            node = place.work.node;
            let Ok(pressures) = (match self.rule {
                Rule::Elementwise => elementwise::pressures(&sight),
                Rule::Gauss => gauss::pressures(&sight),
                Rule::BermudezMoreno(ref parameters) => Ok(parameters.pressures(&sight, multiplier(place))),
            }) else {
                continue;
            };
            for p in pressures {
                if p < lowest.1 {
                    lowest = (i, p);
                }
                highest = larger(highest, p);
            }
        }
        (lowest, highest)
    }
}

/// The multiplier at the Gauss points: the spare state is its room.
fn multiplier<T: Real, M: Model<T>>(place: &Place<T, M>) -> [T; POINTS] {
    let State { e, d } = place.work.states[1];
    [e.x(), e.y(), d.x(), d.y()]
}

/// The larger one; not a number where the new one is not.
fn larger<T: Real>(most: T, new: T) -> T {
    if new <= most { most } else { new }
}

/// An element as the methods see it: the penetration and the law at its Gauss points.
struct Sight<'a, T: Real, M: Model<T>> {
    model: &'a M,
    element: &'a Element<T, M>,
    eta: Cubic<T>,
    q: Cubic<T>,
}

impl<'a, T: Real, M: Model<T>> Sight<'a, T, M> {
    fn new(model: &'a M, place: &'a Place<T, M>, left: &Node<T, M>, context: &Context<'_, T, M>) -> Self {
        let Place { element, work } = place;
        let State { e, d } = work.states[0];
        let ratio = context.onto.as_ref();
        let q =
            ratio.map_or_else(Cubic::default, |ratio| electric::potential(element, left, &work.node, ratio));
        Self { model, element, eta: Motion::new(element.h, e, d).cubic(), q }
    }

    fn penetration(&self) -> [T; POINTS] {
        rule::<POINTS>().map(|(t, _)| self.eta.at(T::of(t)))
    }

    /// Does the beam penetrate at the element's midpoint? (3.7)
    fn is_pressed(&self) -> bool {
        self.eta.at(T::of(0.5)) > T::zero()
    }

    /// (p, dp/dr) of the law at a Gauss point, for penetrations r <= 0 continued as a straight line.
    fn law(&self, point: usize, r: T) -> Result<(T, T), Fault> {
        let t = T::of(rule::<POINTS>()[point].0);
        let (k, x) = (self.element.law.at(t), self.element.x(t));
        // A law promises nothing at zero itself.
        let inside = r.max(T::min_positive_value());
        let (p, slope) = self.model.foundation().law.pressure(k, x, inside);
        if !(p.is_finite() && slope.is_finite()) {
            return Err(Fault::NotFinite);
        }
        if p < T::zero() || slope < T::zero() {
            return Err(Fault::NotMonotone);
        }
        Ok(if r > T::zero() { (p, slope) } else { (slope * r, slope) })
    }

    /// mu1 R(q) R(r) at a Gauss point, and its derivative in r.
    fn conduction(&self, point: usize, r: T) -> (T, T) {
        let t = T::of(rule::<POINTS>()[point].0);
        let bounds = self.model.conduction();
        let drive = self.element.mu1.at(t) * truncate(self.q.at(t), bounds.potential_truncation).0;
        let (value, slope) = truncate(r, bounds.truncation);
        (drive * value, drive * slope)
    }

    /// Law and conduction at a Gauss point in contact, linearised at r.
    fn pressed(&self, point: usize, r: T) -> Result<(T, T), Fault> {
        let ((p, dp), (force, slope)) = (self.law(point, r)?, self.conduction(point, r));
        let stiffness = dp + slope;
        Ok((stiffness, stiffness * r - p - force))
    }

    /// As `each` says at every Gauss point, of its number and the penetration there.
    fn map<R: Copy + Default>(
        &self,
        mut each: impl FnMut(usize, T) -> Result<R, Fault>,
    ) -> Result<[R; POINTS], Fault> {
        let mut found = [R::default(); POINTS];
        for (point, (found, r)) in found.iter_mut().zip(self.penetration()).enumerate() {
            *found = each(point, r)?;
        }
        Ok(found)
    }
}
