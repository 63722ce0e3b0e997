//! Random trees of all kinds of joints, with loads, points and loops, derived twice.

use std::fmt::Write;

use pc_model::Model;
use pc_tests::fuzz::random::Random;
use pc_verify::{Options, TOLERANCE, verify};

use super::run::document;

const KINDS: [&str; 9] =
    ["fixed", "revolute", "prismatic", "screw", "cylindrical", "universal", "planar", "spherical", "free"];

fn vector(random: &mut Random) -> String {
    let mut part = || random.decimal(-1.0, 1.0);
    format!("[{}, {}, {}]", part(), part(), part())
}

/// A coordinate axis, or any direction.
fn axis(random: &mut Random, coordinate: bool) -> String {
    match random.below(if coordinate { 3 } else { 5 }) {
        0 => "[1, 0, 0]".into(),
        1 => "[0, 1, 0]".into(),
        2 => "[0, 0, 1]".into(),
        3 => "[0, -2, 0]".into(),
        _ => format!("[0.3, {}, 1]", random.decimal(-1.0, 1.0)),
    }
}

/// A tree of some bodies, each on one before it or on the world.
fn tree(random: &mut Random) -> String {
    let count = 1 + random.below(4);
    let mut text = "[parameters]\na = 0.3\nm = 1.5\n[gravity]\nacceleration = [0.5, \"a\", -9.81]\n[definitions]\nhalf = \"a/2\"\n".to_owned();
    let mut starts = String::new();
    for number in 0..count {
        let kind = if number == 0 { *random.pick(&KINDS[1..]) } else { *random.pick(&KINDS) };
        writeln!(text, "[bodies.b{number}]").unwrap();
        let parent = random.below(number + 1);
        if parent > 0 {
            writeln!(text, "parent = \"b{}\"", parent - 1).unwrap();
        }
        let mut joint = format!("kind = \"{kind}\"");
        match kind {
            "revolute" | "prismatic" | "cylindrical" => write!(joint, ", axis = {}", axis(random, false)),
            "screw" => write!(joint, ", axis = {}, pitch = \"half\"", axis(random, false)),
            "planar" => write!(joint, ", axis = {}", axis(random, true)),
            // Two that are not parallel.
            "universal" => write!(joint, ", axes = [[1, 0.2, 0], [0, {}, 1]]", random.decimal(-1.0, 1.0)),
            _ => Ok(()),
        }
        .unwrap();
        if random.chance(70) {
            write!(joint, ", at = {}", vector(random)).unwrap();
        }
        match random.below(4) {
            0 => write!(joint, ", turns = [[\"z\", \"a\"], [\"x\", {}]]", random.decimal(-2.0, 2.0)),
            1 => write!(joint, ", turns = [[\"y\", \"pi/2\"]]"),
            2 => write!(joint, ", rotation = [0, -1, 0, 1, 0, 0, 0, 0, 1]"),
            _ => Ok(()),
        }
        .unwrap();
        writeln!(text, "joint = {{ {joint} }}").unwrap();
        writeln!(text, "mass = \"m + {}\"\ncenter = {}", random.decimal(0.1, 1.0), vector(random)).unwrap();
        let mut moment = || random.decimal(0.5, 1.0);
        writeln!(text, "inertia = [{}, {}, {}, 0.05, -0.1, 0.02]", moment(), moment(), moment()).unwrap();
        if random.chance(30) {
            writeln!(text, "force = [\"t\", 0.3, \"half\"]").unwrap();
        }
        if random.chance(30) {
            writeln!(text, "torque = [0.1, \"sin(t)\", \"a\"]").unwrap();
        }
        if matches!(kind, "revolute" | "prismatic" | "screw") {
            writeln!(starts, "b{number} = {}", random.decimal(-1.0, 1.0)).unwrap();
        }
    }
    writeln!(text, "[coordinates]\n{starts}").unwrap();
    let last = count - 1;
    writeln!(text, "[points.p]\nbody = \"b{last}\"\nat = {}", vector(random)).unwrap();
    writeln!(text, "[outputs]\nx = \"p_x\"\nu = \"p_y'\"\nw = \"d(p_z')\"\nr = \"p_13 + p_31\"").unwrap();
    if random.chance(40) {
        writeln!(text, "[lagrangian]\npotential = \"2*(p_x^2 + p_y^2) + p_z\"").unwrap();
    }
    text
}

#[test]
fn random_trees_are_derived_alike_by_both_routes() {
    let mut compared = 0;
    for number in 0..24 {
        let text = tree(&mut Random::new(17, number));
        let model = Model::new(document(&text));
        let agreement = model.derived(|assembly| {
            verify(&model, assembly, &Options { states: 3, seed: number, ..Options::default() })
        });
        let agreement = agreement.unwrap_or_else(|error| panic!("tree {number}: {error}\n{text}"));
        assert!(agreement.error < TOLERANCE, "tree {number}: {agreement}\n{text}");
        compared += agreement.states;
    }
    // Some end where nothing is regular: a universal joint whose axes are in line.
    assert!(compared > 60, "{compared}");
}
