//! Partitions of [0, L].
//!
//! Whatever is asked for, nodes also stand where a profile breaks and under concentrated loads, so that all
//! data are smooth inside elements; a solution reports the number of elements it really has.

use crate::error::{Error, Place, expect};
use crate::real::Real;
use crate::scene::{Model, next_break};

/// How [0, L] is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Mesh<'a, T> {
    /// So many elements, of one length between breaks (and at least one there).
    Uniform {
        /// Number of elements.
        elements: usize,
    },
    /// Lengths in geometric progression.
    Graded {
        /// Number of elements.
        elements: usize,
        /// Length of the last element over that of the first, > 0.
        ratio: T,
    },
    /// Given nodes: ascending, the first 0, the last L \[m\].
    Nodes(&'a [T]),
}

/// More elements than any use has, so that a slip is refused instead of filling the memory.
const MOST: usize = 100_000_000;

impl<T: Real> Mesh<'_, T> {
    /// So many elements of one length.
    #[must_use]
    pub fn uniform(elements: usize) -> Self {
        Self::Uniform { elements }
    }

    /// The mesh's own numbers.
    pub(crate) fn validate(&self, length: T) -> Result<(), Error> {
        let at_least_one = |n: usize| {
            let what = "1 to 100 000 000 elements";
            expect(
                (1..=MOST).contains(&n),
                "mesh.elements",
                Place::Whole,
                what,
                T::from(n).unwrap_or(T::zero()),
            )
        };
        match *self {
            Self::Uniform { elements } => at_least_one(elements),
            Self::Graded { elements, ratio } => {
                at_least_one(elements)?;
                let ok = ratio > T::zero() && ratio.is_finite();
                expect(ok, "mesh.ratio", Place::Whole, "a finite number > 0", ratio)
            }
            Self::Nodes(nodes) => {
                let (what, field) = ("two nodes at least", "mesh.nodes");
                let [first, .., last] = *nodes else {
                    let found = nodes.len();
                    return Err(Error::Length { field, what, expected: 2, found });
                };
                let end = Place::Index(nodes.len() - 1);
                expect(first == T::zero(), field, Place::Index(0), "a first node at 0", first)?;
                expect(last == length, field, end, "a last node at the beam's length", last)?;
                for (i, pair) in nodes.windows(2).enumerate() {
                    let ok = pair[1] > pair[0];
                    expect(ok, field, Place::Index(i + 1), "nodes that increase", pair[1])?;
                }
                Ok(())
            }
        }
    }

    /// Number of elements, those between breaks included.
    pub(crate) fn count<M: Model<T>>(&self, model: &M) -> Result<usize, Error> {
        let mut elements = 0;
        self.lay(model, |_, _, _| {
            elements += 1;
            Ok(())
        })?;
        Ok(elements)
    }

    /// Calls `push(left, right, stop)` for each element from left to right; `stop` says that a break or a
    /// concentrated load stands at `right`, over which no coarser element may reach.
    pub(crate) fn lay<M: Model<T>>(
        &self,
        model: &M,
        mut push: impl FnMut(T, T, bool) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let length = model.length();
        match *self {
            Self::Uniform { elements } => {
                let total = number::<T>(elements);
                let rank = |x: T| (x / length * total).round().to_usize().unwrap_or(elements);
                let mut from = T::zero();
                while from < length {
                    let to = next_break(model, from);
                    let n = rank(to).saturating_sub(rank(from)).max(1);
                    let mut left = from;
                    for j in 1..n {
                        let right = from + (to - from) * (number::<T>(j) / number(n));
                        if right > left {
                            push(left, right, false)?;
                            left = right;
                        }
                    }
                    push(left, to, true)?;
                    from = to;
                }
                Ok(())
            }
            Self::Graded { elements, ratio } => {
                let n = number::<T>(elements);
                // x_i = L (r^i - 1) / (r^n - 1), where r^(n - 1) is the ratio; expm1 keeps r near 1 exact.
                let log = if elements > 1 { ratio.ln() / (n - T::one()) } else { T::zero() };
                let node = |i: usize| {
                    if i == elements {
                        length
                    } else if (log * n).abs() < T::epsilon() {
                        length * (number::<T>(i) / n)
                    } else {
                        length * ((log * number(i)).exp_m1() / (log * n).exp_m1())
                    }
                };
                through(model, 1..=elements, node, push)
            }
            Self::Nodes(nodes) => through(model, 1..nodes.len(), |i| nodes[i], push),
        }
    }
}

