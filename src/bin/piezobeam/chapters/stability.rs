//! Rounding of the recursions, foundations of any stiffness, the table of extremes, single precision.

use super::measure::{How, Measured, Size, errors, measure, points};
use super::scenes::{Number, PARTIAL};
use super::{Chapter, Claim, Effort, Figure, OURS, Section, Table, header, naive, reference, rough};
use crate::extremes::{self, Row, Verdict};
use crate::render::plot::{Axis, Curve, Plot, Point};
use crate::render::{capital, significant};
use crate::report::CONVERGED;
use piezobeam::{
    Beam, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, Problem, Scene, Settings, Steps,
};
use std::error::Error;

/// Rounding, stiffness, single precision, extremes.
pub const STEPS: u64 = 4;

const C: f64 = 5000.0;
const F: f64 = 1e6;
/// Above this the bending is compared with the closed form of the rigid limit, from which it is off by some
/// (C/k)^(3/4), 1e-10 of it at 1e20.
const RIGID: f64 = 1e19;

/// Computes the chapter.
pub fn chapter(effort: &Effort) -> Result<Chapter, Box<dyn Error>> {
    let (rounding, kept) = rounding(effort)?;
    effort.step();
    let (stiffness, any) = stiffness(effort)?;
    effort.step();
    let (single, claim) = single(effort)?;
    effort.step();
    let (table, ends) = table(effort);
    effort.step();
    Ok(Chapter {
        name: "stability",
        title: "Stability",
        introduction: Vec::new(),
        claims: vec![kept, any, claim, ends],
        sections: vec![rounding, stiffness, single, table],
    })
}

/// The deflection in the middle.
fn middle<T: Number, M: Model<T>>(scene: &M, n: usize) -> Result<f64, Box<dyn Error>> {
    let problem = Problem::new(scene, Mesh::uniform(n))?;
    let mut memory = HeapWorkspace::new();
    let solution = problem.solve(&mut memory, &Settings::default())?;
    Ok(solution.at(T::of(0.5)).bending.f64())
}

/// Under one value all along. Types are those of the chapter on what a scene leaves out, to compile them once.
fn uniform<T: Number>(value: &[T]) -> Load<Steps<'_, T>> {
    Load { transverse: Steps { breaks: &[], values: value }, axial: (), points: () }
}

fn free<T: Number>(load: &[T]) -> impl Model<T> {
    Scene::new(T::of(1.0), Beam::elastic(T::of(C))).load(uniform(load))
}

fn held(k: f64) -> impl Model<f64> {
    Scene::new(1.0, Beam::elastic(C)).foundation(Foundation { law: Linear(k), gap: () }).load(uniform(&[F]))
}

