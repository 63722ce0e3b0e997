//! `[states]`: first-order states in addition to the frame.

use pc_expr::Events;
use pc_mech::{Graph, VectorField};
use pc_model::{Category, Document, Flow, Model, Source, Variables};

use crate::verified::derived_twice;

/// A pendulum on a motor with its current, under a controller with its integral.
const MOTOR: &str = r#"[parameters]
J = 0.01
m = 0.2
l = 0.3
g = 9.81
L = 0.005
R = 1.0
ke = 0.05
ref = 1.0
[definitions]
error = "ref - th"
u = "30*error + 20*e - 2*w"
[coordinates]
th = 0.25
[quasi_velocities]
w = { is = "th'", start = 0.5 }
[states]
i = { start = "ref/2", rate = "(u - R*i - ke*w)/L" }
e = { rate = "error" }
[lagrangian]
kinetic = "J/2*w^2"
potential = "-m*g*l*cos(th)"
[forces]
w = "ke*i"
[outputs]
power = "R*i^2"
slope = "d(i)"
"#;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn flow(text: &str, variables: Variables) -> Flow {
    let (model, graph) = (model(text), Graph::new());
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    Flow::new(&model, &assembly, variables).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn assert_close(found: &[f64], expected: &[f64], within: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= within * expected.abs().max(1.0), "{found} is not {expected}");
    }
}

fn rates(flow: &mut Flow, t: f64, y: &[f64]) -> Vec<f64> {
    let mut rates = vec![f64::NAN; y.len()];
    flow.motion.rhs(t, y, &mut rates).unwrap();
    rates
}

/// ∂f/∂y against central differences, whose error is a few 1e-9 of the largest derivative.
#[track_caller]
fn assert_jacobian(flow: &mut Flow, t: f64, y: &[f64]) {
    let n = y.len();
    let mut jacobian = vec![f64::NAN; n * n];
    flow.motion.jacobian(t, y, &mut jacobian).unwrap();
    for j in 0..n {
        let h = 1e-5 * y[j].abs().max(1.0);
        let (mut up, mut down) = (y.to_vec(), y.to_vec());
        up[j] += h;
        down[j] -= h;
        let (up, down) = (rates(flow, t, &up), rates(flow, t, &down));
        let quotients: Vec<f64> = up.iter().zip(&down).map(|(up, down)| (up - down) / (2.0 * h)).collect();
        let largest = quotients.iter().fold(1.0f64, |largest, q| largest.max(q.abs()));
        for (i, quotient) in quotients.iter().enumerate() {
            assert!((jacobian[i + j * n] - quotient).abs() < 1e-7 * largest, "{i} {j}");
        }
    }
}

/// The equations written out.
#[test]
fn a_motor_with_its_current_and_its_controller() {
    let by_hand = |[th, w, i, e]: [f64; 4]| {
        let voltage = 30.0 * (1.0 - th) + 20.0 * e - 2.0 * w;
        [w, (0.05 * i - 0.2 * 9.81 * 0.3 * th.sin()) / 0.01, (voltage - i - 0.05 * w) / 0.005, 1.0 - th]
    };
    let mut poincare = flow(MOTOR, Variables::QuasiVelocities);
    assert_eq!(poincare.names, ["th", "w", "i", "e"]);
    assert_eq!(poincare.start, [0.25, 0.5, 0.5, 0.0]);
    assert_eq!(
        (poincare.motion.coordinates(), poincare.motion.states(), poincare.quasi_velocities()),
        (1, 2, 1)
    );
    let state = [0.7, -1.5, 2.0, 0.3];
    assert_close(&rates(&mut poincare, 0.0, &state), &by_hand(state), 1e-14);
    assert_jacobian(&mut poincare, 0.0, &state);
    let row = poincare.row(0.0, &state);
    assert_close(&row[..4], &state, 0.0);
    assert_close(&row[5..], &[4.0, by_hand(state)[2]], 1e-14); // after the energy

    let mut canonical = flow(MOTOR, Variables::Momenta);
    assert_eq!(canonical.motion.names(), ["th", "p_w", "i", "e"]);
    let mut expected = by_hand(state);
    expected[1] *= 0.01; // of the momentum J ω
    let momenta = [state[0], 0.01 * state[1], state[2], state[3]];
    assert_close(&rates(&mut canonical, 0.0, &momenta), &expected, 1e-14);
    assert_jacobian(&mut canonical, 0.0, &momenta);
    assert_close(&canonical.row(0.0, &momenta), &row, 1e-14);
}

