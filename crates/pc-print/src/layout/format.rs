//! The formats of pages.

/// The format of a page of equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// For people.
    Text,
    /// For a paper.
    Latex,
    /// For programs.
    Json,
}
