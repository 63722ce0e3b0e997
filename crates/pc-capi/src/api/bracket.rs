//! The bracket of two functions of the state.

use std::ffi::c_char;

use ::pc_model::{Model, Variables};
use pc_expr::Evaluator;
use pc_print::bracket_of;

use crate::api::rates::{State, Target, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::text;
use crate::ffi::status::pc_status;
use crate::machinery::mechanics::evaluate;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes the value at (t, y) of the Poisson bracket (12), in coordinates and momenta, of two
/// functions,
///
///   (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + c_rs^m ∂f/∂y_s ∂g/∂y_r y_m,
///
/// so that (x_i, H) = ẋ_i and (y_s, H) = ẏ_s where nothing depends on time and there are no
/// forces. The functions are expressions of the model in coordinates and velocities; the
/// momenta y_s = ∂L/∂η_s are substituted. Under nonholonomic constraints the bracket is the
/// almost-Poisson bracket of the independent momenta. Each call derives equations, as pc_system_new
/// does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_bracket(
    system: *const pc_system,
    f: *const c_char,
    g: *const c_char,
    t: f64,
    y: *const f64,
    y_length: usize,
    value: *mut f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let target = Target { data: value, length: 1, expected: 1, what: "value" };
        // SAFETY: as the preamble demands.
        let (y, value) = unsafe { slices(State { y, length: y_length }, inventory.dim(), target) }?;
        // SAFETY: null or text, as the preamble demands.
        let (f, g) = unsafe { (text(f, "f")?, text(g, "g")?) };
        let mut bracket = inventory.derive(|model| derived(inventory, &model, f, g))?;
        inner.read_quasi_velocities(inventory, t, y)?;
        evaluate(&mut bracket, (t, &inner.room.state, inner.field.parameters()), value)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// The bracket (f, g) as a function of t and (x, η), where η are the quasi-velocities of the state.
fn derived(inventory: &Inventory, model: &Model, f: &str, g: &str) -> Result<Evaluator, CallError> {
    if !inventory.facts.variables.are_own() {
        let why = "the system is in other coordinates and quasi-velocities than those of the model";
        return Err(CallError::Unsupported { what: "a bracket", why });
    }
    model.derived(|assembly| {
        if assembly.constraints.nonlinear().is_some() {
            let why = "a constraint is not affine in the velocities";
            return Err(CallError::Unsupported { what: "a bracket", why });
        }
        let value = bracket_of(model, assembly, f, g)?;
        let equations = assembly.equations_in(Variables::QuasiVelocities)?;
        Ok(assembly.placed(equations.functions(&[value], &[]))?)
    })
}
