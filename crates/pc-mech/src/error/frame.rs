//! Errors of a frame, ẋ = b η + b_0 (3), and of the definitions of its quasi-velocities.

use crate::error::lists::{approximately, at};

/// An error of a frame.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FrameError {
    /// A frame whose b or b_0, in ẋ = b η + b_0, depends on a velocity.
    #[error("the frame contains `{velocity}`, but b and b_0 must be functions of time and coordinates alone")]
    OfVelocities {
        /// The quasi-velocity, or velocity of a coordinate.
        velocity: String,
    },
    /// A frame whose b or b_0 jumps, so that a quasi-velocity or a velocity jumps as well.
    #[error("the frame jumps by {} at {}: velocities or quasi-velocities jump there", approximately(*size), at(place))]
    Jumps {
        /// The size of the jump of an entry.
        size: f64,
        /// Names and values of the variables at a jump.
        place: Vec<(String, f64)>,
    },
    /// A velocity or momentum that is not affine in the quasi-velocities.
    #[error(
        "{what} is not affine in the quasi-velocities: its derivative by `{quasi_velocity}` depends on them"
    )]
    NotAffine {
        /// The velocity or momentum.
        what: String,
        /// The quasi-velocity.
        quasi_velocity: String,
    },
    /// A part of the frame that depends on a first-order state.
    #[error("{what} depends on the first-order state `{state}`, which is not part of the frame")]
    OfState {
        /// The part.
        what: &'static str,
        /// The state.
        state: String,
    },
    /// Definitions that determine the velocities before and after a state of the motion, but not at that
    /// state.
    #[error(
        "between t = {from} and t = {to} the quasi-velocities cease to determine the velocities, or these the \
         quasi-velocities: the state does not say how the motion continues there"
    )]
    Undetermined {
        /// Time at the start of the step that passes this state.
        from: f64,
        /// Time at the end of that step.
        to: f64,
    },
}
