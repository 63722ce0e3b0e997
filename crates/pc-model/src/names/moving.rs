//! What is known of a body as it moves.

use pc_mech::Expr;

/// A body as it moves, in terms of coordinates, x', quasi-velocities and t; vectors are along fixed axes.
#[derive(Clone)]
pub(crate) struct Moving<'g> {
    pub(crate) name: String,
    pub(crate) mass: Expr<'g>,
    pub(crate) centre: [Expr<'g>; 3],
    /// m v
    pub(crate) momentum: [Expr<'g>; 3],
    /// I ω; none if the directions of the axes of ω are not known.
    pub(crate) spin: Option<[Expr<'g>; 3]>,
    pub(crate) kinetic: Expr<'g>,
    /// −m g·r, less the force function of the force on the body.
    pub(crate) potential: Expr<'g>,
}
