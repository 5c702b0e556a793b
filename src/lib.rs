//! Static equilibrium of an electro-elastic (piezoelectric) beam, clamped at both ends, in normal-compliance
//! contact with a deformable, electrically conductive foundation: the model and method of Rodríguez-Arós,
//! Cao-Rial and Sofonea, "A piezoelectric elastic beam model with normal compliance contact".
//!
//! # The problem
//!
//! Unknowns are the bending xi(x) \[m\], positive towards the foundation, the stretching u(x) \[m\] and the
//! potential q(x) \[V\] on \[0, L\]; s(x) is the initial gap and eta = xi - s the penetration where positive.
//!
//! ```text
//!     (C xi'')''            = f - p(x, eta) - mu1 R(q) R~(eta)      xi = xi' = 0 at both ends     (1)
//!     -(P u')' - (eps q')'  = mu2 R~(eta)^2                         q given at both ends          (2)
//!     -(EA u')' + (P q')'   = f_bar                                 u = 0 at both ends            (3)
//!     R(z) = max(-M, min(M, z)),   R~(z) = max(R(z), 0)
//! ```
//!
//! A beam, pipe or rail on a one-way foundation is the same problem without the electric parts, and the
//! solver for it is compiled without them.
//!
//! # The method
//!
//! 1. Cubic Hermite elements for bending, in *relative* unknowns: how far an element's left end departs from
//!    the rigid motion of its right end. No digits are lost to short elements.
//! 2. Contact is integrated exactly at its edges: elements are split where the penetration, or a
//!    truncation, has its kink. The order is four with any contact.
//! 3. Newton's method on a block Thomas recursion that sweeps from both ends; only elements between the
//!    outermost changed ones are swept again, and within a step the contact's edges are iterated by themselves.
//! 4. Nested meshes, with a continuation in the stiffness on the coarsest, so that a nearly rigid foundation
//!    costs no iterations on the finest.
//! 5. u and q by sums of fluxes, exact at nodes. A last sweep for an increment takes out the rounding.
//! 6. Where bending and potential hold each other, a monolithic Newton method on 4x4 blocks, globalised by the
//!    work of the residual.
//!
//! A solve is [`Status::Converged`] only if the moment that the deformation gives and the one that statics
//! gives agree, on all elements.
//!
//! # Errors
//!
//! [`Solution::certify`] bounds the error against the continuous problem in the energy norm, guaranteed, and estimates
//! those of the fields. [`Problem::solve_to`] makes a mesh for an accuracy that is asked for, [`Adaptive`] for scenes
//! one after the other.
//!
//! # Derivatives
//!
//! One more sweep at a converged solution gives a [`Tangent`]: the derivatives of all fields to one
//! [`Parameter`]; or an [`Adjoint`]: those of one [`Output`] to all parameters, and its influence line.
//!
//! # An example
//!
//! A beam that a load presses onto a foundation on its left half and lifts on its right half; no allocator:
//!
//! ```
//! use piezobeam::{Beam, Foundation, Linear, Load, Mesh, Problem, Scene, Settings, Status, Steps};
//!
//! let scene = Scene::new(1.0_f64, Beam::elastic(5000.0))
//!     .foundation(Foundation { law: Linear(1e8), gap: () })
//!     .load(Load {
//!         transverse: Steps { breaks: &[0.5], values: &[1e6, -1e6] },
//!         axial: (),
//!         points: (),
//!     });
//! let problem = Problem::new(scene, Mesh::uniform(96))?;
//! let mut memory = problem.workspace::<128>(); // 96 elements, and the coarser meshes
//! let solution = problem.solve(&mut memory, &Settings::default())?;
//!
//! assert_eq!(solution.report().status, Status::Converged);
//! assert!((solution.at(0.5).bending + 0.06371378).abs() < 1e-7);
//! solution.for_each_zone(|a, b| assert!(a == 0.0 && (b - 0.318538).abs() < 1e-6));
//! # Ok::<(), piezobeam::Error>(())
//! ```
//!
//! # Control and design
//!
//! [`History`] solves scenes one after the other, each from the last solution, and visits only what changed.
//! [`Batch`] (feature `alloc`) solves many scenes of one kind on one mesh at once.
//! [`Prepared::tangent`] and [`Prepared::adjoint`] differentiate a solution.
//!
//! # The paper's own methods
//!
//! [`Prepared::solve_by`] solves by a [`Method`] of the paper, to compare with: what it ends at is held to the same
//! residual.
//!
//! # Memory
//!
//! Nothing is allocated in a solve. [`Workspace`] holds a fixed number of elements where you put it;
//! [`HeapWorkspace`] (feature `alloc`) grows when a scene is laid into it. Bytes per element depend on what the
//! scene has: [`Workspace::BYTES_PER_ELEMENT`].
//!
//! # Features
//!
//! | feature | what it adds |
//! |---|---|
//! | `std` (default) | elementary functions from the standard library; includes `alloc` |
//! | `libm` | elementary functions without it: `--no-default-features --features libm` |
//! | `alloc` | [`HeapWorkspace`], [`Batch`], [`Solution::zones`] |
//! | `cli` | the command line |
//! | `parquet` | the command line's tables as Parquet files |
//!
//! # Guarantees and limits
//!
//! `no_std`, no unsafe code, no allocation in a solve, no panic in one that is optimised (the linked image is
//! searched for it at all levels but 0), bounded work ([`Settings::max_visits`]), and the same bits for the same input:
//! with the feature `libm` on all targets and optimisation levels tried, with `std` but for laws r^a where 2a is not an
//! integer and for graded meshes, which call `pow`, `ln` and `expm1` of the system (`docs/embedded.md`). Bad input is an
//! [`Error`] that names field, place, expected and found; not converging is a [`Status`] with the best iterate.
//!
//! Conduction in both directions (mu1 and mu2) is iterated as a fixed point together with Newton's steps for
//! bending as long as that is quick, else by a monolithic Newton method in (w, theta, u, q) that also finds
//! solutions far beyond the uniqueness condition.
#![no_std]
#![cfg_attr(
    test,
    allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test that panics has failed")
)]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(any(feature = "std", test))]
extern crate std;

