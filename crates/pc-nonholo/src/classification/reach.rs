//! The velocities that constraints allow, and the directions that their commutators reach.

use pc_mech::{Constraint, Expr, Matrix, MechError, Multipliers, Neighbourhood, System};

use crate::classification::involutive::{Along, OperatorField, involutive_closure};
use crate::error::NonholoError;
use crate::reduction::adapted::independent;

/// The velocities allowed by constraints C η + c_0 = 0, and the directions reached by their commutators.
pub(crate) struct Reach<'g> {
    /// The C_α.
    pub(crate) rows: Vec<Vec<Expr<'g>>>,
    /// The c_α0.
    pub(crate) rests: Vec<Expr<'g>>,
    /// The fields X'_0..X'_l, in components along X_0..X_k.
    pub(crate) allowed: Vec<OperatorField<'g>>,
    /// The components, along the constraints, of the fields added by commutators.
    pub(crate) reached: Vec<Along<'g>>,
    /// Values near which the constraints are regular.
    pub(crate) near: Neighbourhood<'g>,
}

impl<'g> Reach<'g> {
    /// The reach under affine constraints that are regular at the values `at` of time and state.
    pub(crate) fn new(
        multipliers: &Multipliers<'g>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<Reach<'g>, NonholoError> {
        let system = multipliers.equations().system();
        let rows = multipliers.constraints().iter().map(|constraint| constraint.coefficients(system));
        let (rows, rests): (Vec<Vec<Expr<'g>>>, Vec<Expr<'g>>) =
            rows.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        let allowed = allowed(system, &independent(multipliers, at)?, &rows, &rests)?;
        let mut near = Neighbourhood { centre: at.to_vec() };
        near.centre.extend(system.parameters().iter().copied());
        let reached = involutive_closure(system, &allowed, &rows, &near);
        Ok(Reach { rows, rests, allowed, reached, near })
    }
}

/// The indices of the constraints that are affine in the velocities and, if there are any, the system under
/// these constraints alone.
pub(crate) fn affine<'g>(
    multipliers: &Multipliers<'g>,
) -> Result<(Vec<usize>, Option<Multipliers<'g>>), NonholoError> {
    let all = multipliers.constraints();
    let affine: Vec<usize> = (0..all.len()).filter(|&a| !all[a].is_nonlinear()).collect();
    if affine.is_empty() {
        return Ok((affine, None));
    }
    let without: Vec<Constraint<'g>> = affine.iter().map(|&a| all[a].clone()).collect();
    let without = multipliers.equations().system().with_multipliers(&without)?;
    Ok((affine, Some(without)))
}

/// The fields X'_0..X'_l of the velocities that satisfy C η + c_0 = 0, in components along X_0..X_k, for the
/// l quasi-velocities `independent`.
///
/// # Errors
/// [`MechError::Algebra`] if the constraints are linearly dependent everywhere.
fn allowed<'g>(
    system: &System<'g>,
    independent: &[usize],
    rows: &[Vec<Expr<'g>>],
    rests: &[Expr<'g>],
) -> Result<Vec<OperatorField<'g>>, NonholoError> {
    let l = independent.len();
    let a = Matrix::from_fn(l + rows.len(), system.quasi_velocities().len(), |u, s| match u.checked_sub(l) {
        Some(alpha) => rows[alpha][s],
        None if independent[u] == s => Expr::ONE,
        None => Expr::ZERO,
    });
    let drift: Vec<Expr<'g>> = independent.iter().map(|_| Expr::ZERO).chain(rests.iter().copied()).collect();
    let change = system.frame().changed_by(&a, &drift).map_err(MechError::from)?;
    Ok((0..=l).map(|s| change.old_components(s)).collect())
}
