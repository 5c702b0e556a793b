//! The paper's Figs. 1 to 4 as separate SVG files: bending, stretching, deformed beam, potential.

use plotters::prelude::*;

use super::chart::{Area, BAND, BLUE, Drawn, FAINT, FINE, Frame, VERMILLION, curve, padded, page};
use super::{Scale, beam, fields, overview};
use crate::report::Picture;

const WIDTH: i32 = 760;
const HEIGHT: i32 = 440;

/// A picture of the beam's axis has at most this many points; it may fold back, so they are taken evenly.
const POINTS: usize = 1000;

/// File names and contents, in the paper's order; a figure whose field the scene does not have is left out.
pub fn all(picture: &Picture) -> Vec<(&'static str, String)> {
    let figures = [
        ("fig1-bending.svg", Some(bending(picture))),
        ("fig2-stretching.svg", field(picture, "stretching", "Stretching of a beam")),
        ("fig3-deformed.svg", Some(deformed(picture))),
        ("fig4-potential.svg", field(picture, "potential", "Electric potential of a beam")),
    ];
    figures.into_iter().filter_map(|(name, svg)| Some((name, svg?))).collect()
}

/// Fig. 1: the bent axis above the foundation.
pub fn bending(picture: &Picture) -> String {
    page("Bending of a beam", WIDTH, HEIGHT, |root| beam::panel(root, picture))
}

/// Figs. 2 and 4: one field over x.
fn field(picture: &Picture, name: &str, title: &'static str) -> Option<String> {
    let fields = fields(&picture.report.samples);
    let field = fields.iter().find(|f| f.name == name && f.values.is_some())?;
    let pressed = picture.report.contact.as_ref().is_some_and(|c| !c.zones.is_empty());
    let note = if pressed { "Shaded: the beam presses the foundation." } else { "" };
    Some(page(title, WIDTH, HEIGHT, |root| overview::panel(root, picture, field, note)))
}

/// Fig. 3: the points (x + u, -xi), as a band around the deformed axis.
pub fn deformed(picture: &Picture) -> String {
    page("Deformed beam", WIDTH, HEIGHT, |root| draw_deformed(root, picture))
}

fn draw_deformed(root: &Area, picture: &Picture) -> Drawn {
    let samples = &picture.report.samples;
    let n = samples.x.len();
    let at =
        |values: &Option<Vec<f64>>, i: usize| values.as_ref().and_then(|v| v.get(i)).copied().unwrap_or(0.0);
    let places: Vec<(f64, f64)> =
        (0..n).map(|i| (samples.x[i] + at(&samples.stretching, i), -at(&samples.bending, i))).collect();

    let (along, _) = beam::x_axis(picture);
    let across = Scale::of(places.iter().map(|p| p.1), "m");
    let scaled = |p: (f64, f64)| (p.0 * along.factor, p.1 * across.factor);
    let points: Vec<_> = places.iter().copied().map(scaled).collect();
    let length = picture.length * along.factor;
    let x = padded(points.iter().map(|p| p.0).chain([0.0, length]), 0.05, 0.05);
    let y = padded(points.iter().map(|p| p.1).chain([0.0]), 0.2, 0.2);

    let folded = places.windows(2).any(|p| p[1].0 < p[0].0);
    let title = format!("Deformed beam, height −ξ [{}] over x + u", across.unit);
    let x_label = format!(
        "x + u [{}]; dots: each eighth of the beam, joined to its place at rest; thickness not to scale",
        along.unit
    );
    let mut frame = Frame {
        title: &title,
        note: String::new(),
        colour: Some(BLUE),
        x,
        y,
        x_label: &x_label,
        downwards: false,
        logarithmic: false,
    };
    let scales = frame.magnified(root, &along, &across);
    frame.note = match folded {
        true => {
            format!("Stretched until it folds back on itself, outside the model's small strains. {scales}")
        }
        false => scales,
    };
    let mut chart = frame.draw(root)?;
    let thin = FAINT.stroke_width(FINE as u32);
    let rest = [(0.0, 0.0), (length, 0.0)];
    chart.draw_series(DashedLineSeries::new(rest, 6 * FINE as u32, 5 * FINE as u32, thin))?;

    let step = n.div_ceil(POINTS).max(1);
    let last = points.last().copied();
    let even: Vec<_> = points.iter().copied().step_by(step).chain(last).collect();
    curve(&mut chart, &even, BAND, 12)?;
    let eighths: Vec<_> = (0..=8)
        .map(|eighth| eighth * n.saturating_sub(1) / 8)
        .filter_map(|i| Some(((samples.x.get(i)? * along.factor, 0.0), *points.get(i)?)))
        .filter(|(_, to)| to.0.is_finite() && to.1.is_finite())
        .collect();
    for &(from, to) in &eighths {
        chart.draw_series([PathElement::new([from, to], thin)])?;
    }
    curve(&mut chart, &even, BLUE, 2)?;
    for (_, to) in eighths {
        chart.draw_series([Circle::new(to, 4 * FINE, VERMILLION.filled())])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::fixture;

    fn text(svg: &str) -> String {
        let xml = roxmltree::Document::parse(svg).unwrap();
        let text = xml.descendants().filter(|n| n.has_tag_name("text"));
        text.filter_map(|n| n.text()).collect()
    }

    #[test]
    fn four_figures() {
        let figures = all(&fixture::partial());
        let names: Vec<_> = figures.iter().map(|f| f.0).collect();
        assert_eq!(
            names,
            ["fig1-bending.svg", "fig2-stretching.svg", "fig3-deformed.svg", "fig4-potential.svg"]
        );
        let wanted = [
            ["Bending ξ [mm]", "foundation"],
            ["Stretching u [m]", "1.136"],
            ["Deformed beam, height −ξ [mm]", "folds back on itself"],
            ["Potential q [V]", "−112.6"],
        ];
        for ((name, svg), labels) in figures.iter().zip(wanted) {
            for label in labels {
                assert!(text(svg).contains(label), "no {label:?} in {name}");
            }
        }
    }

    #[test]
    fn absent_fields_have_no_figure() {
        assert_eq!(all(&fixture::free()).len(), 2);
        assert!(!text(&deformed(&fixture::free())).contains("folds"));
    }

    #[test]
    fn hard_data() {
        for picture in [fixture::zero(), fixture::mems()] {
            for (_, svg) in all(&picture) {
                assert!(!text(&svg).contains("NaN"));
            }
        }
        let mut picture = fixture::partial();
        picture.report.samples.stretching.as_mut().unwrap()[3] = f64::NAN;
        picture.report.samples.bending.as_mut().unwrap()[5] = f64::INFINITY;
        assert_eq!(all(&picture).len(), 4);
    }
}
