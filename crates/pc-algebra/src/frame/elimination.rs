//! The operators that remain when quasi-velocities are solved for, and their brackets.

use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::frame::frame::{Frame, shape};
use crate::frame::structure::{StructureCoefficients, pairs};
use crate::identity::sample::Neighbourhood;
use crate::linear_algebra::matrix::Matrix;

/// A frame after some quasi-velocities have been expressed in terms of the others, η_D = A_DI η_I + A_D0; the
/// remaining operators are
///
///   X'_I = X_I + A_DI X_D,   X'_0 = X_0 + A_D0 X_D.
#[derive(Clone, Debug)]
pub struct Elimination<'g> {
    whole: Frame<'g>,
    /// The indices in D, then those in I, numbered from 0.
    dependent: Vec<usize>,
    free: Vec<usize>,
    /// A_DI, with a row for each index in D.
    matrix: Matrix<Expr<'g>>,
    /// A_D0
    drift: Vec<Expr<'g>>,
    frame: Frame<'g>,
}

impl<'g> Frame<'g> {
    /// The frame after elimination of the operators `dependent`, numbered from 0, by η_D = A_DI η_I + A_D0. I
    /// are the other operators in order, `matrix` is A_DI, and `drift` is A_D0.
    ///
    /// # Errors
    /// [`AlgebraError::Shape`]
    pub fn eliminated(
        &self,
        dependent: &[usize],
        matrix: Matrix<Expr<'g>>,
        drift: Vec<Expr<'g>>,
    ) -> Result<Elimination<'g>, AlgebraError> {
        let (graph, k) = (self.graph(), self.operators());
        let free: Vec<usize> = (0..k).filter(|s| !dependent.contains(s)).collect();
        shape("the matrix A", matrix.rows(), dependent.len())?;
        shape("a row of the matrix A", matrix.columns(), free.len())?;
        shape("the drift A_0", drift.len(), dependent.len())?;
        let b = self.b();
        let carried = |i: usize, a: &mut dyn Iterator<Item = Expr<'g>>| {
            graph.dot(dependent.iter().map(|&d| b[(i, d)]), a)
        };
        let left =
            Matrix::from_fn(b.rows(), free.len(), |i, s| b[(i, free[s])] + carried(i, &mut matrix.column(s)));
        let b0 = (0..b.rows()).map(|i| self.b0()[i] + carried(i, &mut drift.iter().copied())).collect();
        let left = Frame::new(graph, self.time(), self.coordinates().to_vec(), left, b0)?;
        Ok(Elimination {
            whole: self.clone(),
            dependent: dependent.to_vec(),
            free,
            matrix,
            drift,
            frame: left,
        })
    }
}

impl<'g> Elimination<'g> {
    /// The frame of the remaining operators.
    pub fn frame(&self) -> &Frame<'g> {
        &self.frame
    }

    /// The structure coefficients of the remaining operators, from those of the whole frame, whatever its rank: with
    /// B_ps the components of X'_s along X_p,
    ///
    ///   [X'_r, X'_s] = Y^m X_m,   Y^m = c_pq^m B_pr B_qs + X'_r B_ms − X'_s B_mr,   p, q = 0..k,
    ///
    /// and c'_rs^I = Y^I if Y^D = A_DI Y^I, which is the test of Frobenius.
    ///
    /// # Errors
    /// [`AlgebraError::Shape`] unless `c` has k operators; [`AlgebraError::NotClosed`] with the first pair whose
    /// bracket is not a combination of the remaining operators.
    ///
    /// ```
    /// # use pc_algebra::{Frame, LieAlgebra, Matrix, Neighbourhood};
    /// # use pc_expr::{Expr, Graph};
    /// // Without coordinates the algebra decides: [X_1, X_2] = X_2 is compatible with η_3 = 0, so(3) is not.
    /// let graph = Graph::new();
    /// let frame = Frame::new(&graph, graph.symbol("t"), vec![], Matrix::from_fn(0, 3, |_, _| Expr::ZERO), vec![])?;
    /// let plane = frame.eliminated(&[2], Matrix::from_fn(1, 2, |_, _| Expr::ZERO), vec![Expr::ZERO])?;
    /// let near = Neighbourhood::default();
    /// let algebra = LieAlgebra::from_brackets(3, &[(0, 1, 1, 1.into())])?;
    /// assert_eq!(plane.structure_coefficients(&algebra.structure_coefficients(), &near)?.get(1, 2, 2), 1.into());
    /// assert!(plane.structure_coefficients(&LieAlgebra::so3().structure_coefficients(), &near).is_err());
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn structure_coefficients(
        &self,
        c: &StructureCoefficients<'g>,
        near: &Neighbourhood<'g>,
    ) -> Result<StructureCoefficients<'g>, AlgebraError> {
        let (graph, k, l) = (self.whole.graph(), self.whole.operators(), self.free.len());
        shape("the list of operators of the structure coefficients", c.operators(), k)?;
        let components: Vec<Vec<Expr<'g>>> = (0..=l).map(|s| self.components(s)).collect();
        let bracket = |r: usize, s: usize| -> Vec<Vec<Expr<'g>>> {
            let (u, v) = (&components[r], &components[s]);
            let (forth, back) = (self.frame.apply(r, v), self.frame.apply(s, u));
            let mut terms: Vec<Vec<Expr<'g>>> = (1..=k).map(|m| vec![forth[m], -back[m]]).collect();
            for (p, q, m, c) in c.nonzero() {
                terms[m - 1].extend([c * u[p] * v[q], -(c * u[q] * v[p])]);
            }
            terms
        };
        for (r, s) in pairs(l) {
            let residual = near.residual(graph, &self.outside(&bracket(r, s)));
            if residual > Neighbourhood::ROUNDING {
                return Err(AlgebraError::NotClosed { pair: (r, s), residual });
            }
        }
        StructureCoefficients::from_pairs(l, pairs(l), |r, s| {
            let terms = bracket(r, s);
            let inside: Vec<Expr<'g>> =
                self.free.iter().map(|&m| graph.sum(terms[m].iter().copied())).collect();
            Ok(graph.shorten(&inside, &[]))
        })
    }

    /// The terms of Y^D − A_DI Y^I, for a vector field Y given by the terms of its components.
    fn outside(&self, field: &[Vec<Expr<'g>>]) -> Vec<Vec<Expr<'g>>> {
        let row = |(d, &m): (usize, &usize)| -> Vec<Expr<'g>> {
            let carried = self.matrix.nonzero(d).map(|(i, a)| (self.free[i], a));
            let carried = carried.flat_map(|(i, a)| field[i].iter().map(move |&y| -(a * y)));
            field[m].iter().copied().chain(carried).filter(|term| !term.is_zero()).collect()
        };
        self.dependent.iter().enumerate().map(row).collect()
    }

    /// B_ps for p = 0..k.
    fn components(&self, s: usize) -> Vec<Expr<'g>> {
        let mut components = vec![Expr::ZERO; self.whole.operators() + 1];
        components[s.checked_sub(1).map_or(0, |s| self.free[s] + 1)] = Expr::ONE;
        for (d, &place) in self.dependent.iter().enumerate() {
            components[place + 1] = s.checked_sub(1).map_or(self.drift[d], |s| self.matrix[(d, s)]);
        }
        components
    }
}
