//! The contents of a file that describes a robot.

use std::ops::Range;

pub(crate) use crate::import::pose::Pose;

/// A robot: links, and joints between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Robot {
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    /// Kinds of elements that a model cannot contain, each with the number of times that it occurs.
    pub(crate) left_out: Vec<(String, usize)>,
}

/// A link: a body.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    pub(crate) inertial: Option<Inertial>,
    /// The files of the link's meshes.
    pub(crate) meshes: Vec<String>,
}

/// The mass, mass centre and inertia of a link.
#[derive(Clone, Debug)]
pub(crate) struct Inertial {
    pub(crate) origin: Pose,
    pub(crate) mass: f64,
    /// Ixx, Iyy, Izz, Ixy, Iyz, Ixz along the axes of `origin`.
    pub(crate) inertia: [f64; 6],
}

/// A joint.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    pub(crate) kind: Kind,
    pub(crate) parent: String,
    pub(crate) child: String,
    pub(crate) origin: Pose,
    pub(crate) axis: [f64; 3],
    /// The second axis of a universal joint, which the first one turns.
    pub(crate) second_axis: [f64; 3],
    pub(crate) limits: Vec<(&'static str, f64)>,
    pub(crate) damping: f64,
    pub(crate) friction: f64,
    pub(crate) mimic: Option<Mimic>,
    /// An inertia in the direction of each velocity, such as that of a geared rotor.
    pub(crate) armature: f64,
    /// What was changed about it.
    pub(crate) remarks: Vec<String>,
}

/// The kind of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
    Floating,
    Planar,
    Spherical,
    Universal,
}

impl Kind {
    /// The kinds, each with its name in URDF.
    pub(crate) const ALL: [(&'static str, Kind); 8] = [
        ("fixed", Kind::Fixed),
        ("revolute", Kind::Revolute),
        ("continuous", Kind::Continuous),
        ("prismatic", Kind::Prismatic),
        ("floating", Kind::Floating),
        ("planar", Kind::Planar),
        ("spherical", Kind::Spherical),
        ("universal", Kind::Universal),
    ];

    /// Its name in URDF.
    pub(crate) fn word(self) -> &'static str {
        Kind::ALL.iter().find(|(_, kind)| *kind == self).map_or("free", |(word, _)| word)
    }

    /// Whether it moves along or about an axis.
    pub(crate) fn has_axis(self) -> bool {
        !matches!(self, Kind::Fixed | Kind::Floating | Kind::Spherical)
    }

    /// Whether the joint has exactly one coordinate.
    pub(crate) fn is_single(self) -> bool {
        matches!(self, Kind::Revolute | Kind::Continuous | Kind::Prismatic)
    }
}

/// The dependence of a joint on another one: x = multiplier · other + offset.
#[derive(Clone, Debug)]
pub(crate) struct Mimic {
    pub(crate) joint: String,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}
