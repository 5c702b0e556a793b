//! Nested meshes: the coarsest finds the contact, finer ones sharpen it.
//!
//! A cold start with full steps creeps: when the foundation is nearly rigid each iteration moves the
//! contact edge by one boundary layer. On a few dozen elements a continuation in the stiffness is cheap and
//! finds the edge; the cubic of a coarse element stays a cubic when the element is divided, so each finer
//! mesh starts where the coarser one ended, and one to four iterations are left for it. The work is then a
//! few sweeps over the finest mesh, whatever the stiffness.

use super::{Context, Count, Goal, Halt, Level, Outcome, Report, Residual, Settings, Status};
use crate::element::Element;
use crate::element::hermite::Motion;
use crate::law::Compliance;
use crate::profile::{Piece, Profile, Smooth};
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::storage::{Node, Place, State, States};
use crate::sweep::pair::Bending;
use crate::sweep::{Block, Condensed, End};
use crate::{Error, electric};
use arrayvec::ArrayVec;
use core::ops::Range;

/// Elements of a mesh that are merged into one of the next coarser mesh.
const MERGED: usize = 4;
/// A mesh of so many elements is not coarsened further under a soft foundation ...
const COARSEST: usize = 40;
/// ... and under others, where contact that is found on less than twenty elements misleads.
const COARSEST_STIFF: usize = 80;
/// Meshes at most: 4^16 times the coarsest is more than any memory.
const MOST_LEVELS: usize = 16;
/// Step after which a stage of the continuation has done its part, unless edges at rest say so before ...
const ROUGH: f64 = 1e-4;
/// ... and a coarser mesh: what is left to do costs less there.
const CLOSE: f64 = 1e-4;
/// Iterations granted to one stage or coarser mesh.
const STAGE: usize = 15;
/// Stages of the continuation closer than this factor are not tried.
const SHORTEST: f64 = 1.2;
/// Factor between stages of the continuation in the stiffness; its square follows where one took a single step.
const STRIDE: f64 = 100.0;
/// Stiffness k L^4 / C with which the continuation starts: contact is a few boundary layers wide.
const SOFT: f64 = 1e5;

/// k h^4 / C of a foundation whose layers are a sixth of an element wide: as stiff as it makes sense on a coarser mesh.
const SHARPEST: f64 = 4096.0;

/// Where rounding may make so much of the largest moment, a residual says nothing.
const BLIND: f64 = 1e-2;

/// A residual of so many times the estimate of its rounding may still be rounding.
const FLOOR: f64 = 64.0;

/// Where each mesh lies in memory, finest first.
pub(crate) type Levels = ArrayVec<(usize, usize), MOST_LEVELS>;

/// Builds coarser meshes behind the finest one, which takes the first `elements` places.
///
/// At a clamp that is `pressed` into the foundation all meshes are as fine as the finest, and grow coarse
/// with the distance from it: the moment there goes with the smallest elements where they do not resolve its
/// boundary layer, and decides how far off the beam lifts.
pub(crate) fn coarsen<T: Real, M: Model<T>>(
    model: &M,
    places: &mut [Place<T, M>],
    elements: usize,
) -> Levels {
    let mesh = places.get(..elements).unwrap_or_default();
    let pressed = pressed(model, mesh);
    let coarsest = if is_soft(model, mesh) { COARSEST } else { COARSEST_STIFF };
    let mut levels = Levels::new();
    let _ = levels.try_push((0, elements));
    while let Some(&(start, len)) = levels.last() {
        // Without contact the first solve is the last.
        let linear = !M::Law::PRESENT && !M::Mu1::PRESENT;
        if linear || len <= coarsest || levels.is_full() {
            break;
        }
        let behind = places.get_mut(start..).unwrap_or_default();
        let Some((fine, rest)) = behind.split_at_mut_checked(len) else { break };
        let mut made = 0;
        let mut from = 0;
        while from < len {
            // Up to four neighbours, none beyond a break, and no more than lie between them and a pressed clamp.
            let mut to = from + 1;
            while to < len
                && to - from < MERGED
                && fine.get(to - 1).is_some_and(|place| !place.element.stop)
                && !(pressed[0] && to - from >= from.max(1))
                && !(pressed[1] && to - from >= (len - 1 - to).max(1))
            {
                to += 1;
            }
            let Some(place) = rest.get_mut(made) else { break };
            place.element = Element::merge(fine.get(from..to).unwrap_or_default());
            // What is rigid to coarse elements makes them touch here and there: it is for the finer ones.
            if pressed == [false; 2] {
                let most = T::of(SHARPEST) * place.element.own();
                place.element.soften(model.foundation().law, most);
            }
            made += 1;
            from = to;
        }
        // Out of room, or breaks leave nothing to gain.
        if from < len || made * 4 > len * 3 {
            break;
        }
        let _ = levels.try_push((start + len, made));
    }
    levels
}

