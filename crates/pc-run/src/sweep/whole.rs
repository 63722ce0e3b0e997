//! A sweep: one model for many values of parameters and starts.
//!
//! ```text
//! Design ─ values of a member ─► Work ─ its motion, eigenvalues or properties ─► Record ─► Journal ─► table
//!          on all cores, by pc_solve::Ensemble                       in the order of the members
//! ```
//! The journal is the only link between a member and the table, so a sweep may be interrupted at any moment and
//! continued later.

use std::num::NonZeroUsize;
use std::ops::{ControlFlow, Range};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use pc_model::{Category, Model};
use pc_solve::{Deadline, Ending, Ensemble, Panicked};

use super::checks::Checks;
use super::design::{Design, Variation};
use super::error::SweepError;
use super::journal::{Journal, Tally};
use super::linearizations::Linearizations;
use super::motions::Motions;
use super::of::SweepOf;
use super::record::Record;
use super::shard::Shard;
use super::sweep_columns::SweepColumns;
use super::work::Work;
use super::{picture, shards};
use crate::error::RunError;
use crate::linear::state::StateChoice;
use crate::motion::derived::Derived;
use crate::motion::identity::{self, Identity};
use crate::motion::integrate::units;
use crate::motion::remarks::say_dropped;
use crate::observer::Observer;
use crate::plan::Plan;
use crate::plan::Wishes;

/// The largest number of bytes of finished members that may wait for an earlier member.
const WAITING: usize = 64 << 20;
/// The largest number of finished members that may wait for an earlier one.
const MOST_WAITING: usize = 4096;

/// What to compute for each member, and how.
#[derive(Clone, Debug, Default)]
pub struct SweepWishes {
    /// What a sweep computes.
    pub of: SweepOf,
    /// How to integrate motions; all their rows are recorded if `samples` is given, otherwise only the last
    /// row with the drifts.
    pub run: Wishes,
    /// The state at which to linearize.
    pub state: StateChoice,
    /// The number of threads; by default, one for each core. The result is the same for any number.
    pub threads: Option<NonZeroUsize>,
    /// The largest number of members; by default, [`MOST_MEMBERS`](SweepWishes::MOST_MEMBERS).
    pub limit_members: Option<u64>,
}

impl SweepWishes {
    /// More members than these are more often a slip in a grid than meant.
    pub const MOST_MEMBERS: u64 = 1_000_000;
}

/// A sweep to be computed.
pub struct Sweep {
    title: String,
    /// The units that the text of the model names, each after its quantity.
    units: Vec<(String, String)>,
    deadline: Deadline,
    work: Box<dyn Work>,
    sweep_columns: SweepColumns,
    threads: Option<NonZeroUsize>,
    members: u64,
    is_random: bool,
    /// How many values each quantity of a grid has.
    counts: Vec<u64>,
    /// Everything on which the result depends.
    header: Identity,
}

/// The members of a sweep that were computed.
#[derive(Clone, Debug)]
pub struct Swept {
    /// How many members were finished before this run.
    pub before: u64,
    /// How many of all members ended in each way.
    pub tally: Tally,
    /// The time it took.
    pub wall: Duration,
}

impl Sweep {
    /// A sweep of a model; the names in `set` must not be varied.
    ///
    /// # Errors
    /// [`RunError`] if the text of the model is wrong, the work is not defined for it, or there are too many members.
    pub fn new(
        model: Model,
        variation: &Variation,
        set: &[&str],
        wishes: &SweepWishes,
        observer: &dyn Observer,
    ) -> Result<Sweep, RunError> {
        let design = Design::new(&model, variation, set)?;
        let (members, names) = (design.members(), design.names());
        let limit = wishes.limit_members.unwrap_or(SweepWishes::MOST_MEMBERS);
        if members > limit {
            return Err(SweepError::Many { members, limit }.into());
        }
        let (title, deadline) = (model.title().to_owned(), model.budget().deadline().clone());
        let units = units(&model);
        let observes = model.observes_reactions();
        let (work, depends_on) = begun(wishes, model, design, observer)?;
        let sweep_columns = SweepColumns::new(wishes.of, &names, work.members().columns());
        Ok(Sweep {
            title,
            units,
            deadline,
            work,
            sweep_columns,
            threads: wishes.threads,
            members,
            is_random: variation.members.is_some(),
            counts: variation.vary.iter().map(|vary| vary.values.count()).collect(),
            header: header(depends_on, variation, wishes, observes),
        })
    }

