//! Random states that satisfy the constraints.

use nalgebra::DMatrix;

use crate::derivation::derivation::Derivation;
use crate::derivation::place::Place;
use crate::derivation::velocities::{NEWTON, SETTLED};
use crate::error::Irregular;
use crate::numbers::linear::{matrix, shortest_inverse};
use crate::numbers::rounding::{Random, Rounding};
use crate::text::text::Velocities;

/// The sizes of the random displacements, used in turn.
const SCALES: [f64; 4] = [1.0, 0.3, 0.05, 0.002];

/// The number of smaller displacements that are tried if a displacement of one size does not lead to a state.
const ATTEMPTS: i32 = 5;

impl Derivation {
    /// State number `number` near a place.
    pub(crate) fn random(&self, near: &Place, number: usize) -> Result<Place, Irregular> {
        let mut random = Random::new(number as u64);
        let scale = SCALES[number % SCALES.len()];
        let mut outcome = Err(Irregular::OffConstraints);
        for attempt in 0..ATTEMPTS {
            let scale = scale * 0.2f64.powi(attempt);
            outcome = self.random_within(near, scale, &mut random);
            if outcome.is_ok() {
                break;
            }
        }
        outcome
    }

    /// A random state at about this distance from a place.
    pub(crate) fn random_within(
        &self,
        near: &Place,
        scale: f64,
        random: &mut Random,
    ) -> Result<Place, Irregular> {
        let time = self.within_tables(near.t, scale * random.signed());
        let along: Vec<f64> = near.w.iter().map(|_| scale * random.signed()).collect();
        let mut at = self.moved(near, time, &along)?;
        at.w = self.units.faster(near, scale, random);
        for (z, unit) in at.z.iter_mut().zip(&self.units.z) {
            *z += scale * (unit + z.abs()) * random.signed();
        }
        self.on_constraints(at)
    }

    /// A step in time, reversed if inputs have values only on the other side: a table may begin with the
    /// motion.
    fn within_tables(&self, t: f64, step: f64) -> f64 {
        let is_known = |t: f64| self.text.tables.iter().all(|(_, table)| table.at(t).is_some());
        if !is_known(t + step) && is_known(t - step) { -step } else { step }
    }

    /// The velocities with which coordinates change by their own size in a unit of time.
    fn sizes(&self, at: &Place) -> Vec<f64> {
        match self.text.velocities {
            Velocities::Ordinary(_) => {
                at.x.iter().zip(&self.units.x).map(|(x, unit)| unit + x.abs()).collect()
            }
            Velocities::Quasi(_) => self.units.w.clone(),
        }
    }

    /// The place reached from another one by moving with the velocity b ξ + τ b_0 for a unit of time, during
    /// which t grows by τ; this place is on the same leaf of the frame. `step` is ξ in units of the sizes
    /// that velocities have at the first place.
    fn moved(&self, from: &Place, tau: f64, step: &[f64]) -> Result<Place, Irregular> {
        let xi: Vec<f64> = self.sizes(from).iter().zip(step).map(|(size, step)| size * step).collect();
        if let Velocities::Ordinary(_) = self.text.velocities {
            let x = from.x.iter().zip(xi).map(|(x, step)| x + step).collect();
            return Ok(Place { t: from.t + tau, x, ..from.clone() });
        }
        let (mut x, mut s, mut length) = (from.x.clone(), 0.0, 1.0f64);
        while s < 1.0 {
            let rate = |s: f64, x: &[f64]| self.leading(from.t + tau * s, x, tau, &xi);
            let step = f64::min(length, 1.0 - s);
            match extrapolated(rate, s, (&x, &self.units.x), step) {
                Ok(reached) => {
                    x = reached;
                    s += step;
                }
                Err(_) if length > SHORTEST => length /= 2.0,
                Err(irregular) => return Err(irregular),
            }
        }
        Ok(Place { t: from.t + tau, x, ..from.clone() })
    }

    /// b ξ + τ b_0
    fn leading(&self, t: f64, x: &[f64], tau: f64, xi: &[f64]) -> Result<Vec<f64>, Irregular> {
        let exact = Rounding::none();
        let velocity = |w: Vec<f64>| -> Result<Vec<f64>, Irregular> {
            let place = Place { t, x: x.to_vec(), w, z: vec![0.0; self.text.state_rates.len()] };
            Ok(self.still(&place, &exact).velocities()?.to_vec())
        };
        let (moving, drift) = (velocity(xi.to_vec())?, velocity(vec![0.0; xi.len()])?);
        let rates: Vec<f64> = moving.iter().zip(drift).map(|(u, drift)| u + (tau - 1.0) * drift).collect();
        if rates.iter().all(|rate| rate.is_finite()) {
            Ok(rates)
        } else {
            Err(Irregular::NotFinite { what: "the frame" })
        }
    }

