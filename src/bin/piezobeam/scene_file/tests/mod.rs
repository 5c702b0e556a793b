//! Whole scenes, good and bad, with the exact text of every complaint.

mod profiles;
mod refusals;

use super::*;

/// A scene which uses the whole format.
pub(super) const EXAMPLE: &str = "\
length = 1.0
[beam]
bending = 5000.0
axial = 1e5
piezo = 100.0
permittivity = 1.0
[foundation]
stiffness = 1e8
exponent = 1.0
gap = { polynomial = [0, 0, 4, -8, 4] }
[conduction]
mu1 = 1.0
mu2 = 1.0
truncation = 1.0
potential_truncation = 1.0
[load]
transverse = { breaks = [0.5], values = [1e6, -1e6] }
axial = 1e6
[[load.points]]
x = 0.3
force = 1e3
moment = 0.0
[potential]
left = 1.0
right = 1.0
[mesh]
elements = 100
";

#[track_caller]
fn scene(text: &str) -> SceneFile {
    match parse(text, "scene.toml") {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

fn load(value: &str) -> ProfileSpec {
    let text = format!("length = 2\nload.transverse = {value}\nbeam.bending = 1");
    scene(&text).load.transverse.expect("a load")
}

#[test]
fn the_example_is_read() {
    let scene = scene(EXAMPLE);
    assert_eq!(scene.name, "scene.toml");
    assert!(matches!(scene.beam.bending, ProfileSpec::Number(5000.0)));
    assert!(matches!(scene.beam.axial, Some(ProfileSpec::Number(1e5))));
    assert!(matches!(scene.beam.piezo, Some(ProfileSpec::Number(100.0))));
    assert!(scene.beam.permittivity.is_some());
    let foundation = scene.foundation.as_ref().expect("a foundation");
    assert!(matches!(foundation.stiffness, ProfileSpec::Number(1e8)));
    assert_eq!(foundation.exponent.to_bits(), 1.0_f64.to_bits());
    let gap = foundation.gap.as_ref().expect("a gap");
    assert!(matches!(gap, ProfileSpec::Polynomial(c) if c == &[0.0, 0.0, 4.0, -8.0, 4.0]));
    let conduction = scene.conduction.as_ref().expect("conduction");
    assert!(conduction.mu1.is_some() && conduction.mu2.is_some());
    assert_eq!(conduction.potential_truncation, Some(1.0));
    assert_eq!(scene.load.points.len(), 1);
    assert_eq!(scene.load.points[0].force.to_bits(), 1e3_f64.to_bits());
    assert_eq!(scene.potential.as_ref().map(|p| p.left), Some(1.0));
    assert_eq!(scene.mesh.elements, Some(100));
    assert!(scene.mesh.nodes.is_none());
    assert_eq!(scene.line_of("length"), Some(1));
    assert_eq!(scene.line_of("foundation"), Some(7));
    assert_eq!(scene.line_of("foundation.gap"), Some(10));
    assert_eq!(scene.line_of("load.points[0].x"), Some(20));
    assert_eq!(scene.line_of("mesh.elements"), Some(27));
    assert_eq!(scene.line_of("load.points[7].x"), Some(19));
}

#[test]
fn the_least_scene_is_read() {
    for text in [
        "length = 1\n[beam]\nbending = 2",
        "\u{feff}length = 1\r\n[beam]\r\nbending = 2\r\n",
        "beam = { bending = 2 }\nlength = 0x1",
    ] {
        let scene = scene(text);
        assert!(scene.foundation.is_none() && scene.conduction.is_none());
        assert!(scene.load.transverse.is_none() && scene.load.points.is_empty());
        assert!(scene.potential.is_none() && scene.mesh.elements.is_none());
    }
    let scene = scene("length = 1\nbeam.bending = 2\nfoundation.stiffness = 3\nconduction.truncation = 4\n");
    assert_eq!(scene.foundation.map(|f| f.exponent), Some(1.0));
    assert!(scene.conduction.is_some_and(|c| c.potential_truncation.is_none()));
}

#[test]
fn every_form_of_a_profile_is_read() {
    assert!(matches!(load("3"), ProfileSpec::Number(3.0)));
    assert!(matches!(load("-3e2"), ProfileSpec::Number(-300.0)));
    assert!(matches!(load("{ polynomial = [1, 2.5] }"), ProfileSpec::Polynomial(c) if c == [1.0, 2.5]));
    let steps = load("{ breaks = [0.5, 1], values = [1, 2, 3] }");
    assert_eq!(steps.breaks(), [0.5, 1.0]);
    assert!((steps.value(0.7, 0.7) - 2.0).abs() < 1e-15);
    let pieces = load("{ breaks = [1], polynomials = [[0, 1], [1]] }");
    assert!((pieces.value(0.25, 0.25) - 0.25).abs() < 1e-15);
    assert!((pieces.value(1.0, 1.5) - 1.0).abs() < 1e-15);
    let table = load("{ x = [-1, 1, 2.0], y = [0, 2, 0] }");
    assert_eq!(table.breaks(), [1.0]);
    assert!((table.value(0.0, 0.1) - 1.0).abs() < 1e-15);
    let formula = load("\"0.4*sin(pi*x/L)^2\"");
    assert!((formula.value(1.0, 1.0) - 0.4).abs() < 1e-15);
    assert!(formula.breaks().is_empty() && !formula.stepwise());
    assert!((load("\"max(x, 1)\"").value(0.5, 0.5) - 1.0).abs() < 1e-15);
}

/// The message about the text, without the name of the file.
#[track_caller]
fn refusal(text: &str) -> String {
    let message = parse(text, "a").expect_err("a refusal").to_string();
    message.strip_prefix("a:").map_or(message.clone(), str::to_owned)
}

/// The message about a beam of length 1 with these further lines, the first of
/// which is line 4.
#[track_caller]
fn complaint(lines: &str) -> String {
    refusal(&format!("length = 1.0\n[beam]\nbending = 5000.0\n{lines}\n"))
}
