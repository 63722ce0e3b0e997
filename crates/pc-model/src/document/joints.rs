//! Bodies attached to other bodies by joints, as written.

use crate::diagnostics::source::Place;
use crate::document::expression::{Expression, Located, Name};
use crate::document::inertia::Inertia;

/// The name that stands for the fixed axes where a body is expected.
pub const WORLD: &str = "world";

/// A body attached to another, or to the world, by a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct TreeBody {
    /// Its label, which lies outside the namespace of the model.
    pub name: Name,
    /// The section's header.
    pub place: Place,
    /// The body to which it is attached; the world if left out.
    pub parent: Option<Located<String>>,
    /// The joint by which it is attached.
    pub joint: Joint,
    /// Its mass; 0 if left out.
    pub mass: Option<Expression>,
    /// The position of the mass centre relative to the joint, in body axes; the joint itself if left out.
    pub center: Option<[Expression; 3]>,
    /// The inertia about the mass centre, in body axes.
    pub inertia: Option<Inertia>,
    /// The force at the mass centre, in components along fixed axes.
    pub force: Option<[Expression; 3]>,
    /// The torque, in components along body axes.
    pub torque: Option<[Expression; 3]>,
}

impl TreeBody {
    /// The body to which it is attached; none for the world.
    pub fn parent(&self) -> Option<&str> {
        self.parent.as_ref().map(|parent| parent.value.as_str()).filter(|parent| *parent != WORLD)
    }
}

/// A joint: how a body moves relative to the one to which it is attached.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The joint's place in the file.
    pub place: Place,
    /// Its kind.
    pub kind: JointKind,
    /// The directions that this kind of joint has, in the joint's axes; vectors of any length but 0.
    pub axes: Vec<[f64; 3]>,
    /// The advance of a screw joint per radian.
    pub pitch: Option<Expression>,
    /// The position of the joint relative to the origin of the body that carries it, in the axes of that
    /// body; the origin if left out.
    pub at: Option<[Expression; 3]>,
    /// The rotation from the joint's axes to those of the body that carries it; `None` if the axes are
    /// parallel.
    pub rotation: Option<JointRotation>,
    /// The names of its coordinates.
    pub coordinates: Vec<Name>,
    /// The names of its quasi-velocities, where `x'` is the velocity of the coordinate `x`.
    pub quasi_velocities: Vec<Name>,
    /// The joint whose motion it repeats, for a joint without coordinates of its own.
    pub follows: Option<Following>,
    /// What acts on its coordinate, for a joint that has exactly one.
    pub drive: Drive,
}

/// The rotor, spring, damper, dry friction and stops of a joint with the coordinate x.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drive {
    /// The inertia J of ½ J x'².
    pub armature: Option<Expression>,
    /// The stiffness k of ½ k (x − x_0)².
    pub stiffness: Option<Expression>,
    /// x_0; 0 if left out.
    pub rest: Option<Expression>,
    /// The coefficient d of the force −d x'.
    pub damping: Option<Expression>,
    /// The size F of the force −F sign x'.
    pub friction: Option<Expression>,
    /// The force F_s ≥ F up to which friction holds at rest; F if left out.
    pub stiction: Option<Expression>,
    /// The ends of the way of x, at which there are stops.
    pub limits: Option<[Expression; 2]>,
    /// The coefficient e of restitution of rigid stops: at an end x' becomes −e x'.
    pub restitution: Option<Expression>,
    /// The stiffness k of the stops: beyond an end by s, they push back with k s + d s'.
    pub stop_stiffness: Option<Expression>,
    /// d; 0 if left out.
    pub stop_damping: Option<Expression>,
}

/// How a joint with one coordinate is geared to that of another body: x = ratio · x of the other + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct Following {
    /// The body whose joint it follows.
    pub body: Located<String>,
    /// The ratio; 1 if left out.
    pub ratio: Option<Expression>,
    /// The offset; 0 if left out.
    pub offset: Option<Expression>,
    /// The name of x, which is a definition and an output.
    pub name: Name,
}

impl Joint {
    /// Whether each quasi-velocity is the velocity of the coordinate at the same position in its list.
    pub fn is_plain(&self) -> bool {
        self.kind.is_of_velocities()
            && self.coordinates.iter().zip(&self.quasi_velocities).all(|(x, eta)| eta.text == prime(&x.text))
    }
}

/// `x'`
pub(crate) fn prime(coordinate: &str) -> String {
    format!("{coordinate}'")
}

/// The kinds of joints, described by the motions that they allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Nothing.
    Fixed,
    /// A rotation about an axis.
    Revolute,
    /// A translation along an axis.
    Prismatic,
    /// A rotation about an axis with an advance along the same axis.
    Screw,
    /// A translation along an axis and a rotation about the same axis.
    Cylindrical,
    /// Rotations about an axis of one body and an axis of the other.
    Universal,
    /// Translations perpendicular to a normal and a rotation about the normal.
    Planar,
    /// All rotations.
    Spherical,
    /// All motions.
    Free,
}

