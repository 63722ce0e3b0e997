//! Measures how far a state is off the constraints, and moves it onto them.

use pc_expr::Failure;

use crate::compiled::motion::{Form, Motion};
use crate::compiled::point::Point;
use crate::compiled::projection::holding::PrescribedComponents;

impl Motion {
    /// Names of the constraints.
    pub fn constraint_names(&self) -> &[String] {
        &self.constraints
    }

    /// The residual of each constraint at (t, y): f(t, x) for conditions on positions, C η + c_0 for the others.
    ///
    /// # Panics
    /// If `y` does not have the length of the state.
    pub fn constraint_residuals(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut residuals = vec![f64::NAN; self.constraints.len()];
        self.constraint_residuals_to(t, y, &mut residuals);
        residuals
    }

    /// Writes the residual of each constraint to `residuals`, as
    /// [`constraint_residuals`](Motion::constraint_residuals) gives it.
    ///
    /// # Panics
    /// If `y` does not have the length of the state, or `residuals` not that of
    /// [`constraint_names`](Motion::constraint_names).
    pub fn constraint_residuals_to(&mut self, t: f64, y: &[f64], residuals: &mut [f64]) {
        assert_eq!(y.len(), self.names.len(), "length of the state");
        assert_eq!(residuals.len(), self.constraints.len(), "number of constraints");
        if let Form::InMomenta(motion) = &mut self.form {
            return motion.constraint_residuals(t, y, residuals);
        }
        self.follow_signals(t);
        if let Some(surface) = &mut self.surface {
            surface.residuals(Point { t, y, p: &self.parameters }, residuals);
        }
    }

    /// Moves a state onto the constraints, disregarding kept integrals. The coordinates and the
    /// quasi-velocities with these indices stay as they are; the others are moved by the shortest path in the
    /// kinetic metric.
    ///
    /// # Errors
    /// A [`Failure`] where no such state exists or can be reached.
    pub fn project_holding(
        &mut self,
        t: f64,
        y: &mut [f64],
        coordinates: &[usize],
        quasi_velocities: &[usize],
    ) -> Result<(), Failure> {
        self.follow_signals(t);
        let Some(surface) = &mut self.surface else { return Ok(()) };
        let held = PrescribedComponents { coordinates, quasi_velocities };
        let projected = surface.project_holding((t, y, &self.parameters), &held);
        projected.map_err(|failure| self.failure(failure, t, y))
    }

    /// Moves the η of a state onto the constraints, and leaves its x as they are.
    ///
    /// # Errors
    /// As for the [projection](pc_expr::VectorField::project) of the state.
    ///
    /// # Panics
    /// If `y` does not have the length of the state.
    pub fn project_velocities(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        assert_eq!(y.len(), self.names.len(), "length of the state");
        self.follow_signals(t);
        let parameters = &self.parameters;
        let outcome = self.surface.as_mut().map_or(Ok(()), |s| s.project_velocities(t, y, parameters));
        outcome.map_err(|failure| self.failure(failure, t, y))
    }

    /// Moves the η of a state onto the constraints, and leaves its x as they are. The quasi-velocities with the
    /// indices `held` change only as far as constraints on them alone demand; the others adjust to them. All of
    /// them move by the shortest path in the kinetic metric.
    ///
    /// # Errors
    /// A [`Failure`] where no such velocities are found.
    ///
    /// # Panics
    /// If `y` does not have the length of the state.
    pub fn project_velocities_holding(
        &mut self,
        t: f64,
        y: &mut [f64],
        held: &[usize],
    ) -> Result<(), Failure> {
        assert_eq!(y.len(), self.names.len(), "length of the state");
        self.follow_signals(t);
        let Some(surface) = &mut self.surface else { return Ok(()) };
        let projected = surface.project_velocities_holding((t, y, &self.parameters), held);
        projected.map_err(|failure| self.failure(failure, t, y))
    }
}
