//! `pc schema`: the JSON Schema of the text format.

use std::io::Write;

use pc_model::document::SCHEMA;

use crate::args::tools::SchemaArguments;
use crate::error::CliError;
use crate::output::standard_output::print;
use pc_run::files::error::FileError;
use pc_run::files::target::{Target, file};

/// Writes the schema.
///
/// # Errors
/// [`FileError::Place`]; [`FileError::Write`].
pub fn command(arguments: &SchemaArguments) -> Result<(), CliError> {
    let text = SCHEMA.as_bytes();
    match file(arguments.output.as_deref()) {
        None => print(|out| out.write_all(text)),
        Some(path) => {
            let place = Target::new(path).map_err(|source| FileError::no_place(path, source))?;
            place
                .write(|out| out.write_all(text))
                .map_err(|source| FileError::cannot_write(path, source).into())
        }
    }
}
