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
use crate::args::sweep::{Law, Random, SweepArguments, Vary};
use crate::error::CliError;
use crate::motion::identity;
use crate::motion::identity::Identity;
use crate::motion::interrupt;
use crate::motion::memory;
use crate::motion::plan::Plan;
use crate::report::text::{labelled, short};
use crate::report::{notes, text};
use crate::sweep::design::Design;
use crate::sweep::error::SweepError;
use crate::sweep::journal::Journal;
use crate::sweep::member::Members;
use crate::sweep::output::destination::Destination;
use crate::sweep::progress::Progress;
use crate::sweep::sheet::Sheet;

/// Bytes of finished members that may wait for an earlier one.
const WAITING: usize = 64 << 20;
/// … and how many.
const MOST_WAITING: usize = 4096;

/// Runs `pc sweep`.
///
/// # Errors
/// [`CliError`]; what was finished is kept then.
pub fn command(arguments: &SweepArguments) -> Result<(), CliError> {
    let destination = Destination::new(&arguments.output)?;
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
    let title = model.title().to_owned();
    let header = header(&model, arguments, &plan, form);
    // Of each member at work its trajectory, its table, its record and the bytes of that.
    let threads =
        arguments.threads.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZeroUsize::get);
    memory::allow(plan.samples as u64, (4 * columns * threads) as u64, model.budget().limits())?;
    let mut journal = Journal::open(destination.path(), &header)?;
    let (members, before) = (design.members(), journal.tally().done);

    let row = 8 * motion.len() * if all_rows { plan.samples } else { 1 };
    let window = NonZeroUsize::new((WAITING / row.max(1)).min(MOST_WAITING)).unwrap_or(NonZeroUsize::MIN);
    let mut ensemble = Ensemble::new().window(window);
    if let Some(threads) = arguments.threads {
        ensemble = ensemble.threads(threads);
    }
    let start = Instant::now();
    let work = Members::new(model, design, form, &plan, all_rows, columns);
    interrupt::catch();
    let mut progress = Progress::new(before, members);
    let mut kept = Ok(());
    let consume = |member, record: Result<Option<_>, pc_solve::Panicked>| {
        let record = record.unwrap_or_else(|panicked| Some(work.panicked(member, &panicked.message)));
        // None: interrupted on its way, or ended by a limit.
        let Some(record) = record else { return ControlFlow::Break(()) };
        kept = journal.append(&record);
        progress.at(member + 1);
        if kept.is_err() || interrupt::requested() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let ending = ensemble.map(before..members, |member, stop| work.integrate(member, stop), consume);
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
    destination.write(&title, &sheet, &journal)?;
    let elapsed = start.elapsed().as_secs_f64();
    let tally = journal.tally().clone();
    journal.remove()?;
    text::say(format_args!("{}", summary(&title, &plan, &tally, before, elapsed)));
    match tally.others.first() {
        Some((_, _, first)) if tally.completed + tally.by_event == 0 => {
            Err(SweepError::NoneCompleted { members, first: first.clone() }.into())
        }
        _ => Ok(()),
    }
}

/// That the text of the model is right. What the values of its parameters make inconsistent may be consistent in a
/// member.
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
fn header(model: &Model, arguments: &SweepArguments, plan: &Plan, form: RunForm) -> Identity {
    let vary =
        arguments.vary.iter().map(|Vary { name, from, to, count }| format!("{name}={from}:{to}:{count}"));
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

fn summary(
    title: &str,
    plan: &Plan,
    tally: &crate::sweep::journal::Tally,
    before: u64,
    elapsed: f64,
) -> String {
    let mut text = format!("{}\n", one_line(title));
    let mut line = |label: &str, line: String| text += &labelled(label, 9, &[line]);
    line("method", plan.in_words());
    line("time", format!("{} to {}", short(plan.t_start, 10), short(plan.t_end, 10)));
    let others = tally.done - tally.completed - tally.by_event;
    let mut members = format!("{}, {} completed", tally.done, tally.completed);
    if tally.by_event > 0 {
        members += &format!(", {} ended by an event", tally.by_event);
    }
    if others > 0 {
        members += &format!(", {others} not");
    }
    if before > 0 {
        members += &format!("; {before} were finished before");
    }
    line("members", members);
    for (member, status, message) in &tally.others {
        line(status.word(), format!("member {member}: {message}"));
    }
    if others > tally.others.len() as u64 {
        line("", format!("… and {} more", others - tally.others.len() as u64));
    }
    let computed = tally.done - before;
    line("work", format!("{elapsed:.3} s, {:.0} members/s", computed as f64 / elapsed));
    text
}
