//! Detection of stiffness on the tape, as in [`stiffness`](super::super::stiffness), but in every
//! step.

use pc_expr::{Binary, LaneTape, LaneValue};

use super::super::stiffness::{BOUNDARY, CLEAR, SUSPECT};

/// The counters of a lane: the suspect steps, and the successive steps since the last suspect one.
#[derive(Clone, Copy)]
pub(super) struct Counters {
    pub(super) suspect: LaneValue,
    pub(super) clear: LaneValue,
}

impl Counters {
    /// Counts an accepted step of length h; returns the new counters, and the mask of the lanes
    /// that are stiff.
    ///
    /// `states` and `rates` are those at the end of the step and at its last stage. A step is
    /// suspect if h² ‖f(t₁, y₁) − k₁₂‖² exceeds the square of the boundary of stability times ‖y₁ −
    /// g₁₂‖².
    pub(super) fn count(
        self,
        tape: &mut LaneTape,
        h: LaneValue,
        states: [&[LaneValue]; 2],
        rates: [&[LaneValue]; 2],
    ) -> (Counters, LaneValue) {
        let [zero, one, boundary, enough, long] =
            [0.0, 1.0, BOUNDARY * BOUNDARY, f64::from(SUSPECT), f64::from(CLEAR)]
                .map(|value| tape.constant(value));
        let [states, rates] = [states, rates].map(|[a, b]| square(tape, a, b));
        let (states, square_of_h) = (tape.multiply(states, boundary), tape.multiply(h, h));
        let rates = tape.multiply(rates, square_of_h);
        let is_suspect = tape.binary(Binary::Less, states, rates);
        let one_more = tape.add(self.clear, one);
        let clear = tape.select(is_suspect, zero, one_more);
        let is_clear = tape.binary(Binary::LessOrEqual, long, clear);
        let counted = tape.binary(Binary::And, is_suspect, one);
        let suspect = tape.add(self.suspect, counted);
        let suspect = tape.select(is_clear, zero, suspect);
        let is_stiff = tape.binary(Binary::LessOrEqual, enough, suspect);
        (Counters { suspect, clear }, is_stiff)
    }
}

/// ‖a − b‖²
fn square(tape: &mut LaneTape, a: &[LaneValue], b: &[LaneValue]) -> LaneValue {
    let mut sum = tape.constant(0.0);
    for (&a, &b) in a.iter().zip(b) {
        let difference = tape.subtract(a, b);
        sum = tape.multiply_add(difference, difference, sum);
    }
    sum
}
