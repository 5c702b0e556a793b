//! Numbers of a TOML document as finite doubles.

use toml::de::DeValue;

use super::error::cut;

/// Why a value is not a finite number.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Problem {
    /// It is text, a boolean, an array, ...
    NotANumber,
    /// It is `inf` or `nan`, as written.
    NotFinite(String),
    /// It is beyond the range of doubles, as written.
    TooLarge(String),
    /// It is not zero, but nearer to zero than any double, as written.
    TooSmall(String),
}

/// The value as a finite number, be it written as an integer or as a float.
pub(super) fn finite(value: &DeValue<'_>) -> Result<f64, Problem> {
    let (text, parsed) = match value {
        DeValue::Float(float) => (float.as_str(), float.as_str().parse().ok()),
        DeValue::Integer(integer) if integer.radix() == 10 => {
            (integer.as_str(), integer.as_str().parse().ok())
        }
        DeValue::Integer(integer) => {
            let parsed = u32::from_str_radix(integer.as_str(), integer.radix()).ok();
            (integer.as_str(), parsed.map(f64::from))
        }
        _ => return Err(Problem::NotANumber),
    };
    match parsed {
        Some(0.0) if vanishes(text) => Err(Problem::TooSmall(cut(text))),
        Some(number) if f64::is_finite(number) => Ok(number),
        Some(_) if text.contains("inf") || text.contains("nan") => Err(Problem::NotFinite(text.to_owned())),
        // The parser of TOML lets characters pass after an underscore that belong to no number.
        _ if text.chars().all(|c| c.is_ascii_hexdigit() || "+-.".contains(c)) => {
            Err(Problem::TooLarge(cut(text)))
        }
        _ => Err(Problem::NotANumber),
    }
}

/// Whether a number that reads as zero is written as another one, such as `1e-400`.
pub(super) fn vanishes(text: &str) -> bool {
    let digits = text.split(['e', 'E']).next().unwrap_or_default();
    digits.contains(|c: char| ('1'..='9').contains(&c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<f64, Problem> {
        finite(DeValue::parse(text).expect("valid TOML").get_ref())
    }

    #[test]
    fn integers_and_floats_are_numbers() {
        for (text, number) in [
            ("0", 0.0),
            ("-3", -3.0),
            ("+1_000", 1000.0),
            ("1e3", 1000.0),
            ("-2.5E-1", -0.25),
            ("1_0.2_5", 10.25),
            ("0x1F", 31.0),
            ("0b101", 5.0),
            ("123456789012345678901234567890", 1.234_567_890_123_456_8e29),
            ("0e-999", 0.0),
            ("-0.0", 0.0),
            ("5e-324", 5e-324),
        ] {
            assert_eq!(of(text), Ok(number), "{text}");
        }
    }

    #[test]
    fn other_values_are_not() {
        for text in ["true", "\"1\"", "[1]", "{a = 1}", "2024-01-01"] {
            assert_eq!(of(text), Err(Problem::NotANumber), "{text}");
        }
        assert_eq!(of("1_2\u{2}"), Err(Problem::NotANumber));
        for text in ["inf", "-inf", "+inf", "nan", "-nan"] {
            assert_eq!(of(text), Err(Problem::NotFinite(text.into())), "{text}");
        }
        for text in ["1e999", "-1e999"] {
            assert_eq!(of(text), Err(Problem::TooLarge(text.into())), "{text}");
        }
        for text in ["1e-999", "-0.001E-400", "1e-324"] {
            assert_eq!(of(text), Err(Problem::TooSmall(text.into())), "{text}");
        }
        let digits = "9".repeat(400);
        let cut = format!("{}…", &digits[..60]);
        assert_eq!(of(&digits), Err(Problem::TooLarge(cut)));
    }
}
