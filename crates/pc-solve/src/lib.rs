//! Integration of ẏ = f(t, y) with SUNDIALS CVODES, for any [`VectorField`].
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
//! [`Options`] chooses method and tolerances; [`Cvode`] is the integration itself, to take it step by step.
//!
//! The methods are those of the variable-order, variable-step linear multistep code CVODE [Cohen, Hindmarsh 1996],
//! in SUNDIALS 7 [Hindmarsh et al. 2005; Gardner et al. 2022].

#![expect(unsafe_code, reason = "calls of the C library SUNDIALS")]

mod adjoint;
mod adjoint_field;
mod adjoint_pass;
mod callback;
mod checkpoint;
mod code;
mod context;
mod crossing;
mod cvode;
mod dense;
mod ensemble;
mod error;
mod events;
mod fn_field;
mod handles;
mod inequality;
mod integrals;
mod linear;
mod linearisation;
mod lyapunov;
mod motion_record;
mod offset;
mod options;
mod orthonormal;
mod sensitivity;
mod sensitivity_trajectory;
mod solve;
mod statistics;
mod trajectory;
mod transpose;
mod variation;

pub use adjoint::{
    AdjointOptions, Functional, Gradient, adjoint_gradient, adjoint_gradients, adjoint_gradients_with_events,
};
pub use checkpoint::{Checkpoint, CheckpointError, solve_checkpointed, solve_with_events_checkpointed};
pub use code::Code;
pub use cvode::{Cvode, Ending, Hybrid};
pub use dense::{DenseOutput, Segment};
pub use ensemble::{Ensemble, EnsembleError, MemberError, Panicked, Stop, member_stream};
pub use error::{InputError, IntegrationError, NonFinite, Reason, SolveError, SolveFailure};
pub use events::{Accumulation, FnEvents, Occurrence};
pub use fn_field::{FnField, from_fn};
pub use inequality::Inequality;
pub use integrals::{Integrals, solve_with_integrals};
pub use linear::{Krylov, LinearSolver, Preconditioner, Side};
pub use lyapunov::{Lyapunov, LyapunovOptions, lyapunov_exponents};
pub use options::{Method, NonlinearSolver, Options, Tolerance};
pub use pc_expr::{Direction, Event, Events, Failure, Pattern, TimeDependence, TimeProfile, VectorField};
pub use sensitivity::{Correction, Sensitivities, SensitivityStatistics};
pub use sensitivity_trajectory::{
    HybridSensitivities, HybridSensitivityFailure, SensitivityFailure, SensitivityTrajectory,
    solve_dense_with_sensitivities, solve_with_sensitivities, solve_with_sensitivities_and_events,
};
pub use solve::{
    HybridFailure, HybridMotion, solve, solve_dense, solve_observed, solve_with_events,
    solve_with_events_observed,
};
pub use statistics::Statistics;
pub use trajectory::Trajectory;
