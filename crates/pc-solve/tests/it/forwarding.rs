//! The steppers that are one of several forward every method of theirs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The names of the methods from `start` to the first line that is `}`.
fn methods(text: &str, start: &str) -> BTreeSet<String> {
    let (_, rest) = text.split_once(start).unwrap_or_else(|| panic!("no `{start}`"));
    let lines = rest.lines().take_while(|line| *line != "}");
    let names = lines.filter_map(|line| line.trim_start().strip_prefix("fn ")?.split(['(', '<']).next());
    names.map(str::to_owned).collect()
}

#[test]
fn steppers_of_several_methods_forward_every_method() {
    let read = |file: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(file);
        fs::read_to_string(path).expect("a source file")
    };
    let mut of_trait = methods(&read("integration/stepper.rs"), "pub trait Stepper");
    assert!(of_trait.len() > 20, "{of_trait:?}");
    // By its default it is made of the others.
    of_trait.remove("failed");
    assert_eq!(methods(&read("chosen.rs"), "Stepper for Chosen<F>"), of_trait);
    of_trait.remove("end_time"); // that of the last step, by its default
    assert_eq!(methods(&read("sensitivity/explicit.rs"), "Stepper for Differentiated<F>"), of_trait);
}
