//! The tables of a scene file.

use toml::de::DeValue;

use super::error::FileError;
use super::profile::ProfileSpec;
use super::profile_form;
use super::table::{Field, Table};

pub(super) const BEAM_KEYS: &[&str] = &["bending", "axial", "piezo", "permittivity"];
pub(super) const FOUNDATION_KEYS: &[&str] = &["stiffness", "exponent", "gap"];
pub(super) const CONDUCTION_KEYS: &[&str] = &["mu1", "mu2", "truncation", "potential_truncation"];
pub(super) const LOAD_KEYS: &[&str] = &["transverse", "axial", "points"];
pub(super) const POINT_KEYS: &[&str] = &["x", "force", "moment"];
pub(super) const POTENTIAL_KEYS: &[&str] = &["left", "right"];
pub(super) const MESH_KEYS: &[&str] = &["elements", "nodes"];

/// The most elements of a mesh.
const MOST_ELEMENTS: usize = 10_000_000;

/// The material of the beam.
#[derive(Clone, Debug)]
pub struct BeamTable {
    /// Bending stiffness, N m^2.
    pub bending: ProfileSpec,
    /// Axial stiffness, N.
    pub axial: Option<ProfileSpec>,
    /// Piezoelectric coupling, N m/V.
    pub piezo: Option<ProfileSpec>,
    /// Electric permittivity, N m^2/V^2.
    pub permittivity: Option<ProfileSpec>,
}

/// The foundation below the beam.
#[derive(Clone, Debug)]
pub struct FoundationTable {
    /// Stiffness, N/m^(1+exponent).
    pub stiffness: ProfileSpec,
    /// Power of the penetration which the reaction grows with.
    pub exponent: f64,
    /// Distance from the beam at rest, m.
    pub gap: Option<ProfileSpec>,
}

/// The electric contact with the foundation.
#[derive(Clone, Debug)]
pub struct ConductionTable {
    /// First coefficient, N/(V m^2).
    pub mu1: Option<ProfileSpec>,
    /// Second coefficient, N/(V m^2).
    pub mu2: Option<ProfileSpec>,
    /// Bound on what enters the conditions, m.
    pub truncation: f64,
    /// Bound on the potential which enters, V; the other bound when absent.
    pub potential_truncation: Option<f64>,
}

/// The loads on the beam.
#[derive(Clone, Debug, Default)]
pub struct LoadTable {
    /// Load across the beam, N/m.
    pub transverse: Option<ProfileSpec>,
    /// Load along the beam, N/m.
    pub axial: Option<ProfileSpec>,
    /// Loads at points.
    pub points: Vec<PointSpec>,
}

/// A force and a moment at a point.
#[derive(Clone, Debug)]
pub struct PointSpec {
    /// Position, m.
    pub x: f64,
    /// Force, N.
    pub force: f64,
    /// Moment, N m.
    pub moment: f64,
}

/// The electric potential at the ends.
#[derive(Clone, Debug)]
pub struct PotentialTable {
    /// Potential at the left end, V.
    pub left: f64,
    /// Potential at the right end, V.
    pub right: f64,
}

/// The mesh; at most one of the two is given.
#[derive(Clone, Debug, Default)]
pub struct MeshTable {
    /// Number of elements.
    pub elements: Option<usize>,
    /// Positions of the nodes, m.
    pub nodes: Option<Vec<f64>>,
}

/// The profile of this key, when it is there.
fn profile(table: &Table<'_>, key: &str, length: f64) -> Result<Option<ProfileSpec>, FileError> {
    let field = table.field(key);
    field.map(|field| profile_form::read(&field, length)).transpose()
}

/// The number of this key, which has to be there.
fn required_number(table: &Table<'_>, key: &str, hint: &str) -> Result<f64, FileError> {
    table.required(key, hint)?.number()
}

