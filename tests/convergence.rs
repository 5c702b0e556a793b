//! Observed orders of convergence at nodes: contact edges cost none.
#![allow(clippy::expect_used, reason = "a test that cannot go on fails")]

mod common;

use common::{Case, fields, named, tolerances as tol};
use piezobeam::{Fields, Mesh, Status};

const COUNTS: [usize; 4] = [32, 64, 128, 256];

/// Largest error of a column over its maximum, on each of the meshes.
fn errors(
    case: &Case,
    column: &str,
    get: fn(&Fields<f64>) -> f64,
    mesh: fn(usize) -> Mesh<'static, f64>,
) -> Vec<f64> {
    let want = case.column(column);
    COUNTS
        .iter()
        .map(|&n| {
            let (report, at) = fields(&case.scene, mesh(n), &case.column("x"));
            assert_eq!(report.status, Status::Converged, "{} N = {n}: {report:?}", case.name);
            let got: Vec<f64> = at.iter().map(get).collect();
            common::relative(&got, &want)
        })
        .collect()
}

/// Mean order between the coarsest mesh and the finest whose error is above rounding.
fn order(errors: &[f64]) -> f64 {
    let last = errors.iter().rposition(|&e| e > tol::ROUNDING).expect("an error above rounding");
    assert!(last > 0, "{errors:?}");
    let doublings = u32::try_from(last).expect("few meshes");
    (errors[0] / errors[last]).log2() / f64::from(doublings)
}

fn converges(name: &str, column: &str, get: fn(&Fields<f64>) -> f64, least: f64) {
    let case = named(name);
    let errors = errors(&case, column, get, Mesh::uniform);
    let order = order(&errors);
    assert!(order >= least, "{name}, {column}: order {order:.2}, errors {errors:?}");
}

fn xi(f: &Fields<f64>) -> f64 {
    f.bending
}

fn q(f: &Fields<f64>) -> f64 {
    f.potential.expect("a potential")
}

#[test]
fn bending_converges_with_order_four_in_partial_contact() {
    converges("partial", "xi", xi, tol::ORDER);
}

#[test]
fn bending_converges_with_order_four_in_full_contact() {
    converges("paper", "xi", xi, tol::ORDER);
}

#[test]
fn bending_and_potential_converge_with_order_four_when_both_act_on_each_other() {
    converges("coupled-partial", "xi", xi, tol::ORDER);
    converges("coupled-partial", "q", q, tol::ORDER);
}

#[test]
fn a_law_with_a_steep_second_derivative_costs_one_order_at_most() {
    converges("hertz", "xi", xi, tol::ORDER_HERTZ);
}

#[test]
fn a_gap_that_does_not_vanish_at_the_clamps_costs_no_order() {
    converges("const-gap", "xi", xi, tol::ORDER);
}

#[test]
fn a_kink_of_the_gap_costs_no_order() {
    converges("kinked-gap", "xi", xi, tol::ORDER);
}

#[test]
fn coefficients_that_vary_and_jump_cost_no_order() {
    converges("graded", "xi", xi, tol::ORDER);
}

#[test]
fn stretching_and_potential_are_exact_at_nodes_where_only_they_vary() {
    let case = named("graded");
    for (column, get) in [("q", q as fn(&Fields<f64>) -> f64), ("u", |f| f.stretching.expect("u"))] {
        let errors = errors(&case, column, get, Mesh::uniform);
        assert!(errors[0] <= tol::FIELD, "{column}: {errors:?}");
    }
}

#[test]
fn a_graded_mesh_costs_no_order() {
    for name in ["partial", "coupled-partial"] {
        let case = named(name);
        let errors = errors(&case, "xi", xi, |elements| Mesh::Graded { elements, ratio: 5.0 });
        let order = order(&errors);
        assert!(order >= tol::ORDER, "{name}: order {order:.2}, errors {errors:?}");
    }
}

#[test]
fn moment_converges_with_order_four_too() {
    let case = named("partial");
    let errors = errors(&case, "moment", |f| f.moment, Mesh::uniform);
    let order = order(&errors);
    assert!(order >= tol::ORDER, "order {order:.2}, errors {errors:?}");
}
