//! Elimination over a prime field.

use crate::identity::prime_field::Residue;

/// Rows over GF(2⁶¹ − 1) in echelon form: with distinct leading columns, 1 in the leading column.
///
/// ```
/// use pc_expr::{Residue, ResidueEchelon};
/// let mut echelon = ResidueEchelon::new(3);
/// for row in [[1, 2, 3], [2, 4, 6], [0, 0, 5], [1, 2, 8]] {
///     echelon.insert(row.map(Residue::integer).to_vec());
/// }
/// assert_eq!(echelon.rank(), 2);
/// assert_eq!(echelon.null_space(), [[-2, 1, 0].map(Residue::integer)]);
/// ```
#[derive(Clone, Debug)]
pub struct ResidueEchelon {
    columns: usize,
    /// The row whose leading column is this one.
    leading: Vec<Option<Vec<Residue>>>,
}

impl ResidueEchelon {
    /// An echelon form with this many columns and no rows yet.
    pub fn new(columns: usize) -> ResidueEchelon {
        ResidueEchelon { columns, leading: vec![None; columns] }
    }

    /// The number of independent rows.
    pub fn rank(&self) -> usize {
        self.leading.iter().flatten().count()
    }

    /// Adds a row if it is independent of the rows already present.
    ///
    /// # Panics
    /// If it has fewer entries than there are columns.
    pub fn insert(&mut self, mut row: Vec<Residue>) {
        for column in 0..self.columns {
            if row[column] == Residue::ZERO {
                continue;
            }
            let Some(known) = &self.leading[column] else {
                let scale = row[column].inverse();
                row.iter_mut().for_each(|x| *x = *x * scale);
                self.leading[column] = Some(row);
                return;
            };
            subtract(&mut row, known, column);
        }
    }

    /// A basis of the vectors that all rows annihilate, one for each non-leading column, with 1 in that
    /// column and 0 in the columns after it and in the other non-leading columns.
    pub fn null_space(mut self) -> Vec<Vec<Residue>> {
        for column in (0..self.columns).rev() {
            let Some(known) = self.leading[column].take() else { continue };
            for row in self.leading[..column].iter_mut().flatten() {
                subtract(row, &known, column);
            }
            self.leading[column] = Some(known);
        }
        let free = (0..self.columns).filter(|&column| self.leading[column].is_none());
        let vector = |free: usize| {
            let entry = |column: usize| match &self.leading[column] {
                Some(row) => -row[free],
                None if column == free => Residue::ONE,
                None => Residue::ZERO,
            };
            (0..self.columns).map(entry).collect()
        };
        free.map(vector).collect()
    }
}

/// row ← row − row[column]·known, where `column` is the leading column of known.
fn subtract(row: &mut [Residue], known: &[Residue], column: usize) {
    let factor = row[column];
    if factor == Residue::ZERO {
        return;
    }
    for (x, &y) in row[column..].iter_mut().zip(&known[column..]) {
        if y != Residue::ZERO {
            *x = *x - factor * y;
        }
    }
}
