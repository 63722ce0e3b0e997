//! The parts of the equations as functions of the state.

use ::pc_model::{Assembly, Model, Variables};
use pc_expr::Evaluator;
use pc_mech::{Expr, MechError};
use serde::{Deserialize, Serialize};

use crate::ffi::call_error::CallError;

/// The parts of M η̇ = r and of ẋ = b η + b_0, as functions of t and (x, η).
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Mechanics {
    /// M, k × k.
    pub(crate) mass: Evaluator,
    /// The structure coefficients c_rs^m; the index m varies fastest, then s, then r.
    pub(crate) structure: Evaluator,
    pub(crate) operators: usize,
    /// b η + b_0, then r, then ż; the external forces are further inputs.
    pub(crate) right: Evaluator,
    /// Whether M η̇ = r are all the equations, with neither multipliers nor momenta.
    pub(crate) complete: bool,
}

impl Mechanics {
    pub(crate) fn of(model: &Model, variables: Variables) -> Result<Mechanics, CallError> {
        let graph = model.graph();
        Mechanics::of_assembly(&model.assemble(&graph)?, variables)
    }

    fn of_assembly<'g>(assembly: &Assembly<'g>, variables: Variables) -> Result<Mechanics, CallError> {
        let equations = assembly.equations_in(variables)?;
        let structure = equations.system().structure();
        let operators = structure.operators();
        let all = || 0..=operators;
        let pairs = all().flat_map(|r| all().map(move |s| (r, s)));
        let coefficients = pairs.flat_map(|(r, s)| (1..=operators).map(move |m| structure.get(r, s, m)));
        let of_states: Vec<Expr<'_>> = equations.system().states().iter().map(|&(_, rate)| rate).collect();
        let right = [equations.velocities(), equations.right_hand_side(), &of_states].concat();
        let held = assembly.constraints.held().is_some();
        let forces: Vec<Expr<'_>> =
            equations.system().external_forces().iter().map(|&(_, symbol)| symbol).collect();
        let compiled =
            |values: &[Expr<'g>], forces: &[Expr<'g>]| assembly.placed(equations.functions(values, forces));
        Ok(Mechanics {
            mass: compiled(&equations.mass_matrix().entries(), &[])?,
            structure: compiled(&coefficients.collect::<Vec<_>>(), &[])?,
            operators,
            right: compiled(&right, &forces)?,
            complete: !variables.has_momenta() && !held,
        })
    }
}

/// Writes the values at (t, state); an error says why one is not finite.
pub(crate) fn evaluate(
    program: &mut Evaluator,
    (t, state, parameters): (f64, &[f64], &[f64]),
    values: &mut [f64],
) -> Result<(), CallError> {
    program.eval(t, state, parameters, values);
    if values.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    match program.diagnose(t, state, parameters) {
        Some(error) => Err(MechError::from(error).into()),
        None => Ok(()),
    }
}
