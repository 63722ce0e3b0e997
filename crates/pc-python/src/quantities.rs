//! Functions of the state besides the rates.

use std::sync::{Mutex, PoisonError};

use pc_expr::Evaluator;
use pc_mech::LegendreTransform;
use pc_model::Flow;
use pyo3::prelude::*;

use crate::evaluation::Quantity;
use crate::mechanics::{MassMatrix, bracket, evaluate, read};
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
        self.check_length(y.len())?;
        let missing = self.mass.lock().unwrap_or_else(PoisonError::into_inner).is_none();
        if missing {
            let variables = self.variables;
            let derived = self.derive(py, move |model| MassMatrix::of(model, variables))?;
            *self.mass.lock().unwrap_or_else(PoisonError::into_inner) = Some(derived);
        }
        let parameters = self.state().derived.flow.motion.parameters().to_vec();
        let mut known = self.mass.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(MassMatrix { entries, transform, size }) = &mut *known else {
            return Ok((0, Vec::new())); // it has just been derived, and nobody takes it away
        };
        let mut values = vec![f64::NAN; *size * *size];
        let state = read(transform.as_mut(), t, &y, &parameters)?;
        evaluate(entries, (t, &state, &parameters), &mut values)?;
        Ok((*size, values))
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