fn rounding(effort: &Effort) -> Result<(Section, Claim), Box<dyn Error>> {
    const SOFT: f64 = 1e8;
    let alone = F / (384.0 * C);
    let scene = held(SOFT);
    let problem = Problem::new(&scene, Mesh::uniform(16))?;
    let mut memory = HeapWorkspace::new();
    let pressed = problem.solve_to(&mut memory, 1e-13, &Settings::default())?.solution.at(0.5).bending;
    let finest = effort.pick(5, 6);
    let sizes: Vec<usize> =
        (1..=finest).flat_map(|power| [1, 3].map(|times| times * 10usize.pow(power))).collect();
    // An even number of elements has a node in the middle.
    let sizes: Vec<_> = sizes.into_iter().filter(|&n| n <= 10usize.pow(finest)).map(|n| n + n % 2).collect();
    let (mut naive_free, mut naive_held) = (Vec::new(), Vec::new());
    let (mut ours_free, mut ours_held, mut single) = (Vec::new(), Vec::new(), Vec::new());
    for &n in &sizes {
        let off = |found: f64, exact: f64| Point::at(n as f64, (found / exact - 1.0).abs());
        naive_free.push(off(naive::deflections(C, 0.0, F, n)[n / 2], alone));
        naive_held.push(off(naive::deflections(C, SOFT, F, n)[n / 2], pressed));
        ours_free.push(off(middle(&free(&[F]), n)?, alone));
        ours_held.push(off(middle(&scene, n)?, pressed));
        single.push(off(middle(&free(&[F as f32]), n)?, alone));
    }
    let at = |points: &[Point], n: f64| points.iter().find(|p| p.x == n).map_or(f64::NAN, |p| p.y);
    let most = |points: &[Point]| points.iter().map(|p| p.y).fold(0.0, f64::max);
    let fine = ours_held.iter().filter(|p| p.x >= 1e4).map(|p| p.y).fold(0.0, f64::max);
    let to_ten_thousand = single.iter().filter(|p| p.x <= 1e4).map(|p| p.y).fold(0.0, f64::max);
    let (lost, worst) = (at(&naive_free, 1e4), most(&ours_free));
    let claim = Claim {
        by: OURS,
        said: "the recursion in nodal values loses all digits on fine meshes, the one in relative unknowns none",
        found: format!(
            "in nodal values {} on 1e4 elements without contact and {} on 1e5; in relative unknowns {} at most, {} \
             with contact, up to {:.0e} elements; in f32 {} up to 1e4 elements",
            rough(lost),
            rough(at(&naive_free, 1e5)),
            rough(worst),
            rough(fine),
            10f64.powi(finest as i32),
            rough(to_ten_thousand)
        ),
        artefact: false,
        holds: lost > 1e-4 && worst < 1e-12 && fine < 1e-11 && to_ten_thousand < 1e-5,
        assumes: "",
    };
    let figure = |name: &str, title: &str, caption: &str, curves| Figure {
        name: name.into(),
        caption: caption.into(),
        plot: Plot {
            title: title.into(),
            x: Axis::logarithmic("elements", "", "elements"),
            y: Axis::error("relative error of ξ(L/2)"),
            curves,
        },
    };
    let figures = vec![
        figure(
            "rounding-free",
            "Rounding without contact",
            "No foundation: nodes are exact but for rounding.",
            vec![
                Curve::new("nodal values", 1, naive_free),
                Curve::new("this solver", 3, ours_free),
                Curve::new("the same, f32", 4, single),
            ],
        ),
        figure(
            "rounding-contact",
            "Rounding in contact",
            "In contact at k = 1e8 N/m^2: first the mesh's error, then rounding.",
            vec![Curve::new("nodal values", 1, naive_held), Curve::new("this solver", 3, ours_held)],
        ),
    ];
    let text = vec![
        "A uniform load on a clamped beam, C = 5000 N m^2. The naive recursion subtracts numbers of size C/h^3 to \
         get one of size C/x^3; in relative unknowns none of that size appears."
            .into(),
    ];
    let section = Section { title: "Rounding of the recursion".into(), text, figures, tables: Vec::new() };
    Ok((section, claim))
}

