//! Motions that the integration here does not judge.

use std::fmt;

/// Why a motion is not judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Skip {
    /// A surface is touched, or passed so slowly that rounding decides.
    Grazes,
    /// Several surfaces are reached together.
    Together,
    /// No side, or more than one, leads on.
    Undecided,
    /// A hundred passages: one error each.
    Many,
    /// Steps become too short, or the motion has no bounds.
    Lost,
    /// Small disturbances change the order of the passages, or grow so far that no digits are left.
    Unstable,
}

impl fmt::Display for Skip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Skip::Grazes => "a surface is touched, or hardly passed",
            Skip::Together => "surfaces are reached together",
            Skip::Undecided => "the rates at a surface decide on no way, or on several",
            Skip::Many => "more passages than are followed",
            Skip::Lost => "steps too short, or no bounds",
            Skip::Unstable => "disturbances change the order of passages, or grow",
        })
    }
}
