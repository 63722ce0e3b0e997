//! The equations of a model in the variables of their state.

use pc_mech::{Canonical, Equations, LegendreTransform, System};

use crate::assembly::assembly::Assembly;
use crate::assembly::constraint_treatment::ConstraintFormulation;
use crate::diagnostics::error::ModelError;

/// The variables of the state beside the coordinates, and so which equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variables {
    /// The quasi-velocities of (9), or of (30): independent ones if constraints say that the others vanish, all of
    /// them with multipliers otherwise.
    QuasiVelocities,
    /// The momenta of (10), those of the same quasi-velocities.
    Momenta,
}

impl<'g> Assembly<'g> {
    /// The system of the quasi-velocities of the state; for momenta where multipliers hold constraints, that of
    /// independent ones.
    ///
    /// # Errors
    /// [`ModelError`] at the constraint that there are no independent velocities under.
    pub fn system_in(&self, variables: Variables) -> Result<System<'g>, ModelError> {
        Ok(match (variables, self.constraints.formulation()) {
            (Variables::QuasiVelocities, ConstraintFormulation::Multipliers(_)) => {
                self.system.without_observed()
            }
            // What is observed may contain velocities that are not among the free ones.
            (Variables::Momenta, ConstraintFormulation::Multipliers(_)) => {
                self.free_system()?.without_observed()
            }
            (_, ConstraintFormulation::Free | ConstraintFormulation::Vanishing(_)) => self.free_system()?,
        })
    }

    /// M η̇ = r in the quasi-velocities of the state, or those of its momenta; without the reactions of multipliers.
    ///
    /// # Errors
    /// [`ModelError`] at the constraint that there are no independent velocities under.
    pub fn equations_in(&self) -> Result<Equations<'g>, ModelError> {
        match self.constraints.formulation() {
            ConstraintFormulation::Multipliers(held) => Ok(held.multipliers.equations().clone()),
            ConstraintFormulation::Free | ConstraintFormulation::Vanishing(_) => self.equations(),
        }
    }

    /// The canonical equations of the momenta of the [system](Assembly::system_in) in these variables, η looked for from their start where they are
    /// not closed.
    ///
    /// # Errors
    /// [`ModelError`] if there are none.
    pub fn canonical_in(&self, variables: Variables) -> Result<Canonical<'g>, ModelError> {
        let system = self.system_in(variables)?;
        let start = self.start_of(&system.state());
        let n = system.frame().coordinates().len();
        let canonical = system
            .canonical()
            .and_then(|canonical| canonical.with_guess(&start[n..n + system.quasi_velocities().len()]));
        canonical.map_err(|error| self.document.derivation_error(error))
    }

    /// The change between the quasi-velocities of the state and its momenta; from momenta to quasi-velocities that satisfy
    /// the constraints, where multipliers hold these and momenta are integrated.
    ///
    /// # Errors
    /// [`ModelError`] if there is none.
    pub fn legendre_transform(&self, variables: Variables) -> Result<LegendreTransform, ModelError> {
        let transform = match (variables, self.constraints.formulation()) {
            (Variables::Momenta, ConstraintFormulation::Multipliers(held)) => {
                held.multipliers.legendre_transform(&self.start_velocities())
            }
            _ => self.canonical_in(variables)?.legendre_transform(),
        };
        transform.map_err(|error| self.document.derivation_error(error))
    }
}