/// The state of a coarser mesh, on the next finer one: the same cubics.
fn prolong<T: Real, M: Model<T>>(fine: &mut [Place<T, M>], coarse: &[Place<T, M>], current: usize) {
    let mut parts = fine.iter_mut();
    for Place { element, work } in coarse {
        let State { e, d } = work.states[current];
        let whole = Motion::new(element.h, e, d);
        let mut right = T::one();
        for _ in 0..element.children {
            let Some(part) = parts.next() else { return };
            let share = part.element.h / element.h;
            right = (right - share).max(T::zero());
            let motion = whole.part(right, share);
            part.work.states[0] = State { e: motion.e, d: motion.d };
        }
    }
}

/// The ends of the beam as the penetration sees them: xi = xi' = 0, so eta = -s.
pub(super) fn clamp<T: Real, M: Model<T>>(model: &M, x: T, mid: T) -> End<T, crate::sweep::pair::Bending> {
    let [s, slope, _] = model.foundation().gap.jet(x, mid);
    End { held: [true, true], value: -T::Vec2::of(s, slope), condensed: Condensed::default() }
}

/// Both ends of the beam that was laid into `places`.
pub(crate) fn ends<T: Real, M: Model<T>>(model: &M, places: &[Place<T, M>]) -> [End<T, Bending>; 2] {
    let (length, half) = (model.length(), T::of(0.5));
    let h = |place: Option<&Place<T, M>>| place.map_or(length, |place| place.element.h);
    [
        clamp(model, T::zero(), half * h(places.first())),
        clamp(model, length, length - half * h(places.last())),
    ]
}

/// Is the beam's left end, its right end pressed into the foundation before anything bends?
fn pressed<T: Real, M: Model<T>>(model: &M, places: &[Place<T, M>]) -> [bool; 2] {
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return [false; 2] };
    let (length, half) = (model.length(), T::of(0.5));
    let pressed = |x: T, mid: T, inwards: T| {
        let [s, slope, _] = model.foundation().gap.jet(x, mid);
        s < T::zero() || (s == T::zero() && inwards * slope < T::zero())
    };
    [
        pressed(T::zero(), half * first.element.h, T::one()),
        pressed(length, length - half * last.element.h, -T::one()),
    ]
}

/// How a solve ended, and where in memory its answer is.
pub(crate) struct Answer<T: Real, M: Model<T>> {
    pub(crate) report: Report<T>,
    /// Which of the two states of each element.
    pub(crate) state: usize,
    /// Fields at the left end.
    pub(crate) left: Node<T, M>,
    /// Where the condensed parts meet, if they are those of the state.
    pub(crate) meeting: Option<usize>,
    /// The largest moment \[N m\]; zero where no history follows.
    pub(crate) size: T,
    /// The foundation was taken as one that is rigid to the elements.
    pub(crate) rigid: bool,
}

/// What the scene in `places` means for all meshes.
pub(crate) fn context<'a, T: Real, M: Model<T>>(
    model: &'a M,
    places: &[Place<T, M>],
    stop: T,
) -> Context<'a, T, M> {
    let [left, right] = ends(model, places);
    let first = places.first().filter(|_| places.iter().any(|place| place.element.is_driven(model)));
    Context {
        model,
        left,
        right,
        onto: first.map(|first| electric::Ratio::of(&first.element)),
        into: electric::conducts_into(places),
        quiet: quiet(model, places, stop),
    }
}

