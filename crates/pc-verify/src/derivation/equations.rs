//! The equations of motion at one state, by Lagrange's equations with multipliers.
//!
//! With velocities w, ẋ = u(t, x, w), b_s = ∂u/∂w_s and constraints φ_α(t, x, w) = 0 the motion satisfies
//!
//!   D_t p_s − p·δw_s − X_s L − Q_s = λ_α ∂φ_α/∂w_s,   p_s = ∂L/∂w_s,   X_s L = b_is ∂L/∂x_i,
//!
//! where b δw_s = D_t b_s − (∂u/∂x) b_s: for a virtual displacement δx = ε b_s the variation of the velocity is
//! δẋ = (δx)˙ = (∂u/∂x) δx + b δw, and δ∫L dt + ∫Q_s ε dt = 0 after an integration by parts. If w = ẋ these are
//! Lagrange's equations, with δw = 0; otherwise they are Lagrange's for L̂(t, x, ẋ) = L(t, x, w(t, x, ẋ)),
//! multiplied by bᵀ. If b does not determine w, the term follows from the brackets, p·δw_s = (c_rs^m η_r +
//! c_0s^m) p_m, as in (9).

use nalgebra::DMatrix;

use crate::derivation::derivation::Derivation;
use crate::derivation::place::{Direction, Place, Virtual};
use crate::error::Irregular;
use crate::numbers::balance::Balance;
use crate::numbers::linear::{Solution, fitting_inverse, solve};
use crate::numbers::rounding::{Rounding, UNIT, within};
use crate::text::text::Velocities;

/// The solution of the equations at a place.
#[derive(Clone, Debug)]
pub(crate) struct Derived {
    /// The place at which the equations are evaluated.
    pub(crate) place: Place,
    /// ẋ
    pub(crate) velocities: Vec<f64>,
    /// ż
    pub(crate) state_rates: Vec<f64>,
    /// The components of ẇ, each with the size of its terms.
    pub(crate) accelerations: Vec<f64>,
    pub(crate) acceleration_sizes: Vec<f64>,
    /// The sizes of the terms of the forces, including reactions, and of the accelerations that each would
    /// impart to its own mass.
    pub(crate) force_sizes: Vec<f64>,
    pub(crate) unconstrained_sizes: Vec<f64>,
    /// The multipliers λ of the independent constraints, each with the size of its terms.
    pub(crate) reactions: Vec<f64>,
    pub(crate) reaction_sizes: Vec<f64>,
    /// The momenta p, their rates, and the sizes of the terms of the rates.
    pub(crate) momenta: Vec<f64>,
    pub(crate) momentum_rates: Vec<f64>,
    pub(crate) momentum_rate_sizes: Vec<f64>,
    /// The sizes of the terms of p, ∂²L/∂w∂w w, and of the terms of w when p is solved for w.
    pub(crate) momentum_sizes: Vec<f64>,
    pub(crate) velocity_sizes: Vec<f64>,
    /// The largest entry of ∂²L/∂w∂w.
    pub(crate) mass_size: f64,
    /// The Lagrangian L and its rate.
    pub(crate) lagrangian: f64,
    pub(crate) lagrangian_rate: f64,
    /// The condition number of the equations.
    pub(crate) condition: f64,
}

