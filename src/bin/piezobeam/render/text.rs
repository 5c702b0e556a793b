//! Text for people: the status first, then what an engineer looks for, numbers with six digits and SI prefixes.

use std::fmt::Write;

use comfy_table::{CellAlignment, Table, presets};

use super::{counted, extremes, fields, quantity, significant, zones};
use crate::report::{Checked, Picture, Report, Sensitivities, Timing, Uniqueness};

const DIGITS: usize = 6;

/// The report of `solve`.
pub fn solve(picture: &Picture) -> String {
    let report = &picture.report;
    let mut out = status(report);
    let _ = writeln!(out, "{}", picture.title);
    let _ = writeln!(
        out,
        "{} elements, {}, {} element visits, {}, {}, residual {}\n",
        report.elements,
        counted(report.iterations, "iteration"),
        report.element_visits,
        report.precision,
        report.method.name,
        significant(report.residual, 3)
    );
    out += &lines(field_table(picture));
    out.push('\n');
    out += &pairs(&results(picture));
    out += &warnings(&report.warnings);
    if let Some(found) = &report.sensitivities {
        out += &sensitivities(found);
    }
    out
}

/// The report of `check`.
pub fn check(checked: &Checked) -> String {
    let mut rows = checked.facts.clone();
    rows.push(("uniqueness".into(), uniqueness(&checked.uniqueness)));
    let title = &checked.title;
    format!("the scene is sound\n{title}\n\n{}{}", pairs(&rows), warnings(&checked.warnings))
}

/// The report of `time`.
pub fn time(timing: &Timing) -> String {
    let seconds = |ns: f64| quantity(ns * 1e-9, "s", 4);
    let visits = timing.element_visits.max(1) as f64;
    let rows = [
        ("status", timing.status.clone()),
        ("elements", timing.elements.to_string()),
        ("iterations", timing.iterations.to_string()),
        ("element visits", timing.element_visits.to_string()),
        ("per element visit", seconds(timing.best_ns / visits)),
        ("fastest", seconds(timing.best_ns)),
        ("slowest", seconds(timing.worst_ns)),
        ("memory", format!("{} bytes per element", timing.bytes_per_element)),
    ]
    .map(|(name, value)| (name.to_owned(), value));
    format!(
        "{} per solve (median of {}, {})\n{}",
        seconds(timing.median_ns),
        timing.repeat,
        timing.precision,
        pairs(&rows)
    )
}

/// First line and, where it did not converge, what to try.
fn status(report: &Report) -> String {
    if report.converged() {
        return format!("converged in {}\n", counted(report.iterations, "iteration"));
    }
    let reason = report.reason.as_deref().unwrap_or("no reason was recorded");
    let precision = match report.precision.as_str() {
        "f32" => "--precision f64 for more digits, ",
        _ => "",
    };
    if let (name, Some(own)) = (report.method.name, report.method.own_residual) {
        let pressures = [report.method.lowest_pressure, report.method.highest_pressure];
        let [low, high] = pressures.map(|p| quantity(p.unwrap_or(0.0), "N/m", 3));
        return format!(
            "NOT CONVERGED ({}): {reason}\n\
             The numbers below are what {name} found, not a solution: its own residual is {}, its contact \
             pressure from {low} to {high}.\n\
             Try --method newton, which integrates the contact up to its edges.\n",
            report.status,
            significant(own, 2)
        );
    }
    // A tolerance is a number below one.
    let stop = match report.residual {
        residual if residual < 1e-3 => {
            format!(", or a --stop above the residual {}", significant(residual, 2))
        }
        _ => String::new(),
    };
    format!(
        "NOT CONVERGED ({}): {reason}\n\
         The numbers below are the best iterate, not a solution.\n\
         Try {precision}--elements {} for a finer mesh{stop}.\n",
        report.status,
        report.elements.saturating_mul(2)
    )
}

