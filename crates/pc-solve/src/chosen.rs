//! The method chosen in the options.

use pc_expr::{Events, Method, PolynomialMotion, VectorField};

#[cfg(feature = "cvode")]
use crate::auto::switch::Auto;
#[cfg(feature = "cvode")]
use crate::cvode::cvode::Cvode;
use crate::dop853::setup::Dop853;
#[cfg(not(feature = "cvode"))]
use crate::error::InputError;
use crate::error::{IntegrationError, SolveError};
use crate::integration::integration::Integration;
use crate::integration::integration_method::IntegrationMethod;
use crate::integration::limits::Limits;
use crate::integration::since::Since;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};
use crate::settings::options::Options;
use crate::taylor::stepper::Taylor;

/// The method chosen in [`Options`].
///
/// Its variable of integration is the time since the start, so that the steps of a motion from t₀ =
/// 10⁹ have as many digits as those of a motion from 0; the field is evaluated at t₀ plus that
/// time.
#[derive(Debug)]
pub struct Chosen<F: VectorField> {
    method: Engine<Since<F>>,
    /// The time that is the method's origin of time.
    origin: f64,
    /// The current time, and the end of the last step.
    time: f64,
    end: f64,
    stop_time: Option<f64>,
}

/// A method.
#[derive(Debug)]
enum Engine<F: VectorField> {
    #[cfg(feature = "cvode")]
    Cvode(Box<Cvode<F>>),
    Dop853(Box<Dop853<F>>),
    Taylor(Box<Taylor<F>>),
    #[cfg(feature = "cvode")]
    Auto(Box<Auto<F>>),
}

/// Forwards a call to the method.
macro_rules! each {
    ($chosen:expr, $method:ident => $call:expr) => {
        match $chosen {
            #[cfg(feature = "cvode")]
            Engine::Cvode($method) => $call,
            Engine::Dop853($method) => $call,
            Engine::Taylor($method) => $call,
            #[cfg(feature = "cvode")]
            Engine::Auto($method) => $call,
        }
    };
}

impl<F: VectorField> Chosen<F> {
    /// Starts at y(t0) = y0, one number per component.
    ///
    /// # Errors
    /// As for `Cvode::new`, [`Dop853::new`], [`Taylor::new`] and `Auto::new`;
    /// [`InputError::NoCvode`](crate::InputError::NoCvode).
    pub fn new(field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        let stop_time = options.stop_time;
        let (field, start, options) = counted(field, t0, options);
        let method = match options.method {
            Method::Dop853 => Engine::Dop853(Box::new(Dop853::new(field, start, y0, &options)?)),
            Method::Taylor => Engine::Taylor(Box::new(Taylor::new(field, start, y0, &options)?)),
            #[cfg(feature = "cvode")]
            Method::Bdf | Method::Adams => Engine::Cvode(Box::new(Cvode::new(field, start, y0, &options)?)),
            #[cfg(feature = "cvode")]
            Method::Auto => Engine::Auto(Box::new(Auto::new(field, start, y0, &options)?)),
            #[cfg(not(feature = "cvode"))]
            method => return Err(InputError::NoCvode { method }.into()),
        };
        Ok(Chosen::of(method, t0, stop_time))
    }

    /// Starts with CVODES as `begin` does, at a time that becomes the method's origin of time.
    ///
    /// # Errors
    /// The errors of `begin`.
    #[cfg(feature = "cvode")]
    pub(crate) fn by_cvode(
        field: F,
        t0: f64,
        options: &Options,
        begin: impl FnOnce(Since<F>, f64, &Options) -> Result<Cvode<Since<F>>, SolveError>,
    ) -> Result<Self, SolveError> {
        let stop_time = options.stop_time;
        let (field, start, options) = counted(field, t0, options);
        Ok(Chosen::of(Engine::Cvode(Box::new(begin(field, start, &options)?)), t0, stop_time))
    }

    /// The estimated local errors of the components in the last step, where the method is one of CVODES; none for another
    /// method.
    ///
    /// # Errors
    /// [`InputError::NoStep`](crate::InputError::NoStep) before the first step.
    pub fn local_errors(&mut self) -> Result<Option<&[f64]>, SolveError> {
        match &mut self.method {
            #[cfg(feature = "cvode")]
            Engine::Cvode(cvode) => cvode.local_errors().map(Some),
            #[cfg(feature = "cvode")]
            Engine::Auto(auto) => auto.local_errors(),
            Engine::Dop853(_) | Engine::Taylor(_) => Ok(None),
        }
    }

    fn of(method: Engine<Since<F>>, t0: f64, stop_time: Option<f64>) -> Self {
        Chosen { method, origin: t0, time: t0, end: t0, stop_time }
    }

    fn since(&self) -> &Since<F> {
        each!(&self.method, method => method.field())
    }

    /// The time t at a distance s after the origin.
    fn at(&self, s: f64) -> f64 {
        match self.stop_time {
            Some(stop) if s == stop - self.origin => stop,
            _ => self.since().time(s),
        }
    }

