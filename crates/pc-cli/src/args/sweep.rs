//! Arguments of `pc sweep`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{ArgGroup, Args};

use crate::args::checkpoint::CheckpointArguments;
use crate::args::forms::{RunForm, run_form};
use crate::args::options;
use crate::args::options::{EventArguments, Method, ModelArguments, RunArguments, VelocityArguments};

/// Arguments of `pc sweep`.
#[derive(Clone, Debug, Args)]
#[command(
    group(ArgGroup::new("members").args(["vary", "random"]).required(true)),
    after_help = "Members of a grid are all combinations of the values, the last --vary changing fastest. \
                  lognormal(m,s) is exp of normal(m,s).\n\
                  A row has the number of the member, the varied values (start values as NAME(start)), how it ended \
                  (completed; event: it was ended by the event of the message; failed: the row is what was reached; refused: it could not start; panicked), the \
                  columns of `pc run` at the end, the drift of each integral, the number of steps, and a message \
                  where it was not completed.\n\
                  What is finished is kept in FILE.partial until FILE is complete: after an interruption of any kind \
                  the same command goes on from there, and gives the same bytes.\n\
                  Exit codes: 0 also if some members were not completed, they are counted in the summary; 5 if none \
                  was; 6 if something could not be written; 130 interrupted."
)]
pub struct SweepArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Give a parameter or start value N values evenly spaced, both ends included (repeatable)
    #[arg(long, value_name = "NAME=FROM:TO:N", value_parser = vary, conflicts_with = "random")]
    pub vary: Vec<Vary>,
    /// Draw a parameter or start value: normal(m,s), uniform(a,b) or lognormal(m,s) (repeatable)
    #[arg(long, value_name = "NAME=DISTRIBUTION", value_parser = random, requires = "samples")]
    pub random: Vec<Random>,
    /// Number of randomly drawn members
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), requires = "random", conflicts_with = "vary")]
    pub samples: Option<u64>,
    /// Seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// Number of threads; else one for each core. The result is the same for any
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
    /// End time; else that of the file
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = options::finite)]
    pub t_end: Option<f64>,
    /// Write N rows of each member, evenly spaced, start and end included, instead of the last one and the drifts
    #[arg(long, value_name = "N", value_parser = options::samples)]
    pub rows: Option<usize>,
    /// Relative tolerance; else that of the file, else 1e-9
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = options::positive)]
    pub rtol: Option<f64>,
    /// Absolute tolerance; else that of the file, else 1e-12
    #[arg(long, value_name = "A", allow_hyphen_values = true, value_parser = options::positive)]
    pub atol: Option<f64>,
    /// Largest step; else that of the file, else unlimited. Events that come and go within a step are not seen
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = options::positive)]
    pub max_step: Option<f64>,
    /// Events.
    #[command(flatten)]
    pub events: EventArguments,
    /// Method: adams, dop853 or taylor (not stiff), bdf (stiff) or auto (dop853, and bdf where stiffness is seen); else that of the file,
    /// else adams
    #[arg(long, value_name = "METHOD", value_parser = options::method)]
    pub method: Option<Method>,
    /// Form of the equations: poincare or canonical; else that of the file, else poincare. Columns stay the same
    #[arg(long, value_name = "FORM", value_parser = run_form)]
    pub form: Option<RunForm>,
    /// Keep an integral, or energy, at its start value by projection after each step (repeatable)
    #[arg(long, value_name = "NAME")]
    pub project: Vec<String>,
    /// Write the table to FILE.csv, FILE.json, FILE.npz or FILE.parquet
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

impl SweepArguments {
    /// The corresponding arguments of `pc run` for one member.
    pub fn as_run(&self) -> RunArguments {
        RunArguments {
            velocities: VelocityArguments::default(),
            sensitivities: Vec::new(),
            model: self.model.clone(),
            t_end: self.t_end,
            samples: self.rows,
            rtol: self.rtol,
            atol: self.atol,
            max_step: self.max_step,
            events: self.events.clone(),
            method: self.method,
            form: self.form,
            project: self.project.clone(),
            outputs: None,
            no_verify: true,
            output: None,
            plot: None,
            checkpoints: CheckpointArguments::default(),
        }
    }
}

