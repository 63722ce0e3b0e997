//! Errors of expressions.

use crate::graph::limits::Spent;

/// An error of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExprError {
    /// A quotient whose divisor is identically zero.
    #[error("division by zero: `{dividend}` is divided by an expression that is identically zero")]
    DivisionByZero {
        /// Text of the dividend.
        dividend: String,
    },
    /// An expression that has no value whatever the values of the symbols, such as log(−1).
    #[error("an expression is undefined: a constant in it has no finite value")]
    Undefined,
    /// A symbol that is neither an input of the program nor given a value.
    #[error("the symbol `{symbol}` has no value")]
    UnboundSymbol {
        /// Its name.
        symbol: String,
    },
    /// The [budget](crate::Budget) of the expressions is spent.
    #[error("{stage}: {what} ({nodes} expressions were made)")]
    Spent {
        /// The limit that is reached.
        what: Spent,
        /// The stage of the work.
        stage: &'static str,
        /// The number of expressions at that point.
        nodes: usize,
    },
    /// Input values that are not finite: no expression is at fault.
    #[error("the values given are not finite: {}", listed(given))]
    GivenNotFinite {
        /// Names and values of the inputs (time, state and parameters) that are not finite.
        given: Vec<(String, f64)>,
    },
    /// An expression whose value is not a finite number.
    #[error("`{expression}` is {value}{}", at(*t, state))]
    NotFinite {
        /// Text of the innermost expression that is not finite.
        expression: String,
        /// NaN or an infinity.
        value: f64,
        /// Time of the evaluation.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
}

fn at(t: f64, state: &[(String, f64)]) -> String {
    let separator = if state.is_empty() { "" } else { ", " };
    format!(" at t = {}{separator}{}", readable(t), listed(state))
}

fn listed(values: &[(String, f64)]) -> String {
    let values: Vec<String> =
        values.iter().map(|(name, value)| format!("{name} = {}", readable(*value))).collect();
    values.join(", ")
}

/// A number in a message, with an exponent if it would be long without one.
pub fn readable(value: f64) -> String {
    let usual = value == 0.0 || (1e-4..1e15).contains(&value.abs()) || !value.is_finite();
    if usual { value.to_string() } else { format!("{value:e}") }
}
