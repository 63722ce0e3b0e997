//! A hanging chain: point masses on stiff damped springs, in a plane.

use pc_expr::TimeDependence;
use pc_solve::{Failure, Pattern, VectorField};

/// Mass i has position and velocity y[4 i..4 i + 4] = (x, z, ẋ, ż). Spring i, of unit length, is
/// between mass i − 1 and mass i, the first one at the origin. With d and ḋ the differences of its
/// ends, it pulls with F = `stiffness` (1 − 1/|d|) d + `damping` ḋ, and
///
/// r̈ᵢ = Fᵢ₊₁ − Fᵢ + g − `drag` ṙᵢ.
pub(crate) struct Chain {
    pub(crate) links: usize,
    pub(crate) pattern: Pattern,
    pub(crate) knows_jacobian: bool,
    pub(crate) knows_products: bool,
}

const STIFFNESS: f64 = 2e4;
const DAMPING: f64 = 50.0;
const DRAG: f64 = 0.1;
const GRAVITY: f64 = 1.0;

type Block = [[f64; 2]; 2];

fn sum(a: Block, b: Block) -> Block {
    [[a[0][0] + b[0][0], a[0][1] + b[0][1]], [a[1][0] + b[1][0], a[1][1] + b[1][1]]]
}

impl Chain {
    pub(crate) fn new(links: usize) -> Self {
        let neighbours = |mass: usize| mass.saturating_sub(1)..(mass + 2).min(links);
        let column = |j: usize| -> Vec<usize> {
            let (mass, c) = (j / 4, j % 4);
            match c {
                0 | 1 => neighbours(mass).flat_map(|i| [4 * i + 2, 4 * i + 3]).collect(),
                _ => neighbours(mass).map(|i| 4 * i + c).chain([4 * mass + c - 2]).collect(),
            }
        };
        let pattern = Pattern::from_columns(4 * links, (0..4 * links).map(column));
        Chain { links, pattern, knows_jacobian: true, knows_products: true }
    }

    /// At rest, straight, half a radian from the vertical, stretched as if it were hanging.
    pub(crate) fn start(&self) -> Vec<f64> {
        let mut length = 0.0;
        let (sin, cos) = 0.5_f64.sin_cos();
        let place = |i: usize| {
            length += 1.0 + (self.links - i) as f64 * GRAVITY / STIFFNESS;
            [length * sin, -length * cos, 0.0, 0.0]
        };
        (0..self.links).flat_map(place).collect()
    }

    /// d of spring i.
    fn difference(y: &[f64], i: usize) -> [f64; 2] {
        let end = [y[4 * i], y[4 * i + 1]];
        if i == 0 { end } else { [end[0] - y[4 * i - 4], end[1] - y[4 * i - 3]] }
    }

    /// ∂F/∂d of spring i, zero beyond the last.
    fn slope(&self, y: &[f64], i: usize) -> Block {
        if i == self.links {
            return [[0.0; 2]; 2];
        }
        let d = Chain::difference(y, i);
        let length = d[0].hypot(d[1]);
        let entry = |a: usize, b: usize| {
            let direction = d[a] * d[b] / length.powi(3);
            STIFFNESS * (if a == b { 1.0 - 1.0 / length } else { 0.0 } + direction)
        };
        [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
    }

    /// Adds the pull of each spring, given its number, d and ḋ.
    fn pull(&self, y: &[f64], ydot: &mut [f64], force: impl Fn(usize, [f64; 2], [f64; 2]) -> [f64; 2]) {
        for i in 0..self.links {
            ydot[4 * i] = y[4 * i + 2];
            ydot[4 * i + 1] = y[4 * i + 3];
            ydot[4 * i + 2] = -DRAG * y[4 * i + 2];
            ydot[4 * i + 3] = -DRAG * y[4 * i + 3];
        }
        for i in 0..self.links {
            let force = force(i, Chain::difference(y, i), Chain::difference(&y[2..], i));
            for c in 0..2 {
                ydot[4 * i + 2 + c] -= force[c];
                if i > 0 {
                    ydot[4 * i - 2 + c] += force[c];
                }
            }
        }
    }
}

impl VectorField for Chain {
    fn dim(&self) -> usize {
        4 * self.links
    }

    fn time_dependence(&self) -> TimeDependence {
        TimeDependence::Absent
    }

    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.pull(y, ydot, |_, d, ddot| {
            let pull = STIFFNESS * (1.0 - 1.0 / d[0].hypot(d[1]));
            [pull * d[0] + DAMPING * ddot[0], pull * d[1] + DAMPING * ddot[1]]
        });
        ydot.iter_mut().skip(3).step_by(4).for_each(|rate| *rate -= GRAVITY);
        Ok(())
    }

    fn has_jacobian(&self) -> bool {
        self.knows_jacobian
    }

    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        let mut values = vec![0.0; self.pattern.len()];
        self.sparse_jacobian(t, y, &mut values)?;
        self.pattern.scatter(&values, jacobian);
        Ok(())
    }

    fn sparsity(&self) -> Option<&Pattern> {
        Some(&self.pattern)
    }

    fn sparse_jacobian(&mut self, _t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let mut values = values.iter_mut();
        let mut write =
            |numbers: &[f64]| values.by_ref().zip(numbers).for_each(|(value, number)| *value = *number);
        let mut above = self.slope(y, 0);
        for i in 0..self.links {
            let below = self.slope(y, i + 1);
            let (first, last) = (i == 0, i + 1 == self.links);
            let here = sum(above, below);
            for c in 0..2 {
                let (before, after) = ([above[0][c], above[1][c]], [below[0][c], below[1][c]]);
                write(if first { &[] } else { &before });
                write(&[-here[0][c], -here[1][c]]);
                write(if last { &[] } else { &after });
            }
            for _ in 0..2 {
                write(if first { &[] } else { &[DAMPING] });
                write(&[1.0, -DRAG - if last { DAMPING } else { 2.0 * DAMPING }]);
                write(if last { &[] } else { &[DAMPING] });
            }
            above = below;
        }
        Ok(())
    }

    fn has_jvp(&self) -> bool {
        self.knows_products
    }

    fn jvp(&mut self, _t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        self.pull(v, product, |i, d, ddot| {
            let slope = self.slope(y, i);
            [0, 1].map(|c| slope[c][0] * d[0] + slope[c][1] * d[1] + DAMPING * ddot[c])
        });
        Ok(())
    }
}
