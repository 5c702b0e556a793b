//! The command line under attack: files that are no scenes, outputs that cannot be written, runs that are disturbed.
//! A run ends with the promised status, says one line that names the place and what to do, and leaves no half
//! of a file.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test that panics has failed")]
#![cfg(feature = "cli")]

#[path = "common/program.rs"]
mod program;

use program::{HALVES, folder, piezobeam, refusal, text, write};

/// What is said of a file with these bytes, without the program's and the file's names.
#[track_caller]
fn complaint(bytes: impl AsRef<[u8]>) -> String {
    let folder = folder();
    std::fs::write(folder.path().join("bad.toml"), bytes).expect("a file");
    let message = refusal(&folder, "solve bad.toml");
    assert!(!message.chars().any(char::is_control), "one line that a terminal can show: {message:?}");
    message.strip_prefix("piezobeam: bad.toml:").expect(&message).trim_start().to_owned()
}

/// The scene of two halves with one thing changed in it.
#[track_caller]
fn edited(from: &str, to: &str) -> String {
    assert!(HALVES.contains(from), "{from}");
    HALVES.replacen(from, to, 1)
}

#[track_caller]
fn check_all(cases: &[(&str, &str, &str)]) {
    for &(from, to, expected) in cases {
        assert_eq!(complaint(edited(from, to)), expected, "{to}");
    }
}

#[test]
fn bad_toml_is_named_with_line_and_column() {
    for (text, expected) in [
        ("length = 1\n[beam\n", "2:6: not valid TOML: unclosed table, expected `]`"),
        ("length = 1\n[beam]\nbending = \"5", "3:13: not valid TOML: invalid basic string, expected `\"`"),
        (
            "length = 1\r\n[beam]\r\nbending = \r\n",
            "3:11: not valid TOML: expected a value, found nothing; write one after the = sign",
        ),
        ("length = 1\nbeam = { bending = [1,\n", "2:23: not valid TOML: unclosed array, expected `]`"),
        (
            "length = 1\nlength = 2\n",
            "2:1: not valid TOML: \"length\" is given twice; give every key and every [table] once",
        ),
        ("length = 1,5\n", "1:11: not valid TOML: unexpected key or value, expected newline, `#`"),
        ("length = 01\n", "1:10: not valid TOML: unexpected leading zero, expected nothing"),
        ("length : 1\n", "1:8: not valid TOML: key with no value, expected `=`"),
    ] {
        assert_eq!(complaint(text), expected, "{text}");
    }
}

#[test]
fn unknown_and_misspelt_keys_are_named_with_the_nearest_right_one() {
    check_all(&[
        ("[foundation]", "[fondation]", "11: fondation: unknown key; did you mean \"foundation\"?"),
        ("bending", "bendign", "6: beam.bendign: unknown key; did you mean \"bending\"?"),
        ("transverse =", "tranverse =", "20: load.tranverse: unknown key; did you mean \"transverse\"?"),
        ("breaks", "brakes", "20: load.transverse.brakes: unknown key; did you mean \"breaks\"?"),
        ("[mesh]", "[load.point]\n[mesh]", "27: load.point: unknown key; did you mean \"points\"?"),
        ("mu1", "mu_1", "15: conduction.mu_1: unknown key; did you mean \"mu1\"?"),
        (
            "[mesh]",
            "[colour]\n[mesh]",
            "27: colour: unknown key; a scene has length, beam, foundation, conduction, load, potential and mesh",
        ),
    ]);
}

