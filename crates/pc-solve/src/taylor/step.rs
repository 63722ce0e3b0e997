//! A step of Taylor's method.

use pc_expr::{Failure, VectorField};

use crate::error::{NonFinite, Reason, SolveError};
use crate::integration::breaks::next_break;
use crate::integration::stepper::Stepper;
use crate::taylor::stepper::Taylor;

/// A step that would end just before a stop time or a break, by less than this fraction of its
/// length, is made to end there.
const NEAR: f64 = 1e-9;
/// A step is at most this many times as long as the previous step or as the time to its target,
/// whichever is longer.
const FARTHEST: f64 = 1e3;

/// Why a step is rejected.
pub(super) enum Refusal {
    /// A shorter step may succeed.
    Shorter(Reason, Option<Failure>),
    Fatal(SolveError),
}

impl<F: VectorField> Taylor<F> {
    /// The time that the next step towards `towards` must not pass, if there is one.
    pub(super) fn limit(&mut self, towards: f64) -> Result<Option<f64>, SolveError> {
        let from = self.end;
        let direction = 1.0_f64.copysign(towards - from);
        let end = self.stop_time.unwrap_or(f64::INFINITY.copysign(direction));
        let mut next = self.stop_time;
        let mut jumped = false;
        if !self.field.breaks().is_empty() {
            let (t, following) = next_break(self.field.breaks(), from, end);
            next = following.or(self.stop_time);
            jumped = self.field.enter(t, end);
        }
        let leaves = |i: usize| self.sides[i] == 0.0 && self.leading_side(i) != 0.0;
        if jumped || self.direction != direction || (0..self.sides.len()).any(leaves) {
            self.expand_at_end(direction)?;
        }
        Ok(next)
    }

    /// The maximum length of a step along the series.
    pub(super) fn longest(&mut self, towards: f64) -> Result<f64, SolveError> {
        let known = self.known_length.take();
        let mut length = known.unwrap_or_else(|| self.tolerances.length(&self.series)).min(self.max_step);
        if !self.branches.is_empty() {
            length = length.min(self.branch_length());
        }
        if let Some(first) = self.first_step.filter(|_| self.begins) {
            length = length.min(first);
        }
        if length.is_nan() {
            return Err(self.failed(Reason::Stalled, None));
        }
        let wanted = (towards - self.start).abs();
        // A finite series holds everywhere. Of one that nearly ends so much is taken that places in the step can be told apart.
        let known = wanted.max(self.statistics.last_step.abs());
        Ok(if length.is_infinite() { wanted } else { length.min(FARTHEST * known) })
    }

    /// Makes a step along the series; returns the time at its end as a number, and the rounding
    /// error to be added to that number.
    pub(super) fn find_step(
        &mut self,
        towards: f64,
        limit: Option<f64>,
        direction: f64,
    ) -> Result<(f64, f64), SolveError> {
        let (from, low) = (self.start, self.start_low);
        let remaining = limit.map(|limit| (limit - from) - low);
        let mut turns = 0;
        let (mut h, mut lands, mut crossed) = loop {
            let length = self.longest(towards)?;
            let mut h = length * direction;
            let mut lands = false;
            if let Some(remaining) =
                remaining.filter(|&remaining| (remaining - h) * direction <= NEAR * length)
            {
                (h, lands) = (remaining, true);
            }
            match self.corner(h) {
                None => break (h, lands, Vec::new()),
                Some((corner, which)) if from + corner != from => break (corner, false, which),
                // The previous step has ended at the corner.
                Some((_, which)) if turns <= self.branches.len() => {
                    turns += 1;
                    self.turn(&which, direction)?;
                }
                Some((_, which)) => return Err(self.sliding(which[0], from)),
            }
        };
        if !self.places.are_absent()
            && let Some(shorter) = self.foreseen(h, self.stop_time.unwrap_or(towards))?
        {
            (h, lands) = (shorter, false);
            crossed.clear();
        }
        loop {
            // The end of the step, with the rounding error of its time.
            let (t, rest) = match limit {
                Some(limit) if lands => (limit, 0.0),
                _ => {
                    let change = h + low;
                    let t = from + change;
                    let part = t - from;
                    (t, (from - (t - part)) + (change - part))
                }
            };
            if t == from {
                return Err(self.failed(Reason::Stalled, None));
            }
            let (reason, failure) = match self.attempt(t, h, &crossed) {
                Ok(()) => return Ok((t, rest)),
                Err(Refusal::Fatal(error)) => return Err(error),
                Err(Refusal::Shorter(reason, failure)) => (reason, failure),
            };
            if failure.as_ref().is_some_and(|failure| !failure.is_recoverable()) {
                return Err(self.failed(reason, failure));
            }
            if failure.is_some() {
                self.statistics.step_failures += 1;
            }
            h *= 0.5;
            lands = false;
            crossed.clear();
            if from + h == from || h.abs() < self.min_step {
                return Err(match failure {
                    Some(failure) => self.failed(reason, Some(failure)),
                    None => self.failed(Reason::Stalled, None),
                });
            }
        }
    }

