//! The command line: what may be asked, and the help texts that explain it.
//!
//! Every length is in metres, every force in newtons, every potential in volts, as in the scene files.

use std::path::{Path, PathBuf};

use crate::output;
use clap::builder::RangedU64ValueParser;
use clap::error::ErrorKind;
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use piezobeam::{BermudezMoreno, Method, Real};

use crate::sweep::{Shard, Vary};

const EXAMPLES: &str = "\
Examples:
  piezobeam check beam.toml                       is the scene sound, is its solution unique?
  piezobeam solve beam.toml                       a summary for people
  piezobeam solve beam.toml --plot beam.svg       ... and one page of pictures
  piezobeam solve beam.toml --format json | jq .contact.force
  piezobeam sweep beam.toml --vary foundation.stiffness=log:1e0:1e16:17 --out k.csv
  piezobeam paper --out paper                     the figures of the paper, recomputed
  piezobeam report --quick                        errors, run times, the paper's figures: one page
  piezobeam extremes --quick                      does it hold at the edges of what can be asked?

Exit status:
  0  the solve converged (sweep: all did; check, paper, time, extremes, report: all went well)
  1  the solve did not converge, or not to the --tolerance; the best iterate is still reported, marked as such
  2  bad input: the command line, the scene file, or an output that cannot be written";

const SOLVE: &str = "\
Examples:
  piezobeam solve beam.toml --elements 400
  piezobeam solve beam.toml --tolerance 1e-8
  piezobeam solve beam.toml --samples 101 --format csv --out beam.csv
  piezobeam solve beam.toml --format json --out beam.json --plot beam.svg --force
  piezobeam solve beam.toml --sensitivities
  piezobeam solve beam.toml --method elementwise

Units of the samples: x, bending and stretching in m; slope in m/m; moment in N m; shear and
axial_force in N; potential in V; electric_displacement in C.
Bending is positive towards the foundation.
A field the scene does not have is null in JSON and an empty cell in CSV.";

const SWEEP: &str = "\
Examples:
  piezobeam sweep beam.toml --vary foundation.stiffness=log:1e0:1e16:17 --out k.csv --plot k.svg
  piezobeam sweep beam.toml --vary load.axial=lin:0:1e6:5 --vary mesh.elements=100,200,400
  piezobeam sweep beam.toml --vary load.points[0].x=lin:0.1:0.9:81 --shard $TASK/8 --out part-$TASK.csv

Values are lin:FROM:TO:COUNT, log:FROM:TO:COUNT (both with both ends) or a list; of several --vary all
combinations are solved, the last one varying fastest. Any number of the scene file can be varied, by its path.

While it runs, rows are kept in FILE.partial: run the same command again and it goes on where it was. The table is
the same to the last byte for any --jobs, and the shards I/N of it, one after the other, are the whole.

Columns: the varied numbers, status, residual, iterations, visits, elements, max_bending (m, the largest in size
with its sign) and max_bending_x, contact_force (N), contact_length (m), left_ and right_force (N) and _moment
(N m), bending_energy (J), certified, warnings. A scene that is none is a row with the status bad_input.

Exit status 1: a row is not converged.";

const EXTREMES: &str = "\
Examples:
  piezobeam extremes --quick
  piezobeam extremes --format json | jq '.groups[].rows[] | select(.verdict == \"wrong\")'
  piezobeam extremes --format markdown --out docs/extremes.md --force

Exit status 1: a row is wrong, that is, it did not end as the table says that it should.";

const REPORT: &str = "\
Example:
  piezobeam report --quick --out report

Writes report.html, which loads nothing from elsewhere, and the numbers of each picture and table as CSV. The full report
takes some minutes; times are those of this machine.

Exit status 1: something that is said does not hold, or a part has no data.";