fn stiffness(effort: &Effort) -> Result<(Section, Claim), Box<dyn Error>> {
    let powers = [0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 25, 30, 50, 100, 150, 200, 250, 300];
    let meshes: &[usize] = effort.pick(&[100, 1000], &[100, 1000, 10_000]);
    let at = points();
    let limit = extremes::rigid_halves(C, F);
    let rigid: Vec<_> = at.iter().map(|&x| [limit(x), 1.0, 1.0]).collect();
    let mut off: Vec<Curve> = Vec::new();
    let mut visits: Vec<Curve> = Vec::new();
    for (look, n) in meshes.iter().enumerate() {
        off.push(Curve::new(format!("{n} elements"), look, Vec::new()));
        visits.push(Curve::new(format!("{n} elements"), look, Vec::new()));
    }
    for power in powers {
        let k = 10f64.powi(power);
        let scene = PARTIAL.on(k);
        let exact = if k > RIGID { rigid.clone() } else { reference::of(&scene)? };
        let given = scene.in_precision::<f64>();
        let whole = given.scene();
        let mut bench = super::measure::Bench::new(&whole);
        for (i, &n) in meshes.iter().enumerate() {
            let found = bench.find(How::Exact, Size::Elements(n), &at)?;
            let (status, hollow) = (found.status, found.hollow());
            let error = errors(&found.fields, &exact)[0];
            off[i].points.push(Point { x: k, y: error, spread: 0.0, status, hollow });
            let each = found.visits as f64 / found.elements as f64;
            visits[i].points.push(Point { x: k, y: each, spread: 0.0, status, hollow });
        }
    }
    let all =
        |curves: &[Curve], most: f64| curves.iter().flat_map(|c| &c.points).all(|p| !p.hollow && p.y <= most);
    let most = |curves: &[Curve]| curves.iter().flat_map(|c| &c.points).map(|p| p.y).fold(0.0, f64::max);
    let claim = Claim {
        by: OURS,
        said: "foundations of any stiffness are solved, up to 1e300 N/m^2, in bounded work",
        found: format!(
            "all converged; errors at most {} on {} elements and {} on {}; {} visits per element at most",
            rough(most(&off[..1])),
            meshes[0],
            rough(most(&off[1..2])),
            meshes[1],
            significant(most(&visits), 2)
        ),
        artefact: false,
        holds: all(&off[..1], 1e-4) && all(&off[1..], 1e-6) && most(&visits) <= 500.0,
        assumes: "from 1e20 on compared with the closed form of the rigid limit, from which the bending is 1e-10 off \
                  there",
    };
    let mut figures = Vec::new();
    for (most, name, title) in [(1e20, "", "up to 1e20"), (f64::INFINITY, "-all", "up to 1e300")] {
        for (curves, key, y, caption) in [
            (&off, "error", Axis::error("relative error of bending"), "Error of bending on uniform meshes."),
            (
                &visits,
                "visits",
                Axis::logarithmic("visits per element", "", "visits"),
                "Elements whose matrices were evaluated or re-factored, per element of the mesh.",
            ),
        ] {
            let mut curves = curves.clone();
            curves.iter_mut().for_each(|curve| curve.points.retain(|p| p.x <= most));
            figures.push(Figure {
                name: format!("stiffness-{key}{name}"),
                caption: caption.into(),
                plot: Plot {
                    title: format!("{}, k {title}", capital(key)),
                    x: Axis::logarithmic("stiffness k of the foundation", "N/m^2", "k"),
                    y,
                    curves,
                },
            });
        }
    }
    let text = vec![
        "Partial contact. Where the layer at the contact's edge, (C/k)^(1/4) wide, is thinner than an element, as from \
         1e16 N/m^2 on with 1000 elements, what is left is the mesh's own error. From 1e20 on the reference is the \
         rigid limit, from which the bending is 1e-10 off there."
            .into(),
    ];
    let section = Section { title: "Foundations of any stiffness".into(), text, figures, tables: Vec::new() };
    Ok((section, claim))
}

fn single(effort: &Effort) -> Result<(Section, Claim), Box<dyn Error>> {
    let exact = reference::of(&PARTIAL)?;
    let sizes: Vec<_> =
        (3..=effort.pick(15, 17)).step_by(2).map(|power| Size::Elements(1 << power)).collect();
    // Times are not asked for.
    let once = (0.0, usize::MAX);
    let single = measure::<f32>(&PARTIAL, How::Exact, &sizes, &exact, once)?;
    let double = measure::<f64>(&PARTIAL, How::Exact, &sizes, &exact, once)?;
    let curve = |name: &str, look: usize, set: &[Measured], field: usize| {
        let points = set.iter().map(|m| Point {
            x: m.found.elements as f64,
            y: m.errors[field],
            spread: 0.0,
            status: m.found.status,
            hollow: m.found.hollow(),
        });
        Curve::new(name, look, points.collect())
    };
    let settled = single.iter().all(|m| m.found.settled);
    let fine = single.iter().filter(|m| (100..=10_000).contains(&m.found.elements));
    let worst = fine.flat_map(|m| m.errors).fold(0.0, f64::max);
    let claim = Claim {
        by: OURS,
        said: "single precision gives five digits on meshes of 100 to 10 000 elements",
        found: format!("errors of bending, u and q are at most {} on them", rough(worst)),
        artefact: false,
        holds: settled && worst < 1e-5,
        assumes: "",
    };
    let figure = Figure {
        name: "single-precision".into(),
        caption: "Partial contact, exact kinks on uniform meshes: errors of the three fields in f32, and of bending \
                  in f64."
            .into(),
        plot: Plot {
            title: "Single precision".into(),
            x: Axis::logarithmic("elements", "", "elements"),
            y: Axis::error("relative error"),
            curves: vec![
                curve("bending, f32", 0, &single, 0),
                curve("u, f32", 1, &single, 1),
                curve("q, f32", 2, &single, 2),
                curve("bending, f64", 3, &double, 0),
            ],
        },
    };
    let section = Section {
        title: "Single precision".into(),
        text: Vec::new(),
        figures: vec![figure],
        tables: Vec::new(),
    };
    Ok((section, claim))
}

