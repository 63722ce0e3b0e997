//! What is wrong with bodies on joints, and every message in full.

use pc_mech::Graph;
use pc_model::{Document, Model, ModelError, Source};

fn refusal(text: &str) -> Option<ModelError> {
    let document = Document::parse(Source::new("m.toml", text));
    document.and_then(|document| Model::new(document).assemble(&Graph::new()).map(|_| ())).err()
}

/// What is wrong, the model, the exit code and the message.
const REFUSED: &[(&str, &str, u8, &str)] = &[
    (
        "unknown parent",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[bodies.b]
parent = "aa"
joint = { kind = "fixed" }
"#,
        3,
        r#"m.toml:5:10: [bodies.b] parent: no body with a joint is called `aa`
    parent = "aa"
             ^^^^
  help: did you mean `a`? the bodies with joints are a, b; "world" is what they hang on in the end"#,
    ),
    (
        "circle",
        r#"[bodies.a]
parent = "c"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[bodies.b]
parent = "a"
joint = { kind = "fixed" }
[bodies.c]
parent = "b"
joint = { kind = "fixed" }
"#,
        3,
        r#"m.toml:2:10: [bodies.a] parent: no body of these hangs on the world: `a` on `c`, `c` on `b`, `b` on `a`
    parent = "c"
             ^^^
  help: leave the `parent` of one of them out: it hangs on the world then"#,
    ),
    (
        "own parent",
        r#"[bodies.a]
parent = "a"
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:10: [bodies.a] parent: no body of these hangs on the world: `a` on `a`
    parent = "a"
             ^^^
  help: leave the `parent` of one of them out: it hangs on the world then"#,
    ),
    (
        "zero axis",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 0] }
