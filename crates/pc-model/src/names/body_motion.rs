//! The motion of a body, placed by its position or on a joint.

use pc_mech::{Expr, Graph, Matrix};

use crate::diagnostics::error::ModelError;
use crate::document::{Expression, Orientation};
use crate::names::scope::Scope;
use crate::names::stage::Stage;

pub(crate) type Vector<'g> = [Expr<'g>; 3];

/// The motion of a body: the position of its reference point and the rotation from its axes to the fixed ones; the
/// velocity of that point along fixed axes, and the angular velocity along its own.
pub(crate) struct BodyMotion<'g> {
    pub(crate) place: Vector<'g>,
    pub(crate) rotation: Matrix<Expr<'g>>,
    pub(crate) velocity: Vector<'g>,
    pub(crate) turning: Vector<'g>,
}

impl BodyMotion<'_> {
    /// That of the fixed axes.
    pub(crate) fn at_rest() -> Self {
        let zero = [Expr::ZERO; 3];
        BodyMotion { place: zero, rotation: unit_matrix(), velocity: zero, turning: zero }
    }
}

impl<'g> Scope<'g, '_> {
    /// The motion of a body of the document in terms of coordinates, x', quasi-velocities and t. `attitude` is the rotation
    /// of a body of which only the angular velocity is given.
    pub(crate) fn body_motion(
        &mut self,
        body: &str,
        attitude: Option<&[Expression; 9]>,
    ) -> Result<BodyMotion<'g>, ModelError> {
        let document = self.document;
        let placed = document.bodies.iter().find(|placed| placed.name.text == body);
        let Some(body) = placed else { return self.motion_on_joint(body) };
        let place = self.each(&body.position, Stage::Position)?;
        let rates = self.rates();
        let velocity = self.graph.directional(&place, &rates);
        let velocity = [velocity[0], velocity[1], velocity[2]];
        let entries = match (&body.orientation, attitude) {
            (Some(Orientation::Rotation(entries)), _) => &**entries,
            (_, Some(attitude)) => attitude,
            _ => {
                let (rotation, turning) = (unit_matrix(), [Expr::ZERO; 3]);
                return Ok(BodyMotion { place, rotation, velocity, turning });
            }
        };
        let values = self.each(entries, Stage::Position)?;
        let rotation = Matrix::from_fn(3, 3, |i, j| values[3 * i + j]);
        let turning = match &body.orientation {
            Some(Orientation::AngularVelocity(components)) => self.each(components, Stage::Constraint)?,
            _ => {
                let rates = self.graph.directional(&values, &rates);
                // ω_1 = Σ R_i3 R'_i2, and so on round: RᵀR' is antisymmetric.
                [(2, 1), (0, 2), (1, 0)].map(|(j, k)| {
                    let column = |of: &[Expr<'g>], j: usize| [of[j], of[3 + j], of[6 + j]];
                    self.graph.dot(column(&values, j), column(&rates, k))
                })
            }
        };
        Ok(BodyMotion { place, rotation, velocity, turning })
    }

    fn motion_on_joint(&mut self, body: &str) -> Result<BodyMotion<'g>, ModelError> {
        let tree = self.kinematic_tree()?;
        let motions = tree.motions();
        let zero = [Expr::ZERO; 3]; // the callers' bodies are in the tree
        let rotation = motions.rotation(body).unwrap_or_else(unit_matrix);
        let velocity = motions.velocity(body).unwrap_or(zero);
        Ok(BodyMotion {
            place: motions.place(body).unwrap_or(zero),
            velocity: turned(&rotation, &velocity, |r, i, j| r[(i, j)], self.graph),
            turning: motions.angular_velocity(body).unwrap_or(zero),
            rotation,
        })
    }
}

fn unit_matrix<'g>() -> Matrix<Expr<'g>> {
    Matrix::from_fn(3, 3, |i, j| if i == j { Expr::ONE } else { Expr::ZERO })
}

/// R v, or Rᵀ v, according to the order of the indices in `entry`.
pub(crate) fn turned<'g>(
    rotation: &Matrix<Expr<'g>>,
    v: &Vector<'g>,
    entry: impl Fn(&Matrix<Expr<'g>>, usize, usize) -> Expr<'g>,
    graph: &'g Graph,
) -> Vector<'g> {
    [0, 1, 2].map(|i| graph.dot((0..3).map(|j| entry(rotation, i, j)), v.iter().copied()))
}
