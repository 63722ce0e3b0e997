//! Tags of the built-in models.

use crate::model::builtin::Builtin;

/// A word by which built-in models can be found.
#[derive(Clone, Copy, Debug)]
pub struct Tag {
    /// The word.
    pub name: &'static str,
    /// The property that the models have in common.
    pub meaning: &'static str,
    /// Their names.
    pub models: &'static [&'static str],
}

/// All tags: the kinds of system, then the parts of the theory and of the format that they show.
pub const TAGS: &[Tag] = &[
    Tag {
        name: "particle",
        meaning: "mass points in given fields or on wires",
        models: &[
            "turning-wire",
            "turning-hoop",
            "rotating-oscillator",
            "charged-particle",
            "charged-particle-induction",
            "damped-oscillator",
            "damped-oscillator-scaled-frame",
            "relativistic-particle",
            "relativistic-constant-force",
            "toda-chain",
            "nonholonomic-particle",
            "voronets",
            "voronets-rheonomic",
            "bouncing-ball",
            "stick-slip-block",
            "three-bodies",
        ],
    },
    Tag {
        name: "pendulum",
        meaning: "pendulums, single and in chains",
        models: &[
            "spherical-pendulum-cartesian",
            "spherical-pendulum-meridian",
            "double-pendulum-cartesian",
            "double-pendulum-links",
            "pendulum-chain",
            "pendulum-chain-cartesian",
            "spatial-chain",
            "foucault-pendulum",
            "kapitza-pendulum",
            "swinging-atwood",
            "wilberforce-pendulum",
            "double-spherical-pendulum",
            "furuta-pendulum",
        ],
    },
    Tag {
        name: "top",
        meaning: "rigid bodies with a fixed point",
        models: &[
            "heavy-top-lagrange",
            "heavy-top-kovalevskaya",
            "heavy-top-goryachev-chaplygin",
            "heavy-top-euler",
            "heavy-top-euler-symmetric",
            "heavy-top-quaternion",
            "euler-top",
            "gimbals",
            "suslov",
            "suslov-in-gravity",
        ],
    },
    Tag {
        name: "free-body",
        meaning: "rigid bodies that move or turn freely in space",
        models: &[
            "rigid-body-spring",
            "gravity-gradient",
            "reaction-wheels",
            "quadrotor",
            "satellite",
            "quadruped",
        ],
    },
    Tag {
        name: "spacecraft",
        meaning: "satellites and their attitude",
        models: &["gravity-gradient", "reaction-wheels", "satellite", "dumbbell-satellite"],
    },
    Tag {
        name: "rolling",
        meaning: "disks, balls and wheels that roll",
        models: &[
            "vertical-disk",
            "vertical-disk-driven",
            "tilted-disk",
            "turntable",
            "turntable-accelerated",
            "ball-in-cylinder",
            "snakeboard",
            "snakeboard-driven",
            "carriage",
            "rocking-disk",
            "segway",
            "roller-racer",
            "tractor-trailers",
            "whipple-bicycle",
            "rattleback",
            "rolling-spheroid",
            "disk-on-bumps",
        ],
    },
    Tag {
        name: "mechanism",
        meaning: "linkages, machines and robots",
        models: &[
            "appell-hamel",
            "four-bar-loop",
            "slider-crank-loop",
            "puma-560",
            "quadruped",
            "stewart-platform",
            "elroys-beanie",
            "cart-pole",
            "segway",
            "quarter-car",
            "snake",
            "tractor-trailers",
        ],
    },
    Tag {
        name: "nonholonomic",
        meaning: "constraints on velocities that cannot be integrated",
        models: &[
            "chaplygin-sleigh",
            "vertical-disk",
            "vertical-disk-driven",
            "tilted-disk",
            "nonholonomic-particle",
            "suslov",
            "suslov-in-gravity",
            "turntable",
            "turntable-accelerated",
            "ball-in-cylinder",
            "snakeboard",
            "snakeboard-driven",
            "carriage",
            "voronets",
            "voronets-rheonomic",
            "stiff-sleigh",
            "stick-slip-sleigh",
            "segway",
            "roller-racer",
            "snake",
            "tractor-trailers",
            "whipple-bicycle",
            "rattleback",
            "rolling-spheroid",
            "disk-on-bumps",
        ],
    },
    Tag {
        name: "nonlinear",
        meaning: "constraints that are not affine in the velocities",
        models: &["appell-hamel"],
    },
    Tag {
        name: "relativistic",
        meaning: "Lagrangians that are not quadratic in the velocities",
        models: &["relativistic-particle", "relativistic-constant-force"],
    },
    Tag {
        name: "quaternion",
        meaning: "attitudes by unit quaternions",
        models: &[
            "heavy-top-quaternion",
            "rigid-body-spring",
            "gravity-gradient",
            "reaction-wheels",
            "suslov",
            "suslov-in-gravity",
            "turntable",
            "turntable-accelerated",
            "ball-in-cylinder",
            "satellite",
            "quadruped",
            "stewart-platform",
        ],
    },
    Tag {
        name: "events",
        meaning: "impacts, and laws of motion that change",
        models: &[
            "bouncing-ball",
            "stick-slip-block",
            "rocking-block",
            "stick-slip-sleigh",
            "rocking-disk",
            "quadruped",
        ],
    },
    Tag { name: "friction", meaning: "dry friction", models: &["stick-slip-block", "stick-slip-sleigh"] },
    Tag { name: "stiff", meaning: "motions for implicit methods", models: &["stiff-sleigh"] },
    Tag {
        name: "inputs",
        meaning: "functions of time from outside",
        models: &["quadrotor", "cart-pole", "furuta-pendulum", "quarter-car"],
    },
    Tag {
        name: "joints",
        meaning: "bodies on joints",
        models: &[
            "puma-560",
            "four-bar-loop",
            "slider-crank-loop",
            "spatial-chain",
            "satellite",
            "quadruped",
            "stewart-platform",
            "disk-on-bumps",
        ],
    },
    Tag {
        name: "loops",
        meaning: "chains of bodies that are closed",
        models: &["four-bar-loop", "slider-crank-loop", "stewart-platform"],
    },
];

impl Builtin {
    /// The tags of a model, in the order of [`TAGS`].
    pub fn tags(&self) -> impl Iterator<Item = &'static Tag> + use<> {
        let name = self.name;
        TAGS.iter().filter(move |tag| tag.models.contains(&name))
    }
}
