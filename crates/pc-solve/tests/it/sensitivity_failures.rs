//! Failures, panics and NaN of the derivatives of a vector field, and invalid input.

use std::cell::Cell;
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Code, Failure, Integration, Method, NonFinite, Options, Sensitivities, SensitivitySolution, Solve,
    SolveError, SolveFailure, VectorField,
};

type Value = fn(f64) -> Result<f64, Failure>;

/// ẏ = p with arbitrary derivatives by y, as a product or as a Jacobian, and by p.
#[derive(Clone)]
struct Faulty {
    by_state: Value,
    products: bool,
    by_parameter: Value,
    drops: Rc<Cell<u32>>,
}

impl Drop for Faulty {
    fn drop(&mut self) {
        self.drops.set(self.drops.get() + 1);
    }
}

impl VectorField for Faulty {
    fn dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, _t: f64, _y: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
        rate[0] = 1.0;
        Ok(())
    }
    fn has_jvp(&self) -> bool {
        self.products
    }
    fn jvp(&mut self, t: f64, _y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        product[0] = (self.by_state)(t)? * v[0];
        Ok(())
    }
    fn has_jacobian(&self) -> bool {
        !self.products
    }
    fn jacobian(&mut self, t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        jacobian[0] = (self.by_state)(t)?;
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
    fn component_name(&self, _i: usize) -> String {
        "x".to_owned()
    }
}

fn faulty(by_state: Value, products: bool, by_parameter: Value) -> Faulty {
    Faulty { by_state, products, by_parameter, drops: Rc::default() }
}

#[derive(Debug, PartialEq, thiserror::Error)]
#[error("no value")]
struct NoValue;

const ZERO: Value = |_| Ok(0.0);
const FATAL: Value = |t| if t > 1.0 { Err(Failure::fatal(NoValue)) } else { Ok(0.0) };
const RECOVERABLE: Value = |t| if t > 1.0 { Err(Failure::recoverable(NoValue)) } else { Ok(0.0) };
const NAN: Value = |t| if t > 1.0 { Ok(f64::NAN) } else { Ok(0.0) };
const PANIC: Value = |t| if t > 1.0 { panic!("no further than 1") } else { Ok(0.0) };

fn wanted() -> Sensitivities {
    Sensitivities::new().by_start(0).by_parameter(0)
}

fn run(field: Faulty, method: Method) -> Result<SensitivitySolution, Box<SolveFailure<SensitivitySolution>>> {
    // Adams needs no Jacobian for the state, so all failures are of the sensitivities; for BDF they
    // may be of both.
    let options = Options::new(method).initial_step(0.1).max_step(0.1);
    Solve::new(erased(field), 0.0, &[0.0]).method(&options).sensitivities(&wanted()).run(&[0.5, 2.0])
}

#[test]
fn failures_carry_the_state_reached() {
    for (by_state, by_parameter) in [(FATAL, ZERO), (ZERO, FATAL), (RECOVERABLE, ZERO), (ZERO, RECOVERABLE)] {
        for products in [true, false] {
            let failure = *run(faulty(by_state, products, by_parameter), Method::Adams).unwrap_err();
            assert_eq!(failure.reached.trajectory.motion().times(), [0.5]);
            assert!(
                (failure.reached.trajectory.matrix(0)[0] - 1.0).abs() < 1e-12
                    && !failure.reached.trajectory.motion().is_complete()
            );
            let (t, y) = failure.error.reached().unwrap();
            assert!(t > 0.89 && t <= 1.0 && (y[0] - t).abs() < 1e-9, "{t} {y:?}");
            assert_eq!(failure.source().unwrap().downcast_ref(), Some(&NoValue));
            if by_state(2.0).or(by_parameter(2.0)).is_err_and(|failure| !failure.is_recoverable()) {
                assert_eq!(failure.error.code(), Some(Code::SensitivityFatal));
            }
            let SolveError::Integration(error) = failure.error else { panic!("it began") };
            assert_eq!(error.failure.unwrap().to_string(), "no value");
        }
    }
    let at_start =
        run(faulty(|_| Err(Failure::recoverable(NoValue)), true, ZERO), Method::Adams).unwrap_err();
    assert_eq!(at_start.error.code(), Some(Code::SensitivityFirst));
    assert_eq!(at_start.error.reached(), Some((0.0, &[0.0][..])));
}

