//! Nested meshes: the coarsest finds the contact, finer ones sharpen it.
//!
//! A cold start with full steps creeps: when the foundation is nearly rigid each iteration moves the
//! contact edge by one boundary layer. On a few dozen elements a continuation in the stiffness is cheap and
//! finds the edge; the cubic of a coarse element stays a cubic when the element is divided, so each finer
//! mesh starts where the coarser one ended, and one to four iterations are left for it. The work is then a
//! few sweeps over the finest mesh, whatever the stiffness.

use super::{Context, Count, Halt, Level, Outcome, Report, Settings, Status};
use crate::element::Element;
use crate::element::hermite::Motion;
use crate::law::Compliance;
use crate::profile::{Piece, Profile, Smooth};
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::storage::{Node, Place, State};
use crate::sweep::{Condensed, End};
use crate::{Error, electric};
use arrayvec::ArrayVec;

/// Elements of a mesh that are merged into one of the next coarser mesh.
const MERGED: usize = 4;
/// A mesh of so many elements is not coarsened further.
const COARSEST: usize = 40;
/// Meshes at most: 4^16 times the coarsest is more than any memory.
const MOST_LEVELS: usize = 16;
/// Relative residual at which a coarser mesh, or a stage of the continuation, has done its part.
const ROUGH: f64 = 1e-4;
/// Iterations granted to one stage or coarser mesh.
const STAGE: usize = 15;
/// Stages of the continuation closer than this factor are not tried.
const SHORTEST: f64 = 1.2;
/// Factor between stages of the continuation in the stiffness.
const STRIDE: f64 = 100.0;
/// Stiffness k L^4 / C with which the continuation starts: contact is a few boundary layers wide.
const SOFT: f64 = 1e5;

/// Where each mesh lies in memory, finest first.
pub(crate) type Levels = ArrayVec<(usize, usize), MOST_LEVELS>;

