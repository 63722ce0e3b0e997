//! What can go wrong.

use std::error::Error;
use std::fmt;

use pc_expr::Failure;

use crate::cvode::return_code::Code;
use crate::integration::inequality::Inequality;
use crate::integration::options::Method;
use crate::integration::trajectory::Trajectory;

/// Why an integration was not begun or not completed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The problem or an option is not valid; no step was taken.
    #[error(transparent)]
    Input(#[from] InputError),

    /// SUNDIALS could not make or set up one of its objects; with valid input, it ran out of memory.
    #[error("{function} failed with code {code}: {message}")]
    Setup {
        /// The function of SUNDIALS.
        function: &'static str,
        /// Its return code.
        code: i32,
        /// What SUNDIALS said.
        message: String,
    },

    /// The integration began and could not go on.
    #[error(transparent)]
    Integration(Box<IntegrationError>),
}

impl SolveError {
    /// The return code of CVODES, if that is the reason.
    pub fn code(&self) -> Option<Code> {
        match self {
            SolveError::Integration(error) => error.reason.code(),
            SolveError::Input(_) | SolveError::Setup { .. } => None,
        }
    }

    /// The last state reached, (t, y), if the integration had begun.
    pub fn reached(&self) -> Option<(f64, &[f64])> {
        match self {
            SolveError::Integration(error) => Some((error.time, &error.state)),
            SolveError::Input(_) | SolveError::Setup { .. } => None,
        }
    }
}

/// Why an integration could not go on, and the last state it reached.
///
/// Its [`source`](Error::source) is the cause of [`failure`](IntegrationError::failure).
#[derive(Debug)]
#[non_exhaustive]
pub struct IntegrationError {
    /// Why it could not go on.
    pub reason: Reason,
    /// End of the last successful internal step.
    pub time: f64,
    /// The state at [`time`](IntegrationError::time); as many numbers as the field has components.
    pub state: Vec<f64>,
    /// The last failure of the vector field there: what it reported, or [`NonFinite`] if it wrote such a number.
    pub failure: Option<Failure>,
}

impl fmt::Display for IntegrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reason.write(self.time, f)
    }
}

impl Reason {
    /// The return code of CVODES, if that is the reason.
    fn code(&self) -> Option<Code> {
        match self {
            Reason::Cvode { code, .. } => Some(*code),
            Reason::Adjoint(reason) => reason.code(),
            Reason::Overflow { .. }
            | Reason::Projection { .. }
            | Reason::Functional
            | Reason::EndsEarly { .. }
            | Reason::Collapsed { .. }
            | Reason::Stalled
            | Reason::Rates { .. }
            | Reason::Event { .. }
            | Reason::Reset { .. }
            | Reason::Accumulation { .. }
            | Reason::Grazing { .. }
            | Reason::Together { .. }
            | Reason::Saltation { .. } => None,
        }
    }

    /// The message, after reaching `time`.
    fn write(&self, time: f64, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::Cvode { code, message } => write!(f, "{code} after reaching t = {time}: {message}"),
            Reason::Adjoint(reason) => {
                f.write_str("the adjoint equations, from the end back: ")?;
                reason.write(time, f)
            }
            Reason::EndsEarly { event, t } => write!(
                f,
                "the motion ends with the event {event} at t = {t}: there are gradients of functionals only of motions to \
                 a time that is given"
            ),
            Reason::Functional => write!(f, "the functional has no value at the end, t = {time}"),
            Reason::Collapsed { vector } => write!(
                f,
                "tangent vector number {vector} (from 0) has lost its direction at t = {time}: shorter intervals keep \
                 it"
            ),
            Reason::Overflow { component, value, t } => {
                write!(f, "{component} is {value} at t = {t}, after reaching t = {time}")
            }
            Reason::Projection { t } => write!(
                f,
                "the state at t = {t} cannot be projected to where it belongs, after reaching t = {time}"
            ),
            Reason::Stalled => write!(f, "the steps have become too short to go on from t = {time}"),
            Reason::Rates { t } => {
                write!(f, "the rates at t = {t} cannot be computed, after reaching t = {time}")
            }
            Reason::Event { event, t } => {
                write!(f, "the event {event} cannot be evaluated at t = {t}, after reaching t = {time}")
            }
            Reason::Reset { event, t } => write!(f, "the event {event} cannot reset the state at t = {t}"),
            Reason::Grazing { event, t } => write!(
                f,
                "the function of the event {event} touches zero at t = {t}: the motion after it has no derivatives"
            ),
            Reason::Together { events, t } => write!(
                f,
                "the events {} occur together at t = {t}: the motion after them has no derivatives",
                events.join(", ")
            ),
            Reason::Saltation { t } => {
                write!(f, "the rates of the motion cannot be evaluated on both sides of the reset at t = {t}")
            }
            Reason::Accumulation { event, occurrences, t } => write!(
                f,
                "the event {event} occurs without end near t = {t:.5e} ({occurrences} times up to t = {time})"
            ),
        }
    }
}

