//! Nonholonomic constraints in quasi-velocities.
//!
//! With the constraints η_α = 0, α = l+1..k, the equations of motion are (30)
//!
//!   d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s,   s, r = 1..l, m = 1..k,
//!
//! the constraints put in after differentiation, so that all k momenta count.
//!
//! ```
//! use pc_mech::{Graph, System};
//! use pc_nonholo::Constrained;
//!
//! // Chaplygin's sleigh: v along the blade, ω about it, and the lateral velocity u that the blade forbids.
//! let graph = Graph::new();
//! let [m, j, a] = graph.symbols(["m", "J", "a"]);
//! let sleigh = System::builder(&graph)
//!     .coordinates(["x", "y", "φ"])
//!     .quasi_velocities(["u", "v", "ω"])
//!     .kinematics(|_, x, eta| {
//!         let (s, c) = (x[2].sin(), x[2].cos());
//!         [eta[1]*c - eta[0]*s, eta[1]*s + eta[0]*c, eta[2]]
//!     })
//!     .lagrangian(|_, _, eta| {
//!         (m*(eta[1].square() + (eta[0] + a*eta[2]).square()) + j*eta[2].square())/2.0
//!     })
//!     .build()?;
//! let constrained = Constrained::new(&sleigh, &[graph.symbol("u")])?;
//! assert_eq!(constrained.equations().right_hand_side()[0].to_string(), "m*a*ω^2");
//! assert_eq!(constrained.equations().right_hand_side()[1].to_string(), "-m*a*v*ω");
//! # Ok::<(), pc_nonholo::NonholoError>(())
//! ```

mod adapted;
mod almost_poisson;
mod constrained;
mod error;
mod measure;
mod sorted;
mod voronets;

pub use adapted::Adapted;
pub use constrained::Constrained;
pub use error::NonholoError;
pub use measure::InvariantMeasure;
pub use sorted::{Kind, Redundant, Sorted};
pub use voronets::Voronets;
