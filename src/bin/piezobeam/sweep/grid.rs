//! What to vary: the values of each number of the scene, their full product, and a shard of it.

use std::ops::Range;
use std::str::FromStr;

/// Rows of a table at most: more is a slip, not a study.
const MOST: usize = 10_000_000;
/// Values of one number at most.
const MOST_VALUES: usize = 100_000;

/// A number of the scene and its values: `foundation.stiffness=log:1e0:1e16:17`.
#[derive(Debug, Clone, PartialEq)]
pub struct Vary {
    /// Dotted path in the scene file.
    pub path: String,
    pub values: Vec<f64>,
    /// Values that are spaced evenly in their logarithm are shown so.
    pub logarithmic: bool,
}

const FORMS: &str = "expected FIELD=lin:FROM:TO:COUNT, FIELD=log:FROM:TO:COUNT or FIELD=VALUE,VALUE,..";

impl FromStr for Vary {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let (path, values) = text.split_once('=').ok_or(FORMS)?;
        let path = path.trim();
        if path.is_empty() {
            return Err(FORMS.into());
        }
        let values = values.trim();
        let (logarithmic, values) = match values.split_once(':') {
            Some(("lin", range)) => (false, spaced(range, false)?),
            Some(("log", range)) => (true, spaced(range, true)?),
            Some((other, _)) => return Err(format!("{other:?} is no kind of spacing; {FORMS}")),
            None => (false, values.split(',').map(number).collect::<Result<_, _>>()?),
        };
        Ok(Self { path: path.to_owned(), values, logarithmic })
    }
}

fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("{:?} is not a finite number; {FORMS}", text.trim())),
    }
}

/// FROM:TO:COUNT, both ends included.
fn spaced(text: &str, logarithmic: bool) -> Result<Vec<f64>, String> {
    let parts: Vec<&str> = text.split(':').collect();
    let [from, to, count] = parts.as_slice() else { return Err(FORMS.into()) };
    let (from, to) = (number(from)?, number(to)?);
    let count: usize = match count.trim().parse() {
        Ok(count) if (2..=MOST_VALUES).contains(&count) => count,
        _ => return Err(format!("{:?} is no number of values from 2 to {MOST_VALUES}", count.trim())),
    };
    if logarithmic && !(from > 0.0 && to > 0.0) {
        return Err("values spaced in their logarithm are positive; use lin: for others".into());
    }
    let at = |i: usize| {
        let share = i as f64 / (count - 1) as f64;
        match i {
            0 => from,
            i if i == count - 1 => to,
            _ if logarithmic => rounded((from.ln() * (1.0 - share) + to.ln() * share).exp(), 12),
            _ => rounded(from * (1.0 - share) + to * share, 15),
        }
    };
    Ok((0..count).map(at).collect())
}

/// With so many significant digits: a decade of a logarithmic scale is a power of ten.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// The full product; the last number varies fastest.
pub struct Grid<'v> {
    vary: &'v [Vary],
    rows: usize,
}

impl<'v> Grid<'v> {
    /// # Errors
    /// A number that is varied twice, or more rows than any study has.
    pub fn new(vary: &'v [Vary]) -> Result<Self, String> {
        for (i, one) in vary.iter().enumerate() {
            if vary[..i].iter().any(|other| other.path == one.path) {
                return Err(format!("--vary {} is given twice; list all its values once", one.path));
            }
        }
        let product = vary.iter().try_fold(1_usize, |rows, one| rows.checked_mul(one.values.len()));
        match product {
            Some(rows) if rows <= MOST => Ok(Self { vary, rows }),
            _ => Err(format!("--vary makes more than {MOST} scenes; leave out some values")),
        }
    }

    /// The rows of a shard.
    pub fn rows(&self, shard: Shard) -> Range<usize> {
        let Shard { number, of } = shard;
        let start = |n: usize| (self.rows as u128 * n as u128 / of as u128) as usize;
        start(number - 1)..start(number)
    }

