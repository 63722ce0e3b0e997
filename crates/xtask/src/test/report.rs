//! What was done, and what took how long: the last page of the output.

use std::fmt;
use std::time::Duration;

/// The number of tests that are named as slow.
const SLOWEST: usize = 10;

/// How a stage ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Passed,
    Failed,
    Skipped,
    /// Nothing that it tries has changed.
    Untouched,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Verdict::Passed => "passed",
            Verdict::Failed => "failed",
            Verdict::Skipped => "skipped",
            Verdict::Untouched => "untouched",
        })
    }
}

/// The stages with their times, and those of the tests.
#[derive(Debug, Default)]
pub(crate) struct Report {
    stages: Vec<(String, Verdict, Duration)>,
    tests: Vec<(Duration, String)>,
    /// What could not be tried, and why.
    pub(crate) skipped: Vec<String>,
}

impl Report {
    /// A stage that is over.
    pub(crate) fn stage(&mut self, title: &str, verdict: Verdict, took: Duration) {
        self.stages.push((title.to_owned(), verdict, took));
    }

    /// Tests with their times.
    pub(crate) fn tests(&mut self, tests: Vec<(Duration, String)>) {
        self.tests.extend(tests);
    }
}

/// A time as it stands in tables.
pub(crate) fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\n== stages")?;
        let total: Duration = self.stages.iter().map(|(_, _, took)| *took).sum();
        for (title, verdict, took) in &self.stages {
            writeln!(f, "{:>10}  {verdict:<9}  {title}", seconds(*took))?;
        }
        writeln!(f, "{:>10}  all of it", seconds(total))?;
        let mut slowest: Vec<&(Duration, String)> = self.tests.iter().collect();
        slowest.sort_by(|a, b| b.cmp(a));
        if !slowest.is_empty() {
            writeln!(f, "\n== the slowest tests")?;
        }
        for (took, test) in slowest.into_iter().take(SLOWEST) {
            writeln!(f, "{:>10}  {test}", seconds(*took))?;
        }
        self.skipped.iter().try_for_each(|missing| writeln!(f, "skipped: {missing}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_stand_in_order_and_tests_by_their_times() {
        let mut report = Report::default();
        report.stage("format", Verdict::Passed, Duration::from_millis(3040));
        report.stage("FMUs", Verdict::Skipped, Duration::from_secs(1));
        report.tests(vec![
            (Duration::from_secs(1), "pc-expr it: a".to_owned()),
            (Duration::from_secs(2), "pc-expr it: b".to_owned()),
        ]);
        report.skipped.push("FMUs: no Python".to_owned());
        let expected = "
== stages
     3.0 s  passed     format
     1.0 s  skipped    FMUs
     4.0 s  all of it

== the slowest tests
     2.0 s  pc-expr it: b
     1.0 s  pc-expr it: a
skipped: FMUs: no Python
";
        assert_eq!(report.to_string(), expected);
    }
}
