//! One page to show a colleague: the beam, moment and shear, the electric fields where there are any, the numbers.

use plotters::prelude::*;

use super::chart::{
    Area, BLUE, Drawn, FAINT, FINE, Frame, GREEN, INK, ORANGE, PURPLE, VERMILLION, curve, heading, mark,
    padded, page, shortened, typeset, words, wrapped,
};
use super::{Field, Scale, beam, counted, extremes, fields, quantity, significant, telling, text, zones};
use crate::report::{Picture, Report};

const WIDTH: i32 = 960;
const HEAD: i32 = 42;
const KEYS: i32 = 58;
const BEAM: i32 = 360;
const ROW: i32 = 220;
const LINE: i32 = 20;
/// Characters of a line over the whole page.
const WORDS: usize = 118;
/// Warnings shown.
const WARNINGS: usize = 4;

/// The page as SVG.
pub fn solve(picture: &Picture) -> String {
    let fields = fields(&picture.report.samples);
    let drawn: Vec<_> = ["moment", "shear", "stretching", "potential"]
        .iter()
        .filter_map(|name| fields.iter().find(|f| f.name == *name && f.values.is_some()))
        .collect();
    let rows = drawn.chunks(2);
    let (left, right) = (numbers(picture), facts(picture));
    let warnings: Vec<String> = (picture.report.warnings.iter().take(WARNINGS))
        .flat_map(|warning| wrapped(&format!("warning: {warning}"), WORDS))
        .collect();
    let (said, colour) = verdict(&picture.report);
    let said = wrapped(&said, WORDS);
    let head = HEAD + LINE * said.len() as i32;
    let foot = 44 + LINE * (left.len().max(right.len()) + warnings.len()) as i32 + 16;
    let below = head + KEYS + BEAM + ROW * rows.len() as i32;

    page("Equilibrium of a piezoelectric beam", WIDTH, below + foot, |root| {
        let (top, rest) = root.split_vertically(head * FINE);
        heading(&top, &shortened(&picture.title, 80), (14, 12), 20, INK)?;
        for (i, line) in said.iter().enumerate() {
            words(&top, line, (14, HEAD + LINE * i as i32), 14, colour)?;
        }
        let (top, rest) = rest.split_vertically(KEYS * FINE);
        for (area, (name, value)) in top.split_evenly((1, 3)).iter().zip(keys(picture)) {
            words(area, &shortened(&name, 48), (14, 8), 12, FAINT)?;
            heading(area, &typeset(&shortened(&value, 34)), (14, 26), 16, INK)?;
        }
        let (top, rest) = rest.split_vertically(BEAM * FINE);
        beam::panel(&top, picture)?;
        let mut rest = rest;
        for row in rows {
            let (here, next) = rest.split_vertically(ROW * FINE);
            for (area, field) in here.split_evenly((1, row.len())).iter().zip(row) {
                panel(area, picture, field, "")?;
            }
            rest = next;
        }
        columns(&rest, &left, &right)?;
        let y = 44 + LINE * left.len().max(right.len()) as i32;
        for (i, line) in warnings.iter().enumerate() {
            words(&rest, line, (14, y + LINE * i as i32), 13, VERMILLION)?;
        }
        Ok(())
    })
}

fn verdict(report: &Report) -> (String, RGBColor) {
    if report.converged() {
        let work = [(report.iterations, "iteration"), (report.elements, "element")]
            .map(|(n, what)| counted(n, what));
        let text = format!(
            "converged, {}, residual {}{}",
            work.join(", "),
            significant(report.residual, 2),
            errors(report)
        );
        return (typeset(&text), FAINT);
    }
    let reason = report.reason.as_deref().unwrap_or("no reason was recorded");
    let shown = match report.method.own_residual {
        Some(_) => format!("what the method {} found is shown", report.method.name),
        None => "best iterate shown".into(),
    };
    (format!("NOT CONVERGED, {shown}: {reason}"), VERMILLION)
}

