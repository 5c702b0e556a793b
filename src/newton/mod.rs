//! Newton's method (3.8) with the active set decided at the kinks.
//!
//! One iteration on one mesh:
//!
//! ```text
//!     u, q, sigma, D  from the penetration, where conduction goes both ways        (2), (3)
//!     forward sweep:  linearise the contact of each element and condense it
//!     backward sweep: the new state, and how far it is from the one before         (3.8)
//! ```
//!
//! *Residual.* The deformation of an element gives its moment: linear, known by its values at both ends,
//! and formed from the relative unknowns e, free of the cancellation that differences of nodal values
//! suffer. Equilibrium gives the same moment in another way. The residual is the largest difference of the
//! two, over the largest moment ([`Level::balance`]): statics takes loads and contact forces alone, so that
//! nothing that the recursion may have lost goes unseen. While iterating, the change of the moments by a step says
//! how far off the state before it was; this takes no extra pass. Statics is asked once a step is short, and before
//! a solve says `Converged`. Where the contact force is monotone the residual bounds the error: the statical
//! moment is in equilibrium, and so differs from that of the deformation by at least as much, in the energy
//! norm, as the latter does from the solution's. Shear is not compared: 1/h times the rounding of e is in
//! it, which is no error of the moment.
//!
//! *Whole states and increments.* A sweep solves for the whole state: what did not change need not be swept
//! again. Its rounding, a few units times the root of N, stays in the state however often it is repeated.
//! So where the residual shows it a last sweep solves for an increment, with what is missing of equilibrium
//! and of compatibility for its data; both are found by compensated sums ([`Level::polish`]). On many elements the
//! first step on the finest mesh is one already ([`Level::advance`]).
//!
//! *Only what changed.* Both ends are condensed towards a meeting point among the elements whose matrices
//! changed; the parts outside them stay as they are. Convergence is decided on all elements. Within a step the contact's
//! edges are iterated by themselves first ([`Level::settle_edges`]).
//!
//! *Descent.* Without the potential's action on bending the state is the minimum of a convex energy. Where full
//! steps do not halve the residual, increments are cut to where the energy is least along them
//! ([`Level::lower`]): this converges from anywhere.

mod coupled;
mod local;
pub(crate) mod nested;
mod settings;

pub use settings::{Report, Settings, Status};

use crate::electric::{self, Ratio};
use crate::element::Element;
use crate::element::contact::{Contact, Fault, Touch};
use crate::element::hermite::{self, Motion};
use crate::law::Compliance;
use crate::profile::{Piece, Profile};
use crate::quadrature::POINTS;
use crate::real::{Pair, Real, Sum};
use crate::scene::Model;
use crate::storage::{Node, Place, State, Work};
use crate::sweep::pair::Bending;
use crate::sweep::{Block, Condensed, End, Factor, Stamp};
use core::ops::Range;
use local::Edges;

/// Differences between moments by deformation and by equilibrium, and what to compare them with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Residual<T> {
    /// Largest difference of the moments \[N m\].
    mismatch: T,
    /// Largest moment \[N m\].
    size: T,
    /// Sum of the sizes of loads and contact forces, times the length \[N m\].
    load: T,
    /// Sum of all differences: not finite where one of them is not, which a maximum would pass over.
    sum: T,
}

impl<T: Real> Residual<T> {
    fn none() -> Self {
        Self { mismatch: T::zero(), size: T::zero(), load: T::zero(), sum: T::zero() }
    }

    #[cfg(feature = "alloc")]
    pub(crate) fn of(mismatch: T, size: T, load: T, sum: T) -> Self {
        Self { mismatch, size, load, sum }
    }

    /// What an element's force and moment at one end are off by; h leads to its other end.
    #[inline(always)]
    fn see(&mut self, gap: T::Vec2, h: T) {
        let far = gap.y() - h * gap.x();
        self.mismatch = larger(larger(self.mismatch, gap.y().abs()), far.abs());
        self.sum = self.sum + far;
    }

    /// The relative residual; zero where there is no moment at all.
    pub(crate) fn relative(&self) -> T {
        if self.mismatch == T::zero() { T::zero() } else { self.mismatch / self.size }
    }

    /// What rounding alone may leave: some units in the last place of the moment and of the sums of forces
    /// that balance to it.
    pub(crate) fn floor(&self) -> T {
        if self.load == T::zero() {
            T::zero()
        } else {
            T::of(16.0) * T::epsilon() * (T::one() + self.load / self.size)
        }
    }

    /// What a moment's balance does not see: loads below the normal numbers are rounded to units that are no part of
    /// their size, force and moment of each element to some of them. Over the largest moment, zero where there is none.
    pub(crate) fn underflow(&self, elements: usize, length: T) -> T {
        let unit = T::min_positive_value() * T::epsilon();
        let elements = T::from(elements).unwrap_or(T::one());
        // A load per length acts on the length twice.
        let arm = T::one() + length;
        let lost = T::of(4.0) * elements * unit * arm * arm;
        if self.size == T::zero() { T::zero() } else { lost / self.size }
    }

    /// Is there no moment at all?
    #[cfg(feature = "alloc")]
    pub(crate) fn is_weightless(&self) -> bool {
        self.size == T::zero()
    }

    pub(crate) fn is_finite(&self) -> bool {
        (self.mismatch + self.size + self.sum).is_finite()
    }
}

/// Why an iteration cannot go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Halt {
    Breakdown(usize),
    Law(usize, Fault),
    Budget,
}

impl From<Halt> for Status {
    fn from(halt: Halt) -> Self {
        match halt {
            Halt::Breakdown(element) => Self::Breakdown { element },
            Halt::Law(element, Fault::NotFinite) => Self::LawNotFinite { element },
            Halt::Law(element, Fault::NotMonotone) => Self::LawNotMonotone { element },
            Halt::Budget => Self::VisitLimit,
        }
    }
}

/// What holds on every mesh of a solve.
pub(crate) struct Context<'a, T: Real, M: Model<T>> {
    pub(crate) model: &'a M,
    pub(crate) left: End<T, Bending>,
    pub(crate) right: End<T, Bending>,
    /// Where the potential acts on bending: what its slopes need.
    pub(crate) onto: Option<Ratio<T>>,
    /// Bending acts on the potential.
    pub(crate) into: bool,
    /// The smallest size of moments that a residual is compared with \[N m\].
    pub(crate) quiet: T,
}

