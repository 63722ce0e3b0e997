//! What is derived from a model besides its motion, each on first use, for all systems of a code.

use ::pc_model::CentreOfMass;
use pc_expr::Evaluator;
use pc_mech::{CoriolisMatrix, InverseDynamics, LegendreTransform, Motion, VelocityMap};
use serde::{Deserialize, Serialize};

use crate::machinery::linear::Linear;
use crate::machinery::mechanics::Mechanics;
use crate::machinery::once::{Named, Once};

/// Each system evaluates copies of its own.
#[derive(Default, Serialize, Deserialize)]
pub(crate) struct Derivations {
    pub(crate) mechanics: Once<Mechanics>,
    pub(crate) inverse: Once<InverseDynamics>,
    pub(crate) coriolis: Once<CoriolisMatrix>,
    pub(crate) centroidal: Once<VelocityMap>,
    pub(crate) centre: Once<CentreOfMass>,
    /// By the names of bodies and points.
    pub(crate) bodies: Named<VelocityMap>,
    /// Likewise.
    pub(crate) poses: Named<Evaluator>,
    pub(crate) legendre: Once<LegendreTransform>,
    /// The motion with ∂f/∂t, or nothing if f does not contain time.
    pub(crate) by_time: Once<Option<Box<Motion>>>,
    /// The motion with all its first derivatives.
    pub(crate) slopes: Once<Box<Motion>>,
    /// By the inputs; they are not stored.
    #[serde(skip)]
    pub(crate) linear: Named<Box<Linear>>,
}
