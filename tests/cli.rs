//! The command line as a user meets it: exit statuses, messages, contracts.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test that panics has failed")]
#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{HALVES, folder, piezobeam, refusal, text, write};
use serde_json::Value;

fn json(folder: &tempfile::TempDir, line: &str) -> Value {
    let output = piezobeam(folder.path(), line);
    assert_eq!(output.status.code(), Some(0), "{line}: {}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

#[test]
fn a_solve_gives_the_reference_in_json() {
    let folder = folder();
    let value = json(&folder, "solve halves.toml --elements 1000 --format json --samples 33");
    assert_eq!(value["status"], "converged");
    assert_eq!(value["elements"], 1000);
    let reference: Value = serde_json::from_str(include_str!("reference/partial.json")).expect("JSON");
    for (column, name) in [("bending", "xi"), ("stretching", "u"), ("potential", "q")] {
        let list = |v: &Value| -> Vec<f64> {
            v.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
        };
        let got = list(&value["samples"][column]);
        let want = list(&reference["reference"][name]);
        let size = want.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let error = got.iter().zip(&want).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(error <= 1e-9 * size, "{column}: {error:e} of {size:e}");
    }
    let edge = value["contact"]["zones"][0][1].as_f64().expect("a zone");
    assert!((edge - reference["crossings"]["eta=0"][0].as_f64().expect("a crossing")).abs() < 1e-8);
    assert_eq!(value["uniqueness"]["certified"], true);
}

#[test]
fn what_a_scene_has_not_is_null() {
    let folder = folder();
    write(&folder, "free.toml", "length = 2.0\n[beam]\nbending = 3.0\n[load]\ntransverse = \"1 + x\"\n");
    let value = json(&folder, "solve free.toml --format json --samples 5");
    for name in ["stretching", "potential", "axial_force", "electric_displacement"] {
        assert_eq!(value["samples"][name], Value::Null, "{name}");
    }
    assert_eq!(value["contact"], Value::Null);
    assert_eq!(value["elements"], 200);
}

#[test]
fn every_shape_of_profile_is_the_same_scene() {
    let folder = folder();
    let shapes = [
        "5000.0",
        "{ polynomial = [5000.0] }",
        "{ breaks = [0.5], values = [5000.0, 5000.0] }",
        "{ breaks = [0.5], polynomials = [[5000.0], [5000.0]] }",
        "{ x = [0.0, 0.5, 1.0], y = [5000.0, 5000.0, 5000.0] }",
        "\"5000 + 0*x\"",
    ];
    let mut found = Vec::new();
    for shape in shapes {
        let scene = HALVES.replacen("bending = 5000.0", &format!("bending = {shape}"), 1);
        write(&folder, "shape.toml", &scene);
        let value = json(&folder, "solve shape.toml --elements 100 --format json --samples 3");
        found.push(value["samples"]["bending"][1].as_f64().expect("a number"));
    }
    for value in &found {
        assert!((value - found[0]).abs() <= 1e-14, "{found:?}");
    }
}

#[test]
fn single_precision_is_single() {
    let folder = folder();
    let value = json(&folder, "solve halves.toml --elements 100 --precision f32 --format json");
    assert_eq!(value["precision"], "f32");
    let middle = value["samples"]["bending"][16].as_f64().expect("a number");
    assert!((middle + 0.06371378).abs() < 1e-5, "{middle}");
}

#[test]
fn not_converging_exits_with_one_and_still_prints() {
    let folder = folder();
    let output = piezobeam(folder.path(), "solve halves.toml --stop 1e-17 --format json");
    assert_eq!(output.status.code(), Some(1));
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["status"], "tolerance_below_floor");
    assert!(value["reason"].as_str().is_some_and(|r| r.contains("rounding floor")));
    assert!(value["samples"]["bending"][16].as_f64().is_some_and(|v| (v + 0.0637138).abs() < 1e-6));
    assert!(text(&output.stderr).contains("not converged"));
}

#[test]
fn bad_scenes_are_refused_with_file_line_field_and_hint() {
    let folder = folder();
    let cases = [
        ("bending = 5000.0", "bending = -1.0", "bad.toml:6: beam.bending at x = "),
        ("stiffness = 1e8", "stifness = 1e8", "bad.toml:"),
        ("mu1 = 1.0", "mu1 = -1.0", "conduction.mu1 at x = "),
        ("breaks = [0.5]", "breaks = [1.5]", "load.transverse"),
        ("permittivity = 1.0", "", "beam.permittivity: expected because of potential, found nothing"),
        ("stiffness = 1e8", "stiffness = 1e8\ngap = { breaks = [0.5], values = [0.0, 1.0] }", "found a jump"),
        (
            "stiffness = 1e8",
            "stiffness = 1e8\nexponent = 0.5",
            "foundation.exponent: expected a finite number >= 1",
        ),
    ];
    for (from, to, expected) in cases {
        assert!(HALVES.contains(from), "{from}");
        write(&folder, "bad.toml", &HALVES.replacen(from, to, 1));
        let message = refusal(&folder, "solve bad.toml");
        assert!(message.contains("bad.toml:") && message.contains(expected), "{to}: {message}");
    }
    write(&folder, "bad.toml", &HALVES.replacen("stiffness", "stifness", 1));
    assert!(refusal(&folder, "solve bad.toml").contains("stiffness"), "the nearest key is named");
}

#[test]
fn files_that_are_no_scene_are_refused() {
    let folder = folder();
    std::fs::create_dir(folder.path().join("sub")).expect("a folder");
    assert!(refusal(&folder, "solve sub").contains("directory"));
    assert!(refusal(&folder, "solve nowhere.toml").contains("nowhere.toml"));
    write(&folder, "large.toml", &"# filler\n".repeat(200_000));
    assert!(refusal(&folder, "solve large.toml").contains("MiB"));
    #[cfg(unix)]
    assert!(refusal(&folder, "solve /dev/zero").contains("/dev/zero"));
}

#[test]
fn outputs_appear_whole_and_nothing_is_overwritten() {
    let folder = folder();
    let run = |line: &str| piezobeam(folder.path(), line).status.code();
    let line = "solve halves.toml --elements 50 --format csv --out a.csv --plot a.svg";
    assert_eq!(run(line), Some(0));
    let page = std::fs::read_to_string(folder.path().join("a.svg")).expect("a picture");
    assert!(roxmltree::Document::parse(&page).is_ok());
    std::fs::write(folder.path().join("a.csv"), "mine").expect("a file");
    std::fs::remove_file(folder.path().join("a.svg")).expect("removed");
    assert!(refusal(&folder, line).contains("--force"));
    assert_eq!(std::fs::read_to_string(folder.path().join("a.csv")).expect("a file"), "mine");
    assert!(!folder.path().join("a.svg").exists(), "one refused output stops the other");
    assert_eq!(run(&format!("{line} --force")), Some(0));
    let csv = std::fs::read_to_string(folder.path().join("a.csv")).expect("a file");
    assert_eq!(csv.lines().count(), 34);
}

#[test]
fn the_main_job_writes_eight_pictures() {
    let folder = folder();
    let output = piezobeam(folder.path(), "paper --out figures");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.contains("0.318538") && said.contains("762.19279 kN"), "{said}");
    let pictures = std::fs::read_dir(folder.path().join("figures")).expect("a folder").count();
    assert_eq!(pictures, 8);
}

