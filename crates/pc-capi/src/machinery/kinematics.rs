//! The Coriolis matrix, the poses of bodies, and the Jacobians of bodies and momenta, each derived on first use.

use ::pc_model::{CentreOfMass, Model, Variables};
use pc_expr::Evaluator;
use pc_mech::{CoriolisMatrix, VelocityMap};

use crate::ffi::call_error::CallError;

/// What was derived so far.
#[derive(Clone, Default)]
pub(crate) struct Kinematics {
    pub(crate) coriolis: Option<CoriolisMatrix>,
    pub(crate) centroidal: Option<VelocityMap>,
    pub(crate) centre: Option<CentreOfMass>,
    /// By the names of bodies and points.
    pub(crate) bodies: Vec<(String, VelocityMap)>,
}

pub(crate) fn coriolis(model: &Model, variables: Variables) -> Result<CoriolisMatrix, CallError> {
    model.derived(|assembly| {
        let equations = assembly.equations_in(variables)?;
        Ok(assembly.placed(equations.coriolis_of_motion())?)
    })
}

pub(crate) fn centroidal(model: &Model, variables: Variables) -> Result<VelocityMap, CallError> {
    model.derived(|assembly| Ok(model.centroidal_map(assembly, variables)?))
}

pub(crate) fn centre(model: &Model, variables: Variables) -> Result<CentreOfMass, CallError> {
    model.derived(|assembly| Ok(model.centre_of_mass(assembly, variables)?))
}

/// The position of a point of a body, and the rotation of this body.
pub(crate) fn pose(model: &Model, variables: Variables, name: &str) -> Result<Evaluator, CallError> {
    check_name(model, name)?;
    model.derived(|assembly| Ok(model.body_pose(assembly, variables, name)?))
}

fn check_name(model: &Model, name: &str) -> Result<(), CallError> {
    let known = model.body_names();
    match known.iter().any(|known| known == name) {
        true => Ok(()),
        false => Err(CallError::UnknownName { what: "body or point", name: name.to_owned(), known }),
    }
}

pub(crate) fn body(model: &Model, variables: Variables, name: &str) -> Result<VelocityMap, CallError> {
    check_name(model, name)?;
    model.derived(|assembly| Ok(model.body_map(assembly, variables, name)?))
}
