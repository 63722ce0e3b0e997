//! Rank and index: dimensions at almost all elements of an algebra and of its dual.

use pc_expr::{Number, Residue, ResidueEchelon};

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The number of random points at which a rank is computed; the largest result is taken.
const POINTS: u64 = 2;

impl LieAlgebra {
    /// The rank: the dimension of the Cartan subalgebras, which is the multiplicity of the eigenvalue 0 of ad
    /// x for almost all x.
    ///
    /// That multiplicity is k − rank (ad x)^p for any p ≥ k. The multiplicity is computed modulo the prime
    /// 2⁶¹ − 1 at two fixed pseudo-random points x, without rounding. At a special point or modulo a prime
    /// the rank of a matrix can only be lower, so the result is never too small. By the lemma of Schwartz and
    /// Zippel, the result is too large with a probability below 2k²/2⁶¹ at each point, unless the prime
    /// divides all coefficients of a minor of (ad x)^p.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// assert_eq!(LieAlgebra::so(4)?.rank()?, 2);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn rank(&self) -> Result<usize, AlgebraError> {
        let (k, c) = (self.dim(), self.residues()?);
        let largest = (0..POINTS).map(|index| {
            let x = point(k, index);
            let mut power = contraction(k, &c, |r, s, m| (m, s, x[r]));
            let mut exponent = 1;
            while exponent < k {
                power = Matrix::from_fn(k, k, |i, j| (0..k).map(|l| power[(i, l)] * power[(l, j)]).sum());
                exponent *= 2;
            }
            rank(&power)
        });
        Ok(k - largest.max().unwrap_or(0))
    }

    /// The index: k − rank of the matrix c_rs^m ξ_m for almost all ξ of the dual space, which is the
    /// codimension of the largest coadjoint orbits and so the number of independent Casimir functions near
    /// such a ξ (J. Dixmier, *Enveloping Algebras*).
    ///
    /// The index is computed like the [`rank`](LieAlgebra::rank), with the probability k/2⁶¹ in place of
    /// 2k²/2⁶¹.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// assert_eq!(LieAlgebra::se3().index()?, 2); // Casimirs p·p and p·m
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn index(&self) -> Result<usize, AlgebraError> {
        let (k, c) = (self.dim(), self.residues()?);
        let largest = (0..POINTS).map(|index| {
            let xi = point(k, index);
            rank(&contraction(k, &c, |r, s, m| (r, s, xi[m])))
        });
        Ok(k - largest.max().unwrap_or(0))
    }

    /// The structure constants that are not 0, modulo the prime.
    fn residues(&self) -> Result<Vec<(usize, usize, usize, Residue)>, AlgebraError> {
        self.exact()?; // names a constant that is not rational
        let residue = |(r, s, m, c): (usize, usize, usize, Number)| Some((r, s, m, c.residue()?));
        Ok(self.nonzero().filter_map(residue).collect())
    }
}

/// The k × k matrix that is the sum of contributions of the constants: c_rs^m adds c_rs^m·y to the entry (i,
/// j), where (i, j, y) = `place`(r, s, m).
fn contraction(
    k: usize,
    c: &[(usize, usize, usize, Residue)],
    place: impl Fn(usize, usize, usize) -> (usize, usize, Residue),
) -> Matrix<Residue> {
    let mut matrix = Matrix::from_fn(k, k, |_, _| Residue::ZERO);
    for &(r, s, m, c) in c {
        let (i, j, y) = place(r, s, m);
        matrix[(i, j)] = matrix[(i, j)] + c * y;
    }
    matrix
}

/// Point number `index` of a fixed pseudo-random sequence.
fn point(dim: usize, index: u64) -> Vec<Residue> {
    Residue::sequence(index << 32).take(dim).collect()
}

fn rank(matrix: &Matrix<Residue>) -> usize {
    let mut echelon = ResidueEchelon::new(matrix.columns());
    (0..matrix.rows()).for_each(|i| echelon.insert(matrix.row(i).to_vec()));
    echelon.rank()
}
