//! Errors of constraints.

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
    /// Voronets' equations were requested in quasi-velocities.
    #[error("Voronets' equations are those of a system in the velocities of its coordinates")]
    NotInVelocities,
    /// A form of the equations that requires constraints affine in the velocities.
    #[error("{form} need constraints that are affine in the velocities; `{constraint}` is not")]
    Nonlinear {
        /// The requested form.
        form: &'static str,
        /// The name of the first constraint that is not.
        constraint: String,
    },
    /// A constraint that no velocity satisfies together with others.
    #[error("the constraint `{constraint}` contradicts {}", quoted(others))]
    Contradictory {
        /// Its name.
        constraint: String,
        /// The constraints that leave no velocity for it; empty if it leaves none by itself.
        others: Vec<String>,
    },
    /// An error of the derivation.
    #[error(transparent)]
    Mech(#[from] MechError),
}

fn quoted(names: &[String]) -> String {
    match names {
        [] => "itself: no velocity satisfies it".to_owned(),
        _ => names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and "),
    }
}
