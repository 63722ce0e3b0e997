//! Dry friction of contacts: bodies that slide, roll, and begin to slip, against closed forms and equations written by hand.

use super::run::{Run, difference, model};

/// A ball in a vertical plane on a slope of the angle s, downwards along x where s > 0.
fn ball(s: f64, friction: f64, [speed, spin]: [f64; 2]) -> String {
    format!(
        r#"
[parameters]
r = 0.2
m = 1.3
s = {s:?}
mu = {friction:?}
[coordinates]
ball_z = "r/cos(s)"
[quasi_velocities]
"ball_x'" = "{speed:?}*cos(s)"
"ball_z'" = "-{speed:?}*sin(s)"
"ball_φ'" = {spin:?}
[gravity]
acceleration = [0, 0, -9.81]
[bodies.ball]
joint = {{ kind = "planar", axis = [0, 1, 0] }}
mass = "m"
inertia = [0, "0.4*m*r^2", 0]
[contacts.table]
body = "ball"
shape = "sphere"
radius = "r"
normal = ["sin(s)", 0, "cos(s)"]
motion = "slides"
friction = "mu"
[outputs]
way = "table_x/cos(s)"
"#
    )
}

/// With the velocity v and the spin ω about y a ball slips at s = v − ω r, until it rolls with v − 2/7 s.
#[test]
fn a_thrown_ball_comes_to_roll() {
    let (r, m, weight) = (0.2, 1.3, 1.3 * 9.81);
    for (v, spin) in [(2.0, 0.0), (-2.0, 0.0), (1.0, -12.0), (0.5, 9.0), (0.0, 10.0)] {
        let run = Run::of(&model(&ball(0.0, 0.3, [v, spin])), 2.0, 1e-11);
        let slip: f64 = v - spin * r;
        let (pull, rolls) = (-0.3 * weight * slip.signum(), 2.0 * slip.abs() / (7.0 * 0.3 * 9.81));
        let at = |t: f64| {
            let slides = t.min(rolls);
            v * slides + pull / m * slides * slides / 2.0 + (v - slip * 2.0 / 7.0) * (t - slides)
        };
        let (xs, forces) = (run.column("way"), run.column("T_table_1"));
        for (i, (x, force)) in xs.iter().zip(forces).enumerate() {
            let t = 0.1 * i as f64;
            assert!((x - at(t)).abs() < 1e-9, "{v}, {spin}: {x} at {t}, not {}", at(t));
            let expected = if t < rolls { pull } else { 0.0 };
            assert!((force - expected).abs() < 1e-9, "{v}, {spin}: T = {force} at {t}, not {expected}");
        }
    }
}

/// A ball at rest on a slope rolls if tan α ≤ 7/2 μ, with T = −2/7 m g sin α, and slides otherwise, with T = −μ m g cos α.
#[test]
fn a_ball_rolls_down_a_slope_unless_it_is_too_steep() {
    for (s, friction) in [(0.3f64, 0.1), (0.3, 0.08), (-0.3, 0.1), (-0.3, 0.08), (0.9, 0.2), (0.0, 0.1)] {
        let run = Run::of(&model(&ball(s, friction, [0.0, 0.0])), 1.0, 1e-11);
        let rolls = s.tan().abs() <= 3.5 * friction;
        let down = 9.81 * s.sin();
        let pull = if rolls { -2.0 / 7.0 * down } else { -friction * 9.81 * s.cos() * s.signum() };
        let way: Vec<f64> = run.column("way").iter().map(|way| way - run.column("way")[0]).collect();
        let found = [way, run.column("T_table_1"), run.column("N_table")];
        let expected = [(down + pull) / 2.0, 1.3 * pull, 1.3 * 9.81 * s.cos()];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found[20] - expected).abs() < 1e-9, "{s}, {friction}: {} and not {expected}", found[20]);
        }
    }
}

