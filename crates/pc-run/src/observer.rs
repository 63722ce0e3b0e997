//! Whoever is waiting for a run: they may end the run, are told about its progress, and are given remarks on it.

use std::error::Error;
use std::sync::atomic::{AtomicBool, Ordering};

/// A function that is told how far a motion or a sweep has come, until it is dropped.
pub type Progress<'o, T> = Box<dyn FnMut(T) + 'o>;

static NEVER: AtomicBool = AtomicBool::new(false);

/// Whoever is waiting for a run. Every method has a default, which acts as if nobody were waiting.
pub trait Observer: Sync {
    /// The flag that ends a run once it is true, for example after Ctrl-C; the results so far are kept.
    fn stop(&self) -> &AtomicBool {
        &NEVER
    }

    /// Whether the run should end.
    fn is_stopped(&self) -> bool {
        self.stop().load(Ordering::Relaxed)
    }

    /// Returns a function that is told the times reached by an integration over `span`.
    fn motion(&self, _span: (f64, f64)) -> Progress<'_, f64> {
        Box::new(|_| ())
    }

    /// Returns a function that is told how many of the `members` of a sweep are finished; `before` of them
    /// were finished when it began.
    fn members(&self, _before: u64, _members: u64) -> Progress<'_, u64> {
        Box::new(|_| ())
    }

    /// Is given a remark on the equations or the run, in sentences that may extend over several lines.
    fn remark(&self, _remark: &str) {}

    /// Is told about an error that does not end the run.
    fn trouble(&self, _error: &dyn Error) {}
}

/// Nobody is waiting: nothing ends a run from outside, and it reports nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nobody;

impl Observer for Nobody {}
