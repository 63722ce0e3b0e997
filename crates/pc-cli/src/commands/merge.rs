//! `pc merge`: the shards of a sweep as one table.

use std::path::PathBuf;

use pc_print::{labelled, one_line};
use pc_run::RunError;
use pc_run::files::apart::keep_apart;
use pc_run::sweep::output;
use pc_run::sweep::shards::Shards;
use pc_run::table::format::Format;

use crate::args::sweep::MergeArguments;
use crate::commands::sweep::{counted, draw, judged, uncompleted};
use crate::error::CliError;
use crate::output::destination::Destination;
use crate::output::table::regular_file;
use crate::terminal::text;

/// Runs `pc merge`.
///
/// # Errors
/// [`CliError`]; nothing is written unless all shards are given and complete.
pub fn command(arguments: &MergeArguments) -> Result<(), CliError> {
    let file = regular_file(&arguments.table, Format::OF_TABLES)?;
    let columns = arguments.columns.names();
    let picture = Destination::plot(arguments.plot.as_deref())?;
    let results = [Some(file.path()), arguments.plot.as_deref()];
    keep_apart(arguments.shards.iter().map(PathBuf::as_path), results.into_iter().flatten())?;
    let shards = Shards::open(&arguments.shards)?;
    let written = shards.sweep_columns.written(&columns).map_err(RunError::from)?;
    output::write(&file, &shards.title, (&shards.sweep_columns, &written), &shards)?;
    if let Some(place) = picture {
        draw(&place, (&shards.title, &[]), (&shards.sweep_columns, &shards), &columns, shards.is_random)?;
    }
    let tally = shards.tally();
    let mut said = format!("{}\n", one_line(&shards.title));
    said += &labelled("shards", 9, &[arguments.shards.len().to_string()]);
    said += &labelled("members", 9, &[counted(&tally)]);
    said += &uncompleted(&tally);
    text::say(format_args!("{said}"));
    judged(&tally)
}
