//! Numerical search for states near a given one that satisfy conditions on positions.

use pc_mech::{Expr, Graph, LeastSquares, Matrix, System};

/// The largest number of steps towards a nearby point that satisfies the conditions; the convergence is
/// quadratic in the end.
const MOST_STEPS: usize = 60;

/// The largest number of times that a step is shortened if it brings no improvement.
const SHORTENINGS: usize = 12;

/// The residual, in units of displacements, that rounding errors leave in conditions that are satisfied.
const SATISFIED: f64 = 1e-11;

/// The relative amount by which the coordinates are varied.
const VARIED: f64 = 0.01;

/// Coordinates smaller than this fraction of the largest coordinate are varied as if they were of that size.
const LEAST: f64 = 0.1;

/// Conditions f(t, x) = 0 on the positions of a system, possibly dependent on each other.
pub(crate) struct Positions<'g> {
    graph: &'g Graph,
    time: Expr<'g>,
    x: Vec<Expr<'g>>,
    /// The functions f, then their derivatives ∂f/∂x, row by row.
    values: Vec<Expr<'g>>,
    count: usize,
    parameters: Vec<(Expr<'g>, f64)>,
}

/// A time, and the coordinates at that time.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub(crate) t: f64,
    pub(crate) x: Vec<f64>,
}

impl Place {
    /// A point near this one, different for each `index` but the same in every run.
    pub(crate) fn varied(&self, index: u64) -> Place {
        let scale = self.scale();
        let mut random = Random(index.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d);
        let mut vary = |x: f64| x + VARIED * x.abs().clamp(LEAST * scale, 1.0) * random.next();
        Place { t: vary(self.t), x: self.x.iter().map(|&x| vary(x)).collect() }
    }

    /// The magnitude of the largest coordinate, but at most 1; 1 if all are zero.
    fn scale(&self) -> f64 {
        let largest = self.x.iter().fold(0.0f64, |size, x| size.max(x.abs()));
        if largest == 0.0 { 1.0 } else { largest.min(1.0) }
    }
}

impl<'g> Positions<'g> {
    pub(crate) fn new(system: &System<'g>, functions: &[Expr<'g>]) -> Positions<'g> {
        let (graph, frame) = (system.graph(), system.frame());
        let x = frame.coordinates().to_vec();
        let slopes = functions.iter().flat_map(|&f| graph.gradient(f, &x));
        let values = functions.iter().copied().chain(slopes.collect::<Vec<_>>()).collect();
        let parameters = system.parameters().to_vec();
        Positions { graph, time: frame.time(), x, values, count: functions.len(), parameters }
    }

    /// The values, at a point, of expressions in time, coordinates and parameters; `None` if one is not
    /// finite.
    pub(crate) fn evaluate(&self, expressions: &[Expr<'g>], at: &Place) -> Option<Vec<f64>> {
        let state = self.x.iter().copied().zip(at.x.iter().copied());
        let values: Vec<_> =
            self.parameters.iter().copied().chain([(self.time, at.t)]).chain(state).collect();
        let found = self.graph.evaluate(expressions, &values).ok()?;
        found.iter().all(|value| value.is_finite()).then_some(found)
    }

    /// The values of f and ∂f/∂x, each row divided by its entry in `sizes`.
    fn at(&self, place: &Place, sizes: &[f64]) -> Option<(Vec<f64>, Matrix<f64>)> {
        let values = self.evaluate(&self.values, place)?;
        let (f, slopes) = values.split_at(self.count);
        let n = self.x.len();
        Some((
            f.iter().zip(sizes).map(|(f, size)| f / size).collect(),
            Matrix::from_fn(self.count, n, |a, i| slopes[a * n + i] / sizes[a]),
        ))
    }

    /// The lengths of the rows ∂f/∂x at a point; 1 for a row that vanishes.
    fn sizes(&self, place: &Place) -> Option<Vec<f64>> {
        let values = self.evaluate(&self.values, place)?;
        let length = |row: &[f64]| row.iter().fold(0.0f64, |size, entry| size.hypot(*entry));
        let sizes = values[self.count..].chunks(self.x.len().max(1)).map(length);
        Some(sizes.map(|size| if size > 0.0 { size } else { 1.0 }).collect())
    }

    /// The distance of f from zero, in units of displacements; infinite where f has no value.
    pub(crate) fn off(&self, place: &Place) -> f64 {
        let found = self.sizes(place).and_then(|sizes| self.at(place, &sizes));
        found.map_or(f64::INFINITY, |(f, _)| norm(&f) / place.scale())
    }

    /// A point near `start`, at the same time, where f = 0, found by Levenberg and Marquardt's method with μ =
    /// |f|²: it converges quadratically even if ∂f/∂x loses rank where f = 0 [N. Yamashita, M. Fukushima,
    /// Computing Suppl. 15 (2001) 239–249]. `None` if it does not converge.
    pub(crate) fn near(&self, start: &Place) -> Option<Place> {
        let (scale, sizes) = (start.scale(), self.sizes(start)?);
        let mut place = start.clone();
        let (mut f, mut slopes) = self.at(&place, &sizes)?;
        for _ in 0..MOST_STEPS {
            let residual = norm(&f);
            if residual == 0.0 {
                break;
            }
            let equations = LeastSquares::of(&slopes).ok()?;
            let mut mu = (residual / scale).powi(2);
            let shorter = (0..SHORTENINGS).find_map(|_| {
                let step = equations.damped(&f, mu);
                let x = place.x.iter().zip(&step).map(|(x, step)| x - step).collect();
                let next = Place { x, ..place };
                mu *= 10.0;
                let (f, slopes) = self.at(&next, &sizes)?;
                (norm(&f) < residual).then_some((next, f, slopes))
            });
            let Some(next) = shorter else { break };
            (place, f, slopes) = next;
        }
        (norm(&f) <= SATISFIED * scale).then_some(place)
    }
}

pub(crate) fn norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |size, value| size.hypot(*value))
}

/// The random number generator splitmix64, uniform in (−1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