mass = 1
"#,
        4,
        r#"m.toml:2:37: [bodies.a] joint.axis: the axis has length 0
    joint = { kind = "revolute", axis = [0, 0, 0] }
                                        ^^^^^^^^^
  help: give it a direction, such as `[0, 0, 1]`"#,
    ),
    (
        "unknown kind",
        r#"[bodies.a]
joint = { kind = "revolut", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:18: [bodies.a] joint.kind: `revolut` is not one of the choices
    joint = { kind = "revolut", axis = [0, 0, 1] }
                     ^^^^^^^^^
  help: did you mean `revolute`? The choices are fixed, revolute, prismatic, screw, cylindrical, universal, planar, spherical, free"#,
    ),
    (
        "no kind",
        r#"[bodies.a]
joint = { axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:9: [bodies.a] joint: `kind` is missing
    joint = { axis = [0, 0, 1] }
            ^^^^^^^^^^^^^^^^^^^^
  help: add `kind = "revolute"`"#,
    ),
    (
        "no axis",
        r#"[bodies.a]
joint = { kind = "revolute" }
mass = 1
"#,
        3,
        r#"m.toml:2:9: [bodies.a] joint: `axis` is missing
    joint = { kind = "revolute" }
            ^^^^^^^^^^^^^^^^^^^^^
  help: add `axis = [0, 0, 1]`"#,
    ),
    (
        "axis of a fixed joint",
        r#"[bodies.a]
joint = { kind = "fixed", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:27: [bodies.a] joint.axis: joints of this kind have no `axis`
    joint = { kind = "fixed", axis = [0, 0, 1] }
                              ^^^^
  help: write `kind = "revolute"`, or leave `axis` out"#,
    ),
    (
        "one axis of two",
        r#"[bodies.a]
joint = { kind = "universal", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:31: [bodies.a] joint.axis: joints of this kind have no `axis`
    joint = { kind = "universal", axis = [0, 0, 1] }
                                  ^^^^
  help: write `axes = [[1, 0, 0], [0, 1, 0]]`, or leave `axis` out"#,
    ),
    (
        "pitch",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1], pitch = 0.1 }
mass = 1
"#,
        3,
        r#"m.toml:2:48: [bodies.a] joint.pitch: joints of this kind have no `pitch`
    joint = { kind = "revolute", axis = [0, 0, 1], pitch = 0.1 }
                                                   ^^^^^
  help: write `kind = "screw"`, or leave `pitch` out"#,
    ),
    (
        "no pitch",
        r#"[bodies.a]
joint = { kind = "screw", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:9: [bodies.a] joint: `pitch` is missing
    joint = { kind = "screw", axis = [0, 0, 1] }
            ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: add `pitch = 0.01`"#,
    ),
    (
        "normal",
        r#"[bodies.a]
joint = { kind = "planar", axis = [0, 1, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:35: [bodies.a] joint.axis: expected [1, 0, 0], [0, 1, 0] or [0, 0, 1] as the normal of a planar joint, whose axes `rotation` or `turns` can turn, found [0, 1, 1]
    joint = { kind = "planar", axis = [0, 1, 1] }
                                      ^^^^^^^^^
  help: write `axis = [0, 0, 1]`"#,
    ),
    (
        "massless leaf",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[bodies.b]
parent = "a"
joint = { kind = "prismatic", axis = [0, 0, 1] }
"#,
        4,
        r#"m.toml:4:9: [bodies] b: `b` can move, and neither it nor what hangs on it has mass or inertia
    [bodies.b]
            ^
  help: give it a mass, or make its joint `fixed`"#,
    ),
    (
        "point mass on the axis",
        r#"[parameters]
m = 1.0
[bodies.a]
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = "m"
center = [0, 2, 0]
"#,
        4,
        r#"m.toml:4:9: [bodies.a] joint: nothing that the revolute joint of `a` turns has inertia about its axis (0, 1, 0)
    joint = { kind = "revolute", axis = [0, 1, 0] }
            ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: give `a` an `inertia`, or by `center` a place off the axis for a mass that is not 0, or make its joint `fixed`"#,
    ),
    (
        "tip without mass",
        r#"[parameters]
m = 0.0
[bodies.a]
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = 1
center = [0, 0, -1]
[bodies.b]
parent = "a"
joint = { kind = "revolute", axis = [0, 1, 0], at = [0, 0, -1] }
mass = "m"
center = [0, 0, -1]
"#,
        4,
        r#"m.toml:9:9: [bodies.b] joint: nothing that the revolute joint of `b` turns has inertia about its axis (0, 1, 0)
    joint = { kind = "revolute", axis = [0, 1, 0], at = [0, 0, -1] }
            ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: give `b` an `inertia`, or by `center` a place off the axis for a mass that is not 0, or make its joint `fixed`"#,
    ),
    (
        "slide without mass",
        r#"[parameters]
m = 0.0
[bodies.a]
joint = { kind = "prismatic", axis = [0, 0, 1] }
mass = "m"
"#,
        4,
        r#"m.toml:4:9: [bodies.a] joint: nothing that the prismatic joint of `a` moves along its axis (0, 0, 1) has mass
    joint = { kind = "prismatic", axis = [0, 0, 1] }
            ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: give `a` a mass that is not 0, or make its joint `fixed`"#,
    ),
    (
        "point mass on a spherical joint",
        r#"[bodies.a]
joint = { kind = "spherical" }
mass = 1
center = [0, 0, -1]
"#,
        4,
        r#"m.toml:2:9: [bodies.a] joint: nothing that the spherical joint of `a` turns has inertia about the axis (0, 0, 1) of the body
    joint = { kind = "spherical" }
            ^^^^^^^^^^^^^^^^^^^^^^
  help: give `a` an `inertia`, or by `center` a place off the axis for a mass that is not 0, or make its joint `fixed`"#,
    ),
    (
        "point mass at the crossing of the axes",
        r#"[bodies.a]
joint = { kind = "universal", axes = [[1, 0, 0], [0, 1, 0]] }
mass = 1
center = [0, 1, 0]
"#,
        4,
        r#"m.toml:2:9: [bodies.a] joint: nothing that the universal joint of `a` turns has inertia about its second axis (0, 1, 0)
    joint = { kind = "universal", axes = [[1, 0, 0], [0, 1, 0]] }
            ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: give `a` an `inertia`, or by `center` a place off the axis for a mass that is not 0, or make its joint `fixed`"#,
    ),
    (
        "name taken by a parameter",
        r#"[parameters]
a = 1
[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:3:9: [bodies] a: `a` is already the name of a parameter (line 2)
    [bodies.a]
            ^
  help: parameters, inputs, functions, definitions, coordinates, quasi-velocities, states, integrals and outputs share one namespace; choose another name, such as `a_1`"#,
    ),
    (
        "name taken by another joint",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[bodies.b]
joint = { kind = "revolute", axis = [0, 0, 1], coordinates = ["a"] }
mass = 1
"#,
        3,
        r#"m.toml:5:63: [bodies.b] joint.coordinates: `a` is already the name of a coordinate (line 1)
    …int = { kind = "revolute", axis = [0, 0, 1], coordinates = ["a"] }
                                                                 ^^^
  help: parameters, inputs, functions, definitions, coordinates, quasi-velocities, states, integrals and outputs share one namespace; choose another name, such as `a_1`"#,
    ),
    (
        "no name",
        r#"[bodies."left arm"]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:1:9: [bodies] left arm: `left arm` is not a name
    [bodies."left arm"]
            ^^^^^^^^^^
  help: a name is a Latin or Greek letter or `_`, then letters, digits and `_`"#,
    ),
    (
        "names of another number",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1], coordinates = ["x", "y"] }
mass = 1
"#,
        3,
        r#"m.toml:2:62: [bodies.a] joint.coordinates: expected 1 name, found 2
    …oint = { kind = "revolute", axis = [0, 0, 1], coordinates = ["x", "y"] }
                                                                 ^^^^^^^^^^
  help: write `coordinates = ["x"]`"#,
    ),
    (
        "position beside a joint",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
position = [0, 0, 0]
"#,
        3,
        r#"m.toml:4:1: [bodies.a] position: `joint` and `position` exclude each other
    position = [0, 0, 0]
    ^^^^^^^^
  help: a body with a joint has its place and its attitude from that: `at` and `rotation` are the joint's"#,
    ),
    (
        "parent without joint",
        r#"[bodies.a]
parent = "world"
mass = 1
"#,
        3,
        r#"m.toml:1:1: [bodies.a]: `joint` is missing
    [bodies.a]
    ^^^^^^^^^^
  help: add `joint = { kind = "revolute", axis = [0, 0, 1], at = [0, 0, 0] }`"#,
    ),
    (
        "no rotation",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1], rotation = [1, 0, 0, 0, 1, 0, 0, 0, -1] }
mass = 1
"#,
        4,
        r#"m.toml:2:60: [bodies.a] joint.rotation: these nine entries are not a rotation: R·Rᵀ differs from 1 by 0, and the determinant is -1
    joint = { kind = "revolute", axis = [0, 0, 1], rotation = [1, 0, 0, 0, 1, 0, 0, 0, -1] }
                                                               ^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: its rows are orthogonal unit vectors; angles about axes are given by `turns`"#,
    ),
    (
        "unknown axis of turns",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1], turns = [["w", 0.1]] }
mass = 1
"#,
        3,
        r#"m.toml:2:58: [bodies.a] joint.turns: `w` is not one of the choices
    joint = { kind = "revolute", axis = [0, 0, 1], turns = [["w", 0.1]] }
                                                             ^^^
  help: the choices are x, y, z"#,
    ),
    (
        "quaternion",
        r#"[coordinates]
a_q1 = 0.5
[bodies.a]
joint = { kind = "spherical" }
inertia = [1, 1, 1]
"#,
        4,
        r#"m.toml:3:9: [bodies] a: the quaternion of `a` has length 1.118033988749895 at the start, not 1
    [bodies.a]
            ^
  help: a turn by the angle a about the unit vector u has the quaternion cos(a/2), u*sin(a/2)"#,
    ),
    (
        "kinematics of a joint",
        r#"[kinematics]
a = "u"
[quasi_velocities]
u = 0
[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:2:1: [kinematics] a: the joint of `a` says how `a` moves
    a = "u"
    ^
  help: give its start value alone, or leave it out"#,
    ),
    (
        "is of a joint",
        r#"[quasi_velocities]
"a_ω1" = { is = "0" }
[bodies.a]
joint = { kind = "spherical" }
inertia = [1, 1, 1]
"#,
        3,
        r#"m.toml:2:2: [quasi_velocities] a_ω1: the joint of `a` says how `a_ω1` moves
    "a_ω1" = { is = "0" }
     ^^^^
  help: give its start value alone, or leave it out"#,
    ),
    (
        "is beside a ball",
        r#"[coordinates]
x = 0
[quasi_velocities]
u = { is = "x'" }
[bodies.a]
joint = { kind = "spherical" }
inertia = [1, 1, 1]
[lagrangian]
kinetic = "x'^2/2"
"#,
        3,
        r#"m.toml:4:1: [quasi_velocities] u: the joint of `a` has an angular velocity, beside which no quasi-velocity is defined by `is`
    u = { is = "x'" }
    ^
  help: give the velocities of what belongs to no joint in [kinematics]"#,
    ),
    (
        "coordinate in a joint",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1], at = [0, 0, "a"] }