/// The smallest size of moments to compare with. The unknown is the penetration: where a gap is large beside the
/// bending, its rounding is a bending, too, and that of the moment that would bend the beam like the gap is in all
/// moments. What a residual of `stop` leaves need not be less than that.
pub(crate) fn quiet<T: Real, M: Model<T>>(model: &M, places: &[Place<T, M>], stop: T) -> T {
    if !M::Gap::PRESENT {
        return T::zero();
    }
    let (mut gap, mut bent, mut flexibility) = (T::zero(), T::zero(), T::zero());
    for Place { element, .. } in places {
        gap = gap.max(model.foundation().gap.value(element.right, element.x(T::of(0.5))).abs());
        bent = bent.max(element.bending.times(element.gap.bend::<T>()).y().abs());
        // The parts of a beam take a displacement of its ends in series.
        flexibility = flexibility + element.h / element.stiffness();
    }
    let most = bent.max(gap / model.length() / flexibility);
    // Below rounding a residual asks for nothing.
    let rounding = T::of(64.0) * T::epsilon();
    rounding / stop.max(rounding) * most
}

/// The work that `settings` allow on a mesh of so many elements.
pub(crate) fn budget<T: Real>(settings: &Settings<T>, elements: usize) -> Count {
    let most_visits = settings.max_visits.unwrap_or(400 * elements + 100_000);
    Count { iterations: 0, visits: 0, most_visits }
}

/// Do full steps from the free beam find the contact, without a continuation in the stiffness?
pub(crate) fn is_soft<T: Real, M: Model<T>>(model: &M, places: &[Place<T, M>]) -> bool {
    let most = |of: &dyn Fn(&Element<T, M>) -> T| places.iter().fold(T::zero(), |m, p| m.max(of(&p.element)));
    let law = model.foundation().law;
    let stiffness = most(&|element| law.coefficient(element.x(T::of(0.5)), element.x(T::of(0.5))));
    let soft = T::of(SOFT) * most(&Element::stiffness) / model.length().powi(4);
    M::Law::LINEAR && stiffness <= soft && pressed(model, places) == [false; 2]
}

/// Is no more than rounding left?
pub(crate) fn is_rounding<T: Real>(residual: &Residual<T>) -> bool {
    residual.relative() <= T::of(FLOOR) * residual.floor()
}

/// The first element that is beyond the number format: moments may balance where displacements or fluxes are, and where
/// all moments are below it nothing was balanced.
pub(crate) fn beyond<T: Real, M: Model<T>>(
    model: &M,
    places: &[Place<T, M>],
    state: usize,
    left: &Node<T, M>,
    residual: Option<&Residual<T>>,
) -> Option<usize> {
    let ratio = electric::Ratio::of(&places.first()?.element);
    // No element has the left end for its right node.
    if !left.is_finite(&ratio) {
        return Some(0);
    }
    let weightless = residual.is_some_and(|residual| residual.size == T::zero());
    let beyond =
        |place: &Place<T, M>| !place.is_finite(model, state, &ratio) || (weightless && place.is_bent(state));
    places.iter().position(beyond)
}

/// What the moments' balance does not tell: rounding of the potential, of fluxes and loads below the normal numbers, and of contact
/// forces that outweigh all moments; an end of the beam that is not where it is clamped. Relative as the residual is; of
/// less than `stop` it may be zero.
pub(crate) fn unseen<T: Real, M: Model<T>>(
    model: &M,
    places: &[Place<T, M>],
    state: usize,
    left: &Node<T, M>,
    residual: &Residual<T>,
    stop: T,
) -> T {
    let floor = if residual.floor() > T::of(BLIND) { residual.floor() } else { T::zero() };
    let fluxes = electric::rounding(places, left, stop).max(electric::faint(places, left, model.length()));
    let rounding = fluxes.max(residual.underflow(places.len(), model.length()));
    floor.max(rounding).max(loose(model, places, state))
}

