//! GMRES.

use std::ffi::{c_int, c_void};
use std::sync::Arc;
use std::{fmt, slice};

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use super::handles::Solver;
use super::preconditioner::Preconditioner;
use crate::cvode::callback::{Callbacks, FATAL, nan_slice};
use crate::cvode::context::Context;
use crate::cvode::handles::{Memory, Vector, numbers_of};
use crate::error::{InputError, NonFinite, SolveError};
use crate::integration::options::positive;

/// On which side of A = I − γ ∂f/∂y the inverse of the preconditioner P stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// P⁻¹ A x = P⁻¹ b: the residual that is made small is P⁻¹ (b − A x).
    Left,
    /// A P⁻¹ (P x) = b: the residual is b − A x, as without a preconditioner.
    Right,
}

/// The method of generalised minimal residuals, GMRES [Saad, Schultz, SIAM J. Sci. Stat. Comp. 7 (1986) 856].
#[derive(Debug, Clone, PartialEq)]
pub struct Krylov {
    dimension: u32,
    restarts: u32,
    tolerance: f64,
    preconditioner: Option<(Side, Maker)>,
}

impl Default for Krylov {
    /// A space of dimension 5.
    fn default() -> Self {
        Krylov::new(5)
    }
}

impl Krylov {
    /// Searches spaces spanned by b, A b, A² b, … of the given dimension, at least 1; without restarts and
    /// preconditioner, and with tolerance 0.05.
    pub fn new(dimension: u32) -> Self {
        Krylov { dimension, restarts: 0, tolerance: 0.05, preconditioner: None }
    }

    /// How often to go on with the residual from a new space when the first does not suffice.
    pub fn restarts(self, restarts: u32) -> Self {
        Krylov { restarts, ..self }
    }

    /// How small the residual must become, in parts of the tolerance of Newton's iteration; positive.
    pub fn tolerance(self, tolerance: f64) -> Self {
        Krylov { tolerance, ..self }
    }

    /// With a preconditioner: `make` makes one for each integration.
    pub fn preconditioner<P: Preconditioner + Send + 'static>(
        self,
        side: Side,
        make: impl Fn() -> P + Send + Sync + 'static,
    ) -> Self {
        let maker = Maker(Arc::new(move || Box::new(make())));
        Krylov { preconditioner: Some((side, maker)), ..self }
    }

    pub(super) fn check(&self) -> Result<(), InputError> {
        positive("the dimension of the Krylov space", f64::from(self.dimension))?;
        positive("the tolerance of the Krylov solver", self.tolerance)
    }

    pub(super) fn solver(&self, context: &mut Context, y: &Vector) -> Result<Solver, SolveError> {
        let side = match self.preconditioner {
            None => sys::SUN_PREC_NONE,
            Some((Side::Left, _)) => sys::SUN_PREC_LEFT,
            Some((Side::Right, _)) => sys::SUN_PREC_RIGHT,
        };
        let dimension = saturating(self.dimension);
        // SAFETY: both are live and of one context; `y` is only a template to clone.
        let raw = unsafe { sys::SUNLinSol_SPGMR(y.raw(), side as c_int, dimension, context.raw()) };
        let solver = Solver::from_raw(context.check_new("SUNLinSol_SPGMR", raw)?);
        // SAFETY: the solver is live.
        let code = unsafe { sys::SUNLinSol_SPGMRSetMaxRestarts(solver.raw(), saturating(self.restarts)) };
        context.check("SUNLinSol_SPGMRSetMaxRestarts", code)?;
        Ok(solver)
    }

    /// Gives CVODES, whose linear solver is set, the tolerance and the callbacks; the preconditioner is for them.
    pub(super) fn attach<F: VectorField>(
        &self,
        memory: &Memory,
        context: &mut Context,
        has_jvp: bool,
    ) -> Result<Option<Box<dyn Preconditioner + Send>>, SolveError> {
        memory.set(context, "CVodeSetEpsLin", sys::CVodeSetEpsLin, self.tolerance)?;
        if has_jvp {
            // SAFETY: the linear solver is set, and the user data are those the callback expects.
            let code = unsafe { sys::CVodeSetJacTimes(memory.raw(), None, Some(product::<F>)) };
            context.check("CVodeSetJacTimes", code)?;
        }
        let Some((_, maker)) = &self.preconditioner else { return Ok(None) };
        // SAFETY: the linear solver is set, and the user data are those the callbacks expect.
        let code =
            unsafe { sys::CVodeSetPreconditioner(memory.raw(), Some(set_up::<F>), Some(precondition::<F>)) };
        context.check("CVodeSetPreconditioner", code)?;
        Ok(Some((maker.0)()))
    }
}

fn saturating(number: u32) -> c_int {
    c_int::try_from(number).unwrap_or(c_int::MAX)
}

/// Makes preconditioners. Two are equal if they are copies of one.
#[derive(Clone)]
struct Maker(Arc<dyn Fn() -> Box<dyn Preconditioner + Send> + Send + Sync>);

impl fmt::Debug for Maker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Maker")
    }
}

impl PartialEq for Maker {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
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

    /// Calls `evaluate` with the preconditioner too.
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
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData) and vectors of its dimension.
unsafe extern "C" fn product<F: VectorField>(
    v: sys::N_Vector,
    product: sys::N_Vector,
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    user_data: *mut c_void,
    _tmp: sys::N_Vector,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of CVODES.
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
/// As for [`product`]; `is_current` is a place for the result.
unsafe extern "C" fn set_up<F: VectorField>(
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    may_keep: c_int,
    is_current: *mut c_int,
    gamma: f64,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of CVODES.
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
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of CVODES.
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
