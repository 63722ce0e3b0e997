//! Contacts: against the same systems with constraints written by hand, their forces against closed forms, and lift-off.

use pc_expr::Events;
use pc_model::{Builtin, Model};
use pc_solve::{Ending, Method, Options, Solve};

use super::run::{Run, difference, flow, model};

/// Two motions with a tolerance of 1e-12 for each step.
const APART: f64 = 1e-9;

fn builtin(name: &str) -> Model {
    Model::new(Builtin::named(name).unwrap().document().unwrap())
}

const COIN: &str = r#"
[parameters]
m = 1.0
r = 1.0
A = 0.25
C = 0.5
[coordinates]
coin_y = "r*cos(1.2)"
coin_z = "r*sin(1.2)"
coin_q0 = "cos(0.6)"
coin_q1 = "sin(0.6)"
[quasi_velocities]
"coin_ω1" = 0.2
"coin_ω2" = 0.5
"coin_ω3" = 4.0
[gravity]
acceleration = [0, 0, -10]
[bodies.coin]
joint = { kind = "free" }
mass = "m"
inertia = ["A", "A", "C"]
[contacts.ground]
body = "coin"
shape = "disc"
radius = "r"
axis = [0, 0, 1]
motion = "rolls"
[outputs]
X = "ground_x"
Y = "ground_y"
height = "ground_z"
gap = "ground_gap"
weight = "1*10 + d(d(coin_z))"
push = "d(d(coin_x))"
"#;

/// The disc that rolls by two quasi-velocities that vanish; Newton's law gives the forces at the contact.
#[test]
fn a_coin_rolls_as_the_tilted_disk() {
    let coin = Run::of(&model(COIN), 3.0, 1e-12);
    let disk = Run::of(&builtin("tilted-disk"), 3.0, 1e-12);
    for name in ["X", "Y", "energy"] {
        let apart = difference(&disk.column(name), &coin.column(name));
        assert!(apart < APART, "{name}: {apart}");
    }
    for (force, by_newton) in [("N_ground", "weight"), ("T_ground_1", "push")] {
        let apart = difference(&coin.column(force), &coin.column(by_newton));
        assert!(apart < 1e-10, "{force}: {apart}");
    }
    for name in ["height", "gap"] {
        assert!(coin.column(name).iter().all(|value| value.abs() < 1e-11), "{name}");
    }
}

const SPHEROID: &str = r#"
[parameters]
m = 1.0
a = 0.3
c = 0.5
A = "m*(a^2 + c^2)/5"
C = "2*m*a^2/5"
[coordinates]
egg_z = "sqrt(a^2*sin(0.9)^2 + c^2*cos(0.9)^2)"
egg_q0 = "cos(0.45)"
egg_q1 = "sin(0.45)"
[quasi_velocities]
"egg_ω1" = 0.0
"egg_ω2" = 1.0
"egg_ω3" = 6.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.egg]
joint = { kind = "free" }
mass = "m"
inertia = ["A", "A", "C"]
[contacts.ground]
body = "egg"
shape = "ellipsoid"
semi_axes = ["a", "a", "c"]
motion = "rolls"
"#;

#[test]
fn an_egg_rolls_as_the_spheroid() {
    let egg = Run::of(&model(SPHEROID), 3.0, 1e-12);
    let spheroid = Run::of(&builtin("rolling-spheroid"), 3.0, 1e-12);
    for (one, two) in [("x", "egg_x"), ("y", "egg_y"), ("energy", "energy")] {
        let apart = difference(&spheroid.column(one), &egg.column(two));
        assert!(apart < APART, "{one}: {apart}");
    }
}

