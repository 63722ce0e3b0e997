//! The names that links and joints have in a model.

use std::collections::{HashMap, HashSet};

use pc_expr::parse::{FUNCTIONS, is_name};

use crate::import::robot::{Joint, Kind, Link};

/// The suffixes of the names of a body's coordinates and velocities, if its joint has several coordinates.
const PLANAR: [&str; 3] = ["x'", "y'", "φ'"];
const FLOATING: [&str; 6] = ["v1", "v2", "v3", "ω1", "ω2", "ω3"];
const OF_COORDINATES: [&str; 8] = ["x", "y", "z", "φ", "q0", "q1", "q2", "q3"];

/// The names in the model of a robot: those of its links and joints, changed if they are invalid or taken.
pub(crate) struct Names<'a> {
    /// The names of the bodies of links.
    bodies: HashMap<&'a str, String>,
    /// The names of the coordinates, for joints that have exactly one coordinate.
    coordinates: HashMap<&'a str, String>,
    /// The names of the damping parameters, for the joints that have such a parameter.
    dampings: HashMap<&'a str, String>,
}

impl<'a> Names<'a> {
    /// The names for links, each with the joint by which it is attached; the first link is the root.
    pub(crate) fn of(order: &[(&'a Link, Option<&'a Joint>)]) -> Names<'a> {
        let mut taken: HashSet<String> =
            HashSet::from(["world", "t", "pi", "energy", "g"].map(str::to_owned));
        taken.extend(FUNCTIONS.iter().map(|function| function.name.to_owned()));
        let joints = || order.iter().filter_map(|(_, joint)| *joint);
        let mut coordinates = HashMap::new();
        for joint in joints().filter(|joint| joint.kind.is_single()) {
            coordinates.insert(joint.name.as_str(), unused(&joint.name, &[], &mut taken));
        }
        // The names of bodies are labels, but those of free and planar bodies begin the names of their coordinates.
        let mut bodies = HashMap::new();
        let mut labels: HashSet<String> = HashSet::from(["world".to_owned()]);
        for (place, (link, joint)) in order.iter().enumerate() {
            let names =
                place == 0 || joint.is_some_and(|joint| !joint.kind.is_single() && joint.kind != Kind::Fixed);
            let label = match names {
                true => unused(&link.name, &[&OF_COORDINATES[..], &FLOATING].concat(), &mut taken),
                false => unused(&link.name, &[], &mut labels),
            };
            labels.insert(label.clone());
            bodies.insert(link.name.as_str(), label);
        }
        let mut names = Names { bodies, coordinates, dampings: HashMap::new() };
        for joint in joints().filter(|joint| joint.damping != 0.0 && joint.kind != Kind::Fixed) {
            let moves = names.coordinate(joint).unwrap_or_else(|| names.body(&joint.child));
            let damping = unused(&format!("{moves}_damping"), &[], &mut taken);
            names.dampings.insert(&joint.name, damping);
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

    /// The name of the damping parameter of a joint, if the joint has such a parameter.
    pub(crate) fn damping(&self, joint: &Joint) -> Option<&str> {
        self.dampings.get(joint.name.as_str()).map(String::as_str)
    }

    /// The names of the velocities of a joint.
    pub(crate) fn velocities(&self, joint: &Joint) -> Vec<String> {
        let of_body = |velocities: &[&str]| {
            let body = self.body(&joint.child);
            velocities.iter().map(|velocity| format!("{body}_{velocity}")).collect()
        };
        match (joint.kind, self.coordinate(joint)) {
            (Kind::Planar, _) => of_body(&PLANAR),
            (Kind::Floating, _) => of_body(&FLOATING),
            (_, Some(x)) => vec![format!("{x}'")],
            (_, None) => Vec::new(),
        }
    }
}

/// The name with invalid characters replaced, and extended if it, or a name `NAME_ENDING` formed from it, is
/// taken.
fn unused(name: &str, endings: &[&str], taken: &mut HashSet<String>) -> String {
    let mut own: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if !is_name(&own) {
        own.insert(0, '_');
        own.truncate(200); // a name has at most 255 bytes
    }
    let all = |own: &str| -> Vec<String> {
        let longer = endings.iter().map(|ending| format!("{own}_{ending}"));
        std::iter::once(own.to_owned()).chain(longer).collect()
    };
    while all(&own).iter().any(|name| taken.contains(name)) {
        own.push('_');
    }
    taken.extend(all(&own));
    own
}
