//! The parts of the equations: mass matrix, structure coefficients, residual.

use ::pc_model::Model;
use pc_mech::{EvaluationError, InverseDynamics, MassFactors, MechError, SingularMatrix, VectorField};

use crate::api::rates::{State, Target, all_finite, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, numbers, write};
use crate::ffi::status::pc_status;
use crate::machinery::mechanics::{Mechanics, evaluate};
use crate::machinery::motion_field::MotionField;
use crate::machinery::system::{Inner, Inventory, Room, inside, pc_system};

impl Inner {
    /// The parts of the equations, derived on first use, together with the field of the motion.
    fn mechanics(
        &mut self,
        inventory: &Inventory,
    ) -> Result<(&mut Mechanics, &mut MotionField, &mut Room), CallError> {
        let derive = || inventory.derive(|model| Mechanics::of(&model, inventory.facts.variables));
        let mechanics = inventory.derivations.mechanics.own(&mut self.mechanics, derive)?;
        Ok((mechanics, &mut self.field, &mut self.room))
    }

    /// The inverse dynamics, derived on first use, with the field of the motion.
    pub(crate) fn inverse(
        &mut self,
        inventory: &Inventory,
    ) -> Result<(&mut InverseDynamics, &mut MotionField, &mut Room), CallError> {
        let derive = |model: Model| -> Result<InverseDynamics, CallError> {
            let graph = model.graph();
            let assembly = model.assemble(&graph)?;
            let equations = assembly.equations_in(inventory.facts.variables)?;
            Ok(assembly.placed(equations.inverse_dynamics_of_motion())?)
        };
        let inverse = inventory.derivations.inverse.own(&mut self.inverse, || inventory.derive(derive))?;
        Ok((inverse, &mut self.field, &mut self.room))
    }

    /// Writes the state y, converted to (x, η), to `room.state`.
    pub(crate) fn read_quasi_velocities(
        &mut self,
        inventory: &Inventory,
        t: f64,
        y: &[f64],
    ) -> Result<(), CallError> {
        match inventory.facts.variables {
            variables if !variables.has_momenta() => self.room.state.copy_from_slice(y),
            _ => {
                self.legendre(inventory)?;
                if let Some(transform) = &mut self.legendre {
                    transform.to_quasi_velocities_in(t, y, &mut self.room.state)?;
                }
            }
        }
        Ok(())
    }
}

/// Writes the mass matrix M = ∂²L/∂η∂η at (t, y), k × k for the k quasi-velocities of the state,
/// so `length` is k*k; k is pc_system_dim less pc_system_coordinate_count and
/// pc_system_state_count. Rows for multipliers are not part of M. The first call derives M, as
/// pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_mass_matrix(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    matrix: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let target = Target { data: matrix, length, expected: k * k, what: "matrix" };
        // SAFETY: as the preamble demands.
        let (y, matrix) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let (mechanics, motion, Room { state, .. }) = inner.mechanics(inventory)?;
        evaluate(&mut mechanics.mass, (t, state, motion.parameters()), matrix)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the right-hand side r of M η̇ = r at (t, y), k numbers, with k and M as in
/// pc_system_mass_matrix: all forces and gyroscopic terms, without the reactions that multipliers
/// represent. The first call derives r, as pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_right_hand_side(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    right: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let target = Target { data: right, length, expected: k, what: "right" };
        // SAFETY: as the preamble demands.
        let (y, right) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let (mechanics, motion, room) = inner.mechanics(inventory)?;
        let n = motion.coordinates();
        let (values, state) = room.split(dim);
        evaluate(&mut mechanics.right, (t, state, motion.inputs(t, y)?), values)?;
        right.copy_from_slice(&values[n..n + k]);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the generalised forces tau = M η̇ + h - Q that have to be added to the forces Q of the
