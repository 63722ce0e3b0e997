//! The start of a model with other values of its parameters.

use crate::assembly::assembler::Assembler;
use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::model::model::Model;
use crate::names::scope::Scope;

impl<'g> Assembly<'g> {
    /// The start of another model with the same text but other values, in the form of [`start`](Assembly::start) of
    /// the assembled model: the start depends only on the frame and the constraints, so that nothing else is
    /// derived again.
    ///
    /// # Errors
    /// [`ModelError`] if that model has no start.
    pub(crate) fn start_with(&self, model: &Model) -> Result<Vec<f64>, ModelError> {
        let graph = self.system.graph();
        let mut assembler = Assembler { model, graph, scope: Scope::new(graph, model.document()) };
        let begun = assembler.begin()?;
        let mut start = begun.start;
        if !begun.constraints.is_empty() {
            let system = self.system.with_parameter_values(model.parameter_values().values());
            let at = assembler.values_at((&begun.frame, begun.t_start), &system.state(), &start);
            let constraints = assembler.in_quasi_velocities(&begun.constraints, &begun.x_dot);
            assembler.on_constraints(
                (&system, &constraints),
                &at,
                (begun.t_start, &mut start),
                begun.prescribed,
            )?;
        }
        Ok(start)
    }
}