impl JointKind {
    /// The kinds, each with its word in the text.
    pub(crate) const ALL: &'static [(&'static str, JointKind)] = &[
        ("fixed", JointKind::Fixed),
        ("revolute", JointKind::Revolute),
        ("prismatic", JointKind::Prismatic),
        ("screw", JointKind::Screw),
        ("cylindrical", JointKind::Cylindrical),
        ("universal", JointKind::Universal),
        ("planar", JointKind::Planar),
        ("spherical", JointKind::Spherical),
        ("free", JointKind::Free),
    ];

    /// Its word.
    pub(crate) fn word(self) -> &'static str {
        Self::ALL.iter().find(|(_, kind)| *kind == self).map_or("", |(word, _)| word)
    }

    /// Whether it has exactly one coordinate.
    pub fn is_single(self) -> bool {
        matches!(self, JointKind::Revolute | JointKind::Prismatic | JointKind::Screw)
    }

    /// The number of axes that this kind of joint has.
    pub fn axes(self) -> usize {
        match self {
            JointKind::Fixed | JointKind::Spherical | JointKind::Free => 0,
            JointKind::Universal => 2,
            _ => 1,
        }
    }

    /// The names of the coordinates of a joint called `name` with these axes.
    pub(crate) fn coordinates(self, name: &str, axes: &[[f64; 3]]) -> Vec<String> {
        let ends: &[&str] = match self {
            JointKind::Fixed => &[],
            JointKind::Revolute | JointKind::Prismatic | JointKind::Screw => &[""],
            JointKind::Cylindrical => &["_z", "_φ"],
            JointKind::Universal => &["_1", "_2"],
            JointKind::Planar => match axes {
                [[x, ..]] if *x != 0.0 => &["_y", "_z", "_φ"],
                [[_, y, _]] if *y != 0.0 => &["_z", "_x", "_φ"],
                _ => &["_x", "_y", "_φ"],
            },
            JointKind::Spherical => &["_q0", "_q1", "_q2", "_q3"],
            JointKind::Free => &["_x", "_y", "_z", "_q0", "_q1", "_q2", "_q3"],
        };
        ends.iter().map(|end| format!("{name}{end}")).collect()
    }

    /// The names of the quasi-velocities of a joint called `name` whose coordinates are called `coordinates`.
    pub(crate) fn quasi_velocities(self, name: &str, coordinates: &[String]) -> Vec<String> {
        let ends: &[&str] = match self {
            JointKind::Spherical => &["_ω1", "_ω2", "_ω3"],
            JointKind::Free => &["_v1", "_v2", "_v3", "_ω1", "_ω2", "_ω3"],
            _ => return coordinates.iter().map(|x| prime(x)).collect(),
        };
        ends.iter().map(|end| format!("{name}{end}")).collect()
    }

    /// The index, among the joint's coordinates, of the first component of its quaternion, if it has a
    /// quaternion.
    pub fn quaternion(self) -> Option<usize> {
        match self {
            JointKind::Spherical => Some(0),
            JointKind::Free => Some(3),
            _ => None,
        }
    }

    /// Whether its quasi-velocities are the velocities of its coordinates.
    pub fn is_of_velocities(self) -> bool {
        self.quaternion().is_none()
    }
}

/// A constant rotation.
#[derive(Clone, Debug, PartialEq)]
pub enum JointRotation {
    /// The rows of the matrix.
    Matrix(Box<[Expression; 9]>),
    /// Successive rotations about axes 0 to 2, each about an axis as turned by the preceding rotations.
    Turns(Vec<(usize, Expression)>),
}

/// A point of a body; its position and the orientation of the body there have names.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Its label.
    pub name: Name,
    /// The body to which it belongs.
    pub body: Located<String>,
    /// Its position in body axes, relative to the origin of the body; this origin if left out.
    pub at: Option<[Expression; 3]>,
    /// `NAME_x` to `NAME_z`, its position along fixed axes, then `NAME_11` to `NAME_33`, the rotation matrix
    /// of its body, row by row.
    pub components: Vec<Name>,
}

impl Point {
    const ENDS: [&'static str; 12] = ["x", "y", "z", "11", "12", "13", "21", "22", "23", "31", "32", "33"];

    pub(super) fn new(name: Name, body: Located<String>, at: Option<[Expression; 3]>) -> Point {
        let component = |end| Name { text: format!("{}_{end}", name.text), place: name.place.clone() };
        Point { components: Self::ENDS.map(component).to_vec(), name, body, at }
    }

    /// The body to which it belongs; none for the world.
    pub fn body(&self) -> Option<&str> {
        Some(self.body.value.as_str()).filter(|body| *body != WORLD)
    }

    /// The index of the component with this name.
    pub fn component(&self, name: &str) -> Option<usize> {
        self.components.iter().position(|component| component.text == name)
    }
}
