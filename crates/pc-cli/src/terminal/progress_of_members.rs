//! The progress bar of a sweep.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// A shorter sweep needs no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// Shows how many members are finished, on standard error if that is a terminal.
pub(super) struct Progress {
    start: Instant,
    /// Members finished by an earlier run.
    from: u64,
    members: u64,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(super) fn new(from: u64, members: u64) -> Progress {
        Progress { start: Instant::now(), from, members, bar: None }
    }

    /// Notes that `done` members are finished.
    pub(super) fn at(&mut self, done: u64) {
        let elapsed = self.start.elapsed();
        if elapsed < PATIENCE {
            return;
        }
        let bar = self.bar.get_or_insert_with(|| {
            let style = ProgressStyle::with_template("  {bar:36} {pos}/{len}  {msg}");
            ProgressBar::new(self.members).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        let rate = (done - self.from) as f64 / elapsed.as_secs_f64();
        bar.set_position(done);
        bar.set_message(format!("{rate:.0}/s, {:.0} s left", (self.members - done) as f64 / rate));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
