//! `pc merge`: the shards of a sweep as one table.

use pc_print::one_line;

use crate::args::sweep::MergeArguments;
use crate::error::CliError;
use crate::output;
use crate::report::text;
use crate::report::text::labelled;
use crate::sweep::command::{counted, draw, judged, uncompleted};
use crate::sweep::output::destination::Destination;
use crate::sweep::shards::Shards;

/// Runs `pc merge`.
///
/// # Errors
/// [`CliError`]; nothing is written unless all shards are given and complete.
pub fn command(arguments: &MergeArguments) -> Result<(), CliError> {
    let destination = Destination::new(&arguments.output)?;
    let picture = output::destination::Destination::plot(arguments.plot.as_deref())?;
    let shards = Shards::open(&arguments.shards)?;
    destination.write(&shards.title, &shards.sheet, &shards)?;
    if let Some(place) = picture {
        draw(&place, &shards.title, &shards.sheet, &shards, &arguments.columns, shards.is_random)?;
    }
    let tally = shards.tally();
    let mut said = format!("{}\n", one_line(&shards.title));
    said += &labelled("shards", 9, &[arguments.shards.len().to_string()]);
    said += &labelled("members", 9, &[counted(&tally)]);
    said += &uncompleted(&tally);
    text::say(format_args!("{said}"));
    judged(&tally)
}
