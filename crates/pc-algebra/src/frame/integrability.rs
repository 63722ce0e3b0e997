//! Frobenius' theorem applied to the velocities that a frame allows.

use nalgebra::{DMatrix, DVector};
use pc_expr::{Expr, Weighed};

use crate::frame::frame::Frame;
use crate::identity::sample::{Neighbourhood, TRIALS};

/// Whether the velocities ẋ = b η + b_0 (3) that a frame allows are velocities of motions on submanifolds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrability {
    /// All [X_r, X_s], r, s = 0..k, are in the span of X_1..X_k at almost every point.
    ///
    /// Through each (t, x) goes one submanifold that no motion leaves: its dimension at each instant is rank
    /// b, and it moves with time according to X_0. The n − rank b constraints that the frame represents can
    /// be written f(t, x) = const.
    Integrable {
        /// rank b.
        dimension: usize,
    },
    /// The commutator of this pair of operators lies outside the span; 0 is time.
    NotIntegrable {
        /// The first such pair r < s.
        pair: (usize, usize),
        /// The largest distance of this commutator from the span, relative to the terms of \[X_r, X_s\], with
        /// each coordinate and each operator in its own units.
        residual: f64,
    },
}

impl<'g> Frame<'g> {
    /// Frobenius' test, time included: the fields X_0, X_1..X_k on the space of (t, x) are integrable if and
    /// only if their commutators are in their span; since \[X_r, X_s\] has no ∂/∂t, this is the span of
    /// X_1..X_k.
    ///
    /// The rank is the rank at almost all points, determined as by [`pc_expr::Graph::generic_rank`]; if the
    /// graph knows too little about the functions involved, a residual at points of `near` decides. Unlike
    /// [`structure_coefficients`](Frame::structure_coefficients), this method accepts frames of any rank.
    ///
    /// To ask whether constraints η_α = 0 are holonomic, [restrict](Frame::restricted) the frame to the other
    /// operators.
    ///
    /// ```
    /// # use pc_algebra::{Frame, Integrability, Neighbourhood};
    /// # use pc_expr::Graph;
    /// // A blade on ice: the velocity (ẋ, ẏ) = v (cos φ, sin φ), φ̇ = w. The lost direction is [X_1, X_2].
    /// let graph = Graph::new();
    /// let [t, x, y, phi, v, w] = graph.symbols(["t", "x", "y", "phi", "v", "w"]);
    /// let velocities = [v * phi.cos(), v * phi.sin(), w];
    /// let blade = Frame::from_velocities(&graph, t, vec![x, y, phi], &[v, w], &velocities)?;
    /// let verdict = blade.integrability(&Neighbourhood::default());
    /// assert!(matches!(verdict, Integrability::NotIntegrable { pair: (1, 2), .. }));
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn integrability(&self, near: &Neighbourhood<'g>) -> Integrability {
        let columns = self.b().transpose().to_rows();
        let rank = self.graph().generic_rank(&columns);
        for pair in self.coupled_pairs() {
            let terms = self.commutator_terms(pair.0, pair.1);
            let commutator: Vec<Expr<'g>> = terms.iter().map(|&[forth, back]| forth + back).collect();
            if commutator.iter().all(|x| x.is_zero()) {
                continue;
            }
            let extended = [columns.as_slice(), std::slice::from_ref(&commutator)].concat();
            if self.graph().generic_rank(&extended) == rank {
                continue;
            }
            let residual = self.distance_from_span(&terms, near);
            if residual > Neighbourhood::ROUNDING {
                return Integrability::NotIntegrable { pair, residual };
            }
        }
        Integrability::Integrable { dimension: rank }
    }

    /// The largest distance of an operator from the span of X_1..X_k, relative to the terms of its
    /// components, each of which is a sum of two.
    fn distance_from_span(&self, y: &[[Expr<'g>; 2]], near: &Neighbourhood<'g>) -> f64 {
        let (n, k) = (self.b().rows(), self.operators());
        let outputs: Vec<Expr<'g>> = self.b().entries().iter().chain(y.as_flattened()).copied().collect();
        let samples = near.weighed(self.graph(), &outputs, TRIALS);
        if samples.is_empty() {
            return f64::INFINITY;
        }
        let distance = |values: &Vec<Weighed>| {
            let b = DMatrix::from_fn(n, k, |i, s| values[i * k + s].value);
            let y = DVector::from_fn(n, |i, _| {
                let sum = values[n * k + 2 * i] + values[n * k + 2 * i + 1];
                (sum.value, sum.size())
            });
            scaled_distance(b, &y.map(|(value, _)| value), &y.map(|(_, size)| size))
        };
        samples.iter().map(distance).fold(0.0, f64::max)
    }
}

/// The distance of y from the span of the columns of b, relative to the `size` of the terms of y. The columns
/// and y, then the rows, are first scaled to size one, which makes the distance independent of units.
fn scaled_distance(mut b: DMatrix<f64>, y: &DVector<f64>, size: &DVector<f64>) -> f64 {
    let largest = size.amax();
    if largest == 0.0 {
        return 0.0;
    }
    let (mut y, mut size) = (y / largest, size / largest);
    for mut column in b.column_iter_mut().filter(|column| column.amax() > 0.0) {
        column /= column.amax();
    }
    for (i, mut row) in b.row_iter_mut().enumerate() {
        let unit = row.iter().fold(size[i], |unit, entry| unit.max(entry.abs()));
        if unit > 0.0 {
            row /= unit;
            y[i] /= unit;
            size[i] /= unit;
        }
    }
    for mut column in b.column_iter_mut().filter(|column| column.amax() > 0.0) {
        column /= column.norm();
    }
    let mut outside = y.clone();
    if b.ncols() > 0 {
        let svd = b.svd(true, false);
        let kept = svd.singular_values.iter().map(|s| *s > 1e-10 * svd.singular_values.max());
        for (u, _) in svd.u.iter().flat_map(|u| u.column_iter()).zip(kept).filter(|(_, kept)| *kept) {
            outside -= u * u.dot(&y);
        }
    }
    outside.amax() / size.amax()
}
