//! `[bodies.NAME]`: contributions to the energy and the forces, and every refusal in full.

use pc_mech::{Expr, Graph, System};
use pc_model::{Category, Document, Model, ModelError, Source};

use crate::verified::derived_twice;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn system<'g>(graph: &'g Graph, text: &str) -> System<'g> {
    model(text).assemble(graph).unwrap_or_else(|error| panic!("{error}")).system
}

fn refused(text: &str) -> ModelError {
    match model(text).assemble(&Graph::new()) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error,
    }
}

const PENDULUM: &str = r#"
[parameters]
m = 2.0
M = 1.0
l = 0.5
g = 9.8
k = 0.1

[coordinates]
s = 0.0
"φ" = 1.0

[definitions]
depth = "l*cos(φ)"

[bodies.cart]
mass = "M"
position = ["s", 0, 0]

[bodies."the bob"]
mass = "m"
position = ["s + l*sin(φ)", 0, "-depth"]
force = ["-k*s'", 0, "-m*g"]
"#;

/// No `[lagrangian]` is needed; the weight counts in the energy, and the drag −k ṡ along the first axis is a force.
#[test]
fn particles_give_the_energy_and_the_forces() {
    let graph = Graph::new();
    let pendulum = system(&graph, PENDULUM);
    let [m, cart, l, g, k] = graph.symbols(["m", "M", "l", "g", "k"]);
    let [phi, s_rate, phi_rate] = graph.symbols(["φ", "s'", "φ'"]);
    let expected = (m + cart) * s_rate.square() / 2.0
        + m * l * phi.cos() * s_rate * phi_rate
        + m * l.square() * phi_rate.square() / 2.0
        + m * g * l * phi.cos();
    assert_eq!(pendulum.lagrangian(), expected);
    let drag = -k * s_rate * l * phi.cos();
    assert_eq!(pendulum.forces(), [-k * s_rate, drag]);

    // With a Lagrangian in addition, and the dissipation function of another drag.
    let text = format!(
        "{PENDULUM}\n[lagrangian]\nkinetic = \"s'^2\"\npotential = \"k*s^2\"\ndissipation = \"k*φ'^2/2\"\n\n[forces]\ns = 3\n"
    );
    let more = system(&graph, &text);
    let s = graph.symbol("s");
    assert_eq!(more.lagrangian(), expected + s_rate.square() - k * s.square());
    assert_eq!(more.forces(), [3.0 - k * s_rate, drag - k * phi_rate]);
}

const ON_A_TURNTABLE: &str = r#"
[parameters]
J = 2.0
N = 3.0
"Ω" = 0.5

[coordinates]
"φ" = 0.0

[quasi_velocities]
w = { is = "2*φ'", start = 1.0 }
"#;

/// ω from the rotation and from φ' = w/2, with inertia in three and in six entries.
#[test]
fn a_body_turns_by_its_rotation_or_its_angular_velocity() {
    let graph = Graph::new();
    let [j, omega, w, torque] = graph.symbols(["J", "Ω", "w", "N"]);
    for body in [
        r#"inertia = ["J", 7, "J"]
rotation = ["cos(φ + Ω*t)", "-sin(φ + Ω*t)", 0, "sin(φ + Ω*t)", "cos(φ + Ω*t)", 0, 0, 0, 1]"#,
        r#"inertia = [1, 2, "J", 0.1, 0.2, 0.3]
angular_velocity = [0, 0, "φ' + Ω"]"#,
        r#"inertia = ["J", "J", "J"]
angular_velocity = ["w/2 + Ω", 0, 0]"#,
    ] {
        let torque_axis = if body.contains("[\"w/2") { "[\"N\", 0, 0]" } else { "[0, 0, \"N\"]" };
        let text = format!(
            "{ON_A_TURNTABLE}\n[bodies.disk]\nmass = 1\nposition = [0, 0, 0]\n{body}\ntorque = {torque_axis}\n"
        );
        let disk = system(&graph, &text);
        assert_eq!(disk.lagrangian(), j * (w / 2.0 + omega).square() / 2.0, "{body}");
        assert_eq!(disk.forces(), [torque / 2.0], "{body}");
    }
    // All six entries: ½ ω·Iω with the mixed ones twice.
    let text = format!(
        "{ON_A_TURNTABLE}\n[bodies.disk]\nmass = 1\nposition = [0, 0, 0]\ninertia = [1, 2, 3, 0.5, 0.25, 0.125]\n\
         angular_velocity = [\"w\", \"2*w\", \"4*w\"]\n"
    );
    let expected = (1.0 + 8.0 + 48.0 + 2.0 * (0.5 * 2.0 + 0.25 * 8.0 + 0.125 * 4.0)) / 2.0;
    assert_eq!(system(&graph, &text).lagrangian(), Expr::from(expected) * w.square());
}

