//! The columns of a table that are wanted.

use std::io;

use pc_report::UnknownColumn;

use crate::table::rows::{Cell, Column, Rows, Take};

/// The places of the columns that are written: those that tell the rows apart, which always are, then the wanted ones in the
/// order in which they are wanted; all columns if none is.
///
/// # Errors
/// [`UnknownColumn`]
pub fn chosen(
    names: &[String],
    is_always: impl Fn(usize) -> bool,
    wanted: &[String],
) -> Result<Vec<usize>, UnknownColumn> {
    if wanted.is_empty() {
        return Ok((0..names.len()).collect());
    }
    let mut places: Vec<usize> = (0..names.len()).filter(|&j| is_always(j)).collect();
    for name in wanted.iter().map(|name| name.trim()) {
        let unknown = || UnknownColumn { name: name.to_owned(), known: names.to_vec() };
        let place = names.iter().position(|known| known == name).ok_or_else(unknown)?;
        if !places.contains(&place) {
            places.push(place);
        }
    }
    Ok(places)
}

/// A table with only some of its columns.
pub(crate) struct Chosen<'t> {
    /// The whole table.
    pub(crate) table: &'t dyn Rows,
    /// The places of its columns.
    pub(crate) places: &'t [usize],
}

impl Rows for Chosen<'_> {
    fn columns(&self) -> Vec<Column> {
        let all = self.table.columns();
        self.places.iter().map(|&j| all[j].clone()).collect()
    }

    fn count(&self) -> Option<u64> {
        self.table.count()
    }

    fn each(&self, take: Take<'_>) -> io::Result<()> {
        self.table.each(&mut |row| {
            let cells: Vec<Cell<'_>> = self.places.iter().map(|&j| row[j]).collect();
            take(&cells)
        })
    }

    fn each_of(&self, j: usize, take: &mut dyn FnMut(Cell<'_>) -> io::Result<()>) -> io::Result<()> {
        self.table.each_of(self.places[j], take)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_as_they_are_wanted() {
        let names = ["t", "x", "y", "energy"].map(str::to_owned);
        let chosen = |wanted: &[&str]| {
            chosen(&names, |j| j == 0, &wanted.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>())
        };
        assert_eq!(chosen(&[]), Ok(vec![0, 1, 2, 3]));
        assert_eq!(chosen(&["energy", " x"]), Ok(vec![0, 3, 1]));
        assert_eq!(chosen(&["y", "t", "y"]), Ok(vec![0, 2]));
        let unknown = chosen(&["z"]).expect_err("unknown");
        assert_eq!(unknown.name, "z");
    }
}