/// Work done so far and allowed.
pub(crate) struct Count {
    pub(crate) iterations: usize,
    pub(crate) visits: usize,
    pub(crate) most_visits: usize,
}

impl Count {
    /// Counts visits, or says that they are over the cap.
    pub(crate) fn spend(&mut self, visits: usize) -> Result<(), Halt> {
        if visits > self.most_visits - self.visits {
            return Err(Halt::Budget);
        }
        self.visits += visits;
        Ok(())
    }
}

/// Newton's iteration on one mesh.
pub(crate) struct Level<'a, 'b, T: Real, M: Model<T>> {
    pub(crate) context: &'b Context<'a, T, M>,
    pub(crate) places: &'b mut [Place<T, M>],
    /// Fields at the left end.
    pub(crate) node: Node<T, M>,
    /// Which of the two states is the current one.
    pub(crate) current: usize,
    /// Which holds the best iterate; its residual.
    pub(crate) best: Option<(usize, Residual<T>)>,
    /// Elements before this one are condensed from the left, the others from the right.
    pub(crate) meeting: usize,
    /// The condensed parts are those of a state, not of an increment.
    pub(crate) fresh: bool,
    /// Each element's touch is that of the current state and potential.
    located: bool,
    /// Elements whose law the continuation in the stiffness scales.
    scaled: Range<usize>,
    /// The largest moment after the last step, or of what is started from \[N m\]; zero from nothing.
    size: T,
    edges: Edges,
}

/// What a sweep solves for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Solve<T: Real> {
    State,
    /// An increment, loaded by what the elements leave open of equilibrium; the left end has to move by `open`.
    Increment {
        open: T::Vec2,
    },
}

/// What an iteration is to reach.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal<T> {
    /// The relative residual; on the finest mesh that by statics, else that of a sweep, and one step more. (Where edges are
    /// at rest a coarser mesh is left before.)
    pub(crate) stop: T,
    pub(crate) finest: bool,
}

/// How an iteration on one mesh ended, if it was not halted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Converged,
    Floor,
    Stalled,
}

/// What became of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cut {
    Whole,
    Shorter,
    /// It lowers the energy by no more than rounding.
    Nowhere,
}

impl<'a, 'b, T: Real, M: Model<T>> Level<'a, 'b, T, M> {
    pub(crate) fn new(context: &'b Context<'a, T, M>, places: &'b mut [Place<T, M>]) -> Self {
        let meeting = (places.len() / 2).max(1);
        let scaled = 0..places.len();
        let (node, fresh, located) = (Node::default(), false, false);
        let (size, edges) = (T::zero(), Edges::default());
        Self { context, places, node, current: 0, best: None, meeting, fresh, located, scaled, size, edges }
    }

    /// Is bending in a loop with the potential?
    fn two_way(&self) -> bool {
        let possible = M::Mu1::PRESENT && M::Mu2::PRESENT && M::Permittivity::PRESENT;
        possible && self.context.onto.is_some() && self.context.into
    }

    /// u, q and the fluxes from the current penetration, to all digits.
    pub(crate) fn electric(&mut self) {
        self.node = electric::solve::<T, M, true>(self.context.model, self.places, self.current);
        self.located = false;
    }

    /// The same where bending moves them.
    fn renew(&mut self) {
        if self.two_way() {
            self.electric();
        }
    }

    /// The same with the rounding of plain sums, as good as an iteration needs.
    fn renew_rounded(&mut self) {
        if self.two_way() {
            self.node = electric::solve::<T, M, false>(self.context.model, self.places, self.current);
            self.located = false;
        }
    }

    /// Iterates to the goal, at most `most` times, with the law scaled by `scale`. The current state is then the best
    /// one found.
    pub(crate) fn iterate(
        &mut self,
        scale: T,
        goal: Goal<T>,
        most: usize,
        count: &mut Count,
    ) -> Result<Outcome, Halt> {
        self.renew_rounded();
        // The scale is a new one wherever the beam touches.
        let changed = self.changed(true);
        self.iterate_from(changed, scale, goal, most, count)
    }

    /// The same, where only the elements `changed` have changed since they were condensed last.
    pub(crate) fn iterate_from(
        &mut self,
        changed: Range<usize>,
        scale: T,
        goal: Goal<T>,
        most: usize,
        count: &mut Count,
    ) -> Result<Outcome, Halt> {
        self.best = None;
        let changed = if self.fresh { changed } else { 0..self.places.len() };
        let mut outcome = self.descend(changed, scale, goal, most, count);
        if outcome == Ok(Outcome::Stalled) && !self.convex() {
            self.keep_best();
            outcome = self.descend_coupled(scale, goal.stop, most, count);
        }
        if outcome != Ok(Outcome::Converged) {
            self.keep_best();
        }
        outcome
    }

    /// The beam without its foundation's law, from a state that may be none: it need not satisfy the
    /// conditions at the ends.
    pub(crate) fn free(&mut self, count: &mut Count) -> Result<(), Halt> {
        let all = 0..self.places.len();
        self.best = None;
        self.renew_rounded();
        count.spend(all.len())?;
        self.condense(all, T::zero(), Solve::State)?;
        count.iterations += 1;
        self.substitute(false).map(|_| ()).ok_or(Halt::Breakdown(self.meeting - 1))
    }

    /// Is the current state the solution already?
    pub(crate) fn holds(&mut self, stop: T, count: &mut Count) -> Result<Outcome, Halt> {
        let residual = self.check(T::one(), count)?;
        self.best = Some((self.current, residual));
        Ok(if residual.relative() <= stop { Outcome::Converged } else { Outcome::Stalled })
    }

