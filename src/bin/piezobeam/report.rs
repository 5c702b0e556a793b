//! What a run has to say, as plain data: filled once by the command, read by every renderer.
//!
//! The names and their order are the JSON contract. All quantities are in SI units; bending and transverse forces
//! are positive towards the foundation. A number that is not finite is written as `null`.

use serde::Serialize;

/// The status of a solve that met its stopping test.
pub const CONVERGED: &str = "converged";

/// Errors are bounded and estimated on meshes of so many elements at most: it takes a mesh four times as fine.
pub const CERTIFIED: usize = 50_000;

/// The result of `solve`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// [`CONVERGED`], or a short name of how the iteration ended instead.
    pub status: String,
    /// Why it did not converge, in a sentence.
    pub reason: Option<String>,
    /// Newton steps, all stages and meshes together.
    pub iterations: usize,
    /// Elements visited by all sweeps: the work done.
    pub element_visits: u64,
    pub elements: usize,
    /// Relative residual of the reported solution.
    pub residual: f64,
    /// Guaranteed bound on the error of the discrete bending in the energy norm, relative; `None` where theory gives
    /// none, or for more than [`CERTIFIED`] elements.
    pub error_bound: Option<f64>,
    /// Estimate of the largest error of bending, relative to the largest bending.
    pub error_estimate: Option<f64>,
    /// The same two of stretching and potential, together and each.
    pub electric_error_bound: Option<f64>,
    pub stretching_error_estimate: Option<f64>,
    pub potential_error_estimate: Option<f64>,
    /// `None` unless the mesh was made for a tolerance.
    pub adaptive: Option<Adaptive>,
    pub warnings: Vec<String>,
    pub samples: Samples,
    /// `None` where the scene has no foundation.
    pub contact: Option<Contact>,
    pub uniqueness: Uniqueness,
    pub resultants: Resultants,
    /// Floating-point type of the solve: `f64` or `f32`.
    pub precision: String,
    pub method: Method,
    /// `None` where they were not asked for.
    pub sensitivities: Option<Sensitivities>,
}

/// How a mesh was made for an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Adaptive {
    /// The relative error of bending that was asked for.
    pub tolerance: f64,
    /// `tolerance` if it was reached; `floor`, `capacity` or `unsolved` say why not.
    pub reached: String,
    /// The same in a sentence.
    pub meaning: String,
    /// Meshes solved on.
    pub passes: usize,
}

/// How it was solved; numbers are there for the paper's own methods only, by their own reckoning.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Method {
    /// As on the command line.
    pub name: &'static str,
    /// Last relative change of moments and contact forces.
    pub own_residual: Option<f64>,
    /// N/m; negative where the foundation pulls.
    pub lowest_pressure: Option<f64>,
    /// N/m
    pub highest_pressure: Option<f64>,
}

/// Derivatives of outputs to the parameters of the scene.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Sensitivities {
    /// What a number means, in a sentence.
    pub meaning: &'static str,
    /// Why there are none.
    pub error: Option<String>,
    /// What they may not say of changes of finite size.
    pub warning: Option<String>,
    pub parameters: Vec<Parameter>,
    pub outputs: Vec<Output>,
}

/// What a derivative is taken to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameter {
    /// Its field in a scene file.
    pub name: String,
    /// m: where, of a concentrated load.
    pub x: Option<f64>,
    /// N, N m or V; `None`: a factor on the whole profile, which has no unit.
    pub unit: Option<&'static str>,
}

/// What is differentiated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Output {
    pub name: &'static str,
    /// m: where, of a field.
    pub x: Option<f64>,
    pub unit: &'static str,
    /// To the parameters in their order, in `unit`, or in `unit` per unit of the parameter.
    pub derivatives: Vec<f64>,
}

/// The fields at the points `x`; `None` for a field the scene does not have.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Samples {
    /// m
    pub x: Vec<f64>,
    /// xi, m, positive towards the foundation.
    pub bending: Option<Vec<f64>>,
    /// xi', m/m
    pub slope: Option<Vec<f64>>,
    /// C xi'', N m
    pub moment: Option<Vec<f64>>,
    /// (C xi'')', N
    pub shear: Option<Vec<f64>>,
    /// u, m
    pub stretching: Option<Vec<f64>>,
    /// q, V
    pub potential: Option<Vec<f64>>,
    /// sigma, N
    pub axial_force: Option<Vec<f64>>,
    /// D integrated over the section, C
    pub electric_displacement: Option<Vec<f64>>,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Contact {
    /// Intervals `[a, b]` where the beam presses the foundation, m, in increasing order.
    pub zones: Vec<[f64; 2]>,
    /// Integral of the contact pressure, N; positive: the foundation is pressed.
    pub force: f64,
}

/// The sufficient condition for uniqueness; a margin is its left side over its right side: it holds above 1. `None`
/// without conduction, where the condition holds whatever the numbers.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Uniqueness {
    pub certified: bool,
    pub margin_bending: Option<f64>,
    pub margin_electric: Option<f64>,
}

#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Resultants {
    pub left: Reaction,
    pub right: Reaction,
    /// J
    pub bending_energy: f64,
    /// What is left of loads, contact and reactions together, relative to the sum of their sizes (no unit).
    pub equilibrium_error: f64,
}

/// What a clamp exerts on the beam.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Reaction {
    /// N, positive towards the foundation.
    pub force: f64,
    /// C xi'', N m
    pub moment: f64,
}

/// What `solve` shows to people: the report and what the scene adds to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub report: Report,
    pub title: String,
    /// m
    pub length: f64,
    /// The gap s at the points `report.samples.x`, m; `None` where the scene has no foundation.
    pub gap: Option<Vec<f64>>,
    /// What to know about the scene: name and value, the value with its unit.
    pub facts: Vec<(String, String)>,
}

/// The result of `check`.
#[derive(Debug, Clone, PartialEq)]
pub struct Checked {
    pub title: String,
    pub facts: Vec<(String, String)>,
    pub warnings: Vec<String>,
    pub uniqueness: Uniqueness,
}

/// The result of `time`; all times are nanoseconds per solve.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Timing {
    pub status: String,
    pub elements: usize,
    pub iterations: usize,
    pub element_visits: u64,
    pub precision: String,
    pub repeat: usize,
    pub best_ns: f64,
    pub median_ns: f64,
    pub worst_ns: f64,
    /// Memory of the solver.
    pub bytes_per_element: usize,
}

impl Report {
    pub fn converged(&self) -> bool {
        self.status == CONVERGED
    }

    /// What was asked for beyond convergence, and was not reached.
    pub fn missed(&self) -> Option<&Adaptive> {
        self.adaptive.as_ref().filter(|adaptive| adaptive.reached != "tolerance")
    }
}
