//! `[events.NAME]`: their assembly, and every refusal in full.

use pc_expr::Direction;
use pc_mech::Graph;
use pc_model::{Category, Document, Model, ModelError, Source};

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
