//! Frames in which constraints make quasi-velocities vanish.

use pc_mech::{Constraint, Expr, MechError, Multipliers, ShapeError, System};

use crate::error::NonholoError;
use crate::reduction::constrained::Constrained;

/// A system whose last quasi-velocities are the left-hand sides of its constraints,
///
///   η'_s = η_s of the l that stay independent,   η'_α = C_αr η_r + c_α0 (28),   α = l+1..k, r = 1..k,
///
/// so that the k − l constraints are η'_α = 0. Its forces and structure coefficients are those of
/// [`System::in_quasi_velocities`].
#[derive(Clone, Debug)]
pub struct Adapted<'g> {
    system: System<'g>,
    free: usize,
}

impl<'g> Adapted<'g> {
    /// The system of `multipliers` in the quasi-velocities that stay independent, in their order, followed by the
    /// left-hand sides C η + c_0 of its constraints, each with the name of its constraint.
    ///
    /// The dependent quasi-velocities are those that the constraints determine best at the values `at` of time,
    /// coordinates, quasi-velocities and parameters; if a constraint says that a quasi-velocity vanishes, that
    /// quasi-velocity is dependent. The frame is singular where the constraints do not determine these
    /// quasi-velocities.
    ///
    /// # Errors
    /// [`NonholoError::Nonlinear`]; [`NonholoError::Mech`], where
    /// [`ConstraintError::Singular`](pc_mech::ConstraintError::Singular) says that the constraints are linearly
    /// dependent at `at`.
    pub fn new(multipliers: &Multipliers<'g>, at: &[(Expr<'g>, f64)]) -> Result<Adapted<'g>, NonholoError> {
        let system = multipliers.equations().system();
        let eta = system.quasi_velocities();
        affine(multipliers, "adapted frames")?;
        let independent: Vec<Expr<'g>> = independent(multipliers, at)?.into_iter().map(|s| eta[s]).collect();
        let names = independent.iter().map(Expr::to_string);
        let names = names.chain(multipliers.constraints().iter().map(|c| unused(system, c)));
        let definitions: Vec<Expr<'g>> =
            independent.iter().chain(multipliers.velocities()).copied().collect();
        let free = independent.len();
        Ok(Adapted { system: system.in_quasi_velocities(names, &definitions)?, free })
    }

    /// The system with free quasi-velocities that have these names, one for each, and are orthonormal in the kinetic
    /// metric: their mass matrix is the l × l unit matrix.
    ///
    /// # Errors
    /// [`NonholoError::Mech`], with the errors of [`System::in_orthonormal_frame`].
    pub fn orthonormal<S: AsRef<str>>(&self, names: &[S]) -> Result<Adapted<'g>, NonholoError> {
        if names.len() != self.free {
            let (what, found) = ("the list of names", names.len());
            return Err(MechError::from(ShapeError { what, found, expected: self.free }).into());
        }
        Ok(Adapted { system: self.system.in_orthonormal_frame(names)?, free: self.free })
    }

    /// The system of all k quasi-velocities, with the free ones first.
    pub fn system(&self) -> &System<'g> {
        &self.system
    }

    /// The number l of free quasi-velocities.
    pub fn free(&self) -> usize {
        self.free
    }

    /// The system with η_α = 0: its equations (30) and reactions.
    ///
    /// # Errors
    /// [`LagrangianError::Degenerate`](pc_mech::LagrangianError::Degenerate) if the free quasi-velocities have
    /// no inertia.
    pub fn constrained(&self) -> Result<Constrained<'g>, NonholoError> {
        Constrained::new(&self.system, &self.system.quasi_velocities()[self.free..])
    }
}

/// Checks that all constraints are affine in the velocities, as this form requires.
///
/// # Errors
/// [`NonholoError::Nonlinear`]
pub(crate) fn affine(multipliers: &Multipliers<'_>, form: &'static str) -> Result<(), NonholoError> {
    match multipliers.constraints().iter().find(|constraint| constraint.is_nonlinear()) {
        None => Ok(()),
        Some(constraint) => Err(NonholoError::Nonlinear { form, constraint: constraint.name().to_owned() }),
    }
}

/// The indices of the quasi-velocities that the constraints leave independent, as [`Adapted::new`] chooses them.
///
/// # Errors
/// The errors of [`Multipliers::dependent_at`].
pub(crate) fn independent<'g>(
    multipliers: &Multipliers<'g>,
    at: &[(Expr<'g>, f64)],
) -> Result<Vec<usize>, NonholoError> {
    let eta = multipliers.equations().system().quasi_velocities();
    let dependent = match vanishing(eta, multipliers.velocities()) {
        Some(places) => places,
        None => multipliers.dependent_at(at)?,
    };
    Ok((0..eta.len()).filter(|s| !dependent.contains(s)).collect())
}

/// The indices of the quasi-velocities that the constraints set to zero, if each constraint does no more than
/// that.
fn vanishing<'g>(eta: &[Expr<'g>], velocities: &[Expr<'g>]) -> Option<Vec<usize>> {
    velocities.iter().map(|velocity| eta.iter().position(|eta| eta == velocity)).collect()
}

/// The name of a constraint, extended if the system already has it.
fn unused(system: &System<'_>, constraint: &Constraint<'_>) -> String {
    let parameters = system.parameters().iter().map(|(symbol, _)| symbol);
    let taken: Vec<String> = system
        .state()
        .iter()
        .chain(parameters)
        .filter(|symbol| **symbol != constraint.expression())
        .map(Expr::to_string)
        .collect();
    let mut name = constraint.name().to_owned();
    while taken.contains(&name) {
        name.push('_');
    }
    name
}
