//! `pc equilibria`: the equilibria in a box.

use pc_print::{visible, visible_json};
use pc_run::linear::found::{Found, Search};
use pc_run::table::file::{Format, TableFile};

use crate::args::input;
use crate::args::linear::{EquilibriaArguments, MatrixFormat};
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::terminal::observer::Terminal;

/// Runs `pc equilibria`.
///
/// # Errors
/// [`CliError`]
pub fn command(arguments: &EquilibriaArguments) -> Result<(), CliError> {
    let file = arguments.output.as_deref().map(|path| TableFile::new(path, Format::OF_LISTS)).transpose()?;
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    let bounds = arguments.bounds.iter().map(|bounds| (bounds.name.clone(), bounds.low, bounds.high));
    let search = Search { bounds: bounds.collect(), starts: arguments.starts };
    let found = Found::of(&model, &search, !arguments.verify.no_verify, &Terminal)?;
    match (&file, arguments.format) {
        (Some(file), _) => Ok(found.write(file)?),
        (None, MatrixFormat::Text) => print(|out| write!(out, "{}", visible(&found.text()))),
        (None, MatrixFormat::Json) => print(|out| writeln!(out, "{}", visible_json(&found.json()))),
        (None, MatrixFormat::Csv) => print(|out| write!(out, "{}", found.csv())),
    }
}
