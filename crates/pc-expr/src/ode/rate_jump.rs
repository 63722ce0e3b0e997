//! Jumps of a vector field.

use std::fmt;

use serde::{Deserialize, Serialize};

/// A surface g(t, y, p) = 0 on which f jumps.
///
/// Where a motion passes it, derivatives of the motion with respect to p and y₀ also jump, if p and y₀ move
/// the passage:
///
///   s⁺ = s⁻ + (f⁻ − f⁺) ∂τ,   ∂τ the derivative of the time τ of the passage,
///
/// a term that is not contained in any derivative of f.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RateJump {
    /// The text of g.
    pub surface: String,
    /// The component of y whose rate jumps.
    pub component: String,
    /// Whether g depends on the state.
    pub of_state: bool,
    /// The indices and names of the parameters on which g depends.
    pub parameters: Vec<(usize, String)>,
}

impl RateJump {
    /// Whether this parameter moves the passage; if no parameter is given, whether the start state does.
    pub fn moves_with(&self, parameter: Option<usize>) -> bool {
        self.of_state || self.parameters.iter().any(|(j, _)| parameter == Some(*j))
    }
}

impl fmt::Display for RateJump {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the rate of {} jumps where {} = 0, ", self.component, self.surface)?;
        let names: Vec<String> = self.parameters.iter().map(|(_, name)| format!("`{name}`")).collect();
        match (self.of_state, names.is_empty()) {
            (true, true) => write!(f, "a surface of the state"),
            (true, false) => write!(f, "a surface of the state that {} moves", names.join(", ")),
            (false, true) => write!(f, "at a time of its own"),
            (false, false) => write!(f, "at a time that {} moves", names.join(", ")),
        }
    }
}
