//! Derivatives at a converged solution, for control and design.
//!
//! Where a solution depends smoothly on a parameter its derivative solves a linear system: the tangent at the
//! solution, loaded by minus the derivative of the residual to the parameter. A [`Tangent`] is that solution,
//! from one sweep: how *all* fields and outputs change with *one* parameter. An [`Adjoint`] solves the transposed
//! system for the weights of one output: how *one* output changes with *all* parameters, and with a transverse
//! force anywhere, its influence line. Both are exact derivatives of the discrete solution, not differences, but for
//! quadrature next to a contact edge where the law is no polynomial there.
//!
//! ```
//! use piezobeam::{Beam, Load, Mesh, Output, Parameter, Problem, Scene, Settings};
//!
//! let scene = Scene::new(1.0_f64, Beam::elastic(5000.0))
//!     .load(Load { transverse: 1e6, axial: (), points: () });
//! let problem = Problem::new(scene, Mesh::uniform(10))?;
//! let mut memory = problem.workspace::<16>();
//! let mut beam = problem.prepare(&mut memory)?;
//! beam.solve(&Settings::default())?;
//!
//! // f L^4 / (384 C) at midspan, so C d/dC is minus that, and f d/df that.
//! let middle = 1e6 / (384.0 * 5000.0);
//! let stiffer = beam.tangent(Parameter::Bending)?;
//! assert!((stiffer.of(Output::Bending(0.5)).unwrap() + middle).abs() < 1e-12);
//! let deflection = beam.adjoint(Output::Bending(0.5))?;
//! assert!((deflection.to(Parameter::Transverse).unwrap() - middle).abs() < 1e-12);
//! // L^3 / (192 C) metres per newton at midspan.
//! assert!((deflection.influence(0.5) - 1.0 / (192.0 * 5000.0)).abs() < 1e-15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chain;
mod grazing;
mod rate;

pub use grazing::Grazing;

use crate::law::Compliance;
use crate::newton::nested::Answer;
use crate::newton::{Report, Status};
use crate::problem::Prepared;
use crate::profile::Profile;
use crate::real::{Pair, Real, Sum};
use crate::scene::Model;
use crate::solution::{Fields, Solution};
use crate::storage::State;
use chain::{System, Task, held_by_gap, moved, variation};
use core::fmt;
use rate::{Direction, Rate, Variation, shapes};

/// What a derivative is taken to.
///
/// *Profiles* (bending stiffness to axial load): to a factor on the whole profile, at factor 1. A derivative has
/// the output's unit and is the output's change per relative change of the profile: one per cent more gives a
/// hundredth of it. For a constant profile p it is p times the derivative to p.
///
/// *Forces, moments and potentials*: to the number itself, so per newton, newton metre or volt.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Parameter<T> {
    /// A factor on the bending stiffness C.
    Bending,
    /// A factor on the axial stiffness EA.
    Axial,
    /// A factor on the piezoelectric coefficient P.
    Piezo,
    /// A factor on the permittivity eps.
    Permittivity,
    /// A factor on the foundation's pressure: for p = k r^a, on k.
    Stiffness,
    /// A factor on the gap s.
    Gap,
    /// A factor on mu1.
    Mu1,
    /// A factor on mu2.
    Mu2,
    /// A factor on the transverse load per length; concentrated loads stay.
    Transverse,
    /// A factor on the axial load.
    AxialLoad,
    /// Force of the concentrated load of this number, counted from 0 \[per N\].
    PointForce(usize),
    /// Moment of the concentrated load of this number, counted from 0 \[per N m\].
    PointMoment(usize),
    /// A transverse force at this x in metres, positive towards the foundation, whether or not the scene has one
    /// there \[per N\].
    Force(T),
    /// Potential at x = 0 \[per V\].
    LeftPotential,
    /// Potential at x = L \[per V\].
    RightPotential,
}