const BODY: &str = r#"[parameters]
m = 1.0
[coordinates]
x = 1.0
[quasi_velocities]
w = { is = "2*x'", start = 1.0 }
[definitions]
v = "x'"
"#;

/// The message on a body with these lines, without the excerpt of the file.
fn refused_body(lines: &str) -> String {
    let mut text = format!("{BODY}[bodies.b]\n{lines}\n");
    if !lines.contains("mass") {
        text.push_str("mass = \"m\"\n");
    }
    if !lines.contains("position") {
        text.push_str("position = [\"x\", 0, 0]\n");
    }
    let error = refused(&text);
    assert_eq!(error.category(), Category::Text);
    let message = error.to_string();
    let lines: Vec<&str> = message.lines().collect();
    format!("{}\n{}", lines[0], lines[lines.len() - 1])
}

#[test]
fn expressions_of_bodies_are_refused_with_their_place() {
    let at_rest = "in the mass, inertia, position or rotation of a body\n  help: use parameters, coordinates and t only";
    assert_eq!(
        refused_body("position = [\"x\", \"w*t\", 0]"),
        format!("m.toml:10:19: [bodies.b] position: `w` cannot be used {at_rest}")
    );
    assert_eq!(
        refused_body("position = [0, 0, \"1 + x'\"]"),
        format!("m.toml:10:24: [bodies.b] position: `x'` cannot be used {at_rest}")
    );
    assert_eq!(
        refused_body("mass = \"m + d(x)\""),
        format!("m.toml:10:13: [bodies.b] mass: `d(x)` cannot be used {at_rest}")
    );
    assert_eq!(
        refused_body("position = [\"v\", 0, 0]"),
        format!("m.toml:8:6: [definitions] v: `x'` cannot be used {at_rest}")
    );
    let turning = "angular_velocity = [0, 0, \"w\"]";
    assert_eq!(
        refused_body(&format!("inertia = [1, \"w\", 1]\n{turning}")),
        format!("m.toml:10:16: [bodies.b] inertia: `w` cannot be used {at_rest}")
    );
    assert_eq!(
        refused_body("rotation = [1, 0, 0, 0, 1, 0, 0, 0, \"w\"]\ninertia = [1, 1, 1]"),
        format!("m.toml:10:38: [bodies.b] rotation: `w` cannot be used {at_rest}")
    );
    assert_eq!(
        refused_body("angular_velocity = [0, \"1 + x'^2\", \"w\"]\ninertia = [1, 1, 1]"),
        "m.toml:10:25: [bodies.b] angular_velocity: `1 + x'^2` is not affine in the velocities\n  \
         help: write a sum of terms linear in the velocities"
    );
    assert_eq!(
        refused_body("force = [0, \"d(w)\", 0]"),
        "m.toml:10:14: [bodies.b] force: `d()` of velocities gives accelerations, which cannot be used in the \
         Lagrangian or a force\n  help: accelerations can be used in [integrals] and [outputs]"
    );
    assert_eq!(
        refused_body(&format!("{turning}\ntorque = [\"1/(m - m)\", 0, 0]")),
        "m.toml:11:12: [bodies.b] torque: `1/(m - m)` divides by zero\n  \
         help: the divisor is zero whatever the motion"
    );
    assert_eq!(
        refused_body("force = [0, 0, \"-m*G\"]"),
        "m.toml:10:20: [bodies.b] force: the name `G` is not declared\n  \
         help: declare it, for example in [parameters]"
    );
}