/// How far the beam's ends are from where they are clamped, over its largest penetration, or slope: moments balance in a
/// beam that came loose, too. Zero where it is no more than half the digits.
fn loose<T: Real, M: Model<T>>(model: &M, places: &[Place<T, M>], state: usize) -> T {
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return T::zero() };
    let [left, right] = ends(model, places).map(|end| end.value);
    let size = |v: T::Vec2| [v.x().abs(), model.length() * v.y().abs()];
    let larger = |[a, b]: [T; 2], [c, d]: [T; 2]| [a.max(c), b.max(d)];
    let State { e, d } = first.work.states[state];
    let start = e + Bending::carry(first.element.h, d);
    let off = larger(size(start - left), size(last.work.states[state].d - right));
    // A slope that is only rounding is so of the penetration.
    let over = |[w, slope]: [T; 2]| (off[0] / w).max(off[1] / (w + slope));
    let few = T::epsilon().sqrt();
    let near = larger(size(left), size(d));
    if over(near) <= few {
        return T::zero();
    }
    let loose = over(places.iter().map(|place| size(place.work.states[state].d)).fold(near, larger));
    if loose <= few { T::zero() } else { loose }
}

impl<T: Real, M: Model<T>> Level<'_, '_, T, M> {
    /// The answer on the finest mesh, where an iteration ended so.
    fn answer(mut self, outcome: Result<Outcome, Halt>, stop: T, count: &Count) -> Answer<T, M> {
        if outcome != Ok(Outcome::Converged) {
            // What was best may have been so of a stage of a continuation, or by a sweep's reckoning.
            self.electric();
            self.assess();
        } else if !self.two_way() && (self.context.into || self.context.onto.is_none()) {
            self.electric();
        }
        let status = match outcome {
            Err(halt) => halt.into(),
            // Refined, the residual may be found to be larger than it was.
            Ok(Outcome::Converged) if self.best.is_some_and(|(_, best)| best.relative() <= stop) => {
                Status::Converged
            }
            // However the iteration ended, what is left tells which it is.
            Ok(_) if self.best.is_some_and(|(_, best)| is_rounding(&best)) => Status::ToleranceBelowFloor,
            Ok(_) => Status::Stagnation,
        };
        let best = self.best.as_ref().map(|(_, residual)| residual);
        let status = match beyond(self.context.model, self.places, self.current, &self.node, best) {
            Some(element) if status == Status::Converged => Status::Breakdown { element },
            _ => status,
        };
        let lost = self.best.map_or(T::zero(), |(_, r)| {
            unseen(self.context.model, self.places, self.current, &self.node, &r, stop)
        });
        let faint = status == Status::Converged && lost > stop;
        let residual = self.best.map_or(T::infinity(), |(_, r)| r.relative());
        let floor = self.best.map_or(T::zero(), |(_, r)| r.floor());
        let report = Report {
            status: if faint { Status::ToleranceBelowFloor } else { status },
            residual: if faint { lost } else { residual },
            floor: if faint { lost } else { floor },
            iterations: count.iterations,
            element_visits: count.visits,
            elements: self.places.len(),
        };
        let meeting = self.fresh.then_some(self.meeting);
        let size = self.best.map_or(T::zero(), |(_, r)| r.size);
        Answer { report, state: self.current, left: self.node, meeting, size, rigid: false }
    }
}

impl<T: Real, M: Model<T>> Clone for Answer<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for Answer<T, M> {}

