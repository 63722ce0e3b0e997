//! The second derivation: the text evaluated over dual numbers at a place, and the parts that are linear in
//! velocities there.

use std::collections::BTreeMap;

use nalgebra::SVector;
use num_dual::Derivative;

use crate::derivation::place::{Direction, Place};
use crate::derivation::point::Point;
use crate::derivation::structure::Structure;
use crate::error::Irregular;
use crate::numbers::linear::independent_rows;
use crate::numbers::number::{D1, D2, LANES, Lanes, MovingLanes};
use crate::numbers::rounding::Rounding;
use crate::numbers::units::Units;
use crate::text::couplings::Couplings;
use crate::text::text::Text;

/// An undeclared quasi-velocity, added to bring those defined by `is` up to the number of coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Completing {
    /// ẋ_i
    Velocity(usize),
    /// The left-hand side of a constraint, which is 0.
    Constraint(usize),
}

impl Completing {
    pub(crate) fn velocity(&self) -> Option<usize> {
        if let Completing::Velocity(i) = self { Some(*i) } else { None }
    }

    pub(crate) fn constraint(&self) -> Option<usize> {
        if let Completing::Constraint(a) = self { Some(*a) } else { None }
    }
}

/// The second derivation of a model.
#[derive(Clone, Debug)]
pub(crate) struct Derivation {
    pub(crate) text: Text,
    /// Whether each constraint is free of velocities.
    pub(crate) on_positions: Vec<bool>,
    /// The constraints that are independent of the preceding ones.
    pub(crate) kept: Vec<usize>,
    /// The quasi-velocities added to the declared ones.
    pub(crate) completing: Vec<Completing>,
    pub(crate) structure: Structure,
    /// The record of which second derivatives of L with respect to velocities vanish.
    pub(crate) couplings: Couplings,
    /// The sizes of the components of states.
    pub(crate) units: Units,
}

impl Derivation {
    /// The point at a place that changes in one direction.
    pub(crate) fn once<'a>(&'a self, at: &Place, along: &Direction, rounding: &'a Rounding) -> Point<'a, D1> {
        let both = |values: &[f64], rates: &[f64]| -> Vec<D1> {
            values.iter().zip(rates).map(|(&value, &rate)| D1::new(value, rate)).collect()
        };
        let all = [both(&at.x, &along.x), both(&at.w, &along.w), both(&at.z, &along.z)];
        Point::new(&self.text, rounding, D1::new(at.t, along.t), all)
    }

