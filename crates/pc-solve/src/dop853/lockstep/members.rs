//! Whom lanes work for.

use pc_expr::LaneField;

use crate::integration::trajectory::Trajectory;

/// What a block works on, and for whom.
pub(crate) trait Members {
    /// What a member is known by.
    type Name;

    /// The next member, with its field, whose kernels are those of the block, and its start; none if the source has none.
    fn next(&mut self, from: Source) -> Option<(Self::Name, LaneField, Vec<f64>)>;

    /// Takes the complete motion of one; none where it is to be integrated alone.
    fn end(&mut self, name: Self::Name, motion: Option<Trajectory>);

    /// Whether to end now.
    fn is_stopped(&self) -> bool;
}

/// Where members come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// From those that have been handed to this thread.
    AtHand,
    /// From those too that can be handed to it now.
    Available,
    /// From whichever come, for which to wait.
    Awaited,
}
