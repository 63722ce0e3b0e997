//! The progress bar of a long run.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::terminal::text::short;

/// A shorter run needs no bar.
const PATIENCE: Duration = Duration::from_millis(500);
/// Steps between two looks at the clock.
const STRIDE: u32 = 64;
const LENGTH: u64 = 1000;

/// Shows how far an integration is, on standard error if that is a terminal.
pub(crate) struct Progress {
    range: (f64, f64),
    start: Instant,
    terminal: bool,
    steps: u32,
    bar: Option<ProgressBar>,
}

impl Progress {
    pub(crate) fn new(t_start: f64, t_end: f64) -> Progress {
        let terminal = std::io::stderr().is_terminal();
        Progress { range: (t_start, t_end), start: Instant::now(), terminal, steps: 0, bar: None }
    }

    /// Notes that a step has ended at `t`.
    pub(crate) fn at(&mut self, t: f64) {
        self.steps = (self.steps + 1) % STRIDE;
        if !self.terminal || self.steps != 0 || self.start.elapsed() < PATIENCE {
            return;
        }
        let (from, to) = self.range;
        let done = (t - from) / (to - from);
        let left = self.start.elapsed().as_secs_f64() * (1.0 - done).max(0.0) / done;
        let bar = self.bar.get_or_insert_with(|| {
            let style = ProgressStyle::with_template("  {bar:36} {percent:>3} %  {msg}");
            ProgressBar::new(LENGTH).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        bar.set_position((done * LENGTH as f64) as u64);
        bar.set_message(format!("t = {}, {left:.0} s left", short(t, 5)));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
