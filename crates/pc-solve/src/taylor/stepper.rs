//! Taylor's method as a stepper.

use std::sync::Arc;

use pc_expr::{Failure, PolynomialMotion, Program, RootSeparation, VectorField};

use crate::error::{IntegrationError, NonFinite, Reason, SolveError};
use crate::foresight::places::Places;
use crate::integration::breaks::next_break;
use crate::integration::checks::{check_inequalities, check_start, finite};
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};
use crate::settings::method::Method;
use crate::settings::options::Options;
use crate::taylor::corners::first_exit;
use crate::taylor::polynomial::Polynomial;
use crate::taylor::step_length::Tolerances;

/// A step that would end so near to a stop time or a break, in parts of its length, ends there.
const NEAR: f64 = 1e-9;
/// Functions that change their signs so near to each other, in parts of a step, do so together.
const TOGETHER: f64 = 1e-12;

/// Taylor's method of adaptive order and step as a [`Stepper`] [Jorba, Zou 2005]:
///
/// y(t + h) = Σ_{k=0}^{p} y⁽ᵏ⁾(t) hᵏ/k!,   h = min_{k = p−1, p} (|y⁽ᵏ⁾/k!|/|y|)^{−1/k} · rtol^{1/(p+1)}.
///
/// The polynomial is also what states inside a step are read from. Time and state are sums with
/// the rounding of each addition carried on [Kahan 1965]. A step whose polynomial has not the rates of the field at its end is tried
/// again at half its length; none passes a corner or a jump of the field. States are [projected](pc_expr::VectorField::project) at the
/// end of each step, and inside steps where they are read.
#[derive(Debug)]
pub struct Taylor<F> {
    pub(super) field: F,
    pub(super) tolerances: Tolerances,
    limits: Limits,
    first_step: Option<f64>,
    min_step: f64,
    max_step: f64,
    stop_time: Option<f64>,
    /// The last step: where it began, and what of that time a number does not hold.
    pub(super) start: f64,
    pub(super) start_low: f64,
    pub(super) series: Polynomial,
    /// Where it ended, likewise, and the series there.
    end: f64,
    end_low: f64,
    ahead: Polynomial,
    /// That of the step before while one is made.
    before: Polynomial,
    /// What of the state at the end its numbers do not hold.
    low: Vec<f64>,
    next_low: Vec<f64>,
    /// The signs of the branch functions at the end, and where they are computed.
    sides: Vec<f64>,
    branches: Vec<String>,
    branch_series: Polynomial,
    /// Whether there is no step since the start.
    begins: bool,
    /// The direction in which the series ahead holds; 0 where there is none.
    direction: f64,
    time: f64,
    pub(super) places: Places,
    /// Of the events that were asked about last.
    separation: Option<RootSeparation>,
    pub(super) state: Vec<f64>,
    pub(super) slope: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) statistics: Statistics,
}

/// Why a step has to be shorter.
enum Refusal {
    /// A smaller step may do.
    Shorter(Reason, Option<Failure>),
    Fatal(SolveError),
}

