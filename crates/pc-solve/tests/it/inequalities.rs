//! Components that keep their sign.

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Code, Inequality, Integration, LinearSolver, Method, NonlinearSolver, Options, Pattern, SolveError,
};

/// The least y over the ends of steps of ẏ = −100 y.
fn least(options: &Options) -> f64 {
    let decay = from_fn(1, |_t, y, ydot| {
        ydot[0] = -100.0 * y[0];
        Ok(())
    })
    .with_sparsity(Pattern::full(1, 1));
    let mut cvode = Integration::new(erased(decay), 0.0, &[1.0], options).unwrap();
    let mut least = f64::INFINITY;
    while cvode.time() < 2.0 {
        cvode.step_towards(2.0).unwrap();
        least = least.min(cvode.state()[0]);
    }
    least
}

/// With loose tolerances the decay overshoots.
#[test]
fn signs_are_kept() {
    let loose = Options::new(Method::Bdf).relative_tolerance(1e-3).absolute_tolerance(1e-2);
    for options in
        [loose.clone().linear_solver(LinearSolver::Dense), loose.clone().linear_solver(LinearSolver::Sparse)]
    {
        let kept = least(&options.clone().inequalities(vec![Inequality::NotNegative]));
        let free = least(&options);
        assert!(free < 0.0, "{free}");
        assert!(kept >= 0.0, "{kept}");
    }
}

/// ẏ = −1 from 1 violates y ≥ 0 at t = 1, for any step. An exact prediction must lead to shorter
/// steps too.
#[test]
fn an_inequality_that_cannot_be_kept_ends_the_integration() {
    for nonlinear_solver in [NonlinearSolver::Newton, NonlinearSolver::FixedPoint] {
        let options = Options::new(Method::Bdf)
            .nonlinear_solver(nonlinear_solver)
            .min_step(1e-6)
            .inequalities(vec![Inequality::NotNegative]);
        let fall = from_fn(1, |_t, _y, ydot| {
            ydot[0] = -1.0;
            Ok(())
        });
        let mut cvode = Integration::new(erased(fall), 0.0, &[1.0], &options).unwrap();
        let error = cvode.state_at(2.0).unwrap_err();
        let (t, y) = error.reached().unwrap();
        assert!(t > 0.99 && t <= 1.0 && y[0] >= 0.0, "{t} {y:?}: {error}");
        assert_eq!(error.code(), Some(Code::Nonlinear), "{error}"); // the name used by CVODES
    }
}

/// Difference quotients respect the inequality: f is not defined for y ≤ 0.
#[test]
fn quotients_keep_to_their_side() {
    let options = Options::new(Method::Bdf)
        .linear_solver(LinearSolver::Sparse)
        .inequalities(vec![Inequality::NotPositive]);
    let crossed = std::cell::Cell::new(false);
    let field = from_fn(1, |_t, y, ydot| {
        crossed.set(crossed.get() || y[0] > 0.0);
        ydot[0] = -y[0];
        Ok(())
    })
    .with_sparsity(Pattern::full(1, 1));
    let mut cvode = Integration::new(erased(field), 0.0, &[0.0], &options).unwrap();
    cvode.state_at(1.0).unwrap();
    assert!(cvode.statistics().jacobian_evaluations > 0);
    assert!(!crossed.get());
}

#[test]
fn starts_that_do_not_satisfy_them_are_refused() {
    let refusal = |inequalities: Vec<Inequality>, y0: &[f64]| {
        let field = from_fn(2, |_t, _y, ydot| {
            ydot.fill(0.0);
            Ok(())
        });
        let options = Options::default().inequalities(inequalities);
        match Integration::new(erased(field.with_names(["x"])), 0.0, y0, &options) {
            Ok(_) => "taken".to_owned(),
            Err(error) => error.to_string(),
        }
    };
    use Inequality::{Free, Negative, NotNegative, NotPositive, Positive};
    assert_eq!(refusal(vec![Positive, Free], &[0.0, 0.0]), "x at the start is 0, but must be positive");
    assert_eq!(refusal(vec![Free, Negative], &[0.0, 0.0]), "y[1] at the start is 0, but must be negative");
    assert_eq!(
        refusal(vec![NotNegative, Free], &[-1.0, 0.0]),
        "x at the start is -1, but must be zero or positive"
    );
    assert_eq!(
        refusal(vec![NotPositive, Free], &[1.0, 0.0]),
        "x at the start is 1, but must be zero or negative"
    );
    assert_eq!(refusal(vec![NotNegative, NotPositive], &[0.0, 0.0]), "taken");
    assert_eq!(refusal(vec![Positive, Negative], &[1.0, -1.0]), "taken");
    assert_eq!(refusal(vec![Free, Free], &[1.0, 0.0]), "taken");
    assert_eq!(
        refusal(vec![Free], &[1.0, 0.0]),
        "the inequalities: expected one number for each component (2), found 1"
    );

    let projected = from_fn(1, |_t, _y, ydot| {
        ydot[0] = 0.0;
        Ok(())
    })
    .with_projection(|_t, _y| Ok(()));
    let options = Options::default().inequalities(vec![Free]);
    let error = Integration::new(erased(projected), 0.0, &[0.0], &options).unwrap_err();
    assert!(matches!(error, SolveError::Input(_)));
    assert_eq!(
        error.to_string(),
        "inequalities cannot be imposed on a vector field that projects its states: the projection could violate them"
    );
}

/// A restart, and the reset of an event, must satisfy them too.
#[test]
fn a_new_start_is_checked() {
    let falling = || {
        from_fn(1, |_t, _y, ydot: &mut [f64]| {
            ydot[0] = -1.0;
            Ok(())
        })
    };
    let options = Options::default().inequalities(vec![Inequality::NotNegative]);
    let mut cvode = Integration::new(erased(falling()), 0.0, &[1.0], &options).unwrap();
    cvode.state_at(0.1).unwrap();
    let refused = cvode.restart(0.1, &[-1.0]).unwrap_err();
    assert!(
        matches!(refused, SolveError::Input(pc_solve::InputError::Inequality { value: -1.0, .. })),
        "{refused}"
    );
    assert_eq!(cvode.time(), 0.1);

    let events = pc_solve::FnEvents::new().with_reset(
        pc_solve::Event::new("half").terminal(true),
        |_t, y| Ok(y[0] - 0.5),
        |_t, y| {
            y[0] = -1.0;
            Ok(())
        },
    );
    let failure =
        pc_solve::Solve::new(falling(), 0.0, &[1.0]).method(&options).events(events).run(&[0.9]).unwrap_err();
    assert!(
        failure.error.to_string().starts_with("the event half cannot reset the state"),
        "{}",
        failure.error
    );
}
