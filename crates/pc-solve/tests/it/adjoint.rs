//! Gradients by the adjoint equations against closed forms and forward sensitivities, and their
//! failures.

use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::boxed::erased;
use crate::offers::{Circle, Formulas, OFFERS, Offer, Offering, Oscillator, Pendulum, precise};
use pc_solve::{
    AdjointOptions, Code, Failure, Functional, Gradient, Method, NonFinite, NonlinearSolver, Options, Reason,
    Sensitivities, Solve, SolveError, VectorField, adjoint_gradient,
};

/// G = ∫ (φ̇² + p₀ cos(t) φ) dt + φ(T)² φ̇(T) + p₁ φ̇(T) of the pendulum.
#[derive(Clone, Copy)]
struct Mixed([f64; 3]);

impl Functional for Mixed {
    fn density(&mut self, t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.copy_from_slice(&[self.0[0] * t.cos(), 2.0 * y[1]]);
        by_p.copy_from_slice(&[t.cos() * y[0], 0.0, 0.0]);
        Ok(y[1] * y[1] + self.0[0] * t.cos() * y[0])
    }
    fn end(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.copy_from_slice(&[2.0 * y[0] * y[1], y[0] * y[0] + self.0[1]]);
        by_p.copy_from_slice(&[0.0, y[1], 0.0]);
        Ok(y[0] * y[0] * y[1] + self.0[1] * y[1])
    }
}

/// The pendulum with ∫ g dt as a third component.
#[derive(Clone, Copy)]
struct WithIntegral(Pendulum);

impl Formulas for WithIntegral {
    const DIM: usize = 3;
    const PARAMETERS: usize = 3;
    fn rhs(&self, t: f64, y: &[f64], rate: &mut [f64]) {
        self.0.rhs(t, y, &mut rate[..2]);
        rate[2] = y[1] * y[1] + self.0.0[0] * t.cos() * y[0];
    }
    fn jacobian(&self, t: f64, y: &[f64], jacobian: &mut [f64]) {
        let mut of_pendulum = [0.0; 4];
        self.0.jacobian(t, y, &mut of_pendulum);
        let [a, b, c, d] = of_pendulum;
        jacobian.copy_from_slice(&[a, b, self.0.0[0] * t.cos(), c, d, 2.0 * y[1], 0.0, 0.0, 0.0]);
    }
    fn by_parameters(&self, t: f64, y: &[f64], jacobian: &mut [f64]) {
        let mut of_pendulum = [0.0; 6];
        self.0.by_parameters(t, y, &mut of_pendulum);
        let [a, b, c, d, e, f] = of_pendulum;
        jacobian.copy_from_slice(&[a, b, t.cos() * y[0], c, d, 0.0, e, f, 0.0]);
    }
}

const START: [f64; 2] = [1.0, 0.7];

/// G and its gradients by y₀ and p from forward sensitivities.
fn forward(p: [f64; 3], t0: f64, t1: f64) -> (f64, Vec<f64>) {
    let field = Offering(WithIntegral(Pendulum(p)), Offer::Jacobian);
    let wanted = Sensitivities::new().by_starts(0..2).by_parameters(0..3);
    let options = Options::default().relative_tolerance(1e-12).absolute_tolerance(1e-14);
    let start = [START[0], START[1], 0.0];
    let found =
        Solve::new(erased(field), t0, &start).method(&options).sensitivities(&wanted).run(&[t1]).unwrap();
    let y = found.trajectory.motion().state(0);
    let (mut by_y, mut by_p) = ([0.0; 2], [0.0; 3]);
    let value = y[2] + Mixed(p).end(t1, y, &mut by_y, &mut by_p).unwrap();
    let gradient = (0..5).map(|j| {
        let s = found.trajectory.column(0, j);
        s[2] + by_y[0] * s[0] + by_y[1] * s[1] + if j >= 2 { by_p[j - 2] } else { 0.0 }
    });
    (value, gradient.collect())
}

#[track_caller]
fn assert_agree(found: &Gradient, expected: &(f64, Vec<f64>), tolerance: f64, what: impl std::fmt::Debug) {
    let error = (found.value - expected.0).abs();
    assert!(error < tolerance * (1.0 + expected.0.abs()), "{what:?}: {} {}", found.value, expected.0);
    let gradient = [&found.by_start[..], &found.by_parameters].concat();
    assert_eq!(gradient.len(), expected.1.len());
    // Errors relative to the largest component, since they spread between components.
    let size = expected.1.iter().fold(1.0, |size: f64, b| size.max(b.abs()));
    for (a, b) in gradient.iter().zip(&expected.1) {
        assert!((a - b).abs() < tolerance * size, "{what:?}: {gradient:?}, not {:?}", expected.1);
    }
}

