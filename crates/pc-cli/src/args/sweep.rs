//! Arguments of `pc sweep`.

use std::fmt;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueEnum};
use pc_model::Variables;

use crate::args::checkpoint::CheckpointArguments;
use crate::args::drawn::DrawnArguments;
use crate::args::examples;
use crate::args::forms::run_form;
use crate::args::options;
use crate::args::options::{IntegrationArguments, ModelArguments, RunArguments, VelocityArguments};
use crate::args::steady::StateArguments;
use crate::sweep::shard::Shard;

/// What a sweep finds of each member.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SweepOf {
    /// Its motion, as `pc run`.
    Run,
    /// The eigenvalues at a state near its start, as `pc linearize`.
    Linearize,
    /// Its properties, as `pc check`.
    Check,
}

impl SweepOf {
    /// As on the command line.
    pub(crate) fn word(self) -> &'static str {
        match self {
            SweepOf::Run => "run",
            SweepOf::Linearize => "linearize",
            SweepOf::Check => "check",
        }
    }

    /// The one of this word.
    pub(crate) fn of_word(word: &str) -> Option<SweepOf> {
        [SweepOf::Run, SweepOf::Linearize, SweepOf::Check].into_iter().find(|of| of.word() == word)
    }
}

/// Arguments of `pc sweep`.
#[derive(Clone, Debug, Args)]
#[command(
    group(ArgGroup::new("members").args(["vary", "random"]).required(true)),
    after_help = format!("{}\n\n\
                  Members of a grid are all combinations of the values, the last --vary changing fastest. \
                  lognormal(m,s) is exp of normal(m,s).\n\
                  A row has the number of the member, the varied values (start values as NAME(start)), how it ended \
                  (completed; event: it was ended by the event of the message; failed: the row is what was reached; refused: it could not start; panicked), the \
                  columns of `pc run` in the same form at the end, the drift of each integral, the number of steps, and a message \
                  where it was not completed. --of linearize has the real and imaginary parts re1, im1, … of the eigenvalues in descending \
                  order of the real parts, and the stability by them, instead; --of check has verdicts of `pc check`.\n\
                  What is finished is kept in FILE.partial until FILE is complete: after an interruption of any kind \
                  the same command goes on from there, and gives the same bytes.\n\
                  Exit codes: 0 also if some members were not completed, they are counted in the summary; 5 if none \
                  was; 6 if something could not be written; 130 interrupted.", examples::SWEEP)
)]
pub struct SweepArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Of each member its motion (run), its eigenvalues (linearize), or its properties (check)
    #[arg(long, value_name = "WHAT", default_value = "run")]
    pub of: SweepOf,
    /// Vary a parameter or start value over N evenly spaced values from FROM to TO, both included; NAME=FROM:TO:N:log
    /// spaces them in a constant ratio, NAME=A,B,… lists them (repeatable)
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
    /// Tolerances and method.
    #[command(flatten)]
    pub integration: IntegrationArguments,
    /// Form of the equations, as for `pc run`: poincare, canonical, reduced, lie-poisson, orthonormal, or hamel where the file gives the
    /// quasi-velocities; else that of the file, else poincare. Columns are those of `pc run` in this form
    #[arg(long, value_name = "FORM", value_parser = run_form)]
    pub form: Option<Variables>,
    /// Keep an integral, or energy, at its start value by projection after each step (repeatable)
    #[arg(long, value_name = "NAME")]
    pub project: Vec<String>,
    /// With --of linearize: the state.
    #[command(flatten)]
    pub state: StateArguments,
    /// Write the table to FILE.csv, FILE.json, FILE.npz or FILE.parquet
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Compute the members I, I + N, … alone and keep them in FILE.shard-I-of-N, for `pc merge` to make the table of all N
    #[arg(long, value_name = "I/N", value_parser = Shard::parse, conflicts_with = "plot")]
    pub shard: Option<Shard>,
    /// Draw the last row of each member into FILE.svg, FILE.png or FILE.pdf: over one value curves, over two a colour for each
    /// pair, of drawn members histograms with quantiles; with --rows curves over time
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// With --plot: draw these columns, separated by commas
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "plot")]
    pub columns: Vec<String>,
    /// Do not compare the first member, one in the middle and the last with a second derivation
    #[arg(long)]
    pub no_verify: bool,
}

/// Arguments of `pc merge`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:\n  \
                        pc merge sweep.csv.shard-* -o sweep.csv    # of four jobs\n  \
                        pc merge part1/cloud.npz.shard-* part2/cloud.npz.shard-* -o cloud.npz    # of several machines\n\
                        The jobs were `pc sweep MODEL … -o sweep.csv --shard 1/4` to `4/4`. The table has the bytes of the same sweep by one process. A shard that was killed goes on where it was by \
                        the same command. Shards that are missing, there twice, not complete or of another sweep are named, and \
                        nothing is written then. The shards stay where they are.")]
pub struct MergeArguments {
    /// The files that `pc sweep --shard` has left, in any order
    #[arg(value_name = "SHARD", required = true)]
    pub shards: Vec<PathBuf>,
    /// Write the table to FILE.csv, FILE.json, FILE.npz or FILE.parquet
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Draw it, as `pc sweep --plot` does
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// With --plot: draw these columns, separated by commas
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "plot")]
    pub columns: Vec<String>,
}

