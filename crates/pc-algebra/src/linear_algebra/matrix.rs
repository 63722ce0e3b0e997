//! A matrix of numbers, or of expressions most of which are zero.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::{Index, IndexMut};

use pc_expr::{Expr, Graph, Number, Residue};

/// An entry of a [`Matrix`].
pub trait MatrixEntry: Copy + PartialEq {
    /// 0
    const ZERO: Self;
    /// Whether a matrix stores only its nonzero entries: the frame and the mass matrix of n independent bodies
    /// have n² entries, of which about n are not zero.
    const IS_SPARSE: bool;
    /// Whether the entry is left out of a sparse matrix.
    fn is_nothing(&self) -> bool;
}

impl MatrixEntry for Expr<'_> {
    const ZERO: Self = Expr::ZERO;
    const IS_SPARSE: bool = true;
    fn is_nothing(&self) -> bool {
        self.is_zero()
    }
}

macro_rules! held_whole {
    ($($number:ty: $zero:expr),*) => {
        $(impl MatrixEntry for $number {
            const ZERO: Self = $zero;
            const IS_SPARSE: bool = false;
            fn is_nothing(&self) -> bool {
                *self == $zero
            }
        })*
    };
}
held_whole!(f64: 0.0, Number: Number::ZERO, Residue: Residue::ZERO);

/// A rows × columns matrix, indexed by `(row, column)`.
#[derive(Clone, Debug)]
pub struct Matrix<T> {
    rows: usize,
    columns: usize,
    /// All entries, row by row, in a dense matrix.
    all: Vec<T>,
    /// The stored entries of each row of a sparse matrix, as pairs of column and entry, in ascending order of
    /// columns.
    held: Vec<Vec<(usize, T)>>,
    zero: T,
}

impl<T: MatrixEntry> Matrix<T> {
    /// The matrix with entry `f(i, j)` in row i and column j.
    pub fn from_fn(rows: usize, columns: usize, mut f: impl FnMut(usize, usize) -> T) -> Matrix<T> {
        let mut matrix = Matrix { rows, columns, all: Vec::new(), held: Vec::new(), zero: T::ZERO };
        if T::IS_SPARSE {
            let mut row =
                |i| (0..columns).map(|j| (j, f(i, j))).filter(|(_, entry)| !entry.is_nothing()).collect();
            matrix.held = (0..rows).map(&mut row).collect();
        } else {
            matrix.all = (0..rows * columns).map(|index| f(index / columns, index % columns)).collect();
        }
        matrix
    }

    /// The matrix with `columns` columns and these entries in each row, given with their columns in ascending
    /// order; other entries are zero.
    ///
    /// # Panics
    /// If a column is out of range.
    pub fn from_rows(columns: usize, rows: Vec<Vec<(usize, T)>>) -> Matrix<T> {
        assert!(rows.iter().flatten().all(|&(j, _)| j < columns), "a column beyond the last");
        if !T::IS_SPARSE {
            let mut matrix = Matrix::from_fn(rows.len(), columns, |_, _| T::ZERO);
            for (i, row) in rows.iter().enumerate() {
                row.iter().for_each(|&(j, entry)| matrix[(i, j)] = entry);
            }
            return matrix;
        }
        let mut held = rows;
        held.iter_mut().for_each(|row| row.retain(|(_, entry)| !entry.is_nothing()));
        Matrix { rows: held.len(), columns, all: Vec::new(), held, zero: T::ZERO }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Row `i`, including zeros.
    pub fn row(&self, i: usize) -> Cow<'_, [T]> {
        if !T::IS_SPARSE {
            return Cow::Borrowed(&self.all[i * self.columns..(i + 1) * self.columns]);
        }
        let mut row = vec![T::ZERO; self.columns];
        self.held[i].iter().for_each(|&(j, entry)| row[j] = entry);
        Cow::Owned(row)
    }

