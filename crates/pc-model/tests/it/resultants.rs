//! Reactions as forces and torques on bodies: closed forms, Newton's laws, and undetermined components.

use pc_mech::{Graph, Motion, VectorField};
use pc_model::{Document, Model, ModelError, Source};

use crate::random::numbers;
use crate::verified::derived_twice;

fn model(text: &str) -> Model {
    let mut model = derived_twice(Document::parse(Source::new("m.toml", text)).unwrap());
    model.observe_reactions(true);
    model
}

/// The motion of a model, with the names of its state, and the undetermined components.
struct Watched {
    motion: Motion,
    start: Vec<f64>,
    undetermined: Vec<String>,
}

impl Watched {
    fn new(text: &str) -> Watched {
        let model = model(text);
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let (motion, start) = model.compile(&assembly).unwrap();
        Watched { motion, start, undetermined: assembly.constraints.undetermined().to_vec() }
    }

    /// The observables of these names at a state.
    fn at<const N: usize>(&mut self, state: &[f64], names: [&str; N]) -> [f64; N] {
        let values = self.motion.observe(0.0, state);
        let known = self.motion.observable_names();
        names.map(|name| {
            values[known.iter().position(|known| known == name).unwrap_or_else(|| panic!("{name}"))]
        })
    }

    fn rates(&mut self, state: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; state.len()];
        self.motion.rhs(0.0, state, &mut rates).unwrap();
        rates
    }

    /// A state on the constraints, near the start.
    fn near_start(&mut self, next: &mut impl FnMut() -> f64) -> Vec<f64> {
        let mut state: Vec<f64> = self.start.iter().map(|x| x + 0.2 * next()).collect();
        self.motion.project(0.0, &mut state).unwrap();
        state
    }
}

#[track_caller]
fn close(found: &[f64], expected: &[f64]) {
    let size = expected.iter().fold(1.0f64, |size, x| size.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        // Some ten operations with numbers up to some tens.
        assert!((a - b).abs() <= 1e-13 * size, "{found:?} instead of {expected:?}");
    }
}

const PENDULUM: &str = r#"
[coordinates]
x = 0.6
z = -0.8
[quasi_velocities]
"x'" = 0.8
"z'" = 0.6
[bodies.bob]
mass = 2
position = ["x", 0, "z"]
force = [0, 0, -19.6]
[constraints]
length = "x^2 + z^2 - 1"
[outputs]
tension = "-(F_length_bob_x*x + F_length_bob_z*z)"
"#;

/// T = m g cos θ + m l θ̇², θ from the vertical.
#[test]
fn the_rod_of_a_pendulum_pulls_with_its_tension() {
    let mut pendulum = Watched::new(PENDULUM);
    let names = pendulum.motion.observable_names().to_vec();
    let columns = ["energy", "tension", "λ_length", "F_length_bob_x", "F_length_bob_y", "F_length_bob_z"];
    assert_eq!(names, columns);
    let mut next = numbers(1);
    for _ in 0..100 {
        let state = pendulum.near_start(&mut next);
        let [tension, fx, fy, fz] =
            pendulum.at(&state, ["tension", "F_length_bob_x", "F_length_bob_y", "F_length_bob_z"]);
        let expected = 2.0 * 9.8 * -state[1] + 2.0 * (state[2].powi(2) + state[3].powi(2));
        close(&[tension, fx, fy, fz], &[expected, -expected * state[0], 0.0, -expected * state[1]]);
    }
}

/// A sphere that rolls down a plane: friction −(2/7) m g sin α at its centre, and the torque that rotates it.
#[test]
fn friction_of_a_rolling_sphere_is_two_sevenths() {
    let sphere = r#"
[parameters]
m = 3.0
a = 0.5
J = 0.3
G = 7.0
[coordinates]
x = 0.0
"φ" = 0.0
[quasi_velocities]
"x'" = 0.5
"φ'" = 1.0
[bodies.ball]
mass = "m"
position = ["x", 0, "a"]
inertia = ["J", "J", "J"]
angular_velocity = [0, "φ'", 0]
force = ["G", 0, 0]
[constraints]
roll = "x' - a*φ'"
"#;
    let mut ball = Watched::new(sphere);
    let start = ball.start.clone();
    let found = ball.at(&start, ["F_roll_ball_x", "F_roll_ball_y", "F_roll_ball_z"]);
    close(&found, &[-2.0, 0.0, 0.0]);
    close(&ball.at(&start, ["N_roll_ball_1", "N_roll_ball_2", "N_roll_ball_3"]), &[0.0, 1.0, 0.0]);
    assert!(ball.undetermined.is_empty());
}

