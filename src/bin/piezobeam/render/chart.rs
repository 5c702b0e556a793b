//! What every picture is made of: an SVG page, a frame with axes, curves, labels.
//!
//! The SVG backend rounds coordinates to whole units, so a page is drawn [`FINE`] times too large and shown at its
//! size through the `viewBox`. Colours are those of Okabe and Ito, told apart with any kind of colour vision.

use std::ops::Range;

use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Scale, significant};

/// Drawing units per pixel.
pub const FINE: i32 = 10;

pub const INK: RGBColor = RGBColor(34, 34, 34);
pub const FAINT: RGBColor = RGBColor(95, 95, 95);
pub const GRID: RGBColor = RGBColor(226, 226, 226);
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const GREEN: RGBColor = RGBColor(0, 158, 115);
pub const VERMILLION: RGBColor = RGBColor(213, 94, 0);
pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
/// The foundation and its surface.
pub const GROUND: RGBColor = RGBColor(226, 220, 207);
pub const SURFACE: RGBColor = RGBColor(122, 106, 79);
/// Walls behind their hatching.
pub const WALL: RGBColor = RGBColor(238, 238, 238);
/// A beam drawn as a band.
pub const BAND: RGBColor = RGBColor(170, 209, 233);
pub const SKY: RGBColor = RGBColor(86, 180, 233);

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
pub type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// What each colour is on a dark page: as light against it as it is dark against white, of the same hue.
const DARK: [(RGBColor, &str); 12] = [
    (WHITE, "#16191d"),
    (INK, "#ececec"),
    (FAINT, "#a9b0b8"),
    (GRID, "#343a41"),
    (WALL, "#24282d"),
    (GROUND, "#39342b"),
    (SURFACE, "#b5a27e"),
    (BLUE, "#5cb3ee"),
    (GREEN, "#3fc79d"),
    (VERMILLION, "#f58b45"),
    (PURPLE, "#dd9cc2"),
    (BAND, "#2f6388"),
];

/// What all pictures look like: a page that has one needs it once. Text carries an outline of the page's colour, so
/// that a label crossed by a line stays readable.
pub fn style_sheet() -> String {
    format!(
        "svg text {{ paint-order: stroke; stroke: #fff; stroke-width: {}px; stroke-linejoin: round }} \
         polyline {{ stroke-linejoin: round }}\n{}",
        3 * FINE,
        dark()
    )
}

/// The style rules with which a page is dark where the reader's screen is.
fn dark() -> String {
    let rules = DARK.map(|(RGBColor(r, g, b), dark)| {
        let light = format!("#{r:02X}{g:02X}{b:02X}");
        format!("[fill=\"{light}\"] {{ fill: {dark} }} [stroke=\"{light}\"] {{ stroke: {dark} }}\n")
    });
    format!("@media (prefers-color-scheme: dark) {{\nsvg text {{ stroke: #16191d }}\n{}}}\n", rules.concat())
}

/// A white page of `width` by `height` pixels; `name` is its title for browsers and screen readers, plain words.
pub fn page(name: &'static str, width: i32, height: i32, draw: impl FnOnce(&Area) -> Drawn) -> String {
    alone(&part(name, width, height, draw))
}

/// A picture that is part of a page, as a file of its own.
pub fn alone(part: &str) -> String {
    match part.split_once('\n') {
        Some((head, body)) => format!("{head}\n<style>{}</style>\n{body}", style_sheet()),
        None => part.to_owned(),
    }
}

/// As [`page`], without [`style_sheet`].
pub fn part(name: &str, width: i32, height: i32, draw: impl FnOnce(&Area) -> Drawn) -> String {
    let mut svg = String::new();
    let size = ((width * FINE) as u32, (height * FINE) as u32);
    let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
    root.fill(&WHITE)
        .and_then(|()| draw(&root))
        .and_then(|()| root.present())
        .expect("drawing into memory cannot fail");
    drop(root);
    let drawn = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    let shown = format!("width=\"{width}\" height=\"{height}\" role=\"img\"");
    let svg = svg.replacen(&drawn, &shown, 1);
    match svg.split_once('\n') {
        Some((head, body)) => format!("{head}\n<title>{}</title>\n{body}", escaped(name)),
        None => svg,
    }
}

/// `text` between tags.
fn escaped(text: &str) -> String {
    printable(text).replace('&', "&amp;").replace('<', "&lt;")
}

/// A line of text: size in pixels, colour, and which point of the text is at the given place.
pub fn style(size: i32, color: RGBColor, h: HPos, v: VPos) -> TextStyle<'static> {
    // The backend divides the size by 1.24 to get the em of the SVG.
    ("sans-serif", f64::from(size * FINE) * 1.24).into_font().color(&color).pos(Pos::new(h, v))
}