/// Is it called converged, and is not what it should be?
fn quiet(row: &Row) -> bool {
    let wrong = |remark: &String| {
        ["error ", "residual ", "a field", "the foundation pulls"].iter().any(|w| remark.starts_with(w))
    };
    row.status == CONVERGED && row.verdict == Verdict::Wrong && row.remarks.iter().any(wrong)
}

fn table(effort: &Effort) -> (Section, Claim) {
    let found = extremes::run(effort.quick);
    let count = |rows: &[Row], verdict| rows.iter().filter(|row| row.verdict == verdict).count().to_string();
    let worst = |rows: &[Row], precision: &str| {
        let rows = rows.iter().filter(|row| row.precision == precision);
        let most = rows.filter_map(|row| row.error).fold(f64::NAN, f64::max);
        if most.is_nan() { "-".into() } else { rough(most) }
    };
    let rows = found.groups.iter().map(|group| {
        vec![
            capital(group.name),
            group.rows.len().to_string(),
            count(&group.rows, Verdict::Ok),
            count(&group.rows, Verdict::Refused),
            count(&group.rows, Verdict::Wrong),
            worst(&group.rows, "f64"),
            worst(&group.rows, "f32"),
        ]
    });
    let mut tables = vec![Table {
        name: "extremes".into(),
        caption: format!(
            "Scenes with extreme data and meshes, each held to what it should give: rows of `piezobeam extremes{}`, \
             which lists them one by one. Errors near 1 are allowed where layers that no mesh here resolves are all of \
             the bending.",
            if effort.quick { " --quick" } else { "" }
        ),
        header: header(&["extreme", "rows", "ok", "refused", "wrong", "largest error, f64", "f32"]),
        rows: rows.collect(),
    }];
    let all = || found.groups.iter().flat_map(|group| &group.rows);
    let wrong: Vec<_> = all()
        .filter(|row| row.verdict == Verdict::Wrong)
        .map(|row| {
            vec![row.case.clone(), row.elements.to_string(), row.status.clone(), row.remarks.join("; ")]
        })
        .collect();
    if !wrong.is_empty() {
        tables.push(Table {
            name: "extremes-wrong".into(),
            caption: "Rows that did not end as they should.".into(),
            header: header(&["case", "elements", "status", "why"]),
            rows: wrong,
        });
    }
    let quietly = all().filter(|row| quiet(row)).count();
    let claim = Claim {
        by: OURS,
        said: "at the edges of what can be asked no wrong answer is called converged",
        found: format!(
            "{quietly} of {} rows are; {} did not end as they should, by work, by their reference or by a status \
             that says so",
            found.rows, found.wrong
        ),
        artefact: false,
        // Meshes of up to 100 elements have no wrong rows at all.
        holds: quietly == 0 && (!effort.quick || found.wrong == 0),
        assumes: "",
    };
    (Section { title: "Extremes".into(), text: Vec::new(), figures: Vec::new(), tables }, claim)
}