    /// The nonzero entries of row `i`, with their columns in ascending order.
    pub fn nonzero(&self, i: usize) -> impl Iterator<Item = (usize, T)> + Clone + '_ {
        let all = if T::IS_SPARSE { &[] } else { &self.all[i * self.columns..(i + 1) * self.columns] };
        let held = if T::IS_SPARSE { self.held[i].as_slice() } else { &[] };
        let all = all.iter().copied().enumerate();
        all.chain(held.iter().copied()).filter(|(_, entry)| !entry.is_nothing())
    }

    /// The nonzero entries of each row, with their columns in ascending order.
    pub fn nonzero_rows(&self) -> Vec<Vec<(usize, T)>> {
        (0..self.rows).map(|i| self.nonzero(i).collect()).collect()
    }

    /// The nonzero entries, row by row.
    pub fn nonzero_entries(&self) -> Vec<T> {
        (0..self.rows).flat_map(|i| self.nonzero(i)).map(|(_, entry)| entry).collect()
    }

    /// The matrix with each of its [entries that are not zero](Matrix::nonzero_entries) replaced by the
    /// corresponding one of `entries`.
    ///
    /// # Panics
    /// If there are fewer `entries` than nonzero entries.
    #[must_use]
    pub fn with_nonzero_entries(&self, entries: &[T]) -> Matrix<T> {
        let mut next = 0;
        let mut replaced = |(j, _)| {
            next += 1;
            (j, entries[next - 1])
        };
        let rows = (0..self.rows).map(|i| self.nonzero(i).map(&mut replaced).collect());
        Matrix::from_rows(self.columns, rows.collect())
    }

    /// Column `j`.
    pub fn column(&self, j: usize) -> impl Iterator<Item = T> + '_ {
        (0..self.rows).map(move |i| self[(i, j)])
    }

    /// All entries, row by row, including zeros.
    pub fn entries(&self) -> Cow<'_, [T]> {
        if !T::IS_SPARSE {
            return Cow::Borrowed(&self.all);
        }
        let mut entries = vec![T::ZERO; self.rows * self.columns];
        for (i, row) in self.held.iter().enumerate() {
            row.iter().for_each(|&(j, entry)| entries[i * self.columns + j] = entry);
        }
        Cow::Owned(entries)
    }

    /// The rows as vectors.
    pub fn to_rows(&self) -> Vec<Vec<T>> {
        (0..self.rows).map(|i| self.row(i).into_owned()).collect()
    }

    /// The transpose.
    #[must_use]
    pub fn transpose(&self) -> Matrix<T> {
        let mut columns = vec![Vec::new(); self.columns];
        for i in 0..self.rows {
            self.nonzero(i).for_each(|(j, entry)| columns[j].push((i, entry)));
        }
        Matrix::from_rows(self.rows, columns)
    }

    /// The matrix with `f` applied to every entry; `f` must map 0 to 0.
    #[must_use]
    pub fn map<S: MatrixEntry>(&self, mut f: impl FnMut(T) -> S) -> Matrix<S> {
        if !T::IS_SPARSE {
            return Matrix::from_fn(self.rows, self.columns, |i, j| f(self[(i, j)]));
        }
        let mut row = |i| self.nonzero(i).map(|(j, entry)| (j, f(entry))).collect();
        Matrix::from_rows(self.columns, (0..self.rows).map(&mut row).collect())
    }

    fn place(&self, (i, j): (usize, usize)) -> Result<usize, usize> {
        assert!(j < self.columns, "a column beyond the last");
        self.held[i].binary_search_by_key(&j, |&(column, _)| column)
    }
}

impl<T: MatrixEntry> PartialEq for Matrix<T> {
    fn eq(&self, other: &Matrix<T>) -> bool {
        (self.rows, self.columns) == (other.rows, other.columns)
            && self.all == other.all
            && (0..self.held.len()).all(|i| self.nonzero(i).eq(other.nonzero(i)))
    }
}

impl<T: MatrixEntry> Index<(usize, usize)> for Matrix<T> {
    type Output = T;
    fn index(&self, (i, j): (usize, usize)) -> &T {
        if T::IS_SPARSE {
            return self.place((i, j)).map_or(&self.zero, |place| &self.held[i][place].1);
        }
        &self.all[i * self.columns + j]
    }
}

impl<T: MatrixEntry> IndexMut<(usize, usize)> for Matrix<T> {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut T {
        if !T::IS_SPARSE {
            return &mut self.all[i * self.columns + j];
        }
        let place = self.place((i, j)).unwrap_or_else(|place| {
            self.held[i].insert(place, (j, T::ZERO));
            place
        });
        &mut self.held[i][place].1
    }
}