/// Builds coarser meshes behind the finest one, which takes the first `elements` places.
pub(crate) fn coarsen<T: Real, M: Model<T>>(places: &mut [Place<T, M>], elements: usize) -> Levels {
    let mut levels = Levels::new();
    levels.push((0, elements));
    while let Some(&(start, len)) = levels.last() {
        // Without contact the first solve is the last.
        let linear = !M::Law::PRESENT && !M::Mu1::PRESENT;
        if linear || len <= COARSEST || levels.is_full() {
            break;
        }
        let (fine, rest) = places[start..].split_at_mut(len);
        let mut made = 0;
        let mut from = 0;
        while from < len {
            // Up to four neighbours, none beyond a break.
            let mut to = from + 1;
            while to < len && to - from < MERGED && !fine[to - 1].element.stop {
                to += 1;
            }
            let Some(place) = rest.get_mut(made) else { break };
            let mut parts: ArrayVec<Element<T, M>, MERGED> = ArrayVec::new();
            parts.extend(fine[from..to].iter().map(|p| p.element));
            place.element = Element::merge(&parts);
            made += 1;
            from = to;
        }
        // Out of room, or breaks leave nothing to gain.
        if from < len || made * 4 > len * 3 {
            break;
        }
        levels.push((start + len, made));
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
fn clamp<T: Real, M: Model<T>>(model: &M, x: T, mid: T) -> End<T, crate::sweep::pair::Bending> {
    let [s, slope, _] = model.foundation().gap.jet(x, mid);
    End { held: [true, true], value: -T::Vec2::of(s, slope), condensed: Condensed::default() }
}

/// How a solve ended, and where in memory its answer is.
pub(crate) struct Answer<T: Real, M: Model<T>> {
    pub(crate) report: Report<T>,
    /// Which of the two states of each element.
    pub(crate) state: usize,
    /// Fields at the left end.
    pub(crate) left: Node<T, M>,
}

impl<T: Real, M: Model<T>> Clone for Answer<T, M> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T: Real, M: Model<T>> Copy for Answer<T, M> {}

/// Solves the scene that was laid into `places`.
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
    let length = model.length();
    let half = T::of(0.5);
    let (first, last) = (places[0].element, places[elements - 1].element);
    let context = Context {
        model,
        left: clamp(model, T::zero(), half * first.right),
        right: clamp(model, length, length - half * last.h),
        onto: electric::conducts_onto(&places[..elements]).then(|| electric::Ratio::of(&first)),
        into: electric::conducts_into(&places[..elements]),
    };
    let most_visits = settings.max_visits.unwrap_or(400 * elements + 100_000);
    let mut count = Count { iterations: 0, visits: 0, most_visits };

    let mut halted = None;
    let mut finest = None;
    for (rank, &(start, len)) in levels.iter().enumerate().rev() {
        let coarsest = rank + 1 == levels.len();
        let (head, tail) = places.split_at_mut(start + len);
        let mesh = &mut head[start..];
        if coarsest {
            for place in mesh.iter_mut() {
                place.work.states = [State::default(); 2];
            }
        } else {
            let (_, coarse_len) = levels[rank + 1];
            let coarse = &tail[..coarse_len];
            prolong(mesh, coarse, finest.map_or(0, |(current, _, _)| current));
        }
        let mut level = Level::new(&context, mesh);
        if context.onto.is_some() && !context.into {
            level.electric();
        }
        let stop = if rank == 0 { settings.stop } else { T::of(ROUGH) };
        let mut outcome = Ok(Outcome::Stalled);
        if halted.is_none() {
            outcome = if coarsest {
                level.cold(stop, rank == 0, &mut count)
            } else {
                level.iterate(T::one(), stop, STAGE, &mut count)
            };
            if rank == 0 && !coarsest && outcome == Ok(Outcome::Stalled) {
                // The coarser meshes misled: start anew on this one.
                for place in level.places.iter_mut() {
                    place.work.states = [State::default(); 2];
                }
                outcome = level.cold(stop, true, &mut count);
            }
            if rank == 0 && outcome == Ok(Outcome::Converged) {
                outcome = level.refine(&mut count).map(|()| Outcome::Converged);
            }
            if let Err(halt) = outcome {
                halted = Some(halt);
            }
        }
        if rank == 0 && (context.into || context.onto.is_none()) && !level.two_way() {
            level.electric();
        }
        if rank == 0 && halted.is_some() {
            level.assess();
        }
        finest = Some((level.current, level.node, (level.best, outcome)));
    }
    let Some((current, node, (best, outcome))) = finest else {
        return Err(Error::Capacity { needed: 1, available: 0 });
    };
    let status = match (halted, outcome) {
        (Some(halt), _) => halt.into(),
        (None, Err(halt)) => Halt::into(halt),
        (None, Ok(Outcome::Converged)) => Status::Converged,
        (None, Ok(Outcome::Floor)) => Status::ToleranceBelowFloor,
        (None, Ok(Outcome::Stalled)) => Status::Stagnation,
    };
    // Moments may balance where displacements or fluxes are beyond the number format.
    let ratio = electric::Ratio::of(&first);
    let status = match places[..elements].iter().position(|p| !p.is_finite(current, &ratio)) {
        Some(element) if status == Status::Converged => Status::Breakdown { element },
        _ => status,
    };
    let report = Report {
        status,
        residual: best.map_or(T::infinity(), |(_, r)| r.relative()),
        floor: best.map_or(T::zero(), |(_, r)| r.floor()),
        iterations: count.iterations,
        element_visits: count.visits,
        elements,
    };
    Ok(Answer { report, state: current, left: node })
}

impl<T: Real, M: Model<T>> Level<'_, '_, T, M> {
    /// From nothing: the free beam, then a continuation in the stiffness as far as it is needed.
    fn cold(&mut self, stop: T, finest: bool, count: &mut Count) -> Result<Outcome, Halt> {
        let rough = T::of(ROUGH);
        let changed = self.free(count)?;
        if !M::Law::PRESENT {
            return self.iterate_from(changed, T::one(), stop, STAGE, count);
        }
        let stiffness = self.stiffness()?;
        let length = self.context.model.length();
        let bending = self
            .places
            .iter()
            .fold(T::zero(), |m, p| m.max(p.element.bending.yy * p.element.h * T::of(0.25)));
        let soft = T::of(SOFT) * (bending / length / length / length / length);
        let mut scale = T::one().min(soft / stiffness);
        // A stiffness beyond all bounds makes the first scale zero, or a number that is none.
        scale = scale.max(T::min_positive_value());
        let mut stride = T::of(STRIDE);
        let mut reached = T::zero();
        while scale < T::one() {
            if self.iterate(scale, rough, STAGE, count)? == Outcome::Stalled {
                // Too far: half the way in the exponent, from where the failed stage ended.
                if stride <= T::of(SHORTEST) || reached == T::zero() {
                    break;
                }
                stride = stride.sqrt();
            } else {
                reached = scale;
                stride = (stride * stride).min(T::of(STRIDE));
            }
            scale = reached * stride;
        }
        let most = if finest { 4 * STAGE } else { STAGE };
        self.iterate(T::one(), stop, most, count)
    }

    /// The largest tangent stiffness of the law under the current penetration \[N/m^2\].
    fn stiffness(&self) -> Result<T, Halt> {
        let law = self.context.model.foundation().law;
        let mut most = T::zero();
        for (i, Place { element, work }) in self.places.iter().enumerate() {
            let State { e, d } = work.states[self.current];
            let eta = Motion::new(element.h, e, d).cubic();
            for t in [0.0, 0.25, 0.5, 0.75, 1.0].map(T::of) {
                let r = eta.at(t);
                if r > T::zero() {
                    let (_, slope) = law.pressure(element.law.at(t), element.x(t), r);
                    if slope.is_nan() {
                        return Err(Halt::Law(i, crate::element::contact::Fault::NotFinite));
                    }
                    most = most.max(slope);
                }
            }
        }
        Ok(most)
    }
}
