//! No two files of a crate import from each other, directly or around: the files of a crate can be read in an order.
//!
//! An arrow goes from a file to the file in which a name it uses is defined, through all re-exports in between, so
//! that the head of a folder may offer what its files define. Declaring a module is no arrow; unit tests are left out.

mod circles;
mod source;

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
