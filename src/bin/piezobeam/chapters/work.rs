//! Error against run time, against elements, and time against elements.

use super::measure::{How, METHODS, Measured, Size, measure};
use super::scenes::{ALL, COUPLED, Numbers, PARTIAL, RIGID};
use super::{Chapter, Claim, Effort, Figure, OURS, Section, Table, exponent, header, reference, rough};
use crate::render::plot::{Axis, Curve, Plot, Point};
use crate::render::{capital, quantity, significant};
use std::error::Error;

/// A step for each method, precision and scene, and one for each scene's times.
pub const STEPS: u64 = (METHODS.len() * 2 * ALL.len() + ALL.len()) as u64;

/// Errors that a table asks the time of.
const GOALS: [f64; 3] = [1e-3, 1e-6, 1e-9];
/// Orders are fitted to errors between these: below, there is rounding, above, meshes too coarse for the scene.
const FITTED: (f64, f64) = (1e-12, 1e-3);
/// Digits that adaptive meshes are asked for; references are made for 13.
const DIGITS: i32 = 11;
/// Elements longer than so many widths (C/k)^(1/4) of the contact's layer say nothing of the order.
const RESOLVED: f64 = 8.0;

const FIELDS: [(&str, &str); 3] =
    [("bending", "bending"), ("stretching", "stretching u"), ("potential", "potential q")];

/// What all methods find of a scene in a precision, in the order of [`METHODS`].
type Sets = Vec<Vec<Measured>>;

/// A scene with what was measured of it.
struct Studied {
    numbers: Numbers,
    double: Sets,
    single: Sets,
    /// Seconds on so many elements.
    times: Vec<Measured>,
}

/// Computes the chapter.
pub fn chapter(effort: &Effort) -> Result<Chapter, Box<dyn Error>> {
    let studied = ALL.iter().map(|numbers| study(effort, numbers)).collect::<Result<Vec<_>, _>>()?;
    let mut sections: Vec<_> = studied.iter().map(against_time).collect();
    let (costs, cheaper) = costs(&studied);
    let (orders, fourth) = against_elements(&studied);
    let (times, linear) = time_against_elements(&studied);
    sections.extend([costs, orders, times]);
    let claims = fourth.into_iter().chain([reached(&studied), cheaper, linear]).collect();
    let introduction = vec![
        "Errors are the largest difference to the reference among 101 points inside the beam, over the field's \
         largest value; the reference is the solver's own solution on a mesh made for 1e-13, which a test holds to \
         1e-12 against solutions by another method to 16 digits. A mark is one mesh, of 8 elements and on; an \
         adaptive mesh is one tolerance. A hollow mark is a solve whose own status says that it is no solution: the \
         foundation pulls the beam, the iteration goes in circles or ran out."
            .into(),
        format!(
            "Methods: “{}” is the paper's active set (3.7)-(3.8), “{}” its algorithm (3.3) with the best parameters, \
             “{}” decides contact at four points of each element, “{}” is this solver on uniform meshes, “{}” the \
             same on meshes that it makes for an accuracy.",
            How::Elementwise.name(),
            How::BermudezMoreno.name(),
            How::Gauss.name(),
            How::Exact.name(),
            How::Adaptive.name()
        )
        ,
    ];
    Ok(Chapter { name: "work", title: "Error against run time", introduction, claims, sections })
}

fn study(effort: &Effort, numbers: &Numbers) -> Result<Studied, Box<dyn Error>> {
    let reference = reference::of(numbers)?;
    let set = |double: bool| -> Result<Sets, Box<dyn Error>> {
        METHODS
            .iter()
            .map(|&how| {
                let sizes = sizes(effort, how, double);
                let most = effort.pick((1e-3, 60_000), (0.1, 5_000_000));
                let found = match double {
                    true => measure::<f64>(numbers, how, &sizes, &reference, most),
                    false => measure::<f32>(numbers, how, &sizes, &reference, most),
                }?;
                effort.step();
                Ok(found)
            })
            .collect()
    };
    let (double, single) = (set(true)?, set(false)?);
    let elements: &[usize] = effort.pick(
        &[100, 1000, 10_000, 40_000],
        &[100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000],
    );
    let sizes: Vec<_> = elements.iter().map(|&n| Size::Elements(n)).collect();
    let times = measure::<f64>(
        numbers,
        How::Exact,
        &sizes,
        &reference,
        effort.pick((0.01, usize::MAX), (0.3, usize::MAX)),
    )?;
    effort.step();
    Ok(Studied { numbers: *numbers, double, single, times })
}

