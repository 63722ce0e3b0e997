//! The shapes of a drawing.

use std::path::PathBuf;

use pc_mech::{Expr, Graph, Matrix};

/// The coordinates of a point in space, as functions of (t, x, η).
pub type Spot<'g> = [Expr<'g>; 3];

/// A shape that follows the motion, described by functions of (t, x, η).
#[derive(Clone, Debug, PartialEq)]
pub enum Shape<'g> {
    /// A dot, with its own label.
    Point {
        /// Its position.
        at: Spot<'g>,
        /// Its name.
        label: Option<String>,
    },
    /// A polyline.
    Line {
        /// Its corners.
        through: Vec<Spot<'g>>,
    },
    /// A disc.
    Disc {
        /// Its centre.
        at: Spot<'g>,
        /// A vector perpendicular to the disc.
        normal: Spot<'g>,
        /// Its radius.
        radius: Expr<'g>,
    },
    /// A ring: the edge of a disc.
    Ring {
        /// Its centre.
        at: Spot<'g>,
        /// A vector perpendicular to the ring.
        normal: Spot<'g>,
        /// Its radius.
        radius: Expr<'g>,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        at: Spot<'g>,
        /// Its radius.
        radius: Expr<'g>,
    },
    /// A box.
    Box {
        /// Its centre.
        at: Spot<'g>,
        /// The lengths of the box's edges.
        size: Spot<'g>,
        /// The rotation matrix from its axes to the fixed axes.
        rotation: Matrix<Expr<'g>>,
    },
    /// The axes of a body with an orientation.
    Axes {
        /// The common point of the axes.
        at: Spot<'g>,
        /// The rotation matrix from its axes to the fixed axes.
        rotation: Matrix<Expr<'g>>,
    },
    /// A surface of triangles, from a file.
    Mesh {
        /// The path of the file.
        file: PathBuf,
        /// The factors of the lengths along the file's axes.
        scale: [f64; 3],
        /// The place of the origin of the file's axes.
        at: Spot<'g>,
        /// The rotation matrix from the file's axes to the fixed axes.
        rotation: Matrix<Expr<'g>>,
    },
    /// A spring.
    Spring {
        /// One end.
        from: Spot<'g>,
        /// The other.
        to: Spot<'g>,
    },
    /// The path that a point has traced so far.
    Trace {
        /// The point.
        at: Spot<'g>,
    },
    /// Words.
    Text {
        /// The position where the words begin.
        at: Spot<'g>,
        /// The words.
        text: String,
    },
}

impl<'g> Shape<'g> {
    /// The functions that describe the shape, in an order that depends only on the kind of shape.
    pub fn functions(&self) -> Vec<Expr<'g>> {
        match self {
            Shape::Point { at, .. } | Shape::Trace { at } | Shape::Text { at, .. } => at.to_vec(),
            Shape::Line { through } => through.concat(),
            Shape::Disc { at, normal, radius } | Shape::Ring { at, normal, radius } => {
                [at.as_slice(), normal, &[*radius]].concat()
            }
            Shape::Sphere { at, radius } => [at.as_slice(), &[*radius]].concat(),
            Shape::Box { at, size, rotation } => [at.as_slice(), size, &entries(rotation)].concat(),
            Shape::Axes { at, rotation } | Shape::Mesh { at, rotation, .. } => {
                [at.as_slice(), &entries(rotation)].concat()
            }
            Shape::Spring { from, to } => [*from, *to].concat(),
        }
    }

    /// The shape with the velocities substituted.
    pub(super) fn substituted(self, graph: &'g Graph, known: &[(Expr<'g>, Expr<'g>)]) -> Shape<'g> {
        let values = graph.substitute(&self.functions(), known);
        let at = |n: usize| [values[n], values[n + 1], values[n + 2]];
        let turned = |n: usize| Matrix::from_fn(3, 3, |i, j| values[n + 3 * i + j]);
        match self {
            Shape::Point { label, .. } => Shape::Point { at: at(0), label },
            Shape::Trace { .. } => Shape::Trace { at: at(0) },
            Shape::Text { text, .. } => Shape::Text { at: at(0), text },
            Shape::Line { through } => {
                Shape::Line { through: (0..through.len()).map(|corner| at(3 * corner)).collect() }
            }
            Shape::Disc { .. } => Shape::Disc { at: at(0), normal: at(3), radius: values[6] },
            Shape::Ring { .. } => Shape::Ring { at: at(0), normal: at(3), radius: values[6] },
            Shape::Sphere { .. } => Shape::Sphere { at: at(0), radius: values[3] },
            Shape::Box { .. } => Shape::Box { at: at(0), size: at(3), rotation: turned(6) },
            Shape::Axes { .. } => Shape::Axes { at: at(0), rotation: turned(3) },
            Shape::Mesh { file, scale, .. } => Shape::Mesh { file, scale, at: at(0), rotation: turned(3) },
            Shape::Spring { .. } => Shape::Spring { from: at(0), to: at(3) },
        }
    }
}

/// The entries of a rotation matrix, row by row.
fn entries<'g>(rotation: &Matrix<Expr<'g>>) -> Vec<Expr<'g>> {
    (0..9).map(|ij| rotation[(ij / 3, ij % 3)]).collect()
}
