//! Which linear solver.

use pc_expr::{Pattern, VectorField};

use super::krylov::Krylov;
use crate::error::InputError;
use crate::integration::options::{NonlinearSolver, Options};

/// How the linear systems (I − γ ∂f/∂y) x = b of Newton's iteration are solved.
///
/// Unless one is [chosen](Options::linear_solver), it is [`Sparse`](LinearSolver::Sparse) for a field that knows its
/// [zero pattern](VectorField::sparsity), has at least 60 components and at most one entry in eight other than zero,
/// and else [`Dense`](LinearSolver::Dense).
#[derive(Debug, Clone, PartialEq)]
pub enum LinearSolver {
    /// LU factors of the whole matrix: SUNDIALS' own, and from 64 components on those of the crate `faer`.
    ///
    /// ∂f/∂y is the field's [Jacobian](VectorField::jacobian), or comes from difference quotients, one evaluation of f
    /// for each component.
    Dense,

    /// LU factors of a band matrix, whose entries (i, j) other than zero have −`upper` ≤ i − j ≤ `lower`.
    ///
    /// ∂f/∂y is the field's [sparse Jacobian](VectorField::sparse_jacobian) if it has one and knows its zero pattern,
    /// or comes from difference quotients, one evaluation of f for each of the lower + upper + 1 diagonals. A known
    /// pattern must lie in the band.
    Band {
        /// Diagonals below the main one.
        lower: usize,
        /// Diagonals above the main one.
        upper: usize,
    },

    /// Sparse LU factors, of the crate `faer`; the order of elimination is found once.
    ///
    /// Needs the field's [zero pattern](VectorField::sparsity). ∂f/∂y is the field's [sparse
    /// Jacobian](VectorField::sparse_jacobian), or comes from difference quotients, one evaluation of f for each colour
    /// of the pattern [Curtis, Powell, Reid 1974].
    Sparse,

    /// GMRES without a matrix [Saad, Schultz 1986], from the field's [products](VectorField::jvp) (∂f/∂y) v, or from
    /// difference quotients in the direction v.
    Krylov(Krylov),
}

/// From this many components on sparse factors are worth their overhead.
const SPARSE_FROM: usize = 60;
/// … if no more than one entry in so many is other than zero.
const SPARSE_DENSITY: usize = 8;

/// The linear solver for `field`, if the nonlinear solver of `options` needs one.
///
/// # Errors
/// [`InputError`] if the chosen solver is not one for this field.
pub(crate) fn choose(
    field: &impl VectorField,
    options: &Options,
) -> Result<Option<LinearSolver>, InputError> {
    match (options.nonlinear_solver, &options.linear_solver) {
        (NonlinearSolver::FixedPoint, None) => Ok(None),
        (NonlinearSolver::FixedPoint, Some(_)) => Err(InputError::LinearSolverUnused),
        (NonlinearSolver::Newton, None) => automatic(field).map(Some),
        (NonlinearSolver::Newton, Some(choice)) => check(field, choice).map(|()| Some(choice.clone())),
    }
}

fn automatic(field: &impl VectorField) -> Result<LinearSolver, InputError> {
    let dim = field.dim();
    match field.sparsity() {
        Some(pattern) if dim >= SPARSE_FROM && pattern.len() <= dim * dim / SPARSE_DENSITY => {
            check_size(pattern, dim)?;
            Ok(LinearSolver::Sparse)
        }
        _ => Ok(LinearSolver::Dense),
    }
}

fn check(field: &impl VectorField, choice: &LinearSolver) -> Result<(), InputError> {
    let dim = field.dim();
    match choice {
        LinearSolver::Dense => Ok(()),
        LinearSolver::Band { lower, upper } => check_band(field, *lower, *upper),
        LinearSolver::Sparse => check_size(field.sparsity().ok_or(InputError::NoPattern)?, dim),
        LinearSolver::Krylov(krylov) => krylov.check(),
    }
}

fn check_size(pattern: &Pattern, dim: usize) -> Result<(), InputError> {
    let (rows, columns) = (pattern.rows(), pattern.columns());
    if rows == dim && columns == dim {
        Ok(())
    } else {
        Err(InputError::PatternSize { rows, columns, expected: dim })
    }
}

fn check_band(field: &impl VectorField, lower: usize, upper: usize) -> Result<(), InputError> {
    let dim = field.dim();
    if lower >= dim || upper >= dim {
        return Err(InputError::BandTooWide { lower, upper, components: dim });
    }
    let Some(pattern) = field.sparsity() else { return Ok(()) };
    check_size(pattern, dim)?;
    match pattern.entries().find(|&(i, j)| i > j + lower || j > i + upper) {
        None => Ok(()),
        Some((i, j)) => Err(InputError::OutsideBand {
            row: field.component_name(i),
            column: field.component_name(j),
            lower,
            upper,
        }),
    }
}
