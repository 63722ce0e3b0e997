//! Derivatives of a motion that an explicit method integrates along with it.
//!
//! The state of the method is (y, s₁, s₂, …), with the equations of variation for the columns; seen
//! from outside, the state is y alone.

use pc_expr::{
    Failure, Method, PolynomialMotion, SteepFunctions, Switching, TaylorSeries, TimeDependence, VectorField,
    forward,
};

use crate::cvode::cvode::Cvode;
use crate::cvode::forward::linearisation::Linearisation;
use crate::cvode::forward::sensitivities::Sensitivities;
use crate::cvode::forward::variation::Variation;
use crate::dop853::setup::Dop853;
use crate::error::{IntegrationError, Reason, SolveError};
use crate::integration::checks::check_start;
use crate::integration::integration_method::IntegrationMethod;
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};
use crate::settings::inequality::Inequality;
use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;
use crate::taylor::stepper::Taylor;

/// The absolute tolerance of components whose error is not controlled.
const ANY: f64 = 1e300;

/// A field together with the equations of variation of its columns, ṡ = (∂f/∂y) s + ∂f/∂p.
#[derive(Debug)]
pub(crate) struct WithVariation<F> {
    field: F,
    variation: Variation,
    dim: usize,
}

impl<F: VectorField> VectorField for WithVariation<F> {
    fn dim(&self) -> usize {
        self.dim * (1 + self.variation.parameters().len())
    }

    fn rhs(&mut self, t: f64, all: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        let (y, columns) = all.split_at(self.dim);
        let (ydot, rates) = rates.split_at_mut(self.dim);
        self.field.rhs(t, y, ydot)?;
        let columns = columns.chunks_exact(self.dim).zip(rates.chunks_exact_mut(self.dim));
        self.variation.rates(&mut self.field, t, y, columns)
    }

    fn has_projection(&self) -> bool {
        self.field.has_projection()
    }

    fn project(&mut self, t: f64, all: &mut [f64]) -> Result<(), Failure> {
        self.field.project(t, &mut all[..self.dim])
    }

    fn time_dependence(&self) -> TimeDependence {
        self.field.time_dependence()
    }

    fn steep_functions(&self) -> Option<SteepFunctions> {
        self.field.steep_functions().map(|steep| steep.in_states_of(self.dim()))
    }

    fn series(&mut self) -> Result<&TaylorSeries, Failure> {
        self.field.varied_series(self.variation.parameters())
    }

    fn expand(&mut self, t: f64, all: &[f64], sides: &[f64], order: usize) -> Result<&TaylorSeries, Failure> {
        self.field.expand_varied(self.variation.parameters(), t, all, sides, order)
    }

    fn restart(&mut self, t: f64, all: &[f64]) {
        self.field.restart(t, &all[..self.dim]);
    }

    fn breaks(&self) -> &[f64] {
        self.field.breaks()
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        self.field.enter(t, end)
    }

    /// The surfaces are those of the field for y; the integration evaluates their functions with y
    /// alone.
    fn switching(&mut self) -> Option<&mut dyn Switching> {
        self.field.switching()
    }

    fn component_name(&self, i: usize) -> String {
        let name = self.field.component_name(i % self.dim);
        match i / self.dim {
            0 => name,
            column => format!("column {} (from 0) of the sensitivity of {name}", column - 1),
        }
    }
}

/// An explicit method with the derivatives of the motion as part of its state.
#[derive(Debug)]
pub(crate) struct Explicit<S> {
    method: S,
    /// The parameter of each column, none for derivatives with respect to the start.
    parameters: Vec<Option<usize>>,
    dim: usize,
    relative_tolerance: f64,
    /// The state and the columns at the time, inside the last step, that is being read.
    state: Vec<f64>,
    inside: Option<Vec<f64>>,
    /// The columns at the start of the last step.
    start: Vec<f64>,
}