/// Errors found only at the start or in the derivation are located at the body, too.
#[test]
fn singular_energies_are_located_at_bodies() {
    let root = refused(&format!("{BODY}[bodies.b]\nmass = \"m\"\nposition = [\"sqrt(x - 2)\", 0, 0]\n"));
    assert_eq!(root.category(), Category::Inconsistent);
    assert_eq!(
        root.to_string(),
        "m.toml:11:14: [bodies.b] position: `sqrt(x - 2)` is NaN at the start (x = 1, w = 1)\n    \
         position = [\"sqrt(x - 2)\", 0, 0]\n                 ^^^^^^^^^^^\n  \
         help: start where the coordinates and functions are regular"
    );

    let model = model(&format!("{BODY}[bodies.b]\nmass = \"m\"\nposition = [1, 2, 3]\n"));
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let error = assembly.placed(assembly.system.poincare()).unwrap_err();
    assert_eq!(assembly.equations().unwrap_err().to_string(), error.to_string(), "placed already");
    assert_eq!(
        error.to_string(),
        "m.toml:9:1: [bodies.b]: the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank 0 of 1, so \
         w' is not determined\n    [bodies.b]\n    ^^^^^^^^^^\n  \
         help: every quasi-velocity needs kinetic energy of its own"
    );
}

/// A cart, a bob and a top: their weights are −m g · r in the energy, and no force.
#[test]
fn gravity_is_a_potential_of_all_bodies() {
    const BODIES: &str = r#"
[parameters]
m = 2.0
l = 0.5
g = "0.98*10"
[coordinates]
s = 0.3
"φ" = 1.0
[bodies.cart]
mass = 3
position = ["s", 0, "s/10"]
[bodies.rod]
mass = "m"
position = ["s + l*sin(φ)", 0, "s/10 - l*cos(φ)"]
inertia = [0, "m*l^2/3", 0]
angular_velocity = [0, "φ'", 0]
"#;
    let graph = Graph::new();
    let falling = format!("{BODIES}[gravity]\nacceleration = [0.5, \"t\", \"-g\"]\n");
    let assembly = model(&falling).assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    let (fallen, floating) = (assembly.system, system(&graph, BODIES));
    let [m, l, g, s, phi] = graph.symbols(["m", "l", "g", "s", "φ"]);
    let potential =
        -3.0 * (s / 2.0 - g * s / 10.0) - m * ((s + l * phi.sin()) / 2.0 - g * (s / 10.0 - l * phi.cos()));
    assert_eq!(floating.lagrangian() - fallen.lagrangian(), potential);
    assert_eq!(fallen.forces(), [Expr::ZERO; 2]);
    assert!(fallen.energy_rate().is_zero());
}

/// Bodies that do not move sideways: a component that depends on time does no work on them. One along the
/// motion does.
#[test]
fn gravity_that_changes_with_time_does_not_keep_the_energy() {
    let graph = Graph::new();
    let shaken = PENDULUM.replace("force = [\"-k*s'\", 0, \"-m*g\"]", "")
        + "[gravity]\nacceleration = [\"cos(t)\", 0, \"-g\"]\n";
    let rate = system(&graph, &shaken).energy_rate();
    let [m, cart, l, t, s, phi] = graph.symbols(["m", "M", "l", "t", "s", "φ"]);
    assert_eq!(rate, (m * (s + l * phi.sin()) + cart * s) * t.sin());
}

#[test]
fn gravity_depends_on_parameters_and_time_only() {
    let with = |entry: &str| format!("{PENDULUM}[gravity]\nacceleration = [0, 0, \"{entry}\"]\n");
    for (entry, name) in [("-s", "s"), ("-s'", "s'"), ("depth", "φ"), ("d(t)", "d(t)")] {
        let error = refused(&with(entry)).to_string();
        let message = format!("`{name}` cannot be used in the acceleration of gravity\n");
        assert!(error.contains(&message), "{error}");
        assert!(error.ends_with("help: use numbers, parameters, inputs and t only"), "{error}");
    }
}

/// A body whose nine direction cosines, given at the start, follow its angular velocity.
fn by_cosines(start: [&str; 9], rotation: [&str; 9]) -> String {
    let name = |row: usize, column: usize| format!("r{row}{column}");
    let mut text = String::from("[coordinates]\n");
    for (place, value) in start.iter().enumerate() {
        text += &format!("{} = {value}\n", name(place / 3 + 1, place % 3 + 1));
    }
    text += "[quasi_velocities]\nw1 = 0.3\nw2 = -0.2\nw3 = 1.1\n[kinematics]\n";
    for row in 1..=3 {
        let [a, b, c] = [1, 2, 3].map(|column| name(row, column));
        text += &format!("{a} = \"{b}*w3 - {c}*w2\"\n{b} = \"{c}*w1 - {a}*w3\"\n{c} = \"{a}*w2 - {b}*w1\"\n");
    }
    text += "[bodies.b]\nmass = 1\nposition = [0, 0, 0]\ninertia = [1, 2, 3]\n";
    text +=
        &format!("rotation = {rotation:?}\n[lagrangian]\npotential = \"r33\"\n[simulation]\nt_end = 1.0\n");
    text
}

