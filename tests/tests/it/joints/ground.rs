//! Contacts with uneven ground: against the same systems by hand, against planes, and integrals of a ball in a bowl.

use std::fmt::Write;

use pc_model::{Document, Model, Source};
use pc_tests::fuzz::random::Random;
use pc_verify::{TOLERANCE, verify};

use super::run::{Run, difference, document, model};

/// Two motions with a tolerance of 1e-12 for each step.
const APART: f64 = 1e-9;

/// A wheel on a street of the height a cos k s, by its point of contact: it is at (s, h) and the centre at r n from there. That it
/// rolls ties the velocity of the centre along the street, v, to its turn, v = r φ'.
const WHEEL_BY_HAND: &str = r#"
[parameters]
r = 0.3
a = 0.1
k = 2.0
[coordinates]
s = 0.0
"φ" = 0.0
[definitions]
slope = "-a*k*sin(k*s)"
length = "sqrt(1 + slope^2)"
across = "s - r*slope/length"
up = "a*cos(k*s) + r/length"
[quasi_velocities]
"φ'" = 3.0
[constraints]
rolls = "(d(across) + slope*d(up))/length - r*φ'"
[lagrangian]
kinetic = "(d(across)^2 + d(up)^2)/2 + r^2/4*φ'^2"
potential = "9.81*up"
"#;

const WHEEL: &str = r#"
[parameters]
r = 0.3
a = 0.1
k = 2.0
[coordinates]
wheel_z = "a + r"
[quasi_velocities]
"wheel_φ'" = 3.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.wheel]
joint = { kind = "planar", axis = [0, 1, 0] }
mass = 1
inertia = [0, "r^2/2", 0]
[contacts.street]
body = "wheel"
shape = "disc"
radius = "r"
axis = [0, 1, 0]
height = "a*cos(k*street_x)"
motion = "rolls"
[outputs]
push = "d(d(wheel_x))"
lift = "9.81 + d(d(wheel_z))"
"#;

#[test]
fn a_wheel_rolls_over_bumps() {
    let (wheel, by_hand) = (Run::of(&model(WHEEL), 3.0, 1e-12), Run::of(&model(WHEEL_BY_HAND), 3.0, 1e-12));
    for (one, two) in [("s", "street_x"), ("φ", "wheel_φ"), ("s'", "street_x'"), ("energy", "energy")] {
        let apart = difference(&by_hand.column(one), &wheel.column(two));
        assert!(apart < APART, "{one}: {apart}");
    }
    // N n + T t is what Newton's law asks for.
    let (n, t) = (wheel.column("N_street"), wheel.column("T_street_1"));
    for (i, s) in wheel.column("street_x").into_iter().enumerate() {
        let slope = -0.2 * (2.0 * s).sin();
        let length = slope.hypot(1.0);
        let push = (t[i] - slope * n[i]) / length - wheel.column("push")[i];
        let lift = (n[i] + slope * t[i]) / length - wheel.column("lift")[i];
        assert!(push.abs() < 1e-10 && lift.abs() < 1e-10, "{s}: {push}, {lift}");
    }
}

/// An upright wheel that is free to turn about the vertical, and crosses the street at an angle: it meets bumps that are longer by the
/// cosine of the angle. Their slope across the wheel does not turn it, since the force across vanishes in total.
#[test]
fn an_upright_wheel_crosses_a_street() {
    let text = r#"
[parameters]
r = 0.3
a = 0.1
k = 2.0
[coordinates]
"fork_φ" = 0.4
post = "a + r"
[quasi_velocities]
"wheel'" = 3.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.fork]
joint = { kind = "planar", axis = [0, 0, 1] }
[bodies.post]
parent = "fork"
joint = { kind = "prismatic", axis = [0, 0, 1] }
[bodies.wheel]
parent = "post"
joint = { kind = "revolute", axis = [0, 1, 0] }
mass = 1
inertia = ["r^2/4", "r^2/2", "r^2/4"]
[contacts.street]
body = "wheel"
shape = "disc"
radius = "r"
axis = [0, 1, 0]
height = "a*cos(k*street_x)"
motion = "rolls"
"#;
    let by_hand = WHEEL_BY_HAND.replace("k = 2.0", &format!("k = {}", 2.0 * 0.4f64.cos()));
    let (wheel, by_hand) = (Run::of(&model(text), 3.0, 1e-12), Run::of(&model(&by_hand), 3.0, 1e-12));
    for (one, two) in [("φ", "wheel"), ("energy", "energy")] {
        let apart = difference(&by_hand.column(one), &wheel.column(two));
        assert!(apart < APART, "{one}: {apart}");
    }
    let along: Vec<f64> = by_hand.column("s").iter().map(|s| s * 0.4f64.cos()).collect();
    assert!(difference(&along, &wheel.column("street_x")) < APART);
    assert!(wheel.column("fork_φ").iter().all(|angle| (angle - 0.4).abs() < 1e-10));
}

