//! The bodies of a model: their expressions are resolved, and errors are located in the file.

use pc_algebra::affine;
use pc_mech::{Expr, Frame, Inertia, Matrix, MechError, Particle, RigidBody};

use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{self, Expression, Orientation};
use crate::names::stage::Stage;

/// A body in the form that `pc_mech` accepts.
pub(super) enum SystemBody<'g> {
    /// A body without orientation.
    Particle(Particle<'g>),
    /// A body with an orientation.
    Rigid(Box<RigidBody<'g>>),
}

impl<'g> SystemBody<'g> {
    /// The force function of the force on the body, a term of L.
    pub(super) fn force_function(&self, frame: &Frame<'g>, eta: &[Expr<'g>]) -> Result<Expr<'g>, MechError> {
        match self {
            SystemBody::Particle(particle) => particle.force_function_of(frame, eta),
            SystemBody::Rigid(body) => body.force_function_of(frame, eta),
        }
    }
}

impl<'g> Assembler<'g, '_> {
    /// The entries of `[bodies]`; `x_dot` pairs each symbol x' with its value b η + b_0.
    pub(super) fn bodies(
        &mut self,
        eta: &[Expr<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Vec<SystemBody<'g>>, ModelError> {
        self.model.document().bodies.iter().map(|body| self.body(body, eta, x_dot)).collect()
    }

    /// The bodies whose masses change with time or first-order states.
    pub(super) fn changing_masses(&mut self) -> Result<Vec<String>, ModelError> {
        let changing = [vec![self.graph.symbol("t")], self.scope.states()].concat();
        let mut names = Vec::new();
        for body in &self.model.document().bodies {
            let mass = self.scope.resolve(&body.mass, Stage::Inertia)?;
            if changing.iter().any(|&y| mass.depends_on(y)) {
                names.push(body.name.text.clone());
            }
        }
        Ok(names)
    }

    /// The entry of `[gravity]`.
    pub(super) fn gravity(&mut self) -> Result<Option<[Expr<'g>; 3]>, ModelError> {
        let gravity = self.model.document().gravity.as_ref();
        gravity.map(|gravity| self.resolved(&gravity.acceleration, Stage::Gravity)).transpose()
    }

    fn body(
        &mut self,
        body: &document::Body,
        eta: &[Expr<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<SystemBody<'g>, ModelError> {
        let mass = self.scope.resolve(&body.mass, Stage::Inertia)?;
        let position = self.resolved(&body.position, Stage::Position)?;
        let force = body.force.as_ref().map(|force| self.all_dynamic(force, x_dot)).transpose()?;
        let Some(orientation) = &body.orientation else {
            let particle = Particle::new(mass, position).named(&body.name.text);
            return Ok(SystemBody::Particle(match force {
                Some(force) => particle.force(force),
                None => particle,
            }));
        };
        let inertia: Inertia<'g> = match &body.inertia {
            None => [Expr::ZERO; 3].into(),
            Some(document::Inertia::Principal(moments)) => self.resolved(moments, Stage::Inertia)?.into(),
            Some(document::Inertia::Full(entries)) => self.resolved(entries, Stage::Inertia)?.into(),
        };
        let mut rigid = match orientation {
            Orientation::Rotation(entries) => {
                let entries = self.resolved(entries, Stage::Position)?;
                let rotation = Matrix::from_fn(3, 3, |i, j| entries[3 * i + j]);
                RigidBody::rotating(mass, position, inertia, rotation)
            }
            Orientation::AngularVelocity(components) => {
                let omega = self.angular_velocity(components, eta, x_dot)?;
                RigidBody::turning(mass, position, inertia, omega)
            }
        };
        rigid = rigid.named(&body.name.text);
        if let Some(force) = force {
            rigid = rigid.force(force);
        }
        if let Some(torque) = &body.torque {
            rigid = rigid.torque(self.all_dynamic(torque, x_dot)?);
        }
        Ok(SystemBody::Rigid(Box::new(rigid)))
    }

    /// The expressions resolved as functions of the names allowed at this stage.
    pub(super) fn resolved<const N: usize>(
        &mut self,
        list: &[Expression; N],
        stage: Stage,
    ) -> Result<[Expr<'g>; N], ModelError> {
        let mut values = [Expr::ZERO; N];
        for (value, expression) in values.iter_mut().zip(list) {
            *value = self.scope.resolve(expression, stage)?;
        }
        Ok(values)
    }

    /// The expressions resolved as functions of the motion, with ẋ = b η + b_0 substituted.
    pub(super) fn all_dynamic<const N: usize>(
        &mut self,
        list: &[Expression; N],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<[Expr<'g>; N], ModelError> {
        let mut values = [Expr::ZERO; N];
        for (value, expression) in values.iter_mut().zip(list) {
            *value = self.dynamic(expression, x_dot)?;
        }
        Ok(values)
    }

    fn angular_velocity(
        &mut self,
        components: &[Expression; 3],
        eta: &[Expr<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<[Expr<'g>; 3], ModelError> {
        let omega = self.all_dynamic(components, x_dot)?;
        for (component, value) in components.iter().zip(omega) {
            if affine(self.graph, value, eta).is_none() {
                let fault = |text| MeaningError::NotAffine { text, variables: "velocities" };
                return Err(self.scope.error(component, component.ast.span, fault));
            }
        }
        Ok(omega)
    }
}
