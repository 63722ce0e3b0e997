//! What bodies have as they move, as names: mass centres, momenta, energies, and the zero-moment point.
//!
//! Of a body with the name B these are its mass centre `COM_B_x`, its momentum `p_B_x`, its angular momentum
//! `L_B_x` about its mass centre, and its energies `T_B` and `V_B`; of all bodies together `COM_x`, `P_x`, and `L_x`
//! about their common mass centre. All vectors are along fixed axes. `ZMP_x` and `ZMP_y` are the point of the plane
//! z = 0 about which whatever holds the bodies against their weight has no moment along that plane.

use std::borrow::Cow;

use pc_expr::parse::Span;
use pc_mech::{Expr, System, Tree, TreeBody};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{self, Body, Expression, Inertia, Orientation};
use crate::names::moving::Moving;
use crate::names::points::hung;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

const AXES: [&str; 3] = ["x", "y", "z"];

/// What a name means: a component of a vector of one body or of all, or an energy of one body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Observed {
    Centre(Option<usize>, usize),
    Momentum(Option<usize>, usize),
    AngularMomentum(Option<usize>, usize),
    Kinetic(usize),
    Potential(usize),
    ZeroMomentPoint(usize),
}

impl<'g> Scope<'g, '_> {
    /// What `name` means of bodies; none if it is not such a name.
    pub(super) fn observed(&self, name: &str) -> Option<Observed> {
        let document = self.document;
        let names = document.bodies.iter().map(|body| &body.name.text);
        let mut names = names.chain(document.tree.iter().map(|body| &body.name.text));
        let (symbol, rest) = name.split_once('_')?;
        let energy = match symbol {
            "T" => Some(Observed::Kinetic as fn(usize) -> Observed),
            "V" => Some(Observed::Potential as fn(usize) -> Observed),
            _ => None,
        };
        if let Some(energy) = energy {
            return names.position(|body| body == rest).map(energy);
        }
        let (body, axis) = rest.rsplit_once('_').map_or((None, rest), |(body, axis)| (Some(body), axis));
        let axis = AXES.iter().position(|known| *known == axis)?;
        let whose = match body {
            Some(body) => Some(names.position(|known| known == body)?),
            None => names.next().and(None),
        };
        match (symbol, whose) {
            ("COM", whose) => Some(Observed::Centre(whose, axis)),
            ("p", Some(_)) | ("P", None) => Some(Observed::Momentum(whose, axis)),
            ("L", whose) => Some(Observed::AngularMomentum(whose, axis)),
            ("ZMP", None) if axis < 2 => Some(Observed::ZeroMomentPoint(axis)),
            _ => None,
        }
        .filter(|_| !document.bodies.is_empty() || !document.tree.is_empty())
    }

    /// All bodies as they move.
    pub(crate) fn bodies_in_motion(&mut self) -> Result<&[Moving<'g>], ModelError> {
        let bodies = match self.moving.take() {
            Some(bodies) => bodies,
            None => self.all_moving()?,
        };
        Ok(self.moving.insert(bodies))
    }

    /// The value of what the part `span` of an expression names.
    pub(super) fn of_motion(
        &mut self,
        expression: &Expression,
        span: Span,
        observed: Observed,
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        let bodies = match self.moving.take() {
            Some(bodies) => bodies,
            None => self.all_moving()?,
        };
        let value = self.component(expression, span, &bodies, observed, stage);
        self.moving = Some(bodies);
        value
    }

    fn component(
        &mut self,
        expression: &Expression,
        span: Span,
        bodies: &[Moving<'g>],
        observed: Observed,
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        let graph = self.graph;
        let sum = |of: &dyn Fn(&Moving<'g>) -> Expr<'g>| graph.sum(bodies.iter().map(of));
        let mass = sum(&|body| body.mass);
        let common = |i: usize| sum(&|body| body.mass * body.centre[i]) / mass;
        match observed {
            Observed::Centre(Some(body), i) => Ok(bodies[body].centre[i]),
            Observed::Centre(None, i) => Ok(common(i)),
            Observed::Momentum(Some(body), i) => Ok(bodies[body].momentum[i]),
            Observed::Momentum(None, i) => Ok(sum(&|body| body.momentum[i])),
            Observed::Kinetic(body) => Ok(bodies[body].kinetic),
            Observed::Potential(body) => Ok(bodies[body].potential),
            Observed::AngularMomentum(Some(body), i) => {
                self.spin(expression, span, &bodies[body]).map(|spin| spin[i])
            }
            Observed::AngularMomentum(None, i) => {
                let centre = [0, 1, 2].map(common);
                self.angular_momentum(expression, span, bodies, &centre, i)
            }
            Observed::ZeroMomentPoint(i) => {
                let gravity = self.acceleration_of_gravity()?;
                if gravity[2].is_zero() {
                    return Err(self.error(expression, span, |name| MeaningError::NoGround { name }));
                }
                // The force and the moment about the origin that act on the bodies besides their weight.
                let momentum = sum(&|body| body.momentum[2]);
                let force = self.rate_of(expression, span, momentum, stage)? - mass * gravity[2];
                let across = 1 - i;
                let origin = [Expr::ZERO; 3];
                let turning = self.angular_momentum(expression, span, bodies, &origin, across)?;
                let weight = sum(&|body| body.mass * cross(&body.centre, &gravity)[across]);
                let moment = self.rate_of(expression, span, turning, stage)? - weight;
                Ok(if i == 0 { -(moment / force) } else { moment / force })
            }
        }
    }

    /// Σ (r − r_0) × m v + I ω about a point r_0.
    fn angular_momentum(
        &self,
        expression: &Expression,
        span: Span,
        bodies: &[Moving<'g>],
        about: &[Expr<'g>; 3],
        i: usize,
    ) -> Result<Expr<'g>, ModelError> {
        let mut terms = Vec::with_capacity(2 * bodies.len());
        for body in bodies {
            let arm = [0, 1, 2].map(|j| body.centre[j] - about[j]);
            terms.push(cross(&arm, &body.momentum)[i]);
            terms.push(self.spin(expression, span, body)?[i]);
        }
        Ok(self.graph.sum(terms))
    }

    fn spin(
        &self,
        expression: &Expression,
        span: Span,
        body: &Moving<'g>,
    ) -> Result<[Expr<'g>; 3], ModelError> {
        let unknown = |name| MeaningError::NoFixedAxes { name, body: body.name.clone() };
        body.spin.ok_or_else(|| self.error(expression, span, unknown))
    }

    fn acceleration_of_gravity(&mut self) -> Result<[Expr<'g>; 3], ModelError> {
        match &self.document.gravity {
            Some(gravity) => self.each(&gravity.acceleration, Stage::Gravity),
            None => Ok([Expr::ZERO; 3]),
        }
    }

    /// All bodies: those that are placed by their position, then those on joints.
    fn all_moving(&mut self) -> Result<Vec<Moving<'g>>, ModelError> {
        // What the text says of a body is no part of the definition or branch in which the body is named.
        let context = std::mem::take(&mut self.context);
        let document = self.document;
        let gravity = self.acceleration_of_gravity()?;
        let mut all = Vec::with_capacity(document.bodies.len() + document.tree.len());
        for (place, body) in document.bodies.iter().enumerate() {
            let of_force = self.force_functions.get(place).copied().unwrap_or(Expr::ZERO);
            all.push(self.placed(body, &gravity, of_force)?);
        }
        all.extend(self.jointed(&gravity)?);
        self.context = context;
        Ok(all)
    }

    /// A body that is placed by its position.
    fn placed(
        &mut self,
        body: &Body,
        gravity: &[Expr<'g>; 3],
        of_force: Expr<'g>,
    ) -> Result<Moving<'g>, ModelError> {
        let graph = self.graph;
        let dot = |a: &[Expr<'g>; 3], b: &[Expr<'g>; 3]| graph.dot(a.iter().copied(), b.iter().copied());
        let mass = self.resolve(&body.mass, Stage::Inertia)?;
        let centre = self.each(&body.position, Stage::Position)?;
        let velocity = graph.directional(&centre, &self.rates());
        let velocity = [0, 1, 2].map(|i| velocity[i]);
        let inertia = match &body.inertia {
            None => [Expr::ZERO; 6],
            Some(Inertia::Full(entries)) => self.each(entries, Stage::Inertia)?,
            Some(Inertia::Principal(moments)) => {
                let [x, y, z] = self.each(moments, Stage::Inertia)?;
                [x, y, z, Expr::ZERO, Expr::ZERO, Expr::ZERO]
            }
        };
        let turned = |omega: &[Expr<'g>; 3]| {
            let [xx, yy, zz, xy, yz, xz] = inertia;
            [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].map(|row| dot(&row, omega))
        };
        let none = [Expr::ZERO; 3];
        let (omega, spin) = match &body.orientation {
            None => (none, Some(none)),
            Some(Orientation::AngularVelocity(components)) => (self.each(components, Stage::Dynamics)?, None),
            Some(Orientation::Rotation(entries)) => {
                let rotation = self.each(entries, Stage::Position)?;
                let omega = self.turning(&rotation);
                let own = turned(&omega);
                let row = |i: usize| dot(&[0, 1, 2].map(|j| rotation[3 * i + j]), &own);
                (omega, Some([0, 1, 2].map(row)))
            }
        };
        Ok(Moving {
            name: body.name.text.clone(),
            mass,
            centre,
            momentum: velocity.map(|v| mass * v),
            spin: spin.or_else(|| inertia.iter().all(|entry| entry.is_zero()).then_some(none)),
            kinetic: (mass * dot(&velocity, &velocity) + dot(&omega, &turned(&omega))) / 2.0,
            potential: -(mass * dot(gravity, &centre) + of_force),
        })
    }

    /// The angular velocity ω̂ = RᵀṘ along the axes of the body, of a multiple R of a rotation.
    fn turning(&self, rotation: &[Expr<'g>; 9]) -> [Expr<'g>; 3] {
        let graph = self.graph;
        let rates = graph.directional(rotation, &self.rates());
        let size = graph.dot(rotation.iter().copied(), rotation.iter().copied()) / 3.0;
        let entry = |i: usize, j: usize| {
            graph.dot((0..3).map(|l| rotation[3 * l + i]), (0..3).map(|l| rates[3 * l + j]))
        };
        [(2, 1), (0, 2), (1, 0)].map(|(i, j)| (entry(i, j) - entry(j, i)) / (2.0 * size))
    }

    /// The bodies on joints.
    fn jointed(&mut self, gravity: &[Expr<'g>; 3]) -> Result<Vec<Moving<'g>>, ModelError> {
        let document = self.document;
        let mut bodies = Vec::with_capacity(document.tree.len());
        let mut masses = Vec::with_capacity(document.tree.len());
        for body in &document.tree {
            let mass = body.mass.as_ref().map(|mass| self.resolve(mass, Stage::Joint)).transpose()?;
            masses.push(mass.unwrap_or(Expr::ZERO));
            bodies.push(self.massive(body)?);
        }
        let tree = Tree::new(self.graph, bodies).map_err(|error| document.derivation_error(error))?;
        let motions = tree.motions();
        let moving = |(body, mass): (&document::TreeBody, Expr<'g>)| {
            let name = body.name.text.clone();
            let centre = motions.mass_centre(&name)?;
            let height = self.graph.dot(gravity.iter().copied(), centre.iter().copied());
            Some(Moving {
                momentum: motions.momentum(&name)?,
                spin: motions.spin(&name),
                kinetic: motions.kinetic_energy(&name)?,
                potential: -(mass * height),
                name,
                mass,
                centre,
            })
        };
        Ok(document.tree.iter().zip(masses).filter_map(moving).collect()) // the tree has all of them
    }

    /// The bodies on joints with their masses: those of the system, which keeps them where no other inertia is added to theirs.
    pub(crate) fn tree_of<'t>(
        &mut self,
        system: &'t System<'g>,
    ) -> Result<Option<Cow<'t, Tree<'g>>>, ModelError> {
        let document = self.document;
        match system.tree() {
            Some(tree) => Ok(Some(Cow::Borrowed(tree))),
            None if document.tree.is_empty() => Ok(None),
            None => {
                let bodies =
                    document.tree.iter().map(|body| self.massive(body)).collect::<Result<Vec<_>, _>>()?;
                let tree = Tree::new(self.graph, bodies).map_err(|error| document.derivation_error(error))?;
                Ok(Some(Cow::Owned(tree)))
            }
        }
    }

    /// A body on its joint, with its mass but without forces.
    pub(crate) fn massive(&mut self, body: &document::TreeBody) -> Result<TreeBody<'g>, ModelError> {
        let mut made = hung(body, self.joint(&body.joint)?);
        if let Some(mass) = &body.mass {
            made = made.mass(self.resolve(mass, Stage::Joint)?);
        }
        if let Some(center) = &body.center {
            made = made.centre(self.constants(center)?);
        }
        if let Some(inertia) = &body.inertia {
            made = made.inertia(match inertia {
                Inertia::Principal(moments) => pc_mech::Inertia::from(self.constants(moments)?),
                Inertia::Full(entries) => pc_mech::Inertia::from(self.constants(entries)?),
            });
        }
        Ok(made)
    }

    pub(super) fn each<const N: usize>(
        &mut self,
        list: &[Expression; N],
        stage: Stage,
    ) -> Result<[Expr<'g>; N], ModelError> {
        let mut values = [Expr::ZERO; N];
        for (value, expression) in values.iter_mut().zip(list) {
            *value = self.resolve(expression, stage)?;
        }
        Ok(values)
    }
}

pub(crate) fn cross<'g>(a: &[Expr<'g>; 3], b: &[Expr<'g>; 3]) -> [Expr<'g>; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(j, l)| a[j] * b[l] - a[l] * b[j])
}
