//! `cargo xtask release`: everything that is to be so before a version is published, tried in turn; nothing is published.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cargo_tools::CargoTool;
use crate::command::{announce_and_run, cargo, succeeds, target_directory, text_of, workspace_root};
use crate::error::Error;
use crate::python;
use crate::test;

const CYCLONEDX: CargoTool = CargoTool { name: "cargo-cyclonedx", version: "~0.5" };

/// Packages of the workspace that are not for crates.io.
const NOT_PUBLISHED: [&str; 3] = ["pc-python", "pc-tests", "xtask"];

/// One point of the list.
struct Point {
    title: &'static str,
    /// Why it is on the list.
    why: &'static str,
    work: fn() -> Result<(), Error>,
}

const POINTS: [Point; 8] = [
    Point { title: "tree", why: "what is published is what is committed", work: tree },
    Point {
        title: "version",
        why: "the changelog has a heading for the version, with its date",
        work: version,
    },
    Point {
        title: "tests",
        why: "the tests of everything pass, with the interface lists and the licences",
        work: tests,
    },
    Point {
        title: "compiler",
        why: "the oldest compiler that the manifests promise compiles all targets",
        work: compiler,
    },
    Point {
        title: "packages",
        why: "each package builds of the files that it is published with",
        work: packages,
    },
    Point { title: "pages", why: "docs.rs can build the pages of each package", work: pages },
    Point {
        title: "wheel",
        why: "two builds of the wheel have the same bytes, and its tests pass",
        work: wheel,
    },
    Point {
        title: "materials",
        why: "a bill of materials in CycloneDX lists what each package is made of",
        work: materials,
    },
];

/// The whole list, or the points with these titles.
///
/// # Errors
/// [`Error::Usage`] for a title that is not on the list; [`Error::Release`] with the points that failed.
pub(crate) fn run(titles: &[String]) -> Result<(), Error> {
    if let Some(unknown) = titles.iter().find(|title| POINTS.iter().all(|point| point.title != **title)) {
        let known: Vec<&str> = POINTS.iter().map(|point| point.title).collect();
        let message = format!("there is no point `{unknown}`; there are {}", known.join(", "));
        return Err(Error::Usage { message });
    }
    let wanted = |point: &&Point| titles.is_empty() || titles.iter().any(|title| title == point.title);
    let mut lines = Vec::new();
    let mut failed = Vec::new();
    for point in POINTS.iter().filter(wanted) {
        println!("\n{}: {}", point.title, point.why);
        let verdict = match (point.work)() {
            Ok(()) => "yes".to_owned(),
            Err(error) => {
                failed.push(point.title);
                format!("NO: {error}")
            }
        };
        lines.push(format!("{:10} {verdict}", point.title));
    }
    println!("\n{}", lines.join("\n"));
    if failed.is_empty() { Ok(()) } else { Err(Error::Release { points: failed }) }
}

fn tree() -> Result<(), Error> {
    let changed = text_of(Command::new("git").args(["status", "--porcelain"]).current_dir(workspace_root()))?;
    match changed.trim() {
        "" => Ok(()),
        changed => Err(Error::Unfit { wrong: format!("these files are not committed:\n{changed}") }),
    }
}

/// What a line `key = "value"` of a text says.
fn value<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    let of_line =
        |line: &'t str| line.strip_prefix(key)?.trim_start().strip_prefix('=')?.trim().strip_prefix('"');
    text.lines().find_map(of_line)?.split('"').next()
}

/// What the root manifest says of all packages.
fn of_manifest(key: &str) -> Result<String, Error> {
    let manifest = workspace_root().join("Cargo.toml");
    let text = fs::read_to_string(&manifest).map_err(|source| Error::of_file(&manifest, source))?;
    let missing = || Error::Unfit { wrong: format!("Cargo.toml has no `{key}`") };
    value(&text, key).map(str::to_owned).ok_or_else(missing)
}

fn version() -> Result<(), Error> {
    let (version, changelog) = (of_manifest("version")?, workspace_root().join("CHANGELOG.md"));
    let text = fs::read_to_string(&changelog).map_err(|source| Error::of_file(&changelog, source))?;
    heading(&text, &version).map_err(|wrong| Error::Unfit { wrong })
}

/// Checks that the first heading of a changelog is that of a version, with a date.
fn heading(changelog: &str, version: &str) -> Result<(), String> {
    let first = changelog.lines().find_map(|line| line.strip_prefix("## ")).unwrap_or_default();
    let Some(date) = first.strip_prefix(version).and_then(|rest| rest.strip_prefix(", ")) else {
        return Err(format!("CHANGELOG.md begins with `{first}`, and the version is {version}"));
    };
    let is_date = date.len() == 10 && date.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-');
    if is_date {
        Ok(())
    } else {
        Err(format!("CHANGELOG.md says `{date}` where the date of {version} belongs"))
    }
}

fn tests() -> Result<(), Error> {
    test::run(&test::Wanted::default())
}

