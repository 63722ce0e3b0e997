//! The polynomial that predicts the motion up to the end of the next step, and its defect.

use pc_expr::VectorField;

use crate::foresight::places::Places;
use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

/// Approximate maximum ratio of a step's correction to its local error, at the orders at which the
/// step length grows.
const NEXT_TERM: f64 = 20.0;

/// The times to examine, and the prediction of the motion at them.
pub(super) struct Foresight {
    /// The times to examine; none while they are in use elsewhere.
    pub(super) places: Option<Places>,
    pub(super) relative_tolerance: f64,
    pub(super) absolute_tolerance: Tolerance,
    /// The number of evaluations since the last restart.
    pub(super) evaluations: u64,
    /// z⁽ᵏ⁾(tₙ)/k! of the last polynomial, for k = 0, 1, …, each as long as the state; and work space.
    pub(super) polynomial: Vec<f64>,
    pub(super) state: Vec<f64>,
    pub(super) slope: Vec<f64>,
    pub(super) rates: Vec<f64>,
    /// The local errors of the last step, its length and order.
    pub(super) errors: Vec<f64>,
    pub(super) last_step: f64,
    pub(super) order: i32,
}

impl Foresight {
    pub(super) fn new(field: &mut impl VectorField, t0: f64, options: &Options) -> Foresight {
        let (dim, places) = (field.dim(), Places::new(field, t0, options.min_step));
        let most = if places.are_absent() { 0 } else { options.method.highest_order() as usize + 1 };
        let polynomial = Vec::with_capacity(most * dim);
        Foresight {
            places: Some(places),
            relative_tolerance: options.resolved_tolerance(),
            absolute_tolerance: options.absolute_tolerance.clone(),
            evaluations: 0,
            polynomial,
            state: vec![0.0; dim],
            slope: vec![0.0; dim],
            rates: vec![0.0; dim],
            errors: vec![0.0; dim],
            last_step: 0.0,
            order: 0,
        }
    }

    /// Resets the counts, for a restart.
    pub(super) fn restart(&mut self) {
        self.evaluations = 0;
        if let Some(places) = &mut self.places {
            places.restart();
        }
    }

    /// rtol |yᵢ| + atolᵢ
    pub(super) fn tolerance(&self, i: usize, y: f64) -> f64 {
        let atol = match &self.absolute_tolerance {
            Tolerance::Scalar(atol) => *atol,
            Tolerance::Vector(atol) => atol[i],
        };
        self.relative_tolerance * y.abs() + atol
    }

    /// The smallest significant size of a component, according to the tolerances.
    pub(super) fn least_size(&self) -> f64 {
        let atol = match &self.absolute_tolerance {
            Tolerance::Scalar(atol) => *atol,
            Tolerance::Vector(atol) => atol.iter().copied().fold(0.0, f64::max),
        };
        atol / self.relative_tolerance
    }

    /// max |δᵢ|/(rtol |yᵢ| + atolᵢ) for the defect at the last time examined, which lies `since`
    /// after the last step.
    ///
    /// The part of the defect that the next term of the polynomial would explain is subtracted: a
    /// method that has just raised its order includes that term, and makes long steps with it.
    pub(super) fn defect(&self, since: f64) -> f64 {
        let ratio = (since / self.last_step).abs();
        let growth = NEXT_TERM * f64::from(self.order + 1) * ratio.powi(self.order) / self.last_step.abs();
        let weighed = |i: usize| {
            let defect = (self.rates[i] - self.slope[i]).abs();
            (defect - growth * self.errors[i].abs()) / self.tolerance(i, self.state[i])
        };
        (0..self.rates.len()).map(weighed).fold(0.0, f64::max)
    }

    /// Writes p and p′ at the time `since` after the last step.
    pub(super) fn predict(&mut self, since: f64) {
        self.state.fill(0.0);
        self.slope.fill(0.0);
        for terms in self.polynomial.rchunks_exact(self.state.len()) {
            for ((state, slope), term) in self.state.iter_mut().zip(&mut self.slope).zip(terms) {
                *slope = *slope * since + *state;
                *state = *state * since + term;
            }
        }
    }
}
