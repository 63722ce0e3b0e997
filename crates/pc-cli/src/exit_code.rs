//! Exit codes.

use pc_run::Category;

/// A wrong command line.
pub(crate) const USAGE: u8 = 2;

/// A result that could not be written.
pub(crate) const UNWRITTEN: u8 = 6;

/// That of an error of a run.
pub(crate) fn of(category: Category) -> u8 {
    match category {
        Category::Different => 1,
        Category::Request => USAGE,
        Category::Text => 3,
        Category::Undefined => 4,
        Category::Failed => 5,
        Category::Unwritten => UNWRITTEN,
        Category::Undecided => 7,
        Category::Interrupted => 130,
    }
}
