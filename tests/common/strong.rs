//! Random scenes whose bending and potential act on each other strongly.

use piezobeam::Beam;
use proptest::prelude::*;

/// A scene with everything, by its numbers.
#[derive(Clone, Debug)]
pub struct Numbers {
    pub elements: usize,
    pub beam: Beam<f64, f64, f64, f64>,
    pub mu: [f64; 2],
    pub truncation: f64,
    pub potential_truncation: f64,
    pub stiffness: f64,
    /// Height of the gap's bump.
    pub gap: f64,
    /// Where the load steps, and its values.
    pub step: [f64; 1],
    pub load: [f64; 2],
    pub ends: [f64; 2],
}

prop_compose! {
    /// 10^x, x between the bounds.
    fn powers(low: f64, high: f64)(x in low..high) -> f64 {
        10f64.powf(x)
    }
}

prop_compose! {
    fn signed(low: f64, high: f64)(size in powers(low, high), up in any::<bool>()) -> f64 {
        if up { size } else { -size }
    }
}

prop_compose! {
    /// A beam up to 10^most times past the condition (2.15).
    pub fn numbers(most: f64)(
        elements in powers(0.903, 3.3),
        bending in powers(-3.0, 5.0),
        axial in powers(0.0, 8.0),
        permittivity in powers(-6.0, 2.0),
        piezo in prop_oneof![Just(0.0), signed(-2.0, 2.0)],
        truncation in powers(-2.0, 0.0),
        larger in prop_oneof![Just(1.0), powers(0.0, 4.0)],
        past in powers(-0.5, most),
        ratio in powers(-2.0, 2.0),
        stiffness in prop_oneof![Just(0.0), powers(-2.0, 12.0)],
        gap in prop_oneof![Just(0.0), signed(-3.0, 0.0)],
        step in prop::array::uniform1(0.02..0.98_f64),
        size in powers(-2.0, 1.5),
        load in prop::array::uniform2(signed(-1.0, 0.0)),
        ends in prop::array::uniform2(signed(-1.0, 1.5)),
    ) -> Numbers {
        let potential_truncation = truncation * larger;
        let (c1, c2) = (1.0 / core::f64::consts::PI, (1.0 / 4.730_040_744_862_704_f64).powi(2));
        let by_bending = bending / c2 / c2 / (potential_truncation + 0.5 * truncation + ratio * truncation);
        let by_permittivity = permittivity / c1 / c1 / (0.5 * truncation + ratio * truncation);
        let mu1 = past * by_bending.min(by_permittivity);
        Numbers {
            elements: elements as usize,
            beam: Beam { bending, axial, piezo: piezo * (axial * permittivity).sqrt(), permittivity },
            mu: [mu1, ratio * mu1],
            truncation,
            potential_truncation,
            stiffness: stiffness * bending,
            gap: gap * truncation,
            step,
            load: load.map(|f| 384.0 * bending * truncation * size * f),
            ends: ends.map(|q| q * potential_truncation),
        }
    }
}