#[test]
fn derivatives_that_are_not_finite_are_named() {
    let cause = |field, method| {
        let failure = run(field, method).unwrap_err();
        assert!(failure.source().unwrap().is::<NonFinite>());
        let cause = failure.source().unwrap().to_string();
        cause.split(" at t = ").next().unwrap().to_owned()
    };
    assert_eq!(
        cause(faulty(NAN, true, ZERO), Method::Adams),
        "the derivative of the rate of x along sensitivity number 0 (from 0) is NaN"
    );
    for method in [Method::Adams, Method::Bdf] {
        assert_eq!(cause(faulty(NAN, false, ZERO), method), "the derivative of the rate of x by x is NaN");
        assert_eq!(
            cause(faulty(ZERO, false, NAN), method),
            "the derivative of the rate of x by parameter 0 (from 0) is NaN"
        );
    }
}

/// Entries that the field does not write do not keep old values.
#[test]
fn derivatives_that_are_not_written_are_named() {
    struct Silent(bool);
    impl VectorField for Silent {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _t: f64, _y: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
            rate[0] = 0.0;
            Ok(())
        }
        fn has_jvp(&self) -> bool {
            self.0
        }
        fn jvp(&mut self, _t: f64, _y: &[f64], _v: &[f64], _product: &mut [f64]) -> Result<(), Failure> {
            Ok(())
        }
        fn parameters_len(&self) -> usize {
            1
        }
        fn has_parameter_jacobian(&self) -> bool {
            true
        }
        fn parameter_jacobian(&mut self, _t: f64, _y: &[f64], _j: &mut [f64]) -> Result<(), Failure> {
            Ok(())
        }
    }
    for (products, wanted) in [(true, Sensitivities::new().by_start(0)), (false, wanted())] {
        let options = Options::default();
        let failure = Solve::new(erased(Silent(products)), 0.0, &[1.0])
            .method(&options)
            .sensitivities(&wanted)
            .run(&[1.0])
            .unwrap_err();
        assert!(failure.source().unwrap().is::<NonFinite>());
        assert_eq!(failure.error.reached(), Some((0.0, &[1.0][..])));
    }
}

#[test]
fn panics_reach_the_caller_and_leave_the_last_state() {
    for method in [Method::Adams, Method::Bdf] {
        for field in [faulty(PANIC, true, ZERO), faulty(PANIC, false, ZERO), faulty(ZERO, true, PANIC)] {
            let drops = Rc::clone(&field.drops);
            let options = Options::new(method).initial_step(0.1).max_step(0.1);
            let mut cvode =
                Integration::with_sensitivities(erased(field), 0.0, &[0.0], &options, &wanted()).unwrap();
            for _ in 0..2 {
                let advance = AssertUnwindSafe(|| cvode.state_at(2.0).map(<[f64]>::len));
                let panic = catch_unwind(advance).unwrap_err();
                assert_eq!(panic.downcast_ref::<&str>(), Some(&"no further than 1"));
                assert!(cvode.time() > 0.89 && cvode.time() <= 1.0);
                assert!((cvode.state()[0] - cvode.time()).abs() < 1e-9);
                let matrix = cvode.sensitivities().unwrap();
                assert!((matrix[0] - 1.0).abs() < 1e-9 && matrix[1].abs() < 1e-9);
            }
            assert_eq!(drops.get(), 0);
            drop(cvode);
            assert_eq!(drops.get(), 1);
        }
    }
}

