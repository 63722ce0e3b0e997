//! A smooth motion represented by a polynomial whose rates agree with the field away from the middle of the
//! interval.

use std::ops::Range;
use std::sync::LazyLock;

use pc_algebra::Matrix;

use crate::numeric::least_squares::LeastSquares;

/// The number of terms of the rates.
const TERMS: usize = 8;

/// The nodes on either side of the middle: the zeros of Legendre's P_5, shifted to the interval from 0 to 1 and
/// mapped to the outer part of each half.
const NODES: [f64; 5] = [0.046910077030668, 0.2307653449471585, 0.5, 0.7692346550528415, 0.953089922969332];

/// The fraction of the interval, around its middle, that contains no node, since rates lose digits there.
const MIDDLE: f64 = 0.4;

/// The maximum number of iterations: each gains more digits the shorter the interval.
const MOST_ITERATIONS: usize = 20;

/// How many times the remaining distance may grow before the iteration is given up.
const MOST_RETURNS: usize = 2;

/// The motion y(t) from y(a) to t = b with x = 2 (t − a)/(b − a) − 1 and
///
///   ẏ = Σ_j g_j P_j(x),   y = y(a) + (b − a) Σ_j g_j (P_{j+1}(x) − P_{j−1}(x))/(4j + 2),
///
/// with Legendre polynomials P_j and P_{−1} = −1. The rates are fitted to the field at the nodes by least
/// squares.
#[derive(Clone, Debug)]
pub(crate) struct Collocation {
    pub(crate) start: f64,
    pub(crate) end: f64,
    from: Vec<f64>,
    /// g_j
    series: Vec<Vec<f64>>,
    /// The largest absolute value among the components of each group.
    sizes: Vec<(Range<usize>, f64)>,
}

/// The flow that defines a motion: moves a state at a given time to the nearest admissible one and writes the rates
/// there; false if it cannot.
pub(crate) type Flow<'a> = dyn FnMut(f64, &mut [f64], &mut [f64]) -> bool + 'a;

impl Collocation {
    /// The motion from (t, y) to `end`, if there is one with which `flow` agrees at all nodes to within the
    /// fraction `tolerance` of the largest component of each of the `groups`.
    pub(crate) fn new(
        flow: &mut Flow<'_>,
        (t, y): (f64, &[f64]),
        end: f64,
        groups: &[Range<usize>],
        tolerance: f64,
    ) -> Option<Collocation> {
        let (mut here, mut slope) = (y.to_vec(), vec![f64::NAN; y.len()]);
        if !flow(t, &mut here, &mut slope) {
            return None;
        }
        let mut series = vec![vec![0.0; y.len()]; TERMS];
        let length = end - t;
        let size = |group: &Range<usize>| {
            group.clone().fold(0.0f64, |size, i| size.max(y[i].abs()).max((length * slope[i]).abs()))
        };
        let sizes = groups.iter().map(|group| (group.clone(), size(group))).collect();
        series[0] = slope;
        let mut motion = Collocation { start: t, end, from: y.to_vec(), series, sizes };
        let (nodes, fit) = FIT.as_ref()?;
        let (mut last, mut returns) = (f64::INFINITY, 0);
        for _ in 0..MOST_ITERATIONS {
            let (series, moved) = motion.improved(flow, nodes, fit)?;
            let before = motion.state(end);
            motion.series = series;
            let change = motion.distance(&before, &motion.state(end));
            // Until the change is only rounding error.
            if change <= f64::EPSILON || change <= tolerance && 2.0 * change >= last {
                let ends = |j: usize| {
                    let term: Vec<f64> = motion.series[j].iter().map(|g| length * g).collect();
                    motion.distance(&term, &vec![0.0; y.len()]) <= tolerance
                };
                // In an even or odd motion every second term vanishes.
                let is_smooth = ends(TERMS - 2) && ends(TERMS - 1);
                return (is_smooth && moved <= tolerance).then_some(motion);
            }
            returns += usize::from(change > last);
            if returns == MOST_RETURNS || !change.is_finite() {
                return None;
            }
            last = change;
        }
        None
    }

    /// The Legendre series fitted to the rates at the nodes, and the longest distance by which a state was
    /// moved at a node.
    fn improved(
        &self,
        flow: &mut Flow<'_>,
        nodes: &[f64],
        fit: &LeastSquares,
    ) -> Option<(Vec<Vec<f64>>, f64)> {
        let (mut rates, mut moved) = (vec![vec![f64::NAN; self.from.len()]; nodes.len()], 0.0f64);
        for (x, rates) in nodes.iter().zip(&mut rates) {
            let t = self.start + 0.5 * (1.0 + x) * (self.end - self.start);
            let state = self.state(t);
            let mut there = state.clone();
            if !flow(t, &mut there, rates) {
                return None;
            }
            moved = larger(moved, self.distance(&state, &there));
        }
        let mut series = vec![vec![0.0; self.from.len()]; TERMS];
        for i in 0..self.from.len() {
            let component: Vec<f64> = rates.iter().map(|rates| rates[i]).collect();
            series.iter_mut().zip(fit.shortest(&component, 0.0)).for_each(|(g, found)| g[i] = found);
        }
        Some((series, moved))
    }

