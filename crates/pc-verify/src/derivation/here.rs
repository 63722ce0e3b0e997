//! The results of the second derivation at a place.

use crate::derivation::derivation::Derivation;
use crate::derivation::equations::Derived;
use crate::derivation::quantity::Free;
use crate::error::Irregular;
use crate::numbers::rounding::Rounding;

/// The results of the second derivation at a place.
#[derive(Clone, Debug)]
pub(crate) struct Here {
    pub(crate) derived: Derived,
    /// The values of the columns at the place.
    pub(crate) columns: Vec<f64>,
}

impl Here {
    pub(crate) fn new(derivation: &Derivation, derived: Derived) -> Result<Here, Irregular> {
        let exact = Rounding::none();
        let columns = derivation.columns(&derivation.still(&derived.place, &exact))?;
        Ok(Here { derived, columns })
    }

    /// The value of a quasi-velocity.
    pub(crate) fn velocity(&self, velocity: Free) -> f64 {
        match velocity {
            Free::Column(s) => self.columns[s],
            Free::Velocity(i) => self.derived.velocities[i],
            Free::Constraint(_) => 0.0,
        }
    }
}
