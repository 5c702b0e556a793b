//! Elements divided into equal parts, with the state that they are in.
//!
//! The cubic of a part is that of the whole, so nothing is lost: a finer mesh starts where the coarser one ended.

use crate::element::Element;
use crate::element::hermite::Motion;
use crate::error::Error;
use crate::real::Real;
use crate::scene::Model;
use crate::storage::{Place, State};

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
