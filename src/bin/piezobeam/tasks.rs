//! What the commands do with a scene: solve it, check it, time it.

use crate::cli::MethodArgs;
use crate::model::Task;
use crate::report::{
    Adaptive, CERTIFIED, Contact, Method, Reaction, Report, Resultants, Samples, Timing, Uniqueness,
};
use crate::sensitivities;
use piezobeam::{
    Error, Fields, HeapWorkspace, Mesh, Model, Prepared, Problem, Reached, Real, Settings, Solution, Status,
};
use std::time::Instant;

/// A solved scene with its fields at uniform points, and the gap there.
pub struct Solved {
    pub report: Report,
    pub gap: Option<Vec<f64>>,
}

/// Where an accuracy was missed it is asked for again, so many times stricter, and no stricter than that in all.
const STRICTER: f64 = 0.1;
const STRICTEST: f64 = 1e-3;

/// Solve, and sample the fields at `samples` uniform points, ends included.
pub struct Solve {
    /// `None`: the library's default.
    pub stop: Option<f64>,
    /// Relative accuracy for which the mesh is made; `None`: the mesh is the problem's own.
    pub tolerance: Option<f64>,
    pub samples: usize,
    pub sensitivities: bool,
    pub method: MethodArgs,
}

impl Task for Solve {
    type Output = Solved;
    fn run<T: Real, M: Model<T>>(self, problem: Problem<'_, T, M>) -> Result<Solved, Error> {
        let settings = settings::<T>(self.stop);
        let mut memory = HeapWorkspace::new();
        let Some(tolerance) = self.tolerance else {
            let mut prepared = problem.prepare(&mut memory)?;
            let method = solve_by(&self.method, &mut prepared, self.stop)?;
            let mut solved = self.solved(&prepared.last().ok_or(NOTHING)?, &settings);
            solved.report.method = method;
            if self.sensitivities {
                solved.report.sensitivities = Some(sensitivities::of(&mut prepared));
            }
            return Ok(solved);
        };
        if !T::DOUBLE {
            return Err(ONLY_DOUBLE);
        }
        let (mut solved, nodes) = self.adapted(&problem, &mut memory, tolerance, &settings)?;
        if self.sensitivities {
            // On the mesh that was made.
            let problem = problem.on(Mesh::Nodes(&nodes))?;
            let mut prepared = problem.prepare(&mut memory)?;
            prepared.solve(&settings)?;
            solved.report.sensitivities = Some(sensitivities::of(&mut prepared));
        }
        Ok(solved)
    }
}

impl Solve {
    /// The report of a solution on a mesh made for `tolerance`, and the mesh's nodes.
    fn adapted<T: Real, M: Model<T>>(
        &self,
        problem: &Problem<'_, T, M>,
        memory: &mut HeapWorkspace<T, M>,
        tolerance: f64,
        settings: &Settings<T>,
    ) -> Result<(Solved, Vec<T>), Error> {
        let (mut asked, mut visits) = (tolerance, 0);
        loop {
            let found = problem.solve_to(memory, T::of(asked), settings)?;
            let mut solved = self.solved(&found.solution, settings);
            visits += solved.report.element_visits;
            solved.report.element_visits = visits;
            // The certificate knows the error better than the meshes do.
            let missed = found.reached == Reached::Tolerance
                && solved.report.error_estimate.is_some_and(|error| error > tolerance);
            if missed && asked > STRICTEST * tolerance {
                asked *= STRICTER;
                continue;
            }
            let reached = if missed { Reached::Capacity } else { found.reached };
            solved.report.adaptive = Some(Adaptive {
                tolerance,
                reached: reached.name().into(),
                meaning: reached.to_string(),
                passes: found.passes,
            });
            solved.report.method.name = self.method.method.name();
            return Ok((solved, found.solution.nodes().collect()));
        }
    }

    /// The report of a solution, with what is known of its error.
    fn solved<T: Real, M: Model<T>>(&self, solution: &Solution<'_, T, M>, settings: &Settings<T>) -> Solved {
        let mut solved = solved(solution, self.samples);
        let report = &mut solved.report;
        // In double precision only, to compile it once: in single precision rounding is soon more than the mesh's error.
        if T::DOUBLE && report.converged() && report.elements <= CERTIFIED {
            // Without a mesh that divides this one, to rounding, there is no certificate.
            let Ok(found) = solution.certify(&mut HeapWorkspace::new(), settings) else { return solved };
            report.error_bound = found.bending_bound.map(Real::f64);
            report.electric_error_bound = found.electric_bound.map(Real::f64);
            // Estimates are differences to a finer solution, if there is one.
            if matches!(found.report.status, Status::Converged | Status::ToleranceBelowFloor) {
                report.error_estimate = Some(found.bending_estimate.f64());
                report.stretching_error_estimate = found.stretching_estimate.map(Real::f64);
                report.potential_error_estimate = found.potential_estimate.map(Real::f64);
            }
        }
        solved
    }
}

/// Warnings and the uniqueness condition. The scene is sampled, as it is before a solve, and solved, as some
/// warnings are of the solution.
pub struct Check;

impl Task for Check {
    type Output = (Vec<String>, Uniqueness, usize);
    fn run<T: Real, M: Model<T>>(self, problem: Problem<'_, T, M>) -> Result<Self::Output, Error> {
        let mut memory = HeapWorkspace::new();
        let solution = problem.solve(&mut memory, &Settings::default())?;
        let warnings = solution.warnings().iter().map(ToString::to_string).collect();
        Ok((warnings, uniqueness(&solution), solution.report().elements))
    }
}