/// model for the accelerations η̇ at (t, y): inverse dynamics. Both lists have k numbers, with k
/// as in pc_system_mass_matrix; null accelerations stand for zeros, so that tau is what the motion
/// itself requires, and in a state at rest what holds the system there. The forces of constraints
/// that multipliers hold are part of tau. For bodies on joints tau is found from body to body. The
/// first call derives equations, as pc_system_new does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_inverse_dynamics(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    accelerations: *const f64,
    accelerations_length: usize,
    tau: *mut f64,
    tau_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let given = !accelerations.is_null();
        if given && accelerations_length == k && tau_length == k {
            apart((accelerations, k, "accelerations"), (tau, k, "tau"))?;
        }
        let accelerations = match given {
            // SAFETY: as the preamble demands; tau shares no memory with it.
            true => Some(unsafe { numbers(accelerations, accelerations_length, k, "accelerations") }?),
            false => None,
        };
        let target = Target { data: tau, length: tau_length, expected: k, what: "tau" };
        // SAFETY: as the preamble demands.
        let (y, tau) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let (inverse, field, room) = inner.inverse(inventory)?;
        inverse.parameters_mut().copy_from_slice(field.inputs(t, y)?);
        match accelerations {
            Some(accelerations) => inverse.forces(t, &room.state, accelerations, tau)?,
            None => inverse.bias(t, &room.state, tau)?,
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Solves M w = v at (t, y), with M as in pc_system_mass_matrix, and writes w = M⁻¹ v; both have k
/// numbers. The first call derives M, as pc_system_new derives equations. Returns PC_EVALUATION
/// where M is singular.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_solve_mass_matrix(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    v: *const f64,
    v_length: usize,
    w: *mut f64,
    w_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        if v_length == k && w_length == k {
            apart((v, k, "v"), (w, k, "w"))?;
        }
        // SAFETY: as the preamble demands; w shares no memory with it.
        let v = unsafe { numbers(v, v_length, k, "v") }?;
        let target = Target { data: w, length: w_length, expected: k, what: "w" };
        // SAFETY: as the preamble demands.
        let (y, w) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let (mechanics, motion, room) = inner.mechanics(inventory)?;
        let n = motion.coordinates();
        let (mass, state) = room.split(k * k);
        evaluate(&mut mechanics.mass, (t, state, motion.parameters()), mass)?;
        let factors = inner.factors.get_or_insert_with(|| MassFactors::new(k));
        factors.factorise(inner.room.numbers(k * k)).map_err(|SingularMatrix { index, pivot }| {
            let quasi_velocity = inventory.names[n + index].to_string_lossy().into_owned();
            let names = inventory.names.iter().map(|name| name.to_string_lossy().into_owned());
            let state = names.zip(y.iter().copied()).collect();
            MechError::from(EvaluationError::SingularMassMatrix { quasi_velocity, pivot, t, state })
        })?;
        w.copy_from_slice(v);
        factors.solve(w);
        all_finite("M⁻¹ v", w)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the number K of operators X_1 … X_K that have structure coefficients: one for each
/// quasi-velocity of the state, then one for each quasi-velocity that constraints make vanish. The
/// first call derives them, as pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_operator_count(
    system: *const pc_system,
    operators: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (mechanics, ..) = inner.mechanics(inventory)?;
        // SAFETY: null or memory for a number, as the preamble demands.
        unsafe { write(operators, mechanics.operators, "operators") }
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the structure coefficients of [X_r, X_s] = c_rs^m X_m, (5), at (t, y), for r, s = 0 …
/// K, with 0 for time, and m = 1 … K: c[(r*(K + 1) + s)*K + m - 1], so `length` is (K + 1)*(K +
/// 1)*K. The first call derives them, as pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_structure_coefficients(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    c: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let expected = inner.mechanics(inventory)?.0.structure.program().outputs_len();
        let target = Target { data: c, length, expected, what: "c" };
        // SAFETY: as the preamble demands.
        let (y, c) = unsafe { slices(State { y, length: y_length }, inventory.dim(), target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let (mechanics, motion, Room { state, .. }) = inner.mechanics(inventory)?;
        evaluate(&mut mechanics.structure, (t, state, motion.parameters()), c)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the residual of the equations for ydot in the form expected by codes for implicit
/// equations F(t, y, ẏ) = 0: ẋ − b η − b_0, then M η̇ − r, without dividing by M. If there are
/// multipliers, whose reactions are eliminated, the second part is M times the error of η̇; in the
/// canonical form the residual is ẏ − f. The first call derives equations, as pc_system_new does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_residual(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    ydot: *const f64,
    ydot_length: usize,
    residual: *mut f64,
    residual_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let dim = inventory.dim();
        let target = Target { data: residual, length: residual_length, expected: dim, what: "residual" };
        if ydot_length == dim && residual_length == dim {
            apart((ydot, dim, "ydot"), (residual, dim, "residual"))?;
        }
        // SAFETY: as the preamble demands; the residual shares no memory with it.
        let ydot = unsafe { numbers(ydot, ydot_length, dim, "ydot") }?;
        // SAFETY: as the preamble demands.
        let (y, residual) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        let (mechanics, motion, room) = inner.mechanics(inventory)?;
        let (n, k) = (motion.coordinates(), motion.quasi_velocities());
        let (mass, rates) = room.split(k * k);
        rates.copy_from_slice(ydot);
        if !mechanics.complete {
            motion.rhs(t, y, residual)?;
            for (rate, right) in rates.iter_mut().zip(&*residual) {
                *rate -= right;
            }
            if inventory.facts.variables.has_momenta() {
                residual.copy_from_slice(rates);
                return all_finite("the residual", residual);
            }
            residual.fill(0.0);
        } else {
            evaluate(&mut mechanics.right, (t, y, motion.inputs(t, y)?), residual)?;
        }
        evaluate(&mut mechanics.mass, (t, y, motion.parameters()), mass)?;
        for i in 0..n {
            residual[i] = rates[i] - residual[i];
        }
        for s in 0..k {
            let product: f64 = (0..k).map(|r| mass[s * k + r] * rates[n + r]).sum();
            residual[n + s] = product - residual[n + s];
        }
        for i in n + k..dim {
            residual[i] = rates[i] - residual[i];
        }
        all_finite("the residual", residual)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}
