//! Decides whether constraints hold where they lose rank.

use pc_algebra::Matrix;

use crate::compiled::chart::determinant;
use crate::compiled::elimination::saddle_point::Independence;
use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::point::Point;
use crate::compiled::projection::constraint_manifold::{Spans, Surface};
use crate::compiled::projection::nearest::dot;
use crate::numeric::singular_values::SingularValues;

/// The residual that rounding may cause, as a multiple of the combined bounds of the constraints.
const ROUNDINGS: f64 = 2.0;

/// If a singular value of the constraints, with rows scaled to length 1, has fallen to this fraction, the rank is
/// lost.
const FALLEN: f64 = 0.2;

impl Surface {
    /// Whether the constraints on positions hold at a state near which they lose rank, in those combinations u, with uᵀ
    /// C ≈ 0, that restrict no velocity there: then surfaces cross near this state. Otherwise two sheets pass each
    /// other there, and the residual uᵀ f is the gap between them. `before` is a state at which the rank is still full.
    pub(crate) fn crosses(&mut self, at: Point<'_>, before: Point<'_>) -> Result<bool, EvaluationFailure> {
        let rows = self.rows(before)?;
        let lengths: Vec<f64> = (0..rows.rows()).map(|a| length(&rows.row(a))).collect();
        let of_length_1 = |rows: &Matrix<f64>| {
            Matrix::from_fn(rows.rows(), rows.columns(), |a, s| rows[(a, s)] / lengths[a])
        };
        let full = singular(&of_length_1(&rows))?;
        let found = singular(&of_length_1(&self.rows(at)?))?;
        self.positions.try_eval(at)?;
        for (a, (value, was)) in found.values.iter().zip(&full.values).enumerate() {
            if *value > FALLEN * was {
                continue;
            }
            let (mut residual, mut bound) = (0.0, 0.0);
            let conditions = self.positions.values().iter().zip(self.positions.errors());
            for (&place, (f, error)) in self.places.iter().zip(conditions) {
                let u = found.left[(place, a)] / lengths[place];
                residual += u * f;
                bound += u.abs() * error;
            }
            if residual.abs() > ROUNDINGS * bound {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether the space spanned by the independent constraints has the opposite orientation at the later state. The
    /// space turns by less than a right angle between the two states, so that det C C'ᵀ > 0, unless rank is lost in
    /// between.
    pub(crate) fn is_reversed(
        &mut self,
        (before, from): (&Independence, Point<'_>),
        (later, to): (&Independence, Point<'_>),
    ) -> Result<bool, EvaluationFailure> {
        if let Some(is_reversed) = before.is_reversed(later) {
            return Ok(is_reversed);
        }
        let mut spans = std::mem::take(&mut self.spans);
        let orientation = self.orientation(&mut spans, &later.rows, from, to);
        self.spans = spans;
        Ok(orientation? <= 0.0)
    }

    /// The determinant det C C'ᵀ of these rows.
    fn orientation(
        &mut self,
        Spans { before, later, products }: &mut Spans,
        independent: &[usize],
        from: Point<'_>,
        to: Point<'_>,
    ) -> Result<f64, EvaluationFailure> {
        self.write_rows(from, before)?;
        self.write_rows(to, later)?;
        let row = |a: &usize| a * self.k..(a + 1) * self.k;
        products.clear();
        for a in independent {
            products.extend(independent.iter().map(|b| dot(&before[row(a)], &later[row(b)])));
        }
        Ok(determinant(products, independent.len()))
    }

    /// The rows of C, with each unknown in units in which its mass is 1.
    fn rows(&mut self, at: Point<'_>) -> Result<Matrix<f64>, EvaluationFailure> {
        let mut rows = Vec::new();
        self.write_rows(at, &mut rows)?;
        Ok(Matrix::from_fn(rows.len() / self.k, self.k, |a, s| rows[a * self.k + s]))
    }

    /// Writes the rows of C, one after the other.
    fn write_rows(&mut self, at: Point<'_>, rows: &mut Vec<f64>) -> Result<(), EvaluationFailure> {
        let k = self.k;
        rows.clear();
        rows.resize(self.velocities.values().len() * k, 0.0);
        self.bordered.eval(at.t, at.y, at.p, &mut self.entries);
        check_finite(&self.entries, &self.bordered, at)?;
        self.weigh();
        for ((i, s), &entry) in self.lower.entries().zip(&self.entries) {
            if i >= k && s < k {
                rows[(i - k) * k + s] = -entry / self.weights[s].sqrt();
            }
        }
        Ok(())
    }
}

/// The length of a row; 1 for a row that vanishes.
fn length(row: &[f64]) -> f64 {
    let length = row.iter().copied().fold(0.0, f64::hypot);
    if length > 0.0 { length } else { 1.0 }
}

fn singular(rows: &Matrix<f64>) -> Result<SingularValues, EvaluationFailure> {
    SingularValues::of(rows).map_err(|_| EvaluationFailure::NoProjection { unknowns: 0 })
}
