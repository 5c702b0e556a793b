//! Sweeps as a user meets them: the same table however it comes about.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test that panics has failed")]
#![cfg(feature = "cli")]

use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const HALVES: &str = include_str!("../scenes/halves.toml");
const VARY: &str =
    "--vary foundation.stiffness=log:1e2:1e10:9 --vary load.transverse.values[1]=lin:-1e6:1e6:3";
/// Columns after the varied numbers.
const COLUMNS: usize = 16;

fn command(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_piezobeam"));
    command.args(line.split_whitespace()).current_dir(folder);
    command
}

fn piezobeam(folder: &Path, line: &str) -> Output {
    command(folder, line).output().expect("the program runs")
}

/// A folder with a scene of 40 elements.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(&folder, "scene.toml", &HALVES.replace("elements = 1000", "elements = 40"));
    folder
}

fn write(folder: &tempfile::TempDir, name: &str, text: &str) {
    std::fs::write(folder.path().join(name), text).expect("a file");
}

fn read(folder: &tempfile::TempDir, name: &str) -> String {
    std::fs::read_to_string(folder.path().join(name)).expect("a file")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Runs a sweep that has to end with `code`, and gives what it says.
fn sweep(folder: &tempfile::TempDir, line: &str, code: i32) -> Output {
    let output = piezobeam(folder.path(), &format!("sweep scene.toml {line}"));
    assert_eq!(output.status.code(), Some(code), "{line}: {}", text(&output.stderr));
    output
}

fn refusal(folder: &tempfile::TempDir, line: &str) -> String {
    let output = sweep(folder, line, 2);
    assert!(output.stdout.is_empty(), "{line} printed a table");
    text(&output.stderr)
}

#[test]
fn a_row_is_what_solve_says_of_the_scene() {
    let folder = folder();
    let table = text(&sweep(&folder, VARY, 0).stdout);
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().expect("a header").clone();
    assert_eq!((&header[0], &header[1]), ("foundation.stiffness", "load.transverse.values[1]"));
    assert_eq!(header.len(), 2 + COLUMNS);
    let rows: Vec<_> = reader.records().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), 27);
    let at = |row: &csv::StringRecord, name: &str| -> f64 {
        let column = header.iter().position(|cell| cell == name).expect("a column");
        row[column].parse().expect("a number")
    };
    // The last number varies fastest: row 19 is 1e8 and 0.
    let row = &rows[19];
    assert_eq!((&row[0], &row[1], &row[2]), ("100000000.0", "0.0", "converged"));
    let scene = HALVES.replace("elements = 1000", "elements = 40").replace("-1e6", "0");
    write(&folder, "one.toml", &scene);
    let output = piezobeam(folder.path(), "solve one.toml --format json --samples 2001");
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let number = |path: &str| value.pointer(path).and_then(serde_json::Value::as_f64).expect("a number");
    for (column, path) in [
        ("residual", "/residual"),
        ("iterations", "/iterations"),
        ("visits", "/element_visits"),
        ("elements", "/elements"),
        ("contact_force", "/contact/force"),
        ("left_force", "/resultants/left/force"),
        ("left_moment", "/resultants/left/moment"),
        ("right_force", "/resultants/right/force"),
        ("right_moment", "/resultants/right/moment"),
        ("bending_energy", "/resultants/bending_energy"),
    ] {
        assert_eq!(at(row, column), number(path), "{column}");
    }
    let zones = value["contact"]["zones"].as_array().expect("zones");
    let length: f64 = zones.iter().map(|z| z[1].as_f64().unwrap() - z[0].as_f64().unwrap()).sum();
    assert!((at(row, "contact_length") - length).abs() < 1e-12);
    // The summit is at least as high as any sample, and near the highest.
    let bending: Vec<f64> =
        value["samples"]["bending"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    let most = bending.iter().fold(0.0_f64, |most, v| if v.abs() > most.abs() { *v } else { most });
    let (found, x) = (at(row, "max_bending"), at(row, "max_bending_x"));
    assert!(found.abs() >= most.abs() && (found - most).abs() < 1e-6 * most.abs(), "{found} {most}");
    let sample = bending.iter().position(|v| *v == most).unwrap() as f64 / 2000.0;
    assert!((x - sample).abs() <= 1.0 / 2000.0, "{x} {sample}");
    assert_eq!(&row[2 + 14], "true");
    assert!(row[2 + 15].contains("axial strain"));
}

