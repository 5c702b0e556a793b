//! The forms in which a scene file gives a profile.

use toml::de::DeValue;

use super::error::{FileError, quoted};
use super::expression::Expression;
use super::profile::ProfileSpec;
use super::table::{Field, Table};

const FORMS: &str = "give a number, a formula in quotes, { polynomial = [..] }, \
                     { breaks = [..], values = [..] }, { breaks = [..], polynomials = [..] } \
                     or { x = [..], y = [..] }";

const KEYS: &[&str] = &["polynomial", "breaks", "values", "polynomials", "x", "y"];

/// Reads a profile of a beam of this length.
pub(super) fn read(field: &Field<'_>, length: f64) -> Result<ProfileSpec, FileError> {
    match field.value() {
        DeValue::Integer(_) | DeValue::Float(_) => field.number().map(ProfileSpec::Number),
        DeValue::String(text) => formula(field, text, length).map(ProfileSpec::Expression),
        DeValue::Table(_) => pieces(field, &field.table()?, length),
        DeValue::Array(_) => {
            Err(field.expected("a profile").hint("name what the numbers are, as in { polynomial = [1, 2] }"))
        }
        DeValue::Boolean(_) | DeValue::Datetime(_) => Err(field.expected("a profile").hint(FORMS)),
    }
}

/// Reads a profile whose first two derivatives are needed.
pub(super) fn read_smooth(field: &Field<'_>, length: f64) -> Result<ProfileSpec, FileError> {
    let profile = read(field, length)?;
    if let ProfileSpec::Expression(expression) = &profile
        && let Some(function) = expression.kinked()
    {
        let message = format!(
            "in {}: {function} has kinks, and the first two derivatives are needed here",
            quoted(expression.text())
        );
        return Err(field
            .error(message)
            .hint("give the pieces between the kinks as { breaks = [..], polynomials = [..] }"));
    }
    Ok(profile)
}

fn formula(field: &Field<'_>, text: &str, length: f64) -> Result<Expression, FileError> {
    let formula = Expression::parse(text, length).map_err(|error| {
        let place = error.at.map_or(String::new(), |at| format!(" at character {at}"));
        let message = format!("in {}: {}{place}", quoted(text), error.message);
        field.error(message).hint(error.hint)
    })?;
    let Some(x) = formula.pole(length) else { return Ok(formula) };
    // As many digits as the search is good for.
    let x = format!("{x:.5e}").parse().unwrap_or(x);
    let message = format!("in {}: grows without bound at x = {x}", quoted(text));
    Err(field.error(message).hint("give a formula that is finite on the whole beam"))
}

/// Reads the forms which are tables.
fn pieces(field: &Field<'_>, table: &Table<'_>, length: f64) -> Result<ProfileSpec, FileError> {
    table.allow(KEYS)?;
    let given: Vec<&str> = KEYS.iter().copied().filter(|key| table.has(key)).collect();
    match given.as_slice() {
        ["polynomial"] => {
            let coefficients = table.required("polynomial", FORMS)?.numbers()?;
            Ok(ProfileSpec::Polynomial(coefficients))
        }
        ["breaks", "values"] => {
            let breaks = breaks(table, length)?;
            let field = table.required("values", FORMS)?;
            let values = field.numbers()?;
            one_more(&field, values.len(), breaks.len())?;
            Ok(ProfileSpec::Steps { breaks, values })
        }
        ["breaks", "polynomials"] => {
            let breaks = breaks(table, length)?;
            let field = table.required("polynomials", FORMS)?;
            let DeValue::Array(array) = field.value() else {
                return Err(field.expected("an array of arrays of coefficients"));
            };
            let polynomials: Vec<_> =
                field.elements(array).map(|piece| piece.numbers()).collect::<Result<_, _>>()?;
            one_more(&field, polynomials.len(), breaks.len())?;
            Ok(ProfileSpec::Pieces { breaks, polynomials })
        }
        ["x", "y"] => curve(table, length),
        _ => Err(incomplete(field, &given)),
    }
}

/// The complaint about keys which make no form together.
fn incomplete(field: &Field<'_>, given: &[&str]) -> FileError {
    match given {
        [] => field.error("expected a profile, found an empty table").hint(FORMS),
        ["breaks"] => field
            .error("breaks without values")
            .hint("add values = [..] or polynomials = [..], one more than there are breaks"),
        ["values" | "polynomials"] => field
            .error(format!("{} without breaks", given[0]))
            .hint("add breaks = [..], one fewer than there are pieces"),
        ["x"] => field.error("x without y").hint("add y = [..], one value for each x"),
        ["y"] => field.error("y without x").hint("add x = [..], one position for each y"),
        _ => field.error(format!("{} do not go together", super::error::listed(given))).hint(FORMS),
    }
}

