//! Errors about constraints.

use pc_mech::MechError;

/// An error of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NonholoError {
    /// A symbol that is to vanish but is not a quasi-velocity of the system.
    #[error("`{name}` is not a quasi-velocity of the system")]
    NotAQuasiVelocity {
        /// Its text.
        name: String,
    },
    /// A quasi-velocity that is listed twice among those that are to vanish.
    #[error("`{name}` is constrained twice")]
    Twice {
        /// The quasi-velocity.
        name: String,
    },
    /// Voronets' equations were requested for a system in quasi-velocities.
    #[error("Voronets' equations are those of a system in the velocities of its coordinates")]
    NotInVelocities,
    /// A form of the equations that requires constraints affine in the velocities.
    #[error("{form} need constraints that are affine in the velocities; `{constraint}` is not")]
    Nonlinear {
        /// The requested form.
        form: &'static str,
        /// The name of the first constraint that is not affine.
        constraint: String,
    },
    /// A constraint that contradicts others: no velocity satisfies them all.
    #[error("the constraint `{constraint}` contradicts {}", quoted(others))]
    Contradictory {
        /// Its name.
        constraint: String,
        /// The constraints that it contradicts; empty if no velocity satisfies this constraint even by
        /// itself.
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
