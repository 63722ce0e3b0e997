//! The equations of a system that is a tree.

use crate::tree::dynamics::TreeDynamics;
use crate::tree::system::TreeSystem;

/// The equations of a tree.
#[derive(Clone, Debug)]
pub(crate) struct TreeEquations<'g> {
    pub(crate) system: TreeSystem<'g>,
    pub(crate) dynamics: TreeDynamics<'g>,
}

impl TreeEquations<'_> {
    /// Whether it has more quasi-velocities than a mass matrix that is looked at whole.
    pub(crate) fn is_large(&self) -> bool {
        self.system.is_large()
    }
}
