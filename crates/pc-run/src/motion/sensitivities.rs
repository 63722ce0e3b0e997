//! `pc run --sensitivities`: derivatives of the columns of a motion with respect to parameters.

use std::num::NonZeroU64;
use std::ops::ControlFlow;

use pc_model::{Assembly, Flow, Model};
use pc_solve::{
    Checkpoint, Options, Resumable, Sensitivities, SensitivitySolution, Solution, Solve, SolveError,
    SolveFailure,
};

use pc_expr::VectorField;
use pc_verify::Slope;

use crate::error::RunError;

/// Derivatives of a motion with respect to parameters, which are integrated together with the motion, and their values at each
/// output.
pub(crate) struct Derivatives {
    parameters: Vec<usize>,
    names: Vec<String>,
    wanted: Sensitivities,
    /// The derivatives at each output, column-major.
    matrices: Vec<Vec<f64>>,
}

impl Derivatives {
    /// The derivatives of the motion of a model with respect to these parameters, on which the start may
    /// depend too.
    ///
    /// # Errors
    /// [`RunError::Model`] if the start has no derivative.
    pub(crate) fn new(
        model: &Model,
        assembly: &Assembly<'_>,
        flow: &Flow,
        parameters: &[usize],
    ) -> Result<Derivatives, RunError> {
        let mut wanted = Sensitivities::new();
        for &j in parameters {
            wanted = wanted.by_parameter_from(j, flow.start_by_parameter(model, assembly, j)?);
        }
        let names: Vec<String> = model.parameters().map(|(name, _)| name.to_owned()).collect();
        let names = parameters.iter().map(|&j| names[j].clone()).collect();
        Ok(Derivatives { parameters: parameters.to_vec(), names, wanted, matrices: Vec::new() })
    }

    /// Integrates the motion as far as possible; the error says why it ended. `output` is called with each
    /// output and may stop the integration.
    pub(crate) fn follow(
        &mut self,
        flow: &mut Flow,
        t_start: f64,
        times: &[f64],
        options: &Options,
        output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> (Solution, Option<SolveError>) {
        let (motion, start, events) = (&mut flow.motion, &flow.start, &mut flow.events);
        let solved = Solve::new(motion, t_start, start)
            .method(options)
            .events(events)
            .sensitivities(&self.wanted)
            .run_with_outputs(times, output);
        self.take(solved)
    }

    /// As [`follow`](Derivatives::follow), from a checkpoint and with further checkpoints.
    pub(crate) fn follow_checkpointed(
        &mut self,
        flow: &Flow,
        (times, options): (&[f64], &Options),
        (from, every): (Checkpoint, NonZeroU64),
        save: impl FnMut(&Checkpoint, bool),
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> (Solution, Option<SolveError>) {
        let parts = || (flow.motion.clone(), flow.events.clone());
        let solved = Resumable::new(parts, from)
            .method(options)
            .every(every)
            .sensitivities(&self.wanted)
            .run(times, save, step);
        self.take(solved)
    }

    /// Stores the derivatives, as far as they were integrated.
    fn take(
        &mut self,
        solved: Result<SensitivitySolution, Box<SolveFailure<SensitivitySolution>>>,
    ) -> (Solution, Option<SolveError>) {
        let (reached, error) = SolveFailure::split(solved);
        let SensitivitySolution { trajectory, occurrences, ending, slides, .. } = reached;
        self.matrices = trajectory.iter().map(|(_, _, matrix)| matrix.to_vec()).collect();
        (Solution { trajectory: trajectory.motion().clone(), occurrences, ending, slides }, error)
    }

    /// The rates (∂f/∂y) ∂y/∂p + ∂f/∂p of the derivatives at the last output, as they are integrated; empty if the field has no
    /// derivatives of its own.
    pub(crate) fn slopes(&self, flow: &mut Flow, t: f64, state: &[f64]) -> Vec<Slope> {
        let (motion, dim) = (&mut flow.motion, state.len());
        let mut by_state = vec![f64::NAN; dim * dim];
        let mut by_parameters = vec![f64::NAN; dim * motion.parameters_len()];
        let has_both = motion.has_jacobian() && motion.has_parameter_jacobian();
        let Some(last) = self.matrices.last().filter(|_| has_both) else { return Vec::new() };
        let known = motion.jacobian(t, state, &mut by_state).is_ok()
            && motion.parameter_jacobian(t, state, &mut by_parameters).is_ok();
        if !known {
            return Vec::new();
        }
        let names = motion.names().to_vec();
        let slope = |(column, (&j, name)): (&[f64], (&usize, &String))| {
            let rate = |i: usize| {
                let moving: f64 = (0..dim).map(|k| by_state[i + k * dim] * column[k]).sum();
                (names[i].clone(), moving + by_parameters[i + j * dim])
            };
            Slope {
                name: format!("the derivative by {name}"),
                state: column.to_vec(),
                parameters: vec![(name.clone(), 1.0)],
                rates: (0..dim).map(rate).collect(),
                observed: Vec::new(),
            }
        };
        last.chunks(dim).zip(self.parameters.iter().zip(&self.names)).map(slope).collect()
    }

    /// The names of the columns: ∂x/∂p for each x of a motion, first for one p, then for the next.
    pub(crate) fn columns(&self, flow: &Flow) -> Vec<String> {
        self.names
            .iter()
            .flat_map(|parameter| flow.names.iter().map(move |x| format!("∂{x}/∂{parameter}")))
            .collect()
    }

    /// The values of these columns at output number `i`, which is the state y at time t.
    pub(crate) fn row(&self, flow: &Flow, i: usize, t: f64, y: &[f64]) -> Vec<f64> {
        let columns = self.matrices[i].chunks_exact(y.len()).zip(&self.parameters);
        columns.flat_map(|(column, &j)| flow.derivative(t, y, column, j)).collect()
    }
}
