//! The classical Runge–Kutta method of order 4, with steps of fixed length.
//!
//! ```text
//! k₁ = f(t, y), k₂ = f(t + h/2, y + h/2 k₁), k₃ = f(t + h/2, y + h/2 k₂), k₄ = f(t + h, y + h k₃)
//! y(t + h) ≈ y + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄)
//! ```
//! [Kutta, Z. Math. Phys. 46 (1901) 435]. States inside a step lie on the cubic Hermite
//! interpolant, whose error is of order 4, like that of the steps.

use pc_expr::{Failure, VectorField};

use crate::error::{NonFinite, Reason, SolveError};
use crate::integration::breaks::next_break;
use crate::integration::checks::{check_inequalities, check_start, finite, positive};
use crate::integration::integration_method::IntegrationMethod;
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};

/// A step that would end just before a stop time or a break, by less than this fraction of its
/// length, is made to end there.
const NEAR: f64 = 1e-9;
/// The relative and absolute tolerance of the state that events use, since a fixed-step method has
/// none.
const TOLERANCES: (f64, f64) = (1e-9, 1e-12);

/// Integration with [`RungeKutta4`], without error control: for real-time loops, for comparisons,
/// and wherever every step has to take the same computing time.
///
/// ```
/// use pc_solve::{FixedStep, Solve, from_fn};
///
/// let oscillator = from_fn(2, |_t, y, ydot| { ydot.copy_from_slice(&[y[1], -y[0]]); Ok(()) });
/// let solution = Solve::new(oscillator, 0.0, &[1.0, 0.0]).method(FixedStep::new(0.01)).run(&[1.0])?;
/// assert!((solution.trajectory.state(0)[0] - 1.0_f64.cos()).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct FixedStep {
    length: f64,
    limits: Limits,
}

impl FixedStep {
    /// Integration with steps of this length, which is positive; a step that ends at a stop time or
    /// a [break](VectorField::breaks) may be shorter.
    pub fn new(length: f64) -> FixedStep {
        FixedStep { length, limits: Limits::default() }
    }

    /// The limits of the integration.
    pub fn limits(self, limits: Limits) -> FixedStep {
        FixedStep { limits, ..self }
    }
}

impl<F: VectorField> IntegrationMethod<F> for FixedStep {
    type Stepper = RungeKutta4<F>;

    fn begin(&self, field: F, t0: f64, y0: &[f64], stop: Option<f64>) -> Result<RungeKutta4<F>, SolveError> {
        let mut stepper = RungeKutta4::new(field, t0, y0, self)?;
        stepper.stop_time = stop.filter(|t| t.is_finite());
        Ok(stepper)
    }
}

/// The classical Runge–Kutta method of order 4 as a [`Stepper`].
///
/// States are [projected](VectorField::project) at the end of each step, and inside steps where
/// they are read.
#[derive(Debug, Clone)]
pub struct RungeKutta4<F> {
    field: F,
    length: f64,
    limits: Limits,
    stop_time: Option<f64>,
    /// The values of t, y and f at the start and at the end of the last step.
    start: Node,
    end: Node,
    /// Whether no step has been made since the start.
    begins: bool,
    time: f64,
    rates: [Vec<f64>; 3],
    /// Room for the argument of a stage, or a state inside a step.
    state: Vec<f64>,
    statistics: Statistics,
}

/// A state of the motion, with its rates.
#[derive(Debug, Clone)]
struct Node {
    t: f64,
    y: Vec<f64>,
    rates: Vec<f64>,
}

impl<F: VectorField> RungeKutta4<F> {
    /// Starts at y(t0) = y0, one number per component.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all inputs are finite, of matching lengths and in their ranges;
    /// [`Reason::Rates`] if the rates at the start cannot be computed.
    pub fn new(field: F, t0: f64, y0: &[f64], steps: &FixedStep) -> Result<Self, SolveError> {
        check_start(&field, t0, y0)?;
        finite("the length of steps", steps.length)?;
        positive("the length of steps", steps.length)?;
        positive("the number of steps", steps.limits.max_steps as f64)?;
        positive("the number of samples in a step", f64::from(steps.limits.samples_per_step))?;
        check_inequalities(&field, y0, &steps.limits.inequalities)?;
        let node = Node { t: t0, y: y0.to_vec(), rates: vec![f64::NAN; y0.len()] };
        let mut stepper = RungeKutta4 {
            field,
            length: steps.length,
            limits: steps.limits.clone(),
            stop_time: None,
            start: node.clone(),
            end: node,
            begins: true,
            time: t0,
            rates: std::array::from_fn(|_| vec![f64::NAN; y0.len()]),
            state: y0.to_vec(),
            statistics: Statistics { current_time: t0, ..Statistics::default() },
        };
        if stepper.field.breaks().is_empty() {
            stepper.rates_at_end()?;
        }
        Ok(stepper)
    }

    /// Computes f at the end of the last step.
    fn rates_at_end(&mut self) -> Result<(), SolveError> {
        self.statistics.rhs_evaluations += 1;
        let Node { t, y, rates } = &mut self.end;
        let evaluated = evaluate(&mut self.field, *t, y, rates);
        evaluated.map_err(|failure| self.failed(Reason::Rates { t: self.end.t }, Some(failure)))
    }

    /// The end of the next step towards a given time.
    fn target(&mut self, towards: f64) -> Result<f64, SolveError> {
        let from = self.end.t;
        let direction = 1.0_f64.copysign(towards - from);
        let end = self.stop_time.unwrap_or(f64::INFINITY.copysign(direction));
        let mut next = self.stop_time;
        if !self.field.breaks().is_empty() {
            let (t, first) = next_break(self.field.breaks(), from, end);
            next = first.or(self.stop_time);
            if self.field.enter(t, end) || self.begins {
                self.rates_at_end()?;
            }
        }
        let target = from + direction * self.length;
        let is_near = |&time: &f64| (target - time) * direction > -NEAR * self.length;
        Ok(next.filter(is_near).unwrap_or(target))
    }

