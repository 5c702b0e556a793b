//! Complaints about the file, its keys and its numbers.

use super::{complaint, refusal, scene};

#[test]
fn what_is_not_toml_is_refused() {
    for (lines, message) in [
        ("axial = ", "4:9: not valid TOML: expected a value, found nothing; write one after the = sign"),
        (
            "axial = sin(x)",
            "4:9: not valid TOML: expected a value, found \"sin(x)\"; \
             write texts and formulas in quotes",
        ),
        (
            "axial = 1\naxial = 2",
            "5:1: not valid TOML: \"axial\" is given twice; give every key and every [table] once",
        ),
        ("[beam]", "4:2: not valid TOML: \"beam\" is given twice; give every key and every [table] once"),
    ] {
        assert_eq!(complaint(lines), message, "{lines}");
    }
    assert_eq!(
        complaint("axial = \"x\u{7}\""),
        "4:11: not valid TOML: invalid basic string, \
         expected non-double-quote visible characters, `\\`"
    );
    assert_eq!(complaint("axial = [1, 2"), "4:14: not valid TOML: unclosed array, expected `]`");
    assert!(complaint("axial = 1,5").starts_with("4:10: not valid TOML: "));
}

#[test]
fn empty_texts_are_refused() {
    for text in ["", "\n \n", "\u{feff}"] {
        assert_eq!(refusal(text), " the file is empty; a scene has at least length and [beam] with bending");
    }
}

#[test]
fn missing_keys_are_named() {
    assert_eq!(refusal("# nothing"), " length: missing; add length = <number>, in m, at the top");
    assert_eq!(refusal("length = 1"), " beam: missing; add [beam] with bending = <number>, in N m^2");
    assert_eq!(
        refusal("length = 1\n[beam]\naxial = 1"),
        "2: beam.bending: missing; add bending = <number>, in N m^2"
    );
    assert_eq!(
        complaint("[foundation]"),
        "4: foundation.stiffness: missing; add stiffness = <number>, in N/m^2"
    );
    assert_eq!(
        complaint("[conduction]\nmu1 = 1"),
        "4: conduction.truncation: missing; add truncation = <number>, in m"
    );
    assert_eq!(complaint("[potential]\nleft = 1"), "4: potential.right: missing; add right = <number>, in V");
    assert_eq!(
        complaint("[[load.points]]\nx = 0.5\n[[load.points]]\nforce = 1"),
        "6: load.points[1].x: missing; add x = <position>, in m"
    );
}

#[test]
fn unknown_keys_are_refused() {
    assert_eq!(
        complaint("[foundation]\nstifness = 1"),
        "5: foundation.stifness: unknown key; did you mean \"stiffness\"?"
    );
    assert_eq!(refusal("lenght = 1"), "1: lenght: unknown key; did you mean \"length\"?");
    assert_eq!(
        complaint("length = 2"),
        "4: beam.length: unknown key; length belongs at the top of the file, before the first [table]"
    );
    assert_eq!(
        complaint("stiffness = 2"),
        "4: beam.stiffness: unknown key; stiffness belongs in [foundation]"
    );
    assert_eq!(
        complaint("[colour]"),
        "4: colour: unknown key; a scene has length, beam, foundation, conduction, load, \
         potential and mesh"
    );
    assert_eq!(
        complaint("[[load.points]]\nx = 1\n\"fo\\nrce\" = 1"),
        "6: load.points[0].fo\\nrce: unknown key; did you mean \"force\"?"
    );
}

#[test]
fn wrong_types_are_explained() {
    assert_eq!(
        refusal("length = \"1.5\""),
        "1: length: expected a number, found the text \"1.5\"; remove the quotes: 1.5"
    );
    assert_eq!(refusal("length = true"), "1: length: expected a number, found the boolean true");
    assert_eq!(refusal("length = 1979-05-27"), "1: length: expected a number, found a date or time");
    assert_eq!(
        refusal("length = 0"),
        "1: length: expected a positive length, found 0; give the length of the beam in m"
    );
    assert_eq!(
        refusal("length = 1\nbeam = 5000"),
        "2: beam: expected the table [beam], found the number 5000"
    );
    assert_eq!(
        refusal("length = 1\n[[beam]]\nbending = 1"),
        "2: beam: expected the table [beam], found an array of 1 element; \
         write [beam] once, in single brackets"
    );
    assert_eq!(
        complaint("[load.points]\nx = 1"),
        "4: load.points: expected tables [[load.points]], found a table; \
         write [[load.points]] in double brackets before each point"
    );
    assert_eq!(
        complaint("load.points = [0.5]"),
        "4: beam.load: unknown key; load belongs at the top of the file, before the first [table]"
    );
    assert_eq!(
        complaint("[load]\npoints = [0.5]"),
        "5: load.points[0]: expected a table, found the number 0.5; \
         write a point as { x = 0.3, force = 1e3 }"
    );
    assert_eq!(
        complaint("[foundation]\nstiffness = 1\nexponent = \"x\""),
        "6: foundation.exponent: expected a number, found the text \"x\""
    );
}

#[test]
fn numbers_are_finite() {
    assert_eq!(complaint("axial = nan"), "4: beam.axial: nan is not a finite number; give the value itself");
    assert_eq!(
        complaint("[potential]\nleft = -inf"),
        "5: potential.left: -inf is not a finite number; give the value itself"
    );
    assert_eq!(
        complaint("axial = 1e999"),
        "4: beam.axial: 1e999 is beyond the range of double precision; \
         use numbers up to about 1.8e308"
    );
}

#[test]
fn meshes_are_checked() {
    let count = "expected a whole number from 1 to 10000000, found";
    for (value, found) in [
        ("0", "the number 0"),
        ("-5", "the number -5"),
        ("10_000_001", "the number 10000001"),
        ("100.0", "the number 100.0"),
        ("\"100\"", "the text \"100\""),
        ("99999999999999999999999", "the number 99999999999999999999999"),
    ] {
        let message = complaint(&format!("[mesh]\nelements = {value}"));
        assert_eq!(message, format!("5: mesh.elements: {count} {found}"));
    }
    assert_eq!(
        complaint("[mesh]\nelements = 1\nnodes = [0, 1]"),
        "6: mesh.nodes: given together with mesh.elements; keep one of the two"
    );
    assert_eq!(complaint("[mesh]\nnodes = [0.0]"), "5: mesh.nodes: expected at least two nodes, found one");
    assert_eq!(
        complaint("[mesh]\nnodes = [0.0, 0.6,\n0.5, 1]"),
        "6: mesh.nodes[2]: 0.5 does not exceed 0.6 before it; \
         write the positions in strictly increasing order"
    );
    let scene = scene("length = 1\n[beam]\nbending = 1\n[mesh]\nnodes = [0, 0.1, 1]\n");
    assert_eq!(scene.mesh.nodes, Some(vec![0.0, 0.1, 1.0]));
}

#[test]
fn hostile_nesting_is_refused() {
    assert_eq!(
        complaint(&format!("axial = {}", "[".repeat(100_000))),
        "4: nested more than 32 deep; a scene needs no more than four brackets in one another"
    );
    // Nesting which is only just allowed is handled by the parser.
    let deep = format!("axial = {}1{}", "[".repeat(32), "]".repeat(32));
    assert!(complaint(&deep).starts_with("4: beam.axial: expected a profile"));
}
