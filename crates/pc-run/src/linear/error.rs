//! Errors of linearizations and equilibria.

use pc_analysis::{AnalysisError, BranchCount};
use pc_model::UnknownValue;

use crate::category::Category;
use pc_print::short;

/// An error of `pc linearize` or `pc equilibria`.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LinearError {
    /// One name is given values twice.
    #[error("`{name}` is given values twice; leave one out")]
    Twice {
        /// The name.
        name: String,
    },
    /// `--vary` names something that is neither a parameter nor has a start value.
    #[error("--vary: {0}")]
    Varied(UnknownValue),
    /// A name that is not a component of the state.
    #[error("{option}: there is no component `{name}` of the state here; there are {}", known.join(", "))]
    Component {
        /// The option.
        option: &'static str,
        /// As written.
        name: String,
        /// The components of the state.
        known: Vec<String>,
    },
    /// A box that is meaningless or empty.
    #[error("--box: {0}")]
    Box(AnalysisError),
    /// No state is steady.
    #[error(
        "the equations depend on time explicitly, so that no state is steady\n  help: {help}",
        help = if *of_linearization { "--at start gives their Jacobian at the start" } else { "give what drives them a constant value" }
    )]
    DependsOnTime {
        /// Whether a linearization was requested.
        of_linearization: bool,
    },
    /// Newton's method did not converge.
    #[error(
        "no steady state was found near the start: the rates that should vanish {} where Newton's method \
         ended, at {}\n  help: start nearer to one (--set NAME=VALUE), which `pc equilibria` finds for those of rest, hold fewer \
         components (--hold), or take the Jacobian of the start as it is (--at start)",
        left(*residual),
        listed(state)
    )]
    NotSteady {
        /// √Σ f_i², NaN where the rates are not defined.
        residual: f64,
        /// The state at which the method ended.
        state: Vec<(String, f64)>,
    },
    /// Newton's method did not converge for the values to be chosen.
    #[error(
        "the rates vanish for no values of {} that were found: those that should vanish {} where Newton's method ended, \
         at {}\n  help: leave more inputs or components of the state free, or start nearer",
        free.join(", "),
        left(*residual),
        listed(state)
    )]
    NotTrimmed {
        /// The names of the values to be chosen.
        free: Vec<String>,
        /// √Σ f_i²
        residual: f64,
        /// The state at which the method ended.
        state: Vec<(String, f64)>,
    },
    /// A name to be chosen that is neither a component of the state nor an input.
    #[error("`{name}` is neither a component of the state nor an input here; these are {}", known.join(", "))]
    Free {
        /// As given.
        name: String,
        /// The components of the state and the inputs.
        known: Vec<String>,
    },
    /// The start is not steady, and no other state is known to be reachable from it.
    #[error(
        "the start is not steady, as rates of norm {} show, and the functions of the coordinates that the frame keeps are not \
         known, so that no other state can be reached from it\n  help: declare these functions under [integrals], or start at \
         a steady state",
        short(*residual, 3)
    )]
    LeafUnknown {
        /// √Σ f_i²
        residual: f64,
    },
    /// The rates have no derivatives where they vanish.
    #[error(
        "the rates vanish but have no derivatives at {}: the coordinates or the frame are singular there, or a force jumps\n  \
         help: use others that are regular there, or start nearer to another steady state (--set NAME=VALUE)",
        listed(state)
    )]
    NotSmooth {
        /// The state.
        state: Vec<(String, f64)>,
    },
    /// Outputs contain reactions that are not determined.
    #[error("{0}\n  help: leave these outputs out, or one of the constraints that follow from others")]
    ReactionsUndetermined(AnalysisError),
    /// There is no steady state for any value of the parameter.
    #[error("there is no steady state for any of the {values} values; for the first: {first}")]
    NoneSteady {
        /// The number of values.
        values: usize,
        /// The error for the first value.
        first: String,
    },
    /// The state has more or fewer components for another value of a parameter.
    #[error("at {name} = {}: {cause}: the constraints have another rank there\n  help: vary it over a smaller range", short(*value, 6))]
    Branches {
        /// The parameter.
        name: String,
        /// Its value.
        value: f64,
        /// The two numbers of components.
        cause: BranchCount,
    },
    /// The search found nothing.
    #[error(
        "no equilibrium was found from {starts} starts{}{}\n  help: {}",
        match converged { 0 => String::new(), n => format!("; {n} led to some outside the box") },
        match poles {
            0 => String::new(),
            n => format!("; {n} led to where the coordinates or the frame are singular and the rates have no derivatives"),
        },
        match (converged, poles) {
            (0, 0) => "widen the box (--box NAME=FROM:TO), or take more starts (--starts N); where a force drives a coordinate on \
                       which nothing depends, there is none in any box",
            (_, 0) => "widen the box (--box NAME=FROM:TO), or take more starts (--starts N)",
            _ => "use coordinates and a frame that are regular there, such as more coordinates under a constraint",
        }
    )]
    NoEquilibrium {
        /// The number of starts.
        starts: usize,
        /// How many of the starts converged.
        converged: usize,
        /// How many led to where the rates have no derivatives.
        poles: usize,
    },
    /// Any other error in the analysis.
    #[error(transparent)]
    Analysis(AnalysisError),
}

impl LinearError {
    /// Converts an error of the analysis that is not about a name given on the command line.
    pub(crate) fn of(error: AnalysisError, of_linearization: bool) -> LinearError {
        match error {
            AnalysisError::DependsOnTime => LinearError::DependsOnTime { of_linearization },
            AnalysisError::NoSteadyMotion { residual, state, .. } => {
                LinearError::NotSteady { residual, state }
            }
            AnalysisError::NotSmooth { state } => LinearError::NotSmooth { state },
            AnalysisError::LeafUnknown { residual } => LinearError::LeafUnknown { residual },
            AnalysisError::ReactionsUndetermined { .. } => LinearError::ReactionsUndetermined(error),
            AnalysisError::UnknownComponent { name, known } => {
                let option = if of_linearization { "--hold" } else { "--box" };
                LinearError::Component { option, name, known }
            }
            AnalysisError::CyclicBox { .. } | AnalysisError::EmptyBox { .. } => LinearError::Box(error),
            other => LinearError::Analysis(other),
        }
    }

    /// The kind of the error.
    pub fn category(&self) -> Category {
        match self {
            LinearError::Twice { .. }
            | LinearError::Varied(_)
            | LinearError::Component { .. }
            | LinearError::Free { .. }
            | LinearError::Box(_) => Category::Request,
            LinearError::DependsOnTime { .. }
            | LinearError::LeafUnknown { .. }
            | LinearError::NotSmooth { .. }
            | LinearError::ReactionsUndetermined(_)
            | LinearError::Branches { .. }
            | LinearError::Analysis(_) => Category::Undefined,
            LinearError::NotSteady { .. }
            | LinearError::NotTrimmed { .. }
            | LinearError::NoneSteady { .. }
            | LinearError::NoEquilibrium { .. } => Category::Failed,
        }
    }
}

/// What is left of rates that should vanish.
fn left(residual: f64) -> String {
    match residual.is_finite() {
        true => format!("have the norm {}", short(residual, 3)),
        false => "are not defined".to_owned(),
    }
}

fn listed(state: &[(String, f64)]) -> String {
    state.iter().map(|(name, value)| format!("{name} = {}", short(*value, 6))).collect::<Vec<_>>().join(", ")
}
