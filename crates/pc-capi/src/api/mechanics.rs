//! The parts of the equations: mass matrix, structure coefficients, residual.

use ::pc_model::{Model, Variables};
use pc_expr::{Evaluator, Inputs, Program};
use pc_mech::{Backend, Equations, Expr, Graph, MechError, VectorField};

use crate::api::rates::{State, Target, slices};
use crate::api::system::{Inner, Inventory, inside, pc_system};
use crate::ffi::error::{Fault, pc_error};
use crate::ffi::pointer::{apart, numbers, write};
use crate::ffi::status::pc_status;
use crate::machinery::field::Field;

/// The parts of M η̇ = r and of ẋ = b η + b_0, functions of t and (x, η).
#[derive(Clone)]
pub(crate) struct Mechanics {
    /// M, k × k.
    mass: Evaluator,
    /// c_rs^m, the index m fastest, then s, then r.
    structure: Evaluator,
    operators: usize,
    /// b η + b_0, then r, then ż, which the external forces are inputs of too.
    right: Evaluator,
    /// Whether M η̇ = r is all there is: no multipliers, no momenta.
    complete: bool,
}

impl Mechanics {
    fn of(model: &Model, variables: Variables) -> Result<Mechanics, Fault> {
        let graph = Graph::new();
        let assembly = model.assemble(&graph)?;
        let equations = model.equations_in(&assembly)?;
        let structure = equations.system().structure();
        let operators = structure.operators();
        let all = || 0..=operators;
        let pairs = all().flat_map(|r| all().map(move |s| (r, s)));
        let coefficients = pairs.flat_map(|(r, s)| (1..=operators).map(move |m| structure.get(r, s, m)));
        let of_states: Vec<Expr<'_>> = equations.system().states().iter().map(|&(_, rate)| rate).collect();
        let right = [equations.velocities(), equations.right_hand_side(), &of_states].concat();
        let held = matches!(assembly.bound.form(), ::pc_model::Form::Held(_));
        let forces: Vec<Expr<'_>> =
            equations.system().external_forces().iter().map(|&(_, symbol)| symbol).collect();
        let compiled = |values: &[Expr<'_>], forces: &[Expr<'_>]| {
            compile(&equations, values, forces).map_err(|error| model.derivation_error(error))
        };
        Ok(Mechanics {
            mass: compiled(equations.mass_matrix().entries(), &[])?,
            structure: compiled(&coefficients.collect::<Vec<_>>(), &[])?,
            operators,
            right: compiled(&right, &forces)?,
            complete: variables == Variables::QuasiVelocities && !held,
        })
    }
}

/// `values` as functions of t, (x, η), the parameters and `forces`.
pub(crate) fn compile<'g>(
    equations: &Equations<'g>,
    values: &[Expr<'g>],
    forces: &[Expr<'g>],
) -> Result<Evaluator, MechError> {
    let system = equations.system();
    let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
    let inputs = Inputs {
        time: Some(system.frame().time()),
        state: system.state(),
        parameters: parameters.chain(forces.iter().copied()).collect(),
    };
    Ok(Evaluator::new(Program::new(system.graph(), &inputs, values)?, Backend::Interpreter))
}

/// The values at (t, state), if all are numbers.
pub(crate) fn evaluate(
    program: &mut Evaluator,
    (t, state, parameters): (f64, &[f64], &[f64]),
    values: &mut [f64],
) -> Result<(), Fault> {
    program.eval(t, state, parameters, values);
    if values.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    match program.diagnose(t, state, parameters) {
        Some(error) => Err(MechError::from(error).into()),
        None => Ok(()),
    }
}

impl Inner {
    /// The parts of the equations, derived when first asked for, with the motion.
    fn mechanics(&mut self, inventory: &Inventory) -> Result<(&mut Mechanics, &mut Field), Fault> {
        if self.mechanics.is_none() {
            self.mechanics = Some(Mechanics::of(&inventory.model, inventory.variables)?);
        }
        const MISSING: Fault = Fault::Unsupported { what: "M η̇ = r", why: "it was not derived" };
        Ok((self.mechanics.as_mut().ok_or(MISSING)?, &mut self.field))
    }

    /// The state (x, η) of a state.
    pub(crate) fn in_quasi_velocities(
        &mut self,
        inventory: &Inventory,
        t: f64,
        y: &[f64],
    ) -> Result<Vec<f64>, Fault> {
        match inventory.variables {
            Variables::QuasiVelocities => Ok(y.to_vec()),
            Variables::Momenta => Ok(self.legendre(inventory)?.to_quasi_velocities(t, y)?),
        }
    }
}

/// Writes the mass matrix M = ∂²L/∂η∂η at (t, y), k × k for the k quasi-velocities of the state, so `length` is
/// k*k; k is pc_system_dim less pc_system_coordinate_count and
/// pc_system_state_count. With multipliers their rows are not among it. The
/// first call derives, as pc_system_new does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_mass_matrix(
    system: *mut pc_system,
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
        let state = inner.in_quasi_velocities(inventory, t, y)?;
        let (mechanics, motion) = inner.mechanics(inventory)?;
        evaluate(&mut mechanics.mass, (t, &state, motion.parameters()), matrix)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the number K of operators X_1 … X_K between which there are structure coefficients: one for each
/// quasi-velocity of the state, then those that constraints say vanish, if any. The first call derives, as
/// pc_system_new does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_operator_count(
    system: *mut pc_system,
    operators: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (mechanics, _) = inner.mechanics(inventory)?;
        // SAFETY: null or a place for a number, as the preamble demands.
        unsafe { write(operators, mechanics.operators, "operators") }
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the structure coefficients of [X_r, X_s] = c_rs^m X_m, (5), at (t, y), for r, s = 0 … K, with 0 for
/// time, and m = 1 … K: c[(r*(K + 1) + s)*K + m - 1], so `length` is (K + 1)*(K + 1)*K. The first call derives,
/// as pc_system_new does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_structure_coefficients(
    system: *mut pc_system,
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
        let state = inner.in_quasi_velocities(inventory, t, y)?;
        let (mechanics, motion) = inner.mechanics(inventory)?;
        evaluate(&mut mechanics.structure, (t, &state, motion.parameters()), c)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the residual of the equations for ydot, as codes for implicit equations F(t, y, ẏ) = 0 take it: ẋ − b
/// η − b_0, then M η̇ − r, where nothing is divided by M. With multipliers, whose reactions are eliminated, the
/// second part is M times the difference of η̇ from what it should be; in the canonical form all is ẏ − f. The
/// first call derives, as pc_system_new does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_residual(
    system: *mut pc_system,
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
        let (mechanics, motion) = inner.mechanics(inventory)?;
        let n = motion.coordinates();
        let mut rates = ydot.to_vec();
        if !mechanics.complete {
            motion.rhs(t, y, residual)?;
            for (rate, right) in rates.iter_mut().zip(&*residual) {
                *rate -= right;
            }
            if inventory.variables == Variables::Momenta {
                residual.copy_from_slice(&rates);
                return Ok(());
            }
            residual.fill(0.0);
        } else {
            evaluate(&mut mechanics.right, (t, y, motion.inputs(t, y)?), residual)?;
        }
        let k = motion.quasi_velocities();
        let mut mass = vec![0.0; k * k];
        evaluate(&mut mechanics.mass, (t, y, motion.parameters()), &mut mass)?;
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
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}
