//! States of a motion at which constraints lose rank, such as the change point of a four-bar linkage with equal
//! cranks.
//!
//! Two motions cross there, and the velocity determines which of them the mechanism follows: the one that continues
//! smoothly. Rates cannot be computed at such a state and lose digits near it, though the motion itself is as smooth
//! as elsewhere. So `watch` follows, from step to step, how far the constraints are from losing rank; ahead of such
//! a state `bridge` computes the smooth motion to the other side as a `collocation` polynomial, whose nodes avoid
//! the state. Until the other side is reached, rates are taken from the polynomial. If the smooth motion does not
//! satisfy the constraints there, no motion passes through that state, and steps continue; if a step has passed over
//! the state, or comes within rounding error of it, the motion is undetermined, which is an error.

pub(crate) mod bridge;
pub(crate) mod collocation;
pub(crate) mod watch;
