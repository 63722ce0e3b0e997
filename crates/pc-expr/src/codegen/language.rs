//! How identifiers, constants, strings and comments are written in a language.

use crate::codegen::layout::{Calls, Language};
use crate::codegen::{c, comment, identifier, rust};

impl Language {
    /// Valid and distinct identifiers for `names`, each as close to its name as possible: Greek letters are spelt out,
    /// a prime becomes `_dot`, and a keyword of the language, an argument of a [`Layout`](crate::Layout) or a name in
    /// `reserved` gets a `_` at its end.
    ///
    /// ```
    /// use pc_expr::Language;
    /// let names = ["γ1", "x'", "δθ", "class", "y", "γ_1"];
    /// let identifiers = Language::C.identifiers(&names, &[]);
    /// assert_eq!(identifiers, ["gamma1", "x_dot", "delta_theta", "class_", "y_", "gamma_1"]);
    /// ```
    pub fn identifiers<S: AsRef<str>>(self, names: &[S], reserved: &[&str]) -> Vec<String> {
        identifier::distinct(self, names, reserved)
    }

    /// A literal that reads back as the same bits.
    pub fn constant(self, value: f64) -> String {
        match self {
            Language::C => c::constant(value),
            Language::Rust => rust::constant(value),
        }
    }

    /// A string literal.
    pub fn string(self, text: &str) -> String {
        match self {
            Language::C => c::string(text),
            Language::Rust => rust::string(text),
        }
    }

    /// `text` on one line, without anything that ends or breaks a comment.
    pub fn comment(self, text: &str) -> String {
        comment::comment(text)
    }

    /// The definitions that these calls need: in C the functions that `<math.h>` lacks, with names that begin
    /// with `prefix`; in Rust the module `math`.
    pub fn helpers(self, calls: &Calls, prefix: &str) -> String {
        match self {
            Language::C => c::helpers(calls, prefix),
            Language::Rust => rust::helpers(calls),
        }
    }
}
