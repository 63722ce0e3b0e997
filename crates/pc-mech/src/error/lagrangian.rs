//! Errors of a Lagrangian, for the requested form of the equations.

use crate::error::lists::{approximately, at, quoted};

/// An error of a Lagrangian.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LagrangianError {
    /// There is no Lagrangian, or it does not depend on the quasi-velocities.
    #[error("the system has no Lagrangian")]
    Missing,
    /// ∂²L/∂η∂η is singular at almost all states.
    #[error(
        "the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank {rank} of {size}, so {} not determined by its equation",
        undetermined(quasi_velocities)
    )]
    Degenerate {
        /// Rank of the Hessian.
        rank: usize,
        /// Number of quasi-velocities.
        size: usize,
        /// The quasi-velocities for which elimination found no pivot.
        quasi_velocities: Vec<String>,
    },
    /// H(t, x, y) was requested where y = ∂L/∂η is not linear in the quasi-velocities.
    #[error(
        "the Hamiltonian as a function of the momenta needs a Lagrangian that is quadratic in the quasi-velocities; \
         this one is not in `{quasi_velocity}`"
    )]
    NotQuadratic {
        /// A quasi-velocity in which L is not quadratic.
        quasi_velocity: String,
    },
    /// The Coriolis matrix was requested where the kinetic energy is not quadratic in the quasi-velocities.
    #[error(
        "the Coriolis matrix needs a Lagrangian that is quadratic in the quasi-velocities; the mass matrix of this one \
         depends on `{quasi_velocity}`"
    )]
    NoCoriolisMatrix {
        /// A quasi-velocity on which M depends.
        quasi_velocity: String,
    },
    /// Lagrange's equations were requested in coordinates that are not independent.
    #[error(
        "Lagrange's equations need independent coordinates; here {coordinates} coordinates move with \
         {quasi_velocities} quasi-velocities"
    )]
    RedundantCoordinates {
        /// Number n of coordinates.
        coordinates: usize,
        /// Number k of quasi-velocities.
        quasi_velocities: usize,
    },
    /// L or ∂L/∂η has no value where the velocities vanish, so that inertia cannot be separated from forces.
    #[error(
        "the Lagrangian or its momenta have no value at rest, so that forces of inertia cannot be separated from active forces"
    )]
    NoRest,
    /// L jumps on the path of the motion, so that the force derived from L is an impulse there.
    #[error("the Lagrangian jumps by {} at {}: its force there is an impulse", approximately(*size), at(place))]
    Jumps {
        /// The size of the jump.
        size: f64,
        /// Names and values of the variables at a jump.
        place: Vec<(String, f64)>,
    },
    /// A momentum ∂L/∂η jumps, so that its rate of change is an impulse.
    #[error(
        "the momentum of `{quasi_velocity}`, the derivative of the Lagrangian, jumps by {} at {}: its rate there is an impulse",
        approximately(*size),
        at(place)
    )]
    MomentumJumps {
        /// The quasi-velocity.
        quasi_velocity: String,
        /// The size of the jump.
        size: f64,
        /// Names and values of the variables at a jump.
        place: Vec<(String, f64)>,
    },
    /// The frame or the kinetic energy contains an input whose rate is not known.
    #[error("velocities or momenta depend on the input `{input}`, whose rate is not known")]
    SignalInMomentum {
        /// The input.
        input: String,
    },
}

fn undetermined(names: &[String]) -> String {
    match names {
        [_] => format!("{} is", quoted(names)),
        _ => format!("{} are", quoted(names)),
    }
}
