//! Contacts of bodies with a fixed ground, plane or uneven: a disc, a sphere or an ellipsoid that rolls or slides on it.

use pc_expr::parse::AstKind;

use crate::document::expression::{Expression, Located, Name};

/// A contact of a body with a fixed ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Its name.
    pub name: Name,
    /// The body that touches the ground.
    pub body: Located<String>,
    /// The part of the surface of the body that may touch the ground.
    pub shape: ContactShape,
    /// The centre of the shape, in body axes, relative to the origin of a body with a joint or to the `position` of
    /// another body; that point if left out.
    pub at: Option<[Expression; 3]>,
    /// The rotation from the axes of the angular velocity of a body to the fixed axes, row by row.
    pub attitude: Option<Located<Box<[Expression; 9]>>>,
    /// Whether the body rolls; otherwise it slides.
    pub rolls: bool,
    /// The dry friction of a body that slides.
    pub friction: Option<ContactFriction>,
    /// The direction out of the plane towards the body, a vector of any length but 0; upwards if left out.
    pub normal: Option<[Expression; 3]>,
    /// A point of the plane; the origin of the fixed axes if left out.
    pub through: Option<[Expression; 3]>,
    /// The height of an uneven ground, in terms of `NAME_x` and `NAME_y`; it takes the place of a plane.
    pub height: Option<Expression>,
    /// The fixed axes, 0 and 1, along which the height changes. The point of contact has a coordinate along each of
    /// them, `NAME_x` or `NAME_y`.
    pub along: Vec<usize>,
    /// Those of them whose coordinates have no start value in the text: it is found from the place of the body.
    pub found: Vec<usize>,
    /// Whether the contact also pulls, so that it never ends.
    pub keeps: bool,
    /// `NAME_x` to `NAME_z`, the point of contact along fixed axes; `NAME_gap`, the distance from the ground;
    /// `NAME_slip_1`, `NAME_slip_2`, the velocity along the ground of the material point of the body there; and on uneven
    /// ground `NAME_off_x`, `NAME_off_y`, how far that point is beside the normal, for each coordinate of the point.
    pub components: Vec<Name>,
}

/// Dry friction, −μ N s/|s| for the velocity s of slip.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactFriction {
    /// The coefficient μ.
    pub coefficient: Expression,
    /// The velocity c of a smooth friction −μ N s/√(s² + c²).
    pub creep: Option<Expression>,
}

/// A convex shape that touches the ground in one point.
#[derive(Clone, Debug, PartialEq)]
pub enum ContactShape {
    /// The edge of a disc.
    Disc {
        /// Its radius.
        radius: Expression,
        /// The direction of its axle in body axes, a vector of any length but 0.
        axis: [f64; 3],
    },
    /// A sphere.
    Sphere {
        /// Its radius.
        radius: Expression,
    },
    /// An ellipsoid, whose axes are those of the body.
    Ellipsoid {
        /// The halves of its axes.
        semi_axes: Box<[Expression; 3]>,
    },
}

impl Contact {
    const ENDS: [&'static str; 6] = ["x", "y", "z", "gap", "slip_1", "slip_2"];
    /// The number of components that contacts with a plane have, too.
    pub(crate) const COMMON: usize = Contact::ENDS.len();
    /// The index of the gap among the components; the velocities of slip follow it.
    pub(crate) const GAP: usize = 3;
    /// The indices of the velocities of slip among the components.
    pub(crate) const SLIPS: [usize; 2] = [4, 5];

    /// The ends of the names of its components, for a ground whose height changes along these axes.
    pub(super) fn ends(along: &[usize]) -> impl Iterator<Item = &'static str> {
        Contact::ENDS.into_iter().chain(along.iter().map(|&axis| ["off_x", "off_y"][axis.min(1)]))
    }

    /// The index of the component with this name; none for a coordinate of the point of contact.
    pub fn component(&self, name: &str) -> Option<usize> {
        let component = self.components.iter().position(|component| component.text == name);
        component.filter(|number| !self.along.contains(number))
    }

    /// The names of the coordinates of the point of contact.
    pub fn coordinates(&self) -> impl Iterator<Item = &Name> {
        self.along.iter().filter_map(|&axis| self.components.get(axis))
    }

    /// The names of those of them whose start values are found from the place of the body.
    pub(crate) fn found_coordinates(&self) -> impl Iterator<Item = &Name> {
        self.found.iter().filter_map(|&axis| self.components.get(axis))
    }

    /// The names of its reactions, each with the name of its constraint: the normal force, then for a body that rolls
    /// the forces of friction along the two tangents.
    pub fn reactions(&self) -> Vec<(String, String)> {
        let name = &self.name.text;
        let mut reactions = vec![(format!("N_{name}"), name.clone())];
        if self.rolls {
            reactions.extend([1, 2].map(|i| (format!("T_{name}_{i}"), format!("{name}_{i}"))));
        }
        reactions
    }

    /// Whether dry friction holds the body, which then rolls.
    pub(crate) fn sticks(&self) -> bool {
        self.friction.as_ref().is_some_and(|friction| friction.creep.is_none())
    }

    /// The names of the forces of dry friction along the two tangents.
    pub fn friction_forces(&self) -> Vec<String> {
        let tangents = if self.friction.is_some() { &[1, 2][..] } else { &[] };
        tangents.iter().map(|i| format!("T_{}_{i}", self.name.text)).collect()
    }

    /// The fixed axis along whose projection onto the plane the first tangent points: the first, unless the normal is
    /// written as parallel to it.
    pub fn first_tangent(&self) -> usize {
        let is_zero = |part: &Expression| matches!(part.ast.kind, AstKind::Number(0.0));
        let along_first = self.normal.as_ref().is_some_and(|[_, y, z]| is_zero(y) && is_zero(z));
        usize::from(along_first)
    }
}
