//! Reactions as forces and torques on bodies, determined by virtual work.
//!
//! Forces F at the points of the bodies, torques N on them and impulses on other terms of the kinetic energy
//! do the same work as the reactions, for all virtual velocities: Jᵀ F = λ_α ∂φ_α/∂w, where J has the rows
//! ∂ṙ/∂w, ∂ω/∂w and ∂p/∂w. The smallest F results from the pseudo-inverse; only the parts of F that the first
//! derivation considers determined are compared.

use nalgebra::DMatrix;

use crate::derivation::derivation::Derivation;
use crate::derivation::equations::Derived;
use crate::error::Irregular;
use crate::numbers::linear::shortest_inverse;
use crate::numbers::rounding::Rounding;
use crate::numbers::sized::Sized;
use crate::text::resultant::Resultants;

impl Derivation {
    /// λ_α (Jᵀ)⁺ ∂φ_α/∂w for all independent constraints.
    pub(crate) fn resultants(&self, derived: &Derived, rounding: &Rounding) -> Result<Resultants, Irregular> {
        let (at, text, k) = (&derived.place, &self.text, derived.place.w.len());
        let mut columns = Vec::with_capacity(k);
        let mut rows = Vec::new();
        for s in 0..k {
            let point = self.once(at, &at.along_velocity(s), rounding);
            let mut column = Vec::new();
            rows.clear();
            for body in &text.bodies {
                let force = column.len();
                column.extend(point.velocity(body)?.iter().map(|v| v.eps));
                rows.push([force, column.len()]);
                column.extend(point.angular_velocity(body)?.iter().map(|omega| omega.eps));
            }
            if text.has_own_energy {
                for r in 0..k {
                    if !self.couplings.has(s, r) {
                        column.push(0.0);
                        continue;
                    }
                    let point = self.twice(at, &at.along_velocity(s), &at.along_velocity(r), rounding);
                    column.push(point.own_lagrangian()?.eps.eps);
                }
            }
            columns.push(column);
        }
        let size = columns.first().map_or(0, Vec::len);
        let work = DMatrix::from_fn(k, size, |s, i| columns[s][i]);
        let (inverse, _) =
            shortest_inverse(&work).ok_or(Irregular::NotFinite { what: "a velocity of a body" })?;
        let constraints = self.constraint_matrix(&self.kept, at, rounding)?;
        let of = |i: usize, place: usize| {
            let terms = || (0..k).map(|s| inverse[(i, s)] * constraints[place][s]);
            let largest = terms().fold(0.0f64, |largest, term| largest.max(term.abs()));
            Sized {
                value: derived.reactions[place] * terms().sum::<f64>(),
                size: largest * derived.reaction_sizes[place].max(derived.reactions[place].abs()),
            }
        };
        let values = (0..size).map(|i| (0..self.kept.len()).map(|place| of(i, place)).collect()).collect();
        Ok(Resultants { rows, kept: self.kept.clone(), values })
    }
}
