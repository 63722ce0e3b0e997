//! `[events.NAME]`: their assembly, and every refusal in full.

use pc_expr::{Direction, Events};
use pc_mech::Graph;
use pc_model::{Category, Document, Flow, Model, ModelError, Source, Variables};

use crate::verified::derived_twice;

const PENDULUM: &str = r#"[parameters]
l = 1.0
[definitions]
height = "-l*cos(phi)"
[coordinates]
phi = 1.0
[quasi_velocities]
omega = 0.5
[kinematics]
phi = "omega"
[lagrangian]
kinetic = "l^2*omega^2/2"
potential = "height"
[integrals]
depth = "-height"
[outputs]
place = "l*sin(phi)"
"#;

const POINT: &str = r#"[coordinates]
x = 0.6
y = -0.8
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
"#;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn error(text: &str) -> ModelError {
    let graph = Graph::new();
    match model(text).assemble(&graph) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error,
    }
}

fn refused(system: &str, event: &str) -> String {
    let error = error(&format!("{system}{event}"));
    assert_eq!(error.category(), Category::Text);
    error.to_string()
}

/// Velocities are expressed by quasi-velocities, definitions by their meaning, resets by their index in (x,
/// η).
#[test]
fn events_are_expressions_in_the_state() {
    let text = format!(
        "{PENDULUM}[events.low]\nwhen = \"height + t + d(height)\"\ndirection = \"rising\"\nterminal = true\n\
         reset = {{ omega = \"-phi'/2\", phi = \"phi + omega\" }}\n[events.\"just so\"]\nwhen = \"omega\"\n"
    );
    let graph = Graph::new();
    let assembly = model(&text).assemble(&graph).unwrap();
    let [low, so] = &assembly.events[..] else { panic!("two events") };
    assert_eq!((low.name.as_str(), low.direction, low.terminal), ("low", Direction::Rising, true));
    let (l, phi, omega) = (graph.symbol("l"), graph.symbol("phi"), graph.symbol("omega"));
    assert_eq!(low.when, -l * phi.cos() + graph.symbol("t") + l * phi.sin() * omega);
    assert_eq!(low.resets, [(1, -omega / 2), (0, phi + omega)]);
    assert_eq!((so.name.as_str(), so.direction, so.terminal), ("just so", Direction::Both, false));
    assert!(so.resets.is_empty());
}

/// Without quasi-velocities these are the velocities.
#[test]
fn velocities_are_reset_where_they_are_the_quasi_velocities() {
    let graph = Graph::new();
    let text = format!("{POINT}[events.hit]\nwhen = \"y\"\nreset = {{ \"y'\" = \"-y'\" }}\n");
    let assembly = model(&text).assemble(&graph).unwrap();
    assert_eq!(assembly.events[0].resets, [(3, -graph.symbol("y'"))]);
}

/// A reset needs no value at the start, where `when` needs one.
#[test]
fn only_the_event_function_is_tried_at_the_start() {
    let later = "[events.low]\nwhen = \"phi\"\nreset = { omega = \"sqrt(-phi)\" }\n";
    assert!(model(&format!("{PENDULUM}{later}")).assemble(&Graph::new()).is_ok());
    let error = error(&format!("{PENDULUM}[events.low]\nwhen = \"1 + sqrt(-phi)\"\n"));
    assert_eq!(error.category(), Category::Inconsistent);
    assert_eq!(
        error.to_string(),
        "m.toml:19:13: [events.low] when: `sqrt(-phi)` is NaN at the start (phi = 1, omega = 0.5)\n    \
         when = \"1 + sqrt(-phi)\"\n                ^^^^^^^^^^\n  help: start where the coordinates and functions \
         are regular"
    );
}

