//! The equations of motion at one state, by Lagrange's equations with multipliers.
//!
//! With velocities w, ẋ = u(t, x, w), b_s = ∂u/∂w_s and constraints φ_α(t, x, w) = 0 the motion is that of
//!
//!   D_t p_s − p·δw_s − X_s L − Q_s = λ_α ∂φ_α/∂w_s,   p_s = ∂L/∂w_s,   X_s L = b_is ∂L/∂x_i,
//!
//! where b δw_s = D_t b_s − (∂u/∂x) b_s: for a virtual displacement δx = ε b_s the variation of the velocity is
//! δẋ = (δx)˙ = (∂u/∂x) δx + b δw, and δ∫L dt + ∫Q_s ε dt = 0 after an integration by parts. Where w = ẋ these are Lagrange's
//! equations, δw = 0; otherwise they are Lagrange's for L̂(t, x, ẋ) = L(t, x, w(t, x, ẋ)), multiplied by bᵀ. Where b does not
//! determine w the term is that of the brackets, p·δw_s = (c_rs^m η_r + c_0s^m) p_m, as in (9).

use nalgebra::DMatrix;

use crate::error::Irregular;
use crate::linear::{Solution, independent_rows, matrix, pseudo_inverse, solve};
use crate::number::{D1, D2, Number};
use crate::point::Point;
use crate::rounding::{Rounding, within};
use crate::structure::Structure;
use crate::text::{Forced, Text, Velocities};

/// A time, coordinates, velocities w and first-order states.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) t: f64,
    pub(crate) x: Vec<f64>,
    pub(crate) w: Vec<f64>,
    pub(crate) z: Vec<f64>,
}

/// A direction in which a place changes.
#[derive(Clone, Debug)]
pub(crate) struct Direction {
    pub(crate) t: f64,
    pub(crate) x: Vec<f64>,
    pub(crate) w: Vec<f64>,
    pub(crate) z: Vec<f64>,
}

/// A virtual velocity: the direction of w, and the displacement of the coordinates b w.
#[derive(Clone, Debug)]
pub(crate) struct Virtual {
    pub(crate) w: Direction,
    pub(crate) x: Vec<f64>,
}

impl Place {
    /// In the direction of w_s.
    pub(crate) fn along_velocity(&self, s: usize) -> Direction {
        let mut still = self.along(vec![0.0; self.x.len()]);
        still.w[s] = 1.0;
        still
    }

    /// In the direction of coordinates.
    pub(crate) fn along(&self, x: Vec<f64>) -> Direction {
        Direction { t: 0.0, x, w: vec![0.0; self.w.len()], z: vec![0.0; self.z.len()] }
    }

    /// In that of time, coordinates moving with it and first-order states at rest.
    pub(crate) fn in_time(&self, velocity: &[f64]) -> Direction {
        Direction { t: 1.0, ..self.along(velocity.to_vec()) }
    }
}

/// A quasi-velocity that is not declared, but completes those that are defined by `is` to as many as coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Completing {
    /// ẋ_i
    Velocity(usize),
    /// What a constraint fixes at 0.
    Constraint(usize),
}

impl Completing {
    fn velocity(&self) -> Option<usize> {
        if let Completing::Velocity(i) = self { Some(*i) } else { None }
    }

    fn constraint(&self) -> Option<usize> {
        if let Completing::Constraint(a) = self { Some(*a) } else { None }
    }
}

/// The second derivation of a model.
#[derive(Clone, Debug)]
pub(crate) struct Derivation {
    pub(crate) text: Text,
    /// Of each constraint, whether it contains no velocities.
    pub(crate) on_positions: Vec<bool>,
    /// The constraints that do not follow from those before.
    pub(crate) kept: Vec<usize>,
    /// What completes the quasi-velocities.
    pub(crate) completing: Vec<Completing>,
    pub(crate) structure: Structure,
}

