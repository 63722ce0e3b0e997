//! From a model to its compiled motion, and to the expressions that belong to the motion's state.

use std::ffi::c_int;

use ::pc_model::{Assembly, Form, Model};
use pc_mech::{Canonical, Equations, Graph, Motion, System};

use crate::error::Fault;

/// Which equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Variables {
    /// (9), or (30), or with multipliers: of quasi-velocities.
    QuasiVelocities,
    /// (10): of momenta.
    Momenta,
}

impl TryFrom<c_int> for Variables {
    type Error = Fault;

    fn try_from(form: c_int) -> Result<Variables, Fault> {
        match form {
            0 => Ok(Variables::QuasiVelocities),
            1 => Ok(Variables::Momenta),
            value => Err(Fault::Choice { what: "pc_form", value: value.into() }),
        }
    }
}

/// A motion with the state that it starts from.
pub(crate) struct Derived {
    pub(crate) motion: Motion,
    pub(crate) parameters: Vec<String>,
    pub(crate) t_start: f64,
    pub(crate) start: Vec<f64>,
}

/// Derives and compiles.
pub(crate) fn derive(model: &Model, variables: Variables) -> Result<Derived, Fault> {
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    let (motion, start) = match variables {
        Variables::QuasiVelocities => model.compile(&assembly)?,
        Variables::Momenta => canonical_motion(model, &assembly)?,
    };
    let parameters = assembly.system.parameters().iter().map(|(symbol, _)| symbol.to_string()).collect();
    Ok(Derived { motion, parameters, t_start: assembly.t_start, start })
}

fn canonical_motion(model: &Model, assembly: &Assembly<'_>) -> Result<(Motion, Vec<f64>), Fault> {
    let canonical = canonical(model, assembly, Variables::Momenta)?;
    let mut transform = canonical.legendre_transform().map_err(|error| model.derivation_error(error))?;
    let start = assembly.start_of(&state(canonical.system()));
    let start =
        transform.to_momenta(assembly.t_start, &start).map_err(|error| model.derivation_error(error))?;
    Ok((model.compile_canonical(&canonical, assembly.t_start, &start)?, start))
}

/// The canonical equations of the system that the state belongs to, η looked for from their start where they are
/// not closed.
pub(crate) fn canonical<'g>(
    model: &Model,
    assembly: &Assembly<'g>,
    variables: Variables,
) -> Result<Canonical<'g>, Fault> {
    let system = system(model, assembly, variables)?;
    let start = assembly.start_of(&state(&system));
    let n = system.frame().coordinates().len();
    let canonical = system.canonical().and_then(|canonical| canonical.with_guess(&start[n..]));
    Ok(canonical.map_err(|error| model.derivation_error(error))?)
}

/// The system whose quasi-velocities are those of the state, or those of its momenta.
fn system<'g>(model: &Model, assembly: &Assembly<'g>, variables: Variables) -> Result<System<'g>, Fault> {
    let free = || assembly.free_system().map_err(|error| model.constraint_error(error));
    Ok(match (variables, assembly.bound.form()) {
        (Variables::QuasiVelocities, Form::Held(_)) => assembly.system.without_observed(),
        (Variables::QuasiVelocities, _) => free()?,
        // What is observed may contain velocities that are not among the free ones.
        (Variables::Momenta, Form::Held(_)) => free()?.without_observed(),
        (Variables::Momenta, _) => free()?,
    })
}

/// M η̇ = r in the quasi-velocities of the state, or of its momenta; without the reactions of multipliers.
pub(crate) fn equations<'g>(
    model: &Model,
    assembly: &Assembly<'g>,
    variables: Variables,
) -> Result<Equations<'g>, Fault> {
    match (variables, assembly.bound.form()) {
        (Variables::QuasiVelocities, Form::Held(held)) => Ok(held.multipliers.equations().clone()),
        _ => Ok(assembly.equations().map_err(|error| model.constraint_error(error))?),
    }
}

/// x, η
pub(crate) fn state<'g>(system: &System<'g>) -> Vec<pc_mech::Expr<'g>> {
    [system.frame().coordinates(), system.quasi_velocities()].concat()
}
