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
}
