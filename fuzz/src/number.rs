//! Numbers and positions that a byte string spells.

use arbitrary::{Arbitrary, Result, Unstructured};
use piezobeam::Real;

/// A number: most often what its place suggests or some decades off it, now and then something special.
#[derive(Clone, Copy, Debug)]
pub enum Number {
    /// What the place suggests.
    Nominal,
    /// So many quarters of a decade off, perhaps with the sign turned.
    Off { quarters: i8, turned: bool },
    /// So many decades off, perhaps with the sign turned.
    Far { decades: i16, turned: bool },
    /// One of the special values of the format.
    Special(u8),
    /// These bits.
    Bits(u64),
}

impl<'a> Arbitrary<'a> for Number {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        Ok(match u8::arbitrary(u)? {
            0..96 => Self::Nominal,
            tag @ 96..192 => Self::Off { quarters: i8::arbitrary(u)? / 4, turned: tag % 8 == 0 },
            tag @ 192..224 => Self::Far { decades: i16::arbitrary(u)? % 330, turned: tag % 4 == 0 },
            224..252 => Self::Special(u8::arbitrary(u)?),
            252.. => Self::Bits(u64::arbitrary(u)?),
        })
    }
}

impl Number {
    /// The number, where `nominal` is what its place suggests.
    pub fn of<T: Real>(self, nominal: f64) -> T {
        let sign = |turned: bool| if turned { -1.0 } else { 1.0 };
        match self {
            Self::Nominal => T::of(nominal),
            Self::Off { quarters, turned } => {
                T::of(sign(turned) * nominal * 10f64.powf(f64::from(quarters) / 4.0))
            }
            Self::Far { decades, turned } => T::of(sign(turned) * nominal * 10f64.powi(decades.into())),
            Self::Special(which) => special(which),
            Self::Bits(bits) => T::of(f64::from_bits(bits)),
        }
    }
}

fn special<T: Real>(which: u8) -> T {
    let tiny = T::min_positive_value();
    let values = [
        T::zero(),
        T::neg_zero(),
        tiny * T::epsilon(),
        tiny,
        tiny.sqrt(),
        T::epsilon(),
        T::one() - T::epsilon(),
        T::one(),
        T::max_value().sqrt(),
        T::max_value(),
        T::infinity(),
        T::nan(),
    ];
    let value = values[usize::from(which / 2) % values.len()];
    if which % 2 == 1 { -value } else { value }
}

/// A place on the beam: a 257th part of its length, or any number.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub struct Position {
    part: u8,
    number: Number,
}

/// The positions in ascending order (not a number last).
pub fn positions<T: Real>(list: &[Position], length: T) -> Vec<T> {
    let place = |p: &Position| p.number.of(length.f64() * (f64::from(p.part) + 1.0) / 257.0);
    let mut list: Vec<T> = list.iter().map(place).collect();
    list.sort_by(|a, b| a.f64().total_cmp(&b.f64()));
    list
}