/// For a nonlinear system, with drag, which has a corner, and without.
#[test]
fn adjoint_and_forward_agree() {
    for p in [[1.3, 0.0, 0.4], [1.3, 0.2, 0.4]] {
        for (t0, t1) in [(0.0, 6.0), (2.0, -1.0)] {
            let expected = forward(p, t0, t1);
            for motion in precise() {
                for offer in OFFERS {
                    let options = AdjointOptions::new(motion.clone());
                    let field = Offering(Pendulum(p), offer);
                    let found = adjoint_gradient(field, Mixed(p), t0, &START, t1, &options).unwrap();
                    assert_agree(&found, &expected, 1e-8, (&motion, offer, p, t1));
                    assert!(found.statistics.steps > 10);
                }
            }
        }
    }
}

/// Checkpoints change gradients within the tolerances of their restarts only.
#[test]
fn checkpoints() {
    let p = [1.3, 0.1, 0.4];
    let expected = forward(p, 0.0, 12.0);
    for motion in precise() {
        for steps in [5, 30, 200, 100_000] {
            let options = AdjointOptions::new(motion.clone()).checkpoint_interval(steps);
            let field = Offering(Pendulum(p), Offer::Jacobian);
            let found = adjoint_gradient(field, Mixed(p), 0.0, &START, 12.0, &options).unwrap();
            assert_agree(&found, &expected, 1e-8, (&motion, steps));
        }
    }
}

/// With a stop time beyond the end the last step may pass the end; no piece of the motion may begin
/// there.
#[test]
fn a_stop_time_beyond_the_end_changes_nothing() {
    let p = [1.3, 0.1, 0.4];
    let expected = forward(p, 0.0, 2.0);
    for motion in precise() {
        let options = AdjointOptions::new(motion.clone().stop_time(3.0)).checkpoint_interval(1);
        let field = Offering(Pendulum(p), Offer::Jacobian);
        let found = adjoint_gradient(field, Mixed(p), 0.0, &START, 2.0, &options).unwrap();
        assert_agree(&found, &expected, 1e-8, &motion);
    }
}

/// G = ∫ x dt of the oscillator: by x₀ it is sin(ωT)/ω, by ẋ₀ (1 − cos ωT)/ω².
#[test]
fn closed_form() {
    struct Mean;
    impl Functional for Mean {
        fn density(
            &mut self,
            _t: f64,
            y: &[f64],
            by_y: &mut [f64],
            by_p: &mut [f64],
        ) -> Result<f64, Failure> {
            by_y.copy_from_slice(&[1.0, 0.0]);
            by_p.fill(0.0);
            Ok(y[0])
        }
    }
    let (w, t) = (1.7, 5.0);
    for motion in precise() {
        let field = Offering(Oscillator { damping: 0.0, frequency: w }, Offer::Products);
        let found = adjoint_gradient(field, Mean, 0.0, &[0.4, 0.0], t, &AdjointOptions::new(motion)).unwrap();
        let (sin, cos) = (w * t).sin_cos();
        // ∂/∂ω of 0.4 sin(ωT)/ω; the derivative by the damping is compared above.
        let by_frequency = 0.4 * (t * cos / w - sin / (w * w));
        assert!((found.value - 0.4 * sin / w).abs() < 1e-8);
        assert!((found.by_start[0] - sin / w).abs() < 1e-8);
        assert!((found.by_start[1] - (1.0 - cos) / (w * w)).abs() < 1e-8);
        assert!((found.by_parameters[1] - by_frequency).abs() < 1e-8);
    }
}

/// G = y(T), of a field without parameters, also with Newton's iteration and Adams' formulas.
#[test]
fn fields_without_parameters() {
    struct End;
    impl Functional for End {
        fn end(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
            assert!(by_p.is_empty());
            by_y[0] = 1.0;
            Ok(y[0])
        }
    }
    let decay = pc_solve::from_fn(1, |_t, y: &[f64], rate: &mut [f64]| {
        rate[0] = -y[0] * y[0];
        Ok(())
    });
    for motion in precise() {
        for solver in [NonlinearSolver::Newton, NonlinearSolver::FixedPoint] {
            let options = AdjointOptions::new(motion.clone().nonlinear_solver(solver));
            let found = adjoint_gradient(decay.clone(), End, 0.0, &[2.0], 1.5, &options).unwrap();
            assert!((found.value - 0.5).abs() < 1e-9);
            assert!((found.by_start[0] - 1.0 / 16.0).abs() < 1e-9);
            assert!(found.by_parameters.is_empty());
        }
    }
}

