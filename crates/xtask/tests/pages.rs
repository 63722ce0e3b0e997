//! Files and folders that the pages in `docs` name are where they say.

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