mass = 1
"#,
        3,
        r#"m.toml:2:61: [bodies.a] joint.at: `a` cannot be used in a joint, a point, or the mass of a body with a joint
    joint = { kind = "revolute", axis = [0, 0, 1], at = [0, 0, "a"] }
                                                                ^
  help: use numbers, parameters and definitions made of them only"#,
    ),
    (
        "world",
        r#"[bodies.world]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
"#,
        3,
        r#"m.toml:1:9: [bodies] world: the name `world` is reserved
    [bodies.world]
            ^^^^^
  help: it is what bodies hang on in the end; choose another name, such as `world_1`"#,
    ),
    (
        "point of nothing",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[points.p]
body = "b"
"#,
        3,
        r#"m.toml:5:8: [points.p] body: no body with a joint is called `b`
    body = "b"
           ^^^
  help: the bodies with joints are a; "world" is what they hang on in the end"#,
    ),
    (
        "point in gravity",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[points.p]
body = "a"
[gravity]
acceleration = [0, 0, "p_x"]
"#,
        3,
        r#"m.toml:7:24: [gravity] acceleration: `p_x` cannot be used in the acceleration of gravity
    acceleration = [0, 0, "p_x"]
                           ^^^
  help: use numbers, parameters, inputs and t only"#,
    ),
    (
        "loop of an unknown kind",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[loops.l]
kind = "ball"
bodies = ["a", "world"]
at = [[1, 0, 0], [1, 0, 0]]
"#,
        3,
        r#"m.toml:5:8: [loops.l] kind: `ball` is not one of the choices
    kind = "ball"
           ^^^^^^
  help: the choices are point, revolute, rod"#,
    ),
    (
        "loop that is open",
        r#"[bodies.a]
joint = { kind = "free" }
mass = 1
inertia = [1, 1, 1]
[loops.l]
kind = "point"
bodies = ["a", "world"]
at = [[1, 0, 0], [0.5, 0, 0]]
"#,
        4,
        r#"m.toml:5:8: [loops] l: the start is off the constraint `l_1`: it is 0.5, not 0
    [loops.l]
           ^
  help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)"#,
    ),
    (
        "loop without axis",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[loops.l]
kind = "revolute"
bodies = ["a", "world"]
at = [[1, 0, 0], [1, 0, 0]]
"#,
        3,
        r#"m.toml:4:1: [loops.l]: `axis` is missing
    [loops.l]
    ^^^^^^^^^
  help: add `axis = [[0, 0, 1], [0, 0, 1]]`"#,
    ),
    (
        "axis of a point",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[loops.l]
kind = "point"
bodies = ["a", "world"]
at = [[1, 0, 0], [1, 0, 0]]
axis = [[0, 0, 1], [0, 0, 1]]
"#,
        3,
        r#"m.toml:8:1: [loops.l] axis: joints of this kind have no `axis`
    axis = [[0, 0, 1], [0, 0, 1]]
    ^^^^
  help: write `kind = "revolute"`, or leave `axis` out"#,
    ),
    (
        "loop with the name of a constraint",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[constraints]
l_1 = "a"
[loops.l]
kind = "point"
bodies = ["a", "world"]
at = [[1, 0, 0], [1, 0, 0]]
"#,
        3,
        r#"m.toml:6:8: [loops] l: `l_1` is already the name of a constraint (line 5)
    [loops.l]
           ^
  help: parameters, inputs, functions, definitions, coordinates, quasi-velocities, states, integrals and outputs share one namespace; choose another name, such as `l_1_1`"#,
    ),
    (
        "undefined quasi-velocity",
        r#"[coordinates]
x = 0
[quasi_velocities]
u = 0
[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1
[lagrangian]
kinetic = "x'^2/2"
"#,
        3,
        r#"m.toml:4:1: [quasi_velocities] u: nothing says what the quasi-velocity `u` is
    u = 0
    ^
  help: give [kinematics] for every coordinate, or define `u = { is = "…", start = 0.0 }`"#,
    ),
    (
        "mass of a coordinate",
        r#"[bodies.a]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = "1 + a^2"
"#,
        3,
        r#"m.toml:3:13: [bodies.a] mass: `a` cannot be used in a joint, a point, or the mass of a body with a joint
    mass = "1 + a^2"
                ^
  help: use numbers, parameters and definitions made of them only"#,
    ),
];

#[test]
fn what_is_wrong_is_shown_where_it_stands() {
    let mut complaints = Vec::new();
    for (what, text, code, message) in REFUSED {
        match refusal(text) {
            None => complaints.push(format!("{what}: it is accepted")),
            Some(error) => {
                let found = error.to_string();
                if (error.category().exit_code(), found.trim_end()) != (*code, *message) {
                    complaints.push(format!("{what}: {}\n{found}", error.category().exit_code()));
                }
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
}