/// Solves the scene that was laid into `places`.
///
/// Under a foundation so stiff that the elements cannot resolve how it gives way, the contact's edge is found by luck
/// if at all. Where a bounded share of the work does not find it, the foundation is taken as one that is just rigid
/// to the elements ([`Element::rigid`]); the answer says so.
pub(crate) fn solve<T: Real, M: Model<T>>(
    model: &M,
    places: &mut [Place<T, M>],
    levels: &Levels,
    settings: &Settings<T>,
) -> Result<Answer<T, M>, Error> {
    settings.validate()?;
    let Some(&(_, elements)) = levels.first() else {
        return Err(Error::Capacity { needed: 1, available: 0 });
    };
    let law = model.foundation().law;
    let too_stiff = |place: &Place<T, M>| {
        let (rigid, mid) = (place.element.rigid(), place.element.x(T::of(0.5)));
        let k = law.coefficient(mid, mid);
        law.at_most(k, rigid) < k
    };
    // A beam that is pressed in at a clamp has no rigid limit: the moment there grows with the stiffness.
    let rigid = M::Law::PRESENT
        && pressed(model, places.get(..elements).unwrap_or_default()) == [false; 2]
        && places.iter().take(elements).any(too_stiff);
    let mut count = budget(settings, elements);
    let (most, share) = (count.most_visits, 40 * elements + 5000);
    if rigid {
        count.most_visits = most.min(share);
    }
    let mut answer = descend(model, places, levels, settings, &mut count)?;
    let report = &mut answer.report;
    if rigid && share < most && report.status == Status::VisitLimit && report.residual <= report.floor {
        // The share was spent on nothing but rounding: the contact is found.
        report.status = Status::ToleranceBelowFloor;
    }
    // Where rounding is all that there is, nothing is solved.
    let solved = report.is_solved() && report.floor <= T::of(BLIND);
    if !rigid || solved || most < 2 * share {
        return Ok(answer);
    }
    count.most_visits = most;
    for &(start, len) in levels {
        soften(model, places.get_mut(start..start + len).unwrap_or_default());
    }
    let answer = descend(model, places, levels, settings, &mut count)?;
    Ok(Answer { rigid: true, ..answer })
}

/// Takes back what a solve did to the laws in `places` that found the foundation rigid.
pub(crate) fn harden<T: Real, M: Model<T>>(model: &M, places: &mut [Place<T, M>], levels: &Levels) {
    let Some(&(_, elements)) = levels.first() else { return };
    for place in places.iter_mut().take(elements) {
        place.element.harden(model.foundation().law);
    }
    coarsen(model, places, elements);
}

/// From the coarsest mesh to the finest.
fn descend<T: Real, M: Model<T>>(
    model: &M,
    places: &mut [Place<T, M>],
    levels: &Levels,
    settings: &Settings<T>,
    count: &mut Count,
) -> Result<Answer<T, M>, Error> {
    let elements = levels.first().map_or(0, |&(_, len)| len);
    let context = context(model, places.get(..elements).unwrap_or_default(), settings.stop);
    let mut outcome = Ok(Outcome::Stalled);
    let (mut state, mut size) = (0, T::zero());
    for (rank, &(start, len)) in levels.iter().enumerate().rev() {
        let coarsest = rank + 1 == levels.len();
        let Some((head, tail)) = places.split_at_mut_checked(start + len) else { break };
        let mesh = head.get_mut(start..).unwrap_or_default();
        if coarsest {
            for place in mesh.iter_mut() {
                place.work.states = States::default();
            }
        } else if let Some(&(_, coarse_len)) = levels.get(rank + 1) {
            prolong(mesh, tail.get(..coarse_len).unwrap_or_default(), state);
        }
        let mut level = Level::new(&context, mesh);
        level.size = size;
        if M::Mu1::PRESENT && context.onto.is_some() && !context.into {
            level.electric();
        }
        // A halt on a coarser mesh is one on all: what it found is only carried on.
        if outcome.is_ok() {
            let finest = rank == 0;
            let goal = Goal { stop: if finest { settings.stop } else { T::of(CLOSE) }, finest };
            outcome = if coarsest { level.begin(goal, count) } else { level.proceed(goal, count) };
            if rank == 0 && outcome == Ok(Outcome::Converged) {
                outcome = level.refine(level.polished(), count).map(|()| Outcome::Converged);
            }
        }
        if rank == 0 {
            return Ok(level.answer(outcome, settings.stop, count));
        }
        (state, size) = (level.current, level.size);
    }
    Err(Error::Capacity { needed: 1, available: 0 })
}

