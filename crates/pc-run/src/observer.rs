//! Whoever waits for a run: they may end it, and are told of its progress and of remarks on it.

use std::error::Error;
use std::sync::atomic::{AtomicBool, Ordering};

/// Is told how far a motion or a sweep has come, until it is dropped.
pub type Progress<'o, T> = Box<dyn FnMut(T) + 'o>;

static NEVER: AtomicBool = AtomicBool::new(false);

/// Whoever waits for a run. Every method has a default, as if nobody waited.
pub trait Observer: Sync {
    /// The flag that ends a run once it is true, for example by Ctrl-C; what was reached is kept.
    fn stop(&self) -> &AtomicBool {
        &NEVER
    }

    /// Whether the run is to end.
    fn is_stopped(&self) -> bool {
        self.stop().load(Ordering::Relaxed)
    }

    /// Is told the times that an integration over `span` reaches.
    fn motion(&self, _span: (f64, f64)) -> Progress<'_, f64> {
        Box::new(|_| ())
    }

    /// Is told how many members of a sweep of `members` are finished; `before` of them were finished when it
    /// began.
    fn members(&self, _before: u64, _members: u64) -> Progress<'_, u64> {
        Box::new(|_| ())
    }

    /// Is told remarks on the equations or the run, in sentences that may have several lines.
    fn remark(&self, _remark: &str) {}

    /// Is told of an error that does not end the run.
    fn trouble(&self, _error: &dyn Error) {}
}

/// Nobody: nothing ends a run from outside, and it reports nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nobody;

impl Observer for Nobody {}
