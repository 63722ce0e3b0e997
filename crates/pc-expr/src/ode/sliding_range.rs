//! The range of σ in which a motion stays on a surface.

/// The σ for which a motion stays on a surface: by default from −1 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingRange {
    /// The lowest, at most −1; −∞ if the motion does not leave the surface downwards.
    pub lowest: f64,
    /// The highest, at least 1; ∞ if the motion does not leave the surface upwards.
    pub highest: f64,
}

impl Default for SlidingRange {
    fn default() -> SlidingRange {
        SlidingRange { lowest: -1.0, highest: 1.0 }
    }
}

impl SlidingRange {
    /// No σ: a motion passes through the surface, and f does not jump there.
    pub const NONE: SlidingRange = SlidingRange { lowest: 1.0, highest: -1.0 };

    /// Whether a motion with this σ stays, up to a fraction of the ends of the range.
    pub fn holds(self, sigma: f64, beyond: f64) -> bool {
        sigma >= self.lowest * (1.0 + beyond) && sigma <= self.highest * (1.0 + beyond)
    }

    /// A function that is positive where a motion with this σ stays: 1 − u², where u = ±1 at the ends of the range, or
    /// the distance to its only end.
    ///
    /// ```
    /// use pc_expr::SlidingRange;
    ///
    /// assert_eq!(SlidingRange::default().margin(0.5), 0.75);
    /// assert_eq!(SlidingRange { lowest: -3.0, highest: 3.0 }.margin(-3.0), 0.0);
    /// assert_eq!(SlidingRange { lowest: f64::NEG_INFINITY, highest: 1.0 }.margin(-7.0), 8.0);
    /// ```
    pub fn margin(self, sigma: f64) -> f64 {
        let SlidingRange { lowest, highest } = self;
        match (lowest.is_finite(), highest.is_finite()) {
            (true, true) => {
                let u = (sigma - (highest + lowest) / 2.0) / ((highest - lowest) / 2.0);
                1.0 - u * u
            }
            (true, false) => sigma - lowest,
            (false, _) => highest - sigma,
        }
    }

    /// The sides to be tried in turn where a motion comes to the surface, with those that f alone suggests.
    pub fn options(self, plain: [f64; 3]) -> [f64; 3] {
        match (self.lowest.is_finite(), self.highest.is_finite()) {
            // What holds without end on one side has no other side.
            (true, false) => [0.0, -1.0, 0.0],
            (false, _) => [0.0, 1.0, 0.0],
            (true, true) if self == SlidingRange::NONE => {
                let side = if plain[0] == 0.0 { 1.0 } else { plain[0] };
                [side, -side, side]
            }
            (true, true) if self == SlidingRange::default() || plain[0] == 0.0 => plain,
            (true, true) => [0.0, plain[0], -plain[0]],
        }
    }
}
