//! The names that links and joints have in a model.

use std::collections::{HashMap, HashSet};

use pc_expr::parse::{FUNCTIONS, is_name};

use crate::import::massless::Order;
use crate::import::robot::{Actuator, Joint, Kind, Robot, WORLD};

/// The endings of the names of a body's coordinates and velocities, if its joint has several coordinates. A planar joint
/// slides along the two axes that follow its normal.
fn endings(kind: Kind, axis: [f64; 3]) -> (&'static [&'static str], &'static [&'static str]) {
    match kind {
        Kind::Planar if axis[0] != 0.0 => (&["y", "z", "φ"], &["y'", "z'", "φ'"]),
        Kind::Planar if axis[1] != 0.0 => (&["z", "x", "φ"], &["z'", "x'", "φ'"]),
        Kind::Planar => (&["x", "y", "φ"], &["x'", "y'", "φ'"]),
        Kind::Universal => (&["1", "2"], &["1'", "2'"]),
        Kind::Spherical => (&["q0", "q1", "q2", "q3"], &["ω1", "ω2", "ω3"]),
        Kind::Floating => (&["x", "y", "z", "q0", "q1", "q2", "q3"], &["v1", "v2", "v3", "ω1", "ω2", "ω3"]),
        Kind::Fixed | Kind::Revolute | Kind::Continuous | Kind::Prismatic | Kind::Screw => (&[], &[]),
    }
}

/// The endings of the names of the components of a point.
const POINT: [&str; 12] = ["x", "y", "z", "11", "12", "13", "21", "22", "23", "31", "32", "33"];

/// The names in the model of a robot: those of its links and joints, changed if they are invalid or taken.
pub(crate) struct Names<'a> {
    /// The names of the bodies of links.
    bodies: HashMap<&'a str, String>,
    /// The names of the coordinates, for joints that have exactly one coordinate.
    coordinates: HashMap<&'a str, String>,
    /// The names of the parameters of joints, by joint and quantity.
    parameters: HashMap<(String, &'static str), String>,
    /// The names of the controls of actuators.
    inputs: HashMap<&'a str, String>,
    /// The names of the loops.
    closures: Vec<String>,
}

impl<'a> Names<'a> {
    /// The names for links, each with the joint by which it is attached; the first link is the root.
    pub(crate) fn of(robot: &'a Robot, order: &Order<'a>) -> Names<'a> {
        let mut taken: HashSet<String> =
            HashSet::from(["world", "t", "pi", "energy", "g"].map(str::to_owned));
        taken.extend(FUNCTIONS.iter().map(|function| function.name.to_owned()));
        let joints = || order.iter().filter_map(|(_, joint)| *joint);
        let mut coordinates = HashMap::new();
        for joint in joints().filter(|joint| joint.kind.is_single()) {
            coordinates.insert(joint.name.as_str(), unused(&joint.name, &[], &mut [&mut taken]));
        }
        // The names of bodies are labels, but those of joints with several coordinates begin the names of
        // these.
        let mut bodies = HashMap::new();
        let mut labels: HashSet<String> = HashSet::from(["world".to_owned()]);
        for (place, (link, joint)) in order.iter().enumerate() {
            if link.is_world {
                bodies.insert(link.name.as_str(), WORLD.to_owned());
                continue;
            }
            let (kind, axis) = match joint {
                _ if place == 0 => (Kind::Floating, [0.0; 3]),
                Some(joint) => (joint.kind, joint.axis),
                None => (Kind::Fixed, [0.0; 3]),
            };
            let (coordinates, velocities) = endings(kind, axis);
            let label = match coordinates {
                [] => unused(&link.name, &[], &mut [&mut labels]),
                _ => unused(&link.name, &[coordinates, velocities].concat(), &mut [&mut labels, &mut taken]),
            };
            bodies.insert(link.name.as_str(), label);
        }
        let mut names = Names {
            bodies,
            coordinates,
            parameters: HashMap::new(),
            inputs: HashMap::new(),
            closures: Vec::new(),
        };
        for joint in joints() {
            let moves = names.coordinate(joint).unwrap_or_else(|| names.body(&joint.child)).to_owned();
            for (quantity, _) in joint.quantities() {
                let name = unused(&format!("{moves}_{quantity}"), &[], &mut [&mut taken]);
                names.parameters.insert((joint.name.clone(), quantity), name);
            }
        }
        for actuator in &robot.actuators {
            let name = unused(&actuator.name, &[], &mut [&mut taken]);
            names.inputs.insert(&actuator.name, name);
        }
        for closure in &robot.loops {
            // A loop declares the components of two points.
            let ends = ["a", "b"]
                .iter()
                .flat_map(|end| POINT.iter().map(move |component| format!("{end}_{component}")));
            let ends: Vec<String> = ends.collect();
            let ends: Vec<&str> = ends.iter().map(String::as_str).collect();
            names.closures.push(unused(&closure.name, &ends, &mut [&mut taken]));
        }
        names
    }

    /// The name of the body of a link.
    pub(crate) fn body(&self, link: &str) -> &str {
        &self.bodies[link]
    }

    /// The name of the coordinate of a joint, if it has exactly one.
    pub(crate) fn coordinate(&self, joint: &Joint) -> Option<&str> {
        self.coordinates.get(joint.name.as_str()).map(String::as_str)
    }

    /// The name of the parameter of a joint for a quantity, if the joint has such a parameter.
    pub(crate) fn parameter(&self, joint: &Joint, quantity: &'static str) -> Option<&str> {
        self.parameters.get(&(joint.name.clone(), quantity)).map(String::as_str)
    }

    /// The name of the control of an actuator.
    pub(crate) fn input(&self, actuator: &Actuator) -> &str {
        &self.inputs[actuator.name.as_str()]
    }

    /// The name of a loop, by its place in the robot.
    pub(crate) fn closure(&self, place: usize) -> &str {
        &self.closures[place]
    }

    /// The names of the velocities of a joint.
    pub(crate) fn velocities(&self, joint: &Joint) -> Vec<String> {
        match self.coordinate(joint) {
            Some(x) => vec![format!("{x}'")],
            None => {
                let body = self.body(&joint.child);
                let (_, velocities) = endings(joint.kind, joint.axis);
                velocities.iter().map(|velocity| format!("{body}_{velocity}")).collect()
            }
        }
    }
}

/// The name with invalid characters replaced, and extended if it, or a name `NAME_ENDING` formed from it, is
/// in one of the sets of taken names, to which these names are then added.
fn unused(name: &str, endings: &[&str], taken: &mut [&mut HashSet<String>]) -> String {
    let mut own: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if !is_name(&own) {
        own.insert(0, '_');
        own.truncate(200); // a name has at most 255 bytes
    }
    let all = |own: &str| -> Vec<String> {
        let longer = endings.iter().map(|ending| format!("{own}_{ending}"));
        std::iter::once(own.to_owned()).chain(longer).collect()
    };
    while all(&own).iter().any(|name| taken.iter().any(|taken| taken.contains(name))) {
        own.push('_');
    }
    taken.iter_mut().for_each(|taken| taken.extend(all(&own)));
    own
}