impl Derivation {
    /// Solves the equations at a place.
    pub(crate) fn at(&self, at: &Place, rounding: &Rounding) -> Result<Derived, Irregular> {
        let k = at.w.len();
        let here = self.still(at, rounding);
        let (velocity, state_rates) = (here.velocities()?.to_vec(), here.all(&self.text.state_rates)?);
        let in_time = Direction { z: state_rates.clone(), ..at.in_time(&velocity) };
        let frame = self.frame(at, rounding)?;

        let mut mass = DMatrix::zeros(k, k);
        let mut work = vec![0.0; k];
        for s in 0..k {
            let along = at.along_velocity(s);
            for r in (s..k).filter(|&r| self.couplings.has(s, r)) {
                let value = self.twice(at, &along, &at.along_velocity(r), rounding).lagrangian()?;
                mass[(s, r)] = value.eps.eps;
                mass[(r, s)] = value.eps.eps;
            }
            work[s] = self.once(at, &at.along(frame[s].clone()), rounding).lagrangian()?.eps;
        }
        let [momenta, transport] = self.slopes_of_lagrangian(at, &in_time, rounding)?;
        let transposed = self.transposed(at, &velocity, &frame, &momenta, rounding)?;
        let unit = |s: usize| Virtual { w: at.along_velocity(s), x: frame[s].clone() };
        let units: Vec<Virtual> = (0..k).map(unit).collect();
        let forces = self.forces(at, &units, rounding)?;
        let rows = self.constraint_matrix(&self.kept, at, rounding)?;
        let drift = self.constraint_rates(&self.kept, at, &in_time, rounding)?;

        // The forces of a reaction λ_α, with the friction that it causes.
        let mut led_by = rows.clone();
        for drag in self.drags(at, &units, rounding)? {
            let forces = led_by[drag.kept].iter_mut().zip(&drag.per_normal_force);
            forces.for_each(|(force, drag)| *force += drag);
        }

        // M ẇ − Cᵀλ = p·δw + XL + Q − D_t p at ẇ = 0,  C ẇ = −(D_t φ at ẇ = 0)
        let l = rows.len();
        let system = DMatrix::from_fn(k + l, k + l, |i, j| match (i < k, j < k) {
            (true, true) => mass[(i, j)],
            (true, false) => -led_by[j - k][i],
            (false, true) => rows[i - k][j],
            (false, false) => 0.0,
        });
        let mut right: Vec<Balance> = (0..k)
            .map(|s| {
                let mut sum = transposed[s];
                let largest = forces[s].largest;
                [work[s], forces[s].sum, -transport[s]].into_iter().for_each(|term| sum.add(term));
                Balance { largest: sum.largest.max(largest), ..sum }
            })
            .collect();
        right.extend(drift.iter().map(|&rate| Balance { sum: -rate, largest: rate.abs() }));
        let sums: Vec<f64> = right.iter().map(|balance| balance.sum).collect();
        let terms: Vec<f64> = right.iter().map(|balance| balance.largest).collect();
        let Solution { values, sizes, condition, inverse } = solve(&system, &sums, &terms)?;

        let accelerations = values[..k].to_vec();
        self.require_followed(at, &in_time, &accelerations)?;
        let inertia = |s: usize| (0..k).map(|r| mass[(s, r)] * accelerations[r]).sum::<f64>();
        let inertia_size = |s: usize| (0..k).map(|r| (mass[(s, r)] * sizes[r]).abs()).fold(0.0, f64::max);
        let reacting =
            |s: usize| led_by.iter().zip(&values[k..]).map(move |(row, lambda)| (row[s] * lambda).abs());
        let force_sizes: Vec<f64> = (0..k).map(|s| reacting(s).fold(terms[s], f64::max)).collect();
        let unconstrained =
            |s: usize| if mass[(s, s)] == 0.0 { 0.0 } else { force_sizes[s] / mass[(s, s)].abs() };
        let unconstrained_sizes = (0..k).map(unconstrained).collect();
        let momentum_sizes: Vec<f64> =
            (0..k).map(|s| (0..k).map(|r| (mass[(s, r)] * at.w[r]).abs()).fold(0.0, f64::max)).collect();
        let led = |s: usize| {
            (0..k).map(|r| (inverse[(s, r)] * momentum_sizes[r]).abs()).fold(at.w[s].abs(), f64::max)
        };
        let velocity_sizes = (0..k).map(led).collect();
        let along_time = self.once(at, &in_time, rounding).lagrangian()?;
        let through_velocities: f64 = momenta.iter().zip(&accelerations).map(|(p, w)| p * w).sum();
        let mut derived = Derived {
            place: at.clone(),
            velocities: velocity,
            state_rates,
            acceleration_sizes: sizes[..k].to_vec(),
            force_sizes,
            unconstrained_sizes,
            reactions: values[k..].to_vec(),
            reaction_sizes: sizes[k..].to_vec(),
            momentum_rates: (0..k).map(|s| transport[s] + inertia(s)).collect(),
            momentum_rate_sizes: (0..k).map(|s| inertia_size(s).max(transport[s].abs())).collect(),
            momenta,
            momentum_sizes,
            velocity_sizes,
            mass_size: mass.amax(),
            lagrangian: along_time.re,
            lagrangian_rate: along_time.eps + through_velocities,
            accelerations,
            condition,
        };
        let least = self.least_reaction_sizes(&derived)?;
        derived.reaction_sizes.iter_mut().zip(least).for_each(|(size, least)| *size = size.max(least));
        Ok(derived)
    }

    /// p_s = ∂L/∂w_s for all s, and their rates along a direction.
    fn slopes_of_lagrangian(
        &self,
        at: &Place,
        along: &Direction,
        rounding: &Rounding,
    ) -> Result<[Vec<f64>; 2], Irregular> {
        let slopes = self.along_velocities_and(at, along, rounding, |point| Ok(vec![point.lagrangian()?]))?;
        Ok(slopes.map(|rows| rows.into_iter().next().unwrap_or_default()))
    }

