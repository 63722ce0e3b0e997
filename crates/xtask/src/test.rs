//! `cargo xtask test`: everything that has to hold before a change goes in.

use std::process::Command;
use std::time::{Duration, Instant};

use crate::cargo_tools::CargoTool;
use crate::command::{announce_and_run, announce_and_tee, cargo};
use crate::counts::{Counter, Counts};
use crate::error::Error;
use crate::{attack, book, c_examples, fmu, setup};

const DENY: CargoTool = CargoTool { name: "cargo-deny", version: "~0.20" };

/// Runs the stages in order and stops at the first that fails.
///
/// The last line on standard output is the sum over all test binaries; `quick` stops after the tests.
pub(crate) fn run(quick: bool) -> Result<(), Error> {
    let start = Instant::now();
    stage("set-up", setup::everything)?;
    cargo_stage("format", &mut cargo(&["fmt", "--all", "--check"]))?;
    cargo_stage("lints", &mut cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    let without_sundials =
        ["clippy", "-p", "pc-solve", "--lib", "--no-default-features", "--", "-D", "warnings"];
    cargo_stage("lints without SUNDIALS", &mut cargo(&without_sundials))?;
    let counts = tests()?;
    let mut without = Vec::new();
    if !quick {
        stage("attack", attack::quick)?;
        stage("C examples", c_examples::quick)?;
        let mut doc = cargo(&["doc", "--workspace", "--no-deps"]);
        cargo_stage("documentation", doc.env("RUSTDOCFLAGS", "-D warnings"))?;
        stage("book", book::run)?;
        stage("licences", licences)?;
        without.extend(stage_if_possible("FMUs", fmu::quick)?);
    }
    println!("\nall of it: {}", seconds(start.elapsed()));
    for missing in without {
        println!("skipped: {missing}");
    }
    println!("{counts}");
    Ok(())
}

/// Unit, integration and documentation tests of all crates; a failure in one does not keep the others from running.
fn tests() -> Result<Counts, Error> {
    let mut counter = Counter::default();
    let mut command = cargo(&["test", "--workspace", "--no-fail-fast"]);
    let outcome = stage("tests", || announce_and_tee(&mut command, |piece| counter.feed(piece)));
    let counts = counter.finish();
    match outcome {
        Err(failure) => Err(Error::Tests { counts, failure: Box::new(failure) }),
        Ok(()) if counts.executed() == 0 => Err(Error::NoTests),
        Ok(()) => Ok(counts),
    }
}

/// Licences, sources and duplicates of the dependencies, by `deny.toml`.
///
/// Advisories are left out: they need a database from the network and change without a change of ours.
fn licences() -> Result<(), Error> {
    if !DENY.is_available()? {
        return Ok(());
    }
    announce_and_run(&mut cargo(&["deny", "check", "--hide-inclusion-graph", "licenses", "bans", "sources"]))
}

fn cargo_stage(title: &str, command: &mut Command) -> Result<(), Error> {
    stage(title, || announce_and_run(command))
}

/// Header, work, time; the time of a failed stage as well.
fn stage(title: &str, work: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
    println!("\n== {title}");
    let start = Instant::now();
    let outcome = work();
    let verdict = match &outcome {
        Ok(()) => "passed",
        Err(Error::Unavailable { .. }) => "skipped",
        Err(_) => "failed",
    };
    println!("== {title} {verdict} in {}", seconds(start.elapsed()));
    outcome
}

/// A stage that needs what a machine need not have: then it is said what is missing.
fn stage_if_possible(title: &str, work: impl FnOnce() -> Result<(), Error>) -> Result<Option<String>, Error> {
    match stage(title, work) {
        Ok(()) => Ok(None),
        Err(Error::Unavailable { what }) => Ok(Some(format!("{title}: {what}"))),
        Err(error) => Err(error),
    }
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said_and_what_is_wrong_fails() {
        let unavailable = || Err(Error::Unavailable { what: "no Python".to_owned() });
        let said = stage_if_possible("FMUs", unavailable).unwrap();
        assert_eq!(said.as_deref(), Some("FMUs: no Python"));
        assert_eq!(stage_if_possible("FMUs", || Ok(())).unwrap(), None);
        assert!(stage_if_possible("FMUs", || Err(Error::NoTests)).is_err());
    }
}