fn number<T: Real>(n: usize) -> T {
    T::from(n).unwrap_or_else(T::infinity)
}

/// The nodes `node(i)` with the breaks between them.
fn through<T: Real, M: Model<T>>(
    model: &M,
    ids: impl Iterator<Item = usize>,
    node: impl Fn(usize) -> T,
    mut push: impl FnMut(T, T, bool) -> Result<(), Error>,
) -> Result<(), Error> {
    // A node within rounding of a break is that break, as `next_break` has it: no slivers.
    let tiny = T::of(16.0) * T::epsilon() * model.length();
    let mut left = T::zero();
    let mut stop = next_break(model, left);
    for i in ids {
        let right = node(i);
        while stop < right - tiny {
            push(left, stop, true)?;
            left = stop;
            stop = next_break(model, left);
        }
        if right - left > tiny {
            let stops = stop <= right + tiny;
            push(left, right, stops)?;
            left = right;
            if stops && right < model.length() {
                stop = next_break(model, left);
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Beam, Load, PointLoad, Scene, Steps};
    use std::vec::Vec;

    fn nodes(mesh: Mesh<'_, f64>, breaks: &[f64], points: &[f64]) -> Vec<f64> {
        let values: Vec<f64> = (0..=breaks.len()).map(|i| i as f64).collect();
        let points: Vec<_> = points.iter().map(|&x| PointLoad { x, force: 1.0, moment: 0.0 }).collect();
        let scene = Scene::new(1.0, Beam::elastic(1.0)).load(Load {
            transverse: Steps { breaks, values: &values },
            axial: (),
            points: points.as_slice(),
        });
        let mut nodes = std::vec![0.0];
        let laid = mesh.lay(&scene, |left, right, _| {
            assert_eq!(Some(&left), nodes.last());
            assert!(right > left);
            nodes.push(right);
            Ok(())
        });
        assert!(laid.is_ok());
        nodes
    }

    #[test]
    fn nodes_stand_at_breaks_and_loads() {
        assert_eq!(nodes(Mesh::uniform(4), &[], &[]), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(nodes(Mesh::uniform(4), &[0.5], &[]), [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(nodes(Mesh::uniform(1), &[0.3], &[0.7]), [0.0, 0.3, 0.7, 1.0]);
        // A load within rounding of a break does not make a sliver.
        assert_eq!(nodes(Mesh::uniform(2), &[0.5], &[0.5 + 1e-16]), [0.0, 0.5, 1.0]);
        assert_eq!(nodes(Mesh::Nodes(&[0.0, 0.2, 1.0]), &[0.1, 0.2], &[]), [0.0, 0.1, 0.2, 1.0]);
        assert_eq!(nodes(Mesh::uniform(999), &[0.5], &[]).len(), 1000);
    }

    #[test]
    fn graded_lengths_are_geometric() {
        let x = nodes(Mesh::Graded { elements: 3, ratio: 4.0 }, &[], &[]);
        let lengths: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
        for (got, want) in lengths.iter().zip([1.0 / 7.0, 2.0 / 7.0, 4.0 / 7.0]) {
            assert!((got - want).abs() < 1e-15);
        }
        assert_eq!(nodes(Mesh::Graded { elements: 2, ratio: 1.0 }, &[], &[]), [0.0, 0.5, 1.0]);
    }
}
