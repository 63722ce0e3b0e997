//! What happens to a motion where an expression passes through zero.

use pc_expr::{Direction, Expr};

/// An event of a model, in expressions of time, coordinates, all quasi-velocities of the system and parameters.
#[derive(Clone, Debug)]
pub struct Event<'g> {
    /// Its name.
    pub name: String,
    /// What passes through zero.
    pub when: Expr<'g>,
    /// In which direction.
    pub direction: Direction,
    /// Whether the motion ends there.
    pub terminal: bool,
    /// The components of (x, η, z) that are given new values, and these: all of the state before the event.
    pub resets: Vec<(usize, Expr<'g>)>,
}
