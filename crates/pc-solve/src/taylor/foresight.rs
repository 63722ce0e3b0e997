//! Examination of the field farther ahead, where a series shows nothing.
//!
//! The coefficients of the series of exp(−((t − 5)/0.2)²) at t = 0 are indistinguishable from 0. At
//! the [times](crate::foresight) in the next step at which the field may turn or jump, the rates of
//! the field are therefore compared with those of the polynomial.

use pc_expr::{PolynomialMotion, VectorField};

use crate::error::{Reason, SolveError};
use crate::foresight::places::{Ahead, Here};
use crate::foresight::scatter::scatters;
use crate::integration::stepper::Stepper;
use crate::taylor::stepper::Taylor;

impl<F: VectorField> Taylor<F> {
    /// A shorter length for the step, if f has a feature in it that the series does not show.
    pub(super) fn foreseen(&mut self, h: f64, end: f64) -> Result<Option<f64>, SolveError> {
        let t = self.start;
        let ahead = Ahead { t, reach: t + h, end, given: false };
        let Taylor { places, series, field, tolerances, statistics, .. } = self;
        let mut noise = false;
        let mut here = Start {
            motion: PolynomialMotion { start: t, coefficients: &series.coefficients },
            resolve: |near: f64, length: f64| {
                let dim = series.dim;
                let mut state = vec![0.0; dim];
                noise |= scatters(dim, length, |part, rates, allowed| {
                    series.derivative((near - t) * part, 0, &mut state);
                    for (i, allowed) in allowed.iter_mut().enumerate() {
                        *allowed = tolerances.of(i, state[i]);
                    }
                    statistics.rhs_evaluations += 1;
                    field.rhs(t + (near - t) * part, &state, rates).is_ok()
                });
            },
        };
        let any = places.look(ahead, &mut here)?;
        if noise {
            return Err(self.failed(Reason::Unresolved { t }, None));
        }
        if !any {
            return Ok(None);
        }
        let crowded = self.places.crowded.map(|crowded| crowded - t);
        for i in 0..self.places.found.len() {
            let since = self.places.found[i] - t;
            if crowded.is_some_and(|crowded| (since - crowded) * h > 0.0) {
                break;
            }
            if self.surprises_at(self.places.found[i], h) {
                self.places.surprised();
                return Ok(Some(since));
            }
        }
        self.places.as_expected();
        Ok(crowded.filter(|crowded| crowded.abs() < h.abs()))
    }

    /// Whether f at a time in the step differs from the prediction of the polynomial.
    fn surprises_at(&mut self, place: f64, h: f64) -> bool {
        let s = (place - self.start) - self.start_low;
        self.series.change(s, &mut self.state, &mut self.slope);
        for (state, y) in self.state.iter_mut().zip(self.series.of_order(0)) {
            *state += y;
        }
        self.statistics.rhs_evaluations += 1;
        // A step ends where f is not defined, and is then shortened further.
        self.field.rhs(place, &self.state, &mut self.rates).is_err()
            || self.tolerances.feels(&self.rates, &self.slope, &self.state, h, self.series.order())
    }
}

/// The start of a step.
struct Start<'a, R> {
    motion: PolynomialMotion<'a>,
    resolve: R,
}

impl<R: FnMut(f64, f64)> Here for Start<'_, R> {
    fn prediction(&mut self) -> Result<Option<PolynomialMotion<'_>>, SolveError> {
        Ok(Some(self.motion))
    }

    fn resolve(&mut self, near: f64, length: f64) -> Result<(), SolveError> {
        (self.resolve)(near, length);
        Ok(())
    }
}
