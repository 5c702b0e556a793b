//! The scenes of the report, typed as a program of one's own would write them: compiled for what they hold.

use piezobeam::{Beam, Conduction, Foundation, Linear, Load, Potential, Profile, Real, Scene, Smooth, Steps};

/// A scene's numbers, in SI units; its length is 1 m.
#[derive(Clone, Copy, Debug)]
pub struct Numbers {
    /// Of files; that of the reference suite, where it is in it.
    pub name: &'static str,
    pub title: &'static str,
    /// For people.
    pub what: &'static str,
    pub bending: f64,
    pub axial: f64,
    pub piezo: f64,
    pub permittivity: f64,
    pub stiffness: f64,
    /// mu1 and mu2; the truncation is 1.
    pub conduction: [f64; 2],
    pub breaks: &'static [f64],
    pub transverse: &'static [f64],
    pub axial_load: f64,
    /// Potentials at both ends.
    pub ends: [f64; 2],
}

/// The paper's example. It does not print the truncation, the gap, the potentials at the ends and, for Figs. 1-4, the
/// stiffness of the foundation.
pub const PAPER: Numbers = Numbers {
    name: "paper",
    title: "Full contact",
    what: "the paper's example: a load of 1e6 N/m presses all of the beam onto a foundation of 1e8 N/m^2",
    bending: 5e3,
    axial: 1e5,
    piezo: 100.0,
    permittivity: 1.0,
    stiffness: 1e8,
    conduction: [1.0, 1.0],
    breaks: &[],
    transverse: &[1e6],
    axial_load: 1e6,
    ends: [1.0, 1.0],
};

pub const PARTIAL: Numbers = Numbers {
    name: "partial",
    title: "Partial contact",
    what: "the same, with the load turned round on the right half: the beam lifts off",
    breaks: &[0.5],
    transverse: &[1e6, -1e6],
    ..PAPER
};

pub const RIGID: Numbers = Numbers {
    name: "rigid",
    title: "Rigid foundation",
    what: "partial contact with a foundation of 1e16 N/m^2",
    stiffness: 1e16,
    ..PARTIAL
};

pub const COUPLED: Numbers = Numbers {
    name: "coupled-partial",
    title: "Strongly coupled",
    what: "C = EA = 1, soft foundation (50 N/m^2), conduction that bends the beam and current that the beam makes",
    bending: 1.0,
    axial: 1.0,
    piezo: 0.5,
    permittivity: 1.0,
    stiffness: 50.0,
    conduction: [10.0, 4.0],
    breaks: &[0.6],
    transverse: &[300.0, -400.0],
    axial_load: 1.0,
    ends: [0.2, 0.9],
};

pub const ALL: [Numbers; 4] = [PAPER, PARTIAL, RIGID, COUPLED];

/// `f32` or `f64` with the constants of its scenes.
pub trait Number: Real + Profile<Self> + Smooth<Self> {}
impl<T: Real + Profile<T> + Smooth<T>> Number for T {}

pub type Whole<'a, T> = Scene<
    T,
    Beam<T, T, T, T>,
    Foundation<Linear<T>>,
    Conduction<T, T, T>,
    Load<Steps<'a, T>, T>,
    Potential<T>,
>;

/// A scene's numbers in a precision.
pub struct Given<T> {
    numbers: Numbers,
    breaks: Vec<T>,
    transverse: Vec<T>,
}

impl Numbers {
    pub fn in_precision<T: Number>(&self) -> Given<T> {
        let list = |values: &[f64]| values.iter().map(|&v| T::of(v)).collect();
        Given { numbers: *self, breaks: list(self.breaks), transverse: list(self.transverse) }
    }

    pub fn on(self, stiffness: f64) -> Self {
        Self { stiffness, ..self }
    }
}

impl<T: Number> Given<T> {
    pub fn scene(&self) -> Whole<'_, T> {
        let Numbers { bending, axial, piezo, permittivity, stiffness, conduction, axial_load, ends, .. } =
            self.numbers;
        let beam = Beam {
            bending: T::of(bending),
            axial: T::of(axial),
            piezo: T::of(piezo),
            permittivity: T::of(permittivity),
        };
        let transverse = Steps { breaks: &self.breaks, values: &self.transverse };
        Scene::new(T::of(1.0), beam)
            .foundation(Foundation { law: Linear(T::of(stiffness)), gap: () })
            .conduction(Conduction::new(T::of(conduction[0]), T::of(conduction[1]), T::of(1.0)))
            .load(Load { transverse, axial: T::of(axial_load), points: () })
            .potential(Potential { left: T::of(ends[0]), right: T::of(ends[1]) })
    }
}
