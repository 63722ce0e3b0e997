//! The source of members, and the sink of their motions.

use pc_expr::LaneField;

use crate::integration::trajectory::Trajectory;

/// The members that a block integrates, and the receiver of their motions.
pub(crate) trait Members {
    /// Identifies a member.
    type Name;

    /// The next member, with its start and its field, to which the kernels of the block apply; none
    /// if the source has no member.
    fn next(&mut self, from: Source) -> Option<(Self::Name, LaneField, Vec<f64>)>;

    /// Receives the complete motion of a member, or none if the member has to be integrated alone.
    fn end(&mut self, name: Self::Name, motion: Option<Trajectory>);

    /// Whether the block has to stop now.
    fn is_stopped(&self) -> bool;
}

/// Where the members come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// Members that this thread already has.
    AtHand,
    /// Members that this thread already has, and those that it can get at once.
    Available,
    /// Any member, waiting for it if necessary.
    Awaited,
}
