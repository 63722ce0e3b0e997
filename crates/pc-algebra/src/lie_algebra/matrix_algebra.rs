//! Lie algebras of matrices.

use num_rational::BigRational;
use num_traits::{One, Zero};
use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::lie_algebra::structure_constants::exact_matrix;
use crate::linear_algebra::echelon::Echelon;
use crate::linear_algebra::matrix::Matrix;

impl LieAlgebra {
    /// The algebra that has n × n matrices X_s as its basis and the commutator X_r X_s − X_s X_r as its
    /// bracket.
    ///
    /// # Errors
    /// [`AlgebraError::DependentMatrices`] and [`AlgebraError::NotMatrixAlgebra`], with the numbers of
    /// the matrices; [`AlgebraError::Shape`], [`AlgebraError::IrrationalEntry`],
    /// [`AlgebraError::TooLarge`].
    ///
    /// ```
    /// # use pc_algebra::{LieAlgebra, Matrix};
    /// let [h, e, f] = [[[1, 0], [0, -1]], [[0, 1], [0, 0]], [[0, 0], [1, 0]]]
    ///     .map(|rows| Matrix::from_fn(2, 2, |i, j| rows[i][j].into()));
    /// assert_eq!(LieAlgebra::of_matrices(&[h, e, f])?, LieAlgebra::sl2());
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn of_matrices(basis: &[Matrix<Number>]) -> Result<LieAlgebra, AlgebraError> {
        let (k, n) = (basis.len(), basis.first().map_or(0, Matrix::rows));
        for matrix in basis {
            let found = matrix.rows().max(matrix.columns()).max(n);
            if (matrix.rows(), matrix.columns()) != (found, found) || found != n {
                return Err(AlgebraError::Shape { what: "a row or column of a matrix", found, expected: n });
            }
        }
        let basis: Vec<_> = basis.iter().map(|x| exact_matrix("a matrix", x)).collect::<Result<_, _>>()?;
        let coordinates = Coordinates::new(&basis, n)?;
        let mut constants = Vec::with_capacity(k * k);
        for r in 0..k {
            for s in 0..k {
                let bracket = coordinates.of(&commutator(&basis[r], &basis[s]));
                constants.push(bracket.ok_or(AlgebraError::NotMatrixAlgebra { pair: (r + 1, s + 1) })?);
            }
        }
        LieAlgebra::from_exact(k, |r, s, m| constants[r * k + s][m].clone())
    }
}

/// XY − YX
fn commutator(x: &[Vec<BigRational>], y: &[Vec<BigRational>]) -> Vec<Vec<BigRational>> {
    let n = x.len();
    let entry = |i: usize, j: usize| -> BigRational {
        (0..n).map(|l| &x[i][l] * &y[l][j] - &y[i][l] * &x[l][j]).sum()
    };
    (0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect()
}

/// Computes the coordinates of matrices in a basis, from the echelon form of the rows X_s | e_s.
struct Coordinates {
    echelon: Echelon,
    entries: usize,
}

impl Coordinates {
    fn new(basis: &[Vec<Vec<BigRational>>], n: usize) -> Result<Coordinates, AlgebraError> {
        let (k, entries) = (basis.len(), n * n);
        let mut echelon = Echelon::new(entries + k);
        for (s, matrix) in basis.iter().enumerate() {
            let unit = (0..k).map(|m| if m == s { BigRational::one() } else { BigRational::zero() });
            echelon.insert(matrix.concat().into_iter().chain(unit).collect());
            if echelon.pivots().iter().any(|&pivot| pivot >= entries) {
                return Err(AlgebraError::DependentMatrices { number: s + 1 });
            }
        }
        Ok(Coordinates { echelon, entries })
    }

    /// The coordinates of a matrix, if it is in the span of the basis.
    fn of(&self, matrix: &[Vec<BigRational>]) -> Option<Vec<BigRational>> {
        let mut row = matrix.concat();
        row.resize(self.echelon.columns(), BigRational::zero());
        self.echelon.reduce(&mut row);
        let (rest, tail) = row.split_at(self.entries);
        rest.iter().all(Zero::is_zero).then(|| tail.iter().map(|x| -x).collect())
    }
}
