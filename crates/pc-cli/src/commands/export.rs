//! `pc export`: models in other formats.

use pc_model::export::urdf_of_model;

use crate::args::input;
use crate::args::options::ExportArguments;
use crate::error::CliError;
use crate::output::text::TextOutput;
use crate::terminal::text::say;

/// Writes a model of bodies on joints as a robot in URDF.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &ExportArguments) -> Result<(), CliError> {
    let place = TextOutput::at(arguments.output.as_deref())?;
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    model.require_values()?;
    let (text, notes) = urdf_of_model(&model)?;
    notes.iter().for_each(|note| say(format_args!("note: {note}\n")));
    place.write(|out| out.write_all(text.as_bytes()))
}