/// The same contact of a body with a position, whose height is written out: the gap vanishes whatever the motion.
#[test]
fn a_body_with_a_position_rolls() {
    let text = Builtin::named("rolling-spheroid").unwrap().text;
    let (before, rest) = text.split_once("[constraints]").unwrap();
    let (_, after) = rest.split_once("[bodies.solid]").unwrap();
    let contact = r#"
[contacts.ground]
body = "solid"
shape = "ellipsoid"
semi_axes = ["a", "a", "c"]
motion = "rolls"
attitude = ["cos(ψ)", "-cos(θ)*sin(ψ)", "sin(θ)*sin(ψ)", "sin(ψ)", "cos(θ)*cos(ψ)", "-sin(θ)*cos(ψ)", 0, "sin(θ)", "cos(θ)"]
[outputs]
along = "ground_slip_1"
turned = "ground_x - x - ρx"
"#;
    let by_contact = model(&format!("{before}[bodies.solid]{after}{contact}"));
    let run = Run::of(&by_contact, 3.0, 1e-12);
    let by_hand = Run::of(&builtin("rolling-spheroid"), 3.0, 1e-12);
    for name in ["x", "y", "θ", "ψ", "φ"] {
        let apart = difference(&by_hand.column(name), &run.column(name));
        assert!(apart < APART, "{name}: {apart}");
    }
    for name in ["along", "turned", "N_ground"] {
        assert!(run.column(name).iter().all(|value| value.abs() < 1e-12), "{name}: {:?}", run.column(name));
    }
}

const RATTLEBACK: &str = r#"
[parameters]
a = 0.2
b = 0.03
c = 0.02
h = 0.01
m = 1.0
A = 2e-4
B = 1.6e-3
C = 1.7e-3
"δ" = 0.0143
[coordinates]
stone_z = "sqrt((a*cos(0.01)*sin(0.02))^2 + (b*sin(0.01))^2 + (c*cos(0.01)*cos(0.02))^2) - h*cos(0.01)*cos(0.02)"
stone_q0 = "cos(0.005)*cos(0.01)"
stone_q1 = "sin(0.005)*cos(0.01)"
stone_q2 = "cos(0.005)*sin(0.01)"
stone_q3 = "sin(0.005)*sin(0.01)"
[quasi_velocities]
"stone_ω1" = 0.0
"stone_ω2" = 0.0
"stone_ω3" = 5.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.stone]
joint = { kind = "free" }
mass = "m"
inertia = ["A*cos(δ)^2 + B*sin(δ)^2", "A*sin(δ)^2 + B*cos(δ)^2", "C", "(A - B)*sin(δ)*cos(δ)", 0, 0]
[contacts.ground]
body = "stone"
shape = "ellipsoid"
semi_axes = ["a", "b", "c"]
at = [0, 0, "h"]
motion = "rolls"
"#;

#[test]
fn a_rattleback_rattles() {
    let stone = Run::of(&model(RATTLEBACK), 1.0, 1e-12);
    let by_hand = Run::of(&builtin("rattleback"), 1.0, 1e-12);
    for (one, two) in
        [("x", "stone_x"), ("z", "stone_z"), ("ω1", "stone_ω1"), ("ω2", "stone_ω2"), ("ω3", "stone_ω3")]
    {
        let apart = difference(&by_hand.column(one), &stone.column(two));
        assert!(apart < APART, "{one}: {apart}");
    }
}

const ELLIPSE: &str = r#"
[parameters]
a = 0.5
b = 0.3
[coordinates]
egg_z = "b"
[quasi_velocities]
"egg_φ'" = 2.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.egg]
joint = { kind = "planar", axis = [0, 1, 0] }
mass = 1
inertia = [0, "(a^2 + b^2)/4", 0]
[contacts.table]
body = "egg"
shape = "ellipsoid"
semi_axes = ["a", 1, "b"]
motion = "rolls"
"#;

/// An ellipse rolls on a line with T = ½ (J + m ρ²) φ'², ρ² = h² + h'(φ)², where h is the height of its centre, which is what it
/// moves on by with its turn, too.
#[test]
fn an_ellipse_rolls_by_its_angle() {
    let by_hand = model(
        r#"
[coordinates]
x = 0.0
"φ" = 0.0
[quasi_velocities]
"φ'" = 2.0
[definitions]
h = "sqrt(0.25*sin(φ)^2 + 0.09*cos(φ)^2)"
[constraints]
rolls = "x' - h*φ'"
[lagrangian]
kinetic = "(x'^2 + d(h)^2 + 0.085*φ'^2)/2"
potential = "9.81*h"
"#,
    );
    let (egg, by_hand) = (Run::of(&model(ELLIPSE), 3.0, 1e-12), Run::of(&by_hand, 3.0, 1e-12));
    for (one, two) in [("φ", "egg_φ"), ("x", "egg_x"), ("energy", "energy")] {
        let apart = difference(&by_hand.column(one), &egg.column(two));
        assert!(apart < APART, "{one}: {apart}");
    }
}