impl<F: VectorField> Taylor<F> {
    /// Starts at y(t0) = y0, where `y0` has as many numbers as `field` has components, with tolerances, lengths of steps, the highest order
    /// and limits of the options, whose method does not matter.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all inputs are finite, of matching lengths and in their ranges;
    /// [`InputError::Explicit`](crate::InputError::Explicit) if they choose how implicit equations are solved; [`Reason::Rates`] if the field
    /// has no [series](VectorField::series).
    pub fn new(mut field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        check_start(&field, t0, y0)?;
        Options { method: Method::Taylor, ..options.clone() }.validate(y0.len())?;
        check_inequalities(&field, y0, &options.inequalities)?;
        let tolerances = Tolerances::new(options);
        let (cost, branches) = match field.series() {
            Ok(series) => (series.cost(), series.branches().to_vec()),
            Err(failure) => {
                let (reason, state) = (Reason::Rates { t: t0 }, y0.to_vec());
                let error = IntegrationError { reason, time: t0, state, failure: Some(failure) };
                return Err(SolveError::Integration(Box::new(error)));
            }
        };
        let order = tolerances.order(cost, options.max_order);
        let mut ahead = Polynomial::new(y0.len(), order);
        ahead.of_order_mut(0).copy_from_slice(y0);
        let places = Places::new(&field, t0, options.min_step);
        let zeros = || vec![0.0; y0.len()];
        Ok(Taylor {
            field,
            tolerances,
            limits: options.limits(),
            first_step: options.initial_step,
            min_step: options.min_step.unwrap_or(0.0),
            max_step: options.max_step.unwrap_or(f64::INFINITY),
            stop_time: options.stop_time,
            start: t0,
            start_low: 0.0,
            series: ahead.clone(),
            before: ahead.clone(),
            end: t0,
            end_low: 0.0,
            low: zeros(),
            next_low: zeros(),
            sides: vec![0.0; branches.len()],
            branch_series: Polynomial::new(branches.len().max(1), order - 1),
            branches,
            begins: true,
            direction: 0.0,
            time: t0,
            places,
            separation: None,
            state: zeros(),
            slope: zeros(),
            rates: zeros(),
            ahead,
            statistics: Statistics { current_time: t0, current_order: order as u32, ..Statistics::default() },
        })
    }

    /// The order of the method.
    pub fn order(&self) -> u32 {
        self.ahead.order() as u32
    }

