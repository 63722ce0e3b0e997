//! Motions that pass where the quasi-velocities do not determine velocities.

use pc_mech::{FrameError, Graph, MechError};
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{Method, Options, Solution, Solve, SolveError};

/// An error of 1e-10 a step, in some dozen steps.
const ACCURACY: f64 = 1e-8;

/// A free particle with η_1 = x', η_2 = (x − 1) y', from x = 0 with x' = 1 and this η_2, to t = 2.
fn particle(eta: f64, method: Method) -> Result<Solution, Box<SolveError>> {
    defined("(x - 1)*y'", eta, method)
}

/// The same with η_2 = `definition`.
fn defined(definition: &str, eta: f64, method: Method) -> Result<Solution, Box<SolveError>> {
    let text = format!(
        r#"
[coordinates]
x = 0.0
y = 0.3
[quasi_velocities]
w1 = {{ is = "x'", start = 1.0 }}
w2 = {{ is = "{definition}", start = {eta:?} }}
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
"#
    );
    run(&text, method)
}

fn run(text: &str, method: Method) -> Result<Solution, Box<SolveError>> {
    let (graph, model) =
        (Graph::new(), Model::new(Document::parse(Source::new("particle.toml", text)).unwrap()));
    let assembly = model.assemble(&graph).unwrap();
    let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let options = Options::new(method).relative_tolerance(1e-10).absolute_tolerance(1e-12);
    let solve = Solve::new(&mut flow.motion, 0.0, &flow.start).method(&options);
    solve.run(&[0.5, 2.0]).map_err(|failure| Box::new(failure.error))
}

/// The motion ends in the step that passes a time, at which the state does not determine the rest of the motion.
fn assert_undetermined(outcome: Result<Solution, Box<SolveError>>, when: f64, what: &str) {
    let error = outcome.expect_err("the rest of the motion is arbitrary");
    let SolveError::Integration(error) = *error else { panic!("{what}: {error}") };
    let failure = error.failure.as_ref().unwrap();
    let cause = failure.cause().downcast_ref::<MechError>();
    let Some(MechError::Frame(FrameError::Undetermined { from, to })) = cause else {
        panic!("{what}: {error}")
    };
    assert!(
        *from < when && when < *to && error.time == *from,
        "{what}: {from} to {to}, after reaching {}",
        error.time
    );
}

/// With y' = 1/2 the motion is x = t, y = 0.3 + t/2; but at x = 1 the state is x = 1, y = 0.8, η = (1, 0) whatever y' was.
#[test]
fn a_motion_is_not_followed_past_a_place_that_does_not_determine_its_velocity() {
    for method in [Method::Adams, Method::Bdf] {
        assert_undetermined(particle(-0.5, method), 1.0, "definitions");
    }
}

/// The same where the determinant, (x − 1)², has no change of sign.
#[test]
fn a_motion_is_not_followed_past_a_double_zero() {
    for method in [Method::Adams, Method::Bdf] {
        assert_undetermined(defined("(x - 1)^2*y'", 0.5, method), 1.0, "a double zero");
        let (t, y) = (2.0, [2.0, 0.3]);
        let solution = defined("(x - 1)^2*y'", 0.0, method).unwrap();
        let (end, state) = solution.trajectory.last().unwrap();
        assert!(end == t && (0..2).all(|i| (state[i] - y[i]).abs() < ACCURACY), "{state:?}");
    }
}

/// A determinant that only comes near zero, 1e-4 at x = 1, determines the motion: w2 = y'/2 there.
#[test]
fn a_motion_is_followed_past_a_small_determinant() {
    for method in [Method::Adams, Method::Bdf] {
        let solution = defined("((x - 1)^2 + 0.0001)*y'", 0.50005, method).unwrap();
        let (t, y) = solution.trajectory.last().unwrap();
        // The rounding of w2 is seen in y' by the inverse of the determinant.
        assert!(t == 2.0 && (y[1] - 1.3).abs() < 1e4 * ACCURACY, "{y:?}");
    }
}

/// At a pole of the determinant, 1/(x − 1), w2 = y'/(x − 1) has no bound unless y' = 0.
#[test]
fn a_motion_passes_a_pole_of_its_definitions_only_at_rest() {
    for method in [Method::Adams, Method::Bdf] {
        defined("y'/(x - 1)", -0.5, method).expect_err("w2 has no bound");
        let solution = defined("y'/(x - 1)", 0.0, method).unwrap();
        let (t, y) = solution.trajectory.last().unwrap();
        assert!(t == 2.0 && (y[0] - 2.0).abs() < ACCURACY && (y[1] - 0.3).abs() < ACCURACY, "{y:?}");
    }
}

/// Where y' = 0 nothing is forgotten: x = t, y = 0.3.
#[test]
fn a_motion_without_the_undetermined_velocity_is_followed() {
    for method in [Method::Adams, Method::Bdf] {
        let solution = particle(0.0, method).unwrap();
        let (t, y) = solution.trajectory.last().unwrap();
        assert!(t == 2.0 && (y[0] - 2.0).abs() < ACCURACY && (y[1] - 0.3).abs() < ACCURACY, "{y:?}");
    }
}
