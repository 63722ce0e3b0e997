//! Why there is no agreement.

use std::fmt;

use pc_expr::Spent;
use pc_model::ModelError;

/// Why a model was not found to agree with its second derivation.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// The two derivations give different motions: one of them is wrong.
    #[error(transparent)]
    Disagreement(Box<Disagreement>),
    /// The first derivation refuses the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The second derivation cannot be made of this model.
    #[error("the second derivation cannot be made: {0}")]
    Unable(#[from] Unable),
    /// Nowhere were both derivations regular.
    #[error("nothing could be compared: of {tried} states none is regular; {reason}")]
    NothingCompared {
        /// States tried.
        tried: usize,
        /// Why the last one was passed over.
        reason: String,
    },
}

/// A quantity with two values.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the two derivations disagree: {quantity} of the form {form} is {first:?}, by the second derivation {second:?}, of terms \
     up to {size:?}, at {}",
    State { t: *t, values: state }
)]
pub struct Disagreement {
    /// The form of the equations, as [`Agreement::forms`](crate::Agreement::forms) calls it.
    pub form: String,
    /// The quantity.
    pub quantity: String,
    /// Its value by the first derivation, compiled.
    pub first: f64,
    /// Its value by the second.
    pub second: f64,
    /// How large the terms are that it is made up of, in its own units, rounding being led through the linear equations.
    pub size: f64,
    /// Time.
    pub t: f64,
    /// Coordinates and quasi-velocities.
    pub state: Vec<(String, f64)>,
}

struct State<'a> {
    t: f64,
    values: &'a [(String, f64)],
}

impl fmt::Display for State<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "t = {:?}", self.t)?;
        self.values.iter().try_for_each(|(name, value)| write!(f, ", {name} = {value:?}"))
    }
}

/// What the second derivation does not know.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unable {
    /// A name that is none of the model's.
    #[error("`{name}` is unknown")]
    UnknownName {
        /// It.
        name: String,
    },
    /// A definition that contains itself.
    #[error("`{name}` is defined by itself")]
    Circular {
        /// It.
        name: String,
    },
    /// d() of what contains velocities, where accelerations are not known, or d() too deep inside d().
    #[error("d() of velocities, or nested too deep")]
    NoRate,
    /// A reaction outside `[integrals]` and `[outputs]`.
    #[error("a reaction where none is known")]
    NoReaction,
    /// Quasi-velocities of which only some are defined.
    #[error("the quasi-velocity `{name}` is neither defined nor in [kinematics]")]
    Undefined {
        /// One that is not.
        name: String,
    },
    /// The frame is of lower rank, and nothing says what the brackets are.
    #[error("the brackets of the quasi-velocities are neither given nor determined by constants")]
    NoBrackets,
    /// A name of `[algebra]` that is not in the table of the second derivation.
    #[error("the algebra `{name}` is not known to it")]
    UnknownAlgebra {
        /// As written.
        name: String,
    },
}

/// Why a state is passed over.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Irregular {
    /// The model cannot be evaluated anywhere.
    #[error(transparent)]
    Unable(#[from] Unable),
    /// Something is not finite.
    #[error("{what} is not finite")]
    NotFinite {
        /// It.
        what: &'static str,
    },
    /// A derivative at a corner of |x|, min, max, sign or step.
    #[error("`{function}` has a corner")]
    Corner {
        /// The function.
        function: &'static str,
    },
    /// The linear equations for accelerations and multipliers are singular.
    #[error("the equations for the accelerations are singular")]
    Singular,
    /// The constraints are not met near by.
    #[error("no state near by satisfies the constraints")]
    OffConstraints,
    /// The frame does not determine its brackets here.
    #[error("the frame is singular or not closed")]
    Frame,
    /// The first derivation, compiled, says that it cannot be evaluated.
    #[error("the form {form} refuses it: {message}")]
    Refused {
        /// The form.
        form: String,
        /// What it says.
        message: String,
    },
    /// A limit of the work was reached, which is the answer then.
    #[error("{what}")]
    Spent {
        /// The limit.
        what: Spent,
    },
    /// Rounding errors are amplified until they hide errors of derivation.
    #[error("rounding errors are amplified too much")]
    IllConditioned,
}
