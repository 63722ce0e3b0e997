//! The reasons why no agreement between the two derivations was found.

use std::fmt;

use pc_expr::Spent;
use pc_model::ModelError;

/// The reason why the two derivations of a model were not found to agree.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum VerifyError {
    /// The two derivations give different motions: one of them is wrong.
    #[error(transparent)]
    Disagreement(Box<Disagreement>),
    /// The first derivation refuses the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The second derivation of this model cannot be carried out.
    #[error("the second derivation cannot be made: {0}")]
    Unable(#[from] Unable),
    /// There was no state at which both derivations were regular.
    #[error("nothing could be compared: of {tried} states none is regular; {reason}")]
    NothingCompared {
        /// The number of states tried.
        tried: usize,
        /// The reason why the last of these states was skipped.
        reason: String,
    },
}

/// A quantity for which the two derivations give different values.
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
    /// The value of the quantity according to the compiled first derivation.
    pub first: f64,
    /// The value of the quantity according to the second derivation.
    pub second: f64,
    /// The size of the terms of the quantity, in its units, including rounding errors propagated through the
    /// linear equations.
    pub size: f64,
    /// Time.
    pub t: f64,
    /// The coordinates and quasi-velocities, with their values.
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

/// The reason why the second derivation cannot be carried out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unable {
    /// A name that the model does not declare.
    #[error("`{name}` is unknown")]
    UnknownName {
        /// The name.
        name: String,
    },
    /// A definition that contains itself.
    #[error("`{name}` is defined by itself")]
    Circular {
        /// The name.
        name: String,
    },
    /// A call of a function that is too long when it is written out.
    #[error("`{name}` is too long when its calls are written out")]
    TooLong {
        /// The function.
        name: String,
    },
    /// d() is applied to velocities where accelerations are not known, or nested too deeply.
    #[error("d() of velocities, or nested too deeply")]
    NoRate,
    /// A reaction is used outside `[integrals]` and `[outputs]`.
    #[error("a reaction where none is known")]
    NoReaction,
    /// Only some of the quasi-velocities are defined.
    #[error("the quasi-velocity `{name}` is neither defined nor in [kinematics]")]
    Undefined {
        /// A quasi-velocity that is not defined.
        name: String,
    },
    /// The rank of the frame is lower than the number of quasi-velocities, and the brackets are neither given
    /// nor determined by constants.
    #[error("the brackets of the quasi-velocities are neither given nor determined by constants")]
    NoBrackets,
    /// A name of `[algebra]` that is not in the table of the second derivation.
    #[error("the algebra `{name}` is unknown")]
    UnknownAlgebra {
        /// As written.
        name: String,
    },
}

/// The reason why a state is skipped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum Irregular {
    /// The second derivation cannot be carried out at any state.
    #[error(transparent)]
    Unable(#[from] Unable),
    /// A value is not finite.
    #[error("{what} is not finite")]
    NotFinite {
        /// The quantity.
        what: &'static str,
    },
    /// A derivative is needed at a corner of |x|, min, max, sign or step.
    #[error("`{function}` has a corner")]
    Corner {
        /// The function.
        function: &'static str,
    },
    /// The linear equations for accelerations and multipliers are singular.
    #[error("the equations for the accelerations are singular")]
    Singular,
    /// No nearby state satisfies the constraints.
    #[error("no nearby state satisfies the constraints")]
    OffConstraints,
    /// The frame does not determine its brackets here.
    #[error("the frame is singular or not closed")]
    Frame,
    /// The compiled first derivation reports that it cannot be evaluated.
    #[error("the form {form} refuses it: {message}")]
    Refused {
        /// The form.
        form: String,
        /// Its message.
        message: String,
    },
    /// A limit on the amount of work was reached, which ends the comparison.
    #[error("{what}")]
    Spent {
        /// The limit.
        what: Spent,
    },
    /// Rounding errors are amplified so much that they would hide errors of derivation.
    #[error("rounding errors are amplified too much")]
    IllConditioned,
}
