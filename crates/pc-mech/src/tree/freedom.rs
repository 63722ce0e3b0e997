//! Free components of joints, and how they are eliminated.

use pc_expr::{Expr, Graph, Number};

use crate::tree::inertia6::{Inertia6, Spatial};
use crate::tree::link::{Hinge, Link};

/// The direction s, one of the six components; for a screw, one of the first three plus a multiple of the
/// displacement along the same axis. The armature J resists it in addition to Φ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Direction<'g> {
    pub(crate) component: usize,
    pub(crate) pitch: Expr<'g>,
    pub(crate) armature: Expr<'g>,
}

/// A remainder this small relative to its terms may be a rounding error.
const ROUNDING: f64 = 1e-12;

impl<'g> Direction<'g> {
    /// Whether eliminating the direction eliminates one of the six components: nothing resists it afterwards.
    pub(crate) fn is_pure(&self) -> bool {
        self.pitch.is_zero() && self.armature.is_zero()
    }

    /// Whether eliminating the direction eliminates component `r` of the six.
    pub(crate) fn is_component(&self, r: usize) -> bool {
        self.is_pure() && r == self.component
    }

    /// Φ s
    pub(crate) fn column(&self, graph: &'g Graph, phi: &Inertia6<'g>) -> Spatial<'g> {
        std::array::from_fn(|r| match self.pitch.is_zero() {
            true => phi.0[r][self.component],
            false => graph.keep(phi.0[r][self.component] + self.pitch * phi.0[r][self.component + 3]),
        })
    }

    /// An upper bound on s·Φ s + J: the trace of the block of Φ, in the units of the direction, and the armature.
    pub(crate) fn size(&self, graph: &'g Graph, phi: &Inertia6<'g>) -> Expr<'g> {
        let trace = |first: usize| graph.sum((first..first + 3).map(|r| phi.0[r][r]));
        let size = match self.component < 3 {
            true if self.pitch.is_zero() => trace(0),
            true => trace(0) + self.pitch.square() * trace(3),
            false => trace(3),
        };
        size + self.armature
    }

    /// Adds s w to an acceleration.
    pub(crate) fn accelerate(&self, graph: &'g Graph, a: &mut Spatial<'g>, w: Expr<'g>) {
        let Direction { component, pitch, .. } = *self;
        a[component] = graph.keep(a[component] + w);
        if !pitch.is_zero() {
            a[component + 3] = graph.keep(a[component + 3] + pitch * w);
        }
    }

    /// s · p
    pub(crate) fn along(&self, p: &Spatial<'g>) -> Expr<'g> {
        match self.pitch.is_zero() {
            true => p[self.component],
            false => p[self.component] + self.pitch * p[self.component + 3],
        }
    }
}

impl<'g> Link<'g> {
    /// The directions of the free components, in the order of the quasi-velocities of the hinge.
    pub(crate) fn directions(&self) -> Vec<Direction<'g>> {
        let of = |component: usize| Direction { component, pitch: Expr::ZERO, armature: self.armature };
        match &self.hinge {
            Hinge::Turn { axis, pitch, .. } => vec![Direction { pitch: *pitch, ..of(*axis) }],
            Hinge::Slide { axis, .. } => vec![of(3 + axis)],
            Hinge::Ball { .. } => (0..3).map(of).collect(),
            Hinge::Free { .. } => (3..6).chain(0..3).map(of).collect(),
        }
    }
}

impl<'g> Inertia6<'g> {
    /// The inertia of a single body that remains after elimination, if its resistance to the direction is a
    /// number that is not a rounding error of `size`. The pivot of the joint is then at least as large: the
    /// inertia of the bodies beyond it is nonnegative, and the remainder of a sum is at least the sum of the
    /// remainders.
    pub(crate) fn resisting(
        &self,
        graph: &'g Graph,
        direction: Direction<'g>,
        size: Expr<'g>,
    ) -> Option<Inertia6<'g>> {
        let column = direction.column(graph, self);
        let number = |x: Expr<'g>| x.constant().map(Number::to_f64);
        let (pivot, size) = (number(direction.along(&column) + direction.armature)?, number(size)?);
        (pivot > ROUNDING * size).then(|| self.map(|r, c, entry| entry - column[r] * column[c] / pivot))
    }
}

/// A free component of a joint that has been eliminated.
#[derive(Clone, Debug)]
pub(crate) struct Freedom<'g> {
    /// The direction in which the component moves, along the axes of its link.
    pub(crate) direction: Direction<'g>,
    /// Φ s
    pub(crate) column: Spatial<'g>,
    pub(crate) inverse: Expr<'g>,
    /// The vector Φ s/(s·Φ s), with zero at its own component.
    pub(crate) factors: Spatial<'g>,
    /// The pivot s·Φ s with the size of its terms before elimination, if it may vanish.
    pub(crate) watched: Option<(Expr<'g>, Expr<'g>)>,
    /// Whether s·Φ s is identically zero: no inertia resists the direction.
    pub(crate) is_massless: bool,
    /// Each open coupling, with s·C_d and s·C_d/(s·Φ s).
    pub(crate) coupled: Vec<(usize, Expr<'g>, Expr<'g>)>,
}

impl<'g> Freedom<'g> {
    /// s · p
    pub(crate) fn along(&self, p: &Spatial<'g>) -> Expr<'g> {
        self.direction.along(p)
    }

    /// Adds s w to an acceleration.
    pub(crate) fn accelerate(&self, graph: &'g Graph, a: &mut Spatial<'g>, w: Expr<'g>) {
        self.direction.accelerate(graph, a, w);
    }

    /// Removes the free component from an acceleration and returns it, if it is one of the six components and
    /// has no inertia of its own.
    pub(crate) fn leave_out(&self, a: &mut Spatial<'g>) -> Expr<'g> {
        match self.direction.is_pure() {
            true => std::mem::replace(&mut a[self.direction.component], Expr::ZERO),
            false => Expr::ZERO,
        }
    }
}

/// Eliminates a component, so that the remaining `inertia` does not resist it. The pivot of the component is
/// watched if the `size` of its terms is given.
pub(crate) fn eliminate<'g>(
    graph: &'g Graph,
    inertia: &mut Inertia6<'g>,
    direction: Direction<'g>,
    size: Option<Expr<'g>>,
) -> Freedom<'g> {
    let column = direction.column(graph, inertia);
    let pivot = direction.along(&column) + direction.armature;
    let inverse = graph.keep(pivot.powi(-1));
    let factors: Spatial<'g> = std::array::from_fn(|r| match direction.is_component(r) {
        true => Expr::ZERO,
        false => graph.keep(column[r] * inverse),
    });
    *inertia = inertia.map(|r, c, entry| match direction.is_component(r) || direction.is_component(c) {
        true => Expr::ZERO,
        false => graph.keep(entry - column[r] * factors[c]),
    });
    let watched = size.map(|size| (pivot, size));
    let is_massless = pivot.is_zero();
    Freedom { direction, column, inverse, factors, watched, is_massless, coupled: Vec::new() }
}
