//! Errors of the analysis of motions.

use pc_expr::{Expr, ExprError, Failure, Graph, readable};
use pc_mech::{MechError, ShapeError};
use pc_nonholo::NonholoError;

/// An error of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AnalysisError {
    /// Newton's method ended at a state where the rates do not vanish.
    #[error(
        "no steady motion was found near the guess: after {iterations} steps the rates that should vanish have \
         the norm {} at t = {t}{}",
        readable(*residual),
        listed(state)
    )]
    NoSteadyMotion {
        /// √Σ f_i² over the components that are not cyclic.
        residual: f64,
        /// The number of steps taken.
        iterations: usize,
        /// Time.
        t: f64,
        /// The names and values of the state at which the residual was least.
        state: Vec<(String, f64)>,
    },
    /// Newton's method ended at a state where the rates vanish but have no derivatives, for example at a pole
    /// of the coordinates or of the frame.
    #[error("the rates vanish, but have no derivatives, at{}", listed(state).trim_start_matches(','))]
    NotSmooth {
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// Outputs contain reactions at a state where the constraints do not determine the reactions.
    #[error(
        "the constraints are dependent at{}, where they leave the reactions in {} undetermined",
        listed(state).trim_start_matches(','),
        quoted(outputs)
    )]
    ReactionsUndetermined {
        /// Names of the outputs.
        outputs: Vec<String>,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// The rates also vanish at other values nearby, so that the values are not determined.
    #[error("{} may change while the rates still vanish, so that nothing determines them", quoted(names))]
    Undetermined {
        /// The names of the values that are not determined.
        names: Vec<String>,
    },
    /// A name was given that no component of the state has.
    #[error("the state has no component `{name}`; it has {}", known.join(", "))]
    UnknownComponent {
        /// The name.
        name: String,
        /// The names of the components.
        known: Vec<String>,
    },
    /// A component was named as cyclic, but a rate depends on it.
    #[error("`{coordinate}` is not cyclic: the rate of `{component}` depends on it")]
    NotCyclic {
        /// The component named as cyclic.
        coordinate: String,
        /// A component whose rate depends on it.
        component: String,
    },
    /// A steady motion was requested for equations that depend on time.
    #[error("the equations depend on time explicitly, so that no state is steady")]
    DependsOnTime,
    /// A steady motion was requested for equations whose coordinates satisfy relations that are not known.
    #[error(
        "the start is not steady, as rates of norm {} show, and the functions of the coordinates that the frame keeps \
         are not known, so that no other state can be reached from it",
        readable(*residual)
    )]
    LeafUnknown {
        /// √Σ f_i² over the components that are not cyclic.
        residual: f64,
    },
    /// A box was given for a coordinate on which equilibria do not depend.
    #[error("`{name}` is cyclic: equilibria exist at any value of it, so it takes no box")]
    CyclicBox {
        /// The coordinate.
        name: String,
    },
    /// A box is empty.
    #[error("the box of `{name}` from {} to {} is empty", readable(*low), readable(*high))]
    EmptyBox {
        /// The coordinate.
        name: String,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// A function that should be an integral changes along the motion.
    #[error("`{name}` is not a first integral free of time, so it does not prove stability")]
    NotConserved {
        /// Its name.
        name: String,
    },
    /// Hamilton–Jacobi's equation was requested with generalised forces.
    #[error("Hamilton–Jacobi's equation needs Q = 0; the force on `{quasi_velocity}` is not zero")]
    Forced {
        /// The first quasi-velocity with a force.
        quasi_velocity: String,
    },
    /// A function that does not satisfy Hamilton–Jacobi's equation.
    #[error("S does not satisfy Hamilton–Jacobi's equation: X_0 S + H(t, x, X_s S) = {remainder}")]
    NotAnAction {
        /// Text of the left-hand side.
        remainder: String,
    },
    /// Too few functions are known that all operators of the frame leave unchanged.
    #[error(
        "the orbits of the frame are given by {needed} functions f(t, x) with X_0 f = X_s f = 0; {found} of them are known"
    )]
    OrbitUnknown {
        /// The number of independent invariants that are known.
        found: usize,
        /// n − rank b
        needed: usize,
    },
    /// Newton's method ended at constants with which the action does not have the given momenta.
    #[error(
        "y_s = X_s S has no solution near the given constants: the norm of the difference is {} at t = {t}{}",
        readable(*residual),
        listed(constants)
    )]
    NoConstants {
        /// |X_s S − y_s|
        residual: f64,
        /// Time.
        t: f64,
        /// The names and values of the constants at which the residual was least.
        constants: Vec<(String, f64)>,
    },
    /// The branch of an action ends along a motion.
    #[error("the branch of the action ends at t = {t}{}", listed(coordinates))]
    BranchEnds {
        /// Time.
        t: f64,
        /// The names and values of the coordinates there.
        coordinates: Vec<(String, f64)>,
    },
    /// A solution of Hamilton–Jacobi's equation with too few constants.
    #[error("the integral is not complete: the matrix ∂(X_s S)/∂α has rank {rank} of {size}")]
    IncompleteIntegral {
        /// The rank at almost all points.
        rank: usize,
        /// rank b, the number of quasi-velocities of a frame without relations between its operators.
        size: usize,
    },
    /// Newton's method ended at a position where Jacobi's equations are not satisfied.
    #[error(
        "∂S/∂α = β has no solution near the guess: after {iterations} steps the norm of the difference is {} at \
         t = {t}{}",
        readable(*residual),
        listed(coordinates)
    )]
    NoPosition {
        /// |∂S/∂α − β|
        residual: f64,
        /// The number of steps taken.
        iterations: usize,
        /// Time.
        t: f64,
        /// The names and values of the coordinates at which the residual was least.
        coordinates: Vec<(String, f64)>,
    },
    /// A function contains a symbol that is not a variable here.
    #[error("`{symbol}` stands in {what}, which can contain {}", quoted(known))]
    NotAVariable {
        /// The kind of function.
        what: &'static str,
        /// The first symbol that is neither a variable nor declared as constant.
        symbol: String,
        /// The symbols that the function can contain.
        known: Vec<String>,
    },
    /// Constraints whose brackets with each other form a singular matrix.
    #[error(
        "the brackets of {} with each other form a singular matrix, so that there is no bracket of Dirac",
        quoted(constraints)
    )]
    NotSecondClass {
        /// Texts of the constraints.
        constraints: Vec<String>,
    },
    /// An error of the derivation, or of the numerical evaluation of a motion.
    #[error(transparent)]
    Mech(#[from] MechError),
    /// An error of the constraints.
    #[error(transparent)]
    Nonholo(#[from] NonholoError),
    /// An error of the expressions.
    #[error(transparent)]
    Expr(#[from] ExprError),
}

impl From<Failure> for AnalysisError {
    /// The error of a [`Motion`](pc_mech::Motion); for other vector fields the text of their error.
    fn from(failure: Failure) -> AnalysisError {
        MechError::from(failure).into()
    }
}

/// Returns an error unless `found` equals `expected`.
pub(crate) fn shape(what: &'static str, found: usize, expected: usize) -> Result<(), AnalysisError> {
    if found == expected { Ok(()) } else { Err(MechError::from(ShapeError { what, found, expected }).into()) }
}

/// Returns an error that names the first symbol in `functions` that is not `known`.
pub(crate) fn check_variables<'g>(
    what: &'static str,
    graph: &'g Graph,
    functions: &[Expr<'g>],
    known: &[Expr<'g>],
) -> Result<(), AnalysisError> {
    match graph.symbols_of(functions).into_iter().find(|symbol| !known.contains(symbol)) {
        None => Ok(()),
        Some(symbol) => {
            let known = known.iter().map(Expr::to_string).collect();
            Err(AnalysisError::NotAVariable { what, symbol: symbol.to_string(), known })
        }
    }
}

fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

fn listed(values: &[(String, f64)]) -> String {
    values.iter().map(|(name, value)| format!(", {name} = {}", readable(*value))).collect()
}
