//! Zero patterns of matrices.

use serde::{Deserialize, Serialize};

/// The zero pattern of a matrix in compressed columns: the rows of the entries that may be nonzero, column by
/// column, in ascending order within each column.
///
/// ```
/// use pc_expr::Pattern;
/// let pattern = Pattern::from_columns(2, [vec![0], vec![0, 1]]);
/// assert_eq!(pattern.column_starts(), [0, 1, 3]);
/// assert_eq!(pattern.row_indices(), [0, 0, 1]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pattern {
    rows: usize,
    starts: Vec<usize>,
    indices: Vec<usize>,
}

impl Pattern {
    /// The pattern with the given rows in each column, in any order.
    ///
    /// # Panics
    /// If a row is not below `rows`.
    pub fn from_columns<C: IntoIterator<Item = usize>>(
        rows: usize,
        columns: impl IntoIterator<Item = C>,
    ) -> Pattern {
        let mut pattern = Pattern { rows, starts: vec![0], indices: Vec::new() };
        for column in columns {
            let mut column: Vec<usize> = column.into_iter().collect();
            column.sort_unstable();
            column.dedup();
            assert!(column.last().is_none_or(|&row| row < rows), "a row beyond the last");
            pattern.indices.extend(column);
            pattern.starts.push(pattern.indices.len());
        }
        pattern
    }

    /// The pattern in which every entry may be nonzero.
    pub fn full(rows: usize, columns: usize) -> Pattern {
        Pattern::from_columns(rows, (0..columns).map(|_| 0..rows))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of entries that may be nonzero.
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether all entries are zero.
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Whether no entry is known to be zero.
    pub fn is_full(&self) -> bool {
        self.len() == self.rows * self.columns()
    }

    /// The index at which the entries of each column start, followed by the number of all entries; these are
    /// columns + 1 numbers.
    pub fn column_starts(&self) -> &[usize] {
        &self.starts
    }

    /// The rows of the entries.
    pub fn row_indices(&self) -> &[usize] {
        &self.indices
    }

    /// The rows of the entries of column `j`.
    ///
    /// # Panics
    /// If there is no such column.
    pub fn column(&self, j: usize) -> &[usize] {
        &self.indices[self.starts[j]..self.starts[j + 1]]
    }

    /// The row and the column of each entry, in order.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.columns()).flat_map(|j| self.column(j).iter().map(move |&i| (i, j)))
    }

    /// Writes the entries `values` and the zeros to `dense[i + j * rows]`.
    ///
    /// # Panics
    /// If `dense` has fewer than rows × columns numbers.
    pub fn scatter(&self, values: &[f64], dense: &mut [f64]) {
        dense.fill(0.0);
        for ((i, j), &value) in self.entries().zip(values) {
            dense[i + j * self.rows] = value;
        }
    }

    /// Writes the entries of `dense[i + j * rows]` to `values`.
    ///
    /// # Panics
    /// If `dense` has fewer than rows × columns numbers.
    pub fn gather(&self, dense: &[f64], values: &mut [f64]) {
        for ((i, j), value) in self.entries().zip(values) {
            *value = dense[i + j * self.rows];
        }
    }
}
