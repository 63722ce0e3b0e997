//! Errors of a problem or an option.

use pc_expr::{Method, RateJump};

use crate::settings::inequality::Inequality;

/// What is wrong with a problem or an option.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// The vector field has dimension 0.
    #[error("the vector field has no components")]
    NoComponents,

    /// A list that needs one number for each component has the wrong length.
    #[error("{what}: expected one number for each component ({expected}), found {found}")]
    Length {
        /// Which list.
        what: &'static str,
        /// The dimension of the vector field.
        expected: usize,
        /// The length of the list.
        found: usize,
    },

    /// A checkpoint belongs to a motion with a different number of events.
    #[error("the checkpoint belongs to another motion: its number of events is {found}, not {expected}")]
    EventCount {
        /// The number of events of the motion.
        expected: usize,
        /// The number of events in the checkpoint.
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

    /// An option that must be positive is not positive.
    #[error("{what} is {value}, but must be positive")]
    NotPositive {
        /// Which option.
        what: String,
        /// Its value.
        value: f64,
    },

    /// The maximum order is 0 or higher than any order of the method.
    #[error("the maximum order is {found}, but {method} has orders 1 to {limit}")]
    MaxOrder {
        /// The method.
        method: Method,
        /// The highest order of the method.
        limit: u32,
        /// The order requested.
        found: u32,
    },

    /// An option that the method does not support.
    #[error("{method} does not let you choose {what}: leave the choice out")]
    Explicit {
        /// The method.
        method: Method,
        /// What was chosen.
        what: &'static str,
    },

    /// A feature that only CVODES has, such as sensitivities, is requested from another method.
    #[error(
        "sensitivities, adjoint gradients and integrals along a motion are computed by CVODES, and {method} is not one of its methods: choose Adams, BDF or auto"
    )]
    NotCvode {
        /// The method.
        method: Method,
    },

    /// A method of CVODES is chosen in a build without CVODES.
    #[error("{method} needs CVODES, which this build does not contain: choose DOP853 or Taylor")]
    NoCvode {
        /// The method.
        method: Method,
    },

    /// The minimum step is larger than the maximum step.
    #[error("the minimum step {min} is larger than the maximum step {max}")]
    StepBounds {
        /// The minimum step.
        min: f64,
        /// The maximum step.
        max: f64,
    },

    /// A checkpoint belongs to an integration with a different number of sensitivities.
    #[error(
        "the checkpoint has {found} columns of sensitivities, but {expected} are requested: resume with the sensitivities that it was written with"
    )]
    Sensitivities {
        /// The number of columns requested.
        expected: usize,
        /// The number of columns in the checkpoint.
        found: usize,
    },

    /// No functional is given to differentiate.
    #[error("no functional is given: a gradient needs at least one")]
    NoFunctional,

    /// Integrals are read from an integration that has none, or are requested of an integration
    /// that has already begun.
    #[error("integrals must be requested once, before the first step")]
    NoIntegrals,

    /// Derivatives are read from an integration that has none.
    #[error("the integration was begun without sensitivities")]
    NoSensitivities,

    /// Derivatives are requested of a motion whose rates jump where it crosses a surface, and the
    /// time of crossing depends on the variable of differentiation.
    #[error(
        "{0}: the derivatives of the motion jump with it, and would not show this. Make the jump an event that switches a \
         state, or smooth it, as tanh does"
    )]
    RateJump(RateJump),

    /// Derivatives with respect to parameters are requested for a motion with events whose
    /// derivatives with respect to the parameters are unknown.
    #[error(
        "an event resets the state, but does not say how its function and its reset depend on the parameters: sensitivities need these derivatives"
    )]
    EventParameters,

    /// The number of samples for events in a step is 0.
    #[error("the number of samples per step must be at least 1")]
    SamplesPerStep,

    /// The fraction of an interval below which events count as accumulated is out of range.
    #[error(
        "the fraction of an interval within which events accumulate is {within}, but must be at least 0 and less than 1"
    )]
    Accumulation {
        /// The fraction given.
        within: f64,
    },

    /// The maximum number of steps is 0.
    #[error("the maximum number of steps must be at least 1")]
    MaxSteps,

    /// A linear solver is chosen together with the fixed-point iteration, which does not use one.
    #[error(
        "a linear solver is chosen, but the fixed-point iteration solves no linear systems: choose Newton's iteration, or no linear solver"
    )]
    LinearSolverUnused,

    /// The sparse linear solver is chosen for a field without a zero pattern of ∂f/∂y.
    #[error(
        "the sparse linear solver needs the zero pattern of the Jacobian, which the vector field does not provide"
    )]
    NoPattern,

    /// The zero pattern of ∂f/∂y is not that of a square matrix of the field's dimension.
    #[error("the zero pattern of the Jacobian is {rows} × {columns}, but must be {expected} × {expected}")]
    PatternSize {
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
        /// The dimension of the vector field.
        expected: usize,
    },

    /// A band matrix is given more diagonals than fit into its corners.
    #[error(
        "a band of {lower} diagonals below the main one and {upper} above is too wide for a Jacobian of {components} × {components}"
    )]
    BandTooWide {
        /// The number of diagonals below the main one.
        lower: usize,
        /// The number of diagonals above the main one.
        upper: usize,
        /// The dimension of the vector field.
        components: usize,
    },

    /// An entry of ∂f/∂y that may be nonzero lies outside the band chosen.
    #[error(
        "the rate of {row} depends on {column}, which lies outside the band of {lower} diagonals below the main one \
         and {upper} above: widen the band"
    )]
    OutsideBand {
        /// The name of the component of f.
        row: String,
        /// The name of the component of y.
        column: String,
        /// The number of diagonals below the main one.
        lower: usize,
        /// The number of diagonals above the main one.
        upper: usize,
    },

    /// The start does not satisfy an inequality.
    #[error("{component} at the start is {value}, but must be {inequality}")]
    Inequality {
        /// The name of the component.
        component: String,
        /// The inequality that the component must satisfy.
        inequality: Inequality,
        /// The value of the component.
        value: f64,
    },

    /// Inequalities are given for a field with a projection, which could move states so that they
    /// violate the inequalities again.
    #[error(
        "inequalities cannot be imposed on a vector field that projects its states: the projection could violate them"
    )]
    InequalitiesOfProjected,

    /// No output times are given.
    #[error("no output times are given")]
    NoTimes,

    /// The output times neither increase nor decrease throughout.
    #[error(
        "output times must increase throughout or decrease throughout: {time} (number {index} from 0) follows {previous}"
    )]
    TimesNotMonotonic {
        /// The position of the time in the list.
        index: usize,
        /// The time that precedes the offending one.
        previous: f64,
        /// The time that repeats the previous time or reverses the direction.
        time: f64,
    },

    /// The target time is the current time.
    #[error("the end time equals the start time, t = {t}")]
    EndIsStart {
        /// The start and end time.
        t: f64,
    },

    /// A time lies in the direction opposite to that of the integration.
    #[error("t = {requested} has already been passed: the integration has reached t = {current}")]
    Behind {
        /// The time requested.
        requested: f64,
        /// The current time of the integration.
        current: f64,
    },

    /// A time lies beyond the stop time.
    #[error("t = {requested} lies beyond the stop time {stop_time}")]
    BeyondStopTime {
        /// The time requested.
        requested: f64,
        /// The stop time.
        stop_time: f64,
    },

    /// A time lies outside the span of a dense output.
    #[error("t = {requested} lies outside the dense output, which covers t = {start} to {end}")]
    OutsideSpan {
        /// The time requested.
        requested: f64,
        /// Where the output begins.
        start: f64,
        /// Where the output ends.
        end: f64,
    },

    /// A time lies outside the last internal step, or beyond the next event in that step.
    #[error("t = {requested} lies outside the last step, which covers t = {start} to {end}")]
    OutsideStep {
        /// The time requested.
        requested: f64,
        /// Where the step begins.
        start: f64,
        /// Where the step ends.
        end: f64,
    },

    /// A derivative is requested whose order exceeds the degree of the polynomial of the last step.
    #[error(
        "the derivative of order {order} is requested, but within the last step derivatives are known up to order {highest}"
    )]
    DerivativeOrder {
        /// The order requested.
        order: u32,
        /// The highest order available.
        highest: u32,
    },

    /// Derivatives with respect to parameters are requested from a vector field that does not
    /// provide them.
    #[error("the vector field does not provide its derivatives by the parameters")]
    NoParameterJacobian,

    /// There is no parameter with the number requested.
    #[error("there is no parameter number {index} (from 0): the number of parameters is {len}")]
    NoParameter {
        /// The number requested.
        index: usize,
        /// The number of parameters.
        len: usize,
    },

    /// There is no component with the number requested.
    #[error("there is no component number {index} (from 0): the number of components is {dim}")]
    NoComponent {
        /// The number requested.
        index: usize,
        /// The dimension of the vector field.
        dim: usize,
    },

    /// The number of Lyapunov exponents is out of range.
    #[error(
        "the number of Lyapunov exponents is {count}, but must be from 1 to {dim}, the number of components"
    )]
    Exponents {
        /// The number requested.
        count: usize,
        /// The dimension of the vector field.
        dim: usize,
    },

    /// An integration with sensitivities is restarted without the derivatives of the new state.
    #[error(
        "an integration with sensitivities can be restarted only with the sensitivities of the new state"
    )]
    Restart,

    /// Interpolation is requested before the first step.
    #[error("there is nothing to interpolate: no step has been made")]
    NoStep,
}
