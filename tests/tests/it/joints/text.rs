//! What else of the format stands beside bodies on joints.

use pc_mech::Graph;
use pc_model::{Flow, Variables};

use super::run::{Run, difference, flow, model, rates};

/// An arm of two links, all of whose parts can be replaced.
const ARM: &str = "[parameters]\nl = 0.5\nm = 2.0\ng = 9.81\n[gravity]\nacceleration = [0, 0, \"-g\"]\n\
    [coordinates]\nlower = 0.3\n[quasi_velocities]\n\"upper'\" = 1.0\n\
    [bodies.upper]\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = \"m\"\ncenter = [0, 0, \"-l/2\"]\n\
    inertia = [\"m*l^2/12\", \"m*l^2/12\", 0]\n\
    [bodies.lower]\nparent = \"upper\"\njoint = { kind = \"revolute\", axis = [0, 1, 0], at = [0, 0, \"-l\"] }\n\
    mass = \"m\"\ncenter = [0, 0, \"-l/2\"]\ninertia = [\"m*l^2/12\", \"m*l^2/12\", 0]\n";

/// The same by positions, in the angles of the joints.
const PLACED: &str = "[parameters]\nl = 0.5\nm = 2.0\ng = 9.81\n[gravity]\nacceleration = [0, 0, \"-g\"]\n\
    [coordinates]\nupper = 0\nlower = 0.3\n[quasi_velocities]\n\"upper'\" = 1.0\n\
    [definitions]\nβ = \"upper + lower\"\n\
    [bodies.upper]\nmass = \"m\"\nposition = [\"-l/2*sin(upper)\", 0, \"-l/2*cos(upper)\"]\n\
    inertia = [\"m*l^2/12\", \"m*l^2/12\", 0]\nangular_velocity = [0, \"upper'\", 0]\n\
    [bodies.lower]\nmass = \"m\"\nposition = [\"-l*sin(upper) - l/2*sin(β)\", 0, \"-l*cos(upper) - l/2*cos(β)\"]\n\
    inertia = [\"m*l^2/12\", \"m*l^2/12\", 0]\nangular_velocity = [0, \"upper' + lower'\", 0]\n";

fn placed() -> String {
    PLACED.replace("β = ", "\"β\" = ")
}

#[test]
fn two_links_swing_as_those_placed_by_hand() {
    let (tree, hand) = (Run::of(&model(ARM), 3.0, 1e-11), Run::of(&model(&placed()), 3.0, 1e-11));
    for name in ["upper", "lower", "upper'", "lower'", "energy"] {
        let apart = difference(&tree.column(name), &hand.column(name));
        assert!(apart < 1e-8, "{name}: {apart}");
    }
}

#[test]
fn points_are_known_everywhere_with_their_velocities() {
    let text = format!(
        "{ARM}[points.tip]\nbody = \"lower\"\nat = [0, 0, \"-l\"]\n[definitions]\nheight = \"tip_z\"\n\
         [states]\nway = {{ rate = \"sqrt(tip_x'^2 + tip_z'^2)\" }}\n\
         [lagrangian]\npotential = \"5*(tip_x - 0.1)^2\"\n[forces]\n\"lower'\" = \"-0.1*tip_x'\"\n\
         [events.low]\nwhen = \"height + 0.95\"\ndirection = \"falling\"\n\
         [outputs]\nx = \"tip_x\"\nu = \"tip_x'\"\nv = \"d(tip_x)\"\na = \"d(tip_x')\"\nr = \"tip_13\"\n"
    );
    let hand = format!(
        "{}tip = \"-l*sin(upper) - l*sin(β)\"\n[lagrangian]\npotential = \"5*(tip - 0.1)^2\"\n\
         [forces]\nlower = \"-0.1*d(tip)\"\n\
         [outputs]\nx = \"tip\"\nu = \"d(tip)\"\nv = \"d(tip)\"\na = \"d(d(tip))\"\nr = \"sin(β)\"\n",
        {
            let text = placed();
            let (head, bodies) = text.split_once("[bodies.upper]").unwrap();
            let (definitions, head) = (
                head.split_once("[definitions]").unwrap().1.to_owned(),
                head.split_once("[definitions]").unwrap().0.to_owned(),
            );
            format!("{head}[bodies.upper]{bodies}[definitions]{definitions}")
        }
    );
    let (one, two) = (Run::of(&model(&text), 2.0, 1e-11), Run::of(&model(&hand), 2.0, 1e-11));
    for name in ["upper", "lower", "x", "u", "v", "a", "r"] {
        let apart = difference(&one.column(name), &two.column(name));
        assert!(apart < 1e-8, "{name}: {apart}");
    }
}

/// Names that are given, beside a coordinate of no joint, and quasi-velocities that are velocities.
#[test]
fn names_can_be_given_and_other_coordinates_stand_beside() {
    let text = ARM
        .replace(
            "axis = [0, 1, 0] }",
            "axis = [0, 1, 0], coordinates = [\"a\"], quasi_velocities = [\"p\"] }",
        )
        .replace("\"upper'\" = 1.0", "p = 1.0\n\"s'\" = 0.5")
        .replace("lower = 0.3", "lower = 0.3\ns = 0.1");
    let text = format!("{text}[lagrangian]\nkinetic = \"s'^2/2\"\npotential = \"2*s^2 + s*a\"\n");
    let model = model(&text);
    assert_eq!(flow(&model).names, ["a", "lower", "s", "p", "lower'", "s'"]);
    let hand = placed()
        .replace("[coordinates]\n", "[coordinates]\ns = 0.1\n")
        .replace("\"upper'\" = 1.0", "\"upper'\" = 1.0\n\"s'\" = 0.5");
    let hand = format!("{hand}[lagrangian]\nkinetic = \"s'^2/2\"\npotential = \"2*s^2 + s*upper\"\n");
    let (one, two) = (Run::of(&model, 2.0, 1e-11), Run::of(&self::model(&hand), 2.0, 1e-11));
    for (own, other) in [("a", "upper"), ("p", "upper'"), ("s", "s"), ("s'", "s'"), ("lower'", "lower'")] {
        assert!(difference(&one.column(own), &two.column(other)) < 1e-8, "{own}");
    }
}