/// An upright disk on a circle: friction towards the centre m R θ̇ φ̇, none along the path.
#[test]
fn a_disk_on_a_circle_is_held_by_friction() {
    let disk = r#"
[coordinates]
X = 1.0
Y = -1.0
"φ" = 0.2
"θ" = 0.0
[quasi_velocities]
"X'" = "0.5*3*cos(0.2)"
"Y'" = "0.5*3*sin(0.2)"
"φ'" = 0.5
"θ'" = 3.0
[bodies.disk]
mass = 2
position = ["X", "Y", 0.5]
inertia = [0.125, 0.25, 0.125]
angular_velocity = [0, "θ'", "φ'"]
[constraints]
along = "X' - 0.5*θ'*cos(φ)"
across = "Y' - 0.5*θ'*sin(φ)"
"#;
    let mut disk = Watched::new(disk);
    let mut next = numbers(2);
    for _ in 0..100 {
        let state = disk.near_start(&mut next);
        let along = disk.at(&state, ["F_along_disk_x", "F_along_disk_y"]);
        let across = disk.at(&state, ["F_across_disk_x", "F_across_disk_y"]);
        let centripetal = 2.0 * 0.5 * state[7] * state[6];
        let expected = [-centripetal * state[2].sin(), centripetal * state[2].cos()];
        close(&[along[0] + across[0], along[1] + across[1]], &expected);
    }
}

/// A ball on a turntable: the friction is m a, and turns the ball: J ω̇ = a e_z × F, with the contact below.
#[test]
fn friction_drives_the_ball_on_a_turntable() {
    // η = (ẋ, ẏ, ω_x, ω_y), with ṗ = ω_x and q̇ = ω_y: no attitude is needed for the forces.
    let ball = r#"
[parameters]
a = 0.4
W = 2.0
[coordinates]
x = 1.0
y = 0.0
p = 0.0
q = 0.0
[quasi_velocities]
ux = 1.0
uy = 0.5
wx = "(W - 0.5)/a"
wy = "1.0/a"
[kinematics]
x = "ux"
y = "uy"
p = "wx"
q = "wy"
[bodies.ball]
mass = 5
position = ["x", "y", "a"]
inertia = [0.32, 0.32, 0.32]
angular_velocity = ["wx", "wy", 0]
[constraints]
u = "ux - a*wy + W*y"
v = "uy + a*wx - W*x"
"#;
    let mut ball = Watched::new(ball);
    let mut next = numbers(3);
    for _ in 0..100 {
        let state = ball.near_start(&mut next);
        let rates = ball.rates(&state);
        let mut sum = |kind: &str, axis: &str| -> f64 {
            let names = ["u", "v"].map(|constraint| format!("{kind}_{constraint}_ball_{axis}"));
            ball.at(&state, [&names[0], &names[1]]).iter().sum()
        };
        let force = [sum("F", "x"), sum("F", "y")];
        let torque = [sum("N", "1"), sum("N", "2")];
        close(&force, &[5.0 * rates[4], 5.0 * rates[5]]);
        close(&torque, &[0.32 * rates[6], 0.32 * rates[7]]);
        close(&torque, &[0.4 * force[1], -0.4 * force[0]]);
    }
}

