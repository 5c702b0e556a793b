//! Scenes of any numbers through the library.

use crate::form::{Any, Form};
use crate::number::{self, Number, Position};
use crate::property::{self, Also};
use arbitrary::{Arbitrary, Unstructured};
use piezobeam::{
    Beam, Conduction, Foundation, Law, Linear, Load, Mesh, PointLoad, Potential, Power, Profile, Real, Scene,
    Settings, Smooth, Tabulated,
};
use std::fmt::Debug;

/// Which parts the scene has, and of which types.
#[derive(Arbitrary, Clone, Copy, Debug)]
enum Parts {
    /// Everything, of numbers.
    Full,
    /// Everything, profiles of any form, a linear law.
    Formed,
    /// As [`Parts::Formed`] with a power law.
    FormedPower,
    /// As [`Parts::Formed`] with a law by points.
    FormedTable,
    /// Bending alone.
    Bending,
    /// Bending on a foundation.
    Contact,
    /// Bending on a foundation at a distance.
    Gap,
    /// Bending on a foundation at a distance of any form, under a load of any form.
    FormedGap,
    /// Bending and stretching.
    Stretching,
    /// The potential alone beside bending.
    Potential,
    /// A law as a closure, whose slope need not be its derivative.
    Closure,
}

#[derive(Arbitrary, Clone, Copy, Debug)]
struct Point {
    x: Position,
    force: Number,
    moment: Number,
}

#[derive(Arbitrary, Clone, Debug)]
enum Division {
    Uniform,
    Graded(Number),
    Nodes(Vec<Position>),
}

/// All that a scene may need; a scene takes what its parts ask for.
#[derive(Arbitrary, Clone, Debug)]
struct Input {
    parts: Parts,
    single: bool,
    elements: u8,
    division: Division,
    length: Number,
    bending: Form,
    stiffness: Form,
    transverse: Form,
    gap: Form,
    exponent: Number,
    table: [Number; 4],
    slope: Number,
    truncation: Number,
    potential_truncation: Number,
    mu1: Form,
    mu2: Form,
    axial: Form,
    piezo: Form,
    permittivity: Form,
    axial_load: Form,
    left: Number,
    right: Number,
    points: Vec<Point>,
    stop: Option<Number>,
    max_visits: Option<u16>,
}

/// Visits that most scenes converge in on a few elements.
const VISITS: usize = 500;

/// Numbers of the paper's scene.
mod paper {
    pub const LENGTH: f64 = 1.0;
    pub const BENDING: f64 = 5e3;
    pub const STIFFNESS: f64 = 1e8;
    pub const LOAD: f64 = 1e6;
    pub const GAP: f64 = 1e-3;
    pub const AXIAL: f64 = 1e5;
    pub const PIEZO: f64 = 100.0;
    pub const UNIT: f64 = 1.0;
}

/// The property, of the scene that `data` spells: no panic, and what [`property`] says.
///
/// # Panics
/// Where the property fails.
pub fn scene(data: &[u8]) {
    let mut data = Unstructured::new(data);
    if let Ok(input) = Input::arbitrary(&mut data) {
        if input.single { solve::<f32>(&input) } else { solve::<f64>(&input) }
    }
}