#[test]
fn every_message() {
    assert_eq!(
        refused(PENDULUM, "[events.low]\nwhen = \"psi\"\n"),
        "m.toml:19:9: [events.low] when: the name `psi` is not declared\n    when = \"psi\"\n            ^^^\n  \
         help: did you mean `phi`? declare it, for example in [parameters]"
    );
    assert_eq!(
        refused(PENDULUM, "[events.low]\nwhen = \"d(omega)\"\n"),
        "m.toml:19:9: [events.low] when: `d()` of velocities gives accelerations, which cannot be used in an event\n    \
         when = \"d(omega)\"\n            ^^^^^^^^\n  help: accelerations can be used in [integrals] and [outputs]"
    );
    let reset = |system: &str, name: &str| {
        refused(system, &format!("[events.low]\nwhen = \"1\"\nreset = {{ {name} = \"0\" }}\n"))
    };
    let not_reset = |name: &str, what: &str, help: &str| {
        let carets = "^".repeat(name.len());
        format!(
            "m.toml:20:11: [events.low] reset.{name}: `{name}` cannot be reset: it is {what}\n    reset = {{ {name} = \
             \"0\" }}\n              {carets}\n  help: {help}"
        )
    };
    for (name, what, help) in [
        ("l", "a parameter", "an event can reset phi, omega"),
        ("height", "a definition", "an event can reset phi, omega"),
        ("depth", "an integral", "an event can reset phi, omega"),
        ("place", "an output", "an event can reset phi, omega"),
        ("omeg", "declared nowhere", "did you mean `omega`? an event can reset phi, omega"),
        ("t", "time", "an event can reset phi, omega"),
    ] {
        let found = reset(PENDULUM, name);
        assert_eq!(found, not_reset(name, what, help), "\n{found}");
    }
    let found = reset(PENDULUM, "\"phi'\"");
    assert!(found.contains("`phi'` cannot be reset: it is a velocity that quasi-velocities give"), "{found}");
    let found = reset(POINT, "\"z'\"");
    assert!(found.contains("`z` is not a coordinate, so `z'` means nothing"), "{found}");

    // A quasi-velocity that a constraint keeps at zero.
    let kept = format!("{PENDULUM}[constraints]\nstill = \"omega\"\n").replace("omega = 0.5", "omega = 0");
    let kept = kept
        .replace("[coordinates]", "[coordinates]\nz = 0.0")
        .replace("omega = 0\n[kinematics]", "omega = 0\nw = 1.0\n[kinematics]\nz = \"w\"");
    let found = reset(&kept.replace("omega^2/2", "omega^2/2 + w^2/2"), "omega");
    assert!(
        found.contains("`omega` cannot be reset: it is a quasi-velocity that a constraint keeps at zero"),
        "{found}"
    );

    // A velocity kept by a constraint: the reset would be lost silently.
    let found = reset(&format!("{POINT}[constraints]\nlevel = \"y'\"\n"), "\"y'\"");
    assert!(
        found.contains("`y'` cannot be reset: it is a velocity that a constraint keeps at zero"),
        "{found}"
    );
    assert!(
        found.contains("an event can reset x, y, x'\n") || found.ends_with("an event can reset x, y, x'"),
        "{found}"
    );
}

/// The values of these outputs after a reset at the start.
fn after(
    text: &str,
    reset: &str,
    outputs: &[&str],
    (variables, independent): (Variables, &[&str]),
) -> Result<Vec<f64>, String> {
    let named = outputs.iter().enumerate().map(|(i, output)| format!("o{i} = \"{output}\"\n"));
    let named: String = named.collect();
    let mut model =
        model(&format!("{text}[outputs]\n{named}[events.e]\nwhen = \"t - 1\"\nreset = {{ {reset} }}\n"));
    model.choose_independent(independent.iter().copied());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    let mut flow = Flow::new(&model, &assembly, variables).unwrap_or_else(|error| panic!("{error}"));
    let mut state = flow.start.clone();
    flow.events.reset(0, 0.0, &mut state).map_err(|failure| failure.to_string())?;
    let row = flow.row(0.0, &state);
    let first =
        flow.names.len() + flow.motion.observable_names().iter().position(|name| name == "o0").unwrap();
    Ok(row[first..first + outputs.len()].to_vec())
}

#[track_caller]
fn assert_close(found: Result<Vec<f64>, String>, expected: &[f64]) {
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(found.len(), expected.len());
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() < 1e-13 * y.abs().max(1.0), "{found:?} is not {expected:?}");
    }
}

const IN_VELOCITIES: (Variables, &[&str]) = (Variables::QuasiVelocities, &[]);
const IN_MOMENTA: (Variables, &[&str]) = (Variables::Momenta, &[]);

/// A bead on a circle.
fn bead(quasi_velocities: &str) -> String {
    format!(
        "[coordinates]\nx = 0.6\ny = -0.8\n[quasi_velocities]\n{quasi_velocities}[constraints]\nrod = \"x^2 + y^2 - 1\"\n\
         [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
    )
}

const BEAD: &str = "\"x'\" = 1.6\n\"y'\" = 1.2\n";