pub(super) fn beam(table: &Table<'_>, length: f64) -> Result<BeamTable, FileError> {
    table.allow(BEAM_KEYS)?;
    let bending = table.required("bending", "add bending = <number>, in N m^2")?;
    Ok(BeamTable {
        bending: profile_form::read(&bending, length)?,
        axial: profile(table, "axial", length)?,
        piezo: profile(table, "piezo", length)?,
        permittivity: profile(table, "permittivity", length)?,
    })
}

pub(super) fn foundation(table: &Table<'_>, length: f64) -> Result<FoundationTable, FileError> {
    table.allow(FOUNDATION_KEYS)?;
    let stiffness = table.required("stiffness", "add stiffness = <number>, in N/m^2")?;
    let gap = table.field("gap");
    Ok(FoundationTable {
        stiffness: profile_form::read(&stiffness, length)?,
        exponent: table.number("exponent")?.unwrap_or(1.0),
        gap: gap.map(|gap| profile_form::read_smooth(&gap, length)).transpose()?,
    })
}

pub(super) fn conduction(table: &Table<'_>, length: f64) -> Result<ConductionTable, FileError> {
    table.allow(CONDUCTION_KEYS)?;
    Ok(ConductionTable {
        mu1: profile(table, "mu1", length)?,
        mu2: profile(table, "mu2", length)?,
        truncation: required_number(table, "truncation", "add truncation = <number>, in m")?,
        potential_truncation: table.number("potential_truncation")?,
    })
}

pub(super) fn load(table: &Table<'_>, length: f64) -> Result<LoadTable, FileError> {
    table.allow(LOAD_KEYS)?;
    Ok(LoadTable {
        transverse: profile(table, "transverse", length)?,
        axial: profile(table, "axial", length)?,
        points: match table.field("points") {
            Some(field) => points(&field, length)?,
            None => Vec::new(),
        },
    })
}

fn points(field: &Field<'_>, length: f64) -> Result<Vec<PointSpec>, FileError> {
    let DeValue::Array(array) = field.value() else {
        return Err(field
            .expected("tables [[load.points]]")
            .hint("write [[load.points]] in double brackets before each point"));
    };
    field.elements(array).map(|point| self::point(&point, length)).collect()
}

fn point(field: &Field<'_>, length: f64) -> Result<PointSpec, FileError> {
    let DeValue::Table(_) = field.value() else {
        return Err(field.expected("a table").hint("write a point as { x = 0.3, force = 1e3 }"));
    };
    let table = field.table()?;
    table.allow(POINT_KEYS)?;
    let place = table.required("x", "add x = <position>, in m")?;
    let x = place.number()?;
    if x <= 0.0 || x >= length {
        return Err(place
            .error(format!("{x} is not inside the beam"))
            .hint(format!("concentrated loads stand strictly between 0 and {length}")));
    }
    Ok(PointSpec {
        x,
        force: table.number("force")?.unwrap_or(0.0),
        moment: table.number("moment")?.unwrap_or(0.0),
    })
}

pub(super) fn potential(table: &Table<'_>) -> Result<PotentialTable, FileError> {
    table.allow(POTENTIAL_KEYS)?;
    Ok(PotentialTable {
        left: required_number(table, "left", "add left = <number>, in V")?,
        right: required_number(table, "right", "add right = <number>, in V")?,
    })
}

pub(super) fn mesh(table: &Table<'_>) -> Result<MeshTable, FileError> {
    table.allow(MESH_KEYS)?;
    let elements = table.field("elements");
    let nodes = table.field("nodes");
    if let (Some(_), Some(nodes)) = (&elements, &nodes) {
        return Err(nodes.error("given together with mesh.elements").hint("keep one of the two"));
    }
    let nodes = nodes.map(|field| {
        let nodes = field.numbers()?;
        if nodes.len() < 2 {
            return Err(field.error("expected at least two nodes, found one"));
        }
        profile_form::rising(&field, &nodes)?;
        Ok(nodes)
    });
    Ok(MeshTable {
        elements: elements.map(|field| field.count(MOST_ELEMENTS)).transpose()?,
        nodes: nodes.transpose()?,
    })
}