/// Text with its top left corner at `at` (pixels).
pub fn words(area: &Area, text: &str, at: (i32, i32), size: i32, color: RGBColor) -> Drawn {
    let style = style(size, color, HPos::Left, VPos::Top);
    area.draw_text(&printable(text), &style, (at.0 * FINE, at.1 * FINE))
}

/// Bold text with its top left corner at `at` (pixels).
pub fn heading(area: &Area, text: &str, at: (i32, i32), size: i32, color: RGBColor) -> Drawn {
    let font = ("sans-serif", f64::from(size * FINE) * 1.24).into_font().style(FontStyle::Bold);
    let style = font.color(&color).pos(Pos::new(HPos::Left, VPos::Top));
    area.draw_text(&printable(text), &style, (at.0 * FINE, at.1 * FINE))
}

/// `text` without the control characters that XML forbids.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c })
        .collect()
}

/// At most `most` characters of `text`, the last one an ellipsis if some were left out.
pub fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => text.to_owned(),
        Some(_) => text.chars().take(most.saturating_sub(1)).chain(['…']).collect(),
    }
}

/// `text` in lines of at most `width` characters, broken between words; a longer word stays whole.
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.len() - 1;
        let used = lines[line].chars().count();
        if used == 0 {
            lines[line] += word;
        } else if used + 1 + word.chars().count() <= width {
            lines[line] = format!("{} {word}", lines[line]);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// `text` as it is printed: minus signs, and small whole powers raised.
pub fn typeset(text: &str) -> String {
    let exponent = |minus: String, digit: char| minus.replace(&format!("{digit}e-"), &format!("{digit}e−"));
    let minus = text.replace(" -", " −").replace("[-", "[−");
    let minus = ('0'..='9').fold(minus, exponent);
    let minus = minus.strip_prefix('-').map_or(minus.clone(), |rest| format!("−{rest}"));
    let mut out = String::new();
    let mut parts = minus.split('^');
    out += parts.next().unwrap_or_default();
    for part in parts {
        let after = part[1.min(part.len())..].trim_start_matches('.');
        let alone = !after.starts_with(|c: char| c.is_ascii_digit());
        match part.chars().next().filter(|_| alone) {
            Some('2') => out = out + "²" + &part[1..],
            Some('3') => out = out + "³" + &part[1..],
            _ => out = out + "^" + part,
        }
    }
    out
}

/// As [`typeset`], with powers of ten raised: 3e-12 is 3·10⁻¹².
pub fn scientific(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find('e') {
        let (before, after) = (&rest[..at], &rest[at + 1..]);
        let number = before
            .rfind(|c: char| !c.is_ascii_digit() && c != '.')
            .map_or(0, |i| i + before[i..].chars().next().map_or(0, char::len_utf8));
        let digits = after.find(|c: char| !c.is_ascii_digit() && c != '-').unwrap_or(after.len());
        let mantissa = &before[number..];
        match after[..digits].parse() {
            Ok(exponent) if mantissa.starts_with(|c: char| c.is_ascii_digit()) => {
                out += &before[..number];
                if mantissa != "1" {
                    out = out + mantissa + "·";
                }
                out += &power_of_ten(exponent);
                rest = &after[digits..];
            }
            _ => {
                out += &rest[..=at];
                rest = after;
            }
        }
    }
    typeset(&(out + rest))
}

/// 1, 10, 100, else raised: 10³, 10⁻⁶.
pub fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".into(),
        1 => "10".into(),
        2 => "100".into(),
        _ => {
            let raised = |c: char| match c {
                '-' => '⁻',
                '1' => '¹',
                '2' => '²',
                '3' => '³',
                digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
            };
            format!("10{}", exponent.to_string().chars().map(raised).collect::<String>())
        }
    }
}

/// Axes and a title above them; `colour` draws a sample of the line the title names.
pub struct Frame<'a> {
    pub title: &'a str,
    /// A line below the title; empty for none.
    pub note: String,
    pub colour: Option<RGBColor>,
    pub x: Range<f64>,
    pub y: Range<f64>,
    pub x_label: &'a str,
    /// Print the ordinates with their sign changed: for an axis that counts downwards.
    pub downwards: bool,
    /// Abscissas are logarithms to the base ten; print the numbers themselves.
    pub logarithmic: bool,
}

/// Room around the plotting area, pixels.
const LEFT: i32 = 58;
const RIGHT: i32 = 16;
const BOTTOM: i32 = 42;
const TITLE: i32 = 30;
const NOTE: i32 = 16;