fn compiler() -> Result<(), Error> {
    let oldest = of_manifest("rust-version")?;
    let present = text_of(Command::new("rustc").arg("--version").current_dir(workspace_root()))?;
    let check = ["check", "--workspace", "--all-targets", "--locked"];
    if present.starts_with(&format!("rustc {oldest}.")) {
        println!("{} is the oldest", present.trim());
        return announce_and_run(&mut cargo(&check));
    }
    let toolchain = format!("+{oldest}");
    if !succeeds(Command::new("cargo").args([toolchain.as_str(), "--version"])) {
        let what = format!("Rust {oldest} is not installed (rustup toolchain install {oldest})");
        return Err(Error::Unavailable { what });
    }
    announce_and_run(Command::new("cargo").arg(toolchain).args(check).current_dir(workspace_root()))
}

/// The arguments that leave out what is not published.
fn published() -> impl Iterator<Item = &'static str> {
    NOT_PUBLISHED.into_iter().flat_map(|name| ["--exclude", name])
}

fn packages() -> Result<(), Error> {
    announce_and_run(cargo(&["package", "--workspace", "--locked", "--allow-dirty"]).args(published()))
}

fn pages() -> Result<(), Error> {
    let mut doc = cargo(&["doc", "--workspace", "--no-deps", "--all-features", "--locked"]);
    announce_and_run(doc.args(published()).env("RUSTDOCFLAGS", "-D warnings --cfg docsrs"))
}

/// Everything is compiled twice, in two target directories.
fn wheel() -> Result<(), Error> {
    let target = target_directory()?;
    let wheel = python::wheel(&target)?;
    let again = python::wheel(&target.join("again"))?;
    let bytes = |path: &Path| fs::read(path).map_err(|source| Error::of_file(path, source));
    let (first, second) = (bytes(&wheel)?, bytes(&again)?);
    if first != second {
        let wrong = format!("{} and {} differ", wheel.display(), again.display());
        return Err(Error::Unfit { wrong });
    }
    println!("{}: {} bytes, the same twice", wheel.display(), first.len());
    python::tested(&wheel)
}

/// The bills of materials, in `target/materials`.
fn materials() -> Result<(), Error> {
    if !CYCLONEDX.is_available()? {
        return Err(Error::Unavailable { what: format!("{} is not installed", CYCLONEDX.name) });
    }
    let place = target_directory()?.join("materials");
    fs::create_dir_all(&place).map_err(|source| Error::of_file(&place, source))?;
    let mut bill = CYCLONEDX.command();
    let arguments = ["cyclonedx", "--format", "json", "--override-filename", BILL];
    announce_and_run(bill.args(arguments).current_dir(workspace_root()))?;
    let written = bills(&workspace_root())?;
    for (package, bill) in &written {
        let to = place.join(format!("{package}.cdx.json"));
        fs::rename(bill, &to).map_err(|source| Error::of_file(bill, source))?;
    }
    println!("{}: {} bills of materials", place.display(), written.len());
    if written.is_empty() {
        Err(Error::Unfit { wrong: "no bill of materials was written".to_owned() })
    } else {
        Ok(())
    }
}

/// The name that a bill of materials has beside the manifest of its package.
const BILL: &str = "bill-of-materials";

/// The bills of materials beside the manifests, by the folders of these.
fn bills(root: &Path) -> Result<BTreeMap<String, PathBuf>, Error> {
    let crates = root.join("crates");
    let entries = fs::read_dir(&crates).map_err(|source| Error::of_file(&crates, source))?;
    let folders = entries.flatten().map(|entry| entry.path()).chain([root.join("tests")]);
    let bill = |folder: PathBuf| {
        let bill = folder.join(BILL).with_extension("json");
        Some((folder.file_name()?.to_str()?.to_owned(), bill)).filter(|(_, bill)| bill.is_file())
    };
    Ok(folders.filter_map(bill).collect())
}

#[cfg(test)]
mod tests_of_the_list {
    use super::*;

    #[test]
    fn a_version_has_a_heading_with_its_date() {
        let changelog = "# Changelog\n\n## 0.2.0, 2026-12-01\n\n## 0.1.0, 2026-11-01\n";
        assert_eq!(heading(changelog, "0.2.0"), Ok(()));
        let wrong = "CHANGELOG.md begins with `0.2.0, 2026-12-01`, and the version is 0.3.0".to_owned();
        assert_eq!(heading(changelog, "0.3.0"), Err(wrong));
        let open = heading("## 0.2.0, not yet released\n", "0.2.0");
        let wrong = "CHANGELOG.md says `not yet released` where the date of 0.2.0 belongs".to_owned();
        assert_eq!(open, Err(wrong));
    }

    #[test]
    fn manifests_say_what_all_packages_share() {
        assert_eq!(value("[a]\nrust-version = \"1.95\"\nversion = \"0.1.0\"\n", "version"), Some("0.1.0"));
        assert_eq!(of_manifest("rust-version").ok().as_deref(), Some("1.95"));
    }

    #[test]
    fn a_point_that_is_not_on_the_list_is_refused() {
        let message = run(&["wheels".to_owned()]).unwrap_err().to_string();
        assert!(
            message.starts_with("there is no point `wheels`; there are tree, version, tests, "),
            "{message}"
        );
    }
}
