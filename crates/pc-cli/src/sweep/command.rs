//! `pc sweep`: one model for many values of parameters and starts, in one table.
//!
//! ```text
//! Design ─ values of a member ─► Work ─ its motion, eigenvalues or properties ─► Record ─► Journal ─► table
//!          on all cores, by pc_solve::Ensemble                       in the order of the members
//! ```
//! The journal is the only link between a member and the table, so a sweep may end at any moment and continue later.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::thread;
use std::time::Instant;

use pc_model::{Category, Model};
use pc_print::one_line;
use pc_solve::{Ending, Ensemble};

use crate::args::input;
use crate::args::sweep::{Law, Random, SweepArguments, SweepOf};
use crate::error::CliError;
use crate::motion::identity;
use crate::motion::identity::Identity;
use crate::motion::interrupt;
use crate::motion::plan::Plan;
use crate::output;
use crate::report::text::labelled;
use crate::report::{notes, text};
use crate::sweep::checks::Checks;
use crate::sweep::design::Design;
use crate::sweep::error::SweepError;
use crate::sweep::journal::{Journal, Records, Tally};
use crate::sweep::linearizations::Linearizations;
use crate::sweep::motions::Motions;
use crate::sweep::output::destination::Destination;
use crate::sweep::progress::Progress;
use crate::sweep::shard::Shard;
use crate::sweep::sheet::Sheet;
use crate::sweep::work::Work;
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
    if let Some(option) = arguments.idle() {
        return Err(SweepError::Idle { option, of: arguments.of.word() }.into());
    }
    let mut model = input::open(&arguments.model)?;
    for name in &arguments.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    let design = Design::new(&model, arguments)?;
    let (all, names) = (design.members(), design.names());
    let is_random = arguments.samples.is_some();
    let (title, deadline) = (model.title().to_owned(), model.budget().deadline().clone());
    let threads =
        arguments.threads.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get);
    let (work, depends_on) = begun(arguments, model, design, threads)?;
    if !arguments.no_verify {
        work.vouched()?;
    }
    let sheet = Sheet::new(arguments.of, &names, work.members().columns());
    if picture.is_some() {
        let counts: Vec<u64> = arguments.vary.iter().map(|vary| vary.values.count()).collect();
        plot::check(&sheet, &arguments.columns, &counts, is_random).map_err(SweepError::Drawn)?;
    }
    let shard = arguments.shard.unwrap_or(Shard::ALL);
    let mut header = header(depends_on, arguments);
    if arguments.shard.is_some() {
        header = shards::described(header, shard, all, &title, &sheet);
    }
    let path = match arguments.shard {
        Some(shard) => shard.beside(destination.path()),
        None => Journal::beside(destination.path()),
    };
    let mut journal = Journal::open(path, shard, &header)?;
    let (members, before) = (shard.members(all), journal.tally().done);

    let row = 8 * work.members().columns().len() * work.rows();
    let window = NonZeroUsize::new((WAITING / row.max(1)).min(MOST_WAITING)).unwrap_or(NonZeroUsize::MIN);
    let mut ensemble = Ensemble::new().window(window).stopped_by(interrupt::flag());
    if let Some(threads) = arguments.threads {
        ensemble = ensemble.threads(threads);
    }
    let start = Instant::now();
    interrupt::catch();
    let mut progress = Progress::new(before, members);
    let mut kept = Ok(());
    let mut consume = |place, record: Result<Option<_>, pc_solve::Panicked>| {
        let record = record.unwrap_or_else(|panicked| {
            let message = &panicked.message;
            Some(work.members().panicked(shard.member(place), message))
        });
        // A member without a record was interrupted, or ended by a limit.
        let Some(record) = record else { return ControlFlow::Break(()) };
        kept = sheet.check(&record).map_err(SweepError::from).and_then(|()| journal.append(&record));
        progress.at(place + 1);
        if kept.is_err() || interrupt::requested() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let ending = work.records(&ensemble, shard, before..members, &mut consume);
    drop(progress);
    kept?;
    let done = journal.tally().done;
    if ending.map_err(SweepError::from)? == Ending::Stopped && done < members {
        return Err(match deadline.passed() {
            Some(limit) if !interrupt::requested() => SweepError::Ended { done, members, limit },
            _ => SweepError::Interrupted { done, members },
        }
        .into());
    }
    let tally = journal.tally().clone();
    let mut said = summary(&title, work.as_ref(), &tally, before, start.elapsed().as_secs_f64());
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

/// The work that is asked for, with what it depends on.
///
/// # Errors
/// [`CliError`] if the text of the model is wrong, or the work is not defined for it.
fn begun(
    arguments: &SweepArguments,
    model: Model,
    design: Design,
    threads: usize,
) -> Result<(Box<dyn Work>, Identity), CliError> {
    Ok(match arguments.of {
        SweepOf::Run => {
            let (run, all_rows) = (arguments.as_run(), arguments.rows.is_some());
            let form = Plan::form(&model, &run);
            look(&model)?;
            let plan = Plan::new(&model, &run)?;
            let identity = identity::of_motion(&model, &plan, form);
            (Box::new(Motions::new(model, design, (plan, form), all_rows, threads)?), identity)
        }
        SweepOf::Linearize => {
            let state = &arguments.state;
            let identity = identity::of_work(&model, Linearizations::depends_on(state));
            (Box::new(Linearizations::new(model, design, state)?), identity)
        }
        SweepOf::Check => {
            look(&model)?;
            let identity = identity::of_work(&model, []);
            (Box::new(Checks::new(model, design)), identity)
        }
    })
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

/// What the result depends on.
fn header(depends_on: Identity, arguments: &SweepArguments) -> Identity {
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
    let mut header = depends_on;
    header.insert(0, ("--of".to_owned(), arguments.of.word().to_owned()));
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

fn summary(title: &str, work: &dyn Work, tally: &Tally, before: u64, elapsed: f64) -> String {
    let mut text = format!("{}\n", one_line(title));
    for (label, line) in work.said() {
        text += &labelled(label, 9, &[line]);
    }
    let mut members = counted(tally);
    if before > 0 {
        members += &format!("; {before} were finished before");
    }
    text += &labelled("members", 9, &[members]);
    text += &uncompleted(tally);
    let rate = (tally.done - before) as f64 / elapsed;
    let took = format!("{elapsed:.3} s, {rate:.0} members/s{}", work.done());
    text + &labelled("work", 9, &[took])
}