impl SweepArguments {
    /// The first option that says nothing of what is found of each member.
    pub(crate) fn idle(&self) -> Option<&'static str> {
        let IntegrationArguments { rtol, atol, max_step, max_steps, events, method } = &self.integration;
        let of_runs = [
            ("--t-end", self.t_end.is_some()),
            ("--rows", self.rows.is_some()),
            ("--rtol", rtol.is_some()),
            ("--atol", !atol.is_empty()),
            ("--max-step", max_step.is_some()),
            ("--max-steps", max_steps.is_some()),
            ("--samples-per-step", events.samples_per_step.is_some()),
            ("--accumulation", events.accumulation.is_some()),
            ("--method", method.is_some()),
            ("--form", self.form.is_some()),
            ("--project", !self.project.is_empty()),
        ];
        let of_linearizations = [
            ("--at", self.state.at.is_some()),
            ("--hold", !self.state.hold.is_empty()),
            ("--cyclic", self.state.cyclic.is_some()),
        ];
        let first = |of: SweepOf, options: &[(&'static str, bool)]| {
            options.iter().find(|&&(_, given)| given && self.of != of).map(|&(option, _)| option)
        };
        first(SweepOf::Run, &of_runs).or_else(|| first(SweepOf::Linearize, &of_linearizations))
    }

    /// The corresponding arguments of `pc run` for one member.
    pub fn as_run(&self) -> RunArguments {
        RunArguments {
            velocities: VelocityArguments::default(),
            sensitivities: Vec::new(),
            estimate: false,
            model: self.model.clone(),
            t_end: self.t_end,
            samples: self.rows,
            integration: self.integration.clone(),
            form: self.form,
            project: self.project.clone(),
            outputs: None,
            no_verify: true,
            output: None,
            plot: None,
            drawn: DrawnArguments::default(),
            checkpoints: CheckpointArguments::default(),
        }
    }
}

/// `NAME=FROM:TO:N`, `NAME=FROM:TO:N:log` or `NAME=A,B,…`
#[derive(Clone, Debug, PartialEq)]
pub struct Vary {
    /// The parameter, coordinate or quasi-velocity.
    pub name: String,
    /// Its values.
    pub values: Values,
}

/// The values of a varied quantity, at least one.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// From one number to another, this many, evenly spaced.
    Even(f64, f64, u64),
    /// From one number to another, this many, with a constant ratio.
    Logarithmic(f64, f64, u64),
    /// These values.
    List(Vec<f64>),
}

impl Values {
    /// How many there are.
    pub fn count(&self) -> u64 {
        match self {
            Values::Even(_, _, count) | Values::Logarithmic(_, _, count) => *count,
            Values::List(list) => list.len() as u64,
        }
    }

    /// All of them, in order.
    pub(crate) fn in_order(&self) -> Vec<f64> {
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

/// As on the command line.
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

pub(crate) fn vary(text: &str) -> Result<Vary, String> {
    let usage = || {
        "write NAME=FROM:TO:N, NAME=FROM:TO:N:log or NAME=A,B,…, as in `--vary m=1:2:11` or `--vary m=1,2,5`"
            .to_owned()
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

fn range(from: &str, to: &str, count: &str, is_logarithmic: bool) -> Result<Values, String> {
    let (from, to) = (options::finite(from)?, options::finite(to)?);
    let count = count.parse().ok().filter(|&count: &u64| count > 0);
    let count = count.ok_or("the number of values must be a whole number, at least 1")?;
    if count == 1 && from != to {
        return Err(
            "one value cannot be at both ends; give 2 values, or the same number at both ends".to_owned()
        );
    }
    if is_logarithmic {
        if from == 0.0 || to == 0.0 || (from > 0.0) != (to > 0.0) {
            return Err("a logarithmic range lies on one side of 0".to_owned());
        }
        return Ok(Values::Logarithmic(from, to, count));
    }
    if !(to - from).is_finite() {
        return Err("the range is too large".to_owned());
    }
    Ok(Values::Even(from, to, count))
}

fn list(values: &str) -> Result<Values, String> {
    let list =
        values.split(',').map(|value| options::finite(value.trim())).collect::<Result<Vec<f64>, _>>()?;
    match list.iter().enumerate().find(|(i, value)| list[..*i].contains(value)) {
        Some((_, value)) => Err(format!("the value {value} is given twice")),
        None => Ok(Values::List(list)),
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
    fn values_follow_their_spacing() {
        let all = |values: Values| (0..values.count()).map(|i| values.at(i)).collect::<Vec<_>>();
        assert_eq!(all(Values::Even(1.0, 2.0, 3)), [1.0, 1.5, 2.0]);
        assert_eq!(all(Values::Logarithmic(1e-3, 100.0, 6)), [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0]);
        // Rounding of the logarithm.
        let negative = all(Values::Logarithmic(-8.0, -2.0, 3));
        assert!((negative[1] + 4.0).abs() < 1e-14 && negative[0] == -8.0 && negative[2] == -2.0);
        assert_eq!(all(Values::List(vec![5.0, 1.0])), [5.0, 1.0]);
        for text in ["m=1:2:3", "m=0.001:10:5:log", "m=5,1,-2"] {
            assert_eq!(vary(text).map(|vary| vary.to_string()), Ok(text.to_owned()));
        }
    }

    #[test]
    fn variations_are_read_or_refused() {
        let m = |values| Vary { name: "m".to_owned(), values };
        assert_eq!(vary("m=1:2:11"), Ok(m(Values::Even(1.0, 2.0, 11))));
        assert_eq!(vary("m = -1e3 : -1e3 : 1"), Ok(m(Values::Even(-1e3, -1e3, 1))));
        assert_eq!(vary("m=1e-3:10:5:log"), Ok(m(Values::Logarithmic(1e-3, 10.0, 5))));
        assert_eq!(vary("m = 5, 1,-2"), Ok(m(Values::List(vec![5.0, 1.0, -2.0]))));
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