fn sizes(effort: &Effort, how: How, double: bool) -> Vec<Size> {
    match (how, double) {
        (How::Adaptive, true) => (1..=DIGITS).map(|digits| Size::Tolerance(10f64.powi(-digits))).collect(),
        (How::Adaptive, false) => (1..=5).map(|digits| Size::Tolerance(10f64.powi(-digits))).collect(),
        _ => (3..=effort.pick(11, 16)).map(|power| Size::Elements(1 << power)).collect(),
    }
}

/// One scene's pictures.
fn against_time(studied: &Studied) -> Section {
    let Numbers { name, title, what, .. } = studied.numbers;
    let picture = |sets: &Sets, field: usize, precision: &str, suffix: &str| {
        let (key, label) = FIELDS[field];
        Figure {
            name: format!("work-{name}-{key}{suffix}"),
            caption: format!("{title}: error of {label} against the time of a solve, in {precision}."),
            plot: Plot {
                title: format!("{title}, {label}, {precision}"),
                x: Axis::logarithmic("time of a solve", "s", "seconds"),
                y: error_axis(label),
                curves: curves(sets, |m| (m.times.best, m.errors[field], m.times.slow - m.times.best)),
            },
        }
    };
    let figures = vec![
        picture(&studied.double, 0, "f64", ""),
        picture(&studied.single, 0, "f32", "-f32"),
        picture(&studied.double, 1, "f64", ""),
        picture(&studied.double, 2, "f64", ""),
    ];
    Section { title: title.into(), text: vec![format!("{}.", capital(what))], figures, tables: Vec::new() }
}

fn error_axis(field: &str) -> Axis {
    Axis::error(format!("relative error of {field}"))
}

fn curves(sets: &Sets, point: impl Fn(&Measured) -> (f64, f64, f64)) -> Vec<Curve> {
    let curve = |(how, set): (&How, &Vec<Measured>)| {
        let points = set.iter().map(|m| {
            let (x, y, spread) = point(m);
            Point { x, y, spread, status: m.found.status, hollow: m.found.hollow() }
        });
        Curve::new(how.name(), how.look(), points.collect())
    };
    METHODS.iter().zip(sets).map(curve).collect()
}

/// Best time of an error of at most `goal` on a mesh and on all finer ones, whatever the solve says of itself.
fn time_to(set: &[Measured], goal: f64) -> Option<f64> {
    let good = |m: &&Measured| m.errors[0] <= goal;
    let fine = set.iter().rev().take_while(good);
    fine.map(|m| m.times.best).min_by(f64::total_cmp)
}

fn costs(studied: &[Studied]) -> (Section, Claim) {
    let mut rows = Vec::new();
    let mut gains = Vec::new();
    for Studied { numbers, double, .. } in studied {
        for goal in GOALS {
            let times: Vec<_> = double.iter().map(|set| time_to(set, goal)).collect();
            let least = |of: &[Option<f64>]| of.iter().flatten().copied().min_by(f64::total_cmp);
            // In the order of METHODS: the paper's two, Gauss points, ours.
            let (paper, ours) = (least(&times[..2]), least(&times[3..]));
            let gain = match (paper, ours) {
                (Some(paper), Some(ours)) => {
                    gains.push((numbers.name, goal, paper / ours));
                    format!("{} times", significant(paper / ours, 2))
                }
                (None, Some(_)) => "paper: not reached".into(),
                _ => "-".into(),
            };
            let mut row = vec![numbers.title.to_owned(), format!("{goal:e}")];
            row.extend(times.iter().map(|time| time.map_or("-".into(), |t| quantity(t, "s", 2))));
            row.push(gain);
            rows.push(row);
        }
    }
    let edge = |name: &str| [PARTIAL.name, RIGID.name].contains(&name);
    let least = gains.iter().filter(|(name, goal, _)| edge(name) && *goal <= 1e-6).map(|g| g.2);
    let least = least.fold(f64::INFINITY, f64::min);
    let reached = studied.iter().all(|s| {
        let ours = |goal| s.double[3..].iter().any(|set| time_to(set, goal).is_some());
        GOALS.into_iter().all(ours)
    });
    let claim = Claim {
        by: OURS,
        said: "where the contact has an edge inside the beam, 1e-6 and 1e-9 cost less than by the paper's methods",
        found: match least.is_finite() {
            true => format!(
                "at least {} times less wherever these reach it on the meshes tried; all are reached by this solver",
                significant(least, 2)
            ),
            false => "these do not reach them on the meshes tried; this solver reaches all".into(),
        },
        artefact: false,
        holds: reached && least > 1.0,
        assumes: "the best of both of the paper's methods, in this implementation",
    };
    let mut names = vec!["scene", "error of bending"];
    names.extend(METHODS.map(How::name));
    names.push("gain over the paper");
    let table = Table {
        name: "time-to-error".into(),
        caption:
            "Shortest time of a solve after which the error of bending is below a bound, on that mesh and on all \
                  finer ones that were tried, also where the solve says of itself that it is none; the gain is over \
                  the faster one of the paper's two methods."
                .into(),
        header: header(&names),
        rows,
    };
    let section = Section {
        title: "Time to an accuracy".into(),
        text: Vec::new(),
        figures: Vec::new(),
        tables: vec![table],
    };
    (section, claim)
}