    /// Writes the state at the end of a step of length h to `state`.
    fn advance(&mut self, t: f64, h: f64) -> Result<(), (f64, Failure)> {
        let RungeKutta4 { field, end: Node { t: from, y, rates: k1 }, rates: [k2, k3, k4], state, .. } = self;
        let middle = *from + h / 2.0;
        for (at, factor, stage) in [(middle, h / 2.0, 0), (middle, h / 2.0, 1), (t, h, 2)] {
            let (slope, rates) = match stage {
                0 => (&*k1, &mut *k2),
                1 => (&*k2, &mut *k3),
                _ => (&*k3, &mut *k4),
            };
            for ((stage, y), slope) in state.iter_mut().zip(&*y).zip(slope) {
                *stage = y + factor * slope;
            }
            evaluate(field, at, state, rates).map_err(|failure| (at, failure))?;
        }
        for (i, y) in y.iter().enumerate() {
            state[i] = y + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
        Ok(())
    }
}

/// Writes f(t, y) and checks that it is finite.
fn evaluate(field: &mut impl VectorField, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
    field.rhs(t, y, rates)?;
    match rates.iter().position(|rate| !rate.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let component = field.component_name(i);
            Err(Failure::recoverable(NonFinite::Rate { component, value: rates[i], t }))
        }
    }
}

/// The coefficients of y₀, h f₀, y₁ and h f₁ in hᵏ times the derivative of order k of the Hermite
/// cubic at s = (t − t₀)/h.
fn hermite(s: f64, order: u32) -> [f64; 4] {
    match order {
        0 => {
            let r = 1.0 - s;
            [r * r * (1.0 + 2.0 * s), s * r * r, s * s * (3.0 - 2.0 * s), -s * s * r]
        }
        1 => [6.0 * s * (s - 1.0), (1.0 - s) * (1.0 - 3.0 * s), 6.0 * s * (1.0 - s), s * (3.0 * s - 2.0)],
        2 => [12.0 * s - 6.0, 6.0 * s - 4.0, 6.0 - 12.0 * s, 6.0 * s - 2.0],
        3 => [12.0, 6.0, -12.0, 6.0],
        _ => [0.0; 4],
    }
}

impl<F: VectorField> Stepper for RungeKutta4<F> {
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
        let degree = (!self.begins).then_some(3);
        let start = if self.begins { self.end.t } else { self.start.t };
        LastStep { start, end: self.end.t, degree }
    }

    fn end_time(&self) -> f64 {
        self.end.t
    }

    fn end_state(&self) -> &[f64] {
        &self.end.y
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn stand_at(&mut self, t: f64) {
        self.time = t;
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        let t = self.target(towards)?;
        let h = t - self.end.t;
        if h == 0.0 {
            return Err(self.failed(Reason::Stalled, None));
        }
        self.statistics.rhs_evaluations += 3;
        if let Err((at, failure)) = self.advance(t, h) {
            return Err(self.failed(Reason::Rates { t: at }, Some(failure)));
        }
        if let Some(i) = self.state.iter().position(|value| !value.is_finite()) {
            let (component, value) = (self.field.component_name(i), self.state[i]);
            return Err(self.failed(Reason::Overflow { component, value, t }, None));
        }
        if let Err(failure) = self.field.project(t, &mut self.state) {
            return Err(self.failed(Reason::Projection { t }, Some(failure)));
        }
        self.statistics.rhs_evaluations += 1;
        if let Err(failure) = evaluate(&mut self.field, t, &self.state, &mut self.rates[0]) {
            return Err(self.failed(Reason::Rates { t }, Some(failure)));
        }
        std::mem::swap(&mut self.start, &mut self.end);
        (self.end.t, self.time, self.begins) = (t, t, false);
        self.end.y.copy_from_slice(&self.state);
        self.end.rates.copy_from_slice(&self.rates[0]);
        self.statistics.steps += 1;
        self.statistics.last_order = 4;
        self.statistics.current_order = 4;
        if self.statistics.first_step == 0.0 {
            self.statistics.first_step = h;
        }
        (self.statistics.last_step, self.statistics.current_step) = (h, self.length.copysign(h));
        self.statistics.current_time = t;
        Ok(())
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        let Node { t: from, y: y0, rates: f0 } = &self.start;
        let Node { t: to, y: y1, rates: f1 } = &self.end;
        let h = to - from;
        let [a, b, c, d] = hermite((t - from) / h, order);
        let scale = h.powi(-i32::try_from(order).unwrap_or(i32::MAX));
        for (i, value) in self.state.iter_mut().enumerate() {
            *value = scale * (a * y0[i] + c * y1[i] + h * (b * f0[i] + d * f1[i]));
        }
        if order == 0
            && let Err(failure) = self.field.project(t, &mut self.state)
        {
            return Err(self.failed(Reason::Projection { t }, Some(failure)));
        }
        Ok(&self.state)
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        _columns: &[f64],
        _direction: Option<f64>,
    ) -> Result<(), SolveError> {
        self.field.restart(t, y);
        self.end.t = t;
        self.end.y.copy_from_slice(y);
        (self.time, self.begins) = (t, true);
        self.statistics.current_time = t;
        if self.field.breaks().is_empty() { self.rates_at_end() } else { Ok(()) }
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

    fn tolerance(&self, _i: usize, y: f64) -> f64 {
        TOLERANCES.0 * y.abs() + TOLERANCES.1
    }

    fn least_size(&self) -> f64 {
        TOLERANCES.1 / TOLERANCES.0
    }
}
