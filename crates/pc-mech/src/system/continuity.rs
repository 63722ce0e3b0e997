//! Checks that energies and frames cause no impulses.
//!
//! Where L jumps with the position, or where ∂L/∂η or the frame jumps with anything but the velocities, d/dt ∂L/∂η or
//! X_s L in (9) is an impulse. The derivatives of the pieces do not show the impulse: the motion would pass through as
//! if there were no jump.

use pc_algebra::{Frame, Jump, Neighbourhood};
use pc_expr::Expr;

use crate::error::{ConstraintError, FrameError, LagrangianError, MechError};
use crate::system::builder::SystemBuilder;
use crate::system::system::System;

impl<'g> SystemBuilder<'g> {
    /// The neighbourhood in which expressions are regular: near the given values, with the values of the
    /// parameters.
    pub(super) fn near_parameters(&self) -> Neighbourhood<'g> {
        let mut near = self.near.clone();
        near.centre.extend(self.parameters.iter().copied());
        near
    }

    /// Checks that L, as a function of the position, does not jump, and that neither the momenta nor the
    /// frame jump.
    ///
    /// # Errors
    /// [`LagrangianError::Jumps`], [`LagrangianError::MomentumJumps`], [`FrameError::Jumps`]
    pub(super) fn check_continuous(
        &self,
        frame: &Frame<'g>,
        eta: &[Expr<'g>],
        lagrangian: Expr<'g>,
    ) -> Result<(), MechError> {
        let (graph, near) = (self.graph, self.near_parameters());
        let position = frame.coordinates();
        let placed = [position, &[self.time]].concat();
        let states: Vec<Expr<'g>> = self.states.iter().map(|&(z, _)| z).collect();
        let all = [&placed, &states, &self.signals[..]].concat();
        let entries = frame.b().nonzero_entries();
        let entries = entries.iter().chain(frame.b0());
        if let Some(Jump { at, size }) = entries.filter_map(|&entry| near.jump(graph, entry, &placed)).next()
        {
            return Err(FrameError::Jumps { size, place: at }.into());
        }
        if !graph.applies(lagrangian, &[&all, eta].concat(), |function| !function.is_smooth()) {
            return Ok(());
        }
        if let Some(Jump { at, size }) = near.jump(graph, lagrangian, position) {
            return Err(LagrangianError::Jumps { size, place: at }.into());
        }
        for (velocity, momentum) in eta.iter().zip(graph.gradient(lagrangian, eta)) {
            if let Some(Jump { at, size }) = near.jump(graph, momentum, &all) {
                let quasi_velocity = velocity.to_string();
                return Err(LagrangianError::MomentumJumps { quasi_velocity, size, place: at }.into());
            }
        }
        Ok(())
    }
}

impl<'g> System<'g> {
    /// Checks that a condition on velocities does not jump with position or time.
    ///
    /// # Errors
    /// [`ConstraintError::Jumps`]
    pub(crate) fn check_continuous_constraint(
        &self,
        name: &str,
        velocity: Expr<'g>,
    ) -> Result<(), ConstraintError> {
        let placed = [self.frame.coordinates(), &[self.frame.time()]].concat();
        let near = Neighbourhood { centre: self.parameters.clone() };
        match near.jump(self.graph(), velocity, &placed) {
            Some(Jump { at, .. }) => Err(ConstraintError::Jumps { constraint: name.to_owned(), place: at }),
            None => Ok(()),
        }
    }
}
