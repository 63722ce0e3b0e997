//! Invalid input.

use pc_solve::{Failure, FnField, Integration, Method, Options, VectorField, solve};

use crate::boxed::erased;

type Rhs = fn(f64, &[f64], &mut [f64]) -> Result<(), Failure>;

fn drift(dim: usize) -> FnField<Rhs> {
    pc_solve::from_fn(dim, |_t, _y, ydot| {
        ydot.fill(1.0);
        Ok(())
    })
}

#[track_caller]
fn assert_refused(options: &Options, expected: &str) {
    let error = Integration::new(erased(drift(2)), 0.0, &[0.0, 0.0], options).expect_err("must be refused");
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.reached(), None);
    assert_eq!(error.code(), None);
}

#[test]
fn options() {
    let new = Options::default;
    assert_refused(&new().relative_tolerance(0.0), "the relative tolerance is 0, but must be positive");
    assert_refused(&new().relative_tolerance(f64::NAN), "the relative tolerance is NaN");
    assert_refused(&new().absolute_tolerance(-1.0), "the absolute tolerance is -1, but must be positive");
    assert_refused(
        &new().absolute_tolerance(vec![1e-9]),
        "the absolute tolerances: expected one number for each component (2), found 1",
    );
    assert_refused(
        &new().absolute_tolerance(vec![1e-9, 0.0]),
        "absolute tolerance number 1 (from 0) is 0, but must be positive",
    );
    assert_refused(&new().max_steps(0), "the maximum number of steps must be at least 1");
    assert_refused(&new().initial_step(-0.1), "the initial step is -0.1, but must be positive");
    assert_refused(&new().min_step(f64::INFINITY), "the minimum step is inf");
    assert_refused(&new().max_step(0.0), "the maximum step is 0, but must be positive");
    assert_refused(
        &new().min_step(0.2).max_step(0.1),
        "the minimum step 0.2 is larger than the maximum step 0.1",
    );
    assert_refused(&new().max_order(13), "the maximum order is 13, but Adams has orders 1 to 12");
    assert_refused(
        &Options::new(Method::Bdf).max_order(0),
        "the maximum order is 0, but BDF has orders 1 to 5",
    );
    assert_refused(&new().stop_time(f64::NAN), "the stop time is NaN");
}

#[test]
fn start() {
    let refusal = |field: FnField<Rhs>, t0: f64, y0: &[f64]| {
        Integration::new(erased(field), t0, y0, &Options::default()).expect_err("must be refused").to_string()
    };
    assert_eq!(refusal(drift(0), 0.0, &[]), "the vector field has no components");
    assert_eq!(
        refusal(drift(2), 0.0, &[0.0]),
        "the start: expected one number for each component (2), found 1"
    );
    assert_eq!(
        refusal(drift(usize::MAX), 0.0, &[0.0]),
        "the start: expected one number for each component (18446744073709551615), found 1"
    );
    assert_eq!(refusal(drift(1), f64::INFINITY, &[0.0]), "the start time is inf");
    assert_eq!(refusal(drift(2), 0.0, &[0.0, f64::NAN]), "y[1] at the start is NaN");
    assert_eq!(refusal(drift(2).with_names(["x", "v"]), 0.0, &[0.0, f64::NAN]), "v at the start is NaN");
}

#[test]
fn times() {
    let refusal = |times: &[f64]| {
        let failure = solve(erased(drift(1)), 1.0, &[0.0], times, &Options::default()).unwrap_err();
        assert!(failure.reached.is_empty());
        assert_eq!(failure.reached.last(), None);
        failure.to_string()
    };
    assert_eq!(refusal(&[]), "no output times are given");
    assert_eq!(refusal(&[1.0]), "the end time equals the start time, t = 1");
    assert_eq!(refusal(&[2.0, f64::NAN, 3.0]), "output time number 1 (from 0) is NaN");
    assert_eq!(refusal(&[2.0, f64::INFINITY]), "output time number 1 (from 0) is inf");
    assert_eq!(
        refusal(&[2.0, 3.0, 3.0]),
        "output times must increase throughout or decrease throughout: 3 (number 2 from 0) follows 3"
    );
    assert_eq!(
        refusal(&[2.0, 1.5, 3.0]),
        "output times must increase throughout or decrease throughout: 1.5 (number 1 from 0) follows 2"
    );
    assert_eq!(refusal(&[0.5, 1.5]), "t = 0.5 has already been passed: the integration has reached t = 1");
    let options = Options::default().stop_time(1.5);
    let failure = solve(erased(drift(1)), 1.0, &[0.0], &[1.2, 1.6], &options).unwrap_err();
    assert_eq!(failure.to_string(), "t = 1.6 lies beyond the stop time 1.5");
    let failure = solve(erased(drift(0)), 1.0, &[], &[2.0], &options).unwrap_err();
    assert_eq!(failure.reached.iter().len(), 0);
}

#[test]
fn directions() {
    let mut cvode = Integration::new(erased(drift(1)), 0.0, &[0.0], &Options::default()).unwrap();
    assert_eq!(cvode.step_towards(0.0).unwrap_err().to_string(), "the end time equals the start time, t = 0");
    cvode.state_at(1.0).unwrap();
    assert_eq!(
        cvode.state_at(0.5).unwrap_err().to_string(),
        "t = 0.5 has already been passed: the integration has reached t = 1"
    );
    assert_eq!(
        cvode.step_towards(0.5).unwrap_err().to_string(),
        "t = 0.5 has already been passed: the integration has reached t = 1"
    );
    assert_eq!(cvode.state_at(f64::NAN).unwrap_err().to_string(), "the time is NaN");
    assert_eq!(cvode.interpolate(f64::NAN, 0).unwrap_err().to_string(), "the time is NaN");
    let reached = cvode.statistics().current_time;
    assert_eq!(
        cvode.set_stop_time(Some(0.5)).unwrap_err().to_string(),
        format!("t = 0.5 has already been passed: the integration has reached t = {reached}")
    );
    // The errors have changed nothing.
    assert_eq!(cvode.time(), 1.0);
    assert!((cvode.state_at(2.0).unwrap()[0] - 2.0).abs() < 1e-9);

    let mut behind =
        Integration::new(erased(drift(1)), 0.0, &[0.0], &Options::default().stop_time(-1.0)).unwrap();
    assert_eq!(behind.state_at(1.0).unwrap_err().to_string(), "t = 1 lies beyond the stop time -1");
    behind.state_at(-1.0).unwrap();
}

#[test]
fn closures_without_a_jacobian_say_so() {
    let mut field = drift(1);
    assert!(!field.has_jacobian());
    let failure = field.jacobian(0.0, &[0.0], &mut [0.0]).unwrap_err();
    assert_eq!(failure.to_string(), "this vector field was given no Jacobian");
    assert!(!failure.is_recoverable());
}
