//! Two frames of one system.

use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::frame::frame::{Frame, shape};
use crate::frame::structure::{StructureCoefficients, pairs};
use crate::identity::sample::Neighbourhood;
use crate::linear_algebra::inverse::inverse;
use crate::linear_algebra::matrix::Matrix;

/// The change η' = A η + A_0 of quasi-velocities from a frame X_s to a frame X'_s that allows the same
/// velocities.
///
/// A is k × k and regular, A_0 has length k; both depend on t and x. X_s = A_us X'_u, X_0 = X'_0 + A_u0 X'_u.
#[derive(Clone, Debug)]
pub struct FrameChange<'g> {
    to: Frame<'g>,
    matrix: Matrix<Expr<'g>>,
    drift: Vec<Expr<'g>>,
    /// B = A⁻¹ and B_0 = −B A_0, of η = B η' + B_0.
    back: (Matrix<Expr<'g>>, Vec<Expr<'g>>),
}

impl<'g> Frame<'g> {
    /// The change of quasi-velocities from this frame to `other`, by A = a' b, A_0 = a' (b_0 − b'_0) with a'
    /// b' = 1.
    ///
    /// # Errors
    /// [`AlgebraError::DifferentSpaces`]; [`AlgebraError::Shape`] if the numbers of operators differ;
    /// [`AlgebraError::DependentOperators`] if one of the frames has rank b < k;
    /// [`AlgebraError::DifferentVelocities`] with the first operator that `other` does not allow, 0 for the
    /// drift.
    ///
    /// ```
    /// # use pc_algebra::{EulerAngles, LieGroup, Neighbourhood};
    /// # use pc_expr::Graph;
    /// // From body to spatial angular velocity: A is the rotation matrix, and so(3) changes sign.
    /// let graph = Graph::new();
    /// let angles = graph.symbols(["psi", "theta", "phi"]).to_vec();
    /// let (t, near, group) = (graph.symbol("t"), Neighbourhood::default(), EulerAngles::about("zxz")?);
    /// let body = group.left_frame(&graph, t, angles.clone())?;
    /// let space = group.right_frame(&graph, t, angles.clone())?;
    /// let change = body.change_to(&space, &near)?;
    /// assert_eq!(change.matrix()[(2, 2)], angles[1].cos());
    /// let c = change.structure_coefficients(&body.structure_coefficients(&near)?)?;
    /// assert_eq!(c.get(1, 2, 3), (-1).into());
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn change_to(
        &self,
        other: &Frame<'g>,
        near: &Neighbourhood<'g>,
    ) -> Result<FrameChange<'g>, AlgebraError> {
        if (self.time(), self.coordinates()) != (other.time(), other.coordinates()) {
            return Err(AlgebraError::DifferentSpaces);
        }
        let (graph, k) = (self.graph(), self.operators());
        shape("the list of operators of the other frame", other.operators(), k)?;
        let (a, _) = other.definitions()?;
        let project = |y: &[Expr<'g>]| -> Vec<Expr<'g>> {
            (0..k).map(|u| graph.dot(a.row(u).iter().copied(), y.iter().copied())).collect()
        };
        let columns: Vec<Vec<Expr<'g>>> = (0..=k)
            .map(|s| {
                let operator: Vec<[Expr<'g>; 2]> = match s {
                    0 => self.b0().iter().zip(other.b0()).map(|(&own, &others)| [own, -others]).collect(),
                    _ => self.operator(s).into_iter().map(|entry| [entry, Expr::ZERO]).collect(),
                };
                let column = project(&operator.iter().map(|&[own, others]| own + others).collect::<Vec<_>>());
                match other.residual(&operator, &column, near) > Neighbourhood::ROUNDING {
                    true => Err(AlgebraError::DifferentVelocities { operator: s }),
                    false => Ok(column),
                }
            })
            .collect::<Result<_, _>>()?;
        let matrix = Matrix::from_fn(k, k, |u, s| columns[s + 1][u]);
        let dependent = || AlgebraError::DependentOperators { rank: self.rank(), operators: k };
        let b = inverse(graph, &matrix).ok_or_else(dependent)?;
        let drift = columns[0].clone();
        let b0 = (0..k).map(|m| -graph.dot(b.row(m).iter().copied(), drift.iter().copied())).collect();
        Ok(FrameChange { to: other.clone(), matrix, drift, back: (b, b0) })
    }
}