/// `NAME=FROM:TO:N`
#[derive(Clone, Debug, PartialEq)]
pub struct Vary {
    /// The parameter, coordinate or quasi-velocity.
    pub name: String,
    /// First value.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// How many, at least 1.
    pub count: u64,
}

/// `NAME=DISTRIBUTION`
#[derive(Clone, Debug, PartialEq)]
pub struct Random {
    /// The parameter, coordinate or quasi-velocity.
    pub name: String,
    /// The distribution.
    pub law: Law,
}

/// A distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Mean and standard deviation.
    Normal(f64, f64),
    /// Least and largest value.
    Uniform(f64, f64),
    /// Mean and standard deviation of the logarithm.
    LogNormal(f64, f64),
}

fn vary(text: &str) -> Result<Vary, String> {
    let usage = || "write NAME=FROM:TO:N, as in `--vary m=1:2:11`".to_owned();
    let (name, range) = text.split_once('=').ok_or_else(usage)?;
    let parts: Vec<&str> = range.split(':').map(str::trim).collect();
    let &[from, to, count] = &parts[..] else { return Err(usage()) };
    let (from, to) = (options::finite(from)?, options::finite(to)?);
    let count = count.parse().ok().filter(|&count: &u64| count > 0);
    let count = count.ok_or("the number of values must be a whole number, at least 1")?;
    if !(to - from).is_finite() {
        return Err("the range is too large".to_owned());
    }
    if count == 1 && from != to {
        return Err(
            "one value cannot be at both ends; give 2 values, or the same number at both ends".to_owned()
        );
    }
    match name.trim() {
        "" => Err(usage()),
        name => Ok(Vary { name: name.to_owned(), from, to, count }),
    }
}

fn random(text: &str) -> Result<Random, String> {
    let usage = || "write NAME=normal(m,s), NAME=uniform(a,b) or NAME=lognormal(m,s)".to_owned();
    let (name, law) = text.split_once('=').ok_or_else(usage)?;
    let (kind, numbers) =
        law.trim().strip_suffix(')').and_then(|law| law.split_once('(')).ok_or_else(usage)?;
    let (a, b) = numbers.split_once(',').ok_or_else(usage)?;
    let (a, b) = (options::finite(a.trim())?, options::finite(b.trim())?);
    let law = match kind.trim() {
        "normal" if b >= 0.0 => Law::Normal(a, b),
        "lognormal" if b >= 0.0 => Law::LogNormal(a, b),
        "normal" | "lognormal" => return Err("the standard deviation must not be negative".to_owned()),
        "uniform" if a <= b && (b - a).is_finite() => Law::Uniform(a, b),
        "uniform" => return Err("the first bound must be the lower one".to_owned()),
        _ => return Err(usage()),
    };
    match name.trim() {
        "" => Err(usage()),
        name => Ok(Random { name: name.to_owned(), law }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variations_are_read_or_refused() {
        let m = |from, to, count| Vary { name: "m".to_owned(), from, to, count };
        assert_eq!(vary("m=1:2:11"), Ok(m(1.0, 2.0, 11)));
        assert_eq!(vary("m = -1e3 : -1e3 : 1"), Ok(m(-1e3, -1e3, 1)));
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
        ] {
            assert!(vary(wrong).is_err(), "{wrong}");
        }
        let x = |law| Random { name: "x".to_owned(), law };
        assert_eq!(random("x=normal(0, 0.1)"), Ok(x(Law::Normal(0.0, 0.1))));
        assert_eq!(random("x=uniform(-1,1)"), Ok(x(Law::Uniform(-1.0, 1.0))));
        assert_eq!(random("x=lognormal(0,1)"), Ok(x(Law::LogNormal(0.0, 1.0))));
        for wrong in [
            "x",
            "x=normal",
            "x=normal(0)",
            "x=normal(0,-1)",
            "x=uniform(1,0)",
            "x=cauchy(0,1)",
            "=normal(0,1)",
        ] {
            assert!(random(wrong).is_err(), "{wrong}");
        }
    }
}