#[test]
fn sensitivities_are_what_solves_of_changed_scenes_differ_by() {
    let folder = folder();
    let line = "solve halves.toml --elements 200 --stop 1e-13 --format json --samples 3";
    let value = json(&folder, &format!("{line} --sensitivities"));
    let found = &value["sensitivities"];
    assert_eq!(found["error"], Value::Null);
    assert_eq!(found["warning"], Value::Null);
    let find = |list: &str, name: &str| {
        let list = found[list].as_array().expect("a list");
        list.iter().position(|entry| entry["name"] == name).expect("an entry")
    };
    let changed = |from: &str, to: &str| {
        assert!(HALVES.contains(from), "{from}");
        write(&folder, "changed.toml", &HALVES.replacen(from, to, 1));
        json(&folder, &line.replace("halves", "changed"))
    };
    for (name, field, low, high) in [
        ("foundation.stiffness", "stiffness = 1e8", "stiffness = 0.999e8", "stiffness = 1.001e8"),
        ("beam.bending", "bending = 5000.0", "bending = 4995.0", "bending = 5005.0"),
    ] {
        let (low, high) = (changed(field, low), changed(field, high));
        let at = find("parameters", name);
        for (output, path) in [
            ("contact force", "/contact/force"),
            ("bending", "/samples/bending/1"),
            ("left moment", "/resultants/left/moment"),
            ("right force", "/resultants/right/force"),
        ] {
            let of = |value: &Value| value.pointer(path).and_then(Value::as_f64).expect("a number");
            let want = (of(&high) - of(&low)) / 0.002;
            let got =
                found["outputs"][find("outputs", output)]["derivatives"][at].as_f64().expect("a number");
            assert!((got - want).abs() < 1e-4 * want.abs(), "{output} {name}: {got} {want}");
        }
    }
    assert_eq!(json(&folder, line)["sensitivities"], Value::Null);

    let output = piezobeam(folder.path(), "solve halves.toml --sensitivities");
    let said = text(&output.stdout);
    assert!(said.contains("derivative of") && said.contains("foundation.stiffness"), "{said}");
    assert!(said.contains("per relative change"), "{said}");
    assert!(!said.contains("load.points") && !said.contains("foundation.gap"), "{said}");
    assert!(refusal(&folder, "solve halves.toml --sensitivities --format csv").contains("csv"));

    let output = piezobeam(folder.path(), "solve halves.toml --sensitivities --stop 1e-17");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stdout).contains("no derivatives: "));
    write(&folder, "rest.toml", "length = 1.0\n[beam]\nbending = 1.0\n[foundation]\nstiffness = 10.0\n");
    let output = piezobeam(folder.path(), "solve rest.toml --sensitivities");
    assert!(text(&output.stdout).contains("one sign at most"), "{}", text(&output.stdout));
}

