//! Places of a motion where constraints lose rank, such as the change point of a four-bar of equal cranks.
//!
//! Two motions cross there, and the velocity says which of them continues: the one that is smooth. Rates cannot be
//! computed at the place and lose digits near it, though the motion itself is as smooth as elsewhere. So
//! `watch` follows, from step to step, how far the constraints are from losing rank; ahead of such a place `bridge`
//! computes the smooth motion to the other side by a `collocation` polynomial, whose nodes avoid the place, and its
//! rates are those of the polynomial until then. If the smooth motion does not satisfy the constraints at the place,
//! no motion passes through it, and steps continue; if one step passed over it, or comes within rounding of it, the
//! motion is undetermined, which is an error.

pub(crate) mod bridge;
pub(crate) mod collocation;
pub(crate) mod watch;
