//! Random trees.

use super::pose::{Matrix, Vector, applied, at_start, sum, transposed};
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
            Kind::Planar => {
                let axes = ["x", "y", "z"];
                vec![axes[(self.normal() + 1) % 3], axes[(self.normal() + 2) % 3], "φ"]
            }
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
    pub(super) name: &'static str,
    /// The second may be the world.
    pub(super) bodies: (usize, Option<usize>),
    pub(super) at: [Vector; 2],
    pub(super) closing: Closing,
}

/// What two points of a loop have in common.
#[derive(Clone, Debug)]
pub(super) enum Closing {
    /// A rod of this length.
    Rod(f64),
    /// A place.
    Point,
    /// A place and an axis, in the axes of each body.
    Revolute([Vector; 2]),
}

/// The coordinate of the first body, moved as x + a (1 − cos ω t).
#[derive(Clone, Debug)]
pub(super) struct Drive {
    pub(super) amplitude: f64,
    pub(super) frequency: f64,
}

/// Bodies on joints.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub(super) bodies: Vec<Body>,
    pub(super) gravity: Vector,
    pub(super) loops: Vec<Loop>,
    pub(super) drive: Option<Drive>,
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
    let closes = count > 1 && random.chance(30);
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
    let mut tree = Tree { bodies, gravity, loops: Vec::new(), drive: None, observed };
    match closes {
        true => close(&mut random, &mut tree),
        false => tree.drive = drive(&mut random, &mut tree.bodies),
    }
    tree
}

/// One loop, sometimes two.
fn close(random: &mut Random, tree: &mut Tree) {
    let names = if random.chance(30) { &["c", "d"][..] } else { &["c"] };
    for &name in names {
        let closed = closed(random, tree, name);
        // Between parts of one rigid body a loop is no constraint.
        let (first, second) = closed.bodies;
        if tree.rigid(first) != second.and_then(|second| tree.rigid(second)) {
            tree.loops.push(closed);
        }
    }
}

/// A first body that is moved from outside, from rest, so that what hangs on it has a moving anchor.
fn drive(random: &mut Random, bodies: &mut [Body]) -> Option<Drive> {
    let (anchor, others) = bodies.split_first_mut()?;
    let single = matches!(anchor.kind, Kind::Revolute | Kind::Prismatic);
    let hangs = others.iter().any(|body| body.kind != Kind::Fixed);
    (single && hangs && random.chance(12)).then(|| {
        anchor.eta = vec![0.0];
        Drive { amplitude: random.decimal(-0.5, 0.5), frequency: random.decimal(0.5, 3.0) }
    })
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
    // Of four decades where some are heavy and some light.
    let heavy = if random.chance(25) { 10f64.powf(random.number(-2.0, 2.0)) } else { 1.0 };
    let tensor = [moments[0], moments[1], moments[2], products[0], products[1], products[2]];
    Body {
        name: format!("b{i}"),
        parent,
        kind,
        axes,
        pitch: random.decimal(-0.5, 0.5),
        at: vector(random, 1.0),
        turns,
        mass: heavy * random.decimal(0.2, 2.0),
        centre: if random.chance(80) { vector(random, 0.5) } else { [0.0; 3] },
        inertia: tensor.map(|moment| heavy * moment),
        x,
        eta,
        spring: (single && random.chance(40)).then(|| random.decimal(0.5, 5.0)),
        damper: (single && random.chance(30)).then(|| random.decimal(0.05, 0.5)),
        force: random.chance(15).then(|| vector(random, 1.0)),
        torque: random.chance(10).then(|| vector(random, 1.0)),
    }
}

/// A rod, a common point or a common axis between two bodies, or one and the world, as they stand at the start.
fn closed(random: &mut Random, tree: &Tree, name: &'static str) -> Loop {
    let first = random.below(tree.bodies.len());
    let second = (first + 1 + random.below(tree.bodies.len() - 1)) % tree.bodies.len();
    let second = random.chance(75).then_some(second);
    let poses = at_start(tree);
    let still = ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]);
    let (one, other) = (poses[first], second.map_or(still, |second| poses[second]));
    let place = |pose: &(Matrix, Vector), at: &Vector| sum(&pose.1, &applied(&pose.0, at));
    let mut at = [vector(random, 1.0), vector(random, 1.0)];
    let bodies = (first, second);
    let kind = random.below(100);
    if kind < 50 {
        let (a, b) = (place(&one, &at[0]), place(&other, &at[1]));
        let length = (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt();
        return Loop { name, bodies, at, closing: Closing::Rod(length) };
    }
    let common = place(&one, &at[0]);
    let from = std::array::from_fn(|i| common[i] - other.1[i]);
    at[1] = applied(&transposed(&other.0), &from);
    if kind < 80 {
        return Loop { name, bodies, at, closing: Closing::Point };
    }
    let axis = vector(random, 1.0);
    let beside = applied(&transposed(&other.0), &applied(&one.0, &axis));
    Loop { name, bodies, at, closing: Closing::Revolute([axis, beside]) }
}
