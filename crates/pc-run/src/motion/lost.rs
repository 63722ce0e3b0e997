//! An integral that a motion has lost.

/// An integral that is proved to be kept, and has changed.
#[derive(Clone, Debug, PartialEq)]
pub struct LostIntegral {
    /// Its name.
    pub name: String,
    /// Its value at the start.
    pub start: f64,
    /// The largest change from it.
    pub drift: f64,
    /// The scale of its terms: for the energy, the largest kinetic energy or the range of the rest, whichever
    /// is larger.
    pub scale: f64,
}
