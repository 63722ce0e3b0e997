//! The compared quantities, with the sizes of their rounding errors.

use crate::comparison::natural::{SHARED, motion, natural_size};
use crate::comparison::solved::Solved;
use crate::derivation::derivation::Derivation;
use crate::derivation::equations::Derived;
use crate::derivation::here::Here;
use crate::derivation::place::{Direction, Place};
use crate::derivation::quantity::{Free, Quantity};
use crate::error::Irregular;
use crate::numbers::linear::{matrix, solve};
use crate::numbers::rounding::{Rounding, UNIT, within};
use crate::numbers::sized::Sized;
use crate::text::resultant::Resultants;

/// Momenta of independent quasi-velocities, with the others determined by constraints.
struct Momenta {
    values: Vec<Sized>,
    rates: Vec<Sized>,
    energy: Sized,
    energy_rate: Sized,
    condition: f64,
}

/// The number of evaluations with deliberate rounding errors.
pub(crate) const REPETITIONS: u64 = 3;

/// The condition number beyond which equations are too inaccurate.
const WORST_CONDITION: f64 = 1e10;

/// The condition number beyond which a choice of independent velocities fails.
const WORST_CHOICE: f64 = 1e4;

impl Derivation {
    /// The equations repeated with deliberate rounding errors.
    pub(crate) fn scattered(&self, derived: &Derived) -> Result<Vec<(Rounding, Derived)>, Irregular> {
        let again = |seed| {
            let rounding = Rounding::made(seed);
            let place = self.near(&derived.place, &derived.velocity_sizes, &rounding);
            let derived = self.at(&place, &rounding)?;
            Ok((rounding, derived))
        };
        (1..=REPETITIONS).map(again).collect()
    }

    /// Quantities of the equations at a state, each with the largest of its terms, propagated through the
    /// linear equations.
    pub(crate) fn quantities(
        &self,
        derived: &Derived,
        wanted: &[Quantity],
        free: Option<&[Free]>,
        rounding: &Rounding,
    ) -> Result<Vec<Sized>, Irregular> {
        let at = &derived.place;
        if !within(derived.condition, WORST_CONDITION) {
            return Err(Irregular::IllConditioned);
        }
        let momenta = free.map(|free| self.momenta(derived, free, rounding)).transpose()?;
        if momenta.as_ref().is_some_and(|momenta| !within(momenta.condition, WORST_CHOICE)) {
            return Err(Irregular::IllConditioned);
        }
        let along = motion(derived);
        let moving = self.once(at, &along, rounding);
        let columns = self.columns(&moving)?;
        let column_sizes = self.column_sizes(derived)?;
        let accelerates = wanted.iter().any(|quantity| matches!(quantity, Quantity::Acceleration(_)));
        let acceleration_sizes = if accelerates { self.acceleration_sizes(derived)? } else { Vec::new() };
        let velocities = moving.velocities()?;
        let energy = self.energy(derived, rounding)?;
        let resultants = self.needed_resultants(derived, wanted, rounding)?;
        let observed = self.observed(derived, wanted, resultants.clone(), rounding)?;
        let of_momenta = |pick: &dyn Fn(&Momenta) -> Sized| momenta.as_ref().map(pick).unwrap_or_default();
        let quantity = |(place, wanted): (usize, &Quantity)| match *wanted {
            Quantity::Velocity(i) => Sized { value: derived.velocities[i], size: 0.0 },
            Quantity::Acceleration(i) => Sized { value: velocities[i].eps, size: acceleration_sizes[i] },
            Quantity::StateRate(j) => Sized { value: derived.state_rates[j], size: 0.0 },
            Quantity::Column(s) => Sized { value: columns[s].re, size: column_sizes[s].0 },
            Quantity::ColumnRate(s) => Sized { value: columns[s].eps, size: column_sizes[s].1 },
            Quantity::Zero => Sized::default(),
            Quantity::Reaction(a) => match self.kept.iter().position(|&kept| kept == a) {
                Some(place) => Sized { value: derived.reactions[place], size: derived.reaction_sizes[place] },
                None => Sized::default(),
            },
            Quantity::Resultant(resultant) => {
                resultants.as_ref().map(|all| all.get(resultant)).unwrap_or_default()
            }
            Quantity::Energy => energy,
            Quantity::Momentum(f) => of_momenta(&|momenta| momenta.values[f]),
            Quantity::MomentumRate(f) => of_momenta(&|momenta| momenta.rates[f]),
            Quantity::FreeEnergy => of_momenta(&|momenta| momenta.energy),
            Quantity::FreeEnergyRate => of_momenta(&|momenta| momenta.energy_rate),
            Quantity::Observed(_) => observed[place],
        };
        let sized = |(place, wanted)| {
            let Sized { value, size } = quantity((place, wanted));
            let size = if value.abs() <= size { size } else { value.abs() };
            if size.is_finite() {
                Ok(Sized { value, size })
            } else {
                Err(Irregular::NotFinite { what: "a quantity" })
            }
        };
        let mut quantities =
            wanted.iter().enumerate().map(sized).collect::<Result<Vec<Sized>, Irregular>>()?;
        let [drift, _] = self.drift(at, &derived.velocities, &Rounding::none())?;
        raise(&mut quantities, wanted, |quantity| natural_size(derived, &drift, quantity));
        Ok(quantities)
    }

