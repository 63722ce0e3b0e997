//! Lyapunov exponents of a motion, and gradients of functions of it.

use pc_expr::Failure;
use pc_mech::{Motion, VectorField};
use pc_solve::{
    AdjointOptions, Functional, LyapunovOptions, Method, adjoint_gradients_with_events, lyapunov_exponents,
};

use crate::api::options::{pc_method, pc_solver_options, take};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, numbers, room, write};
use crate::ffi::status::pc_status;
use crate::machinery::motion_field::MotionField;
use crate::machinery::slopes::{Forces, add_through_forces};
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes the largest Lyapunov exponents of the motion from the state y at the time t, in units
/// of inverse time and in descending order as far as they have converged; `exponents_length` is
/// their number, from 1 to the length of the state. As many deviations are integrated with the
/// motion and are made orthonormal again after each interval of time; the exponents are their
/// mean rates of growth over `intervals` intervals, after the first `transient` of them, which do
/// not count. The interval should be so short that its product with the difference of the
/// exponents is below 10. `options` may be NULL. Events of the model are not followed. Takes as
/// long as an integration over all intervals; PC_LIMIT as for a solver.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_lyapunov(
    system: *const pc_system,
    options: *const pc_solver_options,
    t: f64,
    y: *const f64,
    y_length: usize,
    interval: f64,
    intervals: u32,
    transient: u32,
    exponents: *mut f64,
    exponents_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let dim = inventory.dim();
        // SAFETY: null or options, as the preamble demands.
        let options = unsafe { take(options, "options")?.options(dim, inventory.deadline()) }?;
        if y_length == dim {
            apart((y, dim, "y"), (exponents, exponents_length, "exponents"))?;
        }
        // SAFETY: null or `y_length` numbers, as the preamble demands; the exponents share no memory with them.
        let y = unsafe { numbers(y, y_length, dim, "y") }?;
        // SAFETY: null or room for as many numbers, as the preamble demands.
        let exponents = unsafe { room(exponents, exponents_length, exponents_length, "exponents") }?;
        let wanted = LyapunovOptions::new(exponents.len(), interval, intervals).transient(transient);
        let found = lyapunov_exponents(inner.field.clone(), t, y, &options, &wanted)?;
        exponents.copy_from_slice(&found.exponents);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the value of G = h(t_end) + ∫ g dt along the motion from the state y at the time t, and
