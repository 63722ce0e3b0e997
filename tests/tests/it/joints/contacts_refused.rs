//! What is wrong with contacts, and every message in full.

use std::fmt::Write;

use pc_mech::Graph;
use pc_model::{Document, Model, Source};

/// A ball with an entry of its contact, or a whole contact, and the message.
const REFUSED: &[(&str, &str)] = &[
    (
        r#"shape = "sphere"
radius = 1
motion = "rolls"
"#,
        r#"m.toml:5:1: [contacts.c]: `body` is missing
    [contacts.c]
    ^^^^^^^^^^^^
  help: add `body = "…"`"#,
    ),
    (
        r#"body = "bal"
shape = "sphere"
radius = 1
motion = "rolls"
"#,
        r#"m.toml:6:8: [contacts.c] body: no body is called `bal`
    body = "bal"
           ^^^^^
  help: did you mean `ball`? the bodies are ball"#,
    ),
    (
        r#"body = "ball"
shape = "cube"
motion = "rolls"
"#,
        r#"m.toml:7:9: [contacts.c] shape: `cube` is not one of the choices
    shape = "cube"
            ^^^^^^
  help: the choices are disc, sphere, ellipsoid"#,
    ),
    (
        r#"body = "ball"
shape = "disc"
radius = 1
motion = "rolls"
"#,
        r#"m.toml:5:1: [contacts.c]: `axis` is missing
    [contacts.c]
    ^^^^^^^^^^^^
  help: add `axis = [0, 0, 1]`"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
semi_axes = [1, 1, 1]
motion = "rolls"
"#,
        r#"m.toml:9:1: [contacts.c] semi_axes: contacts of this shape have no `semi_axes`
    semi_axes = [1, 1, 1]
    ^^^^^^^^^
  help: write `radius = "r"`, or leave `semi_axes` out"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
axis = [0, 0, 1]
motion = "rolls"
"#,
        r#"m.toml:9:1: [contacts.c] axis: contacts of this shape have no `axis`
    axis = [0, 0, 1]
    ^^^^
  help: write `shape = "disc"`, or leave `axis` out"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = "ball_z"
motion = "rolls"
"#,
        r#"m.toml:8:11: [contacts.c] radius: `ball_z` cannot be used in a joint, a point, or the mass of a body with a joint
    radius = "ball_z"
              ^^^^^^
  help: use numbers, parameters and definitions made of them only"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
normal = [0, 0, 0]
"#,
        r#"m.toml:10:11: [contacts.c] normal: the axis has length 0
    normal = [0, 0, 0]
              ^
  help: give it a direction, such as `[0, 0, 1]`"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rols"
"#,
        r#"m.toml:9:10: [contacts.c] motion: `rols` is not one of the choices
    motion = "rols"
             ^^^^^^
  help: did you mean `rolls`? The choices are rolls, slides"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
attitude = [1, 0, 0, 0, 1, 0, 0, 0, 1]
"#,
        r#"m.toml:10:12: [contacts.c] attitude: `attitude` has no effect without `angular_velocity`
    attitude = [1, 0, 0, 0, 1, 0, 0, 0, 1]
               ^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: add `angular_velocity = ["w1", "w2", "w3"]`, or leave `attitude` out"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
rubber = 0.1
"#,
        r#"m.toml:10:1: [contacts.c] rubber: unknown entry `rubber`
    rubber = 0.1
    ^^^^^^
  help: the entries here are body, shape, radius, axis, semi_axes, at, attitude, motion, friction, creep, normal, through, height, keeps"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
"#,
        r#"m.toml:5:11: [contacts] c: the start is off the constraint `c`: it is -1, not 0
    [contacts.c]
              ^
  help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
[parameters]
c_gap = 1
"#,
        r#"m.toml:11:1: [parameters] c_gap: `c_gap` is already the name of a component of a contact (line 5)
    c_gap = 1
    ^^^^^
  help: parameters, inputs, functions, definitions, coordinates, quasi-velocities, states, integrals and outputs share one namespace; choose another name, such as `c_gap_1`"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
[coordinates]
ball_z = 1
[constraints]
c_1 = "ball_x"
"#,
        r#"m.toml:5:11: [contacts] c: `c_1` is already the name of a constraint (line 13)
    [contacts.c]
              ^
  help: parameters, inputs, functions, definitions, coordinates, quasi-velocities, states, integrals and outputs share one namespace; choose another name, such as `c_1_1`"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
[coordinates]
ball_z = 1
[forces]
ball_x = "N_c"
"#,
        r#"m.toml:13:11: [forces] ball_x: `N_c` cannot be used in the Lagrangian or a force
    ball_x = "N_c"
              ^^^
  help: use declared names only"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
[coordinates]
ball_z = 1
[events.e]
when = "ball_x - 1"
reset = { ball_x = "N_c" }
"#,
        r#"m.toml:14:21: [events.e] reset.ball_x: `N_c` cannot be used in the reset of an event
    reset = { ball_x = "N_c" }
                        ^^^
  help: use declared names other than forces only"#,
    ),
    (
        r#"body = "p"
shape = "sphere"
radius = 1
motion = "rolls"
[bodies.p]
mass = 1
position = ["ball_x", 0, 1]
"#,
        r#"m.toml:6:8: [contacts.c] body: the body `p` is a particle, without a shape that could touch anything
    body = "p"
           ^^^
  help: give it `inertia` and `rotation` or `angular_velocity`, or attach it by a `joint`"#,
    ),
    (
        r#"body = "p"
shape = "sphere"
radius = 1
motion = "rolls"
[bodies.p]
mass = 1
position = ["ball_x", 0, 1]
inertia = [1, 1, 1]
angular_velocity = [0, "ball_ω1", 0]
"#,
        r#"m.toml:5:11: [contacts] c: `attitude` is missing
    [contacts.c]
              ^
  help: add `attitude = [1, 0, 0, 0, 1, 0, 0, 0, 1]`"#,
    ),
    (
        r#"body = "p"
shape = "sphere"
radius = 1
motion = "rolls"
[bodies.p]
mass = 1
position = ["c_x", 0, 1]
inertia = [1, 1, 1]
rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
"#,
        r#"m.toml:12:14: [bodies.p] position: `c_x` cannot be used in the mass, inertia, position or rotation of a body
    position = ["c_x", 0, 1]
                 ^^^
  help: use parameters, coordinates and t only"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "rolls"
friction = 0.3
"#,
        r#"m.toml:10:1: [contacts.c] friction: `friction` is of contacts that slide and lift off, not of one with `motion = "rolls"`
    friction = 0.3
    ^^^^^^^^
  help: write `motion = "slides"`: with friction, the body also rolls where friction suffices"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
friction = 0.3
keeps = true
"#,
        r#"m.toml:10:1: [contacts.c] friction: `friction` is of contacts that slide and lift off, not of one with `keeps = true`
    friction = 0.3
    ^^^^^^^^
  help: leave `keeps` out: N may be negative there, and friction would drive the body"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
creep = 0.3
"#,
        r#"m.toml:5:1: [contacts.c]: `friction` is missing
    [contacts.c]
    ^^^^^^^^^^^^
  help: add `friction = "mu"`"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
friction = 0.3
[coordinates]
ball_z = 1
"#,
        r#"m.toml:5:11: [contacts] c: `c` has friction in two directions, which needs a velocity of creep
    [contacts.c]
              ^
  help: write `creep = "v"`, a velocity far below those of interest"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
friction = -0.3
creep = 1e-3
[coordinates]
ball_z = 1
"#,
        r#"m.toml:10:12: [contacts.c] friction: a coefficient of friction is not negative, as -0.3 is
    friction = -0.3
               ^^^^
  help: 0.1 to 1 are usual"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
friction = 0.3
creep = 0
[coordinates]
ball_z = 1
"#,
        r#"m.toml:11:9: [contacts.c] creep: a velocity of creep is positive, and not 0
    creep = 0
            ^
  help: choose it far below the velocities of interest"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
friction = 0.3
creep = 1e-3
[coordinates]
ball_z = 1
[events.e]
when = "T_c_1"
"#,
        r#"m.toml:15:9: [events.e] when: `T_c_1` cannot be used in an event
    when = "T_c_1"
            ^^^^^
  help: use declared names only"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
friction = 0.3
creep = 1e-3
[contacts.below]
body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
friction = 0.3
creep = 1e-3
[coordinates]
ball_z = 1
"#,
        r#"m.toml:12:11: [contacts] below: the normal force of `below`, to which its friction is proportional, is not determined
    [contacts.below]
              ^^^^^
  help: leave the height of the body a coordinate, and give a body one contact"#,
    ),
    (
        r#"body = "ball"
shape = "sphere"
radius = 1
motion = "slides"
[coordinates]
ball_z = 1
lift = 1
[bodies.lift]
joint = { kind = "prismatic", axis = [0, 0, 1] }
mass = 1
[contacts.floor]
body = "lift"
shape = "sphere"
radius = 1
motion = "slides"
friction = 0.2
"#,
        r#"m.toml:21:12: [contacts.floor] friction: the body of `floor` cannot slip, and friction does nothing
    friction = 0.2
               ^^^
  help: leave `friction` out"#,
    ),
];

#[test]
fn wrong_contacts_are_refused() {
    let ball = "[bodies.ball]\njoint = { kind = \"free\" }\nmass = 1\ninertia = [1, 1, 1]\n[contacts.c]\n";
    let mut complaints = String::new();
    for (entries, message) in REFUSED {
        let refused = Document::parse(Source::new("m.toml", format!("{ball}{entries}")))
            .and_then(|document| Model::new(document).assemble(&Graph::new()).map(|_| ()));
        let found = refused.err().map_or_else(|| "accepted".to_owned(), |error| error.to_string());
        if found.trim_end() != *message {
            writeln!(complaints, "{entries}\n{found}\n").unwrap();
        }
    }
    assert!(complaints.is_empty(), "{complaints}");
}
