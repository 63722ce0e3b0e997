//! Transforms between quasi-velocities and momenta.

use pc_mech::{LegendreTransform, MechError};

use crate::api::rates::{State, Target, all_finite, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::status::pc_status;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

impl Inner {
    /// The Legendre transform of the state, derived on first use.
    pub(crate) fn legendre(&mut self, inventory: &Inventory) -> Result<&mut LegendreTransform, CallError> {
        let derive = || {
            inventory.derive(|model| {
                model.derived(|assembly| Ok(assembly.legendre_transform(inventory.facts.variables)?))
            })
        };
        let is_new = self.legendre.is_none();
        let transform = inventory.derivations.legendre.own(&mut self.legendre, derive)?;
        if is_new {
            transform.parameters_mut().copy_from_slice(self.field.parameters());
        }
        Ok(transform)
    }
}

/// Writes the state (x, p) with the momenta p_s = ∂L/∂η_s of the state (x, η). The first call
/// derives the transform, as pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_to_momenta(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    result: *mut f64,
    result_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let (state, target) = (State { y, length: y_length }, (result, result_length));
    // SAFETY: as the preamble demands.
    unsafe { transformed(system, t, state, target, error, LegendreTransform::to_momenta_in) }
}

/// Writes the state (x, η) with the quasi-velocities of the state (x, p). The first call derives
/// the transform, as pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_to_quasi_velocities(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    result: *mut f64,
    result_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let (state, target) = (State { y, length: y_length }, (result, result_length));
    // SAFETY: as the preamble demands.
    unsafe { transformed(system, t, state, target, error, LegendreTransform::to_quasi_velocities_in) }
}

/// # Safety
/// As the preamble demands.
unsafe fn transformed(
    system: *const pc_system,
    t: f64,
    state: State,
    (data, length): (*mut f64, usize),
    error: *mut *mut pc_error,
    transform: impl FnOnce(&mut LegendreTransform, f64, &[f64], &mut [f64]) -> Result<(), MechError>,
) -> pc_status {
    let transform = |inventory: &Inventory, inner: &mut Inner| {
        let dim = inventory.dim();
        let target = Target { data, length, expected: dim, what: "result" };
        // SAFETY: as promised.
        let (y, result) = unsafe { slices(state, dim, target) }?;
        transform(inner.legendre(inventory)?, t, y, result)?;
        all_finite("the result", result)
    };
    // SAFETY: as promised.
    unsafe { inside(system, error, transform) }
}
