//! Wrappers forward every method of their trait: one with a default that is forgotten would hide what the wrapped value has.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The names of the methods from `start` to the first line that is `end`.
fn methods(text: &str, start: &str, end: &str) -> BTreeSet<String> {
    let (_, rest) = text.split_once(start).unwrap_or_else(|| panic!("no `{start}`"));
    let lines = rest.lines().take_while(|line| *line != end);
    let names = lines.filter_map(|line| line.trim_start().strip_prefix("fn ")?.split(['(', '<']).next());
    names.map(str::to_owned).collect()
}

#[test]
fn pointers_forward_every_method() {
    let read = |file: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/ode").join(file);
        fs::read_to_string(path).expect("a source file")
    };
    let (field, events) = (read("vector_field.rs"), read("events.rs"));
    let of_trait = methods(&field, "pub trait VectorField", "}");
    assert!(of_trait.len() > 30, "{of_trait:?}");
    assert_eq!(methods(&field, "macro_rules! behind", "}"), of_trait);
    let of_trait = methods(&events, "pub trait Events", "}");
    assert!(of_trait.len() > 8, "{of_trait:?}");
    assert_eq!(methods(&events, "Events for &mut E", "}"), of_trait);
}