#[cfg(not(any(feature = "std", feature = "libm")))]
compile_error!("piezobeam needs elementary functions: enable the feature `std` or `libm`");

mod accuracy;
#[cfg(feature = "alloc")]
mod batch;
mod certificate;
mod cubic;
mod electric;
mod element;
mod error;
mod history;
mod law;
mod mesh;
mod methods;
mod newton;
mod problem;
mod profile;
mod quadrature;
mod real;
mod scene;
mod sensitivity;
mod solution;
mod storage;
mod sweep;

pub use accuracy::{Adapted, Adaptive, Certificate, Reached};
#[cfg(feature = "alloc")]
pub use batch::{Batch, Group};
pub use certificate::{Uniqueness, Warning};
pub use cubic::Cubic;
pub use error::{Error, Place};
pub use history::History;
pub use law::{Compliance, Law, Linear, Power, Tabulated, truncate, truncate_positive};
pub use mesh::Mesh;
pub use methods::{BermudezMoreno, Compared, Method};
pub use newton::{Report, Settings, Status};
pub use problem::{Prepared, Problem};
pub use profile::{
    Curve, Flat, Function, Kept, Piece, Pieces, Polynomial, Profile, Room, Slot, Smooth, Steps, Table,
};
pub use real::{Field, Pair, Quad, Real, Square};
pub use scene::{
    Beam, BeamPart, Conduction, ConductionPart, Foundation, FoundationPart, Load, LoadPart, Model, PointLoad,
    Points, Potential, PotentialPart, Scene,
};
pub use sensitivity::{Adjoint, Grazing, Output, Parameter, SensitivityError, Tangent};
pub use solution::{Fields, Resultants, Solution};
#[cfg(feature = "alloc")]
pub use storage::HeapWorkspace;
pub use storage::{Place as StoragePlace, Storage, Workspace};