/// A ball in a bowl, which it touches away from the bottom.
fn ball(height: &str, motion: &str) -> String {
    format!(
        r#"
[parameters]
r = 0.2
R = 1.5
[coordinates]
ball_x = "(R - r)*sin(0.4)"
ball_z = "R - (R - r)*cos(0.4)"
[quasi_velocities]
"ball_ω1" = 1.0
"ball_ω2" = 0.5
"ball_ω3" = 4.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.ball]
joint = {{ kind = "free" }}
mass = 1
inertia = ["0.4*r^2", "0.4*r^2", "0.4*r^2"]
[contacts.bowl]
body = "ball"
shape = "sphere"
radius = "r"
motion = "{motion}"
height = "{height}"
[outputs]
along_normal = "L_ball_x*(ball_x - bowl_x) + L_ball_y*(ball_y - bowl_y) + L_ball_z*(ball_z - bowl_z)"
about_vertical = "L_ball_z - r/(R - r)*(ball_x*p_ball_y - ball_y*p_ball_x)"
momentum = "ball_x*p_ball_y - ball_y*p_ball_x"
spin = "L_ball_z"
"#
    )
}

const SPHERICAL: &str = "R - sqrt(R^2 - bowl_x^2 - bowl_y^2)";

/// In a spherical bowl the spin about the normal stays, and so does J ω_z − m r (e × v)_z with the unit vector e from the ball to the
/// contact, whose rate is v/(R − r). A ball that slides keeps its angular momentum about the vertical, and its spin.
#[test]
fn a_ball_rolls_in_a_bowl() {
    for motion in ["rolls", "slides"] {
        let run = Run::of(&model(&ball(SPHERICAL, motion)), 3.0, 1e-12);
        let of_turn =
            if motion == "rolls" { ["along_normal", "about_vertical"] } else { ["spin", "momentum"] };
        for kept in ["energy", of_turn[0], of_turn[1]] {
            let values = run.column(kept);
            let drift = values.iter().fold(0.0f64, |drift, value| drift.max((value - values[0]).abs()));
            assert!(drift < 1e-9, "{motion}: {kept} {values:?}");
        }
        // The point of contact was found at the start, and lies behind the centre of the ball as seen from that of the bowl.
        let expected: Vec<f64> = run.column("ball_x").iter().map(|x| x * 1.5 / 1.3).collect();
        assert!(difference(&expected, &run.column("bowl_x")) < 1e-11);
        assert!((run.column("bowl_x")[0] - 1.5 * 0.4f64.sin()).abs() < 1e-14);
    }
}

