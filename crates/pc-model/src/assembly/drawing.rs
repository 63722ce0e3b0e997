//! Drawings of a model: its bodies, joints and points, and the shapes given in its text.

use pc_mech::{Expr, Matrix};

use crate::assembly::assembly::Assembly;
use crate::assembly::outlines::Outlines;
use crate::assembly::placed::{rotation, spot};
use crate::assembly::shape::{Shape, Spot};
use crate::diagnostics::error::ModelError;
use crate::document::{Draw, DrawnShape, Expression};
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

    /// The shapes of `[[draw]]`.
    ///
    /// # Errors
    /// As for [`drawing`](Model::drawing).
    pub(crate) fn drawn<'g>(&self, assembly: &Assembly<'g>) -> Result<Vec<Shape<'g>>, ModelError> {
        let graph = assembly.system.graph();
        let mut scope = Scope::new(graph, self.document());
        let velocities = assembly.velocities_of_coordinates();
        let of_state = |shape: Shape<'g>| shape.substituted(graph, &velocities);
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
            let (at, normal) = (at(place)?, normal.as_ref().map_or(Ok(THIRD), |normal| at(normal))?);
            Shape::Disc { at, normal, radius: scope.resolve(radius, Stage::Drawing)? }
        }
        DrawnShape::Ring { at: place, normal, radius } => {
            let (at, normal) = (at(place)?, normal.as_ref().map_or(Ok(THIRD), |normal| at(normal))?);
            Shape::Ring { at, normal, radius: scope.resolve(radius, Stage::Drawing)? }
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
