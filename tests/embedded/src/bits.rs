//! Random numbers and a hash of results that no target computes differently.

use core::fmt::{Display, Formatter, Result};
use piezobeam::{Fields, Model, Real, Smooth, Solution};

/// `f32` or `f64`, which are profiles of x, too: constant ones.
pub trait Number: Real + Smooth<Self> {}

impl<T: Real + Smooth<T>> Number for T {}

/// SplitMix64 (Steele, Lea and Flood, 2014): integers alone, and one exact conversion.
pub struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Of [from, to).
    #[allow(clippy::cast_precision_loss, reason = "53 bits fit")]
    pub fn within<T: Number>(&mut self, from: f64, to: f64) -> T {
        T::of(from + (to - from) * ((self.next() >> 11) as f64 / 9_007_199_254_740_992.0))
    }

    /// Of 0 to n - 1.
    #[allow(clippy::cast_possible_truncation, reason = "less than n")]
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// A size of 10^from to 10^to, by products alone.
    pub fn size<T: Number>(&mut self, from: i32, to: i32) -> T {
        let mut size = self.within::<f64>(1.0, 10.0);
        #[allow(clippy::cast_sign_loss, clippy::cast_possible_wrap, reason = "a few dozen")]
        let power = from + self.below((to - from) as usize) as i32;
        for _ in 0..power.abs() {
            size = if power > 0 { size * 10.0 } else { size / 10.0 };
        }
        T::of(size)
    }
}

/// FNV-1a over 64-bit words (Fowler, Noll and Vo).
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    /// One more word.
    pub fn word(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// One more number. The payload of what is no number is not specified, so it is left out.
    pub fn number<T: Number>(&mut self, x: T) {
        self.word(if x.is_nan() { u64::MAX } else { x.f64().to_bits() });
    }

    /// One more hash.
    pub fn hash(&mut self, other: Self) {
        self.word(other.0);
    }

    /// The fields at one place.
    pub fn fields<T: Number>(&mut self, at: &Fields<T>) {
        for x in [at.x, at.bending, at.slope, at.moment, at.shear] {
            self.number(x);
        }
        let rest =
            [at.stretching, at.potential, at.axial_force, at.electric_displacement, at.gap, at.pressure];
        for x in rest.into_iter().flatten() {
            self.number(x);
        }
    }

    /// All that a solution says: report, fields at nodes and between them, zones, resultants.
    pub fn solution<T: Number, M: Model<T>>(&mut self, solution: &Solution<'_, T, M>) {
        let report = solution.report();
        for byte in report.status.name().bytes() {
            self.word(u64::from(byte));
        }
        self.word(report.iterations as u64);
        self.word(report.element_visits as u64);
        self.number(report.residual);
        self.number(report.floor);
        let mut left = T::zero();
        for right in solution.nodes() {
            self.fields(&solution.at(left + T::of(0.3) * (right - left)));
            self.fields(&solution.at(right));
            left = right;
        }
        solution.for_each_zone(|a, b| {
            self.number(a);
            self.number(b);
        });
        let sum = solution.resultants();
        for x in [
            sum.contact_force,
            sum.conduction_force,
            sum.load,
            sum.left_force,
            sum.right_force,
            sum.left_moment,
            sum.right_moment,
            sum.bending_energy,
            sum.equilibrium_error,
        ] {
            self.number(x);
        }
    }
}

impl Display for Hash {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{:016x}", self.0)
    }
}

/// `f32` or `f64`, by name.
pub fn name<T: Number>() -> &'static str {
    if size_of::<T>() == 4 { "f32" } else { "f64" }
}
