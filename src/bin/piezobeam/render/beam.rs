//! The beam above its foundation: the bent axis, the surface below it, contact zones and clamps.
//!
//! Bending is positive towards the foundation, which is drawn below: ordinates are -xi, and the axis counts downwards.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::chart::{
    Area, BLUE, Chart, Drawn, FAINT, FINE, Frame, GROUND, INK, ORANGE, SURFACE, WALL, curve, mark, padded,
    style, thinned,
};
use super::{Scale, telling};
use crate::report::Picture;

/// Width of a wall relative to the length of the beam.
const WIDE: f64 = 0.045;

/// Foundation drawn at most this many times deeper than the beam bends, or the beam would look straight.
const DEEPEST: f64 = 2.5;

/// The x axis of every picture of `picture`: its scale, and the label.
pub fn x_axis(picture: &Picture) -> (Scale, String) {
    let scale = Scale::axis(picture.length, "m");
    let label = format!("x [{}]", scale.unit);
    (scale, label)
}

/// Draws the panel into `area`.
pub fn panel(area: &Area, picture: &Picture) -> Drawn {
    let samples = &picture.report.samples;
    let (along, x_label) = x_axis(picture);
    let bending = samples.bending.as_deref().unwrap_or(&[]);
    let greatest = bending.iter().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
    let depth = if greatest > 0.0 { DEEPEST * greatest } else { f64::INFINITY };
    let gap: Option<Vec<f64>> = picture.gap.as_ref().map(|gap| gap.iter().map(|s| s.min(depth)).collect());
    let cut = picture.gap.as_ref().is_some_and(|gap| gap.iter().any(|&s| s > depth));

    let ground = gap.as_deref().unwrap_or(&[]);
    let across = Scale::of(bending.iter().chain(ground).copied(), "m");
    let shown = |values: &[f64]| -> Vec<(f64, f64)> {
        let x = samples.x.iter().map(|x| x * along.factor);
        x.zip(values.iter().map(|v| -v * across.factor)).collect()
    };
    let (axis, surface) = (shown(bending), gap.as_deref().map(shown));

    let heights = axis.iter().chain(surface.iter().flatten()).map(|p| p.1).chain([0.0]);
    let below = match (cut, gap.is_some()) {
        (true, _) => 0.0, // where the surface is cut it runs along the lower edge, not as a floor above it
        (false, true) => 0.32,
        (false, false) => 0.2,
    };
    let y = padded(heights, below, 0.22);
    let length = picture.length * along.factor;
    let title = format!("Bending ξ [{}], positive downwards", across.unit);
    let mut frame = Frame {
        title: &title,
        note: String::new(),
        colour: Some(BLUE),
        x: -WIDE * length..(1.0 + WIDE) * length,
        y: y.clone(),
        x_label: &x_label,
        downwards: true,
        logarithmic: false,
    };
    let scales = frame.magnified(area, &along, &across);
    frame.note = match (gap.is_some(), cut) {
        (_, true) => format!("The foundation lies below the lower edge in places. {scales}"),
        (true, false) => {
            format!("Orange: the beam presses the foundation. Dashed: the beam at rest. {scales}")
        }
        (false, false) => format!("No foundation. Dashed: the beam at rest. {scales}"),
    };
    let mut chart = frame.draw(area)?;

    if let Some(surface) = &surface {
        foundation(&mut chart, &axis, surface, y.start)?;
        zones(&mut chart, picture, along.factor, (y.start, y.end))?;
    }
    let rest = [(0.0, 0.0), (length, 0.0)];
    let dash = FAINT.stroke_width(FINE as u32);
    chart.draw_series(DashedLineSeries::new(rest, 6 * FINE as u32, 5 * FINE as u32, dash))?;
    curve(&mut chart, &axis, BLUE, 3)?;
    walls(&chart)?;
    labels(&mut chart, picture, &along, &across)?;
    if let Some(surface) = &surface {
        name_foundation(&mut chart, surface, &axis, y.start)?;
    }
    Ok(())
}

/// The ground below the surface, and in orange what the beam takes of it.
fn foundation(chart: &mut Chart, axis: &[(f64, f64)], surface: &[(f64, f64)], bottom: f64) -> Drawn {
    let (Some(first), Some(last)) = (surface.first(), surface.last()) else {
        return Ok(());
    };
    let mut ground = thinned(surface);
    let top = ground.clone();
    ground.extend([(last.0, bottom), (first.0, bottom)]);
    chart.draw_series([Polygon::new(ground, GROUND.filled())])?;
    curve(chart, &top, SURFACE, 2)?;
    let lower = |(a, s): (&(f64, f64), &(f64, f64))| (s.0, if a.1 < s.1 { a.1 } else { s.1 });
    let pressed: Vec<_> = axis.iter().zip(surface).map(lower).collect();
    let mut taken = thinned(&pressed);
    taken.extend(top.into_iter().rev());
    chart.draw_series([Polygon::new(taken, ORANGE.mix(0.75).filled())])?;
    Ok(())
}