    /// y(t)
    pub(crate) fn state(&self, t: f64) -> Vec<f64> {
        let x = 2.0 * (t - self.start) / (self.end - self.start) - 1.0;
        let p: Vec<f64> = legendre(x).take(TERMS + 1).collect();
        let mut state = self.from.clone();
        for (j, g) in self.series.iter().enumerate() {
            let before = if j == 0 { -1.0 } else { p[j - 1] };
            let factor = (self.end - self.start) * (p[j + 1] - before) / (4 * j + 2) as f64;
            state.iter_mut().zip(g).for_each(|(y, g)| *y += factor * g);
        }
        state
    }

    /// ẏ(t)
    pub(crate) fn rates(&self, t: f64, rates: &mut [f64]) {
        let x = 2.0 * (t - self.start) / (self.end - self.start) - 1.0;
        rates.fill(0.0);
        for (g, p) in self.series.iter().zip(legendre(x)) {
            rates.iter_mut().zip(g).for_each(|(rate, g)| *rate += p * g);
        }
    }

    /// Whether a time lies in the interval of the polynomial, ends included.
    pub(crate) fn contains(&self, t: f64) -> bool {
        (t - self.start) * (t - self.end) <= 0.0
    }

    /// The distance between two states, as a fraction of the largest component of each group.
    pub(crate) fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let part = |(group, size): &(Range<usize>, f64)| {
            let apart = group.clone().map(|i| (a[i] - b[i]).abs()).fold(0.0, larger);
            if apart == 0.0 { 0.0 } else { apart / size }
        };
        self.sizes.iter().map(part).fold(0.0, larger)
    }
}

/// The positions of the nodes, and the equations Σ_j g_j P_j(x) = ẏ at them, which are the same for all motions.
static FIT: LazyLock<Option<(Vec<f64>, LeastSquares)>> = LazyLock::new(|| {
    let nodes: Vec<f64> = nodes().collect();
    let values = Matrix::from_fn(nodes.len(), TERMS, |i, j| legendre(nodes[i]).nth(j).unwrap_or(f64::NAN));
    let fit = LeastSquares::of(&values).ok()?;
    Some((nodes, fit))
});

/// The larger of two numbers; NaN if one of them is NaN, whereas f64::max would return the other.
fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// P_0(x), P_1(x), …
fn legendre(x: f64) -> impl Iterator<Item = f64> {
    let next = move |&(j, before, p): &(f64, f64, f64)| {
        Some((j + 1.0, p, ((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0)))
    };
    std::iter::successors(Some((0.0, 0.0, 1.0)), next).map(|(_, _, p)| p)
}

/// The positions x of the nodes.
fn nodes() -> impl Iterator<Item = f64> {
    let outer = NODES.map(|node| MIDDLE + (1.0 - MIDDLE) * node);
    outer.into_iter().rev().map(|x| -x).chain(outer)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ẍ = −x from (1, 0) over half a unit of time: the terms left out, from 4⁻⁸/(15·13⋯3) = 8e-12 on, are far below
    /// the last terms kept, about 1e-8, from which the error is estimated.
    #[test]
    fn an_oscillation_is_followed() {
        let mut flow = |_: f64, y: &mut [f64], rates: &mut [f64]| {
            (rates[0], rates[1]) = (y[1], -y[0]);
            true
        };
        let motion = Collocation::new(&mut flow, (0.5, &[1.0, 0.0]), 1.0, &[0..1, 1..2], 1e-7).unwrap();
        let mut rates = [0.0; 2];
        for t in [0.5, 0.7, 0.75, 1.0] {
            let (state, phase) = (motion.state(t), t - 0.5);
            motion.rates(t, &mut rates);
            assert!((state[0] - phase.cos()).abs() < 1e-11 && (state[1] + phase.sin()).abs() < 1e-11);
            assert!((rates[0] - state[1]).abs() < 1e-9 && (rates[1] + state[0]).abs() < 1e-9, "{rates:?}");
        }
        assert!(motion.contains(1.0) && motion.contains(0.5) && !motion.contains(1.1));
    }

    #[test]
    fn what_is_not_smooth_or_has_no_rates_is_refused() {
        let mut kink = |t: f64, _: &mut [f64], rates: &mut [f64]| {
            rates[0] = (t - 0.5).abs();
            true
        };
        assert!(Collocation::new(&mut kink, (0.0, &[1.0]), 1.0, &[0..1, 1..1], 1e-9).is_none());
        let mut ends = |t: f64, _: &mut [f64], rates: &mut [f64]| {
            rates[0] = 1.0;
            t < 0.5
        };
        assert!(Collocation::new(&mut ends, (0.0, &[1.0]), 1.0, &[0..1, 1..1], 1e-9).is_none());
    }
}
