//! The method chosen by options.

use pc_expr::{PolynomialMotion, VectorField};

#[cfg(feature = "cvode")]
use crate::auto::switch::Auto;
#[cfg(feature = "cvode")]
use crate::cvode::cvode::Cvode;
use crate::dop853::setup::Dop853;
#[cfg(not(feature = "cvode"))]
use crate::error::InputError;
use crate::error::SolveError;
use crate::integration::limits::Limits;
use crate::integration::method::IntegrationMethod;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};
use crate::settings::method::Method;
use crate::settings::options::Options;
use crate::taylor::stepper::Taylor;

/// The method chosen by [`Options`].
#[derive(Debug)]
#[non_exhaustive]
pub enum Chosen<F: VectorField> {
    /// [`Method::Adams`] or [`Method::Bdf`].
    #[cfg(feature = "cvode")]
    Cvode(Box<Cvode<F>>),
    /// [`Method::Dop853`].
    Dop853(Box<Dop853<F>>),
    /// [`Method::Taylor`].
    Taylor(Box<Taylor<F>>),
    /// [`Method::Auto`].
    #[cfg(feature = "cvode")]
    Auto(Box<Auto<F>>),
}

impl<F: VectorField> Chosen<F> {
    /// Starts at y(t0) = y0, as long as `field` has components.
    ///
    /// # Errors
    /// As for `Cvode::new`, [`Dop853::new`], [`Taylor::new`] and `Auto::new`;
    /// [`InputError::NoCvode`](crate::InputError::NoCvode).
    pub fn new(field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        match options.method {
            Method::Dop853 => Ok(Chosen::Dop853(Box::new(Dop853::new(field, t0, y0, options)?))),
            Method::Taylor => Ok(Chosen::Taylor(Box::new(Taylor::new(field, t0, y0, options)?))),
            #[cfg(feature = "cvode")]
            Method::Bdf | Method::Adams => Ok(Chosen::Cvode(Box::new(Cvode::new(field, t0, y0, options)?))),
            #[cfg(feature = "cvode")]
            Method::Auto => Ok(Chosen::Auto(Box::new(Auto::new(field, t0, y0, options)?))),
            #[cfg(not(feature = "cvode"))]
            method => Err(InputError::NoCvode { method }.into()),
        }
    }
}

#[cfg(feature = "cvode")]
impl<F: VectorField> From<Cvode<F>> for Chosen<F> {
    fn from(cvode: Cvode<F>) -> Self {
        Chosen::Cvode(Box::new(cvode))
    }
}

impl<F: VectorField> IntegrationMethod<F> for Options {
    type Stepper = Chosen<F>;

    fn begin(&self, field: F, t0: f64, y0: &[f64], stop: Option<f64>) -> Result<Chosen<F>, SolveError> {
        let mut options = self.clone();
        options.stop_time = options.stop_time.or(stop.filter(|t| t.is_finite()));
        Chosen::new(field, t0, y0, &options)
    }
}

/// Forwards a call to the method.
macro_rules! each {
    ($chosen:expr, $method:ident => $call:expr) => {
        match $chosen {
            #[cfg(feature = "cvode")]
            Chosen::Cvode($method) => $call,
            Chosen::Dop853($method) => $call,
            Chosen::Taylor($method) => $call,
            #[cfg(feature = "cvode")]
            Chosen::Auto($method) => $call,
        }
    };
}

impl<F: VectorField> Stepper for Chosen<F> {
    type Field = F;

    fn field(&self) -> &F {
        each!(self, method => method.field())
    }

    fn field_mut(&mut self) -> &mut F {
        each!(self, method => method.field_mut())
    }

    fn into_field(self) -> F {
        each!(self, method => method.into_field())
    }

    fn limits(&self) -> &Limits {
        each!(self, method => method.limits())
    }

    fn limits_mut(&mut self) -> &mut Limits {
        each!(self, method => method.limits_mut())
    }

    fn last_step(&self) -> LastStep {
        each!(self, method => method.last_step())
    }

    fn end_state(&self) -> &[f64] {
        each!(self, method => method.end_state())
    }

    fn time(&self) -> f64 {
        each!(self, method => method.time())
    }

    fn stand_at(&mut self, t: f64) {
        each!(self, method => method.stand_at(t));
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        each!(self, method => method.step(towards))
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        each!(self, method => method.interpolate(t, order))
    }

    fn centre(&self) -> f64 {
        each!(self, method => method.centre())
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        each!(self, method => method.restart(t, y, columns, direction))
    }

    fn enter_piece(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        each!(self, method => method.enter_piece(t, y, columns, direction))
    }

    fn stop_time(&self) -> Option<f64> {
        each!(self, method => method.stop_time())
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError> {
        each!(self, method => method.set_stop_time(t))
    }

    fn statistics(&self) -> Statistics {
        each!(self, method => method.statistics())
    }

    fn polynomial<'a>(&'a mut self, room: &'a mut Vec<f64>) -> Result<PolynomialMotion<'a>, SolveError> {
        each!(self, method => method.polynomial(room))
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        each!(self, method => method.tolerance(i, y))
    }

    fn least_size(&self) -> f64 {
        each!(self, method => method.least_size())
    }

    fn columns(&self) -> Result<Vec<f64>, SolveError> {
        each!(self, method => method.columns())
    }

    fn column_parameters(&self) -> &[Option<usize>] {
        each!(self, method => method.column_parameters())
    }
}
