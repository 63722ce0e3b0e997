//! A motion as a function of time.

use numpy::prelude::*;
use numpy::{PyArray1, PyArray2};
use pc_model::deep;
use pc_solve::{DenseOutput, Solve};
use pyo3::prelude::*;

use crate::error::Error;
use crate::model::renewed;
use crate::plan::{Wished, options};
use crate::system::SystemCore;
use crate::task::attended;

/// The polynomials of the steps of an integration.
#[pyclass(frozen, module = "chetaev._native")]
pub(crate) struct DenseCore {
    motion: DenseOutput,
    dim: usize,
}

#[pymethods]
impl DenseCore {
    /// The first and the last time.
    #[getter]
    fn span(&self) -> Option<(f64, f64)> {
        self.motion.span()
    }

    /// The states at the given times, as columns.
    fn at<'py>(&self, py: Python<'py>, times: Vec<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut states = vec![0.0; self.dim * times.len()];
        for (k, &t) in times.iter().enumerate() {
            let state = self.motion.evaluate(t).map_err(Error::from)?;
            for (i, value) in state.into_iter().enumerate() {
                states[i * times.len() + k] = value;
            }
        }
        PyArray1::from_vec(py, states).reshape([self.dim, times.len()])
    }
}

#[pymethods]
impl SystemCore {
    /// The motion from a state at the start to `end`, or to a terminal event before that.
    #[pyo3(name = "_dense")]
    fn dense(&self, py: Python<'_>, end: f64, start: Vec<f64>, wished: Wished) -> PyResult<DenseCore> {
        let (mut model, derived) = self.now();
        let cancel = renewed(&mut model);
        let (t_start, dim) = (self.inventory.t_start, self.dim());
        let plan = wished.plan(&model, self.variables, &cancel)?;
        self.check_length(start.len())?;
        let mut flow = derived.flow;
        flow.start = start;
        let options = options(&plan, &mut flow);
        let work = move || {
            deep(|| {
                let solve = Solve::new(&mut flow.motion, t_start, &flow.start);
                Ok(solve.method(&options).events(&mut flow.events).dense(end)?)
            })
        };
        let motion = attended(py, &cancel, |_| Ok(()), work)?;
        Ok(DenseCore { motion, dim })
    }
}