impl<'g> Matrix<Expr<'g>> {
    /// The identity matrix with n rows.
    pub fn identity(n: usize) -> Matrix<Expr<'g>> {
        Matrix::from_rows(n, (0..n).map(|i| vec![(i, Expr::ONE)]).collect())
    }

    /// The product with another matrix, which must have as many rows as this matrix has columns; only nonzero
    /// terms cost operations.
    ///
    /// # Panics
    /// If the other matrix has fewer rows.
    pub fn times(&self, graph: &'g Graph, other: &Matrix<Expr<'g>>) -> Matrix<Expr<'g>> {
        let row = |i: usize| {
            let mut terms: BTreeMap<usize, Vec<Expr<'g>>> = BTreeMap::new();
            for (m, entry) in self.nonzero(i) {
                for (j, factor) in other.nonzero(m) {
                    terms.entry(j).or_default().push(entry * factor);
                }
            }
            terms.into_iter().map(|(j, terms)| (j, graph.sum(terms))).collect()
        };
        Matrix::from_rows(other.columns, (0..self.rows).map(row).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_entries_of_a_sparse_matrix() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let entry = |i: usize, j: usize| match (i, j) {
            (0, 2) => x,
            (1, 0) => y,
            _ => Expr::ZERO,
        };
        let mut a = Matrix::from_fn(2, 3, entry);
        assert_eq!(a, Matrix::from_rows(3, vec![vec![(2, x)], vec![(0, y), (1, Expr::ZERO)]]));
        assert_eq!(a.entries().to_vec(), [Expr::ZERO, Expr::ZERO, x, y, Expr::ZERO, Expr::ZERO]);
        assert_eq!(
            (a[(0, 2)], a[(0, 1)], a.row(1).to_vec()),
            (x, Expr::ZERO, vec![y, Expr::ZERO, Expr::ZERO])
        );
        assert_eq!(a.transpose(), Matrix::from_fn(3, 2, |i, j| entry(j, i)));
        assert_eq!(a.map(|entry| 2.0 * entry)[(1, 0)], 2.0 * y);
        // An entry written and cleared leaves the same matrix as one that never had it.
        let before = a.clone();
        a[(0, 0)] = y;
        assert_ne!(a, before);
        assert_eq!(a.nonzero(0).collect::<Vec<_>>(), [(0, y), (2, x)]);
        a[(0, 0)] = Expr::ZERO;
        assert_eq!(a, before);
        assert_eq!(a.nonzero_entries(), [x, y]);
    }

    #[test]
    fn products_are_those_of_all_entries() {
        let graph = Graph::new();
        let symbol = |name: &str, i: usize, j: usize| graph.symbol(&format!("{name}{i}{j}"));
        let a = Matrix::from_fn(3, 4, |i, j| if (i + j) % 3 == 0 { Expr::ZERO } else { symbol("a", i, j) });
        let b = Matrix::from_fn(4, 2, |i, j| if i == 2 * j { Expr::ZERO } else { symbol("b", i, j) });
        let whole = |i: usize, j: usize| graph.dot(a.row(i).iter().copied(), b.column(j));
        assert_eq!(a.times(&graph, &b), Matrix::from_fn(3, 2, whole));
        assert_eq!(a.times(&graph, &Matrix::identity(4)), a);
    }

    #[test]
    fn matrices_of_numbers_are_dense() {
        let a = Matrix::from_rows(2, vec![vec![(1, 3.0)], vec![(0, -1.0)]]);
        assert_eq!(*a.entries(), [0.0, 3.0, -1.0, 0.0]);
        assert_eq!(a.nonzero_rows(), [[(1, 3.0)], [(0, -1.0)]]);
        assert_eq!(a.map(|entry| entry + 1.0)[(0, 0)], 1.0);
    }

    #[test]
    #[should_panic(expected = "a column beyond the last")]
    fn there_is_no_column_beyond_the_last() {
        let _ = Matrix::<Expr<'_>>::identity(2)[(0, 2)];
    }
}
