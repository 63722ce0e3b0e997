//! Arguments of `pc sweep`.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::builder::TypedValueParser;
use clap::{ArgGroup, Args};
use pc_model::Variables;
use pc_run::Wishes;
use pc_run::sweep::SweepWishes;
use pc_run::sweep::design::Variation;
use pc_run::sweep::law::Random;
use pc_run::sweep::of::SweepOf;
use pc_run::sweep::shard::Shard;
use pc_run::sweep::values::Vary;

use crate::args::examples;
use crate::args::forms::{by_word, run_form};
use crate::args::options;
use crate::args::options::{IntegrationArguments, ModelArguments};
use crate::args::steady::StateArguments;
use crate::args::table::{ColumnArguments, OutputArguments, TableArguments};

/// Arguments of `pc sweep`.
#[derive(Clone, Debug, Args)]
#[command(
    group(ArgGroup::new("varied").args(["vary", "random"]).required(true)),
    group(ArgGroup::new("file").args(["output"]).required(true)),
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
    /// What to compute for each member: its motion (run), its eigenvalues (linearize) or its properties (check)
    #[arg(long, value_name = "WHAT", default_value = "run", value_parser = sweep_of())]
    pub of: SweepOf,
    /// Vary a parameter or start value: FROM:TO:N evenly spaced values, both ends included; FROM:TO:N:log with a constant ratio; or
    /// a list A,B,… (repeatable)
    #[arg(long, value_name = "NAME=FROM:TO:N", conflicts_with = "random")]
    pub vary: Vec<Vary>,
    /// Draw a parameter or start value: normal(m,s), uniform(a,b) or lognormal(m,s) (repeatable)
    #[arg(long, value_name = "NAME=DISTRIBUTION", requires = "members")]
    pub random: Vec<Random>,
    /// Number of randomly drawn members
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..), requires = "random", conflicts_with = "vary")]
    pub members: Option<u64>,
    /// Seed of the random numbers
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// Largest number of members, of all shards together; a sweep of more is refused before anything is computed [default: 1000000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub limit_members: Option<u64>,
    /// Number of threads, which does not affect the result [default: one per core]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZeroUsize>,
    /// End time [default: the file's]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = options::finite)]
    pub t_end: Option<f64>,
    /// Write N rows for each member, evenly spaced, start and end included, instead of the last row and the drifts
    #[arg(long, value_name = "N", value_parser = options::rows)]
    pub rows: Option<usize>,
    /// Tolerances and method.
    #[command(flatten)]
    pub integration: IntegrationArguments,
    /// Form of the equations, as for `pc run`: poincare, canonical, reduced, lie-poisson, orthonormal, voronets, or hamel where the file gives the
    /// quasi-velocities; columns are those of `pc run` in this form [default: the file's, or poincare]
    #[arg(long, value_name = "FORM", value_parser = run_form)]
    pub form: Option<Variables>,
    /// Keep an integral, or energy, at its start value by projection after each step (repeatable)
    #[arg(long, value_name = "NAME")]
    pub project: Vec<String>,
    /// With --of linearize: the state.
    #[command(flatten)]
    pub state: StateArguments,
    /// Further outputs.
    #[command(flatten)]
    pub outputs: OutputArguments,
    /// The table.
    #[command(flatten)]
    pub table: TableArguments,
    /// Its columns.
    #[command(flatten)]
    pub columns: ColumnArguments,
    /// Compute only the members I, I + N, … and keep them in FILE.shard-I-of-N; `pc merge` makes one table from all N shards
    #[arg(long, value_name = "I/N", value_parser = Shard::parse, conflicts_with = "plot")]
    pub shard: Option<Shard>,
    /// Draw the last row of each member into FILE.svg, FILE.png or FILE.pdf: curves over one varied value, colours over two of
    /// them, histograms with quantiles for randomly drawn members; with --rows, curves over time
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Do not compare the first member, one in the middle and the last with a second derivation
    #[arg(long)]
    pub no_verify: bool,
}

/// Arguments of `pc merge`.
#[derive(Clone, Debug, Args)]
#[command(group(ArgGroup::new("file").args(["output"]).required(true)),
          after_help = "Examples:\n  \
                        pc merge sweep.csv.shard-* -o sweep.csv    # of four jobs\n  \
                        pc merge part1/cloud.npz.shard-* part2/cloud.npz.shard-* -o cloud.npz    # of several machines\n\
                        The jobs were `pc sweep MODEL … -o sweep.csv --shard 1/4` to `4/4`. The table has the bytes of the same sweep by one process. A shard that was killed goes on where it was by \
                        the same command. Shards that are missing, there twice, not complete or of another sweep are named, and \
                        nothing is written then. The shards stay where they are.")]
pub struct MergeArguments {
    /// The files that `pc sweep --shard` has written, in any order
    #[arg(value_name = "SHARD", required = true)]
    pub shards: Vec<PathBuf>,
    /// The table.
    #[command(flatten)]
    pub table: TableArguments,
    /// Its columns.
    #[command(flatten)]
    pub columns: ColumnArguments,
    /// Draw the table, as `pc sweep --plot` does
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}

impl SweepArguments {
    /// The first option given that has no effect on what is computed for each member.
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
            ("--outputs", self.outputs.outputs.is_some()),
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

    /// What is varied, as specified by the options.
    pub(crate) fn variation(&self) -> Variation {
        let SweepArguments { vary, random, members, seed, .. } = self;
        Variation { vary: vary.clone(), random: random.clone(), members: *members, seed: *seed }
    }

    /// What to compute for each member, and how.
    pub(crate) fn wishes(&self) -> SweepWishes {
        SweepWishes {
            of: self.of,
            run: Wishes {
                form: self.form,
                t_end: self.t_end,
                samples: self.rows,
                ..self.integration.wishes()
            },
            state: self.state.choice(),
            threads: self.threads,
            limit_members: self.limit_members,
        }
    }
}

/// The values of `--of`.
fn sweep_of() -> impl TypedValueParser<Value = SweepOf> {
    by_word(SweepOf::ALL.map(|of| {
        let help = match of {
            SweepOf::Run => "Its motion, as `pc run`",
            SweepOf::Linearize => "The eigenvalues at a state near its start, as `pc linearize`",
            SweepOf::Check => "Its properties, as `pc check`",
        };
        (of.word(), help, of)
    }))
}