/// The same slope as the height of a ground and as a plane.
#[test]
fn an_even_slope_is_a_plane() {
    let text = |ground: &str| {
        format!(
            "[parameters]\na = 0.3\n[coordinates]\nball_z = \"0.1*sqrt(1 + a^2) + 0.05\"\n[quasi_velocities]\n\"ball_ω1\" = 1\n\"ball_ω3\" = 2\n\
             [gravity]\nacceleration = [0, 0, -9.81]\n[bodies.ball]\njoint = {{ kind = \"free\" }}\nmass = 2\n\
             inertia = [0.008, 0.008, 0.008]\n[contacts.slope]\nbody = \"ball\"\nshape = \"sphere\"\nradius = 0.1\n\
             motion = \"rolls\"\n{ground}\n[outputs]\nx = \"slope_x\"\ny = \"slope_y\"\nz = \"slope_z\"\n"
        )
    };
    let plane = text("normal = [\"-a\", 0, 1]\nthrough = [0, 0, 0.05]");
    let plane = Run::of(&model(&plane), 1.0, 1e-12);
    for height in ["a*slope_x + 0.05", "a*slope_x + 0.05 + 0*slope_y"] {
        let ground = Run::of(&model(&text(&format!("height = \"{height}\""))), 1.0, 1e-12);
        for name in ["ball_x", "ball_y", "ball_z", "x", "y", "z", "N_slope", "T_slope_1", "T_slope_2"] {
            let apart = difference(&plane.column(name), &ground.column(name));
            // Steps are chosen by all coordinates, of which the ground has one more.
            assert!(apart < 1e-11, "{height}: {name} {apart}");
        }
        let first = |run: &Run, name: &str| run.column(name)[0];
        for name in ["N_slope", "T_slope_1", "T_slope_2"] {
            let apart = first(&plane, name) - first(&ground, name);
            assert!(apart.abs() < 1e-12, "{height}: {name} {apart}");
        }
    }
    let level = Run::of(&model(&text("height = 0.05").replace("sqrt(1 + a^2)", "1")), 1.0, 1e-12);
    assert!(level.column("N_slope").iter().all(|n| (n - 2.0 * 9.81).abs() < 1e-12));
}

/// The wheel of [`WHEEL`] as a body with a position, with velocities of its own by each of the ways in which these are given.
#[test]
fn a_body_with_a_position_rolls_over_bumps() {
    let text = |velocities: &str| {
        format!(
            r#"
[parameters]
r = 0.3
a = 0.1
k = 2.0
[coordinates]
x = 0.0
z = "a + r"
"φ" = 0
[functions]
h = {{ of = "s", is = "a*cos(k*s)" }}
[gravity]
acceleration = [0, 0, -9.81]
[bodies.wheel]
position = ["x", 0, "z"]
rotation = ["cos(φ)", 0, "sin(φ)", 0, 1, 0, "-sin(φ)", 0, "cos(φ)"]
mass = 1
inertia = ["r^2/4", "r^2/2", "r^2/4"]
[contacts.street]
body = "wheel"
shape = "disc"
radius = "r"
axis = [0, 1, 0]
height = "h(street_x)"
motion = "rolls"
{velocities}
"#
        )
    };
    let by_hand = Run::of(&model(WHEEL_BY_HAND), 3.0, 1e-12);
    for velocities in [
        "[quasi_velocities]\n\"φ'\" = 3.0",
        "[quasi_velocities]\nturn = { is = \"φ'\", start = 3.0 }",
        "[quasi_velocities]\nturn = { is = \"φ'\", start = 3.0 }\nrise = { is = \"z'\" }\nalong = { is = \"street_x'\" }",
        "[quasi_velocities]\nu = 0.9\nv = 0\nw = 3.0\n[kinematics]\nx = \"u\"\nz = \"v\"\n\"φ\" = \"w\"",
    ] {
        let run = Run::of(&model(&text(velocities)), 3.0, 1e-12);
        for (one, two) in [("s", "street_x"), ("φ", "φ"), ("energy", "energy")] {
            let apart = difference(&by_hand.column(one), &run.column(two));
            assert!(apart < APART, "{velocities}: {one} {apart}");
        }
    }
}

/// The lines in which a motion is formulated: bodies, joints, contacts, constraints, energies and definitions.
#[test]
fn heights_shorten_texts() {
    let sections = |text: &str, wanted: &[&str]| {
        let mut section = "";
        let mut lines = 0;
        for line in text.lines().filter(|line| !line.is_empty()) {
            section = if line.starts_with('[') { line } else { section };
            lines += usize::from(
                !line.starts_with('[') && wanted.contains(&section) && line.contains(['*', '/', '+']),
            );
        }
        lines
    };
    // Lines with a formula: the height and the moment of inertia.
    let by_contact = sections(WHEEL, &["[bodies.wheel]", "[contacts.street]"]);
    let by_hand = sections(WHEEL_BY_HAND, &["[definitions]", "[constraints]", "[lagrangian]"]);
    assert_eq!((by_contact, by_hand), (2, 7));
}

