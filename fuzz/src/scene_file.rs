//! Bytes through the reader of scene files.

use crate::reader;

/// Bytes are refused with one printable line of bounded length that begins with the file's name, or are a scene, whose
/// description and profiles can be asked for, in any order of what is not a number.
pub fn scene_file(data: &[u8]) {
    match reader::source::from_bytes(data, "scene.toml") {
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("scene.toml:"), "{message:?}");
            assert!(!message.chars().any(char::is_control), "{message:?}");
            assert!(message.len() < 2000, "{message:?}");
        }
        Ok(scene) => {
            assert!(scene.length.is_finite() && scene.length > 0.0);
            assert!(!scene.describe().is_empty());
            let (beam, load) = (&scene.beam, &scene.load);
            let foundation = scene.foundation.as_ref();
            let conduction = scene.conduction.as_ref();
            let profiles = [
                Some(&beam.bending),
                beam.axial.as_ref(),
                beam.piezo.as_ref(),
                beam.permittivity.as_ref(),
                foundation.map(|f| &f.stiffness),
                foundation.and_then(|f| f.gap.as_ref()),
                conduction.and_then(|c| c.mu1.as_ref()),
                conduction.and_then(|c| c.mu2.as_ref()),
                load.transverse.as_ref(),
                load.axial.as_ref(),
            ];
            for profile in profiles.into_iter().flatten() {
                let breaks = profile.breaks();
                let inside = |b: &f64| *b > 0.0 && *b < scene.length;
                assert!(breaks.iter().all(inside) && breaks.is_sorted_by(|a, b| a < b), "{profile:?}");
                for part in 0..=8 {
                    let x = scene.length * (f64::from(part) / 8.0);
                    let [value, _, _] = profile.jet(x, x);
                    let same = profile.value(x, x);
                    let close = (value - same).abs() <= 1e-9 * value.abs().max(same.abs());
                    let odd = !value.is_finite() || !same.is_finite();
                    assert!(close || odd, "{value} and {same} at {x}: {profile:?}");
                }
            }
            for (i, point) in load.points.iter().enumerate() {
                assert!(point.x > 0.0 && point.x < scene.length);
                assert!(scene.line_of(&format!("load.points[{i}].x")).is_some());
            }
        }
    }
}