/// A ball on a slope: s'' = (5/7) g sin α if it rolls, g sin α if it slides, and N = m g cos α.
#[test]
fn a_ball_rolls_or_slides_down_a_slope() {
    for (motion, share) in [("rolls", 5.0 / 7.0), ("slides", 1.0)] {
        let text = format!(
            r#"
[parameters]
r = 0.1
s = 0.3
m = 2.0
[coordinates]
ball_z = "r/cos(s)"
[gravity]
acceleration = [0, 0, -9.81]
[bodies.ball]
joint = {{ kind = "free" }}
mass = "m"
inertia = ["0.4*m*r^2", "0.4*m*r^2", "0.4*m*r^2"]
[contacts.slope]
body = "ball"
shape = "sphere"
radius = "r"
normal = ["2*sin(s)", 0, "2*cos(s)"]
motion = "{motion}"
[outputs]
speed = "sqrt(ball_x'^2 + ball_z'^2)"
slip = "slope_slip_1"
"#
        );
        let run = Run::of(&model(&text), 1.0, 1e-11);
        let (sin, cos) = 0.3f64.sin_cos();
        let near = |name: &str, at_end: f64, tolerance: f64| {
            let found = *run.column(name).last().unwrap();
            assert!((found - at_end).abs() < tolerance, "{motion}: {name} {found}, not {at_end}");
        };
        near("speed", share * 9.81 * sin, 1e-9);
        near("slip", if motion == "slides" { 9.81 * sin } else { 0.0 }, 1e-9);
        near("N_slope", 2.0 * 9.81 * cos, 1e-9);
        if motion == "rolls" {
            // Friction turns the ball: T r = J ω' with ω' = s''/r; it points up the slope.
            near("T_slope_1", -0.4 * 2.0 * share * 9.81 * sin, 1e-9);
            near("T_slope_2", 0.0, 1e-12);
        }
    }
}

/// The time at which a run ends, with the name of the event that ends it.
fn ended(model: &Model, end: f64) -> (f64, Option<String>) {
    let mut flow = flow(model);
    let options = Options::new(Method::Adams).relative_tolerance(1e-11).absolute_tolerance(1e-13);
    let (start, events) = (flow.start.clone(), flow.events.clone());
    let solve = Solve::new(&mut flow.motion, 0.0, &start).method(&options).events(&mut flow.events);
    let solution = solve.run(&[end]).map_err(|failure| failure.error).unwrap();
    match solution.ending {
        Some(Ending::Event { event }) => {
            (solution.occurrences.last().unwrap().time, Some(events.events()[event].name().to_owned()))
        }
        _ => (end, None),
    }
}

/// A ball that is pulled up by the force k t leaves the ground at t = m g/k; a contact that keeps never ends.
#[test]
fn a_ball_lifts_off() {
    for (form, keeps) in [("free", false), ("free", true), ("planar", false)] {
        let joint = match form {
            "free" => "kind = \"free\"",
            _ => "kind = \"planar\", axis = [0, 1, 0]",
        };
        let text = format!(
            "[parameters]\nk = 10.0\n[coordinates]\nball_z = 0.1\n[gravity]\nacceleration = [0, 0, -9.81]\n\
             [bodies.ball]\njoint = {{ {joint} }}\nmass = 2\ninertia = [0.008, 0.008, 0.008]\nforce = [0, 0, \"k*t\"]\n\
             [contacts.ground]\nbody = \"ball\"\nshape = \"sphere\"\nradius = 0.1\nmotion = \"rolls\"\nkeeps = {keeps}\n"
        );
        let (t, event) = ended(&model(&text), 3.0);
        if keeps {
            assert_eq!((t, event), (3.0, None));
        } else {
            assert_eq!(event.as_deref(), Some("ground_lift_off"), "{form}");
            assert!((t - 2.0 * 9.81 / 10.0).abs() < 1e-9, "{form}: {t}");
        }
    }
}

