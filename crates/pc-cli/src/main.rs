//! The program `pc`.

use std::io::{self, Write};
use std::process::ExitCode;

use clap::Parser;
use pc_cli::CliError;
use pc_cli::args::command_line::Arguments;
use pc_cli::commands::{self, version};
#[cfg(unix)]
use pc_cli::output::size_limit;
use pc_cli::output::standard_output;
use pc_cli::terminal::text;

fn main() -> ExitCode {
    #[cfg(unix)]
    size_limit::catch();
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
    ended(commands::command(command))
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
