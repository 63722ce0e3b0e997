//! What a program of tests says while it runs: verdicts, times, and which tests are at work.
//!
//! The harness of Rust starts tests in the order of its list, as many at a time as it has threads, and names each when it has
//! ended. From this follows which ones are at work, and when each was begun: the next one of the list begins when one ends.

use std::time::{Duration, Instant};

/// The tests of a program, with what is known of each.
pub(crate) struct Progress {
    tests: Vec<Test>,
    begun: usize,
}

struct Test {
    name: String,
    from: Option<Instant>,
    took: Option<Duration>,
}

impl Progress {
    /// At the start of a program with the tests of `list`, the output of `--list --format terse`.
    pub(crate) fn new(list: &str, threads: usize, now: Instant) -> Progress {
        let names = list.lines().filter_map(|line| line.strip_suffix(": test"));
        let tests = names.map(|name| Test { name: name.to_owned(), from: None, took: None }).collect();
        let mut progress = Progress { tests, begun: 0 };
        (0..threads).for_each(|_| progress.begin(now));
        progress
    }

    fn begin(&mut self, now: Instant) {
        if let Some(test) = self.tests.get_mut(self.begun) {
            test.from = Some(now);
            self.begun += 1;
        }
    }

    /// Takes a line of the output, which may tell that a test has ended.
    pub(crate) fn line(&mut self, line: &str, now: Instant) {
        let Some(name) = ended(line) else { return };
        let at_work = self.tests.iter_mut().find(|test| test.took.is_none() && test.name == name);
        if let Some((test, from)) = at_work.and_then(|test| test.from.map(|from| (test, from))) {
            test.took = Some(now - from);
            self.begin(now);
        }
    }

    /// The tests that have begun and not ended.
    pub(crate) fn at_work(&self) -> Vec<String> {
        let at_work = self.tests[..self.begun].iter().filter(|test| test.took.is_none());
        at_work.map(|test| test.name.clone()).collect()
    }

    /// The tests that have ended, with their times.
    pub(crate) fn times(&self) -> impl Iterator<Item = (Duration, &str)> {
        self.tests.iter().filter_map(|test| Some((test.took?, test.name.as_str())))
    }
}

/// The test that a line says has ended.
fn ended(line: &str) -> Option<&str> {
    let (name, verdict) = line.strip_prefix("test ")?.rsplit_once(" ... ")?;
    let known = ["ok", "FAILED", "ignored"].iter().any(|known| verdict.starts_with(known));
    known.then(|| name.strip_suffix(" - should panic").unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_begin_in_order_when_others_end() {
        let start = Instant::now();
        let at = |seconds| start + Duration::from_secs(seconds);
        let list = "a: test\nb::c: test\nd: test\ne: benchmark\nf: test\n";
        let mut progress = Progress::new(list, 2, start);
        assert_eq!(progress.at_work(), ["a", "b::c"]);
        progress.line("test b::c - should panic ... ok", at(3));
        assert_eq!(progress.at_work(), ["a", "d"]);
        progress.line("test d ... ignored, for a reason", at(3));
        progress.line("running 4 tests", at(4));
        progress.line("test result: ok. 4 passed", at(4));
        progress.line("test a ... FAILED", at(5));
        assert_eq!(progress.at_work(), ["f"]);
        let times: Vec<_> = progress.times().map(|(took, name)| (took.as_secs(), name)).collect();
        assert_eq!(times, [(5, "a"), (3, "b::c"), (0, "d")]);
    }
}
