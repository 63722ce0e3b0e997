//! The check that an integration makes progress.
//!
//! Steps may become so short, without any of them failing, that a motion would take years. This
//! becomes apparent long before the limit on steps is reached: [`STEPS`] steps that cover less than
//! [`LEAST`] of the remaining time would have to be followed by 10¹³ similar steps.

/// The number of steps that are judged together.
const STEPS: u64 = 10_000;
/// The least fraction of the remaining time that these steps must cover.
const LEAST: f64 = 1e-9;

/// The steps since a certain time, called the mark.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Pace {
    steps: u64,
    mark: f64,
    limited: u64,
    /// Whether the mark is a time that the integration has reached.
    is_known: bool,
}

/// Several steps that together have hardly advanced the time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crawl {
    pub(crate) steps: u64,
    /// The time by which these steps advanced.
    pub(crate) by: f64,
    /// Whether most of these steps were shortened because of explicit dependence on time.
    pub(crate) shortened: bool,
}

impl Pace {
    /// Notes a step to `t` towards `end`, with the number of shortened steps so far; returns the
    /// latest steps if these have hardly advanced the time.
    pub(crate) fn note(&mut self, t: f64, end: f64, limited: impl FnOnce() -> u64) -> Option<Crawl> {
        self.steps += 1;
        if self.steps < STEPS {
            return None;
        }
        let now = Pace { steps: 0, mark: t, limited: limited(), is_known: true };
        let Pace { steps, mark, limited: before, is_known } = std::mem::replace(self, now);
        let (by, rest) = ((t - mark).abs(), (end - mark).abs());
        let shortened = 2 * now.limited.saturating_sub(before) >= steps;
        (is_known && by < LEAST * rest).then_some(Crawl { steps, by, shortened })
    }
}
