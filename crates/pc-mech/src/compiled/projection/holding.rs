//! Projection onto the surface with some components of the state unchanged.

use pc_algebra::Matrix;

use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::point::Point;
use crate::compiled::projection::constraint_manifold::{MOST_STEPS, Part, Surface};
use crate::numeric::least_squares::LeastSquares;

/// A combination of rows this small relative to the rows is treated as rounding error.
pub(crate) const DEPENDENT: f64 = 1e-12;

/// The corresponding bound near states where constraints become dependent.
pub(super) const NEARLY_DEPENDENT: f64 = 1e-7;

/// A step this short relative to the state is treated as rounding error.
const SHORT: f64 = 1e-13;

/// The components of a state (x, η) that stay unchanged, by their indices among the x and among the η.
#[derive(Clone, Debug, Default)]
pub(crate) struct PrescribedComponents<'a> {
    pub(crate) coordinates: &'a [usize],
    pub(crate) quasi_velocities: &'a [usize],
}

impl Surface {
    /// Moves the components of `y` that are not `held` onto the surface, x first and then η, by the shortest
    /// steps δπ in the kinetic metric with
    ///
    ///   (∂f/∂π) δπ = −f,   (b δπ)_i = 0 for the x_i held,   and   C δη = −g,   δη_s = 0 for the η_s held.
    ///
    /// # Errors
    /// [`EvaluationFailure::NoProjection`] if no step leads closer; [`EvaluationFailure::Constraint`] for a
    /// constraint that involves held components alone.
    pub(crate) fn project_holding(
        &mut self,
        (t, y, p): (f64, &mut [f64], &[f64]),
        held: &PrescribedComponents<'_>,
    ) -> Result<(), EvaluationFailure> {
        if !self.places.is_empty() {
            self.project_part_holding(Part::Position, (t, y, p), held)?;
        }
        self.project_part_holding(Part::Velocity, (t, y, p), held)
    }

