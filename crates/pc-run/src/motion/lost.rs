//! An integral that a motion failed to conserve.

/// An integral that is proved to be conserved but has changed.
#[derive(Clone, Debug, PartialEq)]
pub struct LostIntegral {
    /// Its name.
    pub name: String,
    /// The value of the integral at the start.
    pub start: f64,
    /// The largest change from this value.
    pub drift: f64,
    /// The scale of its terms: for the energy, the largest kinetic energy or the range of the remaining
    /// energy, whichever is larger.
    pub scale: f64,
}
