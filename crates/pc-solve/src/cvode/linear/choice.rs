//! The choice of the linear solver.

use pc_expr::{Pattern, VectorField};

use crate::cvode::linear::solver::LinearSolver;
use crate::error::InputError;
use crate::settings::nonlinear_solver::NonlinearSolver;
use crate::settings::options::Options;

/// The number of components from which sparse factorisation is worth its overhead, …
const SPARSE_FROM: usize = 60;
/// … provided that at most one entry in this many is nonzero.
const SPARSE_DENSITY: usize = 8;

/// The linear solver for `field`, if the nonlinear solver of `options` needs one.
///
/// # Errors
/// [`InputError`] if the chosen solver does not suit this field.
pub(crate) fn choose(
    field: &impl VectorField,
    options: &Options,
) -> Result<Option<LinearSolver>, InputError> {
    match (options.iteration(), &options.linear_solver) {
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
