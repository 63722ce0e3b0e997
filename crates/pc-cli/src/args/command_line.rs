//! The command line as a whole: which command, with which options.

use clap::{Parser, Subcommand};

use crate::args::bench::BenchArguments;
use crate::args::compare::CompareArguments;
use crate::args::examples;
use crate::args::linear::{EquilibriaArguments, LinearizeArguments};
use crate::args::live::LiveArguments;
use crate::args::models::ModelsArguments;
use crate::args::options::{
    CheckArguments, DeriveArguments, EmitArguments, ExportArguments, ImportArguments, RunArguments,
    TheoryArguments,
};
use crate::args::report::{AnimateArguments, ReportArguments};
use crate::args::sweep::{MergeArguments, SweepArguments};
use crate::args::tools::{CompletionsArguments, ManArguments, NewArguments, SchemaArguments};

/// The command line of `pc`.
#[derive(Clone, Debug, Parser)]
#[command(
    name = "pc",
    version,
    disable_version_flag = true,
    arg_required_else_help = true,
    args_conflicts_with_subcommands = true,
    override_usage = "pc <COMMAND>\n       pc --version [--verbose]",
    about = "Poincaré–Chetaev equations of mechanical systems, derived and integrated from text models",
    after_help = "MODEL is a file, `-` for standard input, or the name of a model that comes with the program \
                  (`pc models` lists them).\n\
                  Exit codes: 0 done; 1 `pc compare` found a difference; 2 usage; 3 the model file is wrong; 4 the model is inconsistent, or its limits are reached; 5 the \
                  integration failed; 6 a result could not be written where it belongs, the message says where it is; \
                  7 `pc compare` cannot tell; 130 interrupted, what was reached is in FILE.partial."
)]
pub struct Arguments {
    /// Print the version
    #[arg(short = 'V', long)]
    pub version: bool,
    /// With --version: print the features built in, the target system, and what this processor supports
    #[arg(long, requires = "version")]
    pub verbose: bool,
    /// The command; without one, only the version can be printed.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The commands of `pc`.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Write a starter model that runs and explains the format
    #[command(after_help = examples::NEW)]
    New(NewArguments),
    /// Check a model: consistency, conserved quantities, steady motions near its start
    #[command(after_help = examples::CHECK)]
    Check(CheckArguments),
    /// Print the equations of motion
    #[command(after_help = examples::DERIVE)]
    Derive(DeriveArguments),
    /// Print the analysis of the motions: brackets, integrals, measures, steady motions, reductions
    #[command(after_help = examples::THEORY)]
    Theory(TheoryArguments),
    /// Linearize about the start, an equilibrium or a steady motion: matrices, eigenvalues, modes; root locus over a parameter
    Linearize(Box<LinearizeArguments>),
    /// Find the equilibria in a box, with their stability
    Equilibria(EquilibriaArguments),
    /// Integrate the motion; CSV on standard output unless -o is given
    #[command(after_help = examples::RUN)]
    Run(Box<RunArguments>),
    /// Write a page for a browser: equations in all forms, analysis, verdicts, plots of the motion
    Report(Box<ReportArguments>),
    /// Write a page that animates the motion
    Animate(Box<AnimateArguments>),
    /// Serve a page on this computer that follows the text of a model as it is edited
    Live(LiveArguments),
    /// Integrate, linearize or check a model for many parameters and starts, on all cores; finished members are kept after an
    /// interruption
    Sweep(Box<SweepArguments>),
    /// Merge the shards of a sweep into one table
    Merge(MergeArguments),
    /// Compare the motions of two models, or of two forms of one model
    #[command(after_help = examples::COMPARE)]
    Compare(Box<CompareArguments>),
    /// Measure the derivation of a model and the evaluation of its equations
    #[command(after_help = examples::BENCH)]
    Bench(BenchArguments),
    /// Write the equations as C or Rust source without dependencies
    #[command(after_help = examples::EMIT)]
    Emit(EmitArguments),
    /// Convert a robot in URDF, MJCF or SDF into a model
    #[command(after_help = examples::IMPORT)]
    Import(ImportArguments),
    /// Write a model of bodies on joints as a robot in URDF
    #[command(after_help = examples::EXPORT)]
    Export(ExportArguments),
    /// List the built-in models, or print one
    #[command(after_help = examples::MODELS)]
    Models(ModelsArguments),
    /// Print the JSON Schema of the text format, for editors
    #[command(after_help = examples::SCHEMA)]
    Schema(SchemaArguments),
    /// Print the completions of this command line for a shell
    #[command(after_help = examples::COMPLETIONS)]
    Completions(CompletionsArguments),
    /// Print a manual page, or write all of them
    #[command(after_help = examples::MAN)]
    Man(ManArguments),
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
