//! One step.

use pc_expr::{Failure, VectorField};

use super::arithmetic::{Weights, add, distance};
use super::control::Control;
use super::setup::Dop853;
use super::stages::{advance, evaluate};
use crate::error::{Reason, SolveError};
use crate::integration::breaks::next_break;
use crate::integration::stepper::Stepper;

/// A step that would end just before a stop time or a break, within this fraction of its length, is
/// made to end there.
const LEFT: f64 = 0.01;
/// The first guess for the length of the first step if the state or its rates vanish.
pub(super) const FIRST: f64 = 1e-6;

/// The first step on another piece of the field may be as long as the last step before it, but at
/// most this many times the initial length that the new rates suggest.
const LEAP: f64 = 30.0;

/// No step is longer, so that its ends and its length are numbers, and it becomes shorter when it is halved.
const LONGEST: f64 = f64::MAX / 4.0;

/// Why a step is rejected.
enum Refusal {
    /// The error, which is greater than 1 or NaN.
    Error(f64),
    /// A component violates its inequality.
    Inequality,
    /// A failure of the field.
    Failure(Reason, Failure),
    /// The field has a feature at this time that the stages missed.
    Surprise(f64),
}

impl<F: VectorField> Dop853<F> {
    /// Makes a step in the direction of `towards`, with a length that the tolerances allow.
    pub(super) fn make_step(&mut self, towards: f64) -> Result<(), SolveError> {
        let t = self.end.t;
        let direction = 1.0_f64.copysign(towards - t);
        let limit = self.limit(direction)?;
        if !self.has_rates {
            let counted = (&mut self.field, &mut self.statistics.rhs_evaluations);
            let evaluated = evaluate(counted, t, &self.end.y, &mut self.end.rates);
            evaluated.map_err(|(t, failure)| self.failed(Reason::Rates { t }, Some(failure)))?;
            self.has_rates = true;
        }
        let planned = match self.control.next {
            Some(length) => length,
            None => {
                let first = self.first_length(direction, limit.unwrap_or(towards));
                self.last_length.take().map_or(first, |last| last.max(first).min(LEAP * first))
            }
        };
        let mut length = planned.min(self.control.longest).max(self.control.shortest).min(LONGEST);
        let mut end = self.look_ahead(t + direction * length, limit, towards)?.or(limit);
        let mut refused = false;
        let mut failed = None; // the last failure of the field in this step: mostly why it becomes too short
        loop {
            let to = (t + direction * length).clamp(-f64::MAX, f64::MAX);
            let near = |end: &f64| (to - end) * direction > -LEFT * length;
            let (to, ends) = end.filter(near).map_or((to, false), |end| (end, true));
            if to == t || !(length > 4.0 * f64::EPSILON * t.abs() || ends) {
                return Err(self.too_short(failed));
            }
            let refusal = match self.attempt(to) {
                Ok(error) => {
                    let mut factor = Control::accepted(error);
                    if refused {
                        factor = factor.min(1.0);
                    }
                    let next = (to - t).abs() * factor;
                    // A step cut short does not tell how long the next may be.
                    let next = if ends && !refused { next.max(planned) } else { next };
                    self.accept(direction, next.min(self.control.longest).max(self.control.shortest));
                    return Ok(());
                }
                Err(refusal) => refusal,
            };
            length = (to - t).abs();
            match &refusal {
                Refusal::Error(error) => {
                    self.statistics.error_test_failures += 1;
                    length *= Control::rejected(*error);
                }
                Refusal::Failure(_, failure) if !failure.is_recoverable() => {}
                Refusal::Failure(..) | Refusal::Inequality => {
                    self.statistics.step_failures += 1;
                    length /= 2.0;
                }
                Refusal::Surprise(place) => {
                    end = Some(*place);
                    continue;
                }
            }
            refused = true;
            let rounds = t + direction * length == t || length <= 4.0 * f64::EPSILON * t.abs();
            let last = matches!(&refusal, Refusal::Failure(_, failure) if !failure.is_recoverable());
            if let Refusal::Failure(reason, failure) = refusal {
                failed = Some((reason, failure));
            }
            if last || rounds || length < self.control.shortest {
                return Err(self.too_short(failed));
            }
        }
    }

    /// The stop time or the next break of the field, which the step must not pass.
    fn limit(&mut self, direction: f64) -> Result<Option<f64>, SolveError> {
        if self.field.breaks().is_empty() {
            return Ok(self.stop_time);
        }
        let end = self.stop_time.unwrap_or(f64::INFINITY.copysign(direction));
        let (t, next) = next_break(self.field.breaks(), self.end.t, end);
        if self.field.enter(t, end) {
            self.has_rates = false;
        }
        Ok(next.or(self.stop_time))
    }

