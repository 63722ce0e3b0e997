//! Integrals by the quadrature of Gauss and Legendre.

/// The number of nodes: polynomials of degree 2 NODES − 1 are integrated exactly.
const NODES: usize = 24;
/// The steps of Newton's method for a node, from a start with some correct digits.
const STEPS: usize = 8;

/// Halves of an interval are integrated by themselves until they agree with the whole to this fraction.
const ENOUGH: f64 = 1e-14;
/// An interval is halved at most so often.
const HALVINGS: usize = 12;

/// The integrals of several functions from a to b; `f` writes their values at a point.
pub(super) fn integral(interval: (f64, f64), functions: usize, f: impl FnMut(f64, &mut [f64])) -> Vec<f64> {
    let mut rule = Rule { nodes: (1..=NODES).map(node).collect(), functions, f };
    let whole = rule.over(interval);
    rule.halved(interval, &whole, HALVINGS)
}

/// The nodes with their weights, and the functions.
struct Rule<F> {
    nodes: Vec<(f64, f64)>,
    functions: usize,
    f: F,
}

impl<F: FnMut(f64, &mut [f64])> Rule<F> {
    /// The sum of the integrals over both halves, each halved again where it differs from the `whole`.
    fn halved(&mut self, (a, b): (f64, f64), whole: &[f64], most: usize) -> Vec<f64> {
        let centre = (a + b) / 2.0;
        let (left, right) = (self.over((a, centre)), self.over((centre, b)));
        let sum: Vec<f64> = left.iter().zip(&right).map(|(left, right)| left + right).collect();
        let size = sum.iter().zip(whole).fold(0.0f64, |size, (a, b)| size.max(a.abs()).max(b.abs()));
        let agree = |(sum, whole): (&f64, &f64)| {
            !sum.is_finite() || (sum - whole).abs() <= ENOUGH * (sum.abs() + whole.abs() + size)
        };
        if most == 0 || sum.iter().zip(whole).all(agree) {
            return sum;
        }
        let left = self.halved((a, centre), &left, most - 1);
        let right = self.halved((centre, b), &right, most - 1);
        left.iter().zip(&right).map(|(left, right)| left + right).collect()
    }

    /// The integrals by the nodes of one interval.
    fn over(&mut self, (a, b): (f64, f64)) -> Vec<f64> {
        let (centre, half) = ((a + b) / 2.0, (b - a) / 2.0);
        let (mut sums, mut values) = (vec![0.0; self.functions], vec![0.0; self.functions]);
        for &(node, weight) in &self.nodes {
            (self.f)(centre + half * node, &mut values);
            sums.iter_mut().zip(&values).for_each(|(sum, value)| *sum += half * weight * value);
        }
        sums
    }
}

/// Zero number i of Legendre's polynomial P of degree n, with its weight 2/((1 − x²) P′²).
fn node(i: usize) -> (f64, f64) {
    let n = NODES as f64;
    let mut x = (std::f64::consts::PI * (i as f64 - 0.25) / (n + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..STEPS {
        // (k + 1) P_{k+1} = (2k + 1) x P_k − k P_{k−1}
        let (mut before, mut value) = (1.0, x);
        for k in 1..NODES {
            let k = k as f64;
            (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
        }
        slope = n * (x * value - before) / (x * x - 1.0);
        x -= value / slope;
    }
    (x, 2.0 / ((1.0 - x * x) * slope * slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_functions_are_integrated_to_rounding() {
        let found = integral((0.5, 2.0), 2, |x, values| values.copy_from_slice(&[x.exp(), x.powi(46)]));
        let expected = [2f64.exp() - 0.5f64.exp(), (2f64.powi(47) - 0.5f64.powi(47)) / 47.0];
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() < 1e-13 * b, "{a} is {b}");
        }
    }

    #[test]
    fn long_intervals_are_halved() {
        let found = integral((0.0, 100.0), 1, |x, values| values[0] = x.cos().powi(2));
        let expected = 50.0 + 200f64.sin() / 4.0;
        assert!((found[0] - expected).abs() < 1e-12, "{found:?} is {expected}");
    }
}
