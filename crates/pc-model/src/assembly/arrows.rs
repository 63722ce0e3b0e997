//! Vectors of a motion: velocities and angular velocities of bodies, and the forces on them.

use pc_mech::{BodyVelocity, Expr, Matrix};

use crate::assembly::assembly::Assembly;
use crate::assembly::placed::{rotation, spot};
use crate::assembly::resultant::{force_names, joint_force_names};
use crate::assembly::shape::Spot;
use crate::diagnostics::error::ModelError;
use crate::document::{Contact, Document, Expression, Orientation};
use crate::model::model::Model;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// The quantities that arrows stand for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// The velocity of a mass centre.
    Velocity,
    /// The angular velocity of a body.
    AngularVelocity,
    /// A force of the text, or a weight.
    Force,
    /// The force of a constraint, a contact or a joint.
    Reaction,
}

/// A vector along the axes of space, as a function of (t, x, η) and, for a reaction, of its columns among the outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow<'g> {
    /// What it stands for.
    pub quantity: Quantity,
    /// The body or contact to which it belongs.
    pub of: String,
    /// Where it begins.
    pub at: Spot<'g>,
    /// Its components.
    pub vector: Spot<'g>,
}

impl Model {
    /// The vectors of the motion: for each body ṙ of its mass centre, ω where its axes are known in space, its weight under
    /// `[gravity]` and the force of the text, then reactions. Those that are identically zero are left out, and so are forces
    /// that are known only as generalized ones. Of a body with a position, ṙ and forces are those of that position.
    ///
    /// # Errors
    /// [`ModelError`] at the expression that cannot be resolved.
    pub fn arrows<'g>(&self, assembly: &Assembly<'g>) -> Result<Vec<Arrow<'g>>, ModelError> {
        let graph = assembly.system.graph();
        let mut arrows = Arrows::of(self.document(), assembly)?;
        arrows.reactions()?;
        let mut arrows = arrows.list;
        arrows.retain(|arrow| arrow.vector.iter().any(|component| !component.is_zero()));
        let functions: Vec<Expr<'g>> =
            arrows.iter().flat_map(|arrow| [arrow.at, arrow.vector].concat()).collect();
        let known = assembly.velocities_of_coordinates();
        let values = graph.substitute(&functions, &known);
        for (arrow, values) in arrows.iter_mut().zip(values.chunks_exact(6)) {
            arrow.at = [values[0], values[1], values[2]];
            arrow.vector = [values[3], values[4], values[5]];
        }
        Ok(arrows)
    }
}

/// A body as it stands and moves in space.
struct Moving<'d, 'g> {
    name: &'d str,
    at: Spot<'g>,
    mass: Expr<'g>,
    velocity: Spot<'g>,
    omega: Option<Spot<'g>>,
    force: Option<&'d [Expression; 3]>,
}

struct Arrows<'a, 'd, 'g> {
    document: &'d Document,
    assembly: &'a Assembly<'g>,
    scope: Scope<'g, 'd>,
    /// The names of bodies, and the points on which reactions act.
    places: Vec<(&'d str, Spot<'g>)>,
    /// The places of joints.
    joints: Vec<(&'d str, Spot<'g>)>,
    list: Vec<Arrow<'g>>,
}

impl<'a, 'd, 'g> Arrows<'a, 'd, 'g> {
    /// Velocities and forces.
    fn of(document: &'d Document, assembly: &'a Assembly<'g>) -> Result<Self, ModelError> {
        let scope = Scope::new(assembly.system.graph(), document);
        let (places, joints, list) = (Vec::new(), Vec::new(), Vec::new());
        let mut arrows = Arrows { document, assembly, scope, places, joints, list };
        for body in arrows.on_joints()?.into_iter().chain(arrows.placed()?) {
            arrows.add(&body)?;
        }
        Ok(arrows)
    }

    fn on_joints(&mut self) -> Result<Vec<Moving<'d, 'g>>, ModelError> {
        let (document, assembly) = (self.document, self.assembly);
        let Some(tree) = self.scope.tree_of(&assembly.system)? else { return Ok(Vec::new()) };
        let motions = tree.motions();
        let moving = document.tree.iter().zip(tree.bodies()).filter_map(|(body, on_joint)| {
            let name = body.name.text.as_str();
            let (mass, centre, _) = on_joint.mass_properties();
            self.joints.push((name, motions.place(name)?));
            let (at, velocity) = (motions.mass_centre(name)?, motions.velocity_of_point(name, &centre)?);
            let omega = motions.angular_velocity_in_world(name);
            Some(Moving { name, at, mass, velocity, omega, force: body.force.as_ref() })
        });
        Ok(moving.collect())
    }