/// Along projected states: G = ∫ x ż dt + z(T) of a pendulum on a circle, by the start along the
/// circle.
#[test]
fn fields_with_a_projection() {
    struct Area;
    impl Functional for Area {
        fn density(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], _p: &mut [f64]) -> Result<f64, Failure> {
            assert!((y[0].hypot(y[1]) - 1.0).abs() < 1e-7); // the tolerance, within steps
            by_y.copy_from_slice(&[y[3], 0.0, 0.0, y[0]]);
            Ok(y[0] * y[3])
        }
        fn end(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], _p: &mut [f64]) -> Result<f64, Failure> {
            by_y.copy_from_slice(&[0.0, 1.0, 0.0, 0.0]);
            Ok(y[1])
        }
    }
    // The same in terms of the angle φ from the horizontal: x ż = φ̇ cos² φ.
    let by_angle = pc_solve::from_fn(3, |_t, y: &[f64], rate: &mut [f64]| {
        rate.copy_from_slice(&[y[1], -y[0].cos(), y[1] * y[0].cos().powi(2)]);
        Ok(())
    });
    let (end, speed) = (30.0, 2.0);
    for method in [Method::Adams, Method::Bdf] {
        let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
        let circle = Circle { farthest: 0.0 };
        let start = [1.0, 0.0, 0.0, speed];
        let adjoint = AdjointOptions::new(options).checkpoint_interval(150);
        let found = adjoint_gradient(circle, Area, 0.0, &start, end, &adjoint).unwrap();
        let exact = Options::default().relative_tolerance(1e-12).absolute_tolerance(1e-13);
        let wanted = Sensitivities::new().by_starts(0..2);
        let forward = Solve::new(erased(by_angle.clone()), 0.0, &[0.0, speed, 0.0])
            .method(&exact)
            .sensitivities(&wanted)
            .run(&[end])
            .unwrap();
        let y = forward.trajectory.motion().state(0);
        assert!((found.value - y[2] - y[0].sin()).abs() < 1e-6, "{} {}", found.value, y[2] + y[0].sin());
        // By φ₀, (x, z, ẋ, ż) = (0, 1, −φ̇, 0), and by φ̇₀, (0, 0, 0, 1).
        let along = [found.by_start[1] - speed * found.by_start[2], found.by_start[3]];
        for (j, along) in along.into_iter().enumerate() {
            let s = forward.trajectory.column(0, j);
            let expected = s[2] + y[0].cos() * s[0];
            // Across the circle λ is some thousand times larger, and its errors are relative to
            // that: 1e-12 times some thousand steps times this factor.
            assert!(
                (along - expected).abs() < 5e-6 * (1.0 + expected.abs()),
                "{method:?}: {along} {expected}"
            );
        }
    }
}

/// ẏ = 1 with faults after some time.
#[derive(Clone, Copy)]
struct Faulty {
    jacobian: fn(f64) -> Result<f64, Failure>,
    by_parameter: fn(f64) -> Result<f64, Failure>,
    density: fn(f64) -> Result<f64, Failure>,
    end: fn(f64) -> Result<f64, Failure>,
}

const SOUND: Faulty =
    Faulty { jacobian: |_| Ok(0.0), by_parameter: |_| Ok(1.0), density: |_| Ok(1.0), end: |_| Ok(1.0) };

impl VectorField for Faulty {
    fn dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, _t: f64, _y: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
        rate[0] = 1.0;
        Ok(())
    }
    fn has_jacobian(&self) -> bool {
        true
    }
    fn jacobian(&mut self, t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        jacobian[0] = (self.jacobian)(t)?;
        Ok(())
    }
    fn parameters_len(&self) -> usize {
        1
    }
    fn has_parameter_jacobian(&self) -> bool {
        true
    }
    fn parameter_jacobian(&mut self, t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        jacobian[0] = (self.by_parameter)(t)?;
        Ok(())
    }
}

impl Functional for Faulty {
    fn density(&mut self, t: f64, _y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        (by_y[0], by_p[0]) = (1.0, 0.0);
        (self.density)(t)
    }
    fn end(&mut self, t: f64, _y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y[0] = (self.end)(t)?;
        by_p[0] = 0.0;
        Ok(0.0)
    }
}

#[derive(Debug, PartialEq, thiserror::Error)]
#[error("no value")]
struct NoValue;

fn gradient(faulty: Faulty) -> Result<Gradient, SolveError> {
    let options = AdjointOptions::new(Options::new(Method::Adams).max_step(0.1)).checkpoint_interval(3);
    adjoint_gradient(faulty, faulty, 0.0, &[0.0], 2.0, &options)
}

fn before_one(t: f64) -> Result<f64, Failure> {
    if t < 1.0 { Err(Failure::fatal(NoValue)) } else { Ok(1.0) }
}