    /// Converts a time in the last step to the time since the origin; a time that rounding puts
    /// outside the step is moved to the nearer end.
    fn inside(&self, t: f64) -> f64 {
        if self.origin == 0.0 {
            return t;
        }
        let LastStep { start, end, .. } = each!(&self.method, method => method.last_step());
        if t == self.end {
            return end;
        }
        let (s, rounding) = (t - self.origin, f64::EPSILON * t.abs());
        let (least, most) = if end < start { (end, start) } else { (start, end) };
        if s < least && s >= least - rounding {
            least
        } else if s > most && s <= most + rounding {
            most
        } else {
            s
        }
    }
}

/// The field with its time counted from the start, the start in terms of that time, and the options
/// in terms of that time.
fn counted<F: VectorField>(field: F, t0: f64, options: &Options) -> (Since<F>, f64, Options) {
    if !t0.is_finite() {
        return (Since::new(field, 0.0), t0, options.clone()); // which the method refuses
    }
    let options = Options { stop_time: options.stop_time.map(|stop| stop - t0), ..options.clone() };
    (Since::new(field, t0), 0.0, options)
}

/// An error of the method, with its times converted to those of the integration.
fn dated(error: SolveError, origin: f64) -> SolveError {
    match error {
        SolveError::Integration(error) if origin != 0.0 => {
            let IntegrationError { reason, time, state, failure } = *error;
            let (reason, time) = (reason.since(origin), origin + time);
            SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure }))
        }
        other => other,
    }
}

impl<F: VectorField, E: Events> Integration<Chosen<F>, E> {
    /// The estimated local errors of the components in the last step, as [`Chosen::local_errors`] gives them.
    ///
    /// # Errors
    /// As there.
    pub fn local_errors(&mut self) -> Result<Option<&[f64]>, SolveError> {
        self.stepper_mut().local_errors()
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

impl<F: VectorField> Stepper for Chosen<F> {
    type Field = F;

    fn field(&self) -> &F {
        &self.since().field
    }

    fn field_mut(&mut self) -> &mut F {
        &mut each!(&mut self.method, method => method.field_mut()).field
    }

    fn into_field(self) -> F {
        each!(self.method, method => method.into_field()).field
    }

    fn limits(&self) -> &Limits {
        each!(&self.method, method => method.limits())
    }

    fn limits_mut(&mut self) -> &mut Limits {
        each!(&mut self.method, method => method.limits_mut())
    }

    fn last_step(&self) -> LastStep {
        let LastStep { start, degree, .. } = each!(&self.method, method => method.last_step());
        LastStep { start: self.at(start), end: self.end, degree }
    }

    fn end_time(&self) -> f64 {
        self.end
    }

    fn end_state(&self) -> &[f64] {
        each!(&self.method, method => method.end_state())
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn stand_at(&mut self, t: f64) {
        let s = self.inside(t);
        self.time = t;
        each!(&mut self.method, method => method.stand_at(s));
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        let (towards, origin) = (towards - self.origin, self.origin);
        let stepped = each!(&mut self.method, method => method.step(towards));
        self.end = self.at(each!(&self.method, method => method.end_time()));
        self.time = self.end;
        stepped.map_err(|error| dated(error, origin))
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        let (s, origin) = (self.inside(t), self.origin);
        each!(&mut self.method, method => method.interpolate(s, order)).map_err(|error| dated(error, origin))
    }

    fn centre(&self) -> f64 {
        let centre = each!(&self.method, method => method.centre());
        let end = each!(&self.method, method => method.end_time());
        if centre == end { self.end } else { self.at(centre) }
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        let s = t - self.origin;
        each!(&mut self.method, method => method.field_mut()).read_breaks();
        each!(&mut self.method, method => method.restart(s, y, columns, direction))
            .map_err(|error| dated(error, self.origin))?;
        (self.time, self.end) = (t, t);
        Ok(())
    }

    fn enter_piece(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        let s = t - self.origin;
        each!(&mut self.method, method => method.enter_piece(s, y, columns, direction))
            .map_err(|error| dated(error, self.origin))?;
        (self.time, self.end) = (t, t);
        Ok(())
    }

    fn stop_time(&self) -> Option<f64> {
        self.stop_time
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError> {
        let stop = t.map(|t| t - self.origin);
        each!(&mut self.method, method => method.set_stop_time(stop))?;
        self.stop_time = t;
        Ok(())
    }

    fn statistics(&self) -> Statistics {
        let work = each!(&self.method, method => method.statistics());
        let stiff_from = work.stiff_from.map(|t| self.origin + t);
        Statistics { current_time: self.at(work.current_time), stiff_from, ..work }
    }

    fn polynomial<'a>(&'a mut self, room: &'a mut Vec<f64>) -> Result<PolynomialMotion<'a>, SolveError> {
        let origin = self.origin;
        let motion = each!(&mut self.method, method => method.polynomial(room));
        let motion = motion.map_err(|error| dated(error, origin))?;
        Ok(PolynomialMotion { start: origin + motion.start, ..motion })
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        each!(&self.method, method => method.tolerance(i, y))
    }

    fn least_size(&self) -> f64 {
        each!(&self.method, method => method.least_size())
    }

    fn columns(&self) -> Result<Vec<f64>, SolveError> {
        each!(&self.method, method => method.columns()).map_err(|error| dated(error, self.origin))
    }

    fn column_parameters(&self) -> &[Option<usize>] {
        each!(&self.method, method => method.column_parameters())
    }
}
