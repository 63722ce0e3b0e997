//! `cargo xtask book`: the pages of `docs` as a book for a browser, in target/book.

use crate::cargo_tools::CargoTool;
use crate::command::{announce_and_run, workspace_root};
use crate::error::Error;

const MDBOOK: CargoTool = CargoTool { name: "mdbook", version: "~0.5" };

/// Builds the book, if there is an mdbook to build it with. What its pages show is tried by the tests of `pc-cli`.
pub(crate) fn run() -> Result<(), Error> {
    if !MDBOOK.is_installed() {
        return Ok(());
    }
    announce_and_run(MDBOOK.command().args(["build", "docs"]).current_dir(workspace_root()))
}
