//! DOP853: the explicit Runge–Kutta method of order 8 of Dormand and Prince, with step control and
//! dense output.
//!
//! ```text
//! kᵢ = f(t + cᵢ h, y + h Σ_{j<i} aᵢⱼ kⱼ), i = 1 … 12;  y₁ = y + h Σ bᵢ kᵢ;  k₁₃ = f(t + h, y₁), which is k₁ of the next step
//! ```
//! [Prince, Dormand 1981] and [Hairer, Nørsett, Wanner 1993], II.5, with their error estimates of
//! orders 5 and 3, their step control (II.4) and their dense output of order 7 (II.6); stiffness is
//! detected as in [Hairer, Wanner 1996], IV.2.
//!
//! Read `stepper` first: `setup` starts an integration, `step` makes a step from `stages`, of a
//! length given by `control`; `dense` gives the states inside the step, `hindsight` checks these
//! states for features of f that the stages missed, `stiffness` detects when stability limits the
//! steps. `coefficients` holds the tables, and `arithmetic` computes the sums over stages.
//! `lockstep` integrates many members of an ensemble at once.

mod arithmetic;
mod coefficients;
mod control;
mod dense;
mod hindsight;
#[cfg(feature = "cvode")]
pub(crate) mod lockstep;
pub(crate) mod setup;
mod stages;
mod step;
mod stepper;
mod stiffness;
