//! Lie algebras given by structure constants.

use std::collections::BTreeMap;

use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::jacobi::check_jacobi;
use crate::linear_algebra::matrix::Matrix;

/// A Lie algebra with basis X_1..X_k and exact structure constants: [X_r, X_s] = c_rs^m X_m (5).
#[derive(Clone, Debug, PartialEq)]
pub struct LieAlgebra {
    dim: usize,
    /// The c_rs^m that are not 0, with the keys (r, s, m), counted from 0.
    nonzero: BTreeMap<(usize, usize, usize), Number>,
}

impl LieAlgebra {
    /// The algebra with `c(r, s, m)` = c_rs^m, where indices run from 0 to `dim` − 1.
    ///
    /// # Errors
    /// [`AlgebraError::NotSkew`] and [`AlgebraError::Jacobi`], with the indices counted from 1.
    pub fn new(dim: usize, c: impl Fn(usize, usize, usize) -> Number) -> Result<LieAlgebra, AlgebraError> {
        let algebra = LieAlgebra::from_constants(dim, c);
        algebra.check_antisymmetry()?;
        let all: Vec<_> = algebra.nonzero().map(|(r, s, m, c)| (r + 1, s + 1, m + 1, c)).collect();
        check_jacobi(dim, &all)?;
        Ok(algebra)
    }

    /// The algebra with constants that are known to satisfy Jacobi's identity.
    pub(crate) fn from_constants(dim: usize, c: impl Fn(usize, usize, usize) -> Number) -> LieAlgebra {
        let all = indices(dim).map(|(r, s, m)| ((r, s, m), c(r, s, m)));
        LieAlgebra { dim, nonzero: all.filter(|(_, c)| !c.is_zero()).collect() }
    }

    /// The algebra with the c_rs^m listed as (r, s, m, c_rs^m), r < s; they are known to satisfy Jacobi's
    /// identity, and indices are counted from 0.
    pub(crate) fn from_upper(
        dim: usize,
        upper: impl Iterator<Item = (usize, usize, usize, Number)>,
    ) -> LieAlgebra {
        let both = upper.flat_map(|(r, s, m, c)| [((r, s, m), c), ((s, r, m), -c)]);
        LieAlgebra { dim, nonzero: both.collect() }
    }

    /// The algebra whose brackets [X_r, X_s] = Σ value·X_m are listed as (r, s, m, value), with indices
    /// counted from 0; the brackets of the pairs (s, r) follow from these, and pairs that are not listed
    /// commute.
    ///
    /// # Errors
    /// As for [`new`](LieAlgebra::new); a list that contradicts itself is not antisymmetric.
    pub fn from_brackets(
        dim: usize,
        brackets: &[(usize, usize, usize, Number)],
    ) -> Result<LieAlgebra, AlgebraError> {
        let listed = |r, s, m| {
            brackets.iter().filter(|b| (b.0, b.1, b.2) == (r, s, m)).fold(Number::ZERO, |sum, b| sum + b.3)
        };
        let is_listed = |r, s| brackets.iter().any(|b| (b.0, b.1) == (r, s));
        LieAlgebra::new(dim, |r, s, m| if is_listed(r, s) { listed(r, s, m) } else { -listed(s, r, m) })
    }

    /// The commutative algebra of the given dimension.
    pub fn commutative(dim: usize) -> LieAlgebra {
        LieAlgebra { dim, nonzero: BTreeMap::new() }
    }

    /// Dimension k.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// The structure constant c_rs^m, with indices counted from 0.
    pub fn constant(&self, r: usize, s: usize, m: usize) -> Number {
        self.nonzero.get(&(r, s, m)).copied().unwrap_or(Number::ZERO)
    }

    /// The c_rs^m that are not 0, as (r, s, m, c_rs^m), with indices counted from 0; both (r, s, m) and (s,
    /// r, m) are listed.
    pub fn nonzero(&self) -> impl Iterator<Item = (usize, usize, usize, Number)> + '_ {
        self.nonzero.iter().map(|(&(r, s, m), &c)| (r, s, m, c))
    }

    /// The bracket of two vectors, [u, v]^m = c_rs^m u_r v_s; all have length [`dim`](LieAlgebra::dim).
    pub fn bracket(&self, u: &[f64], v: &[f64]) -> Vec<f64> {
        let mut bracket = vec![0.0; self.dim];
        for (r, s, m, c) in self.nonzero() {
            bracket[m] += c.to_f64() * u[r] * v[s];
        }
        bracket
    }

    /// The matrix of ad x = [x, ·], whose entry (m, s) is c_rs^m x_r; `x` has length
    /// [`dim`](LieAlgebra::dim).
    ///
    /// ```
    /// # use pc_algebra::{LieAlgebra, Matrix};
    /// let ad = LieAlgebra::so3().ad(&[0, 0, 1]); // e_3 × ·
    /// assert_eq!(ad.to_rows(), [[0, -1, 0], [1, 0, 0], [0, 0, 0]].map(|row| row.map(Into::into)));
    /// ```
    pub fn ad<T: Copy + Into<Number>>(&self, x: &[T]) -> Matrix<Number> {
        let mut ad = Matrix::from_fn(self.dim, self.dim, |_, _| Number::ZERO);
        for (r, s, m, c) in self.nonzero() {
            ad[(m, s)] = ad[(m, s)] + c * x[r].into();
        }
        ad
    }

    /// The matrix −(ad x)ᵀ of the coadjoint action on covectors, whose entry (s, m) is −c_rs^m x_r.
    ///
    /// The bracket terms in (9) are v_s = c_rs^m η_r p_m, that is, v = −coad(η) p.
    pub fn coad<T: Copy + Into<Number>>(&self, x: &[T]) -> Matrix<Number> {
        self.ad(x).transpose().map(|entry| -entry)
    }

    fn check_antisymmetry(&self) -> Result<(), AlgebraError> {
        for (r, s, m, value) in self.nonzero() {
            let transposed = self.constant(s, r, m);
            if value != -transposed {
                let (r, s, value, transposed) =
                    if r <= s { (r, s, value, transposed) } else { (s, r, transposed, value) };
                let [value, transposed] = [value, transposed].map(|c| c.to_string());
                return Err(AlgebraError::NotSkew { r: r + 1, s: s + 1, m: m + 1, value, transposed });
            }
        }
        Ok(())
    }
}

/// All (r, s, m) from 0.
fn indices(k: usize) -> impl Iterator<Item = (usize, usize, usize)> + use<> {
    (0..k).flat_map(move |r| (0..k).flat_map(move |s| (0..k).map(move |m| (r, s, m))))
}
