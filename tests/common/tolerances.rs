//! The one table of what the integration tests allow, and why.

/// Stiffness [N/m^2] from which the suite's foundations count as rigid: their boundary layers are thinner than
/// an element of a thousand, so that fields are held to the looser bounds below.
pub const RIGID: f64 = 1e12;

/// Relative error of xi, u and q against the suite at N = 1000: the discretisation leaves 1e-11.
pub const FIELD: f64 = 1e-9;
/// The same where the foundation is rigid: the boundary layer is not resolved, 1e-9 is measured at 1e16.
pub const FIELD_RIGID: f64 = 1e-6;
/// Relative error of the slope against the suite: one derivative of xi.
pub const SLOPE: f64 = 1e-7;
/// Relative error of moment and shear against the suite: they follow from statics and the contact's force.
pub const STATIC: f64 = 1e-5;
/// The same where the foundation is rigid: the shear jumps in the layer at the contact's edge.
pub const STATIC_RIGID: f64 = 1e-4;
/// Relative error of D against the suite, beside `DISPLACEMENT_ROUNDING`: D is fed by the squared penetration.
pub const DISPLACEMENT: f64 = 1e-6;
/// Rounding of D, over the size of eps q', which cancels against P u' in it.
pub const DISPLACEMENT_ROUNDING: f64 = 1e-13;
/// Relative error of contact force and bending energy: integrals of fields that are good to `FIELD`.
pub const RESULTANT: f64 = 1e-9;
/// The same where the foundation is rigid: the force is k times a penetration a few units of rounding above it.
pub const RESULTANT_RIGID: f64 = 1e-4;
/// Ends of contact zones, over the length: where xi' is not small an edge moves by as much as xi.
pub const EDGE: f64 = 1e-8;
/// The same where the foundation is rigid: xi leaves the gap so flat that an error of 1e-9 moves the edge far.
pub const EDGE_RIGID: f64 = 1e-5;
/// Ends of contact zones this near to a clamp, over the length, are the clamp's: the penetration is zero there.
pub const CLAMP: f64 = 1e-9;
/// What is left of the sum of all transverse forces over the sum of their sizes, up to N = 1000: rounding of
/// the end forces, which know the element's 1/h.
pub const EQUILIBRIUM: f64 = 5e-11;
/// Element visits of a solve: so many per element and so many beside, whatever the stiffness.
pub const VISITS: (usize, usize) = (8, 2000);

/// The same with conduction that acts on bending, up to a hundred times past the uniqueness condition: most take 5 to 30,
/// one whose attraction all but equals the beam's resistance took 310.
pub const COUPLED_VISITS: (usize, usize) = (400, 20_000);

/// Newton steps on all meshes of a beam half pressed and half lifted, up to 1000 elements and 1e16 N/m^2, with the
/// contact's edges iterated alone: 9 were needed, by full steps alone 53.
pub const FULL_STEPS: usize = 12;

/// Fields of random scenes with the contact's edges iterated alone and by full steps, over the largest bending: two states
/// with residuals up to 1e-10 each, and where the foundation is all but rigid rounding of forces of 1e-8.
pub const ALONE: f64 = 1e-7;

/// Fields from a warm and from a cold start: two states with residuals up to 1e-10 each.
pub const HISTORY: f64 = 1e-8;

/// Fields of a scene in a batch and alone: two states with residuals up to 1e-10 each, one of which may be refined.
pub const BATCH: f64 = 1e-8;

/// Nodal error over the maximum for the free beam at any N up to a million: a few roundings per node carried
/// along, of which the relative unknowns keep the sum bounded.
pub const FREE: f64 = 1e-12;
/// Fields of a beam without contact on a few elements: all integrals are of polynomials, only rounding is left.
pub const EXACT: f64 = 1e-12;
/// Full contact against its closed form: rounding and the closed form's own cancellation. The error of the
/// cubic, `WINKLER_ORDER` K / N^4 with K = k L^4 / C, is allowed beside it.
pub const WINKLER: f64 = 1e-11;
/// Constant of the cubic element's error in full contact: h^4 w'''' / 384 in an element, less at nodes.
pub const WINKLER_ORDER: f64 = 1.0 / 384.0;
/// Mirrored scenes: nodal values differ by rounding alone, fields between nodes by the quadrature of the law's
/// r^1.5, which starts from the left node.
pub const MIRROR: f64 = 1e-8;
/// Without contact everything is linear in the loads; sums differ by rounding.
pub const SUPERPOSITION: f64 = 1e-11;
/// A beam of smoothly varying stiffness in full contact on 64 elements against 2048: order four, whose constant
/// grows with the ratio of largest to smallest stiffness, 7 here; 2e-7 is measured.
pub const VARIABLE: f64 = 1e-6;
/// A step in C on a mesh with a node at it, against its closed form: only rounding is left.
pub const STEPPED: f64 = 1e-11;
/// Single precision: nodal error of the free beam at any N, in units of rounding: that of the samples of load
/// and stiffness and of the nodes' own x. About 4 are measured.
pub const SINGLE_UNITS: f32 = 16.0;

/// Order of xi at nodes in partial contact: four, less what the moving contact edge perturbs.
pub const ORDER: f64 = 3.7;
/// Order where the law has an unbounded second derivative at the contact's edge (Hertz, r^1.5).
pub const ORDER_HERTZ: f64 = 3.0;
/// Errors below this share of the maximum are rounding: no order can be read off them.
pub const ROUNDING: f64 = 2e-12;

