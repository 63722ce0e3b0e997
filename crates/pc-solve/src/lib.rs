//! Integration of ẏ = f(t, y) with SUNDIALS CVODES or DOP853, for any [`VectorField`].
//!
//! A vector field is compiled equations of motion or a closure:
//! ```
//! use pc_solve::{Options, from_fn, solve};
//!
//! // The pendulum φ̈ = −sin φ.
//! let pendulum = from_fn(2, |_t, y, ydot| {
//!     ydot[0] = y[1];
//!     ydot[1] = -y[0].sin();
//!     Ok(())
//! });
//! let motion = solve(pendulum, 0.0, &[1.0, 0.0], &[0.0, 5.0, 10.0], &Options::default())?;
//! let energy = |y: &[f64]| 0.5 * y[1] * y[1] - y[0].cos();
//! for (t, y) in motion.iter() {
//!     println!("{t} {} {}", y[0], y[1]);
//!     assert!((energy(y) - energy(&[1.0, 0.0])).abs() < 1e-7);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! [`Options`] chooses method and tolerances; [`Solve`] adds events and other methods, and [`Integration`] is the
//! integration itself, step by step.
//!
//! The methods are those of the variable-order, variable-step linear multistep code CVODE [Cohen, Hindmarsh 1996],
//! in SUNDIALS 7 [Hindmarsh et al. 2005; Gardner et al. 2022], the explicit Runge–Kutta method [`Dop853`], and the change
//! between both where [stiffness is seen](Method::Auto).
//!
//! Without the default feature `cvode` the crate builds without SUNDIALS and a C compiler. It then has [`Integration`]
//! by any [`Stepper`], such as [`Dop853`] and [`RungeKutta4`], with events, dense output and checkpoints.

#![cfg_attr(feature = "cvode", expect(unsafe_code, reason = "calls of the C library SUNDIALS"))]

#[cfg(feature = "cvode")]
mod auto;
mod checkpoint;
mod chosen;
#[cfg(feature = "cvode")]
mod cvode;
mod dop853;
#[cfg(feature = "cvode")]
mod ensemble;
mod error;
mod events;
mod foresight;
mod integration;
#[cfg(feature = "cvode")]
mod lyapunov;
mod runge_kutta;
#[cfg(feature = "cvode")]
mod sensitivity;
mod settings;
mod solve;
mod taylor;

#[cfg(feature = "cvode")]
pub use auto::switch::Auto;
pub use checkpoint::checkpoint::Checkpoint;
pub use checkpoint::encoding::CheckpointError;
pub use checkpoint::legs::solve_checkpointed;
pub use chosen::Chosen;
#[cfg(feature = "cvode")]
pub use cvode::cvode::Cvode;
#[cfg(feature = "cvode")]
pub use cvode::forward::sensitivities::{Correction, Sensitivities, SensitivityStatistics};
#[cfg(feature = "cvode")]
pub use cvode::integrals::Integrals;
#[cfg(feature = "cvode")]
pub use cvode::linear::krylov::{Krylov, Side};
#[cfg(feature = "cvode")]
pub use cvode::linear::preconditioner::Preconditioner;
#[cfg(feature = "cvode")]
pub use cvode::linear::solver::LinearSolver;
#[cfg(feature = "cvode")]
pub use cvode::version::sundials_version;
pub use dop853::setup::Dop853;
#[cfg(feature = "cvode")]
pub use ensemble::ensemble::{Ensemble, EnsembleError, MemberError, Panicked};
#[cfg(feature = "cvode")]
pub use ensemble::random::member_stream;
#[cfg(feature = "cvode")]
pub use ensemble::stop::Stop;
pub use error::{Code, InputError, IntegrationError, NonFinite, Reason, SolveError};
pub use events::events::{Accumulation, FnEvents, NoEvents, Occurrence};
pub use integration::dense_output::{DenseOutput, Segment};
pub use integration::fn_field::{FnField, from_fn};
pub use integration::integration::{Ending, Integration};
pub use integration::limits::Limits;
pub use integration::method::IntegrationMethod;
pub use integration::observer::{Observed, Observer};
pub use integration::statistics::Statistics;
pub use integration::stepper::{LastStep, Stepper};
pub use integration::trajectory::Trajectory;
#[cfg(feature = "cvode")]
pub use lyapunov::lyapunov::{Lyapunov, LyapunovOptions, lyapunov_exponents};
pub use pc_expr::{
    Deadline, Direction, Event, Events, Failure, Pattern, Spent, TimeDependence, TimeProfile, VectorField,
};
pub use runge_kutta::{FixedStep, RungeKutta4};
#[cfg(feature = "cvode")]
pub use sensitivity::adjoint::{adjoint_gradient, adjoint_gradients, adjoint_gradients_with_events};
#[cfg(feature = "cvode")]
pub use sensitivity::adjoint_options::AdjointOptions;
#[cfg(feature = "cvode")]
pub use sensitivity::functional::{Functional, Gradient};
#[cfg(feature = "cvode")]
pub use sensitivity::trajectory::{
    SensitivitySolution, SensitivityTrajectory, solve_dense_with_sensitivities, solve_with_sensitivities,
    solve_with_sensitivities_and_events,
};
pub use settings::inequality::Inequality;
pub use settings::method::{Method, NonlinearSolver};
pub use settings::options::Options;
pub use settings::tolerance::Tolerance;
pub use solve::failure::SolveFailure;
#[cfg(feature = "cvode")]
pub use solve::integrals::solve_with_integrals;
pub use solve::solution::Solution;
pub use solve::solve::{Solve, solve};
pub use taylor::stepper::Taylor;
