//! A thousand random scenes of all kinds, each kind hashed to one value.
//!
//! Kinds that call `pow`, `ln` or `expm1` are marked: these functions are not correctly rounded, so two
//! libraries of them give other bits. All other kinds need +, -, *, / and the square root alone.

use crate::bits::{Hash, Number, Random, name};
use core::fmt::{Error, Result, Write};
use piezobeam::{
    Beam, Conduction, Foundation, History, Linear, Load, Mesh, Model, Output, Parameter, PointLoad,
    Polynomial, Potential, Power, Prepared, Problem, Profile, Scene, Settings, Steps, Tabulated, Workspace,
};

/// Scenes of each kind in each precision: ten kinds, two precisions.
const SCENES: usize = 50;
/// Most elements of a scene, those between breaks included.
const MOST: usize = 60;

/// A scene's hash, or why there is none.
type Solved = core::result::Result<Hash, Error>;

/// Prints the hash of each kind, and one of all.
///
/// # Errors
/// What `out` says, or a scene that is refused.
pub fn report(out: &mut impl Write) -> Result {
    let mut all = Hash::default();
    precision::<f32>(out, &mut all)?;
    precision::<f64>(out, &mut all)?;
    writeln!(out, "{} scenes: {all}", 20 * SCENES)
}

fn precision<T: Number>(out: &mut impl Write, all: &mut Hash) -> Result {
    kind::<T>(out, all, "bending", bending::<T>)?;
    kind::<T>(out, all, "contact", contact::<T>)?;
    kind::<T>(out, all, "gap and derivatives", gap::<T>)?;
    kind::<T>(out, all, "law r^1, r^1.5, r^2, r^2.5", half_power::<T>)?;
    kind::<T>(out, all, "law r^a (pow)", any_power::<T>)?;
    kind::<T>(out, all, "law by a table", table::<T>)?;
    kind::<T>(out, all, "potential onto bending", onto::<T>)?;
    kind::<T>(out, all, "contact into potential", into::<T>)?;
    kind::<T>(out, all, "both", both::<T>)?;
    kind::<T>(out, all, "history on a graded mesh (ln, expm1)", history::<T>)
}

fn kind<T: Number>(
    out: &mut impl Write,
    all: &mut Hash,
    what: &str,
    scene: fn(&mut Random) -> Solved,
) -> Result {
    let mut random = Random(1);
    let mut kind = Hash::default();
    for _ in 0..SCENES {
        kind.hash(scene(&mut random)?);
    }
    all.hash(kind);
    writeln!(out, "{SCENES} random scenes, {}, {what}: {kind}", name::<T>())
}

/// Settings that bound a scene that is hard to the work that an emulator does in a blink.
fn settings<T: Number>() -> Settings<T> {
    Settings { max_visits: Some(2000), ..Settings::default() }
}

/// A load of one sign, or pressing on one part and lifting on the other.
fn loads<T: Number>(random: &mut Random) -> ([T; 1], [T; 2]) {
    let at = [random.within(0.1, 0.9)];
    (at, [random.within(-1e6, 1e6), random.within(-1e6, 1e6)])
}

/// Solves and hashes.
fn solved<T: Number, M: Model<T>>(random: &mut Random, scene: M) -> Solved {
    and_more(random, scene, |_, _| {})
}