    /// Raises the sizes of quantities to at least their scatter, in units of the rounding error, when the
    /// computation is repeated with rounding errors.
    pub(crate) fn scatter(
        &self,
        quantities: &mut [Sized],
        scattered: &[(Rounding, Here)],
        wanted: &[Quantity],
        free: Option<&[Free]>,
    ) -> Result<(), Irregular> {
        for (rounding, near) in scattered {
            let moved = self.quantities(&near.derived, wanted, free, rounding)?;
            for (quantity, moved) in quantities.iter_mut().zip(moved) {
                quantity.size = quantity.size.max((moved.value - quantity.value).abs() / UNIT);
            }
        }
        Ok(())
    }

    /// For each η_s, the largest product of |∂η_s/∂w_r| and the terms of w_r, and the largest with the terms
    /// of ẇ_r instead.
    fn column_sizes(&self, derived: &Derived) -> Result<Vec<(f64, f64)>, Irregular> {
        let rows = self.quasi_velocity_matrix(&derived.place, &Rounding::none())?;
        let led = |row: &[f64], sizes: &[f64]| {
            row.iter().zip(sizes).map(|(a, size)| (a * size).abs()).fold(0.0, f64::max)
        };
        let both =
            |row: &Vec<f64>| (led(row, &derived.velocity_sizes), led(row, &derived.acceleration_sizes));
        Ok(rows.iter().map(both).collect())
    }

    /// For each ẋ_i, the largest product of |b_is| and the terms of ẇ_s.
    fn acceleration_sizes(&self, derived: &Derived) -> Result<Vec<f64>, Irregular> {
        let frame = self.frame(&derived.place, &Rounding::none())?;
        let led = |i: usize| {
            let terms = frame.iter().zip(&derived.acceleration_sizes).map(|(b, size)| (b[i] * size).abs());
            terms.fold(0.0, f64::max)
        };
        Ok((0..derived.velocities.len()).map(led).collect())
    }

    /// p·(w − b_0) − L, which is y·η − L.
    fn energy(&self, derived: &Derived, rounding: &Rounding) -> Result<Sized, Irregular> {
        let at = &derived.place;
        let [drift, _] = self.drift(at, &derived.velocities, rounding)?;
        let terms = (0..at.w.len()).map(|s| derived.momenta[s] * (at.w[s] - drift[s]));
        Ok(sum(terms.chain([-derived.lagrangian])))
    }