/// The equations at a place, solved.
#[derive(Clone, Debug)]
pub(crate) struct Derived {
    /// Where they were taken.
    pub(crate) place: Place,
    /// ẋ
    pub(crate) velocities: Vec<f64>,
    /// ż
    pub(crate) state_rates: Vec<f64>,
    /// ẇ, each with the size of its terms.
    pub(crate) accelerations: Vec<f64>,
    pub(crate) acceleration_sizes: Vec<f64>,
    /// λ of the constraints kept, each with the size of its terms.
    pub(crate) reactions: Vec<f64>,
    pub(crate) reaction_sizes: Vec<f64>,
    /// p, its rate, and the size of the terms of this.
    pub(crate) momenta: Vec<f64>,
    pub(crate) momentum_rates: Vec<f64>,
    pub(crate) momentum_rate_sizes: Vec<f64>,
    /// How large the terms of p are, ∂²L/∂w∂w w, and those of w where p is solved for it.
    pub(crate) momentum_sizes: Vec<f64>,
    pub(crate) velocity_sizes: Vec<f64>,
    /// L and its rate.
    pub(crate) lagrangian: f64,
    pub(crate) lagrangian_rate: f64,
    /// The condition of the equations.
    pub(crate) condition: f64,
}

/// Terms that are summed, and the largest of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Balance {
    pub(crate) sum: f64,
    pub(crate) largest: f64,
}

impl Balance {
    fn add(&mut self, term: f64) {
        self.sum += term;
        if !within(term.abs(), self.largest) {
            self.largest = term.abs();
        }
    }
}

impl Derivation {
    /// The point of a place as it changes in a direction.
    pub(crate) fn once<'a>(&'a self, at: &Place, along: &Direction, rounding: &'a Rounding) -> Point<'a, D1> {
        let both = |values: &[f64], rates: &[f64]| -> Vec<D1> {
            values.iter().zip(rates).map(|(&value, &rate)| D1::new(value, rate)).collect()
        };
        let all = [both(&at.x, &along.x), both(&at.w, &along.w), both(&at.z, &along.z)];
        Point::new(&self.text, rounding, D1::new(at.t, along.t), all)
    }

