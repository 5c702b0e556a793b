//! The scenes that cases are made of.

use crate::scene_file::{ConductionTable, FoundationTable, PotentialTable, ProfileSpec, SceneFile};

/// Bending stiffness and load of the paper's example.
pub(super) const C: f64 = 5000.0;
pub(super) const F: f64 = 1e6;

pub(super) fn steps(breaks: &[f64], values: &[f64]) -> ProfileSpec {
    ProfileSpec::Steps { breaks: breaks.to_vec(), values: values.to_vec() }
}

pub(super) fn polynomial(c: &[f64]) -> ProfileSpec {
    ProfileSpec::Polynomial(c.to_vec())
}

/// +f on the left half, -f on the right.
pub(super) fn turned(f: f64) -> ProfileSpec {
    steps(&[0.5], &[f, -f])
}

impl SceneFile {
    /// The scene with something else about it.
    pub(super) fn but(mut self, change: impl FnOnce(&mut Self)) -> Self {
        change(&mut self);
        self
    }

    pub(super) fn on(self, stiffness: impl Into<ProfileSpec>) -> Self {
        let foundation = FoundationTable { stiffness: stiffness.into(), exponent: 1.0, gap: None };
        self.but(|s| s.foundation = Some(foundation))
    }

    pub(super) fn gap(self, gap: impl Into<ProfileSpec>) -> Self {
        self.but(|s| {
            if let Some(foundation) = &mut s.foundation {
                foundation.gap = Some(gap.into());
            }
        })
    }

    pub(super) fn exponent(self, exponent: f64) -> Self {
        self.but(|s| {
            if let Some(foundation) = &mut s.foundation {
                foundation.exponent = exponent;
            }
        })
    }

    pub(super) fn under(self, transverse: impl Into<ProfileSpec>) -> Self {
        self.but(|s| s.load.transverse = Some(transverse.into()))
    }

    pub(super) fn conducting(self, mu1: f64, mu2: f64, truncation: f64) -> Self {
        let (mu1, mu2) = (Some(mu1.into()), Some(mu2.into()));
        self.but(|s| {
            s.conduction = Some(ConductionTable { mu1, mu2, truncation, potential_truncation: None });
        })
    }

    pub(super) fn between(self, left: f64, right: f64) -> Self {
        self.but(|s| s.potential = Some(PotentialTable { left, right }))
    }

    pub(super) fn nodes(self, nodes: Vec<f64>) -> Self {
        self.but(|s| s.mesh.nodes = Some(nodes))
    }
}

/// A beam of length 1 that only bends.
pub(super) fn elastic(bending: impl Into<ProfileSpec>) -> SceneFile {
    SceneFile::beam(1.0, bending.into())
}

/// The paper's beam with all its parts, and no foundation yet.
pub(super) fn electric() -> SceneFile {
    let scene = elastic(C).but(|s| {
        s.beam.axial = Some(1e5.into());
        s.beam.piezo = Some(100.0.into());
        s.beam.permittivity = Some(1.0.into());
        s.load.axial = Some(1e6.into());
    });
    scene.between(1.0, 1.0)
}

/// The paper's beam, pressed down on its left half and lifted on its right half.
pub(super) fn halves(k: f64) -> SceneFile {
    electric().on(k).conducting(1.0, 1.0, 1.0).under(turned(F))
}

/// The same beam, which only bends.
pub(super) fn elastic_halves(k: f64) -> SceneFile {
    elastic(C).on(k).under(turned(F))
}