/// A light band over each contact zone and a bar at the top, where even a narrow zone can be seen.
fn zones(chart: &mut Chart, picture: &Picture, factor: f64, (bottom, top): (f64, f64)) -> Drawn {
    let zones = picture.report.contact.iter().flat_map(|c| &c.zones);
    let bar = top - 0.02 * (top - bottom);
    for [a, b] in zones.clone().map(|z| z.map(|end| end * factor)) {
        chart.draw_series([
            Rectangle::new([(a, bottom), (b, top)], ORANGE.mix(0.13).filled()),
            Rectangle::new([(a, bar), (b, top)], ORANGE.filled()),
        ])?;
    }
    let width = |z: &&[f64; 2]| z[1] - z[0];
    let widest = zones.max_by(|a, b| width(a).total_cmp(&width(b)));
    if let Some(zone) = widest.filter(|z| width(z) > 0.1 * picture.length) {
        let middle = 0.5 * (zone[0] + zone[1]) * factor;
        let label = style(12, FAINT, HPos::Center, VPos::Top);
        let text = Text::new("contact", (0, 4 * FINE), label);
        chart.draw_series([EmptyElement::at((middle, bar)) + text])?;
    }
    Ok(())
}

/// Hatched walls over the full height at both ends.
pub fn walls(chart: &Chart) -> Drawn {
    let area = chart.plotting_area().strip_coord_spec();
    let (width, height) = area.dim_in_pixel();
    let (width, height) = (width as i32, height as i32);
    let wall = (f64::from(width) * WIDE / (1.0 + 2.0 * WIDE)).round() as i32;
    for (from, edge) in [(0, wall), (width - wall, width - wall)] {
        let box_ = [(from, 0), (from + wall, height)];
        area.draw(&Rectangle::new(box_, WALL.filled()))?;
        for c in (0..height + wall).step_by(8 * FINE as usize) {
            // The line x + y = c, cut to the box.
            let (start, end) = ((c - height).max(0), c.min(wall));
            let line = [(from + start, c - start), (from + end, c - end)];
            area.draw(&PathElement::new(line, FAINT.stroke_width(FINE as u32)))?;
        }
        let face = [(edge, 0), (edge, height)];
        area.draw(&PathElement::new(face, INK.stroke_width(2 * FINE as u32)))?;
    }
    Ok(())
}

/// The deepest and the highest point of the axis, where the beam leaves its rest.
fn labels(chart: &mut Chart, picture: &Picture, along: &Scale, across: &Scale) -> Drawn {
    let samples = &picture.report.samples;
    let bending = samples.bending.as_deref().unwrap_or(&[]);
    for ((x, value), upwards) in telling(&samples.x, bending) {
        let (size, place) = (across.show(value, 4), along.show(x, 4));
        let at = (x * along.factor, -value * across.factor);
        // The axis counts downwards: the greatest value is the lowest point, and its label belongs below.
        mark(chart, at, &format!("beam axis {size} at x = {place}"), !upwards, BLUE)?;
    }
    Ok(())
}

/// The foundation's name, low in the ground: where there is more ground, else away from the beam's deepest point.
fn name_foundation(chart: &mut Chart, surface: &[(f64, f64)], axis: &[(f64, f64)], bottom: f64) -> Drawn {
    let (Some(first), Some(last)) = (surface.first(), surface.last()) else {
        return Ok(());
    };
    let deepest = axis.iter().filter(|p| p.1.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1));
    let right = match last.1 == first.1 {
        true => deepest.is_none_or(|p| p.0 < 0.5 * (first.0 + last.0)),
        false => last.1 > first.1,
    };
    let (x, h, dx) = match right {
        true => (last.0, HPos::Right, -8),
        false => (first.0, HPos::Left, 8),
    };
    let text = Text::new("foundation", (dx * FINE, -4 * FINE), style(12, SURFACE, h, VPos::Bottom));
    chart.draw_series([EmptyElement::at((x, bottom)) + text])?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::render::{figures, fixture};

    fn shown(picture: &super::Picture) -> Vec<String> {
        let svg = figures::bending(picture);
        let xml = roxmltree::Document::parse(&svg).unwrap();
        let text = xml.descendants().filter(|n| n.has_tag_name("text"));
        text.filter_map(|n| n.text()).map(|t| t.trim().to_owned()).collect()
    }

    #[test]
    fn labels() {
        let labels = shown(&fixture::partial());
        for label in ["beam axis −63.69 mm at x = 0.6562 m", "contact", "foundation", "0", "−60"] {
            assert!(labels.iter().any(|l| l == label), "no {label:?} in {labels:?}");
        }
    }

    #[test]
    fn a_far_foundation_does_not_flatten_the_beam() {
        let mut picture = fixture::partial();
        picture.gap = Some(vec![10.0; picture.report.samples.x.len()]);
        picture.report.contact.as_mut().unwrap().zones.clear();
        let labels = shown(&picture);
        assert!(labels.iter().any(|l| l.contains("below the lower edge")), "{labels:?}");
        assert!(!labels.iter().any(|l| l == "contact"));
    }
}