/// Two masses on rods in space: m a = w + Σ F of all constraints, and a rod pulls its ends with opposite forces.
#[test]
fn newtons_laws_hold() {
    let text = r#"
[coordinates]
x1 = 0.6
y1 = 0.1
z1 = -0.8
x2 = 1.0
y2 = 0.2
z2 = -1.7
[bodies.upper]
mass = 2
position = ["x1", "y1", "z1"]
force = [0, "-0.3*y1'", -19.6]
[bodies.lower]
mass = 3
position = ["x2", "y2", "z2"]
force = ["z2'", 0, -29.4]
[constraints]
support = "x1^2 + y1^2 + z1^2 - 1.01"
rod = "(x2 - x1)^2 + (y2 - y1)^2 + (z2 - z1)^2 - 0.98"
blade = "x2' - y2*y2'"
"#;
    let mut pair = Watched::new(text);
    let mut next = numbers(4);
    for _ in 0..100 {
        let state = pair.near_start(&mut next);
        let rates = pair.rates(&state);
        let support = pair.at(&state, ["F_support_upper_x", "F_support_upper_y", "F_support_upper_z"]);
        let up = pair.at(&state, ["F_rod_upper_x", "F_rod_upper_y", "F_rod_upper_z"]);
        let down = pair.at(&state, ["F_rod_lower_x", "F_rod_lower_y", "F_rod_lower_z"]);
        let blade = pair.at(&state, ["F_blade_lower_x", "F_blade_lower_y", "F_blade_lower_z"]);
        close(&up, &down.map(|f| -f));
        for i in 0..3 {
            let weight = [[0.0, -0.3 * state[7], -19.6][i], [state[11], 0.0, -29.4][i]];
            close(&[weight[0] + support[i] + up[i]], &[2.0 * rates[6 + i]]);
            close(&[weight[1] + down[i] + blade[i]], &[3.0 * rates[9 + i]]);
        }
    }
    // Only the blade is a constraint on velocities, and only the support acts on the upper bob alone.
    let names = pair.motion.observable_names();
    assert!(
        !names.iter().any(|name| name.starts_with("F_support_lower") || name.starts_with("F_blade_upper"))
    );
}

/// Two masses on a rod by its centre and angle: virtual work does not determine the effect of a blade at one
/// end on each of them, but its effect on a third mass.
#[test]
fn undetermined_reactions_are_left_out() {
    let rod = r#"
[coordinates]
x = 0.0
y = 0.0
"φ" = 0.3
s = 0.0
[bodies.left]
mass = 1
position = ["x - cos(φ)", "y - sin(φ)", 0]
[bodies.right]
mass = 1
position = ["x + cos(φ)", "y + sin(φ)", 0]
[bodies.slide]
mass = 1
position = [0, 0, "s"]
force = [0, 0, -9.8]
[constraints]
blade = "y'*cos(φ) - x'*sin(φ)"
stop = "s"
"#;
    let rod_only = Watched::new(rod);
    assert_eq!(rod_only.undetermined, ["the force on `left`", "the force on `right`"]);
    let names = rod_only.motion.observable_names();
    assert_eq!(
        names[names.len() - 5..],
        ["λ_blade", "λ_stop", "F_stop_slide_x", "F_stop_slide_y", "F_stop_slide_z"]
    );
    let named = format!("{rod}[outputs]\npush = \"2*F_blade_left_x\"\n");
    let error = |text: &str| -> ModelError {
        let model = model(text);
        let graph = Graph::new();
        model.assemble(&graph).map(|_| ()).unwrap_err()
    };
    assert_eq!(
        error(&named).to_string(),
        "m.toml:21:11: [outputs] push: `F_blade_left_x` is not determined: the velocity of the body is tied to others by \
         the choice of coordinates\n    push = \"2*F_blade_left_x\"\n              ^^^^^^^^^^^^^^\n  \
         help: use coordinates in which the body moves independently, and constraints that tie it"
    );
    // A particle has no torque.
    let torque = format!("{rod}[outputs]\npush = \"N_stop_slide_1\"\n");
    assert!(error(&torque).to_string().contains("the name `N_stop_slide_1` is not declared"));
}

/// Kinetic energy of [lagrangian] on the coordinate of a body takes an unknown part of the load.
#[test]
fn kinetic_energy_beside_bodies_shares_the_load() {
    let text = |kinetic: &str| {
        format!(
            "[coordinates]\nx = 0.0\ny = 0.0\n[bodies.bead]\nmass = 1\nposition = [\"x\", 0, 0]\nforce = [1, 0, 0]\n\
             [lagrangian]\nkinetic = \"{kinetic}\"\n[constraints]\ntie = \"x - y\"\n"
        )
    };
    let mut alone = Watched::new(&text("2*y'^2"));
    let start = alone.start.clone();
    // m = 1 and 4 tied together: a = 1/5.
    close(&alone.at(&start, ["F_tie_bead_x"]), &[-0.8]);
    assert_eq!(Watched::new(&text("2*y'^2 + x'^2")).undetermined, ["the force on `bead`"]);
}

#[test]
fn dropped_constraints_exert_no_force() {
    let text = PENDULUM
        .replace("length =", "again = \"x*x' + z*z'\"\nlength =")
        .replace("F_length_bob_x*x", "F_again_bob_x*x");
    let mut pendulum = Watched::new(&text);
    let start = pendulum.start.clone();
    let [tension, along] = pendulum.at(&start, ["tension", "F_length_bob_z"]);
    close(&[tension], &[along * 0.8]);
}