/// Time cold solves: the scene is sampled and memory allocated before.
pub struct Time<'p> {
    pub repeat: usize,
    pub progress: &'p dyn Fn(),
}

impl Task for Time<'_> {
    type Output = Timing;
    const LEAN: bool = true;
    fn run<T: Real, M: Model<T>>(self, problem: Problem<'_, T, M>) -> Result<Timing, Error> {
        let mut memory = HeapWorkspace::new();
        let mut prepared = problem.prepare(&mut memory)?;
        let settings = Settings::default();
        let mut report = prepared.solve(&settings)?;
        let mut nanoseconds = Vec::with_capacity(self.repeat);
        for _ in 0..self.repeat {
            let start = Instant::now();
            report = prepared.solve(&settings)?;
            nanoseconds.push(start.elapsed().as_secs_f64() * 1e9);
            (self.progress)();
        }
        nanoseconds.sort_by(f64::total_cmp);
        let at = |i: usize| nanoseconds.get(i).copied().unwrap_or(0.0);
        let n = nanoseconds.len();
        Ok(Timing {
            status: report.status.name().into(),
            elements: report.elements,
            iterations: report.iterations,
            element_visits: report.element_visits as u64,
            precision: core::any::type_name::<T>().into(),
            repeat: n,
            best_ns: at(0),
            median_ns: 0.5 * (at(n.saturating_sub(1) / 2) + at(n / 2)),
            worst_ns: at(n.saturating_sub(1)),
            bytes_per_element: HeapWorkspace::<T, M>::BYTES_PER_ELEMENT,
        })
    }
}

/// What the command line does not do in single precision; the arguments are checked before.
const ONLY_DOUBLE: Error = Error::Missing { field: "--precision f64", needed_by: "--tolerance and --method" };

/// There is a solution after every solve.
const NOTHING: Error = Error::Missing { field: "mesh", needed_by: "the solve" };

/// Solves by the method that was asked for, and gives what there is to say of that.
pub fn solve_by<T: Real, M: Model<T>>(
    method: &MethodArgs,
    prepared: &mut Prepared<'_, T, M>,
    stop: Option<f64>,
) -> Result<Method, Error> {
    let settings = settings::<T>(stop);
    let name = method.method.name();
    let Some(method) = method.method::<T>() else {
        prepared.solve(&settings)?;
        return Ok(Method { name, ..Method::default() });
    };
    if !T::DOUBLE {
        return Err(ONLY_DOUBLE);
    }
    let found = prepared.solve_by(&method, &settings)?;
    Ok(Method {
        name,
        own_residual: Some(found.own_residual.f64()),
        lowest_pressure: Some(found.lowest_pressure.f64()),
        highest_pressure: Some(found.highest_pressure.f64()),
    })
}

fn settings<T: Real>(stop: Option<f64>) -> Settings<T> {
    let default = Settings::default();
    Settings { stop: stop.map_or(default.stop, T::of), ..default }
}

fn uniqueness<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>) -> Uniqueness {
    let found = solution.uniqueness();
    Uniqueness {
        certified: found.certified,
        margin_bending: found.margin_bending.map(Real::f64),
        margin_electric: found.margin_electric.map(Real::f64),
    }
}

fn solved<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>, samples: usize) -> Solved {
    let length = solution.scene().length();
    let last = samples.max(2) - 1;
    let fields: Vec<Fields<T>> = (0..=last)
        .map(|i| {
            let share = T::of(i as f64 / last as f64);
            solution.at(if i == last { length } else { length * share })
        })
        .collect();
    let column = |get: fn(&Fields<T>) -> T| fields.iter().map(|f| get(f).f64()).collect::<Vec<_>>();
    let optional = |get: fn(&Fields<T>) -> Option<T>| {
        fields.iter().map(|f| get(f).map(Real::f64)).collect::<Option<Vec<_>>>()
    };
    let found = solution.resultants();
    let report = solution.report();
    let gap = optional(|f| f.gap);
    let status = report.status;
    let report = Report {
        status: status.name().into(),
        reason: (status != Status::Converged).then(|| status.to_string()),
        iterations: report.iterations,
        element_visits: report.element_visits as u64,
        elements: report.elements,
        residual: report.residual.f64(),
        error_bound: None,
        error_estimate: None,
        electric_error_bound: None,
        stretching_error_estimate: None,
        potential_error_estimate: None,
        adaptive: None,
        warnings: solution.warnings().iter().map(ToString::to_string).collect(),
        samples: Samples {
            x: column(|f| f.x),
            bending: Some(column(|f| f.bending)),
            slope: Some(column(|f| f.slope)),
            moment: Some(column(|f| f.moment)),
            shear: Some(column(|f| f.shear)),
            stretching: optional(|f| f.stretching),
            potential: optional(|f| f.potential),
            axial_force: optional(|f| f.axial_force),
            electric_displacement: optional(|f| f.electric_displacement),
        },
        contact: gap.as_ref().map(|_| Contact {
            zones: solution.zones().iter().map(|z| z.map(Real::f64)).collect(),
            force: found.contact_force.f64(),
        }),
        uniqueness: uniqueness(solution),
        resultants: Resultants {
            left: Reaction { force: found.left_force.f64(), moment: found.left_moment.f64() },
            right: Reaction { force: found.right_force.f64(), moment: found.right_moment.f64() },
            bending_energy: found.bending_energy.f64(),
            equilibrium_error: found.equilibrium_error.f64(),
        },
        precision: core::any::type_name::<T>().into(),
        method: Method::default(),
        sensitivities: None,
    };
    Solved { report, gap }
}
