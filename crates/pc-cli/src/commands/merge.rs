//! `pc merge`: the shards of a sweep as one table.

use std::path::PathBuf;

use pc_print::{labelled, one_line};
use pc_run::files::apart::keep_apart;
use pc_run::sweep::output;
use pc_run::sweep::shards::Shards;
use pc_run::table::file::{Format, TableFile};

use crate::args::sweep::MergeArguments;
use crate::commands::sweep::{counted, draw, judged, uncompleted};
use crate::error::CliError;
use crate::output::destination::Destination;
use crate::terminal::text;

/// Runs `pc merge`.
///
/// # Errors
/// [`CliError`]; nothing is written unless all shards are given and complete.
pub fn command(arguments: &MergeArguments) -> Result<(), CliError> {
    let file = TableFile::regular(&arguments.output, Format::OF_TABLES)?;
    let picture = Destination::plot(arguments.plot.as_deref())?;
    let written = [Some(arguments.output.as_path()), arguments.plot.as_deref()];
    keep_apart(arguments.shards.iter().map(PathBuf::as_path), written.into_iter().flatten())?;
    let shards = Shards::open(&arguments.shards)?;
    output::write(&file, &shards.title, &shards.sweep_columns, &shards)?;
    if let Some(place) = picture {
        draw(
            &place,
            (&shards.title, &[]),
            (&shards.sweep_columns, &shards),
            &arguments.columns,
            shards.is_random,
        )?;
    }
    let tally = shards.tally();
    let mut said = format!("{}\n", one_line(&shards.title));
    said += &labelled("shards", 9, &[arguments.shards.len().to_string()]);
    said += &labelled("members", 9, &[counted(&tally)]);
    said += &uncompleted(&tally);
    text::say(format_args!("{said}"));
    judged(&tally)
}