#[test]
fn threads_and_shards_make_the_same_bytes() {
    let folder = folder();
    sweep(&folder, &format!("{VARY} --jobs 1 --out one.csv"), 0);
    sweep(&folder, &format!("{VARY} --jobs 4 --out four.csv"), 0);
    let whole = read(&folder, "one.csv");
    assert_eq!(whole.lines().count(), 28);
    assert_eq!(read(&folder, "four.csv"), whole);
    assert_eq!(text(&sweep(&folder, VARY, 0).stdout), whole);
    for shards in [2, 5, 30] {
        let mut parts = String::new();
        for shard in 1..=shards {
            let name = format!("part{shard}of{shards}.csv");
            sweep(&folder, &format!("{VARY} --shard {shard}/{shards} --out {name}"), 0);
            parts += &read(&folder, &name);
        }
        assert_eq!(parts, whole, "{shards} shards");
    }
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().file_name()).collect();
    assert!(left.iter().all(|name| !name.to_string_lossy().contains("partial")), "{left:?}");
}

#[test]
fn a_killed_run_resumes_where_it_was() {
    let folder = folder();
    // Scenes that take some time: duality on a stiff foundation.
    let line = "--vary foundation.stiffness=lin:4e10:6e10:24 --method bermudez-moreno --jobs 2";
    let mut child = command(folder.path(), &format!("sweep scene.toml {line} --out a.csv"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program runs");
    let partial = folder.path().join("a.csv.partial");
    let rows = || std::fs::read_to_string(&partial).map_or(0, |text| text.lines().count());
    let begin = Instant::now();
    while rows() < 3 && begin.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("it can be killed");
    child.wait().expect("it ends");
    let before = rows();
    assert!((3..25).contains(&before), "killed too late to tell anything: {before} lines");
    assert!(!folder.path().join("a.csv").exists(), "half a table is none");

    // A torn last line is solved again; a whole one is believed, which a mark in it shows.
    let journal = read(&folder, "a.csv.partial");
    let marked = journal.replacen(",own_equations,", ",marked,", 1) + "23,60000000000.0,own";
    write(&folder, "a.csv.partial", &marked);
    sweep(&folder, &format!("{line} --out a.csv"), 1);
    sweep(&folder, &format!("{line} --out b.csv"), 1);
    let (resumed, whole) = (read(&folder, "a.csv"), read(&folder, "b.csv"));
    assert_eq!(resumed.matches(",marked,").count(), 1);
    assert_eq!(resumed.replace(",marked,", ",own_equations,"), whole);
    assert!(!partial.exists());
}

#[test]
fn a_journal_of_another_sweep_is_refused() {
    let folder = folder();
    write(&folder, "a.csv.partial", "piezobeam sweep 0123456789abcdef\n");
    let message = refusal(&folder, &format!("{VARY} --out a.csv"));
    assert!(message.contains("a.csv.partial holds rows of another sweep"), "{message}");
    write(&folder, "a.csv", "mine");
    assert!(refusal(&folder, &format!("{VARY} --out a.csv")).contains("--force"));
    assert_eq!(read(&folder, "a.csv"), "mine");
}

#[test]
fn scenes_that_fail_are_rows_with_their_status() {
    let folder = folder();
    let output = sweep(&folder, "--vary beam.bending=-1,5e3,0 --vary load.transverse.breaks[0]=0.5,2", 1);
    let table = text(&output.stdout);
    let statuses: Vec<_> = table.lines().skip(1).map(|row| row.split(',').nth(2).unwrap()).collect();
    assert_eq!(statuses, ["bad_input", "bad_input", "converged", "bad_input", "bad_input", "bad_input"]);
    assert!(table.contains("scene.toml:6: beam.bending at x = "), "{table}");
    assert!(table.contains("2 is not inside the beam"), "{table}");
    assert!(table.lines().all(|row| csv_cells(row) == 2 + COLUMNS), "{table}");
    assert!(text(&output.stderr).contains("5 of 6 scenes did not converge"));

    let table = text(&sweep(&folder, "--vary foundation.stiffness=1e12 --method elementwise", 1).stdout);
    assert!(table.contains(",foundation_pulls,"), "{table}");
    let table = text(&sweep(&folder, "--vary foundation.stiffness=1e8 --stop 1e-17", 1).stdout);
    assert!(table.contains(",tolerance_below_floor,"), "{table}");
}

fn csv_cells(row: &str) -> usize {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(row.as_bytes());
    reader.records().next().expect("a row").expect("cells").len()
}

#[test]
fn what_cannot_be_varied_is_said_with_what_was_meant() {
    let folder = folder();
    for (vary, meant) in [
        ("foundation.stifness=1,2", "did you mean \"foundation.stiffness\"?"),
        ("stiffness=1,2", "did you mean \"foundation.stiffness\"?"),
        ("load.transverse=1,2", "its numbers are load.transverse.breaks[0], load.transverse.values[0]"),
        ("foundation.exponent=1,2", "does not give this number; add it to the file"),
        ("colour=1,2", "it has length, beam.bending"),
        ("load.axial=exp:1:2:3", "\"exp\" is no kind of spacing"),
        ("load.axial=log:0:2:3", "spaced in their logarithm are positive"),
        ("load.axial", "expected FIELD=lin:FROM:TO:COUNT"),
        ("load.axial=1 --vary load.axial=2", "given twice"),
        ("load.axial=lin:0:1:10000 --vary length=lin:1:2:1001", "more than 10000000 scenes"),
        ("load.axial=1 --shard 0/4", "counted from 1"),
        ("load.axial=1 --out a.txt", "ends in .csv or .parquet"),
        ("load.axial=1,2 --shard 1/2 --plot a.svg", "--plot draws the whole table"),
        ("mesh.elements=10,20 --elements 5", "--elements overrides mesh.elements"),
    ] {
        let message = refusal(&folder, &format!("--vary {vary}"));
        assert!(message.contains(meant), "{vary}: {message}");
    }
    write(&folder, "scene.toml", "length = 1.0\n");
    assert!(refusal(&folder, "--vary length=1,2").contains("beam"), "the scene itself has to be one");
}

#[test]
fn a_table_can_be_drawn() {
    let folder = folder();
    let line = format!("{VARY} --method gauss --out a.csv --plot a.svg");
    sweep(&folder, &line, 1);
    let page = read(&folder, "a.svg");
    let xml = roxmltree::Document::parse(&page).expect("a picture");
    let words: Vec<_> = (xml.descendants().filter(|n| n.has_tag_name("text")))
        .filter_map(|n| n.text())
        .map(str::trim)
        .collect();
    for wanted in [
        "scene.toml",
        "Largest bending [m]",
        "Contact force [kN]",
        "foundation.stiffness [N/m²]",
        "1e10",
        "load.transverse.values[1] = 0",
    ] {
        assert!(words.contains(&wanted), "no {wanted:?} in {words:?}");
    }
    assert!(words.iter().any(|word| word.contains("not converged (hollow)")), "{words:?}");
}

#[cfg(not(feature = "parquet"))]
#[test]
fn a_build_without_parquet_says_how_to_get_it() {
    let folder = folder();
    assert!(refusal(&folder, "--vary load.axial=1,2 --out a.parquet").contains("--features parquet"));
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_holds_the_numbers_of_the_csv() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    let folder = folder();
    let line = "--vary foundation.stiffness=1e8,-1,1e4 --out";
    sweep(&folder, &format!("{line} a.csv"), 1);
    sweep(&folder, &format!("{line} a.parquet"), 1);
    let file = std::fs::File::open(folder.path().join("a.parquet")).expect("a file");
    let reader = SerializedFileReader::new(file).expect("Parquet");
    let rows: Vec<_> = reader.get_row_iter(None).expect("rows").map(|row| row.expect("a row")).collect();
    let csv = read(&folder, "a.csv");
    let mut csv = csv::Reader::from_reader(csv.as_bytes());
    let header = csv.headers().expect("a header").clone();
    let expected: Vec<_> = csv.records().map(|row| row.expect("a row")).collect();
    assert_eq!(rows.len(), 3);
    for (row, expected) in rows.iter().zip(&expected) {
        for (((name, field), header), cell) in row.get_column_iter().zip(&header).zip(expected) {
            assert_eq!(name, header);
            match field {
                Field::Null => assert_eq!(cell, "", "{name}"),
                Field::Double(value) => assert_eq!(*value, cell.parse::<f64>().unwrap(), "{name}"),
                Field::Long(value) => assert_eq!(*value, cell.parse::<i64>().unwrap(), "{name}"),
                Field::Str(value) => assert_eq!(value, cell, "{name}"),
                other => panic!("{name}: {other:?}"),
            }
        }
    }
}