impl Error for IntegrationError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.failure.as_ref().map(|failure| failure.cause() as &(dyn Error + 'static))
    }
}

/// Why an integration could not go on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// CVODES returned an error.
    Cvode {
        /// Its return code.
        code: Code,
        /// What it said.
        message: String,
    },

    /// The integration of the adjoint equations, from the end back, could not go on; time and state reached are those of
    /// the motion there.
    Adjoint(Box<Reason>),

    /// The end term of a [functional](crate::Functional) failed.
    Functional,

    /// A terminal event ends the motion before the end of a [functional](crate::Functional).
    EndsEarly {
        /// Its name.
        event: String,
        /// When it occurred.
        t: f64,
    },

    /// A tangent vector became a combination of those before it, to rounding, in the course of one interval.
    Collapsed {
        /// Its number.
        vector: usize,
    },

    /// A component grew beyond the largest number in a step that CVODES accepted.
    Overflow {
        /// Name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// End of that step.
        t: f64,
    },

    /// The state could not be [projected](pc_expr::VectorField::project) to the surface it belongs to.
    Projection {
        /// Time of that state.
        t: f64,
    },

    /// The steps became so short that t + h rounds to t: the motion is singular there, or failures of the vector field
    /// wall it in.
    Stalled,

    /// The vector field could not be evaluated, by a method that has no shorter step to try.
    Rates {
        /// Time of the state at which it was evaluated.
        t: f64,
    },

    /// The function of an event, or of one together with it, could not be evaluated.
    Event {
        /// Its name.
        event: String,
        /// Time of the state at which it was evaluated.
        t: f64,
    },

    /// An event did not give a new state.
    Reset {
        /// Its name.
        event: String,
        /// When it occurred.
        t: f64,
    },

    /// An event that resets the state is met at no speed: sensitivities have no bound.
    Grazing {
        /// Its name.
        event: String,
        /// When it occurred.
        t: f64,
    },

    /// Events that reset the state occur together: sensitivities depend on which of them would come first.
    Together {
        /// Their names.
        events: Vec<String>,
        /// When they occurred.
        t: f64,
    },

    /// The rates before or after a reset, by which sensitivities jump, cannot be evaluated.
    Saltation {
        /// When it occurred.
        t: f64,
    },

    /// An event [accumulates](crate::Accumulation).
    Accumulation {
        /// Its name.
        event: String,
        /// How often it has occurred.
        occurrences: u64,
        /// The time that its occurrences approach, if their distances go on as a geometric series.
        t: f64,
    },
}

/// A number that is not finite, written by a vector field that reported no failure, or never written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NonFinite {
    /// A component of f(t, y).
    #[error("the rate of {component} is {value} at t = {t}")]
    Rate {
        /// Name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// Where f was evaluated.
        t: f64,
    },

    /// An entry of ∂f/∂y.
    #[error("the derivative of the rate of {row} by {column} is {value} at t = {t}")]
    Jacobian {
        /// Name of the component of f.
        row: String,
        /// Name of the component of y.
        column: String,
        /// NaN or an infinity.
        value: f64,
        /// Where the Jacobian was evaluated.
        t: f64,
    },

    /// A component of (∂f/∂y) v.
    #[error("the change of the rate of {component} in a direction is {value} at t = {t}")]
    Product {
        /// Name of the component of f.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// Where the product was evaluated.
        t: f64,
    },

    /// An entry of ∂f/∂p.
    #[error("the derivative of the rate of {row} by parameter {parameter} (from 0) is {value} at t = {t}")]
    ParameterJacobian {
        /// Name of the component of f.
        row: String,
        /// Number of the parameter.
        parameter: usize,
        /// NaN or an infinity.
        value: f64,
        /// Where the derivative was evaluated.
        t: f64,
    },

    /// An entry of (∂f/∂y) s.
    #[error(
        "the rate of {component} has a derivative along column {column} (from 0) that is {value} at t = {t}"
    )]
    Variation {
        /// Name of the component of f.
        component: String,
        /// Number of the column s.
        column: usize,
        /// NaN or an infinity.
        value: f64,
        /// Where the product was evaluated.
        t: f64,
    },

    /// A component of what a [preconditioner](crate::Preconditioner) wrote.
    #[error("the preconditioner makes {component} {value} at t = {t}")]
    Preconditioned {
        /// Name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// The time of the step.
        t: f64,
    },

    /// The function of an event.
    #[error("the function of the event {event} is {value} at t = {t}")]
    Event {
        /// Its name.
        event: String,
        /// NaN or an infinity.
        value: f64,
        /// Where it was evaluated.
        t: f64,
    },

    /// A value or derivative of a [functional](crate::Functional).
    #[error("{what} is {value} at t = {t}")]
    Functional {
        /// Which.
        what: String,
        /// NaN or an infinity.
        value: f64,
        /// Where it was evaluated.
        t: f64,
    },

    /// A rate of an [integral](crate::Integrals).
    #[error("the rate of integral number {index} (from 0) is {value} at t = {t}")]
    Integrand {
        /// Its number.
        index: usize,
        /// NaN or an infinity.
        value: f64,
        /// Where it was evaluated.
        t: f64,
    },

    /// A component of a state after a reset.
    #[error("the event {event} sets {component} to {value} at t = {t}")]
    Reset {
        /// Its name.
        event: String,
        /// Name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// When it occurred.
        t: f64,
    },
}

