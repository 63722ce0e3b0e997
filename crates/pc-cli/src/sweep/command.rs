//! `pc sweep`: many motions of one model, over parameters and starts, in one table.
//!
//! ```text
//! Design ─ values of a member ─► Members ─ its motion ─► Record ─► Journal ─► table
//!          on all cores, by pc_solve::Ensemble             in the order of the members
//! ```
//! The journal is the only link between a member and the table, so a sweep may end at any moment and continue later.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::thread;
use std::time::Instant;

use pc_model::{Category, Model};
use pc_print::one_line;
use pc_solve::{Ending, Ensemble};

use crate::args::forms::RunForm;
use crate::args::input;
use crate::args::sweep::{Law, Random, SweepArguments};
use crate::error::CliError;
use crate::motion::identity;
use crate::motion::identity::Identity;
use crate::motion::interrupt;
use crate::motion::memory;
use crate::motion::plan::Plan;
use crate::output;
use crate::report::text::{labelled, short};
use crate::report::{notes, text};
use crate::sweep::design::Design;
use crate::sweep::error::SweepError;
use crate::sweep::journal::{Journal, Records, Tally};
use crate::sweep::member::Members;
use crate::sweep::output::destination::Destination;
use crate::sweep::progress::Progress;
use crate::sweep::shard::Shard;
use crate::sweep::sheet::Sheet;
use crate::sweep::{plot, shards};

/// Bytes of finished members that may wait for an earlier one.
const WAITING: usize = 64 << 20;
/// Finished members that may wait for an earlier one.
const MOST_WAITING: usize = 4096;

/// Runs `pc sweep`.
///
/// # Errors
/// [`CliError`]; finished members are kept.
pub fn command(arguments: &SweepArguments) -> Result<(), CliError> {
    let destination = Destination::new(&arguments.output)?;
    let picture = output::destination::Destination::plot(arguments.plot.as_deref())?;
    let mut model = input::open(&arguments.model)?;
    for name in &arguments.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    let design = Design::new(&model, arguments)?;
    let form = Plan::form(&model, &arguments.as_run());
    look(&model)?;
    let plan = Plan::new(&model, &arguments.as_run())?;

    let all_rows = arguments.rows.is_some();
    let motion = Sheet::motion(&model, !all_rows);
    let columns = Sheet::motion(&model, false).len();
    let sheet = Sheet::new(&design, &motion);
    let is_random = arguments.samples.is_some();
    if picture.is_some() {
        let counts: Vec<u64> = arguments.vary.iter().map(|vary| vary.values.count()).collect();
        plot::check(&sheet, &arguments.columns, &counts, is_random).map_err(SweepError::Drawn)?;
    }
    let title = model.title().to_owned();
    let shard = arguments.shard.unwrap_or(Shard::ALL);
    let all = design.members();
    let mut header = header(&model, arguments, &plan, form);
    if arguments.shard.is_some() {
        header = shards::described(header, shard, all, &title, &sheet);
    }
    // Each member at work has its trajectory, its table, its record and the bytes of the record.
    let threads =
        arguments.threads.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get);
    memory::allow(plan.samples as u64, (4 * columns * threads) as u64, model.budget().limits())?;
    let path = match arguments.shard {
        Some(shard) => shard.beside(destination.path()),
        None => Journal::beside(destination.path()),
    };
    let mut journal = Journal::open(path, shard, &header)?;
    let (members, before) = (shard.members(all), journal.tally().done);

    let row = 8 * motion.len() * if all_rows { plan.samples } else { 1 };
    let window = NonZeroUsize::new((WAITING / row.max(1)).min(MOST_WAITING)).unwrap_or(NonZeroUsize::MIN);
    let mut ensemble = Ensemble::new().window(window).stopped_by(interrupt::flag());
    if let Some(threads) = arguments.threads {
        ensemble = ensemble.threads(threads);
    }
    let start = Instant::now();
    let work = Members::new(model, design, form, &plan, all_rows, columns);
    interrupt::catch();
    let mut progress = Progress::new(before, members);
    let mut kept = Ok(());
    let consume = |place, record: Result<Option<_>, pc_solve::Panicked>| {
        let record = record.unwrap_or_else(|panicked| {
            let message = &panicked.message;
            Some(work.panicked(shard.member(place), message))
        });
        // A member without a record was interrupted, or ended by a limit.
        let Some(record) = record else { return ControlFlow::Break(()) };
        kept = journal.append(&record);
        progress.at(place + 1);
        if kept.is_err() || interrupt::requested() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let ending = ensemble.map_in_lanes(
        before..members,
        work.span(),
        |place| work.begin(shard.member(place)),
        |_, begun, trajectory| work.completed(begun, &trajectory),
        |_, begun, stop| work.integrate(begun, stop),
        consume,
    );
    drop(progress);
    kept?;
    let done = journal.tally().done;
    if ending.map_err(SweepError::from)? == Ending::Stopped && done < members {
        return Err(match plan.deadline.passed() {
            Some(limit) if !interrupt::requested() => SweepError::Ended { done, members, limit },
            _ => SweepError::Interrupted { done, members },
        }
        .into());
    }
    let tally = journal.tally().clone();
    let mut said = summary(&title, &plan, &tally, (before, work.beside()), start.elapsed().as_secs_f64());
    if arguments.shard.is_some() {
        // Only all shards together show whether any member was completed.
        said += &labelled("shard", 9, &[format!("{shard}, in {}, for pc merge", journal.path().display())]);
        text::say(format_args!("{said}"));
        return Ok(());
    }
    destination.write(&title, &sheet, &journal)?;
    let drawn = picture.map(|place| draw(&place, &title, &sheet, &journal, &arguments.columns, is_random));
    journal.remove()?;
    text::say(format_args!("{said}"));
    drawn.transpose()?;
    judged(&tally)
}

