//! Elements divided into equal parts, with the state that they are in.
//!
//! The cubic of a part is that of the whole, so nothing is lost: a finer mesh starts where the coarser one ended.

use crate::element::Element;
use crate::element::hermite::Motion;
use crate::error::Error;
use crate::real::{Pair, Real};
use crate::scene::Model;
use crate::storage::{Place, State, States, Storage};
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
    let sampled = Element::sample(model, node(j), node(j + 1), last && element.stop)?;
    let mut part = Place { element: sampled, ..Place::default() };
    let State { e, d } = whole.work.states[state];
    let motion = Motion::new(element.h, e, d).part(T::one() - share(j + 1), share(1));
    part.work.states = States::both(State { e: motion.e, d: motion.d });
    Ok(part)
}

/// One element for two neighbours, in the state that has the nodes of theirs.
fn joined<T: Real, M: Model<T>>(
    model: &M,
    [west, east]: [&Place<T, M>; 2],
    left: T,
    state: usize,
) -> Result<Place<T, M>, Error> {
    let element = Element::sample(model, left, east.element.right, east.element.stop)?;
    let mut whole = Place { element, ..Place::default() };
    let (near, far) = (east.work.states[state], west.work.states[state]);
    // e = d_left - T d_right along both.
    let e = far.e + Bending::carry(west.element.h, near.e);
    whole.work.states = States::both(State { e, d: near.d });
    Ok(whole)
}

/// What may be done to a mesh.
#[derive(Clone, Copy)]
pub(super) struct Plan<T> {
    /// The largest part of the error that an element may have \[m\].
    most: T,
    /// Elements then.
    pub(super) elements: usize,
    join: bool,
}

/// Parts and joins of a mesh, whose elements' shares of the error are in their states number `shares`.
pub(super) struct Shares<'p, T: Real, M: Model<T>> {
    pub(super) places: &'p [Place<T, M>],
    pub(super) shares: usize,
    /// Elements may be joined, too.
    pub(super) join: bool,
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
        let like = self.join && (west.element.h - east.element.h).abs() <= T::of(1e-6) * west.element.h;
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
        Plan { most, elements, join: self.join }
    }
}

/// Joins and divides the first `elements` of the mesh in `memory` as planned, from their states number `state`; their
/// shares of the error are in the other states.
pub(super) fn remesh<T: Real, M: Model<T>, S: Storage<T, M> + ?Sized>(
    model: &M,
    memory: &mut S,
    elements: usize,
    state: usize,
    Plan { most, elements: needed, join }: Plan<T>,
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
        if (Shares { places: &places[..elements], shares, join }).joins(i, most) {
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
        let parts = (Shares { places: &places[..kept], shares, join }).of(i).parts(most);
        let (whole, left) = (places[i], left_of(places, i));
        end -= parts;
        for j in 0..parts {
            places[end + j] = if parts == 1 { whole } else { part(model, &whole, left, (j, parts), state)? };
        }
    }
    for place in &mut places[..needed] {
        place.work.states = States::both(place.work.states[state]);
    }
    Ok(())
}