#[test]
fn numbers_that_no_double_holds_are_refused() {
    let b = "bending = 5000.0";
    check_all(&[
        (b, "bending = nan", "6: beam.bending: nan is not a finite number; give the value itself"),
        (b, "bending = -inf", "6: beam.bending: -inf is not a finite number; give the value itself"),
        (
            b,
            "bending = 1e999",
            "6: beam.bending: 1e999 is beyond the range of double precision; use numbers up to about 1.8e308",
        ),
        (
            "stiffness = 1e8",
            "stiffness = 1e-400",
            "12: foundation.stiffness: 1e-400 is too small for double precision; write 0, or numbers from \
             about 5e-324 on",
        ),
        (
            b,
            "bending = \"1e-999 + x\"",
            "6: beam.bending: in \"1e-999 + x\": \"1e-999\" is too small for double precision at character 1; \
             write 0, or numbers from about 5e-324 on",
        ),
        (
            b,
            "bending = 1e306",
            "6: beam.bending at x = 0.0005: expected a stiffness C for which C / h^3 fits the number format, found 1e306; it is in N m^2",
        ),
        (
            b,
            "bending = -0.0",
            "6: beam.bending at x = 0.0009305681557970263: expected a number > 0, found -0; it is in N m^2",
        ),
        (
            "length = 1.0",
            "length = 1e300",
            "6: beam.bending at x = 5e296: expected a stiffness C for which C / h^3 fits the number format, found 5000; it is in N m^2",
        ),
        (
            "truncation = 1.0",
            "truncation = 0",
            "17: conduction.truncation: expected a finite number > 0, found 0; it is in m",
        ),
        (
            "elements = 1000",
            "elements = 99999999999999999999",
            "28: mesh.elements: expected a whole number from 1 to 10000000, found the number 99999999999999999999",
        ),
        (
            "elements = 1000",
            "elements = 1e3",
            "28: mesh.elements: expected a whole number from 1 to 10000000, found the number 1e3",
        ),
    ]);
}

#[test]
fn positions_out_of_order_or_off_the_beam_are_refused() {
    let steps = "breaks = [0.5], values = [1e6, -1e6]";
    check_all(&[
        (
            steps,
            "breaks = [0.5], values = [1e6]",
            "20: load.transverse.values: expected 2 entries, found 1; 1 break parts the beam into 2 pieces",
        ),
        (
            steps,
            "breaks = [0.5, 0.4], values = [1, 2, 3]",
            "20: load.transverse.breaks[1]: 0.4 does not exceed 0.5 before it; write the positions in strictly increasing order",
        ),
        (
            steps,
            "breaks = [1.0], values = [1, 2]",
            "20: load.transverse.breaks[0]: 1 is not inside the beam; breaks lie strictly between 0 and 1",
        ),
        (
            steps,
            "breaks = [-0.5], values = [1, 2]",
            "20: load.transverse.breaks[0]: -0.5 is not inside the beam; breaks lie strictly between 0 and 1",
        ),
        (
            steps,
            "x = [0, 0.5], y = [1, 2]",
            "20: load.transverse.x: the table covers 0 to 0.5 of the beam only; let x reach from 0 to 1",
        ),
        (
            steps,
            "x = [0, 1], y = [1]",
            "20: load.transverse.y: 1 values for 2 positions; give one y for each x",
        ),
        (
            "elements = 1000",
            "nodes = [0, 0.5]",
            "28: mesh.nodes[1]: expected a last node at the beam's length, found 0.5; it is in m",
        ),
        (
            "elements = 1000",
            "nodes = [0, 0.5, 0.5, 1]",
            "28: mesh.nodes[2]: 0.5 does not exceed 0.5 before it; write the positions in strictly increasing order",
        ),
        (
            "[load]",
            "[load]\npoints = [\n{ x = 1.7, force = 1 },\n{ x = 0.3, force = 1 }]",
            "21: load.points[0].x: 1.7 is not inside the beam; concentrated loads stand strictly between 0 and 1",
        ),
        (
            "[load]",
            "[load]\npoints = [{ x = 0, force = 1 }]",
            "20: load.points[0].x: 0 is not inside the beam; concentrated loads stand strictly between 0 and 1",
        ),
        (
            "[load]",
            "[load]\npoints = [{ force = 1 }]",
            "20: load.points[0].x: missing; add x = <position>, in m",
        ),
        (
            "stiffness = 1e8",
            "stiffness = 1e8\ngap = { breaks = [0.5], values = [0, 1e-3] }",
            "13: foundation.gap at x = 0.5: expected a continuous function, found a jump from 0 to 0.001; give pieces whose values meet at the break",
        ),
    ]);
}