/// A body on a free joint that touches random ground at a random point, with a sphere, a disc or an ellipsoid.
fn touching(random: &mut Random, shape: u64) -> String {
    let mut any = |size: f64| random.decimal(-size, size);
    let (sx, sy) = (any(0.5), any(0.5));
    let length = (1.0 + sx * sx + sy * sy).sqrt();
    let n = [-sx / length, -sy / length, 1.0 / length];
    let (p, curved) = ([any(1.0), any(1.0), any(1.0)], [any(0.3), any(0.3), any(0.3)]);
    let at = [any(0.5), any(0.5), any(0.5)];
    let mut half = || random.decimal(0.2, 0.9);
    let half = [half(), half(), half()];
    let (shape, arm) = match shape {
        0 => (format!("\"sphere\"\nradius = {}", half[0]), n.map(|part| -half[0] * part)),
        1 => {
            let size = n[0].hypot(n[2]);
            let arm = [-half[0] * n[0] / size, 0.0, -half[0] * n[2] / size];
            (format!("\"disc\"\naxis = [0, 2, 0]\nradius = {}", half[0]), arm)
        }
        _ => {
            let size: f64 = half.iter().zip(n).map(|(a, n)| (a * n).powi(2)).sum::<f64>().sqrt();
            let arm = [0, 1, 2].map(|i| -half[i] * half[i] * n[i] / size);
            (format!("\"ellipsoid\"\nsemi_axes = {half:?}"), arm)
        }
    };
    let mut text = String::new();
    writeln!(text, "[coordinates]").unwrap();
    for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
        writeln!(text, "b_{axis} = {:?}", p[i] - at[i] - arm[i]).unwrap();
    }
    if random.chance(50) {
        writeln!(text, "c_x = {:?}\nc_y = {:?}", p[0], p[1]).unwrap();
    }
    writeln!(text, "[quasi_velocities]\n\"b_ω1\" = 0.3\n\"b_ω2\" = -0.4\n\"b_ω3\" = 1.2").unwrap();
    writeln!(text, "[bodies.b]\njoint = {{ kind = \"free\" }}\nmass = 1.5").unwrap();
    writeln!(text, "center = [0.1, 0.2, -0.1]\ninertia = [0.5, 0.7, 0.6, 0.05, 0, 0.1]").unwrap();
    writeln!(text, "[gravity]\nacceleration = [0.2, 0.1, -9.81]").unwrap();
    writeln!(text, "[functions]\nf = {{ of = \"x, y\", is = \"{:?}*x + {:?}*y + {:?}*x*sin(x) + {:?}*x*y + {:?}*(exp(y) - 1 - y)\" }}",
        sx, sy, curved[0], curved[1], curved[2]).unwrap();
    writeln!(text, "[contacts.c]\nbody = \"b\"\nshape = {shape}\nat = {at:?}").unwrap();
    writeln!(text, "height = \"{:?} + f(c_x - ({:?}), c_y - ({:?}))\"", p[2], p[0], p[1]).unwrap();
    writeln!(text, "motion = \"{}\"", if random.chance(70) { "rolls" } else { "slides" }).unwrap();
    writeln!(text, "[outputs]\nx = \"c_x\"\nspeed = \"c_z'\"\nslip = \"c_slip_2\"\nrate = \"d(c_slip_1)\"")
        .unwrap();
    text
}

#[test]
fn random_ground_is_derived_alike_by_both_routes() {
    for number in 0..3 {
        let text = touching(&mut Random::new(29, number), number);
        let model = Model::new(document(&text));
        let options = pc_verify::Options { states: 1, seed: number, ..pc_verify::Options::default() };
        let agreement = model.derived(|assembly| verify(&model, assembly, &options));
        let agreement = agreement.unwrap_or_else(|error| panic!("ground {number}: {error}\n{text}"));
        assert!(agreement.error < TOLERANCE, "ground {number}: {agreement}\n{text}");
        let run = Run::of(&model, 0.2, 1e-10);
        let energy = run.column("energy");
        assert!((energy[20] - energy[0]).abs() < 1e-7, "ground {number}: {energy:?}\n{text}");
    }
}

