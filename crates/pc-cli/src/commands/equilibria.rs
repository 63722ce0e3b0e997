//! `pc equilibria`: the equilibria in a box.

use pc_run::linear::found::{Found, Search};
use pc_run::table::format::Format;

use crate::args::input;
use crate::args::linear::EquilibriaArguments;
use crate::error::CliError;
use crate::output::table::TablePlace;
use crate::terminal::observer::Terminal;

/// Runs `pc equilibria`.
///
/// # Errors
/// [`CliError`]
pub fn command(arguments: &EquilibriaArguments) -> Result<(), CliError> {
    let place = TablePlace::of(&arguments.table, Format::OF_LISTS)?;
    let mut model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.table.output.as_deref()])?;
    arguments.outputs.apply([&mut model]);
    let bounds = arguments.bounds.iter().map(|bounds| (bounds.name.clone(), bounds.low, bounds.high));
    let search = Search { bounds: bounds.collect(), starts: arguments.starts };
    let found = Found::of(&model, &search, !arguments.verify.no_verify, &Terminal)?;
    place.write(&found, "equilibria")
}
