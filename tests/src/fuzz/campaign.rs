//! Many models, on all cores, in order.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use super::breaks;
use super::examination::{self, Examined, Thoroughness};
use super::program::{Program, Session};
use super::trees;
use super::units::Units;

/// What is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Models over the whole format, but for bodies on joints.
    Models,
    /// Bodies on joints.
    Trees,
    /// Models of several pieces.
    Breaks,
}

impl Subject {
    /// Examines number `index` of a seed.
    pub fn examine(self, seed: u64, index: u64, thoroughness: Thoroughness) -> Examined {
        match self {
            Subject::Models => examination::examine(seed, index, thoroughness),
            Subject::Trees => trees::examine(seed, index, thoroughness),
            Subject::Breaks => breaks::examine(seed, index, thoroughness.limit),
        }
    }
}

/// Which models are examined.
#[derive(Clone, Debug)]
pub struct Campaign {
    /// What they are models of.
    pub subject: Subject,
    /// The seed of all.
    pub seed: u64,
    /// The number of the first.
    pub first: u64,
    /// So many.
    pub count: u64,
    /// Threads that work at the same time.
    pub threads: usize,
    /// Every so many models one is emitted and compiled; 0 for none.
    pub emitted_every: u64,
    /// The program, where its commands are tried.
    pub program: Option<Program>,
    /// Every so many models its commands are tried on one; 0 for none.
    pub program_every: u64,
    /// Every so many models one is run in other units; 0 for none.
    pub units_every: u64,
    /// How long a model may take.
    pub limit: Duration,
}

impl Campaign {
    /// How model number `index` is examined.
    pub fn thoroughness(&self, index: u64) -> Thoroughness {
        let falls = |every: u64| every > 0 && index.is_multiple_of(every);
        let program = self.program.clone().filter(|_| falls(self.program_every));
        let commands = program.map(|program| Session::new(program, self.seed, index));
        let units = falls(self.units_every).then(|| Units::of(self.seed, index));
        Thoroughness { emitted: falls(self.emitted_every), commands, units, limit: self.limit }
    }

    /// What came of the models, in their order, whatever the number of threads; `done` sees each as soon as it is, in
    /// the order in which they end.
    pub fn run(&self, done: impl Fn(u64, &Examined) + Sync) -> Vec<(u64, Examined)> {
        let next = AtomicU64::new(0);
        let results = Mutex::new(Vec::new());
        let work = || {
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                if number >= self.count {
                    return;
                }
                let index = self.first + number;
                let examined = self.subject.examine(self.seed, index, self.thoroughness(index));
                done(index, &examined);
                results.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((index, examined));
            }
        };
        thread::scope(|scope| (0..self.threads.max(1)).for_each(|_| _ = scope.spawn(work)));
        let mut results = results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        results.sort_by_key(|(index, _)| *index);
        results
    }
}
