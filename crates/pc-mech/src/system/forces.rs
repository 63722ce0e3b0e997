//! Generalised forces Q_s in the forms in which they are given.

use pc_algebra::{Frame, Matrix};
use pc_expr::Expr;

use crate::error::{MatrixError, MechError, shape};

/// A part of Q_1..Q_k.
#[derive(Clone, Debug)]
pub(crate) enum Force<'g> {
    /// Q_s
    OnQuasiVelocities(Vec<Expr<'g>>),
    /// Forces F_i on the coordinates, with the power F_i ẋ_i: Q_s = b_is F_i = F · X_s x.
    OnCoordinates(Vec<Expr<'g>>),
    /// Rayleigh's R: Q_s = −∂R/∂η_s.
    Dissipation(Expr<'g>),
    /// Γ, antisymmetric: Q_s = Γ_sr η_r.
    Gyroscopic(Matrix<Expr<'g>>),
}

impl<'g> Force<'g> {
    /// The components Q_1..Q_k in the frame of the quasi-velocities `eta`.
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError), [`MatrixError::NotSkew`].
    pub(crate) fn components(&self, frame: &Frame<'g>, eta: &[Expr<'g>]) -> Result<Vec<Expr<'g>>, MechError> {
        let (graph, k) = (frame.graph(), eta.len());
        match self {
            Force::OnQuasiVelocities(q) => {
                shape("the list of forces", q.len(), k)?;
                Ok(q.clone())
            }
            Force::OnCoordinates(f) => {
                shape("the list of forces on coordinates", f.len(), frame.coordinates().len())?;
                Ok(frame.contract(f))
            }
            Force::Dissipation(r) => Ok(graph.gradient(*r, eta).into_iter().map(|slope| -slope).collect()),
            Force::Gyroscopic(gamma) => {
                shape("the list of rows of the gyroscopic matrix", gamma.rows(), k)?;
                shape("the list of columns of the gyroscopic matrix", gamma.columns(), k)?;
                let pairs = (0..k).flat_map(|s| (0..=s).map(move |r| (r, s)));
                let skew = |(r, s)| graph.generic_rank(&[vec![gamma[(s, r)] + gamma[(r, s)]]]) == 0;
                match pairs.into_iter().find(|&pair| !skew(pair)) {
                    Some((r, s)) => Err(MatrixError::NotSkew {
                        what: "the matrix of gyroscopic forces",
                        pair: [eta[r].to_string(), eta[s].to_string()],
                    }
                    .into()),
                    None => {
                        Ok((0..k).map(|s| graph.dot(gamma.row(s).to_vec(), eta.iter().copied())).collect())
                    }
                }
            }
        }
    }
}
