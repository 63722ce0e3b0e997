//! The equations of a system that is a tree.

use std::collections::BTreeSet;

use crate::error::LagrangianError;
use crate::tree::dynamics::TreeDynamics;
use crate::tree::system::TreeSystem;

/// The equations of a tree.
#[derive(Clone, Debug)]
pub(crate) struct TreeEquations<'g> {
    pub(crate) system: TreeSystem<'g>,
    pub(crate) dynamics: TreeDynamics<'g>,
}

impl TreeEquations<'_> {
    /// Checks that every free direction of a joint moves some inertia.
    ///
    /// # Errors
    /// [`LagrangianError::Degenerate`] with the quasi-velocities that no inertia resists.
    pub(crate) fn check_regular(&self, names: &[String]) -> Result<(), LagrangianError> {
        let pivots = self.dynamics.articulated.pivots().filter(|pivot| pivot.is_massless);
        let massless: BTreeSet<usize> =
            pivots.map(|pivot| self.system.places[pivot.link][pivot.component]).collect();
        if massless.is_empty() {
            return Ok(());
        }
        let quasi_velocities = massless.iter().map(|&place| names[place].clone()).collect();
        let size = names.len();
        Err(LagrangianError::Degenerate { rank: size - massless.len(), size, quasi_velocities })
    }

    /// Whether the tree has too many quasi-velocities for its mass matrix to be written
    /// out as a whole.
    pub(crate) fn is_large(&self) -> bool {
        self.system.is_large()
    }
}
