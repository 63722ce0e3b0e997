//! `pc new`: a model to start from.

use std::fs;
use std::io::Write;
use std::path::Path;

use pc_model::document::SCHEMA;

use crate::args::tools::NewArguments;
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::terminal::text::say;
use pc_run::files::error::FileError;
use pc_run::files::target::{Target, file};

/// The file of the schema beside a model.
const SCHEMA_FILE: &str = "pc-model.schema.json";

/// Writes a model that runs, whose comments explain the format.
///
/// # Errors
/// [`FileError::Place`] where the file exists already; [`FileError::Write`].
pub fn command(arguments: &NewArguments) -> Result<(), CliError> {
    let directive = if arguments.schema { format!("#:schema ./{SCHEMA_FILE}\n") } else { String::new() };
    let text = directive + arguments.kind.text();
    let Some(path) = file(arguments.output.as_deref()) else {
        return print(|out| out.write_all(text.as_bytes()));
    };
    let place = Target::fresh(path).map_err(|source| FileError::no_place(path, source))?;
    if arguments.schema {
        write_schema(&path.with_file_name(SCHEMA_FILE))?;
    }
    place
        .create(|out| out.write_all(text.as_bytes()))
        .map_err(|source| FileError::cannot_write(path, source))?;
    let name = path.display();
    let next = ["check", "derive", "run", "live"].map(|command| format!("`pc {command} {name}`")).join(", ");
    say(format_args!("{name}: now {next}\n"));
    Ok(())
}

/// Writes the schema unless the file exists.
fn write_schema(path: &Path) -> Result<(), CliError> {
    match fs::read(path) {
        Ok(known) if known == SCHEMA.as_bytes() => Ok(()),
        Ok(_) => {
            let name = path.display();
            say(format_args!("note: {name} is not what `pc schema` prints; it is kept as it is\n"));
            Ok(())
        }
        Err(_) => {
            let place = Target::fresh(path).map_err(|source| FileError::no_place(path, source))?;
            let written = place.create(|out| out.write_all(SCHEMA.as_bytes()));
            written.map_err(|source| FileError::cannot_write(path, source).into())
        }
    }
}
