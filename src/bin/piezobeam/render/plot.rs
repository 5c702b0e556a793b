//! Curves over linear or logarithmic axes, each named beside its end, and the same numbers as CSV.
//!
//! Narrow enough to be read on a telephone. A curve is told from the others by its name, its mark and its colour.

use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::chart::{
    Area, BLUE, Drawn, FAINT, FINE, GREEN, GRID, INK, ORANGE, PURPLE, SKY, VERMILLION, heading, part,
    power_of_ten, scientific, style, typeset, words,
};
use super::{Scale, significant};

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub curves: Vec<Curve>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it measures, with nothing of units: those are `unit`.
    pub label: String,
    /// SI; empty for plain numbers.
    pub unit: &'static str,
    /// Its column in CSV.
    pub key: &'static str,
    pub logarithmic: bool,
    /// Smaller values are drawn there.
    pub floor: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub name: String,
    /// Which colour and mark; see [`LOOKS`].
    pub look: usize,
    pub points: Vec<Point>,
    /// Points are measurements, each with a mark; else only their line is drawn.
    pub marks: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Point {
    pub x: f64,
    pub y: f64,
    /// How far x was above the value given, at most three times in four; 0 where it is not measured.
    pub spread: f64,
    /// How the solve ended; hollow where it is not worth its name.
    pub status: &'static str,
    pub hollow: bool,
}

/// Colours of curves; with the marks circle, square, triangle, diamond, cross in turn.
const LOOKS: [RGBColor; 7] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, INK];

const WIDTH: i32 = 420;
const HEIGHT: i32 = 316;
const LEFT: i32 = 48;
const TOP: i32 = 52;
const BOTTOM: i32 = 44;
/// Between a curve's end and its name.
const LEAD: i32 = 20;
/// Between two names.
const LINE: i32 = 16;
/// Pixels of a letter, on average, at size 12.
const LETTER: f64 = 6.3;

impl Axis {
    pub fn linear(label: impl Into<String>, unit: &'static str, key: &'static str) -> Self {
        Self { label: label.into(), unit, key, logarithmic: false, floor: f64::NEG_INFINITY }
    }

    pub fn logarithmic(label: impl Into<String>, unit: &'static str, key: &'static str) -> Self {
        Self { logarithmic: true, ..Self::linear(label, unit, key) }
    }

    /// Relative errors, down to the rounding of double precision.
    pub fn error(label: impl Into<String>) -> Self {
        Self { floor: 1e-16, ..Self::logarithmic(label, "", "error") }
    }

    fn name(&self, scale: &Scale) -> String {
        match (self.unit, self.logarithmic) {
            ("", _) => self.label.clone(),
            // Ticks carry prefixes.
            ("s", true) => self.label.clone(),
            (unit, true) => typeset(&format!("{} [{unit}]", self.label)),
            (_, false) => typeset(&format!("{} [{}]", self.label, scale.unit)),
        }
    }
}

impl Curve {
    pub fn new(name: impl Into<String>, look: usize, points: Vec<Point>) -> Self {
        Self { name: name.into(), look, points, marks: true }
    }

    /// A line through many points.
    pub fn line(name: impl Into<String>, look: usize, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let points = points.into_iter().map(|(x, y)| Point::at(x, y)).collect();
        Self { marks: false, ..Self::new(name, look, points) }
    }
}

impl Point {
    pub fn at(x: f64, y: f64) -> Self {
        Self { x, y, ..Self::default() }
    }
}

impl Plot {
    /// Is there a curve, and are there numbers in each?
    pub fn has_data(&self) -> bool {
        let there = |curve: &Curve| curve.points.iter().any(|p| p.x.is_finite() && p.y.is_finite());
        !self.curves.is_empty() && self.curves.iter().all(there)
    }

    /// A row for each point.
    pub fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let wrote = |writer: &mut csv::Writer<Vec<u8>>| -> csv::Result<()> {
            writer.write_record(["curve", self.x.key, self.y.key, "spread", "status"])?;
            for curve in &self.curves {
                for p in &curve.points {
                    writer.serialize((&curve.name, p.x, p.y, p.spread, p.status))?;
                }
            }
            Ok(())
        };
        wrote(&mut writer).expect("names and numbers go into memory as CSV");
        String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
    }

    /// The picture, as a part of a page.
    pub fn svg(&self) -> String {
        part(&self.title, WIDTH, HEIGHT, |area| self.draw(area))
    }

    fn draw(&self, area: &Area) -> Drawn {
        let longest = self.curves.iter().map(|curve| curve.name.chars().count()).max().unwrap_or(0);
        let right = LEAD + (longest as f64 * LETTER) as i32 + 8;
        let x = Range::of(self.curves.iter().flat_map(|c| &c.points).map(|p| p.x), &self.x);
        let y = Range::of(self.curves.iter().flat_map(|c| &c.points).map(|p| p.y), &self.y);
        let frame = Frame { x, y, right: WIDTH - right, bottom: HEIGHT - BOTTOM };
        heading(area, &scientific(&self.title), (12, 8), 14, INK)?;
        words(area, &self.y.name(&frame.y.scale), (12, 29), 12, FAINT)?;
        frame.grid(area, self)?;
        for curve in &self.curves {
            frame.curve(area, curve)?;
        }
        frame.names(area, &self.curves)
    }
}