/// Largest equilibrium error of random scenes: forces and reactions cancel to rounding times 1/h's conditioning.
pub const RANDOM_EQUILIBRIUM: f64 = 1e-8;
/// How much the integral of the squared penetration may grow with k relatively: discretisation of two scenes.
pub const MONOTONE_IN_K: f64 = 1e-3;
/// An integral of the squared penetration below this is none: the square of what rounding leaves of a gap.
pub const UNTOUCHED: f64 = 1e-24;
/// Two meshes, N and 4 N with N at least 20, agree to this share of the largest bending ...
pub const REFINED: f64 = 2e-2;
/// Energy products that have to be >= 0 may be below by this share of the sum of their parts: discretisation
/// and residuals of both solves.
pub const MONOTONE: f64 = 1e-8;
/// Beams on a monotone foundation move at most as the free beam under the load's difference: rounding beside.
pub const CONTINUITY: f64 = 1e-6;
/// Concentrated loads anywhere: a load near a clamp leaves a short element, whose rounding is relative to a
/// small deflection.
pub const POINT: f64 = 1e-10;
/// Residual that a free beam reaches in double precision whatever the stop.
pub const FLOOR: f64 = 1e-12;
/// Fifty breaks within 5e-13 of the length against a single one: the load between them is 3 off at most.
pub const CROWD: f64 = 1e-11;
/// Element visits of scenes made hard: so many per element and so many beside.
pub const HARD_VISITS: (usize, usize) = (400, 100_000);
/// A residual that counts as the floor, over the floor that is estimated.
pub const FLOORS: f64 = 8.0;
/// k L^4 / C below which rounding never keeps a residual above 1e-10 on any mesh of the tests.
pub const RESOLVABLE: f64 = 1e8;
/// Bending at 1e18 and in the rigid limit on a hundred elements: (C / k)^(1/4) of its change at 1e18, and the mesh's.
pub const RIGID_LIMIT: f64 = 1e-4;
/// Residual that rounding may leave of a foundation that is all but rigid, on coarse meshes.
pub const RIGID_FLOOR: f64 = 1e-4;

/// Tangents against differences of order four with a step of 1e-3: their own error, relative to the largest
/// derivative of the same kind of output ...
pub const DERIVATIVE: f64 = 1e-6;
/// ... and the rounding and residual of the solves, relative to the outputs, over the step.
pub const DIFFERENCE: f64 = 1e-12;
/// The same where the law has a root at the contact's edge (Hertz): quadrature next to an edge that moves.
pub const DERIVATIVE_HERTZ: f64 = 1e-5;
/// The same on random scenes, where a contact edge may pass a node within the step; next to a touch the error of
/// order two is allowed beside it.
pub const DERIVATIVE_RANDOM: f64 = 2e-6;
/// Tangents and adjoints are the same sums in another order: rounding ...
pub const TRANSPOSED: f64 = 1e-9;
/// ... and of the outputs themselves, where a derivative is small beside them.
pub const TRANSPOSED_FLOOR: f64 = 1e-12;
/// Influence lines at nodes are symmetric to rounding.
pub const RECIPROCAL: f64 = 1e-11;
/// Euler's identities: residuals of the solve.
pub const EULER: f64 = 1e-8;
/// Derivatives in single precision.
pub const DERIVATIVE_SINGLE: f64 = 2e-3;

/// Guaranteed bounds over the errors that they bound, on the suite: the second term of the bound, the error of the mesh
/// four times as fine, is a sixteenth of the first where the mesh resolves the solution; 1.09 is measured.
pub const EFFECTIVITY: f64 = 1.2;
/// Estimates of errors are the errors up to this factor: 1.05 is the rule, more where a contact's layers are not
/// resolved.
pub const ESTIMATE: f64 = 1.5;
/// Errors below this are rounding, of which neither of two solutions knows the other's.
pub const ESTIMATE_FLOOR: f64 = 1e-13;
/// Element visits of a solve to an accuracy, those on all meshes together, per element of the last and beside.
pub const ADAPTIVE_VISITS: (usize, usize) = (6, 2000);
/// What the references of bounds may lack of the error, of their own.
pub const REFERENCE: f64 = 1e-6;

/// What plain sums over a solution's fields may be off by, relative to the sizes of their terms: a check of another
/// kind than the residual, whose kinks and differences of nodal values are those of a naive program ...
pub const HONEST: f64 = 1e-4;
/// ... or so many residuals of the solve, or estimates of its rounding.
pub const HONEST_RESIDUALS: f64 = 1e3;

/// The order of methods that integrate the contact across its edge, by a line through the errors on six meshes: two,
/// up and down with where the edge lies in its element.
pub const ORDER_ACROSS_KINKS: std::ops::Range<f64> = 1.5..2.8;
/// Bending of two methods with the same equations, each with a residual up to 1e-10.
pub const METHODS: f64 = 1e-8;
/// The same on random scenes, whose moments may bend the beam but little.
pub const METHODS_RANDOM: f64 = 1e-6;
/// Bending of methods that integrate the contact across its edge, on 200 elements.
pub const ACROSS_KINKS: f64 = 1e-4;
/// Iterations of Bermúdez and Moreno's algorithm over those of its rate: what the start is off by is beside it.
pub const DUAL_ITERATIONS: std::ops::Range<f64> = 0.5..1.5;

/// One function written down in two ways: coefficients differ by rounding, the meshes that begin the solve may differ.
pub const SAME_FUNCTION: f64 = 1e-9;
