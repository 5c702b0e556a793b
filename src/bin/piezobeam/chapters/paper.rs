//! The paper reproduced: its nine figures, and what it says of penetration, of iterations and of orders.

use super::measure::{Bench, Field, Found, How, Size, errors, points};
use super::scenes::{Numbers, PAPER as EXAMPLE, PARTIAL};
use super::{
    Chapter, Claim, Effort, Figure, OURS, PAPER, Section, Table, exponent, header, naive, reference, rough,
};
use crate::render::plot::{Axis, Curve, Plot, Point};
use crate::render::{quantity, significant};
use std::error::Error;

/// One for each part.
pub const STEPS: u64 = 5;

/// Elements of the paper's meshes.
const ELEMENTS: usize = 100;
/// E of the paper, which it compares k with \[N/m^2\].
const YOUNG: f64 = 1e5;
/// k at which duality is slow, as the paper has it.
const STIFF: f64 = 1e12;
/// Elements of the reference that the paper measures its errors by.
const FINE: usize = 10_000;
/// Elements that divide [`FINE`] and have nodes at tenths.
const DIVISORS: [usize; 9] = [10, 20, 50, 100, 200, 500, 1000, 2000, 5000];

const ASSUMED: &str =
    "M = 1, s = 0, 1 V at both ends, and k = 1e8 N/m^2 where no k is named: the paper does not print them.";

/// The paper's methods in its figures, and this solver.
const COMPARED: [How; 3] = [How::Elementwise, How::BermudezMoreno, How::Exact];

/// Computes the chapter.
pub fn chapter(effort: &Effort) -> Result<Chapter, Box<dyn Error>> {
    let fields = fields()?;
    effort.step();
    let (penetration, falls) = penetration(effort)?;
    effort.step();
    let (iterations, counted) = iterations(effort)?;
    effort.step();
    let (worth, quiet) = worth()?;
    effort.step();
    let (convergence, orders) = convergence()?;
    effort.step();
    let introduction = vec![format!(
        "Its example on {ELEMENTS} elements where nothing else is said, and the same with the load turned round on \
         the right half, which lifts the beam off. What the paper does not print is assumed: {ASSUMED}"
    )];
    let claims = falls.into_iter().chain(counted).chain([quiet]).chain(orders).collect();
    let sections = vec![fields, penetration, iterations, worth, convergence];
    Ok(Chapter { name: "paper", title: "The paper reproduced", introduction, claims, sections })
}

/// Solves a scene from nothing; fields at `at`.
fn solved(numbers: &Numbers, how: How, elements: usize, at: &[f64]) -> Result<Found, Box<dyn Error>> {
    let given = numbers.in_precision::<f64>();
    let scene = given.scene();
    Ok(Bench::new(&scene).find(how, Size::Elements(elements), at)?)
}

/// Evenly spaced, both ends included.
fn even() -> Vec<f64> {
    (0..=200).map(|i| f64::from(i) / 200.0).collect()
}

fn along() -> Axis {
    Axis::linear("x", "m", "x")
}

