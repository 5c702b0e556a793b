//! One scene in two systems of units that differ by powers of two: all fields are the same numbers but for these, or one
//! of both solves has a status that says why.

use crate::differential::{Data, State};
use arbitrary::{Arbitrary, Unstructured};
use piezobeam::{
    Beam, Compliance, Conduction, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, PointLoad,
    Polynomial, Potential, Power, Problem, Profile, Real, Scene, Settings, Smooth, Solution, Status, Steps,
    Table, Warning,
};

#[derive(Arbitrary, Clone, Copy, Debug)]
struct Input {
    elements: u8,
    single: bool,
    electric: bool,
    formed: u8,
    scene: State,
    units: [i16; 6],
}

/// Exponents of two. Nothing in the equations ties these six to each other.
#[derive(Clone, Copy, Debug)]
struct Units {
    /// Along the beam \[m\].
    length: i32,
    /// Across it \[m\].
    deflection: i32,
    /// Transverse force per length \[N/m\].
    load: i32,
    /// Potential \[V\].
    potential: i32,
    /// Stretching \[m\].
    stretching: i32,
    /// Axial force \[N\].
    axial: i32,
}

impl Units {
    const NONE: Self = Self { length: 0, deflection: 0, load: 0, potential: 0, stretching: 0, axial: 0 };

    fn of<T: Real>(units: [i16; 6]) -> Self {
        // Most units are near those of the scene, some as far as the format goes.
        let most = if T::epsilon().f64() > 1e-10 { 160 } else { 1200 };
        let exponent = |i: usize| match units[i] % 4 {
            0 => 0,
            1 => i32::from(units[i]) % 64,
            _ => i32::from(units[i]) % most,
        };
        Self {
            length: exponent(0),
            deflection: exponent(1),
            load: exponent(2),
            potential: exponent(3),
            stretching: exponent(4),
            axial: exponent(5),
        }
    }

    /// Of the electric displacement \[N/V\].
    fn displacement(&self) -> i32 {
        self.axial + self.stretching - self.potential
    }
}

/// Numbers in other units, if all are exact.
struct Scale(bool);

impl Scale {
    fn to<T: Real>(&mut self, number: T, exponent: i32) -> T {
        let scaled = times(number, exponent);
        self.0 = self.0 && (number == T::zero() || scaled.is_normal());
        scaled
    }
}

/// The number in other units; exact, or beyond or below the normal numbers.
fn times<T: Real>(number: T, exponent: i32) -> T {
    let step = |exponent: i32| T::of(2.0).powi(exponent);
    let most = 100;
    let (mut number, mut rest) = (number, exponent);
    while rest != 0 {
        let part = rest.clamp(-most, most);
        (number, rest) = (number * step(part), rest - part);
    }
    number
}

/// Two ways agree where both say that they converged.
pub fn units(data: &[u8]) {
    let Ok(input) = Input::arbitrary(&mut Unstructured::new(data)) else { return };
    if input.single { compare::<f32>(&input) } else { compare::<f64>(&input) }
}

fn compare<T: Real + Profile<T> + Smooth<T>>(input: &Input) {
    let data = input.scene.data::<T>();
    let units = Units::of::<T>(input.units);
    let (a, b) = (look(input, &data, &Units::NONE), look(input, &data, &units));
    let (Some(a), Some(b)) = (a, b) else { return };
    // What the fields are differences of: rounding of these is all that there is of some.
    let largest = |all: &[T]| all.iter().fold(0.0_f64, |most, v| most.max(v.abs().f64()));
    let (gap, electric) =
        (largest(&[data.gap]), largest(&data.ends) + largest(&data.values) + largest(&[data.gap]));
    let natural = [gap, 16.0 * gap, electric, electric, electric];
    for (((field, allowed), (other, more)), natural) in a.iter().zip(&b).zip(natural) {
        let allowed = allowed.max(*more);
        if allowed.is_infinite() {
            continue;
        }
        let size = field.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let slack = allowed * size + 256.0 * T::epsilon().f64() * natural;
        for (one, two) in field.iter().zip(other) {
            let apart = (one - two).abs();
            assert!(apart <= slack, "{one:e} and {two:e} of {size:e}: {units:?} {input:?} {data:?}");
        }
    }
}

type Field = (Vec<f64>, f64);

