//! Contacts of bodies with the ground, as functions of coordinates and velocities.
//!
//! With the outward unit normal n of a plane, which leads through p_0, a convex body of centre c touches the plane at
//!
//!   p = c − ρ(n),    g = n·(c − p_0) − h(n) = 0,    ρ = ∂h/∂n,
//!
//! where h is the support function of the body: r for a sphere, r |n − (n·e) e| for a disc with the axle e, and
//! √(a²n_1² + b²n_2² + c²n_3²) for an ellipsoid along its own axes. The material point of the body at p has the velocity
//! u = v + ω × (p − c), of which n·u is the rate of g.
//!
//! Where the ground has the height f(x, y), the plane is the tangent plane at the point p_0 = (x, y, f(x, y)), whose
//! coordinates x and y are coordinates of the system, tied to the body by
//!
//!   t_i·(p − p_0) = 0,    t_1 = (1, 0, f_x),    t_2 = (0, 1, f_y),    n = t_1 × t_2/|t_1 × t_2|.
//!
//! There ∂h/∂n is p − c, so that the derivatives of g with respect to x and y vanish, and with them the reactions of these two
//! constraints.

use pc_mech::{Expr, Tree};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Contact, ContactShape, Expression};
use crate::names::body_motion::{Vector, turned};
use crate::names::points::hung;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// The ground at a point: the point itself, where the ground is uneven along the axes along which its height changes; the
/// normal; and the derivatives of the height.
struct Ground<'g> {
    through: Vector<'g>,
    normal: Vector<'g>,
    slopes: [Expr<'g>; 2],
}

impl<'g, 'd> Scope<'g, 'd> {
    /// The contact that has a component with this name, and the index of the component.
    pub(super) fn contact_of(&self, name: &str) -> Option<(usize, usize)> {
        let contacts = self.document.contacts.iter().enumerate();
        contacts.filter_map(|(number, contact)| Some((number, contact.component(name)?))).next()
    }

