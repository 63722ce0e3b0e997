//! `pc export`: models in other formats.

use std::io::Write;

use pc_model::export::urdf_of_model;
use pc_run::files::error::FileError;
use pc_run::files::target::{Target, file};

use crate::args::input;
use crate::args::options::ExportArguments;
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::terminal::text::say;

/// Writes a model of bodies on joints as a robot in URDF.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &ExportArguments) -> Result<(), CliError> {
    let place = file(arguments.output.as_deref()).map(|output| (output, Target::new(output)));
    let place = place
        .map(|(output, place)| place.map_err(|source| FileError::no_place(output, source)))
        .transpose()?;
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    model.require_values()?;
    let (text, notes) = urdf_of_model(&model)?;
    notes.iter().for_each(|note| say(format_args!("note: {note}\n")));
    match place {
        None => print(|out| out.write_all(text.as_bytes())),
        Some(place) => place
            .write(|out| out.write_all(text.as_bytes()))
            .map_err(|source| FileError::cannot_write(place.path(), source).into()),
    }
}
