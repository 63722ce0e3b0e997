//! No two files of a crate import from each other, directly or around: the files of a crate can be read in an order, and so can those of
//! the Python package.
//!
//! An arrow goes from a file to the file in which a name it uses is defined, through all re-exports in between, so
//! that the head of a folder may offer what its files define. Declaring a module is no arrow; unit tests are left out.

mod circles;
mod source;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use source::Crate;

/// The crates of the workspace, by name.
fn crates() -> Vec<(String, Crate)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the folder of the crates");
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder of the crates is readable")
        .map(|entry| {
            entry.expect("an entry of the folder").file_name().into_string().expect("a name in UTF-8")
        })
        .filter(|name| folder.join(name).join("src").is_dir())
        .collect();
    names.sort();
    assert!(names.len() > 5, "crates were found: {names:?}");
    names.into_iter().map(|name| (name.clone(), Crate::read(&folder.join(name).join("src")))).collect()
}

#[test]
fn no_files_import_from_each_other_in_a_circle() {
    let mut found = String::new();
    for (name, source) in crates() {
        let arrows = source.arrows();
        assert!(name == "xtask" || arrows.values().any(|to| !to.is_empty()), "imports of {name} were read");
        for circle in circles::circles(&arrows) {
            found += &format!("{name}:\n");
            for from in &circle {
                let to: Vec<_> = arrows[from].iter().filter(|file| circle.contains(*file)).cloned().collect();
                found += &format!("    {from} -> {}\n", to.join(", "));
            }
        }
    }
    assert!(found.is_empty(), "files that import from each other in a circle:\n{found}");
}

/// The modules of a package of Python, each with those that it imports, also for types alone or inside functions.
fn modules_of_python(folder: &Path, package: &str, found: &mut BTreeMap<String, BTreeSet<String>>) {
    for entry in std::fs::read_dir(folder).expect("the folder of a package") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        if path.is_dir() && path.join("__init__.py").exists() {
            modules_of_python(&path, &format!("{package}.{name}"), found);
        } else if path.extension().is_some_and(|ending| ending == "py") && name != "__init__" {
            let text = std::fs::read_to_string(&path).expect("a module");
            let from = text.lines().filter_map(|line| line.trim_start().strip_prefix("from "));
            let imported =
                from.filter_map(|rest| rest.split_once(" import ")).map(|(from, _)| from.to_owned());
            found.insert(format!("{package}.{name}"), imported.collect());
        }
    }
}

#[test]
fn no_modules_of_python_import_from_each_other_in_a_circle() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pc-python/python/chetaev");
    let mut arrows = BTreeMap::new();
    modules_of_python(&package, "chetaev", &mut arrows);
    let inside: BTreeSet<String> = arrows.keys().cloned().collect();
    assert!(inside.len() > 10 && arrows.values().any(|to| to.iter().any(|name| inside.contains(name))));
    assert!(
        arrows.values().flatten().all(|name| !name.starts_with("chetaev")
            || name == "chetaev"
            || inside.contains(name)
            || name == "chetaev._native"),
        "each import names a module: {arrows:#?}"
    );
    let circles = circles::circles(&arrows);
    assert!(circles.is_empty(), "modules that import from each other in a circle: {circles:#?}");
}
