//! The terminal as whoever waits for a run.

use std::error::Error;
use std::sync::atomic::AtomicBool;

use pc_run::observer::{Observer, Progress};

use crate::error::with_causes;
use crate::terminal::text::say;
use crate::terminal::{interrupt, progress, progress_of_members};

/// Shows bars and remarks on standard error; Ctrl-C ends a run once its motion has begun.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terminal;

impl Observer for Terminal {
    fn stop(&self) -> &AtomicBool {
        interrupt::flag()
    }

    fn motion(&self, (t_start, t_end): (f64, f64)) -> Progress<'_, f64> {
        interrupt::catch();
        let mut bar = progress::Progress::new(t_start, t_end);
        Box::new(move |t| bar.at(t))
    }

    fn members(&self, before: u64, members: u64) -> Progress<'_, u64> {
        interrupt::catch();
        let mut bar = progress_of_members::Progress::new(before, members);
        Box::new(move |done| bar.at(done))
    }

    fn remark(&self, remark: &str) {
        say(format_args!("note: {}\n", remark.replace('\n', "\n      ")));
    }

    fn trouble(&self, error: &dyn Error) {
        say(format_args!("{}\n", with_causes(error)));
    }
}
