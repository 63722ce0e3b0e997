//! Integrations that are cancelled, or ended by a deadline.

use std::time::Duration;

use crate::boxed::{erased, from_fn};
use pc_expr::{Cancel, Limits};
use pc_solve::{
    Deadline, FixedStep, Integration, Options, Reason, RungeKutta4, SolveError, SolveFailure, Spent,
    VectorField, solve,
};

/// ẏ₁ = y₂, ẏ₂ = −y₁, which cancels the integration after some time.
fn cancelling(cancel: Cancel, from: f64) -> impl VectorField {
    from_fn(2, move |t, y, ydot| {
        if t >= from {
            cancel.cancel();
        }
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    })
}

fn within(time: Option<Duration>, cancel: Cancel) -> Options {
    Options::default().deadline(Deadline::new(&Limits { time, cancel, ..Limits::default() }))
}

#[test]
fn a_cancelled_integration_keeps_what_it_reached() {
    let cancel = Cancel::default();
    let times: Vec<f64> = (1..=100).map(f64::from).collect();
    let field = cancelling(cancel.clone(), 50.0);
    let failure = solve(erased(field), 0.0, &[1.0, 0.0], &times, &within(None, cancel.clone())).unwrap_err();
    let SolveFailure { reached, error, .. } = *failure;
    assert_eq!(error.ended(), Some(Spent::Cancelled));
    assert!(error.to_string().starts_with("cancelled, after reaching t = "), "{error}");
    // The current step is completed, which is short against the distance of a few outputs.
    let outputs = reached.len();
    assert!((45..55).contains(&outputs) && !reached.is_complete(), "{outputs}");
    assert!((reached.state(outputs - 1)[0] - reached.times()[outputs - 1].cos()).abs() < 1e-6);
    // A cancelled integration does not begin again.
    let (field, options) = (cancelling(Cancel::default(), 1.0), within(None, cancel));
    let mut again = Integration::new(erased(field), 0.0, &[1.0, 0.0], &options).unwrap();
    assert_eq!(again.state_at(1.0).unwrap_err().ended(), Some(Spent::Cancelled));
    assert_eq!((again.time(), again.state()), (0.0, &[1.0, 0.0][..]));
}

/// Whether an integration that would take hours is ended by this limit only after its first steps; then it continues.
fn is_ended_midway(limit: Duration) -> bool {
    let options = within(Some(limit), Cancel::default()).max_steps(100_000_000);
    let field = cancelling(Cancel::default(), 0.0);
    let mut motion = Integration::new(erased(field), 0.0, &[1.0, 0.0], &options).unwrap();
    let error = motion.state_at(1e10).unwrap_err();
    assert_eq!(error.ended(), Some(Spent::Time { limit }));
    assert!(
        matches!(&error, SolveError::Integration(error) if error.reason == Reason::Ended(Spent::Time { limit }))
    );
    let reached = motion.time();
    assert!(motion.state_at(reached + 1e6).is_err());
    motion.renew_deadline();
    reached > 0.0 && motion.state_at(reached + 1.0).is_ok()
}

#[test]
fn a_deadline_ends_an_integration_and_a_new_one_continues_it() {
    // On a busy machine some steps may take longer than the least limit.
    let limits = [50, 1000, 20_000].map(Duration::from_millis);
    assert!(limits.into_iter().any(is_ended_midway));
}

#[test]
fn a_deadline_ends_any_method() {
    let cancel = Cancel::default();
    let deadline = Deadline::new(&Limits { cancel: cancel.clone(), ..Limits::default() });
    let steps = FixedStep::new(0.01).limits({
        let mut limits = pc_solve::Limits::default();
        limits.deadline = Some(deadline);
        limits
    });
    let field = cancelling(cancel, 1.0);
    let mut motion = Integration::of(RungeKutta4::new(field, 0.0, &[1.0, 0.0], &steps).unwrap());
    assert_eq!(motion.state_at(2.0).unwrap_err().ended(), Some(Spent::Cancelled));
    assert!((0.9..1.1).contains(&motion.time()));
}
