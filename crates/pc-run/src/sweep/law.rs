//! The distributions from which members are drawn.

use std::fmt;

use pc_solve::member_stream;
use rand_distr::{Distribution, LogNormal, Normal, Uniform};

/// A quantity with the distribution of its values, [written](super::written) `NAME=DISTRIBUTION`.
#[derive(Clone, Debug, PartialEq)]
pub struct Random {
    /// The name of a parameter, or of something that has a start value.
    pub name: String,
    /// The distribution.
    pub law: Law,
}

/// A distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// The mean and the standard deviation.
    Normal(f64, f64),
    /// The smallest and the largest value.
    Uniform(f64, f64),
    /// The mean and the standard deviation of the logarithm.
    LogNormal(f64, f64),
}

/// Why a name and numbers do not give a distribution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// There is no distribution with this name.
    #[error("`{name}` is not a distribution; there are {}", Law::NAMES.join(", "))]
    Unknown {
        /// As written.
        name: String,
    },
    /// A deviation below 0.
    #[error("the standard deviation must not be negative")]
    Deviation,
    /// The bounds are in the wrong order, or too far apart.
    #[error("the first bound must be the lower one")]
    Bounds,
}

impl Law {
    /// The names of distributions.
    pub const NAMES: [&'static str; 3] = ["normal", "lognormal", "uniform"];

    /// The distribution `name(a, b)`, where a and b are finite numbers.
    ///
    /// # Errors
    /// [`LawError`]
    pub fn of(name: &str, a: f64, b: f64) -> Result<Law, LawError> {
        match name {
            "normal" if b >= 0.0 => Ok(Law::Normal(a, b)),
            "lognormal" if b >= 0.0 => Ok(Law::LogNormal(a, b)),
            "normal" | "lognormal" => Err(LawError::Deviation),
            "uniform" if a <= b && (b - a).is_finite() => Ok(Law::Uniform(a, b)),
            "uniform" => Err(LawError::Bounds),
            _ => Err(LawError::Unknown { name: name.to_owned() }),
        }
    }

    /// The values of a member, in the order of the distributions, drawn from its own random stream.
    pub fn draw(laws: &[Law], seed: u64, member: u64) -> Vec<f64> {
        let mut stream = member_stream(seed, member);
        let draw = |law: &Law| match *law {
            Law::Normal(m, s) => Normal::new(m, s).map_or(f64::NAN, |law| law.sample(&mut stream)),
            Law::LogNormal(m, s) => LogNormal::new(m, s).map_or(f64::NAN, |law| law.sample(&mut stream)),
            Law::Uniform(a, b) => {
                Uniform::new_inclusive(a, b).map_or(f64::NAN, |law| law.sample(&mut stream))
            }
        };
        laws.iter().map(draw).collect()
    }
}

impl fmt::Display for Random {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.name;
        match self.law {
            Law::Normal(m, s) => write!(f, "{name}=normal({m},{s})"),
            Law::Uniform(a, b) => write!(f, "{name}=uniform({a},{b})"),
            Law::LogNormal(m, s) => write!(f, "{name}=lognormal({m},{s})"),
        }
    }
}
