//! `cargo xtask header`: writes `include/pc.h` from the sources of the C interface.

use std::fs;
use std::path::Path;

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

/// The headers below a directory, as programs include them, in order.
///
/// # Errors
/// [`Error::File`] where it cannot be read.
pub(crate) fn headers(include: &Path) -> Result<Vec<String>, Error> {
    let mut found = Vec::new();
    for part in ["", "pc/"] {
        let directory = include.join(part);
        let wrong = |source| Error::File { path: directory.display().to_string(), source };
        for entry in fs::read_dir(&directory).map_err(wrong)? {
            let name = entry.map_err(wrong)?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".h") || name.ends_with(".hpp") {
                found.push(format!("{part}{name}"));
            }
        }
    }
    found.sort();
    Ok(found)
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

    #[test]
    fn headers_are_named_as_they_are_included() {
        let headers = headers(&workspace_root().join("include")).unwrap();
        for name in ["pc.h", "pc.hpp", "pc/cvode.h", "pc/system.hpp"] {
            assert!(headers.iter().any(|header| header == name), "{name}");
        }
        assert!(headers.is_sorted() && !headers.iter().any(|header| header.ends_with(".md")));
    }
}