/// One velocity of a bead determines the other, and the energy after an impact is e² of the one before.
#[test]
fn the_velocity_that_is_reset_determines_the_others() {
    let seen = ["x'", "y'", "(x'^2 + y'^2)/2"];
    let expected = [-0.4, -0.3, 2.0 / 16.0];
    let chosen = |independent| [(Variables::QuasiVelocities, independent), (Variables::Momenta, independent)];
    let forms = |own: &'static [&'static str], other: &'static [&'static str]| {
        [vec![IN_VELOCITIES, IN_MOMENTA], chosen(own).to_vec(), chosen(other).to_vec()].concat()
    };
    for (quasi_velocities, reset, forms) in [
        (BEAD, "\"x'\" = \"-x'/4\"", forms(&["x'"], &["y'"])),
        (BEAD, "\"y'\" = \"-y'/4\"", forms(&["x'"], &["y'"])),
        (BEAD, "\"x'\" = \"-x'/4\", \"y'\" = \"-y'/4\"", forms(&["x'"], &["y'"])),
        ("w = { is = \"x'\", start = 1.6 }\n", "w = \"-w/4\"", forms(&["w"], &["y'"])),
        ("w = { is = \"y*x' + 3*y'\", start = 2.32 }\n", "w = \"-w/4\"", forms(&["w"], &["x'"])),
        (
            "u = { is = \"x' + y'\", start = 2.8 }\nv = { is = \"x' - 2*y'\", start = -0.8 }\n",
            "v = \"-v/4\"",
            forms(&["u"], &["v"]),
        ),
    ] {
        for form in forms {
            assert_close(after(&bead(quasi_velocities), reset, &seen, form), &expected);
        }
    }
    // To another place, at a speed that is given there: 0.8 x' − 0.6 y' = 0.
    let there = "x = \"0.8\", y = \"-0.6\", ";
    for form in [IN_VELOCITIES, IN_MOMENTA] {
        let velocity = after(&bead(BEAD), &format!("{there}\"x'\" = \"0.3\""), &seen[..2], form);
        assert_close(velocity, &[0.3, 0.4]);
        let defined = bead("w = { is = \"x'\", start = 1.6 }\n");
        assert_close(after(&defined, &format!("{there}w = \"0.3\""), &seen[..2], form), &[0.3, 0.4]);
        // At one that is not, the nearest: of (1.6, 1.2) the part along (0.6, 0.8).
        assert_close(after(&bead(BEAD), "x = \"0.8\", y = \"-0.6\"", &seen[..2], form), &[1.152, 1.536]);
    }
}

/// A particle of different masses in each direction on a sphere: what is not reset moves by δ = −μ M⁻¹ ∂f/∂x along the velocities left,
/// with μ from (x, ẋ) = 0.
#[test]
fn velocities_that_are_not_reset_move_the_shortest_way() {
    let sphere = |quasi_velocities: &str| {
        format!(
            "[coordinates]\nx = 0.48\ny = 0.6\nz = 0.64\n[quasi_velocities]\n{quasi_velocities}[constraints]\n\
             sphere = \"x^2 + y^2 + z^2 - 1\"\n[lagrangian]\nkinetic = \"(x'^2 + 2*y'^2 + 3*z'^2)/2\"\n"
        )
    };
    let plain = sphere("\"x'\" = 0.9\n\"y'\" = 0.4\n\"z'\" = -1.05\n");
    let seen = ["x'", "y'", "z'"];
    let mu = (0.48 * 0.9 + 0.6 * 0.4 + 0.64 * 0.2) / (0.48 * 0.48 + 0.6 * 0.6 / 2.0);
    let chosen: (Variables, &[&str]) = (Variables::QuasiVelocities, &["x'", "z'"]);
    for form in [IN_VELOCITIES, IN_MOMENTA, chosen] {
        let expected = [0.9 - 0.48 * mu, 0.4 - 0.3 * mu, 0.2];
        assert_close(after(&plain, "\"z'\" = \"0.2\"", &seen, form), &expected);
        // With two the third is determined.
        let y = -(0.48 * 0.5 + 0.64 * 0.2) / 0.6;
        assert_close(after(&plain, "\"x'\" = \"0.5\", \"z'\" = \"0.2\"", &seen, form), &[0.5, y, 0.2]);
    }
    // Of all three the nearest, where they contradict the constraint.
    let mu = (0.48 * 0.5 + 0.64 * 0.2) / (0.48 * 0.48 + 0.6 * 0.6 / 2.0 + 0.64 * 0.64 / 3.0);
    let expected = [0.5 - 0.48 * mu, -0.3 * mu, 0.2 - 0.64 / 3.0 * mu];
    let all = "\"x'\" = \"0.5\", \"y'\" = \"0\", \"z'\" = \"0.2\"";
    assert_close(after(&plain, all, &seen, IN_VELOCITIES), &expected);
    // Declared ones that determine all velocities keep their values.
    let defined = sphere("p = { is = \"x'\", start = 0.9 }\nq = { is = \"z' + y*x'\", start = -0.51 }\n");
    let z = -0.51 - 0.6 * 0.5;
    let y = -(0.48 * 0.5 + 0.64 * z) / 0.6;
    for form in [IN_VELOCITIES, IN_MOMENTA] {
        assert_close(after(&defined, "p = \"0.5\"", &seen, form), &[0.5, y, z]);
    }
}

