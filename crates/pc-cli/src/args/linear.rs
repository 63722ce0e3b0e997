//! Arguments of `pc linearize` and `pc equilibria`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use pc_run::linear::locus_picture::Axes;
use pc_run::sweep::values::Vary;

use crate::args::options::{self, ModelArguments, VerifyArguments};
use crate::args::steady::StateArguments;
use crate::args::table::{OutputArguments, TableArguments};

/// The axes of the complex plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PlaneAxes {
    /// Linear.
    Linear,
    /// Logarithmic with a sign, and linear about zero.
    Symlog,
}

impl From<PlaneAxes> for Axes {
    fn from(axes: PlaneAxes) -> Axes {
        match axes {
            PlaneAxes::Linear => Axes::Linear,
            PlaneAxes::Symlog => Axes::Symlog,
        }
    }
}

/// Arguments of `pc linearize`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:\n  \
                        pc linearize furuta-pendulum --set θ=0.1\n  \
                        pc linearize cart-pole --format json\n  \
                        pc linearize whipple-bicycle --set roll=0 --vary v0=0:10:101 -o bicycle.csv --plot bicycle.svg\n  \
                        pc linearize quadrotor --free f1,f2,f3,f4,θ,φ --set p=0 --set q=0 --set s=0\n  \
                        pc linearize heavy-top-euler --at start -o top.mat\n\
                        Given are the matrices of δẏ = A δy + B δu and δh = C δy + D δu, u the [inputs] and h the [outputs] of the model, \
                        the eigenvalues and modes of A, and M, G, K, F of M q̈ + G q̇ + K q = F u where that is defined. \
                        Derivatives are exact. y are independent components of the states that satisfy the constraints; \
                        cyclic coordinates are left out where they move. The page docs/linearization.md says what the files contain.\n\
                        Exit codes: 4 where nothing is steady or defined, 5 where Newton's method found nothing, others as of `pc`.")]
pub struct LinearizeArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// The state.
    #[command(flatten)]
    pub state: StateArguments,
    /// Choose these inputs and components of the state, separated by commas, so that the state is steady (trim); all others keep
    /// their values
    #[arg(long, value_name = "NAMES", value_delimiter = ',', conflicts_with_all = ["at", "hold", "vary"])]
    pub free: Vec<String>,
    /// Follow the eigenvalues over N evenly spaced values of a parameter or start value, both ends included: the root locus
    #[arg(long, value_name = "NAME=FROM:TO:N")]
    pub vary: Option<Vary>,
    /// Further outputs h.
    #[command(flatten)]
    pub outputs: OutputArguments,
    /// The matrices, or with --vary the table of eigenvalues.
    #[command(flatten)]
    pub table: TableArguments,
    /// With --vary: draw the eigenvalues in the complex plane, and their real and imaginary parts, to FILE.svg, FILE.png or FILE.pdf
    #[arg(long, value_name = "FILE", requires = "vary")]
    pub plot: Option<PathBuf>,
    /// With --plot: the axes of the complex plane; symlog shows eigenvalues of very different sizes
    #[arg(long, value_name = "SCALE", default_value = "linear", requires = "plot")]
    pub axes: PlaneAxes,
    /// Verification.
    #[command(flatten)]
    pub verify: VerifyArguments,
}

/// Arguments of `pc equilibria`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:\n  \
                        pc equilibria furuta-pendulum\n  \
                        pc equilibria double-spherical-pendulum --box α1=-4:4 --starts 100\n  \
                        pc equilibria gravity-gradient --format json\n\
                        Newton's method starts from points that fill the box evenly, the same each time. What is found are equilibria; \
                        that there are no others is not proved. Angles are taken modulo 2π; cyclic coordinates stay at their start \
                        values. Of a continuous family one member is listed.\n\
                        Exit codes: 4 where the equations depend on time, 5 where none was found, others as of `pc`.")]
pub struct EquilibriaArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Bounds of a coordinate or first-order state (repeatable) [default: for angles, one turn about the start; for others, 2
    /// (1 + |start|) on either side of the start, beyond which equilibria may still be found]
    #[arg(long = "box", value_name = "NAME=FROM:TO", value_parser = bounds)]
    pub bounds: Vec<Bounds>,
    /// Number of points from which Newton's method starts
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = starts)]
    pub starts: usize,
    /// Further outputs.
    #[command(flatten)]
    pub outputs: OutputArguments,
    /// The list.
    #[command(flatten)]
    pub table: TableArguments,
    /// Verification.
    #[command(flatten)]
    pub verify: VerifyArguments,
}

/// `NAME=FROM:TO`
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// The coordinate or first-order state.
    pub name: String,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// The largest number of starts: more would take hours.
const MOST_STARTS: usize = 1_000_000;

fn starts(text: &str) -> Result<usize, String> {
    let count = text.parse::<usize>().ok().filter(|count| (1..=MOST_STARTS).contains(count));
    count.ok_or_else(|| format!("write a whole number from 1 to {MOST_STARTS}"))
}

fn bounds(text: &str) -> Result<Bounds, String> {
    let usage = || "write NAME=FROM:TO, as in `--box x=-2:2`".to_owned();
    let (name, range) = text.split_once('=').ok_or_else(usage)?;
    let (low, high) = range.split_once(':').ok_or_else(usage)?;
    let (low, high) = (options::finite(low.trim())?, options::finite(high.trim())?);
    if low > high {
        return Err("the first bound must be the lower one".to_owned());
    }
    match name.trim() {
        "" => Err(usage()),
        name => Ok(Bounds { name: name.to_owned(), low, high }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_read_or_refused() {
        let x = |low, high| Bounds { name: "x".to_owned(), low, high };
        assert_eq!(bounds("x=-2:2"), Ok(x(-2.0, 2.0)));
        assert_eq!(bounds("x = -.5 : 1e3"), Ok(x(-0.5, 1e3)));
        for wrong in ["x", "x=1", "x=1..2", "=1:2", "x=2:1", "x=1:inf", "x=:2", "x=1:2:3"] {
            assert!(bounds(wrong).is_err(), "{wrong}");
        }
        assert!(starts("0").is_err() && starts("1e3").is_err() && starts("64") == Ok(64));
    }
}