/// A carriage that loses sand, m' = −q, at rest relative to it: (m v)' = −q v − c v, so v' = −c v/m; where
/// the sand leaves at rest, (m v)' = −c v, so v' = (q − c) v/m.
#[test]
fn the_mass_of_a_body_may_be_a_state() {
    for (force, factor) in [("-c*v - q*v", -0.5), ("-c*v", -0.2)] {
        let text = format!(
            "[parameters]\nq = 0.3\nc = 0.5\n[coordinates]\nx = 0\n[quasi_velocities]\nv = 2\n[kinematics]\nx = \"v\"\n\
             [states]\nm = {{ start = 4, rate = \"-q\" }}\n\
             [bodies.carriage]\nmass = \"m\"\nposition = [\"x\", 0, 0]\n[forces]\nv = \"{force}\"\n"
        );
        let (mass, v) = (1.6, 3.0);
        let mut poincare = flow(&text, Variables::QuasiVelocities);
        assert_close(&rates(&mut poincare, 0.0, &[0.0, v, mass]), &[v, factor * v / mass, -0.3], 1e-15);
        let mut canonical = flow(&text, Variables::Momenta);
        let of_momentum = (factor * v / mass) * mass - 0.3 * v;
        assert_close(&rates(&mut canonical, 0.0, &[0.0, mass * v, mass]), &[v, of_momentum, -0.3], 1e-15);

        // H = m v²/2: its rate is m v v' + m' v²/2.
        let graph = Graph::new();
        let system = model(&text).assemble(&graph).unwrap().system;
        let at = [("v", v), ("m", mass), ("q", 0.3), ("c", 0.5)].map(|(x, value)| (graph.symbol(x), value));
        let rate = graph.evaluate(&[system.energy_rate()], &at).unwrap()[0];
        assert_close(&[rate], &[factor * v * v - 0.15 * v * v], 1e-15);
    }
}

/// A pendulum in Cartesian coordinates with a thrust that builds up, and the same in its angle.
#[test]
fn constraints_do_not_change_states() {
    const PULLED: &str = r#"[coordinates]
x = 0.6
y = -0.8
[quasi_velocities]
"x'" = 0.8
"y'" = 0.6
[states]
F = { start = 0.5, rate = "1 - F + x'" }
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "9.81*y"
[forces]
x = "F"
"#;
    let mut held = flow(PULLED, Variables::QuasiVelocities);
    assert_eq!(held.names, ["x", "y", "x'", "y'", "F"]);
    let start = held.start.clone();
    assert_close(&start, &[0.6, -0.8, 0.8, 0.6, 0.5], 0.0);
    let found = rates(&mut held, 0.0, &start);
    // φ' = 1, φ'' = −g sin φ + F cos φ with sin φ = 0.6: x'' = φ'' cos φ − φ'² sin φ, y'' = φ'' sin φ + φ'² cos φ
    let turn = -9.81 * 0.6 + 0.5 * 0.8;
    assert_close(&found, &[0.8, 0.6, 0.8 * turn - 0.6, 0.6 * turn + 0.8, 1.3], 1e-14);
    assert_jacobian(&mut held, 0.0, &start);
    let mut off = [0.61, -0.8, 0.8, 0.61, 0.5];
    held.motion.project(0.0, &mut off).unwrap();
    assert_eq!(off[4], 0.5);
    assert_close(&[off[0].hypot(off[1]), off[0] * off[2] + off[1] * off[3] + 1.0], &[1.0, 1.0], 1e-14);

    let mut canonical = flow(PULLED, Variables::Momenta);
    let start = canonical.start.clone();
    assert_eq!(canonical.motion.names(), ["x", "y", "p_x", "p_y", "F"]);
    assert_close(&rates(&mut canonical, 0.0, &start), &found, 1e-14);
    assert_jacobian(&mut canonical, 0.0, &start);
    let row = canonical.row(0.0, &start);
    assert_close(&row[..5], &held.start, 1e-14);
}

