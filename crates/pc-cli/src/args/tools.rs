//! Arguments of the commands around models: new ones, their schema, completions and manual pages.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use clap_complete::Shell;

/// Arguments of `pc new`.
#[derive(Clone, Debug, Args)]
pub struct NewArguments {
    /// The kind of system
    #[arg(value_name = "KIND")]
    pub kind: Kind,
    /// The file to write, which must not exist yet; standard output if it is not given
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// With -o FILE: write the schema of the format beside FILE unless it exists, and name it in the first line of FILE, so
    /// that editors with Taplo complete entries and mark mistakes
    #[arg(long, requires = "output")]
    pub schema: bool,
}

/// Kinds of system to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Kind {
    /// Lagrange's equations in coordinates of your choice: a mass that swings on a spring
    Coordinates,
    /// A rigid body in quasi-velocities: a heavy top in its angular velocity
    RigidBody,
    /// Constraints on velocities: a wheel that rolls on a slope
    Nonholonomic,
    /// Bodies on joints: an arm of two links on a column
    Joints,
    /// Inputs, and states besides those of the mechanics: a pendulum with a motor and a controller
    Control,
}

impl Kind {
    /// The text of the model to start from.
    pub fn text(self) -> &'static str {
        match self {
            Kind::Coordinates => include_str!("../../starters/coordinates.toml"),
            Kind::RigidBody => include_str!("../../starters/rigid-body.toml"),
            Kind::Nonholonomic => include_str!("../../starters/nonholonomic.toml"),
            Kind::Joints => include_str!("../../starters/joints.toml"),
            Kind::Control => include_str!("../../starters/control.toml"),
        }
    }
}

/// Arguments of `pc schema`.
#[derive(Clone, Debug, Args)]
pub struct SchemaArguments {
    /// The file to write; standard output if it is not given
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Arguments of `pc completions`.
#[derive(Clone, Debug, Args)]
pub struct CompletionsArguments {
    /// The shell
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Arguments of `pc man`.
#[derive(Clone, Debug, Args)]
pub struct ManArguments {
    /// Print the page of this command instead of that of the program
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub command: Option<String>,
    /// Write all pages into this directory, which is created if it does not exist
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
}