impl<'g> Frame<'g> {
    /// The change to the quasi-velocities η' = A η + A_0, where A is k × k and A_0 has length k, for a frame of
    /// any rank.
    ///
    /// # Errors
    /// [`AlgebraError::Shape`]; [`AlgebraError::SingularDefinitions`] if A is singular everywhere.
    ///
    /// ```
    /// # use pc_algebra::{Frame, Matrix, Neighbourhood};
    /// # use pc_expr::{Expr, Graph};
    /// // η' = ẋ₁, ẋ₂ − x₁ ẋ₁: X'_1 = ∂/∂x₁ + x₁ ∂/∂x₂, X'_2 = ∂/∂x₂.
    /// let graph = Graph::new();
    /// let [t, x1, x2] = graph.symbols(["t", "x1", "x2"]);
    /// let frame = Frame::coordinate(&graph, t, vec![x1, x2]);
    /// let a = Matrix::from_fn(2, 2, |i, j| if i == j { Expr::ONE } else if i == 1 { -x1 } else { Expr::ZERO });
    /// let change = frame.changed_by(&a, &[Expr::ZERO, Expr::ZERO])?;
    /// assert_eq!(change.frame().b()[(1, 0)], x1);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn changed_by(&self, a: &Matrix<Expr<'g>>, a0: &[Expr<'g>]) -> Result<FrameChange<'g>, AlgebraError> {
        let (graph, k) = (self.graph(), self.operators());
        shape("the matrix A", a.rows(), k)?;
        shape("the drift A_0", a0.len(), k)?;
        if is_identity(a, a0) {
            let back = (a.clone(), a0.to_vec());
            return Ok(FrameChange { to: self.clone(), matrix: a.clone(), drift: a0.to_vec(), back });
        }
        let back = inverse(graph, a).ok_or(AlgebraError::SingularDefinitions)?;
        let back0: Vec<Expr<'g>> =
            (0..k).map(|m| -graph.dot(back.row(m).iter().copied(), a0.iter().copied())).collect();
        let b = self.b().times(graph, &back);
        let b0 = self.velocities(&back0);
        let to = Frame::new(graph, self.time(), self.coordinates().to_vec(), b, b0)?;
        Ok(FrameChange { to, matrix: a.clone(), drift: a0.to_vec(), back: (back, back0) })
    }
}

/// Whether η' = A η + A_0 equals η, which makes the expensive products unnecessary.
fn is_identity(a: &Matrix<Expr<'_>>, a0: &[Expr<'_>]) -> bool {
    let entry = |i: usize, j: usize| a[(i, j)] == if i == j { Expr::ONE } else { Expr::ZERO };
    a0.iter().all(|a0| a0.is_zero()) && (0..a.rows()).all(|i| (0..a.columns()).all(|j| entry(i, j)))
}

impl<'g> FrameChange<'g> {
    /// The new frame.
    pub fn frame(&self) -> &Frame<'g> {
        &self.to
    }

    /// A, k × k.
    pub fn matrix(&self) -> &Matrix<Expr<'g>> {
        &self.matrix
    }

    /// A_0, length k.
    pub fn drift(&self) -> &[Expr<'g>] {
        &self.drift
    }

    /// B = A⁻¹, k × k.
    pub fn back(&self) -> &Matrix<Expr<'g>> {
        &self.back.0
    }

    /// The old quasi-velocities η = B η' + B_0, where `eta` is η', of length k.
    pub fn old_quasi_velocities(&self, eta: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let (graph, (b, b0)) = (self.to.graph(), &self.back);
        let row = |m: usize| b.nonzero(m).map(|(s, b)| b * eta[s]);
        (0..eta.len()).map(|m| graph.sum(row(m).chain([b0[m]]))).collect()
    }

    /// The new quasi-velocities η' = A η + A_0, where `eta` is η, of length k.
    pub fn quasi_velocities(&self, eta: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let graph = self.to.graph();
        let row = |u: usize| self.matrix.nonzero(u).map(|(s, a)| a * eta[s]);
        (0..eta.len()).map(|u| graph.sum(row(u).chain([self.drift[u]]))).collect()
    }

    /// The structure coefficients c' of the frame X' from those of the frame X:
    /// c'_rs^u = A_um (B_pr B_qs c_pq^m + X'_r B_ms − X'_s B_mr), where B = A⁻¹, p, q = 0..k and m = 1..k;
    /// B_00 = 1, B_0s = 0, and B_p0 = −B_pu A_u0.
    ///
    /// # Errors
    /// [`AlgebraError::Shape`] unless `c` has k operators.
    pub fn structure_coefficients(
        &self,
        c: &StructureCoefficients<'g>,
    ) -> Result<StructureCoefficients<'g>, AlgebraError> {
        let (graph, k) = (self.to.graph(), self.drift.len());
        shape("the list of operators of the structure coefficients", c.operators(), k)?;
        if is_identity(&self.matrix, &self.drift) {
            return Ok(c.clone());
        }
        let b: Vec<Vec<Expr<'g>>> = (0..=k).map(|s| self.old_components(s)).collect();
        StructureCoefficients::from_pairs(k, pairs(k), |r, s| {
            let forth = self.to.apply(r, &b[s]);
            let back = self.to.apply(s, &b[r]);
            let along_old: Vec<Expr<'g>> = (1..=k)
                .map(|m| {
                    let brackets = c
                        .nonzero()
                        .filter(|entry| entry.2 == m)
                        .map(|(p, q, _, c)| c * (b[r][p] * b[s][q] - b[r][q] * b[s][p]));
                    graph.sum(brackets.chain([forth[m], -back[m]]))
                })
                .collect();
            Ok((0..k)
                .map(|u| graph.dot(self.matrix.row(u).iter().copied(), along_old.iter().copied()))
                .collect())
        })
    }

    /// The components B_ps, p = 0..k, of X'_s along X_0..X_k, for s = 0..k.
    ///
    /// # Panics
    /// If s is out of range.
    pub fn old_components(&self, s: usize) -> Vec<Expr<'g>> {
        match s {
            0 => [&[Expr::ONE], self.back.1.as_slice()].concat(),
            _ => std::iter::once(Expr::ZERO).chain(self.back.0.column(s - 1)).collect(),
        }
    }
}
