//! Errors of generalised forces, above all of those computed outside.

use crate::error::lists::{listed, quoted};

/// An error of forces.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ForceError {
    /// A force on something that is not a quasi-velocity.
    #[error("`{name}` is not a quasi-velocity; these are {}", known.join(", "))]
    NotAQuasiVelocity {
        /// The name.
        name: String,
        /// The quasi-velocities of the system.
        known: Vec<String>,
    },
    /// An external force for a system that has declared none.
    #[error("no quasi-velocity of the system was declared to have an external force")]
    NoneDeclared,
    /// An external force that is not a number.
    #[error("the external force on `{quasi_velocity}` is {value} at t = {t}{}", listed(state))]
    NotFinite {
        /// The quasi-velocity it acts on.
        quasi_velocity: String,
        /// The force.
        value: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A derivative of an external force that is not a number.
    #[error(
        "the derivative by `{by}` of the external force on `{quasi_velocity}` is {value} at t = {t}{}",
        listed(state)
    )]
    SlopeNotFinite {
        /// The quasi-velocity it acts on.
        quasi_velocity: String,
        /// The component of the state.
        by: String,
        /// The derivative.
        value: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// An external force that could not be computed.
    #[error("the external force on {} failed at t = {t}: {cause}", quoted(quasi_velocities))]
    Failed {
        /// The quasi-velocities it acts on.
        quasi_velocities: Vec<String>,
        /// Time.
        t: f64,
        /// Its message.
        cause: String,
    },
}
