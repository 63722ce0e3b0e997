//! The gradient of a function of a motion, by the adjoint equations.

use std::sync::Arc;

use pc_expr::{Backend, Evaluator, Failure, Inputs, Program};
use pc_mech::{Expr, MechError, Table};
use pc_model::{Assembly, Flow, Model, ModelError};
use pc_solve::{AdjointOptions, Functional, Method, adjoint_gradients_with_events};

use crate::error::RunError;
use crate::plan::Plan;

/// A function to be differentiated: h at the end plus the integral of g over the motion, each an expression of the model or the name of
/// an output.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Objective {
    /// h, 0 unless given.
    pub end: Option<String>,
    /// g, 0 unless given.
    pub integral: Option<String>,
}

/// The value of an objective with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectiveGradient {
    /// Its value.
    pub value: f64,
    /// The derivatives with respect to the components of the state at the start, each with the others held fixed.
    pub by_start: Vec<(String, f64)>,
    /// The derivatives with respect to the parameters of the plan, on which the start may depend.
    pub by_parameters: Vec<(String, f64)>,
}

/// The gradient of an objective of the motion of a model with respect to the start and the parameters whose sensitivities the plan
/// requests. The motion is integrated forwards and the adjoint equations backwards, once each whatever the number of parameters, by the
/// methods of CVODES: `bdf` if the plan says so, else `adams`.
///
/// # Errors
/// [`RunError::Model`] at the place in an expression, or in the text, that causes it; [`RunError::Integration`].
pub fn gradient(model: &Model, plan: &Plan, objective: &Objective) -> Result<ObjectiveGradient, RunError> {
    let mut model = model.clone();
    model.differentiate_by_parameters(true);
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    let mut flow = Flow::new(&model, &assembly, plan.form)?;
    let tolerances = plan.tolerances(&mut flow);
    let method = if plan.method == Method::Bdf { Method::Bdf } else { Method::Adams };
    let options = AdjointOptions::new(Plan { method, ..plan.clone() }.options(&tolerances));
    let term = |text: &Option<String>| {
        text.as_ref().map(|text| Term::new(&model, &assembly, &flow, text)).transpose()
    };
    let sum = Sum { end: term(&objective.end)?, density: term(&objective.integral)? };
    let (motion, start, events) = (&mut flow.motion, flow.start.clone(), &mut flow.events);
    let found =
        adjoint_gradients_with_events(motion, events, [sum], plan.t_start, &start, plan.t_end, &options);
    let names = flow.motion.names();
    let mut found = found.map_err(|cause| RunError::Integration {
        cause: Box::new(cause),
        names: names.to_vec(),
        jumps: false,
        lost_inertia: None,
    })?;
    let of_parameters: Vec<&str> = model.parameters().map(|(name, _)| name).collect();
    let found = found.swap_remove(0); // one for each objective
    let mut by_parameters = Vec::with_capacity(plan.sensitivities.len());
    for &j in &plan.sensitivities {
        let moving = flow.start_by_parameter(&model, &assembly, j)?;
        let moved: f64 = moving.iter().zip(&found.by_start).map(|(y, slope)| y * slope).sum();
        by_parameters.push((of_parameters[j].to_owned(), found.by_parameters[j] + moved));
    }
    let by_start = names.iter().cloned().zip(found.by_start).collect();
    Ok(ObjectiveGradient { value: found.value, by_start, by_parameters })
}

/// An expression with its derivatives with respect to the state and the parameters.
struct Term {
    evaluator: Evaluator,
    values: Vec<f64>,
    parameters: Vec<f64>,
    /// The inputs that are read from tables, by their indices.
    tables: Vec<(usize, Arc<Table>)>,
}

impl Term {
    fn new(model: &Model, assembly: &Assembly<'_>, flow: &Flow, text: &str) -> Result<Term, ModelError> {
        let (system, graph) = (&assembly.system, assembly.system.graph());
        let output = system.outputs().iter().find(|(name, _)| name == text).map(|&(_, value)| value);
        let value = match output {
            Some(value) => value,
            None => model.function(assembly, text)?,
        };
        let state: Vec<Expr<'_>> = flow.motion.names().iter().map(|name| graph.symbol(name)).collect();
        let first = flow.motion.coordinates();
        let free = &state[first..state.len() - flow.motion.states()];
        let all = system.quasi_velocities().iter().copied().zip(assembly.quasi_velocities_of(free)?);
        let value = graph.substitute(&[value], &all.collect::<Vec<_>>())[0];
        let parameters: Vec<Expr<'_>> = system.parameters().iter().map(|&(symbol, _)| symbol).collect();
        let slopes = graph.gradient(value, &[&state[..], &parameters].concat());
        let inputs = Inputs { time: Some(system.frame().time()), state, parameters };
        let program = Program::new(graph, &inputs, &[&[value], &slopes[..]].concat());
        let program = assembly.placed(program.map_err(MechError::from))?;
        Ok(Term {
            evaluator: Evaluator::new(program, Backend::Interpreter),
            values: vec![f64::NAN; 1 + slopes.len()],
            parameters: model.parameters().map(|(_, value)| value).collect(),
            tables: model
                .parameter_values()
                .tables()
                .into_iter()
                .map(|(place, table)| (place, Arc::clone(table)))
                .collect(),
        })
    }

    /// The value; the derivatives with respect to the state and the parameters are written to the slices.
    fn at(&mut self, t: f64, y: &[f64], by_state: &mut [f64], by_parameters: &mut [f64]) -> f64 {
        for (place, table) in &self.tables {
            self.parameters[*place] = table.at(t).unwrap_or(f64::NAN);
        }
        self.evaluator.eval(t, y, &self.parameters, &mut self.values);
        let (of_state, of_parameters) = self.values[1..].split_at(y.len());
        by_state.copy_from_slice(of_state);
        // External forces come after the parameters.
        by_parameters.fill(0.0);
        for (slope, value) in by_parameters.iter_mut().zip(of_parameters) {
            *slope = *value;
        }
        self.values[0]
    }
}

/// The two terms of an objective.
struct Sum {
    density: Option<Term>,
    end: Option<Term>,
}

impl Sum {
    fn of(
        term: Option<&mut Term>,
        (t, y): (f64, &[f64]),
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> f64 {
        let Some(term) = term else {
            by_state.fill(0.0);
            by_parameters.fill(0.0);
            return 0.0;
        };
        term.at(t, y, by_state, by_parameters)
    }
}

impl Functional for Sum {
    fn density(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        Ok(Sum::of(self.density.as_mut(), (t, y), by_state, by_parameters))
    }

    fn end(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        Ok(Sum::of(self.end.as_mut(), (t, y), by_state, by_parameters))
    }
}