/// Static equilibrium of a piezoelectric beam, clamped at both ends, on a deformable foundation.
#[derive(Debug, Parser)]
#[command(name = "piezobeam", version, about, after_help = EXAMPLES, max_term_width = 110)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve a scene and report its fields, contact zones and reactions
    #[command(after_help = SOLVE)]
    Solve(SolveArgs),
    /// Read a scene, say what it contains, whether its solution is known to be unique, and what to beware of
    #[command(after_help = "Example:\n  piezobeam check beam.toml")]
    Check(CheckArgs),
    /// Solve a scene with many values of its numbers, and make a table
    #[command(after_help = SWEEP)]
    Sweep(SweepArgs),
    /// Recompute the examples of the paper and draw its figures as SVG files
    #[command(after_help = "Example:\n  piezobeam paper --out figures --force")]
    Paper(PaperArgs),
    /// Compute anew what is said of errors, run times, the paper and stability: one page, and its data
    #[command(after_help = REPORT)]
    Report(ReportArgs),
    /// Measure how long a scene takes to solve
    #[command(after_help = "Example:\n  piezobeam time beam.toml --elements 10000 --repeat 20 --format json")]
    Time(TimeArgs),
    /// Solve scenes with extreme data and meshes, and compare each end with what is expected of it
    #[command(after_help = EXTREMES)]
    Extremes(ExtremesArgs),
}

#[derive(Debug, Args)]
pub struct SolveArgs {
    /// Scene file (TOML, SI units)
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Number of elements over the length of the beam [default: what the scene asks for]
    #[arg(long, value_name = "N", value_parser = elements())]
    pub elements: Option<usize>,
    /// Make a mesh for this relative error of bending, such as 1e-8; the elements asked for are where it starts
    /// [default: 16]
    #[arg(long, value_name = "ERROR", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// Floating-point type of the solve; the report is in f64 in either case
    #[arg(long, value_enum, value_name = "TYPE", default_value_t = Precision::F64)]
    pub precision: Precision,
    /// Stop once the relative residual (no unit) is below this [default: 1e-10 with f64, 1e-5 with f32]
    #[arg(long, value_name = "TOLERANCE", value_parser = tolerance)]
    pub stop: Option<f64>,
    /// Number of points, evenly spaced from 0 to the length, both included, at which fields are reported
    #[arg(long, value_name = "K", default_value_t = 33,
          value_parser = RangedU64ValueParser::<usize>::new().range(2..=1_000_000))]
    pub samples: usize,
    /// text for people, json with full-precision numbers, csv with one row per sample
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    pub format: Format,
    #[command(flatten)]
    pub method: MethodArgs,
    /// Add derivatives of bending, contact force, reactions and potential to the scene's parameters
    #[arg(long)]
    pub sensitivities: bool,
    /// Write the report to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Draw the solution on one page (beam and foundation, moment, shear, electric fields)
    #[arg(long, value_name = "FILE.svg", value_parser = svg_path)]
    pub plot: Option<PathBuf>,
    /// Replace output files that exist
    #[arg(long)]
    pub force: bool,
}

/// Which method, and what it leaves open.
#[derive(Debug, Clone, Copy, Default, Args)]
pub struct MethodArgs {
    /// How to solve; all but newton are the paper's own methods, to compare with: held to the same test, they
    /// rarely converge
    #[arg(long, value_enum, value_name = "METHOD", default_value_t = MethodName::Newton)]
    pub method: MethodName,
    /// bermudez-moreno: stiffness of the linear problems, N/m^2 [default: sqrt(a1 k), a1 that of the first mode]
    #[arg(long, value_name = "OMEGA", value_parser = positive)]
    pub omega: Option<f64>,
    /// bermudez-moreno: parameter of the regularisation, m^2/N, at most and by default 1 / (2 omega)
    #[arg(long, value_name = "MU", value_parser = positive)]
    pub mu: Option<f64>,
    /// bermudez-moreno: share of an update that is taken, at most 1 [default: (1 + s) / (1 + 2 s), s = sqrt(a1 / k)]
    #[arg(long, value_name = "RHO", value_parser = positive)]
    pub rho: Option<f64>,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Scene file (TOML, SI units)
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
}

