//! Frames of operators ẋ = b η + b_0 (3) and their structure coefficients (5).
//!
//! This module derives the c_rs^m and their consequences from b and b_0, or from definitions of the
//! quasi-velocities (2). Read `frame` first, then `structure` (the coefficients), and then how they are
//! found: in `closure`, by (6), if the operators are independent at each point (`followers` names
//! coordinates that are left out), and in `constant_brackets` if they are independent only over the
//! constants. `integrability` (Frobenius) and `holonomy` (7) interpret the coefficients; `change` relates
//! two frames of one system to each other, and `elimination` gives the operators that remain when
//! quasi-velocities are solved for.

pub(crate) mod change;
pub(crate) mod closure;
pub(crate) mod constant_brackets;
pub(crate) mod elimination;
pub(crate) mod followers;
pub(crate) mod frame;
pub(crate) mod holonomy;
pub(crate) mod integrability;
pub(crate) mod structure;
