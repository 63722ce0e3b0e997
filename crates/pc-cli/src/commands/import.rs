//! `pc import`: models in other formats, as text models.

use std::io::{self, Write};
use std::path::Path;

use pc_model::Source;
use pc_model::document::{read_bounded, read_file_bounded};
use pc_model::import::{Directories, ImportOptions, model_of_robot};
use pc_run::files::apart::{STANDARD_INPUT, keep_apart};
use pc_run::files::error::FileError;
use pc_run::files::target::{Target, file};

use crate::args::options::ImportArguments;
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::terminal::text::say;

/// Writes the text model of a robot in URDF, MJCF or SDF.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &ImportArguments) -> Result<(), CliError> {
    let path = file(Some(&arguments.file));
    let name = path.map_or("<stdin>".to_owned(), |path| path.display().to_string());
    let place = file(arguments.output.as_deref()).map(|output| (output, Target::new(output)));
    let place = place
        .map(|(output, place)| place.map_err(|source| FileError::no_place(output, source)))
        .transpose()?;
    keep_apart([path.unwrap_or(Path::new(STANDARD_INPUT))], place.as_ref().map(Target::path))?;
    let bytes = path.map_or_else(|| read_bounded(io::stdin().lock()), read_file_bounded);
    let bytes = bytes.map_err(|source| CliError::Read { name: name.clone(), source })?;
    let source = match String::from_utf8(bytes) {
        Ok(text) => Source::new(name, text),
        Err(error) => {
            let source = io::Error::new(io::ErrorKind::InvalidData, error);
            return Err(CliError::Read { name, source });
        }
    };
    let options = ImportOptions {
        floating: arguments.floating,
        fix_massless: arguments.fix_massless,
        restitution: arguments.limits,
        // The model on standard output is for the directory in which the program runs.
        directories: path
            .map(|robot| Directories::of_files(robot, place.as_ref().map_or(Path::new(""), Target::path))),
    };
    let (text, left_out) = model_of_robot(&source, options)?;
    left_out.iter().for_each(|left| say(format_args!("note: {left}\n")));
    match place {
        None => print(|out| out.write_all(text.as_bytes())),
        Some(place) => place
            .write(|out| out.write_all(text.as_bytes()))
            .map_err(|source| FileError::cannot_write(place.path(), source).into()),
    }
}
