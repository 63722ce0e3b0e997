//! A state of rest or steady motion, found by choosing some inputs and components of the state, for people and for programs.

use pc_analysis::{AnalysisError, Trim};
use pc_model::{GivenInput, Model};
use pc_print::short;
use serde_json::{Value, json};

use crate::error::RunError;
use crate::linear::error::LinearError;
use crate::linear::json::map;
use crate::linear::linearizable::{Linearizable, placed};
use crate::observer::Observer;

/// A state and inputs with which a model is at rest or moves steadily.
#[derive(Debug)]
pub struct Trimmed {
    title: String,
    /// The state of rest or steady motion that was found.
    pub trim: Trim,
}

impl Trimmed {
    /// Finds values of the named inputs and components of the state that make the start of a model an equilibrium or a steady motion;
    /// the equations are compared with a second derivation if they are to be verified.
    ///
    /// # Errors
    /// [`RunError`]
    pub fn of(
        model: &Model,
        free: &[String],
        verify: bool,
        observer: &dyn Observer,
    ) -> Result<Trimmed, RunError> {
        let graph = model.graph();
        let mut linearizable = Linearizable::vouched(model, &graph, verify, observer)?;
        let (t, start) = (linearizable.assembly.t_start, linearizable.linear.start.clone());
        let trim = linearizable.linear.linearizer.trim(t, &start, free).map_err(|error| match error {
            AnalysisError::NoSteadyMotion { residual, state, .. } => {
                LinearError::NotTrimmed { free: free.to_vec(), residual, state }.into()
            }
            AnalysisError::UnknownComponent { name, known } => LinearError::Free { name, known }.into(),
            AnalysisError::DependsOnTime => LinearError::DependsOnTime { of_linearization: false }.into(),
            other => placed(&linearizable.assembly, other, false),
        })?;
        linearizable.assembly.within_limits()?;
        Ok(Trimmed { title: model.title().to_owned(), trim })
    }

    /// The model with the inputs that were found.
    ///
    /// # Errors
    /// [`LinearError::Free`] if the model is another one, which lacks an input.
    pub(crate) fn with_inputs(&self, model: &Model) -> Result<Model, LinearError> {
        let mut held = model.clone();
        for (name, value) in &self.trim.inputs {
            let given = held.give_input(name, GivenInput::Constant(*value));
            given.map_err(|unknown| LinearError::Free { name: unknown.name, known: unknown.known })?;
        }
        Ok(held)
    }

    /// For people.
    pub fn text(&self) -> String {
        let part = |title: &str, values: &[(String, f64)]| {
            let lines = values.iter().map(|(name, value)| format!("    {name} = {}\n", short(*value, 10)));
            if values.is_empty() {
                String::new()
            } else {
                format!("  {title}\n{}", lines.collect::<String>())
            }
        };
        let Trim { state, inputs, rates, .. } = &self.trim;
        let parts =
            [part("state", state), part("inputs", inputs), part("rates of cyclic coordinates", rates)];
        format!("{}: at rest or in steady motion\n{}", self.title, parts.concat())
    }

    /// The result as one JSON object: `state`, `inputs` and the `rates` of cyclic coordinates by their names, and the `residual`.
    pub fn json(&self) -> Value {
        let of = |values: &[(String, f64)]| map(values.iter().map(|(name, value)| (name.as_str(), *value)));
        let Trim { state, inputs, rates, residual } = &self.trim;
        json!({ "state": of(state), "inputs": of(inputs), "rates": of(rates), "residual": residual })
    }
}