/// What is differentiated. An x outside of \[0, L\] is moved into it, as [`Solution::at`] does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Output<T> {
    /// Bending xi at x \[m\].
    Bending(T),
    /// Slope xi' at x \[1\].
    Slope(T),
    /// Moment C xi'' at x \[N m\].
    Moment(T),
    /// Shear (C xi'')' at x \[N\].
    Shear(T),
    /// Stretching u at x \[m\].
    Stretching(T),
    /// Potential q at x \[V\].
    Potential(T),
    /// Axial force sigma at x \[N\].
    AxialForce(T),
    /// Electric displacement D at x \[C\].
    ElectricDisplacement(T),
    /// Integral of the foundation's pressure \[N\].
    ContactForce,
    /// Force of the left clamp on the beam \[N\].
    LeftForce,
    /// Force of the right clamp on the beam \[N\].
    RightForce,
    /// Moment C xi'' at the left clamp \[N m\].
    LeftMoment,
    /// Moment C xi'' at the right clamp \[N m\].
    RightMoment,
}

/// Why there is no derivative.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SensitivityError {
    /// Nothing was solved since the scene was laid into memory.
    Unsolved,
    /// The last solve did not converge: its state is no solution.
    NotConverged(Status),
    /// The scene lacks the parameter or the output, as a piezoelectric coefficient, a potential, or a
    /// concentrated load of that number.
    Absent,
    /// A list of results is not as long as rows times columns.
    Length {
        /// The length that fits.
        expected: usize,
        /// The length found.
        found: usize,
    },
    /// A pivot of the tangent is singular or not finite: the solution is at a turning point.
    Breakdown {
        /// Element, counted from 0.
        element: usize,
    },
    /// The compliance law changed its mind since the solve.
    Law {
        /// Element, counted from 0.
        element: usize,
    },
}

impl fmt::Display for SensitivityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsolved => write!(f, "derivatives are taken at a solution: solve first"),
            Self::NotConverged(status) => write!(
                f,
                "derivatives are taken at a solution, and the last solve did not converge ({})",
                status.name()
            ),
            Self::Absent => write!(f, "the scene lacks the parameter or the output"),
            Self::Length { expected, found } => {
                write!(f, "expected room for {expected} derivatives, found {found}")
            }
            Self::Breakdown { element } => write!(
                f,
                "the tangent is singular or not finite in element {element}: the solution has no derivative"
            ),
            Self::Law { element } => write!(
                f,
                "the compliance law is not finite or not monotone in element {element}, as it was in the solve"
            ),
        }
    }
}

impl core::error::Error for SensitivityError {}

impl<T: Real> Parameter<T> {
    /// Has the scene this parameter?
    #[must_use]
    pub fn is_in<M: Model<T>>(&self, scene: &M) -> bool {
        match *self {
            Self::Bending => true,
            Self::Axial => M::Axial::PRESENT,
            Self::Piezo => M::Piezo::PRESENT,
            Self::Permittivity | Self::LeftPotential | Self::RightPotential => M::Permittivity::PRESENT,
            Self::Stiffness => M::Law::PRESENT,
            Self::Gap => M::Gap::PRESENT,
            Self::Mu1 => M::Mu1::PRESENT,
            Self::Mu2 => M::Mu2::PRESENT,
            Self::Transverse => M::Transverse::PRESENT,
            Self::AxialLoad => M::AxialLoad::PRESENT,
            Self::PointForce(i) | Self::PointMoment(i) => i < scene.load().points.len(),
            Self::Force(x) => x.is_finite(),
        }
    }

