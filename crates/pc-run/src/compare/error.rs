//! Errors of comparisons.

use pc_expr::parse::ParseError;

use crate::category::Category;

/// A comparison that cannot be made, or motions that differ.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// There is only one model in only one form.
    #[error("there is one motion only: give another model, or two forms as in `--form poincare,canonical`")]
    OneMotion,
    /// More forms were given than models.
    #[error("--form: {count} forms are given for two motions; give one or two")]
    Forms {
        /// How many.
        count: usize,
    },
    /// Both models are to be read from standard input.
    #[error("only one of the models can come from standard input")]
    StandardInput,
    /// The motions begin at different times.
    #[error("the motions begin at t = {first} and t = {second}: `t_start` in [simulation] must be the same")]
    Starts {
        /// The start time of the first motion.
        first: f64,
        /// The start time of the second motion.
        second: f64,
    },
    /// There is nothing to compare.
    #[error(
        "no column but the energy is in both motions: the first has {}, the second {}; say what corresponds, as in `--map \
         \"r=sqrt(x^2+y^2)\"`",
        first.join(", "), second.join(", ")
    )]
    NothingShared {
        /// The columns of the first motion.
        first: Vec<String>,
        /// The columns of the second motion.
        second: Vec<String>,
    },
    /// A column that the two motions do not have in common.
    #[error("--columns: `{name}` is not a column of both motions; these are {}", shared.join(", "))]
    NotShared {
        /// The requested name.
        name: String,
        /// The columns that both motions have.
        shared: Vec<String>,
    },
    /// Text that is not an expression.
    #[error("--map: `{text}`: {error}; {}", error.help())]
    Expression {
        /// As written.
        text: String,
        /// What is wrong with the text.
        error: ParseError,
    },
    /// A name that is neither a column nor a parameter.
    #[error("--map: `{text}`: `{name}` is neither a column nor a parameter of {model}; these are {}", known.join(", "))]
    UnknownName {
        /// The expression.
        text: String,
        /// The unknown name in the expression.
        name: String,
        /// The model.
        model: String,
        /// The columns and parameters of the model.
        known: Vec<String>,
    },
    /// A derivative, which tables do not contain.
    #[error("--map: `{text}`: d() cannot be taken of columns; make it an entry of [outputs] in the model")]
    Derivative {
        /// The expression.
        text: String,
    },
    /// The motions are not the same.
    #[error("the motions differ: {}", differences.join("; "))]
    Different {
        /// What differs.
        differences: Vec<String>,
    },
    /// The errors of integration are too large to tell.
    #[error(
        "the errors of integration are too large to tell whether the motions are the same: {}; give smaller tolerances or an \
         earlier end, or say by --tolerance or --absolute how much they may differ",
        columns.join("; ")
    )]
    Undecided {
        /// What cannot be told, and from when on.
        columns: Vec<String>,
    },
}

impl CompareError {
    /// The kind of the error.
    pub fn category(&self) -> Category {
        match self {
            CompareError::Different { .. } => Category::Different,
            CompareError::Undecided { .. } => Category::Undecided,
            _ => Category::Request,
        }
    }
}
