//! Features of the field that the stages of a step miss.
//!
//! A step evaluates f at twelve times, and a pulse may lie between two of them. Before a step is
//! accepted, its polynomial p is therefore inserted into the equations at the
//! [times](crate::foresight) in the step that have to be examined: where the defect p′ − f(t, p)
//! exceeds what the error of the polynomial explains, the step is repeated so as to end at that
//! time.

use pc_expr::{Failure, PolynomialMotion, VectorField};

use super::setup::Dop853;
use super::stages::evaluate;
use crate::error::{Reason, SolveError};
use crate::foresight::SURPRISE;
use crate::foresight::places::{Ahead, Here};
use crate::foresight::scatter::scatters;
use crate::integration::stepper::Stepper;

/// The allowed ratio of the polynomial's defect to the error of the step; it is large because the
/// polynomial is of lower order.
const DEFECT: f64 = 100.0;

impl<F: VectorField> Dop853<F> {
    /// Finds the times to examine in the step ahead; if there are too many, returns the time that
    /// the step must not pass.
    pub(super) fn look_ahead(
        &mut self,
        reach: f64,
        limit: Option<f64>,
        towards: f64,
    ) -> Result<Option<f64>, SolveError> {
        if self.places.are_absent() {
            return Ok(None);
        }
        let (t, direction) = (self.end.t, 1.0_f64.copysign(towards - self.end.t));
        let reach = limit.filter(|limit| (reach - limit) * direction > 0.0).unwrap_or(reach);
        let ahead =
            Ahead { t, reach, end: self.stop_time.unwrap_or(towards), given: self.begins && self.given };
        let Dop853 { field, control, end, places, argument, statistics, .. } = self;
        let dim = field.dim();
        let mut noise = false;
        let mut here = Start {
            resolve: |near: f64, length: f64| {
                let is_noise = scatters(dim, length, |part, rates, tolerances| {
                    let since = (near - t) * part;
                    for i in 0..dim {
                        argument[i] = end.y[i] + since * end.rates[i];
                        tolerances[i] = control.tolerance(i, argument[i]);
                    }
                    evaluate((&mut *field, &mut statistics.rhs_evaluations), t + since, argument, rates)
                        .is_ok()
                });
                noise |= is_noise;
            },
        };
        places.look(ahead, &mut here)?;
        if noise {
            return Err(self.failed(Reason::Unresolved { t }, None));
        }
        Ok(self.places.crowded)
    }

    /// Whether steep functions of the state may hide a feature of the field in the trial step,
    /// judging by the cubic through the states and rates at its ends.
    fn hides_along_cubic(&mut self) -> bool {
        let Dop853 { field, end, trial, places, coefficients, .. } = self;
        let (dim, h) = (field.dim(), trial.t - end.t);
        coefficients.clear();
        coefficients.extend_from_slice(&end.y[..dim]);
        coefficients.extend_from_slice(&end.rates[..dim]);
        let slopes = |i: usize| ((trial.y[i] - end.y[i]) / h, end.rates[i], trial.rates[i]);
        coefficients
            .extend((0..dim).map(slopes).map(|(mean, first, last)| (3.0 * mean - 2.0 * first - last) / h));
        coefficients
            .extend((0..dim).map(slopes).map(|(mean, first, last)| (first + last - 2.0 * mean) / (h * h)));
        places.hide_along((end.t, trial.t), PolynomialMotion { start: end.t, coefficients })
    }

    /// A time in the trial step at which the field does something that the polynomial does not
    /// show.
    ///
    /// # Errors
    /// A failure of the field at the stages of dense output.
    pub(super) fn surprise(&mut self) -> Result<Option<f64>, (f64, Failure)> {
        self.has_polynomial = false;
        let (t, t1) = (self.end.t, self.trial.t);
        let along = self.places.follow_states() && self.hides_along_cubic();
        if !along && self.places.found.is_empty() && self.places.crowded.is_none() {
            return Ok(None);
        }
        if !along && !self.places.found.iter().any(|place| (t1 - place) * (t1 - t) > 0.0) {
            self.places.as_expected();
            return Ok(None);
        }
        let Dop853 { field, end, trial, tried, early, argument, polynomial, places, control, .. } = self;
        let count = &mut self.statistics.rhs_evaluations;
        polynomial.make((field, count), (end, trial), tried, early, argument)?;
        let dim = field.dim();
        if along {
            polynomial.coefficients(dim, &mut self.coefficients);
            places.look_along((t, t1), PolynomialMotion { start: t, coefficients: &self.coefficients });
        }
        let [slope, rates, ..] = early;
        for i in 0..places.found.len() {
            let place = places.found[i];
            if (t1 - place) * (t1 - t) <= 0.0 {
                break;
            }
            polynomial.evaluate(place, 0, &mut argument[..dim]);
            polynomial.evaluate(place, 1, &mut slope[..dim]);
            evaluate((field, count), place, argument, rates)?;
            let defect = |i: usize| (slope[i] - rates[i]).abs() / control.tolerance(i, argument[i]);
            let defect = (0..dim).map(defect).fold(0.0, f64::max);
            if (t1 - t).abs() * defect > DEFECT * SURPRISE {
                places.surprised();
                return Ok(Some(place));
            }
        }
        self.has_polynomial = true;
        places.as_expected();
        Ok(None)
    }
}

/// The start of a step.
struct Start<R> {
    resolve: R,
}

impl<R: FnMut(f64, f64)> Here for Start<R> {
    fn prediction(&mut self) -> Result<Option<PolynomialMotion<'_>>, SolveError> {
        Ok(None) // the polynomial of a step is known after it
    }

    fn resolve(&mut self, near: f64, length: f64) -> Result<(), SolveError> {
        (self.resolve)(near, length);
        Ok(())
    }
}
