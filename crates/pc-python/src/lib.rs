//! The native part of the Python package `chetaev`: models, their equations printed, systems evaluated and integrated.
//!
//! This crate converts and delegates; the package in `python/` presents what it returns, and documents it for users. Read `error`, the
//! exceptions, and `notation`, the names of options in their messages; `task`, work that Ctrl-C ends; `model`, a model and what is printed
//! of it; `system`, its compiled equations, with `evaluation` at states and at arrays of states, and with `quantities` and `jacobians` besides the rates,
//! from `mechanics` and `kinematics`; then `motion`, `dense`, `stepper`, `sweep`, `gradient` and `lyapunov`, integrations, all with the settings in `plan`;
//! `linear`, the motions near a state; `animation`, pages; and `exchange`, robots in URDF and FMUs.

#![expect(clippy::needless_pass_by_value, reason = "what Python gives is converted into values of our own")]

mod animation;
mod dense;
mod error;
mod evaluation;
mod exchange;
mod gradient;
mod jacobians;
mod kinematics;
mod linear;
mod lyapunov;
mod mechanics;
mod model;
mod motion;
mod notation;
mod plan;
mod quantities;
mod stepper;
mod sweep;
mod system;
mod task;

use pyo3::prelude::*;

/// The native part of the package.
#[pymodule]
mod _native {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::animation::panels_of;
    #[pymodule_export]
    use crate::dense::DenseCore;
    #[pymodule_export]
    use crate::exchange::text_of_urdf;
    #[pymodule_export]
    use crate::model::{ModelCore, builtin_names};
    #[pymodule_export]
    use crate::quantities::Function;
    #[pymodule_export]
    use crate::stepper::Stepper;
    #[pymodule_export]
    use crate::sweep::draw;
    #[pymodule_export]
    use crate::system::SystemCore;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