    /// The derivatives along every velocity w_s, a row for each of the values that are found at a point.
    pub(crate) fn along_velocities(
        &self,
        at: &Place,
        rounding: &Rounding,
        values: impl Fn(&Point<'_, Lanes>) -> Result<Vec<Lanes>, Irregular>,
    ) -> Result<Vec<Vec<f64>>, Irregular> {
        let still = |values: &[f64]| values.iter().map(|&value| Lanes::from_re(value)).collect();
        let mut rows = Vec::new();
        for first in (0..at.w.len()).step_by(LANES) {
            let place = [still(&at.x), lanes(&at.w, first), still(&at.z)];
            let point = Point::new(&self.text, rounding, Lanes::from_re(at.t), place);
            append(&mut rows, at.w.len() - first, values(&point)?);
        }
        Ok(rows)
    }

    /// The derivatives along every one of these fields of directions in x.
    fn along_fields(
        &self,
        at: &Place,
        fields: &[Vec<f64>],
        rounding: &Rounding,
        values: impl Fn(&Point<'_, Lanes>) -> Result<Vec<Lanes>, Irregular>,
    ) -> Result<Vec<Vec<f64>>, Irregular> {
        let still = |values: &[f64]| values.iter().map(|&value| Lanes::from_re(value)).collect();
        let mut rows = Vec::new();
        for (first, fields) in (0..).step_by(LANES).zip(fields.chunks(LANES)) {
            let moved = |(i, &x): (usize, &f64)| {
                let along = |lane: usize| fields.get(lane).map_or(0.0, |field| field[i]);
                Lanes::new(x, Derivative::some(SVector::from_fn(|lane, _| along(lane))))
            };
            let place = [at.x.iter().enumerate().map(moved).collect(), still(&at.w), still(&at.z)];
            let point = Point::new(&self.text, rounding, Lanes::from_re(at.t), place);
            append(&mut rows, at.w.len() - first, values(&point)?);
        }
        Ok(rows)
    }

    /// The derivatives along every velocity w_s at a place that also changes in a direction, and their rates in that direction.
    pub(crate) fn along_velocities_and(
        &self,
        at: &Place,
        direction: &Direction,
        rounding: &Rounding,
        values: impl Fn(&Point<'_, MovingLanes>) -> Result<Vec<MovingLanes>, Irregular>,
    ) -> Result<[Vec<Vec<f64>>; 2], Irregular> {
        let moving = |value: Lanes, rate: &f64| MovingLanes::new(value, Lanes::from_re(*rate));
        let along = |values: &[f64], rates: &[f64]| {
            values.iter().zip(rates).map(|(&value, rate)| moving(Lanes::from_re(value), rate)).collect()
        };
        let [mut rows, mut rates] = [Vec::new(), Vec::new()];
        for first in (0..at.w.len()).step_by(LANES) {
            let w = lanes(&at.w, first).into_iter().zip(&direction.w).map(|(w, rate)| moving(w, rate));
            let place = [along(&at.x, &direction.x), w.collect(), along(&at.z, &direction.z)];
            let t = moving(Lanes::from_re(at.t), &direction.t);
            let values = values(&Point::new(&self.text, rounding, t, place))?;
            append(&mut rows, at.w.len() - first, values.iter().map(|value| value.re));
            append(&mut rates, at.w.len() - first, values.iter().map(|value| value.eps));
        }
        Ok([rows, rates])
    }

    /// The point at a place that changes in two directions.
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

    /// The point at a place that does not change.
    pub(crate) fn still<'a>(&'a self, at: &Place, rounding: &'a Rounding) -> Point<'a, f64> {
        Point::new(&self.text, rounding, at.t, [at.x.clone(), at.w.clone(), at.z.clone()])
    }

    /// The values φ_α of these constraints.
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

    /// The matrix ∂φ_α/∂w_s, with a row for each of these constraints. A constraint f(t, x) = 0 on positions restricts velocities by
    /// φ = X_0 f + w_s X_s f: its row holds X_s f.
    pub(crate) fn constraint_matrix(
        &self,
        which: &[usize],
        at: &Place,
        rounding: &Rounding,
    ) -> Result<Vec<Vec<f64>>, Irregular> {
        // First-order states have rates of their own, which may contain velocities.
        let has_states = !self.text.state_rates.is_empty();
        let (of_positions, others): (Vec<usize>, Vec<usize>) =
            which.iter().partition(|&&a| self.on_positions[a] && !has_states);
        let values = |point: &Point<'_, Lanes>| {
            of_positions.iter().map(|&a| point.velocity_constraint(a, false)).collect()
        };
        let along_fields = match of_positions.is_empty() {
            true => Vec::new(),
            false => self.along_fields(at, &self.frame(at, rounding)?, rounding, values)?,
        };
        let values = |point: &Point<'_, Lanes>| {
            others.iter().map(|&a| point.velocity_constraint(a, self.on_positions[a])).collect()
        };
        let along_velocities = match others.is_empty() {
            true => Vec::new(),
            false => self.along_velocities(at, rounding, values)?,
        };
        let found = of_positions.iter().zip(along_fields).chain(others.iter().zip(along_velocities));
        let found: BTreeMap<usize, Vec<f64>> = found.map(|(&a, row)| (a, row)).collect();
        // Without velocities no rows are found, although there may be constraints.
        Ok(which.iter().map(|a| found.get(a).cloned().unwrap_or_default()).collect())
    }

    /// b_s for all s.
    pub(crate) fn frame(&self, at: &Place, rounding: &Rounding) -> Result<Vec<Vec<f64>>, Irregular> {
        let rows = self.along_velocities(at, rounding, |point| Ok(point.velocities()?.to_vec()))?;
        Ok((0..at.w.len()).map(|s| rows.iter().map(|row| row[s]).collect()).collect())
    }

    /// Those of the given constraints that are independent of the preceding ones at a place.
    pub(crate) fn independent(&self, at: &Place, of: &[usize]) -> Result<Vec<usize>, Irregular> {
        let rows = independent_rows(&self.constraint_matrix(of, at, &Rounding::none())?, at.w.len());
        Ok(rows.into_iter().map(|row| of[row]).collect())
    }

    /// The place moved by the rounding errors of a state; w is moved by the errors of terms of these sizes.
    pub(crate) fn near(&self, place: &Place, sizes: &[f64], rounding: &Rounding) -> Place {
        // Constraints mix velocities, so each is as uncertain as the largest.
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
}

/// Velocities, of which those from `first` on change, each in a lane of its own.
fn lanes(w: &[f64], first: usize) -> Vec<Lanes> {
    let mut lanes: Vec<Lanes> = w.iter().map(|&w| Lanes::from_re(w)).collect();
    for (lane, w) in lanes[first..].iter_mut().take(LANES).enumerate() {
        *w = w.derivative(lane);
    }
    lanes
}

/// Appends the derivatives of each value to its row; `left` velocities are left, of which a number holds only so many.
fn append(rows: &mut Vec<Vec<f64>>, left: usize, values: impl IntoIterator<Item = Lanes>) {
    for (place, value) in values.into_iter().enumerate() {
        if place == rows.len() {
            rows.push(Vec::with_capacity(left));
        }
        rows[place].extend((0..LANES.min(left)).map(|lane| value.eps.0.map_or(0.0, |rates| rates[lane])));
    }
}