    /// Full Newton steps, and where these do not help steps down the energy.
    ///
    /// How far a step moves the beam says how far off the state before it was. Only statics can say that a solve has
    /// converged; it is asked, on all elements, once a step is so short that it may have been the last.
    fn descend(
        &mut self,
        mut changed: Range<usize>,
        scale: T,
        goal: Goal<T>,
        most: usize,
        count: &mut Count,
    ) -> Result<Outcome, Halt> {
        let stop = goal.stop;
        // The shortest step, and the least residual where steps went down the energy.
        let (mut least, mut lowest) = (T::infinity(), T::infinity());
        let (mut rounds_since_best, mut stuck) = (0, 0);
        let (mut slow, mut last) = (0, T::infinity());
        let (mut short, mut vain): (Option<T>, bool) = (None, false);
        // What rounding may leave of a step.
        let blur = T::of(64.0) * T::epsilon() * T::from(self.places.len()).unwrap_or(T::one());
        for _ in 0..=most {
            let mut residual = Residual::none();
            if !changed.is_empty() {
                let stepped = self.step(&changed, scale, goal, count);
                // There is a way back where a state was good before.
                residual = if self.best.is_some() { self.tried(stepped)? } else { stepped? };
                if !residual.is_finite() && self.best.is_some_and(|(best, _)| best == self.current) {
                    // The state that seemed best cannot be gone on from: the one before it could.
                    self.best = Some((1 - self.current, residual));
                }
                // Without an edge of contact that moves the equations are all but linear.
                let still = short.is_none() && !self.edges.moving && !self.has_edges(&changed);
                let linear = self.edges.rest || still;
                short = Some(match short {
                    _ if linear && !vain => T::of(LINEAR),
                    None => T::of(SHORT),
                    Some(before) => before.min(T::of(QUADRATIC)),
                });
            }
            let moved = residual.relative();
            // A start is good enough where the edges are at rest and the rest has followed.
            let enough = if self.two_way() { T::of(RENEWED) } else { T::of(FOLLOWED) };
            if !goal.finest && moved <= if self.edges.rest { enough } else { stop } {
                return Ok(Outcome::Converged);
            }
            let done = moved <= stop.max(blur);
            // Rounding may be all that is left without being known beforehand: a gap far above the beam's own
            // bending adds to it. Steps that gain nothing then ask statics, too.
            let near = moved <= T::of(NEAR) && moved > T::of(0.5) * last;
            let mut checked = done || near || rounds_since_best == IDLE;
            if checked {
                residual = self.settle(scale, stop, count)?;
            } else if goal.finest && short.is_some_and(|short| moved <= short) {
                let balanced = self.check(scale, count);
                let balanced = self.tried(balanced)?;
                checked = balanced.relative() <= stop;
                // Not twice in vain: the steps have to grow far shorter before it is asked again.
                (short, vain) = (Some(T::of(1e-3) * moved), true);
                if checked {
                    residual = balanced;
                }
            } else {
                self.renew_rounded();
            }
            if checked && residual.relative() <= stop {
                self.best = Some((self.current, residual));
                return Ok(Outcome::Converged);
            }
            if rounds_since_best >= FULL_STEPS || !residual.is_finite() {
                // Full steps do not help from here: down the energy, unless there are better ways to start, or no
                // energy.
                if most < usize::MAX || !self.convex() {
                    return Ok(Outcome::Stalled);
                }
                self.keep_best();
                match self.lower(T::of(0.5) * lowest, scale, stop, count)? {
                    Some(lower) if lower.relative() <= stop => return Ok(Outcome::Converged),
                    Some(lower) => lowest = lower.relative(),
                    // Rounding of a steep law may hide where the energy falls, but not from full steps for good.
                    None if stuck < STUCK => stuck += 1,
                    None => return Ok(Outcome::Floor),
                }
                // Full steps again.
                (least, last, rounds_since_best) = (T::infinity(), T::infinity(), 0);
                changed = if self.fresh { self.changed(false) } else { 0..self.places.len() };
                continue;
            }
            let relative = residual.relative();
            let halved = relative < T::of(0.5) * least;
            rounds_since_best = if halved { 0 } else { rounds_since_best + 1 };
            least = least.min(relative);
            // At the floor no progress can be expected; above it, patience ends.
            if checked && relative <= T::of(4.0) * residual.floor() && rounds_since_best >= FLOOR_STEPS {
                return Ok(Outcome::Floor);
            }
            slow += usize::from(relative > T::of(0.1) * last);
            last = relative;
            if slow > SLOW && self.is_tied() {
                return Ok(Outcome::Stalled);
            }
            changed = self.changed(false);
        }
        Ok(Outcome::Stalled)
    }

    /// Had one of the elements an edge of contact in it when they were swept?
    fn has_edges(&self, swept: &Range<usize>) -> bool {
        let edge = |place: &Place<T, M>| place.work.swept == Touch::Edge;
        self.places.get(swept.clone()).is_some_and(|places| places.iter().any(edge))
    }

    /// One full step, where the elements `changed` have changed; after the edges of the contact by themselves, where these
    /// may be far from their places. By how much it moved the beam: the change of the moments, from where the edges
    /// came to rest if the best state is kept beside the current one. The best state is the one after the shortest step.
    fn step(
        &mut self,
        changed: &Range<usize>,
        scale: T,
        goal: Goal<T>,
        count: &mut Count,
    ) -> Result<Residual<T>, Halt> {
        self.locate();
        let groups = self.contact_edges();
        let toward = groups.first().map_or(self.meeting, |group| group.start + group.len() / 2);
        let swept = self.extent(changed, toward);
        count.spend(swept.len())?;
        self.condense(swept, scale, Solve::State)?;
        self.settle_edges(groups, scale, goal, count)?;
        let residual = self.substitute(false).ok_or(Halt::Breakdown(self.meeting - 1))?;
        if residual.is_finite() {
            self.size = residual.size;
        }
        if self.best.is_none_or(|(_, best)| residual.relative() < best.relative()) {
            self.best = Some((self.current, residual));
        }
        count.iterations += 1;
        Ok(residual)
    }

    /// From the current state, steps that lower the energy, each cut to where it is least, until the residual has
    /// halved and is at most `enough`; `None` where they lower it by no more than rounding.
    ///
    /// The steps are increments: a sweep for the whole state has rounding in it that may be more than what is
    /// left to go.
    pub(crate) fn lower(
        &mut self,
        enough: T,
        scale: T,
        stop: T,
        count: &mut Count,
    ) -> Result<Option<Residual<T>>, Halt> {
        let mut residual = self.check(scale, count)?;
        let enough = enough.min(T::of(0.5) * residual.relative());
        while residual.relative() > enough.max(stop) {
            let before = residual;
            self.best = Some((self.current, before));
            let polished = self.polish(scale, count);
            residual = self.tried(polished)?;
            if residual.relative() <= enough {
                break;
            }
            match self.shorten(scale, count)? {
                Cut::Whole => {}
                Cut::Shorter => residual = self.check(scale, count)?,
                // No energy can judge this step; the residual still can.
                Cut::Nowhere => match self.halve(before, residual, scale, count)? {
                    Some(less) => residual = less,
                    None => return Ok(None),
                },
            }
        }
        if residual.relative() > stop {
            // The factors are those of an increment: condense the state itself.
            count.spend(self.places.len())?;
            self.condense(0..self.places.len(), scale, Solve::State)?;
        }
        self.best = Some((self.current, residual));
        Ok(Some(residual))
    }