/// The order of an error of a method: minus the exponent of N.
fn order(studied: &Studied, how: How, field: usize) -> Option<f64> {
    let Numbers { bending, stiffness, .. } = studied.numbers;
    let coarsest = 1.0 / (RESOLVED * (bending / stiffness).powf(0.25));
    let fitted = |m: &&Measured| {
        let resolved = m.found.elements as f64 >= coarsest;
        resolved && (FITTED.0..FITTED.1).contains(&m.errors[field]) && m.found.settled
    };
    let set = &studied.double[how.look()];
    let points: Vec<_> =
        set.iter().filter(fitted).map(|m| (m.found.elements as f64, m.errors[field])).collect();
    let ends = points.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p.1), h.max(p.1)));
    // Fewer, or all alike, are no law.
    (points.len() >= 3 && ends.1 > 10.0 * ends.0).then(|| -exponent(points))
}

fn against_elements(studied: &[Studied]) -> (Section, [Claim; 2]) {
    let figures = studied.iter().map(|s| {
        let Numbers { name, title, .. } = s.numbers;
        Figure {
            name: format!("order-{name}"),
            caption: format!("{title}: error of bending against the number of elements, f64."),
            plot: Plot {
                title: format!("{title}, bending, f64"),
                x: Axis::logarithmic("elements", "", "elements"),
                y: error_axis("bending"),
                curves: curves(&s.double, |m| (m.found.elements as f64, m.errors[0], 0.0)),
            },
        }
    });
    let uniform = &METHODS[..4];
    let mut rows = Vec::new();
    for s in studied {
        for (field, (_, label)) in FIELDS.iter().enumerate() {
            let orders: Vec<_> = uniform.iter().map(|&how| order(s, how, field)).collect();
            if orders.iter().all(Option::is_none) {
                continue;
            }
            let mut row = vec![format!("{}, {label}", s.numbers.title)];
            row.extend(orders.iter().map(|o| o.map_or("-".into(), |o| significant(o, 2))));
            rows.push(row);
        }
    }
    let of = |name: &str, how: How| order(studied.iter().find(|s| s.numbers.name == name)?, how, 0);
    let ours: Vec<_> = studied.iter().filter_map(|s| order(s, How::Exact, 0)).collect();
    let (low, high) = ours.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), o| (l.min(*o), h.max(*o)));
    let theirs: Vec<_> = [PARTIAL.name, COUPLED.name]
        .into_iter()
        .flat_map(|name| [How::Elementwise, How::Gauss].map(|how| of(name, how)))
        .flatten()
        .collect();
    let best = theirs.iter().fold(0.0_f64, |most, order| most.max(*order));
    let claims = [
        Claim {
            by: OURS,
            said: "with kinks integrated exactly bending is of fourth order, whatever the contact",
            found: format!(
                "orders {} to {} in the scenes of this chapter",
                significant(low, 3),
                significant(high, 3)
            ),
            artefact: false,
            holds: ours.len() == studied.len() && low > 3.6,
            assumes: "",
        },
        Claim {
            by: OURS,
            said: "where the contact ends inside an element, deciding by elements or by points costs two orders",
            found: format!("orders of at most {} with partial contact", significant(best, 2)),
            artefact: false,
            holds: theirs.len() >= 3 && best < 3.0,
            assumes: "",
        },
    ];
    let names: Vec<_> = std::iter::once("field").chain(uniform.iter().map(|how| how.name())).collect();
    let table = Table {
        name: "orders".into(),
        caption: format!(
            "Orders p of errors c / N^p on uniform meshes, fitted to errors from {:e} to {:e} on elements no longer \
             than {RESOLVED} widths (C/k)^(1/4) of the layer at a contact's edge; a field without three of them, a \
             decade apart, is left out: it is exact to rounding, or far from it.",
            FITTED.0, FITTED.1
        ),
        header: header(&names),
        rows,
    };
    let section = Section {
        title: "Error against elements".into(),
        text: Vec::new(),
        figures: figures.collect(),
        tables: vec![table],
    };
    (section, claims)
}

