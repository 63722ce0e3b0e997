//! States read as coordinates, all quasi-velocities and first-order states of a model.

use pc_expr::{Evaluator, Expr, Inputs};
use pc_mech::{LegendreTransform, MechError, System};

/// How a state is read as coordinates and all quasi-velocities of the model, and written.
#[derive(Clone, Debug)]
pub(super) struct Reading {
    /// Number of coordinates.
    pub(super) coordinates: usize,
    /// All quasi-velocities of the model, the declared ones first, as functions of (t, x, η, z) with the free η.
    pub(super) quasi_velocities: Evaluator,
    /// Which of them are the free ones.
    pub(super) free: Vec<usize>,
    pub(super) parameters: Vec<f64>,
    /// From momenta to quasi-velocities, where the state has momenta.
    pub(super) transform: Option<LegendreTransform>,
}

impl Reading {
    /// (x, η, z) with all η of a state.
    ///
    /// # Errors
    /// [`MechError`] where momenta have no quasi-velocities.
    pub(super) fn read(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, MechError> {
        match &mut self.transform {
            Some(transform) => {
                let free = transform.to_quasi_velocities(t, state)?;
                Ok(self.complete(t, &free))
            }
            None => Ok(self.complete(t, state)),
        }
    }

    /// (x, η, z) with all η of one with the free ones.
    pub(super) fn complete(&mut self, t: f64, free: &[f64]) -> Vec<f64> {
        let n = self.coordinates;
        let mut all = vec![0.0; n + self.quasi_velocities.program().outputs_len()];
        let (coordinates, quasi_velocities) = all.split_at_mut(n);
        coordinates.copy_from_slice(&free[..n]);
        self.quasi_velocities.eval(t, free, &self.parameters, quasi_velocities);
        all.extend_from_slice(&free[n + self.free.len()..]);
        all
    }

    /// The state of an (x, η, z) with all η.
    ///
    /// # Errors
    /// [`MechError`] where the quasi-velocities have no momenta.
    pub(super) fn write(&mut self, t: f64, all: &[f64]) -> Result<Vec<f64>, MechError> {
        let (coordinates, rest) = all.split_at(self.coordinates);
        let (eta, states) = rest.split_at(self.quasi_velocities.program().outputs_len());
        let mut state = coordinates.to_vec();
        state.extend(self.free.iter().map(|&s| eta[s]));
        state.extend_from_slice(states);
        match &mut self.transform {
            Some(transform) => transform.to_momenta(t, &state),
            None => Ok(state),
        }
    }

    /// Gives the parameters other values.
    pub(super) fn set_parameters(&mut self, parameters: &[f64]) {
        self.parameters.copy_from_slice(parameters);
        if let Some(transform) = &mut self.transform {
            transform.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
        }
    }

    /// Values of the parameters, to be changed.
    pub(super) fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// Values of the parameters.
    pub(super) fn parameters(&self) -> &[f64] {
        &self.parameters
    }
}

/// Time, a state of these symbols, and the parameters.
pub(super) fn inputs<'g>(system: &System<'g>, state: &[Expr<'g>]) -> Inputs<'g> {
    Inputs {
        time: Some(system.frame().time()),
        state: state.to_vec(),
        parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
    }
}