/// An event may watch the friction that rolling needs: under a force F t along the ground a ball with the moment of
/// inertia ⅖ m r² needs T = −(2/7) F t, and slips where this is μ m g.
#[test]
fn a_ball_begins_to_slip() {
    let text = "[coordinates]\nball_z = 0.1\n[gravity]\nacceleration = [0, 0, -9.81]\n\
        [bodies.ball]\njoint = { kind = \"free\" }\nmass = 2\ninertia = [0.008, 0.008, 0.008]\nforce = [\"20*t\", 0, 0]\n\
        [contacts.ground]\nbody = \"ball\"\nshape = \"sphere\"\nradius = 0.1\nmotion = \"rolls\"\n\
        [events.slips]\nwhen = \"T_ground_1^2 + T_ground_2^2 - (0.1*N_ground)^2\"\ndirection = \"rising\"\nterminal = true\n";
    let (t, event) = ended(&model(text), 3.0);
    assert_eq!(event.as_deref(), Some("slips"));
    assert!((t - 0.1 * 2.0 * 9.81 * 7.0 / (2.0 * 20.0)).abs() < 1e-9, "{t}");
}

/// A tricycle with rolling wheels, whose rear wheels do not slip sideways and whose front wheel is turned by δ: it goes round a
/// circle, ψ' = v tan δ/L, and the wheels on the outside turn faster.
#[test]
fn a_tricycle_steers() {
    let wheel = |name: &str, at: &str, turns: &str| {
        format!(
            "[bodies.{name}]\nparent = \"frame\"\njoint = {{ kind = \"revolute\", axis = [0, 1, 0], at = {at}{turns} }}\n\
             mass = 1\ninertia = [0.02, 0.04, 0.02]\n\
             [contacts.under_{name}]\nbody = \"{name}\"\nshape = \"disc\"\nradius = 0.3\naxis = [0, 1, 0]\nmotion = \"rolls\"\n"
        )
    };
    let text = format!(
        "[quasi_velocities]\n\"front'\" = 2.0\n\
         [bodies.frame]\njoint = {{ kind = \"planar\", axis = [0, 0, 1], at = [0, 0, 0.3] }}\nmass = 10\n\
         center = [0.4, 0, 0]\ninertia = [1, 1, 1]\nforce = [0.5, 0.2, 0]\n{}{}{}\
         [outputs]\nalong = \"frame_x'*cos(frame_φ) + frame_y'*sin(frame_φ)\"\n\
         across = \"-frame_x'*sin(frame_φ) + frame_y'*cos(frame_φ)\"\nyaw = \"frame_φ'\"\nleft_rate = \"left'\"\n",
        wheel("left", "[0, 0.4, 0]", ""),
        wheel("right", "[0, -0.4, 0]", ""),
        wheel("front", "[1.2, 0, 0]", ", turns = [[\"z\", 0.3]]"),
    );
    let run = Run::of(&model(&text), 2.0, 1e-11);
    let (along, yaw) = (run.column("along"), run.column("yaw"));
    assert!(along.iter().all(|v| v.abs() > 0.1), "{along:?}");
    let expected: Vec<f64> = along.iter().map(|v| v * 0.3f64.tan() / 1.2).collect();
    assert!(difference(&expected, &yaw) < 1e-10);
    assert!(run.column("across").iter().all(|v| v.abs() < 1e-10));
    let rates: Vec<f64> = along.iter().zip(&yaw).map(|(v, w)| (v - 0.4 * w) / 0.3).collect();
    assert!(difference(&rates, &run.column("left_rate")) < 1e-10);
}

/// The lines of a text in which a motion is formulated, without its parameters, start values and drawings.
fn formulated(text: &str) -> usize {
    let given = ["[parameters]", "[model]", "[simulation]", "[coordinates]", "[[draw]]", "[outputs]"];
    let (mut section, mut count) = ("", 0);
    for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if line.starts_with('[') {
            section = line;
        }
        let is_start = section.starts_with("[quasi_velocities]") && !line.contains("is =");
        count += usize::from(!is_start && !given.iter().any(|given| section.starts_with(given)));
    }
    count
}

/// Contacts say in fewer lines, and without a formula, what is worked out by hand in the built-in models.
#[test]
fn contacts_shorten_texts() {
    let by_hand = |name: &str| formulated(Builtin::named(name).unwrap().text);
    assert_eq!((formulated(RATTLEBACK), by_hand("rattleback")), (12, 30));
    assert_eq!((formulated(SPHEROID), by_hand("rolling-spheroid")), (11, 23));
    assert_eq!((formulated(COIN), by_hand("tilted-disk")), (12, 19));
}
