//! What a scene leaves out costs nothing: time, memory and work of scenes with more and more in them.

use super::measure::Times;
use super::{Chapter, Claim, Effort, Figure, OURS, Section, Table, header};
use crate::render::plot::{Axis, Curve, Plot, Point};
use crate::render::{quantity, significant};
use crate::report::CONVERGED;
use piezobeam::{
    Beam, Conduction, Error, Foundation, HeapWorkspace, Linear, Load, Mesh, Model, Potential, Problem, Scene,
    Settings, Steps,
};
use std::hint::black_box;

/// One for each scene.
pub const STEPS: u64 = 5;

/// Elements of the table.
const ELEMENTS: usize = 1000;

/// Down on the left half, up on the right one.
const TRANSVERSE: Steps<'static, f64> = Steps { breaks: &[0.5], values: &[1e6, -1e6] };

/// A solve on a mesh.
struct Run {
    elements: usize,
    visits: usize,
    times: Times,
    status: &'static str,
}

/// A scene's runs.
struct Costs {
    name: &'static str,
    bytes: usize,
    runs: Vec<Run>,
}

/// Computes the chapter.
pub fn chapter(effort: &Effort) -> Result<Chapter, Box<dyn std::error::Error>> {
    let bending = Load { transverse: TRANSVERSE, axial: (), points: () };
    let both = Load { transverse: TRANSVERSE, axial: 1e6, points: () };
    let foundation = Foundation { law: Linear(1e8), gap: () };
    let stretched = Beam { bending: 5e3, axial: 1e5, piezo: (), permittivity: () };
    let whole = Beam { bending: 5e3, axial: 1e5, piezo: 100.0, permittivity: 1.0 };
    let ends = Potential { left: 1.0, right: 1.0 };
    let electric = Scene::new(1.0, whole).foundation(foundation).load(both).potential(ends);
    let all = vec![
        costs(effort, "bending only", Scene::new(1.0, Beam::elastic(5e3)).load(bending))?,
        costs(
            effort,
            "with contact",
            Scene::new(1.0, Beam::elastic(5e3)).foundation(foundation).load(bending),
        )?,
        costs(effort, "with stretching", Scene::new(1.0, stretched).foundation(foundation).load(both))?,
        costs(effort, "one-way", electric.conduction(Conduction::new((), 1.0, 1.0)))?,
        costs(effort, "fully coupled", electric.conduction(Conduction::new(1.0, 1.0, 1.0)))?,
    ];
    let converged = all.iter().flat_map(|c| &c.runs).all(|run| run.status == CONVERGED);
    let lean = all.windows(2).all(|pair| pair[0].bytes <= pair[1].bytes) && all[0].bytes < all[4].bytes;
    let at = |costs: &Costs| {
        costs.runs.iter().find(|run| run.elements == ELEMENTS).map_or(f64::NAN, |r| r.times.best)
    };
    let (first, last) = (&all[0], &all[4]);
    let claim = Claim {
        by: OURS,
        said: "what a scene lacks takes no memory and no time",
        found: format!(
            "bending alone takes {} of the {} bytes per element of the whole scene, and {} times less time on \
             {ELEMENTS} elements",
            first.bytes,
            last.bytes,
            significant(at(last) / at(first), 2)
        ),
        artefact: false,
        holds: converged && lean && at(first) < at(last),
        assumes: "",
    };
    let rows = all.iter().map(|costs| {
        let run = costs.runs.iter().find(|run| run.elements == ELEMENTS);
        let cell = |get: &dyn Fn(&Run) -> String| run.map_or("-".into(), get);
        vec![
            costs.name.to_owned(),
            costs.bytes.to_string(),
            cell(&|run| quantity(run.times.best, "s", 3)),
            cell(&|run| quantity(run.times.best / run.elements as f64, "s", 3)),
            cell(&|run| run.visits.to_string()),
            cell(&|run| quantity(run.times.best / run.visits as f64, "s", 3)),
        ]
    });
    let table = Table {
        name: "left-out".into(),
        caption: format!(
            "Scenes with more and more in them, a solve from nothing on {ELEMENTS} elements, f64."
        ),
        header: header(&["scene", "bytes per element", "time", "per element", "element visits", "per visit"]),
        rows: rows.collect(),
    };
    let section = Section {
        title: "Time, memory, work".into(),
        text: vec![
            "Partial contact. One-way: the penetration drives a current, the potential does not act on bending. \
             Bytes are those of the workspace. Instructions are not counted here; `benches/left_out.sh` counts them \
             exactly."
                .into(),
        ],
        figures: vec![
            figure(&all, "left-out-time", "Time per element", Axis::linear("time per element", "s", "seconds"), |run| {
                run.times.best / run.elements as f64
            }),
            figure(
                &all,
                "left-out-visits",
                "Visits per element",
                Axis::linear("visits per element", "", "visits"),
                |run| run.visits as f64 / run.elements as f64,
            ),
        ],
        tables: vec![table],
    };
    let introduction = vec![
        "The parts of a scene are types: a part that is not there is not compiled. Five programs in one, each as if \
         the others were not."
            .into(),
    ];
    Ok(Chapter {
        name: "left-out",
        title: "What a scene leaves out",
        introduction,
        claims: vec![claim],
        sections: vec![section],
    })
}

fn figure(all: &[Costs], name: &str, title: &str, y: Axis, get: fn(&Run) -> f64) -> Figure {
    let curves = all.iter().enumerate().map(|(look, costs)| {
        let points = costs.runs.iter().map(|run| Point {
            x: run.elements as f64,
            y: get(run),
            status: run.status,
            ..Point::default()
        });
        Curve::new(costs.name, look, points.collect())
    });
    let x = Axis::logarithmic("elements", "", "elements");
    Figure {
        name: name.into(),
        caption: format!("{title} of the mesh, a solve from nothing."),
        plot: Plot { title: title.into(), x, y, curves: curves.collect() },
    }
}

// One function per scene, so that each is compiled as in a program that has no other.
#[inline(never)]
fn costs<M: Model<f64>>(effort: &Effort, name: &'static str, scene: M) -> Result<Costs, Error> {
    let elements: &[usize] =
        effort.pick(&[100, 1000, 10_000], &[100, 300, 1000, 3000, 10_000, 30_000, 100_000]);
    let mut runs = Vec::new();
    let mut memory = HeapWorkspace::new();
    for &elements in elements {
        let problem = Problem::new(&scene, Mesh::uniform(elements))?;
        let (mut visits, mut status) = (0, "");
        let times = Times::of(effort.pick(0.02, 0.5), || {
            let problem = black_box(&problem);
            let solution = problem.solve(&mut memory, &Settings::default())?;
            (visits, status) = (solution.report().element_visits, solution.report().status.name());
            Ok(())
        })?;
        runs.push(Run { elements, visits, times, status });
    }
    effort.step();
    Ok(Costs { name, bytes: HeapWorkspace::<f64, M>::BYTES_PER_ELEMENT, runs })
}