/// its derivatives by this state, ∂G/∂y_i with the other components held fixed, and by all
/// parameters, ∂G/∂p_j for a start that does not depend on them; to what they are for a start
/// that does, pc_system_start_by_parameter adds Σ ∂y_i/∂p_j ∂G/∂y_i.
///
/// h and g are observables, given by their indices `end` and `density`; SIZE_MAX stands for 0.
/// The motion is integrated forwards and the adjoint equations backwards, once each however many
/// parameters there are, by PC_BDF if `options`, which may be NULL, say so, else by PC_ADAMS. The
/// derivatives are continued across the events of the model. `by_parameters` needs
/// pc_model_differentiate; it may be NULL, of length 0. The first call derives the derivatives of
/// observables, as pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_gradient(
    system: *const pc_system,
    options: *const pc_solver_options,
    t: f64,
    y: *const f64,
    y_length: usize,
    t_end: f64,
    end: usize,
    density: usize,
    value: *mut f64,
    by_start: *mut f64,
    by_start_length: usize,
    by_parameters: *mut f64,
    by_parameters_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, parameters) = (inventory.dim(), inventory.parameters.len());
        // SAFETY: null or options, as the preamble demands.
        let mut options: pc_solver_options = unsafe { take(options, "options") }?;
        if options.method != pc_method::PC_BDF as std::ffi::c_int {
            options.method = pc_method::PC_ADAMS as std::ffi::c_int;
        }
        // SAFETY: as the preamble demands.
        let options = unsafe { options.options(dim, inventory.deadline()) }?;
        debug_assert!(matches!(options.method(), Method::Adams | Method::Bdf));
        let [end, density] = [(end, "end"), (density, "density")].map(|(index, what)| match index {
            usize::MAX => Ok(None),
            index if index < inventory.observables.len() => Ok(Some(index)),
            index => Err(CallError::Index { what, index, count: inventory.observables.len() }),
        });
        let wants_parameters = !(by_parameters.is_null() && by_parameters_length == 0);
        let (start, all) = ((y, dim, "y"), (by_parameters.cast_const(), parameters, "by_parameters"));
        if y_length == dim && by_start_length == dim {
            apart(start, (by_start, dim, "by_start"))?;
        }
        if wants_parameters && by_parameters_length == parameters {
            apart(start, all)?;
            apart((by_start, dim.min(by_start_length), "by_start"), all)?;
        }
        // SAFETY: null or `y_length` numbers, as the preamble demands; what is written shares no memory with them.
        let y = unsafe { numbers(y, y_length, dim, "y") }?;
        // SAFETY: null or room for as many numbers, as the preamble demands.
        let by_start = unsafe { room(by_start, by_start_length, dim, "by_start") }?;
        let by_parameters = match wants_parameters {
            // SAFETY: as the preamble demands.
            true => Some(unsafe { room(by_parameters, by_parameters_length, parameters, "by_parameters") }?),
            false => None,
        };
        if by_parameters.is_some() && !inner.field.has_parameter_jacobian() {
            let (what, why) =
                ("a derivative by parameters", "call pc_model_differentiate before the system is made");
            return Err(CallError::Unsupported { what, why });
        }
        let (motion, _) = inner.slopes(inventory, (t, y), Forces::OfFunction)?;
        let motion = motion.clone();
        let functional = Objective {
            slopes: vec![0.0; inventory.observables.len() * motion.parameters().len().max(dim)],
            values: vec![0.0; inventory.observables.len()],
            forces: inventory.forces.len(),
            field: inner.field.clone(),
            motion,
            end: end?,
            density: density?,
        };
        let (field, events) = (inner.field.clone(), inner.events.clone());
        let options = AdjointOptions::new(options);
        let found = adjoint_gradients_with_events(field, events, [functional], t, y, t_end, &options)?;
        let Some(found) = found.into_iter().next() else { return Ok(()) }; // there is one for each functional
        // SAFETY: null or memory for a number, as the preamble demands.
        unsafe { write(value, found.value, "value") }?;
        by_start.copy_from_slice(&found.by_start);
        if let Some(by_parameters) = by_parameters {
            by_parameters.copy_from_slice(&found.by_parameters);
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Observables as h and g.
struct Objective {
    motion: Motion,
    /// It computes the forces.
    field: MotionField,
    forces: usize,
    end: Option<usize>,
    density: Option<usize>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Objective {
    /// An observable with its derivatives.
    fn at(
        &mut self,
        observable: Option<usize>,
        (t, y): (f64, &[f64]),
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        by_state.fill(0.0);
        by_parameters.fill(0.0);
        let Some(place) = observable else { return Ok(0.0) };
        let rows = self.values.len();
        self.motion.parameters_mut().copy_from_slice(self.field.inputs(t, y)?);
        self.motion.observe_to(t, y, &mut self.values);
        let all = self.motion.parameters().len();
        let by_inputs = &mut self.slopes[..rows * all];
        self.motion.observable_parameter_jacobian(t, y, by_inputs)?;
        for (slope, column) in by_parameters.iter_mut().zip(by_inputs.chunks_exact(rows)) {
            *slope = column[place];
        }
        let by_forces: Vec<f64> = by_inputs[rows * (all - self.forces)..].to_vec();
        let by_components = &mut self.slopes[..rows * y.len()];
        self.motion.observable_jacobian(t, y, by_components)?;
        if let Some(force_slopes) = self.field.force_jacobian(t, y)? {
            add_through_forces(by_components, &by_forces, force_slopes, (rows, self.forces));
        }
        for (slope, column) in by_state.iter_mut().zip(by_components.chunks_exact(rows)) {
            *slope = column[place];
        }
        Ok(self.values[place])
    }
}

impl Functional for Objective {
    fn density(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        self.at(self.density, (t, y), by_state, by_parameters)
    }

    fn end(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        self.at(self.end, (t, y), by_state, by_parameters)
    }
}
