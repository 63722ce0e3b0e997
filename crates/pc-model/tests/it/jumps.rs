//! Energies, frames and constraints that jump: an impulse follows from them, which derivatives of their pieces do not show.

use pc_mech::{Graph, VectorField};
use pc_model::{Category, Document, Source};

use crate::verified::derived_twice;

/// The rates of a model at its start, or the message.
fn rates(text: &str) -> Result<Vec<f64>, String> {
    let document = Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}"));
    let model = derived_twice(document);
    let graph = Graph::new();
    let told = |error: pc_model::ModelError| {
        assert_eq!(error.category(), Category::Inconsistent);
        error.to_string()
    };
    let assembly = model.assemble(&graph).map_err(told)?;
    let (mut motion, start) = model.compile(&assembly).map_err(told)?;
    let mut rates = vec![0.0; start.len()];
    motion.rhs(assembly.t_start, &start, &mut rates).unwrap();
    Ok(rates)
}

/// A particle on a line with a potential.
fn particle(kinetic: &str, potential: &str) -> Result<Vec<f64>, String> {
    rates(&format!(
        "[parameters]\na = 1\nk = 1e10\n[coordinates]\nx = 2\n[quasi_velocities]\n\"x'\" = 3\n[lagrangian]\n\
         kinetic = \"{kinetic}\"\npotential = \"{potential}\"\n"
    ))
}

#[test]
fn a_potential_that_jumps_is_refused_with_the_place() {
    insta::assert_snapshot!(particle("x'^2/2", "step(x - a, x, 0)").unwrap_err());
    insta::assert_snapshot!(particle("x'^2/2", "2*x + sign(x^2 - a)").unwrap_err());
    insta::assert_snapshot!(particle("step(x - a, 2, 1)*x'^2/2", "0").unwrap_err());
    // The body is heavier from t = 1: its momentum, not its velocity, is continuous.
    insta::assert_snapshot!(particle("step(t - a, 2, 1)*x'^2/2", "0").unwrap_err());
}

#[test]
fn a_potential_with_corners_is_sound() {
    for (potential, acceleration) in [
        ("step(x - a, k*(x - a)^2/2, 0)", -1e10),
        ("step(x - a, k*(x - a), 0)", -1e10),
        ("step(x - a, (x - a)^1.5, 0)", -1.5),
        ("step(x - 0.1, sqrt(x - 0.1), 0)", -0.5 / 1.9_f64.sqrt()),
        ("abs(x - a)", -1.0),
        ("max(x, a)", -1.0),
        ("(x - a)*sign(x - a)", -1.0),
        // It changes with time, by no force.
        ("step(t - a, 0, 1)*x", -1.0),
        // It is not passed: x² + 1 has one sign.
        ("step(x^2 + 1, x, 0)", -1.0),
        // It is touched only.
        ("step((x - a)^2, x, 0)", -1.0),
        ("step(x - a, step(a - x - 1, 1, 0), 0) + x", -1.0),
    ] {
        let rates = particle("x'^2/2", potential).unwrap_or_else(|message| panic!("{potential}: {message}"));
        assert!(rates[0] == 3.0 && (rates[1] / acceleration - 1.0).abs() < 1e-15, "{potential}: {rates:?}");
    }
}

#[test]
fn frames_and_constraints_that_jump_are_refused() {
    let frame = "[coordinates]\nx = 0\n[quasi_velocities]\nu = 1\n[kinematics]\nx = \"step(x - 1, 1, 2)*u\"\n\
                 [lagrangian]\nkinetic = \"u^2/2\"\n";
    insta::assert_snapshot!(rates(frame).unwrap_err());
    let constraint = |text: &str| {
        rates(&format!(
            "[coordinates]\nx = -1\ny = 1\n[constraints]\npath = \"{text}\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
        ))
    };
    insta::assert_snapshot!(constraint("y - abs(x)").unwrap_err());
    insta::assert_snapshot!(constraint("y' - step(x, 2, 1)*x'").unwrap_err());
    assert!(constraint("y - x*abs(x) - 2").is_ok());
}