/// Writes the picture.
///
/// # Errors
/// [`SweepError::Drawn`], [`CliError::Write`]
pub(super) fn draw(
    place: &output::destination::Destination,
    title: &str,
    sheet: &Sheet,
    members: &dyn Records,
    columns: &[String],
    is_random: bool,
) -> Result<(), CliError> {
    let picture = plot::picture(title, sheet, members, columns, is_random);
    let picture = picture.map_err(SweepError::Read)?.map_err(SweepError::Drawn)?;
    place.write_plot(&picture.drawing())
}

/// An error where no member was completed.
pub(super) fn judged(tally: &Tally) -> Result<(), CliError> {
    match tally.others.first() {
        Some((_, _, first)) if tally.completed + tally.by_event == 0 => {
            Err(SweepError::NoneCompleted { members: tally.done, first: first.clone() }.into())
        }
        _ => Ok(()),
    }
}

/// An error unless the text of the model is right. A model that is inconsistent only for its
/// parameter values may be consistent in a member.
fn look(model: &Model) -> Result<(), CliError> {
    let graph = model.graph();
    match model.assemble(&graph) {
        Ok(assembly) => {
            notes::say_dropped(&assembly);
            Ok(())
        }
        Err(error) if error.category() == Category::Inconsistent => Ok(()),
        Err(error) => Err(error.into()),
    }
}

/// All that the result depends on.
fn header(model: &Model, arguments: &SweepArguments, plan: &Plan, form: RunForm) -> Identity {
    let vary = arguments.vary.iter().map(ToString::to_string);
    let random = arguments.random.iter().map(|Random { name, law }| match law {
        Law::Normal(m, s) => format!("{name}=normal({m},{s})"),
        Law::Uniform(a, b) => format!("{name}=uniform({a},{b})"),
        Law::LogNormal(m, s) => format!("{name}=lognormal({m},{s})"),
    });
    let list = |items: &mut dyn Iterator<Item = String>| items.collect::<Vec<_>>().join(" ");
    let rows = arguments.rows.map_or("none".to_owned(), |rows| rows.to_string());
    let samples = arguments.samples.map_or("none".to_owned(), |samples| samples.to_string());
    let entries = [
        ("--vary", list(&mut { vary })),
        ("--random", list(&mut { random })),
        ("--samples", samples),
        ("--seed", arguments.seed.to_string()),
        ("--rows", rows),
    ];
    let mut header = identity::of_motion(model, plan, form);
    header.extend(entries.map(|(name, value)| (name.to_owned(), value)));
    header
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

fn summary(title: &str, plan: &Plan, tally: &Tally, (before, beside): (u64, u64), elapsed: f64) -> String {
    let mut text = format!("{}\n", one_line(title));
    let mut line = |label: &str, line: String| text += &labelled(label, 9, &[line]);
    line("method", plan.in_words());
    line("time", format!("{} to {}", short(plan.t_start, 10), short(plan.t_end, 10)));
    let mut members = counted(tally);
    if before > 0 {
        members += &format!("; {before} were finished before");
    }
    line("members", members);
    text += &uncompleted(tally);
    let mut line = |label: &str, line: String| text += &labelled(label, 9, &[line]);
    let computed = tally.done - before;
    let mut work = format!("{elapsed:.3} s, {:.0} members/s", computed as f64 / elapsed);
    if beside > 0 {
        work += &format!(", {beside} side by side in vectors");
    }
    line("work", work);
    text
}