    /// After a step from the best state, whose residual was `before`, to the current one, where it is `after`:
    /// halves the step until it has shrunk the residual, as every small enough step does but for rounding.
    fn halve(
        &mut self,
        before: Residual<T>,
        after: Residual<T>,
        scale: T,
        count: &mut Count,
    ) -> Result<Option<Residual<T>>, Halt> {
        let (mut residual, mut t) = (after, T::one());
        for _ in 0..HALVINGS {
            if residual.relative() < (T::one() - T::of(0.1) * t) * before.relative() {
                return Ok(Some(residual));
            }
            t = T::of(0.5) * t;
            self.retreat(T::of(0.5));
            let checked = self.check(scale, count);
            residual = self.tried(checked)?;
        }
        Ok(None)
    }

    /// The residual of the current state by statics; where that is above `stop`, increments take rounding
    /// out as long as it helps: the sweeps are less exact than the increments that they give.
    fn settle(&mut self, scale: T, stop: T, count: &mut Count) -> Result<Residual<T>, Halt> {
        let checked = self.check(scale, count);
        let mut residual = if self.best.is_some() { self.tried(checked)? } else { checked? };
        for _ in 0..POLISHINGS {
            let before = residual.relative();
            if before <= stop {
                break;
            }
            self.best = Some((self.current, residual));
            let polished = self.polish(scale, count);
            residual = self.tried(polished)?;
            if residual.relative() > T::of(0.5) * before {
                break;
            }
        }
        if residual.relative() > stop {
            if let Some((_, best)) = self.best
                && best.relative() <= residual.relative()
            {
                residual = best;
                self.keep_best();
            }
            // The factors may be those of an increment: condense the state again.
            count.spend(self.places.len())?;
            self.condense(0..self.places.len(), scale, Solve::State)?;
        }
        Ok(residual)
    }

    /// The residual after a step that can be taken back or cut: boundless where the step left the numbers that
    /// the law or the sweep can hold.
    fn tried(&self, residual: Result<Residual<T>, Halt>) -> Result<Residual<T>, Halt> {
        match residual {
            Err(Halt::Law(_, Fault::NotFinite) | Halt::Breakdown(_)) if self.convex() => {
                Ok(Residual { mismatch: T::infinity(), size: T::one(), ..Residual::none() })
            }
            residual => residual,
        }
    }

    /// The scale of each element's law.
    fn scaling(&self, scale: T) -> impl Fn(usize) -> T + use<T, M> {
        let Range { start, end } = self.scaled;
        move |i| if (start..end).contains(&i) { scale } else { T::one() }
    }

    /// Is bending, with the potential as it is, the minimum of a convex energy, or all but?
    pub(crate) fn convex(&self) -> bool {
        !self.is_tied()
    }

    /// After a step from the best state (the spare one) to the current one: cuts it to where the energy is
    /// least along it, unless the energy falls all the way.
    ///
    /// The energy is convex and the step a direction of descent, so its derivative along the step rises
    /// through zero; the root is bracketed by false positions, kept off the bracket's ends, and the step ends
    /// below it, where at most half of the derivative is left.
    fn shorten(&mut self, scale: T, count: &mut Count) -> Result<Cut, Halt> {
        let spare = 1 - self.current;
        if self.best.is_none_or(|(best, _)| best != spare) {
            return Ok(Cut::Whole);
        }
        let (zero, one, tenth) = (T::zero(), T::one(), T::of(0.1));
        let mut fault = None;
        let (end, _) = self.derivative(one, scale, count, &mut fault)?;
        if end <= zero {
            return Ok(Cut::Whole);
        }
        let (start, rounding) = self.derivative(zero, scale, count, &mut fault)?;
        if start >= -rounding {
            return Ok(Cut::Nowhere);
        }
        let enough = T::of(-0.5) * start;
        let (mut low, mut high) = ((zero, start), (one, end));
        let mut slope = end;
        for round in 0..CUTS {
            if slope <= zero && slope >= -enough {
                break;
            }
            let width = high.0 - low.0;
            // Steep laws make false positions creep, and infinite ones stand still: halve every other time.
            let falsi = low.0 - low.1 * (width / (high.1 - low.1));
            let bisect = round % 2 == 1 || !high.1.is_finite();
            let t = if bisect {
                low.0 + T::of(0.5) * width
            } else {
                falsi.max(low.0 + tenth * width).min(high.0 - tenth * width)
            };
            slope = self.derivative(t, scale, count, &mut fault)?.0;
            *(if slope <= zero { &mut low } else { &mut high }) = (t, slope);
        }
        if let Some(halt) = fault
            && low.1 < -enough
            && !high.1.is_finite()
        {
            // The energy falls all the way to where the law ends.
            return Err(halt);
        }
        let t = low.0;
        if t == zero {
            return Ok(Cut::Nowhere);
        }
        self.retreat(t);
        Ok(Cut::Shorter)
    }

    /// Back to the share t of the way from the spare state to the current one.
    fn retreat(&mut self, t: T) {
        let current = self.current;
        self.located = false;
        for Place { work, .. } in self.places.iter_mut() {
            work.states[current] = work.states[1 - current].toward(work.states[current], t);
        }
    }