/// Quasi-velocities of one's own, defined by `is` or by kinematics, for what belongs to no joint.
#[test]
fn own_quasi_velocities_stand_beside_joints() {
    let base = ARM.replace("lower = 0.3", "lower = 0.3\nx = 1.0\ny = 0.5");
    let energy = "[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2 + 0.2*x'*upper'\"\npotential = \"x^2 + 2*y^2\"\n";
    let plain = Run::of(&model(&format!("{base}{energy}")), 1.5, 1e-11);
    let with = |lines: &str, kinematics: &str| {
        let text = base.replace("\"upper'\" = 1.0", &format!("\"upper'\" = 1.0\n{lines}"));
        Run::of(&model(&format!("{text}{kinematics}{energy}")), 1.5, 1e-11)
    };
    let defined = with("u = { is = \"x' + 2*y'\" }\nv = { is = \"y' - x*x'\" }", "");
    let given = with("u = 0\nv = 0", "[kinematics]\nx = \"u - v\"\ny = \"v\"\n");
    for run in [defined, given] {
        for name in ["upper", "lower", "x", "y", "energy"] {
            assert!(difference(&plain.column(name), &run.column(name)) < 1e-8, "{name}");
        }
    }
}

/// In momenta the motion is the same, with quaternions and with angles.
#[test]
fn canonical_equations_of_a_tree_move_alike() {
    let text = "[quasi_velocities]\n\"base_ω1\" = 0.4\nbase_v2 = 0.3\n\"arm'\" = 1.0\n\
        [bodies.base]\njoint = { kind = \"free\" }\nmass = 2.0\ncenter = [0.1, 0, 0.2]\ninertia = [0.3, 0.4, 0.5, 0.02, 0, 0]\n\
        [bodies.arm]\nparent = \"base\"\njoint = { kind = \"revolute\", axis = [1, 1, 0], at = [0.5, 0, 0], turns = [[\"z\", 0.3]] }\n\
        mass = 1.0\ncenter = [0, 0, -0.4]\ninertia = [0.1, 0.1, 0.05]\n";
    let model = model(text);
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let canonical = Run::of_flow(Flow::new(&model, &assembly, Variables::Momenta).unwrap(), 2.0, 1e-11);
    let poincare = Run::of(&model, 2.0, 1e-11);
    for name in ["base_x", "base_q1", "arm", "base_ω1", "base_v2", "arm'"] {
        assert!(difference(&canonical.column(name), &poincare.column(name)) < 1e-8, "{name}");
    }
}

/// A stop turns the arm back, and a reset of a quasi-velocity that is a velocity beside others is one of it.
#[test]
fn stops_are_events() {
    let text = "[quasi_velocities]\n\"arm'\" = 1.0\n\"ball_ω1\" = 0.2\n\
        [bodies.arm]\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\ninertia = [0, 0, 1]\n\
        [bodies.ball]\njoint = { kind = \"spherical\" }\ninertia = [1, 2, 3]\n\
        [events.stop]\nwhen = \"arm - 0.5\"\nreset = { \"arm'\" = \"-0.5*arm'\" }\n";
    let model = model(text);
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    assert_eq!(assembly.events.len(), 1);
    let mut flow = flow(&model);
    let start = flow.start.clone();
    let times: Vec<f64> = vec![0.0, 1.0];
    let solved = pc_solve::Solve::new(&mut flow.motion, 0.0, &start)
        .method(&pc_solve::Options::new(pc_solve::Method::Adams))
        .events(&mut flow.events)
        .run(&times)
        .map_err(|failure| failure.error)
        .unwrap();
    let (_, end) = solved.trajectory.iter().last().unwrap();
    // There at 0.5, back with half the speed for 0.5.
    assert!((end[0] - 0.25).abs() < 1e-7, "{end:?}");
}

/// Torque along body axes, force along fixed axes at the mass centre, and the same on the joint.
#[test]
fn forces_act_along_their_axes() {
    let pushed = |line: &str, forces: &str| {
        let text = format!("{ARM}{line}\n{forces}");
        let mut flow = flow(&model(&text));
        let mut state = flow.start.clone();
        (state[0], state[1]) = (0.4, 0.7);
        rates(&mut flow, 0.0, &state)
    };
    // A torque about the axis on the lower link turns both angles; one on the joint the lower alone.
    let torque = pushed("torque = [0.3, 2.0, -0.4]", "");
    let forces = pushed("", "[forces]\n\"upper'\" = 2.0\nlower = 2.0\n");
    assert!(difference(&torque, &forces) < 1e-12);
    // A force (F, 0, 0) at the middle of the lower link, at −l sin α − l/2 sin(α + β) along x.
    let force = pushed("force = [3.0, 0, 0]", "");
    let forces = pushed(
        "",
        "[forces]\n\"upper'\" = \"-3*(l*cos(upper) + l/2*cos(upper + lower))\"\n\"lower'\" = \"-3*l/2*cos(upper + lower)\"\n",
    );
    assert!(difference(&force, &forces) < 1e-12);
}
