//! Errors of constraints, everywhere or at a state.

use crate::error::lists::{at, listed, quoted};

/// An error of constraints.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstraintError {
    /// A condition on velocities that is not affine in the velocities.
    #[error("the constraint `{constraint}` is not affine in the quasi-velocities")]
    NotAffine {
        /// Its name.
        constraint: String,
    },
    /// Constraints that leave no velocity free.
    #[error(
        "the constraints leave nothing free: there are {constraints} of them for {quasi_velocities} quasi-velocities"
    )]
    TooMany {
        /// Number of constraints.
        constraints: usize,
        /// Number k of quasi-velocities.
        quasi_velocities: usize,
    },
    /// A constraint that restricts no velocity, or only velocities that the constraints before it have
    /// already restricted.
    #[error("the constraint `{constraint}` restricts no velocity that those before it leave free")]
    Dependent {
        /// Its name.
        constraint: String,
    },
    /// Friction that jumps, of a body that slides in two directions: where it comes to rest is no surface.
    #[error("`{constraint}` has friction in two directions, which needs a velocity of creep")]
    TwoSlips {
        /// Its name.
        constraint: String,
    },
    /// A constraint that, at one state, restricts no velocity that the others leave free.
    #[error(
        "the constraint `{constraint}` restricts no velocity that the others leave free at t = {t}{}",
        listed(state)
    )]
    Singular {
        /// Its name.
        constraint: String,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A constraint that becomes dependent on the others at a state that the motion reaches.
    #[error(
        "near t = {t} the constraint `{constraint}` depends on the others and leaves `{quasi_velocity}` free: motions may \
         cross there, and this one cannot be followed across{}",
        listed(state)
    )]
    RankLost {
        /// Its name.
        constraint: String,
        /// The quasi-velocity that it determined before.
        quasi_velocity: String,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A constraint that was dropped because it seemed to follow from the others, but does not follow from
    /// them everywhere.
    #[error(
        "the constraint `{constraint}`, which followed from the others, no longer does at t = {t}{}",
        listed(state)
    )]
    Departed {
        /// Its name.
        constraint: String,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A constraint whose condition on velocities jumps along the motion, so that the velocities jump as
    /// well.
    #[error("the condition of `{constraint}` on velocities jumps at {}: velocities jump there", at(place))]
    Jumps {
        /// Its name.
        constraint: String,
        /// Names and values of the variables at a jump.
        place: Vec<(String, f64)>,
    },
    /// Quasi-velocities chosen as independent that do not determine the others.
    #[error("{} cannot be the independent quasi-velocities: {why}", quoted(chosen))]
    NotIndependent {
        /// The chosen quasi-velocities.
        chosen: Vec<String>,
        /// Why not.
        why: String,
    },
    /// No state near this one was found that satisfies the constraints.
    #[error(
        "no state that satisfies the constraints {} was found near t = {t}{}",
        quoted(constraints),
        listed(state)
    )]
    NoProjection {
        /// Their names.
        constraints: Vec<String>,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
}