fn fields() -> Result<Section, Box<dyn Error>> {
    let x = even();
    let (full, partial) = (
        solved(&EXAMPLE, How::Exact, ELEMENTS, &x)?.fields,
        solved(&PARTIAL, How::Exact, ELEMENTS, &x)?.fields,
    );
    let both = [("full contact", 0, &full), ("partial contact", 1, &partial)];
    let curve = |get: fn(f64, &Field) -> (f64, f64)| {
        let x = &x;
        move |(name, look, fields): (&str, usize, &Vec<Field>)| {
            Curve::line(name, look, x.iter().zip(fields).map(move |(&x, field)| get(x, field)))
        }
    };
    let figure = |name: &str, caption: &str, title: &str, x: Axis, y: Axis, curves: Vec<Curve>| Figure {
        name: name.into(),
        caption: caption.into(),
        plot: Plot { title: title.into(), x, y, curves },
    };
    let figures = vec![
        figure(
            "fig1-bending",
            "Fig. 1: bending, positive towards the foundation.",
            "Fig. 1: bending",
            along(),
            Axis::linear("bending ξ", "m", "bending"),
            both.map(curve(|x, f| (x, f[0]))).into(),
        ),
        figure(
            "fig2-stretching",
            "Fig. 2: stretching; the same in both scenes to the width of the line. 1.1 m in a beam of 1 m: the \
             paper's data are not those of a real beam.",
            "Fig. 2: stretching",
            along(),
            Axis::linear("stretching u", "m", "stretching"),
            vec![curve(|x, f| (x, f[1]))(both[0])],
        ),
        figure(
            "fig3-deformed",
            "Fig. 3: the deformed axis, which folds back on itself under so much stretching.",
            "Fig. 3: the deformed beam",
            Axis::linear("x + u", "m", "x"),
            Axis::linear("height −ξ", "m", "height"),
            both.map(curve(|x, f| (x + f[1], -f[0]))).into(),
        ),
        figure(
            "fig4-potential",
            "Fig. 4: electric potential; the same in both scenes to the width of the line.",
            "Fig. 4: potential",
            along(),
            Axis::linear("potential q", "V", "potential"),
            vec![curve(|x, f| (x, f[2]))(both[0])],
        ),
    ];
    Ok(Section { title: "Figs. 1 to 4: the fields".into(), text: Vec::new(), figures, tables: Vec::new() })
}

fn penetration(effort: &Effort) -> Result<(Section, Vec<Claim>), Box<dyn Error>> {
    let x = even();
    let deepest = |found: &Found| found.fields.iter().map(|f| f[0]).fold(0.0, f64::max);
    let mut curves = COMPARED.map(|how| Curve::new(how.name(), how.look(), Vec::new()));
    let mut bent = Vec::new();
    for decade in 0..=16 {
        let k = 10f64.powi(decade);
        for (how, curve) in COMPARED.into_iter().zip(&mut curves) {
            // Thousands of iterations each.
            if effort.quick && how == How::BermudezMoreno && decade % 4 > 0 {
                continue;
            }
            let found = solved(&EXAMPLE.on(k), how, ELEMENTS, &x)?;
            let (status, hollow) = (found.status, found.hollow());
            curve.points.push(Point { x: k, y: deepest(&found), spread: 0.0, status, hollow });
            if how == How::Exact && [0, 4, 5, 6, 7, 8, 16].contains(&decade) {
                let line = x.iter().zip(&found.fields).map(|(&x, f)| (x, f[0]));
                bent.push(Curve::line(format!("k = {k:.0e}"), bent.len(), line));
            }
        }
    }
    let ours = &curves[2].points;
    let falls = ours.windows(2).all(|pair| pair[1].y < pair[0].y) && ours.iter().all(|p| !p.hollow);
    let (first, last) = (ours[0].y, ours[16].y);
    let loss = |most: f64| {
        let below = ours.iter().filter(|p| p.x <= most);
        below.fold(0.0_f64, |loss, p| loss.max(1.0 - p.y / first))
    };
    let percent = |share: f64| format!("{} %", significant(100.0 * share, 2));
    let claims = vec![
        Claim {
            by: PAPER,
            said: "penetration falls as k grows from 1 to 1e16",
            found: format!("from {} to {}", quantity(first, "m", 4), quantity(last, "m", 4)),
            artefact: false,
            holds: falls,
            assumes: ASSUMED,
        },
        Claim {
            by: PAPER,
            said: "this is visible only for k > E",
            found: format!(
                "{} less at k = E, {} less at k = 100 E",
                percent(loss(YOUNG)),
                percent(loss(100.0 * YOUNG))
            ),
            artefact: false,
            holds: loss(YOUNG) < 0.05 && loss(100.0 * YOUNG) > 0.5,
            assumes: ASSUMED,
        },
    ];
    let lines = Figure {
        name: "fig5-bending".into(),
        caption: "Fig. 5: bending for k from 1 to 1e16 N/m^2.".into(),
        plot: Plot {
            title: "Fig. 5: bending and stiffness".into(),
            x: along(),
            y: Axis::linear("bending ξ", "m", "bending"),
            curves: bent,
        },
    };
    let depths = Figure {
        name: "fig5-penetration".into(),
        caption: "The deepest penetration against k, by both of the paper's methods and by this solver. Without gap \
                  and with all of the beam in contact they agree, but for Bermúdez-Moreno's where it ran out of \
                  iterations (hollow)."
            .into(),
        plot: Plot {
            title: "Deepest penetration".into(),
            x: Axis::logarithmic("stiffness k of the foundation", "N/m^2", "k"),
            y: Axis::logarithmic("deepest penetration", "m", "penetration"),
            curves: curves.into(),
        },
    };
    let section = Section {
        title: "Fig. 5: penetration and the foundation's stiffness".into(),
        text: Vec::new(),
        figures: vec![lines, depths],
        tables: Vec::new(),
    };
    Ok((section, claims))
}

