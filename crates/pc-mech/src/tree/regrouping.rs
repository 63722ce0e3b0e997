//! Masses that can be attributed to the parent.
//!
//! A part of a body's inertia can be attributed to the parent: for a body that turns about an axis, its mass
//! at the joint, the first moment along the axis, and as much of an inertia about all perpendicular axes as
//! makes one of them vanish; for a body that turns about a point, its mass at that point; for a body that
//! slides, its inertia. Accelerations are unchanged, and zero entries cost nothing at each evaluation (*base
//! parameters*; Gautier & Khalil 1990). The result depends on parameters alone.

use pc_expr::Expr;

use crate::tree::link::Hinge;
use crate::tree::spatial::{Tensor, Vector, ZERO, add, apply, congruent, dot, tensor, vector};
use crate::tree::tree::{MassOnLink, Tree};

const NONE: Tensor<'static> = [ZERO; 3];

impl<'g> Tree<'g> {
    /// The masses on the links, each reduced as far as possible.
    pub(crate) fn regrouped(&self) -> Vec<MassOnLink<'g>> {
        let mut masses: Vec<MassOnLink<'g>> = (0..self.links.len()).map(|link| self.mass_on(link)).collect();
        for (i, link) in self.links.iter().enumerate().rev() {
            let own = &mut masses[i];
            let moved = match &link.hinge {
                Hinge::Turn { axis, pitch, .. } if pitch.is_zero() => own.take_about(*axis),
                Hinge::Ball { .. } => MassOnLink {
                    mass: std::mem::replace(&mut own.mass, Expr::ZERO),
                    moment: ZERO,
                    inertia: NONE,
                },
                Hinge::Slide { .. } => MassOnLink {
                    mass: Expr::ZERO,
                    moment: ZERO,
                    inertia: std::mem::replace(&mut own.inertia, NONE),
                },
                Hinge::Turn { .. } | Hinge::Free { .. } => continue,
            };
            // Masses moved to the world are at rest. The axes of a sliding inertia are the same at every
            // position.
            if let Some(parent) = link.parent {
                let moved = moved.seen(self, &link.place, &link.rotation);
                masses[parent].add(&moved);
            }
        }
        masses
    }
}

impl<'g> MassOnLink<'g> {
    /// Removes and returns the part that is invariant under rotation about an axis.
    fn take_about(&mut self, axis: usize) -> MassOnLink<'g> {
        let across = if axis == 2 { 1 } else { 2 };
        let transverse = self.inertia[across][across];
        let along = self.moment[axis];
        let taken = MassOnLink {
            mass: std::mem::replace(&mut self.mass, Expr::ZERO),
            moment: vector(|i| if i == axis { along } else { Expr::ZERO }),
            inertia: tensor(|i, j| if i == j && i != axis { transverse } else { Expr::ZERO }),
        };
        self.moment[axis] = Expr::ZERO;
        for i in (0..3).filter(|&i| i != axis) {
            self.inertia[i][i] -= transverse;
        }
        taken
    }

    /// The masses expressed along the axes of the parent and about its origin, for a link at this position.
    fn seen(&self, tree: &Tree<'g>, place: &Vector<'g>, rotation: &Tensor<'g>) -> MassOnLink<'g> {
        let graph = tree.graph;
        let moment = apply(graph, rotation, &self.moment);
        let inertia = congruent(graph, rotation, &self.inertia);
        let (square, mixed) = (dot(graph, place, place), dot(graph, place, &moment));
        let about_origin = |i: usize, j: usize| {
            let diagonal = if i == j { self.mass * square + 2.0 * mixed } else { Expr::ZERO };
            diagonal - self.mass * place[i] * place[j] - place[i] * moment[j] - moment[i] * place[j]
        };
        MassOnLink {
            mass: self.mass,
            moment: vector(|i| moment[i] + self.mass * place[i]),
            inertia: tensor(|i, j| inertia[i][j] + about_origin(i, j)),
        }
    }

    /// Adds masses on the same link.
    pub(crate) fn add(&mut self, other: &MassOnLink<'g>) {
        self.mass += other.mass;
        self.moment = add(&self.moment, &other.moment);
        self.inertia = tensor(|i, j| self.inertia[i][j] + other.inertia[i][j]);
    }
}