#[test]
fn formulas_that_have_no_value_are_refused() {
    let load = "{ breaks = [0.5], values = [1e6, -1e6] }";
    check_all(&[
        // No node and no point of a quadrature need stand there.
        (
            load,
            "\"1/(x - 0.3)\"",
            "20: load.transverse: in \"1/(x - 0.3)\": grows without bound at x = 0.3; give a formula that is finite on the whole beam",
        ),
        (
            load,
            "\"1/(x - 0.123456789)^2\"",
            "20: load.transverse: in \"1/(x - 0.123456789)^2\": grows without bound at x = 0.123457; give a formula that is finite on the whole beam",
        ),
        (
            load,
            "\"ln(x - 0.5)\"",
            "20: load.transverse: in \"ln(x - 0.5)\": grows without bound at x = 0.5; give a formula that is finite on the whole beam",
        ),
        (
            "bending = 5000.0",
            "bending = \"1/x\"",
            "6: beam.bending: in \"1/x\": grows without bound at x = 0; give a formula that is finite on the whole beam",
        ),
        (
            "stiffness = 1e8",
            "stiffness = 1e8\ngap = \"sqrt(x)\"",
            "13: foundation.gap at x = 0: expected a finite number, found NaN; it has to be finite on the whole beam; --precision f32 holds numbers up to 3.4e38",
        ),
        (
            load,
            "\"x +\"",
            "20: load.transverse: in \"x +\": expected a number, a name or \"(\", found the end at character 4; an example is 0.4*sin(pi*x/L)^2",
        ),
        (
            load,
            "\"sinn(x)\"",
            "20: load.transverse: in \"sinn(x)\": unknown function \"sinn\" at character 1; did you mean \"sin\"?",
        ),
    ]);
    let deep = format!("\"{}x{}\"", "(".repeat(1000), ")".repeat(1000));
    assert_eq!(
        complaint(edited(load, &deep)),
        "20: load.transverse: in \"((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((…\": nested more than 32 deep at character 34; write it with fewer brackets"
    );
    assert_eq!(
        complaint(edited(load, &format!("\"{}x\"", "x + ".repeat(100_000)))),
        "20: load.transverse: in \"x + x + x + x + x + x + x + x + x + x + x + x + x + x + x + …\": longer than 4096 bytes; give a table of x and y instead"
    );
}

#[test]
fn what_single_precision_does_not_hold_is_said_to_be_its_fault() {
    let folder = folder();
    for (from, to, flags, expected) in [
        (
            "stiffness = 1e8",
            "stiffness = 1e60",
            "",
            "bad.toml:12: foundation.stiffness at x = 0.00093056820333004: expected a finite number, found inf; it has to be finite on the whole beam; --precision f32 holds numbers up to 3.4e38",
        ),
        (
            "length = 1.0",
            "length = 1e60",
            "",
            "bad.toml:3: length: expected a finite number > 0, found inf; it has to be finite on the whole beam; --precision f32 holds numbers up to 3.4e38",
        ),
        (
            "length = 1.0",
            "length = 1.0",
            "--stop 1e-60",
            "--stop: expected a number between 0 and 1 in the precision of the solve, found 0; ask for a larger one, or for --precision f64",
        ),
    ] {
        write(&folder, "bad.toml", &edited(from, to));
        let message = refusal(&folder, &format!("solve bad.toml --precision f32 {flags}"));
        assert_eq!(message.strip_prefix("piezobeam: ").expect(&message), expected);
    }
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    assert_eq!(complaint(b"length = 1\n# \xff\n"), "2: the text is not UTF-8; save the file as UTF-8");
    assert_eq!(complaint(b"\xff\xfel\0"), "1: the text is UTF-16, not UTF-8; save the file as UTF-8");
    assert_eq!(
        complaint(b"length = 1\n\0"),
        "2: a NUL character stands here; a scene is plain text, save the file anew"
    );
    assert_eq!(complaint(b""), "the file is empty; a scene has at least length and [beam] with bending");
    assert_eq!(
        complaint("length = 1\nbeam.bending = 1_2\u{2}\n"),
        "2: beam.bending: expected a number, found the number 12\\u{2}"
    );
    let escaped = complaint("\"\\u001b[31mlen\\u202egth\" = 1\n");
    assert!(escaped.starts_with("1: \\u{1b}[31mlen\\u{202e}gth: unknown key; "), "{escaped}");
}

