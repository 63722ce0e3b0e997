//! `cargo xtask header`: writes `include/pc.h` from the sources of the C interface.

use std::fs;

use crate::command::{announce_and_run, cargo, workspace_root};
use crate::error::Error;
use crate::setup;

pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["run", "--package", "pc-capi", "--example", "header"]))
}

fn text() -> Result<String, Error> {
    let path = workspace_root().join("include/pc.h");
    fs::read_to_string(&path).map_err(|source| Error::File { path: path.display().to_string(), source })
}

/// The number that the header gives a macro.
///
/// # Errors
/// [`Error::File`] if there is no header.
pub(crate) fn macro_of_header(name: &str) -> Result<String, Error> {
    let header = text()?;
    let define = format!("#define {name} ");
    let value = header.lines().find_map(|line| line.strip_prefix(define.as_str()));
    Ok(value.unwrap_or_default().trim().to_owned())
}

pub(crate) fn abi_version() -> Result<String, Error> {
    macro_of_header("PC_ABI_VERSION")
}

/// The functions that the header declares.
///
/// # Errors
/// [`Error::File`] if there is no header.
pub(crate) fn functions_of_header() -> Result<Vec<String>, Error> {
    let header = text()?;
    let code = header.lines().filter(|line| !line.trim_start().starts_with(['*', '/']));
    let heads = code.filter_map(|line| line.split_once('(')).map(|(head, _)| head);
    let names = heads.filter_map(|head| head.rsplit([' ', '*']).next());
    Ok(names.filter(|name| name.starts_with("pc_")).map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_tells_its_versions_and_functions() {
        assert!(abi_version().unwrap().parse::<u32>().is_ok());
        assert_eq!(macro_of_header("PC_VERSION_NONE").unwrap(), "");
        let functions = functions_of_header().unwrap();
        assert!(functions.iter().any(|name| name == "pc_version"));
        assert!(functions.iter().any(|name| name == "pc_system_rhs"));
    }
}
