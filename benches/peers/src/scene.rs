//! The paper's example: in full contact, or with a gap that leaves parts of the beam free.

use piezobeam::{Beam, Conduction, Curve, Foundation, Linear, Load, Model, Potential};
use std::f64::consts::PI;

pub const BENDING: f64 = 5e3;
pub const AXIAL: f64 = 1e5;
pub const PIEZO: f64 = 100.0;
pub const PERMITTIVITY: f64 = 1.0;
pub const MU1: f64 = 1.0;
pub const MU2: f64 = 1.0;
pub const TRUNCATION: f64 = 1.0;
pub const TRANSVERSE: f64 = 1e6;
pub const ALONG: f64 = 1e6;
/// At both ends.
pub const POTENTIAL: f64 = 1.0;

/// What differs between the scenes.
#[derive(Clone, Copy)]
pub struct Scene {
    pub stiffness: f64,
    pub partial: bool,
}

impl Scene {
    /// The gap, its slope and its curvature.
    pub fn gap(&self, x: f64) -> [f64; 3] {
        if self.partial { wave(x) } else { [0.0; 3] }
    }

    /// For piezobeam, in partial contact.
    pub fn partial(&self) -> impl Model<f64> + Copy {
        common().foundation(Foundation { law: Linear(self.stiffness), gap: Curve(wave) })
    }

    /// For piezobeam, in full contact.
    pub fn full(&self) -> impl Model<f64> + Copy {
        common().foundation(Foundation { law: Linear(self.stiffness), gap: () })
    }
}

type Common = piezobeam::Scene<
    f64,
    Beam<f64, f64, f64, f64>,
    (),
    Conduction<f64, f64, f64>,
    Load<f64, f64>,
    Potential<f64>,
>;

fn common() -> Common {
    let beam = Beam { bending: BENDING, axial: AXIAL, piezo: PIEZO, permittivity: PERMITTIVITY };
    piezobeam::Scene::new(1.0, beam)
        .conduction(Conduction::new(MU1, MU2, TRUNCATION))
        .load(Load { transverse: TRANSVERSE, axial: ALONG, points: () })
        .potential(Potential { left: POTENTIAL, right: POTENTIAL })
}

/// 0.4 sin^2(pi x), its slope and its curvature.
fn wave(x: f64) -> [f64; 3] {
    let angle = 2.0 * PI * x;
    [0.2 * (1.0 - angle.cos()), 0.4 * PI * angle.sin(), 0.8 * PI * PI * angle.cos()]
}
