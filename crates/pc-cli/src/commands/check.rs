//! `pc check`: the consistency and the properties of a model.

use pc_print::{visible, visible_json};

use crate::args::input;
use crate::args::options::{CheckArguments, Format};
use crate::error::CliError;
use crate::output::text::TextOutput;
use crate::terminal::observer::Terminal;
use pc_run::motion::remarks::say_moved;
use pc_run::motion::verification::checked;

/// Prints the properties of a model before it is run.
///
/// # Errors
/// [`CliError`]; for an inconsistent model this is the answer.
pub fn command(arguments: &CheckArguments) -> Result<(), CliError> {
    let place = TextOutput::at(arguments.output.as_deref())?;
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    let graph = model.graph();
    let (assembly, equations) = input::derive(&model, &graph)?;
    say_moved(&assembly, &Terminal);
    let check = checked(&model, &assembly, &equations)?;
    place.write(|out| match arguments.format {
        Format::Text => write!(out, "{}", visible(&check.text())),
        Format::Json => writeln!(out, "{}", visible_json(&check.json())),
    })
}
