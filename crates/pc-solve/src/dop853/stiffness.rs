//! Detects when stability limits the steps.
//!
//! The last two evaluations of f in a step are made at the same time and at nearby states, so that
//! ```text
//! ρ = ‖f(t₁, y₁) − k₁₂‖ / ‖y₁ − g₁₂‖
//! ```
//! with g₁₂ the argument of the last stage, estimates the largest eigenvalue of ∂f/∂y from below.
//! If h ρ lies beyond the boundary of stability in many accepted steps, stability rather than
//! accuracy limits their length [Hairer, Wanner 1996, IV.2].

/// The boundary of stability on the negative real axis.
pub(super) const BOUNDARY: f64 = 6.1;
/// One in this many steps is examined as long as no step is suspect.
const EVERY: u64 = 20;
/// The number of suspect steps that indicate stiffness, …
pub(super) const SUSPECT: u32 = 15;
/// … unless this many successive steps in between are not suspect.
pub(super) const CLEAR: u32 = 6;

/// The findings of the last steps.
#[derive(Debug, Clone, Default)]
pub(super) struct Stiffness {
    suspect: u32,
    clear: u32,
    /// The number of steps since the start.
    steps: u64,
    /// The time at which stiffness was first detected, if it was.
    pub(super) seen: Option<f64>,
}

impl Stiffness {
    /// Whether this step is to be examined.
    pub(super) fn examines(&mut self) -> bool {
        self.steps += 1;
        self.seen.is_none() && (self.suspect > 0 || self.steps.is_multiple_of(EVERY))
    }

    /// Notes the value of h ρ for a step that ends at t.
    pub(super) fn note(&mut self, product: f64, t: f64) {
        if product > BOUNDARY {
            self.clear = 0;
            self.suspect += 1;
            if self.suspect == SUSPECT {
                self.seen = Some(t);
            }
        } else {
            self.clear += 1;
            if self.clear == CLEAR {
                self.suspect = 0;
            }
        }
    }

    /// Forgets suspect steps, for a restart.
    pub(super) fn restart(&mut self) {
        (self.suspect, self.clear) = (0, 0);
    }
}
