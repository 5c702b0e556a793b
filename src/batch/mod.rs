//! Many scenes on one mesh at once: each arithmetic operation is done for `L` scenes, which a target with wide vector
//! registers does as fast as for one.
//!
//! What scenes of one kind have in common is the order of the operations: the sweeps of a nested iteration with full
//! steps. Scenes that need more than that are solved alone, by the solver for one scene: where the foundation is so stiff
//! that contact is found by a continuation, or curved, where the potential acts on bending, where a clamp is pressed
//! in, and where the residual says that the steps in lockstep did not do. So a status means the same as always.

mod lanes;
mod lockstep;

use crate::electric;
use crate::error::Error;
use crate::law::Compliance;
use crate::mesh::Mesh;
use crate::newton::nested::{self, Answer, Levels};
use crate::newton::{Report, Residual, Settings, Status};
use crate::problem;
use crate::profile::{Piece, Profile};
use crate::real::{Pair, Real};
use crate::scene::{self, Model};
use crate::solution::Solution;
use crate::storage::{Place, State};
use crate::sweep::{Condensed, End};
use alloc::vec::Vec;
use arrayvec::ArrayVec;
use lanes::{Lanes, Two};
use lockstep::{Lockstep, Slot, prolong};

/// Steps on a coarser mesh, at most and until the last one is so short.
const COARSE_STEPS: usize = 12;
const CLOSE: f64 = 1e-4;
/// Steps on the finest mesh, at most; from a step so short on statics is asked whether it was the last.
const FINE_STEPS: usize = 5;
const SHORT: f64 = 1e-4;

/// Memory for `L` scenes at once. Eight lanes fill the registers of AVX-512 with `f64`, four those of AVX2: build with
/// `-C target-cpu=native`, or the lanes take their turns.
///
/// ```
/// use piezobeam::{Batch, Beam, Foundation, Linear, Load, Mesh, Scene, Settings, Status};
///
/// let scenes: Vec<_> = (1..=20)
///     .map(|i| {
///         Scene::new(1.0_f64, Beam::elastic(5000.0))
///             .foundation(Foundation { law: Linear(1e6 * f64::from(i)), gap: () })
///             .load(Load { transverse: 1e6, axial: (), points: () })
///     })
///     .collect();
/// let mut batch = Batch::<f64, _, 8>::new();
/// let mut deepest = Vec::new();
/// batch.solve(&scenes, &Mesh::uniform(64), &Settings::default(), |_, solution| {
///     let solution = solution.expect("these scenes are sound");
///     assert_eq!(solution.report().status, Status::Converged);
///     deepest.push(solution.at(0.5).bending);
/// })?;
/// assert_eq!(deepest.len(), 20);
/// assert!(deepest.windows(2).all(|pair| pair[1] < pair[0]));
/// # Ok::<(), piezobeam::Error>(())
/// ```
pub struct Batch<T: Real, M: Model<T>, const L: usize> {
    /// Those of each lane, one lane after the other.
    places: Vec<Place<T, M>>,
    slots: Vec<Slot<T, L>>,
    lanes: Vec<Lane<T, M>>,
}

/// What is known of one scene.
struct Lane<T: Real, M: Model<T>> {
    levels: Levels,
    /// It takes part in the lockstep.
    joins: bool,
    outcome: Result<Option<Answer<T, M>>, Error>,
}

impl<T: Real, M: Model<T>> Lane<T, M> {
    /// Elements of the finest mesh.
    fn elements(&self) -> usize {
        self.levels.first().map_or(0, |&(_, len)| len)
    }
}

impl<T: Real, M: Model<T>, const L: usize> Default for Batch<T, M, L> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, M: Model<T>, const L: usize> Batch<T, M, L> {
    /// No memory yet: it grows when scenes are laid into it.
    #[must_use]
    pub fn new() -> Self {
        const { assert!(L > 0, "a batch has one lane at least") };
        Self { places: Vec::new(), slots: Vec::new(), lanes: Vec::new() }
    }

