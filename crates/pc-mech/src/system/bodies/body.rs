//! A body of either kind.

use pc_expr::{Expr, Graph};

use crate::error::{MechError, shape};
use crate::system::bodies::moving::{Moving, Share};
use crate::system::bodies::particle::Particle;
use crate::system::bodies::rigid_body::RigidBody;

/// A particle or a rigid body.
#[derive(Clone, Debug)]
pub(crate) enum Body<'g> {
    Particle(Particle<'g>),
    Rigid(Box<RigidBody<'g>>),
}

impl<'g> Body<'g> {
    /// T and Q_1..Q_k.
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError), [`BodyError::OfVelocities`](crate::BodyError::OfVelocities),
    /// [`BodyError::AngularVelocityNotAffine`](crate::BodyError::AngularVelocityNotAffine).
    pub(crate) fn share(&self, moving: &Moving<'_, 'g>) -> Result<Share<'g>, MechError> {
        match self {
            Body::Particle(particle) => particle.share(moving),
            Body::Rigid(body) => body.share(moving),
        }
    }

    /// The term m g · r of L in a gravitational field.
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError)
    pub(crate) fn weight(&self, graph: &'g Graph, acceleration: &[Expr<'g>]) -> Result<Expr<'g>, MechError> {
        let (mass, position) = self.mass_and_position();
        shape("the acceleration of gravity", acceleration.len(), position.len())?;
        Ok(mass * graph.dot(acceleration.iter().copied(), position.iter().copied()))
    }

    pub(crate) fn mass_and_position(&self) -> (Expr<'g>, &[Expr<'g>]) {
        match self {
            Body::Particle(particle) => particle.mass_and_position(),
            Body::Rigid(body) => body.mass_and_position(),
        }
    }

    /// The name that the body was given.
    pub(crate) fn name(&self) -> Option<&str> {
        match self {
            Body::Particle(particle) => particle.name(),
            Body::Rigid(body) => body.name(),
        }
    }
}
