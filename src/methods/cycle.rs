//! Does an iteration go in circles? Brent's algorithm on a hash of the state.

use crate::real::Real;

/// A state that is compared with all that follow, replaced after 1, 2, 4, 8 ... of them: within three periods of a
/// circle's beginning it is found.
///
/// An iteration is a function of its state, so a state that comes back to the last bit comes back for ever. States
/// are compared by 64 bits of FNV-1a.
#[derive(Default)]
pub(super) struct Cycle {
    kept: u64,
    age: usize,
    most: usize,
}

impl Cycle {
    /// The number of states since the same one was seen.
    pub(super) fn see<T: Real>(&mut self, state: impl Iterator<Item = T>) -> Option<usize> {
        const PRIME: u64 = 0x0100_0000_01b3;
        const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
        let hash = state.fold(BASIS, |hash, x| {
            let bytes = x.f64().to_bits().to_le_bytes();
            bytes.iter().fold(hash, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(PRIME))
        });
        self.age += 1;
        if self.most > 0 && hash == self.kept {
            return Some(self.age);
        }
        if self.age >= self.most {
            (self.kept, self.age) = (hash, 0);
            self.most = (2 * self.most).max(1);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The period that is found of x -> (x + 1) with `tail` numbers before a circle of `period`, and when.
    fn found(tail: usize, period: usize) -> Option<(usize, usize)> {
        let mut cycle = Cycle::default();
        (0..1000).find_map(|n| {
            let x = if n < tail { n } else { tail + (n - tail) % period };
            cycle.see([x as f64, 0.5].into_iter()).map(|period| (period, n))
        })
    }

    #[test]
    fn circles_are_found_soon_with_their_period() {
        for tail in [0, 1, 2, 5, 30] {
            for period in [1, 2, 3, 7, 12] {
                let (seen, after) = found(tail, period).unwrap();
                assert_eq!(seen, period);
                assert!(after <= 3 * tail.max(period) + period + 2, "{tail} {period}: {after}");
            }
        }
    }

    #[test]
    fn what_never_comes_back_is_no_circle() {
        let mut cycle = Cycle::default();
        assert!((0..10_000_u32).all(|n| cycle.see([f64::from(n)].into_iter()).is_none()));
        assert!((0..100_u32).all(|n| Cycle::default().see([n as f32].into_iter()).is_none()));
    }
}