    /// The direction in which it moves the elements' data.
    fn direction<M: Model<T>>(self, view: &Solution<'_, T, M>) -> Direction<T> {
        let (element, t) = match self {
            Self::Force(x) => {
                let i = element_at(view, x);
                let x = x.max(T::zero()).min(view.scene.length());
                (i, view.solved(i).t(x))
            }
            Self::PointForce(number) | Self::PointMoment(number) => {
                let x = view.scene.load().points[number].x;
                // As elements take the load at their right node for their own.
                let tiny = T::of(16.0) * T::epsilon() * view.scene.length();
                (view.places.partition_point(|place| place.element.right < x - tiny), T::zero())
            }
            _ => (usize::MAX, T::zero()),
        };
        Direction { parameter: Some(self), element, t }
    }
}

impl<T: Real> Output<T> {
    /// Has the scene this output?
    #[must_use]
    pub fn is_in<M: Model<T>>(&self, _: &M) -> bool {
        match *self {
            Self::Bending(x) | Self::Slope(x) | Self::Moment(x) | Self::Shear(x) => x.is_finite(),
            Self::Stretching(x) | Self::AxialForce(x) => M::Axial::PRESENT && x.is_finite(),
            Self::Potential(x) | Self::ElectricDisplacement(x) => M::Permittivity::PRESENT && x.is_finite(),
            Self::ContactForce => M::Law::PRESENT,
            Self::LeftForce | Self::RightForce | Self::LeftMoment | Self::RightMoment => true,
        }
    }

    /// Where the output looks; `None` where that is everywhere.
    fn place(self, length: T) -> Option<T> {
        match self {
            Self::Bending(x)
            | Self::Slope(x)
            | Self::Moment(x)
            | Self::Shear(x)
            | Self::Stretching(x)
            | Self::Potential(x)
            | Self::AxialForce(x)
            | Self::ElectricDisplacement(x) => Some(x),
            Self::LeftForce | Self::LeftMoment => Some(T::zero()),
            Self::RightForce | Self::RightMoment => Some(length),
            Self::ContactForce => None,
        }
    }

    /// Does the output depend on what happens in element i, by itself?
    fn concerns<M: Model<T>>(self, view: &Solution<'_, T, M>, i: usize) -> bool {
        let right = |i: usize| view.places[i].element.right;
        self.place(view.scene.length())
            .is_none_or(|x| (i == 0 || right(i - 1) < x) && (i + 1 == view.places.len() || x <= right(i)))
    }
}

/// The element that holds x.
fn element_at<T: Real, M: Model<T>>(view: &Solution<'_, T, M>, x: T) -> usize {
    view.places.partition_point(|place| place.element.right < x).min(view.places.len() - 1)
}

/// How the solution changes with one parameter.
pub struct Tangent<'p, T: Real, M: Model<T>> {
    view: Solution<'p, T, M>,
    along: Direction<T>,
    left: [T; 4],
}

impl<T: Real, M: Model<T>> Tangent<'_, T, M> {
    /// The derivatives of all fields at x to the parameter, in the fields' units, by the parameter's where it
    /// is a force, a moment or a potential. `x` is the place itself.
    ///
    /// # Cost
    /// As [`Solution::at`].
    #[must_use]
    pub fn at(&self, x: T) -> Fields<T> {
        let x = x.max(T::zero()).min(self.view.scene.length());
        let i = element_at(&self.view, x);
        let by = variation(&self.view, i, self.left);
        Rate::new(&self.view.solved(i), i, self.along, by).fields(x)
    }

    /// The derivative of an output to the parameter; `None` where the scene has no such output.
    ///
    /// # Cost
    /// As [`Solution::at`]; the contact force takes a pass over all elements.
    #[must_use]
    pub fn of(&self, output: Output<T>) -> Option<T> {
        if !output.is_in(self.view.scene) {
            return None;
        }
        let of = |i: usize| {
            let by = variation(&self.view, i, self.left);
            Rate::new(&self.view.solved(i), i, self.along, by).output(output)
        };
        let Some(x) = output.place(self.view.scene.length()) else {
            let mut sum = Sum::<T>::default();
            (0..self.view.places.len()).for_each(|i| sum.add(of(i)));
            return Some(sum.value());
        };
        Some(of(element_at(&self.view, x)))
    }

    /// The solution at which the derivative was taken.
    #[must_use]
    pub fn solution(&self) -> &Solution<'_, T, M> {
        &self.view
    }
}

