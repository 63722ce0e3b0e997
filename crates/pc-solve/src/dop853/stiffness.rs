//! Whether the stability of the method limits the steps.
//!
//! The last two evaluations of a step are at the same time and at nearby states, so that
//! ```text
//! ρ = ‖f(t₁, y₁) − k₁₂‖ / ‖y₁ − g₁₂‖
//! ```
//! with g₁₂ the argument of the last stage, is an estimate of the largest eigenvalue of ∂f/∂y from below. Where h ρ
//! lies beyond the boundary of stability for many steps that pass their error tests, it is not accuracy that makes them
//! short [Hairer, Wanner 1996, IV.2].

/// The boundary of stability on the negative real axis.
const BOUNDARY: f64 = 6.1;
/// Steps are examined so often while none is suspect.
const EVERY: u64 = 20;
/// So many suspect steps show stiffness …
const SUSPECT: u32 = 15;
/// … unless so many in sequence between them are not.
const CLEAR: u32 = 6;

/// What the last steps have shown.
#[derive(Debug, Clone, Default)]
pub(super) struct Stiffness {
    suspect: u32,
    clear: u32,
    /// Since the start.
    steps: u64,
    /// When it was seen first, if it was.
    pub(super) seen: Option<f64>,
}

impl Stiffness {
    /// Whether this step is to be examined.
    pub(super) fn examines(&mut self) -> bool {
        self.steps += 1;
        self.seen.is_none() && (self.suspect > 0 || self.steps.is_multiple_of(EVERY))
    }

    /// Takes note of h ρ of a step that ends at t.
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

    /// For a new start.
    pub(super) fn restart(&mut self) {
        (self.suspect, self.clear) = (0, 0);
    }
}
