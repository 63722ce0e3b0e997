//! `cargo xtask scripts`: bundles the scripts of pages from their modules. The bundles are committed, so that only who
//! changes a script needs Node.

use std::process::Command;

use crate::command::{announce_and_run, workspace_root};
use crate::error::Error;

/// The directories with a `package.json` and its lock, whose `build` writes `dist`.
const PLACES: [&str; 3] = ["crates/pc-report/viewer", "crates/pc-report/plots", "crates/pc-cli/live"];

pub(crate) fn run() -> Result<(), Error> {
    for place in PLACES {
        for arguments in [&["ci", "--no-audit", "--no-fund"][..], &["run", "build"]] {
            announce_and_run(Command::new("npm").args(arguments).current_dir(workspace_root().join(place)))?;
        }
    }
    Ok(())
}
