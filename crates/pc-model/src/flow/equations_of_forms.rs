//! The equations of a model in the variables of their state.

use pc_mech::{Canonical, Equations, LegendreTransform, System};

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::variables::Variables;

impl<'g> Assembly<'g> {
    /// The system in the quasi-velocities of the state; for momenta, if multipliers enforce the constraints,
    /// the system in independent quasi-velocities.
    ///
    /// # Errors
    /// [`ModelError`] at the constraint under which there are no independent velocities.
    pub fn system_in(&self, variables: Variables) -> Result<System<'g>, ModelError> {
        Ok(match variables {
            Variables::QuasiVelocities if self.constraints.held().is_some() => self.system.without_observed(),
            // Observables may contain velocities other than the free ones.
            Variables::Momenta if self.constraints.held().is_some() => self.free_system()?.without_observed(),
            _ => self.free_form(variables)?.system,
        })
    }

    /// The equations M η̇ = r, without the reactions of multipliers, in the quasi-velocities of the state or those
    /// to which its momenta belong.
    ///
    /// # Errors
    /// [`ModelError`] at the constraint under which there are no independent velocities.
    pub fn equations_in(&self, variables: Variables) -> Result<Equations<'g>, ModelError> {
        match (variables, self.constraints.held()) {
            (_, Some(held)) => Ok(held.equations().clone()),
            (Variables::Momenta | Variables::QuasiVelocities, None) => self.equations(),
            (other, None) => self.placed(self.free_form(other)?.system.poincare()),
        }
    }

    /// The canonical equations in the momenta of the [system](Assembly::system_in) for these variables. If the
    /// η have no closed formula, they are solved for numerically, beginning with their values at the start.
    ///
    /// # Errors
    /// [`ModelError`] if there are no canonical equations.
    pub fn canonical_in(&self, variables: Variables) -> Result<Canonical<'g>, ModelError> {
        let system = self.system_in(variables)?;
        let start = match variables.are_own() {
            true => self.start_of(&system.state()),
            false => self.start_in(&self.free_form(variables)?)?,
        };
        let n = system.frame().coordinates().len();
        let canonical = system
            .canonical()
            .and_then(|canonical| canonical.with_guess(&start[n..n + system.quasi_velocities().len()]));
        canonical.map_err(|error| self.document.derivation_error(error))
    }

    /// The conversion between the quasi-velocities of the state and its momenta; if multipliers enforce the
    /// constraints and momenta are integrated, the conversion gives quasi-velocities that satisfy the
    /// constraints.
    ///
    /// # Errors
    /// [`ModelError`] if there is no such conversion.
    pub fn legendre_transform(&self, variables: Variables) -> Result<LegendreTransform, ModelError> {
        let transform = match (variables, self.constraints.held()) {
            (Variables::Momenta, Some(held)) => held.legendre_transform(&self.start_velocities()),
            _ => self.canonical_in(variables)?.legendre_transform(),
        };
        transform.map_err(|error| self.document.derivation_error(error))
    }
}
