//! Arguments that choose the state about which equations are linearized.

use clap::Args;
use clap::builder::TypedValueParser;
use pc_run::linear::state::{At, Cyclic, StateChoice};

use crate::args::forms::by_word;

/// The options that choose the state, and which components of it to keep.
#[derive(Clone, Debug, Default, Args)]
pub struct StateArguments {
    /// Linearize at this state: the equilibrium or steady motion near the start (steady), an equilibrium at rest near it (rest),
    /// or the start as it is (start) [default: steady]
    #[arg(long, value_name = "STATE", value_parser = at())]
    pub at: Option<At>,
    /// Components of the state, separated by commas, that keep their start values while a steady state is looked for
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub hold: Vec<String>,
    /// Keep the cyclic coordinates that are at rest, or drop all cyclic coordinates [default: keep them at an equilibrium and
    /// at the start; drop them for a steady motion and where values are varied]
    #[arg(long, value_name = "WHICH", value_parser = cyclic())]
    pub cyclic: Option<Cyclic>,
}

impl StateArguments {
    /// The choice.
    pub(crate) fn choice(&self) -> StateChoice {
        StateChoice { at: self.at.unwrap_or_default(), hold: self.hold.clone(), cyclic: self.cyclic }
    }
}

/// The values of `--at`.
fn at() -> impl TypedValueParser<Value = At> {
    by_word(At::ALL.map(|at| {
        let help = match at {
            At::Steady => {
                "The equilibrium or steady motion near the start: all but the cyclic coordinates rest"
            }
            At::Rest => "The equilibrium near the start with all quasi-velocities 0",
            At::Start => "The start, steady or not",
        };
        (at.word(), help, at)
    }))
}

/// The values of `--cyclic`.
fn cyclic() -> impl TypedValueParser<Value = Cyclic> {
    by_word(Cyclic::ALL.map(|cyclic| {
        let help = match cyclic {
            Cyclic::Keep => "Those that rest",
            Cyclic::Drop => "None",
        };
        (cyclic.word(), help, cyclic)
    }))
}
