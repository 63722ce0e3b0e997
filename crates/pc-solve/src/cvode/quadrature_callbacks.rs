//! Integrals along an integration, with the callbacks for their integrands.

use std::ffi::{c_int, c_void};
use std::slice;

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use crate::cvode::callback::{Callbacks, FATAL, nan_slice};
use crate::cvode::cvode::Cvode;
use crate::cvode::handles::{Vector, numbers_of};
use crate::cvode::integrals::Integrals;
use crate::cvode::quadrature::{Quadrature, Quadratures};
use crate::error::{InputError, NonFinite, Reason, SolveError};
use crate::settings::options::Options;

impl<F: VectorField> Cvode<F> {
    /// Starts at y(t0) = y0 as [`Cvode::new`] does, with integrals along the motion, which begin
    /// at 0.
    ///
    /// For an integration [with sensitivities](Cvode::with_sensitivities),
    /// [`and_integrals`](Cvode::and_integrals) adds them.
    ///
    /// # Errors
    /// As for [`new`](Cvode::new); [`SolveError::Input`] if the request is invalid.
    pub fn with_integrals(
        field: F,
        t0: f64,
        y0: &[f64],
        options: &Options,
        integrals: Integrals,
    ) -> Result<Self, SolveError> {
        Cvode::new(field, t0, y0, options)?.and_integrals(integrals, options)
    }

    /// Adds integrals along the motion to this integration, which has not yet begun.
    ///
    /// # Errors
    /// [`SolveError::Input`] if the request is invalid; [`InputError::NoIntegrals`] if the
    /// integration has begun or already has integrals.
    pub fn and_integrals(mut self, integrals: Integrals, options: &Options) -> Result<Self, SolveError> {
        if self.direction.is_some() || self.quadrature.is_some() {
            return Err(InputError::NoIntegrals.into());
        }
        let (relative, absolute) = integrals.validate(options)?;
        let count = integrals.count;
        self.callbacks.set_integrands(integrals.integrands);
        self.begin(count, integrands_of::<F>, integrals.error_control, (relative, absolute))?;
        Ok(self)
    }

    /// Starts the integrals of the field at zero, with these tolerances, before the first step.
    pub(crate) fn begin_quadratures(&mut self, relative: f64, absolute: f64) -> Result<(), SolveError>
    where
        F: Quadratures,
    {
        let count = self.field().count();
        self.begin(count, integrands::<F>, true, (relative, absolute))
    }

    fn begin(
        &mut self,
        count: usize,
        rates: unsafe extern "C" fn(f64, sys::N_Vector, sys::N_Vector, *mut c_void) -> c_int,
        error_control: bool,
        (relative, absolute): (f64, f64),
    ) -> Result<(), SolveError> {
        let start = vec![0.0; count];
        let Cvode { memory, context, .. } = self;
        let values = Vector::new(context, &start)?;
        // SAFETY: the memory is initialised, its user data are as the callback expects; CVODES
        // copies the vector.
        let code = unsafe { sys::CVodeQuadInit(memory.raw(), Some(rates), values.raw()) };
        context.check("CVodeQuadInit", code)?;
        // SAFETY: quadratures are initialised.
        let code = unsafe { sys::CVodeQuadSStolerances(memory.raw(), relative, absolute) };
        context.check("CVodeQuadSStolerances", code)?;
        memory.set(context, "CVodeSetQuadErrCon", sys::CVodeSetQuadErrCon, c_int::from(error_control))?;
        self.quadrature = Some(Quadrature { values, start });
        Ok(())
    }

    /// The integrals at the end of the last step.
    pub(crate) fn quadratures(&self) -> Result<Vec<f64>, SolveError> {
        self.integrals_at(self.step_time)
    }

    /// The integrals from the start to the current time, in the order of their integrands, all
    /// finite.
    pub(crate) fn integrals_here(&self) -> Result<Vec<f64>, SolveError> {
        let values = self.integrals_at(self.time)?;
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(index) => {
                let component = format!("integral number {index} (from 0)");
                let reason = Reason::Overflow { component, value: values[index], t: self.time };
                Err(self.error(reason, None))
            }
        }
    }

    /// The integrals at `t` in the last internal step, or at the start.
    fn integrals_at(&self, t: f64) -> Result<Vec<f64>, SolveError> {
        let Some(Quadrature { values, start }) = &self.quadrature else {
            return Err(InputError::NoIntegrals.into());
        };
        if self.direction.is_none() || self.restarted {
            return Ok(start.clone());
        }
        // SAFETY: a step has been taken with quadratures; the vector has their number of
        // components, and nobody borrows it.
        let code = unsafe { sys::CVodeGetQuadDky(self.memory.raw(), t, 0, values.raw()) };
        if code != sys::CV_SUCCESS {
            let message = format!("the integrals at t = {t} cannot be interpolated");
            return Err(self.error(Reason::Cvode { code: code.into(), message }, None));
        }
        Ok(values.as_slice().to_vec())
    }

    /// The integrals at the current time, if there are any, from which
    /// [`begin_integrals_anew`](Cvode::begin_integrals_anew) continues.
    pub(super) fn integrals_to_keep(&self) -> Result<Option<Vec<f64>>, SolveError> {
        self.quadrature.as_ref().map(|_| self.integrals_at(self.time)).transpose()
    }

    /// Continues from these integrals after CVODES has been reinitialised.
    pub(super) fn begin_integrals_anew(&mut self, kept: Option<Vec<f64>>) -> Result<(), SolveError> {
        let (Some(quadrature), Some(kept)) = (&mut self.quadrature, kept) else { return Ok(()) };
        quadrature.values.as_mut_slice().copy_from_slice(&kept);
        quadrature.start = kept;
        // SAFETY: quadratures are initialised; CVODES copies the vector.
        let code = unsafe { sys::CVodeQuadReInit(self.memory.raw(), quadrature.values.raw()) };
        self.context.check("CVodeQuadReInit", code)
    }
}

/// `CVQuadRhsFn`.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData), a
/// vector of its dimension and a vector with one entry for each integral.
unsafe extern "C" fn integrands<F: VectorField + Quadratures>(
    t: f64,
    y: sys::N_Vector,
    rates: sys::N_Vector,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: the vectors are live, of these lengths and distinct.
    let (y, rates) = unsafe {
        let y = slice::from_raw_parts(numbers_of(y), callbacks.dim);
        (y, nan_slice(numbers_of(rates), callbacks.field.count()))
    };
    callbacks.guard(|field, _| field.integrands(t, y, rates))
}

/// The same, for the integrands given to the integration.
///
/// # Safety
/// As there.
unsafe extern "C" fn integrands_of<F: VectorField>(
    t: f64,
    y: sys::N_Vector,
    rates: sys::N_Vector,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    let Some(mut integrands) = callbacks.integrands.take() else { return FATAL };
    // SAFETY: the vectors are live, of these lengths and distinct.
    let (y, rates) = unsafe {
        let count = usize::try_from(sys::N_VGetLength(rates)).unwrap_or(0);
        (slice::from_raw_parts(numbers_of(y), callbacks.dim), nan_slice(numbers_of(rates), count))
    };
    let answer = callbacks.guard(|_, offset| {
        let y = offset.map_or(y, |offset| offset.state_of(y));
        integrands(t, y, rates)?;
        match rates.iter().position(|rate| !rate.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Failure::recoverable(NonFinite::Integrand { index, value: rates[index], t })),
        }
    });
    callbacks.integrands = Some(integrands);
    answer
}
