//! Gradients of functions of a motion.

use pc_model::{Variables, deep};
use pc_run::motion::gradient::{Objective, ObjectiveGradient, gradient};
use pyo3::prelude::*;

use crate::error::Error;
use crate::model::renewed;
use crate::plan::Wished;
use crate::system::SystemCore;
use crate::task::attended;

#[pymethods]
impl SystemCore {
    /// The value of an objective, and its derivatives with respect to the state at the start and to the parameters whose
    /// sensitivities are requested.
    #[pyo3(name = "_gradient")]
    #[expect(clippy::type_complexity, reason = "a tuple for Python")]
    fn gradient(
        &self,
        py: Python<'_>,
        end: Option<String>,
        integral: Option<String>,
        wished: Wished,
    ) -> PyResult<(f64, Vec<(String, f64)>, Vec<(String, f64)>)> {
        if self.variables != Variables::QuasiVelocities {
            let why = "the state has other variables than the model; use the form poincare";
            return Err(Error::Unsupported { what: "a gradient", why }.into());
        }
        let (mut model, _) = self.now();
        let cancel = renewed(&mut model);
        let plan = wished.plan(&model, self.variables, &cancel)?;
        let work = move || deep(|| Ok(gradient(&model, &plan, &Objective { end, integral })?));
        let ObjectiveGradient { value, by_start, by_parameters } = attended(py, &cancel, |_| Ok(()), work)?;
        Ok((value, by_start, by_parameters))
    }
}