/// What is wrong with a problem or an option.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// The vector field has dimension 0.
    #[error("the vector field has no components")]
    NoComponents,

    /// A list of one number for each component has another length.
    #[error("{what}: {found} numbers for {expected} components")]
    Length {
        /// Which list.
        what: &'static str,
        /// Dimension of the vector field.
        expected: usize,
        /// Length of the list.
        found: usize,
    },

    /// A checkpoint of a motion with another number of events.
    #[error("the checkpoint is of a motion with {found} events, not {expected}")]
    EventCount {
        /// Number of events of the motion.
        expected: usize,
        /// Number of events in the checkpoint.
        found: usize,
    },

    /// An input is NaN or infinite.
    #[error("{what} is {value}")]
    NotFinite {
        /// Which input.
        what: String,
        /// NaN or an infinity.
        value: f64,
    },

    /// An option that must be positive is not.
    #[error("{what} is {value}, but must be positive")]
    NotPositive {
        /// Which option.
        what: String,
        /// Its value.
        value: f64,
    },

    /// The largest order is 0 or beyond what the method has.
    #[error("the maximum order is {found}, but {method} has orders 1 to {limit}")]
    MaxOrder {
        /// The method.
        method: Method,
        /// Its highest order.
        limit: u32,
        /// The order asked for.
        found: u32,
    },

    /// The least step is larger than the largest.
    #[error("the minimum step {min} is larger than the maximum step {max}")]
    StepBounds {
        /// The least step.
        min: f64,
        /// The largest step.
        max: f64,
    },

    /// A checkpoint of an integration with another number of sensitivities.
    #[error(
        "the checkpoint has {found} columns of sensitivities, and {expected} are asked for: an integration with \
         sensitivities is resumed with the same ones"
    )]
    Sensitivities {
        /// Columns asked for.
        expected: usize,
        /// Columns of the checkpoint.
        found: usize,
    },

    /// No functional to differentiate.
    #[error("there is no functional")]
    NoFunctional,

    /// Integrals of a motion are asked of an integration that has none, or asked for of one that has begun.
    #[error("integrals are to be asked for once, before the first step")]
    NoIntegrals,

    /// Derivatives of a motion are asked of an integration that has none.
    #[error("the integration was begun without sensitivities")]
    NoSensitivities,

    /// Derivatives by parameters, with events whose own derivatives by these are not known.
    #[error(
        "an event resets the state, and it is not known how its function and its reset depend on the parameters that \
         sensitivities are asked for"
    )]
    EventParameters,

    /// A step is to be looked at for events in 0 parts.
    #[error("the number of samples per step must be at least 1")]
    SamplesPerStep,

    /// The part of a distance to which those of events shrink when they accumulate.
    #[error("events accumulate within a part from 0 to less than 1 of their distance, not {within}")]
    Accumulation {
        /// The part given.
        within: f64,
    },

    /// The maximum number of steps is 0.
    #[error("the maximum number of steps must be at least 1")]
    MaxSteps,

    /// A linear solver is chosen, and the fixed-point iteration uses none.
    #[error("a linear solver is chosen, but the fixed-point iteration has no linear systems to solve")]
    LinearSolverUnused,

    /// The sparse linear solver is chosen for a field that does not know the zero pattern of ∂f/∂y.
    #[error(
        "the sparse linear solver needs the zero pattern of the Jacobian, which the vector field does not know"
    )]
    NoPattern,

    /// The zero pattern of ∂f/∂y is not that of a square matrix of the field's dimension.
    #[error(
        "the zero pattern of the Jacobian has {rows} rows and {columns} columns for {expected} components"
    )]
    PatternSize {
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// Dimension of the vector field.
        expected: usize,
    },

    /// A band matrix has diagonals beyond its corners.
    #[error(
        "a band of {lower} diagonals below the main one and {upper} above does not fit {components} components"
    )]
    BandTooWide {
        /// Diagonals below the main one.
        lower: usize,
        /// Diagonals above the main one.
        upper: usize,
        /// Dimension of the vector field.
        components: usize,
    },

    /// An entry of ∂f/∂y that may be other than zero lies outside of the band chosen.
    #[error(
        "the rate of {row} depends on {column}, outside of the band of {lower} diagonals below the main one and \
         {upper} above"
    )]
    OutsideBand {
        /// Name of the component of f.
        row: String,
        /// Name of the component of y.
        column: String,
        /// Diagonals below the main one.
        lower: usize,
        /// Diagonals above the main one.
        upper: usize,
    },

    /// The start does not satisfy an inequality.
    #[error("{component} at the start is {value}, but must be {inequality}")]
    Inequality {
        /// Name of the component.
        component: String,
        /// What it must satisfy.
        inequality: Inequality,
        /// Its value.
        value: f64,
    },

    /// Inequalities are given for a field with a projection, which would move the states on.
    #[error("inequalities cannot be kept for a vector field that projects its states")]
    InequalitiesOfProjected,

    /// No output times are given.
    #[error("no output times are given")]
    NoTimes,

    /// The output times do not all go one way.
    #[error("output time {time} (number {index} from 0) does not go on from {previous}")]
    TimesNotMonotonic {
        /// Place in the list.
        index: usize,
        /// The time before it.
        previous: f64,
        /// The time that goes back or stays.
        time: f64,
    },

    /// The time to go to is where the integration stands.
    #[error("the end is the start, t = {t}")]
    EndIsStart {
        /// That time.
        t: f64,
    },

    /// A time lies against the direction of integration.
    #[error("t = {requested} lies behind t = {current}")]
    Behind {
        /// The time asked for.
        requested: f64,
        /// Where the integration stands.
        current: f64,
    },

    /// A time lies beyond the stop time.
    #[error("t = {requested} lies beyond the stop time {stop_time}")]
    BeyondStopTime {
        /// The time asked for.
        requested: f64,
        /// The stop time.
        stop_time: f64,
    },

    /// A time outside what a dense output covers.
    #[error("t = {requested} lies outside the dense output, which goes from {start} to {end}")]
    OutsideSpan {
        /// The time asked for.
        requested: f64,
        /// Where the output begins.
        start: f64,
        /// Where it ends.
        end: f64,
    },

    /// A time outside the last internal step, or beyond the event up to which that is known.
    #[error("t = {requested} lies outside the last step, which goes from t = {start} to {end}")]
    OutsideStep {
        /// The time asked for.
        requested: f64,
        /// Where the step begins.
        start: f64,
        /// Where it ends.
        end: f64,
    },

    /// A derivative beyond the degree of the polynomial of the last step.
    #[error(
        "the derivative of order {order} is asked for, but the last step has derivatives up to order {highest}"
    )]
    DerivativeOrder {
        /// The order asked for.
        order: u32,
        /// The highest there is.
        highest: u32,
    },

    /// Derivatives by parameters are asked for of a vector field that has none.
    #[error("the vector field has no derivative by its parameters")]
    NoParameterJacobian,

    /// There is no such parameter.
    #[error("the vector field has {len} parameters, but number {index} (from 0) is asked for")]
    NoParameter {
        /// The number asked for.
        index: usize,
        /// Number of parameters.
        len: usize,
    },

    /// There is no such component.
    #[error("the vector field has {dim} components, but number {index} (from 0) is asked for")]
    NoComponent {
        /// The number asked for.
        index: usize,
        /// Dimension of the vector field.
        dim: usize,
    },

    /// More Lyapunov exponents are asked for than there are, or none.
    #[error("{count} exponents are asked for, but a flow in {dim} dimensions has 1 to {dim}")]
    Exponents {
        /// The number asked for.
        count: usize,
        /// Dimension of the vector field.
        dim: usize,
    },

    /// A new start of an integration with sensitivities: the derivatives of the new state are not known.
    #[error("an integration with sensitivities cannot be started anew without those of the new state")]
    Restart,

    /// Interpolation before the first step.
    #[error("no step has been taken to interpolate in")]
    NoStep,
}

/// A failed integration, such as [`solve`](crate::solve()), with what it had reached.
#[derive(Debug)]
#[non_exhaustive]
pub struct SolveFailure<R = Trajectory> {
    /// The outputs before the failure.
    pub reached: R,
    /// What went wrong.
    pub error: SolveError,
}

impl<R> SolveFailure<R> {
    pub(crate) fn map<T>(self, part: impl FnOnce(R) -> T) -> SolveFailure<T> {
        SolveFailure { reached: part(self.reached), error: self.error }
    }
}

impl<R> fmt::Display for SolveFailure<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl<R: fmt::Debug> Error for SolveFailure<R> {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.error.source()
    }
}
