//! Integration of ẏ = f(t, y), for any [`VectorField`], with SUNDIALS CVODES, DOP853 or Taylor's
//! method.
//!
//! The sections follow the order in which a program needs them: a motion in one call, its method,
//! events, the motion as a function of time, its accuracy, a motion step by step, checkpoints,
//! derivatives, many motions.
//!
//! # A motion in one call
//!
//! A vector field is either compiled equations of motion, a `Motion` of
//! [pc-mech](../pc_mech/index.html), or a closure:
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
//! [`from_fn`] takes further closures: [a Jacobian](FnField::with_jacobian), [its
//! pattern](FnField::with_sparsity), [products with it](FnField::with_jvp), [a
//! projection](FnField::with_projection) to invariants. Failures are values: a [`SolveFailure`]
//! holds the outputs reached before the failure, and the [`SolveError`] that ended the motion.
//!
//! # Method and tolerances
//!
//! [`Options`] chooses a [`Method`]: the variable-order multistep formulas of CVODE [Cohen,
//! Hindmarsh 1996], in SUNDIALS 7 [Hindmarsh et al. 2005; Gardner et al. 2022], which are
//! [`Adams`](Method::Adams) and, for stiff systems, [`Bdf`](Method::Bdf); the explicit Runge–Kutta
//! method [`Dop853`](Method::Dop853); [`Auto`](Method::Auto), which switches from DOP853 to BDF
//! where it detects stiffness; and [`Taylor`](Method::Taylor), which needs a field that is a
//! program. The error of a step is bounded by [`relative_tolerance`](Options::relative_tolerance) ·
//! |y| + [`absolute_tolerance`](Options::absolute_tolerance).
//!
//! # Events
//!
//! [`Solve`] describes a motion to be integrated, with a method and [`Events`]: zeros of functions,
//! which end the motion or [reset](FnEvents::with_reset) its state. Each zero is located to
//! rounding error, even if several lie in one step or one reset causes another. Impacts that follow
//! one another ever faster end the motion where they [accumulate](Accumulation).
//! ```
//! use pc_solve::{Event, FnEvents, Solve, from_fn};
//!
//! // A stone thrown upwards, until it returns.
//! let fall = from_fn(2, |_t, y, ydot| { ydot[0] = y[1]; ydot[1] = -10.0; Ok(()) });
//! let ground = FnEvents::new().with(Event::new("ground").falling().terminal(true), |_t, y| Ok(y[0]));
//! let solution = Solve::new(fall, 0.0, &[0.0, 5.0]).events(ground).run(&[0.5, 2.0])?;
//! assert!((solution.occurrences[0].time - 1.0).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The motion as a function of time
//!
//! [`Solve::dense`] keeps the polynomials of all steps: [`DenseOutput`] evaluates y and ẏ at any
//! time, with the accuracy of the steps.
//!
//! # How accurate it is
//!
//! Tolerances bound the error of each step. [`ErrorEstimate`] integrates a motion a second time, as
//! its [`Companion`], and gives the global errors of its outputs.
//!
//! # Step by step
//!
//! [`Solve::start`] gives the [`Integration`] itself, which is always at some time and state: it
//! steps, advances to a time, can be [restarted](Integration::restart) from another state, and its
//! field can be [changed](Integration::change) on the way, for example by a controller. An
//! [`Observer`] sees outputs, steps and occurrences of a [run](Integration::run).
//! ```
//! use pc_solve::{Solve, from_fn};
//!
//! let decay = from_fn(1, |_t, y, ydot| { ydot[0] = -y[0]; Ok(()) });
//! let mut motion = Solve::new(decay, 0.0, &[1.0]).start()?;
//! let half = motion.state_at(2.0_f64.ln())?[0];
//! assert!((half - 0.5).abs() < 1e-6);
//! motion.restart(0.0, &[4.0])?;
//! let end = motion.step_towards(1.0)?;
//! assert!(end > 0.0 && motion.time() == end);
//! # Ok::<(), pc_solve::SolveError>(())
//! ```
//!
//! # Checkpoints
//!
//! A [`Resumable`] motion gives a [`Checkpoint`] every n steps. A motion resumed from a checkpoint
//! equals the uninterrupted motion to the last bit; a checkpoint [converts to
//! bytes](Checkpoint::to_bytes) that another process can read. A [`Deadline`] in the options ends a
//! motion that takes too long.
//!
//! # Derivatives
//!
//! [`Solve::sensitivities`] integrates S = ∂y/∂(p, y₀) along with the motion; S jumps where an
//! event resets the state. For many parameters and a single quantity g of the motion,
//! [`adjoint_gradient`] integrates backwards instead; g is a [`Functional`]. [`Solve::integrals`]
//! integrates quantities along the motion, and [`lyapunov_exponents`] measures the growth of
//! tangent vectors along it.
//!
//! # Many motions
//!
//! An [`Ensemble`] integrates on all cores; fields that are programs are integrated eight at a time
//! in the lanes of a vector. Its results come in the order of the members and are the same for any
//! number of threads; [`member_stream`] gives each member its own random numbers.
//! ```
//! use std::ops::ControlFlow;
//! use pc_solve::{Ensemble, Method, Options, from_fn};
//!
//! let make = |member: u64| {
//!     let rate = member as f64;
//!     Ok::<_, std::convert::Infallible>((from_fn(1, move |_t, y, ydot| { ydot[0] = -rate * y[0]; Ok(()) }), vec![1.0]))
//! };
//! let mut ends = Vec::new();
//! Ensemble::new().solve(0..4, make, 0.0, &[1.0], &Options::new(Method::Dop853), |_, motion| {
//!     ends.push(motion.map_or(f64::NAN, |motion| motion.state(0)[0]));
//!     ControlFlow::Continue(())
//! })?;
//! assert!((0..4).all(|member| (ends[member] - (-(member as f64)).exp()).abs() < 1e-6));
//! # Ok::<(), pc_solve::EnsembleError>(())
//! ```
//!
//! # Your own method
//!
//! A method implements [`Stepper`]: it makes a step and knows the states along it. Outputs, events,
//! dense output and checkpoints are built on these two abilities. [`RungeKutta4`] is an example.
//!
//! # Without C
//!
//! Without the default feature `cvode` the crate needs neither SUNDIALS nor a C compiler. It then
//! still provides [`Integration`] with any [`Stepper`], such as [`Dop853`], [`Taylor`] and
//! [`RungeKutta4`], with events, dense output and checkpoints.
//!
//! # Related crates
//!
//! [`pc_expr`] defines the [`VectorField`] integrated here; [pc-mech](../pc_mech/index.html)
//! derives vector fields from Lagrangians. [pc-cli](../pc_cli/index.html), the program `pc`, and
//! [pc-capi](../pc/index.html), the C library, use this crate.

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
mod estimate;
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
pub use checkpoint::resumable::Resumable;
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
pub use error::{Code, InputError, IntegrationError, NonFinite, Reason, Shrinks, SolveError};
pub use estimate::companion::Companion;
pub use estimate::estimate::{ErrorEstimate, error_of};
pub use events::events::{Accumulation, FnEvents, NoEvents, Occurrence};
pub use integration::dense_output::{DenseOutput, Segment};
pub use integration::fn_field::{FnField, from_fn};
pub use integration::held_sides::Slide;
pub use integration::integration::{Ending, Integration};
pub use integration::integration_method::IntegrationMethod;
pub use integration::limits::Limits;
pub use integration::observer::{Observed, Observer};
pub use integration::statistics::Statistics;
pub use integration::stepper::{LastStep, Stepper};
pub use integration::trajectory::Trajectory;
#[cfg(feature = "cvode")]
pub use lyapunov::lyapunov::{Lyapunov, LyapunovOptions, lyapunov_exponents};
pub use pc_expr::{
    Deadline, Direction, Event, Events, Failure, Method, Pattern, Spent, TimeDependence, TimeProfile,
    VectorField,
};
pub use runge_kutta::{FixedStep, RungeKutta4};
#[cfg(feature = "cvode")]
pub use sensitivity::adjoint::{adjoint_gradient, adjoint_gradients, adjoint_gradients_with_events};
#[cfg(feature = "cvode")]
pub use sensitivity::adjoint_options::AdjointOptions;
#[cfg(feature = "cvode")]
pub use sensitivity::functional::{Functional, Gradient};
#[cfg(feature = "cvode")]
pub use sensitivity::solve::{ResumableSensitivities, SolveSensitivities};
#[cfg(feature = "cvode")]
pub use sensitivity::trajectory::{SensitivitySolution, SensitivityTrajectory};
pub use settings::inequality::Inequality;
pub use settings::nonlinear_solver::NonlinearSolver;
pub use settings::options::Options;
pub use settings::tolerance::Tolerance;
pub use solve::failure::SolveFailure;
#[cfg(feature = "cvode")]
pub use solve::integrals::SolveIntegrals;
pub use solve::solution::Solution;
pub use solve::solve::{Solve, solve};
pub use taylor::stepper::Taylor;
