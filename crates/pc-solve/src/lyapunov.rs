//! Lyapunov exponents: `lyapunov` integrates tangent vectors, and `orthonormal` orthonormalises
//! them.

pub(crate) mod lyapunov;
pub(crate) mod orthonormal;
