//! Integrals along an integration.

use std::ffi::{c_int, c_void};
use std::slice;

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use crate::cvode::callback::{Callbacks, nan_slice};
use crate::cvode::cvode::Cvode;
use crate::cvode::handles::{Vector, numbers_of};
use crate::error::SolveError;

/// A vector field with integrals q̇ = r(t, y) that do not act on it.
pub(crate) trait Quadratures {
    /// Number of integrals, at least 1.
    fn count(&self) -> usize;

    /// Writes r(t, y), all finite.
    fn integrands(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure>;
}

impl<F: VectorField> Cvode<F> {
    /// Begins the integrals at zero, with these tolerances, before the first step.
    pub(crate) fn begin_quadratures(&mut self, relative: f64, absolute: f64) -> Result<(), SolveError>
    where
        F: Quadratures,
    {
        let zeros = vec![0.0; self.field().count()];
        let Cvode { memory, context, .. } = self;
        let zeros = Vector::new(context, &zeros)?;
        // SAFETY: the memory is initialised, its user data are as the callback expects; CVODES copies the vector.
        let code = unsafe { sys::CVodeQuadInit(memory.raw(), Some(integrands::<F>), zeros.raw()) };
        context.check("CVodeQuadInit", code)?;
        // SAFETY: quadratures are initialised.
        let code = unsafe { sys::CVodeQuadSStolerances(memory.raw(), relative, absolute) };
        context.check("CVodeQuadSStolerances", code)?;
        memory.set(context, "CVodeSetQuadErrCon", sys::CVodeSetQuadErrCon, 1)
    }

    /// The integrals at the end of the last step.
    pub(crate) fn quadratures(&mut self) -> Result<Vec<f64>, SolveError>
    where
        F: Quadratures,
    {
        let zeros = vec![0.0; self.field().count()];
        let mut values = Vector::new(&mut self.context, &zeros)?;
        // SAFETY: a step has been taken with quadratures; the vector has as many components.
        let code = unsafe { sys::CVodeGetQuadDky(self.memory.raw(), self.step_time, 0, values.raw()) };
        self.context.check("CVodeGetQuadDky", code)?;
        Ok(values.as_mut_slice().to_vec())
    }

    /// The field, between steps.
    pub(crate) fn field_mut(&mut self) -> &mut F {
        self.callbacks.field_mut()
    }
}

/// `CVQuadRhsFn`.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData), a vector of its dimension and one
/// as long as there are integrals.
unsafe extern "C" fn integrands<F: VectorField + Quadratures>(
    t: f64,
    y: sys::N_Vector,
    rates: sys::N_Vector,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: the vectors are live, of these lengths and distinct.
    let (y, rates) = unsafe {
        let y = slice::from_raw_parts(numbers_of(y), callbacks.dim);
        (y, nan_slice(numbers_of(rates), callbacks.field.count()))
    };
    callbacks.guard(|field, _| field.integrands(t, y, rates))
}
