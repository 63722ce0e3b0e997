//! The second derivation: the text evaluated over dual numbers at a place, and the parts that are linear in
//! velocities there.

use crate::derivation::place::{Direction, Place};
use crate::derivation::point::Point;
use crate::derivation::structure::Structure;
use crate::error::Irregular;
use crate::numbers::linear::independent_rows;
use crate::numbers::number::{D1, D2};
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

    /// The matrix ∂φ_α/∂w_s, with a row for each of these constraints.
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
