//! Renderers: plain data in, text out. They read and write no file.
//!
//! Shared here: the table of fields, and numbers with SI prefixes.

pub mod beam;
pub mod chart;
pub mod csv;
pub mod extremes;
pub mod figures;
#[cfg(test)]
pub mod fixture;
pub mod html;
pub mod json;
pub mod overview;
pub mod plot;
pub mod sweep;
pub mod text;

use crate::report::Samples;

/// One field of the solution: how it is called, written, measured, and its values where the scene has it.
pub struct Field<'a> {
    pub name: &'static str,
    pub symbol: &'static str,
    pub unit: &'static str,
    pub values: Option<&'a [f64]>,
}

/// The fields in the order of the report.
pub fn fields(samples: &Samples) -> [Field<'_>; 8] {
    let s = samples;
    [
        ("bending", "ξ", "m", &s.bending),
        ("slope", "ξ′", "m/m", &s.slope),
        ("moment", "C ξ″", "N m", &s.moment),
        ("shear", "(C ξ″)′", "N", &s.shear),
        ("stretching", "u", "m", &s.stretching),
        ("potential", "q", "V", &s.potential),
        ("axial force", "σ", "N", &s.axial_force),
        ("electric displacement", "D", "C", &s.electric_displacement),
    ]
    .map(|(name, symbol, unit, values)| Field { name, symbol, unit, values: values.as_deref() })
}

/// A field's least and greatest finite values and where they first occur: `(x, value)` each.
pub fn extremes(x: &[f64], y: &[f64]) -> Option<((f64, f64), (f64, f64))> {
    let mut points = x.iter().copied().zip(y.iter().copied());
    let first = points.by_ref().find(|p| p.1.is_finite())?;
    Some(points.filter(|p| p.1.is_finite()).fold((first, first), |(lo, hi), p| {
        (if p.1 < lo.1 { p } else { lo }, if p.1 > hi.1 { p } else { hi })
    }))
}

/// The extremes worth a label in a picture, and whether it belongs below: neither zero nor tiny beside the other.
pub fn telling(x: &[f64], y: &[f64]) -> impl Iterator<Item = ((f64, f64), bool)> {
    const TINY: f64 = 1e-3;
    let found = extremes(x, y);
    let size = found.map_or(0.0, |(lo, hi)| lo.1.abs().max(hi.1.abs()));
    let both = found.into_iter().flat_map(|(lo, hi)| {
        let least = (lo.1 < hi.1).then_some((lo, true));
        [Some((hi, false)), least].into_iter().flatten()
    });
    both.filter(move |(at, _)| at.1 != 0.0 && at.1.abs() >= TINY * size)
}

/// An SI unit with a prefix that makes numbers of a given size readable.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// Value in the prefixed unit = value in SI times this.
    pub factor: f64,
    /// The unit with its prefix.
    pub unit: String,
}

impl Scale {
    /// The scale for values up to `size` in absolute value: none from 0.1 to 1000, where the plain unit reads best,
    /// else the prefix that leaves one to three digits before the point. Sizes no common prefix reaches stay plain.
    pub fn new(size: f64, unit: &str) -> Self {
        let prefix = Self::prefix(Self::thousands(size));
        Self::power(prefix.map_or(0, |_| Self::thousands(size)), prefix, unit)
    }

    /// As [`Scale::new`], with a power of ten before the unit where no prefix reaches: for axes, whose numbers must
    /// be of moderate size.
    pub fn axis(size: f64, unit: &str) -> Self {
        let thousands = Self::thousands(size);
        match Self::prefix(thousands) {
            Some(prefix) => Self::power(thousands, Some(prefix), unit),
            None => Self::power(thousands, Some(&format!("1e{} ", 3 * thousands)), unit),
        }
    }

    fn power(thousands: i32, prefix: Option<&str>, unit: &str) -> Self {
        Self { factor: 10f64.powi(-3 * thousands), unit: format!("{}{unit}", prefix.unwrap_or("")) }
    }

    /// The power of 1000 to leave out; within the range whose reciprocals are normal numbers.
    fn thousands(size: f64) -> i32 {
        let size = size.abs();
        if (0.1..1000.0).contains(&size) || size == 0.0 || !size.is_finite() {
            return 0;
        }
        // The tiny excess lifts 1e-6, whose logarithm may round below -6, into its own decade.
        (((size.log10() + 1e-12) / 3.0).floor() as i32).clamp(-102, 102)
    }

