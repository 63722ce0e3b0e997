//! Finds the nearest velocities that satisfy constraints nonlinear in the velocities.

use pc_algebra::Matrix;

use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::point::Point;
use crate::compiled::projection::constraint_manifold::{MOST_STEPS, Part, Surface};
use crate::compiled::projection::holding::{DEPENDENT, NEARLY_DEPENDENT};
use crate::numeric::least_squares::LeastSquares;

/// The square of a displacement this short relative to the velocities is within rounding error, and so
/// is the error of Newton's steps.
const SHORT: f64 = 1e-8;

/// A step this short is the last towards the nearest point: its square, the remaining error, is within
/// rounding error.
const LAST: f64 = 1e-7;

/// A displacement this short relative to the velocities is a rounding error of the linear equations.
const ROUNDING: f64 = 1e-14;

/// The maximum number of halvings of a step before its direction is given up.
const HALVINGS: i32 = 20;

/// The matrices M and C = ∂g/∂η, row by row.
pub(super) struct Coefficients {
    pub(super) mass: Vec<Vec<f64>>,
    pub(super) constraints: Vec<Vec<f64>>,
}

impl Surface {
    /// Moves the η of `y` to the nearest η with g(t, x, η) = 0 in the kinetic metric; the matrix
    /// stays factorised at the end point.
    ///
    /// # Errors
    /// [`EvaluationFailure::NoProjection`] if no step leads closer.
    pub(super) fn project_to_nearest(
        &mut self,
        t: f64,
        y: &mut [f64],
        p: &[f64],
    ) -> Result<(), EvaluationFailure> {
        if self.affine {
            return self.project_part(Part::Velocity, t, y, p);
        }
        let mut given = std::mem::take(&mut self.given);
        given.clear();
        given.extend_from_slice(&y[self.moving()]);
        let mut outcome = self.project_part(Part::Velocity, t, y, p);
        if outcome.is_ok() && self.is_longer(SHORT, &y[self.moving()], &given) {
            outcome = self.approach(&given, (t, p), y);
        }
        self.given = given;
        outcome
    }

    /// The range of indices of η in a state.
    pub(super) fn moving(&self) -> std::ops::Range<usize> {
        self.coordinates..self.coordinates + self.k
    }

    /// Moves η along g = 0, from the result of Newton's method, to where
    ///
    ///   M (η − η₀) = Cᵀ μ.
    ///
    /// Each step to g = 0 is the shortest possible, but the whole path is not the shortest, and it depends on
    /// the choice of quasi-velocities. Where g is affine in η a single step leads to the nearest point.
    fn approach(
        &mut self,
        given: &[f64],
        (t, p): (f64, &[f64]),
        y: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let moving = self.moving();
        let failed = EvaluationFailure::NoProjection { unknowns: self.k };
        let mut place = y.to_vec();
        place[moving.clone()].copy_from_slice(given);
        let Coefficients { mass, constraints } = self.coefficients(Point { t, y: &place, p })?;
        if self.coefficients(Point { t, y, p })?.constraints == constraints {
            return self.factorise(t, y, p);
        }
        let distance = |eta: &[f64]| {
            let way: Vec<f64> = eta.iter().zip(given).map(|(a, b)| a - b).collect();
            dot(&way, &times(&mass, &way))
        };
        for _ in 0..MOST_STEPS {
            let eta = y[moving.clone()].to_vec();
            let (back, steepest) = self.tangents(given, &mass, Point { t, y, p })?;
            // Where M is not positive along g = 0, no point is the nearest.
            let slope = dot(&steepest, &times(&mass, &steepest));
            let end = |step: &[f64]| eta.iter().zip(step).map(|(a, b)| a + b).collect::<Vec<f64>>();
            if slope <= 0.0 || slope.is_nan() || !self.is_longer(ROUNDING, &end(&steepest), &eta) {
                return self.factorise(t, y, p);
            }
            let is_last = !self.is_longer(LAST, &end(&back), &eta);
            let least = distance(&eta);
            let mut go = |surface: &mut Surface, step: &[f64], fraction: f64| {
                let step: Vec<f64> = step.iter().map(|step| fraction * step).collect();
                y[moving.clone()].copy_from_slice(&end(&step));
                let come =
                    surface.factorise(t, y, p).and_then(|()| surface.project_part(Part::Velocity, t, y, p));
                come.is_ok() && (is_last || distance(&y[moving.clone()]) < least)
            };
            let mut nearer = |surface: &mut Surface, step: &[f64]| {
                (0..=HALVINGS).any(|halvings| go(surface, step, 0.5f64.powi(halvings)))
            };
            if !nearer(self, &back) && !nearer(self, &steepest) {
                return Err(failed);
            }
            if is_last {
                return Ok(());
            }
        }
        Err(failed)
    }

    /// Whether the distance between two velocities is greater than a fraction of the first.
    fn is_longer(&self, part: f64, a: &[f64], b: &[f64]) -> bool {
        self.speed(a.iter().zip(b).map(|(a, b)| a - b)) > part * self.speed(a.iter().copied())
    }

