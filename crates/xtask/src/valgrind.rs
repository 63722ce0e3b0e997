//! `cargo xtask valgrind`: the tests of `pc-solve` that leave the paths which go well, under valgrind.

use crate::command::{announce_and_run, cargo};
use crate::error::Error;
use crate::setup;
use crate::tools::Machine;

/// Failures, panics and events: where objects of SUNDIALS are given up half-way.
const TESTS: [&str; 8] = [
    "failures::",
    "event_failures::",
    "linear_failures::",
    "sensitivity_failures::",
    "panics::",
    "linear::",
    "events::",
    "inequalities::",
];

/// Cargo runs each test program by this; its last error makes the exit code.
const RUNNER: &str = "target.'cfg(all())'.runner = ['valgrind', '--error-exitcode=9', '--leak-check=full', \
                      '--errors-for-leak-kinds=definite,indirect']";

/// Fails at the first program that reads or writes where it must not, or loses memory.
///
/// Tests run one at a time: valgrind has one processor for all threads.
pub(crate) fn run() -> Result<(), Error> {
    if !Machine::this().has_program("valgrind") {
        return Err(Error::Missing {
            tools: vec!["valgrind"],
            remedy: "it comes in the package `valgrind` of most systems".to_owned(),
        });
    }
    setup::everything()?;
    let tests =
        ["--config", RUNNER, "test", "--package", "pc-solve", "--test", "it", "--", "--test-threads=1"];
    announce_and_run(cargo(&tests).args(TESTS))
}
