//! Counting tests in the output of `cargo test`.

use std::fmt;

/// Sums over the test binaries and the documentation tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Counts {
    pub(crate) passed: u64,
    pub(crate) failed: u64,
    pub(crate) skipped: u64,
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed, {} skipped", self.passed, self.failed, self.skipped)
    }
}

impl Counts {
    /// Tests that were executed.
    pub(crate) fn executed(self) -> u64 {
        self.passed + self.failed
    }

    /// Adds the summary of one binary; any other line leaves the counts as they are:
    ///
    /// `test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.01s`
    pub(crate) fn add_line(&mut self, line: &str) {
        let line = without_colours(line);
        let Some((_, summary)) =
            line.trim_start().strip_prefix("test result: ").and_then(|s| s.split_once(". "))
        else {
            return;
        };
        for part in summary.split("; ") {
            let Some((number, kind)) = part.split_once(' ') else { continue };
            let Ok(number) = number.parse::<u64>() else { continue };
            match kind {
                "passed" => self.passed += number,
                "failed" => self.failed += number,
                "ignored" => self.skipped += number,
                _ => {}
            }
        }
    }
}

/// The line without terminal escapes, `ESC [ … m`.
fn without_colours(line: &str) -> String {
    let mut plain = String::with_capacity(line.len());
    let mut rest = line;
    while let Some((before, escape)) = rest.split_once("\u{1b}[") {
        plain.push_str(before);
        rest = escape.split_once('m').map_or("", |(_, after)| after);
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    const OUTPUT: &str = "
running 3 tests
test counts::tests::a ... ok
test counts::tests::b ... ok
test counts::tests::c ... ignored

test result: ok. 2 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.01s

running 2 tests
test motion ... FAILED
test result: FAILED. 1 passed; 1 failed; 0 ignored; 0 measured; 7 filtered out; finished in 12.30s

   Doc-tests pc_expr
test result: \u{1b}[32mok\u{1b}[0m. 40 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out; finished in 0.30s
all doctests ran in 0.31s; merged doctests compilation took 0.28s";

    const EXPECTED: Counts = Counts { passed: 43, failed: 1, skipped: 3 };

    fn counts_of(output: &str) -> Counts {
        let mut counts = Counts::default();
        output.lines().for_each(|line| counts.add_line(line));
        counts
    }

    #[test]
    fn binaries_and_doctests_are_summed() {
        assert_eq!(counts_of(OUTPUT), EXPECTED);
    }

    #[test]
    fn a_line_that_only_resembles_a_summary_is_not_one() {
        assert_eq!(counts_of("the test result: ok. 5 passed; 1 failed\n"), Counts::default());
        assert_eq!(counts_of("test result: unknown\n"), Counts::default());
    }

    #[test]
    fn the_closing_line() {
        let counts = Counts { passed: 123, failed: 0, skipped: 2 };
        assert_eq!(counts.to_string(), "123 passed, 0 failed, 2 skipped");
        assert_eq!(counts.executed(), 123);
    }
}
