//! Drawings of a model: its bodies, joints and points, and the shapes given in its text.

use pc_mech::{Expr, Graph, Matrix};

use crate::assembly::assembly::Assembly;
use crate::assembly::block::Block;
use crate::diagnostics::error::ModelError;
use crate::document::{Body, Draw, DrawnShape, Expression, Inertia, Orientation};
use crate::model::model::Model;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

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

impl Model {
    /// The drawing of the model: bodies on joints, with rods from joint to joint and to points, other bodies, points, then the
    /// shapes of `[[draw]]`. Bodies that turn, and to which no rod leads the eye, are boxes of their inertia, unless the text draws
    /// them.
    ///
    /// # Errors
    /// [`ModelError`] at the expression that cannot be resolved.
    pub fn drawing<'g>(&self, assembly: &Assembly<'g>) -> Result<Vec<Shape<'g>>, ModelError> {
        let document = self.document();
        let mut scope = Scope::new(assembly.system.graph(), document);
        let mut points: Vec<(&str, Spot<'g>)> = Vec::new();
        for point in &document.points {
            let mut at = [Expr::ZERO; 3];
            for (value, name) in at.iter_mut().zip(&point.components) {
                *value = scope.point(&name.text)?;
            }
            points.push((&point.body.value, at));
        }
        let mut shapes = on_joints(assembly, &points, document.draw.is_empty());
        for body in &document.bodies {
            let label = Some(body.name.text.clone());
            let at = spot(&mut scope, &body.position, Stage::Position)?;
            shapes.push(Shape::Point { at, label });
            if let Some(Orientation::Rotation(entries)) = &body.orientation {
                let rotation = rotation(&mut scope, entries, Stage::Position)?;
                let block = match document.draw.is_empty() {
                    true => own_block(assembly, &mut scope, body, at, &rotation)?,
                    false => None,
                };
                shapes.push(block.unwrap_or(Shape::Axes { at, rotation }));
            }
        }
        shapes.extend(points.into_iter().map(|(_, at)| Shape::Point { at, label: None }));
        shapes.extend(self.drawn(assembly)?);
        Ok(shapes)
    }

    /// The shapes of `[[draw]]`.
    ///
    /// # Errors
    /// As for [`drawing`](Model::drawing).
    pub(crate) fn drawn<'g>(&self, assembly: &Assembly<'g>) -> Result<Vec<Shape<'g>>, ModelError> {
        let system = &assembly.system;
        let mut scope = Scope::new(system.graph(), self.document());
        let velocities = system.frame().velocities(system.quasi_velocities());
        let velocities: Vec<_> = scope.velocities().into_iter().zip(velocities).collect();
        let of_state = |shape: Shape<'g>| shape.substituted(system.graph(), &velocities);
        self.document().draw.iter().map(|draw| Ok(of_state(resolved(&mut scope, draw)?))).collect()
    }
}

fn resolved<'g>(scope: &mut Scope<'g, '_>, draw: &Draw) -> Result<Shape<'g>, ModelError> {
    let mut at = |place: &[Expression]| spot(scope, place, Stage::Drawing);
    Ok(match &draw.shape {
        DrawnShape::Point { at: place } => Shape::Point { at: at(place)?, label: None },
        DrawnShape::Line { through } => {
            Shape::Line { through: through.iter().map(|place| at(place)).collect::<Result<_, _>>()? }
        }
        DrawnShape::Disc { at: place, normal, radius } => {
            let normal = match normal {
                Some(normal) => at(normal)?,
                None => [Expr::ZERO, Expr::ZERO, Expr::ONE],
            };
            Shape::Disc { at: at(place)?, normal, radius: scope.resolve(radius, Stage::Drawing)? }
        }
        DrawnShape::Sphere { at: place, radius } => {
            Shape::Sphere { at: at(place)?, radius: scope.resolve(radius, Stage::Drawing)? }
        }
        DrawnShape::Box { at: place, size, rotation: turned } => {
            let (at, size) = (at(place)?, at(size)?);
            let rotation = match turned {
                Some(entries) => rotation(scope, entries, Stage::Drawing)?,
                None => Matrix::from_fn(3, 3, |i, j| if i == j { Expr::ONE } else { Expr::ZERO }),
            };
            Shape::Box { at, size, rotation }
        }
        DrawnShape::Spring { from, to } => Shape::Spring { from: at(from)?, to: at(to)? },
        DrawnShape::Trace { at: place } => Shape::Trace { at: at(place)? },
        DrawnShape::Text { at: place, text } => Shape::Text { at: at(place)?, text: text.value.clone() },
    })
}

/// A position in space; two expressions give a position in the plane.
fn spot<'g>(scope: &mut Scope<'g, '_>, place: &[Expression], stage: Stage) -> Result<Spot<'g>, ModelError> {
    let mut at = [Expr::ZERO; 3];
    for (value, expression) in at.iter_mut().zip(place) {
        *value = scope.resolve(expression, stage)?;
    }
    Ok(at)
}

fn rotation<'g>(
    scope: &mut Scope<'g, '_>,
    entries: &[Expression; 9],
    stage: Stage,
) -> Result<Matrix<Expr<'g>>, ModelError> {
    let mut values = [Expr::ZERO; 9];
    for (value, expression) in values.iter_mut().zip(entries) {
        *value = scope.resolve(expression, stage)?;
    }
    Ok(Matrix::from_fn(3, 3, |i, j| values[3 * i + j]))
}

