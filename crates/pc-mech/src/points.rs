//! Bodies that carry one another, given by their positions.
//!
//! The mass matrix of a chain whose links are given by angles from the vertical is full, and yet the chain is a tree:
//! the velocity of each body is that of the body that carries it, plus a vector for each quasi-velocity of its own.
//! `links` finds this structure in the velocities, whatever the positions were written in; `elimination` solves M η̇ =
//! r from the tips to the root, in O(N) operations instead of O(N³); `equations` does so for the system, whose
//! right-hand side is also computed body by body.

pub(crate) mod elimination;
pub(crate) mod equations;
pub(crate) mod links;