/// How one output changes with the parameters.
pub struct Adjoint<'p, T: Real, M: Model<T>> {
    view: Solution<'p, T, M>,
    output: Output<T>,
    ends: [T; 2],
}

impl<T: Real, M: Model<T>> Adjoint<'_, T, M> {
    /// The derivative of the output to a parameter (see [`Parameter`] for its unit); `None` where the scene
    /// has no such parameter.
    ///
    /// # Cost
    /// A pass over all elements; none for [`Parameter::Force`] and the potentials.
    #[must_use]
    pub fn to(&self, parameter: Parameter<T>) -> Option<T> {
        let view = &self.view;
        if !parameter.is_in(view.scene) {
            return None;
        }
        match parameter {
            Parameter::LeftPotential => return Some(self.ends[0]),
            Parameter::RightPotential => return Some(self.ends[1]),
            Parameter::Force(x) => return Some(self.influence(x)),
            _ => {}
        }
        let along = parameter.direction(view);
        let mut sum = Sum::<T>::default();
        for i in 0..view.places.len() {
            let solved = view.solved(i);
            let rate = Rate::new(&solved, i, along, Variation::default());
            if self.output.concerns(view, i) {
                sum.add(rate.output(self.output));
            }
            let State { e, d } = moved(view, i);
            let (on_e, on_d) = rate.residual();
            sum.add(-e.times(on_e));
            sum.add(-d.times(on_d));
            if crate::electric::present::<T, M>() {
                let source = rate.source();
                let [m_u, m_q, v, r] = view.places[i].work.factor.kept();
                sum.add(v * source.load);
                sum.add(r * source.current);
                sum.add(-(m_u * source.u));
                sum.add(-(m_q * source.q));
            }
        }
        if M::Gap::PRESENT && parameter == Parameter::Gap {
            sum.add(held_by_gap(view, self.output));
        }
        Some(sum.value())
    }

    /// The influence line: the derivative of the output to a transverse force at x, in the output's unit per
    /// newton. A force on a clamp changes its reaction alone.
    ///
    /// # Cost
    /// A bisection for the element.
    #[must_use]
    pub fn influence(&self, x: T) -> T {
        let view = &self.view;
        let along = Parameter::Force(x).direction(view);
        let i = along.element;
        let solved = view.solved(i);
        let State { e, d } = moved(view, i);
        let (on_e, on_d) = shapes(solved.element.h, along.t);
        let line = e.times(on_e) + d.times(on_d);
        if !self.output.concerns(view, i) {
            return line;
        }
        line + Rate::new(&solved, i, along, Variation::default()).output(self.output)
    }

    /// The solution at which the derivative was taken.
    #[must_use]
    pub fn solution(&self) -> &Solution<'_, T, M> {
        &self.view
    }
}

