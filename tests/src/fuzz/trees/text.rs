//! A tree as two texts.

use std::fmt::Write as _;

use super::generator::{Body, Closing, Drive, Kind, Loop, Tree};
use super::pose::{Vector, about_written, turned, unit};

/// What the quasi-velocity of a coordinate is called in the text without joints, where kinematics have to be written.
const RATE: &str = "w_";

/// How long the motions are.
const T_END: f64 = 0.5;

/// Bodies on joints, as a text.
pub(super) fn on_joints(tree: &Tree) -> String {
    let mut text = String::new();
    let line = |text: &mut String, line: String| _ = writeln!(text, "{line}");
    starts(&mut text, tree, |coordinate| format!("{coordinate}'"));
    for body in &tree.bodies {
        line(&mut text, format!("\n[bodies.{}]", body.name));
        if let Some(parent) = body.parent {
            line(&mut text, format!("parent = \"{}\"", tree.bodies[parent].name));
        }
        let mut joint = format!("kind = \"{}\"", word(body.kind));
        match body.kind {
            Kind::Fixed | Kind::Spherical | Kind::Free => {}
            Kind::Universal => _ = write!(joint, ", axes = {:?}", body.axes),
            Kind::Screw => _ = write!(joint, ", axis = {:?}, pitch = {:?}", body.axes[0], body.pitch),
            _ => _ = write!(joint, ", axis = {:?}", body.axes[0]),
        }
        _ = write!(joint, ", at = {:?}", body.at);
        if !body.turns.is_empty() {
            let turn = |(axis, angle): &(usize, f64)| format!("[\"{}\", {angle:?}]", ["x", "y", "z"][*axis]);
            let turns: Vec<String> = body.turns.iter().map(turn).collect();
            _ = write!(joint, ", turns = [{}]", turns.join(", "));
        }
        line(&mut text, format!("joint = {{ {joint} }}"));
        line(
            &mut text,
            format!("mass = {:?}\ncenter = {:?}\ninertia = {:?}", body.mass, body.centre, body.inertia),
        );
        loads(&mut text, body);
    }
    let (body, at) = &tree.observed;
    line(&mut text, format!("\n[points.P]\nbody = \"b{body}\"\nat = {at:?}"));
    line(&mut text, "\n[outputs]\no1 = \"P_z\"\no2 = \"P_x'\"".to_owned());
    for Loop { name, bodies: (first, second), at, closing } in &tree.loops {
        let second = second.map_or_else(|| "world".to_owned(), |second| format!("b{second}"));
        let (kind, entry) = match closing {
            Closing::Rod(length) => ("rod", format!("length = {length:?}")),
            Closing::Point => ("point", String::new()),
            Closing::Revolute(axis) => ("revolute", format!("axis = {axis:?}")),
        };
        let bodies = format!("bodies = [\"b{first}\", \"{second}\"]");
        line(&mut text, format!("\n[loops.{name}]\nkind = \"{kind}\"\n{bodies}\nat = {at:?}\n{entry}"));
    }
    common(&mut text, tree);
    text
}