    fn project_part_holding(
        &mut self,
        part: Part,
        (t, y, p): (f64, &mut [f64], &[f64]),
        held: &PrescribedComponents<'_>,
    ) -> Result<(), EvaluationFailure> {
        let n = self.coordinates;
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, value| size.max(value.abs()));
        for _ in 0..MOST_STEPS {
            self.measured(part).try_eval(Point { t, y, p })?;
            if self.measured(part).in_errors() <= 1.0 {
                return Ok(());
            }
            self.bordered.eval(t, y, p, &mut self.entries);
            check_finite(&self.entries, &self.bordered, Point { t, y, p })?;
            let fixed = match part {
                Part::Position => self.displacements_of(held.coordinates, Point { t, y, p }),
                Part::Velocity => self.units(held.quasi_velocities),
            };
            let step = self.shortest(part, fixed)?;
            self.change[..self.k].copy_from_slice(&step);
            let range = if part == Part::Position { 0..n } else { n..n + self.k };
            let mut moved = Vec::new();
            self.move_by(part, Point { t, y, p }, &mut moved);
            let still = match part {
                Part::Position => held.coordinates,
                Part::Velocity => held.quasi_velocities,
            };
            for (i, (y, moved)) in y[range.clone()].iter_mut().zip(&moved).enumerate() {
                *y += if still.contains(&i) { 0.0 } else { *moved };
            }
            if largest(&moved) <= SHORT * largest(&y[range]) {
                return Ok(());
            }
        }
        Err(EvaluationFailure::NoProjection { unknowns: self.k })
    }

    /// The rows b_i of some coordinates.
    fn displacements_of(&mut self, coordinates: &[usize], Point { t, y, p }: Point<'_>) -> Vec<Vec<f64>> {
        let n = self.coordinates;
        let mut rows = vec![vec![0.0; self.k]; coordinates.len()];
        let mut column = vec![0.0; n];
        for s in 0..if coordinates.is_empty() { 0 } else { self.k } {
            self.displaced[..n].copy_from_slice(&y[..n]);
            self.displaced[n..n + self.k].fill(0.0);
            self.displaced[n + self.k..].copy_from_slice(&y[n + self.k..]);
            self.displaced[n + s] = 1.0;
            self.displacements.eval(t, &self.displaced, p, &mut column);
            rows.iter_mut().zip(coordinates).for_each(|(row, &i)| row[s] = column[i]);
        }
        rows
    }

    fn units(&self, held: &[usize]) -> Vec<Vec<f64>> {
        held.iter().map(|&held| (0..self.k).map(|s| f64::from(u8::from(s == held))).collect()).collect()
    }

    /// The δ with the least ½ δᵀ M δ that solves the linearised conditions for a part and satisfies `fixed` ·
    /// δ = 0, from
    ///
    ///   M δ + Aᵀ μ = 0,   A δ = α,
    ///
    /// measured in units in which the diagonal of M, and the rows of A, have length one.
    fn shortest(&self, part: Part, fixed: Vec<Vec<f64>>) -> Result<Vec<f64>, EvaluationFailure> {
        let k = self.k;
        let mut mass = vec![vec![0.0; k]; k];
        let mut c = vec![vec![0.0; k]; self.velocities.values().len()];
        for ((i, j), &entry) in self.lower.entries().zip(&self.entries) {
            match i.checked_sub(k) {
                Some(a) if j < k => c[a][j] = -entry,
                Some(_) => {}
                None => (mass[i][j], mass[j][i]) = (entry, entry),
            }
        }
        let diagonal = || (0..k).map(|s| mass[s][s].abs());
        let lightest = diagonal().filter(|&mass| mass > 0.0).fold(f64::INFINITY, f64::min);
        let lightest = if lightest.is_finite() { lightest } else { 1.0 };
        let units: Vec<f64> =
            diagonal().map(|mass| if mass > 0.0 { mass } else { lightest }.sqrt().recip()).collect();
        let (indices, values) = match part {
            Part::Position => (self.places.clone(), self.positions.values()),
            Part::Velocity => ((0..c.len()).collect(), self.velocities.values()),
        };
        let demanded = indices.iter().map(|&a| c[a].clone()).zip(values.iter().map(|value| -value));
        let held = fixed.len();
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for (row, value) in fixed.into_iter().zip(std::iter::repeat(0.0)).chain(demanded) {
            let row: Vec<f64> = row.iter().zip(&units).map(|(entry, unit)| entry * unit).collect();
            let size = row.iter().fold(0.0f64, |size, entry| size.hypot(*entry));
            let size = if size > 0.0 { size } else { 1.0 };
            rows.push(row.iter().map(|entry| entry / size).collect::<Vec<_>>());
            right.push(value / size);
        }
        let failed = |_| EvaluationFailure::NoProjection { unknowns: k };
        let rank = |count: usize| -> Result<usize, EvaluationFailure> {
            let first = Matrix::from_fn(count, k, |a, s| rows[a][s]);
            Ok(LeastSquares::of(&first).map_err(failed)?.rank(DEPENDENT))
        };
        let of_held = rank(held)?;
        // With dependent constraints, one on held components alone cannot be identified.
        let dependent = c.len() - self.rank;
        if rank(rows.len())? + dependent < of_held + indices.len() {
            let mut before = of_held;
            for (place, &index) in indices.iter().enumerate() {
                let now = rank(held + place + 1)?;
                if now == before {
                    return Err(EvaluationFailure::Constraint { index: k + index });
                }
                before = now;
            }
        }
        let bordered = Matrix::from_fn(k + rows.len(), k + rows.len(), |i, j| match (i < k, j < k) {
            (true, true) => mass[i][j] * units[i] * units[j],
            (false, true) => rows[i - k][j],
            (true, false) => rows[j - k][i],
            (false, false) => 0.0,
        });
        let right: Vec<f64> = std::iter::repeat_n(0.0, k).chain(right).collect();
        let solved = LeastSquares::of(&bordered)
            .map_err(failed)?
            .shortest(&right, if dependent > 0 { NEARLY_DEPENDENT } else { DEPENDENT });
        Ok(solved[..k].iter().zip(&units).map(|(step, unit)| step * unit).collect())
    }
}
