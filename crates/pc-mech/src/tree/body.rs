//! A body of a tree.

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::system::bodies::rigid_body::Inertia;
use crate::tree::joint::Joint;
use crate::tree::spatial::{Vector, ZERO};

/// A body, and the joint that connects it to another body.
#[derive(Clone, Debug)]
pub struct TreeBody<'g> {
    pub(crate) name: String,
    /// `None` for the world.
    pub(crate) parent: Option<String>,
    pub(crate) joint: Joint<'g>,
    pub(crate) mass: Expr<'g>,
    pub(crate) centre: Vector<'g>,
    pub(crate) inertia: Inertia<'g>,
    pub(crate) force: Vector<'g>,
    pub(crate) torque: Vector<'g>,
}

impl<'g> TreeBody<'g> {
    /// A body without mass, attached to the world by `joint`.
    pub fn new(name: impl Into<String>, joint: Joint<'g>) -> TreeBody<'g> {
        TreeBody {
            name: name.into(),
            parent: None,
            joint,
            mass: Expr::ZERO,
            centre: ZERO,
            inertia: Inertia::from(ZERO),
            force: ZERO,
            torque: ZERO,
        }
    }

    /// The same body, attached to another body.
    #[must_use]
    pub fn on(self, parent: impl Into<String>) -> TreeBody<'g> {
        TreeBody { parent: Some(parent.into()), ..self }
    }

    /// The same body with a mass.
    #[must_use]
    pub fn mass(self, mass: impl Into<Expr<'g>>) -> TreeBody<'g> {
        TreeBody { mass: mass.into(), ..self }
    }

    /// The same body with its mass centre, given along body axes from the point of its joint.
    #[must_use]
    pub fn centre(self, centre: [impl Into<Expr<'g>>; 3]) -> TreeBody<'g> {
        TreeBody { centre: centre.map(Into::into), ..self }
    }

    /// The same body with its inertia about the mass centre, along body axes.
    #[must_use]
    pub fn inertia(self, inertia: impl Into<Inertia<'g>>) -> TreeBody<'g> {
        TreeBody { inertia: inertia.into(), ..self }
    }

    /// The same body with a force F(t, x, η) at its mass centre, along the axes of the world.
    #[must_use]
    pub fn force(self, force: [impl Into<Expr<'g>>; 3]) -> TreeBody<'g> {
        TreeBody { force: force.map(Into::into), ..self }
    }

    /// The same body with a torque N(t, x, η), along body axes.
    #[must_use]
    pub fn torque(self, torque: [impl Into<Expr<'g>>; 3]) -> TreeBody<'g> {
        TreeBody { torque: torque.map(Into::into), ..self }
    }

    /// The body with each expression replaced.
    pub(crate) fn map<'n>(&self, put: &impl Fn(Expr<'g>) -> Expr<'n>) -> TreeBody<'n> {
        TreeBody {
            name: self.name.clone(),
            parent: self.parent.clone(),
            joint: self.joint.map(put),
            mass: put(self.mass),
            centre: self.centre.map(put),
            inertia: self.inertia.map(put),
            force: self.force.map(put),
            torque: self.torque.map(put),
        }
    }

    /// The name of the body to which it is attached; none for the world.
    pub fn parent(&self) -> Option<&str> {
        self.parent.as_deref()
    }

    /// The name of the body whose joint its own joint follows, if it does.
    pub fn followed(&self) -> Option<&str> {
        self.joint.follows.as_ref().map(|follows| follows.body.as_str())
    }

    /// The mass m, the mass centre c and the inertia I about it, along body axes.
    pub fn mass_properties(&self) -> (Expr<'g>, [Expr<'g>; 3], Matrix<Expr<'g>>) {
        (self.mass, self.centre, self.inertia.matrix())
    }

    /// The force at its mass centre, along the axes of the world, and the torque, along body axes.
    pub fn loads(&self) -> ([Expr<'g>; 3], [Expr<'g>; 3]) {
        (self.force, self.torque)
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }
}
