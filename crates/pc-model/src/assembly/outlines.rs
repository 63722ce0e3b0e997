//! What is drawn of bodies and points that the text does not draw: dots, rods, axes, and boxes of inertia.

use pc_mech::{Expr, Matrix, Tree, TreeBody};

use crate::assembly::assembly::Assembly;
use crate::assembly::block::Block;
use crate::assembly::placed::{rotation, spot};
use crate::assembly::shape::{Shape, Spot};
use crate::diagnostics::error::ModelError;
use crate::document::{Body, Document, DrawnShape, Expression, Inertia, JointKind, Located, Orientation};
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// A point of the text.
struct Dot<'d, 'g> {
    body: &'d str,
    at: Spot<'g>,
}

/// The outlines of what is not hidden.
pub(super) struct Outlines<'a, 'd, 'g> {
    document: &'d Document,
    assembly: &'a Assembly<'g>,
    scope: Scope<'g, 'd>,
    points: Vec<Dot<'d, 'g>>,
}

impl<'a, 'd, 'g> Outlines<'a, 'd, 'g> {
    pub(super) fn new(document: &'d Document, assembly: &'a Assembly<'g>) -> Result<Self, ModelError> {
        let mut scope = Scope::new(assembly.system.graph(), document);
        let mut points = Vec::new();
        for point in document.points.iter().filter(|point| !document.drawing.hides(&point.name.text)) {
            let mut at = [Expr::ZERO; 3];
            for (value, name) in at.iter_mut().zip(&point.components) {
                *value = scope.point(&name.text)?;
            }
            points.push(Dot { body: &point.body.value, at });
        }
        Ok(Outlines { document, assembly, scope, points })
    }

    /// Whether a body may be a box: where the text draws nothing of it, and nothing along the fixed axes, which may be of any body.
    fn has_box(&self, name: &str) -> bool {
        self.document.draw.iter().all(|draw| draw.body.as_ref().is_some_and(|body| body.value != name))
    }

