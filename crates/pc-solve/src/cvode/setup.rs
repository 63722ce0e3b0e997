//! Construction of the solver from a problem and options.

use std::ffi::c_int;

use pc_expr::{Method, VectorField};
use sundials_sys as sys;

use super::foresight::Foresight;
use crate::cvode::callback;
use crate::cvode::callback::UserData;
use crate::cvode::context::Context;
use crate::cvode::cvode::Cvode;
use crate::cvode::handles::{Memory, NonlinearIteration, Vector};
use crate::cvode::linear::choice::choose;
use crate::cvode::linear::linear::Linear;
use crate::cvode::linear::solver::LinearSolver;
use crate::error::SolveError;
use crate::integration::checks::{check_inequalities, check_start};
use crate::integration::statistics::Statistics;
use crate::integration::stepper::Stepper;
use crate::settings::inequality::Inequality;
use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

impl<F: VectorField> Cvode<F> {
    /// Starts at y(t0) = y0, which has one number per component.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all inputs are finite, of matching lengths and in their ranges;
    /// [`SolveError::Setup`] if SUNDIALS runs out of memory.
    pub fn new(field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        Cvode::start(field, t0, y0, options).map_err(|(error, _)| error)
    }

    /// The same, but returns the field on failure.
    pub(crate) fn start(
        mut field: F,
        t0: f64,
        y0: &[f64],
        options: &Options,
    ) -> Result<Self, (SolveError, F)> {
        let (options, linear_solver) = match checked(&field, t0, y0, options) {
            Ok(checked) => checked,
            Err(error) => return Err((error, field)),
        };
        let foresight = Foresight::new(&mut field, t0, &options);
        let mut callbacks = UserData::new(field, y0.len());
        let parts = match Parts::new(&mut callbacks, t0, y0, &options, linear_solver) {
            Ok(parts) => parts,
            Err(error) => return Err((error, callbacks.into_field())),
        };
        let Parts { memory, nonlinear_iteration, linear, step_state, work, context } = parts;
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
        match options.stop_time.map_or(Ok(()), |t| cvode.set_stop_time(Some(t))) {
            Ok(()) => Ok(cvode),
            Err(error) => Err((error, cvode.into_field())),
        }
    }
}

/// Validates the input; returns the options for a method of CVODES, and the linear solver.
fn checked(
    field: &impl VectorField,
    t0: f64,
    y0: &[f64],
    options: &Options,
) -> Result<(Options, Option<LinearSolver>), SolveError> {
    let options = options.by_cvode()?;
    check_start(field, t0, y0)?;
    options.validate(y0.len())?;
    check_inequalities(field, y0, &options.inequalities)?;
    let linear_solver = choose(field, &options)?;
    Ok((options, linear_solver))
}

/// The objects of SUNDIALS, to be dropped in this order.
struct Parts {
    memory: Memory,
    nonlinear_iteration: NonlinearIteration,
    linear: Option<Linear>,
    step_state: Vector,
    work: Vector,
    context: Context,
}

impl Parts {
    /// Makes the objects, which call `callbacks`; `callbacks` must outlive them.
    fn new<F: VectorField>(
        callbacks: &mut UserData<F>,
        t0: f64,
        y0: &[f64],
        options: &Options,
        linear_solver: Option<LinearSolver>,
    ) -> Result<Parts, SolveError> {
        // Dropped in reverse order if one of them fails.
        let mut context = Context::new()?;
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
        let method = if options.method == Method::Bdf { sys::CV_BDF } else { sys::CV_ADAMS };
        let memory = Memory::new(&mut context, method)?;
        let mem = memory.raw();

        // SAFETY: `mem` is live; CVODES copies the start from the vector.
        let code = unsafe { sys::CVodeInit(mem, Some(callback::rhs::<F>), t0, step_state.raw()) };
        context.check("CVodeInit", code)?;
        // SAFETY: the address is of a `Callbacks<F>`, as `callback::rhs::<F>` expects, and outlives
        // `mem`.
        let code = unsafe { sys::CVodeSetUserData(mem, callbacks.address()) };
        context.check("CVodeSetUserData", code)?;
        // SAFETY: `mem` is initialised; the iteration outlives it.
        let code = unsafe { sys::CVodeSetNonlinearSolver(mem, nonlinear_iteration.raw()) };
        context.check("CVodeSetNonlinearSolver", code)?;
        if let Some(linear) = &linear {
            linear.attach(&memory, &mut context, callbacks, &options.inequalities)?;
        }
        apply(options, &memory, &mut context)?;
        Ok(Parts { memory, nonlinear_iteration, linear, step_state, work, context })
    }
}

/// Sets the tolerances and limits of CVODES, which has been initialised.
fn apply(options: &Options, memory: &Memory, context: &mut Context) -> Result<(), SolveError> {
    let rtol = options.resolved_tolerance();
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

/// The code of an inequality in `CVodeSetConstraints`.
fn number(inequality: Inequality) -> f64 {
    match inequality {
        Inequality::Free => 0.0,
        Inequality::NotNegative => 1.0,
        Inequality::NotPositive => -1.0,
        Inequality::Positive => 2.0,
        Inequality::Negative => -2.0,
    }
}
