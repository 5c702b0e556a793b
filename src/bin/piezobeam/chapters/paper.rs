//! The paper reproduced: its figures, and what it says of penetration and of the methods' iterations.

use super::{Chapter, Claim, table};
use crate::cli::{MethodArgs, MethodName, Precision};
use crate::report::Report;
use crate::scene_file::Entries;
use crate::{model, paper, render, tasks};
use std::error::Error;
use std::path::Path;

const PAPER: &str = include_str!("../../../../scenes/paper.toml");
const HALVES: &str = include_str!("../../../../scenes/halves.toml");

/// Elements of the paper's meshes.
const ELEMENTS: usize = 100;
/// E of the paper, which it compares k with \[N/m^2\].
const YOUNG: f64 = 1e5;
/// k in which duality is slow, as the paper has it.
const STIFF: f64 = 1e12;
const STOPS: [f64; 4] = [1e-1, 1e-3, 1e-6, 1e-9];

/// Computes the chapter; `quick` leaves duality on a stiff foundation out.
pub fn chapter(quick: bool, out: &Path) -> Result<Chapter, Box<dyn Error>> {
    let (stiffness, penetration) = penetration()?;
    let (iterations, counted) = iterations(quick)?;
    let (worth, quiet) = worth()?;
    let paper::Paper { table, files, converged } = paper::run(&out.join("paper"))?;
    let pictures: String = (files.iter())
        .filter_map(|(path, _)| Some(path.strip_prefix(out).ok()?.display().to_string()))
        .map(|name| format!("![{name}]({name})\n"))
        .collect();
    let text = format!(
        "Its example, and the same with the load turned round on the right half.\n\n```text\n{table}```\n\n{pictures}\n\
         ### Penetration and the foundation's stiffness\n\nThe paper's example on {ELEMENTS} elements.\n\n{stiffness}\n\
         ### Iterations\n\nAt k = 1e8 N/m^2, and of duality at {STIFF:e}, on {ELEMENTS} elements; in brackets how it \
         ended, where not as converged.\n\n{iterations}\n\
         ### What fast convergence is worth\n\nThe load turned round on the right half, {ELEMENTS} elements.\n\n{worth}"
    );
    let figures = Claim {
        said: "Figs. 1-4 can be computed",
        found: format!("{} pictures, of converged solutions", files.len()),
        holds: converged,
    };
    let claims = [vec![figures], penetration, counted, quiet].into_iter().flatten().collect();
    Ok(Chapter { title: "The paper reproduced", text, files, claims })
}

/// A scene with the foundation's stiffness `k`, solved.
fn solved(text: &str, k: f64, method: MethodName, stop: Option<f64>) -> Result<Report, Box<dyn Error>> {
    let entries = Entries::of(text, "scene")?;
    let file = entries.with(&[(entries.entry("foundation.stiffness")?, k)])?;
    let method = MethodArgs { method, ..MethodArgs::default() };
    let task =
        tasks::Solve { stop, tolerance: None, samples: crate::PICTURE_SAMPLES, sensitivities: false, method };
    let solved = model::with(&file, Some(ELEMENTS), Precision::F64, task).map_err(|e| file.complaint(&e))?;
    Ok(solved.report)
}

/// Without a gap the largest bending is the deepest penetration.
fn deepest(report: &Report) -> f64 {
    report.samples.bending.iter().flatten().copied().fold(0.0, f64::max)
}

fn penetration() -> Result<(String, Vec<Claim>), Box<dyn Error>> {
    let mut rows = Vec::new();
    let mut depths = Vec::new();
    let mut converged = true;
    for decade in 0..=16 {
        let k = 10f64.powi(decade);
        let report = solved(PAPER, k, MethodName::Newton, None)?;
        let depth = deepest(&report);
        rows.push(vec![format!("{k:e}"), render::quantity(depth, "m", 6), report.iterations.to_string()]);
        depths.push((k, depth));
        converged &= report.converged();
    }
    let falls = depths.windows(2).all(|pair| pair[1].1 < pair[0].1);
    let first = depths[0].1;
    let loss = |most: f64| {
        let below = depths.iter().filter(|(k, _)| *k <= most);
        below.fold(0.0_f64, |loss, (_, depth)| loss.max(1.0 - depth / first))
    };
    let claims = vec![
        Claim {
            said: "penetration falls as k grows from 1 to 1e16",
            found: format!(
                "from {} to {}",
                render::quantity(first, "m", 4),
                render::quantity(depths[16].1, "m", 4)
            ),
            holds: falls && converged,
        },
        Claim {
            said: "this is visible only for k > E",
            found: format!(
                "{} % less at k = E, {} % less at k = 100 E",
                render::significant(100.0 * loss(YOUNG), 2),
                render::significant(100.0 * loss(100.0 * YOUNG), 2)
            ),
            holds: loss(YOUNG) < 0.05 && loss(100.0 * YOUNG) > 0.5,
        },
    ];
    Ok((table(&["k [N/m^2]", "deepest penetration", "iterations"], rows), claims))
}

