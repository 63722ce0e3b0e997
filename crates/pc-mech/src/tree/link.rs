//! Elementary movements.

use pc_expr::Expr;

use crate::tree::spatial::{Tensor, Vector};

/// An elementary movement of a joint, between two sets of axes. Bodies can be fixed to the second.
#[derive(Clone, Debug)]
pub(crate) struct Link<'g> {
    /// The link to which this one is attached; `None` for the world.
    pub(crate) parent: Option<usize>,
    /// The position of the link's origin when its coordinates vanish, and the matrix from the link's axes to
    /// the parent's in that position.
    pub(crate) place: Vector<'g>,
    pub(crate) rotation: Tensor<'g>,
    pub(crate) hinge: Hinge<'g>,
    /// The link whose quasi-velocity moves this one, and the ratio of the velocities, for a link that has
    /// none of its own.
    pub(crate) follows: Option<(usize, Expr<'g>)>,
    /// The inertia J of ½ J times the square of its rate, in addition to that of bodies.
    pub(crate) armature: Expr<'g>,
}

/// The movement of a link. An axis is the index of a coordinate axis; what moves it is x, then η, or multiples of
/// those of another link.
#[derive(Clone, Debug)]
pub(crate) enum Hinge<'g> {
    /// Turns about an axis, and advances along it by `pitch` times the angle.
    Turn {
        axis: usize,
        pitch: Expr<'g>,
        angle: Expr<'g>,
        rate: Expr<'g>,
    },
    Slide {
        axis: usize,
        way: Expr<'g>,
        rate: Expr<'g>,
    },
    /// Turns about a point by a unit quaternion, with ω relative to the parent.
    Ball {
        quaternion: [Expr<'g>; 4],
        omega: Vector<'g>,
    },
    /// Moves freely: `way` is the position of the origin along the axes of the joint; its velocity v relative
    /// to the parent is along the axes of the link.
    Free {
        way: Vector<'g>,
        quaternion: [Expr<'g>; 4],
        v: Vector<'g>,
        omega: Vector<'g>,
    },
}

impl<'g> Link<'g> {
    /// The link with each expression replaced.
    pub(crate) fn map<'n>(&self, put: &impl Fn(Expr<'g>) -> Expr<'n>) -> Link<'n> {
        Link {
            parent: self.parent,
            place: self.place.map(put),
            rotation: self.rotation.map(|row| row.map(put)),
            hinge: self.hinge.map(put),
            follows: self.follows.map(|(link, ratio)| (link, put(ratio))),
            armature: put(self.armature),
        }
    }

    /// Its own coordinates.
    pub(crate) fn coordinates(&self) -> Vec<Expr<'g>> {
        if self.follows.is_some() { Vec::new() } else { self.hinge.coordinates() }
    }

    /// Its own quasi-velocities.
    pub(crate) fn quasi_velocities(&self) -> Vec<Expr<'g>> {
        if self.follows.is_some() { Vec::new() } else { self.hinge.quasi_velocities() }
    }
}

impl<'g> Hinge<'g> {
    /// The coordinate of a movement that has exactly one, and its rate: x and η, or what they follow.
    pub(crate) fn single(&self) -> Option<(Expr<'g>, Expr<'g>)> {
        match self {
            Hinge::Turn { angle, rate, .. } => Some((*angle, *rate)),
            Hinge::Slide { way, rate, .. } => Some((*way, *rate)),
            Hinge::Ball { .. } | Hinge::Free { .. } => None,
        }
    }

    fn coordinates(&self) -> Vec<Expr<'g>> {
        match self {
            Hinge::Turn { angle, .. } => vec![*angle],
            Hinge::Slide { way, .. } => vec![*way],
            Hinge::Ball { quaternion, .. } => quaternion.to_vec(),
            Hinge::Free { way, quaternion, .. } => way.iter().chain(quaternion).copied().collect(),
        }
    }

    /// The hinge with each expression replaced.
    pub(crate) fn map<'n>(&self, put: &impl Fn(Expr<'g>) -> Expr<'n>) -> Hinge<'n> {
        match self {
            Hinge::Turn { axis, pitch, angle, rate } => {
                Hinge::Turn { axis: *axis, pitch: put(*pitch), angle: put(*angle), rate: put(*rate) }
            }
            Hinge::Slide { axis, way, rate } => {
                Hinge::Slide { axis: *axis, way: put(*way), rate: put(*rate) }
            }
            Hinge::Ball { quaternion, omega } => {
                Hinge::Ball { quaternion: quaternion.map(put), omega: omega.map(put) }
            }
            Hinge::Free { way, quaternion, v, omega } => Hinge::Free {
                way: way.map(put),
                quaternion: quaternion.map(put),
                v: v.map(put),
                omega: omega.map(put),
            },
        }
    }

    fn quasi_velocities(&self) -> Vec<Expr<'g>> {
        match self {
            Hinge::Turn { rate, .. } | Hinge::Slide { rate, .. } => vec![*rate],
            Hinge::Ball { omega, .. } => omega.to_vec(),
            Hinge::Free { v, omega, .. } => v.iter().chain(omega).copied().collect(),
        }
    }
}