/// Solves on a mesh whose elements are in the state of a coarser one, whose foundation was taken as `rigid` or not, and
/// polishes what is left to so many `units` in the last place.
pub(crate) fn sharpen<T: Real, M: Model<T>>(
    model: &M,
    places: &mut [Place<T, M>],
    rigid: bool,
    units: T,
    settings: &Settings<T>,
) -> Answer<T, M> {
    if rigid {
        // What is rigid to an element is so to smaller ones when it is stiffer.
        soften(model, places);
    }
    let mut count = budget(settings, places.len());
    let context = context(model, places, settings.stop);
    let mut level = Level::new(&context, places);
    if context.onto.is_some() && !context.into {
        level.electric();
    }
    let goal = Goal { stop: settings.stop, finest: true };
    let mut outcome = level.join_in(goal, &mut count);
    if outcome == Ok(Outcome::Stalled) {
        outcome = level.proceed(goal, &mut count);
    }
    if outcome == Ok(Outcome::Converged) {
        outcome = level.refine(units, &mut count).map(|()| Outcome::Converged);
    }
    Answer { rigid, ..level.answer(outcome, settings.stop, &count) }
}

/// Takes the foundation for one that is at most as stiff as is rigid to each element.
fn soften<T: Real, M: Model<T>>(model: &M, places: &mut [Place<T, M>]) {
    for place in places {
        let most = place.element.rigid();
        place.element.soften(model.foundation().law, most);
    }
}

/// How far each node moves under a uniform load, the contact as it is: the step goes into the spare state of each
/// element. The load is the one that would move the free beam by `most`.
pub(crate) fn compliance<T: Real, M: Model<T>>(
    model: &M,
    places: &mut [Place<T, M>],
    answer: &Answer<T, M>,
    most: T,
) -> Option<T> {
    let context = context(model, places, T::one());
    let mut level = Level::new(&context, places);
    (level.current, level.node) = (answer.state, answer.left);
    let load = T::of(384.0) * level.bending() / model.length().powi(4) * most;
    (load > T::zero() && level.yielding(load)).then_some(load)
}

/// What is left of the last solve on a mesh.
pub(crate) struct Last<T: Real, M: Model<T>> {
    state: usize,
    left: Node<T, M>,
    meeting: Option<usize>,
    size: T,
    /// Values at the clamps, and the truncations.
    ends: [T::Vec2; 2],
    bounds: [T; 2],
}

impl<T: Real, M: Model<T>> Last<T, M> {
    pub(crate) fn of(answer: &Answer<T, M>, model: &M, places: &[Place<T, M>]) -> Self {
        Self {
            state: answer.state,
            left: answer.left,
            meeting: answer.meeting,
            size: answer.size,
            ends: ends(model, places).map(|end| end.value),
            bounds: bounds(model),
        }
    }
}

fn bounds<T: Real, M: Model<T>>(model: &M) -> [T; 2] {
    let conduction = model.conduction();
    [conduction.truncation, conduction.potential_truncation]
}

/// Solves a scene from the last solution of another one on the same mesh, of which the elements `changed`
/// differ. Only these, and those whose contact changes, are swept. `None` where the beam's ends are held
/// elsewhere, or where there are no sweeps that would see what is not joined: then from nothing.
pub(crate) fn follow<T: Real, M: Model<T>>(
    model: &M,
    places: &mut [Place<T, M>],
    last: &Last<T, M>,
    mut changed: Range<usize>,
    settings: &Settings<T>,
) -> Option<Answer<T, M>> {
    let context = context(model, places, settings.stop);
    let elements = places.len();
    if [context.left.value, context.right.value] != last.ends || elements < 3 {
        return None;
    }
    let mut count = budget(settings, elements);
    let mut level = Level::new(&context, places);
    (level.current, level.node, level.size) = (last.state, last.left, last.size);
    if let Some(meeting) = last.meeting {
        (level.meeting, level.fresh) = (meeting, true);
    }
    if context.onto.is_some() {
        level.electric();
    }
    let mut outcome = Ok(Outcome::Stalled);
    if bounds(model) != last.bounds {
        changed = 0..elements;
    } else if changed.is_empty() {
        // The old solution may be the new one.
        outcome = level.holds(settings.stop, &mut count);
        changed = level.changed(false);
    } else {
        let touched = level.changed(false);
        if !touched.is_empty() {
            changed = changed.start.min(touched.start)..changed.end.max(touched.end);
        }
    }
    // Not refined: a step for an increment would leave the condensed parts to be made anew.
    let goal = Goal { stop: settings.stop, finest: true };
    if outcome == Ok(Outcome::Stalled) {
        outcome = level.iterate_from(changed, T::one(), goal, 4 * STAGE, &mut count);
    }
    Some(level.answer(outcome, settings.stop, &count))
}

