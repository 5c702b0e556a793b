//! The recursion in nodal values, as a textbook and the paper have it, to compare with: on each element the unknowns of
//! its left node are eliminated, S' = K22 - K21 (S + K11)^-1 K12, a difference of numbers of size C/h^3 that is of size
//! C/x^3.

use glam::{DMat2, DVec2};

/// Deflections at the `n` + 1 nodes of a beam of length 1, clamped at both ends, of stiffness `c`, under a uniform load
/// `f`, wholly in contact with a foundation `k`; Hermite cubics.
pub fn deflections(c: f64, k: f64, f: f64, n: usize) -> Vec<f64> {
    let h = 1.0 / n as f64;
    let (b, m) = (c / (h * h * h), k * h / 420.0);
    let matrix =
        |xx: f64, xy: f64, yx: f64, yy: f64| DMat2::from_cols(DVec2::new(xx, yx), DVec2::new(xy, yy));
    // Of deflection and slope at the left node, at both, and at the right one.
    let bent = [(12.0, 6.0, 6.0, 4.0), (-12.0, 6.0, -6.0, 2.0), (12.0, -6.0, -6.0, 4.0)];
    let held = [(156.0, 22.0, 22.0, 4.0), (54.0, -13.0, 13.0, -3.0), (156.0, -22.0, -22.0, 4.0)];
    let block = |i: usize| {
        let ((xx, xy, yx, yy), (mxx, mxy, myx, myy)) = (bent[i], held[i]);
        let of = |bent: f64, held: f64| b * bent + m * held;
        matrix(of(xx, mxx), h * of(xy, mxy), h * of(yx, myx), h * h * of(yy, myy))
    };
    let (k11, k12, k22) = (block(0), block(1), block(2));
    let k21 = k12.transpose();
    let (f1, f2) = (f * h / 2.0 * DVec2::new(1.0, h / 6.0), f * h / 2.0 * DVec2::new(1.0, -h / 6.0));
    let (mut s, mut load) = (k22, f2);
    let mut eliminated = Vec::with_capacity(n);
    for _ in 1..n {
        let inverse = (s + k11).inverse();
        eliminated.push((inverse, load + f1));
        load = f2 - k21 * (inverse * (load + f1));
        s = k22 - k21 * (inverse * k12);
    }
    let mut right = DVec2::ZERO;
    let mut found = vec![0.0];
    for (inverse, load) in eliminated.into_iter().rev() {
        right = inverse * (load - k12 * right);
        found.push(right.x);
    }
    found.push(0.0);
    found.reverse();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_elements_are_exact_at_nodes() {
        let found = deflections(5000.0, 0.0, 1e6, 8);
        assert_eq!(found.len(), 9);
        for (i, w) in found.iter().enumerate() {
            let x = i as f64 / 8.0;
            let want = 1e6 / 5000.0 * (x * (1.0 - x)).powi(2) / 24.0;
            assert!((w - want).abs() < 1e-10, "{i}: {w} {want}");
        }
        // Far from the clamps a stiff foundation takes all of the load.
        let held = deflections(1.0, 1e8, 1e6, 200);
        assert!((held[100] - 1e-2).abs() < 1e-6, "{}", held[100]);
    }
}