/// Each smooth function of the language in the height is differentiated alike by both routes; those with corners are refused, since
/// velocities would jump there.
#[test]
fn heights_may_contain_all_smooth_functions() {
    for height in [
        "0.1*sin(2*s_x)*cos(s_y)",
        "0.1*tan(s_x) + 0.1*atan(s_y) + 0.1*cot(s_x + 1)",
        "0.1*asin(s_x/3)*acos(s_y/3)",
        "0.1*atan2(s_x + 2, s_y - 3)",
        "0.1*sinh(s_x) + 0.1*cosh(s_y)*tanh(s_x)",
        "0.1*log(2 + s_x) - 0.1*exp(-s_y)/sqrt(2 + s_x)",
        "0.1*(2 + s_x)^1.5 + 0.1*2^s_y - 0.1*(1.5 + s_x)^s_y",
    ] {
        let text = format!(
            "[coordinates]\nb_z = 0.5\n[quasi_velocities]\n\"b_ω1\" = 0.3\n\"b_ω2\" = -0.4\n[bodies.b]\njoint = {{ kind = \"free\" }}\n\
             mass = 1\ninertia = [0.5, 0.5, 0.5]\n[contacts.s]\nbody = \"b\"\nshape = \"sphere\"\nradius = 0.3\nmotion = \"rolls\"\n\
             height = \"{height}\"\n[outputs]\nz = \"s_z\"\n"
        );
        let mut model = Model::new(document(&text));
        model.project_start(true);
        let options = pc_verify::Options { states: 2, seed: 1, ..pc_verify::Options::default() };
        let agreement = model.derived(|assembly| verify(&model, assembly, &options));
        let agreement = agreement.unwrap_or_else(|error| panic!("{height}: {error}"));
        assert!(agreement.error < TOLERANCE, "{height}: {agreement}");
    }
}

const REFUSED: &[(&str, &str)] = &[
    (
        "height = \"0.1*ball_x\"",
        r#"m.toml:10:15: [contacts.c] height: `ball_x` cannot be used in the height of the ground
    height = "0.1*ball_x"
                  ^^^^^^
  help: use numbers, parameters, and NAME_x and NAME_y of this contact only"#,
    ),
    (
        "height = \"c_z\"",
        r#"m.toml:10:11: [contacts.c] height: `c_z` cannot be used in the height of the ground
    height = "c_z"
              ^^^
  help: use numbers, parameters, and NAME_x and NAME_y of this contact only"#,
    ),
    (
        "height = \"0.1*c_x\"\nnormal = [0, 0, 1]",
        r#"m.toml:10:1: [contacts.c] height: `height` and `normal` exclude each other
    height = "0.1*c_x"
    ^^^^^^
  help: write `normal` and `through` for a plane, and `height` for uneven ground"#,
    ),
    (
        "height = \"0.1*c_x\"\n[coordinates]\nc_y = 1",
        r#"m.toml:12:1: [coordinates] c_y: `c_y` is already the name of a component of a contact (line 5)
    c_y = 1
    ^^^
  help: parameters, inputs, functions, definitions, coordinates, quasi-velocities, states, integrals and outputs share one namespace; choose another name, such as `c_y_1`"#,
    ),
    (
        "height = \"c_x^2\"\n[coordinates]\nball_z = 1\nc_x = 0.5",
        r#"m.toml:5:11: [contacts] c: the start is off the constraint `c_off_x`: it is 0.25, not 0
    [contacts.c]
              ^
  help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)"#,
    ),
];

#[test]
fn wrong_ground_is_refused() {
    let ball = "[bodies.ball]\njoint = { kind = \"free\" }\nmass = 1\ninertia = [1, 1, 1]\n[contacts.c]\nbody = \"ball\"\n\
                shape = \"sphere\"\nradius = 1\nmotion = \"rolls\"\n";
    let mut complaints = String::new();
    for (entries, message) in REFUSED {
        let refused = Document::parse(Source::new("m.toml", format!("{ball}{entries}\n")))
            .and_then(|document| Model::new(document).assemble(&pc_mech::Graph::new()).map(|_| ()));
        let found = refused.err().map_or_else(|| "accepted".to_owned(), |error| error.to_string());
        if found.trim_end() != *message {
            writeln!(complaints, "{entries}\n{found}\n").unwrap();
        }
    }
    assert!(complaints.is_empty(), "{complaints}");
}
