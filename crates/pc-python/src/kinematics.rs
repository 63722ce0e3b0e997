//! The Coriolis matrix, and the Jacobians of bodies and of their momenta, as functions of the state.

use pc_mech::{CoriolisMatrix, LegendreTransform, VelocityMap};
use pc_model::{CentreOfMass, Model, Variables};

use crate::error::Error;

/// What was derived so far.
#[derive(Default)]
pub(crate) struct Kinematics {
    pub(crate) coriolis: Option<CoriolisMatrix>,
    pub(crate) centroidal: Option<VelocityMap>,
    pub(crate) centre: Option<CentreOfMass>,
    /// By the names of bodies and points.
    pub(crate) bodies: Vec<(String, VelocityMap)>,
    /// From momenta to quasi-velocities, where the state has momenta.
    pub(crate) transform: Option<LegendreTransform>,
}

/// Something derived from a model, with what converts the states.
pub(crate) struct Made<T>(pub(crate) T, pub(crate) Option<LegendreTransform>);

impl<T> Made<T> {
    pub(crate) fn new(
        model: &Model,
        variables: Variables,
        made: impl FnOnce(&pc_model::Assembly<'_>) -> Result<T, Error>,
    ) -> Result<Made<T>, Error> {
        model.derived(|assembly| {
            let made = made(assembly)?;
            let transform = match variables.has_momenta() {
                true => Some(assembly.legendre_transform(variables)?),
                false => None,
            };
            Ok(Made(made, transform))
        })
    }
}