/// Positions which rise strictly inside the beam.
fn breaks(table: &Table<'_>, length: f64) -> Result<Vec<f64>, FileError> {
    let field = table.required("breaks", FORMS)?;
    let breaks = field.numbers()?;
    rising(&field, &breaks)?;
    let outside = breaks.iter().position(|&at| at <= 0.0 || at >= length);
    if let Some(index) = outside {
        let message = format!("{} is not inside the beam", breaks[index]);
        return Err(element(&field, index)
            .unwrap_or(field)
            .error(message)
            .hint(format!("breaks lie strictly between 0 and {length}")));
    }
    Ok(breaks)
}

/// Refuses numbers which do not strictly increase.
pub(super) fn rising(field: &Field<'_>, numbers: &[f64]) -> Result<(), FileError> {
    let fall = numbers.windows(2).position(|pair| pair[0] >= pair[1]);
    let Some(index) = fall else {
        return Ok(());
    };
    let message = format!("{} does not exceed {} before it", numbers[index + 1], numbers[index]);
    let error = match element(field, index + 1) {
        Some(element) => element.error(message),
        None => field.error(message),
    };
    Err(error.hint("write the positions in strictly increasing order"))
}

fn element<'a>(field: &Field<'a>, index: usize) -> Option<Field<'a>> {
    match field.value() {
        DeValue::Array(array) => field.elements(array).nth(index),
        _ => None,
    }
}

/// Refuses any number of pieces but one more than there are breaks.
fn one_more(field: &Field<'_>, pieces: usize, breaks: usize) -> Result<(), FileError> {
    if pieces == breaks + 1 {
        return Ok(());
    }
    let plural = if breaks == 1 { "" } else { "s" };
    let message = format!("expected {} entries, found {pieces}", breaks + 1);
    let verb = if breaks == 1 { "parts" } else { "part" };
    let hint = format!("{breaks} break{plural} {verb} the beam into {} pieces", breaks + 1);
    Err(field.error(message).hint(hint))
}

/// Reads a table of values, of which the part on the beam is kept.
fn curve(table: &Table<'_>, length: f64) -> Result<ProfileSpec, FileError> {
    let field = table.required("x", FORMS)?;
    let x = field.numbers()?;
    let values = table.required("y", FORMS)?;
    let y = values.numbers()?;
    if x.len() != y.len() {
        return Err(values
            .error(format!("{} values for {} positions", y.len(), x.len()))
            .hint("give one y for each x"));
    }
    rising(&field, &x)?;
    match (x.first(), x.last()) {
        (Some(&first), Some(&last)) if first <= 0.0 && last >= length => Ok(clipped(x, y, length)),
        (Some(first), Some(last)) => Err(field
            .error(format!("the table covers {first} to {last} of the beam only"))
            .hint(format!("let x reach from 0 to {length}"))),
        _ => Err(field.expected("at least two positions")),
    }
}

/// The part of the table on the beam.
fn clipped(x: Vec<f64>, y: Vec<f64>, length: f64) -> ProfileSpec {
    let start = x.partition_point(|&at| at <= 0.0).saturating_sub(1);
    let end = x.partition_point(|&at| at < length);
    let whole = ProfileSpec::Table { x, y };
    let [first, last] = [whole.value(0.0, 0.0), whole.value(length, length.next_down())];
    let ProfileSpec::Table { mut x, mut y } = whole else {
        return whole;
    };
    x.truncate(end + 1);
    y.truncate(end + 1);
    x.drain(..start);
    y.drain(..start);
    if let ([x_first, .., x_last], [y_first, .., y_last]) = (&mut x[..], &mut y[..]) {
        (*x_first, *y_first) = (0.0, first);
        (*x_last, *y_last) = (length, last);
    }
    ProfileSpec::Table { x, y }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_cut_to_the_beam() {
        let clip = |x: &[f64], y: &[f64]| match clipped(x.to_vec(), y.to_vec(), 1.0) {
            ProfileSpec::Table { x, y } => (x, y),
            other => panic!("{other:?}"),
        };
        let whole = (vec![0.0, 0.5, 1.0], vec![3.0, 1.0, 2.0]);
        assert_eq!(clip(&whole.0, &whole.1), whole);
        assert_eq!(
            clip(&[-2.0, -1.0, 1.0, 3.0, 4.0], &[9.0, 0.0, 4.0, 8.0, 0.0]),
            (vec![0.0, 1.0], vec![2.0, 4.0])
        );
        assert_eq!(clip(&[-1.0, 0.5, 2.0], &[0.0, 3.0, 0.0]), (vec![0.0, 0.5, 1.0], vec![2.0, 3.0, 2.0]));
    }
}
