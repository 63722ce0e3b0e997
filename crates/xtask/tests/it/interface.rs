//! The public interfaces of the libraries, written down in `interface/lists`: a change of one is seen where it is reviewed.
//!
//! Of a released version a line that goes, or is another, is a new version 0.(x+1).0 and stands in the changelog; a line that
//! comes is 0.x.(y+1). `INSTA_UPDATE=always cargo test -p xtask --test it interface` writes the lists anew. What the C
//! library offers is in `crates/pc-capi/abi/interface.txt`.

mod interface;

use crate::modules;
use std::path::Path;

/// Crates that other programs use; `pc-capi` has its own list, programs and the Python package have none.
const LIBRARIES: [&str; 12] = [
    "pc-expr",
    "pc-algebra",
    "pc-mech",
    "pc-nonholo",
    "pc-analysis",
    "pc-model",
    "pc-print",
    "pc-verify",
    "pc-report",
    "pc-run",
    "pc-fmu",
    "pc-solve",
];

#[test]
fn public_interfaces_are_those_written_down() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("interface/lists");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for name in LIBRARIES {
            let text = interface::of(&modules::read(&crates.join(name).join("src")));
            assert!(text.contains("pub "), "{name} offers something");
            insta::assert_snapshot!(name, text);
        }
    });
}

#[test]
fn an_interface_is_what_others_can_name() {
    let folder = tempfile::tempdir().expect("a directory");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("a file");
    };
    write(
        "lib.rs",
        "mod room; pub mod open { pub fn f(x: &str) -> usize { x.len() } fn g() {} } pub use room::{Shown, Law}; pub use other::Thing;",
    );
    write(
        "room.rs",
        "/// Words.\n#[derive(Clone)] pub struct Shown { pub a: u8, b: u8 } struct Hidden; trait Secret {}\n\
         impl Shown { /// Words.\n pub fn new() -> Self { Shown { a: 1, b: 2 } } fn own(&self) {} }\n\
         impl From<u8> for Shown { fn from(a: u8) -> Self { Shown { a, b: 0 } } }\n\
         impl Secret for Shown {} impl Hidden { pub fn no() {} } impl Law for f64 { const N: usize = 2; }\n\
         pub trait Law { const N: usize; fn given(&self) -> u8 { 3 } }\n\
         #[cfg(test)] mod tests { impl super::Shown { pub fn untold() {} } }",
    );
    let text = interface::of(&modules::read(folder.path()));
    let shown: String = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(
        shown,
        "// Law pub trait Law { const N: usize; fn given(&self) -> u8 {} } impl Law for f64 {} \
         // Shown #[derive(Clone)] pub struct Shown { pub a: u8, _rest: _, } impl Shown { pub fn new() -> Self {} } \
         impl From<u8> for Shown {} // Thing pub use other::Thing; // open::f pub fn f(x: &str) -> usize {}"
    );
}
