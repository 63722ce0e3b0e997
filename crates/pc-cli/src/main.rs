//! The program `pc`.

use std::process::ExitCode;

use clap::Parser;
use pc_cli::CliError;
use pc_cli::args::command_line::{Arguments, Command};
use pc_cli::commands::{check, derive, emit, models, run};
use pc_cli::report::text;
use pc_cli::sweep;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            let _ = error.print(); // nothing can be said where nothing can be printed
            return ExitCode::from(if error.use_stderr() { CliError::USAGE } else { 0 });
        }
    };
    let outcome = match &arguments.command {
        Command::Check(arguments) => check::command(arguments),
        Command::Derive(arguments) => derive::command(arguments),
        Command::Run(arguments) => run::command(arguments),
        Command::Sweep(arguments) => sweep::command::command(arguments),
        Command::Emit(arguments) => emit::command(arguments),
        Command::Models(arguments) => models::command(arguments),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            text::say(format_args!("{}\n", error.report()));
            ExitCode::from(error.exit_code())
        }
    }
}
