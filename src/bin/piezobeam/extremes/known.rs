//! Closed forms and files of the reference suite.

use super::{Known, Reference};

macro_rules! suite {
    ($name:literal) => {
        $crate::extremes::Reference::Suite(
            $name,
            include_str!(concat!("../../../../tests/reference/", $name, ".json")),
        )
    };
}
pub(super) use suite;

fn bending(name: &'static str, xi: impl Fn(f64) -> f64 + 'static) -> Reference {
    Reference::Closed(name, Box::new(move |x| Known { bending: xi(x), electric: None }))
}

/// Clamped at both ends, under a uniform load.
pub(super) fn free(c: f64, f: f64, length: f64) -> Reference {
    bending("closed form", move |x| uniform(c, f, length, x))
}

fn uniform(c: f64, f: f64, length: f64, x: f64) -> f64 {
    let (left, right) = (x, length - x);
    f / c * (left * right / 24.0) * (left * right)
}

/// Of length 1 and without contact, under f on the left half and -f on the right: each half is clamped and simply
/// supported.
pub(super) fn halves_free(c: f64, f: f64) -> Reference {
    let half = move |x: f64| f / c * (x * x) * (0.75 - 2.5 * x + 2.0 * x * x) / 48.0;
    bending("closed form", move |x| if x < 0.5 { half(x) } else { -half(1.0 - x) })
}

/// The same load over a rigid foundation.
pub(super) fn halves_rigid(c: f64, f: f64) -> Reference {
    bending("rigid limit", rigid_halves(c, f))
}

/// Bending of a beam of length 1 under f on the left half and -f on the right, over a rigid foundation: at rest on it from
/// 0 to a, where a concentrated force acts; from there to the right clamp l = 1 - a satisfies l^4 - l + 3/8 = 0.
pub fn rigid_halves(c: f64, f: f64) -> impl Fn(f64) -> f64 {
    let mut l = 0.8_f64;
    for _ in 0..50 {
        l -= (l.powi(4) - l + 0.375) / (4.0 * l.powi(3) - 1.0);
    }
    let shear = (0.25 - l.powi(3)) / (3.0 * l * l);
    move |x| {
        let y = (x - (1.0 - l)).max(0.0);
        let turned = (x - 0.5).max(0.0);
        f / c * (shear * y.powi(3) / 6.0 + y.powi(4) / 24.0 - turned.powi(4) / 12.0)
    }
}

/// Of length 1, pressed onto a foundation so stiff that the layers at both clamps do not see each other.
pub(super) fn pressed(c: f64, k: f64, f: f64) -> Reference {
    let beta = (k / c / 4.0).sqrt().sqrt();
    let layer = move |x: f64| (-beta * x).exp() * ((beta * x).cos() + (beta * x).sin());
    bending("closed form", move |x| f / k * (1.0 - layer(x) - layer(1.0 - x)))
}

/// Of length 1, under a uniform load, held up at its middle to the height `held`.
pub(super) fn supported(c: f64, f: f64, held: f64) -> Reference {
    let force = (uniform(c, f, 1.0, 0.5) - held) * 192.0 * c;
    bending("rigid limit", move |x| {
        let y = x.min(1.0 - x);
        uniform(c, f, 1.0, x) - force * y * y * (3.0 - 4.0 * y) / (48.0 * c)
    })
}

/// Without contact, of length 1: bending under f, and u and q with constant coefficients, where q follows u but for
/// its end values.
pub(super) fn stretched(c: f64, f: f64, axial: [f64; 4], ends: [f64; 2]) -> Reference {
    let [stiffness, piezo, permittivity, load] = axial;
    Reference::Closed(
        "closed form",
        Box::new(move |x| {
            let ratio = piezo / permittivity;
            let u = load * x * (1.0 - x) / 2.0 / (stiffness + piezo * ratio);
            let q = ends[0] * (1.0 - x) + ends[1] * x - ratio * u;
            Known { bending: uniform(c, f, 1.0, x), electric: Some([u, q]) }
        }),
    )
}
