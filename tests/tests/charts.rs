//! Motions that pass where the quasi-velocities do not determine velocities.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use pc_mech::{FrameError, Graph, MechError};
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{Method, Options, Solution, Solve, SolveError};

/// An error of 1e-10 a step, in some dozen steps.
const ACCURACY: f64 = 1e-8;

/// A free particle with η_1 = x', η_2 = (x − 1) y', from x = 0 with x' = 1 and this η_2, to t = 2.
fn particle(eta: f64, method: Method) -> Result<Solution, Box<SolveError>> {
    let text = format!(
        r#"
[coordinates]
x = 0.0
y = 0.3
[quasi_velocities]
w1 = {{ is = "x'", start = 1.0 }}
w2 = {{ is = "(x - 1)*y'", start = {eta:?} }}
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
"#
    );
    let (graph, model) =
        (Graph::new(), Model::new(Document::parse(Source::new("particle.toml", &text)).unwrap()));
    let assembly = model.assemble(&graph).unwrap();
    let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let options = Options::new(method).relative_tolerance(1e-10).absolute_tolerance(1e-12);
    let solve = Solve::new(&mut flow.motion, 0.0, &flow.start).method(&options);
    solve.run(&[0.5, 2.0]).map_err(|failure| Box::new(failure.error))
}

/// With y' = 1/2 the motion is x = t, y = 0.3 + t/2; but at x = 1 the state is x = 1, y = 0.8, η = (1, 0) whatever y' was.
#[test]
fn a_motion_is_not_followed_past_a_place_that_forgets_its_velocity() {
    for method in [Method::Adams, Method::Bdf] {
        let error = particle(-0.5, method).expect_err("the rest of the motion is arbitrary");
        let SolveError::Integration(error) = *error else { panic!("{error}") };
        let failure = error.failure.as_ref().unwrap();
        let cause = failure.cause().downcast_ref::<MechError>();
        let Some(MechError::Frame(FrameError::Undetermined { from, to })) = cause else { panic!("{error}") };
        assert!(
            *from < 1.0 && 1.0 < *to && error.time == *from,
            "{from} to {to}, after reaching {}",
            error.time
        );
    }
}

/// Where y' = 0 nothing is forgotten: x = t, y = 0.3.
#[test]
fn a_motion_that_has_no_such_velocity_is_followed() {
    for method in [Method::Adams, Method::Bdf] {
        let solution = particle(0.0, method).unwrap();
        let (t, y) = solution.trajectory.last().unwrap();
        assert!(t == 2.0 && (y[0] - 2.0).abs() < ACCURACY && (y[1] - 0.3).abs() < ACCURACY, "{y:?}");
    }
}
