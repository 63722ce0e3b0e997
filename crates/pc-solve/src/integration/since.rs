//! A vector field whose time is measured from the start of the integration.
//!
//! Near t = 10⁹ the floating-point numbers are 10⁻⁷ apart: a step of 10⁻⁵ would have two digits.
//! The methods therefore integrate with respect to s = t − t₀, so that steps and stages have all
//! their digits, and the field is evaluated at t₀ + s. For t₀ = 0, this sum is t to the last bit.

use pc_expr::{
    Failure, LaneField, Pattern, RateJump, SteepFunctions, TaylorSeries, TimeDependence, VectorField,
};

use crate::error::NonFinite;

/// ẏ(s) = f(t₀ + s, y)
#[derive(Debug)]
pub(crate) struct Since<F> {
    pub(crate) field: F,
    origin: f64,
    /// The times of the field's breaks, measured from the origin; empty if the origin is 0.
    breaks: Vec<f64>,
}

impl<F: VectorField> Since<F> {
    pub(crate) fn new(field: F, origin: f64) -> Since<F> {
        let mut since = Since { field, origin, breaks: Vec::new() };
        since.read_breaks();
        since
    }

    /// Reads the breaks of the field, which may have changed.
    pub(crate) fn read_breaks(&mut self) {
        if self.origin != 0.0 {
            self.breaks.clear();
            self.breaks.extend(self.field.breaks().iter().map(|time| time - self.origin));
        }
    }

    /// The time t₀ + s; at a break, it is the time of the break to the last bit.
    pub(crate) fn time(&self, s: f64) -> f64 {
        if self.breaks.is_empty() {
            return self.origin + s;
        }
        let place = self.breaks.partition_point(|time| *time < s);
        match (self.breaks.get(place), self.field.breaks().get(place)) {
            (Some(time), Some(&exact)) if *time == s => exact,
            _ => self.origin + s,
        }
    }
}

impl<F: VectorField> VectorField for Since<F> {
    #[inline]
    fn dim(&self) -> usize {
        self.field.dim()
    }

    #[inline]
    fn rhs(&mut self, s: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let t = self.time(s);
        if self.field.checks_rates() {
            return self.field.rhs(t, y, ydot);
        }
        ydot.fill(f64::NAN); // to detect entries that are not written
        self.field.rhs(t, y, ydot)?;
        match ydot.iter().position(|rate| !rate.is_finite()) {
            None => Ok(()),
            Some(i) => {
                let component = self.field.component_name(i);
                Err(Failure::recoverable(NonFinite::Rate { component, value: ydot[i], t }))
            }
        }
    }

    #[inline]
    fn checks_rates(&self) -> bool {
        true
    }

    fn has_jacobian(&self) -> bool {
        self.field.has_jacobian()
    }

    fn jacobian(&mut self, s: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        let t = self.time(s);
        self.field.jacobian(t, y, jacobian)
    }

    fn sparsity(&self) -> Option<&Pattern> {
        self.field.sparsity()
    }

    fn sparse_jacobian(&mut self, s: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let t = self.time(s);
        self.field.sparse_jacobian(t, y, values)
    }

    fn has_jvp(&self) -> bool {
        self.field.has_jvp()
    }

    fn jvp(&mut self, s: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        let t = self.time(s);
        self.field.jvp(t, y, v, product)
    }

    fn has_vjp(&self) -> bool {
        self.field.has_vjp()
    }

    fn vjp(&mut self, s: f64, y: &[f64], w: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        let t = self.time(s);
        self.field.vjp(t, y, w, product)
    }

    fn parameters_len(&self) -> usize {
        self.field.parameters_len()
    }

    fn has_parameter_jacobian(&self) -> bool {
        self.field.has_parameter_jacobian()
    }

    fn parameter_jacobian(&mut self, s: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        let t = self.time(s);
        self.field.parameter_jacobian(t, y, jacobian)
    }

    fn parameter_size(&self, j: usize) -> Option<f64> {
        self.field.parameter_size(j)
    }

    fn has_projection(&self) -> bool {
        self.field.has_projection()
    }

    fn project(&mut self, s: f64, y: &mut [f64]) -> Result<(), Failure> {
        let t = self.time(s);
        self.field.project(t, y)
    }

    fn time_dependence(&self) -> TimeDependence {
        self.field.time_dependence().since(self.origin)
    }

    fn steep_functions(&self) -> Option<SteepFunctions> {
        self.field.steep_functions().map(|steep| steep.since(self.origin))
    }

    // Its sides are held through the field itself, at times that are not counted from the start.
    fn held_time_dependence(&mut self) -> Option<TimeDependence> {
        self.field.held_time_dependence().map(|dependence| dependence.since(self.origin))
    }

    fn series(&mut self) -> Result<&TaylorSeries, Failure> {
        self.field.series()
    }

    fn expand(&mut self, s: f64, y: &[f64], sides: &[f64], order: usize) -> Result<&TaylorSeries, Failure> {
        let t = self.time(s);
        self.field.expand(t, y, sides, order)
    }

    fn varied_series(&mut self, columns: &[Option<usize>]) -> Result<&TaylorSeries, Failure> {
        self.field.varied_series(columns)
    }

    fn expand_varied(
        &mut self,
        columns: &[Option<usize>],
        s: f64,
        all: &[f64],
        sides: &[f64],
        order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        let t = self.time(s);
        self.field.expand_varied(columns, t, all, sides, order)
    }

    fn lanes(&mut self) -> Option<LaneField> {
        None // their times are not counted from the start
    }

    fn restart(&mut self, s: f64, y: &[f64]) {
        let t = self.time(s);
        self.field.restart(t, y);
    }

    fn breaks(&self) -> &[f64] {
        if self.origin == 0.0 { self.field.breaks() } else { &self.breaks }
    }

    fn enter(&mut self, s: f64, end: f64) -> bool {
        let (t, end) = (self.time(s), self.time(end));
        self.field.enter(t, end)
    }

    fn jumps(&self) -> &[RateJump] {
        self.field.jumps()
    }

    fn leads(&mut self, from: (f64, &[f64]), to: (f64, &[f64])) -> Result<(), Failure> {
        let (start, end) = (self.time(from.0), self.time(to.0));
        self.field.leads((start, from.1), (end, to.1))
    }

    fn component_name(&self, i: usize) -> String {
        self.field.component_name(i)
    }
}
