//! Where a derivative may not be what a change of finite size sees.
//!
//! The contact force has a kink at eta = 0, conduction at eta = M and at q = +-M. Where a field crosses such a
//! level with a slope, a change of size delta moves the crossing by about delta, over which the force changes by
//! as much: a remainder of order delta^2, and the solution is differentiable. Where a field only touches the
//! level, the stretch that changes sides grows like sqrt(delta): still differentiable, but the remainder is of order
//! delta^(3/2), and near such a state the derivative changes quickly. Where a field keeps the level over a
//! whole stretch the force goes along with one sign of the change only: there is no derivative.

use crate::cubic::Cubic;
use crate::law::Compliance;
use crate::profile::{Piece, Profile};
use crate::real::Real;
use crate::scene::Model;
use crate::solution::{Solution, Solved};

/// A state at, or all but at, a kink of the forces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Grazing<T> {
    /// A field keeps a kink's level over a stretch: the derivative is one of several one-sided ones.
    Stretch {
        /// Where the stretch starts \[m\].
        from: T,
        /// Where it ends \[m\].
        to: T,
    },
    /// A field has an extreme at a kink's level: the derivative holds for changes much smaller than what
    /// is between them.
    Touch {
        /// Where \[m\].
        x: T,
    },
}

/// The kinks of the forces.
#[derive(Clone, Copy)]
enum Kink {
    /// eta = 0
    Edge,
    /// eta = M
    Depth,
    /// q = M or -M, where the beam touches
    Potential { high: bool },
}

impl Kink {
    const ALL: [Self; 4] =
        [Self::Edge, Self::Depth, Self::Potential { high: true }, Self::Potential { high: false }];
}

/// The first place where the state is at a kink: stretches before touches.
pub(super) fn find<T: Real, M: Model<T>>(view: &Solution<'_, T, M>) -> Option<Grazing<T>> {
    if !M::Law::PRESENT && !M::Mu1::PRESENT && !M::Mu2::PRESENT {
        return None;
    }
    let stretch = || Kink::ALL.into_iter().find_map(|kink| stretch(view, kink));
    stretch().or_else(|| Kink::ALL.into_iter().find_map(|kink| touch(view, kink)))
}

/// The field less the kink's level on an element; `None` where the kink has no force.
fn offset<T: Real, M: Model<T>>(solved: &Solved<'_, T, M>, kink: Kink, depth: T) -> Option<Cubic<T>> {
    let (zero, element) = (T::zero(), solved.element);
    let less = |field: &Cubic<T>, level: T| {
        let [c0, c1, c2, c3] = field.0;
        Cubic([c0 - level, c1, c2, c3])
    };
    let (onto, into) = (element.conducts_onto(), element.conducts_into());
    let bounds = solved.scene.conduction();
    let pressed = || [0.0, 0.5, 1.0].iter().any(|&t| solved.eta.at(T::of(t)) > zero);
    match kink {
        // A law that starts without a slope, and the squared penetration of the current, have no kink.
        Kink::Edge => (onto || starts_steep(solved, depth)).then(|| less(&solved.eta, zero)),
        Kink::Depth => (onto || into).then(|| less(&solved.eta, bounds.truncation)),
        Kink::Potential { high } if onto && pressed() => {
            let level = bounds.potential_truncation;
            Some(less(&solved.q, if high { level } else { -level }))
        }
        Kink::Potential { .. } => None,
    }
}

/// Has the law a slope at zero, beside that at `depth`?
fn starts_steep<T: Real, M: Model<T>>(solved: &Solved<'_, T, M>, depth: T) -> bool {
    if !M::Law::PRESENT {
        return false;
    }
    let half = T::of(0.5);
    let (k, x) = (solved.element.law.at(half), solved.element.x(half));
    let slope = |r: T| solved.scene.foundation().law.pressure(k, x, r).1;
    let deep = slope(if depth > T::zero() { depth } else { T::one() });
    slope(T::min_positive_value()) > T::epsilon() * deep
}

/// Sizes to compare with: of the penetration, of bending and gap together, of pressures and loads.
fn sizes<T: Real, M: Model<T>>(view: &Solution<'_, T, M>) -> (T, T, T) {
    let (mut depth, mut size, mut force) = (T::zero(), T::zero(), T::zero());
    for i in 0..view.places.len() {
        let solved = view.solved(i);
        let eta = solved.eta.at(T::zero());
        let gap = view.scene.foundation().gap.value(solved.element.right, solved.mid);
        depth = depth.max(eta.abs());
        size = size.max(eta.abs()).max(gap.abs()).max((eta + gap).abs());
        let load = view.scene.load().transverse.value(solved.mid, solved.mid);
        force = force.max(pressure(&solved).abs()).max(load.abs());
    }
    (depth, size, force)
}

/// Pressure that goes with the penetration's size in the middle of an element.
fn pressure<T: Real, M: Model<T>>(solved: &Solved<'_, T, M>) -> T {
    let half = T::of(0.5);
    let r = solved.eta.at(half).abs();
    if !M::Law::PRESENT || r == T::zero() {
        return T::zero();
    }
    let element = solved.element;
    solved.scene.foundation().law.pressure(element.law.at(half), element.x(half), r).0
}