/// One field over x: its curve, contact zones behind it, its extremes marked where they are not zero; `note` under its title.
pub fn panel(area: &Area, picture: &Picture, field: &Field, note: &str) -> Drawn {
    let x = &picture.report.samples.x;
    let values = field.values.unwrap_or(&[]);
    let (along, x_label) = beam::x_axis(picture);
    let scale = Scale::of(values.iter().copied(), field.unit);
    let points: Vec<_> = x.iter().zip(values).map(|(x, v)| (x * along.factor, v * scale.factor)).collect();
    let colour = match field.name {
        "moment" => GREEN,
        "shear" => PURPLE,
        "stretching" => VERMILLION,
        _ => BLUE,
    };
    let mut name = field.name.to_owned();
    name[..1].make_ascii_uppercase();
    let title = format!("{name} {} [{}]", field.symbol, scale.unit);
    let y = padded(points.iter().map(|p| p.1), 0.22, 0.22);
    let length = picture.length * along.factor;
    let frame = Frame {
        title: &title,
        note: note.into(),
        colour: Some(colour),
        x: 0.0..length,
        y: y.clone(),
        x_label: &x_label,
        downwards: false,
        logarithmic: false,
    };
    let mut chart = frame.draw(area)?;
    for [a, b] in picture.report.contact.iter().flat_map(|c| &c.zones) {
        let corners = [(a * along.factor, y.start), (b * along.factor, y.end)];
        chart.draw_series([Rectangle::new(corners, ORANGE.mix(0.13).filled())])?;
    }
    if y.contains(&0.0) {
        let zero = [(0.0, 0.0), (length, 0.0)];
        chart.draw_series([PathElement::new(zero, FAINT.stroke_width(FINE as u32))])?;
    }
    curve(&mut chart, &points, colour, 2)?;
    if !values.is_empty() && values.iter().all(|&v| v == 0.0) {
        mark(&mut chart, (0.5 * length, 0.0), "zero everywhere", false, colour)?;
    }
    for ((x, v), below) in telling(x, values) {
        let text = significant(v * scale.factor, 4);
        let at = (x * along.factor, v * scale.factor);
        mark(&mut chart, at, &text, below, colour)?;
    }
    Ok(())
}

/// How wrong the bending may be, where that is known.
fn errors(report: &Report) -> String {
    let Some(estimate) = report.error_estimate else { return String::new() };
    let bound = report
        .error_bound
        .map_or(", no bound".into(), |bound| format!(", bound {} in the energy norm", significant(bound, 2)));
    format!("; error about {}{bound}", significant(estimate, 2))
}

/// The numbers that matter: the largest deflection and where, contact.
fn keys(picture: &Picture) -> Vec<(String, String)> {
    let samples = &picture.report.samples;
    let mut rows = Vec::new();
    let bending = samples.bending.as_deref().unwrap_or(&[]);
    if let Some((least, greatest)) = extremes(&samples.x, bending) {
        let (x, most) = if -least.1 > greatest.1 { least } else { greatest };
        let value = match most == 0.0 {
            true => "0 m".into(),
            false => format!("{} at x = {}", quantity(most, "m", 5), quantity(x, "m", 5)),
        };
        rows.push(("Largest deflection".to_owned(), value));
    }
    let Some(contact) = &picture.report.contact else {
        rows.push(("Contact".into(), "no foundation".into()));
        return rows;
    };
    rows.push(("Contact force".into(), quantity(contact.force, "N", 6)));
    let pressed: f64 = contact.zones.iter().map(|[a, b]| b - a).sum();
    let share = significant(100.0 * pressed / picture.length, 3);
    rows.push((format!("In contact, {share} % of the length"), zones(&contact.zones, picture.length, 4, 2)));
    rows
}

/// The rest of the text report's numbers.
fn numbers(picture: &Picture) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    for (name, value) in text::results(picture) {
        let value = match (name.as_str(), &picture.report.contact) {
            // These are at the top.
            ("contact force" | "error of bending" | "", _) | ("contact zones", None) => continue,
            ("contact zones", Some(contact)) if contact.zones.len() < 3 => continue,
            ("contact zones", Some(contact)) => zones(&contact.zones, picture.length, 3, 5),
            ("uniqueness", _) => match picture.report.uniqueness.certified {
                true => "certified: one solution only".into(),
                false => "not certified: there may be several".into(),
            },
            _ => value,
        };
        rows.push((name, value));
    }
    rows
}

fn facts(picture: &Picture) -> Vec<(String, String)> {
    const MOST: usize = 14;
    let mut rows: Vec<_> = picture.facts.iter().take(MOST).cloned().collect();
    if picture.facts.len() > MOST {
        rows.push((format!("and {} more", picture.facts.len() - MOST), String::new()));
    }
    rows
}

