//! Elements divided into equal parts, with the state that they are in.
//!
//! The cubic of a part is that of the whole, so nothing is lost: a finer mesh starts where the coarser one ended.

use crate::element::Element;
use crate::element::hermite::Motion;
use crate::error::Error;
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::storage::{Place, State, Storage};
use crate::sweep::Block;
use crate::sweep::pair::Bending;

use super::share::Share;

/// Part `j` of `parts`, counted from the left, of `whole`, whose left node is at `left` and whose state is number
/// `state`; the scene is sampled anew.
pub(super) fn part<T: Real, M: Model<T>>(
    model: &M,
    whole: &Place<T, M>,
    left: T,
    (j, parts): (usize, usize),
    state: usize,
) -> Result<Place<T, M>, Error> {
    let element = &whole.element;
    let share = |j: usize| T::from(j).unwrap_or(T::one()) / T::from(parts).unwrap_or(T::one());
    // Nodes as fractions of the whole from the left, so that the last is the whole's own.
    let node = |j: usize| {
        if j == parts { element.right } else { left + (element.right - left) * share(j) }
    };
    let last = j + 1 == parts;
    let mut part = Place::default();
    part.element = Element::sample(model, node(j), node(j + 1), last && element.stop)?;
    let State { e, d } = whole.work.states[state];
    let motion = Motion::new(element.h, e, d).part(T::one() - share(j + 1), share(1));
    part.work.states = [State { e: motion.e, d: motion.d }; 2];
    Ok(part)
}

/// One element for two neighbours, in the state that has the nodes of theirs.
fn joined<T: Real, M: Model<T>>(
    model: &M,
    [west, east]: [&Place<T, M>; 2],
    left: T,
    state: usize,
) -> Result<Place<T, M>, Error> {
    let mut whole = Place::default();
    whole.element = Element::sample(model, left, east.element.right, east.element.stop)?;
    let (near, far) = (east.work.states[state], west.work.states[state]);
    // e = d_left - T d_right along both.
    let e = far.e + Bending::carry(west.element.h, near.e);
    whole.work.states = [State { e, d: near.d }; 2];
    Ok(whole)
}

/// What may be done to a mesh.
#[derive(Clone, Copy)]
pub(super) struct Plan<T> {
    /// The largest part of the error that an element may have \[m\].
    most: T,
    /// Elements then.
    pub(super) elements: usize,
}

/// Parts and joins of a mesh, whose elements' shares of the error are in their states number `shares`.
pub(super) struct Shares<'p, T: Real, M: Model<T>> {
    pub(super) places: &'p [Place<T, M>],
    pub(super) shares: usize,
}

impl<T: Real, M: Model<T>> Shares<'_, T, M> {
    fn of(&self, i: usize) -> Share<T> {
        let e = self.places[i].work.states[self.shares].e;
        Share { error: e.x(), stiff: e.y() }
    }

    /// Are the elements i and i + 1 to be one, if none may have more than `most`?
    fn joins(&self, i: usize, most: T) -> bool {
        let (Some(west), Some(east)) = (self.places.get(i), self.places.get(i + 1)) else { return false };
        let (a, b) = (self.of(i), self.of(i + 1));
        let like = (west.element.h - east.element.h).abs() <= T::of(1e-6) * west.element.h;
        like && !west.element.stop && a.joined(&b).error <= T::of(JOINED) * most
    }

    /// How many elements there are when none has more than `most`, and what is left of the error.
    fn count(&self, most: T) -> (usize, T) {
        let (mut elements, mut error, mut i) = (0, T::zero(), 0);
        while i < self.places.len() {
            if self.joins(i, most) {
                error = error + self.of(i).joined(&self.of(i + 1)).error;
                (elements, i) = (elements + 1, i + 2);
            } else {
                let share = self.of(i);
                let n = share.parts(most);
                // What cannot be had in one pass is not asked of the others.
                error = error + share.divided(n).min(most * T::from(n).unwrap_or(T::one()));
                (elements, i) = (elements + n, i + 1);
            }
        }
        (elements, error)
    }

    /// The mesh of at most `room` elements whose shares sum up to `allowed` at most, or as little as they can.
    pub(super) fn plan(&self, allowed: T, room: usize) -> Plan<T> {
        let mut most = allowed;
        let (mut elements, mut error) = self.count(most);
        for _ in 0..FINER {
            if error <= allowed {
                break;
            }
            most = most * T::of(STEP);
            (elements, error) = self.count(most);
        }
        for _ in 0..FINER {
            if elements <= room {
                break;
            }
            most = most / T::of(STEP);
            elements = self.count(most).0;
        }
        Plan { most, elements }
    }
}

/// Joins and divides the first `elements` of the mesh in `memory` as planned, from their states number `state`; their
/// shares of the error are in the other states.
pub(super) fn remesh<T: Real, M: Model<T>, S: Storage<T, M> + ?Sized>(
    model: &M,
    memory: &mut S,
    elements: usize,
    state: usize,
    Plan { most, elements: needed }: Plan<T>,
) -> Result<(), Error> {
    let shares = 1 - state;
    let places = memory.places(needed.max(elements));
    let available = places.len();
    if needed > available {
        return Err(Error::Capacity { needed, available });
    }
    let left_of = |places: &[Place<T, M>], i: usize| match i.checked_sub(1) {
        Some(before) => places[before].element.right,
        None => T::zero(),
    };
    let (mut kept, mut i) = (0, 0);
    while i < elements {
        if (Shares { places: &places[..elements], shares }).joins(i, most) {
            let mut whole = joined(model, [&places[i], &places[i + 1]], left_of(places, kept), state)?;
            // It has what it may have.
            whole.work.states[shares].e = T::Vec2::default();
            places[kept] = whole;
            i += 2;
        } else {
            places[kept] = places[i];
            i += 1;
        }
        kept += 1;
    }
    // From the right, so that no element is overwritten before it is divided.
    let mut end = needed;
    for i in (0..kept).rev() {
        let parts = (Shares { places: &places[..kept], shares }).of(i).parts(most);
        let (whole, left) = (places[i], left_of(places, i));
        end -= parts;
        for j in 0..parts {
            places[end + j] = if parts == 1 { whole } else { part(model, &whole, left, (j, parts), state)? };
        }
    }
    for place in &mut places[..needed] {
        place.work.states = [place.work.states[state]; 2];
    }
    Ok(())
}

/// Two elements are joined if their share is this part of the largest then.
const JOINED: f64 = 0.25;
/// Factor between the largest shares that are tried, and how many are.
const STEP: f64 = 0.8;
const FINER: usize = 400;
