//! The stages around the test programs.

use std::env;
use std::process::Command;

use super::limited::{self, Ending};
use super::usual;
use crate::cargo_tools::CargoTool;
use crate::command::{announce_and_run, cargo};
use crate::error::{Error, SKIPPED};
use crate::{attack, book, c_examples, fmu, fuzz_c, python, setup};

const DENY: CargoTool = CargoTool { name: "cargo-deny", version: "~0.20" };

/// A part of the tests.
pub(crate) struct Stage {
    pub(crate) title: &'static str,
    /// Seconds on two cores that do nothing else, from an empty target directory.
    usual: u64,
    /// The packages that it tries; all of them where none are named.
    pub(crate) packages: &'static [&'static str],
    work: fn() -> Result<(), Error>,
}

/// Seconds of the build of everything.
pub(crate) const BUILD: u64 = 500;

/// What comes before the test programs.
pub(crate) const BEFORE: [Stage; 4] = [
    Stage { title: "set-up", usual: 120, packages: &[], work: setup::everything },
    Stage { title: "format", usual: 5, packages: &[], work: format },
    Stage { title: "lints", usual: 160, packages: &[], work: lints },
    Stage {
        title: "lints without SUNDIALS",
        usual: 40,
        packages: &["pc-solve"],
        work: lints_without_sundials,
    },
];

/// The examples in the documentation.
pub(crate) const DOCUMENTATION_TESTS: Stage =
    Stage { title: "documentation tests", usual: 150, packages: &[], work: documentation_tests };

/// What comes after them, and is made of what they have built.
pub(crate) const AFTER: [Stage; 8] = [
    Stage { title: "attack", usual: 170, packages: &["pc-cli"], work: attack::quick },
    Stage { title: "C examples", usual: 120, packages: &["pc-capi"], work: c_examples::quick },
    Stage { title: "C calls", usual: 60, packages: &["pc-capi"], work: fuzz_c::quick },
    Stage { title: "documentation", usual: 110, packages: &[], work: documentation },
    Stage { title: "book", usual: 30, packages: &[], work: book::run },
    Stage { title: "licences", usual: 200, packages: &[], work: licences },
    Stage { title: "FMUs", usual: 60, packages: &["pc-cli"], work: fmu::quick },
    Stage { title: "Python package", usual: 200, packages: &["pc-python"], work: python::quick },
];

impl Stage {
    /// Does the work in a process group of its own, within five times its usual time; its lines go to the terminal and to `sink`.
    ///
    /// # Errors
    /// [`Error::Failed`], [`Error::TimeLimit`], and [`Error::Unavailable`] with the last line that was said.
    pub(crate) fn run(&self, mut sink: impl FnMut(&str)) -> Result<(), Error> {
        let start = |source| Error::Start { program: "xtask".to_owned(), source };
        let mut command = Command::new(env::current_exe().map_err(start)?);
        command.args(["stage", self.title]);
        let limit = usual::limit(self.usual);
        let mut last = String::new();
        let ending = limited::run(&mut command, limit, None, |line, _| {
            println!("{line}");
            sink(line);
            line.clone_into(&mut last);
        })?;
        match ending {
            Ending::Exited(status) if status.success() => Ok(()),
            Ending::Exited(status) if status.code() == Some(SKIPPED.into()) => {
                Err(Error::Unavailable { what: last.trim_start_matches("xtask: ").to_owned() })
            }
            Ending::Exited(status) => Err(Error::Failed { command: self.title.to_owned(), status }),
            Ending::Killed => Err(Error::time_limit(self.title.to_owned(), limit, vec![last])),
        }
    }
}

/// Does the work of one stage, here.
///
/// # Errors
/// [`Error::Usage`] where there is no such stage, else what it says.
pub(crate) fn run_alone(title: &str) -> Result<(), Error> {
    let stages = || BEFORE.iter().chain([&DOCUMENTATION_TESTS]).chain(&AFTER);
    let known = || stages().map(|stage| format!("`{}`", stage.title)).collect::<Vec<_>>().join(", ");
    let unknown = || Error::Usage { message: format!("there is no stage `{title}`; there are {}", known()) };
    (stages().find(|stage| stage.title == title).ok_or_else(unknown)?.work)()
}

fn format() -> Result<(), Error> {
    announce_and_run(&mut cargo(&["fmt", "--all", "--check"]))
}

fn lints() -> Result<(), Error> {
    announce_and_run(&mut cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))
}

fn lints_without_sundials() -> Result<(), Error> {
    let alone = ["clippy", "-p", "pc-solve", "--lib", "--no-default-features", "--", "-D", "warnings"];
    announce_and_run(&mut cargo(&alone))
}

fn documentation_tests() -> Result<(), Error> {
    announce_and_run(&mut cargo(&["test", "--workspace", "--doc", "--no-fail-fast"]))
}

fn documentation() -> Result<(), Error> {
    let mut doc = cargo(&["doc", "--workspace", "--no-deps"]);
    announce_and_run(doc.env("RUSTDOCFLAGS", "-D warnings"))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_called_by_their_titles() {
        let message = run_alone("fromat").unwrap_err().to_string();
        assert!(
            message.starts_with("there is no stage `fromat`; there are `set-up`, `format`, "),
            "{message}"
        );
    }
}
