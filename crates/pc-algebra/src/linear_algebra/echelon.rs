//! Reduced row echelon form over the rationals.

use num_rational::BigRational;
use num_traits::{One, Zero};

/// Independent rows in reduced echelon form: each pivot is 1, is the only nonzero entry in its column,
/// and is to the right of the pivots above it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Echelon {
    columns: usize,
    rows: Vec<Vec<BigRational>>,
    pivots: Vec<usize>,
}

impl Echelon {
    /// No rows.
    pub(crate) fn new(columns: usize) -> Echelon {
        Echelon { columns, rows: Vec::new(), pivots: Vec::new() }
    }

    /// The span of `rows`, each of length `columns`.
    pub(crate) fn of(columns: usize, rows: impl IntoIterator<Item = Vec<BigRational>>) -> Echelon {
        let mut echelon = Echelon::new(columns);
        for row in rows {
            echelon.insert(row);
        }
        echelon
    }

    /// Adds a row to the span. Returns whether the row was outside the span.
    pub(crate) fn insert(&mut self, mut row: Vec<BigRational>) -> bool {
        self.reduce(&mut row);
        let Some(pivot) = row.iter().position(|x| !x.is_zero()) else { return false };
        let scale = row[pivot].clone();
        for x in &mut row[pivot..] {
            *x /= &scale;
        }
        for other in &mut self.rows {
            subtract(other, &row, pivot);
        }
        let place = self.pivots.partition_point(|&p| p < pivot);
        self.rows.insert(place, row);
        self.pivots.insert(place, pivot);
        true
    }

    /// Subtracts from `row` an element of the span, so that the remainder is 0 in every pivot column.
    pub(crate) fn reduce(&self, row: &mut [BigRational]) {
        for (own, &pivot) in self.rows.iter().zip(&self.pivots) {
            subtract(row, own, pivot);
        }
    }

    /// Whether `row` is in the span.
    pub(crate) fn contains(&self, row: &[BigRational]) -> bool {
        let mut rest = row.to_vec();
        self.reduce(&mut rest);
        rest.iter().all(Zero::is_zero)
    }

    /// Dimension of the span.
    pub(crate) fn rank(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    pub(crate) fn rows(&self) -> &[Vec<BigRational>] {
        &self.rows
    }

    pub(crate) fn pivots(&self) -> &[usize] {
        &self.pivots
    }

    /// A basis of the space of vectors whose product with every row is 0, with one vector for each column
    /// without a pivot.
    pub(crate) fn null_space(&self) -> Vec<Vec<BigRational>> {
        (0..self.columns)
            .filter(|free| !self.pivots.contains(free))
            .map(|free| {
                let mut vector = vec![BigRational::zero(); self.columns];
                vector[free] = BigRational::one();
                for (row, &pivot) in self.rows.iter().zip(&self.pivots) {
                    vector[pivot] = -row[free].clone();
                }
                vector
            })
            .collect()
    }
}

/// Sets row ← row − row_p·other with p = `pivot`, where other_p = 1 and the entries of other before p
/// are 0.
fn subtract(row: &mut [BigRational], other: &[BigRational], pivot: usize) {
    if row[pivot].is_zero() {
        return;
    }
    let factor = row[pivot].clone();
    for (x, y) in row[pivot..].iter_mut().zip(&other[pivot..]) {
        if !y.is_zero() {
            *x -= &factor * y;
        }
    }
}

/// The inverse of a square matrix, from the echelon form of `matrix | 1`; `None` if it is singular.
pub(crate) fn inverse(matrix: &[Vec<BigRational>]) -> Option<Vec<Vec<BigRational>>> {
    let n = matrix.len();
    let unit = |i: usize| (0..n).map(move |j| if i == j { BigRational::one() } else { BigRational::zero() });
    let rows = matrix.iter().enumerate().map(|(i, row)| row.iter().cloned().chain(unit(i)).collect());
    let echelon = Echelon::of(2 * n, rows);
    let regular = echelon.pivots.iter().copied().eq(0..n);
    regular.then(|| echelon.rows.iter().map(|row| row[n..].to_vec()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(entries: &[[i64; 3]]) -> Vec<Vec<BigRational>> {
        let whole = |&x: &i64| BigRational::from_integer(x.into());
        entries.iter().map(|row| row.iter().map(whole).collect()).collect()
    }

    #[test]
    fn the_null_space_is_annihilated_and_complements_the_rank() {
        let matrix = rows(&[[1, 2, 3], [2, 4, 6], [1, 1, 1]]);
        let echelon = Echelon::of(3, matrix.clone());
        assert_eq!(echelon.rank(), 2);
        assert_eq!(echelon.null_space(), rows(&[[1, -2, 1]]));
        assert!(echelon.contains(&rows(&[[0, 1, 2]])[0]) && !echelon.contains(&rows(&[[0, 0, 1]])[0]));
    }

    #[test]
    fn the_inverse_of_the_inverse_is_the_matrix() {
        let matrix = rows(&[[0, 2, 1], [1, 0, 3], [5, 1, 1]]);
        assert_eq!(inverse(&inverse(&matrix).unwrap()).unwrap(), matrix);
        assert_eq!(inverse(&rows(&[[1, 2, 3], [2, 4, 6], [1, 1, 1]])), None);
    }
}
