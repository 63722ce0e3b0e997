//! Parts of the equations as functions of the state.

use pc_expr::Evaluator;
use pc_mech::{InverseDynamics, LegendreTransform, MechError};
use pc_model::{Model, Variables};
use pc_print::bracket_of;

use crate::error::Error;

/// Inverse dynamics and mass matrix of a system, which are derived on the first request.
pub(crate) struct Dynamics {
    pub(crate) inverse: InverseDynamics,
    /// From momenta to quasi-velocities, where the state has momenta.
    pub(crate) transform: Option<LegendreTransform>,
}

impl Dynamics {
    pub(crate) fn of(model: &Model, variables: Variables) -> Result<Dynamics, Error> {
        model.derived(|assembly| {
            let equations = assembly.equations_in(variables)?;
            let inverse = assembly.placed(equations.inverse_dynamics_of_motion())?;
            let transform = match variables.has_momenta() {
                true => Some(assembly.legendre_transform(variables)?),
                false => None,
            };
            Ok(Dynamics { inverse, transform })
        })
    }
}

/// Computes the values at (t, state), which have to be finite.
pub(crate) fn evaluate(
    program: &mut Evaluator,
    (t, state, parameters): (f64, &[f64], &[f64]),
    values: &mut [f64],
) -> Result<(), Error> {
    program.eval(t, state, parameters, values);
    if values.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    Err(MechError::from(program.blame(t, state, parameters)).into())
}

/// (x, η) of a state that may have momenta.
pub(crate) fn read(
    transform: Option<&mut LegendreTransform>,
    t: f64,
    y: &[f64],
    parameters: &[f64],
) -> Result<Vec<f64>, Error> {
    let Some(transform) = transform else { return Ok(y.to_vec()) };
    transform.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
    let mut state = vec![0.0; y.len()];
    transform.to_quasi_velocities_in(t, y, &mut state)?;
    Ok(state)
}

/// The bracket (f, g) as a function of t and (x, η), where η are those of the state.
pub(crate) fn bracket(model: &Model, variables: Variables, f: &str, g: &str) -> Result<Evaluator, Error> {
    if !variables.are_own() {
        let why = "the state has other variables than the model; use the form poincare or canonical";
        return Err(Error::Unsupported { what: "a bracket", why });
    }
    model.derived(|assembly| {
        let value = bracket_of(model, assembly, f, g)?;
        let equations = assembly.equations_in(Variables::QuasiVelocities)?;
        Ok(assembly.placed(equations.functions(&[value], &[]))?)
    })
}
