//! Which packages a change can touch: those in which files differ, and all that depend on these.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use crate::command::{text_of, workspace_root};
use crate::error::Error;

/// Files outside packages whose change touches only some of these.
const OUTSIDE: [(&str, &[&str]); 7] = [
    ("docs/", &["pc-cli", "pc-fmu", "pc-tests", "xtask"]),
    ("README.md", &["pc-cli", "pc-tests"]),
    ("CHANGELOG.md", &[]),
    ("CONTRIBUTING.md", &[]),
    ("include/", &["pc-capi"]),
    ("examples-c/", &["pc-capi", "xtask"]),
    ("tests/", &["pc-tests", "pc-cli", "pc-expr", "pc-mech", "pc-model"]),
];

/// The packages of a workspace, each with those it depends on, also for its tests only.
pub(crate) struct Packages {
    dependencies: BTreeMap<String, Vec<String>>,
}

impl Packages {
    /// Those of this workspace, as their manifests say.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(crate) fn of_workspace() -> Result<Packages, Error> {
        let root = workspace_root();
        let crates = root.join("crates");
        let entries = fs::read_dir(&crates).map_err(|source| Error::of_file(&crates, source))?;
        let mut manifests: Vec<_> = entries.flatten().map(|entry| entry.path().join("Cargo.toml")).collect();
        manifests.push(root.join("tests/Cargo.toml"));
        let texts = manifests.iter().map(|path| {
            let text = fs::read_to_string(path).map_err(|source| Error::of_file(path, source))?;
            Ok((name_of(&text).unwrap_or_default().to_owned(), text))
        });
        Ok(Packages::new(&texts.collect::<Result<Vec<_>, Error>>()?))
    }

    fn new(manifests: &[(String, String)]) -> Packages {
        let names: Vec<String> = manifests.iter().map(|(name, _)| name.clone()).collect();
        let named = |text: &str| {
            let keys = text.lines().filter_map(|line| line.split(['.', ' ', '=']).next());
            keys.filter(|key| names.iter().any(|name| name == key)).map(str::to_owned).collect()
        };
        Packages { dependencies: manifests.iter().map(|(name, text)| (name.clone(), named(text))).collect() }
    }

    /// The packages that a change of these files can touch.
    pub(crate) fn touched<'a>(&self, files: impl IntoIterator<Item = &'a str>) -> BTreeSet<String> {
        let mut touched = BTreeSet::new();
        for file in files {
            match self.owners(file) {
                Some(owners) => touched.extend(owners),
                None => return self.dependencies.keys().cloned().collect(),
            }
        }
        loop {
            let dependents = self.dependencies.iter().filter(|(name, dependencies)| {
                !touched.contains(*name) && dependencies.iter().any(|other| touched.contains(other))
            });
            let dependents: Vec<String> = dependents.map(|(name, _)| name.clone()).collect();
            if dependents.is_empty() {
                return touched;
            }
            touched.extend(dependents);
        }
    }

    /// The packages that read a file; none for one that may be anything to all.
    fn owners(&self, file: &str) -> Option<Vec<String>> {
        let package = file.strip_prefix("crates/").and_then(|rest| rest.split('/').next());
        if let Some(package) = package.filter(|package| self.dependencies.contains_key(*package)) {
            return Some(vec![package.to_owned()]);
        }
        let (_, owners) = OUTSIDE.iter().find(|(place, _)| file.starts_with(place))?;
        Some(owners.iter().map(|&owner| owner.to_owned()).collect())
    }
}

/// The packages that can behave otherwise than at a revision: files that differ from it, committed or not, and new ones.
///
/// # Errors
/// [`Error::Failed`] where git does not know the revision.
pub(crate) fn since(revision: &str) -> Result<BTreeSet<String>, Error> {
    let git = |arguments: &[&str]| text_of(Command::new("git").args(arguments).current_dir(workspace_root()));
    let changed = git(&["diff", "--name-only", revision])?;
    let new = git(&["ls-files", "--others", "--exclude-standard"])?;
    Ok(Packages::of_workspace()?.touched(changed.lines().chain(new.lines())))
}

fn name_of(manifest: &str) -> Option<&str> {
    manifest.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn packages() -> Packages {
        let manifest = |name: &str, rest: &str| {
            (name.to_owned(), format!("[package]\nname = \"{name}\"\n[dependencies]\n{rest}"))
        };
        Packages::new(&[
            manifest("pc-expr", "thiserror.workspace = true\n"),
            manifest(
                "pc-mech",
                "pc-expr.workspace = true\n[dev-dependencies]\npc-tests = { path = \"..\" }\n",
            ),
            manifest("pc-solve", "pc-expr = { workspace = true }\n"),
            manifest("pc-cli", "pc-mech.workspace = true\npc-solve.workspace = true\n"),
            manifest("pc-tests", ""),
        ])
    }

    fn touched(files: &[&str]) -> Vec<String> {
        packages().touched(files.iter().copied()).into_iter().collect()
    }

    #[test]
    fn a_change_touches_what_depends_on_it() {
        assert_eq!(touched(&["crates/pc-solve/src/lib.rs"]), ["pc-cli", "pc-solve"]);
        assert_eq!(touched(&["crates/pc-expr/src/lib.rs"]), ["pc-cli", "pc-expr", "pc-mech", "pc-solve"]);
        assert_eq!(touched(&["CHANGELOG.md"]), [""; 0]);
    }

    #[test]
    fn what_is_nobodys_touches_all() {
        assert_eq!(touched(&["Cargo.lock"]).len(), 5);
        assert_eq!(touched(&["crates/pc-new/src/lib.rs"]).len(), 5);
    }

    #[test]
    fn the_workspace_is_read() {
        let packages = Packages::of_workspace().unwrap();
        let touched = packages.touched(["crates/pc-python/src/lib.rs"]);
        assert_eq!(touched.into_iter().collect::<Vec<_>>(), ["pc-python"]);
        assert!(packages.touched(["crates/pc-expr/src/lib.rs"]).len() > 10);
    }
}