    /// Derivative of the energy along the step from the spare state to the current one, at the share t of
    /// it, and what rounding may make of it; infinite, with a `fault`, where the law is.
    fn derivative(
        &self,
        t: T,
        scale: T,
        count: &mut Count,
        fault: &mut Option<Halt>,
    ) -> Result<(T, T), Halt> {
        count.spend(self.places.len())?;
        let Context { model, ref onto, .. } = *self.context;
        let scale = self.scaling(scale);
        let mut node = &self.node;
        let (mut sum, mut size) = (Sum::<T>::default(), T::zero());
        for (i, Place { element, work }) in self.places.iter().enumerate() {
            let (from, to) = (work.states[1 - self.current], work.states[self.current]);
            let State { e, d } = from.toward(to, t);
            let motion = Motion::new(element.h, e, d);
            let q = onto.as_ref().map(|ratio| || electric::potential(element, node, &work.node, ratio));
            let contact = match Contact::at(model, element, &motion, q, scale(i)) {
                Err(Fault::NotFinite) => {
                    *fault = Some(Halt::Law(i, Fault::NotFinite));
                    return Ok((T::infinity(), T::zero()));
                }
                contact => contact.map_err(|fault| Halt::Law(i, fault))?,
            };
            let (ce, cd) = contact.force(&motion, element.h);
            size = size + contact.size(&motion, cd, element.h) * (to.d - from.d).x().abs();
            let held = element.deforming_force(e) + ce;
            if i == 0 {
                // What the step closes of compatibility at the clamp is no work of the beam's.
                let left = (to.e - from.e) + Bending::carry(element.h, to.d - from.d);
                sum.add(-held.times(left));
            }
            for part in [held.times(to.e - from.e), (cd - element.fr).times(to.d - from.d)] {
                sum.add(part);
                size = size + part.abs();
            }
            node = &work.node;
        }
        let sum = sum.value();
        Ok((if sum.is_finite() { sum } else { T::infinity() }, T::of(16.0) * T::epsilon() * size))
    }

    /// One step for an increment of the best state.
    ///
    /// Compatibility first: d is summed anew from the relative unknowns, from the right end, and what is
    /// open at the left end is data for the step. Then equilibrium: as the moments of statics do no work
    /// on any admissible increment, the difference of an element's moments from them is all its load.
    fn polish(&mut self, scale: T, count: &mut Count) -> Result<Residual<T>, Halt> {
        self.keep_best();
        let open = self.rejoin(scale, count)?;
        self.increment(open, scale, count)
    }

    /// The increment by which a uniform load would move the current state, linearly, goes into the spare states.
    ///
    /// The load on the left of an element does its work on the element's e, as all that is left of it follows rigidly:
    /// the element carries it like the difference of statics in a polishing step.
    fn yielding(&mut self, load: T) -> bool {
        let (current, spare) = (self.current, 1 - self.current);
        self.best = Some((current, Residual::none()));
        for Place { element, work } in self.places.iter_mut() {
            let left = element.right - element.h;
            let (own, _) = hermite::loads(element.h, [load; POINTS]);
            let before = T::Vec2::of(load * left, T::of(-0.5) * load * left * left);
            work.open = -(own + before);
        }
        let all = 0..self.places.len();
        let open = T::Vec2::default();
        let yields = self.condense(all, T::one(), Solve::Increment { open }).is_ok()
            && self.substitute(true).is_some();
        for Place { work, .. } in self.places.iter_mut() {
            let State { e, d } = work.states[current];
            let moved = &mut work.states[spare];
            (moved.e, moved.d) = (moved.e - e, moved.d - d);
        }
        yields && self.current == spare
    }

    /// Joins the nodes of the best state anew and finds what is missing of equilibrium; by how much the left end
    /// has to move.
    ///
    /// Where the foundation is all but rigid the last digits of d are forces, and a sum of the relative
    /// unknowns from far away is less exact than the nodes were: then these stay.
    fn rejoin(&mut self, scale: T, count: &mut Count) -> Result<T::Vec2, Halt> {
        count.spend(self.places.len())?;
        let (current, spare) = (self.current, 1 - self.current);
        for Place { work, .. } in self.places.iter_mut() {
            work.states[spare].d = work.states[current].d;
        }
        let mut open = self.join_nodes();
        let mut residual = self.balance(scale)?;
        if self.best.is_some_and(|(_, best)| residual.relative() > T::of(2.0) * best.relative()) {
            for Place { work, .. } in self.places.iter_mut() {
                work.states[current].d = work.states[spare].d;
            }
            self.located = false;
            open = T::Vec2::default();
            residual = self.balance(scale)?;
        }
        self.best = Some((current, residual));
        Ok(open)
    }

    /// The step for what [`Level::rejoin`] left open, and the residual after it.
    fn increment(&mut self, open: T::Vec2, scale: T, count: &mut Count) -> Result<Residual<T>, Halt> {
        let all = 0..self.places.len();
        count.spend(all.len())?;
        self.condense(all, scale, Solve::Increment { open })?;
        self.substitute(true).ok_or(Halt::Breakdown(self.meeting - 1))?;
        count.iterations += 1;
        self.check(scale, count)
    }

    /// Sums d anew from the relative unknowns, from the right end, without rounding; by how much the left end
    /// has to move.
    fn join_nodes(&mut self) -> T::Vec2 {
        let current = self.current;
        self.located = false;
        let right = self.context.right.value;
        let (mut w, mut theta) = (Sum::<T>::from(right.x()), Sum::<T>::from(right.y()));
        for Place { element, work } in self.places.iter_mut().rev() {
            let state = &mut work.states[current];
            state.d = T::Vec2::of(w.value(), theta.value());
            w.add(-(element.h * theta.value()));
            w.add(state.e.x());
            theta.add(state.e.y());
            if M::Gap::PRESENT {
                theta.add(element.gap.kink::<T>().y());
            }
        }
        let left = self.context.left.value;
        w.add(-left.x());
        theta.add(-left.y());
        -T::Vec2::of(w.value(), theta.value())
    }

    /// From a state that is all but the solution: steps for increments, as long as each leaves little of what is open. A
    /// sweep for the whole state would leave rounding in it that grows with the number of elements.
    pub(crate) fn advance(&mut self, stop: T, count: &mut Count) -> Result<Outcome, Halt> {
        count.spend(self.places.len())?;
        let mut open = self.join_nodes();
        self.renew();
        let mut before = self.balance(T::one())?;
        loop {
            self.best = Some((self.current, before));
            let stepped = self.increment(open, T::one(), count);
            let residual = self.tried(stepped)?;
            if residual.relative() < before.relative() {
                self.best = Some((self.current, residual));
            }
            if residual.relative() <= stop {
                return Ok(Outcome::Converged);
            }
            let quick = residual.relative() < T::of(QUICK) * before.relative();
            if !quick {
                self.keep_best();
                return Ok(Outcome::Stalled);
            }
            // The last step closed what was open.
            (before, open) = (residual, T::Vec2::default());
        }
    }