/// The same bodies, their places and rotations written out.
pub(super) fn written_out(tree: &Tree) -> String {
    let mut text = String::new();
    let line = |text: &mut String, line: String| _ = writeln!(text, "{line}");
    let has_quaternions = tree.has_quaternions();
    starts(&mut text, tree, |coordinate| {
        if has_quaternions { format!("{RATE}{coordinate}") } else { format!("{coordinate}'") }
    });
    if has_quaternions {
        line(&mut text, "\n[kinematics]".to_owned());
        for body in &tree.bodies {
            for (coordinate, rate) in body.coordinates().iter().zip(rates(body)) {
                line(&mut text, format!("\"{coordinate}\" = \"{rate}\""));
            }
        }
    }
    line(&mut text, "\n[definitions]".to_owned());
    for (i, body) in tree.bodies.iter().enumerate() {
        poses(&mut text, i, body);
    }
    let (observed, at) = &tree.observed;
    for (i, place) in placed(Some(*observed), at).iter().enumerate() {
        line(&mut text, format!("P_{} = \"{place}\"", ["x", "y", "z"][i]));
    }
    for (i, body) in tree.bodies.iter().enumerate() {
        let place = placed(Some(i), &body.centre).map(|place| format!("\"{place}\"")).join(", ");
        let rotation: Vec<String> = (0..9).map(|e| format!("\"R{i}_{}{}\"", e / 3, e % 3)).collect();
        line(&mut text, format!("\n[bodies.{}]\nmass = {:?}\nposition = [{place}]", body.name, body.mass));
        line(&mut text, format!("rotation = [{}]\ninertia = {:?}", rotation.join(", "), body.inertia));
        loads(&mut text, body);
    }
    line(&mut text, "\n[outputs]\no1 = \"P_z\"\no2 = \"d(P_x)\"".to_owned());
    if !tree.loops.is_empty() {
        line(&mut text, "\n[constraints]".to_owned());
    }
    for closed in &tree.loops {
        for (i, constraint) in closing(closed).iter().enumerate() {
            line(&mut text, format!("{}_{} = \"{constraint}\"", closed.name, i + 1));
        }
    }
    common(&mut text, tree);
    text
}

/// What vanishes in a loop.
fn closing(closed: &Loop) -> Vec<String> {
    let ((first, second), at) = (closed.bodies, &closed.at);
    let (a, b) = (placed(Some(first), &at[0]), placed(second, &at[1]));
    let apart: [String; 3] = std::array::from_fn(|i| format!("({} - ({}))", a[i], b[i]));
    match &closed.closing {
        Closing::Rod(length) => {
            let squares = apart.map(|apart| format!("{apart}^2")).join(" + ");
            vec![format!("{squares} - {length:?}^2")]
        }
        Closing::Point => apart.to_vec(),
        Closing::Revolute([n, m]) => {
            let along = directed(second, m);
            let across = perpendicular(n).map(|across| {
                let across = directed(Some(first), &across);
                let terms: Vec<String> = (0..3).map(|i| format!("{}*{}", across[i], along[i])).collect();
                terms.join(" + ")
            });
            apart.into_iter().chain(across).collect()
        }
    }
}

/// Two directions that are perpendicular to a third and not to be told from each other by it.
fn perpendicular(n: &Vector) -> [Vector; 2] {
    let cross = |a: &Vector, b: &Vector| {
        std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let smallest = (0..3).min_by(|&i, &j| n[i].abs().total_cmp(&n[j].abs())).unwrap_or(0);
    let aside: Vector = std::array::from_fn(|i| if i == smallest { 1.0 } else { 0.0 });
    let across = cross(n, &aside);
    [across, cross(n, &across)]
}

/// A direction on a body, or in the world, in space.
fn directed(body: Option<usize>, along: &Vector) -> [String; 3] {
    std::array::from_fn(|r| {
        let entry = |k: usize| match body {
            Some(body) => format!("R{body}_{r}{k}*({:?})", along[k]),
            None => format!("({:?})", if r == k { along[k] } else { 0.0 }),
        };
        format!("({} + {} + {})", entry(0), entry(1), entry(2))
    })
}

/// What a column of the one text is called in the other.
pub(super) fn in_written_out(name: &str, written_out: &str) -> String {
    match name.strip_suffix('\'') {
        Some(coordinate) if written_out.contains("[kinematics]") => format!("{RATE}{coordinate}"),
        _ => name.to_owned(),
    }
}

fn word(kind: Kind) -> &'static str {
    match kind {
        Kind::Fixed => "fixed",
        Kind::Revolute => "revolute",
        Kind::Prismatic => "prismatic",
        Kind::Screw => "screw",
        Kind::Cylindrical => "cylindrical",
        Kind::Universal => "universal",
        Kind::Planar => "planar",
        Kind::Spherical => "spherical",
        Kind::Free => "free",
    }
}