impl<T: Real, M: Model<T>> Prepared<'_, T, M> {
    /// The solution of the last solve, which derivatives leave as it is; `None` before the first.
    #[must_use]
    pub fn last(&self) -> Option<Solution<'_, T, M>> {
        let answer = self.answer?;
        Some(Solution::new(self.scene, &self.places[..self.elements()], answer))
    }

    /// How the solution of the last solve changes with `parameter`.
    ///
    /// # Errors
    /// No converged solution, no such parameter, or no derivative.
    ///
    /// # Cost
    /// One linear sweep over the mesh, with conduction in both directions that of the coupled system, and two
    /// passes for the potential, four where bending depends on it. No allocation: the memory of the sweeps is
    /// used, the solution stays.
    pub fn tangent(&mut self, parameter: Parameter<T>) -> Result<Tangent<'_, T, M>, SensitivityError> {
        let mut system = self.system()?;
        if !parameter.is_in(system.scene) {
            return Err(SensitivityError::Absent);
        }
        let along = parameter.direction(&system.view());
        system.solve(Task::Rates(along))?;
        let System { scene, places, answer, left, .. } = system;
        Ok(Tangent { view: Solution::new(scene, places, answer), along, left })
    }

    /// How `output` of the last solve's solution changes with the parameters.
    ///
    /// # Errors
    /// No converged solution, no such output, or no derivative.
    ///
    /// # Cost
    /// As [`Prepared::tangent`].
    pub fn adjoint(&mut self, output: Output<T>) -> Result<Adjoint<'_, T, M>, SensitivityError> {
        let mut system = self.system()?;
        if !output.is_in(system.scene) {
            return Err(SensitivityError::Absent);
        }
        system.solve(Task::Weights(output))?;
        let System { scene, places, answer, ends, .. } = system;
        Ok(Adjoint { view: Solution::new(scene, places, answer), output, ends })
    }

    /// The derivatives of all `outputs` to all `parameters`, output by output, into `values`.
    ///
    /// # Errors
    /// As [`Prepared::tangent`] and [`Prepared::adjoint`]; a list that is not as long as the number of outputs
    /// times that of parameters.
    ///
    /// # Cost
    /// A tangent for each parameter or an adjoint for each output, whichever are fewer.
    pub fn derivatives(
        &mut self,
        outputs: &[Output<T>],
        parameters: &[Parameter<T>],
        values: &mut [T],
    ) -> Result<(), SensitivityError> {
        let (columns, expected) = (parameters.len(), outputs.len() * parameters.len());
        if values.len() != expected {
            return Err(SensitivityError::Length { expected, found: values.len() });
        }
        let absent = SensitivityError::Absent;
        if parameters.len() <= outputs.len() {
            for (j, &parameter) in parameters.iter().enumerate() {
                let tangent = self.tangent(parameter)?;
                for (row, &output) in values.chunks_mut(columns).zip(outputs) {
                    row[j] = tangent.of(output).ok_or(absent)?;
                }
            }
        } else {
            for (row, &output) in values.chunks_mut(columns).zip(outputs) {
                let adjoint = self.adjoint(output)?;
                for (value, &parameter) in row.iter_mut().zip(parameters) {
                    *value = adjoint.to(parameter).ok_or(absent)?;
                }
            }
        }
        Ok(())
    }

    /// Is the solution of the last solve at a kink of the forces, where a derivative says little or nothing of
    /// changes of finite size? The first place, if there is one.
    ///
    /// Tested are the penetration against zero and, with conduction, against its truncation, and the
    /// potential against its own where mu1 acts: on stretches, to rounding of the largest value; at
    /// extremes inside the beam, to the root of that, against the extremes on both sides. At a clamp without a
    /// gap the penetration is zero with its slope, whatever happens; this is no grazing. A contact edge that
    /// the penetration crosses is none either: its motion changes the force by the square of a change.
    ///
    /// # Errors
    /// No converged solution.
    ///
    /// # Cost
    /// Some passes over all elements.
    pub fn grazing(&self) -> Result<Option<Grazing<T>>, SensitivityError> {
        self.converged()?;
        Ok(self.last().and_then(|solution| grazing::find(&solution)))
    }

    fn converged(&self) -> Result<Answer<T, M>, SensitivityError> {
        let answer = self.answer.ok_or(SensitivityError::Unsolved)?;
        let Report { status, .. } = answer.report;
        match status {
            Status::Converged => Ok(answer),
            status => Err(SensitivityError::NotConverged(status)),
        }
    }

    fn system(&mut self) -> Result<System<'_, T, M>, SensitivityError> {
        let answer = self.converged()?;
        let elements = self.elements();
        let places = &mut self.places[..elements];
        Ok(System { scene: self.scene, places, answer, left: [T::zero(); 4], ends: [T::zero(); 2] })
    }
}
