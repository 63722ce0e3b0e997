//! The rotation of vectors and matrices from the axes of a link to those of its parent.

use pc_expr::{Expr, Graph};

use crate::tree::link::{Hinge, Link};
use crate::tree::spatial::{Tensor, Vector, apply, congruent, tensor, transpose, unit, vector};

/// A rotation composed of the rotation of the hinge and a constant rotation after it.
#[derive(Clone, Debug)]
pub(crate) struct Turning<'g> {
    hinge: HingeTurning<'g>,
    /// `None` for the unit matrix.
    constant: Option<Tensor<'g>>,
}

#[derive(Clone, Debug)]
enum HingeTurning<'g> {
    None,
    /// A rotation about a coordinate axis.
    Plane {
        axis: usize,
        cos: Expr<'g>,
        sin: Expr<'g>,
    },
    Whole(Box<Tensor<'g>>),
}

impl<'g> Turning<'g> {
    pub(crate) fn of(graph: &'g Graph, link: &Link<'g>) -> Turning<'g> {
        let hinge = match &link.hinge {
            Hinge::Turn { axis, angle, .. } => {
                HingeTurning::Plane { axis: *axis, cos: angle.cos(), sin: angle.sin() }
            }
            Hinge::Slide { .. } => HingeTurning::None,
            Hinge::Ball { .. } | Hinge::Free { .. } => HingeTurning::Whole(Box::new(
                link.hinge.turning().map(|row| row.map(|entry| graph.keep(entry))),
            )),
        };
        let constant = (link.rotation != unit()).then_some(link.rotation);
        Turning { hinge, constant }
    }

    /// Rotates a vector from the axes of the link to those of the parent.
    pub(crate) fn to_parent(&self, graph: &'g Graph, v: &Vector<'g>) -> Vector<'g> {
        let turned = match &self.hinge {
            HingeTurning::None => *v,
            HingeTurning::Plane { axis, cos, sin } => in_plane(*axis, *cos, *sin, v),
            HingeTurning::Whole(matrix) => apply(graph, matrix, v),
        };
        let turned = self.constant.map_or(turned, |constant| apply(graph, &constant, &turned));
        turned.map(|component| graph.keep(component))
    }

    /// Rotates a vector from the axes of the parent to those of the link.
    pub(crate) fn to_link(&self, graph: &'g Graph, v: &Vector<'g>) -> Vector<'g> {
        let v = self.constant.map_or(*v, |constant| apply(graph, &transpose(&constant), v));
        let turned = match &self.hinge {
            HingeTurning::None => v,
            HingeTurning::Plane { axis, cos, sin } => in_plane(*axis, *cos, -*sin, &v),
            HingeTurning::Whole(matrix) => apply(graph, &transpose(matrix), &v),
        };
        turned.map(|component| graph.keep(component))
    }

    /// The matrix R A Rᵀ, for A given along the axes of the link.
    pub(crate) fn matrix_to_parent(&self, graph: &'g Graph, a: &Tensor<'g>) -> Tensor<'g> {
        let turned = match &self.hinge {
            HingeTurning::None => *a,
            HingeTurning::Plane { axis, cos, sin } => matrix_in_plane(graph, *axis, *cos, *sin, a),
            HingeTurning::Whole(matrix) => congruent(graph, matrix, a),
        };
        let turned = self.constant.map_or(turned, |constant| congruent(graph, &constant, &turned));
        turned.map(|row| row.map(|entry| graph.keep(entry)))
    }
}

fn in_plane<'g>(axis: usize, cos: Expr<'g>, sin: Expr<'g>, v: &Vector<'g>) -> Vector<'g> {
    let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
    vector(|i| match i {
        i if i == p => cos * v[p] - sin * v[q],
        i if i == q => sin * v[p] + cos * v[q],
        i => v[i],
    })
}

/// R A Rᵀ. With D = A_pp − A_qq, Y = A_pq + A_qp and X = s D + c Y the block in the plane is
///
///   (A_pp − s X, c X − A_qp; c X − A_pq, A_qq + s X),
///
/// since s² + c² = 1: this takes less than half the operations of two products.
fn matrix_in_plane<'g>(
    graph: &'g Graph,
    axis: usize,
    cos: Expr<'g>,
    sin: Expr<'g>,
    a: &Tensor<'g>,
) -> Tensor<'g> {
    let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
    let difference = graph.keep(a[p][p] - a[q][q]);
    let across = match a[p][q] == a[q][p] {
        true => graph.keep(2.0 * cos) * a[p][q],
        false => cos * graph.keep(a[p][q] + a[q][p]),
    };
    let x = graph.keep(sin * difference + across);
    let (sx, cx) = (graph.keep(sin * x), graph.keep(cos * x));
    tensor(|i, j| match (i, j) {
        _ if i == axis && j == axis => a[axis][axis],
        _ if i == axis && j == p => cos * a[axis][p] - sin * a[axis][q],
        _ if i == axis => sin * a[axis][p] + cos * a[axis][q],
        _ if j == axis && i == p => cos * a[p][axis] - sin * a[q][axis],
        _ if j == axis => sin * a[p][axis] + cos * a[q][axis],
        _ if i == p && j == p => a[p][p] - sx,
        _ if i == q && j == q => a[q][q] + sx,
        _ if i == p => cx - a[q][p],
        _ => cx - a[p][q],
    })
}