#[test]
fn nesting_of_any_depth_is_refused() {
    let deep = "nested more than 32 deep; a scene needs no more than four brackets in one another";
    for part in ["[", "{a=", "a.", "[[", "[a.", "a=[{"] {
        let message = complaint(format!("length = 1\nx = {}", part.repeat(100_000)));
        assert_eq!(message, format!("2: {deep}"), "{part}");
    }
}

#[test]
fn outputs_that_cannot_be_written_are_refused_with_the_way_out() {
    let folder = folder();
    write(&folder, "file", "mine");
    for (flags, expected) in [
        ("--out file", "file exists; pass --force to replace it, or choose another name"),
        ("--out .", ". is a directory; name a file in it"),
        ("--out no/a", "cannot write no/a: its directory does not exist; make it first"),
        ("--out file/a", "cannot write file/a: a part of its path is a file; name a directory there"),
    ] {
        let message = refusal(&folder, &format!("solve halves.toml --elements 10 {flags}"));
        assert_eq!(message, format!("piezobeam: {expected}"));
    }
    let message = refusal(&folder, "paper --out file");
    assert_eq!(message, "piezobeam: cannot write file: a file has this name; choose another");
    // One file under two names is one file.
    for flags in ["--out ./halves.toml --force", "--out ./a.svg --plot a.svg"] {
        let message = refusal(&folder, &format!("solve halves.toml {flags}"));
        assert!(message.starts_with("error: ") && message.contains("name"), "{message}");
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("halves.toml")).expect("a file"), HALVES);
    assert_eq!(std::fs::read_to_string(folder.path().join("file")).expect("a file"), "mine");
}

#[test]
fn numbers_of_the_command_line_are_bounded() {
    let folder = folder();
    for flags in [
        "solve halves.toml --elements 0",
        "solve halves.toml --elements 99999999999999999999",
        "solve halves.toml --samples 1000001",
        "solve halves.toml --stop nan",
        "solve halves.toml --stop=-1",
        "time halves.toml --repeat 18446744073709551615",
    ] {
        let message = refusal(&folder, flags);
        let flag = flags.split([' ', '=']).nth(2).expect("a flag");
        assert!(message.starts_with("error: ") && message.contains(flag), "{message}");
    }
    assert!(refusal(&folder, "slove halves.toml").contains("'solve'"));
    assert!(refusal(&folder, "solve halves.toml --element 3").contains("'--elements'"));
    assert!(refusal(&folder, "").contains("Usage"));
}

#[test]
fn many_loads_and_breaks_take_no_square_of_their_number() {
    let folder = folder();
    let at = |i: u32| f64::from(i + 1) / 20_001.0;
    let points: String = (0..20_000).map(|i| format!("{{x={:.6}}},", at(i))).collect();
    let steps: String = (0..20_000).map(|i| format!("{:.6},", at(i))).collect();
    for load in [
        format!("points = [{points}]"),
        format!("transverse = {{ breaks = [{steps}], values = [{}] }}", "1,".repeat(20_001)),
    ] {
        write(&folder, "many.toml", &format!("length = 1\nbeam.bending = 1\n[load]\n{load}\n"));
        let start = std::time::Instant::now();
        let output = piezobeam(folder.path(), "solve many.toml --format json");
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(start.elapsed().as_secs_f64() < 5.0, "{:?}", start.elapsed());
    }
}

