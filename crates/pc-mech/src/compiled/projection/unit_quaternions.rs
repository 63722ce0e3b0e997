//! Unit quaternions among the coordinates.

use pc_expr::Expr;
use serde::{Deserialize, Serialize};

use crate::system::system::System;

/// |q|² this close to 1 is that of components rounded to the nearest numbers. Moving a state for less would add noise to
/// the differences from which an integrator predicts the motion.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// The positions of quaternions in a state; each has |q| = 1.
///
/// The equations of a joint keep |q| constant, but an integrator does so only to its tolerance, and a quaternion whose
/// |q| is not 1 does not represent a rotation.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct UnitQuaternions {
    places: Vec<[usize; 4]>,
}

impl UnitQuaternions {
    /// The quaternions of a system, whose coordinates come first in its state.
    pub(crate) fn of(system: &System<'_>) -> UnitQuaternions {
        let x = system.frame.coordinates();
        let place = |component: &Expr<'_>| x.iter().position(|x| x == component);
        let places = |q: &[Expr<'_>; 4]| {
            let [a, b, c, d] = q.each_ref().map(place);
            Some([a?, b?, c?, d?])
        };
        UnitQuaternions { places: system.unit_quaternions.iter().filter_map(places).collect() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    pub(crate) fn places(&self) -> &[[usize; 4]] {
        &self.places
    }

    /// Replaces each q by q/|q|; returns whether any q changes. A zero quaternion is left unchanged: the equations
    /// are undefined there.
    #[inline]
    pub(crate) fn normalise(&self, y: &mut [f64]) -> bool {
        let mut changed = false;
        for &places in &self.places {
            let square: f64 = places.iter().map(|&i| y[i] * y[i]).sum();
            if (square - 1.0).abs() > ROUNDED && square.is_normal() {
                let norm = square.sqrt();
                places.iter().for_each(|&i| y[i] /= norm);
                changed = true;
            }
        }
        changed
    }
}