fn iterations(quick: bool) -> Result<(String, Vec<Claim>), Box<dyn Error>> {
    let columns = STOPS.map(|stop| format!("stop {stop:e}"));
    let header: Vec<&str> =
        ["scene", "method"].into_iter().chain(columns.iter().map(String::as_str)).collect();
    let mut rows = Vec::new();
    let mut most_newton = 0;
    for (scene, text) in [("paper", PAPER), ("halves", HALVES)] {
        for method in
            [MethodName::Elementwise, MethodName::Gauss, MethodName::BermudezMoreno, MethodName::Newton]
        {
            let mut row = vec![scene.to_owned(), method.name().to_owned()];
            for stop in STOPS {
                let report = solved(text, 1e8, method, Some(stop))?;
                row.push(ended(&report));
                if method == MethodName::Elementwise {
                    most_newton = most_newton.max(report.iterations);
                }
            }
            rows.push(row);
        }
    }
    let mut claims = vec![Claim {
        said: "Newton's method needs about ten iterations at any tolerance",
        found: format!("{most_newton} at most, by elements at k = 1e8"),
        holds: most_newton <= 10,
    }];
    if !quick {
        let mut row = vec![format!("paper, k = {STIFF:e}"), MethodName::BermudezMoreno.name().to_owned()];
        let mut counts = Vec::new();
        for stop in STOPS {
            let report = solved(PAPER, STIFF, MethodName::BermudezMoreno, Some(stop))?;
            row.push(ended(&report));
            counts.push(report.iterations);
        }
        rows.push(row);
        claims.push(Claim {
            said: "Bermúdez and Moreno's algorithm needs more than a thousand below 1e-3",
            found: format!(
                "{} at 1e-3 and k = {STIFF:e} with the best parameters; fewer where k is small",
                counts[1]
            ),
            holds: counts[1] > 1000,
        });
    }
    Ok((table(&header, rows), claims))
}

fn ended(report: &Report) -> String {
    match report.converged() {
        true => report.iterations.to_string(),
        false => format!("{} ({})", report.iterations, report.status),
    }
}

fn worth() -> Result<(String, Vec<Claim>), Box<dyn Error>> {
    let mut rows = Vec::new();
    let mut found = Vec::new();
    for k in [1e8, 1e12, 1e16] {
        for method in [MethodName::Elementwise, MethodName::Newton] {
            let report = solved(HALVES, k, method, None)?;
            let bending = report.samples.bending.as_deref().unwrap_or_default();
            let middle = bending.get(bending.len() / 2).copied().unwrap_or(f64::NAN);
            let pressure =
                report.method.lowest_pressure.map_or("-".into(), |p| render::quantity(p, "N/m", 3));
            rows.push(vec![
                format!("{k:e}"),
                method.name().into(),
                report.iterations.to_string(),
                render::quantity(middle, "m", 6),
                pressure,
                report.status.clone(),
            ]);
            found.push((middle, report));
        }
    }
    let [.., (wrong, quiet), (right, ours)] = found.as_slice() else { return Ok(Default::default()) };
    let claim = Claim {
        said: "what the set by elements converges to so fast can be wrong: the foundation pulls",
        found: format!(
            "at k = 1e16 after {} iterations xi(L/2) = {}, {} times too small",
            quiet.iterations,
            render::quantity(*wrong, "m", 3),
            render::significant(right / wrong, 2)
        ),
        holds: quiet.status == "foundation_pulls" && ours.converged(),
    };
    let header = ["k [N/m^2]", "method", "iterations", "xi(L/2)", "lowest pressure", "status"];
    Ok((table(&header, rows), vec![claim]))
}
