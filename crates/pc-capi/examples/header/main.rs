//! Writes `include/pc.h` and `abi/interface.txt`: `cargo xtask header`.

mod generate;
mod interface;

use std::fs;
use std::io::{Error, Result};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    match write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Both or, where programs would break, neither.
fn write() -> Result<()> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (header, path) = (generate::header(), here.join("abi/interface.txt"));
    let new = interface::interface(&header, pc::PC_ABI_VERSION);
    interface::replaces(&new, &fs::read_to_string(&path)?).map_err(Error::other)?;
    fs::write(here.join("../../include/pc.h"), header)?;
    fs::write(path, new)
}