/// The fields of the scene in these units, in the units of the scene, and by how much of the largest each may be off;
/// nothing if it did not converge.
fn look<T: Real + Profile<T> + Smooth<T>>(
    input: &Input,
    data: &Data<T>,
    units: &Units,
) -> Option<Vec<Field>> {
    let Units { length, deflection, load, .. } = *units;
    let mut scale = Scale(true);
    let mut to = |number: T, exponent: i32| scale.to(number, exponent);
    let span = to(T::one(), length);
    let breaks = data.breaks.map(|x| to(x, length));
    let bending = to(T::one(), load + 4 * length - deflection);
    let gap = to(data.gap, deflection);
    let [k, twice] = [data.stiffness, T::of(2.0) * data.stiffness].map(|k| to(k, load - deflection));
    let slopes = [T::of(0.25) * data.gap, T::of(-0.5) * data.gap];
    let gaps = [gap, to(slopes[0], deflection - length), to(slopes[1], deflection - 2 * length)];
    let softer = to(T::of(0.5), load + 4 * length - deflection);
    let table = [T::zero(), breaks[1], span];
    let bends = Table { x: &table, y: &[bending, softer, bending] };
    let curved = to(data.stiffness, load - 2 * deflection);
    let [left, right] = data.ends;
    let points = [
        PointLoad { x: breaks[0], force: to(left, load + length), moment: T::zero() },
        PointLoad { x: breaks[1], force: T::zero(), moment: to(right, load + 2 * length) },
    ];
    if !scale.0 {
        return None;
    }
    let plain = Shape { span, breaks, bending, points: &[] };
    let formed = Shape { span, breaks, bending: bends, points: &points };
    let steps = Linear(Steps { breaks: &breaks, values: &[k, twice, k] });
    match input.formed % 4 {
        0 => plain.solve(input, data, units, Foundation { law: Linear(k), gap }),
        1 => plain.solve(input, data, units, Foundation { law: steps, gap: Polynomial(&gaps) }),
        2 => formed.solve(input, data, units, Foundation { law: Linear(k), gap: Polynomial(&gaps) }),
        _ => {
            let law = Power { stiffness: curved, exponent: T::of(2.0) };
            formed.solve(input, data, units, Foundation { law, gap })
        }
    }
}

/// What holds with electric parts and without.
struct Shape<'a, T, B> {
    span: T,
    breaks: [T; 2],
    bending: B,
    points: &'a [PointLoad<T>],
}

impl<T: Real + Profile<T> + Smooth<T>, B: Profile<T> + Copy> Shape<'_, T, B> {
    fn solve<W: Compliance<T>, G: Smooth<T>>(
        &self,
        input: &Input,
        data: &Data<T>,
        units: &Units,
        foundation: Foundation<W, G>,
    ) -> Option<Vec<Field>> {
        let Self { span, breaks, bending, points } = self;
        let Units { length, deflection, load, potential, stretching, axial } = *units;
        let mut scale = Scale(true);
        let mut to = |number: T, exponent: i32| scale.to(number, exponent);
        let values = data.values.map(|f| to(f, load));
        let transverse = Steps { breaks, values: &values };
        if !input.electric {
            let scene = Scene::new(*span, Beam::elastic(*bending)).foundation(foundation);
            let scene = scene.load(Load { transverse, axial: (), points: *points });
            return if scale.0 { solved(input, units, scene) } else { None };
        }
        let displacement = units.displacement();
        let beam = Beam {
            bending: *bending,
            axial: to(T::of(3.0), axial + length - stretching),
            piezo: to(T::of(0.7), axial + length - potential),
            permittivity: to(T::one(), displacement + length - potential),
        };
        let [mu1, mu2] = data.mu;
        let [left, right] = data.ends.map(|q| to(q, potential));
        let scene = Scene::new(*span, beam)
            .foundation(foundation)
            .conduction(Conduction {
                mu1: to(mu1, load - deflection - potential),
                mu2: to(mu2, displacement - length - 2 * deflection),
                truncation: to(data.truncation, deflection),
                potential_truncation: to(data.truncation, potential),
            })
            .load(Load { transverse, axial: to(data.values[0], axial - length), points: *points })
            .potential(Potential { left, right });
        if scale.0 { solved(input, units, scene) } else { None }
    }
}

fn solved<T: Real, M: Model<T>>(input: &Input, units: &Units, scene: M) -> Option<Vec<Field>> {
    let elements = 1 + usize::from(input.elements) % 12;
    let problem = Problem::new(scene, Mesh::uniform(elements)).ok()?;
    let mut memory = HeapWorkspace::new();
    fields(&problem.solve(&mut memory, &Settings::default()).ok()?, units)
}

fn fields<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>, units: &Units) -> Option<Vec<Field>> {
    // A foundation that is taken as rigid in some units need not be so in others.
    let rigid = solution.warnings().iter().any(|w| matches!(w, Warning::Rigid { .. }));
    if solution.report().status != Status::Converged || rigid {
        return None;
    }
    let Units { length, deflection, load, potential, stretching, axial } = *units;
    let span = solution.scene().length();
    let at: Vec<_> = (1..8).map(|i| solution.at(span * T::of(f64::from(i) / 8.0))).collect();
    let back = |value: T, exponent: i32| times(value.f64(), -exponent);
    let few = Settings::<T>::default().stop.f64() * 1e4;
    let column = |of: &dyn Fn(&piezobeam::Fields<T>) -> Option<T>, exponent: i32| -> Field {
        let most = at.iter().filter_map(of).fold(T::zero(), |most, v| most.max(v.abs()));
        // A field below the normal numbers has no digits to compare.
        let few = if most * T::epsilon() < T::min_positive_value() { f64::INFINITY } else { few };
        (at.iter().filter_map(of).map(|v| back(v, exponent)).collect(), few)
    };
    Some(vec![
        column(&|f| Some(f.bending), deflection),
        column(&|f| Some(f.moment), load + 2 * length),
        column(&|f| f.stretching, stretching),
        column(&|f| f.potential, potential),
        column(&|f| f.axial_force, axial),
    ])
}