    /// The reaction that is also called `name`, if this is a force of a contact.
    pub(super) fn reaction_of_contact(&self, name: &str) -> Option<Expr<'g>> {
        let mut reactions = self.document.contacts.iter().flat_map(Contact::reactions);
        let (_, constraint) = reactions.find(|(force, _)| force == name)?;
        Some(self.graph.symbol(&format!("λ_{constraint}")))
    }

    /// Whether this is a force of dry friction of a contact.
    pub(super) fn is_friction(&self, name: &str) -> bool {
        self.document.contacts.iter().flat_map(Contact::friction_forces).any(|force| force == name)
    }

    /// The two velocities of slip of the contact with this number.
    pub(crate) fn slips(&mut self, number: usize) -> Result<[Expr<'g>; 2], ModelError> {
        let mut slips = [Expr::ZERO; 2];
        for (slip, component) in slips.iter_mut().zip(Contact::SLIPS) {
            *slip = self.contact(number, component)?.unwrap_or(Expr::ZERO);
        }
        Ok(slips)
    }

    /// A component of a contact; `None` if the motion of the body depends on the contact itself.
    pub(super) fn contact(
        &mut self,
        number: usize,
        component: usize,
    ) -> Result<Option<Expr<'g>>, ModelError> {
        if let Some(known) = self.contacts.get(&number) {
            return Ok(known.as_ref().map(|values| values[component]));
        }
        self.contacts.insert(number, None);
        let values = self.touching(number)?;
        let value = values[component];
        self.contacts.insert(number, Some(values));
        Ok(Some(value))
    }

    /// The point of a contact, then its normal and two tangents; `None` if the motion of the body depends on the contact itself.
    pub(crate) fn directions_of_contact(
        &mut self,
        number: usize,
    ) -> Result<Option<(Vector<'g>, [Vector<'g>; 3])>, ModelError> {
        let mut point = [Expr::ZERO; 3];
        for (k, part) in point.iter_mut().enumerate() {
            let Some(value) = self.contact(number, k)? else { return Ok(None) };
            *part = value;
        }
        let contact = &self.document.contacts[number];
        let normal = self.ground(contact)?.normal;
        let [first, second] = tangents(contact.first_tangent(), &normal);
        Ok(Some((point, [normal, first, second])))
    }

    /// How far the point of contact with this number is beside the normal, for each of its coordinates, and the place of the
    /// centre of the shape along each of these.
    pub(crate) fn point_off_body(&mut self, number: usize) -> Result<Vec<(Expr<'g>, Expr<'g>)>, ModelError> {
        let contact = &self.document.contacts[number];
        let attitude = contact.attitude.as_ref().map(|attitude| &*attitude.value);
        let body = self.body_motion(&contact.body.value, attitude)?;
        let at = self.vector(contact.at.as_ref())?;
        let centre = sum(&body.place, &turned(&body.rotation, &at, |r, i, j| r[(i, j)], self.graph));
        let mut off = Vec::with_capacity(contact.along.len());
        for (number_off, &axis) in contact.along.iter().enumerate() {
            let value = self.contact(number, Contact::COMMON + number_off)?;
            off.push((value.unwrap_or(Expr::ZERO), centre[axis]));
        }
        Ok(off)
    }

    /// The components of a contact, in the order of their names.
    fn touching(&mut self, number: usize) -> Result<Vec<Expr<'g>>, ModelError> {
        let graph = self.graph;
        let dot = |a: &Vector<'g>, b: &Vector<'g>| graph.dot(a.iter().copied(), b.iter().copied());
        let contact = &self.document.contacts[number];
        let attitude = contact.attitude.as_ref().map(|attitude| &*attitude.value);
        let body = self.body_motion(&contact.body.value, attitude)?;
        let at = self.vector(contact.at.as_ref())?;
        let ground = self.ground(contact)?;
        let normal = ground.normal;
        let to_fixed = |v: &Vector<'g>| turned(&body.rotation, v, |r, i, j| r[(i, j)], graph);
        let to_body = |v: &Vector<'g>| turned(&body.rotation, v, |r, i, j| r[(j, i)], graph);
        let centre = sum(&body.place, &to_fixed(&at));
        // The support of the shape in the direction −n, and the arm from the centre to the point of contact.
        let (support, arm, along) = match &contact.shape {
            ContactShape::Sphere { radius } => {
                let radius = self.resolve(radius, Stage::Joint)?;
                let arm = normal.map(|n| -radius * n);
                let omega = to_fixed(&body.turning);
                let carried = to_fixed(&cross(&body.turning, &at));
                (radius, arm, sum(&carried, &cross(&omega, &arm)))
            }
            ContactShape::Disc { radius, axis } => {
                let radius = self.resolve(radius, Stage::Joint)?;
                let length = axis.iter().fold(0.0f64, |length, part| length.hypot(*part));
                let axle = axis.map(|part| Expr::from(part / length));
                let n = to_body(&normal);
                let lean = dot(&n, &axle);
                let across = [0, 1, 2].map(|i| n[i] - lean * axle[i]);
                let size = dot(&across, &across).sqrt();
                let arm = across.map(|part| -radius * part / size);
                (radius * size, to_fixed(&arm), to_fixed(&cross(&body.turning, &sum(&at, &arm))))
            }
            ContactShape::Ellipsoid { semi_axes } => {
                let squares = self.constants(semi_axes)?.map(Expr::square);
                let n = to_body(&normal);
                let scaled = [0, 1, 2].map(|i| squares[i] * n[i]);
                let size = dot(&scaled, &n).sqrt();
                let arm = scaled.map(|part| -part / size);
                (size, to_fixed(&arm), to_fixed(&cross(&body.turning, &sum(&at, &arm))))
            }
        };
        let velocity = sum(&body.velocity, &along);
        let mut point = sum(&centre, &arm);
        let from_ground = [0, 1, 2].map(|i| centre[i] - ground.through[i]);
        let gap = dot(&normal, &from_ground) - support;
        let beside = |&axis: &usize| {
            let across = point[axis] - ground.through[axis];
            across + ground.slopes[axis] * (point[2] - ground.through[2])
        };
        let off: Vec<Expr<'g>> = contact.along.iter().map(beside).collect();
        contact.along.iter().for_each(|&axis| point[axis] = ground.through[axis]);
        if contact.height.is_some() {
            point[2] = ground.through[2];
        }
        let [first, second] = tangents(contact.first_tangent(), &normal);
        let slips = [dot(&first, &velocity), dot(&second, &velocity)];
        Ok(point.into_iter().chain([gap]).chain(slips).chain(off).collect())
    }

    /// The plane of a contact, or the tangent plane of its ground.
    fn ground(&mut self, contact: &'d Contact) -> Result<Ground<'g>, ModelError> {
        let Some(height) = &contact.height else {
            let through = self.vector(contact.through.as_ref())?;
            let normal = match &contact.normal {
                None => [Expr::ZERO, Expr::ZERO, Expr::ONE],
                Some(normal) => self.unit(normal)?,
            };
            return Ok(Ground { through, normal, slopes: [Expr::ZERO; 2] });
        };
        let coordinates: Vec<(&'d str, Expr<'g>)> =
            contact.coordinates().map(|name| (name.text.as_str(), self.graph.symbol(&name.text))).collect();
        let outer = std::mem::replace(&mut self.arguments, coordinates.clone());
        let value = self.resolve(height, Stage::Height);
        self.arguments = outer;
        let mut through = [Expr::ZERO, Expr::ZERO, value?];
        let mut slopes = [Expr::ZERO; 2];
        for (&axis, (_, coordinate)) in contact.along.iter().zip(coordinates) {
            through[axis] = coordinate;
            slopes[axis] = self.graph.gradient(through[2], &[coordinate])[0];
        }
        let upwards = [-slopes[0], -slopes[1], Expr::ONE];
        let length = self.graph.dot(upwards, upwards).sqrt();
        Ok(Ground { through, normal: upwards.map(|part| part / length), slopes })
    }

    fn vector(&mut self, list: Option<&[Expression; 3]>) -> Result<Vector<'g>, ModelError> {
        list.map_or(Ok([Expr::ZERO; 3]), |list| self.constants(list))
    }

    /// The unit vector in the direction of a normal.
    fn unit(&mut self, normal: &[Expression; 3]) -> Result<Vector<'g>, ModelError> {
        let value = self.constants(normal)?;
        let length = self.graph.dot(value, value).sqrt();
        if length.is_zero() {
            return Err(self.error(&normal[0], normal[0].ast.span, |_| MeaningError::ZeroAxis));
        }
        Ok(value.map(|part| part / length))
    }

    /// The bodies on joints, without their masses.
    pub(super) fn kinematic_tree(&mut self) -> Result<Tree<'g>, ModelError> {
        let document = self.document;
        let mut bodies = Vec::with_capacity(document.tree.len());
        for body in &document.tree {
            bodies.push(hung(body, self.joint(&body.joint)?));
        }
        Tree::new(self.graph, bodies).map_err(|error| document.derivation_error(error))
    }

    /// The coordinates with their velocities x', and time with its rate.
    pub(super) fn rates(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.coordinates().into_iter().zip(self.velocities()).chain(self.graph.in_time(self.time)).collect()
    }
}

/// Two unit vectors along the plane: the projection of a fixed axis, and n × this.
fn tangents<'g>(axis: usize, normal: &Vector<'g>) -> [Vector<'g>; 2] {
    let share = normal[axis];
    let size = (Expr::ONE - share.square()).sqrt();
    let own = |i: usize| if i == axis { Expr::ONE } else { Expr::ZERO };
    let first = [0, 1, 2].map(|i| (own(i) - share * normal[i]) / size);
    [first, cross(normal, &first)]
}

fn sum<'g>(a: &Vector<'g>, b: &Vector<'g>) -> Vector<'g> {
    [0, 1, 2].map(|i| a[i] + b[i])
}

fn cross<'g>(a: &Vector<'g>, b: &Vector<'g>) -> Vector<'g> {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}
