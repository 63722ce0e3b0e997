//! From a problem and options to a solver that is ready.

use std::ffi::c_int;

use pc_expr::VectorField;
use sundials_sys as sys;

use super::foresight::Foresight;
use crate::cvode::callback;
use crate::cvode::callback::UserData;
use crate::cvode::context::Context;
use crate::cvode::cvode::Cvode;
use crate::cvode::handles::{Memory, NonlinearIteration, Vector};
use crate::cvode::linear::choice::choose;
use crate::cvode::linear::linear::Linear;
use crate::cvode::options::Options;
use crate::error::SolveError;
use crate::integration::checks::{check_inequalities, check_start, finite};
use crate::integration::statistics::Statistics;
use crate::integration::stepper::Stepper;
use crate::settings::inequality::Inequality;
use crate::settings::method::Method;
use crate::settings::tolerance::Tolerance;

impl<F: VectorField> Cvode<F> {
    /// Starts at y(t0) = y0, where `y0` has as many numbers as `field` has components.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all inputs are finite, of matching lengths and in their ranges;
    /// [`SolveError::Setup`] if SUNDIALS runs out of memory.
    pub fn new(field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        check_start(&field, t0, y0)?;
        options.validate(y0.len())?;
        check_inequalities(&field, y0, &options.inequalities)?;
        let linear_solver = choose(&field, options)?;
        let foresight = Foresight::new(&field, t0, options);

        // Dropped in reverse order if one of them fails.
        let mut context = Context::new()?;
        let mut callbacks = UserData::new(field, y0.len());
        let mut step_state = Vector::new(&mut context, y0)?;
        step_state.halve_after_violations();
        let work = Vector::new(&mut context, y0)?;
        let linear = linear_solver
            .map(|choice| Linear::new(&mut context, &step_state, choice, callbacks.field()))
            .transpose()?;
        let nonlinear_iteration = if linear.is_some() {
            NonlinearIteration::newton(&mut context, &step_state)?
        } else {
            NonlinearIteration::fixed_point(&mut context, &step_state)?
        };
        let method = match options.method {
            Method::Bdf => sys::CV_BDF,
            Method::Adams => sys::CV_ADAMS,
        };
        let memory = Memory::new(&mut context, method)?;
        let mem = memory.raw();

        // SAFETY: `mem` is live; CVODES copies the start from the vector.
        let code = unsafe { sys::CVodeInit(mem, Some(callback::rhs::<F>), t0, step_state.raw()) };
        context.check("CVodeInit", code)?;
        // SAFETY: the address is of a `Callbacks<F>`, as `callback::rhs::<F>` expects, and outlives `mem`.
        let code = unsafe { sys::CVodeSetUserData(mem, callbacks.address()) };
        context.check("CVodeSetUserData", code)?;
        // SAFETY: `mem` is initialised; the iteration outlives it.
        let code = unsafe { sys::CVodeSetNonlinearSolver(mem, nonlinear_iteration.raw()) };
        context.check("CVodeSetNonlinearSolver", code)?;
        if let Some(linear) = &linear {
            linear.attach(&memory, &mut context, &mut callbacks, &options.inequalities)?;
        }
        apply(options, &memory, &mut context)?;

        let mut cvode = Cvode {
            memory,
            _nonlinear_iteration: nonlinear_iteration,
            linear,
            sensitivity: None,
            quadrature: None,
            step_state,
            work,
            callbacks,
            context,
            time: t0,
            step_time: t0,
            direction: None,
            initial_step: options.initial_step,
            stop_time: None,
            limits: options.limits(),
            idle_steps: 0,
            idle_failure: None,
            earlier: Statistics::default(),
            restarted: false,
            foresight,
        };
        if let Some(t) = options.stop_time {
            finite("the stop time", t)?;
            cvode.set_stop_time(Some(t))?;
        }
        Ok(cvode)
    }
}

/// Hands the tolerances and limits to CVODES, which has been initialised.
fn apply(options: &Options, memory: &Memory, context: &mut Context) -> Result<(), SolveError> {
    let rtol = options.relative_tolerance;
    match &options.absolute_tolerance {
        Tolerance::Scalar(atol) => {
            // SAFETY: the memory is initialised.
            let code = unsafe { sys::CVodeSStolerances(memory.raw(), rtol, *atol) };
            context.check("CVodeSStolerances", code)?;
        }
        Tolerance::Vector(atol) => {
            let atol = Vector::new(context, atol)?;
            // SAFETY: the memory is initialised; CVODES copies the vector, which has its dimension.
            let code = unsafe { sys::CVodeSVtolerances(memory.raw(), rtol, atol.raw()) };
            context.check("CVodeSVtolerances", code)?;
        }
    }
    if options.inequalities.iter().any(|&inequality| inequality != Inequality::Free) {
        let numbers: Vec<f64> = options.inequalities.iter().copied().map(number).collect();
        let numbers = Vector::new(context, &numbers)?;
        // SAFETY: the memory is initialised; CVODES copies the vector, which has its dimension.
        let code = unsafe { sys::CVodeSetConstraints(memory.raw(), numbers.raw()) };
        context.check("CVodeSetConstraints", code)?;
    }
    if let Some(length) = options.max_step {
        memory.set(context, "CVodeSetMaxStep", sys::CVodeSetMaxStep, length)?;
    }
    if let Some(length) = options.min_step {
        memory.set(context, "CVodeSetMinStep", sys::CVodeSetMinStep, length)?;
    }
    if let Some(order) = options.max_order {
        memory.set(context, "CVodeSetMaxOrd", sys::CVodeSetMaxOrd, order as c_int)?;
    }
    Ok(())
}

/// The number that stands for an inequality in `CVodeSetConstraints`.
fn number(inequality: Inequality) -> f64 {
    match inequality {
        Inequality::Free => 0.0,
        Inequality::NotNegative => 1.0,
        Inequality::NotPositive => -1.0,
        Inequality::Positive => 2.0,
        Inequality::Negative => -2.0,
    }
}