impl<F: VectorField, S: Stepper<Field = WithVariation<F>>> Explicit<S> {
    /// Starts an integration at y(t0) = y0 that also computes derivatives of the motion, using the
    /// method that `begin` constructs from the field, the initial state and the options.
    ///
    /// # Errors
    /// As for `begin`; [`SolveError::Input`] if a column needs a derivative that the field does not have.
    pub(crate) fn new(
        begin: impl FnOnce(WithVariation<F>, f64, &[f64], &Options) -> Result<S, SolveError>,
        (mut field, t0, y0): (F, f64, &[f64]),
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        check_start(&field, t0, y0)?;
        options.validate(y0.len())?;
        sensitivities.validate(&field)?;
        let (dim, count) = (y0.len(), sensitivities.len());
        let mut linearisation = Linearisation::new(&field, options);
        let scales = sensitivities.sizes(&mut field, &mut linearisation, t0, y0);
        let own = |i: usize| match &options.absolute_tolerance {
            Tolerance::Scalar(tolerance) => *tolerance,
            Tolerance::Vector(tolerances) => tolerances[i],
        };
        let of_column = |column: usize, i: usize| match sensitivities.tolerances {
            _ if !sensitivities.error_control => ANY,
            Some((_, absolute)) => absolute,
            None => own(i) / scales[column],
        };
        let mut tolerances: Vec<f64> = (0..dim).map(own).collect();
        tolerances.extend(
            (0..count).flat_map(|column| (0..dim).map(move |i| (column, i))).map(|(k, i)| of_column(k, i)),
        );
        let mut inequalities = options.inequalities.clone();
        if !inequalities.is_empty() {
            inequalities.resize(dim * (1 + count), Inequality::Free);
        }
        let all_options =
            Options { absolute_tolerance: Tolerance::Vector(tolerances), inequalities, ..options.clone() };
        let columns = sensitivities.start(dim);
        let all = [y0, &columns].concat();
        let parameters = sensitivities.parameters();
        let variation = Variation::new(linearisation, parameters.clone());
        let method = begin(WithVariation { field, variation, dim }, t0, &all, &all_options)?;
        let relative_tolerance = options.relative_tolerance;
        Ok(Explicit { method, parameters, dim, relative_tolerance, state: all, inside: None, start: columns })
    }

    /// Reads the columns at the current time, if this time lies inside the last step.
    fn read_columns(&mut self, t: f64) {
        let LastStep { start, end, degree } = self.method.last_step();
        self.inside = None;
        if t == end || degree.is_none() {
            return;
        }
        let columns = match t == start {
            true => self.start.clone(),
            false => match self.method.interpolate(t, 0) {
                Ok(all) => all[self.dim..].to_vec(),
                Err(_) => vec![f64::NAN; self.start.len()],
            },
        };
        self.inside = Some(columns);
    }

    fn keep_start(&mut self) {
        self.start.copy_from_slice(&self.method.end_state()[self.dim..]);
    }
}

impl<F: VectorField, S: Stepper<Field = WithVariation<F>>> Stepper for Explicit<S> {
    type Field = F;

    fn field(&self) -> &F {
        &self.method.field().field
    }

    fn field_mut(&mut self) -> &mut F {
        &mut self.method.field_mut().field
    }

    fn into_field(self) -> F {
        self.method.into_field().field
    }

    fn limits(&self) -> &Limits {
        self.method.limits()
    }

    fn limits_mut(&mut self) -> &mut Limits {
        self.method.limits_mut()
    }

    fn last_step(&self) -> LastStep {
        self.method.last_step()
    }

    fn end_state(&self) -> &[f64] {
        &self.method.end_state()[..self.dim]
    }

    fn time(&self) -> f64 {
        self.method.time()
    }

    fn stand_at(&mut self, t: f64) {
        if t != self.method.time() || self.inside.is_none() {
            self.read_columns(t);
        }
        self.method.stand_at(t);
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        let before = self.start.clone();
        self.keep_start();
        self.inside = None;
        let outcome = self.method.step(towards);
        if outcome.is_err() {
            self.start = before;
        }
        outcome.map_err(|error| self.of_state(error))
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        match self.method.interpolate(t, order) {
            Ok(all) => self.state[..all.len()].copy_from_slice(all),
            Err(error) => return Err(self.of_state(error)),
        }
        Ok(&self.state[..self.dim])
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        self.inside = None;
        self.method.restart(t, &[y, columns].concat(), &[], direction)?;
        self.keep_start();
        Ok(())
    }

    fn enter_piece(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        self.inside = None;
        self.method.enter_piece(t, &[y, columns].concat(), &[], direction)?;
        self.keep_start();
        Ok(())
    }