/// A knife edge in the plane with a light that it lifts: conditions on velocities and on positions.
#[test]
fn a_knife_edge_turns_back() {
    let edge = |quasi_velocities: &str| {
        format!(
            "[coordinates]\nx = 0.2\ny = 0.5\nq = 0.3\nz = 0.1\n[quasi_velocities]\n{quasi_velocities}[constraints]\n\
             edge = \"sin(q)*x' - cos(q)*y'\"\nlift = \"z - x*y\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2 + 2*q'^2 + z'^2)/2\"\n"
        )
    };
    let plain = edge(
        "\"x'\" = \"cos(0.3)\"\n\"y'\" = \"sin(0.3)\"\n\"q'\" = 0.7\n\"z'\" = \"0.5*cos(0.3) + 0.2*sin(0.3)\"\n",
    );
    let defined =
        edge("v = { is = \"cos(q)*x' + sin(q)*y'\", start = 1.0 }\nw = { is = \"q'\", start = 0.7 }\n");
    let seen = ["x'", "y'", "q'", "z'"];
    let (c, s) = (0.3f64.cos(), 0.3f64.sin());
    let slide = |v: f64, turn: f64| [v * c, v * s, turn, v * (0.5 * c + 0.2 * s)];
    for form in [IN_VELOCITIES, IN_MOMENTA] {
        assert_close(after(&plain, "\"x'\" = \"-x'/2\"", &seen, form), &slide(-0.5, 0.7));
        assert_close(after(&plain, "\"z'\" = \"z'/4\", \"q'\" = \"-q'\"", &seen, form), &slide(0.25, -0.7));
        assert_close(after(&defined, "v = \"-v/2\"", &seen, form), &slide(-0.5, 0.7));
        assert_close(after(&defined, "v = \"-v/2\", w = \"-w\"", &seen, form), &slide(-0.5, -0.7));
    }
}

/// A velocity that constraints forbid is named, with the value that they allow.
#[test]
fn a_reset_that_contradicts_constraints_is_an_error() {
    let refused = |text: &str, reset: &str, expected: &str| {
        for form in [IN_VELOCITIES, IN_MOMENTA] {
            assert_eq!(after(text, reset, &["x"], form).unwrap_err(), expected);
        }
    };
    // Where the circle is upright x' vanishes.
    let defined = bead("w = { is = \"x'\", start = 1.6 }\n");
    let to_the_side = "its reset leaves the constraints: w would have to be 0, not 0.3";
    refused(&defined, "x = \"1\", y = \"0\", w = \"0.3\"", to_the_side);
    let side = "x = \"1\", y = \"0\", ";
    let upright = "its reset leaves the constraints: x' would have to be 0, not 0.3";
    refused(&bead(BEAD), &format!("{side}\"x'\" = \"0.3\""), upright);
    assert_close(
        after(&bead(BEAD), &format!("{side}\"y'\" = \"0.3\""), &["x'", "y'"], IN_VELOCITIES),
        &[0.0, 0.3],
    );
    // Two velocities that the two rods leave free, but not these.
    let two = "[coordinates]\nx = 1.0\ny = 0.0\na = 0.0\nb = 1.0\n[quasi_velocities]\n\"x'\" = 0.0\n\"y'\" = 0.6\n\"a'\" = 1.0\n\
               \"b'\" = 0.0\n[constraints]\none = \"x^2 + y^2 - 1\"\ntwo = \"a^2 + b^2 - 1\"\n[lagrangian]\n\
               kinetic = \"(x'^2 + y'^2 + a'^2 + b'^2)/2\"\n";
    let nearest = "its reset leaves the constraints: x' would have to be 0, not 0.5";
    refused(two, "\"x'\" = \"0.5\", \"y'\" = \"0.25\"", nearest);
    let both = after(two, "\"y'\" = \"-y'\", \"a'\" = \"-a'/2\"", &["x'", "y'", "a'", "b'"], IN_VELOCITIES);
    assert_close(both, &[0.0, -0.6, -0.5, 0.0]);
}