impl Frame<'_> {
    /// A sentence that compares the scales of a frame with a note, whose axes are lengths.
    pub fn magnified(&self, area: &Area, along: &Scale, across: &Scale) -> String {
        let (width, height) = area.dim_in_pixel();
        let room = |pixels: u32, taken: i32| f64::from(pixels as i32 - taken * FINE);
        let per_metre = |pixels: f64, range: &Range<f64>, scale: &Scale| {
            pixels * scale.factor / (range.end - range.start)
        };
        let ratio = per_metre(room(height, TITLE + NOTE + BOTTOM), &self.y, across)
            / per_metre(room(width, LEFT + RIGHT), &self.x, along);
        format!("Heights are drawn {} times as large as lengths.", significant(ratio, 2))
    }

    pub fn draw<'a, 'b>(
        &self,
        area: &'a Area<'b>,
    ) -> Result<Chart<'a, 'b>, DrawingAreaErrorKind<std::io::Error>> {
        let mut left = 12;
        if let Some(colour) = self.colour {
            let y = 15 * FINE;
            let stroke = colour.stroke_width(3 * FINE as u32);
            area.draw(&PathElement::new([(left * FINE, y), ((left + 20) * FINE, y)], stroke))?;
            left += 28;
        }
        heading(area, self.title, (left, 8), 14, INK)?;
        if !self.note.is_empty() {
            words(area, &self.note, (12, 28), 12, FAINT)?;
        }
        let top = TITLE + if self.note.is_empty() { 0 } else { NOTE };
        let mut chart = ChartBuilder::on(area)
            .margin_top(top * FINE)
            .margin_right(RIGHT * FINE)
            .set_label_area_size(LabelAreaPosition::Left, LEFT * FINE)
            .set_label_area_size(LabelAreaPosition::Bottom, BOTTOM * FINE)
            .build_cartesian_2d(self.x.clone(), self.y.clone())?;
        let sign = if self.downwards { -1.0 } else { 1.0 };
        let (dx, dy) = (self.x.end - self.x.start, self.y.end - self.y.start);
        let label = |size, colour| style(size, colour, HPos::Left, VPos::Top);
        chart
            .configure_mesh()
            .disable_x_mesh()
            .bold_line_style(GRID.stroke_width(FINE as u32))
            .light_line_style(TRANSPARENT)
            .axis_style(FAINT.stroke_width(FINE as u32))
            .x_labels(9)
            .y_labels(((area.dim_in_pixel().1 as i32 / FINE) / 40).max(3) as usize)
            .set_all_tick_mark_size(4 * FINE)
            .label_style(label(12, INK))
            .axis_desc_style(label(12, INK))
            .x_desc(self.x_label)
            .x_label_formatter(&|&v| if self.logarithmic { power(v) } else { tick(v, dx) })
            .y_label_formatter(&|&v| tick(sign * v, dy))
            .draw()?;
        Ok(chart)
    }
}

/// A tick's number on an axis of the given span: rounding noise around zero is zero.
fn tick(value: f64, span: f64) -> String {
    let value = if value.abs() < 1e-9 * span { 0.0 } else { value };
    significant(value, 6).replace('-', "−")
}

/// A tick's number on a logarithmic axis.
fn power(exponent: f64) -> String {
    let whole = exponent.round();
    if (exponent - whole).abs() < 1e-9 {
        return format!("1e{whole:.0}").replace('-', "−");
    }
    significant(10f64.powf(exponent), 2).replace('-', "−")
}

/// The range of `values` with `below` and `above` parts of its span added; never so narrow that ticks run out of digits.
pub fn padded(values: impl IntoIterator<Item = f64>, below: f64, above: f64) -> Range<f64> {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let (mut lo, mut hi) =
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
    if lo > hi {
        (lo, hi) = (0.0, 0.0);
    }
    let size = lo.abs().max(hi.abs());
    let least = if size == 0.0 { 2.0 } else { 1e-3 * size };
    if hi - lo < least {
        let middle = 0.5 * (lo + hi);
        // A value that does not vary is read best against a scale of its own size.
        let half = if size == 0.0 { 1.0 } else { 0.1 * size };
        (lo, hi) = (middle - half, middle + half);
    }
    let span = hi - lo;
    lo - below * span..hi + above * span
}

/// A curve through `points`, broken where a number is not finite.
pub fn curve(chart: &mut Chart, points: &[(f64, f64)], colour: RGBColor, width: i32) -> Drawn {
    let stroke = colour.stroke_width((width * FINE) as u32);
    for run in points.split(|p| !(p.0.is_finite() && p.1.is_finite())) {
        chart.draw_series(LineSeries::new(thinned(run), stroke))?;
    }
    Ok(())
}