    fn placed(&mut self) -> Result<Vec<Moving<'d, 'g>>, ModelError> {
        let system = &self.assembly.system;
        let mut moving = Vec::new();
        for body in &self.document.bodies {
            let name = body.name.text.as_str();
            let Some(known) = system.bodies().iter().find(|known| known.name() == name) else { continue };
            let mass = self.scope.resolve(&body.mass, Stage::Inertia)?;
            let at = spot(&mut self.scope, &body.position, Stage::Position)?;
            let omega = match &body.orientation {
                Some(Orientation::Rotation(entries)) => {
                    let rotation = rotation(&mut self.scope, entries, Stage::Position)?;
                    self.in_space(known, &rotation)
                }
                _ => None,
            };
            let velocity = padded(known.velocity());
            moving.push(Moving { name, at, mass, velocity, omega, force: body.force.as_ref() });
        }
        Ok(moving)
    }

    /// ω along the axes of space, where R leads from the axes of the body.
    fn in_space(&self, body: &BodyVelocity<'g>, rotation: &Matrix<Expr<'g>>) -> Option<Spot<'g>> {
        let (omega, graph) = (padded(body.angular_velocity()?), self.assembly.system.graph());
        Some([0, 1, 2].map(|i| graph.dot((0..3).map(|j| rotation[(i, j)]), omega)))
    }

    fn add(&mut self, body: &Moving<'d, 'g>) -> Result<(), ModelError> {
        let &Moving { name, at, mass, velocity, omega, force } = body;
        let weight = self.assembly.system.gravity().map(|g| mass * g);
        let force = force.map(|force| spot(&mut self.scope, force, Stage::Dynamics)).transpose()?;
        self.places.push((name, at));
        self.push(Quantity::Velocity, name, at, velocity);
        if let Some(omega) = omega {
            self.push(Quantity::AngularVelocity, name, at, omega);
        }
        for force in [weight].into_iter().chain(force) {
            self.push(Quantity::Force, name, at, force);
        }
        Ok(())
    }

    fn push(&mut self, quantity: Quantity, of: &str, at: Spot<'g>, vector: Spot<'g>) {
        self.list.push(Arrow { quantity, of: of.to_owned(), at, vector });
    }

    /// The forces of contacts at the points of contact; those of other constraints on bodies, and of joints.
    fn reactions(&mut self) -> Result<(), ModelError> {
        let graph = self.assembly.system.graph();
        let mut of_contacts = Vec::new();
        for (number, contact) in self.document.contacts.iter().enumerate() {
            of_contacts.extend(contact.reactions().into_iter().map(|(_, constraint)| constraint));
            if let Some((at, directions)) = self.scope.directions_of_contact(number)? {
                let names = forces_of(contact);
                let parts = names.iter().zip(directions).map(|(name, axis)| (graph.symbol(name), axis));
                let parts: Vec<_> = parts.collect();
                let force = [0, 1, 2].map(|k| graph.sum(parts.iter().map(|(force, axis)| *force * axis[k])));
                self.push(Quantity::Reaction, &contact.name.text, at, force);
            }
        }
        let symbols = |names: [String; 3]| names.map(|name| graph.symbol(&name));
        let labels = self.document.constraints.iter().map(|constraint| &constraint.name.text);
        for label in labels.filter(|label| !of_contacts.contains(label)) {
            for (body, at) in self.places.clone() {
                self.push(Quantity::Reaction, body, at, symbols(force_names(label, body)));
            }
        }
        for (body, at) in self.joints.clone() {
            self.push(Quantity::Reaction, body, at, symbols(joint_force_names(body)));
        }
        Ok(())
    }
}

/// The names of the normal force of a contact and of those along its tangents, if it has any.
fn forces_of(contact: &Contact) -> Vec<String> {
    let mut names: Vec<String> = contact.reactions().into_iter().map(|(force, _)| force).collect();
    if names.len() == 1 {
        names.extend(contact.friction_forces());
    }
    names
}

/// A vector of the plane as one of space.
fn padded<'g>(vector: &[Expr<'g>]) -> Spot<'g> {
    [0, 1, 2].map(|k| vector.get(k).copied().unwrap_or(Expr::ZERO))
}