/// Events reset first-order states, and depend on them.
#[test]
fn events_see_and_reset_states() {
    let text = format!("{MOTOR}[events.off]\nwhen = \"i - 3\"\nreset = {{ e = \"e/2\", w = \"i\" }}\n");
    for variables in [Variables::QuasiVelocities, Variables::Momenta] {
        let mut flow = flow(&text, variables);
        let scale = if variables == Variables::Momenta { 0.01 } else { 1.0 };
        let mut state = [0.7, -1.5 * scale, 2.0, 0.3];
        let mut value = [f64::NAN];
        flow.events.evaluate(0.0, &state, &mut value).unwrap();
        assert_close(&value, &[-1.0], 1e-15);
        flow.events.reset(0, 0.0, &mut state).unwrap();
        assert_close(&state, &[0.7, 2.0 * scale, 2.0, 0.15], 1e-15);
    }
    let wrong = format!("{MOTOR}[events.off]\nwhen = \"i\"\nreset = {{ u = \"0\" }}\n");
    let (category, message) = refused(&wrong);
    assert!(message.contains("`u` cannot be reset: it is a definition"), "{message}");
    assert!(message.ends_with("an event can reset th, w, i, e"), "{message}");
    assert_eq!(category, Category::Text);
}

/// A gain that only the energy shows: with the energy kept by projection, the charge of a capacitor is
/// unchanged.
#[test]
fn integrals_are_kept_without_changing_states() {
    let text = "[coordinates]\nx = 1\n[states]\nz = { start = 2, rate = \"-z\" }\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
                potential = \"x^2/2\"\n[integrals]\nI = \"x^2 + x'^2\"\n[simulation]\nproject = [\"I\"]\n";
    let mut flow = flow(text, Variables::QuasiVelocities);
    let mut state = [1.1, 0.0, 2.0];
    flow.motion.project(0.0, &mut state).unwrap();
    assert_close(&state, &[1.0, 0.0, 2.0], 1e-15);
}

fn refused(text: &str) -> (Category, String) {
    let graph = Graph::new();
    match model(text).assemble(&graph) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => (error.category(), error.to_string()),
    }
}

#[test]
fn the_frame_contains_no_states() {
    let states = "[states]\nz = { rate = \"-z\" }\n";
    let lagrangian = "[lagrangian]\nkinetic = \"x'^2\"\n";
    let points = "[bodies.b]\nmass = 1\nposition = [\"z*x\", 0, 0]\n";
    for (rest, place) in [
        (format!("[coordinates]\nx = \"z\"\n{states}{lagrangian}"), "a start value"),
        (
            format!(
                "[coordinates]\nx = 1\n[quasi_velocities]\nv = {{ is = \"z*x'\" }}\n{states}{lagrangian}"
            ),
            "the definition of a quasi-velocity",
        ),
        (
            format!(
                "[coordinates]\nx = 1\n[quasi_velocities]\nv = 0\n[kinematics]\nx = \"v*z\"\n{states}{lagrangian}"
            ),
            "[kinematics]",
        ),
        (
            format!("[coordinates]\nx = 1\ny = 1\n{states}{lagrangian}[constraints]\nc = \"x - z\"\n"),
            "a constraint",
        ),
        (
            format!("[coordinates]\nx = 1\n{states}{points}"),
            "the mass, inertia, position or rotation of a body",
        ),
    ] {
        let (category, message) = refused(&rest);
        assert!(message.contains(&format!("`z` cannot be used in {place}\n")), "{message}");
        assert_eq!(category, Category::Text);
    }
    let circle = "[coordinates]\nx = 1\n[states]\na = { rate = \"d(b)\" }\nb = { rate = \"d(a)\" }\n";
    let (_, message) = refused(&format!("{circle}{lagrangian}"));
    assert!(message.contains("`d(b)` cannot be used in the rate of a first-order state"), "{message}");
}

/// Their start values are set like others.
#[test]
fn starts_are_set_by_name() {
    let mut model = model(MOTOR);
    assert_eq!(model.start_names(), ["th", "w", "i", "e"]);
    model.set("ref", 3.0).unwrap();
    model.set_start("e", -1.0).unwrap();
    assert_eq!(model.start().unwrap(), [0.25, 0.5, 1.5, -1.0]);
}

/// A total derivative in a rate, alone and in a definition: z = ∫ d(x²) is x², and the path is that of the
/// speed.
#[test]
fn rates_contain_total_derivatives() {
    let text = "[coordinates]\nx = 1.0\n[definitions]\nrate = \"d(x^2)\"\n\
                [states]\nz = { start = 1.0, rate = \"rate\" }\nw = { start = 1.0, rate = \"d(x^2)\" }\n\
                [lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"2*x^2\"\n[outputs]\na = \"d(z*x)\"\n";
    let mut flow = flow(text, Variables::QuasiVelocities);
    let mut rates = [0.0; 4];
    flow.motion.rhs(0.0, &[0.5, 3.0, 1.0, 1.0], &mut rates).unwrap();
    assert_close(&rates, &[3.0, -2.0, 3.0, 3.0], 1e-15);
}
