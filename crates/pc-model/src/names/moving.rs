//! What is known of a body as it moves.

use pc_mech::Expr;

/// A body as it moves, in terms of coordinates, x', quasi-velocities and t; vectors are along fixed axes.
#[derive(Clone)]
pub(crate) struct Moving<'g> {
    pub(super) name: String,
    pub(super) mass: Expr<'g>,
    pub(super) centre: [Expr<'g>; 3],
    /// m v
    pub(super) momentum: [Expr<'g>; 3],
    /// I ω; none if the directions of the axes of ω are not known.
    pub(super) spin: Option<[Expr<'g>; 3]>,
    pub(super) kinetic: Expr<'g>,
    /// −m g·r, less the force function of the force on the body.
    pub(super) potential: Expr<'g>,
}
