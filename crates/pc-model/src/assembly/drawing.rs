//! Drawings of a model: its bodies, joints and points, and the shapes given in its text.

use std::path::Path;

use pc_mech::{Expr, Matrix};

use crate::assembly::assembly::Assembly;
use crate::assembly::carrier::Carrier;
use crate::assembly::outlines::Outlines;
use crate::assembly::placed::{rotation, spot};
use crate::assembly::shape::{Shape, Spot};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::{Document, DrawnPlace, DrawnShape, Expression};
use crate::model::model::Model;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// The direction of the third axis.
const THIRD: Spot<'static> = [Expr::ZERO, Expr::ZERO, Expr::ONE];

impl Model {
    /// The drawing of the model: bodies on joints, with rods from joint to joint and to points, other bodies, points, then the
    /// shapes of `[[draw]]`. Bodies that turn, and to which no rod leads the eye, and bodies on free joints are boxes of their
    /// inertia, unless the text draws them. What `[drawing]` hides is left out.
    ///
    /// # Errors
    /// [`ModelError`] at the expression that cannot be resolved.
    pub fn drawing<'g>(&self, assembly: &Assembly<'g>) -> Result<Vec<Shape<'g>>, ModelError> {
        let mut shapes = Outlines::new(self.document(), assembly)?.shapes()?;
        shapes.extend(self.drawn(assembly)?);
        Ok(shapes)
    }

    /// The error for a mesh whose file cannot be drawn, at the entry that names it.
    pub fn not_drawn(&self, file: &Path, why: String) -> ModelError {
        let document = self.document();
        let named = document.draw.iter().find_map(|draw| match &draw.shape {
            DrawnShape::Mesh { file: named, .. } if document.beside(&named.value) == file => Some(named),
            _ => None,
        });
        let place = named.map_or_else(|| document.end(), |named| named.place.clone());
        let file = named.map_or_else(|| file.display().to_string(), |named| named.value.clone());
        document.source.error(&place, ErrorKind::NotDrawn { file, why })
    }

    /// The shapes of `[[draw]]`.
    ///
    /// # Errors
    /// As for [`drawing`](Model::drawing).
    pub(crate) fn drawn<'g>(&self, assembly: &Assembly<'g>) -> Result<Vec<Shape<'g>>, ModelError> {
        let (document, graph) = (self.document(), assembly.system.graph());
        let mut scope = Scope::new(graph, document);
        let is_carried = document.draw.iter().any(|draw| draw.body.is_some());
        let tree = if is_carried { scope.tree_of(&assembly.system)? } else { None };
        let velocities = assembly.velocities_of_coordinates();
        let mut shapes = Vec::new();
        for draw in &document.draw {
            let carrier = match &draw.body {
                None => Carrier::Fixed,
                Some(body) => Carrier::of(&body.value, &mut scope, document, (graph, tree.as_deref()))?,
            };
            let shape = Pen { scope: &mut scope, carrier, document }.shape(&draw.shape)?;
            shapes.push(shape.substituted(graph, &velocities));
        }
        Ok(shapes)
    }
}

/// Resolves what describes a shape in the axes of its carrier.
struct Pen<'a, 'd, 'g> {
    scope: &'a mut Scope<'g, 'd>,
    carrier: Carrier<'g>,
    document: &'d Document,
}

impl<'g> Pen<'_, '_, 'g> {
    fn shape(&mut self, shape: &DrawnShape) -> Result<Shape<'g>, ModelError> {
        Ok(match shape {
            DrawnShape::Point { at } => Shape::Point { at: self.place(at)?, label: None },
            DrawnShape::Line { through } => Shape::Line {
                through: through.iter().map(|place| self.place(place)).collect::<Result<_, _>>()?,
            },
            DrawnShape::Disc { at, normal, radius } => {
                let (at, normal) = (self.place(at)?, self.normal(normal.as_ref())?);
                Shape::Disc { at, normal, radius: self.scope.resolve(radius, Stage::Drawing)? }
            }
            DrawnShape::Ring { at, normal, radius } => {
                let (at, normal) = (self.place(at)?, self.normal(normal.as_ref())?);
                Shape::Ring { at, normal, radius: self.scope.resolve(radius, Stage::Drawing)? }
            }
            DrawnShape::Sphere { at, radius } => {
                Shape::Sphere { at: self.place(at)?, radius: self.scope.resolve(radius, Stage::Drawing)? }
            }
            DrawnShape::Box { at, size, rotation } => Shape::Box {
                at: self.place(at)?,
                size: spot(self.scope, size, Stage::Drawing)?,
                rotation: self.rotation(rotation.as_deref())?,
            },
            DrawnShape::Mesh { file, at, rotation, scale } => Shape::Mesh {
                file: self.document.beside(&file.value),
                scale: *scale,
                at: self.place(at.as_deref().unwrap_or_default())?,
                rotation: self.rotation(rotation.as_deref())?,
            },
            DrawnShape::Spring { from, to } => Shape::Spring { from: self.place(from)?, to: self.place(to)? },
            DrawnShape::Trace { at } => Shape::Trace { at: self.place(at)? },
            DrawnShape::Text { at, text } => Shape::Text { at: self.place(at)?, text: text.value.clone() },
        })
    }

    fn place(&mut self, at: &[Expression]) -> Result<Spot<'g>, ModelError> {
        Ok(self.carrier.place(spot(self.scope, at, Stage::Drawing)?))
    }

    fn normal(&mut self, normal: Option<&DrawnPlace>) -> Result<Spot<'g>, ModelError> {
        let normal = normal.map_or(Ok(THIRD), |normal| spot(self.scope, normal, Stage::Drawing))?;
        Ok(self.carrier.direction(normal))
    }

    fn rotation(&mut self, rows: Option<&[Expression; 9]>) -> Result<Matrix<Expr<'g>>, ModelError> {
        Ok(self.carrier.rotation(match rows {
            Some(entries) => rotation(self.scope, entries, Stage::Drawing)?,
            None => Matrix::from_fn(3, 3, |i, j| if i == j { Expr::ONE } else { Expr::ZERO }),
        }))
    }
}