/// Two elements are joined if their share is this part of the largest then.
const JOINED: f64 = 0.25;
/// Factor between the largest shares that are tried, and how many are.
const STEP: f64 = 0.8;
const FINER: usize = 400;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
    use super::*;
    use crate::{Beam, Foundation, Linear, Load, Scene};
    use glam::DVec2;
    use std::vec::Vec;

    fn scene() -> impl Model<f64> {
        Scene::new(1.0, Beam::elastic(3.0)).foundation(Foundation { law: Linear(7.0), gap: () }).load(Load {
            transverse: 5.0,
            axial: (),
            points: (),
        })
    }

    fn whole<M: Model<f64>>(model: &M, stop: bool) -> Place<f64, M> {
        let element = Element::sample(model, 0.2, 0.8, stop).unwrap();
        let mut place = Place { element, ..Place::default() };
        place.work.states[0] = State { e: DVec2::new(0.3, -0.7), d: DVec2::new(1.1, 0.4) };
        place
    }

    #[test]
    fn parts_lie_on_the_cubic_of_the_whole_and_join_to_it() {
        let model = scene();
        for stop in [false, true] {
            let place = whole(&model, stop);
            let cubic = Motion::new(place.element.h, place.work.states[0].e, place.work.states[0].d).cubic();
            for parts in 1..=5 {
                let list: Vec<_> =
                    (0..parts).map(|j| part(&model, &place, 0.2, (j, parts), 0).unwrap()).collect();
                assert_eq!(list[parts - 1].element.right, 0.8);
                for (j, one) in list.iter().enumerate() {
                    assert_eq!(one.element.stop, stop && j + 1 == parts);
                    let State { e, d } = one.work.states[0];
                    let own = Motion::new(one.element.h, e, d).cubic();
                    for z in [0.0, 0.3, 1.0] {
                        let t = 1.0 - (j as f64 + 1.0 - z) / parts as f64;
                        assert!((own.at(z) - cubic.at(t)).abs() < 1e-14);
                    }
                }
                if parts == 2 {
                    let again = joined(&model, [&list[0], &list[1]], 0.2, 0).unwrap();
                    let State { e, d } = again.work.states[0];
                    assert!((e - place.work.states[0].e).abs().max_element() < 1e-15);
                    assert_eq!(
                        (d, again.element.right, again.element.stop),
                        (place.work.states[0].d, 0.8, stop)
                    );
                }
            }
        }
    }

    /// A mesh of equal elements with these shares.
    fn mesh<M: Model<f64>>(model: &M, shares: &[f64]) -> Vec<Place<f64, M>> {
        let h = 1.0 / shares.len() as f64;
        let place = |(i, &share): (usize, &f64)| {
            let left = i as f64 * h;
            let element = Element::sample(model, left, left + h, i + 1 == shares.len()).unwrap();
            let mut place = Place { element, ..Place::default() };
            place.work.states[1].e = DVec2::new(share, 0.0);
            place
        };
        shares.iter().enumerate().map(place).collect()
    }

    #[test]
    fn a_plan_spends_what_is_allowed_and_no_more_elements_than_there_is_room_for() {
        let model = scene();
        let places = mesh(&model, &[1e-3, 1e-9, 1e-9, 1e-9, 1e-9, 1e-5, 1e-7, 1e-4]);
        let shares = |join| Shares { places: &places, shares: 1, join };
        for allowed in [1e-4, 1e-5, 3e-6] {
            let plan = shares(true).plan(allowed, usize::MAX);
            let (elements, error) = shares(true).count(plan.most);
            assert_eq!(elements, plan.elements);
            assert!(error <= allowed, "{error:e} for {allowed:e}");
            assert!(
                shares(false).plan(allowed, usize::MAX).elements >= plan.elements + 2,
                "two pairs are joined"
            );
        }
        assert!(shares(true).plan(1e-9, 12).elements <= 12);
        assert_eq!(shares(false).plan(1.0, usize::MAX).elements, 8);
    }

    #[test]
    fn remeshing_keeps_the_beam_covered() {
        let model = scene();
        let shares = [1e-3, 1e-9, 1e-9, 1e-9, 1e-9, 1e-5, 1e-7, 1e-4];
        let mut memory: Vec<Place<f64, _>> = mesh(&model, &shares);
        memory.resize(40, Place::default());
        let plan = Shares { places: &memory[..8], shares: 1, join: true }.plan(1e-5, 40);
        remesh(&model, &mut memory[..], 8, 0, plan).unwrap();
        let mut left = 0.0;
        for place in &memory[..plan.elements] {
            assert!((place.element.right - place.element.h - left).abs() < 1e-15);
            left = place.element.right;
        }
        assert_eq!(left, 1.0);
        assert!(memory[plan.elements - 1].element.stop && !memory[0].element.stop);
        let refused = remesh(&model, &mut memory[..4], 4, 0, Plan { most: 1e-9, elements: 5, join: false });
        assert_eq!(refused, Err(Error::Capacity { needed: 5, available: 4 }));
    }
}
