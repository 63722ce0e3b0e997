//! Systems whose coordinates or velocities are subject to conditions.
//!
//! A `constraint` is one condition; `multipliers` keeps all coordinates and adds the reactions, M η̇ = r + Cᵀ
//! λ; `independent_velocities` solves for some velocities instead (14)–(16), which `choice` selects;
//! `explicit_reactions` expresses λ as functions of the state, to which `friction` is proportional, and `body_reactions` as
//! forces and torques on bodies. `loops` closes the loops of a tree whose joints are eliminated one by one.

pub(crate) mod body_reactions;
pub(crate) mod choice;
pub(crate) mod constraint;
pub(crate) mod explicit_reactions;
pub(crate) mod friction;
pub(crate) mod independent_velocities;
pub(crate) mod loops;
pub(crate) mod multipliers;