#[derive(Debug, Args)]
pub struct SweepArgs {
    /// Scene file (TOML, SI units)
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// A number of the scene and its values, as foundation.stiffness=log:1e0:1e16:17
    #[arg(long, value_name = "FIELD=VALUES", required = true)]
    pub vary: Vec<Vary>,
    /// Scenes solved at once [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = RangedU64ValueParser::<usize>::new().range(1..=4096))]
    pub jobs: Option<usize>,
    /// Solve the I-th of N parts of the table only, counted from 1; the first has the header
    #[arg(long, value_name = "I/N", default_value = "1/1", hide_default_value = true)]
    pub shard: Shard,
    /// Number of elements over the length of the beam [default: what the scene asks for]
    #[arg(long, value_name = "N", value_parser = elements())]
    pub elements: Option<usize>,
    /// Floating-point type of the solves; the table is in f64 in either case
    #[arg(long, value_enum, value_name = "TYPE", default_value_t = Precision::F64)]
    pub precision: Precision,
    /// Stop once the relative residual (no unit) is below this [default: 1e-10 with f64, 1e-5 with f32]
    #[arg(long, value_name = "TOLERANCE", value_parser = tolerance)]
    pub stop: Option<f64>,
    #[command(flatten)]
    pub method: MethodArgs,
    /// Write the table to this file instead of standard output
    #[arg(long, value_name = "FILE.csv|.parquet", value_parser = table_path)]
    pub out: Option<PathBuf>,
    /// Draw the table over the first --vary, a curve for each combination of the others
    #[arg(long, value_name = "FILE.svg", value_parser = svg_path)]
    pub plot: Option<PathBuf>,
    /// Replace output files that exist
    #[arg(long)]
    pub force: bool,
}

impl SweepArgs {
    /// The table is asked for as Parquet.
    #[cfg(feature = "parquet")]
    pub fn is_parquet(&self) -> bool {
        self.out.as_deref().is_some_and(|path| has_extension(path, "parquet"))
    }

    fn conflict(&self) -> Option<String> {
        if let Some(message) = self.method.conflict() {
            return Some(message);
        }
        if self.elements.is_some() && self.vary.iter().any(|one| one.path == "mesh.elements") {
            return Some(
                "--elements overrides mesh.elements, which --vary varies; leave one of them out".into(),
            );
        }
        if self.plot.is_some() && self.shard != Shard::WHOLE {
            return Some("--plot draws the whole table; leave it out where --shard asks for a part".into());
        }
        None
    }
}

#[derive(Debug, Args)]
pub struct PaperArgs {
    /// Directory for the figures; made if it is not there
    #[arg(long, value_name = "DIR", default_value = "paper")]
    pub out: PathBuf,
    /// Replace output files that exist
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub struct ReportArgs {
    /// Leave out what takes more than some seconds
    #[arg(long)]
    pub quick: bool,
    /// Directory for the page and its data; made if it is not there
    #[arg(long, value_name = "DIR", default_value = "report")]
    pub out: PathBuf,
    /// Replace output files that exist
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub struct TimeArgs {
    /// Scene file (TOML, SI units)
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Number of elements over the length of the beam [default: what the scene asks for]
    #[arg(long, value_name = "N", value_parser = elements())]
    pub elements: Option<usize>,
    /// Number of solves to measure, each from the same cold start
    #[arg(long, value_name = "R", default_value_t = 100,
          value_parser = RangedU64ValueParser::<usize>::new().range(1..=1_000_000))]
    pub repeat: usize,
    /// Floating-point type of the solve
    #[arg(long, value_enum, value_name = "TYPE", default_value_t = Precision::F64)]
    pub precision: Precision,
    /// text for people, json with times in nanoseconds
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = TimeFormat::Text)]
    pub format: TimeFormat,
}

