//! The derivatives of rates and observables by the state, the parameters and the external forces.

use ::pc_model::Flow;
use pc_mech::Motion;

use crate::ffi::call_error::CallError;
use crate::machinery::motion_field::MotionField;
use crate::machinery::system::{Inner, Inventory};

/// Which forces act at a state.
#[derive(Clone, Copy)]
pub(crate) enum Forces<'a> {
    /// Those of the function that was set.
    OfFunction,
    /// These.
    Given(&'a [f64]),
}

impl Inner {
    /// The motion with all its first derivatives, derived on first use, in which the external forces are numbers that follow
    /// the parameters; both have their current values at (t, y).
    pub(crate) fn slopes(
        &mut self,
        inventory: &Inventory,
        (t, y): (f64, &[f64]),
        forces: Forces<'_>,
    ) -> Result<(&mut Motion, &mut MotionField), CallError> {
        let derive = || {
            inventory.derive(|mut model| {
                model.differentiate_observables(true);
                model.derived(|assembly| {
                    Ok(Box::new(Flow::new(&model, assembly, inventory.facts.variables)?.motion))
                })
            })
        };
        let motion = inventory.derivations.slopes.own(&mut self.slopes, derive)?;
        let parameters = self.field.parameters().len();
        motion.parameters_mut()[..parameters].copy_from_slice(self.field.parameters());
        match forces {
            Forces::OfFunction => motion.parameters_mut().copy_from_slice(self.field.inputs(t, y)?),
            Forces::Given(forces) => motion.parameters_mut()[parameters..].copy_from_slice(forces),
        }
        Ok((motion, &mut self.field))
    }
}

/// A matrix, column by column, to which the part that passes through the external forces is added: ∂h/∂q ∂q/∂y.
pub(crate) fn add_through_forces(
    jacobian: &mut [f64],
    by_forces: &[f64],
    force_slopes: &[f64],
    (rows, forces): (usize, usize),
) {
    for (column, slopes) in jacobian.chunks_exact_mut(rows).zip(force_slopes.chunks_exact(forces)) {
        for (by_force, slope) in by_forces.chunks_exact(rows).zip(slopes) {
            // A force on which an observable does not depend adds nothing, whatever its slope is.
            column.iter_mut().zip(by_force).for_each(|(entry, by_force)| *entry += by_force * slope);
        }
    }
}