    /// Solves all `scenes`, `L` at a time, and gives each solution, or what is wrong with its scene, to `each`, in order.
    ///
    /// # Errors
    /// Settings out of range.
    pub fn solve(
        &mut self,
        scenes: &[M],
        mesh: &Mesh<'_, T>,
        settings: &Settings<T>,
        mut each: impl FnMut(usize, Result<Solution<'_, T, M>, Error>),
    ) -> Result<(), Error> {
        for (turn, group) in scenes.chunks(L).enumerate() {
            let mut group = self.prepare(group, mesh)?;
            group.solve(settings)?;
            for lane in 0..group.len() {
                each(turn * L + lane, group.solution(lane));
            }
        }
        Ok(())
    }

    /// Lays up to `L` scenes into memory and samples them on the mesh. What is wrong with one of them does not keep the
    /// others, and is told by [`Group::solution`].
    ///
    /// # Errors
    /// More than `L` scenes.
    pub fn prepare<'s>(
        &'s mut self,
        scenes: &'s [M],
        mesh: &Mesh<'_, T>,
    ) -> Result<Group<'s, T, M, L>, Error> {
        if scenes.len() > L {
            return Err(Error::Capacity { needed: scenes.len(), available: L });
        }
        let checked = |scene: &M| {
            scene::validate(scene)?;
            mesh.validate(scene.length())?;
            mesh.count(scene)
        };
        let mut counts: ArrayVec<_, L> = ArrayVec::new();
        for scene in scenes {
            let _ = counts.try_push(checked(scene));
        }
        let most = counts.iter().flatten().copied().max().unwrap_or(0);
        // As much as the coarser meshes need, too.
        let stride = most.saturating_add(most / 3).saturating_add(64);
        let needed = stride.saturating_mul(scenes.len());
        let lacks = needed.saturating_sub(self.places.len());
        if lacks > 0 && self.places.try_reserve_exact(lacks).is_err() {
            return Err(Error::Capacity { needed, available: self.places.len() });
        }
        self.places.resize(needed.max(self.places.len()), Place::default());
        self.lanes.clear();
        for ((scene, checked), places) in scenes.iter().zip(counts).zip(self.places.chunks_mut(stride)) {
            let laid = checked.and_then(|_| problem::lay(scene, mesh, places));
            let (levels, outcome) = match laid {
                Ok((_, levels)) => (levels, Ok(None)),
                Err(error) => (Levels::new(), Err(error)),
            };
            self.lanes.push(Lane { levels, joins: false, outcome });
        }
        let mut group = Group { batch: self, scenes, stride };
        group.pack();
        Ok(group)
    }
}

/// Up to `L` scenes laid into memory, ready to be solved, again and again.
pub struct Group<'s, T: Real, M: Model<T>, const L: usize> {
    batch: &'s mut Batch<T, M, L>,
    scenes: &'s [M],
    /// Places of each lane.
    stride: usize,
}