/// An axis's ends, in units or in decades, and its ticks.
struct Range {
    low: f64,
    high: f64,
    floor: f64,
    scale: Scale,
    logarithmic: bool,
    ticks: Vec<(f64, String)>,
}

impl Range {
    fn of(values: impl Iterator<Item = f64>, axis: &Axis) -> Self {
        let above = values.filter(|v| v.is_finite()).map(|v| v.max(axis.floor));
        let shown = above.filter(|v| !axis.logarithmic || *v > 0.0);
        let (mut low, mut high) =
            shown.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        if low > high {
            (low, high) = (1.0, 1.0);
        }
        if axis.logarithmic {
            return Self { floor: axis.floor, ..Self::decades(low.log10(), high.log10(), axis.unit) };
        }
        let scale = Scale::axis(low.abs().max(high.abs()), axis.unit);
        (low, high) = (low * scale.factor, high * scale.factor);
        if high - low <= 1e-12 * high.abs() {
            (low, high) = (low - 1.0, high + 1.0);
        }
        let step = nice((high - low) / 5.0);
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let ticks = (first as i64..=last as i64).map(|i| i as f64 * step);
        let ticks = ticks.map(|v| (v, typeset(&significant(v, 4)))).collect();
        let margin = 0.04 * (high - low);
        Self { low: low - margin, high: high + margin, floor: axis.floor, scale, logarithmic: false, ticks }
    }

    fn decades(low: f64, high: f64, unit: &str) -> Self {
        let (first, last) = ((low + 1e-9).floor(), (high - 1e-9).ceil().max((low + 1e-9).floor() + 1.0));
        let step = [1.0, 2.0, 3.0, 4.0, 6.0, 10.0, 20.0, 30.0, 50.0, 60.0, 100.0, 200.0];
        // Times are wider than powers of ten.
        let most = if unit == "s" { 5.0 } else { 7.0 };
        let step = step.into_iter().find(|step| (last - first) / step <= most).unwrap_or(300.0);
        let name = |decade: f64| match unit {
            "s" => super::quantity(10f64.powf(decade), "s", 1),
            _ => power_of_ten(decade as i32),
        };
        let whole = ((first / step).ceil() as i64..=(last / step).floor() as i64).map(|i| i as f64 * step);
        let ticks = whole.map(|decade| (decade, name(decade))).collect();
        let margin = 0.02 * (last - first);
        Self {
            low: first - margin,
            high: last + margin,
            floor: 0.0,
            scale: Scale::new(1.0, ""),
            logarithmic: true,
            ticks,
        }
    }

    /// Where a value is, from 0 to 1; below and above it is cut off a little outside.
    fn share(&self, value: f64) -> f64 {
        let value = value.max(self.floor);
        let value = if self.logarithmic { value.max(1e-320).log10() } else { value * self.scale.factor };
        ((value - self.low) / (self.high - self.low)).clamp(-0.02, 1.02)
    }

    fn tick(&self, at: f64) -> f64 {
        (at - self.low) / (self.high - self.low)
    }
}

/// The nearest of 1, 2, 5 times a power of ten, not below.
fn nice(step: f64) -> f64 {
    let decade = 10f64.powf(step.log10().floor());
    let times = [1.0, 2.0, 5.0, 10.0].into_iter().find(|t| t * decade >= step * (1.0 - 1e-9)).unwrap_or(10.0);
    times * decade
}

/// Both axes, and where the plotting area ends (pixels).
struct Frame {
    x: Range,
    y: Range,
    right: i32,
    bottom: i32,
}

impl Frame {
    fn place(&self, x: f64, y: f64) -> (i32, i32) {
        let across = f64::from((self.right - LEFT) * FINE) * x;
        let down = f64::from((self.bottom - TOP) * FINE) * (1.0 - y);
        (LEFT * FINE + across.round() as i32, TOP * FINE + down.round() as i32)
    }