fn columns(area: &Area, left: &[(String, String)], right: &[(String, String)]) -> Drawn {
    for (x, name, rows) in [(14, "Result", left), (WIDTH / 2 + 14, "Scene", right)] {
        if rows.is_empty() {
            continue;
        }
        heading(area, name, (x, 12), 14, INK)?;
        for (i, (name, value)) in rows.iter().enumerate() {
            let y = 38 + LINE * i as i32;
            words(area, &shortened(name, 21), (x, y), 13, FAINT)?;
            if !value.is_empty() {
                words(area, &shortened(&typeset(value), 42), (x + 165, y), 13, INK)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::fixture;

    /// All text of the page; parsing also shows that it is well-formed.
    fn labels(picture: &Picture) -> Vec<String> {
        let svg = solve(picture);
        let xml = roxmltree::Document::parse(&svg).unwrap();
        let text = xml.descendants().filter(|n| n.has_tag_name("text"));
        text.filter_map(|n| n.text()).map(|t| t.trim().to_owned()).collect()
    }

    fn has(picture: &Picture, wanted: &[&str]) {
        let labels = labels(picture);
        for label in wanted {
            assert!(labels.iter().any(|l| l == label), "no {label:?} in {labels:#?}");
        }
    }

    #[test]
    fn all_panels() {
        let picture = fixture::partial();
        has(
            &picture,
            &[
                "half pushed, half pulled",
                "converged, 7 iterations, 100 elements, residual 3.2e−13; error about 1.2e−8, bound 0.00029 in the energy norm",
                "Largest deflection",
                "Contact force",
                "In contact, 31.9 % of the length",
                "bending stiffness",
                "Bending ξ [mm], positive downwards",
                "Moment C ξ″ [kN m]",
                "Shear (C ξ″)′ [kN]",
                "Stretching u [m]",
                "Potential q [V]",
                "x [m]",
                "foundation",
                "−112.6",
                "187.039 kN",
                "[0, 0.3185] m",
            ],
        );
    }

    #[test]
    fn a_scene_without_fields_has_no_empty_panels() {
        let picture = fixture::free();
        let labels = labels(&picture);
        assert!(labels.iter().any(|l| l == "no foundation"));
        assert!(!labels.iter().any(|l| l.starts_with("Potential") || l == "foundation"));
        let height = |p| {
            roxmltree::Document::parse(&solve(p))
                .unwrap()
                .root_element()
                .attribute("height")
                .unwrap()
                .parse::<i32>()
                .unwrap()
        };
        assert!(height(&picture) < height(&fixture::partial()));
    }

    #[test]
    fn micrometres_and_markup() {
        // All of a long verdict, and of a long warning, is there.
        let mut picture = fixture::partial();
        picture.report.status = "foundation_pulls".into();
        picture.report.reason = Some("word ".repeat(60) + "end");
        picture.report.method =
            crate::report::Method { name: "gauss", own_residual: Some(0.0), ..Default::default() };
        picture.report.warnings = vec!["slope ".repeat(40) + "last"];
        let labels = labels(&picture).join(" ");
        assert!(labels.contains("what the method gauss found is shown: word"), "{labels}");
        assert!(labels.contains("word end") && labels.contains("slope last"), "{labels}");
        has(
            &fixture::mems(),
            &[
                "microbridge <Si & \"ZnO\">",
                "x [µm]",
                "Bending ξ [µm], positive downwards",
                "[116.3, 383.6] µm",
            ],
        );
    }

    #[test]
    fn hard_data() {
        let mut picture = fixture::zero();
        assert!(!solve(&picture).contains("NaN"));
        picture.report.status = "diverged".into();
        picture.report.reason = Some("a number was not finite".into());
        picture.report.warnings = vec!["w".into()];
        let n = picture.report.samples.x.len();
        for bad in [f64::NAN, f64::INFINITY, 1e300, 1e-300] {
            picture.report.samples.bending = Some(vec![bad; n]);
            picture.report.samples.moment = Some((0..n).map(|i| bad * (i % 3) as f64).collect());
            has(&picture, &["NOT CONVERGED, best iterate shown: a number was not finite", "warning: w"]);
        }
        picture.gap = Some(vec![1.0; n]);
        solve(&picture);
    }
}
