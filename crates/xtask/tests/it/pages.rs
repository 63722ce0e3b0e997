//! Files and folders that the pages in `docs` name are where they say, and so are the crates that front pages name.

use std::path::Path;

#[test]
fn paths_named_in_pages_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut missing, mut named) = (Vec::new(), 0);
    for page in ["docs/architecture.md", "docs/notation.md", "CONTRIBUTING.md"] {
        let text = std::fs::read_to_string(root.join(page)).expect("the page is readable");
        for word in text.split('`').skip(1).step_by(2) {
            let below_crates = word.starts_with("pc-") && word.contains("/src/");
            let place = if below_crates { root.join("crates").join(word) } else { root.join(word) };
            if below_crates || word.starts_with("crates/") {
                named += 1;
                if !place.exists() {
                    missing.push(format!("{page}: {word}"));
                }
            }
        }
    }
    assert!(named > 40, "places were found: {named}");
    assert!(missing.is_empty(), "{missing:#?}");
}

/// rustdoc looks up links to what a crate depends on; those to the crates above it are paths.
#[test]
fn front_pages_lead_to_each_other() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let (mut links, mut lost) = (0, Vec::new());
    for entry in std::fs::read_dir(&crates).expect("the folder of the crates") {
        let front = entry.expect("an entry").path().join("src/lib.rs");
        let Ok(text) = std::fs::read_to_string(&front) else { continue };
        for line in text.lines().filter(|line| line.starts_with("//!")) {
            for link in line.split("](../").skip(1) {
                let name = link.split('/').next().unwrap_or_default();
                let folder = if name == "pc" { "pc-capi".to_owned() } else { name.replace('_', "-") };
                links += 1;
                if !link.starts_with(&format!("{name}/index.html)"))
                    || !crates.join(folder).join("src/lib.rs").exists()
                {
                    lost.push(format!("{}: {line}", front.display()));
                }
            }
        }
    }
    assert!(links > 20, "links were found: {links}");
    assert!(lost.is_empty(), "{lost:#?}");
}
