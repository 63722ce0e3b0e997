//! Dry friction along virtual velocities, as a multiple of the normal force.

use crate::derivation::derivation::Derivation;
use crate::derivation::place::{Place, Virtual};
use crate::error::{Irregular, Unable};
use crate::numbers::rounding::Rounding;

/// The forces of friction of one contact along some virtual velocities, for a normal force of 1.
pub(crate) struct Drag {
    /// The place of its constraint among those that are kept.
    pub(crate) kept: usize,
    pub(crate) per_normal_force: Vec<f64>,
}

impl Derivation {
    /// −μ s_i/|s| ∂s_i/∂w along virtual velocities, for each contact with friction.
    pub(crate) fn drags(
        &self,
        at: &Place,
        along: &[Virtual],
        rounding: &Rounding,
    ) -> Result<Vec<Drag>, Irregular> {
        let still = self.still(at, rounding);
        let mut drags = Vec::with_capacity(self.text.frictions.len());
        for friction in &self.text.frictions {
            let kept = self.kept.iter().position(|&a| a == friction.constraint);
            let kept = kept.ok_or(Unable::NoReaction)?;
            let mut per_normal_force = vec![0.0; along.len()];
            for (part, slip) in friction.per_normal_force.iter().zip(&friction.slips) {
                let part = still.value(part)?;
                if part.is_nan() {
                    return Err(Irregular::Corner { function: "the friction of a contact" });
                }
                for (sum, along) in per_normal_force.iter_mut().zip(along) {
                    *sum -= part * self.once(at, &along.w, rounding).value(slip)?.eps;
                }
            }
            drags.push(Drag { kept, per_normal_force });
        }
        Ok(drags)
    }
}
