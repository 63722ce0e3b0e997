//! The command line as a whole: which command, with which options.

use clap::{Parser, Subcommand};

use crate::args::options::{
    CheckArguments, DeriveArguments, EmitArguments, ImportArguments, ModelsArguments, RunArguments,
    TheoryArguments,
};
use crate::args::report::{AnimateArguments, ReportArguments};
use crate::args::sweep::SweepArguments;

/// The command line of `pc`.
#[derive(Clone, Debug, Parser)]
#[command(
    name = "pc",
    version,
    about = "Poincaré–Chetaev equations of mechanical systems, derived and integrated from text models",
    after_help = "MODEL is a file, `-` for standard input, or the name of a model that comes with the program \
                  (`pc models` lists them).\n\
                  Exit codes: 0 done; 2 usage; 3 the model file is wrong; 4 the model is inconsistent, or its limits are reached; 5 the \
                  integration failed; 6 a result could not be written where it belongs, the message says where it is; \
                  130 interrupted."
)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Check a model: consistency, conserved quantities, steady motions near its start
    Check(CheckArguments),
    /// Print the equations of motion
    Derive(DeriveArguments),
    /// Print the analysis of the motions: brackets, integrals, measures, steady motions, reductions
    Theory(TheoryArguments),
    /// Integrate the motion; CSV on standard output unless -o is given
    Run(Box<RunArguments>),
    /// Write a page for a browser: equations in all forms, analysis, verdicts, plots of the motion
    Report(Box<ReportArguments>),
    /// Write a page on which the motion can be watched
    Animate(Box<AnimateArguments>),
    /// Integrate many motions over parameters and starts, on all cores; finished ones survive interruptions
    Sweep(Box<SweepArguments>),
    /// Write the equations as C or Rust source without dependencies
    Emit(EmitArguments),
    /// Make a model of a robot in URDF
    Import(ImportArguments),
    /// List the built-in models, or print one
    Models(ModelsArguments),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