    /// Tries a step of length h to the time `t`, at which the functions `crossed` change sign;
    /// `ahead` becomes the series at its end.
    pub(super) fn attempt(&mut self, t: f64, h: f64, crossed: &[usize]) -> Result<(), Refusal> {
        let order = self.series.order();
        self.series.change(h, &mut self.state, &mut self.slope);
        let projects = self.field.has_projection();
        for (i, change) in self.state.iter().enumerate() {
            // Summation of Møller and Knuth: keeps the part of the change lost in y.
            let y = self.series.coefficients[i];
            let change = change + self.low[i];
            let sum = y + change;
            let part = sum - y;
            self.ahead.coefficients[i] = sum;
            self.next_low[i] = (y - (sum - part)) + (change - part);
        }
        if projects {
            self.next_low.fill(0.0);
        }
        if let Some(i) = self.ahead.of_order(0).iter().position(|value| !value.is_finite()) {
            let (component, value) = (self.field.component_name(i), self.ahead.coefficients[i]);
            return Err(Refusal::Shorter(Reason::Overflow { component, value, t }, None));
        }
        if projects {
            let projected = self.field.project(t, self.ahead.of_order_mut(0));
            projected.map_err(|failure| Refusal::Shorter(Reason::Projection { t }, Some(failure)))?;
        }
        let inequalities = self.limits.inequalities.iter().zip(self.ahead.of_order(0));
        if inequalities.into_iter().any(|(inequality, &y)| !inequality.holds(y)) {
            return Err(Refusal::Shorter(Reason::Stalled, None));
        }
        let sides = self.sides.clone();
        self.expand(t)?;
        let y = self.ahead.of_order(0);
        if self.tolerances.feels(self.ahead.of_order(1), &self.slope, y, h, order) {
            self.statistics.error_test_failures += 1;
            return Err(Refusal::Shorter(Reason::Stalled, None));
        }
        if !crossed.is_empty() {
            for &i in crossed {
                self.sides[i] = -self.sides[i];
            }
            if let Err(refusal) = self.expand(t) {
                self.sides = sides;
                return Err(refusal);
            }
            // Beyond the corner the motion must continue to the other side.
            if let Some(&i) = crossed.iter().find(|&&i| self.returns(i, h.signum())) {
                self.sides = sides;
                return Err(Refusal::Fatal(self.sliding(i, t)));
            }
        }
        std::mem::swap(&mut self.low, &mut self.next_low);
        Ok(())
    }

    /// Expands the state at the start of `ahead`, at time `t`, on the current sides.
    pub(super) fn expand(&mut self, t: f64) -> Result<(), Refusal> {
        self.statistics.rhs_evaluations += 1;
        self.known_length = None;
        let order = self.ahead.order();
        let refused = |failure: Failure| Refusal::Shorter(Reason::Rates { t }, Some(failure));
        let series = self.field.expand(t, self.ahead.of_order(0), &self.sides, order).map_err(refused)?;
        series.copy_coefficients(order, &mut self.ahead.coefficients[self.ahead.dim..]);
        if !self.branches.is_empty() {
            for k in 0..order {
                self.branch_series.of_order_mut(k).copy_from_slice(series.branch_coefficients(k));
            }
        }
        if self.ahead.is_finite() { Ok(()) } else { Err(refused(self.blame(t))) }
    }

    /// The failure to be reported for a series that is not finite.
    #[cold]
    pub(super) fn blame(&mut self, t: f64) -> Failure {
        if let Err(failure) = self.field.rhs(t, self.ahead.of_order(0), &mut self.rates) {
            return failure;
        }
        let dim = self.ahead.dim;
        let found = self.ahead.coefficients.iter().position(|c| !c.is_finite()).unwrap_or(0);
        let (order, component) = (found / dim, self.field.component_name(found % dim));
        Failure::recoverable(NonFinite::Coefficient {
            component,
            order,
            value: self.ahead.coefficients[found],
            t,
        })
    }
}
