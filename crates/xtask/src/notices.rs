//! The licences of what is linked into a binary, which have to go with it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::command::{cargo, text_of, workspace_root};
use crate::error::Error;

/// How files with licences begin, in lower case.
const BEGINNINGS: [&str; 6] = ["license", "licence", "copying", "copyright", "notice", "unlicense"];

/// The folder of a crate in which the library that it builds is kept, such as SUNDIALS.
const VENDORED: &str = "vendor";

/// Work of others that is in pages: the crate that writes them, its name, and its licence.
const ON_PAGES: [(&str, &str, &str); 4] = [
    ("pc-report", "three.js, in pages", "crates/pc-report/viewer/dist/viewer.LICENSE.txt"),
    ("pc-report", "uPlot, in pages", "crates/pc-report/plots/dist/plots.LICENSE.txt"),
    ("pc-report", "STIX Two Math, in pages", "crates/pc-report/fonts/OFL.txt"),
    ("pc-cli", "CodeMirror, in the page of pc live", "crates/pc-cli/live/dist/live.LICENSE.txt"),
];

/// The licences and notices of all crates from registries that a package of the workspace links, each text once, with the crates
/// that it belongs to.
///
/// # Errors
/// [`Error::Package`] where a crate of which cargo knows is not there; what running cargo and reading files may give.
pub(crate) fn of_dependencies(package: &str) -> Result<String, Error> {
    let places = places()?;
    let mut crates_of_text: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let listed = listed(package)?;
    for (writer, name, path) in ON_PAGES {
        if listed.lines().any(|line| line.starts_with(&format!("{writer} "))) {
            let path = workspace_root().join(path);
            let text = fs::read_to_string(&path)
                .map_err(|source| Error::File { path: path.display().to_string(), source })?;
            crates_of_text.entry(text).or_default().push(name.to_owned());
        }
    }
    for (name, declared) in from_registries(&listed) {
        let missing = || Error::Package { wrong: format!("the sources of {name} are not where cargo says") };
        let place = places.get(&name).ok_or_else(missing)?;
        let mut texts = texts_in(place)?;
        texts.extend(texts_in(&place.join(VENDORED))?);
        if texts.is_empty() {
            texts.push(format!("Licence: {declared}\n"));
        }
        for text in texts {
            let crates = crates_of_text.entry(text).or_default();
            if crates.last() != Some(&name) {
                crates.push(name.clone());
            }
        }
    }
    let mut parts: Vec<(String, String)> =
        crates_of_text.into_iter().map(|(text, crates)| (crates.join(", "), text)).collect();
    parts.sort();
    let rule = "=".repeat(80);
    Ok(parts
        .iter()
        .map(|(crates, text)| format!("{rule}\n{crates}\n{rule}\n\n{}\n\n", text.trim_end()))
        .collect())
}

/// The crates that a package links, a line each: name, version and place, then the licence.
fn listed(package: &str) -> Result<String, Error> {
    let tree = ["tree", "--locked", "--package", package, "--edges", "normal,no-proc-macro"];
    let mut command = cargo(&tree);
    text_of(command.args(["--prefix", "none", "--no-dedupe", "--format", "{p}|{l}"]))
}

/// Those that are from registries, `name-version`, in order, with the licences that they declare.
fn from_registries(listed: &str) -> BTreeMap<String, String> {
    let from_registry = |line: &str| {
        let (package, licence) = line.split_once('|')?;
        let mut words = package.split(' ');
        let (name, version) = (words.next()?, words.next()?.strip_prefix('v')?);
        words.next().is_none().then(|| (format!("{name}-{version}"), licence.to_owned()))
    };
    listed.lines().filter_map(from_registry).collect()
}

/// The directories of all crates of the workspace's dependencies, by their names.
fn places() -> Result<BTreeMap<String, PathBuf>, Error> {
    let metadata = text_of(&mut cargo(&["metadata", "--locked", "--format-version", "1"]))?;
    let manifests = metadata.split("\"manifest_path\":\"").skip(1).filter_map(|rest| rest.split('"').next());
    let directories = manifests.filter_map(|manifest| Path::new(manifest).parent());
    let named = |directory: &Path| Some((directory.file_name()?.to_str()?.to_owned(), directory.to_owned()));
    Ok(directories.filter_map(named).collect())
}

/// The licences and notices that lie in a directory, by the names of their files; none where there is no such directory.
fn texts_in(directory: &Path) -> Result<Vec<String>, Error> {
    let Ok(entries) = fs::read_dir(directory) else { return Ok(Vec::new()) };
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|file| {
        let name = file.file_name().map(|name| name.to_string_lossy().to_lowercase());
        file.is_file()
            && name.is_some_and(|name| BEGINNINGS.iter().any(|beginning| name.starts_with(beginning)))
    });
    files.sort();
    let read = |file: &PathBuf| fs::read_to_string(file).map_err(|source| Error::of_file(file, source));
    files.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_licence_of_sundials_goes_with_the_package() {
        let notices = of_dependencies("pc-python").unwrap();
        assert!(notices.contains("Lawrence Livermore National Security"), "SUNDIALS");
        assert!(
            notices.contains("\nnumpy-") && !notices.contains("pc-expr"),
            "crates of others, and no other ones"
        );
        for (writer, name, _) in ON_PAGES {
            assert_eq!(notices.contains(name), writer != "pc-cli", "{name}");
        }
        assert!(notices.contains("three.js authors") && notices.contains("SIL OPEN FONT LICENSE"));
    }
}
