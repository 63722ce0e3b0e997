//! Velocities that satisfy the constraints; some of the velocities keep their values as far as the
//! constraints allow.

use pc_algebra::Matrix;

use crate::compiled::failure::EvaluationFailure;
use crate::compiled::point::Point;
use crate::compiled::projection::constraint_manifold::{MOST_STEPS, Part, Surface};
use crate::compiled::projection::holding::{DEPENDENT, NEARLY_DEPENDENT};
use crate::compiled::projection::nearest::{Coefficients, dot};
use crate::error::MechError;
use crate::numeric::least_squares::LeastSquares;

/// A step this short relative to the velocities is treated as rounding error.
const SHORT: f64 = 1e-14;

impl Surface {
    /// Moves the η of `y` to g = 0, and the `held` ones only as far as necessary: among all δη with C δη = −g, it
    /// takes those that change the held η least, and among these the shortest, in the kinetic metric.
    ///
    /// # Errors
    /// [`EvaluationFailure::NoProjection`] if no such steps lead to g = 0.
    pub(crate) fn project_velocities_holding(
        &mut self,
        (t, y, p): (f64, &mut [f64], &[f64]),
        held: &[usize],
    ) -> Result<(), EvaluationFailure> {
        if held.is_empty() || (0..self.k).all(|s| held.contains(&s)) {
            return self.project_velocities(t, y, p);
        }
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, value| size.max(value.abs()));
        let (moving, mut last) = (self.moving(), f64::INFINITY);
        for _ in 0..MOST_STEPS {
            self.measured(Part::Velocity).try_eval(Point { t, y, p })?;
            if self.measured(Part::Velocity).in_errors() <= 1.0 {
                return Ok(());
            }
            let coefficients = self.coefficients(Point { t, y, p })?;
            let step = self.least_change(&coefficients, held)?;
            let eta = &mut y[moving.clone()];
            eta.iter_mut().zip(&step).for_each(|(eta, step)| *eta += step);
            // Where g is affine one step leads there, and further steps correct its rounding errors.
            let length = largest(&step);
            if length <= SHORT * largest(eta) || (self.affine && length >= last) {
                return Ok(());
            }
            last = length;
        }
        Err(EvaluationFailure::NoProjection { unknowns: self.k })
    }

    /// The step for the current g, in units in which masses are one. If H are the held indices and F the
    /// others,
    ///
    ///   N C_H δ_H = −N g,   C_F δ_F = −g − C_H δ_H,
    ///
    /// where N is the projection onto the combinations of constraints that C_F does not affect: the conditions
    /// on held velocities alone.
    fn least_change(
        &mut self,
        Coefficients { mass, constraints }: &Coefficients,
        held: &[usize],
    ) -> Result<Vec<f64>, EvaluationFailure> {
        self.weigh();
        let m = constraints.len();
        let tolerance = if self.rank < m { NEARLY_DEPENDENT } else { DEPENDENT };
        let failed = |_| EvaluationFailure::NoProjection { unknowns: self.k };
        let units: Vec<f64> = self.weights.iter().map(|weight| weight.sqrt().recip()).collect();
        let length = |row: &Vec<f64>| row.iter().zip(&units).map(|(c, unit)| c * unit).fold(0.0, f64::hypot);
        let lengths: Vec<f64> =
            constraints.iter().map(length).map(|l| if l > 0.0 { l } else { 1.0 }).collect();
        let of = |a: usize, s: usize| constraints[a][s] * units[s] / lengths[a];
        let right: Vec<f64> =
            self.velocities.values().iter().zip(&lengths).map(|(value, length)| -value / length).collect();
        let free: Vec<usize> = (0..self.k).filter(|s| !held.contains(s)).collect();
        let block = |rows: &[usize], columns: &[usize]| {
            let entry = |i: usize, j: usize| mass[rows[i]][columns[j]] * units[rows[i]] * units[columns[j]];
            Matrix::from_fn(rows.len(), columns.len(), entry)
        };

        // Rows of C have length one, so such entries are rounding errors.
        let beside = |entry: f64| if entry.abs() <= DEPENDENT { 0.0 } else { entry };
        let of_free = Matrix::from_fn(m, free.len(), |a, f| beside(of(a, free[f])));
        let reached = LeastSquares::of(&of_free).map_err(failed)?;
        // N v, without its rounding errors.
        let beyond = |v: &[f64], size: f64| -> Vec<f64> {
            let nearest = reached.shortest(v, tolerance);
            let rest = v.iter().enumerate().map(|(a, v)| v - dot(&of_free.row(a), &nearest));
            rest.map(|rest| if rest.abs() <= tolerance * size { 0.0 } else { rest }).collect()
        };
        let columns: Vec<Vec<f64>> =
            held.iter().map(|&s| beyond(&(0..m).map(|a| of(a, s)).collect::<Vec<_>>(), 1.0)).collect();
        let on_held = Matrix::from_fn(m, held.len(), |a, h| columns[h][a]);
        let pull = vec![0.0; held.len()];
        let of_held =
            shortest(&block(held, held), &pull, &on_held, &beyond(&right, 0.0), tolerance).map_err(failed)?;

        let pull: Vec<f64> = block(&free, held).to_rows().iter().map(|row| -dot(row, &of_held)).collect();
        let taken = |a: usize| held.iter().zip(&of_held).map(|(&s, step)| of(a, s) * step).sum::<f64>();
        let left: Vec<f64> = right.iter().enumerate().map(|(a, right)| right - taken(a)).collect();
        let of_others = shortest(&block(&free, &free), &pull, &of_free, &left, tolerance).map_err(failed)?;

        let mut step = vec![0.0; self.k];
        for (&s, change) in held.iter().zip(of_held).chain(free.iter().zip(of_others)) {
            step[s] = change * units[s];
        }
        Ok(step)
    }
}

/// Among the δ that come closest to solving A δ = α, the one with the least ½ δᵀ M δ − pᵀ δ,
///
///   M δ + Aᵀ μ = p,   A δ = α,
///
/// with the rows of A scaled to length one.
fn shortest(
    mass: &Matrix<f64>,
    pull: &[f64],
    rows: &Matrix<f64>,
    right: &[f64],
    tolerance: f64,
) -> Result<Vec<f64>, MechError> {
    let (k, m) = (mass.rows(), rows.rows());
    let length = |a: usize| rows.row(a).iter().fold(0.0f64, |length, entry| length.hypot(*entry));
    let lengths: Vec<f64> =
        (0..m).map(length).map(|length| if length > 0.0 { length } else { 1.0 }).collect();
    let bordered = Matrix::from_fn(k + m, k + m, |i, j| match (i < k, j < k) {
        (true, true) => mass[(i, j)],
        (false, true) => rows[(i - k, j)] / lengths[i - k],
        (true, false) => rows[(j - k, i)] / lengths[j - k],
        (false, false) => 0.0,
    });
    let right = pull.iter().copied().chain(right.iter().zip(&lengths).map(|(right, length)| right / length));
    let mut solved = LeastSquares::of(&bordered)?.shortest(&right.collect::<Vec<f64>>(), tolerance);
    solved.truncate(k);
    Ok(solved)
}
