//! How far apart two discrete solutions are, one on a mesh that divides the other's.

use super::bound::density;
use crate::electric;
use crate::element::Element;
use crate::quadrature::gauss;
use crate::real::{Pair, Real, Sum};
use crate::scene::Model;
use crate::solution::{Fields, Solution};
use crate::storage::State;

/// Energy norms of differences, and largest differences of fields.
pub(super) struct Distance<T> {
    /// Of the deflections \[J^(1/2)\].
    pub(super) bending: T,
    /// Of the finer one's deflection, by its cubics.
    pub(super) size: T,
    /// Of stretching and potential \[J^(1/2)\].
    pub(super) electric: T,
    /// Largest difference and largest value of bending, stretching, potential.
    pub(super) fields: [(T, T); 3],
}

impl<T: Real> Distance<T> {
    /// `None` unless each element of `coarse` is divided into equal parts by `fine`. Fields are compared at the nodes
    /// of `fine`.
    pub(super) fn between<M: Model<T>>(
        coarse: &Solution<'_, T, M>,
        fine: &Solution<'_, T, M>,
    ) -> Option<Self> {
        let (mut bending, mut electric) = (Sum::<T>::default(), Sum::<T>::default());
        let mut size = Sum::<T>::default();
        let mut fields = [(T::zero(), T::zero()); 3];
        let mut at = 0;
        for (i, place) in fine.places.iter().enumerate() {
            let Element { right: x, h, bending: stiffness, .. } = place.element;
            let half = T::of(0.5) * h;
            while coarse.places.get(at)?.element.right < x - half {
                at += 1;
            }
            let whole = coarse.solved(at);
            // Shares as quotients of whole numbers: lengths are rounded.
            let (parts, from_right) = (whole.element.h / h, (whole.element.right - x) / h);
            let divides = |x: T| (x - x.round()).abs() <= T::of(0.01);
            if !divides(parts) || !divides(from_right) {
                return None;
            }
            let share = parts.round().recip();
            let right = from_right.round() * share;
            let State { e, .. } = place.work.states[fine.state];
            let apart = e - whole.motion.part(right, share).e;
            bending.add(apart.times(stiffness.times(apart)));
            let part = fine.solved(i);
            size.add(part.bend().times(stiffness.times(part.bend())));
            // Without conduction into the potential that is what Gauss's rule misses of coefficients and loads.
            if electric::present::<T, M>() {
                for (z, weight) in gauss::<5>() {
                    let z = T::of(z);
                    let ((u, q), (u_whole, q_whole)) =
                        (part.gradients(z), whole.gradients(right + share * z));
                    electric.add(T::of(weight) * h * density(&part, z, (u - u_whole, q - q_whole)));
                }
            }
            let (a, b) = (whole.fields(x), part.fields(x));
            let get: [fn(&Fields<T>) -> T; 3] =
                [|f| f.bending, |f| f.stretching.unwrap_or(T::zero()), |f| f.potential.unwrap_or(T::zero())];
            for ((apart, most), get) in fields.iter_mut().zip(get) {
                *apart = apart.max((get(&a) - get(&b)).abs());
                *most = most.max(get(&b).abs());
            }
        }
        let [bending, size, electric] =
            [bending, size, electric].map(|sum| sum.value().max(T::zero()).sqrt());
        Some(Self { bending, size, electric, fields })
    }
}
