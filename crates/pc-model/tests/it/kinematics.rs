//! The meaning of quasi-velocities: solved for the velocities without loss, and refused where there is none.

use pc_mech::{Graph, VectorField};
use pc_model::{Category, Document, Model, ModelError, Source};

use crate::verified::derived_twice;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn rates(text: &str) -> Vec<f64> {
    let (model, graph) = (model(text), Graph::new());
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    let (mut motion, start) = model.compile(&assembly).unwrap_or_else(|error| panic!("{error}"));
    let mut rates = vec![0.0; start.len()];
    motion.rhs(assembly.t_start, &start, &mut rates).unwrap();
    rates
}

fn error(text: &str) -> ModelError {
    let graph = Graph::new();
    match model(text).assemble(&graph) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error,
    }
}

/// u = ε x' + y', w = x' + y' with ε = cos(π/2), a rounding error: y' = u and x' = w − u.
#[test]
fn a_rounding_error_in_a_definition_does_not_affect_the_velocities() {
    for [u, w] in [["cos(pi/2)*x' + y'", "x' + y'"], ["y' + 1e-14*x'", "x' + y'"]] {
        let text = format!(
            "[coordinates]\nx = 0\ny = 0\n[quasi_velocities]\nu = {{ is = \"{u}\", start = 1 }}\n\
             w = {{ is = \"{w}\", start = 3 }}\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
        );
        let rates = rates(&text);
        // 1e-14 of a velocity of 2, and roundings
        assert!((rates[0] - 2.0).abs() < 3e-14 && (rates[1] - 1.0).abs() < 3e-14, "{rates:?}");
    }
}

/// The speed is no quasi-velocity of the language: the message says where it stands and what to write in its place.
#[test]
fn nonlinear_quasi_velocities_are_refused_with_what_to_write() {
    let help = |variables: &str| {
        format!(
            "\n  help: Hamel's nonlinear quasi-velocities are not taken: write a sum of terms linear in the {variables}, with \
             coefficients of coordinates, parameters and t; observe a nonlinear function in [outputs], hold it by a \
             constraint with `kind = \"nonlinear\"`, or give it in [states] by its rate"
        )
    };
    let text = "[coordinates]\nx = 1.0\n[quasi_velocities]\nv = { is = \"sqrt(x'^2 + 1)\", start = 1 }\n\
                [lagrangian]\nkinetic = \"x'^2/2\"\n";
    let expected = "m.toml:4:13: [quasi_velocities] v.is: `sqrt(x'^2 + 1)` is not affine in the velocities\n    \
                    v = { is = \"sqrt(x'^2 + 1)\", start = 1 }\n                \
                    ^^^^^^^^^^^^^^";
    assert_eq!(error(text).to_string(), expected.to_owned() + &help("velocities"));
    let text = "[coordinates]\nx = 1.0\n[quasi_velocities]\nv = 1\n[kinematics]\nx = \"v^2\"\n\
                [lagrangian]\nkinetic = \"x'^2/2\"\n";
    let expected = "m.toml:6:6: [kinematics] x: `v^2` is not affine in the quasi-velocities\n    x = \"v^2\"\n         ^^^";
    assert_eq!(error(text).to_string(), expected.to_owned() + &help("quasi-velocities"));
}

/// Kinematics that are linear for each sign only: the second derivatives vanish, but there is no matrix b.
#[test]
fn kinematics_with_a_kink_are_refused() {
    for velocity in
        ["abs(w)", "max(w, 0)", "min(w, 0)", "sign(w)", "step(w, 1, 2)", "w + abs(w)", "w*sign(w)"]
    {
        let text = format!(
            "[coordinates]\nx = 1.0\n[quasi_velocities]\nw = -2.0\n[kinematics]\nx = \"{velocity}\"\n\
             [lagrangian]\nkinetic = \"w^2/2\"\n"
        );
        let error = error(&text);
        let first = error.to_string().lines().next().unwrap().to_owned();
        let expected =
            format!("m.toml:6:6: [kinematics] x: `{velocity}` is not affine in the quasi-velocities");
        assert_eq!((first, error.category()), (expected, Category::Text));
    }
    for definition in ["max(x', 0)", "abs(x')", "x' + sign(x')"] {
        let text = format!(
            "[coordinates]\nx = 0.0\n[quasi_velocities]\nw = {{ is = \"{definition}\", start = -1 }}\n\
             [lagrangian]\nkinetic = \"x'^2/2\"\n"
        );
        assert!(
            error(&text).to_string().contains(&format!("`{definition}` is not affine in the velocities"))
        );
    }
    // A kink in the coordinates is allowed.
    let text = "[coordinates]\nx = -3.0\n[quasi_velocities]\nw = 2.0\n[kinematics]\nx = \"abs(x)*w + max(x, 0)\"\n\
                [lagrangian]\nkinetic = \"w^2/2\"\n";
    assert_eq!(rates(text)[0], 6.0);
}

#[test]
fn an_angular_velocity_with_a_kink_is_refused() {
    let text = "[coordinates]\nx = 1.0\n[bodies.b]\nmass = 1\nposition = [\"x\", 0, 0]\ninertia = [1, 1, 1]\n\
                angular_velocity = [0, 0, \"abs(x')\"]\n";
    assert!(error(text).to_string().contains("`abs(x')` is not affine in the velocities"));
}

const FREE: &str =
    "[quasi_velocities]\na = 1.0\nb = 2.0\n[lagrangian]\nkinetic = \"(a^2 + b^2)/2\"\n[algebra]\n";

#[test]
fn a_bracket_with_a_kink_is_refused() {
    let error = error(&format!("{FREE}brackets = {{ \"a,b\" = \"step(a, 0, 1)\" }}\n"));
    assert!(error.to_string().contains("`step(a, 0, 1)`"), "{error}");
}

/// [[t, a], b] + [[a, b], t] + [[b, t], a] = 2b with [t, a] = 2a.
#[test]
fn brackets_with_time_obey_jacobis_identity() {
    let text = format!("{FREE}brackets = {{ \"a,b\" = \"b\", \"t,a\" = \"2*a\" }}\n");
    let error = error(&text);
    let expected = "m.toml:7:28: [algebra] brackets.t,a: the brackets of t, a and b violate the Jacobi identity by 2 along b";
    assert_eq!(error.to_string().lines().next().unwrap(), expected);
    assert_eq!(error.category(), Category::Inconsistent);
    // [t, b] = 2b is a derivation of [a, b] = b.
    assert_eq!(rates(&format!("{FREE}brackets = {{ \"a,b\" = \"b\", \"t,b\" = \"2*b\" }}\n")).len(), 2);
}

/// ż = 10⁻¹⁰ y u is not a constraint on positions, however small.
#[test]
fn small_kinematics_that_are_not_closed_are_refused() {
    let text = "[coordinates]\nx = 0.0\ny = 1.0\nz = 0.0\n[quasi_velocities]\nu = 1.0\nw = 2.0\n[kinematics]\n\
                x = \"u\"\ny = \"w\"\nz = \"1e-10*y*u\"\n[lagrangian]\nkinetic = \"(u^2 + w^2)/2\"\n";
    let error = error(text);
    assert!(error.to_string().contains("the frame is not closed: [u, w]"), "{error}");
    assert_eq!(error.category(), Category::Inconsistent);
}
