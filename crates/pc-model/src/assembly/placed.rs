//! Places and rotations that the text writes down.

use pc_mech::{Expr, Matrix};

use crate::assembly::shape::Spot;
use crate::diagnostics::error::ModelError;
use crate::document::Expression;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// A position in space; two expressions give a position in the plane.
pub(super) fn spot<'g>(
    scope: &mut Scope<'g, '_>,
    place: &[Expression],
    stage: Stage,
) -> Result<Spot<'g>, ModelError> {
    let mut at = [Expr::ZERO; 3];
    for (value, expression) in at.iter_mut().zip(place) {
        *value = scope.resolve(expression, stage)?;
    }
    Ok(at)
}

/// A rotation by the nine entries of its matrix, row by row.
pub(super) fn rotation<'g>(
    scope: &mut Scope<'g, '_>,
    entries: &[Expression; 9],
    stage: Stage,
) -> Result<Matrix<Expr<'g>>, ModelError> {
    let mut values = [Expr::ZERO; 9];
    for (value, expression) in values.iter_mut().zip(entries) {
        *value = scope.resolve(expression, stage)?;
    }
    Ok(Matrix::from_fn(3, 3, |i, j| values[3 * i + j]))
}
