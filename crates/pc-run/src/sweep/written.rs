//! Variations as a command line writes them: `NAME=FROM:TO:N`, `NAME=A,B,…`, `NAME=normal(m,s)`.

use std::str::FromStr;

use crate::sweep::law::{Law, LawError, Random};
use crate::sweep::values::{Values, Vary};

/// A text that is not a variation.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{why}")]
pub struct NotAVariation {
    /// Why the text is not a variation, and what would be correct.
    pub why: String,
}

fn refused(why: impl Into<String>) -> NotAVariation {
    NotAVariation { why: why.into() }
}

fn finite(text: &str) -> Result<f64, NotAVariation> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(refused("write a finite number, such as 10 or 1e-3")),
    }
}

impl FromStr for Vary {
    type Err = NotAVariation;

    fn from_str(text: &str) -> Result<Vary, NotAVariation> {
        let usage = || {
            refused(
                "write NAME=FROM:TO:N, NAME=FROM:TO:N:log or NAME=A,B,…, as in `--vary m=1:2:11` or `--vary m=1,2,5`",
            )
        };
        let (name, values) = text.split_once('=').ok_or_else(usage)?;
        let parts: Vec<&str> = values.split(':').map(str::trim).collect();
        let values = match &parts[..] {
            [from, to, count] => range(from, to, count, false)?,
            [from, to, count, "log"] => range(from, to, count, true)?,
            [values] if values.contains(',') => list(values)?,
            _ => return Err(usage()),
        };
        match name.trim() {
            "" => Err(usage()),
            name => Ok(Vary { name: name.to_owned(), values }),
        }
    }
}

fn range(from: &str, to: &str, count: &str, is_logarithmic: bool) -> Result<Values, NotAVariation> {
    let (from, to) = (finite(from)?, finite(to)?);
    let count = count.parse().ok().filter(|&count: &u64| count > 0);
    let count = count.ok_or_else(|| refused("the number of values must be a whole number, at least 1"))?;
    if count == 1 && from != to {
        return Err(refused(
            "one value cannot be at both ends; give 2 values, or the same number at both ends",
        ));
    }
    if is_logarithmic {
        if from == 0.0 || to == 0.0 || (from > 0.0) != (to > 0.0) {
            return Err(refused("a logarithmic range lies on one side of 0"));
        }
        return Ok(Values::Logarithmic(from, to, count));
    }
    if !(to - from).is_finite() {
        return Err(refused("the range is too large"));
    }
    Ok(Values::Even(from, to, count))
}

fn list(values: &str) -> Result<Values, NotAVariation> {
    let list = values.split(',').map(|value| finite(value.trim())).collect::<Result<Vec<f64>, _>>()?;
    match list.iter().enumerate().find(|(i, value)| list[..*i].contains(value)) {
        Some((_, value)) => Err(refused(format!("the value {value} is given twice"))),
        None => Ok(Values::List(list)),
    }
}

impl FromStr for Random {
    type Err = NotAVariation;

    fn from_str(text: &str) -> Result<Random, NotAVariation> {
        let usage = || refused("write NAME=normal(m,s), NAME=uniform(a,b) or NAME=lognormal(m,s)");
        let (name, law) = text.split_once('=').ok_or_else(usage)?;
        let (kind, numbers) =
            law.trim().strip_suffix(')').and_then(|law| law.split_once('(')).ok_or_else(usage)?;
        let (a, b) = numbers.split_once(',').ok_or_else(usage)?;
        let (a, b) = (finite(a.trim())?, finite(b.trim())?);
        let law = Law::of(kind.trim(), a, b).map_err(|error| match error {
            LawError::Unknown { .. } => usage(),
            LawError::Deviation | LawError::Bounds => refused(error.to_string()),
        })?;
        match name.trim() {
            "" => Err(usage()),
            name => Ok(Random { name: name.to_owned(), law }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variations_are_shown_as_they_are_written() {
        for text in ["m=1:2:3", "m=0.001:10:5:log", "m=5,1,-2"] {
            assert_eq!(text.parse::<Vary>().map(|vary| vary.to_string()), Ok(text.to_owned()));
        }
        assert_eq!(
            "x=normal(0, 0.1)".parse::<Random>().map(|random| random.to_string()),
            Ok("x=normal(0,0.1)".to_owned())
        );
    }

    #[test]
    fn variations_are_read_or_refused() {
        let m = |values| Vary { name: "m".to_owned(), values };
        assert_eq!("m=1:2:11".parse::<Vary>(), Ok(m(Values::Even(1.0, 2.0, 11))));
        assert_eq!("m = -1e3 : -1e3 : 1".parse::<Vary>(), Ok(m(Values::Even(-1e3, -1e3, 1))));
        assert_eq!("m=1e-3:10:5:log".parse::<Vary>(), Ok(m(Values::Logarithmic(1e-3, 10.0, 5))));
        assert_eq!("m = 5, 1,-2".parse::<Vary>(), Ok(m(Values::List(vec![5.0, 1.0, -2.0]))));
        for wrong in [
            "m",
            "m=1:2",
            "m=1:2:0",
            "m=1:2:1",
            "m=1:2:-3",
            "m=1:inf:3",
            "m=1:2:3:4",
            "=1:2:3",
            "m=-1e308:1e308:3",
            "m=1",
            "m=1,",
            "m=1,2,1",
            "m=1,nan",
            "m=0:1:3:log",
            "m=-1:1:3:log",
            "m=1:0:3:log",
            "m=1:2:3:lin",
        ] {
            assert!(wrong.parse::<Vary>().is_err(), "{wrong}");
        }
        let x = |law| Random { name: "x".to_owned(), law };
        assert_eq!("x=normal(0, 0.1)".parse::<Random>(), Ok(x(Law::Normal(0.0, 0.1))));
        assert_eq!("x=uniform(-1,1)".parse::<Random>(), Ok(x(Law::Uniform(-1.0, 1.0))));
        assert_eq!("x=lognormal(0,1)".parse::<Random>(), Ok(x(Law::LogNormal(0.0, 1.0))));
        for wrong in [
            "x",
            "x=normal",
            "x=normal(0)",
            "x=normal(0,-1)",
            "x=uniform(1,0)",
            "x=cauchy(0,1)",
            "=normal(0,1)",
        ] {
            assert!(wrong.parse::<Random>().is_err(), "{wrong}");
        }
    }
}
