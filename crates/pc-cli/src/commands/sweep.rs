//! `pc sweep`: one model for many values of parameters and starts, in one table.

use pc_print::{labelled, one_line};
use pc_run::RunError;
use pc_run::sweep::error::SweepError;
use pc_run::sweep::journal::{Records, Tally};
use pc_run::sweep::sweep_columns::SweepColumns;
use pc_run::sweep::{Sweep, Swept};
use pc_run::sweep::{output, picture};
use pc_run::table::format::Format;

use crate::args::input;
use crate::args::sweep::SweepArguments;
use crate::error::CliError;
use crate::output::destination::Destination;
use crate::output::table::regular_file;
use crate::terminal::observer::Terminal;
use crate::terminal::text;

/// Runs `pc sweep`.
///
/// # Errors
/// [`CliError`]; finished members are kept.
pub fn command(arguments: &SweepArguments) -> Result<(), CliError> {
    let file = regular_file(&arguments.table, Format::OF_TABLES)?;
    let columns = arguments.columns.names();
    let place = Destination::plot(arguments.plot.as_deref())?;
    if let Some(option) = arguments.idle() {
        return Err(CliError::Idle { option, of: arguments.of.word() });
    }
    let mut model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [Some(file.path()), arguments.plot.as_deref()])?;
    arguments.outputs.apply([&mut model]);
    for name in &arguments.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    let set: Vec<&str> = arguments.model.set.iter().map(|setting| setting.name.as_str()).collect();
    let sweep = Sweep::new(model, &arguments.variation(), &set, &arguments.wishes(), &Terminal)?;
    if !arguments.no_verify {
        sweep.vouched()?;
    }
    let written = sweep.written(&columns)?;
    if place.is_some() {
        sweep.drawable(&columns)?;
    }
    let mut journal = sweep.journal(file.path(), arguments.shard)?;
    let swept = sweep.run(&mut journal, &Terminal)?;
    let mut said = summary(&sweep, &swept);
    if let Some(shard) = arguments.shard {
        // Only all shards together show whether any member was completed.
        said += &labelled("shard", 9, &[format!("{shard}, in {}, for pc merge", journal.path().display())]);
        text::say(format_args!("{said}"));
        return Ok(());
    }
    output::write(&file, sweep.title(), (sweep.sweep_columns(), &written), &journal)?;
    let drawn = place.map(|place| {
        let said = (sweep.title(), sweep.units());
        draw(&place, said, (sweep.sweep_columns(), &journal), &columns, sweep.is_random())
    });
    journal.remove()?;
    text::say(format_args!("{said}"));
    drawn.transpose()?;
    judged(&swept.tally)
}

/// Writes the picture.
///
/// # Errors
/// [`SweepError::Drawn`], or that of the file.
pub(super) fn draw(
    place: &Destination,
    (title, units): (&str, &[(String, String)]),
    (sweep_columns, members): (&SweepColumns, &dyn Records),
    columns: &[String],
    is_random: bool,
) -> Result<(), CliError> {
    let picture = picture::picture(title, sweep_columns, members, columns, is_random)?;
    place.write_plot(&picture.in_units(units).drawing())
}

/// An error where no member was completed.
pub(super) fn judged(tally: &Tally) -> Result<(), CliError> {
    match tally.others.first() {
        Some((_, _, first)) if tally.completed + tally.by_event == 0 => {
            Err(RunError::from(SweepError::NoneCompleted { members: tally.done, first: first.clone() })
                .into())
        }
        _ => Ok(()),
    }
}

/// The numbers of members by how they ended.
pub(super) fn counted(tally: &Tally) -> String {
    let others = tally.done - tally.completed - tally.by_event;
    let mut members = format!("{}, {} completed", tally.done, tally.completed);
    if tally.by_event > 0 {
        members += &format!(", {} ended by an event", tally.by_event);
    }
    if others > 0 {
        members += &format!(", {others} not");
    }
    members
}

/// Lines for the first members that were not completed.
pub(super) fn uncompleted(tally: &Tally) -> String {
    let others = tally.done - tally.completed - tally.by_event;
    let mut lines = String::new();
    for (member, status, message) in &tally.others {
        lines += &labelled(status.word(), 9, &[format!("member {member}: {message}")]);
    }
    if others > tally.others.len() as u64 {
        lines += &labelled("", 9, &[format!("… and {} more", others - tally.others.len() as u64)]);
    }
    lines
}

fn summary(sweep: &Sweep, swept: &Swept) -> String {
    let Swept { before, tally, wall } = swept;
    let mut text = format!("{}\n", one_line(sweep.title()));
    for (label, line) in sweep.said() {
        text += &labelled(label, 9, &[line]);
    }
    let mut members = counted(tally);
    if *before > 0 {
        members += &format!("; {before} were finished before");
    }
    text += &labelled("members", 9, &[members]);
    text += &uncompleted(tally);
    let elapsed = wall.as_secs_f64();
    let rate = (tally.done - before) as f64 / elapsed;
    let took = format!("{elapsed:.3} s, {rate:.0} members/s{}", sweep.done());
    text + &labelled("work", 9, &[took])
}
