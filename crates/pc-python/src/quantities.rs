//! Functions of the state besides the rates.

use std::sync::{Mutex, PoisonError};

use pc_expr::Evaluator;
use pc_mech::{InverseDynamics, LegendreTransform};
use pc_model::Flow;
use pyo3::prelude::*;

use crate::error::Error;
use crate::evaluation::Quantity;
use crate::mechanics::{Dynamics, bracket, evaluate, read};
use crate::system::SystemCore;

/// The Poisson bracket (12) of two functions of the state, as a function of the state.
#[pyclass(frozen, module = "chetaev._native")]
pub(crate) struct Function {
    value: Mutex<(Evaluator, Option<LegendreTransform>)>,
    system: Py<SystemCore>,
}

#[pymethods]
impl Function {
    /// The value of the bracket at a state.
    fn at(&self, py: Python<'_>, t: f64, y: Vec<f64>) -> PyResult<f64> {
        let system = self.system.get();
        system.check_length(y.len())?;
        let parameters = system.state().derived.flow.motion.parameters().to_vec();
        let mut value = [f64::NAN];
        py.detach(|| {
            let mut function = self.value.lock().unwrap_or_else(PoisonError::into_inner);
            let (program, transform) = &mut *function;
            let state = read(transform.as_mut(), t, &y, &parameters)?;
            evaluate(program, (t, &state, &parameters), &mut value)
        })?;
        Ok(value[0])
    }
}

impl SystemCore {
    /// Evaluates the inverse dynamics, derived on the first request, at a state with quasi-velocities.
    fn with_dynamics<T>(
        &self,
        py: Python<'_>,
        t: f64,
        y: &[f64],
        evaluate: impl FnOnce(&mut InverseDynamics, &[f64]) -> Result<T, Error>,
    ) -> PyResult<T> {
        self.check_length(y.len())?;
        let missing = self.dynamics.lock().unwrap_or_else(PoisonError::into_inner).is_none();
        if missing {
            let variables = self.variables;
            let derived = self.derive(py, move |model| Dynamics::of(model, variables))?;
            self.dynamics.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(derived);
        }
        let parameters = self.state().derived.flow.motion.parameters().to_vec();
        let mut known = self.dynamics.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(Dynamics { inverse, transform }) = &mut *known else {
            return Err(Error::Busy.into()); // it has just been derived, and nobody takes it away
        };
        inverse.parameters_mut().copy_from_slice(&parameters);
        let state = read(transform.as_mut(), t, y, &parameters)?;
        Ok(evaluate(inverse, &state)?)
    }
}

#[pymethods]
impl SystemCore {
    /// Coordinates, quasi-velocities, first-order states and observables: one row of a motion.
    #[pyo3(name = "_row")]
    fn row<'py>(&self, t: &Bound<'py, PyAny>, y: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let evaluate = |flow: &mut Flow, t: f64, y: &[f64], values: &mut [f64]| {
            values.copy_from_slice(&flow.row(t, y));
            Ok(())
        };
        self.quantity(t, y, Quantity { shape: vec![self.inventory.columns.len()], evaluate })
    }

    /// y·η − L.
    fn energy<'py>(&self, t: &Bound<'py, PyAny>, y: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let conserved = self.inventory.conserved;
        let mut all = vec![f64::NAN; self.inventory.columns.len() - self.inventory.shown];
        let evaluate = move |flow: &mut Flow, t: f64, y: &[f64], values: &mut [f64]| {
            flow.motion.observe_to(t, y, &mut all);
            values[0] = all[conserved - 1]; // the last of those that should stay constant
            Ok(())
        };
        self.quantity(t, y, Quantity { shape: Vec::new(), evaluate })
    }

    /// M = ∂²L/∂η∂η at a state: its size, and its entries row by row.
    #[pyo3(name = "_mass_entries")]
    fn mass_entries(&self, py: Python<'_>, t: f64, y: Vec<f64>) -> PyResult<(usize, Vec<f64>)> {
        self.with_dynamics(py, t, &y, |inverse, state| {
            let size = inverse.len();
            let mut entries = vec![f64::NAN; size * size];
            inverse.mass_matrix(t, state, &mut entries)?;
            Ok((size, entries))
        })
    }

    /// The forces that have to be added for these accelerations, or zeros, at a state, or at rest where it is.
    #[pyo3(name = "_inverse_dynamics")]
    fn inverse_dynamics(
        &self,
        py: Python<'_>,
        t: f64,
        y: Vec<f64>,
        accelerations: Option<Vec<f64>>,
        at_rest: bool,
    ) -> PyResult<Vec<f64>> {
        self.with_dynamics(py, t, &y, |inverse, state| {
            let mut forces = vec![f64::NAN; inverse.len()];
            match &accelerations {
                _ if at_rest => inverse.holding(t, state, &mut forces)?,
                None => inverse.bias(t, state, &mut forces)?,
                Some(given) if given.len() == forces.len() => inverse.forces(t, state, given, &mut forces)?,
                Some(given) => {
                    let what = "the list of accelerations, one for each quasi-velocity,";
                    return Err(Error::Length { what, given: given.len(), expected: forces.len() });
                }
            }
            Ok(forces)
        })
    }

    /// The Poisson bracket of two expressions of the model.
    #[pyo3(name = "_poisson_bracket")]
    fn poisson_bracket(slf: &Bound<'_, SystemCore>, f: String, g: String) -> PyResult<Function> {
        let system = slf.get();
        let variables = system.variables;
        let (value, transform) = system.derive(slf.py(), move |model| {
            let value = bracket(model, variables, &f, &g)?;
            let transform = match variables.has_momenta() {
                true => Some(model.derived(|assembly| assembly.legendre_transform(variables))?),
                false => None,
            };
            Ok((value, transform))
        })?;
        Ok(Function { value: Mutex::new((value, transform)), system: slf.clone().unbind() })
    }
}