    /// Are there so many elements that the rounding of sweeps shows before that of the contact, whose layers they
    /// resolve? (Where they do not, the nodes of a coarser mesh are better than sums of its relative unknowns.)
    pub(crate) fn is_fine(&self) -> bool {
        let resolved = |place: &Place<T, M>| {
            !M::Law::LINEAR || place.element.law.mean() <= T::of(RESOLVED) * place.element.rigid()
        };
        self.places.len() >= FINE && self.places.iter().all(resolved)
    }

    /// Units in the last place of a residual that is good enough: rounding that grows with the elements is for the
    /// polish, and few elements have little of it.
    pub(crate) fn polished(&self) -> T {
        let few = T::of(FEW) / T::from(self.places.len()).unwrap_or(T::one());
        T::of(128.0) * (few * few).max(T::one())
    }

    /// Takes the rounding of the sweeps out of a converged state, where its residual is more than `units` in the last
    /// place; keeps what is better.
    pub(crate) fn refine(&mut self, units: T, count: &mut Count) -> Result<(), Halt> {
        let Some((_, best)) = self.best else { return Ok(()) };
        // Where contact forces balance to moments that are small beside them, rounding is more than an increment sees.
        if best.relative() <= (units * T::epsilon()).max(T::of(LOST) * best.floor()) {
            return Ok(());
        }
        let refined = self.rejoin(T::one(), count).and_then(|open| {
            let joined = self.best;
            let residual = self.increment(open, T::one(), count)?;
            if joined.is_some_and(|(_, joined)| residual.relative() < joined.relative()) {
                self.best = Some((self.current, residual));
            }
            Ok(())
        });
        self.keep_best();
        match refined {
            // The state was good enough before; that there is no more work to spend on it changes nothing.
            Err(Halt::Budget) => Ok(()),
            refined => refined,
        }
    }

    /// The residual of the current state by statics, if it can be had.
    pub(crate) fn assess(&mut self) {
        self.best = self.balance(T::one()).ok().map(|residual| (self.current, residual));
    }

    /// Makes the best state the current one.
    fn keep_best(&mut self) {
        if let Some((best, _)) = self.best
            && best != self.current
        {
            self.current = best;
            self.located = false;
            self.renew();
        }
    }

    /// The elements that have to be condensed anew where those of `changed` changed; moves the meeting
    /// point among these, as far `toward` one as it can.
    fn extent(&mut self, changed: &Range<usize>, toward: usize) -> Range<usize> {
        let swept = changed.start.min(self.meeting)..changed.end.max(self.meeting);
        let most = (self.places.len() - 1).max(1);
        // `clamp` would check that its bounds are in order, and panic.
        self.meeting = toward.max(changed.start).min(changed.end).max(1).min(most);
        swept
    }

    /// Linearises the elements of `swept` at the current state and condenses them, from both sides towards
    /// the meeting point.
    #[inline(never)]
    fn condense(&mut self, swept: Range<usize>, scale: T, solve: Solve<T>) -> Result<(), Halt> {
        self.locate();
        // Half condensed is not condensed.
        let fresh = core::mem::replace(&mut self.fresh, false);
        let scale = self.scaling(scale);
        let (mut left, mut right) = (self.context.left, self.context.right);
        if let Solve::Increment { open } = solve {
            (left.value, right.value) = (open, T::Vec2::default());
        }
        let step = solve != Solve::State;
        let whole = swept.len() == self.places.len();
        let meeting = self.meeting;
        let (mut from_left, mut from_right) = (swept.start.min(meeting), swept.end.max(meeting));
        let mut west = match self.places.get(..from_left).and_then(<[_]>::last) {
            Some(before) => before.work.condensed,
            None => left.condensed,
        };
        let mut east = self.places.get(from_right).map_or(right.condensed, |p| p.work.condensed);
        // The two chains do not wait for each other, so they are interleaved.
        while from_left < meeting || from_right > meeting {
            if from_left < meeting {
                west = self.absorb::<false>(from_left, west, &left, scale(from_left), step)?;
                from_left += 1;
            }
            if from_right > meeting {
                from_right -= 1;
                east = self.absorb::<true>(from_right, east, &right, scale(from_right), step)?;
            }
        }
        self.fresh = !step && (fresh || whole);
        Ok(())
    }

    /// Condenses element i into the part on its left, `MIRRORED` on its right; an element at the beam's `end` into that.
    ///
    /// Most elements are free, or touch with one stiffness: these take the short way, without a call in it.
    #[inline(always)]
    fn absorb<const MIRRORED: bool>(
        &mut self,
        i: usize,
        mut part: Condensed<T, Bending>,
        end: &End<T, Bending>,
        scale: T,
        step: bool,
    ) -> Result<Condensed<T, Bending>, Halt> {
        let Context { model, ref onto, .. } = *self.context;
        let (current, left) = (self.current, self.node);
        if M::Gap::PRESENT && !step {
            // The penetration's slope jumps at the node to the part.
            if !MIRRORED {
                part = part.shift(self.places.get(i).ok_or(Halt::Breakdown(i))?.element.gap.kink::<T>());
            } else if let Some(next) = self.places.get(i + 1) {
                part = part.shift(-next.element.gap.kink::<T>());
            }
        }
        let ends = if MIRRORED { i + 1 == self.places.len() } else { i == 0 };
        let (before, Place { element, work }) = at(self.places, i).ok_or(Halt::Breakdown(i))?;
        let before = before.map_or(&left, |before| &before.work.node);
        let State { e, d } = work.states[current];
        let motion = Motion::new(element.h, e, d);
        let q = onto.as_ref().map(|ratio| || electric::potential(element, before, &work.node, ratio));
        let touch = work.touch();
        work.swept = touch;
        let h = if MIRRORED { -element.h } else { element.h };
        let absorbed = match touch {
            Touch::Free if !ends => {
                part.absorb(&loaded::<_, _, MIRRORED>(&Contact::none(), element, work, step), h)
            }
            Touch::Full | Touch::High | Touch::Low if !ends => {
                let contact = Contact::uniform(touch.stiffness(model, element, scale));
                part.absorb(&loaded::<_, _, MIRRORED>(&contact, element, work, step), h)
            }
            _ => {
                let contact = Contact::touching(touch, model, element, &motion, q, scale)
                    .map_err(|fault| Halt::Law(i, fault))?;
                join::<_, _, MIRRORED>(&contact, element, work, step, ends.then_some(end), &part)
            }
        };
        let (next, factor) = absorbed.ok_or(Halt::Breakdown(i))?;
        (work.condensed, work.factor) = (next, factor);
        Ok(next)
    }