    /// The point of a place as it changes in two directions.
    pub(crate) fn twice<'a>(
        &'a self,
        at: &Place,
        first: &Direction,
        second: &Direction,
        rounding: &'a Rounding,
    ) -> Point<'a, D2> {
        let number = |value: f64, a: f64, b: f64| D2::new(D1::new(value, a), D1::new(b, 0.0));
        let all = |values: &[f64], a: &[f64], b: &[f64]| -> Vec<D2> {
            (0..values.len()).map(|i| number(values[i], a[i], b[i])).collect()
        };
        let x = all(&at.x, &first.x, &second.x);
        let w = all(&at.w, &first.w, &second.w);
        let z = all(&at.z, &first.z, &second.z);
        Point::new(&self.text, rounding, number(at.t, first.t, second.t), [x, w, z])
    }

    /// The point of a place.
    pub(crate) fn still<'a>(&'a self, at: &Place, rounding: &'a Rounding) -> Point<'a, f64> {
        Point::new(&self.text, rounding, at.t, [at.x.clone(), at.w.clone(), at.z.clone()])
    }

    /// φ_α of these constraints.
    pub(crate) fn constraints(
        &self,
        which: &[usize],
        at: &Place,
        rounding: &Rounding,
    ) -> Result<Vec<f64>, Irregular> {
        let point = self.still(at, rounding);
        which.iter().map(|&a| point.velocity_constraint(a, self.on_positions[a])).collect()
    }

    /// The rates of φ_α along a direction.
    pub(crate) fn constraint_rates(
        &self,
        which: &[usize],
        at: &Place,
        along: &Direction,
        rounding: &Rounding,
    ) -> Result<Vec<f64>, Irregular> {
        let point = self.once(at, along, rounding);
        let rate = |&a: &usize| Ok(point.velocity_constraint(a, self.on_positions[a])?.eps);
        which.iter().map(rate).collect()
    }

    /// ∂φ_α/∂w_s, a row for each of these constraints.
    pub(crate) fn constraint_matrix(
        &self,
        which: &[usize],
        at: &Place,
        rounding: &Rounding,
    ) -> Result<Vec<Vec<f64>>, Irregular> {
        let mut rows = vec![Vec::new(); which.len()];
        for s in 0..at.w.len() {
            let column = self.constraint_rates(which, at, &at.along_velocity(s), rounding)?;
            rows.iter_mut().zip(column).for_each(|(row, entry)| row.push(entry));
        }
        Ok(rows)
    }

    /// b_s for all s.
    pub(crate) fn frame(&self, at: &Place, rounding: &Rounding) -> Result<Vec<Vec<f64>>, Irregular> {
        let field = |s: usize| {
            let point = self.once(at, &at.along_velocity(s), rounding);
            Ok(point.velocities()?.iter().map(|u| u.eps).collect())
        };
        (0..at.w.len()).map(field).collect()
    }

    /// The constraints that do not follow at a place from those before, in an order in which some come last; in that of the text.
    pub(crate) fn independent(&self, at: &Place, last: &[usize]) -> Result<Vec<usize>, Irregular> {
        let first = (0..self.on_positions.len()).filter(|a| !last.contains(a));
        let order: Vec<usize> = first.chain(last.iter().copied()).collect();
        let rows = independent_rows(&self.constraint_matrix(&order, at, &Rounding::none())?);
        let mut kept: Vec<usize> = rows.into_iter().map(|row| order[row]).collect();
        kept.sort_unstable();
        Ok(kept)
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
        let (inverse, rank) = pseudo_inverse(&b).ok_or(Irregular::NotFinite { what: "the frame" })?;
        if rank < k {
            return Err(Irregular::Frame);
        }
        let mut all = Vec::with_capacity(k);
        for s in 0..k {
            let moved = self.twice(at, &at.along_velocity(s), &at.in_time(velocity), rounding);
            let transported: Vec<f64> = moved.velocities()?.iter().map(|u| u.eps.eps).collect();
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

    /// The parts of Q along virtual velocities, Q_s where these are of unit w_s: of forces on coordinates and quasi-velocities, of dissipation −∂R/∂w_s, and (8) of forces and torques
    /// on bodies.
    pub(crate) fn forces(
        &self,
        at: &Place,
        along: &[Virtual],
        rounding: &Rounding,
    ) -> Result<Vec<Balance>, Irregular> {
        let text = &self.text;
        let still = self.still(at, rounding);
        let mut forces = vec![Balance::default(); along.len()];
        for (on, force) in &text.forces {
            let value = still.value(force)?;
            match (*on, &text.velocities) {
                (Forced::Coordinate(i), _) => {
                    forces.iter_mut().zip(along).for_each(|(sum, along)| sum.add(value * along.x[i]));
                }
                (Forced::QuasiVelocity(s), Velocities::Quasi(_)) => {
                    forces.iter_mut().zip(along).for_each(|(sum, along)| sum.add(value * along.w.w[s]));
                }
                (Forced::QuasiVelocity(q), Velocities::Ordinary(definitions)) => {
                    for (sum, along) in forces.iter_mut().zip(along) {
                        let point = self.once(at, &along.w, rounding);
                        sum.add(value * point.value(&definitions[q])?.eps);
                    }
                }
            }
        }
        for (sum, along) in forces.iter_mut().zip(along) {
            let varied = self.once(at, &along.w, rounding);
            let displaced = self.once(at, &at.along(along.x.clone()), rounding);
            if let Some(dissipation) = &text.dissipation {
                sum.add(-varied.value(dissipation)?.eps);
            }
            for body in &text.bodies {
                for (i, force) in still.all(&body.force)?.iter().enumerate() {
                    if body.force_functions[i] == 0.0 {
                        sum.add(force * displaced.value(&body.position[i])?.eps);
                    }
                }
                if !body.torque.is_empty() {
                    let turned = varied.angular_velocity(body)?;
                    still.all(&body.torque)?.iter().zip(turned).for_each(|(n, omega)| sum.add(n * omega.eps));
                }
            }
        }
        Ok(forces)
    }

    /// The place moved by rounding errors of a state, w by those of terms of these sizes.
    pub(crate) fn near(&self, place: &Place, sizes: &[f64], rounding: &Rounding) -> Place {
        // Where constraints mix velocities each is as uncertain as the largest.
        let largest = place.w.iter().fold(0.0f64, |largest, w| largest.max(w.abs()));
        let least = if self.kept.is_empty() { 0.0 } else { largest };
        let by = |(&value, &size): (&f64, &f64)| value + (rounding.of(size.max(least)) - size.max(least));
        Place {
            t: rounding.of(place.t),
            x: place.x.iter().map(|&x| rounding.of(x)).collect(),
            z: place.z.iter().map(|&z| rounding.of(z)).collect(),
            w: place.w.iter().zip(sizes).map(by).collect(),
        }
    }

    /// The equations at a place.
    pub(crate) fn at(&self, at: &Place, rounding: &Rounding) -> Result<Derived, Irregular> {
        let k = at.w.len();
        let here = self.still(at, rounding);
        let (velocity, state_rates) = (here.velocities()?.to_vec(), here.all(&self.text.state_rates)?);
        let in_time = Direction { z: state_rates.clone(), ..at.in_time(&velocity) };
        let frame = self.frame(at, rounding)?;

        let mut mass = DMatrix::zeros(k, k);
        let (mut momenta, mut transport, mut work) = (vec![0.0; k], vec![0.0; k], vec![0.0; k]);
        for s in 0..k {
            let along = at.along_velocity(s);
            for r in s..k {
                let value = self.twice(at, &along, &at.along_velocity(r), rounding).lagrangian()?;
                mass[(s, r)] = value.eps.eps;
                mass[(r, s)] = value.eps.eps;
            }
            let value = self.twice(at, &along, &in_time, rounding).lagrangian()?;
            (momenta[s], transport[s]) = (value.re.eps, value.eps.eps);
            work[s] = self.once(at, &at.along(frame[s].clone()), rounding).lagrangian()?.eps;
        }
        let transposed = self.transposed(at, &velocity, &frame, &momenta, rounding)?;
        let unit = |s: usize| Virtual { w: at.along_velocity(s), x: frame[s].clone() };
        let forces = self.forces(at, &(0..k).map(unit).collect::<Vec<_>>(), rounding)?;
        let rows = self.constraint_matrix(&self.kept, at, rounding)?;
        let drift = self.constraint_rates(&self.kept, at, &in_time, rounding)?;

        // M ẇ − Cᵀλ = p·δw + XL + Q − D_t p at ẇ = 0,  C ẇ = −(D_t φ at ẇ = 0)
        let l = rows.len();
        let system = DMatrix::from_fn(k + l, k + l, |i, j| match (i < k, j < k) {
            (true, true) => mass[(i, j)],
            (true, false) => -rows[j - k][i],
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
        let momentum_sizes: Vec<f64> =
            (0..k).map(|s| (0..k).map(|r| (mass[(s, r)] * at.w[r]).abs()).fold(0.0, f64::max)).collect();
        let led = |s: usize| {
            (0..k).map(|r| (inverse[(s, r)] * momentum_sizes[r]).abs()).fold(at.w[s].abs(), f64::max)
        };
        let velocity_sizes = (0..k).map(led).collect();
        let along_time = self.once(at, &in_time, rounding).lagrangian()?;
        let through_velocities: f64 = momenta.iter().zip(&accelerations).map(|(p, w)| p * w).sum();
        Ok(Derived {
            place: at.clone(),
            velocities: velocity,
            state_rates,
            acceleration_sizes: sizes[..k].to_vec(),
            reactions: values[k..].to_vec(),
            reaction_sizes: sizes[k..].to_vec(),
            momentum_rates: (0..k).map(|s| transport[s] + inertia(s)).collect(),
            momentum_rate_sizes: (0..k).map(|s| inertia_size(s).max(transport[s].abs())).collect(),
            momenta,
            momentum_sizes,
            velocity_sizes,
            lagrangian: along_time.re,
            lagrangian_rate: along_time.eps + through_velocities,
            accelerations,
            condition,
        })
    }

    /// The constraints left out as following from others are followed by the motion, too.
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
        let exact = Rounding::none();
        let rows = self.constraint_matrix(&dropped, at, &exact)?;
        let drift = self.constraint_rates(&dropped, at, in_time, &exact)?;
        for (row, drift) in rows.iter().zip(drift) {
            let mut rate = Balance::default();
            rate.add(drift);
            row.iter().zip(accelerations).for_each(|(c, w)| rate.add(c * w));
            if !within(rate.sum.abs(), FOLLOWED * rate.largest.max(1.0)) {
                return Err(Irregular::OffConstraints);
            }
        }
        Ok(())
    }

    /// ∂η_s/∂w of the quasi-velocities, a row for each; those of ordinary velocities where none is declared.
    pub(crate) fn quasi_velocity_matrix(
        &self,
        at: &Place,
        rounding: &Rounding,
    ) -> Result<Vec<Vec<f64>>, Irregular> {
        let k = at.w.len();
        let mut rows = vec![Vec::new(); self.declared()];
        for s in 0..k {
            let column = self.columns(&self.once(at, &at.along_velocity(s), rounding))?;
            rows.iter_mut().zip(column).for_each(|(row, entry)| row.push(entry.eps));
        }
        Ok(rows)
    }

    /// Number of the quasi-velocities that are columns.
    pub(crate) fn declared(&self) -> usize {
        match self.text.names.quasi_velocities.len() {
            0 => self.text.coordinates(),
            declared => declared,
        }
    }

    /// η; ẋ where none is declared.
    pub(crate) fn columns<T: Number>(&self, point: &Point<'_, T>) -> Result<Vec<T>, Irregular> {
        if self.text.names.quasi_velocities.is_empty() {
            return Ok(point.velocities()?.to_vec());
        }
        point.quasi_velocities()
    }

    /// The velocities w at which η has these values and the constraints hold, found by least squares where w = ẋ.
    pub(crate) fn velocities_of(&self, t: f64, x: &[f64], eta: &[f64]) -> Result<Vec<f64>, Irregular> {
        match &self.text.velocities {
            Velocities::Quasi(_) => return Ok(eta.to_vec()),
            Velocities::Ordinary(definitions) if definitions.is_empty() => return Ok(eta.to_vec()),
            Velocities::Ordinary(_) => {}
        }
        let exact = Rounding::none();
        let all: Vec<usize> = (0..self.on_positions.len()).collect();
        // First-order states stand in no definition and no constraint.
        let mut at =
            Place { t, x: x.to_vec(), w: vec![0.0; x.len()], z: vec![0.0; self.text.state_rates.len()] };
        for _ in 0..NEWTON {
            let mut rows = self.quasi_velocity_matrix(&at, &exact)?;
            rows.extend(self.constraint_matrix(&all, &at, &exact)?);
            let found = self.columns(&self.still(&at, &exact))?;
            let mut rest: Vec<f64> = eta.iter().zip(found).map(|(wanted, found)| wanted - found).collect();
            rest.extend(self.constraints(&all, &at, &exact)?.iter().map(|phi| -phi));
            let (inverse, _) = pseudo_inverse(&matrix(&rows, x.len())).ok_or(Irregular::Singular)?;
            let step = inverse * DMatrix::from_column_slice(rest.len(), 1, &rest);
            at.w.iter_mut().zip(step.iter()).for_each(|(w, step)| *w += step);
            let size = at.w.iter().fold(1.0f64, |size, w| size.max(w.abs()));
            if step.iter().all(|step| step.abs() <= SETTLED * size) {
                return Ok(at.w);
            }
        }
        Err(Irregular::OffConstraints)
    }

    /// ẋ where all quasi-velocities vanish, those that complete the ones defined among them, and its rate along the motion:
    /// what b_0 is where quasi-velocities are defined by ẋ. Zero otherwise: in the velocities w = η there is nothing to add.
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
        let (inverse, _) = pseudo_inverse(&matrix(&rows, zero.len())).ok_or(Irregular::Singular)?;
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

/// The brackets of a frame close to rounding; an error of derivation is of order one.
const CLOSED: f64 = 1e-7;

/// What a constraint that follows from others may leave, to the same.
const FOLLOWED: f64 = 1e-6;

/// Steps of Newton's method.
pub(crate) const NEWTON: usize = 30;

/// A step that is rounding.
pub(crate) const SETTLED: f64 = 1e-13;