    /// Bodies on joints, other bodies, and points.
    pub(super) fn shapes(mut self) -> Result<Vec<Shape<'g>>, ModelError> {
        let mut shapes = self.on_joints()?;
        let document = self.document;
        for body in document.bodies.iter().filter(|body| !document.drawing.hides(&body.name.text)) {
            shapes.extend(self.placed(body)?);
        }
        shapes.extend(self.points.into_iter().map(|point| Shape::Point { at: point.at, label: None }));
        Ok(shapes)
    }

    /// A body with a position.
    fn placed(&mut self, body: &Body) -> Result<Vec<Shape<'g>>, ModelError> {
        let at = spot(&mut self.scope, &body.position, Stage::Position)?;
        let mut shapes = vec![Shape::Point { at, label: Some(body.name.text.clone()) }];
        if let Some(Orientation::Rotation(entries)) = &body.orientation {
            let rotation = rotation(&mut self.scope, entries, Stage::Position)?;
            let block =
                if self.has_box(&body.name.text) { self.own_block(body, at, &rotation)? } else { None };
            shapes.push(block.unwrap_or(Shape::Axes { at, rotation }));
        }
        Ok(shapes)
    }

    fn on_joints(&mut self) -> Result<Vec<Shape<'g>>, ModelError> {
        let assembly = self.assembly;
        let Some(tree) = self.scope.tree_of(&assembly.system)? else { return Ok(Vec::new()) };
        let mut shapes = Vec::new();
        for body in tree.bodies().iter().filter(|body| !self.document.drawing.hides(body.name())) {
            shapes.extend(self.on_joint(&tree, body).into_iter().flatten());
        }
        Ok(shapes)
    }

    /// The mass centre of a body, and a rod from its joint to each joint and point that it carries, or to the mass centre if it
    /// carries none. A body on a free joint, or with its mass centre at the joint, is a box. One with a surface has no rods.
    fn on_joint(&self, tree: &Tree<'g>, body: &TreeBody<'g>) -> Option<Vec<Shape<'g>>> {
        let (motions, graph) = (tree.motions(), self.assembly.system.graph());
        let (place, rotation) = (motions.place(body.name())?, motions.rotation(body.name())?);
        let (mass, centre, inertia) = body.mass_properties();
        let centre: Spot<'g> =
            [0, 1, 2].map(|i| place[i] + graph.dot((0..3).map(|j| rotation[(i, j)]), centre));
        let children = tree.bodies().iter().filter(|child| child.parent() == Some(body.name()));
        let carried = self.points.iter().filter(|point| point.body == body.name()).map(|point| point.at);
        let mut ends: Vec<Spot<'g>> = Vec::new();
        for end in children.filter_map(|child| motions.place(child.name())).chain(carried) {
            if !ends.contains(&end) {
                ends.push(end);
            }
        }
        let ends = if ends.is_empty() { vec![centre] } else { ends };
        let rods: Vec<Spot<'g>> = ends.into_iter().filter(|end| *end != place).collect();
        let is_box = self.has_box(body.name()) && (rods.is_empty() || self.is_free(body.name()));
        let block = is_box.then(|| self.block((mass, &inertia), centre, &rotation)).flatten();
        let mut shapes = match block {
            Some(block) => vec![block],
            None if self.is_covered(body.name()) => Vec::new(),
            None => rods.into_iter().map(|end| Shape::Line { through: vec![place, end] }).collect(),
        };
        shapes.push(Shape::Point { at: centre, label: Some(body.name().to_owned()) });
        Some(shapes)
    }

    /// Whether the text draws the surface of a body.
    fn is_covered(&self, name: &str) -> bool {
        let is_of = |body: &Located<String>| body.value == name;
        let mut drawn = self.document.draw.iter().filter(|draw| draw.body.as_ref().is_some_and(is_of));
        drawn.any(|draw| matches!(draw.shape, DrawnShape::Mesh { .. }))
    }

    fn is_free(&self, name: &str) -> bool {
        let mut bodies = self.document.tree.iter().filter(|body| body.joint.kind == JointKind::Free);
        bodies.any(|body| body.name.text == name)
    }

    /// The box of a body, with its values at the start.
    fn block(
        &self,
        (mass, inertia): (Expr<'g>, &Matrix<Expr<'g>>),
        at: Spot<'g>,
        rotation: &Matrix<Expr<'g>>,
    ) -> Option<Shape<'g>> {
        let graph = self.assembly.system.graph();
        let mut start = self.assembly.at_start();
        start.extend(self.assembly.system.parameters());
        let entries = (0..9).map(|ij| inertia[(ij / 3, ij % 3)]);
        let values = graph.evaluate(&entries.chain([mass]).collect::<Vec<_>>(), &start).ok()?;
        let block = Block::of(values[9], &Matrix::from_fn(3, 3, |i, j| values[3 * i + j]))?;
        let turned = |i: usize, j: usize| {
            graph.dot((0..3).map(|k| rotation[(i, k)]), (0..3).map(|k| Expr::from(block.axes[(k, j)])))
        };
        Some(Shape::Box { at, size: block.edges.map(Expr::from), rotation: Matrix::from_fn(3, 3, turned) })
    }

    /// The box of a body that is not on a joint.
    fn own_block(
        &mut self,
        body: &Body,
        at: Spot<'g>,
        rotation: &Matrix<Expr<'g>>,
    ) -> Result<Option<Shape<'g>>, ModelError> {
        let mass = self.scope.resolve(&body.mass, Stage::Inertia)?;
        let entries: &[Expression] = match &body.inertia {
            None => return Ok(None),
            Some(Inertia::Principal(moments)) => &moments[..],
            Some(Inertia::Full(entries)) => &entries[..],
        };
        let entries: Vec<Expr<'g>> = entries
            .iter()
            .map(|entry| self.scope.resolve(entry, Stage::Inertia))
            .collect::<Result<_, _>>()?;
        // Ixx, Iyy, Izz, Ixy, Iyz, Ixz
        let inertia = Matrix::from_fn(3, 3, |i, j| match i + j {
            _ if i == j => entries[i],
            1 => entries.get(3).copied().unwrap_or(Expr::ZERO),
            3 => entries.get(4).copied().unwrap_or(Expr::ZERO),
            _ => entries.get(5).copied().unwrap_or(Expr::ZERO),
        });
        Ok(self.block((mass, &inertia), at, rotation))
    }
}