    /// The residual of the current state by statics, on all elements, with u and q of that state.
    fn check(&mut self, scale: T, count: &mut Count) -> Result<Residual<T>, Halt> {
        count.spend(self.places.len())?;
        self.renew();
        self.balance(scale)
    }

    /// The residual by statics: no part of the recursion is used. Moments by deformation are compared with those
    /// by statics from the left end; each element keeps what its force and moment are off by.
    #[inline(never)]
    fn balance(&mut self, scale: T) -> Result<Residual<T>, Halt> {
        let Context { model, ref onto, .. } = *self.context;
        self.locate();
        let scale = self.scaling(scale);
        let mut residual = Residual::none();
        let mut rest = T::zero();
        let (mut force, mut moment) = (Sum::<T>::default(), Sum::<T>::default());
        let current = self.current;
        let mut node = self.node;
        for (i, Place { element, work }) in self.places.iter_mut().enumerate() {
            let h = element.h;
            let (contact, motion) = linearise(model, element, work, &node, current, onto, scale(i))
                .map_err(|fault| Halt::Law(i, fault))?;
            let (ce, cd) = contact.force(&motion, h);
            let held = element.deforming_force(motion.e) + ce;
            if i == 0 {
                (force, moment) = (Sum::from(-held.x()), Sum::from(-held.y()));
            }
            work.open = T::Vec2::of(force.plus(held.x()), moment.plus(held.y()));
            rest = work.open.y() - h * work.open.x();
            let carried = cd - element.fr;
            residual.size = larger(residual.size, held.y().abs());
            residual.load = residual.load + contact.size(&motion, cd, h) + element.fr.x().abs();
            moment.add(-(h * force.value()));
            moment.add(carried.y());
            force.add(carried.x());
            node = work.node;
        }
        // The right end has no element on its right.
        if let Some(Place { element, work }) = self.places.last() {
            residual.size = larger(residual.size, element.largest_moment(work.states[current].e));
        }
        // The first element knows the shear at the left end to N times rounding only, the moments at both ends of
        // the beam know it better: what it is off by grows to `rest` along the beam.
        let length = model.length();
        let slip = rest / length;
        for Place { element, work } in self.places.iter_mut() {
            work.open += T::Vec2::of(slip, -(slip * (element.right - element.h)));
            residual.see(work.open, element.h);
        }
        residual.load = residual.load * length;
        residual.size = residual.size.max(self.context.quiet);
        if residual.is_finite() { Ok(residual) } else { Err(Halt::Breakdown(0)) }
    }

    /// Back substitution from the meeting point to both ends: the new state beside the best one; by how much it
    /// changes the elements' moments, which is what the one before was off by. `None` if the parts cannot be joined.
    #[inline(never)]
    fn substitute(&mut self, step: bool) -> Option<Residual<T>> {
        let target = self.target();
        let moved = self.substitute_on(0..self.places.len(), target, step)?;
        (self.current, self.located) = (target, false);
        Some(moved)
    }

    /// Where the next state goes: the best one stays where it is, and the one before a step until something is better.
    fn target(&self) -> usize {
        match self.best {
            Some((best, _)) if best != self.current => self.current,
            _ => 1 - self.current,
        }
    }

    /// The same on the elements `range` about the meeting point, into the state number `target`.
    #[inline(always)]
    fn substitute_on(&mut self, range: Range<usize>, target: usize, step: bool) -> Option<Residual<T>> {
        let current = self.current;
        let meeting = self.meeting;
        let (west, east) = self.places.split_at_mut_checked(meeting)?;
        let met = west.last()?.work.condensed;
        let d = match east.first() {
            Some(Place { element, work }) => {
                if step {
                    met.meet(&work.condensed)?
                } else {
                    met.meet(&work.condensed.shift(-element.gap.kink::<T>()))?
                }
            }
            None if step => {
                let mut right = self.context.right;
                right.value = T::Vec2::default();
                right.close(&met)?
            }
            None => self.context.right.close(&met)?,
        };
        let west = west.get_mut(range.start.min(meeting)..)?;
        let east = east.get_mut(..range.end.max(meeting) - meeting)?;
        let mut near = d;
        let (mut size, mut mismatch, mut sum) = (T::zero(), T::zero(), T::zero());
        let mut see = |element: &Element<T, M>, before: State<T>, after: State<T>| {
            let moved = element.moments(element.bending.times(after.e - before.e));
            (mismatch, sum) = (larger(mismatch, moved), sum + moved);
            size = larger(size, element.largest_moment(after.e));
        };
        for Place { element, work } in west.iter_mut().rev() {
            let (e, far) = work.factor.substitute(near, element.h);
            let before = work.states[current];
            work.states[target] = before.then(step, e, near);
            see(element, before, work.states[target]);
            near = if M::Gap::PRESENT && !step { far + element.gap.kink::<T>() } else { far };
        }
        let mut near = d;
        for Place { element, work } in east {
            if M::Gap::PRESENT && !step {
                near = near - element.gap.kink::<T>();
            }
            let (e, far) = work.factor.substitute(near, -element.h);
            // e = -T e^
            let e = -Bending::carry(element.h, e);
            let before = work.states[current];
            work.states[target] = before.then(step, e, far);
            see(element, before, work.states[target]);
            near = far;
        }
        let size = size.max(self.context.quiet);
        Some(Residual { mismatch, size, sum, ..Residual::none() })
    }

    /// From the first to the last element whose matrix the current state changes, or whose part in the
    /// right-hand side; `rescaled`: or that touches.
    pub(crate) fn changed(&mut self, rescaled: bool) -> Range<usize> {
        self.locate();
        let changes = |place: &Place<T, M>| {
            let (swept, touch) = (place.work.swept, place.work.touch());
            matches!(touch, Touch::Edge | Touch::Mixed)
                || touch != swept
                || (rescaled && touch != Touch::Free)
        };
        self.span(0..self.places.len(), changes).unwrap_or(0..0)
    }

