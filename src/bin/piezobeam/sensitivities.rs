//! Derivatives of what an engineer looks at to all that a scene file sets.

use crate::report::{self, Sensitivities};
use piezobeam::{
    Compliance, Grazing, Model, Output, Parameter, PointLoad, Prepared, Profile, Real, SensitivityError,
    Solution,
};

/// What a number means, for people.
const MEANING: &str = "Each number is the change of the column's output per relative change of the row's profile (1 % \
more of it changes the output by a hundredth of the number), or per N, N m or V where the unit says so.";

/// Points among which the largest bending is looked for.
const POINTS: u32 = 2000;

/// A parameter, its field in a scene file, where it is, and its unit.
type Named<T> = (Parameter<T>, &'static str, Option<T>, Option<&'static str>);

/// Derivatives at the last solution of `prepared`.
pub fn of<T: Real, M: Model<T>>(prepared: &mut Prepared<'_, T, M>) -> Sensitivities {
    let mut found = Sensitivities { meaning: MEANING, ..Sensitivities::default() };
    if let Err(error) = fill(prepared, &mut found) {
        found =
            Sensitivities { meaning: MEANING, error: Some(error.to_string()), ..Sensitivities::default() };
    }
    found
}

fn fill<T: Real, M: Model<T>>(
    prepared: &mut Prepared<'_, T, M>,
    found: &mut Sensitivities,
) -> Result<(), SensitivityError> {
    found.warning = prepared.grazing()?.map(|grazing| warning(&grazing));
    let solution = prepared.last().ok_or(SensitivityError::Unsolved)?;
    let (parameters, outputs) = (parameters(solution.scene()), outputs(&solution));
    let rows: Vec<_> = outputs.iter().map(|&(output, ..)| output).collect();
    let columns: Vec<_> = parameters.iter().map(|&(parameter, ..)| parameter).collect();
    let mut values = vec![T::zero(); rows.len() * columns.len()];
    prepared.derivatives(&rows, &columns, &mut values)?;
    found.parameters = parameters
        .into_iter()
        .map(|(_, name, x, unit)| report::Parameter { name: name.into(), x: x.map(Real::f64), unit })
        .collect();
    found.outputs = outputs
        .into_iter()
        .zip(values.chunks(columns.len()))
        .map(|((_, name, x, unit), row)| report::Output {
            name,
            x: x.map(Real::f64),
            unit,
            derivatives: row.iter().map(|v| v.f64()).collect(),
        })
        .collect();
    Ok(())
}

fn warning<T: Real>(grazing: &Grazing<T>) -> String {
    match grazing {
        Grazing::Stretch { from, to } => format!(
            "from x = {from} to {to} m the beam just rests on the foundation, or is just at a truncation: the \
             derivatives hold for changes of one sign at most"
        ),
        Grazing::Touch { x } => format!(
            "at x = {x} m the beam just touches the foundation, or a truncation: the derivatives hold for very \
             small changes only"
        ),
        _ => "the solution is at a kink of the forces".into(),
    }
}

/// All parameters of the scene that are there: a profile that is zero has nothing to scale.
fn parameters<T: Real, M: Model<T>>(scene: &M) -> Vec<Named<T>> {
    let (beam, foundation) = (scene.beam(), scene.foundation());
    let (conduction, load) = (scene.conduction(), scene.load());
    let length = scene.length();
    let there = |value: &dyn Fn(T) -> T| {
        (0..64).any(|i| value(length * T::of((f64::from(i) + 0.5) / 64.0)) != T::zero())
    };
    let profiles: [(_, _, &dyn Fn(T) -> T); 10] = [
        (Parameter::Bending, "beam.bending", &|x| beam.bending.value(x, x)),
        (Parameter::Axial, "beam.axial", &|x| beam.axial.value(x, x)),
        (Parameter::Piezo, "beam.piezo", &|x| beam.piezo.value(x, x)),
        (Parameter::Permittivity, "beam.permittivity", &|x| beam.permittivity.value(x, x)),
        (Parameter::Stiffness, "foundation.stiffness", &|x| foundation.law.coefficient(x, x)),
        (Parameter::Gap, "foundation.gap", &|x| foundation.gap.value(x, x)),
        (Parameter::Mu1, "conduction.mu1", &|x| conduction.mu1.value(x, x)),
        (Parameter::Mu2, "conduction.mu2", &|x| conduction.mu2.value(x, x)),
        (Parameter::Transverse, "load.transverse", &|x| load.transverse.value(x, x)),
        (Parameter::AxialLoad, "load.axial", &|x| load.axial.value(x, x)),
    ];
    let mut list: Vec<Named<T>> = profiles
        .into_iter()
        .filter(|(parameter, _, value)| parameter.is_in(scene) && there(value))
        .map(|(parameter, name, _)| (parameter, name, None, None))
        .collect();
    for (i, &PointLoad { x, .. }) in load.points.iter().enumerate() {
        list.push((Parameter::PointForce(i), "load.points.force", Some(x), Some("N")));
        list.push((Parameter::PointMoment(i), "load.points.moment", Some(x), Some("(N m)")));
    }
    if Parameter::<T>::LeftPotential.is_in(scene) {
        list.push((Parameter::LeftPotential, "potential.left", None, Some("V")));
        list.push((Parameter::RightPotential, "potential.right", None, Some("V")));
    }
    list
}

/// An output, its name, where it is, and its unit.
type Wanted<T> = (Output<T>, &'static str, Option<T>, &'static str);

fn outputs<T: Real, M: Model<T>>(solution: &Solution<'_, T, M>) -> Vec<Wanted<T>> {
    let scene = solution.scene();
    let length = scene.length();
    let middle = length * T::of(0.5);
    // The place of the largest bending moves too, but there the slope is zero.
    let (mut most, mut summit) = (T::zero(), middle);
    for i in 0..=POINTS {
        let x = length * T::of(f64::from(i) / f64::from(POINTS));
        let size = solution.at(x).bending.abs();
        if size > most {
            (most, summit) = (size, x);
        }
    }
    let mut list: Vec<Wanted<T>> = vec![
        (Output::Bending(summit), "largest bending", Some(summit), "m"),
        (Output::Bending(middle), "bending", Some(middle), "m"),
        (Output::ContactForce, "contact force", None, "N"),
        (Output::LeftForce, "left force", None, "N"),
        (Output::LeftMoment, "left moment", None, "N m"),
        (Output::RightForce, "right force", None, "N"),
        (Output::RightMoment, "right moment", None, "N m"),
        (Output::Potential(middle), "potential", Some(middle), "V"),
    ];
    list.retain(|(output, ..)| output.is_in(scene));
    list
}
