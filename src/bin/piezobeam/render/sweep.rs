//! A sweep's table as a picture: what the scenes came to over the first varied number, a curve for each combination
//! of the others.

use plotters::prelude::*;

use super::chart::{
    Area, BLUE, Drawn, FAINT, FINE, Frame, GREEN, INK, ORANGE, PURPLE, SKY, VERMILLION, curve, heading,
    padded, page, shortened, typeset, words,
};
use super::{Scale, significant};
use crate::report::CONVERGED;
use crate::scene_file::unit;
use crate::sweep::{COLUMNS, Table, Vary};

const WIDTH: i32 = 960;
const HEAD: i32 = 48;
const ROW: i32 = 260;
const LINE: i32 = 20;

/// What is drawn: a column, and what a reader calls it.
const PANELS: [(&str, &str); 4] = [
    ("max_bending", "Largest bending"),
    ("contact_force", "Contact force"),
    ("contact_length", "Length in contact"),
    ("bending_energy", "Bending energy"),
];

/// Curves with a colour of their own; more are told apart by their shade.
const COLOURS: [RGBColor; 7] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, INK];

/// The rows with the same values of all but the first number.
struct Curve {
    /// What they have in common.
    name: String,
    colour: RGBColor,
    /// Numbers of rows, in ascending order of the first number.
    rows: Vec<usize>,
}

/// The page as SVG.
pub fn plot(table: &Table, scene: &str) -> String {
    let cells = table.cells();
    let number = |row: usize, column: usize| cells[row].get(column).and_then(|cell| cell.parse::<f64>().ok());
    let curves = curves(table, cells.len());
    let status = table.vary.len();
    let converged = |row: usize| cells[row].get(status) == Some(CONVERGED);
    let panels: Vec<_> = PANELS
        .iter()
        .filter_map(|&(name, title)| {
            let column = COLUMNS.iter().position(|(column, ..)| *column == name)?;
            let there = (0..cells.len()).any(|row| number(row, status + column).is_some());
            there.then_some((title, COLUMNS[column].1, status + column))
        })
        .collect();
    let failed = (0..cells.len()).filter(|&row| !converged(row)).count();
    let keys = keys(&curves);
    let top = HEAD + LINE * keys.len().div_ceil(3) as i32 + if keys.is_empty() { 0 } else { 12 };
    let below = ROW * panels.len().div_ceil(2) as i32;

    page("Sweep over scenes of a piezoelectric beam", WIDTH, top + below + 12, |root| {
        let (head, rest) = root.split_vertically(top * FINE);
        heading(&head, &shortened(scene, 80), (14, 12), 20, INK)?;
        let rows = match failed {
            0 => format!("{} scenes", cells.len()),
            n => format!("{} scenes, {n} of them not converged (hollow)", cells.len()),
        };
        words(&head, &rows, (WIDTH - 330, 18), 13, if failed > 0 { VERMILLION } else { FAINT })?;
        for (i, (name, colour)) in keys.iter().enumerate() {
            let (x, y) = (14 + (WIDTH - 28) / 3 * (i % 3) as i32, HEAD + LINE * (i / 3) as i32);
            let line = [(x * FINE, (y + 7) * FINE), ((x + 20) * FINE, (y + 7) * FINE)];
            head.draw(&PathElement::new(line, colour.stroke_width(3 * FINE as u32)))?;
            words(&head, &shortened(name, 44), (x + 28, y), 13, INK)?;
        }
        let mut rest = rest;
        for row in panels.chunks(2) {
            let (here, next) = rest.split_vertically(ROW * FINE);
            for (area, &(title, unit, column)) in here.split_evenly((1, row.len())).iter().zip(row) {
                let point = |row: usize| Some((number(row, 0)?, number(row, column)?, converged(row)));
                panel(area, &table.vary[0], (title, unit), &curves, point)?;
            }
            rest = next;
        }
        Ok(())
    })
}

fn curves(table: &Table, rows: usize) -> Vec<Curve> {
    let others: usize = table.vary.iter().skip(1).map(|one| one.values.len()).product();
    let first = &table.vary[0].values;
    (0..others)
        .map(|other| {
            let mut rest = other;
            let mut names: Vec<String> = (table.vary.iter().skip(1).rev())
                .map(|one| {
                    let value = one.values[rest % one.values.len()];
                    rest /= one.values.len();
                    format!("{} = {}", one.path, significant(value, 6))
                })
                .collect();
            names.reverse();
            let mut order: Vec<usize> = (0..first.len()).collect();
            order.sort_by(|&i, &j| first[i].total_cmp(&first[j]));
            let rows = order.into_iter().map(|i| i * others + other).filter(|&row| row < rows).collect();
            Curve { name: names.join(", "), colour: colour(other, others), rows }
        })
        .collect()
}

/// One of a few colours that are told apart with any kind of vision, or of many shades from blue to orange, which
/// are.
fn colour(i: usize, of: usize) -> RGBColor {
    if of <= COLOURS.len() {
        return COLOURS[i % COLOURS.len()];
    }
    let share = i as f64 / (of - 1) as f64;
    let between =
        |from: u8, to: u8| (f64::from(from) + share * (f64::from(to) - f64::from(from))).round() as u8;
    let (from, to) = (SKY, VERMILLION);
    RGBColor(between(from.0, to.0), between(from.1, to.1), between(from.2, to.2))
}

/// What stands for which colour; of many shades the first and the last.
fn keys(curves: &[Curve]) -> Vec<(String, RGBColor)> {
    let key = |curve: &Curve| (typeset(&curve.name), curve.colour);
    match curves {
        [] | [_] => Vec::new(),
        few if few.len() <= COLOURS.len() => few.iter().map(key).collect(),
        [first, between @ .., last] => {
            let middle = (format!("{} between, in shades", between.len()), between[between.len() / 2].colour);
            vec![key(first), middle, key(last)]
        }
    }
}

/// One column over the first varied number; `point` gives x, y and whether it is a solution.
fn panel(
    area: &Area,
    vary: &Vary,
    (name, of): (&str, &str),
    curves: &[Curve],
    point: impl Fn(usize) -> Option<(f64, f64, bool)>,
) -> Drawn {
    let all = || curves.iter().flat_map(|curve| &curve.rows).filter_map(|&row| point(row));
    let scale = Scale::of(all().map(|p| p.1), of);
    let along = |x: f64| if vary.logarithmic { x.log10() } else { x };
    let x = padded(all().map(|p| along(p.0)), 0.02, 0.02);
    let label = match unit(&vary.path) {
        Some(unit) => typeset(&format!("{} [{unit}]", vary.path)),
        None => vary.path.clone(),
    };
    let frame = Frame {
        title: &format!("{name} [{}]", scale.unit),
        note: String::new(),
        colour: None,
        x,
        y: padded(all().map(|p| p.1 * scale.factor), 0.08, 0.08),
        x_label: &label,
        downwards: false,
        logarithmic: vary.logarithmic,
    };
    let mut chart = frame.draw(area)?;
    for one in curves {
        let points: Vec<_> = one.rows.iter().filter_map(|&row| point(row)).collect();
        let places: Vec<_> = points.iter().map(|p| (along(p.0), p.1 * scale.factor)).collect();
        curve(&mut chart, &places, one.colour, 1)?;
        for (&at, &(_, _, solution)) in places.iter().zip(&points) {
            let filled = if solution { one.colour } else { WHITE };
            chart.draw_series([Circle::new(at, 3 * FINE, filled.filled())])?;
            chart.draw_series([Circle::new(at, 3 * FINE, one.colour.stroke_width(FINE as u32))])?;
        }
    }
    Ok(())
}
