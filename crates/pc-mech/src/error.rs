//! What can be wrong with a mechanical system.

use pc_algebra::AlgebraError;
use pc_expr::{ExprError, readable};

/// An error of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MechError {
    /// A part of the system with the wrong number of entries.
    #[error("{what} has {found} entries where {expected} are needed")]
    Shape {
        /// The part.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that fits.
        expected: usize,
    },
    /// Neither a Lagrangian was given nor one that depends on the quasi-velocities.
    #[error("the system has no Lagrangian")]
    NoLagrangian,
    /// ∂²L/∂η∂η is singular at almost all states.
    #[error(
        "the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank {rank} of {size}, so that {} not \
         determined by its equation",
        undetermined(quasi_velocities)
    )]
    DegenerateLagrangian {
        /// Rank of the Hessian.
        rank: usize,
        /// Number of quasi-velocities.
        size: usize,
        /// The quasi-velocities in whose elimination no pivot was left.
        quasi_velocities: Vec<String>,
    },
    /// y = ∂L/∂η is not linear in the quasi-velocities.
    #[error(
        "the canonical form needs a Lagrangian that is quadratic in the quasi-velocities; ∂²L/∂η∂η depends on \
         `{quasi_velocity}`"
    )]
    NotQuadratic {
        /// A quasi-velocity in the Hessian.
        quasi_velocity: String,
    },
    /// Lagrange's equations asked for in coordinates that are not independent.
    #[error(
        "Lagrange's equations need independent coordinates; here {coordinates} coordinates move with \
         {quasi_velocities} quasi-velocities"
    )]
    Redundant {
        /// Number n of coordinates.
        coordinates: usize,
        /// Number k of quasi-velocities.
        quasi_velocities: usize,
    },
    /// A pivot of the mass matrix vanished on the way.
    #[error(
        "the mass matrix is singular: the pivot of `{quasi_velocity}` is {pivot:e} at t = {t}{}",
        listed(state)
    )]
    SingularMassMatrix {
        /// The quasi-velocity whose acceleration is not determined.
        quasi_velocity: String,
        /// The pivot.
        pivot: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A derivative was asked for that was not [compiled](crate::CompileOptions).
    #[error("the motion was compiled without its {what}")]
    NotCompiled {
        /// The derivative.
        what: &'static str,
    },
    /// An error of the frame or its algebra.
    #[error(transparent)]
    Algebra(#[from] AlgebraError),
    /// An error of the expressions.
    #[error(transparent)]
    Expr(#[from] ExprError),
}

fn undetermined(names: &[String]) -> String {
    match names {
        [name] => format!("`{name}` is"),
        _ => format!("{} are", names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")),
    }
}

fn listed(values: &[(String, f64)]) -> String {
    values.iter().map(|(name, value)| format!(", {name} = {}", readable(*value))).collect()
}
