//! The velocities of bodies, stored with the system to which they belong.

use pc_expr::Expr;

/// The velocities of a body: ṙ of its point and its ω, which are affine functions of η.
#[derive(Clone, Debug)]
pub struct BodyVelocity<'g> {
    pub(crate) name: String,
    pub(crate) mass: Expr<'g>,
    pub(crate) velocity: Vec<Expr<'g>>,
    pub(crate) angular_velocity: Option<Vec<Expr<'g>>>,
    /// For each component of its force, whether its force function is a term of L.
    pub(crate) in_lagrangian: Vec<bool>,
}

impl<'g> BodyVelocity<'g> {
    /// The name that the body was given, or else `body` and its number.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The velocity ṙ(t, x, η), along the axes of the position.
    pub fn velocity(&self) -> &[Expr<'g>] {
        &self.velocity
    }

    /// The angular velocity ω(t, x, η), along the axes of the inertia; none for a particle.
    pub fn angular_velocity(&self) -> Option<&[Expr<'g>]> {
        self.angular_velocity.as_deref()
    }

    /// For each component of the force on it, whether its force function is a term of L; empty for a body
    /// without a force and for a body on a joint.
    pub fn force_in_lagrangian(&self) -> &[bool] {
        &self.in_lagrangian
    }
}

/// The bodies of a system, and the other terms of its Lagrangian.
#[derive(Clone, Debug)]
pub(crate) struct Bodies<'g> {
    pub(crate) list: Vec<BodyVelocity<'g>>,
    /// The Lagrangian L without the kinetic energy of the bodies.
    pub(crate) rest: Expr<'g>,
    /// L without Σ m ṙ²/2, the part of that energy that is due to the motion of their points; none where the
    /// equations do not follow from L.
    pub(crate) others: Option<Expr<'g>>,
}

impl<'g> Bodies<'g> {
    /// The same bodies with `put` applied to every expression, including the rest of the Lagrangian.
    pub(crate) fn map<'n>(&self, put: impl Fn(&[Expr<'g>]) -> Vec<Expr<'n>>) -> Bodies<'n> {
        let moved = |body: &BodyVelocity<'g>| BodyVelocity {
            name: body.name.clone(),
            mass: put(&[body.mass])[0],
            velocity: put(&body.velocity),
            angular_velocity: body.angular_velocity.as_deref().map(&put),
            in_lagrangian: body.in_lagrangian.clone(),
        };
        let one = |x: Expr<'g>| put(&[x])[0];
        let (rest, others) = (one(self.rest), self.others.map(one));
        Bodies { list: self.list.iter().map(moved).collect(), rest, others }
    }
}
