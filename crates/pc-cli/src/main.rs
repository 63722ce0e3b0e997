//! The program `pc`.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;
use pc_cli::CliError;
use pc_cli::args::command_line::{Arguments, Command};
use pc_cli::commands::{check, derive, emit, import, models, report, run, theory};
use pc_cli::output::standard_output;
use pc_cli::report::text;
use pc_cli::sweep;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            if error.use_stderr() {
                let _ = error.print(); // nothing can be said where nothing can be printed
                return ExitCode::from(CliError::USAGE);
            }
            let printed = error.print().and_then(|()| io::stdout().flush());
            return ended(printed.map_err(standard_output::error));
        }
    };
    let outcome = match &arguments.command {
        Command::Check(arguments) => check::command(arguments),
        Command::Derive(arguments) => derive::command(arguments),
        Command::Theory(arguments) => theory::command(arguments),
        Command::Run(arguments) => run::command(arguments),
        Command::Report(arguments) => report::command(arguments),
        Command::Animate(arguments) => report::animate(arguments),
        Command::Sweep(arguments) => sweep::command::command(arguments),
        Command::Emit(arguments) => emit::command(arguments),
        Command::Import(arguments) => import::command(arguments),
        Command::Models(arguments) => models::command(arguments),
    };
    ended(outcome)
}

fn ended(outcome: Result<(), CliError>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if !error.is_reader_gone() {
                text::say(format_args!("{}\n", error.report()));
            }
            ExitCode::from(error.exit_code())
        }
    }
}
