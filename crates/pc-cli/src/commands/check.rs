//! `pc check`: the consistency and the properties of a model.

use pc_print::{visible, visible_json};

use crate::args::input;
use crate::args::options::{CheckArguments, Format};
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::terminal::observer::Terminal;
use pc_run::motion::remarks::say_moved;
use pc_run::motion::verification::checked;

/// Prints the properties of a model before it is run.
///
/// # Errors
/// [`CliError`]; for an inconsistent model this is the answer.
pub fn command(arguments: &CheckArguments) -> Result<(), CliError> {
    let model = input::open(&arguments.model)?;
    let graph = model.graph();
    let (assembly, equations) = input::derive(&model, &graph)?;
    say_moved(&assembly, &Terminal);
    let check = checked(&model, &assembly, &equations)?;
    print(|out| match arguments.format {
        Format::Text => write!(out, "{}", visible(&check.text())),
        Format::Json => writeln!(out, "{}", visible_json(&check.json())),
    })
}
