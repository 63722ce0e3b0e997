//! Errors of generalised forces, above all of external forces.

use crate::error::lists::{listed, quoted};

/// An error of forces.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForceError {
    /// A force on a name that is not a quasi-velocity.
    #[error("`{name}` is not a quasi-velocity; these are {}", known.join(", "))]
    NotAQuasiVelocity {
        /// The name.
        name: String,
        /// The quasi-velocities of the system.
        known: Vec<String>,
    },
    /// An external force for a system that declares none.
    #[error("no quasi-velocity of the system was declared to have an external force")]
    NoneDeclared,
    /// An external force whose value is not finite.
    #[error("the external force on `{quasi_velocity}` is {value} at t = {t}{}", listed(state))]
    NotFinite {
        /// The quasi-velocity on which it acts.
        quasi_velocity: String,
        /// The force.
        value: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A derivative of an external force whose value is not finite.
    #[error(
        "the derivative by `{by}` of the external force on `{quasi_velocity}` is {value} at t = {t}{}",
        listed(state)
    )]
    SlopeNotFinite {
        /// The quasi-velocity on which the force acts.
        quasi_velocity: String,
        /// The component of the state with respect to which the derivative is taken.
        by: String,
        /// The derivative.
        value: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// Dry friction and rigid stops of more joints than one motion can hold.
    #[error(
        "dry friction and rigid stops of the joints make {surfaces} surfaces on which a motion can stay; the most that \
         are followed at a time are {most}"
    )]
    TooManySurfaces {
        /// The surfaces: one for the friction of a joint, four for its two stops.
        surfaces: usize,
        /// The most that one motion can have.
        most: usize,
    },
    /// An external force that could not be computed.
    #[error("the external force on {} failed at t = {t}: {cause}", quoted(quasi_velocities))]
    Failed {
        /// The quasi-velocities on which it acts.
        quasi_velocities: Vec<String>,
        /// Time.
        t: f64,
        /// Its message.
        cause: String,
    },
}
