//! Examination of the field up to the end of the next step.
//!
//! A multistep method evaluates f only at the ends of its steps. Before a step is tried, f is
//! therefore evaluated at the [times](crate::foresight) at which it may have a hidden feature, at
//! the predicted state: with p the polynomial through the last steps, the defect
//! ```text
//! δ = p′(t) − f(t, p(t))
//! ```
//! would change the state by about h δ over a step of length h. If this change is large compared
//! with the tolerance, the step ends at that time at the latest, so that the method meets the
//! feature.

use pc_expr::{PolynomialMotion, VectorField};
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::cvode::foresight::Foresight;
use crate::error::{Reason, SolveError};
use crate::foresight::SURPRISE;
use crate::foresight::places::{Ahead, Here, Places};
use crate::foresight::scatter::scatters;

/// The maximum length of the first step as a fraction of the whole interval, as CVODE estimates it.
const FIRST_STEP: f64 = 0.1;

impl<F: VectorField> Cvode<F> {
    /// The time at which the next step towards `towards` has to end so as not to miss a feature of
    /// the field; none if the step would miss nothing.
    pub(super) fn foresee(&mut self, towards: f64) -> Result<Option<f64>, SolveError> {
        let Some(mut places) = self.foresight.places.take_if(|places| !places.are_absent()) else {
            return Ok(None);
        };
        let ahead = Ahead {
            t: self.step_time,
            reach: self.planned_end(towards),
            end: self.stop_time.unwrap_or(towards),
            given: self.direction.is_none() && self.initial_step.is_some(),
        };
        let landing = self.foresee_at(&mut places, ahead);
        self.foresight.places = Some(places);
        landing
    }

    fn foresee_at(&mut self, places: &mut Places, ahead: Ahead) -> Result<Option<f64>, SolveError> {
        if !places.look(ahead, self)? {
            return Ok(None);
        }
        let Ahead { t, reach, .. } = ahead;
        if self.direction.is_none() {
            // Before the first step nothing is known, so it is kept short.
            return Ok(places.found.first().copied().or(places.crowded));
        }
        self.read_polynomial()?;
        for &place in &places.found {
            if places.crowded.is_some_and(|crowded| (place - crowded) * (reach - t) > 0.0) {
                break;
            }
            if self.surprises_at(place, ahead.length()) {
                places.surprised();
                return Ok(Some(place));
            }
        }
        places.as_expected();
        Ok(places.crowded)
    }

    /// The planned end of the next step.
    fn planned_end(&self, towards: f64) -> f64 {
        let t = self.step_time;
        let end = self.stop_time.unwrap_or(towards);
        let direction = 1.0_f64.copysign(end - t);
        let length = if self.direction.is_some() {
            let mut length = 0.0;
            // SAFETY: the memory is live and initialised; `length` is a place for the result.
            unsafe { sys::CVodeGetCurrentStep(self.memory.raw(), &raw mut length) };
            length.abs()
        } else {
            self.initial_step.unwrap_or(FIRST_STEP * (end - t).abs())
        };
        let reach = t + length.copysign(direction);
        match self.stop_time {
            Some(stop) if (reach - stop) * direction > 0.0 => stop,
            _ => reach,
        }
    }

    /// Reads the polynomial of the last step or, before the first step, the tangent.
    fn read_polynomial(&mut self) -> Result<(), SolveError> {
        let t = self.step_time;
        let Foresight { polynomial, state, rates, evaluations, .. } = &mut self.foresight;
        polynomial.clear();
        if self.direction.is_none() {
            state.copy_from_slice(self.step_state.as_slice());
            *evaluations += 1;
            if !self.callbacks.look(t, state, rates) {
                rates.fill(0.0); // CVODE reports the failure
            }
            polynomial.extend_from_slice(state);
            polynomial.extend_from_slice(rates);
            return Ok(());
        }
        let mut order = 0;
        // SAFETY: the memory is live and initialised; `order` is a place for the result.
        unsafe { sys::CVodeGetLastOrder(self.memory.raw(), &raw mut order) };
        let mut factorial = 1.0;
        for k in 0..=order {
            factorial *= f64::from(k.max(1));
            // SAFETY: memory and vector are live and of one context; a step has been taken.
            let code = unsafe { sys::CVodeGetDky(self.memory.raw(), t, k, self.work.raw()) };
            self.context.check("CVodeGetDky", code)?;
            self.foresight.polynomial.extend(self.work.as_slice().iter().map(|term| term / factorial));
        }
        // SAFETY: memory and vector are live and of one context; CVODES copies to the vector.
        let code = unsafe { sys::CVodeGetEstLocalErrors(self.memory.raw(), self.work.raw()) };
        self.context.check("CVodeGetEstLocalErrors", code)?;
        self.foresight.errors.copy_from_slice(self.work.as_slice());
        self.foresight.order = order;
        // SAFETY: the memory is live and initialised; the last step is a place for the result.
        unsafe { sys::CVodeGetLastStep(self.memory.raw(), &raw mut self.foresight.last_step) };
        Ok(())
    }

    /// Whether f at this time differs from the prediction by enough to matter in a step of this
    /// length.
    fn surprises_at(&mut self, place: f64, length: f64) -> bool {
        let since = place - self.step_time;
        self.foresight.predict(since);
        self.foresight.evaluations += 1;
        let Foresight { state, rates, .. } = &mut self.foresight;
        self.callbacks.look(place, state, rates) && length * self.foresight.defect(since) > SURPRISE
    }
}

impl<F: VectorField> Here for Cvode<F> {
    fn prediction(&mut self) -> Result<Option<PolynomialMotion<'_>>, SolveError> {
        self.read_polynomial()?;
        Ok(Some(PolynomialMotion { start: self.step_time, coefficients: &self.foresight.polynomial }))
    }

    fn resolve(&mut self, near: f64, length: f64) -> Result<(), SolveError> {
        self.read_polynomial()?;
        let (t, dim) = (self.step_time, self.step_state.as_slice().len());
        let is_noise = scatters(dim, length, |part, rates, tolerances| {
            let since = (near - t) * part;
            self.foresight.predict(since);
            self.foresight.evaluations += 1;
            for (i, tolerance) in tolerances.iter_mut().enumerate() {
                *tolerance = self.foresight.tolerance(i, self.foresight.state[i]);
            }
            self.callbacks.look(t + since, &self.foresight.state, rates)
        });
        if is_noise { Err(self.failed(Reason::Unresolved { t }, None)) } else { Ok(()) }
    }
}
