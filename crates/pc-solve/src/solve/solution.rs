//! The result of an integration.

use crate::events::events::Occurrence;
use crate::integration::held_sides::Slide;
use crate::integration::integration::Ending;
use crate::integration::trajectory::Trajectory;

/// The part of a motion that was integrated.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The states at the output times, which are y⁺ at events; a terminal event is the last output.
    pub trajectory: Trajectory,
    /// The occurrences of events, in order.
    pub occurrences: Vec<Occurrence>,
    /// How the integration ended; none if it failed.
    pub ending: Option<Ending>,
    /// The parts of the motion that slide along surfaces on which the field jumps; not recorded for
    /// motions with checkpoints.
    pub slides: Vec<Slide>,
}

impl Solution {
    pub(crate) fn new(dim: usize) -> Solution {
        Solution {
            trajectory: Trajectory::new(dim),
            occurrences: Vec::new(),
            ending: None,
            slides: Vec::new(),
        }
    }
}