/// `[coordinates]` and `[quasi_velocities]`, where the rate of a coordinate is called as told.
fn starts(text: &mut String, tree: &Tree, rate: impl Fn(&str) -> String) {
    text.push_str("[coordinates]\n");
    for body in &tree.bodies {
        for (coordinate, x) in body.coordinates().iter().zip(&body.x) {
            _ = writeln!(text, "\"{coordinate}\" = {x:?}");
        }
    }
    text.push_str("\n[quasi_velocities]\n");
    for body in &tree.bodies {
        let names = body.quasi_velocities();
        let names = names.unwrap_or_else(|| body.coordinates().iter().map(|name| rate(name)).collect());
        for (name, eta) in names.iter().zip(&body.eta) {
            _ = writeln!(text, "\"{name}\" = {eta:?}");
        }
    }
}

fn loads(text: &mut String, body: &Body) {
    for (what, load) in [("force", &body.force), ("torque", &body.torque)] {
        if let Some(load) = load {
            _ = writeln!(text, "{what} = {load:?}");
        }
    }
}

/// What both texts have in the same words.
fn common(text: &mut String, tree: &Tree) {
    if tree.gravity != [0.0; 3] {
        _ = writeln!(text, "\n[gravity]\nacceleration = {:?}", tree.gravity);
    }
    let springs = tree.bodies.iter().filter_map(|body| Some(format!("{:?}*{}^2", body.spring?, body.name)));
    let springs: Vec<String> = springs.collect();
    if !springs.is_empty() {
        _ = writeln!(text, "\n[lagrangian]\npotential = \"{}\"", springs.join(" + "));
    }
    let dampers = tree.bodies.iter().filter_map(|body| Some((body.damper?, &body.name)));
    let dampers: Vec<String> =
        dampers.map(|(damper, name)| format!("{name} = \"-{damper:?}*{name}'\"\n")).collect();
    if !dampers.is_empty() {
        _ = write!(text, "\n[forces]\n{}", dampers.concat());
    }
    if let Some(Drive { amplitude, frequency }) = &tree.drive {
        let (name, x) = (&tree.bodies[0].name, tree.bodies[0].x[0]);
        let moved = format!("{name} - ({x:?}) - ({amplitude:?})*(1 - cos({frequency:?}*t))");
        _ = writeln!(text, "\n[constraints]\ndrive = \"{moved}\"");
    }
    _ = writeln!(text, "\n[simulation]\nt_end = {T_END:?}");
}

/// The velocities of the coordinates of a joint in quasi-velocities.
fn rates(body: &Body) -> Vec<String> {
    let name = &body.name;
    let quaternion = [
        format!("-({name}_q1*{name}_ω1 + {name}_q2*{name}_ω2 + {name}_q3*{name}_ω3)/2"),
        format!("({name}_q0*{name}_ω1 + {name}_q2*{name}_ω3 - {name}_q3*{name}_ω2)/2"),
        format!("({name}_q0*{name}_ω2 + {name}_q3*{name}_ω1 - {name}_q1*{name}_ω3)/2"),
        format!("({name}_q0*{name}_ω3 + {name}_q1*{name}_ω2 - {name}_q2*{name}_ω1)/2"),
    ];
    match body.kind {
        Kind::Spherical => quaternion.to_vec(),
        Kind::Free => {
            let rotation = rotation_by_quaternion(name);
            let along = |i: usize| {
                let terms: Vec<String> =
                    (0..3).map(|j| format!("{}*{name}_v{}", rotation[i][j], j + 1)).collect();
                terms.join(" + ")
            };
            (0..3).map(along).chain(quaternion).collect()
        }
        _ => body.coordinates().iter().map(|coordinate| format!("{RATE}{coordinate}")).collect(),
    }
}

fn rotation_by_quaternion(name: &str) -> [[String; 3]; 3] {
    let q = |i: usize| format!("{name}_q{i}");
    let square = |i: usize, j: usize| format!("(1 - 2*({0}^2 + {1}^2))", q(i), q(j));
    let mixed = |i: usize, j: usize, sign: char, k: usize| {
        format!("(2*({}*{} {sign} {}*{}))", q(i), q(j), q(0), q(k))
    };
    [
        [square(2, 3), mixed(1, 2, '-', 3), mixed(1, 3, '+', 2)],
        [mixed(1, 2, '+', 3), square(1, 3), mixed(2, 3, '-', 1)],
        [mixed(1, 3, '-', 2), mixed(2, 3, '+', 1), square(1, 2)],
    ]
}

