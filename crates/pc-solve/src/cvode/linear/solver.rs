//! Linear solvers.

use crate::cvode::linear::krylov::Krylov;

/// How the linear systems (I − γ ∂f/∂y) x = b of Newton's iteration are solved.
///
/// The default [choice](crate::Options::linear_solver) is [`Sparse`](LinearSolver::Sparse) for a
/// field that knows its [zero pattern](pc_expr::VectorField::sparsity), with at least 60 components
/// and at most one nonzero entry in eight, else [`Dense`](LinearSolver::Dense).
#[derive(Debug, Clone, PartialEq)]
pub enum LinearSolver {
    /// LU factors of the whole matrix, computed by SUNDIALS, or by the crate `faer` from 64
    /// components on.
    ///
    /// ∂f/∂y is the field's [Jacobian](pc_expr::VectorField::jacobian), or else difference
    /// quotients, with one evaluation of f for each component.
    Dense,

    /// LU factors of a band matrix, whose nonzero entries (i, j) satisfy −`upper` ≤ i − j ≤
    /// `lower`.
    ///
    /// ∂f/∂y is the field's [sparse Jacobian](pc_expr::VectorField::sparse_jacobian) if it has one
    /// and knows its zero pattern, or else difference quotients, with one evaluation of f for each
    /// of the lower + upper + 1 diagonals. A known pattern must lie in the band.
    Band {
        /// The number of diagonals below the main one.
        lower: usize,
        /// The number of diagonals above the main one.
        upper: usize,
    },

    /// Sparse LU factors, computed by the crate `faer`; the elimination order is determined only
    /// once.
    ///
    /// Requires the field's [zero pattern](pc_expr::VectorField::sparsity). ∂f/∂y is the field's
    /// [sparse Jacobian](pc_expr::VectorField::sparse_jacobian), or else difference quotients, with
    /// one evaluation of f for each colour of the pattern [Curtis, Powell, Reid 1974].
    Sparse,

    /// Matrix-free GMRES [Saad, Schultz 1986], with the field's
    /// [products](pc_expr::VectorField::jvp) (∂f/∂y) v, or else difference quotients along v.
    Krylov(Krylov),
}
