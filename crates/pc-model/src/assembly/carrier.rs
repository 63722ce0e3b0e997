//! The axes in which a shape of the text is described.

use pc_mech::{Expr, Graph, Matrix, Tree};

use crate::assembly::placed::{rotation, spot};
use crate::assembly::shape::Spot;
use crate::diagnostics::error::ModelError;
use crate::document::{Document, Orientation};
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// The axes of a body, from the body's origin, or the fixed axes.
pub(super) enum Carrier<'g> {
    Fixed,
    /// A body at x, with the rotation matrix R from its axes to the fixed axes.
    Body {
        graph: &'g Graph,
        origin: Spot<'g>,
        rotation: Matrix<Expr<'g>>,
    },
}

impl<'g> Carrier<'g> {
    /// The body with this name, on a joint of the tree or at a position; a particle has the fixed axes.
    ///
    /// # Errors
    /// [`ModelError`] at its position or rotation.
    pub(super) fn of(
        name: &str,
        scope: &mut Scope<'g, '_>,
        document: &Document,
        (graph, tree): (&'g Graph, Option<&Tree<'g>>),
    ) -> Result<Carrier<'g>, ModelError> {
        let on_joint =
            tree.and_then(|tree| Some((tree.motions().place(name)?, tree.motions().rotation(name)?)));
        if let Some((origin, rotation)) = on_joint {
            return Ok(Carrier::Body { graph, origin, rotation });
        }
        // That there is such a body was checked as the text was read.
        let Some(body) = document.bodies.iter().find(|body| body.name.text == name) else {
            return Ok(Carrier::Fixed);
        };
        let origin = spot(scope, &body.position, Stage::Position)?;
        let rotation = match &body.orientation {
            Some(Orientation::Rotation(entries)) => rotation(scope, entries, Stage::Position)?,
            _ => Matrix::from_fn(3, 3, |i, j| if i == j { Expr::ONE } else { Expr::ZERO }),
        };
        Ok(Carrier::Body { graph, origin, rotation })
    }

    /// x + R p
    pub(super) fn place(&self, p: Spot<'g>) -> Spot<'g> {
        match self {
            Carrier::Fixed => p,
            Carrier::Body { origin, .. } => {
                let turned = self.direction(p);
                [0, 1, 2].map(|i| origin[i] + turned[i])
            }
        }
    }

    /// R n
    pub(super) fn direction(&self, n: Spot<'g>) -> Spot<'g> {
        match self {
            Carrier::Fixed => n,
            Carrier::Body { graph, rotation, .. } => {
                [0, 1, 2].map(|i| graph.dot((0..3).map(|j| rotation[(i, j)]), n))
            }
        }
    }

    /// R S
    pub(super) fn rotation(&self, s: Matrix<Expr<'g>>) -> Matrix<Expr<'g>> {
        match self {
            Carrier::Fixed => s,
            Carrier::Body { graph, rotation, .. } => Matrix::from_fn(3, 3, |i, j| {
                graph.dot((0..3).map(|k| rotation[(i, k)]), (0..3).map(|k| s[(k, j)]))
            }),
        }
    }
}
