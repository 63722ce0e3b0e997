//! Numbers that are not finite.

/// A number that is not finite: the vector field wrote it without reporting a failure, or left the
/// entry unwritten.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NonFinite {
    /// A component of f(t, y).
    #[error("the rate of {component} is {value} at t = {t}")]
    Rate {
        /// The name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// Where f was evaluated.
        t: f64,
    },

    /// A Taylor coefficient of a solution.
    #[error("the Taylor coefficient of order {order} of {component} is {value} at t = {t}")]
    Coefficient {
        /// The name of the component.
        component: String,
        /// Its order.
        order: usize,
        /// NaN or an infinity.
        value: f64,
        /// Where the series was expanded.
        t: f64,
    },

    /// An entry of ∂f/∂y.
    #[error("the derivative of the rate of {row} by {column} is {value} at t = {t}")]
    Jacobian {
        /// The name of the component of f.
        row: String,
        /// The name of the component of y.
        column: String,
        /// NaN or an infinity.
        value: f64,
        /// Where the Jacobian was evaluated.
        t: f64,
    },

    /// A component of (∂f/∂y) v.
    #[error("the derivative of the rate of {component} in a direction is {value} at t = {t}")]
    Product {
        /// The name of the component of f.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// Where the product was evaluated.
        t: f64,
    },

    /// An entry of ∂f/∂p.
    #[error("the derivative of the rate of {row} by parameter {parameter} (from 0) is {value} at t = {t}")]
    ParameterJacobian {
        /// The name of the component of f.
        row: String,
        /// The number of the parameter.
        parameter: usize,
        /// NaN or an infinity.
        value: f64,
        /// Where the derivative was evaluated.
        t: f64,
    },

    /// An entry of (∂f/∂y) s.
    #[error(
        "the derivative of the rate of {component} along sensitivity number {column} (from 0) is {value} at t = {t}"
    )]
    Variation {
        /// The name of the component of f.
        component: String,
        /// The number of the column s.
        column: usize,
        /// NaN or an infinity.
        value: f64,
        /// Where the product was evaluated.
        t: f64,
    },

    /// A component written by a [preconditioner](crate::Preconditioner).
    #[error("the preconditioner sets {component} to {value} at t = {t}")]
    Preconditioned {
        /// The name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// The time of the step.
        t: f64,
    },

    /// The value of an event function.
    #[error("the function of the event {event} is {value} at t = {t}")]
    Event {
        /// The name of the event.
        event: String,
        /// NaN or an infinity.
        value: f64,
        /// Where the function was evaluated.
        t: f64,
    },

    /// A value or derivative of a [functional](crate::Functional).
    #[error("{what} is {value} at t = {t}")]
    Functional {
        /// Which value or derivative.
        what: String,
        /// NaN or an infinity.
        value: f64,
        /// Where the functional was evaluated.
        t: f64,
    },

    /// A rate of an [integral](crate::Integrals).
    #[error("the rate of integral number {index} (from 0) is {value} at t = {t}")]
    Integrand {
        /// The number of the integral.
        index: usize,
        /// NaN or an infinity.
        value: f64,
        /// Where the rate was evaluated.
        t: f64,
    },

    /// A component of a state after a reset.
    #[error("the event {event} sets {component} to {value} at t = {t}")]
    Reset {
        /// The name of the event.
        event: String,
        /// The name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// When the event occurred.
        t: f64,
    },
}
