//! `pc derive`: the equations of motion, printed.

use pc_print::{Form, Layout, page};
use pc_verify::Outlet;

use crate::args::input;
use crate::args::options::DeriveArguments;
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::report::notes::{say_changing_masses, say_dropped, say_moved};
use crate::report::verification::vouched;

/// Prints the equations of a model.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &DeriveArguments) -> Result<(), CliError> {
    let is_hamel = arguments.form == Some(Form::Hamel);
    let model = input::open_in(&arguments.model, &arguments.velocities, is_hamel)?;
    let written = model.document().simulation.form.as_ref().map(|form| form.value.into());
    let form = arguments.form.or(written).unwrap_or(Form::Poincare);
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    say_dropped(&assembly);
    say_moved(&assembly);
    say_changing_masses(&assembly);
    let layout = Layout { width: arguments.width.into(), brief: arguments.brief, inline: arguments.inline };
    let page = page(form, arguments.format.into(), &layout, model.title(), &assembly)?;
    assembly.within_limits()?;
    vouched(&model, &assembly, Outlet::Page(form), arguments.verify)?;
    print(|out| write!(out, "{page}"))
}
