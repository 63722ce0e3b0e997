//! Random trees.

use super::pose::{Vector, applied, at_start, sum, transposed};
use crate::fuzz::random::Random;

/// How a body moves against its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Fixed,
    Revolute,
    Prismatic,
    Screw,
    Cylindrical,
    Universal,
    Planar,
    Spherical,
    Free,
}

/// Kinds as often as they are met: simple ones more often.
const KINDS: [Kind; 14] = [
    Kind::Fixed,
    Kind::Revolute,
    Kind::Revolute,
    Kind::Revolute,
    Kind::Revolute,
    Kind::Prismatic,
    Kind::Prismatic,
    Kind::Screw,
    Kind::Cylindrical,
    Kind::Universal,
    Kind::Planar,
    Kind::Spherical,
    Kind::Spherical,
    Kind::Free,
];

/// A body on a joint.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) name: String,
    pub(super) parent: Option<usize>,
    pub(super) kind: Kind,
    pub(super) axes: [Vector; 2],
    pub(super) pitch: f64,
    pub(super) at: Vector,
    pub(super) turns: Vec<(usize, f64)>,
    pub(super) mass: f64,
    pub(super) centre: Vector,
    /// Ixx, Iyy, Izz, Ixy, Iyz, Ixz
    pub(super) inertia: [f64; 6],
    /// Coordinates and quasi-velocities of the joint at the start.
    pub(super) x: Vec<f64>,
    pub(super) eta: Vec<f64>,
    pub(super) spring: Option<f64>,
    pub(super) damper: Option<f64>,
    pub(super) force: Option<Vector>,
    pub(super) torque: Option<Vector>,
}

impl Body {
    /// The names of the coordinates of its joint.
    pub(super) fn coordinates(&self) -> Vec<String> {
        let quaternion = ["q0", "q1", "q2", "q3"];
        let ends: Vec<&str> = match self.kind {
            Kind::Fixed => return Vec::new(),
            Kind::Revolute | Kind::Prismatic | Kind::Screw => return vec![self.name.clone()],
            Kind::Cylindrical => vec!["z", "φ"],
            Kind::Universal => vec!["1", "2"],
            // Those of its plane, whatever they are in space.
            Kind::Planar => vec!["x", "y", "φ"],
            Kind::Spherical => quaternion.to_vec(),
            Kind::Free => [&["x", "y", "z"][..], &quaternion].concat(),
        };
        ends.iter().map(|end| format!("{}_{end}", self.name)).collect()
    }

    /// The names of its quasi-velocities, unless these are the velocities of its coordinates.
    pub(super) fn quasi_velocities(&self) -> Option<Vec<String>> {
        let ends: &[&str] = match self.kind {
            Kind::Spherical => &["ω1", "ω2", "ω3"],
            Kind::Free => &["v1", "v2", "v3", "ω1", "ω2", "ω3"],
            _ => return None,
        };
        Some(ends.iter().map(|end| format!("{}_{end}", self.name)).collect())
    }

    /// The number of the axis that a planar joint has as its normal.
    pub(super) fn normal(&self) -> usize {
        self.axes[0].iter().position(|component| *component != 0.0).unwrap_or(0)
    }
}

/// What closes a loop.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    pub(super) bodies: [usize; 2],
    pub(super) at: [Vector; 2],
    /// Of a rod; of none, the points are one.
    pub(super) length: Option<f64>,
}

/// Bodies on joints.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub(super) bodies: Vec<Body>,
    pub(super) gravity: Vector,
    pub(super) closed: Option<Loop>,
    /// A body with a place on it that is observed.
    pub(super) observed: (usize, Vector),
}

impl Tree {
    /// The first body that this one is fixed to, directly or by others; none is the world.
    fn rigid(&self, body: usize) -> Option<usize> {
        match self.bodies[body].kind {
            Kind::Fixed => self.bodies[body].parent.and_then(|parent| self.rigid(parent)),
            _ => Some(body),
        }
    }

    /// Whether a joint has a quaternion.
    pub(super) fn has_quaternions(&self) -> bool {
        self.bodies.iter().any(|body| body.quasi_velocities().is_some())
    }

    /// Whether forces act whose work is not that of a potential in both texts.
    pub(super) fn has_forces(&self) -> bool {
        self.bodies.iter().any(|body| body.force.is_some() || body.torque.is_some())
    }
}

