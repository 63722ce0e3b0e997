//! Sizes that have no meaning: of equations, and of rounding beside 0.

use pc_mech::{Graph, VectorField};
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_verify::{Options, Second, verify};

fn model(text: &str) -> Model {
    Model::new(Document::parse(Source::new("model.toml", text)).unwrap())
}

/// The rates at the start, compared there and at random states.
fn rates(text: &str) -> Vec<f64> {
    let (graph, model) = (Graph::new(), model(text));
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let start = flow.start.clone();
    let mut rates = vec![f64::NAN; start.len()];
    flow.motion.rhs(0.0, &start, &mut rates).unwrap();
    let second = Second::new(&model, &assembly).unwrap();
    second.agrees("poincare", &flow, &assembly, 0.0, &start).unwrap_or_else(|error| panic!("{error}"));
    let agreement = verify(&model, &Options { states: 20, ..Options::default() });
    assert_eq!(agreement.unwrap_or_else(|error| panic!("{error}")).states, 20);
    rates
}

/// x' = 2 u and y' = u x by constraints of any size: with u' + (2 u)˙ 2 + (u x)˙ x = 0, u̇ = −2 u² x/(5 + x²) for
/// T = (x'² + y'² + z'²)/2 and u = z'.
#[test]
fn the_size_of_a_constraint_has_no_meaning() {
    let (x, u) = (0.3, 0.8);
    let expected = [2.0 * u, u * x, u, -2.0 * u * u * x / (5.0 + x * x)];
    for [first, second] in [[1.0, 1.0], [1e-9, 1.0], [1.0, 1e-14], [1e9, 1e-9]] {
        let text = format!(
            "[coordinates]\nx = {x}\ny = 0.1\nz = 0.2\n[quasi_velocities]\nu = {{ is = \"z'\", start = {u} }}\n\
             [constraints]\na = \"{first:e}*(x' - 2*u)\"\nb = \"{second:e}*(y' - u*x)\"\n\
             [lagrangian]\nkinetic = \"(x'^2 + y'^2 + z'^2)/2\"\n"
        );
        for (found, expected) in rates(&text).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{first:e}, {second:e}: {found} for {expected}");
        }
    }
}

/// y' = x x' by a constraint of any size, from which the start of y' follows: with ẍ + x ÿ = 0 is ẍ = −x x'²/(1 + x²).
#[test]
fn a_velocity_follows_from_a_constraint_of_any_size() {
    let (x, rate): (f64, f64) = (0.2, 1.5);
    let acceleration = -x * rate * rate / (1.0 + x * x);
    let expected = [rate, x * rate, acceleration, rate * rate + x * acceleration];
    for size in [1.0, 1e-9, 1e-14, 1e9] {
        let text = format!(
            "[coordinates]\nx = {x}\ny = 0.1\n[quasi_velocities]\n\"x'\" = {rate}\n\
             [constraints]\na = \"{size:e}*(y' - x*x')\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n"
        );
        for (found, expected) in rates(&text).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14, "{size:e}: {found} for {expected}");
        }
    }
}
