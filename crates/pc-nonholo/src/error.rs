//! What can be wrong with constraints.

use pc_mech::MechError;

/// An error of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NonholoError {
    /// A constraint on something that is not a quasi-velocity of the system.
    #[error("`{name}` is not a quasi-velocity of the system")]
    NotAQuasiVelocity {
        /// Its text.
        name: String,
    },
    /// The same constraint twice.
    #[error("`{name}` is constrained twice")]
    Twice {
        /// The quasi-velocity.
        name: String,
    },
    /// An error of the derivation.
    #[error(transparent)]
    Mech(#[from] MechError),
}