    /// The reactions on bodies, if they are compared or occur in observables.
    pub(crate) fn needed_resultants(
        &self,
        derived: &Derived,
        wanted: &[Quantity],
        rounding: &Rounding,
    ) -> Result<Option<Resultants>, Irregular> {
        let needs = |quantity: &Quantity| match quantity {
            Quantity::Resultant(_) => true,
            Quantity::Observed(j) => self.text.observed[*j].1.has_resultants(),
            _ => false,
        };
        let needed = wanted.iter().any(needs);
        needed.then(|| self.resultants(derived, rounding)).transpose()
    }

    /// The integrals and outputs among the wanted quantities, at their indices.
    fn observed(
        &self,
        derived: &Derived,
        wanted: &[Quantity],
        resultants: Option<Resultants>,
        rounding: &Rounding,
    ) -> Result<Vec<Sized>, Irregular> {
        let sizes = match rounding.is_none() {
            true => self.led_to_observed(derived, wanted, resultants.as_ref())?,
            false => vec![0.0; wanted.len()],
        };
        let point = self.on_motion(&Solved::of(derived, resultants), derived, rounding);
        let value = |(wanted, led): (&Quantity, f64)| match wanted {
            Quantity::Observed(j) => {
                let term = &self.text.observed[*j].1;
                let size = rounding.suspended(|| point.largest_term(term))?;
                Ok(Sized { value: point.value(term)?, size: size.max(led) })
            }
            _ => Ok(Sized::default()),
        };
        wanted.iter().zip(sizes).map(value).collect()
    }

    /// The matrix whose rows are ∂φ_α/∂w and ∂η_f/∂w, and its rate.
    pub(crate) fn adapted(
        &self,
        at: &Place,
        binding: &[usize],
        free: &[Free],
        motion: &Direction,
        rounding: &Rounding,
    ) -> Result<[Vec<Vec<f64>>; 2], Irregular> {
        self.along_velocities_and(at, motion, rounding, |point| {
            let (columns, velocities) = (self.columns(point)?, point.velocities()?);
            let constraint = |a: usize| point.velocity_constraint(a, self.on_positions[a]);
            let free = free.iter().map(|&free| match free {
                Free::Column(column) => Ok(columns[column]),
                Free::Velocity(i) => Ok(velocities[i]),
                Free::Constraint(a) => constraint(a),
            });
            binding.iter().map(|&a| constraint(a)).chain(free).collect()
        })
    }