    fn stop_time(&self) -> Option<f64> {
        self.method.stop_time()
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError> {
        self.method.set_stop_time(t)
    }

    fn statistics(&self) -> Statistics {
        self.method.statistics()
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        self.method.tolerance(i, y)
    }

    fn least_size(&self) -> f64 {
        let largest = (0..self.dim).map(|i| self.method.tolerance(i, 0.0)).fold(0.0, f64::max);
        largest / self.relative_tolerance
    }

    fn columns(&self) -> Result<Vec<f64>, SolveError> {
        let columns = match &self.inside {
            Some(inside) => inside.clone(),
            None => self.method.end_state()[self.dim..].to_vec(),
        };
        let Some(k) = columns.iter().position(|value| !value.is_finite()) else { return Ok(columns) };
        let component = self.method.field().component_name(self.dim + k);
        let reason = Reason::Overflow { component, value: columns[k], t: self.method.time() };
        let (time, state) = (self.end_time(), self.end_state().to_vec());
        let error = IntegrationError { reason, time, state, failure: None };
        Err(SolveError::Integration(Box::new(error)))
    }

    fn column_parameters(&self) -> &[Option<usize>] {
        &self.parameters
    }
}

impl<F: VectorField, S: Stepper<Field = WithVariation<F>>> Explicit<S> {
    /// The same error, with its state reduced to that of the motion alone.
    fn of_state(&self, error: SolveError) -> SolveError {
        match error {
            SolveError::Integration(mut error) => {
                error.state.truncate(self.dim);
                SolveError::Integration(error)
            }
            other => other,
        }
    }
}

/// The method chosen in the options for a motion with its derivatives.
#[derive(Debug)]
pub(crate) enum Differentiated<F: VectorField> {
    /// CVODES: for [`Method::Adams`] and [`Method::Bdf`]; also for [`Method::Auto`], with Adams'
    /// formulas.
    Cvode(Box<Cvode<F>>),
    /// [`Method::Dop853`].
    Dop853(Box<Explicit<Dop853<WithVariation<F>>>>),
    /// [`Method::Taylor`].
    Taylor(Box<Explicit<Taylor<WithVariation<F>>>>),
}

impl<F: VectorField> Differentiated<F> {
    /// Starts at y(t0) = y0, and integrates derivatives of the motion too.
    ///
    /// # Errors
    /// As for [`Cvode::with_sensitivities`](crate::Cvode::with_sensitivities), [`Dop853::new`] and [`Taylor::new`].
    pub(crate) fn new(
        field: F,
        t0: f64,
        y0: &[f64],
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        match options.method {
            Method::Dop853 => {
                let method = Explicit::new(Dop853::new, (field, t0, y0), options, sensitivities)?;
                Ok(Differentiated::Dop853(Box::new(method)))
            }
            Method::Taylor => {
                let method = Explicit::new(Taylor::new, (field, t0, y0), options, sensitivities)?;
                Ok(Differentiated::Taylor(Box::new(method)))
            }
            Method::Adams | Method::Bdf | Method::Auto => {
                let cvode = Cvode::with_sensitivities(field, t0, y0, options, sensitivities)?;
                Ok(Differentiated::Cvode(Box::new(cvode)))
            }
        }
    }
}

/// The method chosen in the options, with sensitivities.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Differentiating<'a> {
    pub(crate) options: &'a Options,
    pub(crate) sensitivities: &'a Sensitivities,
}

impl<F: VectorField> IntegrationMethod<F> for Differentiating<'_> {
    type Stepper = Differentiated<F>;

    fn begin(
        &self,
        field: F,
        t0: f64,
        y0: &[f64],
        stop: Option<f64>,
    ) -> Result<Differentiated<F>, SolveError> {
        let mut options = self.options.clone();
        options.stop_time = options.stop_time.or(stop.filter(|t| t.is_finite()));
        Differentiated::new(field, t0, y0, &options, self.sensitivities)
    }
}

/// Forwards a call to the method.
macro_rules! of_either {
    ($chosen:expr, $method:ident => $call:expr) => {
        match $chosen {
            Differentiated::Cvode($method) => $call,
            Differentiated::Dop853($method) => $call,
            Differentiated::Taylor($method) => $call,
        }
    };
}

impl<F: VectorField> Stepper for Differentiated<F> {
    type Field = F;

    fn into_field(self) -> F {
        of_either!(self, method => method.into_field())
    }

    fn polynomial<'a>(&'a mut self, room: &'a mut Vec<f64>) -> Result<PolynomialMotion<'a>, SolveError> {
        of_either!(self, method => method.polynomial(room))
    }

    forward! { @of_either =>
        fn field(&self) -> &F;
        fn field_mut(&mut self) -> &mut F;
        fn limits(&self) -> &Limits;
        fn limits_mut(&mut self) -> &mut Limits;
        fn last_step(&self) -> LastStep;
        fn end_state(&self) -> &[f64];
        fn time(&self) -> f64;
        fn stand_at(&mut self, t: f64);
        fn step(&mut self, towards: f64) -> Result<(), SolveError>;
        fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError>;
        fn centre(&self) -> f64;
        fn restart(&mut self, t: f64, y: &[f64], columns: &[f64], direction: Option<f64>) -> Result<(), SolveError>;
        fn enter_piece(&mut self, t: f64, y: &[f64], columns: &[f64], direction: Option<f64>) -> Result<(), SolveError>;
        fn stop_time(&self) -> Option<f64>;
        fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError>;
        fn statistics(&self) -> Statistics;
        fn tolerance(&self, i: usize, y: f64) -> f64;
        fn least_size(&self) -> f64;
        fn columns(&self) -> Result<Vec<f64>, SolveError>;
        fn column_parameters(&self) -> &[Option<usize>];
    }
}