fn solve<T: Real + Profile<T> + Smooth<T>>(input: &Input) {
    let length: T = input.length.of(paper::LENGTH);
    // Few elements are quick, and have edges and kinks as many do.
    let most = if input.elements < 240 { 8 } else { 64 };
    let elements = usize::from(input.elements) % most + 1;
    let nodes: Vec<T>;
    let mesh = match &input.division {
        Division::Uniform => Mesh::uniform(elements),
        Division::Graded(ratio) => Mesh::Graded { elements, ratio: ratio.of(10.0) },
        Division::Nodes(inner) => {
            let mut all = number::positions(&inner[..inner.len().min(most)], length);
            all.insert(0, T::zero());
            all.push(length);
            nodes = all;
            Mesh::Nodes(&nodes)
        }
    };
    let mut settings = Settings::default();
    if let Some(stop) = input.stop {
        settings.stop = stop.of(1e-6);
    }
    // Most inputs that cannot converge would take all the visits that there are by default.
    settings.max_visits = match input.max_visits.map_or(VISITS, usize::from) {
        visits if visits % 256 == 255 => None,
        visits => Some(visits % (4 * VISITS)),
    };
    let numbers =
        matches!(input.parts, Parts::Full | Parts::Bending | Parts::Contact | Parts::Gap | Parts::Closure);
    // Naive sums need numbers for coefficients.
    let also = Also { sums: numbers, bounds: input.elements.is_multiple_of(8) };
    let case = Case { input, length, mesh, settings, also };
    match input.parts {
        Parts::Full => case.full(),
        Parts::Formed => case.formed(Linear(case.form(&input.stiffness, paper::STIFFNESS))),
        Parts::FormedPower => {
            let stiffness = case.form(&input.stiffness, paper::STIFFNESS);
            case.formed(Power { stiffness, exponent: input.exponent.of(1.5) });
        }
        Parts::FormedTable => {
            let [r1, p1, r2, p2] = input.table;
            let penetration = [T::zero(), r1.of(1e-3), r2.of(2e-3)];
            let pressure = [T::zero(), p1.of(1e5), p2.of(1e6)];
            case.formed(Tabulated { penetration: &penetration, pressure: &pressure });
        }
        Parts::Bending => case.bending(),
        Parts::Contact => case.contact(),
        Parts::Gap => case.gap(),
        Parts::FormedGap => case.formed_gap(),
        Parts::Stretching => case.stretching(),
        Parts::Potential => case.potential(),
        Parts::Closure => case.closure(),
    }
}

struct Case<'a, T> {
    input: &'a Input,
    length: T,
    mesh: Mesh<'a, T>,
    settings: Settings<T>,
    also: Also,
}

