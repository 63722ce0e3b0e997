//! Constraints that are not affine in the velocities, under Chetaev's condition: closed forms, and the equations with
//! multipliers against those in which the reactions are put.

use pc_expr::Events;
use pc_mech::{Graph, VectorField};
use pc_model::{Builtin, Document, Flow, Model, Source, Variables};
use pc_solve::{Method, Options, solve};
use pc_tests::classical::SplitMix64;
use pc_tests::closed_form::{appell_hamel, constant_speed};
use pc_tests::verified::derived_twice;

/// What is asked of an integration at rtol = 1e-12 of motions over a few times their own unit.
const TOLERANCE: f64 = 1e-8;

/// A particle that keeps its speed 5 under the gravity 10, thrown upwards at 4.
const CONSTANT_SPEED: &str = r#"
[parameters]
v = 5.0
g = 10.0
[coordinates]
x = 0.0
y = 0.0
[quasi_velocities]
"x'" = "0.6*v"
"y'" = "0.8*v"
[constraints]
speed = { expr = "x'^2 + y'^2 - v^2", kind = "nonlinear" }
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "g*y"
"#;

fn constant_speed_model() -> Model {
    derived_twice(Document::parse(Source::new("speed.toml", CONSTANT_SPEED)).unwrap())
}

fn machine() -> Model {
    Model::new(Builtin::named("appell-hamel").unwrap().document().unwrap())
}

fn options() -> Options {
    Options::new(Method::Adams).relative_tolerance(1e-12).absolute_tolerance(1e-14)
}

#[track_caller]
fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * (1.0 + expected.abs()), "{found} instead of {expected}");
}

/// With τ_0 = −artanh (4/5): ẏ = −v tanh τ, ẋ = v sech τ, and λ = g ẏ/(2v²) along the velocity 2 (ẋ, ẏ).
#[test]
fn a_particle_of_constant_speed_turns_downwards() {
    let mut model = constant_speed_model();
    model.observe_reactions(true);
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let (mut motion, start) = model.compile(&assembly).unwrap();
    let mut watch = motion.clone();
    let times: Vec<f64> = (1..=20).map(|i| 0.1 * f64::from(i)).collect();
    let trajectory = solve(&mut motion, 0.0, &start, &times, &options()).unwrap();
    let names = watch.observable_names().to_vec();
    let reaction = names.iter().position(|name| name == "λ_speed").unwrap();
    for (t, y) in trajectory.iter() {
        let expected = constant_speed(5.0, 10.0, -0.8f64.atanh(), t);
        for (found, expected) in y.iter().zip(expected) {
            near(*found, expected, TOLERANCE);
        }
        near(watch.observe(t, y)[reaction], 10.0 * expected[3] / 50.0, TOLERANCE);
        // Projected after every step: rounding of 25.
        assert!(watch.constraint_residuals(t, y)[0].abs() < 1e-13);
    }
    assert!(!assembly.keeps_energy(), "the reaction works");
}

#[test]
fn appells_machine_goes_straight_on() {
    let model = machine();
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let (mut motion, start) = model.compile(&assembly).unwrap();
    let trajectory = solve(&mut motion, 0.0, &start, &[0.5, 1.0, 2.0], &options()).unwrap();
    for (t, y) in trajectory.iter() {
        for (found, expected) in y.iter().zip(appell_hamel(t)) {
            near(*found, expected, TOLERANCE);
        }
    }
    assert!(assembly.keeps_energy(), "the constraint is homogeneous");
}

/// M η̇ = r + Cᵀ λ, solved at every evaluation, and the same with λ(t, x, η) put in: at states off the constraint too.
#[test]
fn reactions_put_in_give_the_rates_of_the_multipliers() {
    for model in [constant_speed_model(), machine()] {
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let (mut held, start) = model.compile(&assembly).unwrap();
        let mut put_in = assembly.equations().unwrap().compile().unwrap();
        let mut random = SplitMix64::new(0xc4e7);
        for _ in 0..1000 {
            let state: Vec<f64> = start.iter().map(|_| random.normal()).collect();
            let (mut expected, mut found) = (vec![0.0; state.len()], vec![0.0; state.len()]);
            held.rhs(0.0, &state, &mut expected).unwrap();
            put_in.rhs(0.0, &state, &mut found).unwrap();
            let size = expected.iter().fold(1.0f64, |size, rate| size.max(rate.abs()));
            for (found, expected) in found.iter().zip(&expected) {
                // Some ten operations, with sums of squares of which none is small against the rest.
                assert!((found - expected).abs() <= 1e-13 * size, "{found} {expected}");
            }
        }
    }
}

