//! `pc derive`: the equations of motion, printed.

use pc_print::{Form, Layout, page};
use pc_verify::Outlet;

use crate::args::input;
use crate::args::options::DeriveArguments;
use crate::error::CliError;
use crate::output::text::TextOutput;
use crate::terminal::observer::Terminal;
use pc_run::motion::remarks::{say_changing_masses, say_dropped, say_moved};
use pc_run::motion::verification::vouched;

/// Prints the equations of a model.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &DeriveArguments) -> Result<(), CliError> {
    let is_hamel = arguments.form == Some(Form::Hamel);
    let place = TextOutput::at(arguments.output.as_deref())?;
    let model = input::open_in(&arguments.model, &arguments.velocities, is_hamel)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    let written = model.document().simulation.form.as_ref().map(|form| form.value.into());
    let form = arguments.form.or(written).unwrap_or(Form::Poincare);
    if arguments.reactions && !form.has_reactions() {
        return Err(CliError::NoReactions { form: form.name() });
    }
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    say_dropped(&assembly, &Terminal);
    say_moved(&assembly, &Terminal);
    say_changing_masses(&assembly, &Terminal);
    let layout = Layout {
        width: arguments.width.into(),
        brief: arguments.brief,
        inline: arguments.inline,
        reactions: arguments.reactions,
        symbols: arguments.symbols,
    };
    let page = page(form, arguments.format.into(), &layout, model.title(), &assembly)?;
    assembly.within_limits()?;
    if !arguments.verify.no_verify {
        let outlet = if arguments.reactions { Outlet::PageWithReactions(form) } else { Outlet::Page(form) };
        vouched(&model, &assembly, outlet, &Terminal)?;
    }
    place.write(|out| write!(out, "{page}"))
}