/// Tree number `index` of a seed.
pub(super) fn tree(seed: u64, index: u64) -> Tree {
    let mut random = Random::new(seed, index);
    let count = 1 + random.below(6);
    let closes = count > 1 && random.chance(25);
    let mut bodies = Vec::new();
    for i in 0..count {
        bodies.push(body(&mut random, i, closes));
    }
    if bodies.iter().all(|body: &Body| body.kind == Kind::Fixed) {
        bodies[0].kind = Kind::Revolute;
        (bodies[0].x, bodies[0].eta) = (vec![0.4], vec![if closes { 0.0 } else { 0.7 }]);
    }
    let gravity = if random.chance(70) { vector(&mut random, 5.0) } else { [0.0; 3] };
    let observed = (random.below(count), vector(&mut random, 1.0));
    let mut tree = Tree { bodies, gravity, closed: None, observed };
    if closes {
        let closed = closed(&mut random, &tree);
        // Between parts of one rigid body a loop is no constraint.
        tree.closed =
            Some(closed).filter(|closed| tree.rigid(closed.bodies[0]) != tree.rigid(closed.bodies[1]));
    }
    tree
}

fn vector(random: &mut Random, size: f64) -> Vector {
    std::array::from_fn(|_| random.decimal(-size, size))
}

fn body(random: &mut Random, i: usize, closes: bool) -> Body {
    let parent =
        (i > 0 && random.chance(85)).then(|| if random.chance(60) { i - 1 } else { random.below(i) });
    let kind = *random.pick(&KINDS);
    let mut axes = [vector(random, 1.0), vector(random, 1.0)];
    if kind == Kind::Planar {
        let normal = random.below(3);
        axes[0] = std::array::from_fn(|k| if k == normal { 1.0 } else { 0.0 });
    } else if random.chance(40) {
        let along = random.below(3);
        axes =
            [along, (along + 1) % 3].map(|along| std::array::from_fn(|k| if k == along { 1.0 } else { 0.0 }));
    }
    let turns = (0..random.below(3)).map(|_| (random.below(3), random.decimal(-1.5, 1.5))).collect();
    let angle = random.decimal(-1.2, 1.2);
    let quaternion = [angle.cos(), 0.6 * angle.sin(), 0.0, 0.8 * angle.sin()];
    let (own, velocities) = match kind {
        Kind::Fixed => (0, 0),
        Kind::Revolute | Kind::Prismatic | Kind::Screw => (1, 1),
        Kind::Cylindrical | Kind::Universal => (2, 2),
        Kind::Planar => (3, 3),
        Kind::Spherical => (0, 3),
        Kind::Free => (3, 6),
    };
    let mut x: Vec<f64> = (0..own).map(|_| random.decimal(-0.8, 0.8)).collect();
    if matches!(kind, Kind::Spherical | Kind::Free) {
        x.extend(quaternion);
    }
    // Under a loop only rest is sure to be allowed.
    let eta = (0..velocities).map(|_| if closes { 0.0 } else { random.decimal(-1.0, 1.0) }).collect();
    // Two moments together are more than the third, whatever the products are.
    let moments = [0; 3].map(|_| random.decimal(0.3, 0.5));
    let products = [0; 3].map(|_| random.decimal(-0.05, 0.05));
    let single = matches!(kind, Kind::Revolute | Kind::Prismatic | Kind::Screw);
    Body {
        name: format!("b{i}"),
        parent,
        kind,
        axes,
        pitch: random.decimal(-0.5, 0.5),
        at: vector(random, 1.0),
        turns,
        mass: random.decimal(0.2, 2.0),
        centre: if random.chance(80) { vector(random, 0.5) } else { [0.0; 3] },
        inertia: [moments[0], moments[1], moments[2], products[0], products[1], products[2]],
        x,
        eta,
        spring: (single && random.chance(40)).then(|| random.decimal(0.5, 5.0)),
        damper: (single && random.chance(30)).then(|| random.decimal(0.05, 0.5)),
        force: random.chance(15).then(|| vector(random, 1.0)),
        torque: random.chance(10).then(|| vector(random, 1.0)),
    }
}

/// A rod or a common point between two bodies, as they stand at the start.
fn closed(random: &mut Random, tree: &Tree) -> Loop {
    let first = random.below(tree.bodies.len());
    let second = (first + 1 + random.below(tree.bodies.len() - 1)) % tree.bodies.len();
    let poses = at_start(tree);
    let place = |body: usize, at: &Vector| sum(&poses[body].1, &applied(&poses[body].0, at));
    let mut at = [vector(random, 1.0), vector(random, 1.0)];
    if random.chance(60) {
        let (a, b) = (place(first, &at[0]), place(second, &at[1]));
        let length = (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt();
        return Loop { bodies: [first, second], at, length: Some(length) };
    }
    let common = place(first, &at[0]);
    let from = std::array::from_fn(|i| common[i] - poses[second].1[i]);
    at[1] = applied(&transposed(&poses[second].0), &from);
    Loop { bodies: [first, second], at, length: None }
}
