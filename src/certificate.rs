//! What theory says of a scene: hypotheses, uniqueness.
//!
//! The paper proves existence for bounded truncations, and uniqueness under (2.15). With the best constants
//! of the two Poincare inequalities, c1 = L / pi for functions that vanish at both ends and
//! c2 = (L / 4.730040744862704)^2 for those whose slopes vanish too (the first clamped-clamped root), and
//! with a truncation Mq of the potential of its own, the condition reads
//!
//! ```text
//!     min C   > c2^2 (max mu1 (Mq + M / 2) + max mu2 M)
//!     min eps > c1^2 (max mu1 M / 2        + max mu2 M)
//! ```
//!
//! which for Mq = M is the paper's. It follows from
//! mu1 (R(q) R~(eta) - R(q') R~(eta'))(eta - eta') >= -mu1 (Mq (d eta)^2 + M |d q| |d eta|), the Lipschitz
//! constant 2 M of R~^2, and 2 a b <= a^2 + b^2. It is sufficient, never necessary.

use crate::law::Compliance;
use crate::profile::{Piece, Profile, Smooth};
use crate::quadrature::gauss;
use crate::real::Real;
use crate::scene::Model;
use crate::storage::Place;
use arrayvec::ArrayVec;
use core::fmt;

/// The uniqueness condition (2.15).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniqueness<T> {
    /// Both margins exceed 1: the solution is the only one.
    pub certified: bool,
    /// Left over right side of the condition on the bending stiffness; `None` without conduction, where it
    /// holds whatever the numbers.
    pub margin_bending: Option<T>,
    /// Left over right side of the condition on the permittivity; `None` without conduction.
    pub margin_electric: Option<T>,
}

/// Something that a user should know of a scene or its solution.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning<T> {
    /// Hypothesis (2.7): the compliance law is not Lipschitz continuous in the penetration.
    LawNotLipschitz,
    /// Hypothesis (2.14): the gap or its slope does not vanish at a clamp.
    GapAtClamp {
        /// The clamp's x \[m\].
        x: T,
        /// Gap there \[m\].
        gap: T,
        /// Its slope there.
        slope: T,
    },
    /// Hypothesis (2.14): the gap has a kink.
    GapKink {
        /// Where \[m\].
        x: T,
    },
    /// The foundation is so much stiffer than the elements that no solution was found for it as it is. It is taken as
    /// one that is rigid to the elements (k h^4 / C = 1e7, in `f32` 8e3): bending, moments and forces are those
    /// of a rigid foundation up to the mesh's own error, the penetration is larger than asked for.
    Rigid {
        /// The smallest stiffness that was taken for a larger one \[N/m^2\].
        stiffness: T,
    },
    /// Condition (2.15) fails: there may be other solutions.
    NotUnique {
        /// The smaller of the two margins.
        margin: T,
    },
    /// The axial strain exceeds 5 %.
    LargeStrain {
        /// Strain u'.
        strain: T,
        /// Where \[m\].
        x: T,
    },
    /// The slope is so large that the stretching it causes, xi'^2 / 2, exceeds 5 %.
    LargeSlope {
        /// Slope xi'.
        slope: T,
        /// Where \[m\].
        x: T,
    },
}

impl<T: Real> fmt::Display for Warning<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LawNotLipschitz => write!(
                f,
                "the compliance law is not Lipschitz continuous, as hypothesis (2.7) of the theory asks"
            ),
            Self::GapAtClamp { x, gap, slope } => write!(
                f,
                "the gap does not vanish with its slope at the clamp x = {x} (gap {gap}, slope {slope}), \
                 as hypothesis (2.14) of the theory asks"
            ),
            Self::GapKink { x } => {
                write!(f, "the gap has a kink at x = {x}; hypothesis (2.14) of the theory asks for none")
            }
            Self::Rigid { stiffness } => write!(
                f,
                "the foundation is too stiff for this mesh to be solved as it is; it was taken as one of {:.1e} N/m^2, \
                 rigid to the elements: bending and forces are right up to the mesh's own error, the penetration is \
                 larger than asked for",
                stiffness.f64()
            ),
            Self::NotUnique { margin } => write!(
                f,
                "the uniqueness condition (2.15) fails (margin {margin:.3}, 1 needed): there may be other \
                 solutions"
            ),
            Self::LargeStrain { strain, x } => write!(
                f,
                "the axial strain reaches {:.3} % at x = {x}; the model holds for small strains",
                strain.f64() * 100.0
            ),
            Self::LargeSlope { slope, x } => {
                write!(f, "the slope reaches {slope:.3} at x = {x}; the model holds for small rotations")
            }
        }
    }
}

