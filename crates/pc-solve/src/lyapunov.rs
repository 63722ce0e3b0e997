//! Lyapunov exponents: `lyapunov` integrates tangent vectors, `orthonormal` orthonormalises them.

pub(crate) mod lyapunov;
pub(crate) mod orthonormal;
