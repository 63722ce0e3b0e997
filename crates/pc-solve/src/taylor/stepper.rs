//! Taylor's method as a stepper.

use pc_expr::{Method, PolynomialMotion, VectorField};

use crate::error::{IntegrationError, Reason, SolveError};
use crate::foresight::places::Places;
use crate::integration::checks::{check_inequalities, check_start, finite};
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};
use crate::settings::options::Options;
use crate::taylor::polynomial::Polynomial;
use crate::taylor::step_length::Tolerances;

/// Taylor's method of adaptive order and step as a [`Stepper`] [Jorba, Zou 2005]:
///
/// y(t + h) = Σ_{k=0}^{p} y⁽ᵏ⁾(t) hᵏ/k!, h = min_{k = p−1, p}
/// (|y⁽ᵏ⁾/k!|/|y|)^{−1/k} · rtol^{1/(p+1)}.
///
/// States inside a step are read from the polynomial. Time and state are compensated sums [Kahan
/// 1965]. A step at whose end the rates of the polynomial differ from those of the field is
/// repeated with half its length; no step crosses a corner or a jump of the field. States are
/// [projected](pc_expr::VectorField::project) at the end of each step, and inside steps where they
/// are read.
#[derive(Debug)]
pub struct Taylor<F> {
    pub(super) field: F,
    pub(super) tolerances: Tolerances,
    pub(super) limits: Limits,
    pub(super) first_step: Option<f64>,
    pub(super) min_step: f64,
    pub(super) max_step: f64,
    pub(super) stop_time: Option<f64>,
    /// The time at the start of the last step, with its rounding error, and the series at that
    /// time.
    pub(super) start: f64,
    pub(super) start_low: f64,
    pub(super) series: Polynomial,
    /// The same data at the end of the last step.
    pub(super) end: f64,
    pub(super) end_low: f64,
    pub(super) ahead: Polynomial,
    /// The length over which `ahead`, or at the start of a step `series`, is accurate; none if it is still to be
    /// computed.
    pub(super) known_length: Option<f64>,
    /// The series of the previous step, while a step is made.
    pub(super) before: Polynomial,
    /// The rounding error of the state at the end of the last step.
    pub(super) low: Vec<f64>,
    pub(super) next_low: Vec<f64>,
    /// The signs of the branch functions at the end of the last step, their names and their series.
    pub(super) sides: Vec<f64>,
    pub(super) branches: Vec<String>,
    pub(super) branch_series: Polynomial,
    /// Whether no step has been made since the start.
    pub(super) begins: bool,
    /// The direction of time in which `ahead` is valid; 0 if it has not been expanded.
    pub(super) direction: f64,
    pub(super) time: f64,
    pub(super) places: Places,
    pub(super) state: Vec<f64>,
    pub(super) slope: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) statistics: Statistics,
}

impl<F: VectorField> Taylor<F> {
    /// Starts at y(t0) = y0, one number per component, with the tolerances, step lengths,
    /// highest order and limits of the options; the method they choose is ignored.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all inputs are finite, of matching lengths and in their ranges;
    /// [`InputError::Explicit`](crate::InputError::Explicit) if the options choose how implicit
    /// equations are solved; [`Reason::Rates`] if the field has no [series](VectorField::series).
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
        let places = Places::new(&mut field, t0, options.min_step);
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
            known_length: None,
            low: zeros(),
            next_low: zeros(),
            sides: vec![0.0; branches.len()],
            branch_series: Polynomial::new(branches.len().max(1), order - 1),
            branches,
            begins: true,
            direction: 0.0,
            time: t0,
            places,
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
                let length = self.tolerances.length(&self.ahead);
                self.known_length = Some(length);
                self.statistics.current_step = length.copysign(h);
                self.statistics.current_time = t;
                Ok(())
            }
            Err(error) => {
                // Restore the previous step as the last one.
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

    fn polynomial<'a>(&'a mut self, _room: &'a mut Vec<f64>) -> Result<PolynomialMotion<'a>, SolveError> {
        Ok(PolynomialMotion { start: self.start, coefficients: &self.series.coefficients })
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        self.tolerances.of(i, y)
    }

    fn least_size(&self) -> f64 {
        self.tolerances.largest_absolute() / self.tolerances.relative
    }
}