    /// From the first to the last element of `range` of which `holds` is true.
    fn span(&self, range: Range<usize>, holds: impl Fn(&Place<T, M>) -> bool) -> Option<Range<usize>> {
        let (start, places) = (range.start, self.places.get(range)?);
        let first = places.iter().position(&holds)?;
        let last = places.iter().rposition(holds).unwrap_or(first);
        Some(start + first..start + last + 1)
    }

    /// Finds how each element touches.
    pub(super) fn locate(&mut self) {
        if !self.located {
            self.locate_on(0..self.places.len());
            self.located = true;
        }
    }

    /// The same on the elements `range`.
    #[inline(always)]
    fn locate_on(&mut self, range: Range<usize>) {
        if !Touch::possible::<T, M>() {
            return;
        }
        let Context { model, ref onto, .. } = *self.context;
        let Some((before, places)) = self.places.split_at_mut_checked(range.start) else { return };
        let mut node = before.last().map_or(self.node, |place| place.work.node);
        for Place { element, work } in places.iter_mut().take(range.len()) {
            let State { e, d } = work.states[self.current];
            let q = onto.as_ref().map(|ratio| || electric::potential(element, &node, &work.node, ratio));
            let eta = Motion::new(element.h, e, d).cubic();
            work.set_touch(Touch::of(model, element, &eta, q));
            node = work.node;
        }
    }
}

/// An element and the one before it.
type Neighbours<'a, T, M> = (Option<&'a Place<T, M>>, &'a mut Place<T, M>);

/// Element i and the one before it.
#[inline(always)]
fn at<T: Real, M: Model<T>>(places: &mut [Place<T, M>], i: usize) -> Option<Neighbours<'_, T, M>> {
    let (before, rest) = places.split_at_mut_checked(i)?;
    Some((before.last(), rest.first_mut()?))
}

/// The contact of an element in the current state, which is known as it touches, and that state's motion.
#[inline(always)]
fn linearise<T: Real, M: Model<T>>(
    model: &M,
    element: &Element<T, M>,
    work: &Work<T, M>,
    left: &Node<T, M>,
    state: usize,
    ratio: &Option<Ratio<T>>,
    scale: T,
) -> Result<(Contact<T>, Motion<T>), Fault> {
    let State { e, d } = work.states[state];
    let motion = Motion::new(element.h, e, d);
    let q = ratio.as_ref().map(|ratio| || electric::potential(element, left, &work.node, ratio));
    Contact::touching(work.touch(), model, element, &motion, q, scale).map(|contact| (contact, motion))
}

/// The part of an element with the given contact in a sweep, `MIRRORED` in that from the right; `step`: in that for an
/// increment, which is loaded by what the element leaves open.
#[inline(always)]
fn loaded<T: Real, M: Model<T>, const MIRRORED: bool>(
    contact: &Contact<T>,
    element: &Element<T, M>,
    work: &Work<T, M>,
    step: bool,
) -> Stamp<T, Bending> {
    let mut stamp = if MIRRORED { contact.mirrored(element) } else { contact.stamp(element) };
    if step {
        let open = -work.open;
        stamp.fe = if MIRRORED { -Bending::carry_back(element.h, open) } else { open };
        stamp.fr = T::Vec2::default();
    }
    stamp
}

/// Condenses an element with any contact, at an end of the beam or not.
#[inline(never)]
fn join<T: Real, M: Model<T>, const MIRRORED: bool>(
    contact: &Contact<T>,
    element: &Element<T, M>,
    work: &Work<T, M>,
    step: bool,
    end: Option<&End<T, Bending>>,
    part: &Condensed<T, Bending>,
) -> Option<(Condensed<T, Bending>, Factor<T, Bending>)> {
    let stamp = loaded::<_, _, MIRRORED>(contact, element, work, step);
    let h = if MIRRORED { -element.h } else { element.h };
    match end {
        Some(end) => end.join(part, &stamp, h),
        None => part.absorb(&stamp, h),
    }
}

/// The larger of two sizes. (A maximum that treats NaN takes three instructions more.)
#[inline(always)]
fn larger<T: Real>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// Increments taken one after the other, each from sweeps of its own.
const POLISHINGS: usize = 6;

/// Elements below which the residual shows other rounding than that of sweeps.
const FEW: f64 = 1000.0;

/// Share of what rounding may leave of a residual that is not worth a refinement.
const LOST: f64 = 0.01;

/// Share of the residual that an increment leaves if another one is as good as a sweep for the whole state.
const QUICK: f64 = 0.01;

/// Elements from which on the rounding of sweeps is worth a balance before the first of them.
const FINE: usize = 4000;

/// Stiffness of a foundation whose layers an element resolves, over that of one that is rigid to it.
const RESOLVED: f64 = 1e-4;

/// A step that may be all rounding: if the next one is not shorter by half, statics is asked.
const NEAR: f64 = 1e-7;

/// Change of the moments by the first step after which statics is asked whether it was the last ...
const SHORT: f64 = 1e-4;

/// ... and by any step where no element has an edge of contact in it, or all edges are at rest; until once in vain.
const LINEAR: f64 = 3e-2;

/// Change of the moments with which the rest of the beam may follow edges at rest on a coarser mesh, or in a stage of the
/// continuation: by all of them. The state after it, not before, is the start for what comes.
const FOLLOWED: f64 = 1.0;

/// The same where the potential is still that of before the step.
const RENEWED: f64 = 1e-2;

/// Residual from which the next Newton step leaves its square.
const QUADRATIC: f64 = 1e-6;

/// Rounds that may fall short of a tenth of the residual before where the potential acts on bending, until the
/// monolithic method takes over.
const SLOW: usize = 4;

/// Rounds without halving the residual after which statics is asked whether more than rounding is left of it.
const IDLE: usize = 8;

/// Rounds without halving a residual at its floor after which it counts as the floor.
const FLOOR_STEPS: usize = 6;

/// Full steps taken without halving the residual before they are cut to descend.
const FULL_STEPS: usize = 12;

/// Times that no step lowers the energy, each followed by full steps, before that is the end.
const STUCK: usize = 8;

/// Halvings of one step.
const HALVINGS: usize = 12;

/// Cuts of one step: every other one halves its bracket at least.
const CUTS: usize = 100;