/// Solves, hashes, and does something more with it.
#[inline(never)]
fn and_more<T: Number, M: Model<T>>(
    random: &mut Random,
    scene: M,
    more: impl FnOnce(&mut Prepared<'_, T, M>, &mut Hash),
) -> Solved {
    let mut hash = Hash::default();
    let problem = Problem::new(scene, Mesh::uniform(1 + random.below(24))).map_err(crate::refused)?;
    let mut memory: Workspace<T, M, MOST> = problem.workspace();
    let mut prepared = problem.prepare(&mut memory).map_err(crate::refused)?;
    hash.solution(&prepared.solution(&settings()).map_err(crate::refused)?);
    more(&mut prepared, &mut hash);
    Ok(hash)
}

/// All derivatives of one output, and those of some to one parameter.
fn derivatives<T: Number, M: Model<T>>(prepared: &mut Prepared<'_, T, M>, hash: &mut Hash) {
    if let Ok(tangent) = prepared.tangent(Parameter::Stiffness) {
        for x in [0.1, 0.4, 0.8] {
            hash.fields(&tangent.at(T::of(x)));
        }
    }
    if let Ok(adjoint) = prepared.adjoint(Output::ContactForce) {
        hash.number(adjoint.influence(T::of(0.6)));
        for parameter in
            [Parameter::Bending, Parameter::Stiffness, Parameter::Gap, Parameter::Force(T::of(0.2))]
        {
            hash.number(adjoint.to(parameter).unwrap_or(T::zero()));
        }
    }
    hash.word(match prepared.grazing() {
        Ok(None) => 0,
        Ok(Some(_)) => 1,
        Err(_) => 2,
    });
}

/// Bending and stretching without contact; stiffness that jumps, concentrated loads, a uniform field.
fn bending<T: Number>(random: &mut Random) -> Solved {
    let (breaks, values) = loads(random);
    let stiffer = [random.size(2, 5), random.size(2, 5)];
    let at = [random.within(0.2, 0.8)];
    let load = PointLoad { x: at[0], force: random.size(1, 6), moment: random.within(-1e5, 1e5) };
    let beam = Beam {
        bending: Steps { breaks: &at, values: &stiffer },
        axial: random.size::<T>(3, 7),
        piezo: random.within::<T>(-200.0, 200.0),
        permittivity: random.size::<T>(-1, 2),
    };
    let scene = Scene::new(T::one(), beam)
        .load(Load {
            transverse: Steps { breaks: &breaks, values: &values },
            axial: random.within::<T>(-1e6, 1e6),
            points: [load],
        })
        .potential(Potential { left: random.within(-2.0, 2.0), right: random.within(-2.0, 2.0) });
    solved(random, scene)
}

/// A linear law, up to one that is all but rigid.
fn contact<T: Number>(random: &mut Random) -> Solved {
    let (breaks, values) = loads(random);
    let scene = Scene::new(random.within::<T>(1.0, 2.0), Beam::elastic(random.size::<T>(2, 5)))
        .foundation(Foundation { law: Linear(random.size::<T>(2, 16)), gap: () })
        .load(Load { transverse: Steps { breaks: &breaks, values: &values }, axial: (), points: () });
    solved(random, scene)
}

/// A gap, or a preload, of x (L - x).
fn shape<T: Number>(random: &mut Random) -> [T; 3] {
    let size: T = random.within(-0.1, 0.4);
    [T::zero(), size, -size]
}

fn gap<T: Number>(random: &mut Random) -> Solved {
    let (breaks, values) = loads(random);
    let gap = shape(random);
    let scene = Scene::new(T::one(), Beam::elastic(T::of(5e3)))
        .foundation(Foundation { law: Linear(random.size::<T>(3, 12)), gap: Polynomial(&gap) })
        .load(Load { transverse: Steps { breaks: &breaks, values: &values }, axial: (), points: () });
    and_more(random, scene, derivatives)
}

fn law<T: Number>(random: &mut Random, exponent: T) -> Solved {
    let (breaks, values) = loads(random);
    let law = Power { stiffness: random.size::<T>(4, 10), exponent };
    let scene = Scene::new(T::one(), Beam::elastic(T::of(5e3)))
        .foundation(Foundation { law, gap: random.within::<T>(-0.05, 0.2) })
        .load(Load { transverse: Steps { breaks: &breaks, values: &values }, axial: (), points: () });
    solved(random, scene)
}

fn half_power<T: Number>(random: &mut Random) -> Solved {
    let exponent = T::of([1.0, 1.5, 2.0, 2.5][random.below(4)]);
    law(random, exponent)
}

fn any_power<T: Number>(random: &mut Random) -> Solved {
    let exponent = random.within::<T>(1.0, 3.0);
    law(random, exponent)
}

fn table<T: Number>(random: &mut Random) -> Solved {
    let (breaks, values) = loads(random);
    let step: T = random.size(-3, 0);
    let penetration = [T::zero(), step, step + step];
    let pressure = [T::zero(), random.within(0.0, 1e5), random.within(1e5, 1e7)];
    let scene = Scene::new(T::one(), Beam::elastic(T::of(5e3)))
        .foundation(Foundation {
            law: Tabulated { penetration: &penetration, pressure: &pressure },
            gap: random.within::<T>(-0.05, 0.2),
        })
        .load(Load { transverse: Steps { breaks: &breaks, values: &values }, axial: (), points: () });
    solved(random, scene)
}

/// A beam with all parts, a potential at the ends, and this conduction.
fn electric<T: Number>(random: &mut Random, mu1: impl Profile<T>, mu2: impl Profile<T>) -> Solved {
    let (breaks, values) = loads(random);
    let gap = shape(random);
    let beam = Beam {
        bending: T::of(5e3),
        axial: random.size::<T>(3, 7),
        piezo: random.within::<T>(-200.0, 200.0),
        permittivity: random.size::<T>(-1, 2),
    };
    let (truncation, potential_truncation) = (random.within(0.01, 1.0), random.within(0.1, 2.0));
    let scene = Scene::new(T::one(), beam)
        .foundation(Foundation { law: Linear(random.size::<T>(3, 10)), gap: Polynomial(&gap) })
        .conduction(Conduction { mu1, mu2, truncation, potential_truncation })
        .load(Load {
            transverse: Steps { breaks: &breaks, values: &values },
            axial: random.within::<T>(-1e6, 1e6),
            points: (),
        })
        .potential(Potential { left: random.within(-2.0, 2.0), right: random.within(-2.0, 2.0) });
    solved(random, scene)
}

fn onto<T: Number>(random: &mut Random) -> Solved {
    let mu1 = random.size::<T>(0, 6);
    electric(random, mu1, ())
}

fn into<T: Number>(random: &mut Random) -> Solved {
    let mu2 = random.size::<T>(0, 3);
    electric(random, (), mu2)
}

/// Also far beyond the uniqueness condition, where the monolithic method takes over.
fn both<T: Number>(random: &mut Random) -> Solved {
    let (mu1, mu2) = (random.size::<T>(0, 6), random.size::<T>(0, 3));
    electric(random, mu1, mu2)
}

/// Three steps of a history each.
fn history<T: Number>(random: &mut Random) -> Solved {
    let mut hash = Hash::default();
    let (breaks, _) = loads(random);
    let values: [[T; 2]; 3] = core::array::from_fn(|_| [random.within(-1e6, 1e6), random.within(-1e6, 1e6)]);
    let mesh = Mesh::Graded { elements: 2 + random.below(24), ratio: random.within(0.2, 5.0) };
    let base = Scene::new(T::one(), Beam::elastic(T::of(5e3)))
        .foundation(Foundation { law: Linear(random.size::<T>(3, 10)), gap: random.within::<T>(-0.05, 0.2) });
    let mut memory: Workspace<T, _, MOST> = Workspace::new();
    let mut history = History::new(mesh, &mut memory);
    for values in &values {
        let load = Load { transverse: Steps { breaks: &breaks, values }, axial: (), points: () };
        let scene = base.load(load);
        hash.solution(&history.solve(&scene, &settings()).map_err(crate::refused)?);
    }
    Ok(hash)
}
