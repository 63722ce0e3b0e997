//! The program `pc`.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;
use pc_cli::CliError;
use pc_cli::args::command_line::{Arguments, Command};
use pc_cli::commands::{
    bench, check, compare, completions, derive, emit, equilibria, fmu, import, linearize, man, merge, models,
    new, report, run, schema, sweep, theory, version,
};
use pc_cli::output::standard_output;
use pc_cli::terminal::text;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            if error.use_stderr() {
                let _ = error.print(); // a failure to print cannot be reported
                return ExitCode::from(CliError::USAGE);
            }
            let printed = error.print().and_then(|()| io::stdout().flush());
            return ended(printed.map_err(standard_output::error));
        }
    };
    let Some(command) = &arguments.command else {
        return ended(version::command(arguments.verbose));
    };
    let outcome = match command {
        Command::New(arguments) => new::command(arguments),
        Command::Check(arguments) => check::command(arguments),
        Command::Derive(arguments) => derive::command(arguments),
        Command::Theory(arguments) => theory::command(arguments),
        Command::Linearize(arguments) => linearize::command(arguments),
        Command::Equilibria(arguments) => equilibria::command(arguments),
        Command::Run(arguments) => run::command(arguments),
        Command::Report(arguments) => report::command(arguments),
        Command::Animate(arguments) => report::animate(arguments),
        Command::Sweep(arguments) => sweep::command(arguments),
        Command::Merge(arguments) => merge::command(arguments),
        Command::Compare(arguments) => compare::command(arguments),
        Command::Bench(arguments) => bench::command(arguments),
        Command::Emit(arguments) => match arguments.fmu {
            Some(version) => fmu::command(arguments, version),
            None => emit::command(arguments),
        },
        Command::Import(arguments) => import::command(arguments),
        Command::Models(arguments) => models::command(arguments),
        Command::Schema(arguments) => schema::command(arguments),
        Command::Completions(arguments) => completions::command(arguments),
        Command::Man(arguments) => man::command(arguments),
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