    fn at(&self, p: &Point) -> (i32, i32) {
        self.place(self.x.share(p.x), self.y.share(p.y))
    }

    fn grid(&self, area: &Area, plot: &Plot) -> Drawn {
        let faint = GRID.stroke_width(FINE as u32);
        for (at, name) in &self.y.ticks {
            let (left, y) = self.place(0.0, self.y.tick(*at));
            area.draw(&PathElement::new([(left, y), (self.right * FINE, y)], faint))?;
            area.draw_text(name, &style(12, INK, HPos::Right, VPos::Center), (left - 6 * FINE, y))?;
        }
        for (at, name) in &self.x.ticks {
            let (x, bottom) = self.place(self.x.tick(*at), 0.0);
            area.draw(&PathElement::new([(x, TOP * FINE), (x, bottom)], faint))?;
            area.draw_text(name, &style(12, INK, HPos::Center, VPos::Top), (x, bottom + 5 * FINE))?;
        }
        let corner = [self.place(0.0, 1.0), self.place(0.0, 0.0), self.place(1.0, 0.0)];
        area.draw(&PathElement::new(corner, FAINT.stroke_width(FINE as u32)))?;
        let middle = ((LEFT + self.right) / 2 * FINE, (HEIGHT - 6) * FINE);
        let label = style(12, INK, HPos::Center, VPos::Bottom);
        area.draw_text(&plot.x.name(&self.x.scale), &label, middle)
    }

    fn curve(&self, area: &Area, curve: &Curve) -> Drawn {
        let colour = LOOKS[curve.look % LOOKS.len()];
        let shown = |p: &Point| {
            let positive = |v: f64, range: &Range| v.is_finite() && (!range.logarithmic || v >= 0.0);
            positive(p.x, &self.x) && positive(p.y, &self.y)
        };
        for run in curve.points.split(|p| !shown(p)) {
            let line: Vec<_> = run.iter().map(|p| self.at(p)).collect();
            area.draw(&PathElement::new(line.clone(), colour.stroke_width(2 * FINE as u32)))?;
            for (p, &at) in run.iter().zip(&line).filter(|_| curve.marks) {
                if p.spread > 0.0 {
                    let far = self.at(&Point { x: p.x + p.spread, ..*p });
                    area.draw(&PathElement::new([at, far], colour.stroke_width(FINE as u32)))?;
                }
                mark(area, at, curve.look, colour, p.hollow)?;
            }
        }
        Ok(())
    }

    /// Names on the right, in the order of the curves' ends and no two on one line, each joined to its curve.
    fn names(&self, area: &Area, curves: &[Curve]) -> Drawn {
        // Measurements are named at their last point; lines, which often meet at their ends, at their height.
        let end = |curve: &Curve| {
            let finite = curve.points.iter().filter(|p| p.x.is_finite() && p.y.is_finite());
            let by = |p: &&Point| if curve.marks { p.x } else { p.y.abs() };
            finite.max_by(|a, b| by(a).total_cmp(&by(b))).map(|p| self.at(p))
        };
        let mut ends: Vec<_> = curves.iter().filter_map(|curve| Some((end(curve)?, curve))).collect();
        ends.sort_by_key(|((_, y), _)| *y);
        let wanted: Vec<_> = ends.iter().map(|((_, y), _)| y / FINE).collect();
        let lines = apart(&wanted, TOP - 6, self.bottom);
        for (((x, y), curve), line) in ends.into_iter().zip(lines) {
            let colour = LOOKS[curve.look % LOOKS.len()];
            let at = ((self.right + LEAD - 4) * FINE, line * FINE);
            let lead = [(x, y), ((self.right + 6) * FINE, line * FINE), at];
            let (dash, space) = (FINE as u32, 3 * FINE as u32);
            area.draw(&DashedPathElement::new(lead, dash, space, colour.stroke_width(FINE as u32)))?;
            if curve.marks {
                mark(area, at, curve.look, colour, false)?;
            } else {
                let sample = [(at.0 - 10 * FINE, at.1), (at.0 + 4 * FINE, at.1)];
                area.draw(&PathElement::new(sample, colour.stroke_width(2 * FINE as u32)))?;
            }
            let name = style(12, INK, HPos::Left, VPos::Center);
            area.draw_text(&scientific(&curve.name), &name, (at.0 + 7 * FINE, at.1))?;
        }
        Ok(())
    }
}

