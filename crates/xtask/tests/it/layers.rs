//! What `docs/architecture.md` says that a crate never uses, it does not: neither itself nor through another crate of the workspace.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The dependencies of each crate of the workspace that are not of its tests alone.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut all = BTreeMap::new();
    for entry in std::fs::read_dir(crates).expect("the folder of the crates") {
        let folder = entry.expect("an entry").path();
        let Ok(manifest) = std::fs::read_to_string(folder.join("Cargo.toml")) else { continue };
        let lines = manifest.lines().skip_while(|line| *line != "[dependencies]").skip(1);
        let used = lines.take_while(|line| !line.starts_with('['));
        let used = used.filter_map(|line| line.split(['.', ' ', '=']).next());
        let used = used.filter(|name| !name.is_empty() && *name != "#").map(str::to_owned).collect();
        all.insert(folder.file_name().expect("a name").to_string_lossy().into_owned(), used);
    }
    all
}

/// All that a crate depends on, through crates of the workspace.
fn reached(all: &BTreeMap<String, BTreeSet<String>>, name: &str) -> BTreeSet<String> {
    let (mut found, mut left) = (BTreeSet::new(), vec![name.to_owned()]);
    while let Some(name) = left.pop() {
        for used in all.get(&name).into_iter().flatten() {
            if found.insert(used.clone()) {
                left.push(used.clone());
            }
        }
    }
    found
}

#[test]
fn no_crate_uses_what_it_is_said_never_to_use() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/architecture.md");
    let page = std::fs::read_to_string(page).expect("the page");
    let names = |cell: &str| -> Vec<String> {
        cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()
    };
    let rows = page.lines().filter(|line| line.starts_with("| `pc-"));
    let all = dependencies();
    let (mut listed, mut broken) = (BTreeSet::new(), Vec::new());
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, crate_name, _, never, _] = cells[..] else { panic!("three cells: {row}") };
        for name in names(crate_name) {
            let uses = reached(&all, &name);
            broken
                .extend(names(never).into_iter().filter(|it| uses.contains(it)).map(|it| (name.clone(), it)));
            listed.insert(name);
        }
    }
    let crates: BTreeSet<String> = all.into_keys().filter(|name| name.starts_with("pc-")).collect();
    assert_eq!(listed, crates, "each crate has a row");
    assert!(broken.is_empty(), "{broken:?}");
}
