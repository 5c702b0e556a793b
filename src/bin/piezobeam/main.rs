//! The command line: read, compute, render, write.

#![allow(unreachable_pub, reason = "modules of a binary: `pub` says what others of them may use")]
#![allow(clippy::expect_used, reason = "renderers draw into memory, which cannot fail; each place says why")]
#![cfg_attr(test, allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics has failed"))]

mod chapters;
mod cli;
mod extremes;
mod model;
mod output;
mod paper;
mod profile;
mod render;
mod report;
mod scene_file;
mod sensitivities;
mod sweep;
mod tasks;

use cli::{
    CheckArgs, Cli, Command, ExtremesArgs, Format, PaperArgs, ReportArgs, SolveArgs, SweepArgs, TableFormat,
    TimeArgs, TimeFormat,
};
use indicatif::{ProgressBar, ProgressStyle};
use report::{Checked, Picture};
use scene_file::SceneFile;
use std::path::PathBuf;
use std::process::ExitCode;

/// Points of a picture's curves, whatever is asked for in numbers.
const PICTURE_SAMPLES: usize = 513;

/// Points among which a summary looks for extremes.
const TEXT_SAMPLES: usize = 2001;

/// Elements on which the search for a mesh starts.
const FIRST_ELEMENTS: usize = 16;

/// How a run ends: 0 converged, 1 not converged, 2 bad input (as an `Err`).
type Outcome = Result<bool, Box<dyn std::error::Error>>;

fn main() -> ExitCode {
    let outcome = match Cli::read().command {
        Command::Solve(args) => solve(&args),
        Command::Check(args) => check(&args),
        Command::Sweep(args) => sweep(&args),
        Command::Paper(args) => paper(&args),
        Command::Report(args) => report(&args),
        Command::Time(args) => time(&args),
        Command::Extremes(args) => extremes(&args),
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            output::complain(error);
            ExitCode::from(2)
        }
    }
}

fn solve(args: &SolveArgs) -> Outcome {
    for path in args.out.iter().chain(&args.plot) {
        output::check(path, args.force)?;
    }
    let file = scene_file::read(&args.scene)?;
    let run = |samples| {
        let SolveArgs { stop, tolerance, sensitivities, ref method, .. } = *args;
        let task = tasks::Solve { stop, tolerance, samples, sensitivities, method: *method };
        let elements = args.elements.or(tolerance.map(|_| FIRST_ELEMENTS));
        model::with(&file, elements, args.precision, task).map_err(|e| file.complaint(&e))
    };
    let samples = match args.format {
        // Extremes are looked for between the samples asked for, too.
        Format::Text => args.samples.max(TEXT_SAMPLES),
        Format::Json | Format::Csv => args.samples,
    };
    let picture = picture(&file, run(samples)?);
    let converged = picture.report.converged();
    let text = match args.format {
        Format::Text => render::text::solve(&picture),
        Format::Json => render::json::solve(&picture.report),
        Format::Csv => render::csv::solve(&picture.report.samples),
    };
    let mut files: Vec<(PathBuf, String)> = Vec::new();
    if let Some(plot) = &args.plot {
        let page = self::picture(&file, run(PICTURE_SAMPLES)?);
        files.push((plot.clone(), render::overview::solve(&page)));
    }
    match &args.out {
        Some(path) => files.push((path.clone(), text)),
        None => output::print(&text)?,
    }
    output::write_all(&files, args.force)?;
    if !converged && args.format != Format::Text {
        let reason = picture.report.reason.as_deref().unwrap_or_default();
        output::complain(format!("not converged ({}): {reason}", picture.report.status));
    }
    if let Some(missed) = picture.report.missed() {
        output::complain(format!("the tolerance {:e} was not reached: {}", missed.tolerance, missed.meaning));
    }
    Ok(converged && picture.report.missed().is_none())
}

fn check(args: &CheckArgs) -> Outcome {
    let file = scene_file::read(&args.scene)?;
    let (warnings, uniqueness, elements) =
        model::with(&file, None, cli::Precision::F64, tasks::Check).map_err(|e| file.complaint(&e))?;
    let checked = Checked {
        title: format!("{}\n\n{}", scene_file::printable(&file.name), file.describe()),
        facts: vec![("elements".into(), elements.to_string())],
        warnings,
        uniqueness,
    };
    output::print(&render::text::check(&checked))?;
    Ok(true)
}