    /// y_f = p·W_f, where the virtual velocity W_f has the free quasi-velocity f equal to 1 and the other
    /// free ones equal to 0, and satisfies the constraints unless all quasi-velocities are free.
    fn momenta(&self, derived: &Derived, free: &[Free], rounding: &Rounding) -> Result<Momenta, Irregular> {
        let at = &derived.place;
        let k = at.w.len();
        let binding: &[usize] = if free.len() == k { &[] } else { &self.kept };
        let l = binding.len();
        if l + free.len() != k {
            return Err(Irregular::Singular);
        }
        let exact = Rounding::none();
        let motion = motion(derived);
        let [rows, rates] = self.adapted(at, binding, free, &motion, rounding)?;
        let nothing = vec![0.0; k];
        let solution = solve(&matrix(&rows, k), &nothing, &nothing)?;
        let virtual_velocities = solution.inverse.columns(l, free.len()).into_owned();
        let virtual_rates = -(&solution.inverse * (matrix(&rates, k) * &virtual_velocities));
        // The change of w with time, and along the virtual displacements, at fixed free velocities.
        let mut sizes = solution.inverse.abs() * (matrix(&rates, k).abs() * virtual_velocities.abs());
        let frame = self.frame(at, &exact)?;
        for f in 0..free.len() {
            let along = |i: usize| (0..k).map(|s| frame[s][i] * virtual_velocities[(s, f)]).sum();
            let displacement = at.along((0..at.x.len()).map(along).collect());
            let turned = self.constraint_rates(binding, at, &displacement, &exact)?;
            for (s, (place, rate)) in
                (0..k).flat_map(|s| turned.iter().enumerate().map(move |turned| (s, turned)))
            {
                sizes[(s, f)] = f64::max(sizes[(s, f)], (solution.inverse[(s, place)] * rate).abs());
            }
        }
        let of = |f: usize| -> [Sized; 2] {
            let (w, rate) = (virtual_velocities.column(f), virtual_rates.column(f));
            let mut value = sum((0..k).map(|s| derived.momenta[s] * w[s]));
            let terms = (0..k).map(|s| (derived.momentum_sizes[s] * w[s]).abs());
            value.size = terms.fold(value.size, f64::max);
            let mut change =
                sum((0..k).flat_map(|s| [derived.momentum_rates[s] * w[s], derived.momenta[s] * rate[s]]));
            let led = (0..k).map(|s| (derived.momentum_rate_sizes[s] * w[s]).abs());
            let turned = (0..k).map(|s| (derived.momentum_sizes[s] * sizes[(s, f)]).abs());
            change.size = led.chain(turned).fold(change.size, f64::max);
            [value, change]
        };
        let (values, momentum_rates): (Vec<Sized>, Vec<Sized>) =
            (0..free.len()).map(of).map(|[value, rate]| (value, rate)).unzip();
        let point = self.once(at, &motion, &exact);
        let (columns, velocities) = (self.columns(&point)?, point.velocities()?);
        let (sizes, acceleration_sizes) = (self.column_sizes(derived)?, self.acceleration_sizes(derived)?);
        // Left sides of constraints vanish and do not contribute.
        let moving = free.iter().enumerate().filter_map(|(f, &free)| match free {
            Free::Column(column) => Some((f, columns[column], sizes[column].1)),
            Free::Velocity(i) => Some((f, velocities[i], acceleration_sizes[i])),
            Free::Constraint(_) => None,
        });
        let moving: Vec<_> = moving.collect();
        let terms = moving.iter().map(|&(f, eta, _)| values[f].value * eta.re);
        let energy = sum(terms.chain([-derived.lagrangian]));
        let rates = moving
            .iter()
            .flat_map(|&(f, eta, _)| [momentum_rates[f].value * eta.re, values[f].value * eta.eps]);
        let mut energy_rate = sum(rates.chain([-derived.lagrangian_rate]));
        let led = moving.iter().flat_map(|&(f, eta, size)| {
            [(momentum_rates[f].size * eta.re).abs(), (values[f].value * size).abs()]
        });
        energy_rate.size = led.fold(energy_rate.size, f64::max);
        Ok(Momenta { values, rates: momentum_rates, energy, energy_rate, condition: solution.condition })
    }
}

/// Raises sizes: quantities that result from the same elimination are uncertain by some rounding errors of
/// the largest of these quantities, or of their natural size.
fn raise(quantities: &mut [Sized], wanted: &[Quantity], natural_size: impl Fn(&Quantity) -> f64) {
    for (quantity, wanted) in quantities.iter_mut().zip(wanted) {
        quantity.size = quantity.size.max(SHARED * natural_size(wanted));
    }
    for kind in wanted.iter().map(std::mem::discriminant) {
        if kind == std::mem::discriminant(&Quantity::Observed(0)) {
            continue;
        }
        let alike = |other: &Quantity| std::mem::discriminant(other) == kind;
        let sizes = quantities.iter().zip(wanted).filter(|(_, other)| alike(other));
        let largest = sizes.fold(0.0, |largest, (quantity, _)| f64::max(largest, quantity.size));
        let raised = quantities.iter_mut().zip(wanted).filter(|(_, other)| alike(other));
        raised.for_each(|(quantity, _)| quantity.size = quantity.size.max(SHARED * largest));
    }
}

/// A sum, with the largest of its terms.
fn sum(terms: impl Iterator<Item = f64>) -> Sized {
    terms.fold(Sized::default(), |sum, term| Sized {
        value: sum.value + term,
        size: if term.abs() <= sum.size { sum.size } else { term.abs() },
    })
}
