//! What a caller may set, and how a solve ends.

use crate::error::{Error, Place, expect};
use crate::real::Real;
use core::fmt;

/// When to stop.
///
/// ```
/// let settings = piezobeam::Settings { stop: 1e-8, ..Default::default() };
/// assert_eq!(settings.max_visits, None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings<T> {
    /// Relative residual at which a solve has converged: the largest difference between the moment that
    /// the deformation gives and the one that statics gives, over the largest moment.
    /// Default 1e-10, in `f32` 2^-14.
    pub stop: T,
    /// Cap on element visits; `None` is 400 per element of the mesh and 100 000.
    pub max_visits: Option<usize>,
}

impl<T: Real> Default for Settings<T> {
    fn default() -> Self {
        Self { stop: T::of(1e-10).max(T::of(512.0) * T::epsilon()), max_visits: None }
    }
}

impl<T: Real> Settings<T> {
    pub(crate) fn validate(&self) -> Result<(), Error> {
        let ok = self.stop > T::zero() && self.stop < T::one();
        expect(ok, "stop", Place::Whole, "a number between 0 and 1", self.stop)
    }
}

/// How a solve ended. All but [`Status::Converged`] come with the best iterate found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Status {
    /// The residual, checked on all elements, is at most `stop`.
    Converged,
    /// The cap on element visits was reached.
    VisitLimit,
    /// Iterations stopped reducing the residual, which is above what rounding explains.
    Stagnation,
    /// A pivot of the recursion is singular or not finite.
    Breakdown {
        /// Element, counted from 0 at the left end of the mesh at hand.
        element: usize,
    },
    /// The compliance law returned a number that is not finite.
    LawNotFinite {
        /// Element where it was called.
        element: usize,
    },
    /// The compliance law returned a negative pressure or slope.
    LawNotMonotone {
        /// Element where it was called.
        element: usize,
    },
    /// The residual is as small as rounding lets it become for this scene, but above `stop`. Or rounding that the
    /// moments' balance does not see is above it, and then is the report's residual and floor: of the potential, over
    /// the largest one, where P^2 is far above EA eps; of loads and fluxes below the normal numbers. So after
    /// `Converged` none has lost more than `stop`: a potential with eight digits of sixteen left is converged to 1e-7, not to 1e-10.
    ToleranceBelowFloor,
    /// Only of a [`Method`](crate::Method): it settled on a contact set under which the foundation pulls the beam.
    FoundationPulls {
        /// Element where it pulls most.
        element: usize,
    },
    /// Only of a [`Method`](crate::Method): its iteration goes in circles.
    Cycle {
        /// Iterations until the same state comes back.
        period: usize,
    },
    /// Only of a [`Method`](crate::Method): its own equations are solved, but with the law integrated up to the
    /// contact's edges the residual is above `stop`.
    OwnEquations,
}

impl Status {
    /// Lower snake case, for machines.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::VisitLimit => "visit_limit",
            Self::Stagnation => "stagnation",
            Self::Breakdown { .. } => "numerical_breakdown",
            Self::LawNotFinite { .. } => "law_not_finite",
            Self::LawNotMonotone { .. } => "law_not_monotone",
            Self::ToleranceBelowFloor => "tolerance_below_floor",
            Self::FoundationPulls { .. } => "foundation_pulls",
            Self::Cycle { .. } => "cycle",
            Self::OwnEquations => "own_equations",
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Converged => write!(f, "converged"),
            Self::VisitLimit => {
                write!(f, "the cap on the work of a solve (max_visits) was reached")
            }
            Self::Stagnation => write!(
                f,
                "iterations stopped reducing the residual; a law this steep, or conduction this strong, needs a \
                 finer mesh"
            ),
            Self::Breakdown { element } => write!(
                f,
                "the pivot of element {element} is singular or not finite; look for coefficients whose \
                 sizes differ by more than the number format can hold"
            ),
            Self::LawNotFinite { element } => write!(
                f,
                "the compliance law returned a number that is not finite in element {element}; it has to \
                 be finite for every penetration"
            ),
            Self::LawNotMonotone { element } => write!(
                f,
                "the compliance law returned a negative pressure or slope in element {element}; it has to \
                 be zero at zero and must not decrease"
            ),
            Self::ToleranceBelowFloor => write!(
                f,
                "the residual is at the rounding floor of this scene, above the tolerance; ask for a \
                 larger stop"
            ),
            Self::FoundationPulls { element } => write!(
                f,
                "the iteration settled on a contact set under which the foundation pulls the beam, most in element \
                 {element}: what looks converged is no equilibrium"
            ),
            Self::Cycle { period } => {
                write!(
                    f,
                    "the iteration goes in circles: every {period} iterations the same state comes back"
                )
            }
            Self::OwnEquations => write!(
                f,
                "the method solved its own equations, which integrate the contact across its edges; with the law \
                 itself the residual is above the tolerance"
            ),
        }
    }
}

/// How a solve went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report<T> {
    /// How it ended.
    pub status: Status,
    /// Relative residual of the returned state (see [`Settings::stop`]), evaluated on all elements.
    pub residual: T,
    /// The residual that rounding alone may leave in this scene.
    pub floor: T,
    /// Newton steps on all meshes together. What was iterated around the contact's edges alone is in the visits.
    pub iterations: usize,
    /// Elements whose matrices were evaluated or re-factored, summed over all meshes and iterations.
    pub element_visits: usize,
    /// Elements of the mesh.
    pub elements: usize,
}

impl<T> Report<T> {
    /// Converged, or as well as rounding lets it.
    pub(crate) fn is_solved(&self) -> bool {
        matches!(self.status, Status::Converged | Status::ToleranceBelowFloor)
    }
}
