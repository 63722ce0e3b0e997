//! Tables as the writers of formats see them: columns, and rows of cells.

use std::io;

/// The kind of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellKind {
    /// Whole numbers that are not negative.
    Integer,
    /// Numbers.
    Number,
    /// Text.
    Text,
}

/// A column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// The kind of its cells.
    pub kind: CellKind,
}

impl Column {
    /// A column with this name.
    pub fn new(name: impl Into<String>, kind: CellKind) -> Column {
        Column { name: name.into(), kind }
    }
}

/// An entry of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cell<'a> {
    /// A whole number.
    Integer(u64),
    /// A number.
    Number(f64),
    /// Text.
    Text(&'a str),
}

/// Takes a row.
pub type Take<'t> = &'t mut dyn FnMut(&[Cell<'_>]) -> io::Result<()>;

/// A table that can be read as often as a format needs, in an amount of memory that does not depend on its
/// length.
pub trait Rows {
    /// Its columns.
    fn columns(&self) -> Vec<Column>;

    /// The number of rows, if it is known without reading them.
    fn count(&self) -> Option<u64>;

    /// Passes each row to `take`.
    ///
    /// # Errors
    /// [`io::Error`] from `take`, or from the source of the rows.
    fn each(&self, take: Take<'_>) -> io::Result<()>;

    /// Passes each cell of column `j` to `take`.
    ///
    /// # Errors
    /// As for [`each`](Rows::each).
    fn each_of(&self, j: usize, take: &mut dyn FnMut(Cell<'_>) -> io::Result<()>) -> io::Result<()> {
        self.each(&mut |row| take(row[j]))
    }
}
