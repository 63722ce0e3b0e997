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
    let agreement =
        model.derived(|assembly| verify(&model, assembly, &Options { states: 20, ..Options::default() }));
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

/// A parallelogram of two cranks of length 1 and a coupler of length 3, all axes parallel: the coupler does not turn, and
/// both cranks do as pendulums of the inertia 2·1/3 + 3 and the moment of weight 2·1/2 + 3, from the upright crank. `turned` are
/// entries of the joints of both cranks, `axis` one of the pin.
fn parallelogram(turned: &str, axis: &str, gravity: &str) -> String {
    let crank = |name: &str, at: f64| {
        format!(
            "[bodies.{name}]\njoint = {{ kind = \"revolute\", axis = [0, 0, 1], at = [{at:?}, 0, 0]{turned} }}\n\
             mass = 1\ncenter = [0.5, 0, 0]\ninertia = [0, \"1/12\", \"1/12\"]\n"
        )
    };
    format!(
        "[coordinates]\nleft = 1\nright = 1\ncoupler = -1\n[quasi_velocities]\n\"left'\" = 0.5\n\
         [gravity]\nacceleration = {gravity}\n{}{}\
         [bodies.coupler]\nparent = \"left\"\njoint = {{ kind = \"revolute\", axis = [0, 0, 1], at = [1, 0, 0] }}\n\
         mass = 3\ncenter = [1.5, 0, 0]\ninertia = [0, 2.25, 2.25]\n\
         [loops.pin]\nkind = \"revolute\"\nbodies = [\"coupler\", \"right\"]\nat = [[3, 0, 0], [1, 0, 0]]\n\
         axis = [[0, 0, 1], {axis}]\n",
        crank("left", 0.0),
        crank("right", 3.0)
    )
}

/// A program that draws writes a quarter of a turn with cos(π/2) = 6.1e-17; so read, a loop of parallel axes would leave
/// nothing free.
#[test]
fn rounding_in_constants_of_joints_restricts_nothing() {
    let drawn = ", rotation = [1, 1.2e-17, -5.6e-17, 5.6e-17, 6.123e-17, -1, 0, 1, 6.123e-17]";
    let written = ", rotation = [1, 0, 0, 0, \"cos(pi/2)\", -1, 0, \"sin(pi/2)\", \"cos(pi/2)\"]";
    let near =
        ", rotation = [1, 1.2e-17, -5.6e-17, -1.2e-17, 0.9999999999999999, 6.1e-17, 5.6e-17, -6.1e-17, 1]";
    let upright = "[0, -10, 0]";
    let cases = [
        ("", "[0, 0, 1]", upright),
        ("", "[6.1e-17, -1.2e-16, 1]", upright),
        (near, "[0, 0, 1]", upright),
        (drawn, "[0, 6.1e-17, 2]", "[0, 6.1e-16, -10]"),
        (written, "[0, 0, 1]", "[0, 0, -10]"),
    ];
    // (2/3 + 3) φ̈ = −10 (1 + 3) cos φ
    let expected = -10.0 * 4.0 * 1.0f64.cos() / (2.0 / 3.0 + 3.0);
    for (turned, axis, gravity) in cases {
        let rates = rates(&parallelogram(turned, axis, gravity));
        assert!((rates[3] - expected).abs() < 1e-13, "{turned}: {rates:?} for {expected}");
    }
}

/// The inertia and the centre of a body with rounding beside zeros, as a program that draws writes them.
#[test]
fn rounding_beside_zeros_of_bodies_is_compared() {
    let text = |tiny: f64| {
        format!(
            "[quasi_velocities]\n\"hull_ω1\" = 0.3\n\"hull_ω2\" = 1.0\n[gravity]\nacceleration = [{tiny:e}, 0, -9.81]\n\
             [bodies.hull]\njoint = {{ kind = \"free\" }}\nmass = 2\ncenter = [{tiny:e}, 0, -{tiny:e}]\n\
             inertia = [1, 2, 2.5, {tiny:e}, -{tiny:e}, 1e-18]\n\
             [bodies.arm]\nparent = \"hull\"\njoint = {{ kind = \"cylindrical\", axis = [0, 1, {tiny:e}], at = [0.5, {tiny:e}, 0], \
             turns = [[\"x\", \"pi/2\"]] }}\nmass = 0.5\ncenter = [0.2, 0, {tiny:e}]\ninertia = [0.1, 0.2, 0.25, {tiny:e}, 0, -{tiny:e}]\n"
        )
    };
    let (exact, rounded) = (rates(&text(0.0)), rates(&text(5.6e-17)));
    for (exact, rounded) in exact.iter().zip(&rounded) {
        assert!((exact - rounded).abs() < 1e-14, "{exact} {rounded}");
    }
}