    /// A sweep that integrates members in memory, with equations that have been derived; it records all rows
    /// of the plan or, for each member, only the last.
    ///
    /// # Errors
    /// [`RunError::Rows`] if the rows take more memory than they may.
    pub fn of_motions(
        model: Model,
        design: Design,
        (plan, all_rows): (Plan, bool),
        derived: &Derived,
        threads: Option<NonZeroUsize>,
    ) -> Result<Sweep, RunError> {
        let (members, names) = (design.members(), design.names());
        let (title, deadline) = (model.title().to_owned(), plan.deadline.clone());
        let units = units(&model);
        let work = Motions::new(model, design, plan, all_rows, workers(threads), Some(derived))?;
        let sweep_columns = SweepColumns::new(SweepOf::Run, &names, work.members().columns());
        let (counts, header) = (Vec::new(), Identity::new());
        let work = Box::new(work);
        Ok(Sweep {
            title,
            units,
            deadline,
            work,
            sweep_columns,
            threads,
            members,
            is_random: false,
            counts,
            header,
        })
    }

    /// The records of all members, in order.
    ///
    /// # Errors
    /// [`SweepError::Ended`] or [`SweepError::Interrupted`] if there are fewer records than members, and an
    /// error if threads cannot be started.
    pub fn collect(&self, observer: &dyn Observer) -> Result<Vec<Record>, SweepError> {
        let mut progress = observer.members(0, self.members);
        let mut all = Vec::new();
        self.each(Shard::ALL, 0..self.members, observer, &mut |place, record| {
            all.push(record);
            progress(place + 1);
            ControlFlow::Continue(())
        })?;
        let (done, members) = (all.len() as u64, self.members);
        match self.deadline.passed() {
            _ if done == members => Ok(all),
            Some(limit) if !observer.is_stopped() => Err(SweepError::Ended { done, members, limit }),
            _ => Err(SweepError::Interrupted { done, members }),
        }
    }

    /// Compares the first member, a member in the middle and the last member with a second derivation of
    /// each.
    ///
    /// # Errors
    /// [`RunError::Verify`] if a second derivation disagrees.
    pub fn vouched(&self) -> Result<(), RunError> {
        self.work.vouched()
    }

    /// The title of the model.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The units that the text of the model names, each after its quantity.
    pub fn units(&self) -> &[(String, String)] {
        &self.units
    }

    /// The columns of the sweep's table.
    pub fn sweep_columns(&self) -> &SweepColumns {
        &self.sweep_columns
    }

    /// Whether the members are drawn at random.
    pub fn is_random(&self) -> bool {
        self.is_random
    }

    /// Labelled lines that describe the work to be done.
    pub fn said(&self) -> Vec<(&'static str, String)> {
        self.work.said()
    }

    /// Remarks on the work that was done, which are printed after the time it took.
    pub fn done(&self) -> String {
        self.work.done()
    }

    /// An error unless a picture of these columns can be drawn.
    ///
    /// # Errors
    /// [`SweepError::Drawn`]
    pub fn drawable(&self, columns: &[String]) -> Result<(), SweepError> {
        picture::check(&self.sweep_columns, columns, &self.counts, self.is_random).map_err(SweepError::Drawn)
    }

    /// The numbers of the columns that are written where some are wanted.
    ///
    /// # Errors
    /// [`RunError::Column`]
    pub fn written(&self, wanted: &[String]) -> Result<Vec<usize>, RunError> {
        Ok(self.sweep_columns.written(wanted)?)
    }

    /// The journal beside the table with this path: a new one, or the one that the same sweep, or the same
    /// shard of it, left behind.
    ///
    /// # Errors
    /// [`SweepError`] if it belongs to another sweep or is in use.
    pub fn journal(&self, table: &Path, shard: Option<Shard>) -> Result<Journal, SweepError> {
        match shard {
            Some(shard) => {
                let header = self.header.clone();
                let header = shards::described(header, shard, self.members, &self.title, &self.sweep_columns);
                Journal::open(shard.beside(table), shard, &header)
            }
            None => Journal::open(Journal::beside(table), Shard::ALL, &self.header),
        }
    }

