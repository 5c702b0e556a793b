//! The reference suite: fields, resultants, contact zones and work on scenes whose solutions are known.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on fails")]

mod common;

use common::{Case, fields, relative, solved, suite, tolerances as tol};
use piezobeam::{Fields, Mesh, Resultants, Status};

/// What is wrong with a solved case, in words; several at once, so that one run shows them all.
#[derive(Default)]
struct Complaints(Vec<String>);

impl Complaints {
    fn at_most(&mut self, case: &Case, what: &str, error: f64, bound: f64) {
        if error.is_nan() || error > bound {
            self.0.push(format!("{}: {what} off by {error:.2e}, allowed {bound:.0e}", case.name));
        }
    }

    fn settle(self) {
        assert!(self.0.is_empty(), "\n{}", self.0.join("\n"));
    }
}

fn number(case: &Case, name: &str) -> f64 {
    case.whole[name].as_f64().expect("a number")
}

type Column = (&'static str, fn(&Fields<f64>) -> f64);

const COLUMNS: [Column; 6] = [
    ("xi", |f| f.bending),
    ("theta", |f| f.slope),
    ("moment", |f| f.moment),
    ("shear", |f| f.shear),
    ("u", |f| f.stretching.unwrap_or(f64::NAN)),
    ("q", |f| f.potential.unwrap_or(f64::NAN)),
];

fn bound(case: &Case, column: &str) -> f64 {
    let rigid = case.stiffness >= tol::RIGID;
    match column {
        "theta" => tol::SLOPE,
        "moment" | "shear" if rigid => tol::STATIC_RIGID,
        "moment" | "shear" => tol::STATIC,
        _ if rigid => tol::FIELD_RIGID,
        _ => tol::FIELD,
    }
}

#[test]
fn fields_are_those_of_the_reference() {
    let mut complaints = Complaints::default();
    for case in suite() {
        let (report, at) = fields(&case.scene, Mesh::uniform(1000), &case.column("x"));
        assert_eq!(report.status, Status::Converged, "{}: {report:?}", case.name);
        for (name, get) in COLUMNS {
            let got: Vec<f64> = at.iter().map(get).collect();
            complaints.at_most(&case, name, relative(&got, &case.column(name)), bound(&case, name));
        }
        let sigma: Vec<f64> = at.iter().filter_map(|f| f.axial_force).collect();
        complaints.at_most(&case, "sigma", relative(&sigma, &case.column("sigma")), tol::FIELD);
    }
    complaints.settle();
}

#[test]
fn the_electric_displacement_is_the_references_beyond_its_rounding() {
    let mut complaints = Complaints::default();
    for case in suite().into_iter().filter(|case| case.stiffness < tol::RIGID) {
        let (_, at) = fields(&case.scene, Mesh::uniform(1000), &case.column("x"));
        let want = case.column("D");
        let q = case.column("q");
        let steepest = q.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
        let field = steepest * 32.0 / case.scene.length;
        let permittivity = case.whole["scene"]["permittivity"].as_f64().unwrap_or(1.0);
        let size = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let bound = tol::DISPLACEMENT * size + tol::DISPLACEMENT_ROUNDING * permittivity * field;
        let got = at.iter().map(|f| f.electric_displacement.unwrap_or(f64::NAN));
        let error = got.zip(&want).fold(0.0, |m: f64, (g, w)| m.max((g - w).abs()));
        complaints.at_most(&case, "D", error, bound);
    }
    complaints.settle();
}

#[test]
fn contact_force_and_bending_energy_are_those_of_the_reference() {
    let mut complaints = Complaints::default();
    for case in suite() {
        let Resultants { contact_force, bending_energy, equilibrium_error, .. } =
            solved(&case.scene, Mesh::uniform(1000), |s| s.resultants());
        let rigid = case.stiffness >= tol::RIGID;
        let bound = if rigid { tol::RESULTANT_RIGID } else { tol::RESULTANT };
        let (force, energy) = (number(&case, "contact_force"), number(&case, "bending_energy"));
        complaints.at_most(&case, "contact force", (contact_force - force).abs(), bound * force);
        complaints.at_most(&case, "bending energy", (bending_energy - energy).abs(), bound * energy);
        complaints.at_most(&case, "equilibrium", equilibrium_error, tol::EQUILIBRIUM);
    }
    complaints.settle();
}

/// Ends of contact zones, those at the beam's ends left out: within `margin` lengths of them.
fn edges(case: &Case, margin: f64) -> Vec<f64> {
    let length = case.scene.length;
    let zones = solved(&case.scene, Mesh::uniform(1000), |s| s.zones());
    zones.into_iter().flatten().filter(|x| *x > margin * length && *x < length - margin * length).collect()
}

fn crossings(case: &Case) -> Vec<f64> {
    let list = case.whole["crossings"]["eta=0"].as_array();
    list.map_or(vec![], |list| list.iter().filter_map(serde_json::Value::as_f64).collect())
}

#[test]
fn contact_zones_end_where_the_reference_leaves_the_gap() {
    let mut complaints = Complaints::default();
    for case in suite() {
        let (ends, want) = (edges(&case, tol::CLAMP), crossings(&case));
        if ends.len() != want.len() {
            complaints.0.push(format!("{}: zones end at {ends:?}, expected {want:?}", case.name));
            continue;
        }
        let bound = if case.stiffness >= tol::RIGID { tol::EDGE_RIGID } else { tol::EDGE };
        for (end, want) in ends.iter().zip(&want) {
            complaints.at_most(&case, "a contact edge", (end - want).abs() / case.scene.length, bound);
        }
    }
    complaints.settle();
}

#[test]
fn contact_zones_have_no_ends_within_rounding_of_a_clamp() {
    for case in suite() {
        assert_eq!(edges(&case, 0.0).len(), crossings(&case).len(), "{}", case.name);
    }
}

#[test]
fn work_grows_like_the_mesh_whatever_the_stiffness() {
    let (per_element, beside) = tol::VISITS;
    let mut complaints = Vec::new();
    for case in suite().iter().filter(|case| case.name.starts_with("sweep-")) {
        for n in [100, 1000, 10_000, 100_000] {
            let report = solved(&case.scene, Mesh::uniform(n), |s| *s.report());
            assert_eq!(report.status, Status::Converged, "{} N = {n}: {report:?}", case.name);
            if report.element_visits > per_element * n + beside {
                complaints.push(format!("{} N = {n}: {} visits", case.name, report.element_visits));
            }
        }
    }
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}
