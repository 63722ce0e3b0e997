//! The choice of order and step length from the tolerance and the coefficients [Jorba, Zou 2005,
//! section 3].

use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;
use crate::taylor::polynomial::Polynomial;

/// The range of orders that are chosen automatically.
const ORDERS: std::ops::RangeInclusive<usize> = 6..=40;
/// The smallest useful tolerance: a smaller one would gain nothing.
const TIGHTEST: f64 = 1e-20;
/// Changes of the state over a step that are below this fraction of the state are treated as
/// rounding errors.
const ROUNDING: f64 = 1e-15;
/// So are differences between rates that are below this fraction of the rates: cancellation in f
/// leaves an error of about a hundred rounding errors.
const ROUNDING_OF_RATES: f64 = 1e-13;
/// The rates at the end of a step may differ from those of the polynomial by this many times the
/// contribution of the first neglected term: the coefficients scatter, and tolerances are met only
/// to an order of magnitude.
const DEFECT: f64 = 100.0;

/// rtol |yᵢ| + atolᵢ
#[derive(Debug, Clone)]
pub(super) struct Tolerances {
    pub(super) relative: f64,
    absolute: Tolerance,
}

impl Tolerances {
    /// The tolerances of validated options.
    pub(super) fn new(options: &Options) -> Tolerances {
        // Far below the rounding of the state, whose error is carried from step to step, so that
        // errors stay small over 10⁵ steps.
        let relative = options.relative_tolerance.max(TIGHTEST);
        Tolerances { relative, absolute: options.absolute_tolerance.clone() }
    }

    /// rtol |yᵢ| + atolᵢ
    pub(super) fn of(&self, i: usize, y: f64) -> f64 {
        self.relative * y.abs() + self.absolute(i)
    }

    fn absolute(&self, i: usize) -> f64 {
        match &self.absolute {
            Tolerance::Scalar(tolerance) => *tolerance,
            Tolerance::Vector(tolerances) => tolerances[i],
        }
    }

    pub(super) fn largest_absolute(&self) -> f64 {
        match &self.absolute {
            Tolerance::Scalar(tolerance) => *tolerance,
            Tolerance::Vector(tolerances) => tolerances.iter().copied().fold(0.0, f64::max),
        }
    }

    /// |yᵢ| + atolᵢ/rtol
    fn size(&self, i: usize, y: f64) -> f64 {
        y.abs() + self.absolute(i) / self.relative
    }

    /// max |cᵢ|/(|yᵢ| + atolᵢ/rtol)
    fn norm(&self, c: &[f64], y: &[f64]) -> f64 {
        let inverse = match self.absolute {
            Tolerance::Scalar(absolute) => {
                let least = absolute / self.relative;
                return c.iter().zip(y).map(|(c, y)| c.abs() / (y.abs() + least)).fold(0.0, f64::max);
            }
            Tolerance::Vector(_) => |(i, (c, y)): (usize, (&f64, &f64))| c.abs() / self.size(i, *y),
        };
        c.iter().zip(y).enumerate().map(inverse).fold(0.0, f64::max)
    }

    /// The order p, at most `highest`, with the least work per unit of time: cost(p)/h(p) with h =
    /// ρ tol^{1/(p+1)}, and ρ the same for all p.
    pub(super) fn order(&self, [a, b, c]: [f64; 3], highest: Option<u32>) -> usize {
        let highest = highest.map_or(*ORDERS.end(), |highest| (highest as usize).max(2));
        let work = |p: usize| {
            let order = p as f64;
            (a + b * order + c * order * order) / self.relative.powf(1.0 / (order + 1.0))
        };
        (*ORDERS.start()..=highest).min_by(|&p, &q| work(p).total_cmp(&work(q))).unwrap_or(highest)
    }

    /// The length over which the series is accurate to the tolerance, estimated from its last two
    /// terms; infinite if both are 0.
    pub(super) fn length(&self, series: &Polynomial) -> f64 {
        let (p, y) = (series.order(), series.of_order(0));
        // Logarithms of the radius of convergence, of the factor for the tolerance, and of Jorba
        // and Zou's factor for terms that do not yet decay geometrically.
        let radius = [p - 1, p].map(|k| -self.norm(series.of_order(k), y).log2() / k as f64);
        let order = p as f64;
        let tolerance = self.relative.log2() / (order + 1.0);
        (radius[0].min(radius[1]) + tolerance - 1.01 / (order - 1.0)).exp2()
    }

    /// Whether the difference between `rates` and `slope` matters over a step of this length.
    pub(super) fn feels(&self, rates: &[f64], slope: &[f64], y: &[f64], length: f64, order: usize) -> bool {
        let allowed = DEFECT * (order + 1) as f64 * self.relative.max(ROUNDING) / length.abs();
        // Written so that a NaN counts as large.
        !rates.iter().zip(slope).zip(y).enumerate().all(|(i, ((rate, slope), y))| {
            (rate - slope).abs() <= allowed * self.size(i, *y) + ROUNDING_OF_RATES * rate.abs()
        })
    }
}
