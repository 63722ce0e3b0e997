//! Fields whose states lie on a surface: a pendulum in Cartesian coordinates.

use crate::boxed::{erased, from_fn};
use pc_solve::{Failure, Method, Options, Reason, SolveError, VectorField, solve};

/// A pendulum of unit length under unit gravity: ṙ = v, v̇ = g − (g·r + |v|²) r/|r|², which does
/// not return to the circle by itself.
#[derive(Clone, Copy)]
struct Circle {
    projected: bool,
    /// The projection fails after this time.
    lost_after: f64,
}

#[derive(Debug, thiserror::Error)]
#[error("lost")]
struct Lost;

impl VectorField for Circle {
    fn dim(&self) -> usize {
        4
    }

    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let pull = (y[2] * y[2] + y[3] * y[3] - y[1]) / (y[0] * y[0] + y[1] * y[1]);
        ydot.copy_from_slice(&[y[2], y[3], -pull * y[0], -1.0 - pull * y[1]]);
        Ok(())
    }

    fn has_projection(&self) -> bool {
        self.projected
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        if t > self.lost_after {
            return Err(Failure::recoverable(Lost));
        }
        let length = y[0].hypot(y[1]);
        let (x, z) = (y[0] / length, y[1] / length);
        let along = x * y[3] - z * y[2];
        y.copy_from_slice(&[x, z, -along * z, along * x]);
        Ok(())
    }
}

const CIRCLE: Circle = Circle { projected: true, lost_after: f64::INFINITY };
/// From the horizontal upwards, over the top.
const START: [f64; 4] = [1.0, 0.0, 0.0, 2.0];

/// The largest residual of circle and tangent, the largest error of the position, and the number of
/// steps.
fn turn(method: Method, rtol: f64, circle: Circle, end: f64) -> (f64, f64, u64) {
    let options =
        |rtol| Options::new(method).relative_tolerance(rtol).absolute_tolerance(rtol).max_steps(10_000_000);
    let times: Vec<f64> = (1..=500).map(|i| end * f64::from(i) / 500.0).collect();
    let motion = solve(erased(circle), 0.0, &START, &times, &options(rtol)).unwrap();
    let by_angle = from_fn(2, |_t, y, ydot| {
        ydot.copy_from_slice(&[y[1], -y[0].cos()]);
        Ok(())
    });
    let exact = solve(erased(by_angle), 0.0, &[0.0, 2.0], &times, &options(1e-14)).unwrap();
    let mut worst = (0.0f64, 0.0f64);
    for ((_, y), (_, angle)) in motion.iter().zip(exact.iter()) {
        worst.0 = worst.0.max((y[0].hypot(y[1]) - 1.0).abs()).max((y[0] * y[2] + y[1] * y[3]).abs());
        worst.1 = worst.1.max((y[0] - angle[0].cos()).hypot(y[1] - angle[0].sin()));
    }
    (worst.0, worst.1, motion.statistics().steps)
}

/// States at outputs, inside steps too, are on the surface to rounding, and the motion along it is
/// more accurate, with no more steps.
#[test]
fn projection_keeps_the_surface_and_the_accuracy() {
    for method in [Method::Adams, Method::Bdf] {
        let (residual, error, steps) = turn(method, 1e-8, CIRCLE, 200.0);
        let (drift, free_error, free_steps) =
            turn(method, 1e-8, Circle { projected: false, ..CIRCLE }, 200.0);
        assert!(residual < 4e-16, "{method:?}: {residual:e}");
        assert!(drift > 1e-4, "{method:?}: without projection the circle is left by {drift:e} only");
        // The period depends on the length of the pendulum, which drifts without projection.
        assert!(error * 10.0 < free_error, "{method:?}: {error:e} against {free_error:e}");
        // The error tests fail no more often: a tenth more steps would indicate a history that is
        // not smooth.
        assert!(steps * 10 < free_steps * 11, "{method:?}: {steps} steps against {free_steps}");
    }
}

/// The error falls with the tolerance at least as its power 0.7 (with variable order, errors are
/// only roughly proportional to the tolerance).
#[test]
fn projection_preserves_the_order() {
    for method in [Method::Adams, Method::Bdf] {
        let errors = [1e-5, 1e-7, 1e-9, 1e-11].map(|rtol| turn(method, rtol, CIRCLE, 20.0).1);
        let slope = (errors[0] / errors[3]).log10() / 6.0;
        assert!(slope > 0.7, "{method:?}: slope {slope}, {errors:?}");
    }
}

#[test]
fn a_state_that_cannot_be_projected_ends_the_integration() {
    let options = Options::new(Method::Adams);
    let circle = Circle { lost_after: 1.0, ..CIRCLE };
    let failure = solve(erased(circle), 0.0, &START, &[0.5, 3.0], &options).unwrap_err();
    assert_eq!(failure.reached.len(), 1);
    let SolveError::Integration(error) = failure.error else { panic!("no step was taken") };
    assert!(matches!(error.reason, Reason::Projection { t } if t > 1.0));
    assert!(error.time <= 1.0);
    assert_eq!(error.failure.unwrap().to_string(), "lost");
}
