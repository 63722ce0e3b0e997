//! The values of a varied quantity.

use std::fmt;

/// A quantity with its values: `NAME=FROM:TO:N`, `NAME=FROM:TO:N:log` or `NAME=A,B,…`.
#[derive(Clone, Debug, PartialEq)]
pub struct Vary {
    /// The name of a parameter, or of something that has a start value.
    pub name: String,
    /// Its values.
    pub values: Values,
}

/// The values of a varied quantity, of which there is at least one.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// This many values from one number to another, evenly spaced.
    Even(f64, f64, u64),
    /// This many values from one number to another, with a constant ratio.
    Logarithmic(f64, f64, u64),
    /// The values listed.
    List(Vec<f64>),
}

impl Values {
    /// How many values there are.
    pub fn count(&self) -> u64 {
        match self {
            Values::Even(_, _, count) | Values::Logarithmic(_, _, count) => *count,
            Values::List(list) => list.len() as u64,
        }
    }

    /// All values, in order.
    pub fn in_order(&self) -> Vec<f64> {
        (0..self.count()).map(|place| self.at(place)).collect()
    }

    /// Value number `place`; the ends of a range are exact.
    pub fn at(&self, place: u64) -> f64 {
        let part = |count: u64| place as f64 / (count - 1) as f64;
        match self {
            Values::List(list) => list[place as usize],
            Values::Even(from, _, _) | Values::Logarithmic(from, _, _) if place == 0 => *from,
            Values::Even(_, to, count) | Values::Logarithmic(_, to, count) if place == count - 1 => *to,
            Values::Even(from, to, count) => from + (to - from) * part(*count),
            // Decimal logarithms keep powers of ten between powers of ten exact.
            Values::Logarithmic(from, to, count) => {
                let (a, b) = (from.abs().log10(), to.abs().log10());
                10f64.powf(a + (b - a) * part(*count)).copysign(*from)
            }
        }
    }
}

impl fmt::Display for Vary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}=", self.name)?;
        match &self.values {
            Values::Even(from, to, count) => write!(f, "{from}:{to}:{count}"),
            Values::Logarithmic(from, to, count) => write!(f, "{from}:{to}:{count}:log"),
            Values::List(list) => {
                write!(f, "{}", list.iter().map(f64::to_string).collect::<Vec<_>>().join(","))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_follow_their_spacing() {
        let all = |values: Values| values.in_order();
        assert_eq!(all(Values::Even(1.0, 2.0, 3)), [1.0, 1.5, 2.0]);
        assert_eq!(all(Values::Logarithmic(1e-3, 100.0, 6)), [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0]);
        // Rounding of the logarithm.
        let negative = all(Values::Logarithmic(-8.0, -2.0, 3));
        assert!((negative[1] + 4.0).abs() < 1e-14 && negative[0] == -8.0 && negative[2] == -2.0);
        assert_eq!(all(Values::List(vec![5.0, 1.0])), [5.0, 1.0]);
    }
}