const COSINES: [&str; 9] = ["r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"];

#[test]
fn a_matrix_of_redundant_coordinates_is_a_rotation_at_the_start_and_after() {
    let turned =
        ["\"cos(0.7)\"", "\"-sin(0.7)\"", "0.0", "\"sin(0.7)\"", "\"cos(0.7)\"", "0.0", "0.0", "0.0", "1.0"];
    let graph = Graph::new();
    let bound = system(&graph, &by_cosines(turned, COSINES));
    assert_eq!(bound.quasi_velocities().len(), 3);

    // Nine digits leave 4e-10: ω would have that uncertainty.
    let short =
        ["0.764842187", "-0.644217687", "0.0", "0.644217687", "0.764842187", "0.0", "0.0", "0.0", "1.0"];
    let refusal = refused(&by_cosines(short, COSINES));
    assert_eq!(refusal.category(), Category::Inconsistent);
    assert_eq!(
        refusal.to_string(),
        r#"m.toml:29:14: [bodies.b] rotation: the matrix of `b` is not a rotation at the start: its columns are not orthogonal and of one length, by 4.94285e-10
    rotation = ["r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"]
                 ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: give the start with all digits or as expressions, or the body its `angular_velocity`"#
    );

    // The transposed matrix remains a rotation, about other axes; one with a wrong sign does not, though it
    // is one at the start.
    let plain = ["1.0", "0.0", "0.0", "0.0", "1.0", "0.0", "0.0", "0.0", "1.0"];
    let transposed = ["r11", "r21", "r31", "r12", "r22", "r32", "r13", "r23", "r33"];
    system(&graph, &by_cosines(plain, transposed));
    let wrong = ["r11", "r12", "r13", "-r21", "r22", "r23", "r31", "r32", "r33"];
    let refusal = refused(&by_cosines(plain, wrong));
    assert_eq!(refusal.category(), Category::Inconsistent);
    assert_eq!(
        refusal.to_string(),
        r#"m.toml:29:14: [bodies.b] rotation: the matrix of `b` does not stay a rotation: along the motion its columns do not stay orthogonal and of one length (rate 2)
    rotation = ["r11", "r12", "r13", "-r21", "r22", "r23", "r31", "r32", "r33"]
                 ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: check signs and indices of its entries and of [kinematics]"#
    );
}

/// A quaternion of any length rotates: RᵀR = |q|⁴.
#[test]
fn a_quaternion_matrix_without_a_square_is_not_a_rotation() {
    let text = |square: &str| {
        format!(
            r#"[coordinates]
q0 = 1.0
q1 = 0.0
q2 = 0.0
q3 = 0.0
[quasi_velocities]
w1 = 0.3
w2 = -0.2
w3 = 1.1
[kinematics]
q0 = "(-q1*w1 - q2*w2 - q3*w3)/2"
q1 = "(q0*w1 - q3*w2 + q2*w3)/2"
q2 = "(q3*w1 + q0*w2 - q1*w3)/2"
q3 = "(-q2*w1 + q1*w2 + q0*w3)/2"
[bodies.b]
mass = 1
position = [0, 0, 0]
inertia = [1, 2, 3]
rotation = [
  "q0^2 + q1^2 - q2^2 - q3^2", "2*(q1*q2 - q0*q3)", "2*(q1*q3 + q0*q2)",
  "2*(q1*q2 + q0*q3)", "q0^2 - q1^2 + {square} - q3^2", "2*(q2*q3 - q0*q1)",
  "2*(q1*q3 - q0*q2)", "2*(q2*q3 + q0*q1)", "q0^2 - q1^2 - q2^2 + q3^2",
]
[simulation]
t_end = 1.0
"#
        )
    };
    system(&Graph::new(), &text("q2^2"));
    let refusal = refused(&text("q2")).to_string();
    let expected = "m.toml:20:4: [bodies.b] rotation: the matrix of `b` does not stay a rotation: along the motion its columns do not \
                    stay orthogonal and of one length (rate 0.666667)\n";
    assert!(refusal.starts_with(expected), "{refusal}");
}