    /// Tries a step to t₁; returns the error of the step, which is at most 1.
    fn attempt(&mut self, t1: f64) -> Result<f64, Refusal> {
        let Dop853 { field, control, end, trial, tried, early, argument, statistics, .. } = self;
        let count = &mut statistics.rhs_evaluations;
        trial.t = t1;
        let weights = Weights { relative: control.relative, absolute: &control.absolute };
        let rates = |(t, failure)| Refusal::Failure(Reason::Rates { t }, failure);
        let sums = advance((field, count), end, trial, (early, tried), argument, weights).map_err(rates)?;
        let error = Control::error(t1 - end.t, sums, field.dim());
        if error.is_nan() || error > 1.0 {
            return Err(Refusal::Error(error));
        }
        let dim = field.dim();
        if field.has_projection() {
            let projected = field.project(t1, &mut trial.y[..dim]);
            projected.map_err(|failure| Refusal::Failure(Reason::Projection { t: t1 }, failure))?;
        }
        if !self.limits.inequalities.is_empty() && !self.satisfy_inequalities() {
            return Err(Refusal::Inequality);
        }
        let counted = (&mut self.field, &mut self.statistics.rhs_evaluations);
        evaluate(counted, t1, &self.trial.y, &mut self.trial.rates).map_err(rates)?;
        match self.surprise().map_err(rates)? {
            Some(place) => Err(Refusal::Surprise(place)),
            None => Ok(error),
        }
    }

    /// Sets each component that violates its inequality by at most the tolerance to the boundary;
    /// returns false if a component violates its inequality by more.
    fn satisfy_inequalities(&mut self) -> bool {
        for (i, inequality) in self.limits.inequalities.iter().enumerate() {
            let value = self.trial.y[i];
            if inequality.holds(value) {
                continue;
            }
            if !inequality.holds(0.0) || value.abs() > self.control.tolerance(i, value) {
                return false;
            }
            self.trial.y[i] = 0.0;
        }
        true
    }

    /// Accepts the trial step, which becomes the last step.
    fn accept(&mut self, direction: f64, next: f64) {
        let dim = self.dim();
        let h = self.trial.t - self.end.t;
        if self.stiffness.examines() {
            // The argument of the last stage is still there, unless dense output was computed.
            let states = distance(&self.trial.y[..dim], &self.argument[..dim]);
            let rates = distance(&self.trial.rates[..dim], &self.tried[6][..dim]);
            if states > 0.0 && !self.has_polynomial {
                self.stiffness.note(h.abs() * (rates / states).sqrt(), self.trial.t);
            }
        }
        std::mem::swap(&mut self.start, &mut self.end);
        std::mem::swap(&mut self.end, &mut self.trial);
        std::mem::swap(&mut self.made, &mut self.tried);
        (self.begins, self.given, self.time) = (false, false, self.end.t);
        self.control.next = Some(next);
        let work = &mut self.statistics;
        work.steps += 1;
        (work.last_order, work.current_order) = (8, 8);
        if work.first_step == 0.0 {
            work.first_step = h;
        }
        (work.last_step, work.current_step, work.current_time) = (h, next * direction, self.end.t);
    }

    /// The length of the first step, estimated from the sizes of y, ẏ and a difference quotient for
    /// ÿ [Hairer, Nørsett, Wanner 1993, II.4].
    fn first_length(&mut self, direction: f64, end: f64) -> f64 {
        let Dop853 { field, control, end: node, trial, argument, statistics, .. } = self;
        let dim = field.dim();
        let farthest = (end - node.t).abs().min(control.longest);
        let state = control.norm(&node.y[..dim], &node.y);
        let rates = control.norm(&node.rates[..dim], &node.y);
        let guess = if state <= 1e-5 || rates <= 1e-5 { FIRST } else { 0.01 * state / rates };
        let h = guess.min(farthest);
        let counted = (&mut *field, &mut statistics.rhs_evaluations);
        add(argument, &node.y, h * direction, &[1.0], [&node.rates[..]]);
        if evaluate(counted, node.t + h * direction, argument, &mut trial.rates).is_err() {
            return h; // failures there are left to the step itself
        }
        for (change, rate) in trial.rates.iter_mut().zip(&node.rates) {
            *change -= rate;
        }
        let second = control.norm(&trial.rates[..dim], &node.y) / h;
        let largest = second.max(rates);
        let by_rates = if largest <= 1e-15 { FIRST.max(h * 1e-3) } else { (0.01 / largest).powf(0.125) };
        (100.0 * h).min(by_rates).min(farthest)
    }

    /// The error for steps that become too short or cannot be taken; `failed` gives the cause.
    fn too_short(&mut self, failed: Option<(Reason, Failure)>) -> SolveError {
        if let Some((reason, failure)) = failed {
            return self.failed(reason, Some(failure));
        }
        let dim = self.dim();
        match self.trial.y[..dim].iter().position(|value| !value.is_finite()) {
            None => self.failed(Reason::Stalled, None),
            Some(i) => {
                let (component, value, t) = (self.field.component_name(i), self.trial.y[i], self.trial.t);
                self.failed(Reason::Overflow { component, value, t }, None)
            }
        }
    }
}