    /// A nearby place that satisfies the constraints, found by Newton's method with steps of least length.
    pub(crate) fn on_constraints(&self, mut at: Place) -> Result<Place, Irregular> {
        let exact = Rounding::none();
        let all = 0..self.on_positions.len();
        let positions: Vec<usize> = all.clone().filter(|&a| self.on_positions[a]).collect();
        let all: Vec<usize> = all.collect();
        if !positions.is_empty() {
            self.settle(|| {
                let rest = self
                    .still(&at, &exact)
                    .all(&positions.iter().map(|&a| self.text.constraints[a].clone()).collect::<Vec<_>>())?;
                let step = shortest(&self.constraint_matrix(&positions, &at, &exact)?, &rest, at.w.len())?;
                let step: Vec<f64> =
                    step.iter().zip(self.sizes(&at)).map(|(step, size)| step / size).collect();
                at = self.moved(&at, 0.0, &step)?;
                Ok(size(&step))
            })?;
        }
        if !all.is_empty() {
            self.settle(|| {
                let rest = self.constraints(&all, &at, &exact)?;
                let step = shortest(&self.constraint_matrix(&all, &at, &exact)?, &rest, at.w.len())?;
                at.w.iter_mut().zip(&step).for_each(|(w, step)| *w += step);
                Ok(size(&step) / (size(&self.units.w) + size(&at.w)))
            })?;
            // Velocities that vanish up to rounding.
            let fastest = size(&at.w);
            at.w.iter_mut().filter(|w| w.abs() <= SETTLED * fastest).for_each(|w| *w = 0.0);
        }
        Ok(at)
    }

    /// Repeats a step, which returns its length, until the length is at the level of rounding errors.
    fn settle(&self, mut step: impl FnMut() -> Result<f64, Irregular>) -> Result<(), Irregular> {
        for _ in 0..NEWTON {
            if step()? <= SETTLED {
                return Ok(());
            }
        }
        Err(Irregular::OffConstraints)
    }
}

fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |size, value| if value.abs() <= size { size } else { value.abs() })
}

/// The shortest solution of C ξ = −rest. All constraints have the same weight, whatever the size of their
/// coefficients.
fn shortest(rows: &[Vec<f64>], rest: &[f64], columns: usize) -> Result<Vec<f64>, Irregular> {
    let inverse = shortest_inverse(&matrix(rows, columns));
    let (inverse, _) = inverse.ok_or(Irregular::NotFinite { what: "a constraint" })?;
    let step = -(inverse * DMatrix::from_column_slice(rest.len(), 1, rest));
    if step.iter().all(|step| step.is_finite()) {
        Ok(step.iter().copied().collect())
    } else {
        Err(Irregular::NotFinite { what: "a constraint" })
    }
}

/// The smallest fraction of a displacement that is covered in one step.
const SHORTEST: f64 = 1.0 / 64.0;

/// The numbers of parts into which a step is divided, for extrapolation to infinitely many.
const PARTS: [usize; 8] = [2, 4, 6, 8, 10, 12, 14, 16];

/// The step of Gragg, Bulirsch and Stoer: the midpoint rule with increasing numbers of parts, extrapolated;
/// an error unless the result is accurate to within rounding errors.
fn extrapolated(
    rate: impl Fn(f64, &[f64]) -> Result<Vec<f64>, Irregular>,
    s: f64,
    (x, units): (&[f64], &[f64]),
    step: f64,
) -> Result<Vec<f64>, Irregular> {
    let start = rate(s, x)?;
    let ahead = |from: &[f64], rate: &[f64], h: f64| -> Vec<f64> {
        from.iter().zip(rate).map(|(x, rate)| x + h * rate).collect()
    };
    let mut row: Vec<Vec<f64>> = Vec::new();
    for (j, parts) in PARTS.into_iter().enumerate() {
        let h = step / parts as f64;
        let (mut before, mut here) = (x.to_vec(), ahead(x, &start, h));
        for i in 1..parts {
            let next = ahead(&before, &rate(s + h * i as f64, &here)?, 2.0 * h);
            before = std::mem::replace(&mut here, next);
        }
        let mut next = vec![here];
        for (i, coarser) in row.iter().enumerate() {
            let ratio = (PARTS[j] as f64 / PARTS[j - 1 - i] as f64).powi(2) - 1.0;
            let finer = &next[i];
            next.push(
                finer.iter().zip(coarser).map(|(fine, coarse)| fine + (fine - coarse) / ratio).collect(),
            );
        }
        let settled = row.last().zip(next.last()).is_some_and(|(last, this)| {
            let near = |((a, b), unit): ((&f64, &f64), &f64)| (a - b).abs() <= SETTLED * (unit + a.abs());
            this.iter().zip(last).zip(units).all(near)
        });
        if settled {
            return Ok(next.pop().unwrap_or_default());
        }
        row = next;
    }
    Err(Irregular::Frame)
}
