//! `pc completions`: the command line for the completion of a shell.

use clap::CommandFactory;
use clap_complete::generate;

use crate::args::command_line::Arguments;
use crate::args::tools::CompletionsArguments;
use crate::error::CliError;
use crate::output::standard_output::print;

/// Prints the completions for a shell.
///
/// # Errors
/// `FileError::Write`
pub fn command(arguments: &CompletionsArguments) -> Result<(), CliError> {
    // The generator panics where it cannot write, so it writes to memory.
    let mut script = Vec::new();
    generate(arguments.shell, &mut Arguments::command(), "pc", &mut script);
    print(|out| out.write_all(&script))
}