impl<T: Real, M: Model<T>, const L: usize> Group<'_, T, M, L> {
    /// How many scenes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.scenes.len()
    }

    /// None at all?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.scenes.is_empty()
    }

    /// How many of them are solved in lockstep, if that converges.
    #[must_use]
    pub fn in_lockstep(&self) -> usize {
        self.batch.lanes.iter().filter(|lane| lane.joins).count()
    }

    /// The solution of scene `lane`, which the last [`Group::solve`] has left.
    ///
    /// # Errors
    /// What is wrong with the scene, or that it is none of this group's or was not solved.
    pub fn solution(&self, lane: usize) -> Result<Solution<'_, T, M>, Error> {
        let nothing = Error::Capacity { needed: lane + 1, available: self.scenes.len() };
        let (Some(scene), Some(known)) = (self.scenes.get(lane), self.batch.lanes.get(lane)) else {
            return Err(nothing);
        };
        let answer = known.outcome?.ok_or(nothing)?;
        Ok(Solution::new(scene, self.of(lane).get(..known.elements()).unwrap_or_default(), answer))
    }

    /// Places of a lane.
    fn of(&self, lane: usize) -> &[Place<T, M>] {
        let start = lane * self.stride;
        self.batch.places.get(start..start + self.stride).unwrap_or_default()
    }

    /// Finds the lanes that can go in lockstep, and packs their elements.
    fn pack(&mut self) {
        let sound = |l: usize| {
            let (Some(scene), Some(lane)) = (self.scenes.get(l), self.batch.lanes.get(l)) else {
                return false;
            };
            let places = self.of(l).get(..lane.elements()).unwrap_or_default();
            !places.is_empty()
                && nested::is_soft(scene, places)
                && !(M::Mu1::PRESENT && electric::conducts_onto(places))
        };
        let Some(lead) = (0..self.len()).find(|&l| sound(l)) else { return };
        let Some(levels) = self.batch.lanes.get(lead).map(|lane| lane.levels.clone()) else { return };
        let Some(&(start, len)) = levels.last() else { return };
        let all = start + len;
        let same = |l: usize| {
            let Some(lane) = self.batch.lanes.get(l) else { return false };
            let mut pairs = self.of(l).iter().zip(self.of(lead)).take(all);
            lane.levels == levels && pairs.all(|(one, other)| one.element.covers(&other.element))
        };
        let joins: [bool; L] = core::array::from_fn(|l| sound(l) && same(l));
        let Batch { slots, places, lanes } = &mut *self.batch;
        slots.resize(all, Slot::default());
        // Lanes without a scene of their own go with the first.
        let own = |l: usize| if joins.get(l) == Some(&true) { l } else { lead };
        let of: [_; L] = core::array::from_fn(|l| places.get(own(l) * self.stride..).unwrap_or_default());
        for (i, slot) in slots.iter_mut().enumerate() {
            for (l, places) in of.iter().enumerate() {
                if let Some(place) = places.get(i) {
                    slot.pack(l, &place.element);
                }
            }
        }
        for (lane, joins) in lanes.iter_mut().zip(joins) {
            lane.joins = joins;
        }
    }

    /// Solves all scenes from nothing.
    ///
    /// # Errors
    /// Settings out of range.
    ///
    /// # Cost
    /// Of scenes in lockstep, that of as many steps as the slowest needs; no allocation.
    pub fn solve(&mut self, settings: &Settings<T>) -> Result<(), Error> {
        settings.validate()?;
        let (iterations, visits) = self.run(settings);
        let Self { batch, scenes, stride } = self;
        for ((lane, scene), places) in
            batch.lanes.iter_mut().zip(*scenes).zip(batch.places.chunks_mut(*stride))
        {
            let elements = lane.elements();
            if let Ok(outcome @ None) = &mut lane.outcome {
                let most = nested::budget(settings, elements).most_visits;
                let spent = if lane.joins { visits.min(most) } else { 0 };
                let rest = Settings { max_visits: Some(most - spent), ..*settings };
                let mut answer = nested::solve(scene, places, &lane.levels, &rest)?;
                answer.report.element_visits += spent;
                answer.report.iterations += if lane.joins { iterations } else { 0 };
                *outcome = Some(answer);
            }
        }
        Ok(())
    }

    /// Solves in lockstep what can be, and leaves the rest without an answer; iterations and visits of each.
    fn run(&mut self, settings: &Settings<T>) -> (usize, usize) {
        for (lane, (scene, places)) in
            self.batch.lanes.iter_mut().zip(self.scenes.iter().zip(self.batch.places.chunks_mut(self.stride)))
        {
            if let Ok(Some(last)) = &lane.outcome {
                if last.rigid {
                    nested::harden(scene, places, &lane.levels);
                }
                lane.outcome = Ok(None);
            }
        }
        let Some((lead, lane)) = self.batch.lanes.iter().enumerate().find(|(_, lane)| lane.joins) else {
            return (0, 0);
        };
        let levels = lane.levels.clone();
        let Some(&(_, elements)) = levels.first() else { return (0, 0) };
        // The free beam, and statics after each step.
        let work = levels.iter().map(|&(_, len)| (1 + 2 * COARSE_STEPS) * len).sum::<usize>();
        if work > nested::budget(settings, elements).most_visits {
            return (0, 0);
        }
        let joins: [bool; L] =
            core::array::from_fn(|l| self.batch.lanes.get(l).is_some_and(|lane| lane.joins));
        let own = |l: usize| if joins.get(l) == Some(&true) { l } else { lead };
        let Some(first) = self.scenes.get(lead) else { return (0, 0) };
        let scenes: [&M; L] = core::array::from_fn(|l| self.scenes.get(own(l)).unwrap_or(first));
        let mut slots = core::mem::take(&mut self.batch.slots);
        let places: [&[Place<T, M>]; L] = core::array::from_fn(|l| self.of(own(l)));
        let (mut iterations, mut visits) = (0, 0);
        let residuals = lockstep(scenes, places, &mut slots, &levels, settings, &mut iterations, &mut visits);
        for l in (0..L).filter(|&l| joins.get(l) == Some(&true)) {
            let Some(residual) = residuals.as_ref().and_then(|all| all.get(l)) else { continue };
            let Some(places) = self.batch.places.get_mut(l * self.stride..(l + 1) * self.stride) else {
                continue;
            };
            let places = places.get_mut(..elements).unwrap_or_default();
            // No moments at all are left to the solver that knows what to make of them.
            let good =
                residual.is_finite() && residual.relative() <= settings.stop && !residual.is_weightless();
            if !good {
                continue;
            }
            for (slot, place) in slots.iter().zip(places.iter_mut()) {
                place.work.states[0] = State { e: slot.state.e.lane(l), d: slot.state.d.lane(l) };
            }
            let Some(scene) = self.scenes.get(l) else { continue };
            let left = electric::solve::<T, M, true>(scene, places, 0);
            let looked = !electric::present::<T, M>() && <M::Bending as Profile<T>>::Piece::FLAT;
            let lost = nested::unseen(scene, places, 0, &left, residual, settings.stop) > settings.stop;
            if lost || (!looked && nested::beyond(scene, places, 0, &left, Some(residual)).is_some()) {
                continue;
            }
            let report = Report {
                status: Status::Converged,
                residual: residual.relative(),
                floor: residual.floor(),
                iterations,
                element_visits: visits,
                elements,
            };
            let answer = Answer { report, state: 0, left, meeting: None, size: T::zero(), rigid: false };
            if let Some(lane) = self.batch.lanes.get_mut(l) {
                lane.outcome = Ok(Some(answer));
            }
        }
        self.batch.slots = slots;
        (iterations, visits)
    }
}

