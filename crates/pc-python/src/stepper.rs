//! A motion step by step, under inputs that a controller chooses.

use std::sync::{Mutex, MutexGuard, PoisonError};

use numpy::PyArray1;
use pc_expr::Events;
use pc_model::Flow;
use pc_solve::{Ending, Options, Solution, Solve, SolveFailure};
use pyo3::prelude::*;

use crate::error::Error;
use crate::model::renewed;
use crate::motion::on_constraints;
use crate::plan::{Wished, options};
use crate::system::SystemCore;

/// A motion that is integrated from one time of a controller to the next, with inputs that are constant between them.
///
/// It is made by `System.stepper`.
#[pyclass(frozen, module = "chetaev")]
pub(crate) struct Stepper(Mutex<Walk>);

/// The current point of a motion.
struct Walk {
    flow: Flow,
    options: Options,
    t_start: f64,
    t: f64,
    y: Vec<f64>,
    parameters: Vec<f64>,
    /// The indices of the inputs among the parameters.
    inputs: Vec<usize>,
    /// The terminal event that has ended the motion.
    terminal: Option<String>,
}

impl Stepper {
    fn walk(&self) -> MutexGuard<'_, Walk> {
        // What a panic leaves behind is a state that `restart` replaces.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Stepper {
    /// The time.
    #[getter]
    fn t(&self) -> f64 {
        self.walk().t
    }

    /// The state, an array of n numbers.
    #[getter]
    fn y<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.walk().y)
    }

    /// The name of the terminal event that has ended the motion, or None.
    #[getter]
    fn terminal(&self) -> Option<String> {
        self.walk().terminal.clone()
    }

    /// Continues for the time `dt` with these values of the inputs, or with those of the last step, and returns the new state. A
    /// terminal event ends the motion earlier.
    #[pyo3(signature = (dt, inputs=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        dt: f64,
        inputs: Option<Vec<f64>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut walk = self.walk();
        if let Some(inputs) = inputs {
            walk.set(&inputs)?;
        }
        if !dt.is_finite() {
            return Err(Error::NotFinite { what: "the length of the step".to_owned(), value: dt }.into());
        }
        if walk.terminal.is_none() && dt != 0.0 {
            walk.go_on(dt)?;
        }
        Ok(PyArray1::from_slice(py, &walk.y))
    }

    /// Sets the motion to a time and a state; by default those of the start.
    #[pyo3(signature = (y=None, t=None))]
    fn restart(&self, y: Option<Vec<f64>>, t: Option<f64>) -> PyResult<()> {
        let mut walk = self.walk();
        let y = y.unwrap_or_else(|| walk.flow.start.clone());
        if y.len() != walk.y.len() {
            let (given, expected) = (y.len(), walk.y.len());
            return Err(Error::Length { what: "the state", given, expected }.into());
        }
        let t = t.unwrap_or(walk.t_start);
        on_constraints(&mut walk.flow, t, &y)?;
        (walk.t, walk.y, walk.terminal) = (t, y, None);
        Ok(())
    }

    /// All columns of a motion at the state, in the order of the columns of the system.
    fn row<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let Walk { flow, t, y, .. } = &mut *self.walk();
        PyArray1::from_vec(py, flow.row(*t, y))
    }
}

impl Walk {
    fn set(&mut self, inputs: &[f64]) -> Result<(), Error> {
        if inputs.len() != self.inputs.len() {
            let (given, expected) = (inputs.len(), self.inputs.len());
            return Err(Error::Length { what: "the list of inputs", given, expected });
        }
        let mut is_same = true;
        for (&place, &value) in self.inputs.iter().zip(inputs) {
            if !value.is_finite() {
                return Err(Error::NotFinite { what: "an input".to_owned(), value });
            }
            is_same &= self.parameters[place] == value;
            self.parameters[place] = value;
        }
        if !is_same {
            self.flow.set_parameters(&self.parameters);
        }
        Ok(())
    }

    fn go_on(&mut self, dt: f64) -> Result<(), Error> {
        let Flow { motion, events, .. } = &mut self.flow;
        let solve = Solve::new(motion, self.t, &self.y).method(&self.options).events(&mut *events);
        let (reached, error) = SolveFailure::split(solve.run(&[self.t + dt]));
        if let Some(error) = error {
            return Err(error.into());
        }
        let Solution { trajectory, ending, .. } = reached;
        if let Some((t, y)) = trajectory.last() {
            self.t = t;
            self.y.copy_from_slice(y);
        }
        if let Some(Ending::Event { event }) = ending {
            self.terminal = events.events().get(event).map(|event| event.name().to_owned());
        }
        Ok(())
    }
}

#[pymethods]
impl SystemCore {
    /// A motion from the start, step by step; tolerances are scaled for a step of this length.
    #[pyo3(name = "_stepping")]
    fn stepping(&self, wished: Wished) -> PyResult<Stepper> {
        let (mut model, derived) = self.now();
        let cancel = renewed(&mut model);
        let plan = wished.plan(&model, self.variables, &cancel)?;
        let mut flow = derived.flow;
        let options = options(&plan, &mut flow);
        let tables: Vec<usize> = model.parameter_values().tables().iter().map(|&(place, _)| place).collect();
        let document = model.document();
        let places = document.parameters.len()..document.parameters.len() + document.inputs.len();
        if places.clone().any(|place| tables.contains(&place)) {
            let why = "an input follows a table, which a step would not change; give it a number by `inputs` of the system";
            return Err(Error::Unsupported { what: "a stepper", why }.into());
        }
        let parameters = model.parameters().map(|(_, value)| value).collect();
        let t_start = self.inventory.t_start;
        Ok(Stepper(Mutex::new(Walk {
            t_start,
            t: t_start,
            y: flow.start.clone(),
            flow,
            options,
            parameters,
            inputs: places.collect(),
            terminal: None,
        })))
    }
}