#[derive(Debug, Args)]
pub struct ExtremesArgs {
    /// Leave out meshes of more than 100 elements
    #[arg(long)]
    pub quick: bool,
    /// text for people, markdown for documents, json for machines
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = TableFormat::Text)]
    pub format: TableFormat,
    /// Write the table to this file instead of standard output
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace an output file that exists
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Precision {
    F64,
    F32,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Newton's method with the contact integrated up to its edges
    #[default]
    Newton,
    /// Newton's method with contact decided at four Gauss points per element
    Gauss,
    /// Newton's method with an element in contact as a whole where its midpoint is: (3.7)-(3.8) of the paper
    Elementwise,
    /// The algorithm (3.3) of Bermúdez and Moreno
    BermudezMoreno,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Text,
    Json,
    Csv,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TimeFormat {
    Text,
    Json,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TableFormat {
    Text,
    Markdown,
    Json,
}

impl Cli {
    /// Reads the process's arguments; prints the help or the usage error and exits where there is one.
    pub fn read() -> Self {
        let cli = Self::parse();
        match cli.conflict() {
            Some(message) => Self::command().error(ErrorKind::ArgumentConflict, message).exit(),
            None => cli,
        }
    }

    /// What clap's declarations cannot say: two outputs must be two files, and none may be the scene.
    fn conflict(&self) -> Option<String> {
        let args = match &self.command {
            Command::Solve(args) => args,
            Command::Sweep(args) => return args.conflict(),
            _ => return None,
        };
        if let Some(message) = args.method.conflict() {
            return Some(message);
        }
        if args.tolerance.is_some() && args.precision == Precision::F32 {
            return Some("--tolerance makes meshes in double precision; leave --precision f32 out".into());
        }
        if args.method.method != MethodName::Newton && args.precision == Precision::F32 {
            return Some("--method compares in double precision; leave --precision f32 out".into());
        }
        if args.tolerance.is_some() && args.method.method != MethodName::Newton {
            return Some("--tolerance makes meshes for Newton's method; leave --method out".into());
        }
        if args.sensitivities && args.format == Format::Csv {
            return Some("csv holds samples only; ask for --sensitivities with --format text or json".into());
        }
        let same = |a: &Option<PathBuf>, b: Option<&PathBuf>| {
            a.as_deref().zip(b).is_some_and(|(a, b)| output::same(a, b))
        };
        if same(&args.out, args.plot.as_ref()) {
            return Some("--out and --plot name the same file; give each its own".into());
        }
        let scene = Some(&args.scene);
        if same(&args.out, scene) || same(&args.plot, scene) {
            return Some("an output names the scene file itself; give another name".into());
        }
        None
    }
}

impl MethodName {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Newton => "newton",
            Self::Gauss => "gauss",
            Self::Elementwise => "elementwise",
            Self::BermudezMoreno => "bermudez-moreno",
        }
    }
}

impl MethodArgs {
    /// The library's method in its precision; `None` is its own.
    pub fn method<T: Real>(&self) -> Option<Method<T>> {
        let number = |value: Option<f64>| value.map(T::of);
        match self.method {
            MethodName::Newton => None,
            MethodName::Gauss => Some(Method::Gauss),
            MethodName::Elementwise => Some(Method::Elementwise),
            MethodName::BermudezMoreno => Some(Method::BermudezMoreno(BermudezMoreno {
                omega: number(self.omega),
                mu: number(self.mu),
                rho: number(self.rho),
            })),
        }
    }

    fn conflict(&self) -> Option<String> {
        let given = [("--omega", self.omega), ("--mu", self.mu), ("--rho", self.rho)];
        let (name, _) = given.iter().find(|(_, value)| value.is_some())?;
        let other = self.method != MethodName::BermudezMoreno;
        other.then(|| format!("{name} belongs to --method bermudez-moreno; add that, or leave it out"))
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a positive number, such as 0.5".into()),
    }
}

fn elements() -> RangedU64ValueParser<usize> {
    RangedU64ValueParser::new().range(1..=10_000_000)
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        _ => Err("expected a number between 0 and 1, such as 1e-10".into()),
    }
}

fn svg_path(text: &str) -> Result<PathBuf, String> {
    let path = Path::new(text);
    match has_extension(path, "svg") {
        true => Ok(path.to_owned()),
        false => Err("the picture is an SVG file; give it a name that ends in .svg".into()),
    }
}

fn table_path(text: &str) -> Result<PathBuf, String> {
    let path = Path::new(text);
    if has_extension(path, "parquet") && !cfg!(feature = "parquet") {
        return Err("this build writes no Parquet; build it with --features parquet, or ask for .csv".into());
    }
    match has_extension(path, "csv") || has_extension(path, "parquet") {
        true => Ok(path.to_owned()),
        false => Err("the table is CSV or Parquet; give it a name that ends in .csv or .parquet".into()),
    }
}

fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve(line: &str) -> SolveArgs {
        match Cli::try_parse_from(line.split_whitespace()).unwrap().command {
            Command::Solve(args) => args,
            other => panic!("{other:?}"),
        }
    }

    fn refused(line: &str) -> clap::Error {
        Cli::try_parse_from(line.split_whitespace()).unwrap_err()
    }

    #[test]
    fn declarations_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn defaults() {
        let args = solve("piezobeam solve a.toml");
        assert_eq!((args.samples, args.format, args.force), (33, Format::Text, false));
        assert_eq!((args.elements, args.precision), (None, Precision::F64));
        assert_eq!(solve("piezobeam solve a.toml --stop 1e-7").stop, Some(1e-7));
        let Command::Paper(paper) = Cli::try_parse_from(["piezobeam", "paper"]).unwrap().command else {
            panic!()
        };
        assert_eq!(paper.out, Path::new("paper"));
        let Command::Time(time) = Cli::try_parse_from(["piezobeam", "time", "a.toml"]).unwrap().command
        else {
            panic!()
        };
        assert_eq!((time.repeat, time.format), (100, TimeFormat::Text));
    }

    #[test]
    fn bad_values_are_usage_errors() {
        for line in [
            "piezobeam solve",
            "piezobeam solve a.toml --samples 1",
            "piezobeam solve a.toml --samples 1000001",
            "piezobeam solve a.toml --elements 0",
            "piezobeam solve a.toml --stop nan",
            "piezobeam solve a.toml --stop 0",
            "piezobeam solve a.toml --method simplex",
            "piezobeam solve a.toml --method bermudez-moreno --rho 0",
            "piezobeam solve a.toml --plot a.png",
            "piezobeam sweep a.toml",
            "piezobeam sweep a.toml --vary load.axial",
            "piezobeam sweep a.toml --vary load.axial=1 --shard 3/2",
            "piezobeam sweep a.toml --vary load.axial=1 --jobs 0",
            "piezobeam sweep a.toml --vary load.axial=1 --out a.txt",
            "piezobeam time a.toml --repeat 0",
            "piezobeam time a.toml --format csv",
        ] {
            assert_eq!(refused(line).exit_code(), 2, "{line}");
        }
        let message = refused("piezobeam solve a.toml --plot a.png").to_string();
        assert!(message.contains("ends in .svg"), "{message}");
        assert_eq!(refused("piezobeam solve --help").exit_code(), 0);
    }

    #[test]
    fn outputs_must_differ() {
        let conflict = |line: &str| Cli::try_parse_from(line.split_whitespace()).unwrap().conflict();
        assert!(conflict("piezobeam solve a.toml --out b.svg --plot b.svg").is_some());
        assert!(conflict("piezobeam solve a.toml --out a.toml --force").is_some());
        assert!(conflict("piezobeam solve a.toml --out b.json --plot b.svg").is_none());
        assert!(conflict("piezobeam solve a.toml --sensitivities --format csv").is_some());
        assert!(conflict("piezobeam solve a.toml --sensitivities --format json").is_none());
        assert!(conflict("piezobeam sweep a.toml --vary mesh.elements=9,10 --elements 5").is_some());
        assert!(conflict("piezobeam sweep a.toml --vary length=1,2 --shard 1/2 --plot a.svg").is_some());
        assert!(conflict("piezobeam sweep a.toml --vary length=1,2 --plot a.svg").is_none());
        assert!(conflict("piezobeam solve a.toml --rho 0.5").is_some());
        assert!(conflict("piezobeam solve a.toml --rho 0.5 --method bermudez-moreno").is_none());
    }

    #[test]
    fn help_carries_examples_and_units() {
        let mut command = Cli::command();
        assert!(command.render_long_help().to_string().contains("Exit status:"));
        let solve = command.find_subcommand_mut("solve").unwrap();
        let help = solve.render_long_help().to_string();
        assert!(help.contains("moment in N m") && help.contains("Examples:"));
    }
}
