//! `cargo xtask book`: the pages of `docs` as a book for a browser, in target/book.
//!
//! mdBook is the one that is installed, or a wheel of PyPI with a known checksum, which takes seconds where a build takes minutes.
//! `links` then sees to it that every link of the built pages leads somewhere.

mod links;

use std::path::Path;
use std::process::Command;

use crate::cargo_tools::CargoTool;
use crate::command::{announce_and_run, target_directory, workspace_root};
use crate::error::Error;

const MDBOOK: CargoTool = CargoTool { name: "mdbook", version: "~0.5" };

/// The wheel, with its checksum on each system.
const WHEEL: &str = "docs/book/requirements.txt";

/// Builds the book, if there is an mdbook to build it with. What its pages show is tried by the tests of `pc-cli`.
///
/// # Errors
/// What mdbook says of the pages, and [`Error::Links`].
pub(crate) fn run() -> Result<(), Error> {
    let place = target_directory()?.join("book");
    let Some(mut mdbook) = mdbook(&place) else {
        println!("skipped: the book");
        return Ok(());
    };
    let pages = place.join("docs");
    announce_and_run(mdbook.args(["build", "docs", "--dest-dir"]).arg(&pages).current_dir(workspace_root()))?;
    let count = links::settle(&workspace_root(), &place, "docs")?;
    println!("{}: {count} links lead somewhere", pages.join("index.html").display());
    Ok(())
}

/// The program, installed below `place` if it is nowhere else; none where it cannot be had.
fn mdbook(place: &Path) -> Option<Command> {
    if MDBOOK.is_installed() {
        return Some(MDBOOK.command());
    }
    let environment = place.join("mdbook");
    let program = environment.join("bin").join(MDBOOK.name);
    if !program.is_file() {
        let fetched = announce_and_run(Command::new("python3").args(["-m", "venv"]).arg(&environment))
            .and_then(|()| announce_and_run(&mut fetch(&environment)));
        if let Err(error) = fetched {
            println!("no wheel of mdbook: {error}");
            return None;
        }
    }
    Some(Command::new(program))
}

/// Only a wheel with a checksum of the list, and nothing that is compiled.
fn fetch(environment: &Path) -> Command {
    let mut pip = Command::new(environment.join("bin/python"));
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"])
        .args(["--require-hashes", "--no-deps", "--only-binary", ":all:", "-r", WHEEL])
        .current_dir(workspace_root());
    pip
}