impl<T: Real + Profile<T> + Smooth<T>> Case<'_, T> {
    fn form(&self, form: &Form, nominal: f64) -> Any<T> {
        Any::new(form, nominal, self.length)
    }

    fn check<M: piezobeam::Model<T> + Debug>(&self, scene: M) {
        property::check(scene, self.mesh, &self.settings, self.also);
    }

    fn transverse(&self) -> T {
        self.input.transverse.number().of(paper::LOAD)
    }

    fn points(&self) -> Vec<PointLoad<T>> {
        let points = &self.input.points[..self.input.points.len().min(4)];
        let x = number::positions(&points.iter().map(|p| p.x).collect::<Vec<_>>(), self.length);
        let load = |(p, x): (&Point, T)| PointLoad { x, force: p.force.of(1e5), moment: p.moment.of(1e4) };
        points.iter().zip(x).map(load).collect()
    }

    fn full(&self) {
        let i = self.input;
        self.check(
            Scene::new(
                self.length,
                Beam::<T, T, T, T> {
                    bending: i.bending.number().of(paper::BENDING),
                    axial: i.axial.number().of(paper::AXIAL),
                    piezo: i.piezo.number().of(paper::PIEZO),
                    permittivity: i.permittivity.number().of(paper::UNIT),
                },
            )
            .foundation(Foundation::<Linear<T>, T> {
                law: Linear(i.stiffness.number().of(paper::STIFFNESS)),
                gap: i.gap.number().of(paper::GAP),
            })
            .conduction(Conduction::<T, T, T> {
                mu1: i.mu1.number().of(paper::UNIT),
                mu2: i.mu2.number().of(paper::UNIT),
                truncation: i.truncation.of(paper::UNIT),
                potential_truncation: i.potential_truncation.of(paper::UNIT),
            })
            .load(Load {
                transverse: self.transverse(),
                axial: i.axial_load.number().of::<T>(paper::LOAD),
                points: self.points().as_slice(),
            })
            .potential(Potential { left: i.left.of(paper::UNIT), right: i.right.of(paper::UNIT) }),
        );
    }

    fn formed<W: piezobeam::Compliance<T> + Debug>(&self, law: W) {
        let i = self.input;
        self.check(
            Scene::new(
                self.length,
                Beam {
                    bending: self.form(&i.bending, paper::BENDING),
                    axial: self.form(&i.axial, paper::AXIAL),
                    piezo: self.form(&i.piezo, paper::PIEZO),
                    permittivity: self.form(&i.permittivity, paper::UNIT),
                },
            )
            .foundation(Foundation { law, gap: self.form(&i.gap, paper::GAP) })
            .conduction(Conduction {
                mu1: self.form(&i.mu1, paper::UNIT),
                mu2: self.form(&i.mu2, paper::UNIT),
                truncation: i.truncation.of(paper::UNIT),
                potential_truncation: i.potential_truncation.of(paper::UNIT),
            })
            .load(Load {
                transverse: self.form(&i.transverse, paper::LOAD),
                axial: self.form(&i.axial_load, paper::LOAD),
                points: self.points().as_slice(),
            })
            .potential(Potential { left: i.left.of(paper::UNIT), right: i.right.of(paper::UNIT) }),
        );
    }

    fn bending(&self) {
        let bending: T = self.input.bending.number().of(paper::BENDING);
        let points = self.points();
        let load = Load { transverse: self.transverse(), axial: (), points: points.as_slice() };
        self.check(Scene::new(self.length, Beam::elastic(bending)).load(load));
    }

    fn contact(&self) {
        let bending: T = self.input.bending.number().of(paper::BENDING);
        let law = Linear(self.input.stiffness.number().of::<T>(paper::STIFFNESS));
        let points = self.points();
        self.check(
            Scene::new(self.length, Beam::elastic(bending)).foundation(Foundation { law, gap: () }).load(
                Load {
                    transverse: self.form(&self.input.transverse, paper::LOAD),
                    axial: (),
                    points: points.as_slice(),
                },
            ),
        );
    }

    fn gap(&self) {
        let bending: T = self.input.bending.number().of(paper::BENDING);
        let law = Linear(self.input.stiffness.number().of::<T>(paper::STIFFNESS));
        let gap: T = self.input.gap.number().of(paper::GAP);
        let load = Load { transverse: self.transverse(), axial: (), points: () };
        self.check(
            Scene::new(self.length, Beam::elastic(bending)).foundation(Foundation { law, gap }).load(load),
        );
    }

    fn formed_gap(&self) {
        let bending = self.form(&self.input.bending, paper::BENDING);
        let law = Linear(self.form(&self.input.stiffness, paper::STIFFNESS));
        let gap = self.form(&self.input.gap, paper::GAP);
        let transverse = self.form(&self.input.transverse, paper::LOAD);
        self.check(
            Scene::new(self.length, Beam::elastic(bending)).foundation(Foundation { law, gap }).load(Load {
                transverse,
                axial: (),
                points: (),
            }),
        );
    }

    fn stretching(&self) {
        let bending: T = self.input.bending.number().of(paper::BENDING);
        let axial = self.form(&self.input.axial, paper::AXIAL);
        let beam = Beam { bending, axial, piezo: (), permittivity: () };
        let axial = self.form(&self.input.axial_load, paper::LOAD);
        let load = Load { transverse: self.transverse(), axial, points: () };
        self.check(Scene::new(self.length, beam).load(load));
    }

    fn potential(&self) {
        let i = self.input;
        let beam = Beam {
            bending: i.bending.number().of::<T>(paper::BENDING),
            axial: (),
            piezo: (),
            permittivity: self.form(&i.permittivity, paper::UNIT),
        };
        self.check(
            Scene::new(self.length, beam)
                .conduction(Conduction {
                    mu1: (),
                    mu2: self.form(&i.mu2, paper::UNIT),
                    truncation: i.truncation.of(paper::UNIT),
                    potential_truncation: i.potential_truncation.of(paper::UNIT),
                })
                .load(Load { transverse: self.transverse(), axial: (), points: () })
                .potential(Potential { left: i.left.of(paper::UNIT), right: i.right.of(paper::UNIT) }),
        );
    }

    fn closure(&self) {
        let bending: T = self.input.bending.number().of(paper::BENDING);
        let k: T = self.input.stiffness.number().of(paper::STIFFNESS);
        let slope: T = self.input.slope.of(paper::STIFFNESS);
        let law = property::Named(Law(move |_: T, r: T| (k * r, slope)), [k, slope]);
        let gap: T = self.input.gap.number().of(paper::GAP);
        let load = Load { transverse: self.transverse(), axial: (), points: () };
        self.check(
            Scene::new(self.length, Beam::elastic(bending)).foundation(Foundation { law, gap }).load(load),
        );
    }
}
