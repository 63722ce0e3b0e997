//! `pc derive`: the equations of motion, printed.

use pc_print::{Layout, page};

use crate::args::forms::Form;
use crate::args::input;
use crate::args::options::DeriveArguments;
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::report::notes::{say_dropped, say_moved};

/// Prints the equations of a model.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &DeriveArguments) -> Result<(), CliError> {
    let model = input::open_in(&arguments.model, &arguments.velocities, arguments.form == Form::Hamel)?;
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    say_dropped(&assembly);
    say_moved(&assembly);
    let layout = Layout { width: arguments.width.into(), brief: arguments.brief, inline: arguments.inline };
    let page = page(arguments.form.into(), arguments.format.into(), &layout, model.title(), &assembly)?;
    assembly.within_limits()?;
    print(|out| write!(out, "{page}"))
}