    /// The square root of twice the kinetic energy, computed with the diagonal of M.
    fn speed(&self, eta: impl Iterator<Item = f64>) -> f64 {
        eta.zip(&self.weights).map(|(eta, weight)| eta * weight.sqrt()).fold(0.0, f64::hypot)
    }

    /// Two steps along g = 0: the step of Newton's method to the nearest point, and the steepest direction
    /// towards it; both are zero at that point.
    ///
    ///   (M − ∂(Cᵀμ)/∂η) δ + Cᵀ ν = −M z,   C δ = 0,   where   M z + Cᵀ μ = M (η − η₀),   C z = 0.
    fn tangents(
        &mut self,
        given: &[f64],
        mass: &[Vec<f64>],
        Point { t, y, p }: Point<'_>,
    ) -> Result<(Vec<f64>, Vec<f64>), EvaluationFailure> {
        let moving = self.moving();
        let rows = self.coefficients(Point { t, y, p })?.constraints;
        let way: Vec<f64> = y[moving.clone()].iter().zip(given).map(|(a, b)| a - b).collect();
        let (z, multipliers) = self.along(mass, &rows, &times(mass, &way))?;
        let mut curved = mass.to_vec();
        // Central differences in units of the fastest velocity: their error only slows the method down.
        let fastest = self.speed(y[moving.clone()].iter().copied()).max(self.speed(given.iter().copied()));
        let mut beside = y.to_vec();
        for s in 0..self.k {
            let place = moving.start + s;
            let half = f64::EPSILON.cbrt() * fastest / self.weights[s].sqrt();
            let mut turned = |at: f64| {
                beside[place] = at;
                self.coefficients(Point { t, y: &beside, p }).map(|found| found.constraints)
            };
            let ends = (turned(y[place] + half), turned(y[place] - half));
            beside[place] = y[place];
            // At the edge of the domain of g the curvature is left out.
            let (Ok(ahead), Ok(behind)) = ends else { continue };
            for (r, curved) in curved.iter_mut().enumerate() {
                let quotient = |a: usize| (ahead[a][r] - behind[a][r]) / (2.0 * half);
                curved[s] -= (0..rows.len()).map(|a| multipliers[a] * quotient(a)).sum::<f64>();
            }
        }
        let right: Vec<f64> = times(mass, &z).iter().map(|value| -value).collect();
        let (newton, _) = self.along(&curved, &rows, &right)?;
        Ok((newton, z.iter().map(|z| -z).collect()))
    }

    /// Solves H δ + Cᵀ ν = r, C δ = 0 for δ and ν, in units in which masses and the lengths of the rows
    /// of C are one.
    fn along(
        &self,
        h: &[Vec<f64>],
        rows: &[Vec<f64>],
        right: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), EvaluationFailure> {
        let (k, m) = (self.k, rows.len());
        let units: Vec<f64> = self.weights.iter().map(|weight| weight.sqrt().recip()).collect();
        let length = |row: &Vec<f64>| row.iter().zip(&units).map(|(c, unit)| c * unit).fold(0.0, f64::hypot);
        let lengths: Vec<f64> = rows.iter().map(length).map(|l| if l > 0.0 { l } else { 1.0 }).collect();
        let matrix = Matrix::from_fn(k + m, k + m, |i, j| match (i < k, j < k) {
            (true, true) => h[i][j] * units[i] * units[j],
            (false, true) => rows[i - k][j] * units[j] / lengths[i - k],
            (true, false) => rows[j - k][i] * units[i] / lengths[j - k],
            (false, false) => 0.0,
        });
        let right: Vec<f64> = (0..k + m).map(|i| if i < k { right[i] * units[i] } else { 0.0 }).collect();
        let solved = LeastSquares::of(&matrix)
            .map_err(|_| EvaluationFailure::NoProjection { unknowns: k })?
            .shortest(&right, if self.rank < m { NEARLY_DEPENDENT } else { DEPENDENT });
        let (step, multipliers) = solved.split_at(k);
        let step = step.iter().zip(&units).map(|(step, unit)| step * unit).collect();
        Ok((step, multipliers.iter().zip(&lengths).map(|(mu, length)| mu / length).collect()))
    }

    /// The matrices M and C at a state.
    pub(super) fn coefficients(
        &mut self,
        Point { t, y, p }: Point<'_>,
    ) -> Result<Coefficients, EvaluationFailure> {
        self.bordered.eval(t, y, p, &mut self.entries);
        check_finite(&self.entries, &self.bordered, Point { t, y, p })?;
        let k = self.k;
        let mut mass = vec![vec![0.0; k]; k];
        let mut constraints = vec![vec![0.0; k]; self.velocities.values().len()];
        for ((i, j), &entry) in self.lower.entries().zip(&self.entries) {
            match i.checked_sub(k) {
                Some(a) if j < k => constraints[a][j] = -entry,
                Some(_) => {}
                None => (mass[i][j], mass[j][i]) = (entry, entry),
            }
        }
        Ok(Coefficients { mass, constraints })
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn times(matrix: &[Vec<f64>], vector: &[f64]) -> Vec<f64> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}