impl<T: Real> Goal<T> {
    /// To have a start for a finer mesh, or the next stage of a continuation.
    fn start() -> Self {
        Self { stop: T::of(ROUGH), finest: false }
    }
}

impl<T: Real, M: Model<T>> Level<'_, '_, T, M> {
    /// From nothing.
    fn begin(&mut self, goal: Goal<T>, count: &mut Count) -> Result<Outcome, Halt> {
        // What the type rules out is not compiled: the coupled method is half of the code.
        if !M::Mu1::PRESENT || self.context.onto.is_none() {
            return self.cold(goal, count);
        }
        // Without the potential's action the state is the least of a convex energy: the start for the rest.
        let Context { model, left, right, into, quiet, .. } = *self.context;
        let alone = Context { model, left, right, onto: None, into, quiet };
        let mut level = Level::new(&alone, self.places);
        level.current = self.current;
        level.cold(Goal::start(), count)?;
        (self.current, self.meeting, self.fresh) = (level.current, level.meeting, level.fresh);
        (self.located, self.size) = (false, level.size);
        let most = if goal.finest { 4 * STAGE } else { STAGE };
        let outcome = self.iterate(T::one(), goal, most, count)?;
        if outcome == Outcome::Stalled && self.convex() {
            return self.climb_from(goal, count);
        }
        Ok(outcome)
    }

    /// From near the solution, where bending and potential hold each other: the monolithic method alone.
    fn join_in(&mut self, goal: Goal<T>, count: &mut Count) -> Result<Outcome, Halt> {
        if !self.two_way() {
            return Ok(Outcome::Stalled);
        }
        self.electric();
        if self.convex() {
            Ok(Outcome::Stalled)
        } else {
            self.descend_coupled(T::one(), goal.stop, STAGE, count)
        }
    }

    /// From where a coarser mesh ended.
    fn proceed(&mut self, goal: Goal<T>, count: &mut Count) -> Result<Outcome, Halt> {
        let mut outcome = Outcome::Stalled;
        if goal.finest && self.is_fine() {
            outcome = self.advance(goal.stop, count)?;
        }
        if outcome == Outcome::Stalled {
            outcome = self.iterate(T::one(), goal, STAGE, count)?;
        }
        if outcome != Outcome::Stalled {
            Ok(outcome)
        } else if self.convex() {
            // The contact's edges are known to a few elements: soften until its layers are as wide.
            self.climb_from(goal, count)
        } else if goal.finest {
            // The coarser meshes misled: start anew on this one.
            for place in self.places.iter_mut() {
                place.work.states = States::default();
            }
            self.located = false;
            self.begin(goal, count)
        } else {
            Ok(outcome)
        }
    }

    /// From nothing, for bending alone: the free beam, then a continuation in the stiffness as far as it is needed.
    fn cold(&mut self, goal: Goal<T>, count: &mut Count) -> Result<Outcome, Halt> {
        self.free(count)?;
        if !M::Law::PRESENT {
            return self.iterate(T::one(), goal, STAGE, count);
        }
        let soft = T::of(SOFT) * self.bending() / self.context.model.length().powi(4);
        let stiffness = self.stiffness();
        if !M::Law::LINEAR && soft / stiffness <= T::epsilon() * T::epsilon() {
            // The law is all but infinite under the free beam: from the straight one, steps that are cut.
            self.straighten();
            self.lower(T::of(ROUGH), T::one(), goal.stop, count)?;
            return self.iterate(T::one(), goal, usize::MAX, count);
        }
        // A stiffness beyond all bounds makes the first scale zero.
        self.climb((soft / stiffness).max(T::min_positive_value()), stiffness, true, goal, count)
    }

