//! The contact's edges by themselves, before the rest of the beam: nonlinear elimination.
//!
//! Under a stiff foundation an edge of the contact moves by one of its boundary layers a step, and for each step all
//! between the outermost edges is condensed again and all of the beam substituted. But how the rest answers to an edge
//! is linear as long as its own contact is as it was, and known: the condensed parts on both sides have it. So once
//! a full step is condensed, the meeting point goes from edge to edge, and the few elements around each are iterated
//! alone until they are at rest, with the other edges as they were linearised. The full step that follows takes the
//! rest along. It alone is judged: what happened in between is no more than a better point to linearise at.
//!
//! Under a curved law all that touches changes with each step, and there is little to gain (`docs/speed.md`).

use super::{Count, Goal, Halt, Level, Solve, larger};
use crate::element::contact::Touch;
use crate::law::Compliance;
use crate::real::Real;
use crate::scene::Model;
use crate::storage::{Place, Work};
use arrayvec::ArrayVec;
use core::ops::Range;

/// Elements on both sides of an edge that are iterated with it: one into which it may move, and one that sees it come.
const MARGIN: usize = 2;
/// Groups of neighbouring edges at most: more are a beam that touches here and there, not edges on their way.
const GROUPS: usize = 8;
/// Steps for one group: some to find an edge that is far off, as the margin doubles, then Newton's few.
const STEPS: usize = 12;
/// Change of moments that is rest enough on a coarser mesh, where a state is to be good to 1e-4 ...
const REST: f64 = 1e-6;
/// ... and units in the last place that are rest anywhere.
const UNITS: f64 = 16.0;
/// How often edges may not come to rest before they are no longer iterated alone.
const PATIENCE: usize = 3;

/// Elements around edges.
pub(super) type Groups = ArrayVec<Range<usize>, GROUPS>;

/// What became of the edges.
#[derive(Clone, Copy, Default)]
pub(super) struct Edges {
    /// They were at rest before the last full step ...
    pub(super) rest: bool,
    /// ... or were not.
    pub(super) moving: bool,
    /// How often they were not.
    restless: usize,
}

impl<T: Real, M: Model<T>> Level<'_, '_, T, M> {
    /// The groups of the contact's edges that are to be iterated alone, that nearer to the meeting point first; none in a
    /// first step, from nothing, nor where that was in vain before.
    pub(super) fn contact_edges(&self) -> Groups {
        if !M::Law::LINEAR || self.size == T::zero() || self.edges.restless > PATIENCE {
            return Groups::new();
        }
        let mut groups = self.groups();
        let left = groups.first().map_or(0, |first| self.meeting.saturating_sub(first.end));
        let right = groups.last().map_or(0, |last| last.start.saturating_sub(self.meeting));
        if left <= right {
            return groups;
        }
        let mut reversed = Groups::new();
        while let Some(last) = groups.pop() {
            let _ = reversed.try_push(last);
        }
        reversed
    }

    /// After all was condensed at the current state: condenses anew around the contact's edges `groups`, at states in which
    /// these are at rest. The states are where the next one goes.
    pub(super) fn settle_edges(
        &mut self,
        groups: Groups,
        scale: T,
        goal: Goal<T>,
        count: &mut Count,
    ) -> Result<(), Halt> {
        (self.edges.rest, self.edges.moving) = (false, false);
        if groups.is_empty() {
            return Ok(());
        }
        let (current, target) = (self.current, self.target());
        for Place { work, .. } in self.places.iter_mut() {
            work.states[target] = work.states[current];
        }
        let rest = if goal.finest { goal.stop } else { T::of(REST) };
        let rest = rest.max(T::of(UNITS) * T::epsilon());
        self.current = target;
        let settled = groups.into_iter().try_fold(true, |all, group| {
            let settled = self.settle_group(group, scale, rest, count)?;
            Ok(all && settled)
        });
        // Around the edges it is known how the elements touch there, not here.
        (self.current, self.located) = (current, false);
        match settled {
            Ok(settled) => {
                (self.edges.rest, self.edges.moving) = (settled, !settled);
                self.edges.restless += usize::from(!settled);
                Ok(())
            }
            Err(Halt::Budget) => Err(Halt::Budget),
            Err(_) => {
                // Where that broke down the full step need not: from the state that is whole.
                self.edges.restless = usize::MAX;
                for Place { work, .. } in self.places.iter_mut() {
                    work.states[target] = work.states[1 - target];
                }
                count.spend(self.places.len())?;
                self.condense(0..self.places.len(), scale, Solve::State)
            }
        }
    }

    /// Iterates the elements of `group`, and those that come to touch beside it, in the current state; are they at rest?
    fn settle_group(
        &mut self,
        mut group: Range<usize>,
        scale: T,
        rest: T,
        count: &mut Count,
    ) -> Result<bool, Halt> {
        let (mut changed, mut margin) = (group.clone(), MARGIN);
        for step in 0..STEPS {
            // All is condensed, but perhaps not towards here.
            if step > 0 || !group.contains(&self.meeting) {
                let swept = self.extent(&changed, self.meeting);
                count.spend(swept.len())?;
                self.condense(swept, scale, Solve::State)?;
            }
            let moved = self.substitute_on(group.clone(), self.current, false);
            let moved = moved.filter(|moved| moved.is_finite()).ok_or(Halt::Breakdown(self.meeting - 1))?;
            self.locate_on(group.clone());
            if moved.mismatch <= rest * larger(self.size, moved.size) {
                return Ok(true);
            }
            // What touches everywhere (`Mixed`) is linear with the potential as it is, on one side of the truncation.
            let changes = |Place { work, .. }: &Place<T, M>| is_edge(work) || work.touch() != work.swept;
            let Some(range) = self.span(group.clone(), changes) else { return Ok(true) };
            // An edge that leaves the group is sought farther and farther.
            if range.start == group.start || range.end == group.end {
                margin *= 2;
            }
            changed = range;
            group = self.around(&changed, margin);
        }
        Ok(false)
    }

    /// The elements `range` and `margin` more on both sides.
    fn around(&self, range: &Range<usize>, margin: usize) -> Range<usize> {
        range.start.saturating_sub(margin)..(range.end + margin).min(self.places.len())
    }

    /// The groups of neighbouring edges; none if they are half of the beam.
    fn groups(&self) -> Groups {
        let mut groups = Groups::new();
        let edges = self.places.iter().enumerate().filter(|(_, place)| is_edge(&place.work));
        for around in edges.map(|(i, _)| self.around(&(i..i + 1), MARGIN)) {
            if let Some(last) = groups.last_mut()
                && last.end >= around.start
            {
                last.end = around.end;
            } else if groups.try_push(around).is_err() {
                return Groups::new();
            }
        }
        let elements: usize = groups.iter().map(ExactSizeIterator::len).sum();
        if 2 * elements > self.places.len() { Groups::new() } else { groups }
    }
}

/// Is the contact's edge in the element?
fn is_edge<T: Real, M: Model<T>>(work: &Work<T, M>) -> bool {
    work.touch() == Touch::Edge
}