/// A hoop with its mass centre at the distance e from its own, by Lagrange's equations for its place and its angle. N follows from
/// the motion of the mass centre, and T = ∓μ N gives it as one of two fractions.
fn hoop_by_hand(friction: f64) -> String {
    format!(
        r#"
[parameters]
m = 1.1
r = 0.3
e = 0.12
J = 0.05
g = 9.81
mu = {friction:?}
[coordinates]
x = 0.0
"φ" = 0.0
[quasi_velocities]
"x'" = 1.8
"φ'" = 6.0
[lagrangian]
kinetic = "m*(x' + e*φ'*cos(φ))^2/2 + m*(e*φ'*sin(φ))^2/2 + J*φ'^2/2"
potential = "m*g*e*cos(φ)"
[definitions]
D = "J + m*e^2*sin(φ)^2"
free = "m*g*e*sin(φ) - m*e^2*sin(φ)*cos(φ)*φ'^2"
N0 = "m*g - m*e*φ'^2*cos(φ) - m*e*sin(φ)*free/D"
lead = "mu*m*e*sin(φ)*(r + e*cos(φ))/D"
T = "step(x' - r*φ', -mu*N0/(1 + lead), mu*N0/(1 - lead))"
[forces]
x = "T"
"φ" = "-r*T"
[outputs]
N = "m*g - m*e*φ'^2*cos(φ) - m*e*sin(φ)*d(φ')"
along = "m*d(x') + m*e*cos(φ)*d(φ') - m*e*sin(φ)*φ'^2"
"#
    )
}

fn hoop(contact: &str) -> String {
    format!(
        r#"
[parameters]
m = 1.1
r = 0.3
[coordinates]
hoop_z = "r"
[quasi_velocities]
"hoop_x'" = 1.8
"hoop_φ'" = 6.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.hoop]
joint = {{ kind = "planar", axis = [0, 1, 0] }}
mass = "m"
center = [0, 0, 0.12]
inertia = [0, 0.05, 0]
[contacts.table]
body = "hoop"
shape = "disc"
radius = "r"
axis = [0, 1, 0]
{contact}
"#
    )
}

/// The hoop rolls, slips and rolls again in every turn; with little friction it slips most of the time.
#[test]
fn an_eccentric_hoop_slips_as_by_hand() {
    for friction in [0.25, 0.1, 0.05] {
        let contact = format!("motion = \"slides\"\nfriction = {friction:?}");
        let run = Run::of(&model(&hoop(&contact)), 3.0, 1e-12);
        let by_hand = Run::of(&model(&hoop_by_hand(friction)), 3.0, 1e-12);
        for (one, two) in
            [("x", "hoop_x"), ("φ", "hoop_φ"), ("φ'", "hoop_φ'"), ("N", "N_table"), ("along", "T_table_1")]
        {
            let apart = difference(&by_hand.column(one), &run.column(two));
            // Slips and rests follow each other about ten times, and each adds its tolerance.
            assert!(apart < 1e-7, "μ = {friction}, {one}: {apart}");
        }
        let ratio = run
            .column("T_table_1")
            .iter()
            .zip(run.column("N_table"))
            .map(|(t, n)| t.abs() / n)
            .fold(0.0, f64::max);
        assert!(ratio < friction + 1e-9, "{ratio}");
    }
}

/// Where friction suffices throughout, the body rolls as one whose contact rolls.
#[test]
fn friction_that_suffices_is_rolling() {
    let slides = Run::of(&model(&hoop("motion = \"slides\"\nfriction = 0.5")), 3.0, 1e-12);
    let rolls = Run::of(&model(&hoop("motion = \"rolls\"")), 3.0, 1e-12);
    for name in ["hoop_x", "hoop_φ", "energy", "N_table", "T_table_1", "T_table_2"] {
        let apart = difference(&slides.column(name), &rolls.column(name));
        assert!(apart < 1e-8, "{name}: {apart}");
    }
}