/// No more points than a screen can show: the least and the greatest of each stretch, in their order.
pub fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const STRETCHES: usize = 1000;
    if points.len() <= 2 * STRETCHES {
        return points.to_vec();
    }
    let last = points.len() - 1;
    let mut kept = vec![0];
    for stretch in 0..STRETCHES {
        let indices = stretch * points.len() / STRETCHES..(stretch + 1) * points.len() / STRETCHES;
        let by = |&i: &usize, &j: &usize| points[i].1.total_cmp(&points[j].1);
        kept.extend(indices.clone().min_by(by));
        kept.extend(indices.max_by(by));
    }
    kept.push(last);
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|i| points[i]).collect()
}

/// A dot at `at` and a label beyond it: above, or below if `below`; moved inwards near the sides of the frame.
pub fn mark(chart: &mut Chart, at: (f64, f64), text: &str, below: bool, colour: RGBColor) -> Drawn {
    let x = chart.as_coord_spec().get_x_range();
    let (h, dx) = match (at.0 - x.start) / (x.end - x.start) {
        part if part < 0.25 => (HPos::Left, 5),
        part if part > 0.75 => (HPos::Right, -5),
        _ => (HPos::Center, 0),
    };
    let (v, dy) = if below { (VPos::Top, 6) } else { (VPos::Bottom, -6) };
    let label = style(12, INK, h, v);
    let text = printable(text).replace('-', "−");
    chart.draw_series([EmptyElement::at(at)
        + Circle::new((0, 0), 4 * FINE, colour.filled())
        + Text::new(text, (dx * FINE, dy * FINE), label)])?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges() {
        assert_eq!(padded([0.0, 0.0], 0.0, 0.0), -1.0..1.0);
        assert_eq!(padded([], 0.0, 0.0), -1.0..1.0);
        assert_eq!(padded([5.0, f64::NAN], 0.0, 0.0), 4.5..5.5);
        assert_eq!(padded([0.0, 10.0], 0.1, 0.2), -1.0..12.0);
    }

    #[test]
    fn thinning_keeps_ends_and_peaks() {
        let mut points: Vec<_> = (0..100_000).map(|i| (f64::from(i), 0.0)).collect();
        points[77_777].1 = 1.0;
        let kept = thinned(&points);
        assert!(kept.len() <= 2002 && kept.contains(&(77_777.0, 1.0)));
        assert_eq!((kept[0].0, kept[kept.len() - 1].0), (0.0, 99_999.0));
        assert!(kept.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn a_page_is_xml_with_a_size() {
        let svg = page("test", 200, 100, |area| words(area, "<a>\u{1}&", (1, 1), 12, INK));
        let xml = roxmltree::Document::parse(&svg).unwrap();
        let root = xml.root_element();
        assert_eq!(root.attribute("width"), Some("200"));
        assert_eq!(root.attribute("viewBox"), Some("0 0 2000 1000"));
        assert!(xml.descendants().any(|n| n.text().is_some_and(|t| t.trim() == "<a> &")));
    }

    #[test]
    fn every_colour_has_one_for_dark_pages() {
        let svg = page("test", 20, 10, |_| Ok(()));
        let (_, rules) = svg.split_once("prefers-color-scheme: dark").unwrap();
        for (RGBColor(r, g, b), dark) in DARK {
            assert!(rules.contains(&format!("[fill=\"#{r:02X}{g:02X}{b:02X}\"] {{ fill: {dark} }}")));
        }
        // The backend writes colours as the rules have them.
        assert!(svg.contains("fill=\"#FFFFFF\""), "{svg}");
    }

    #[test]
    fn lines_and_signs() {
        assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrapped("unbreakable a", 4), ["unbreakable", "a"]);
        assert_eq!(wrapped("", 4), [""]);
        assert_eq!(typeset("-1e-5 N m^2/V^2"), "−1e−5 N m²/V²");
        assert_eq!(typeset("1e8 N/m^2.5, -2 x^10 + x^3"), "1e8 N/m^2.5, −2 x^10 + x³");
        assert_eq!(typeset("x^"), "x^");
        assert_eq!(typeset("re-entrant, 3e-4"), "re-entrant, 3e−4");
        assert_eq!(typeset("N/m^2. And m^3..."), "N/m². And m³...");
        assert_eq!(scientific("from 1e8 N/m^2 to 2.5e-12, -1e-3"), "from 10⁸ N/m² to 2.5·10⁻¹², −10⁻³");
        assert_eq!(scientific("the 3 elements, 4e, x1 e5, ξ = 1e0 m"), "the 3 elements, 4e, x1 e5, ξ = 1 m");
    }

    #[test]
    fn small_words() {
        assert_eq!(tick(-1e-17, 1.0), "0");
        assert_eq!(tick(-0.25, 1.0), "−0.25");
        assert_eq!(shortened("abcdef", 4), "abc…");
        assert_eq!(shortened("abcd", 4), "abcd");
    }
}