/// Definitions of the rotation `R{i}_..` and of the origin `p{i}_.` of body number i.
fn poses(text: &mut String, i: usize, body: &Body) {
    let still: [[String; 3]; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { "1" } else { "0" }.to_owned()));
    let (name, n) = (&body.name, unit(&body.axes[0]));
    let along = |n: &Vector, by: &str| n.map(|n| format!("({n:?})*{by}"));
    let nowhere = || [0; 3].map(|_| "0".to_owned());
    let coordinates = body.coordinates();
    let (turn, shift) = match body.kind {
        Kind::Fixed => (still, nowhere()),
        Kind::Revolute => (about_written(&n, name), nowhere()),
        Kind::Prismatic => (still, along(&n, name)),
        Kind::Screw => (about_written(&n, name), along(&n.map(|n| n * body.pitch), name)),
        Kind::Cylindrical => (about_written(&n, &coordinates[1]), along(&n, &coordinates[0])),
        Kind::Universal => {
            let (a, b) =
                (about_written(&n, &coordinates[0]), about_written(&unit(&body.axes[1]), &coordinates[1]));
            (product_written(&a, &b), nowhere())
        }
        Kind::Planar => {
            let (normal, mut place) = (body.normal(), nowhere());
            place[(normal + 1) % 3].clone_from(&coordinates[0]);
            place[(normal + 2) % 3].clone_from(&coordinates[1]);
            (about_written(&n, &coordinates[2]), place)
        }
        Kind::Spherical => (rotation_by_quaternion(name), nowhere()),
        Kind::Free => {
            let place = [coordinates[0].clone(), coordinates[1].clone(), coordinates[2].clone()];
            (rotation_by_quaternion(name), place)
        }
    };
    let joint = turned(&body.turns).map(|row| row.map(|entry| format!("({entry:?})")));
    let local = product_written(&joint, &turn);
    let place: [String; 3] = std::array::from_fn(|k| {
        let terms: Vec<String> = (0..3).map(|l| format!("{}*({})", joint[k][l], shift[l])).collect();
        format!("({:?} + {})", body.at[k], terms.join(" + "))
    });
    for r in 0..3 {
        for c in 0..3 {
            let entry = match body.parent {
                None => local[r][c].clone(),
                Some(parent) => {
                    let terms: Vec<String> =
                        (0..3).map(|k| format!("R{parent}_{r}{k}*L{i}_{k}{c}")).collect();
                    terms.join(" + ")
                }
            };
            if body.parent.is_some() {
                // All entries of L stand before the first of R, which uses a column of them.
                if r == 0 {
                    for k in 0..3 {
                        _ = writeln!(text, "L{i}_{k}{c} = \"{}\"", local[k][c]);
                    }
                }
            }
            _ = writeln!(text, "R{i}_{r}{c} = \"{entry}\"");
        }
    }
    for r in 0..3 {
        let entry = match body.parent {
            None => place[r].clone(),
            Some(parent) => {
                let terms: Vec<String> = (0..3).map(|k| format!("R{parent}_{r}{k}*{}", place[k])).collect();
                format!("p{parent}_{r} + {}", terms.join(" + "))
            }
        };
        _ = writeln!(text, "p{i}_{r} = \"{entry}\"");
    }
}

fn product_written(a: &[[String; 3]; 3], b: &[[String; 3]; 3]) -> [[String; 3]; 3] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let terms: Vec<String> = (0..3).map(|k| format!("{}*{}", a[i][k], b[k][j])).collect();
            format!("({})", terms.join(" + "))
        })
    })
}

/// A place on a body, or in the world, in space.
fn placed(body: Option<usize>, at: &Vector) -> [String; 3] {
    let from = directed(body, at);
    std::array::from_fn(|r| match body {
        Some(body) => format!("(p{body}_{r} + {})", from[r]),
        None => from[r].clone(),
    })
}