/// From the coarsest mesh to the finest; the residuals by statics there.
fn lockstep<T: Real, M: Model<T>, const L: usize>(
    scenes: [&M; L],
    places: [&[Place<T, M>]; L],
    slots: &mut [Slot<T, L>],
    levels: &Levels,
    settings: &Settings<T>,
    iterations: &mut usize,
    visits: &mut usize,
) -> Option<[Residual<T>; L]> {
    let &(_, elements) = levels.first()?;
    let mesh = places.map(|places| places.get(..elements).unwrap_or_default());
    let ends: [_; L] = core::array::from_fn(|l| nested::ends(scenes[l], mesh[l]).map(|end| end.value));
    let end = |side: usize| End {
        held: [true, true],
        value: Two::of(Lanes::from_fn(|l| ends[l][side].x()), Lanes::from_fn(|l| ends[l][side].y())),
        condensed: Condensed::default(),
    };
    let (left, right) = (end(0), end(1));
    let quiet = Lanes::from_fn(|l| nested::quiet(scenes[l], mesh[l], settings.stop));
    let length = scenes.first()?.length();
    let mut found = None;
    let mut spoilt = [false; L];
    for (rank, &(start, len)) in levels.iter().enumerate().rev() {
        let (head, tail) = slots.split_at_mut_checked(start + len)?;
        let mesh = head.get_mut(start..)?;
        let coarsest = rank + 1 == levels.len();
        if !coarsest {
            let &(_, coarse) = levels.get(rank + 1)?;
            prolong(mesh, tail.get(..coarse)?);
        }
        let behind = places.map(|places| places.get(start..).unwrap_or_default());
        let mut level = Lockstep { scenes, places: behind, left, right, slots: mesh, spoilt };
        let mut steps = 0;
        let mut sweep = |level: &mut Lockstep<'_, T, M, L>, touches: bool| {
            steps += 1;
            level.step(touches)
        };
        if coarsest {
            sweep(&mut level, false)?;
        }
        let most = if coarsest { COARSE_STEPS } else { FINE_STEPS };
        let bound = |moved: Lanes<T, L>, most: f64| moved.0.iter().all(|&moved| moved <= T::of(most));
        if rank > 0 {
            for _ in 0..COARSE_STEPS {
                if bound(sweep(&mut level, true)?, CLOSE) {
                    break;
                }
            }
        } else {
            let mut close = !M::Law::PRESENT;
            for _ in 0..most {
                if !close {
                    close = bound(sweep(&mut level, true)?, SHORT);
                }
                if close {
                    *visits += len;
                    found = level.balance(quiet, length);
                    let done = |residual: &Residual<T>| residual.relative() <= settings.stop;
                    if !M::Law::PRESENT || found.as_ref()?.iter().all(done) {
                        break;
                    }
                    close = false;
                }
            }
        }
        spoilt = level.spoilt;
        *iterations += steps;
        *visits += steps * len;
    }
    let mut found = found?;
    for (residual, spoilt) in found.iter_mut().zip(spoilt) {
        if spoilt {
            *residual = Residual::of(T::infinity(), T::one(), T::zero(), T::infinity());
        }
    }
    Some(found)
}
