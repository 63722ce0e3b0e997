//! The contents of a file that describes a robot.

use std::ops::Range;

pub(crate) use crate::import::meshes::Visual;
pub(crate) use crate::import::pose::Pose;

/// A robot: links, and joints between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Robot {
    /// The name of the format of its file.
    pub(crate) format: &'static str,
    pub(crate) name: String,
    pub(crate) links: Vec<Link>,
    pub(crate) joints: Vec<Joint>,
    /// Kinds of elements that a model cannot contain, each with the number of times that it occurs.
    pub(crate) left_out: Vec<(String, usize)>,
    /// Further notes on what was left out.
    pub(crate) notes: Vec<String>,
    /// The acceleration of gravity, if the file gives it.
    pub(crate) gravity: Option<[f64; 3]>,
    pub(crate) actuators: Vec<Actuator>,
    pub(crate) couplings: Vec<Coupling>,
    pub(crate) loops: Vec<Closure>,
}

impl Robot {
    /// The joint of this name.
    pub(crate) fn joint(&self, name: &str) -> Option<&Joint> {
        self.joints.iter().find(|joint| joint.name == name)
    }

    /// Rounds all poses to fifteen digits, which leaves out the rounding errors of frames that were put
    /// together.
    pub(crate) fn tidy(&mut self) {
        self.joints.iter_mut().for_each(|joint| joint.origin = joint.origin.tidied());
        self.loops.iter_mut().for_each(|closure| closure.places = closure.places.map(|place| place.tidied()));
        let inertials = self.links.iter_mut().filter_map(|link| link.inertial.as_mut());
        inertials.for_each(|inertial| inertial.origin = inertial.origin.tidied());
    }

    /// Counts an element that a model cannot contain.
    pub(crate) fn leave_out(&mut self, element: &str) {
        match self.left_out.iter_mut().find(|(name, _)| name == element) {
            Some((_, count)) => *count += 1,
            None => self.left_out.push((element.to_owned(), 1)),
        }
    }
}

/// The name of the link that stands for the fixed axes.
pub(crate) const WORLD: &str = "world";

/// A link: a body.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    pub(crate) inertial: Option<Inertial>,
    /// The files of the link's meshes.
    pub(crate) meshes: Vec<String>,
    /// The meshes with which it is drawn.
    pub(crate) visuals: Vec<Visual>,
    /// Whether it stands for the fixed axes.
    pub(crate) is_world: bool,
}

impl Link {
    /// A link without mass.
    pub(crate) fn empty(name: &str, span: Range<usize>) -> Link {
        Link {
            name: name.to_owned(),
            span,
            inertial: None,
            meshes: Vec::new(),
            visuals: Vec::new(),
            is_world: false,
        }
    }

    /// The fixed axes.
    pub(crate) fn world() -> Link {
        Link { is_world: true, ..Link::empty(WORLD, 0..0) }
    }
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
#[derive(Clone, Debug, Default)]
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
    /// The advance of a screw per radian.
    pub(crate) pitch: f64,
    pub(crate) limits: Vec<(&'static str, f64)>,
    pub(crate) damping: f64,
    pub(crate) friction: f64,
    pub(crate) mimic: Option<Mimic>,
    /// An inertia in the direction of each velocity, such as that of a geared rotor.
    pub(crate) armature: f64,
    /// The stiffness of its spring, which is relaxed at the coordinate `rest`.
    pub(crate) stiffness: f64,
    pub(crate) rest: f64,
    /// The coordinate of the file where that of the model vanishes.
    pub(crate) reference: f64,
    /// What was changed about it.
    pub(crate) remarks: Vec<String>,
}

/// The quantities that only joints with one coordinate have.
const OF_SINGLE: [&str; 2] = ["friction", "stiffness"];

impl Joint {
    /// The quantities that become parameters, each with its value.
    pub(crate) fn quantities(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [
            ("damping", self.damping),
            ("friction", self.friction),
            ("stiffness", self.stiffness),
            ("armature", self.armature),
        ];
        let (moves, is_single) = (self.kind != Kind::Fixed, self.kind.is_single());
        all.into_iter()
            .filter(move |(name, value)| *value != 0.0 && moves && (is_single || !OF_SINGLE.contains(name)))
    }
}

/// The kind of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Kind {
    #[default]
    Fixed,
    Revolute,
    Continuous,
    Prismatic,
    Floating,
    Planar,
    Spherical,
    Universal,
    Screw,
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
        Kind::ALL.iter().find(|(_, kind)| *kind == self).map_or("screw", |(word, _)| word)
    }

    /// Whether it moves along or about an axis.
    pub(crate) fn has_axis(self) -> bool {
        !matches!(self, Kind::Fixed | Kind::Floating | Kind::Spherical)
    }

    /// Whether the joint has exactly one coordinate.
    pub(crate) fn is_single(self) -> bool {
        matches!(self, Kind::Revolute | Kind::Continuous | Kind::Prismatic | Kind::Screw)
    }
}

/// The dependence of a joint on another one: x = multiplier · other + offset.
#[derive(Clone, Debug)]
pub(crate) struct Mimic {
    pub(crate) joint: String,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}

/// An actuator, whose force on a joint is gain u + constant + coordinate x + velocity x', where u is its
/// control.
#[derive(Clone, Debug)]
pub(crate) struct Actuator {
    pub(crate) name: String,
    pub(crate) joint: String,
    pub(crate) gain: f64,
    pub(crate) constant: f64,
    pub(crate) coordinate: f64,
    pub(crate) velocity: f64,
}

/// A constraint x = a_0 + a_1 y + a_2 y² + … between the coordinates of two joints, or x = a_0.
#[derive(Clone, Debug)]
pub(crate) struct Coupling {
    pub(crate) joint: String,
    pub(crate) other: Option<String>,
    pub(crate) coefficients: [f64; 5],
}

/// A joint between two links that hang on the root already.
#[derive(Clone, Debug)]
pub(crate) struct Closure {
    pub(crate) name: String,
    pub(crate) kind: Closing,
    pub(crate) links: [String; 2],
    /// Where it is in each link.
    pub(crate) places: [Pose; 2],
}

/// What a closure holds together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Closing {
    /// Two points.
    Point,
    /// Two points, and an axis of both places.
    Revolute([f64; 3]),
    /// Both places with all their axes.
    Weld,
}
