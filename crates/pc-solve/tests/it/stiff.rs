//! Stiff systems, and the Jacobian.

use std::cell::Cell;

use crate::boxed::{erased, from_fn};
use pc_solve::{Failure, Method, NonlinearSolver, Options, VectorField, solve};

fn robertson_rhs(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
    ydot[2] = 3e7 * y[1] * y[1];
    ydot[1] = -ydot[0] - ydot[2];
    Ok(())
}

fn robertson_jacobian(_t: f64, y: &[f64], j: &mut [f64]) -> Result<(), Failure> {
    j.copy_from_slice(&[
        -0.04,
        0.04,
        0.0, // by y1
        1e4 * y[2],
        -1e4 * y[2] - 6e7 * y[1],
        6e7 * y[1], // by y2
        1e4 * y[1],
        -1e4 * y[1],
        0.0, // by y3
    ]);
    Ok(())
}

/// Reference values at t = 1e11 from [Mazzia, Magherini 2008], Test Set for Initial Value Problem
/// Solvers 2.4, problem ROBER, first in [Robertson 1966].
#[test]
fn robertson() {
    let reference = [0.2083340149701255e-7, 0.8333360770334713e-13, 0.999999979166505];
    // A component of size 1e-13 needs an absolute tolerance below it.
    let options =
        Options::new(Method::Bdf).relative_tolerance(1e-8).absolute_tolerance(vec![1e-14, 1e-20, 1e-12]);
    let calls = Cell::new(0);
    let analytic = from_fn(3, robertson_rhs).with_jacobian(|t, y, j| {
        calls.set(calls.get() + 1);
        robertson_jacobian(t, y, j)
    });
    let with_jacobian = solve(erased(analytic), 0.0, &[1.0, 0.0, 0.0], &[1e11], &options).unwrap();
    assert!(calls.get() > 0);
    assert_eq!(with_jacobian.statistics().jacobian_evaluations, calls.get());

    let quotients =
        solve(erased(from_fn(3, robertson_rhs)), 0.0, &[1.0, 0.0, 0.0], &[1e11], &options).unwrap();
    for motion in [&with_jacobian, &quotients] {
        for i in 0..3 {
            let error = (motion.state(0)[i] / reference[i] - 1.0).abs();
            // Some thousand steps with relative local errors of 1e-8.
            assert!(error < 1e-5, "component {i}: relative error {error}");
        }
        assert!(motion.statistics().steps < 5000, "{:?}", motion.statistics());
    }
    // Difference quotients take three more evaluations of f for each Jacobian.
    assert!(quotients.statistics().rhs_evaluations >= 3 * quotients.statistics().jacobian_evaluations);
}

/// The first phase, as printed by the SUNDIALS example cvRoberts_dns with relative tolerance 1e-4,
/// which is about its accuracy.
#[test]
fn robertson_as_in_the_sundials_examples() {
    let options = Options::new(Method::Bdf).absolute_tolerance(1e-15);
    let field = from_fn(3, robertson_rhs).with_jacobian(robertson_jacobian);
    let motion = solve(erased(field), 0.0, &[1.0, 0.0, 0.0], &[4.0, 40.0], &options).unwrap();
    let printed = [[9.055097e-01, 2.240338e-05, 9.446793e-02], [7.158017e-01, 9.185037e-06, 2.841892e-01]];
    for (i, y) in printed.iter().enumerate() {
        for (found, expected) in motion.state(i).iter().zip(y) {
            assert!((found / expected - 1.0).abs() < 2e-4, "{found} is not {expected}");
        }
    }
}

/// The fixed-point iteration, which uses no Jacobian, limits a stiff system to steps of about 1/λ.
#[test]
fn newton_takes_the_long_steps() {
    let work = |solver| {
        let relaxation = from_fn(1, |t: f64, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -1e4 * (y[0] - t.cos());
            Ok(())
        });
        let options = Options::new(Method::Bdf).nonlinear_solver(solver).relative_tolerance(1e-6);
        let motion = solve(erased(relaxation), 0.0, &[1.0], &[10.0], &options).unwrap();
        assert!((motion.state(0)[0] - 10.0_f64.cos()).abs() < 1e-3);
        motion.statistics().steps
    };
    assert!(work(NonlinearSolver::FixedPoint) > 20 * work(NonlinearSolver::Newton));
}

/// Only Newton's iteration evaluates the Jacobian, with the documented arguments and layout.
#[test]
fn jacobian_is_column_major() {
    struct Linear {
        jacobians: usize,
    }
    impl VectorField for Linear {
        fn dim(&self) -> usize {
            2
        }
        fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[0] = -1e5 * y[0] + 1e5 * y[1];
            ydot[1] = -y[1];
            Ok(())
        }
        fn has_jacobian(&self) -> bool {
            true
        }
        fn jacobian(&mut self, _t: f64, _y: &[f64], j: &mut [f64]) -> Result<(), Failure> {
            self.jacobians += 1;
            j.copy_from_slice(&[-1e5, 0.0, 1e5, -1.0]);
            Ok(())
        }
    }
    let mut steps = Vec::new();
    for solver in [NonlinearSolver::Newton, NonlinearSolver::FixedPoint] {
        let options = Options::new(Method::Bdf).nonlinear_solver(solver);
        let mut cvode =
            pc_solve::Integration::new(Linear { jacobians: 0 }, 0.0, &[2.0, 1.0], &options).unwrap();
        let y = cvode.state_at(0.1).unwrap().to_vec();
        // y1 = a e^(-t) + (2 − a) e^(-1e5 t) with a = 1e5/(1e5 − 1).
        let error = y[0] - 1e5 / (1e5 - 1.0) * (-0.1_f64).exp();
        assert!(error.abs() < 1e-6, "{solver:?}: {error}"); // 1000 rtol: the local errors add up
        steps.push(cvode.statistics().steps);
        let jacobians = cvode.into_field().jacobians;
        assert_eq!(jacobians > 0, solver == NonlinearSolver::Newton);
    }
    assert!(steps[0] < steps[1]);
}