/// In space the direction of the slip is constant on a level plane: the centre follows a parabola until the ball rolls, with
/// v − 2/7 s, but for the velocity of creep.
#[test]
fn a_ball_with_side_spin_follows_a_parabola() {
    let text = r#"
[coordinates]
ball_z = 0.2
[quasi_velocities]
ball_v1 = 2.0
"ball_ω1" = 8.0
"ball_ω2" = -3.0
"ball_ω3" = 5.0
[gravity]
acceleration = [0, 0, -9.81]
[bodies.ball]
joint = { kind = "free" }
mass = 1.3
inertia = [0.0208, 0.0208, 0.0208]
[contacts.table]
body = "ball"
shape = "sphere"
radius = 0.2
motion = "slides"
friction = 0.3
creep = 1e-4
"#;
    let run = Run::of(&model(text), 1.0, 1e-10);
    // s = v + ω × (−r n)
    let slip = [2.0 + 3.0 * 0.2, 8.0 * 0.2];
    let size = f64::hypot(slip[0], slip[1]);
    let rolls = 2.0 * size / (7.0 * 0.3 * 9.81);
    for (axis, (x, v)) in [("ball_x", 2.0), ("ball_y", 0.0)].into_iter().enumerate() {
        let pull = -0.3 * 9.81 * slip[axis] / size;
        for (i, found) in run.column(x).into_iter().enumerate() {
            let t = 0.05 * i as f64;
            let slides = t.min(rolls);
            let expected =
                v * slides + pull * slides * slides / 2.0 + (v - slip[axis] * 2.0 / 7.0) * (t - slides);
            // Friction is less than μ N by the fraction (c/s)²/2, where s comes down to c.
            assert!((found - expected).abs() < 1e-6, "{x} at {t}: {found} and not {expected}");
        }
    }
}

/// Two balls of one linkage have a contact each; the friction of one changes the normal force of the other.
#[test]
fn two_contacts_of_a_linkage_are_derived_alike_by_both_routes() {
    let wheel = |name: &str, parent: &str, joint: &str, friction: f64| {
        format!(
            "[bodies.{name}]\n{parent}joint = {{ {joint} }}\nmass = 1.5\ninertia = [0, 0.03, 0]\n\
             [contacts.under_{name}]\nbody = \"{name}\"\nshape = \"disc\"\nradius = 0.2\naxis = [0, 1, 0]\n\
             motion = \"slides\"\nfriction = {friction:?}\n"
        )
    };
    let text = format!(
        "[coordinates]\nframe_z = 0.2\n[quasi_velocities]\n\"frame_x'\" = 1.0\n\"front'\" = 2.0\n\"back'\" = -4.0\n\
         [gravity]\nacceleration = [0, 0, -9.81]\n[bodies.frame]\njoint = {{ kind = \"planar\", axis = [0, 1, 0] }}\nmass = 4\n\
         center = [0.1, 0, 0.3]\ninertia = [0, 0.4, 0]\n{}{}",
        wheel(
            "front",
            "parent = \"frame\"\n",
            "kind = \"revolute\", axis = [0, 1, 0], at = [0.5, 0, 0]",
            0.2
        ),
        wheel(
            "back",
            "parent = \"frame\"\n",
            "kind = \"revolute\", axis = [0, 1, 0], at = [-0.4, 0, 0]",
            0.3
        )
    );
    let run = Run::of(&model(&text), 2.0, 1e-11);
    // Both roll in the end, and nothing pulls at them any more.
    let last = |name: &str| *run.column(name).last().unwrap();
    let speed = last("frame_x'");
    assert!((last("front'") * 0.2 - speed).abs() < 1e-8 && (last("back'") * 0.2 - speed).abs() < 1e-8);
    assert!(last("T_under_front_1").abs() < 1e-8 && last("T_under_back_1").abs() < 1e-8);
    assert!((last("N_under_front") + last("N_under_back") - 7.0 * 9.81).abs() < 1e-8);
    let first = run.column("T_under_front_1")[0] + run.column("T_under_back_1")[0];
    let (front, back) = (run.column("N_under_front")[0], run.column("N_under_back")[0]);
    assert!((first - (-0.2 * front - 0.3 * back)).abs() < 1e-9, "both slip forwards: {first}");
    // The moments about the contact of the front wheel, with the momenta of the wheels.
    assert!((front + back - 7.0 * 9.81).abs() < 1e-9);
}
