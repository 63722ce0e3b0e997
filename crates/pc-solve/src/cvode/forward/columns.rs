//! The columns of an integration with sensitivities.

use sundials_sys as sys;

use crate::cvode::forward::sensitivities::{Correction, SensitivityStatistics};
use crate::cvode::handles::{NonlinearIteration, Vector};

/// The data of the sensitivities of an integration.
pub(crate) struct Forward {
    /// The nonlinear solver, kept alive because CVODES refers to it.
    pub(super) _nonlinear_iteration: NonlinearIteration,
    /// Room for the columns, written by CVODES.
    pub(crate) columns: Vec<Vector>,
    /// S at the last start or restart, column-major.
    pub(super) matrix: Vec<f64>,
    pub(super) correction: Correction,
    /// The work before the last restart.
    pub(super) earlier: SensitivityStatistics,
}

impl Forward {
    /// The columns in the form that CVODES expects.
    pub(crate) fn raw(&self) -> Vec<sys::N_Vector> {
        self.columns.iter().map(Vector::raw).collect()
    }
}
