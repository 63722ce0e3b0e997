//! Events where an expression passes through zero.

use pc_expr::{Direction, Expr};

/// An event of a model, in terms of time, coordinates, all quasi-velocities of the system and parameters.
#[derive(Clone, Debug)]
pub struct Event<'g> {
    /// Its name.
    pub name: String,
    /// The expression that passes through zero.
    pub when: Expr<'g>,
    /// The direction in which the expression passes through zero.
    pub direction: Direction,
    /// Whether the motion ends there.
    pub terminal: bool,
    /// The components of (x, η, z) that are reset, with their new values as functions of the state before the event.
    pub resets: Vec<(usize, Expr<'g>)>,
    /// The impact that it is, if it changes the velocities by an impulse.
    pub impact: Option<Impact<'g>>,
}

/// An impact on a stop: the rate v of the gap before it becomes −e v, and all velocities change by the impulse along it.
#[derive(Clone, Debug)]
pub struct Impact<'g> {
    /// The rate v of the gap, negative before the impact.
    pub rate: Expr<'g>,
    /// e
    pub restitution: Expr<'g>,
    /// The distance between the two ends of the way, the size of gaps.
    pub way: Expr<'g>,
}

impl Event<'_> {
    /// Whether the state is another one after it.
    pub fn changes_state(&self) -> bool {
        !self.resets.is_empty() || self.impact.is_some()
    }
}
