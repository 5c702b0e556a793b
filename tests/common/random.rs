//! Random scenes of all kinds, the same ones every time.

use super::Shape;
use piezobeam::{Beam, Conduction, Foundation, Linear, Load, Model, Potential, Power, Scene, Steps};
use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};

/// What is done with a scene; `n` is a number of elements that suits it.
pub trait Visit {
    fn scene<M: Model<f64>>(&mut self, i: usize, scene: &M, n: usize);
}

struct Numbers(TestRng);

impl Numbers {
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
    fn power(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }
    fn signed(&mut self, low: f64, high: f64) -> f64 {
        let size = self.power(low, high);
        if self.unit() < 0.5 { size } else { -size }
    }
}

/// Beams of all sizes on foundations up to k L^4 / C = 1e13, with gaps and preloads, linear and curved laws, with and
/// without conduction either way.
pub fn scenes(count: usize, visit: &mut impl Visit) {
    let mut numbers = Numbers(TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    for i in 0..count {
        let n = numbers.power(0.7, 2.1) as usize;
        let (length, bending) = (numbers.power(-3.0, 1.0), numbers.power(-6.0, 6.0));
        let stiffness = numbers.power(0.0, 13.0) * bending / length.powi(4);
        // What bends a free clamped beam by a length.
        let unit = 384.0 * bending / length.powi(3);
        let depth = length * numbers.power(-4.0, -1.0);
        let values =
            [numbers.signed(-1.0, 0.0), numbers.signed(-1.0, 0.0)].map(|f| f * unit * depth / length);
        let breaks = [length * (numbers.between(1.0, n as f64).floor() / n as f64).min(0.999)];
        let transverse = Steps { breaks: &breaks, values: &values };
        let load = Load { transverse, axial: (), points: () };
        let g = if numbers.unit() < 0.3 { 0.0 } else { numbers.signed(-2.0, 0.0) * depth };
        let hump =
            [0.0, 0.0, 16.0, -32.0, 16.0].iter().enumerate().map(|(i, c)| c * g / length.powi(i as i32));
        let gap = Shape::Pieces { breaks: vec![], polynomials: vec![hump.collect()] };
        let truncation = depth * numbers.power(-0.5, 1.0);
        let permittivity = numbers.power(-3.0, 3.0);
        let volts = numbers.power(-2.0, 2.0);
        // Around the condition (2.15), for most below it.
        let by_bending = 500.0 * bending / length.powi(4) / (volts + truncation);
        let by_permittivity = 9.0 * permittivity / length.powi(2) / truncation;
        let mu = numbers.power(-3.0, 0.5) * by_bending.min(by_permittivity);
        let ends =
            Potential { left: volts * numbers.between(-1.0, 1.0), right: volts * numbers.between(-1.0, 1.0) };

        let linear = Foundation { law: Linear(stiffness), gap: gap.clone() };
        let elastic = Scene::new(length, Beam::elastic(bending)).load(load);
        let beam = Beam { bending, axial: permittivity, piezo: 0.3 * permittivity, permittivity };
        let electric = Scene::new(length, beam).load(load).potential(ends).foundation(linear.clone());
        let conduction =
            |mu1: f64, mu2: f64| Conduction { mu1, mu2, truncation, potential_truncation: volts };
        match i % 5 {
            0 => visit.scene(i, &elastic.foundation(linear), n),
            1 => {
                let exponent = [1.5, 2.0, 3.0][i % 3];
                let stiffness = stiffness / (0.1 * depth).powf(exponent - 1.0);
                visit.scene(
                    i,
                    &elastic.foundation(Foundation { law: Power { stiffness, exponent }, gap }),
                    n,
                );
            }
            2 => visit.scene(i, &electric.conduction(conduction(mu, 0.0)), n),
            3 => visit.scene(i, &electric.conduction(conduction(0.0, mu)), n),
            _ => visit.scene(i, &electric.conduction(conduction(mu, 0.3 * mu)), n),
        }
    }
}