#[test]
fn time_and_check_say_what_they_promise() {
    let folder = folder();
    let value = json(&folder, "time halves.toml --elements 50 --repeat 3 --format json");
    for key in ["best_ns", "median_ns", "iterations", "element_visits"] {
        assert!(value[key].as_f64().is_some_and(|v| v > 0.0), "{key}");
    }
    let output = piezobeam(folder.path(), "check halves.toml");
    let said = text(&output.stdout);
    assert!(said.contains("the scene is sound") && said.contains("N m^2/V^2"), "{said}");
    assert!(said.contains("certified") && said.contains("warning: the axial strain"), "{said}");
}

#[test]
fn extremes_end_as_expected() {
    let folder = folder();
    let output = piezobeam(folder.path(), "extremes --quick --format json");
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let groups = value["groups"].as_array().expect("groups");
    let rows: Vec<&Value> = groups.iter().flat_map(|g| g["rows"].as_array().expect("rows")).collect();
    assert!(groups.len() > 10 && rows.len() > 200, "{} groups, {} rows", groups.len(), rows.len());
    for row in &rows {
        for key in ["case", "precision", "expected", "status", "reference"] {
            assert!(row[key].is_string(), "{key}: {row}");
        }
        assert!(row["elements"].as_u64().is_some_and(|n| n <= 110), "quick: {row}");
        let converged = row["status"] == "converged";
        assert!(!converged || row["residual"].as_f64().is_some_and(|r| r < 1e-4), "{row}");
    }
    let with = |verdict: &str| rows.iter().filter(|row| row["verdict"] == verdict).count();
    let wrong: Vec<_> = rows.iter().filter(|row| row["verdict"] == "wrong").collect();
    assert!(wrong.is_empty(), "{wrong:?}");
    assert_eq!(value["wrong"], 0);
    assert_eq!(with("ok") + with("refused"), rows.len());
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn extremes_make_a_document() {
    let folder = folder();
    let line = "extremes --quick --format markdown --out extremes.md";
    assert_eq!(piezobeam(folder.path(), line).status.code(), Some(0));
    let text = std::fs::read_to_string(folder.path().join("extremes.md")).expect("a document");
    assert!(text.starts_with("# Extremes\n\n`cargo beam extremes --quick --format markdown"), "{text}");
    assert!(refusal(&folder, line).contains("--force"));
}

#[test]
fn methods_of_the_paper_are_named_and_judged() {
    let folder = folder();
    for (method, elements, status) in [
        ("newton", 96, "converged"),
        ("gauss", 96, "own_equations"),
        ("elementwise", 96, "foundation_pulls"),
        ("bermudez-moreno", 96, "own_equations"),
    ] {
        let line =
            format!("solve halves.toml --elements {elements} --method {method} --format json --samples 3");
        let output = piezobeam(folder.path(), &line);
        assert_eq!(output.status.code(), Some(i32::from(status != "converged")), "{method}");
        let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(value["status"], status, "{method}");
        assert_eq!(value["method"]["name"], method);
        assert_eq!(value["method"]["own_residual"].is_null(), method == "newton");
        let middle = value["samples"]["bending"][1].as_f64().expect("a number");
        assert!((middle + 0.0637).abs() < 1e-4, "{method}: {middle}");
    }
    let output = piezobeam(folder.path(), "solve halves.toml --elements 96 --method elementwise");
    let said = text(&output.stdout);
    assert!(
        said.starts_with("NOT CONVERGED (foundation_pulls)") && said.contains("Try --method newton"),
        "{said}"
    );
    assert!(refusal(&folder, "solve halves.toml --rho 0.5").contains("--method bermudez-moreno"));
    let line = "solve halves.toml --method bermudez-moreno --omega 1e7 --mu 1e-7";
    assert!(refusal(&folder, line).contains("at most 1 / (2 omega)"));
}

#[test]
fn the_report_holds_and_is_one_page() {
    let folder = folder();
    let output = piezobeam(folder.path(), "report --quick --out found");
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
    let said = text(&output.stdout);
    assert!(said.lines().filter(|line| line.starts_with("holds: ")).count() >= 12, "{said}");
    assert!(said.lines().filter(|line| line.starts_with("artefact: ")).count() == 2, "{said}");
    assert!(!said.contains("FAILS"), "{said}");

    let page = std::fs::read_to_string(folder.path().join("found/report.html")).expect("a page");
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("prefers-color-scheme: dark"));
    assert!(page.matches("<svg ").count() >= 12);
    // Nothing is loaded from elsewhere.
    for word in ["src=", "@import", "url(", "<link", "<script"] {
        assert!(!page.contains(word), "{word}");
    }
    let names = std::fs::read_dir(folder.path().join("found")).expect("a folder");
    let names: Vec<_> =
        names.map(|f| f.expect("a file").file_name().into_string().expect("a name")).collect();
    let data: Vec<_> = names.iter().filter(|name| name.ends_with(".csv")).collect();
    assert!(data.len() >= 20, "{names:?}");
    for name in data {
        assert!(page.contains(&format!("<code>{name}</code>")), "{name} is named on the page");
        let mut reader = csv::Reader::from_path(folder.path().join("found").join(name)).expect("CSV");
        let rows = reader.records().collect::<Result<Vec<_>, _>>().expect("rows of one length");
        assert!(!rows.is_empty(), "{name}");
    }
    let picture =
        std::fs::read_to_string(folder.path().join("found/work-partial-bending.svg")).expect("a picture");
    assert!(roxmltree::Document::parse(&picture).is_ok());
    assert!(refusal(&folder, "report --quick --out found").contains("--force"));
}