/// Smallest and largest value of a profile over the Gauss points and ends of all elements.
pub(crate) fn range<T: Real, M: Model<T>, P: Profile<T>>(profile: &P, places: &[Place<T, M>]) -> (T, T) {
    let mut range = (T::infinity(), T::neg_infinity());
    for Place { element, .. } in places {
        let mid = element.x(T::of(0.5));
        let ends = [0.0, 1.0].map(|t| element.x(T::of(t)));
        for x in gauss::<4>().map(|(t, _)| element.x(T::of(t))).into_iter().chain(ends) {
            let value = profile.value(x.max(T::zero()), mid);
            if value.is_finite() {
                range = (range.0.min(value), range.1.max(value));
            }
        }
        if P::Piece::FLAT && profile.breaks().is_empty() {
            break;
        }
    }
    range
}

/// The best constants of Poincare's inequalities for functions that vanish at both ends \[m\], and for those whose
/// slopes vanish, too \[m^2\].
pub(crate) fn poincare<T: Real>(length: T) -> [T; 2] {
    let root = length / T::of(4.730_040_744_862_704);
    [length / T::of(core::f64::consts::PI), root * root]
}

pub(crate) fn uniqueness<T: Real, M: Model<T>>(model: &M, places: &[Place<T, M>]) -> Uniqueness<T> {
    let (beam, conduction) = (model.beam(), model.conduction());
    let zero = T::zero();
    let mu1 = if M::Mu1::PRESENT { range(conduction.mu1, places).1 } else { zero };
    let mu2 = if M::Mu2::PRESENT { range(conduction.mu2, places).1 } else { zero };
    if mu1 == zero && mu2 == zero {
        return Uniqueness { certified: true, margin_bending: None, margin_electric: None };
    }
    let (m, mq) = (conduction.truncation, conduction.potential_truncation);
    let half = T::of(0.5);
    let [c1, c2] = poincare(model.length());
    let stiffness = range(beam.bending, places).0 / c2 / c2;
    let permittivity = range(beam.permittivity, places).0 / c1 / c1;
    let bending = stiffness / (mu1 * (mq + half * m) + mu2 * m);
    let electric = permittivity / (mu1 * (half * m) + mu2 * m);
    Uniqueness {
        certified: bending > T::one() && electric > T::one(),
        margin_bending: Some(bending),
        margin_electric: Some(electric),
    }
}

pub(crate) fn hypotheses<T: Real, M: Model<T>>(
    model: &M,
    uniqueness: &Uniqueness<T>,
) -> ArrayVec<Warning<T>, 8> {
    let mut warnings = ArrayVec::new();
    let foundation = model.foundation();
    if !foundation.law.is_lipschitz() {
        warnings.push(Warning::LawNotLipschitz);
    }
    if M::Gap::PRESENT {
        let gap = foundation.gap;
        let (length, half) = (model.length(), T::of(0.5));
        let breaks = gap.breaks();
        let inner = [
            (T::zero(), breaks.first().map_or(length, |&b| b) * half),
            (length, half * (length + breaks.last().map_or(T::zero(), |&b| b))),
        ];
        for (x, mid) in inner {
            let [gap, slope, _] = gap.jet(x, mid);
            if gap != T::zero() || slope != T::zero() {
                warnings.push(Warning::GapAtClamp { x, gap, slope });
            }
        }
        for (i, &x) in breaks.iter().enumerate() {
            let before = if i == 0 { T::zero() } else { breaks[i - 1] };
            let after = breaks.get(i + 1).map_or(length, |&b| b);
            let slope = |mid: T| gap.jet(x, mid)[1];
            let (left, right) = (slope(half * (before + x)), slope(half * (x + after)));
            if (left - right).abs() > T::of(1024.0) * T::epsilon() * (left.abs() + right.abs()) {
                warnings.push(Warning::GapKink { x });
                break;
            }
        }
    }
    if !uniqueness.certified {
        let margins = [uniqueness.margin_bending, uniqueness.margin_electric];
        let margin = margins.into_iter().flatten().fold(T::infinity(), T::min);
        warnings.push(Warning::NotUnique { margin });
    }
    warnings
}
