//! The sizes of the components of a state, in the units of the text: they decide how far random states are from the
//! start.

use crate::derivation::place::Place;
use crate::numbers::rounding::Random;

/// A start value below this serves as the unit of its quantity; for a larger start value the unit is 1.
const SMALL: f64 = 1e-3;

/// A unit for each coordinate, velocity and first-order state: 1, unless the start has small values, such as lengths
/// of 1e-9 m; functions of such values overflow or vanish at a distance of 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Units {
    pub(crate) x: Vec<f64>,
    pub(crate) w: Vec<f64>,
    pub(crate) z: Vec<f64>,
}

impl Units {
    /// The units for a start. `frame` has a list of the b_is of ẋ_i = b_is w_s + … for each s; it is absent
    /// if w = ẋ.
    pub(crate) fn of(start: &Place, frame: Option<&[Vec<f64>]>) -> Units {
        let x = units(&start.x);
        let w = frame.map_or_else(|| x.clone(), |frame| velocity_units(frame, &start.x, &x));
        Units { x, w, z: units(&start.z) }
    }

    /// Random coordinates at about this distance, in their units, from the coordinates of a place.
    pub(crate) fn displaced(&self, from: &Place, scale: f64, random: &mut Random) -> Vec<f64> {
        let moved = |(x, unit): (&f64, &f64)| x + scale * (unit + x.abs()) * random.signed();
        from.x.iter().zip(&self.x).map(moved).collect()
    }

    /// Random velocities at about this distance, in their units, from the velocities of a place.
    pub(crate) fn faster(&self, from: &Place, scale: f64, random: &mut Random) -> Vec<f64> {
        let fastest = from.w.iter().fold(0.0f64, |fastest, w| fastest.max(w.abs()));
        let moved = |(w, unit): (&f64, &f64)| w + scale * (unit + fastest) * random.signed();
        from.w.iter().zip(&self.w).map(moved).collect()
    }
}

/// The units for some values: 1, or a small value itself; a value of 0 carries no information and is assigned
/// the largest unit of the others.
fn units(values: &[f64]) -> Vec<f64> {
    let known = |value: f64| (value != 0.0).then_some(if value < SMALL { value } else { 1.0 });
    let largest = values.iter().filter_map(|value| known(value.abs())).reduce(f64::max).unwrap_or(1.0);
    values.iter().map(|value| known(value.abs()).unwrap_or(largest)).collect()
}

/// The units of velocities, which move each coordinate in a unit of time by no more than the sum of its unit and
/// its own value; 1 if the coordinates have no smaller unit.
fn velocity_units(frame: &[Vec<f64>], x: &[f64], of_x: &[f64]) -> Vec<f64> {
    if of_x.iter().all(|&unit| unit >= 1.0) {
        return vec![1.0; frame.len()];
    }
    let reach = |(b, (x, unit)): (&f64, (&f64, &f64))| (x.abs() + unit) / b.abs();
    frame.iter().map(|b| b.iter().zip(x.iter().zip(of_x)).map(reach).fold(1.0, f64::min)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_values_tell_units_and_zeros_take_them() {
        assert_eq!(units(&[0.0, 0.0]), [1.0, 1.0]);
        assert_eq!(units(&[0.3, 0.0, -40.0]), [1.0, 1.0, 1.0]);
        assert_eq!(units(&[1e-9, 0.0]), [1e-9, 1e-9]);
        assert_eq!(units(&[1e-9, 2.0, 0.0]), [1e-9, 1.0, 1.0]);
    }
}