/// Iterations to each stopping tolerance.
fn count(effort: &Effort, numbers: &Numbers, how: How) -> Result<Vec<Point>, Box<dyn Error>> {
    let given = numbers.in_precision::<f64>();
    let scene = given.scene();
    let digits: &[i32] = effort.pick(&[1, 3, 6, 9], &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
    let mut points = Vec::new();
    for stop in digits.iter().map(|&digits| 10f64.powi(-digits)) {
        let found = Bench::new(&scene).stopping_at(stop).find(how, Size::Elements(ELEMENTS), &[])?;
        let (status, hollow) = (found.status, found.hollow());
        points.push(Point { x: stop, y: found.iterations as f64, spread: 0.0, status, hollow });
    }
    Ok(points)
}

fn iterations(effort: &Effort) -> Result<(Section, [Claim; 2]), Box<dyn Error>> {
    let full = [
        ("Bermúdez, 1e12", How::BermudezMoreno, EXAMPLE.on(STIFF), 4),
        ("Bermúdez, 1e8", How::BermudezMoreno, EXAMPLE, 1),
        ("by elements, 1e8", How::Elementwise, EXAMPLE, 0),
        ("exact kinks, 1e8", How::Exact, EXAMPLE, 3),
    ];
    let partial = [
        ("Gauss points, 1e16", How::Gauss, PARTIAL.on(1e16), 4),
        ("exact kinks, 1e16", How::Exact, PARTIAL.on(1e16), 5),
        ("exact kinks, 1e8", How::Exact, PARTIAL, 3),
        ("Gauss points, 1e8", How::Gauss, PARTIAL, 2),
        ("by elements, 1e8", How::Elementwise, PARTIAL, 0),
        ("by elements, 1e16", How::Elementwise, PARTIAL.on(1e16), 1),
    ];
    let counted = |runs: &[(&str, How, Numbers, usize)]| -> Result<Vec<Curve>, Box<dyn Error>> {
        let curve = |&(name, how, ref numbers, look): &(&str, How, Numbers, usize)| {
            Ok(Curve::new(name, look, count(effort, numbers, how)?))
        };
        runs.iter().map(curve).collect()
    };
    let (full, partial) = (counted(&full)?, counted(&partial)?);
    let at = |curve: &Curve, stop: f64| curve.points.iter().find(|p| p.x == stop).map_or(f64::NAN, |p| p.y);
    let (stiff, soft) = (at(&full[0], 1e-3), at(&full[1], 1e-3));
    let most = |curve: &Curve| curve.points.iter().map(|p| p.y).fold(0.0, f64::max);
    let (newton, creeping, quick) = (most(&full[2]), most(&partial[0]), most(&partial[5]));
    let claims = [
        Claim {
            by: PAPER,
            said: "Newton's method needs about ten iterations at any tolerance",
            found: format!(
                "at most {newton} in full contact at k = 1e8. But with partial contact at k = 1e16 a cold start \
                 creeps: {creeping} iterations where contact is decided at points; and where it is decided by \
                 elements, the {quick} iterations end at a state in which the foundation pulls the beam"
            ),
            artefact: true,
            holds: newton <= 10.0 && creeping > 50.0 && partial[5].points.iter().all(|p| p.hollow),
            assumes: ASSUMED,
        },
        Claim {
            by: PAPER,
            said: "Bermúdez and Moreno's algorithm needs more than a thousand iterations below 1e-3",
            found: format!(
                "{stiff} at 1e-3 and k = {STIFF:e} with the best parameters; {soft} at k = 1e8: it is a matter of k"
            ),
            artefact: false,
            holds: stiff > 1000.0 && soft < 1000.0,
            assumes: ASSUMED,
        },
    ];
    let figure = |name: &str, caption: &str, title: &str, curves| Figure {
        name: name.into(),
        caption: caption.into(),
        plot: Plot {
            title: title.into(),
            x: Axis::logarithmic("stopping tolerance", "", "stop"),
            y: Axis::logarithmic("iterations", "", "iterations"),
            curves,
        },
    };
    let section = Section {
        title: "Fig. 6: iterations and the stopping tolerance".into(),
        text: vec![
            "Numbers behind the names are k in N/m^2. Iterations of this solver are those on all of its meshes \
             together, most of them on coarse ones."
                .into(),
        ],
        figures: vec![
            figure("fig6-full", "Fig. 6: iterations in full contact.", "Fig. 6: full contact", full),
            figure(
                "fig6-partial",
                "The same with partial contact; hollow: the foundation pulls the beam.",
                "Iterations, partial contact",
                partial,
            ),
        ],
        tables: Vec::new(),
    };
    Ok((section, claims))
}

fn worth() -> Result<(Section, Claim), Box<dyn Error>> {
    let x = even();
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    let mut last = Vec::new();
    for k in [1e8, 1e12, 1e16] {
        for how in COMPARED {
            let found = solved(&PARTIAL.on(k), how, ELEMENTS, &x)?;
            let middle = found.fields[x.len() / 2][0];
            rows.push(vec![
                format!("{k:e}"),
                how.name().to_owned(),
                found.iterations.to_string(),
                quantity(middle, "m", 6),
                found.lowest.map_or("-".into(), |p| quantity(p, "N/m", 2)),
                rough(found.residual),
                found.status.to_owned(),
            ]);
            if k == 1e16 {
                let line = x.iter().zip(&found.fields).map(|(&x, f)| (x, f[0]));
                curves.push(Curve::line(how.name(), how.look(), line));
                last.push((middle, found));
            }
        }
    }
    let [(wrong, quiet), _, (right, ours)] = last.as_slice() else {
        return Err("a method is missing".into());
    };
    let claim = Claim {
        by: OURS,
        said: "what the active set by elements converges to so fast can be wrong, and is told",
        found: format!(
            "at k = 1e16 after {} iterations ξ(L/2) = {}, {} times too small; its status is {}",
            quiet.iterations,
            quantity(*wrong, "m", 3),
            significant(right / wrong, 2),
            quiet.status
        ),
        artefact: false,
        holds: quiet.status == "foundation_pulls" && ours.converged() && right / wrong > 100.0,
        assumes: "",
    };
    let table = Table {
        name: "fast-convergence".into(),
        caption: "Partial contact on 100 elements; k in N/m^2.".into(),
        header: header(&["k", "method", "iterations", "ξ(L/2)", "lowest pressure", "residual", "status"]),
        rows,
    };
    let figure = Figure {
        name: "fig5-methods".into(),
        caption: "Bending with partial contact at k = 1e16 N/m^2: by elements the beam stays glued to the foundation."
            .into(),
        plot: Plot {
            title: "Partial contact at k = 1e16".into(),
            x: along(),
            y: Axis::linear("bending ξ", "m", "bending"),
            curves,
        },
    };
    let section = Section {
        title: "What fast convergence is worth".into(),
        text: Vec::new(),
        figures: vec![figure],
        tables: vec![table],
    };
    Ok((section, claim))
}

fn convergence() -> Result<(Section, [Claim; 2]), Box<dyn Error>> {
    let tenths: Vec<_> = (1..10).map(|i| f64::from(i) / 10.0).collect();
    let (bending, by_bending) = bending_errors(&tenths)?;
    let (mut figures, mut slopes) = (vec![bending], Vec::new());
    for (field, number, name, label) in
        [(1, 8, "stretching", "stretching u"), (2, 9, "potential", "potential q")]
    {
        let (figure, slope) = linear_errors(field, number, name, label)?;
        figures.push(figure);
        slopes.push(slope);
    }
    let [u, q] = slopes.as_slice() else { return Err("a field is missing".into()) };
    let linear = Claim {
        by: PAPER,
        said: "u and q converge linearly",
        found: format!(
            "that is what slopes of the piecewise linear u and q do: orders {} and {}. The functions themselves are \
             of order {} and {}. What this solver gives anywhere in the beam is off by {} at most, and by {} from h \
             = 1e-2 on",
            significant(u.slope, 3),
            significant(q.slope, 3),
            significant(u.linear, 3),
            significant(q.linear, 3),
            rough(u.ours[0].max(q.ours[0])),
            rough(u.ours[1].max(q.ours[1]))
        ),
        artefact: false,
        holds: slopes.iter().all(|s| {
            (0.9..1.1).contains(&s.slope)
                && (1.8..2.2).contains(&s.linear)
                && s.ours[0] < 1e-10
                && s.ours[1] < 1e-14
        }),
        assumes: ASSUMED,
    };
    let section = Section {
        title: "Figs. 7 to 9: errors against h".into(),
        text: vec![
            "In full contact no element has an edge of contact in it, so that the active set by elements is the \
             exact one. The naive recursion eliminates nodal values, as the paper's (3.8) reads; the conduction \
             term, 1e-8 of the contact force, is left out of it."
                .into(),
        ],
        figures,
        tables: Vec::new(),
    };
    Ok((section, [by_bending, linear]))
}

fn over_h(title: String, label: &str, curves: Vec<Curve>) -> Plot {
    let x = Axis::logarithmic("element length h", "m", "h");
    let y = Axis::error(format!("relative error of {label}"));
    Plot { title, x, y, curves }
}

fn bending_errors(at: &[f64]) -> Result<(Figure, Claim), Box<dyn Error>> {
    let exact = reference::at(&EXAMPLE, at)?;
    let naive = |n: usize| -> Vec<Field> {
        let all = naive::deflections(EXAMPLE.bending, EXAMPLE.stiffness, EXAMPLE.transverse[0], n);
        at.iter().map(|x| [all[(x * n as f64).round() as usize], 1.0, 1.0]).collect()
    };
    let fine = naive(FINE);
    let mut sets = [const { Vec::new() }; 3];
    for n in DIVISORS.into_iter().chain([FINE]) {
        let h = 1.0 / n as f64;
        let found = solved(&EXAMPLE, How::Exact, n, at)?;
        let coarse = naive(n);
        sets[0].push(Point::at(h, errors(&found.fields, &exact)[0]));
        sets[1].push(Point::at(h, errors(&coarse, &exact)[0]));
        if n < FINE {
            sets[2].push(Point::at(h, errors(&coarse, &fine)[0]));
        }
    }
    let steep = |points: &[Point], most: f64| {
        let fitted = points.iter().filter(|p| p.y > 1e-13 && p.x <= most);
        exponent(fitted.map(|p| (p.x, p.y)))
    };
    let (ours, theirs) = (steep(&sets[0], 1.0), steep(&sets[2], 0.01));
    let off = sets[1].last().map_or(f64::NAN, |p| p.y);
    let claim = Claim {
        by: PAPER,
        said: "xi converges slower, against a reference computed at h = 1e-4",
        found: format!(
            "bending is of order {}. A reference at h = 1e-4 by the recursion in nodal values is itself off by {}, \
             so that errors against it do not fall below that: order {} from h = 1e-2 on",
            significant(ours, 3),
            rough(off),
            significant(theirs, 2)
        ),
        artefact: true,
        holds: ours > 3.7 && theirs < 1.0 && off > 1e-7,
        assumes: "The paper does not say how its systems are solved; that they are eliminated node by node is \
                  assumed.",
    };
    let [first, second, third] = sets;
    let curves = vec![
        Curve::new("naive, to h = 1e-4", 0, third),
        Curve::new("naive", 1, second),
        Curve::new("this solver", 3, first),
    ];
    let figure = Figure {
        name: "fig7-bending".into(),
        caption: "Fig. 7: error of bending at tenths of the beam; the first curve against the naive solution at h = \
                  1e-4, as the paper measures it, the others against the reference."
            .into(),
        plot: over_h("Fig. 7: bending".into(), "bending", curves),
    };
    Ok((figure, claim))
}

/// Orders of a piecewise linear field and of its slope, and the largest error of this solver's, on all meshes and on
/// those with h <= 0.01.
struct Orders {
    linear: f64,
    slope: f64,
    ours: [f64; 2],
}

fn linear_errors(
    field: usize,
    number: usize,
    name: &str,
    label: &str,
) -> Result<(Figure, Orders), Box<dyn Error>> {
    /// Half the distance of two points of which the reference's slope is the difference \[m\].
    const BESIDE: f64 = 1e-5;
    let x = points();
    let exact = reference::of(&EXAMPLE)?;
    let beside =
        |sign: f64| reference::at(&EXAMPLE, &x.iter().map(|x| x + sign * BESIDE).collect::<Vec<_>>());
    let slopes: Vec<Field> = (beside(1.0)?.iter().zip(beside(-1.0)?))
        .map(|(right, left)| [0.0, 1.0, 2.0].map(|_| (right[field] - left[field]) / (2.0 * BESIDE)))
        .collect();
    let mut sets = [const { Vec::new() }; 3];
    for n in DIVISORS {
        let h = 1.0 / n as f64;
        let nodes: Vec<_> = (0..=n).map(|i| i as f64 * h).collect();
        let at_nodes = solved(&EXAMPLE, How::Exact, n, &nodes)?.fields;
        let between = solved(&EXAMPLE, How::Exact, n, &x)?.fields;
        let mut linear = exact.clone();
        let mut steps = slopes.clone();
        for (i, x) in x.iter().enumerate() {
            let left = ((x * n as f64) as usize).min(n - 1);
            let (a, b) = (at_nodes[left][field], at_nodes[left + 1][field]);
            linear[i][field] = a + (b - a) * (x * n as f64 - left as f64);
            steps[i][field] = (b - a) / h;
        }
        sets[0].push(Point::at(h, errors(&steps, &slopes)[field]));
        sets[1].push(Point::at(h, errors(&linear, &exact)[field]));
        sets[2].push(Point::at(h, errors(&between, &exact)[field]));
    }
    let fit = |points: &[Point]| exponent(points.iter().map(|p| (p.x, p.y)));
    let [slope, linear, ours] = sets;
    let orders = Orders {
        linear: fit(&linear),
        slope: fit(&slope),
        ours: [1.0, 0.01].map(|h| ours.iter().filter(|p| p.x <= h).map(|p| p.y).fold(0.0, f64::max)),
    };
    let curves = vec![
        Curve::new("slope, linear", 0, slope),
        Curve::new("linear", 1, linear),
        Curve::new("this solver", 3, ours),
    ];
    let figure = Figure {
        name: format!("fig{number}-{name}"),
        caption: format!(
            "Fig. {number}: error of {label}, of the function that is linear between nodes, of its slope, and of \
             what this solver gives between nodes."
        ),
        plot: over_h(format!("Fig. {number}: {label}"), label, curves),
    };
    Ok((figure, orders))
}