    fn prefix(thousands: i32) -> Option<&'static str> {
        const PREFIXES: [&str; 13] = ["a", "f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P", "E"];
        let plain = PREFIXES.len() as i32 / 2;
        let index = usize::try_from(plain + thousands).ok()?;
        PREFIXES.get(index).copied()
    }

    /// The axis scale for the largest finite value among `values`.
    pub fn of(values: impl IntoIterator<Item = f64>, unit: &str) -> Self {
        let finite = values.into_iter().filter(|v| v.is_finite());
        Self::axis(finite.fold(0.0, |m, v| m.max(v.abs())), unit)
    }

    /// `value` (SI) with `digits` significant digits and the prefixed unit.
    pub fn show(&self, value: f64, digits: usize) -> String {
        format!("{} {}", significant(value * self.factor, digits), self.unit)
    }
}

/// A number of things.
fn counted(n: usize, noun: &str) -> String {
    format!("{n} {noun}{}", if n == 1 { "" } else { "s" })
}

/// `text` with a capital first letter.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// `value` (SI) with a prefix of its own.
pub fn quantity(value: f64, unit: &str, digits: usize) -> String {
    Scale::new(value, unit).show(value, digits)
}

/// `value` with at most `digits` significant digits and no trailing zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let rounded = format!("{:.*e}", digits.saturating_sub(1), value);
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let trim = |s: &str| match s.contains('.') {
        true => s.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => s.to_owned(),
    };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..digits as i32 + 2).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        trim(&format!("{value:.decimals$}"))
    } else {
        format!("{}e{exponent}", trim(mantissa))
    }
}

/// Intervals in words: `[0, 318.5] mm`, the first `most` of them.
pub fn zones(zones: &[[f64; 2]], length: f64, digits: usize, most: usize) -> String {
    if zones.is_empty() {
        return "none".into();
    }
    let scale = Scale::new(length, "m");
    let end = |v: f64| significant(v * scale.factor, digits);
    let shown: Vec<_> = zones.iter().take(most).map(|&[a, b]| format!("[{}, {}]", end(a), end(b))).collect();
    let more = match zones.len().saturating_sub(most) {
        0 => String::new(),
        n => format!(" and {n} more"),
    };
    format!("{} {}{more}", shown.join(", "), scale.unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-112.599_2, "-112.599"),
            (0.099_999_99, "0.1"),
            (1_234_567.0, "1234567"),
            (1e9, "1e9"),
            (-1.234_567_8e-13, "-1.23457e-13"),
            (100.0, "100"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(significant(value, 6), text);
        }
    }

    #[test]
    fn prefixes() {
        for (value, text) in [
            (0.0, "0 m"),
            (0.3185, "0.3185 m"),
            (-0.063_713_8, "-63.7138 mm"),
            (4.8e-6, "4.8 µm"),
            (1e-6, "1 µm"),
            (1e-3, "1 mm"),
            (5e-4, "500 µm"),
            (187_038.5, "187.038 km"),
            (1000.0, "1 km"),
            (3e-30, "3e-30 m"),
            (f64::INFINITY, "inf m"),
        ] {
            assert_eq!(quantity(value, "m", 6), text);
        }
        assert_eq!(Scale::of([f64::NAN, -0.02, 0.01], "N m").unit, "mN m");
        assert_eq!(Scale::of([4.2e-20], "m").show(4.2e-20, 3), "42 1e-21 m");
        for size in [5e-324, f64::MAX] {
            let shown = size * Scale::of([size], "m").factor;
            assert!(shown.is_finite(), "{size:e}");
        }
    }

    #[test]
    fn extremes_skip_what_is_not_finite() {
        let x = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(extremes(&x, &[f64::NAN, 2.0, -1.0, 2.0]), Some(((2.0, -1.0), (1.0, 2.0))));
        assert_eq!(extremes(&x, &[f64::NAN; 4]), None);
        assert_eq!(extremes(&[], &[]), None);
        let labels = |y: &[f64]| telling(&x, y).map(|(at, _)| at.1).collect::<Vec<_>>();
        assert_eq!(labels(&[0.0, 2.0, 1.0, -1e-17]), [2.0]);
        assert_eq!(labels(&[1.0, 1.0, 1.0, 1.0]), [1.0]);
        assert_eq!(labels(&[0.0; 4]), [0.0; 0]);
    }

    #[test]
    fn intervals() {
        assert_eq!(zones(&[], 1.0, 4, 3), "none");
        assert_eq!(zones(&[[0.0, 0.318_538]], 1.0, 4, 3), "[0, 0.3185] m");
        let many = [[1e-4, 2e-4], [3e-4, 4e-4]];
        assert_eq!(zones(&many, 5e-4, 4, 1), "[100, 200] µm and 1 more");
    }
}