#[test]
fn failures_carry_the_state_reached() {
    assert!((gradient(SOUND).unwrap().by_parameters[0] - 4.0).abs() < 1e-8); // λ = 1 + (2 − t)
    for (faulty, code) in [
        (Faulty { jacobian: before_one, ..SOUND }, Code::RhsFatal),
        (Faulty { by_parameter: before_one, ..SOUND }, Code::QuadratureFatal),
    ] {
        let error = gradient(faulty).unwrap_err();
        assert_eq!(error.code(), Some(code));
        assert_eq!(error.source().unwrap().downcast_ref(), Some(&NoValue));
        let (t, y) = error.reached().unwrap();
        assert!((1.0..2.0).contains(&t) && (y[0] - t).abs() < 1e-9, "{t} {y:?}"); // y = t
        let SolveError::Integration(error) = error else { panic!("it began") };
        assert!(matches!(error.reason, Reason::Adjoint(_)));
        let expected = format!(
            "in the adjoint equations, integrated backwards from the end: {code} after reaching t = {t}: "
        );
        assert!(error.to_string().starts_with(&expected), "{error}");
    }
    let error = gradient(Faulty { density: before_one, ..SOUND }).unwrap_err();
    assert_eq!(error.source().unwrap().downcast_ref(), Some(&NoValue));
    assert!(error.reached().is_some_and(|(t, y)| t >= 1.0 && (y[0] - t).abs() < 1e-9));

    let error = gradient(Faulty { end: |_| Err(Failure::recoverable(NoValue)), ..SOUND }).unwrap_err();
    assert_eq!(error.to_string(), "the functional cannot be evaluated at the end, t = 2");
    assert_eq!(error.source().unwrap().downcast_ref(), Some(&NoValue));
    assert!(error.reached().is_some_and(|(t, y)| t == 2.0 && (y[0] - 2.0).abs() < 1e-9));
}

#[test]
fn numbers_that_are_not_finite_are_named() {
    let cause = |faulty| {
        let error = gradient(faulty).unwrap_err();
        let cause = error.source().unwrap();
        assert!(cause.is::<NonFinite>());
        let message = cause.to_string();
        message.split(" at t = ").next().unwrap().to_owned()
    };
    assert_eq!(
        cause(Faulty { jacobian: |_| Ok(f64::NAN), ..SOUND }),
        "the derivative of the rate of y[0] by y[0] is NaN"
    );
    assert_eq!(
        cause(Faulty { by_parameter: |_| Ok(f64::INFINITY), ..SOUND }),
        "the derivative of the rate of y[0] by parameter 0 (from 0) is inf"
    );
    assert_eq!(cause(Faulty { density: |_| Ok(f64::NAN), ..SOUND }), "the density of the functional is NaN");
    assert_eq!(
        cause(Faulty { end: |_| Ok(f64::NEG_INFINITY), ..SOUND }),
        "the derivative by y[0] of the end term of the functional is -inf"
    );
}

#[test]
fn panics_reach_the_caller() {
    for faulty in [
        Faulty { jacobian: |_| panic!("here"), ..SOUND },
        Faulty { by_parameter: |_| panic!("here"), ..SOUND },
        Faulty { density: |_| panic!("here"), ..SOUND },
        Faulty { end: |_| panic!("here"), ..SOUND },
    ] {
        let panic = catch_unwind(AssertUnwindSafe(|| gradient(faulty).is_ok())).unwrap_err();
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"here"));
    }
}

#[test]
fn input_is_checked() {
    let refusal = |options: AdjointOptions, t1| {
        adjoint_gradient(SOUND, SOUND, 0.0, &[0.0], t1, &options).unwrap_err().to_string()
    };
    let new = || AdjointOptions::new(Options::default());
    assert_eq!(refusal(new(), 0.0), "the end time equals the start time, t = 0");
    assert_eq!(refusal(new(), f64::NAN), "output time number 0 (from 0) is NaN");
    assert_eq!(
        refusal(new().checkpoint_interval(0), 1.0),
        "the number of steps between checkpoints is 0, but must be positive"
    );
    assert_eq!(
        refusal(new().tolerances(-1.0, 1.0), 1.0),
        "the relative tolerance of the adjoint equations is -1, but must be positive"
    );
    let stopped = AdjointOptions::new(Options::default().stop_time(0.5));
    assert_eq!(refusal(stopped, 1.0), "t = 1 lies beyond the stop time 0.5");
    let limited = AdjointOptions::new(Options::default().max_steps(3).max_step(0.1));
    let error = adjoint_gradient(SOUND, SOUND, 0.0, &[0.0], 2.0, &limited).unwrap_err();
    assert_eq!(error.code(), Some(Code::TooMuchWork));
}