/// What needs devices, pipes and limits as Linux has them.
#[cfg(target_os = "linux")]
mod linux {
    use super::*;
    use std::os::unix::fs::symlink;
    use std::path::Path;
    use std::process::{Command, Output, Stdio};
    use std::time::{Duration, Instant};

    const PROGRAM: &str = env!("CARGO_BIN_EXE_piezobeam");

    /// A line of the shell, in which `$P` is the program.
    fn shell(folder: &Path, line: &str) -> Output {
        let shell = Command::new("sh").args(["-c", line]).env("P", PROGRAM).current_dir(folder).output();
        shell.expect("a shell")
    }

    fn entries(folder: &Path) -> Vec<String> {
        let list = std::fs::read_dir(folder).expect("a folder");
        let mut names: Vec<_> =
            list.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn files_without_end_are_refused_early() {
        let folder = folder();
        std::fs::write(folder.path().join("large.toml"), "# nothing here\n".repeat(40 << 20 >> 4))
            .expect("40 MB");
        std::fs::write(folder.path().join("deep.toml"), "[".repeat(40 << 20)).expect("40 MB");
        let start = Instant::now();
        for (name, expected) in [
            (
                "large.toml",
                "larger than 1 MiB, which no scene needs to be; check that this is the file you meant",
            ),
            (
                "deep.toml",
                "larger than 1 MiB, which no scene needs to be; check that this is the file you meant",
            ),
            (
                "/dev/zero",
                "expected a scene file, found a device, a pipe or a socket; give the path of a regular TOML file",
            ),
            (
                "/dev/stdin",
                "expected a scene file, found a device, a pipe or a socket; give the path of a regular TOML file",
            ),
            (".", "expected a scene file, found a directory; give the path of a regular TOML file"),
            ("none.toml", "there is no such file; check the path of the scene file"),
        ] {
            // 64 MiB of addresses, the program itself included.
            let output = shell(folder.path(), &format!("ulimit -v 65536; exec \"$P\" solve {name}"));
            assert_eq!(text(&output.stderr), format!("piezobeam: {name}: {expected}\n"));
            assert_eq!(output.status.code(), Some(2));
        }
        assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
    }

    #[test]
    fn the_largest_files_that_are_read_take_little() {
        let folder = folder();
        for (text, says) in [
            ("[[load.points]]\n".repeat(1 << 16), "length: missing"),
            ((0..60_000).map(|i| format!("k{i} = 1\n")).collect(), "k0: unknown key"),
            (format!("x = {}", "\"".repeat(1 << 19)), "not valid TOML"),
            (format!("x = [{}", "1,".repeat(1 << 18)), "not valid TOML"),
            (format!("length = {}", "9".repeat(1 << 19)), "9… is beyond the range of double precision"),
            (format!("{} = 1", "k".repeat(1 << 19)), "unknown key"),
        ] {
            write(&folder, "bad.toml", &text);
            let start = Instant::now();
            let output = shell(folder.path(), "ulimit -v 131072; exec \"$P\" solve bad.toml");
            let message = super::text(&output.stderr);
            assert!(message.contains(says) && message.len() < 300, "{message}");
            assert_eq!(output.status.code(), Some(2));
            assert!(start.elapsed() < Duration::from_secs(2), "{says}: {:?}", start.elapsed());
        }
    }

    #[test]
    fn pipes_and_loops_as_scenes_do_not_block() {
        let folder = folder();
        let made = shell(
            folder.path(),
            "mkfifo pipe.toml && ln -s loop.toml loop.toml && ln -s halves.toml link.toml",
        );
        assert!(made.status.success());
        assert!(refusal(&folder, "check pipe.toml").contains("found a device, a pipe or a socket"));
        assert!(
            refusal(&folder, "check loop.toml").starts_with("piezobeam: loop.toml: cannot read the file: ")
        );
        assert_eq!(piezobeam(folder.path(), "check link.toml").status.code(), Some(0));
    }

    #[test]
    fn memory_that_cannot_be_had_is_an_error() {
        let folder = folder();
        let line = "ulimit -v 500000; exec \"$P\" solve halves.toml --elements 10000000";
        let output = shell(folder.path(), line);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(
            message.contains("room for 10000000 elements") && message.contains("ask for fewer elements"),
            "{message}"
        );
    }

    #[test]
    fn full_disks_are_said() {
        let folder = folder();
        symlink("/dev/full", folder.path().join("full.svg")).expect("a link");
        let full = "the disk is full; free some space or choose another disk";
        for (line, expected) in [
            ("solve halves.toml --out /dev/full", format!("cannot write /dev/full: {full}")),
            // The report would have fitted, but outputs appear all or not at all.
            ("solve halves.toml --out a.txt --plot full.svg", format!("cannot write full.svg: {full}")),
        ] {
            assert_eq!(refusal(&folder, line), format!("piezobeam: {expected}"));
        }
        for command in ["solve halves.toml", "check halves.toml", "time halves.toml --repeat 1"] {
            let output = shell(folder.path(), &format!("\"$P\" {command} > /dev/full"));
            assert_eq!(output.status.code(), Some(2), "{command}");
            assert!(text(&output.stderr).contains("standard output"), "{}", text(&output.stderr));
        }
        // Where not even a complaint can be written, the status still says it.
        for line in ["\"$P\" solve none.toml 2> /dev/full", "\"$P\" solve halves.toml > /dev/full 2>&1"] {
            assert_eq!(shell(folder.path(), line).status.code(), Some(2), "{line}");
        }
        let line = "\"$P\" solve halves.toml --stop 1e-17 --format json 2> /dev/full";
        assert_eq!(shell(folder.path(), line).status.code(), Some(1));
        assert_eq!(entries(folder.path()), ["full.svg", "halves.toml"]);
    }

    #[test]
    fn readers_that_go_away_are_no_error() {
        let folder = folder();
        for line in ["solve halves.toml --format csv --samples 100000", "check halves.toml", "--help"] {
            let line = format!("{{ \"$P\" {line}; echo $? >&2; }} | head -c 1 > /dev/null");
            assert_eq!(text(&shell(folder.path(), &line).stderr), "0\n", "{line}");
        }
        let closed = shell(folder.path(), "\"$P\" solve halves.toml >&- 2>&-");
        assert_eq!(closed.status.code(), Some(0));
    }

    #[test]
    fn links_as_outputs_are_followed_and_pipes_are_written() {
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        write(&folder, "real", "mine");
        symlink("real", at("link")).expect("a link");
        symlink("nowhere", at("dangling")).expect("a link");
        for name in ["link", "dangling"] {
            let message = refusal(&folder, &format!("solve halves.toml --out {name}"));
            assert!(message.contains("--force"), "{message}");
        }
        assert_eq!(std::fs::read_to_string(at("real")).expect("a file"), "mine");
        let solve = |name: &str| {
            piezobeam(folder.path(), &format!("solve halves.toml --format csv --force --out {name}"))
        };
        assert_eq!(solve("link").status.code(), Some(0));
        assert!(at("link").is_symlink());
        let csv = std::fs::read_to_string(at("real")).expect("a file");
        assert_eq!(csv.lines().count(), 34);
        assert_eq!(solve("dangling").status.code(), Some(0));
        assert!(!at("dangling").is_symlink() && !at("nowhere").exists());

        assert!(shell(folder.path(), "mkfifo pipe").status.success());
        let line = "cat pipe > read & \"$P\" solve halves.toml --format csv --out pipe; s=$?; wait; exit $s";
        assert_eq!(shell(folder.path(), line).status.code(), Some(0));
        assert_eq!(std::fs::read_to_string(at("read")).expect("a file"), csv);
    }

    #[test]
    fn of_runs_to_one_output_one_wins_and_the_file_is_whole() {
        let folder = folder();
        let run = |n: usize, flags: &str| {
            let line = format!(
                "solve halves.toml --elements {n} --samples 5000 --format json --out one.json {flags}"
            );
            let command = Command::new(PROGRAM)
                .args(line.split_whitespace())
                .current_dir(folder.path())
                .stderr(Stdio::piped())
                .spawn();
            command.expect("a run")
        };
        for flags in ["", "--force"] {
            let runs: Vec<_> = (0..8).map(|i| run(100 + i, flags)).collect();
            let ends: Vec<_> = runs.into_iter().map(|run| run.wait_with_output().expect("an end")).collect();
            let won = ends.iter().filter(|end| end.status.code() == Some(0)).count();
            assert_eq!(won, if flags.is_empty() { 1 } else { 8 }, "{ends:?}");
            for end in ends.iter().filter(|end| end.status.code() != Some(0)) {
                assert_eq!(end.status.code(), Some(2));
                assert!(text(&end.stderr).starts_with("piezobeam: one.json exists; pass --force"), "{end:?}");
            }
            let file = std::fs::read_to_string(folder.path().join("one.json")).expect("a file");
            let value: serde_json::Value = serde_json::from_str(&file).expect("whole");
            assert_eq!(value["status"], "converged");
            assert_eq!(entries(folder.path()), ["halves.toml", "one.json"]);
        }
    }

    #[test]
    fn a_killed_run_leaves_the_old_file() {
        let folder = folder();
        write(&folder, "old.json", "mine");
        let line = "solve halves.toml --elements 30000 --samples 100000 --format json --out old.json --force";
        for wait in [0, 5, 20, 50, 100, 150, 200, 300] {
            let mut run = Command::new(PROGRAM)
                .args(line.split_whitespace())
                .current_dir(folder.path())
                .spawn()
                .expect("a run");
            std::thread::sleep(Duration::from_millis(wait));
            run.kill().expect("killed, or at its end");
            let ended = run.wait().expect("an end").code() == Some(0);
            let file = std::fs::read_to_string(folder.path().join("old.json")).expect("a file");
            if file != "mine" {
                assert!(serde_json::from_str::<serde_json::Value>(&file).is_ok(), "half a file");
                write(&folder, "old.json", "mine");
            }
            assert!(file != "mine" || !ended);
        }
    }

    const SWEEP: &str = "sweep halves.toml --elements 50 --vary foundation.stiffness=lin:1e7:1e8:20";

    #[test]
    fn rows_of_a_sweep_are_kept_in_a_regular_file_or_not_at_all() {
        let folder = folder();
        let made = shell(
            folder.path(),
            "mkfifo pipe.csv.partial && ln -s /dev/zero zero.csv.partial && ln -s /dev/full full.csv.partial \
             && mkdir folder.csv.partial && printf 'piezobeam sweep \\377' > bytes.csv.partial \
             && yes | head -c 3000000 > long.csv.partial",
        );
        assert!(made.status.success());
        let no_file =
            "is no regular file, and solved rows are kept in one; remove it, or choose another --out";
        for (name, expected) in [
            ("pipe", no_file),
            ("zero", no_file),
            ("full", no_file),
            ("folder", "cannot write folder.csv.partial: "),
            ("long", "holds rows of another sweep"),
        ] {
            let message = refusal(&folder, &format!("{SWEEP} --out {name}.csv"));
            assert!(
                message.contains(expected) && message.contains(&format!("{name}.csv.partial")),
                "{message}"
            );
            assert!(!folder.path().join(format!("{name}.csv")).exists());
        }
        // A first line without an end is torn, and written anew.
        assert_eq!(piezobeam(folder.path(), &format!("{SWEEP} --out bytes.csv")).status.code(), Some(0));
    }

    #[test]
    fn sweeps_to_full_disks_and_readers_that_go_away() {
        let folder = folder();
        let output = shell(folder.path(), &format!("\"$P\" {SWEEP} > /dev/full"));
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains("standard output"), "{}", text(&output.stderr));
        let line = format!("{{ \"$P\" {SWEEP}; echo $? >&2; }} | head -c 1 > /dev/null");
        assert!(text(&shell(folder.path(), &line).stderr).ends_with("0\n"));
        // A limit on the size of files ends a disk in the middle of the rows.
        let line = format!("trap '' XFSZ; ulimit -f 1; \"$P\" {SWEEP} --out a.csv");
        let output = shell(folder.path(), &line);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            text(&output.stderr).starts_with("piezobeam: cannot write a.csv"),
            "{}",
            text(&output.stderr)
        );
        assert!(!folder.path().join("a.csv").exists());
        // With room again it goes on, past the line that was torn.
        let whole = piezobeam(folder.path(), SWEEP).stdout;
        assert_eq!(piezobeam(folder.path(), &format!("{SWEEP} --out a.csv")).status.code(), Some(0));
        assert_eq!(std::fs::read(folder.path().join("a.csv")).expect("a file"), whole);
        assert_eq!(entries(folder.path()), ["a.csv", "halves.toml"]);
    }

    #[test]
    fn of_sweeps_to_one_table_one_wins_and_the_others_say_so() {
        let folder = folder();
        let line = format!("{SWEEP} --method bermudez-moreno --jobs 1 --out one.csv");
        let run = || {
            let command = Command::new(PROGRAM)
                .args(line.split_whitespace())
                .current_dir(folder.path())
                .stdout(Stdio::null())
                .stderr(Stdio::piped())
                .spawn();
            command.expect("a run")
        };
        let runs: Vec<_> = (0..6).map(|_| run()).collect();
        let ends: Vec<_> = runs.into_iter().map(|run| run.wait_with_output().expect("an end")).collect();
        let lost: Vec<_> = ends.iter().filter(|end| end.status.code() == Some(2)).collect();
        assert!(lost.len() < ends.len(), "{ends:?}");
        for end in lost {
            let said = text(&end.stderr);
            assert!(said.contains("one.csv.partial is in use") || said.contains("one.csv exists"), "{said}");
        }
        let table = std::fs::read_to_string(folder.path().join("one.csv")).expect("a table");
        assert_eq!(table.lines().count(), 21);
        assert_eq!(entries(folder.path()), ["halves.toml", "one.csv"]);
    }

    #[test]
    fn names_do_not_command_the_terminal() {
        let folder = folder();
        let name = "red\u{1b}[31m\u{202e}.toml";
        write(&folder, name, HALVES);
        let line = |rest: &str| format!("exec \"$P\" {}", rest.replace('@', &format!("'{name}'")));
        for rest in [
            "solve @",
            "solve @ --plot a.svg",
            "check @",
            "solve no/@",
            "solve @ --out @/a",
            "solve halves.toml --out no/@",
            "solve @ --plot @ --force",
            "solve @ --stop @",
            "@",
            "paper --out @",
            "paper --out p@",
            "sweep @ --vary length=1,2 --out no/@.csv",
            "sweep halves.toml --vary length=1,2 --out p@/a.csv",
            "sweep halves.toml --vary @=1,2",
        ] {
            let output = shell(folder.path(), &line(rest));
            let said = text(&output.stdout) + &text(&output.stderr);
            // Errors of the command line itself are clap's, which takes out colours alone.
            let unsafe_to_show = |c| c == '\u{1b}' || (c == '\u{202e}' && !said.starts_with("error: "));
            assert!(!said.contains(unsafe_to_show), "{rest}: {said:?}");
        }
        let page = std::fs::read_to_string(folder.path().join("a.svg")).expect("a picture");
        assert!(roxmltree::Document::parse(&page).is_ok());
        use std::os::unix::ffi::OsStrExt;
        let bytes = std::ffi::OsStr::from_bytes(b"\xff.toml");
        std::fs::write(folder.path().join(bytes), HALVES).expect("a file");
        let output =
            Command::new(PROGRAM).arg("check").arg(bytes).current_dir(folder.path()).output().expect("a run");
        assert_eq!(output.status.code(), Some(0));
    }
}
