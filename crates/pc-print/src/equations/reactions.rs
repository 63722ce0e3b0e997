//! Reactions as formulas, in the forms of the equations that have them in their variables.

use pc_mech::{Equations, Expr, Multipliers};
use pc_model::{Assembly, ModelError};
use pc_nonholo::NonholoError;

use crate::equations::derived::Derived;
use crate::equations::form::Form;

impl Form {
    /// Whether reactions can be written in the velocities of this form: those of the model, of its coordinates, or independent
    /// ones among these.
    pub fn has_reactions(self) -> bool {
        match self {
            Form::Poincare
            | Form::Lagrange
            | Form::Voronets
            | Form::Maggi
            | Form::Kane
            | Form::GibbsAppell => true,
            Form::Canonical | Form::Reduced | Form::LiePoisson | Form::Orthonormal | Form::Hamel => false,
        }
    }
}

impl<'g> Derived<'g> {
    /// These equations, which have this `form`, with the reactions λ_α of all constraints as functions of time, coordinates and the
    /// velocities of the form, and with the forces C_αs λ_α on all velocities. The functions contain the accelerations if that
    /// makes them shorter. Without constraints, and in forms that [have no reactions](Form::has_reactions), nothing is added.
    ///
    /// In Lagrange's form, whose velocities are all ẋ, (C M⁻¹ Cᵀ) λ = −ċ − C M⁻¹ r is solved; in the forms in independent
    /// velocities, the equations of the dependent ones.
    ///
    /// # Errors
    /// [`ModelError`] if the constraints do not determine the reactions.
    pub fn with_reactions(self, form: Form, assembly: &Assembly<'g>) -> Result<Derived<'g>, ModelError> {
        let Some(held) = assembly.constraints.multipliers().filter(|_| form.has_reactions()) else {
            return Ok(self);
        };
        let of_coordinates = matches!(form, Form::Lagrange | Form::Voronets | Form::Maggi);
        let in_velocities =
            if of_coordinates { assembly.placed(held.in_velocities())? } else { held.clone() };
        let reactions = match form {
            Form::Lagrange => {
                let values = assembly.placed(in_velocities.reactions_of_state())?;
                in_velocities.reactions().iter().copied().zip(values).collect()
            }
            Form::Voronets => assembly.placed(of_independent(&in_velocities, &self.equations))?,
            _ => {
                let known = assembly.placed(assembly.constraints.reactions(&assembly.at_start()))?;
                match known.is_empty() {
                    true => assembly.placed(of_independent(held, &self.equations))?,
                    false => known,
                }
            }
        };
        let velocities = in_velocities.equations().system().quasi_velocities().iter().copied();
        let reaction_forces = velocities.zip(in_velocities.reaction_forces()).collect();
        Ok(Derived { reactions, reaction_forces, ..self })
    }
}

/// The symbols λ with their values in the independent velocities of these equations, with the symbols of the accelerations where
/// that is shorter.
fn of_independent<'g>(
    held: &Multipliers<'g>,
    equations: &Equations<'g>,
) -> Result<Vec<(Expr<'g>, Expr<'g>)>, NonholoError> {
    let (system, graph) = (equations.system(), equations.system().graph());
    let by = |accelerations: Vec<Expr<'g>>| {
        let free = system.quasi_velocities().iter().copied();
        held.reactions_of_independent(&free.zip(accelerations).collect::<Vec<_>>())
    };
    let (solved, open) = (by(equations.accelerations())?, by(system.accelerations())?);
    let shorter = |(solved, open): (Expr<'g>, Expr<'g>)| {
        if graph.size(&[solved]) > graph.size(&[open]) { open } else { solved }
    };
    let values = solved.into_iter().zip(open).map(shorter);
    Ok(held.reactions().iter().copied().zip(values).collect())
}
