//! Lie algebras given by structure constants.

use std::ops::RangeInclusive;

use pc_expr::{Number, Scalar};

use crate::error::AlgebraError;
use crate::identity::running_error::Weighed;
use crate::linear_algebra::matrix::Matrix;

/// A Lie algebra with basis X_1..X_k and exact structure constants: [X_r, X_s] = c_rs^m X_m (5).
#[derive(Clone, Debug, PartialEq)]
pub struct LieAlgebra {
    dim: usize,
    /// c_rs^m at (r·k + s)·k + m, from 0.
    constants: Vec<Number>,
}

impl LieAlgebra {
    /// The algebra with `c(r, s, m)` = c_rs^m; indices from 0 to `dim` − 1.
    ///
    /// # Errors
    /// [`AlgebraError::NotSkew`] and [`AlgebraError::Jacobi`], naming the indices (from 1).
    pub fn new(dim: usize, c: impl Fn(usize, usize, usize) -> Number) -> Result<LieAlgebra, AlgebraError> {
        let algebra = LieAlgebra::from_constants(dim, c);
        algebra.check_antisymmetry()?;
        check_jacobi(1..=dim, |r, s, m| algebra.constant(r - 1, s - 1, m - 1))?;
        Ok(algebra)
    }

    /// The algebra with constants that are known to be those of one.
    pub(crate) fn from_constants(dim: usize, c: impl Fn(usize, usize, usize) -> Number) -> LieAlgebra {
        LieAlgebra { dim, constants: indices(dim).map(|(r, s, m)| c(r, s, m)).collect() }
    }

    /// The algebra whose brackets [X_r, X_s] = Σ value·X_m are listed as (r, s, m, value), from 0; those of
    /// the pairs (s, r) follow, and pairs that are not listed commute.
    ///
    /// # Errors
    /// As [`new`](LieAlgebra::new), if the list contradicts itself.
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
        LieAlgebra::from_constants(dim, |_, _, _| Number::ZERO)
    }

    /// Dimension k.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// c_rs^m, indices from 0.
    pub fn constant(&self, r: usize, s: usize, m: usize) -> Number {
        self.constants[(r * self.dim + s) * self.dim + m]
    }

    /// The bracket of two vectors, [u, v]^m = c_rs^m u_r v_s; all have length [`dim`](LieAlgebra::dim).
    pub fn bracket(&self, u: &[f64], v: &[f64]) -> Vec<f64> {
        let k = self.dim;
        (0..k)
            .map(|m| {
                (0..k)
                    .flat_map(|r| (0..k).map(move |s| (r, s)))
                    .map(|(r, s)| self.constant(r, s, m).to_f64() * u[r] * v[s])
                    .sum()
            })
            .collect()
    }

    /// The matrix of ad x = [x, ·], entry (m, s) c_rs^m x_r; `x` has length [`dim`](LieAlgebra::dim).
    ///
    /// ```
    /// # use pc_algebra::{LieAlgebra, Matrix};
    /// let ad = LieAlgebra::so3().ad(&[0, 0, 1]); // e_3 × ·
    /// assert_eq!(ad.to_rows(), [[0, -1, 0], [1, 0, 0], [0, 0, 0]].map(|row| row.map(Into::into)));
    /// ```
    pub fn ad<T: Copy + Into<Number>>(&self, x: &[T]) -> Matrix<Number> {
        let k = self.dim;
        Matrix::from_fn(k, k, |m, s| {
            (0..k).fold(Number::ZERO, |sum, r| sum + self.constant(r, s, m) * x[r].into())
        })
    }

    /// The matrix −(ad x)ᵀ of the coadjoint action on covectors, entry (s, m) −c_rs^m x_r.
    ///
    /// The brackets of (9) are v_s = c_rs^m η_r p_m: v = −coad(η) p.
    pub fn coad<T: Copy + Into<Number>>(&self, x: &[T]) -> Matrix<Number> {
        self.ad(x).transpose().map(|entry| -entry)
    }

    /// All (r, s, m) from 0.
    pub(crate) fn indices(&self) -> impl Iterator<Item = (usize, usize, usize)> + use<> {
        indices(self.dim)
    }

    fn check_antisymmetry(&self) -> Result<(), AlgebraError> {
        let k = self.dim;
        for (r, s, m) in indices(k) {
            let (value, transposed) = (self.constant(r, s, m), self.constant(s, r, m));
            if value != -transposed {
                let [value, transposed] = [value, transposed].map(|c| c.to_string());
                return Err(AlgebraError::NotSkew { r: r + 1, s: s + 1, m: m + 1, value, transposed });
            }
        }
        Ok(())
    }
}

/// c_rs^p c_pu^m + c_su^p c_pr^m + c_ur^p c_ps^m = 0 for r < s < u among the `operators`, which begin with 1, or with 0 for
/// time; `c`(r, s, m) = c_rs^m, where m is from 1.
///
/// # Errors
/// [`AlgebraError::Jacobi`].
pub(crate) fn check_jacobi(
    operators: RangeInclusive<usize>,
    c: impl Fn(usize, usize, usize) -> Number,
) -> Result<(), AlgebraError> {
    let k = *operators.end();
    let triples =
        operators.clone().flat_map(|r| (r + 1..=k).flat_map(move |s| (s + 1..=k).map(move |u| (r, s, u))));
    for (r, s, u) in triples {
        let cycles = [(r, s, u), (s, u, r), (u, r, s)];
        let inner: Vec<(usize, usize, Number)> = cycles
            .iter()
            .flat_map(|&(r, s, u)| (1..=k).map(move |p| (r, s, p, u)))
            .map(|(r, s, p, u)| (p, u, c(r, s, p)))
            .filter(|(.., first)| !first.is_zero())
            .collect();
        for component in (1..=k).filter(|_| !inner.is_empty()) {
            let (mut defect, mut size) = (Number::ZERO, Weighed::from_f64(0.0));
            for &(p, u, first) in &inner {
                let second = c(p, u, component);
                defect = defect + first * second;
                size = size + Weighed::constant(first) * Weighed::constant(second);
            }
            // Rational constants give an exact 0; constants rounded to f64 a few units of rounding.
            let vanishes = defect.to_f64().abs() <= 1e-12 * size.size();
            if !vanishes {
                return Err(AlgebraError::Jacobi {
                    triple: (r, s, u),
                    component,
                    defect: defect.to_string(),
                });
            }
        }
    }
    Ok(())
}

fn indices(k: usize) -> impl Iterator<Item = (usize, usize, usize)> + use<> {
    (0..k).flat_map(move |r| (0..k).flat_map(move |s| (0..k).map(move |m| (r, s, m))))
}