    /// The values of a row, in the order in which they were asked for.
    pub fn values(&self, row: usize) -> Vec<f64> {
        let mut rest = row;
        let mut values: Vec<f64> = (self.vary.iter().rev())
            .map(|one| {
                let value = one.values[rest % one.values.len()];
                rest /= one.values.len();
                value
            })
            .collect();
        values.reverse();
        values
    }
}

/// A part of the table, counted from 1: consecutive rows, as many in each but for one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// The whole table.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// The shard that carries the header.
    pub fn is_first(self) -> bool {
        self.number == 1
    }
}

impl FromStr for Shard {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').map(|(number, of)| (number.parse(), of.parse()));
        match numbers {
            Some((Ok(number), Ok(of))) if (1..=of).contains(&number) => Ok(Self { number, of }),
            _ => Err("expected I/N, shard I of N, counted from 1, such as 3/8".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<f64> {
        text.parse::<Vary>().unwrap().values
    }

    #[test]
    fn spacings() {
        assert_eq!(values("a=lin:0:1e6:5"), [0.0, 250e3, 500e3, 750e3, 1e6]);
        assert_eq!(values("a=lin:0:1:11")[3], 0.3);
        let decades = values("foundation.stiffness=log:1e0:1e16:17");
        assert!(
            decades.iter().enumerate().all(|(i, &k)| k == format!("1e{i}").parse::<f64>().unwrap()),
            "{decades:?}"
        );
        assert_eq!(values("a = 3, -1,2.5e3"), [3.0, -1.0, 2500.0]);
        assert_eq!(values("a=log:8:0.125:3"), [8.0, 1.0, 0.125]);
        let vary: Vary = "load.points[0].x=log:1:10:2".parse().unwrap();
        assert!(vary.path == "load.points[0].x" && vary.logarithmic);
    }

    #[test]
    fn what_is_no_spacing_is_refused() {
        for (text, why) in [
            ("a", "expected FIELD="),
            ("=1,2", "expected FIELD="),
            ("a=", "\"\" is not a finite number"),
            ("a=1,inf", "\"inf\" is not a finite number"),
            ("a=exp:1:2:3", "\"exp\" is no kind of spacing"),
            ("a=lin:1:2", "expected FIELD="),
            ("a=lin:1:2:1", "no number of values"),
            ("a=log:0:2:3", "positive"),
        ] {
            let error = text.parse::<Vary>().unwrap_err();
            assert!(error.contains(why), "{text}: {error}");
        }
    }

    #[test]
    fn the_last_number_varies_fastest_and_shards_are_all_rows_once() {
        let vary = ["a=1,2", "b=10,20,30"].map(|text| text.parse::<Vary>().unwrap());
        let grid = Grid::new(&vary).unwrap();
        let rows: Vec<_> = grid.rows(Shard::WHOLE).map(|row| grid.values(row)).collect();
        assert_eq!(rows[..4], [[1.0, 10.0], [1.0, 20.0], [1.0, 30.0], [2.0, 10.0]]);
        for of in 1..10 {
            let mut next = 0;
            for number in 1..=of {
                let rows = grid.rows(format!("{number}/{of}").parse().unwrap());
                assert_eq!(rows.start, next);
                next = rows.end;
            }
            assert_eq!(next, 6);
        }
        assert!(Grid::new(&[vary[0].clone(), vary[0].clone()]).is_err());
        let long = ["c=lin:0:1:10000", "d=lin:0:1:1000"].map(|text| text.parse::<Vary>().unwrap());
        assert!(Grid::new(&long).is_ok());
        assert!(Grid::new(&[&vary[..1], &long].concat()).is_err());
    }

    #[test]
    fn shards() {
        for wrong in ["0/3", "4/3", "1", "1/0", "a/b", "-1/2", ""] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
        assert!("1/3".parse::<Shard>().unwrap().is_first() && !"3/3".parse::<Shard>().unwrap().is_first());
    }
}