/// A trial step in which only the derivatives fail is repeated with a shorter length: √y at y < 0,
/// of ẏ = −2√y.
#[test]
fn recoverable_failures_are_answered_by_shorter_steps() {
    struct Fall(u32);
    impl VectorField for Fall {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _t: f64, y: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
            rate[0] = -2.0 * y[0].abs().sqrt();
            Ok(())
        }
        fn has_jvp(&self) -> bool {
            true
        }
        fn jvp(&mut self, _t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
            self.0 += u32::from(y[0] <= 0.0);
            product[0] = -v[0] / y[0].sqrt();
            Ok(())
        }
    }
    let options = Options::default().relative_tolerance(1e-4).absolute_tolerance(1e-6).initial_step(0.999);
    // A simultaneous correction meets the trial states before the error test of the state rejects
    // them.
    let wanted = Sensitivities::new().by_start(0).correction(pc_solve::Correction::Simultaneous);
    let mut fall = Fall(0);
    let found = Solve::new(erased(&mut fall), 0.0, &[1.0])
        .method(&options)
        .sensitivities(&wanted)
        .run(&[0.9])
        .unwrap();
    // y = (√y₀ − t)², so ∂y/∂y₀ = 1 − t.
    assert!((found.trajectory.matrix(0)[0] - 0.1).abs() < 1e-2);
    assert!(fall.0 > 0);
}

#[test]
fn overflow_is_named() {
    // The motion from 0 is at rest; its derivative grows as e^t.
    let growth = from_fn(1, |_t, y: &[f64], rate: &mut [f64]| {
        rate[0] = 2.0 * y[0];
        Ok(())
    })
    .with_jacobian(|_t, _y, jacobian| {
        jacobian[0] = 2.0;
        Ok(())
    });
    let wanted = Sensitivities::new().along([1e300]);
    let options = Options::default();
    let failure = Solve::new(erased(growth), 0.0, &[0.0])
        .method(&options)
        .sensitivities(&wanted)
        .run(&[1.0, 100.0])
        .unwrap_err();
    assert_eq!(failure.reached.trajectory.motion().len(), 1);
    let (t, y) = failure.error.reached().unwrap();
    assert!(t > 1.0 && t < 10.0 && y == [0.0], "{t} {y:?}"); // ln(1.8e308/1e300)/2 = 9.5
}

#[test]
fn input_is_checked() {
    let options = Options::default();
    let refusal = |wanted: Sensitivities| {
        let field = faulty(ZERO, true, ZERO);
        let failure = Solve::new(erased(field), 0.0, &[0.0])
            .method(&options)
            .sensitivities(&wanted)
            .run(&[1.0])
            .unwrap_err();
        assert_eq!(failure.reached.trajectory.motion().len(), 0);
        failure.to_string()
    };
    let new = Sensitivities::new;
    assert_eq!(
        refusal(new().by_parameter(1)),
        "there is no parameter number 1 (from 0): the number of parameters is 1"
    );
    assert_eq!(
        refusal(new().by_start(1)),
        "there is no component number 1 (from 0): the number of components is 1"
    );
    assert_eq!(
        refusal(new().along([1.0, 2.0])),
        "the start of a sensitivity: expected one number for each component (1), found 2"
    );
    assert_eq!(refusal(new().by_parameter_from(0, [f64::NAN])), "a sensitivity of x at the start is NaN");
    assert_eq!(
        refusal(new().by_start(0).tolerances(0.0, 1.0)),
        "the relative tolerance of the sensitivities is 0, but must be positive"
    );
    assert_eq!(
        refusal(new().by_start(0).tolerances(1.0, f64::NAN)),
        "the absolute tolerance of the sensitivities is NaN"
    );
    let closure = from_fn(1, |_t, _y, rate| {
        rate[0] = 1.0;
        Ok(())
    });
    let failure = Solve::new(erased(closure), 0.0, &[0.0])
        .method(&options)
        .sensitivities(&new().by_parameter(0))
        .run(&[1.0])
        .unwrap_err();
    assert_eq!(failure.to_string(), "the vector field does not provide its derivatives by the parameters");
}