    /// Computes the members that are not in the journal.
    ///
    /// # Errors
    /// [`RunError`]; finished members are kept.
    pub fn run(&self, journal: &mut Journal, observer: &dyn Observer) -> Result<Swept, RunError> {
        let shard = journal.shard();
        let (members, before) = (shard.members(self.members), journal.tally().done);
        let start = Instant::now();
        let mut progress = observer.members(before, members);
        let mut kept = Ok(());
        let shared = Mutex::new(&mut *journal);
        let ending = Journal::while_writing(&shared, || {
            self.each(shard, before..members, observer, &mut |place, record| {
                let mut journal = shared.lock().unwrap_or_else(PoisonError::into_inner);
                let checked = self.sweep_columns.check(&record).map_err(SweepError::from);
                kept = checked.and_then(|()| journal.append(&record));
                progress(place + 1);
                if kept.is_err() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
        });
        drop(progress);
        kept.and(journal.flush())?;
        let done = journal.tally().done;
        if ending? == Ending::Stopped && done < members {
            return Err(match self.deadline.passed() {
                Some(limit) if !observer.is_stopped() => SweepError::Ended { done, members, limit },
                _ => SweepError::Interrupted { done, members },
            }
            .into());
        }
        Ok(Swept { before, tally: journal.tally().clone(), wall: start.elapsed() })
    }

    /// Passes the records of the members of a shard at these places to `take`, in order, until `take` breaks.
    fn each(
        &self,
        shard: Shard,
        places: Range<u64>,
        observer: &dyn Observer,
        take: &mut dyn FnMut(u64, Record) -> ControlFlow<()>,
    ) -> Result<Ending, SweepError> {
        let row = 8 * self.work.members().columns().len() * self.work.rows();
        let window = NonZeroUsize::new((WAITING / row.max(1)).min(MOST_WAITING)).unwrap_or(NonZeroUsize::MIN);
        let mut ensemble = Ensemble::new().window(window).stopped_by(observer.stop());
        if let Some(threads) = self.threads {
            ensemble = ensemble.threads(threads);
        }
        let mut consume = |place, record: Result<Option<_>, Panicked>| {
            let record = record.unwrap_or_else(|panicked| {
                Some(self.work.members().panicked(shard.member(place), &panicked.message))
            });
            // A member without a record was interrupted, or ended by a limit.
            let Some(record) = record else { return ControlFlow::Break(()) };
            match take(place, record) {
                ControlFlow::Continue(()) if !observer.is_stopped() => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            }
        };
        Ok(self.work.records(&ensemble, shard, places, &mut consume)?)
    }
}

/// The requested work, and everything on which it depends.
fn begun(
    wishes: &SweepWishes,
    model: Model,
    design: Design,
    observer: &dyn Observer,
) -> Result<(Box<dyn Work>, Identity), RunError> {
    Ok(match wishes.of {
        SweepOf::Run => {
            look(&model, observer)?;
            let plan = Plan::of(&model, &wishes.run)?;
            let identity = identity::of_motion(&model, &plan);
            let all_rows = wishes.run.samples.is_some();
            let threads = workers(wishes.threads);
            (Box::new(Motions::new(model, design, plan, all_rows, threads, None)?), identity)
        }
        SweepOf::Linearize => {
            let state = &wishes.state;
            let identity = identity::of_work(&model, Linearizations::depends_on(state));
            (Box::new(Linearizations::new(model, design, state, observer)?), identity)
        }
        SweepOf::Check => {
            look(&model, observer)?;
            let identity = identity::of_work(&model, []);
            (Box::new(Checks::new(model, design)), identity)
        }
    })
}

fn workers(threads: Option<NonZeroUsize>) -> usize {
    let available = || thread::available_parallelism().ok();
    threads.or_else(available).map_or(1, NonZeroUsize::get)
}

/// An error if the text of the model is wrong. A model that contradicts itself is not refused, since it may
/// be consistent with the values of a member.
fn look(model: &Model, observer: &dyn Observer) -> Result<(), RunError> {
    let graph = model.graph();
    match model.assemble(&graph) {
        Ok(assembly) => {
            say_dropped(&assembly, observer);
            Ok(())
        }
        Err(error) if error.category() == Category::Inconsistent => Ok(()),
        Err(error) => Err(error.into()),
    }
}

/// Everything on which the result depends.
fn header(depends_on: Identity, variation: &Variation, wishes: &SweepWishes, observes: bool) -> Identity {
    let list = |items: &mut dyn Iterator<Item = String>| items.collect::<Vec<_>>().join(" ");
    let number = |number: Option<String>| number.unwrap_or_else(|| "none".to_owned());
    let entries = [
        ("--vary", list(&mut variation.vary.iter().map(ToString::to_string))),
        ("--random", list(&mut variation.random.iter().map(ToString::to_string))),
        ("--members", number(variation.members.map(|members| members.to_string()))),
        ("--seed", variation.seed.to_string()),
        ("--outputs", if observes { "reactions" } else { "none" }.to_owned()),
        ("--rows", number(wishes.run.samples.map(|rows| rows.to_string()))),
    ];
    let mut header = depends_on;
    header.insert(0, ("--of".to_owned(), wishes.of.word().to_owned()));
    header.extend(entries.map(|(name, value)| (name.to_owned(), value)));
    header
}
