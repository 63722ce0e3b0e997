//! Quasi-velocities as functions of the velocities w, and the inverse functions.

use nalgebra::DMatrix;

use crate::derivation::derivation::{Completing, Derivation};
use crate::derivation::place::Place;
use crate::derivation::point::Point;
use crate::error::Irregular;
use crate::numbers::linear::{matrix, solving_inverse};
use crate::numbers::number::Number;
use crate::numbers::rounding::Rounding;
use crate::text::text::Velocities;

impl Derivation {
    /// The matrix ∂η_s/∂w, with a row for each quasi-velocity, or for each ordinary velocity if no
    /// quasi-velocity is declared.
    pub(crate) fn quasi_velocity_matrix(
        &self,
        at: &Place,
        rounding: &Rounding,
    ) -> Result<Vec<Vec<f64>>, Irregular> {
        let rows = self.along_velocities(at, rounding, |point| self.columns(point))?;
        Ok(if at.w.is_empty() { vec![Vec::new(); self.declared()] } else { rows })
    }

    /// The number of columns: of declared quasi-velocities, or of coordinates if none is declared.
    pub(crate) fn declared(&self) -> usize {
        match self.text.names.quasi_velocities.len() {
            0 => self.text.coordinates(),
            declared => declared,
        }
    }

    /// The values of the columns: η, or ẋ if no quasi-velocity is declared.
    pub(crate) fn columns<T: Number>(&self, point: &Point<'_, T>) -> Result<Vec<T>, Irregular> {
        if self.text.names.quasi_velocities.is_empty() {
            return Ok(point.velocities()?.to_vec());
        }
        point.quasi_velocities()
    }

    /// The velocities w for which η has these values and the constraints hold; if w = ẋ, they are found by
    /// least squares.
    pub(crate) fn velocities_of(&self, t: f64, x: &[f64], eta: &[f64]) -> Result<Vec<f64>, Irregular> {
        match &self.text.velocities {
            Velocities::Quasi(_) => return Ok(eta.to_vec()),
            Velocities::Ordinary(definitions) if definitions.is_empty() => return Ok(eta.to_vec()),
            Velocities::Ordinary(_) => {}
        }
        let exact = Rounding::none();
        // First-order states occur in no definition and no constraint.
        let mut at =
            Place { t, x: x.to_vec(), w: vec![0.0; x.len()], z: vec![0.0; self.text.state_rates.len()] };
        for _ in 0..NEWTON {
            let mut rows = self.quasi_velocity_matrix(&at, &exact)?;
            rows.extend(self.constraint_matrix(&self.kept, &at, &exact)?);
            let found = self.columns(&self.still(&at, &exact))?;
            let mut rest: Vec<f64> = eta.iter().zip(found).map(|(wanted, found)| wanted - found).collect();
            rest.extend(self.constraints(&self.kept, &at, &exact)?.iter().map(|phi| -phi));
            let (inverse, _) = solving_inverse(&matrix(&rows, x.len())).ok_or(Irregular::Singular)?;
            let step = inverse * DMatrix::from_column_slice(rest.len(), 1, &rest);
            at.w.iter_mut().zip(step.iter()).for_each(|(w, step)| *w += step);
            let size = at.w.iter().fold(1.0f64, |size, w| size.max(w.abs()));
            if step.iter().all(|step| step.abs() <= SETTLED * size) {
                return Ok(at.w);
            }
        }
        Err(Irregular::OffConstraints)
    }

    /// ẋ when all quasi-velocities vanish, including those added to the defined ones, and the rate of this ẋ
    /// along the motion: b_0 if quasi-velocities are defined in terms of ẋ; otherwise zero.
    pub(crate) fn drift(
        &self,
        at: &Place,
        velocity: &[f64],
        rounding: &Rounding,
    ) -> Result<[Vec<f64>; 2], Irregular> {
        let zero = vec![0.0; at.w.len()];
        match &self.text.velocities {
            Velocities::Ordinary(definitions) if !definitions.is_empty() => {}
            _ => return Ok([zero.clone(), zero]),
        }
        let resting = Place { w: zero.clone(), ..at.clone() };
        let constraints: Vec<usize> = self.completing.iter().filter_map(Completing::constraint).collect();
        let mut rest = self.columns(&self.still(&resting, rounding))?;
        rest.extend(self.constraints(&constraints, &resting, rounding)?);
        let mut rows = self.quasi_velocity_matrix(&resting, rounding)?;
        rows.extend(self.constraint_matrix(&constraints, &resting, rounding)?);
        for velocity in self.completing.iter().filter_map(Completing::velocity) {
            rows.push((0..zero.len()).map(|i| f64::from(u8::from(i == velocity))).collect());
            rest.push(0.0);
        }
        let (inverse, _) = solving_inverse(&matrix(&rows, zero.len())).ok_or(Irregular::Singular)?;
        let against = |rest: &[f64]| -> Vec<f64> {
            (-(&inverse * DMatrix::from_column_slice(rest.len(), 1, rest))).iter().copied().collect()
        };
        let drifting = Place { w: against(&rest), ..at.clone() };
        let in_time = at.in_time(velocity);
        let moving = self.once(&drifting, &in_time, rounding);
        let mut rates: Vec<f64> = self.columns(&moving)?.iter().map(|eta| eta.eps).collect();
        rates.extend(self.constraint_rates(&constraints, &drifting, &in_time, rounding)?);
        rates.resize(rest.len(), 0.0);
        Ok([drifting.w, against(&rates)])
    }
}

/// The largest number of steps of Newton's method.
pub(crate) const NEWTON: usize = 30;

/// The relative length of a step that is attributed to rounding errors.
pub(crate) const SETTLED: f64 = 1e-13;
