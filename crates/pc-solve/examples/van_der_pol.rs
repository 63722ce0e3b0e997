//! The relaxation oscillation of van der Pol, ẍ = μ (1 − x²) ẋ − x with μ = 1000, which is stiff
//! between its jumps.
//!
//! Writes t, x, ẋ as CSV to standard output, and progress and the work done to standard error.

use std::error::Error;
use std::ops::ControlFlow;
use std::process::ExitCode;

use pc_solve::{Method, Options, Solve, Trajectory, VectorField, from_fn};

const MU: f64 = 1000.0;

fn van_der_pol() -> impl VectorField {
    from_fn(2, |_t, y, ydot| {
        ydot[0] = y[1];
        ydot[1] = MU * (1.0 - y[0] * y[0]) * y[1] - y[0];
        Ok(())
    })
    .with_jacobian(|_t, y, jacobian| {
        jacobian[0] = 0.0;
        jacobian[1] = -2.0 * MU * y[0] * y[1] - 1.0;
        jacobian[2] = 1.0;
        jacobian[3] = MU * (1.0 - y[0] * y[0]);
        Ok(())
    })
    .with_names(["x", "x'"])
}

fn print(motion: &Trajectory) {
    println!("t,x,x'");
    for (t, y) in motion.iter() {
        println!("{t},{},{}", y[0], y[1]);
    }
    let work = motion.statistics();
    eprintln!(
        "{} steps, {} evaluations, {} Jacobians, {} failed error tests",
        work.steps, work.rhs_evaluations, work.jacobian_evaluations, work.error_test_failures
    );
}

fn main() -> ExitCode {
    let end = 3000.0;
    let times: Vec<f64> = (0..=300).map(|i| end * f64::from(i) / 300.0).collect();
    let options = Options::new(Method::Bdf).relative_tolerance(1e-6).absolute_tolerance(vec![1e-8, 1e-6]);

    let mut tenths = 0.0;
    let progress = |t: f64, _y: &[f64]| {
        if 10.0 * t / end >= tenths + 1.0 {
            tenths = (10.0 * t / end).floor();
            eprintln!("{} %", 10.0 * tenths);
        }
        ControlFlow::Continue(())
    };
    match Solve::new(van_der_pol(), 0.0, &[2.0, 0.0]).method(&options).run_observed(&times, progress) {
        Ok(solution) => {
            print(&solution.trajectory);
            ExitCode::SUCCESS
        }
        Err(failure) => {
            print(&failure.reached.trajectory); // The outputs before the failure are available.
            eprintln!("{failure}");
            if let Some(cause) = failure.source() {
                eprintln!("because {cause}");
            }
            ExitCode::FAILURE
        }
    }
}