/// The box of a body, with its values at the start.
fn block<'g>(
    assembly: &Assembly<'g>,
    (mass, inertia): (Expr<'g>, &Matrix<Expr<'g>>),
    at: Spot<'g>,
    rotation: &Matrix<Expr<'g>>,
) -> Option<Shape<'g>> {
    let graph = assembly.system.graph();
    let mut start = assembly.at_start();
    start.extend(assembly.system.parameters());
    let entries = (0..9).map(|ij| inertia[(ij / 3, ij % 3)]);
    let values = graph.evaluate(&entries.chain([mass]).collect::<Vec<_>>(), &start).ok()?;
    let block = Block::of(values[9], &Matrix::from_fn(3, 3, |i, j| values[3 * i + j]))?;
    let turned = |i: usize, j: usize| {
        graph.dot((0..3).map(|k| rotation[(i, k)]), (0..3).map(|k| Expr::from(block.axes[(k, j)])))
    };
    Some(Shape::Box { at, size: block.edges.map(Expr::from), rotation: Matrix::from_fn(3, 3, turned) })
}

/// The box of a body that is not on a joint.
fn own_block<'g>(
    assembly: &Assembly<'g>,
    scope: &mut Scope<'g, '_>,
    body: &Body,
    at: Spot<'g>,
    rotation: &Matrix<Expr<'g>>,
) -> Result<Option<Shape<'g>>, ModelError> {
    let mass = scope.resolve(&body.mass, Stage::Inertia)?;
    let entries: &[Expression] = match &body.inertia {
        None => return Ok(None),
        Some(Inertia::Principal(moments)) => &moments[..],
        Some(Inertia::Full(entries)) => &entries[..],
    };
    let entries: Vec<Expr<'g>> =
        entries.iter().map(|entry| scope.resolve(entry, Stage::Inertia)).collect::<Result<_, _>>()?;
    // Ixx, Iyy, Izz, Ixy, Iyz, Ixz
    let inertia = Matrix::from_fn(3, 3, |i, j| match i + j {
        _ if i == j => entries[i],
        1 => entries.get(3).copied().unwrap_or(Expr::ZERO),
        3 => entries.get(4).copied().unwrap_or(Expr::ZERO),
        _ => entries.get(5).copied().unwrap_or(Expr::ZERO),
    });
    Ok(block(assembly, (mass, &inertia), at, rotation))
}

/// For each body, its mass centre and a rod from its joint to each joint and point that it carries, or to the mass centre if it
/// carries none; where the mass centre is at the joint, a box if `boxes`.
fn on_joints<'g>(assembly: &Assembly<'g>, points: &[(&str, Spot<'g>)], boxes: bool) -> Vec<Shape<'g>> {
    let Some(tree) = assembly.system.tree() else { return Vec::new() };
    let (motions, graph) = (tree.motions(), assembly.system.graph());
    let mut shapes = Vec::new();
    for body in tree.bodies() {
        let (Some(place), Some(rotation)) = (motions.place(body.name()), motions.rotation(body.name()))
        else {
            continue; // bodies of a tree have places
        };
        let (mass, centre, inertia) = body.mass_properties();
        let centre: Spot<'g> =
            [0, 1, 2].map(|i| place[i] + graph.dot((0..3).map(|j| rotation[(i, j)]), centre));
        let children = tree.bodies().iter().filter(|child| child.parent() == Some(body.name()));
        let carried = points.iter().filter(|(of, _)| *of == body.name()).map(|&(_, at)| at);
        let mut ends: Vec<Spot<'g>> = Vec::new();
        for end in children.filter_map(|child| motions.place(child.name())).chain(carried) {
            if !ends.contains(&end) {
                ends.push(end);
            }
        }
        let ends = if ends.is_empty() { vec![centre] } else { ends };
        let rods: Vec<Spot<'g>> = ends.into_iter().filter(|end| *end != place).collect();
        if rods.is_empty() && boxes {
            shapes.extend(block(assembly, (mass, &inertia), centre, &rotation));
        }
        shapes.extend(rods.into_iter().map(|end| Shape::Line { through: vec![place, end] }));
        shapes.push(Shape::Point { at: centre, label: Some(body.name().to_owned()) });
    }
    shapes
}

impl<'g> Shape<'g> {
    /// The functions that describe the shape, in an order that depends only on the kind of shape.
    pub fn functions(&self) -> Vec<Expr<'g>> {
        match self {
            Shape::Point { at, .. } | Shape::Trace { at } | Shape::Text { at, .. } => at.to_vec(),
            Shape::Line { through } => through.concat(),
            Shape::Disc { at, normal, radius } => [at.as_slice(), normal, &[*radius]].concat(),
            Shape::Sphere { at, radius } => [at.as_slice(), &[*radius]].concat(),
            Shape::Box { at, size, rotation } => [at.as_slice(), size, &entries(rotation)].concat(),
            Shape::Axes { at, rotation } => [at.as_slice(), &entries(rotation)].concat(),
            Shape::Spring { from, to } => [*from, *to].concat(),
        }
    }

    /// The shape with the velocities substituted.
    fn substituted(self, graph: &'g Graph, known: &[(Expr<'g>, Expr<'g>)]) -> Shape<'g> {
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
            Shape::Sphere { .. } => Shape::Sphere { at: at(0), radius: values[3] },
            Shape::Box { .. } => Shape::Box { at: at(0), size: at(3), rotation: turned(6) },
            Shape::Axes { .. } => Shape::Axes { at: at(0), rotation: turned(3) },
            Shape::Spring { .. } => Shape::Spring { from: at(0), to: at(3) },
        }
    }
}

/// The entries of a rotation matrix, row by row.
fn entries<'g>(rotation: &Matrix<Expr<'g>>) -> Vec<Expr<'g>> {
    (0..9).map(|ij| rotation[(ij / 3, ij % 3)]).collect()
}
