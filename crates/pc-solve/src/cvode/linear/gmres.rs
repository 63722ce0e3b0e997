//! GMRES.

use std::ffi::{c_int, c_void};
use std::slice;

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use crate::cvode::callback::{Callbacks, FATAL, nan_slice};
use crate::cvode::context::Context;
use crate::cvode::handles::{Memory, Vector, numbers_of};
use crate::cvode::linear::handles::Solver;
use crate::cvode::linear::krylov::{Krylov, Side};
use crate::cvode::linear::preconditioner::Preconditioner;
use crate::error::{NonFinite, SolveError};

/// The solver for vectors of the same kind as `y`.
pub(super) fn solver(krylov: &Krylov, context: &mut Context, y: &Vector) -> Result<Solver, SolveError> {
    let side = match krylov.preconditioner {
        None => sys::SUN_PREC_NONE,
        Some((Side::Left, _)) => sys::SUN_PREC_LEFT,
        Some((Side::Right, _)) => sys::SUN_PREC_RIGHT,
    };
    let dimension = saturating(krylov.dimension);
    // SAFETY: both are live and of one context; `y` is only a template to clone.
    let raw = unsafe { sys::SUNLinSol_SPGMR(y.raw(), side as c_int, dimension, context.raw()) };
    let solver = Solver::from_raw(context.check_new("SUNLinSol_SPGMR", raw)?);
    // SAFETY: the solver is live.
    let code = unsafe { sys::SUNLinSol_SPGMRSetMaxRestarts(solver.raw(), saturating(krylov.restarts)) };
    context.check("SUNLinSol_SPGMRSetMaxRestarts", code)?;
    Ok(solver)
}

/// Sets the tolerance and the callbacks in CVODES, whose linear solver has already been set;
/// returns the preconditioner for the callbacks.
pub(super) fn attach<F: VectorField>(
    krylov: &Krylov,
    memory: &Memory,
    context: &mut Context,
    has_jvp: bool,
) -> Result<Option<Box<dyn Preconditioner + Send>>, SolveError> {
    memory.set(context, "CVodeSetEpsLin", sys::CVodeSetEpsLin, krylov.tolerance)?;
    if has_jvp {
        // SAFETY: the linear solver is set, and the user data are those the callback expects.
        let code = unsafe { sys::CVodeSetJacTimes(memory.raw(), None, Some(product::<F>)) };
        context.check("CVodeSetJacTimes", code)?;
    }
    let Some((_, maker)) = &krylov.preconditioner else { return Ok(None) };
    // SAFETY: the linear solver is set, and the user data are those the callbacks expect.
    let code =
        unsafe { sys::CVodeSetPreconditioner(memory.raw(), Some(set_up::<F>), Some(precondition::<F>)) };
    context.check("CVodeSetPreconditioner", code)?;
    Ok(Some((maker.0)()))
}

fn saturating(number: u32) -> c_int {
    c_int::try_from(number).unwrap_or(c_int::MAX)
}

impl<F: VectorField> Callbacks<F> {
    fn product(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> c_int {
        self.guard(|field, offset| {
            let y = offset.map_or(y, |offset| offset.state_of(y));
            field.jvp(t, y, v, product)?;
            match product.iter().position(|value| !value.is_finite()) {
                None => Ok(()),
                Some(i) => Err(Failure::recoverable(NonFinite::Product {
                    component: field.component_name(i),
                    value: product[i],
                    t,
                })),
            }
        })
    }

    /// Like `guard`, but also passes the preconditioner to `evaluate`.
    fn with_preconditioner(
        &mut self,
        evaluate: impl FnOnce(&mut dyn Preconditioner, &mut F, &[f64]) -> Result<(), Failure>,
        y: &[f64],
    ) -> c_int {
        let Some(mut preconditioner) = self.linear.preconditioner.take() else { return FATAL };
        let answer = self.guard(|field, offset| {
            let y = offset.map_or(y, |offset| offset.state_of(y));
            evaluate(&mut *preconditioner, field, y)
        });
        self.linear.preconditioner = Some(preconditioner);
        answer
    }
}

/// `CVLsJacTimesVecFn`.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData) and
/// vectors of its dimension.
unsafe extern "C" fn product<F: VectorField>(
    v: sys::N_Vector,
    product: sys::N_Vector,
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    user_data: *mut c_void,
    _tmp: sys::N_Vector,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: all are live serial vectors of length `dim`, `product` distinct from the others.
    let (y, v, product) = unsafe {
        let numbers = |vector| slice::from_raw_parts(numbers_of(vector), callbacks.dim);
        (numbers(y), numbers(v), nan_slice(numbers_of(product), callbacks.dim))
    };
    callbacks.product(t, y, v, product)
}

/// `CVLsPrecSetupFn`.
///
/// # Safety
/// As for [`product`]; `is_current` points to memory for the result.
unsafe extern "C" fn set_up<F: VectorField>(
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    may_keep: c_int,
    is_current: *mut c_int,
    gamma: f64,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: `y` is a live serial vector of length `dim`.
    let y = unsafe { slice::from_raw_parts(numbers_of(y), callbacks.dim) };
    let renew = may_keep == 0;
    // SAFETY: a place for the result.
    unsafe { *is_current = renew.into() };
    let set_up = |preconditioner: &mut dyn Preconditioner, field: &mut F, y: &[f64]| {
        if renew {
            preconditioner.linearise(field, t, y)?;
        }
        preconditioner.factorise(gamma)
    };
    callbacks.with_preconditioner(set_up, y)
}

/// `CVLsPrecSolveFn`.
///
/// # Safety
/// As for [`product`].
unsafe extern "C" fn precondition<F: VectorField>(
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    r: sys::N_Vector,
    z: sys::N_Vector,
    _gamma: f64,
    _tolerance: f64,
    _side: c_int,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: all are live serial vectors of length `dim`, `z` distinct from the others.
    let (y, r, z) = unsafe {
        let numbers = |vector| slice::from_raw_parts(numbers_of(vector), callbacks.dim);
        (numbers(y), numbers(r), nan_slice(numbers_of(z), callbacks.dim))
    };
    let solve = |preconditioner: &mut dyn Preconditioner, field: &mut F, _y: &[f64]| {
        preconditioner.solve(r, z)?;
        match z.iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(i) => Err(Failure::recoverable(NonFinite::Preconditioned {
                component: field.component_name(i),
                value: z[i],
                t,
            })),
        }
    };
    callbacks.with_preconditioner(solve, y)
}
