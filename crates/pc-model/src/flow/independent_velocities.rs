//! Voronets' equations: the equations of motion in the velocities of independent coordinates.

use pc_mech::{Expr, System};
use pc_nonholo::{NonholoError, Voronets};

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::flow::free_form::FreeForm;

impl<'g> Assembly<'g> {
    /// Voronets' equations (35), with the constraints solved for velocities; `None` if there are no constraints. The
    /// independent velocities are those requested, if these are velocities ẋ; otherwise those whose equations are shortest.
    ///
    /// # Errors
    /// [`ModelError`] if the coordinates are not independent, or a constraint is not affine in the velocities.
    pub fn voronets(&self) -> Result<Option<Voronets<'g>>, ModelError> {
        self.placed(self.constraints_solved())
    }

    fn constraints_solved(&self) -> Result<Option<Voronets<'g>>, NonholoError> {
        let Some(multipliers) = self.constraints.multipliers() else { return Ok(None) };
        let held = multipliers.in_velocities()?;
        let lagrange = held.equations().system();
        let start = self.system.velocity_transform()?.to_velocities(self.t_start, &self.start);
        let mut at: Vec<(Expr<'g>, f64)> = lagrange.state().into_iter().zip(start).collect();
        at.push((lagrange.frame().time(), self.t_start));
        let asked = self.constraints.asked_for();
        let are_velocities = asked.iter().all(|asked| lagrange.quasi_velocities().contains(asked));
        Ok(Some(match asked.is_empty() || !are_velocities {
            true => Voronets::shortest(&held, &at)?,
            false => Voronets::new(&held.with_independent(asked, &at)?, &at)?,
        }))
    }

    /// The form in the velocities x' of independent coordinates.
    pub(super) fn in_velocities(&self, free: &System<'g>) -> Result<FreeForm<'g>, ModelError> {
        let (frame, eta) = (free.frame(), free.quasi_velocities());
        let coordinates = match self.voronets()? {
            Some(voronets) => voronets.independent(),
            // Refuses coordinates that are not independent.
            None => self.placed(free.in_velocities())?.frame().coordinates().to_vec(),
        };
        let rates = frame.velocities(eta);
        let rate = |x: &Expr<'g>| frame.coordinates().iter().zip(&rates).find(|(known, _)| *known == x);
        let definitions: Vec<Expr<'g>> =
            coordinates.iter().filter_map(|x| rate(x).map(|(_, &rate)| rate)).collect();
        let names = coordinates.iter().map(|x| format!("{x}'"));
        let change = self.placed(free.quasi_velocity_change(names, &definitions))?;
        Ok(FreeForm::changed(eta, &change))
    }
}