fn field_table(picture: &Picture) -> Table {
    let samples = &picture.report.samples;
    let at = |x| quantity(x, "m", DIGITS);
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_header(["", "least", "at x", "greatest", "at x"]);
    for field in fields(samples) {
        let Some(values) = field.values else { continue };
        let Some((least, greatest)) = extremes(&samples.x, values) else {
            table.add_row([field.name, "no finite value", "", "", ""]);
            continue;
        };
        let value = |v| quantity(v, field.unit, DIGITS);
        if least.1 == greatest.1 {
            let everywhere = "everywhere".to_owned();
            table.add_row([
                field.name.into(),
                value(least.1),
                everywhere.clone(),
                value(greatest.1),
                everywhere,
            ]);
            continue;
        }
        table.add_row([field.name.into(), value(least.1), at(least.0), value(greatest.1), at(greatest.0)]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// Contact, reactions, energy and uniqueness, as name and value; also the numbers of the overview page.
pub fn results(picture: &Picture) -> Vec<(String, String)> {
    let report = &picture.report;
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push((name.to_owned(), value));
    match &report.contact {
        Some(contact) => {
            let pressed: f64 = contact.zones.iter().map(|[a, b]| b - a).sum();
            let share = match contact.zones.is_empty() {
                true => String::new(),
                false => format!(" ({} % of the length)", significant(100.0 * pressed / picture.length, 3)),
            };
            let shown = zones(&contact.zones, picture.length, DIGITS, 8);
            row("contact zones", format!("{shown}{share}"));
            row("contact force", quantity(contact.force, "N", DIGITS));
        }
        None => row("contact zones", "no foundation".into()),
    }
    let r = &report.resultants;
    for (name, reaction) in [("left reaction", r.left), ("right reaction", r.right)] {
        let force = quantity(reaction.force, "N", DIGITS);
        let moment = quantity(reaction.moment, "N m", DIGITS);
        row(name, format!("{force}, moment {moment}"));
    }
    row("bending energy", quantity(r.bending_energy, "J", DIGITS));
    let error = significant(r.equilibrium_error, 2);
    row("out of balance", format!("{error} of the largest force"));
    row("uniqueness", uniqueness(&report.uniqueness));
    if let Some(estimate) = report.error_estimate {
        row("error of bending", format!("about {} of the largest", significant(estimate, 2)));
        row(
            "",
            match report.error_bound {
                Some(bound) => format!(
                    "guaranteed: at most {} in the energy norm, of the mesh's cubics",
                    significant(bound, 3)
                ),
                None => "not guaranteed: theory gives no bound here".into(),
            },
        );
    }
    if let Some(adaptive) = &report.adaptive {
        let asked = significant(adaptive.tolerance, 3);
        row(
            "mesh",
            format!(
                "made for an error of {asked} in {}: {}",
                counted(adaptive.passes, "pass"),
                adaptive.meaning
            ),
        );
    }
    rows
}

fn uniqueness(uniqueness: &Uniqueness) -> String {
    let margins = [("bending", uniqueness.margin_bending), ("electric", uniqueness.margin_electric)];
    let margins: Vec<_> = margins
        .iter()
        .filter_map(|(name, margin)| Some((name, (*margin)?)))
        .map(|(name, margin)| {
            let verb = if margin > 1.0 { "holds" } else { "fails" };
            format!("{name} {verb}, {} times what is needed", significant(margin, 4))
        })
        .collect();
    let verdict = match uniqueness.certified {
        true => "certified, there is only one solution",
        false => "not certified, there may be several solutions",
    };
    match margins.is_empty() {
        true => verdict.into(),
        false => format!("{verdict} ({})", margins.join(", ")),
    }
}

fn warnings(warnings: &[String]) -> String {
    let mut out = String::new();
    for (i, warning) in warnings.iter().enumerate() {
        let _ = writeln!(out, "{}warning: {warning}", if i == 0 { "\n" } else { "" });
    }
    out
}

/// Derivatives, a row for each parameter; four digits, so that the table fits a screen.
fn sensitivities(found: &Sensitivities) -> String {
    const DIGITS: usize = 4;
    if let Some(error) = &found.error {
        return format!("\nno derivatives: {error}\n");
    }
    let place = |x: Option<f64>| x.map_or(String::new(), |x| format!("at {}", quantity(x, "m", DIGITS)));
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    let names = found.outputs.iter().map(|output| format!("{}\n{}", output.name, place(output.x)));
    table.set_header(std::iter::once("derivative of\nto".to_owned()).chain(names));
    for (i, parameter) in found.parameters.iter().enumerate() {
        let name = format!("{} {}", parameter.name, place(parameter.x)).trim_end().to_owned();
        let cells = found.outputs.iter().map(|output| {
            let unit = match parameter.unit {
                Some(per) => format!("{}/{}", output.unit, per.replace(' ', "/")),
                None => output.unit.to_owned(),
            };
            output.derivatives.get(i).map_or(String::new(), |&value| quantity(value, &unit, DIGITS))
        });
        table.add_row(std::iter::once(name).chain(cells));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let warning = found.warning.as_ref().map_or(String::new(), |warning| format!("warning: {warning}\n"));
    format!("\n{}{}\n{warning}", lines(table), found.meaning)
}

/// Names and values in two aligned columns.
fn pairs(rows: &[(String, String)]) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    for (name, value) in rows {
        table.add_row([name, value]);
    }
    lines(table)
}

/// A table as lines without the blanks that pad them on either side.
pub(super) fn lines(mut table: Table) -> String {
    if let Some(first) = table.column_mut(0) {
        first.set_padding((0, 1));
    }
    let mut out = String::new();
    for line in table.lines() {
        out += line.trim_end();
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::fixture;
    use crate::report::Method;

    fn has(text: &str, lines: &[&str]) {
        let squeezed: Vec<_> = text.lines().map(squeeze).collect();
        for line in lines {
            assert!(squeezed.iter().any(|l| l == line), "no line {line:?} in\n{text}");
        }
    }

    fn squeeze(line: &str) -> String {
        line.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn converged() {
        let text = solve(&fixture::partial());
        assert!(text.starts_with("converged in 7 iterations\n"), "{text}");
        has(
            &text,
            &[
                "100 elements, 7 iterations, 812 element visits, f64, newton, residual 3.2e-13",
                "least at x greatest at x",
                "contact zones [0, 0.3185] m (31.9 % of the length)",
                "contact force 187.039 kN",
                "left reaction -168.9 kN, moment -17.8 kN m",
                "uniqueness certified, there is only one solution (bending holds, 2.5e6 times what is needed, electric holds, 8.37 times what is needed)",
            ],
        );
        assert!(
            text.lines().any(|l| squeeze(l).starts_with("bending -63.6878 mm 0.65625 m 9.89133 mm")),
            "{text}"
        );
    }

    #[test]
    fn free_beam() {
        let text = solve(&fixture::free());
        has(&text, &["contact zones no foundation", "uniqueness certified, there is only one solution"]);
        assert!(!text.contains("potential") && !text.contains("stretching"), "{text}");
    }

    #[test]
    fn not_converged() {
        let mut picture = fixture::partial();
        picture.report.status = "iteration-limit".into();
        picture.report.reason = Some("the residual stopped falling after 50 steps".into());
        picture.report.precision = "f32".into();
        picture.report.uniqueness.certified = false;
        picture.report.uniqueness.margin_electric = Some(0.5);
        picture.report.warnings = vec!["the gap is not smooth".into(), "second".into()];
        let text = solve(&picture);
        let first = text.lines().next().unwrap();
        assert_eq!(first, "NOT CONVERGED (iteration-limit): the residual stopped falling after 50 steps");
        assert!(text.contains("--precision f64") && text.contains("--elements 200"), "{text}");
        assert!(text.ends_with("\nwarning: the gap is not smooth\nwarning: second\n"), "{text}");
        assert!(text.contains("electric fails, 0.5 times what is needed"), "{text}");
    }

    #[test]
    fn methods_of_the_paper() {
        let mut picture = fixture::partial();
        picture.report.status = "foundation_pulls".into();
        picture.report.reason = Some("the foundation pulls".into());
        picture.report.method = Method {
            name: "elementwise",
            own_residual: Some(0.0),
            lowest_pressure: Some(-8.25e9),
            highest_pressure: Some(5.6e9),
        };
        let text = solve(&picture);
        assert!(text.contains("what elementwise found, not a solution: its own residual is 0"), "{text}");
        assert!(text.contains("from -8.25 GN/m to 5.6 GN/m.\nTry --method newton"), "{text}");
    }

    #[test]
    fn zeros_and_bad_numbers() {
        let mut picture = fixture::zero();
        has(&solve(&picture), &["bending 0 m everywhere 0 m everywhere", "contact zones none"]);
        picture.report.samples.bending = Some(vec![f64::NAN; picture.report.samples.x.len()]);
        has(&solve(&picture), &["bending no finite value"]);
    }

    #[test]
    fn derivatives() {
        let mut picture = fixture::partial();
        let mut found = fixture::sensitivities();
        picture.report.sensitivities = Some(found.clone());
        let text = solve(&picture);
        has(
            &text,
            &[
                "derivative of bending contact force",
                "to at 0.5 m",
                "beam.bending 62.4 mm -1.234 kN",
                "load.points.force at 0.3 m -1.25 µm/N 0.5 N/N",
            ],
        );
        assert!(text.ends_with("\nwhat a number means\nwarning: the beam only touches\n"), "{text}");
        found.error = Some("solve first".into());
        picture.report.sensitivities = Some(found);
        assert!(solve(&picture).ends_with("\nno derivatives: solve first\n"));
    }

    #[test]
    fn check_and_time() {
        let picture = fixture::partial();
        let checked = Checked {
            title: picture.title.clone(),
            facts: picture.facts.clone(),
            warnings: vec!["w".into()],
            uniqueness: picture.report.uniqueness.clone(),
        };
        let text = check(&checked);
        assert!(text.starts_with("the scene is sound\n") && text.ends_with("warning: w\n"), "{text}");
        has(&text, &["foundation stiffness 100 MN/m²"]);
        let text = time(&fixture::timing());
        assert!(text.starts_with("90 µs per solve (median of 3, f64)\n"), "{text}");
        has(&text, &["per element visit 200 ns", "memory 400 bytes per element"]);
    }
}