/// Gauss's principle: of the accelerations that the constraint allows, those of the motion are nearest to the free ones.
#[test]
fn the_accelerations_are_nearest_to_the_free_ones() {
    let model = machine();
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let (mut held, _) = model.compile(&assembly).unwrap();
    let mut random = SplitMix64::new(7);
    for _ in 0..200 {
        let velocity: Vec<f64> = (0..3).map(|_| random.normal()).collect();
        let mut rates = [0.0; 6];
        held.rhs(0.0, &[&[0.0; 3], &velocity[..]].concat(), &mut rates).unwrap();
        let square = |a: &[f64]| a[0] * a[0] + a[1] * a[1] + (a[2] + 10.0).powi(2);
        let normal = [velocity[0], velocity[1], -0.5625 * velocity[2]];
        let across: Vec<f64> = (0..3).map(|_| random.normal()).collect();
        // Another acceleration with the same ġ.
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let share = dot(&across, &normal) / dot(&normal, &normal);
        let other: Vec<f64> = (0..3).map(|i| rates[3 + i] + across[i] - share * normal[i]).collect();
        assert!(square(&rates[3..]) <= square(&other) + 1e-12, "{velocity:?}");
    }
}

/// A reset asks for (0.3, 0.1, 0) of a particle that keeps the speed 1 in the plane x, y and the height z.
fn reset_onto_a_circle(velocities: &str, masses: [f64; 2], reset: &str) -> Vec<f64> {
    let [a, b] = masses;
    let text = format!(
        r#"
[coordinates]
x = 0.0
y = 0.0
z = 0.0
{velocities}
[constraints]
speed = {{ expr = "x'^2 + y'^2 - 1", kind = "nonlinear" }}
level = "z"
[lagrangian]
kinetic = "({a}*x'^2 + {b}*y'^2 + z'^2 + x'*z'/2)/2"
[events.e]
when = "x - 0.5"
reset = {{ {reset} }}
[simulation]
t_end = 2.0
"#
    );
    let model = Model::new(Document::parse(Source::new("circle.toml", text)).unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let mut state = flow.start.clone();
    flow.events.reset(0, 0.0, &mut state).unwrap();
    flow.row(0.0, &state)[3..6].to_vec()
}

const ORDINARY: [&str; 2] =
    ["[quasi_velocities]\n\"x'\" = 0.6\n\"y'\" = 0.8", "\"x'\" = \"0.3\", \"y'\" = \"0.1\", \"z'\" = \"0\""];

/// u = x' + y', v = 3 y' − x', w = z' + 2 u: the same velocities 0.3, 0.1, 0.
const TURNED: [&str; 2] = [
    "[quasi_velocities]\nu = { is = \"x' + y'\", start = 1.4 }\nv = { is = \"3*y' - x'\", start = 1.8 }\n\
     w = { is = \"z' + 2*(x' + y')\", start = 2.8 }",
    "u = \"0.4\", v = \"0.0\", w = \"0.8\"",
];

/// Where masses are alike in the plane the nearest point of a circle is on the ray from its centre. z' is 0 before and after,
/// and its coupling with x' does no more than take up a reaction.
#[test]
fn a_reset_reaches_the_nearest_velocities_in_every_frame() {
    let to_ordinary = |eta: &[f64]| [(3.0 * eta[0] - eta[1]) / 4.0, (eta[0] + eta[1]) / 4.0];
    for masses in [[1.0, 1.0], [1.0, 4.0], [5.0, 0.7]] {
        let [a, b] = masses;
        let plain = reset_onto_a_circle(ORDINARY[0], masses, ORDINARY[1]);
        let turned = to_ordinary(&reset_onto_a_circle(TURNED[0], masses, TURNED[1]));
        near(plain[0].hypot(plain[1]), 1.0, 1e-14);
        // Of M (η − η₀) = Cᵀμ with C = 2 (x', y') along z' = 0: the way is across the circle in the metric.
        let across = a * (plain[0] - 0.3) * plain[1] - b * (plain[1] - 0.1) * plain[0];
        near(across, 0.0, 1e-12);
        if a == b {
            near(plain[0] / plain[1], 3.0, 1e-12);
        }
        near(turned[0], plain[0], 1e-12);
        near(turned[1], plain[1], 1e-12);
        // And no other such point is nearer.
        let distance = |x: f64, y: f64| a * (x - 0.3).powi(2) + b * (y - 0.1).powi(2);
        let angles = (0..360).map(|i| f64::from(i).to_radians());
        let least = angles.map(|angle| distance(angle.cos(), angle.sin())).fold(f64::INFINITY, f64::min);
        assert!(distance(plain[0], plain[1]) <= least, "{plain:?}");
    }
}