fn sweep(args: &SweepArgs) -> Outcome {
    for path in args.out.iter().chain(&args.plot) {
        output::check(path, args.force)?;
    }
    let table = sweep::run(args, &progress(0, "scenes"))?;
    let mut files: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    if let Some(plot) = &args.plot {
        let name = args.scene.to_string_lossy();
        files.push((plot.clone(), render::sweep::plot(&table, &name).into_bytes()));
    }
    match &args.out {
        #[cfg(feature = "parquet")]
        Some(path) if args.is_parquet() => files.push((path.clone(), sweep::parquet::bytes(&table)?)),
        Some(path) => files.push((path.clone(), table.csv().into_bytes())),
        None => output::print(&table.csv())?,
    }
    output::write_all(&files, args.force)?;
    let (failed, scenes) = (table.failed(), table.len());
    table.finish();
    if failed > 0 {
        eprintln!("piezobeam: {failed} of {scenes} scenes did not converge; the column status says why");
    }
    Ok(failed == 0)
}

fn paper(args: &PaperArgs) -> Outcome {
    let paper::Paper { table, files, converged } = paper::run(&args.out)?;
    for (path, _) in &files {
        output::check(path, args.force)?;
    }
    output::make_directory(&args.out)?;
    output::write_all(&files, args.force)?;
    output::print(&table)?;
    Ok(converged)
}

fn report(args: &ReportArgs) -> Outcome {
    // Before minutes of work: the page is the first file that would be refused.
    output::check(&args.out.join("report.html"), args.force)?;
    let bar = progress(0, "steps");
    let document = chapters::run(args.quick, &bar)?;
    bar.finish_and_clear();
    let files = document.files(&args.out);
    for (path, _) in &files {
        output::check(path, args.force)?;
    }
    output::make_directory(&args.out)?;
    output::write_all(&files, args.force)?;
    let page = args.out.join("report.html");
    output::print(&format!(
        "{}\n{} and {} files beside it\n",
        document.summary(),
        output::shown(&page),
        files.len() - 1
    ))?;
    Ok(document.holds())
}

fn time(args: &TimeArgs) -> Outcome {
    let file = scene_file::read(&args.scene)?;
    // Drawn a few times a second at most: the solves are timed one by one.
    let bar = progress(args.repeat as u64, "solves");
    let task = tasks::Time { repeat: args.repeat, progress: &|| bar.inc(1) };
    let timing = model::with(&file, args.elements, args.precision, task).map_err(|e| file.complaint(&e))?;
    bar.finish_and_clear();
    output::print(&match args.format {
        TimeFormat::Text => render::text::time(&timing),
        TimeFormat::Json => render::json::time(&timing),
    })?;
    Ok(timing.status == report::CONVERGED)
}

fn extremes(args: &ExtremesArgs) -> Outcome {
    if let Some(path) = &args.out {
        output::check(path, args.force)?;
    }
    let table = extremes::run(args.quick);
    let text = match args.format {
        TableFormat::Text => render::extremes::text(&table),
        TableFormat::Markdown => render::extremes::markdown(&table),
        TableFormat::Json => render::json::extremes(&table),
    };
    match &args.out {
        Some(path) => output::write_all(&[(path, text)], args.force)?,
        None => output::print(&text)?,
    }
    if table.wrong > 0 {
        output::complain(format!("{} of {} rows are wrong", table.wrong, table.rows));
    }
    Ok(table.wrong == 0)
}

/// How far it is, on a terminal only.
fn progress(length: u64, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if let Ok(style) =
        ProgressStyle::with_template(&format!("{{bar:40}} {{pos}}/{{len}} {what}, {{eta}} left"))
    {
        bar.set_style(style);
    }
    bar
}

fn picture(file: &SceneFile, solved: tasks::Solved) -> Picture {
    Picture {
        title: scene_file::printable(&file.name),
        length: file.length,
        gap: solved.gap,
        facts: file.facts(),
        report: solved.report,
    }
}
