//! Arguments that choose the state about which equations are linearized.

use clap::{Args, ValueEnum};

/// The state about which equations are linearized.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum At {
    /// The equilibrium or steady motion near the start: all but the cyclic coordinates rest.
    #[default]
    Steady,
    /// The equilibrium near the start with all quasi-velocities 0.
    Rest,
    /// The start, steady or not.
    Start,
}

impl At {
    /// As on the command line.
    pub(crate) fn word(self) -> &'static str {
        match self {
            At::Steady => "steady",
            At::Rest => "rest",
            At::Start => "start",
        }
    }
}

/// Which cyclic coordinates are components of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Cyclic {
    /// Those that rest.
    Keep,
    /// None.
    Drop,
}

impl Cyclic {
    /// As on the command line.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Cyclic::Keep => "keep",
            Cyclic::Drop => "drop",
        }
    }
}

/// The state, and what of it.
#[derive(Clone, Debug, Default, Args)]
pub struct StateArguments {
    /// Linearize at this state: the equilibrium or steady motion near the start (steady), an equilibrium at rest near it (rest),
    /// or the start as it is (start); else steady
    #[arg(long, value_name = "STATE")]
    pub at: Option<At>,
    /// Components of the state, separated by commas, that keep their start values while a steady state is looked for
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub hold: Vec<String>,
    /// Cyclic coordinates: keep those that rest, or drop all; else they are kept at an equilibrium and at the start, and dropped
    /// of a motion and where values are varied
    #[arg(long, value_name = "WHICH")]
    pub cyclic: Option<Cyclic>,
}

impl StateArguments {
    /// The state.
    pub(crate) fn at(&self) -> At {
        self.at.unwrap_or_default()
    }
}
