//! Representations of a Lie algebra, and the semidirect products made from them.

use num_rational::BigRational;
use num_traits::Zero;
use pc_expr::Number;

use crate::error::AlgebraError;
use crate::frame::frame::shape;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::lie_algebra::structure_constants::exact_matrix;
use crate::linear_algebra::matrix::Matrix;

/// A representation ρ: g → gl(V), given by the n × n matrices ρ(X_1)..ρ(X_k):
/// ρ([x, y]) = ρ(x)ρ(y) − ρ(y)ρ(x).
#[derive(Clone, Debug, PartialEq)]
pub struct Representation {
    algebra: LieAlgebra,
    dim: usize,
    matrices: Vec<Matrix<Number>>,
}

impl Representation {
    /// The representation with ρ(X_s) = `matrices`\[s − 1\], all of which are square of size `dim`.
    ///
    /// # Errors
    /// [`AlgebraError::NotRepresentation`] with the pair of operators; [`AlgebraError::Shape`];
    /// [`AlgebraError::NotRational`] and [`AlgebraError::IrrationalEntry`].
    pub fn new(
        algebra: LieAlgebra,
        dim: usize,
        matrices: Vec<Matrix<Number>>,
    ) -> Result<Representation, AlgebraError> {
        shape("the list of matrices ρ(X_s)", matrices.len(), algebra.dim())?;
        for matrix in &matrices {
            shape("a column of a matrix ρ(X_s)", matrix.rows(), dim)?;
            shape("a row of a matrix ρ(X_s)", matrix.columns(), dim)?;
        }
        let representation = Representation { algebra, dim, matrices };
        representation.check()?;
        Ok(representation)
    }

    /// The adjoint representation, V = g and ρ(x) = ad x.
    pub fn adjoint(algebra: &LieAlgebra) -> Representation {
        let k = algebra.dim();
        let unit = |r: usize| -> Vec<Number> { (0..k).map(|s| i32::from(r == s).into()).collect() };
        let matrices = (0..k).map(|r| algebra.ad(&unit(r))).collect();
        Representation { algebra: algebra.clone(), dim: k, matrices }
    }

    /// The dual representation −ρ(x)ᵀ on V*; the dual of the adjoint representation is the coadjoint
    /// one.
    #[must_use]
    pub fn dual(&self) -> Representation {
        let matrices = self.matrices.iter().map(|rho| rho.transpose().map(|entry| -entry)).collect();
        Representation { matrices, ..self.clone() }
    }

    /// The algebra g.
    pub fn algebra(&self) -> &LieAlgebra {
        &self.algebra
    }

    /// Dimension n of V.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// ρ(X_s), s from 0; n × n.
    ///
    /// # Panics
    /// If s is not less than the dimension of the algebra.
    pub fn matrix(&self, s: usize) -> &Matrix<Number> {
        &self.matrices[s]
    }

    /// The semidirect product g ⋉ V with basis X_1..X_k, v_1..v_n: \[X_r, X_s\] as in g, \[X_s, v_j\] =
    /// ρ(X_s)_ij v_i, \[v_i, v_j\] = 0.
    ///
    /// ```
    /// # use pc_algebra::{LieAlgebra, Representation};
    /// // Rotations act on vectors as on so(3) itself: the algebra of motions, and of the heavy top.
    /// let algebra = Representation::adjoint(&LieAlgebra::so3()).semidirect_product();
    /// assert_eq!(algebra, LieAlgebra::se3());
    /// ```
    pub fn semidirect_product(&self) -> LieAlgebra {
        let k = self.algebra.dim();
        let action = |s: usize, j: usize, i: usize| self.matrices[s][(i, j)];
        LieAlgebra::from_constants(k + self.dim, |r, s, m| match (r < k, s < k, m < k) {
            (true, true, true) => self.algebra.constant(r, s, m),
            (true, false, false) => action(r, s - k, m - k),
            (false, true, false) => -action(s, r - k, m - k),
            _ => Number::ZERO,
        })
    }

    /// ρ([X_r, X_s]) = ρ(X_r)ρ(X_s) − ρ(X_s)ρ(X_r) for all r < s
    fn check(&self) -> Result<(), AlgebraError> {
        let c = self.algebra.exact()?;
        let rho: Vec<Vec<Vec<BigRational>>> =
            self.matrices.iter().map(|m| exact_matrix("a matrix ρ(X_s)", m)).collect::<Result<_, _>>()?;
        let product = |r: usize, s: usize, i: usize, j: usize| -> BigRational {
            (0..self.dim).map(|l| &rho[r][i][l] * &rho[s][l][j]).sum()
        };
        let k = self.algebra.dim();
        for (r, s) in (0..k).flat_map(|r| (r + 1..k).map(move |s| (r, s))) {
            let bracket = c.pair(r, s);
            for (i, j) in (0..self.dim).flat_map(|i| (0..self.dim).map(move |j| (i, j))) {
                let of_bracket: BigRational =
                    bracket.iter().enumerate().map(|(m, value)| value * &rho[m][i][j]).sum();
                if !(of_bracket - product(r, s, i, j) + product(s, r, i, j)).is_zero() {
                    let pair = (r + 1, s + 1);
                    return Err(AlgebraError::NotRepresentation { pair, row: i + 1, column: j + 1 });
                }
            }
        }
        Ok(())
    }
}
