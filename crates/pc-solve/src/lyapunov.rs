//! Lyapunov exponents: `lyapunov` integrates deviations, `orthonormal` keeps them apart.

pub(crate) mod lyapunov;
pub(crate) mod orthonormal;
