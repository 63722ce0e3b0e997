//! A small dense matrix whose entries may be expressions.

use std::ops::{Index, IndexMut};

/// A rows × columns matrix, indexed by `(row, column)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix<T> {
    rows: usize,
    columns: usize,
    entries: Vec<T>,
}

impl<T: Copy> Matrix<T> {
    /// The matrix with entry `f(i, j)` in row i and column j.
    pub fn from_fn(rows: usize, columns: usize, mut f: impl FnMut(usize, usize) -> T) -> Matrix<T> {
        let entries = (0..rows * columns).map(|index| f(index / columns, index % columns)).collect();
        Matrix { rows, columns, entries }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Row `i`.
    pub fn row(&self, i: usize) -> &[T] {
        &self.entries[i * self.columns..(i + 1) * self.columns]
    }

    /// Column `j`.
    pub fn column(&self, j: usize) -> impl Iterator<Item = T> + '_ {
        (0..self.rows).map(move |i| self[(i, j)])
    }

    /// All entries, row after row.
    pub fn entries(&self) -> &[T] {
        &self.entries
    }

    /// The rows as vectors.
    pub fn to_rows(&self) -> Vec<Vec<T>> {
        (0..self.rows).map(|i| self.row(i).to_vec()).collect()
    }

    /// The transpose.
    #[must_use]
    pub fn transpose(&self) -> Matrix<T> {
        Matrix::from_fn(self.columns, self.rows, |i, j| self[(j, i)])
    }

    /// The matrix with every entry passed through `f`.
    pub fn map<S: Copy>(&self, mut f: impl FnMut(T) -> S) -> Matrix<S> {
        Matrix::from_fn(self.rows, self.columns, |i, j| f(self[(i, j)]))
    }
}

impl<T> Index<(usize, usize)> for Matrix<T> {
    type Output = T;
    fn index(&self, (i, j): (usize, usize)) -> &T {
        &self.entries[i * self.columns + j]
    }
}

impl<T> IndexMut<(usize, usize)> for Matrix<T> {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut T {
        &mut self.entries[i * self.columns + j]
    }
}