fn reached(studied: &[Studied]) -> Claim {
    let tolerances = (1..=DIGITS).map(|digits| 10f64.powi(-digits));
    let mut worst = 0.0_f64;
    for s in studied {
        let pairs = s.double[How::Adaptive.look()].iter().zip(tolerances.clone());
        worst = pairs.fold(worst, |worst, (m, tolerance)| worst.max(m.errors[0] / tolerance));
    }
    Claim {
        by: OURS,
        said: "a mesh made for an accuracy has it",
        found: format!(
            "errors are at most {} of what was asked for, 1e-1 to 1e-{DIGITS}, in all four scenes",
            significant(worst, 2)
        ),
        artefact: false,
        holds: worst <= 1.0,
        assumes: "",
    }
}

fn time_against_elements(studied: &[Studied]) -> (Section, Claim) {
    let fit = |times: &[Measured]| exponent(times.iter().map(|m| (m.found.elements as f64, m.times.best)));
    let curves = studied.iter().enumerate().map(|(look, s)| {
        let points = s.times.iter().map(|m| Point {
            x: m.found.elements as f64,
            y: m.times.best,
            status: m.found.status,
            hollow: m.found.hollow(),
            spread: 0.0,
        });
        Curve::new(s.numbers.title, look, points.collect())
    });
    let exponents: Vec<_> = studied.iter().map(|s| fit(&s.times)).collect();
    let ends = |all: &[f64]| all.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), e| (l.min(*e), h.max(*e)));
    let (low, high) = ends(&exponents);
    // Times depend on what else runs; visits do not.
    let work =
        |times: &[Measured]| exponent(times.iter().map(|m| (m.found.elements as f64, m.found.visits as f64)));
    let visits: Vec<_> = studied.iter().map(|s| work(&s.times)).collect();
    let (least, most) = ends(&visits);
    let rows = studied.iter().flat_map(|s| {
        s.times.iter().map(|m| {
            vec![
                s.numbers.title.to_owned(),
                m.found.elements.to_string(),
                quantity(m.times.best, "s", 3),
                quantity(m.times.slow, "s", 3),
                quantity(m.times.best / m.found.elements as f64, "s", 3),
                significant(m.found.visits as f64 / m.found.elements as f64, 3),
                m.times.solves.to_string(),
                rough(m.errors[0]),
                m.found.status.to_owned(),
            ]
        })
    });
    let names = [
        "scene",
        "elements",
        "best",
        "3 in 4",
        "per element",
        "visits per element",
        "solves",
        "error",
        "status",
    ];
    let table = Table {
        name: "time-against-elements".into(),
        caption: format!(
            "Fitted to N^p: p = {}.",
            studied
                .iter()
                .zip(&exponents)
                .map(|(s, e)| format!("{} ({})", significant(*e, 3), s.numbers.title.to_lowercase()))
                .collect::<Vec<_>>()
                .join(", ")
        ),
        header: header(&names),
        rows: rows.collect(),
    };
    let claim = Claim {
        by: OURS,
        said: "the work of a solve grows like the number of elements",
        found: format!(
            "visits like N to the power of {} to {}, time like {} to {}",
            significant(least, 3),
            significant(most, 3),
            significant(low, 3),
            significant(high, 3)
        ),
        artefact: false,
        holds: least > 0.8
            && most < 1.2
            && high < 1.6
            && studied.iter().all(|s| s.times.iter().all(|m| m.found.settled)),
        assumes: "up to a million elements (40 000 in a quick run), of which the larger meshes no longer fit the \
                  caches",
    };
    let figure = Figure {
        name: "time-against-elements-curves".into(),
        caption: "Time of a solve against the number of elements, exact kinks on uniform meshes, f64.".into(),
        plot: Plot {
            title: "Time of a solve".into(),
            x: Axis::logarithmic("elements", "", "elements"),
            y: Axis::logarithmic("time of a solve", "s", "seconds"),
            curves: curves.collect(),
        },
    };
    let section = Section {
        title: "Time against elements".into(),
        text: Vec::new(),
        figures: vec![figure],
        tables: vec![table],
    };
    (section, claim)
}