    /// Expands at `t` the state that `ahead` begins with, on these sides.
    fn expand(&mut self, t: f64) -> Result<(), Refusal> {
        self.statistics.rhs_evaluations += 1;
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

    /// The failure of a series that is not finite.
    #[cold]
    fn blame(&mut self, t: f64) -> Failure {
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

    /// Expands at the end of the last step, on the sides that the motion goes to from there.
    fn expand_at_end(&mut self, direction: f64) -> Result<(), SolveError> {
        self.direction = direction;
        self.sides.fill(0.0);
        // Each side that becomes known may show another one.
        for _ in 0..=2 * self.branches.len() {
            match self.expand(self.end) {
                Ok(()) => {}
                Err(Refusal::Shorter(reason, failure)) => {
                    self.direction = 0.0;
                    return Err(self.failed(reason, failure));
                }
                Err(Refusal::Fatal(error)) => return Err(error),
            }
            let sides: Vec<f64> = (0..self.sides.len()).map(|i| self.leading_side(i)).collect();
            if sides == self.sides {
                return Ok(());
            }
            self.sides = sides;
        }
        self.direction = 0.0;
        Err(self.failed(Reason::Sliding { branch: self.branches.join(", "), t: self.end }, None))
    }

    /// The side that a branch function is on, or goes to.
    fn leading_side(&self, i: usize) -> f64 {
        let along = |k: usize| self.branch_series.of_order(k)[i] * self.direction.powi(k as i32 % 2);
        let leading = (0..=self.branch_series.order()).map(along).find(|c| *c != 0.0);
        leading.map_or(0.0, f64::signum)
    }

    /// Where the next step towards a time has to end at the latest; none if nowhere.
    fn limit(&mut self, towards: f64) -> Result<Option<f64>, SolveError> {
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

    /// Where the branch functions first change their signs within h, and which do.
    fn corner(&self, h: f64) -> Option<(f64, Vec<usize>)> {
        let mut first = None::<f64>;
        let mut exits = Vec::new();
        for i in 0..self.branches.len() {
            let coefficients: Vec<f64> =
                (0..=self.branch_series.order()).map(|k| self.branch_series.of_order(k)[i]).collect();
            if self.sides[i] == 0.0 || coefficients.iter().any(|c| !c.is_finite()) {
                continue;
            }
            if let Some(exit) = first_exit(&coefficients, self.sides[i], h) {
                exits.push((i, exit));
                first = Some(first.map_or(exit, |first| if exit.abs() < first.abs() { exit } else { first }));
            }
        }
        let first = first?;
        let together = |&(_, exit): &(usize, f64)| (exit - first).abs() <= TOGETHER * h.abs();
        let last = exits.iter().filter(|exit| together(exit)).map(|&(_, exit)| exit);
        let end = last.fold(first, |end, exit| if exit.abs() > end.abs() { exit } else { end });
        Some((end, exits.iter().filter(|exit| together(exit)).map(|&(i, _)| i).collect()))
    }

    /// How far the series of the branch functions hold.
    fn branch_length(&self) -> f64 {
        let order = self.branch_series.order();
        let mut length = f64::INFINITY;
        for i in 0..self.branches.len() {
            let c = |k: usize| self.branch_series.of_order(k)[i].abs();
            let size = (0..order.min(2)).map(c).fold(self.tolerances.largest_absolute(), f64::max);
            for k in [order.max(2) - 1, order] {
                let radius = (c(k) / size).powf(-1.0 / k as f64);
                length = length.min(radius * self.tolerances.relative.powf(1.0 / (order as f64 + 1.0)));
            }
        }
        length
    }

    /// Tries a step of length h to the time `t`, across these branches; the series at its end is then that ahead.
    fn attempt(&mut self, t: f64, h: f64, crossed: &[usize]) -> Result<(), Refusal> {
        let order = self.series.order();
        self.series.change(h, &mut self.state, &mut self.slope);
        let projects = self.field.has_projection();
        for (i, change) in self.state.iter().enumerate() {
            // Møller's and Knuth's sum: what of the change is lost in y is kept.
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
            // Beyond the corner the motion has to go on as it came.
            if let Some(&i) = crossed.iter().find(|&&i| self.returns(i, h.signum())) {
                self.sides = sides;
                return Err(Refusal::Fatal(self.sliding(i, t)));
            }
        }
        std::mem::swap(&mut self.low, &mut self.next_low);
        Ok(())
    }
}

impl<F: VectorField> Stepper for Taylor<F> {
    type Field = F;

    fn field(&self) -> &F {
        &self.field
    }

    fn field_mut(&mut self) -> &mut F {
        &mut self.field
    }

    fn into_field(self) -> F {
        self.field
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn limits_mut(&mut self) -> &mut Limits {
        &mut self.limits
    }

    fn last_step(&self) -> LastStep {
        let degree = (!self.begins).then_some(self.series.order() as u32);
        let start = if self.begins { self.end } else { self.start };
        LastStep { start, end: self.end, degree }
    }

    fn end_state(&self) -> &[f64] {
        self.ahead.of_order(0)
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn stand_at(&mut self, t: f64) {
        self.time = t;
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        let limit = self.limit(towards)?;
        let direction = self.direction;
        let (from, from_low) = (self.end, self.end_low);
        let before = (self.start, self.start_low);
        std::mem::swap(&mut self.before, &mut self.series);
        std::mem::swap(&mut self.series, &mut self.ahead);
        (self.start, self.start_low) = (from, from_low);
        let branch_series = (!self.branches.is_empty()).then(|| self.branch_series.clone());
        let outcome = self.find_step(towards, limit, direction);
        match outcome {
            Ok((t, low)) => {
                let h = t - from;
                (self.end, self.end_low, self.time, self.begins) = (t, low, t, false);
                self.statistics.steps += 1;
                self.statistics.last_order = self.series.order() as u32;
                if self.statistics.first_step == 0.0 {
                    self.statistics.first_step = h;
                }
                self.statistics.last_step = h;
                self.statistics.current_step = self.tolerances.length(&self.ahead).copysign(h);
                self.statistics.current_time = t;
                Ok(())
            }
            Err(error) => {
                // The step before is the last one again.
                std::mem::swap(&mut self.series, &mut self.ahead);
                std::mem::swap(&mut self.before, &mut self.series);
                (self.start, self.start_low) = before;
                if let Some(branch_series) = branch_series {
                    self.branch_series = branch_series;
                }
                Err(match error {
                    SolveError::Integration(mut error) => {
                        error.time = self.end;
                        error.state = self.ahead.of_order(0).to_vec();
                        self.time = self.end;
                        SolveError::Integration(error)
                    }
                    other => other,
                })
            }
        }
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        let s = (t - self.start) - self.start_low;
        self.series.derivative(s, order as usize, &mut self.state);
        if order == 0
            && let Err(failure) = self.field.project(t, &mut self.state)
        {
            return Err(self.failed(Reason::Projection { t }, Some(failure)));
        }
        Ok(&self.state)
    }

    fn centre(&self) -> f64 {
        self.start
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        _columns: &[f64],
        _direction: Option<f64>,
    ) -> Result<(), SolveError> {
        self.field.restart(t, y);
        (self.end, self.end_low, self.time, self.begins) = (t, 0.0, t, true);
        self.ahead.of_order_mut(0).copy_from_slice(y);
        self.low.fill(0.0);
        self.direction = 0.0;
        self.statistics.current_time = t;
        Ok(())
    }

    fn stop_time(&self) -> Option<f64> {
        self.stop_time
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError> {
        if let Some(stop) = t {
            finite("the stop time", stop)?;
        }
        self.stop_time = t;
        Ok(())
    }

    fn statistics(&self) -> Statistics {
        self.statistics
    }

    fn separate_roots(
        &mut self,
        program: &Arc<Program>,
        parameters: &[f64],
        (from, to): (f64, f64),
        times: &mut Vec<f64>,
    ) -> bool {
        if program.state_len() != self.series.dim {
            return false;
        }
        let separation = match &mut self.separation {
            Some(known) if Arc::ptr_eq(known.program(), program) => known,
            other => other.insert(RootSeparation::new(Arc::clone(program))),
        };
        let motion = PolynomialMotion { start: self.start, coefficients: &self.series.coefficients };
        let (start, low) = (self.start, self.start_low);
        let place = |t: f64| (t - start) - low;
        separation.separate(motion, (place(from), place(to)), parameters, times);
        // What lies beyond by rounding is not looked at.
        times.pop();
        for time in &mut *times {
            *time += start + low;
        }
        times.retain(|time| (time - from) * (to - time) > 0.0);
        times.push(to);
        true
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        self.tolerances.of(i, y)
    }

    fn least_size(&self) -> f64 {
        self.tolerances.largest_absolute() / self.tolerances.relative
    }
}

impl<F: VectorField> Taylor<F> {
    /// How long a step along the series may be.
    fn longest(&mut self, towards: f64) -> Result<f64, SolveError> {
        let mut length = self.tolerances.length(&self.series).min(self.max_step);
        if !self.branches.is_empty() {
            length = length.min(self.branch_length());
        }
        if let Some(first) = self.first_step.filter(|_| self.begins) {
            length = length.min(first);
        }
        if length.is_nan() {
            return Err(self.failed(Reason::Stalled, None));
        }
        // A series that ends goes as far as is asked for.
        Ok(if length.is_infinite() { (towards - self.start).abs() } else { length })
    }

    /// Goes to the other side of these branch functions at the start of the step.
    fn turn(&mut self, which: &[usize], direction: f64) -> Result<(), SolveError> {
        for &i in which {
            self.sides[i] = -self.sides[i];
        }
        self.ahead.of_order_mut(0).copy_from_slice(self.series.of_order(0));
        match self.expand(self.start) {
            Ok(()) => std::mem::swap(&mut self.series, &mut self.ahead),
            Err(Refusal::Shorter(reason, failure)) => return Err(self.failed(reason, failure)),
            Err(Refusal::Fatal(error)) => return Err(error),
        }
        match which.iter().find(|&&i| self.returns(i, direction)) {
            Some(&i) => Err(self.sliding(i, self.start)),
            None => Ok(()),
        }
    }

    /// Whether a branch function at zero goes back from the side that it has come to.
    fn returns(&self, i: usize, direction: f64) -> bool {
        self.branch_series.order() >= 1 && self.branch_series.of_order(1)[i] * direction * self.sides[i] < 0.0
    }

    fn sliding(&mut self, i: usize, t: f64) -> SolveError {
        self.failed(Reason::Sliding { branch: self.branches[i].clone(), t }, None)
    }

    /// Makes a step along the series; the time at its end, and what of that a number does not hold.
    fn find_step(
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
                // The step before has ended at the corner.
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
            // The end of the step, with the rounding of its time.
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
}