    /// From where a coarser mesh ended, and full steps did not help: a continuation that starts with layers
    /// as wide as that mesh's elements.
    fn climb_from(&mut self, goal: Goal<T>, count: &mut Count) -> Result<Outcome, Halt> {
        let stiffness = self.stiffness();
        let widest = self.places.iter().fold(T::zero(), |m, p| m.max(p.element.h)) * T::of(MERGED as f64);
        let scale = T::of(4.0) * self.bending() / stiffness / widest.powi(4);
        if M::Mu1::PRESENT && scale >= T::one() && self.context.onto.is_some() {
            // Not the contact's layers: the potential's action is what does not settle.
            return self.descend_coupled(
                T::one(),
                goal.stop,
                if goal.finest { 4 * STAGE } else { STAGE },
                count,
            );
        }
        self.climb(scale.max(T::min_positive_value()), stiffness, false, goal, count)
    }

    /// The largest bending stiffness \[N m^2\].
    fn bending(&self) -> T {
        self.places.iter().fold(T::zero(), |m, p| m.max(p.element.stiffness()))
    }

    /// The continuation in the stiffness, which is `stiffness` at most, from `scale` times it.
    fn climb(
        &mut self,
        mut scale: T,
        stiffness: T,
        cold: bool,
        goal: Goal<T>,
        count: &mut Count,
    ) -> Result<Outcome, Halt> {
        if scale < T::one() {
            let n = self.places.len();
            let length = self.context.model.length();
            let layer = T::of(4.0) * (T::of(4.0) * self.bending() / stiffness).sqrt().sqrt();
            let pressed = pressed(self.context.model, self.places);
            if pressed[0] {
                self.scaled.start =
                    self.places.iter().position(|p| p.element.right > layer).unwrap_or(n - 1) + 1;
            }
            if pressed[1] {
                self.scaled.end = self
                    .places
                    .iter()
                    .position(|p| p.element.right >= length - layer)
                    .unwrap_or(n - 1)
                    .max(self.scaled.start);
            }
            if cold && self.scaled != (0..n) {
                self.iterate(T::zero(), Goal::start(), 4 * STAGE, count)?;
            }
        }
        // A convex stage that stalls ends by itself.
        let stage = if self.convex() { 4 * STAGE } else { STAGE };
        let mut stride = T::of(STRIDE);
        let mut reached = T::zero();
        while scale < T::one() {
            let before = count.iterations;
            if self.iterate(scale, Goal::start(), stage, count)? == Outcome::Stalled {
                // Too far: half the way in the exponent, from where the failed stage ended.
                if stride <= T::of(SHORTEST) || reached == T::zero() {
                    break;
                }
                stride = stride.sqrt();
            } else {
                reached = scale;
                let quick = count.iterations <= before + 1;
                stride = if quick { stride * stride } else { (stride * stride).min(T::of(STRIDE)) };
            }
            scale = reached * stride;
        }
        let most = match (goal.finest, self.convex()) {
            (true, true) => usize::MAX,
            (true, false) => 4 * STAGE,
            _ => STAGE,
        };
        self.iterate(T::one(), goal, most, count)
    }

    /// The beam without any deflection.
    fn straighten(&mut self) {
        self.located = false;
        let gap = self.context.model.foundation().gap;
        for Place { element, work } in self.places.iter_mut() {
            let [s, slope, _] = gap.jet(element.right, element.x(T::of(0.5)));
            let straight = State { e: -element.gap.bend::<T>(), d: -T::Vec2::of(s, slope) };
            work.states[self.current] = straight;
        }
    }

    /// The largest tangent stiffness of the law under the current penetration \[N/m^2\]; infinite where it is
    /// no number.
    fn stiffness(&self) -> T {
        let law = self.context.model.foundation().law;
        let mut most = T::zero();
        for Place { element, work } in self.places.iter() {
            let State { e, d } = work.states[self.current];
            let eta = Motion::new(element.h, e, d).cubic();
            for t in [0.0, 0.25, 0.5, 0.75, 1.0].map(T::of) {
                let r = eta.at(t);
                if r > T::zero() {
                    let (_, slope) = law.pressure(element.law.at(t), element.x(t), r);
                    most = if slope.is_finite() { most.max(slope) } else { T::infinity() };
                }
            }
        }
        most
    }
}
