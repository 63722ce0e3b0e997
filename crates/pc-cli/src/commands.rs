//! The commands, a file each.
//!
//! Each takes its arguments and gives a result or an error. `new` begins a model, `schema` is the
//! format for editors, `models` lists the built-in models, `check` checks a model, `derive` prints
//! its equations, `theory` the analysis of its motions, `linearize` the motions near a state,
//! `equilibria` the states of rest, `run` integrates a model, `sweep` many members of one, whose shards `merge` puts together,
//! `compare` compares two motions,
//! `report` makes a page of all this, `live` one that follows the text, `emit` writes equations as source, or by `fmu` as an FMU,
//! `bench` measures them, `import` makes models from files in other formats, and `export` makes such files. `completions`,
//! `man` and `version` are about the program.

pub mod bench;
pub mod check;
pub mod compare;
pub mod completions;
pub mod derive;
pub mod emit;
pub mod equilibria;
pub mod export;
pub mod fmu;
pub mod import;
pub mod linearize;
pub mod live;
pub mod man;
pub mod merge;
pub mod models;
pub mod new;
pub mod report;
pub mod run;
pub mod schema;
pub mod sweep;
pub mod theory;
pub mod version;

use crate::args::command_line::Command;
use crate::error::CliError;

/// Does what a command says.
///
/// # Errors
/// [`CliError`]
pub fn command(command: &Command) -> Result<(), CliError> {
    match command {
        Command::New(arguments) => new::command(arguments),
        Command::Check(arguments) => check::command(arguments),
        Command::Derive(arguments) => derive::command(arguments),
        Command::Theory(arguments) => theory::command(arguments),
        Command::Linearize(arguments) => linearize::command(arguments),
        Command::Equilibria(arguments) => equilibria::command(arguments),
        Command::Run(arguments) => run::command(arguments),
        Command::Report(arguments) => report::command(arguments),
        Command::Animate(arguments) => report::animate(arguments),
        Command::Live(arguments) => live::command(arguments),
        Command::Sweep(arguments) => sweep::command(arguments),
        Command::Merge(arguments) => merge::command(arguments),
        Command::Compare(arguments) => compare::command(arguments),
        Command::Bench(arguments) => bench::command(arguments),
        Command::Emit(arguments) => match arguments.fmu {
            Some(version) => fmu::command(arguments, version),
            None => emit::command(arguments),
        },
        Command::Import(arguments) => import::command(arguments),
        Command::Export(arguments) => export::command(arguments),
        Command::Models(arguments) => models::command(arguments),
        Command::Schema(arguments) => schema::command(arguments),
        Command::Completions(arguments) => completions::command(arguments),
        Command::Man(arguments) => man::command(arguments),
    }
}
