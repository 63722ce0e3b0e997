//! Frames of operators and their algebra: [X_r, X_s] = c_rs^m X_m (5).
//!
//! Notation: coordinates x_1..x_n, quasi-velocities η_1..η_k, ẋ = b η + b_0 (3), X_s = b_is ∂/∂x_i and
//! X_0 = ∂/∂t + b_i0 ∂/∂x_i (4); index 0 is time. Numbers in brackets are those of V. V. Rumyantsev,
//! *On Poincaré–Chetaev's equations* (1994), with its misprints corrected.
//!
//! ```
//! use pc_algebra::{Frame, LieAlgebra, Neighbourhood};
//! use pc_expr::Graph;
//!
//! // Euler angles of a rigid body, quasi-velocities: body angular velocity. Their algebra is so(3).
//! let graph = Graph::new();
//! let [t, psi, theta, phi, w1, w2, w3] = graph.symbols(["t", "psi", "theta", "phi", "w1", "w2", "w3"]);
//! let across = w1 * phi.sin() + w2 * phi.cos();
//! let velocities = [across / theta.sin(), w1 * phi.cos() - w2 * phi.sin(), w3 - theta.cot() * across];
//! let frame = Frame::from_velocities(&graph, t, vec![psi, theta, phi], &[w1, w2, w3], &velocities)?;
//! let c = frame.structure_coefficients(&Neighbourhood::default())?;
//! assert_eq!(c.lie_algebra(), Some(LieAlgebra::so3()));
//! # Ok::<(), pc_algebra::AlgebraError>(())
//! ```

mod catalogue;
mod closure;
mod error;
mod frame;
mod inverse;
mod lie_algebra;
mod matrix;
mod sample;
mod structure;

pub use catalogue::{CATALOGUE, Entry};
pub use error::AlgebraError;
pub use frame::Frame;
pub use inverse::inverse;
pub use lie_algebra::LieAlgebra;
pub use matrix::Matrix;
pub use sample::Neighbourhood;
pub use structure::StructureCoefficients;
