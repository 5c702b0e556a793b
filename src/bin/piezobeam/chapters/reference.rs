//! Solutions to compare with: the solver's own, on meshes made for 1e-13.

use super::measure::{Bench, Field, How, Size, points};
use super::scenes::Numbers;
use std::error::Error;

/// The relative error of bending that a reference is made for.
const TOLERANCE: f64 = 1e-13;

/// The fields of a scene at [`points`].
///
/// # Errors
/// It could not be solved.
pub fn of(numbers: &Numbers) -> Result<Vec<Field>, Box<dyn Error>> {
    at(numbers, &points())
}

/// The fields of a scene at these points.
pub fn at(numbers: &Numbers, x: &[f64]) -> Result<Vec<Field>, Box<dyn Error>> {
    let given = numbers.in_precision::<f64>();
    let scene = given.scene();
    let found = Bench::new(&scene).find(How::Adaptive, Size::Tolerance(TOLERANCE), x)?;
    match found.settled {
        true => Ok(found.fields),
        false => Err(format!("the reference of {} ended as {}", numbers.name, found.status).into()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::measure::errors;
    use super::super::scenes::{ALL, PARTIAL};
    use super::*;

    /// x and the fields of a file of the reference suite.
    fn suite(name: &str) -> (Vec<f64>, Vec<Field>) {
        let path = format!("{}/tests/reference/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let whole: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let column = |name: &str| -> Vec<f64> {
            let list = whole["reference"][name].as_array().unwrap();
            list.iter().map(|v| v.as_f64().unwrap()).collect()
        };
        let (xi, u, q) = (column("xi"), column("u"), column("q"));
        let fields = xi.iter().zip(u.iter().zip(&q)).map(|(&xi, (&u, &q))| [xi, u, q]);
        (column("x"), fields.collect())
    }

    /// References are 1e-12 from solutions to 16 digits by another method: a thousandth of the least error that a
    /// claim is about.
    #[test]
    fn references_are_those_of_the_suite() {
        let stiffness = ["1e04", "1e10", "1e14"];
        let swept = stiffness.map(|k| (format!("sweep-{k}"), PARTIAL.on(k.parse().unwrap())));
        let all = ALL.map(|numbers| (numbers.name.to_owned(), numbers));
        for (name, numbers) in all.into_iter().chain(swept) {
            let (x, want) = suite(&name);
            let found = at(&numbers, &x).unwrap();
            let off = errors(&found, &want);
            assert!(off.iter().all(|error| *error < 1e-12), "{name}: {off:e}", off = off[0]);
        }
    }
}
