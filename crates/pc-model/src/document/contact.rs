//! Contacts of bodies with a fixed plane: a disc, a sphere or an ellipsoid that rolls or slides on it.

use pc_expr::parse::AstKind;

use crate::document::expression::{Expression, Located, Name};

/// A contact of a body with a fixed plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Its name.
    pub name: Name,
    /// The body that touches the plane.
    pub body: Located<String>,
    /// The part of the surface of the body that may touch the plane.
    pub shape: ContactShape,
    /// The centre of the shape, in body axes, relative to the origin of a body with a joint or to the `position` of
    /// another body; that point if left out.
    pub at: Option<[Expression; 3]>,
    /// The rotation from the axes of the angular velocity of a body to the fixed axes, row by row.
    pub attitude: Option<Located<Box<[Expression; 9]>>>,
    /// Whether the body rolls; otherwise it slides.
    pub rolls: bool,
    /// The direction out of the plane towards the body, a vector of any length but 0; upwards if left out.
    pub normal: Option<[Expression; 3]>,
    /// A point of the plane; the origin of the fixed axes if left out.
    pub through: Option<[Expression; 3]>,
    /// Whether the contact also pulls, so that it never ends.
    pub keeps: bool,
    /// `NAME_x` to `NAME_z`, the point of contact along fixed axes; `NAME_gap`, the distance from the plane; and
    /// `NAME_slip_1`, `NAME_slip_2`, the velocity along the plane of the material point of the body there.
    pub components: Vec<Name>,
}

/// A convex shape that touches a plane in one point.
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
    pub(super) const ENDS: [&'static str; 6] = ["x", "y", "z", "gap", "slip_1", "slip_2"];
    /// The index of the gap among the components; the velocities of slip follow it.
    pub(crate) const GAP: usize = 3;

    /// The index of the component with this name.
    pub fn component(&self, name: &str) -> Option<usize> {
        self.components.iter().position(|component| component.text == name)
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

    /// The fixed axis along whose projection onto the plane the first tangent points: the first, unless the normal is
    /// written as parallel to it.
    pub fn first_tangent(&self) -> usize {
        let is_zero = |part: &Expression| matches!(part.ast.kind, AstKind::Number(0.0));
        let along_first = self.normal.as_ref().is_some_and(|[_, y, z]| is_zero(y) && is_zero(z));
        usize::from(along_first)
    }
}
