//! The active set (3.7) by elements: one is in contact as a whole where the beam penetrates at its midpoint.
//!
//! Then the law acts on all of the element, also where the beam is lifted: there it pulls. With the paper's law it
//! is k eta whatever the sign; other laws are continued as straight lines below zero.

use super::{Linear, Sight};
use crate::element::contact::Fault;
use crate::quadrature::POINTS;
use crate::real::Real;
use crate::scene::Model;

pub(super) fn linear<T: Real, M: Model<T>>(sight: &Sight<'_, T, M>) -> Result<Linear<T>, Fault> {
    let pressed = sight.is_pressed();
    sight.map(|point, r| if pressed { sight.pressed(point, r) } else { Ok(Default::default()) })
}

pub(super) fn pressures<T: Real, M: Model<T>>(sight: &Sight<'_, T, M>) -> Result<[T; POINTS], Fault> {
    let pressed = sight.is_pressed();
    sight.map(|point, r| if pressed { Ok(sight.law(point, r)?.0) } else { Ok(T::zero()) })
}