    /// p·δw_s for all s, each with the size of its terms.
    fn transposed(
        &self,
        at: &Place,
        velocity: &[f64],
        frame: &[Vec<f64>],
        momenta: &[f64],
        rounding: &Rounding,
    ) -> Result<Vec<Balance>, Irregular> {
        let (n, k) = (at.x.len(), at.w.len());
        if let Velocities::Ordinary(_) = self.text.velocities {
            return Ok(vec![Balance::default(); k]);
        }
        let weighed = |variation: &[f64]| {
            let mut sum = Balance::default();
            variation.iter().zip(momenta).for_each(|(v, p)| sum.add(v * p));
            sum
        };
        if let Some(c) = self.structure.constants(self, at)? {
            // c_rs^m η_r + c_0s^m
            let rate = |r: usize| if r == 0 { 1.0 } else { at.w[r - 1] };
            let of = |s: usize| {
                let mut sum = Balance::default();
                for r in 0..=k {
                    (0..k).for_each(|m| sum.add(c.get(r, s + 1, m) * rate(r) * momenta[m]));
                }
                sum
            };
            return Ok((0..k).map(of).collect());
        }
        let b = DMatrix::from_fn(n, k, |i, s| frame[s][i]);
        let (inverse, rank) = fitting_inverse(&b).ok_or(Irregular::NotFinite { what: "the frame" })?;
        if rank < k {
            return Err(Irregular::Frame);
        }
        let [_, moved] = self.along_velocities_and(at, &at.in_time(velocity), rounding, |point| {
            Ok(point.velocities()?.to_vec())
        })?;
        let mut all = Vec::with_capacity(k);
        for s in 0..k {
            let transported: Vec<f64> = moved.iter().map(|row| row[s]).collect();
            let displaced = self.once(at, &at.along(frame[s].clone()), rounding);
            let displaced: Vec<f64> = displaced.velocities()?.iter().map(|u| u.eps).collect();
            let difference = DMatrix::from_fn(n, 1, |i, _| transported[i] - displaced[i]);
            let variation = &inverse * &difference;
            let rest = (&b * &variation - &difference).amax();
            let size = transported.iter().chain(&displaced).fold(0.0f64, |size, part| size.max(part.abs()));
            if !within(rest, CLOSED * size.max(f64::MIN_POSITIVE)) {
                return Err(Irregular::Frame);
            }
            let mut sum = weighed(variation.as_slice());
            let led =
                |m: usize| (0..n).map(|i| (inverse[(m, i)] * momenta[m]).abs() * size).fold(0.0, f64::max);
            sum.largest = (0..k).map(led).fold(sum.largest, f64::max);
            all.push(sum);
        }
        Ok(all)
    }

    /// Checks that the motion also satisfies the constraints that were left out because they are dependent.
    fn require_followed(
        &self,
        at: &Place,
        in_time: &Direction,
        accelerations: &[f64],
    ) -> Result<(), Irregular> {
        let dropped: Vec<usize> = (0..self.on_positions.len()).filter(|a| !self.kept.contains(a)).collect();
        if dropped.is_empty() {
            return Ok(());
        }
        let followed = |rounding: &Rounding| -> Result<Vec<(Balance, f64)>, Irregular> {
            let rows = self.constraint_matrix(&dropped, at, rounding)?;
            let drift = self.constraint_rates(&dropped, at, in_time, rounding)?;
            let rate = |(row, drift): (&Vec<f64>, f64)| {
                let (mut rate, mut unit) = (Balance::default(), 0.0f64);
                rate.add(drift);
                for (c, w) in row.iter().zip(accelerations) {
                    rate.add(c * w);
                    unit = unit.max(c.abs());
                }
                (rate, unit)
            };
            Ok(rows.iter().zip(drift).map(rate).collect())
        };
        let (rates, moved) = (followed(&Rounding::none())?, followed(&Rounding::made(1))?);
        for ((rate, unit), (moved, _)) in rates.into_iter().zip(moved) {
            // Coefficients that vanish up to rounding have no size of their own.
            let scatter = (moved.sum - rate.sum).abs() / UNIT;
            if !within(rate.sum.abs(), FOLLOWED * rate.largest.max(unit).max(scatter)) {
                return Err(Irregular::OffConstraints);
            }
        }
        Ok(())
    }
}

/// The greatest error with which the brackets of a frame may close; an error of derivation is of order one.
const CLOSED: f64 = 1e-7;

/// The greatest residual that a dependent constraint may have, relative to its terms with accelerations of at
/// least one; an error of derivation is of order one.
const FOLLOWED: f64 = 1e-6;