/// `wanted` places, ascending, moved apart by [`LINE`] and kept between `top` and `bottom`.
fn apart(wanted: &[i32], top: i32, bottom: i32) -> Vec<i32> {
    let mut lines: Vec<i32> = Vec::new();
    for &y in wanted {
        let next = lines.last().map_or(top, |last| last + LINE);
        lines.push(y.max(next));
    }
    let mut most = bottom;
    for line in lines.iter_mut().rev() {
        *line = (*line).min(most);
        most = *line - LINE;
    }
    lines
}

fn mark(area: &Area, (x, y): (i32, i32), look: usize, colour: RGBColor, hollow: bool) -> Drawn {
    let r = 35;
    let corners = match look % 5 {
        0 => {
            area.draw(&Circle::new((x, y), r, if hollow { WHITE } else { colour }.filled()))?;
            return area.draw(&Circle::new((x, y), r, colour.stroke_width(FINE as u32)));
        }
        1 => vec![(x - r, y - r), (x + r, y - r), (x + r, y + r), (x - r, y + r)],
        2 => vec![(x, y - r - 10), (x + r + 5, y + r), (x - r - 5, y + r)],
        3 => vec![(x, y - r - 10), (x + r + 10, y), (x, y + r + 10), (x - r - 10, y)],
        _ => vec![(x, y + r + 10), (x + r + 5, y - r), (x - r - 5, y - r)],
    };
    let mut outline = corners.clone();
    outline.extend(corners.first());
    area.draw(&Polygon::new(corners, if hollow { WHITE } else { colour }.filled()))?;
    area.draw(&PathElement::new(outline, colour.stroke_width(FINE as u32)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot() -> Plot {
        let points = |y: f64| (1..5).map(|i| Point::at(10f64.powi(i), y / f64::from(i))).collect();
        Plot {
            title: "Error & work <test>".into(),
            x: Axis::logarithmic("elements", "", "elements"),
            y: Axis::logarithmic("relative error", "", "error"),
            curves: vec![Curve::new("first", 0, points(1e-3)), Curve::new("second", 1, points(1.001e-3))],
        }
    }

    fn texts(svg: &str) -> Vec<String> {
        let xml = roxmltree::Document::parse(svg).unwrap();
        let text = xml.descendants().filter(|n| n.has_tag_name("text"));
        text.filter_map(|n| n.text()).map(|t| t.trim().to_owned()).collect()
    }

    #[test]
    fn curves_are_named_and_axes_have_decades() {
        let said = texts(&plot().svg());
        for label in ["first", "second", "10³", "10⁻⁴", "elements", "relative error", "Error & work <test>"]
        {
            assert!(said.iter().any(|t| t == label), "no {label:?} in {said:?}");
        }
    }

    #[test]
    fn names_do_not_overlap() {
        let lines = apart(&[100, 101, 102, 290], 40, 290);
        assert_eq!(lines, [100, 116, 132, 290]);
        let low = apart(&[285, 286, 287], 40, 290);
        assert_eq!(low, [258, 274, 290]);
    }

    #[test]
    fn csv_has_every_point() {
        let text = plot().csv();
        assert_eq!(text.lines().count(), 9);
        assert!(text.starts_with("curve,elements,error,spread,status\nfirst,10.0,0.001,0.0,\n"), "{text}");
    }

    #[test]
    fn what_cannot_be_drawn_is_left_out() {
        let mut plot = plot();
        plot.curves[0].points[1].y = f64::NAN;
        plot.curves[1].points[2].y = 0.0;
        assert!(plot.has_data());
        assert!(!plot.svg().contains("NaN"));
        plot.curves[0].points.clear();
        assert!(!plot.has_data());
        assert!(roxmltree::Document::parse(&plot.svg()).is_ok());
        plot.curves.clear();
        assert!(roxmltree::Document::parse(&plot.svg()).is_ok());
    }

    #[test]
    fn ticks_are_numbers_that_people_read() {
        assert_eq!(nice(0.3), 0.5);
        assert_eq!(nice(2.0), 2.0);
        assert_eq!(power_of_ten(-16), "10⁻¹⁶");
        let time = Range::of([2e-6, 3e-2].into_iter(), &Axis::logarithmic("time", "s", "time"));
        let names: Vec<_> = time.ticks.iter().map(|t| t.1.as_str()).collect();
        assert_eq!(names, ["1 µs", "10 µs", "100 µs", "1 ms", "10 ms", "0.1 s"]);
        let metres = Range::of([0.0, 0.012].into_iter(), &Axis::linear("bending", "m", "bending"));
        assert_eq!((metres.scale.unit.as_str(), metres.ticks[1].1.as_str()), ("mm", "5"));
    }
}