/// The first stretch over which a field keeps a kink's level to rounding.
fn stretch<T: Real, M: Model<T>>(view: &Solution<'_, T, M>, kink: Kink) -> Option<Grazing<T>> {
    let (depth, size, force) = sizes(view);
    let bounds = view.scene.conduction();
    let size = match kink {
        Kink::Edge => size,
        Kink::Depth => size + bounds.truncation,
        Kink::Potential { .. } => bounds.potential_truncation,
    };
    let small = T::of(256.0) * T::epsilon() * size;
    let length = view.scene.length();
    let mut open: Option<(T, T)> = None;
    let long_enough = |(from, to): (T, T)| {
        // At a clamp without a gap the penetration starts from zero with its slope.
        let clamped = from == T::zero() || to == length;
        (to - from > if clamped { T::of(0.1) * length } else { T::zero() })
            .then_some(Grazing::Stretch { from, to })
    };
    let mut left = T::zero();
    for i in 0..view.places.len() {
        let solved = view.solved(i);
        let right = solved.element.right;
        let flat = offset(&solved, kink, depth).is_some_and(|field| {
            [0.0, 0.25, 0.5, 0.75, 1.0].iter().all(|&t| field.at(T::of(t)).abs() <= small)
        });
        // A stiff foundation holds loads by a penetration that is tiny beside the bending elsewhere.
        let slack = !matches!(kink, Kink::Edge) || pressure(&solved) <= T::epsilon().sqrt() * force;
        if flat && slack {
            open = Some((open.map_or(left, |(from, _)| from), right));
        } else if let Some(found) = open.take().and_then(long_enough) {
            return Some(found);
        }
        left = right;
    }
    open.and_then(long_enough)
}

/// The first extreme of a field, inside the beam, that is tiny beside both extremes next to it.
fn touch<T: Real, M: Model<T>>(view: &Solution<'_, T, M>, kink: Kink) -> Option<Grazing<T>> {
    let depth = sizes(view).0;
    // At a clamp without a gap the penetration is zero with its slope; rounding may put an extreme beside it.
    let length = view.scene.length();
    let margin = T::of(1e-6) * length;
    let inside = |x: &T| *x > margin && *x < length - margin;
    let mut walk = Walk::new();
    for i in 0..view.places.len() {
        let solved = view.solved(i);
        let Some(field) = offset(&solved, kink, depth) else {
            walk = Walk::new();
            continue;
        };
        if i == 0 || walk.is_new() {
            walk.see(solved.element.x(T::one()), field.at(T::one()));
        }
        let points = field.turning_points();
        for t in points.into_iter().rev().chain([T::zero()]) {
            if let Some(x) = walk.see(solved.element.x(t), field.at(t)).filter(inside) {
                return Some(Grazing::Touch { x });
            }
        }
    }
    walk.finish().filter(inside).map(|x| Grazing::Touch { x })
}

/// Extremes of a function that is seen point by point.
struct Walk<T> {
    /// The extreme before the last one.
    before: Option<T>,
    /// The last extreme, and where.
    extreme: Option<(T, T)>,
    /// The last point.
    point: Option<(T, T)>,
}

impl<T: Real> Walk<T> {
    fn new() -> Self {
        Self { before: None, extreme: None, point: None }
    }

    fn is_new(&self) -> bool {
        self.point.is_none()
    }

    /// The next point; where the last but one extreme touched zero, if that is known now.
    fn see(&mut self, x: T, value: T) -> Option<T> {
        let (Some(last), Some(extreme)) = (self.point, self.extreme) else {
            (self.point, self.extreme) = (Some((x, value)), Some((x, value)));
            return None;
        };
        let (so_far, now) = (last.1 - extreme.1, value - last.1);
        let mut found = None;
        if so_far * now < T::zero() {
            found = self.judge(last.1);
            (self.before, self.extreme) = (Some(extreme.1), Some(last));
        }
        self.point = Some((x, value));
        found
    }

    fn finish(&self) -> Option<T> {
        self.point.and_then(|(_, value)| self.judge(value))
    }

    fn judge(&self, after: T) -> Option<T> {
        let ((x, value), before) = (self.extreme?, self.before?);
        let tiny = T::epsilon().sqrt() * before.abs().min(after.abs());
        (value.abs() <= tiny && tiny > T::zero()).then_some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(values: &[f64]) -> Option<f64> {
        let mut walk = Walk::new();
        for (i, &value) in values.iter().enumerate() {
            if let Some(x) = walk.see(i as f64, value) {
                return Some(x);
            }
        }
        walk.finish()
    }

    #[test]
    fn extremes_at_zero_are_touches_and_crossings_are_none() {
        assert_eq!(first(&[1.0, 0.5, 1e-12, 0.5, 1.0]), Some(2.0));
        assert_eq!(first(&[-1.0, -0.5, 1e-12, -0.5, -1.0, -2.0]), Some(2.0));
        assert_eq!(first(&[1.0, 1e-12, 1.0, 0.5, 1.0]), Some(1.0));
        assert_eq!(first(&[1.0, 0.5, 1e-12, -0.5, -1.0]), None);
        assert_eq!(first(&[0.0, 0.5, 1.0, 0.5, 0.0]), None);
        assert_eq!(first(&[0.0, 1e-10, 0.9e-10, 1e-10, -1.0, 0.0]), None);
        assert_eq!(first(&[0.0, 0.0, 0.0]), None);
        assert_eq!(first(&[1.0, 1e-3, 1.0]), None);
    }
}
