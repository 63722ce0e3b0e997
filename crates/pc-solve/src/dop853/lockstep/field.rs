//! The function f on a tape, and the sums over its stages.

use pc_expr::{Binary, LaneTape, LaneValue, Program};

/// The function f with its inputs other than the state: the constants of a member, computed from
/// its parameters.
pub(super) struct Field<'a> {
    pub(super) program: &'a Program,
    /// The number of pivots that are watched, and the ratio of a pivot to the largest size below
    /// which the pivot counts as zero.
    pub(super) pivots: usize,
    pub(super) vanishing: f64,
    /// The values that the program reads as its parameters.
    pub(super) numbers: Vec<LaneValue>,
    /// The smallest of the constant pivots, and the largest of the constant sizes.
    pub(super) fixed: [LaneValue; 2],
}

/// The number of rows of the frame that `fixed` occupies.
pub(super) const FIXED: usize = 2;

/// The number of components from which it pays to compute the products h aⱼ: there are 50 of them
/// in a step, and together they save one product per component in each of 11 stages.
const MANY: usize = 5;

/// The validity of the lanes: a mask, and a sum that is 0 as long as all values checked are finite.
#[derive(Clone, Copy)]
pub(super) struct Health {
    regular: LaneValue,
    finite: LaneValue,
}

impl Field<'_> {
    /// Computes f at a state; notes in `health` whether the pivots are regular.
    pub(super) fn rates(
        &self,
        tape: &mut LaneTape,
        state: &[LaneValue],
        health: &mut Health,
    ) -> Vec<LaneValue> {
        let t = tape.constant(0.0); // not read
        let mut outputs = tape.inline(self.program, t, state, &self.numbers);
        let watched = outputs.split_off(state.len());
        if self.pivots > 0 {
            let (pivots, sizes) = watched.split_at(self.pivots);
            let [mut smallest, mut largest] = self.fixed;
            for &size in sizes {
                let size = tape.size(size);
                largest = tape.binary(Binary::Greater, largest, size);
            }
            for &pivot in pivots {
                let pivot = tape.size(pivot);
                smallest = tape.binary(Binary::Lesser, smallest, pivot);
            }
            let vanishing = tape.constant(self.vanishing);
            let least = tape.multiply(vanishing, largest);
            let regular = tape.binary(Binary::Less, least, smallest);
            health.regular = tape.binary(Binary::And, health.regular, regular);
        }
        outputs
    }
}

impl Health {
    pub(super) fn new(tape: &mut LaneTape) -> Health {
        Health { regular: tape.bits(u64::MAX), finite: tape.constant(0.0) }
    }

    /// Checks, by means of their sum, that these values are finite.
    pub(super) fn look(&mut self, tape: &mut LaneTape, values: &[LaneValue]) {
        let zero = tape.constant(0.0);
        let sum = values.iter().copied().reduce(|sum, value| tape.add(sum, value));
        if let Some(sum) = sum {
            self.finite = tape.multiply_add(sum, zero, self.finite);
        }
    }

    /// The mask of the valid lanes.
    pub(super) fn mask(self, tape: &mut LaneTape) -> LaneValue {
        let zero = tape.constant(0.0);
        let finite = tape.binary(Binary::LessOrEqual, self.finite, zero);
        tape.binary(Binary::And, finite, self.regular)
    }
}

/// Σ aⱼ kⱼ, with the components innermost, so that successive operations are independent.
pub(super) fn sum(tape: &mut LaneTape, a: &[f64], k: &[&[LaneValue]]) -> Vec<LaneValue> {
    let mut sums = Vec::new();
    for (j, (&a, k)) in a.iter().zip(k).enumerate() {
        let a = tape.constant(a);
        for (i, &k) in k.iter().enumerate() {
            if j == 0 {
                sums.push(tape.multiply(k, a));
            } else {
                sums[i] = tape.multiply_add(k, a, sums[i]);
            }
        }
    }
    sums
}

/// Two such sums at once, so that each k is read once.
pub(super) fn sums(tape: &mut LaneTape, a: [&[f64]; 2], k: &[&[LaneValue]]) -> [Vec<LaneValue>; 2] {
    let mut sums: [Vec<LaneValue>; 2] = Default::default();
    for (j, k) in k.iter().enumerate() {
        let a = a.map(|a| tape.constant(a[j]));
        for (i, &k) in k.iter().enumerate() {
            for (sum, a) in sums.iter_mut().zip(a) {
                if j == 0 {
                    sum.push(tape.multiply(k, a));
                } else {
                    sum[i] = tape.multiply_add(k, a, sum[i]);
                }
            }
        }
    }
    sums
}

/// y + h Σ aⱼ kⱼ
///
/// If there are many components, the sum is computed as y + Σ (h aⱼ) kⱼ, which takes fewer
/// operations, and fewer of these have to wait for the last k.
pub(super) fn advanced(
    tape: &mut LaneTape,
    y: &[LaneValue],
    h: LaneValue,
    a: &[f64],
    k: &[&[LaneValue]],
) -> Vec<LaneValue> {
    if y.len() < MANY {
        let sums = sum(tape, a, k);
        return y.iter().zip(sums).map(|(&y, sum)| tape.multiply_add(sum, h, y)).collect();
    }
    let mut sums = y.to_vec();
    for (&a, k) in a.iter().zip(k) {
        let a = tape.constant(a);
        let part = tape.multiply(h, a);
        for (sum, &k) in sums.iter_mut().zip(*k) {
            *sum = tape.multiply_add(part, k, *sum);
        }
    }
    sums
}

/// Normalises the quaternions q at these positions in a state to q/|q|.
pub(super) fn normalise(tape: &mut LaneTape, quaternions: &[[usize; 4]], y: &mut [LaneValue]) {
    for places in quaternions {
        let mut square = tape.constant(0.0);
        for &i in places {
            square = tape.multiply_add(y[i], y[i], square);
        }
        let norm = tape.square_root(square);
        for &i in places {
            y[i] = tape.binary(Binary::Divide, y[i], norm);
        }
    }
}
