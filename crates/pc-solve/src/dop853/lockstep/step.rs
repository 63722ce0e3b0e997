//! The tape of a step.
//!
//! The step and its errors are those of [`stages`](super::super::stages), and its length is that of
//! [`control`](super::super::control), but with roots and weights computed to only a few digits,
//! which is sufficient for a length.

use pc_expr::{Binary, Fused, LaneTape, LaneValue};

use super::super::coefficients::{A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, B, B3, E5};
use super::super::control::{GROWTH, SAFETY, SHRINKING};
use super::field::{Health, advanced, normalise, sum, sums};
use super::problem::Problem;
use super::stiffness::Counters;

/// The rows that a step reads and replaces; the rows of y, ẏ and the member's constants follow
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Row {
    /// t
    Time,
    /// The trial length of the next step.
    Length,
    /// Accepted steps that reach this time are reported.
    Due,
    /// All bits set where a lane has a member.
    Active,
    /// All bits set where the last attempt was rejected.
    Refused,
    /// The number of accepted steps since the last output.
    Steps,
    /// The number of attempted steps, accepted or not.
    Tries,
    /// The length of the first step, with its sign; 0 before that step.
    First,
    /// The number of steps that seem to be limited by stability, if stiffness is to be detected.
    Suspect,
    /// The number of successive steps since the last such step.
    Clear,
}

/// The number of rows that a step reads and replaces.
pub(super) const ROWS: usize = 10;

/// The results that a step writes to rows of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Output {
    /// All bits set where an accepted step has reached `Due`, or the integration cannot go on.
    Attention,
    /// All bits set where the integration cannot go on.
    Broken,
    /// The start of the step.
    From,
    /// The length of the step, with its sign; followed, for states inside the step, by y, ẏ and
    /// stages 6 to 12.
    Signed,
}

/// The fraction by which a step may be stretched to reach the end.
const LEFT: f64 = 0.01;

/// The tape of a step; if `inside`, it also writes the results needed for states inside the step.
pub(super) fn step(problem: &Problem<'_>, inside: bool) -> LaneTape {
    let tape = &mut LaneTape::new();
    let [t, length, due, active, refused, steps, tries, first, suspect, clear] =
        std::array::from_fn(|_| tape.input());
    let dim = problem.dim();
    let (y, k1) = (tape.inputs(dim), tape.inputs(dim));
    let field = problem.field(tape);

    // The end of the step.
    let [direction, end, stretch] =
        [problem.plan.direction, problem.plan.end(), 1.0 + LEFT].map(|value| tape.constant(value));
    let left = tape.subtract(end, t);
    let left = tape.multiply(left, direction);
    let stretched = tape.multiply(length, stretch);
    let ends = tape.binary(Binary::Less, left, stretched);
    let t1 = tape.multiply_add(length, direction, t);
    let t1 = tape.select(ends, end, t1);
    let h = tape.subtract(t1, t);

    // The stages.
    let mut health = Health::new(tape);
    let mut argument = Vec::new(); // of the last stage
    let mut stage = |a: &[f64], k: &[&[LaneValue]], looked_at: bool| {
        argument = advanced(tape, &y, h, a, k);
        if looked_at {
            health.look(tape, &argument);
        }
        field.rates(tape, &argument, &mut health)
    };
    // Non-finite values of the early stages show in the arguments of stages 3, 4 and 12, those of
    // the others at the end.
    let k2 = stage(&A2, &[&k1], false);
    let k3 = stage(&A3, &[&k1, &k2], true);
    let k4 = stage(&A4, &[&k1, &k3], true);
    let k5 = stage(&A5, &[&k1, &k3, &k4], false);
    let k6 = stage(&A6, &[&k1, &k4, &k5], false);
    let k7 = stage(&A7, &[&k1, &k4, &k5, &k6], false);
    let k8 = stage(&A8, &[&k1, &k4, &k5, &k6, &k7], false);
    let k9 = stage(&A9, &[&k1, &k4, &k5, &k6, &k7, &k8], false);
    let k10 = stage(&A10, &[&k1, &k4, &k5, &k6, &k7, &k8, &k9], false);
    let k11 = stage(&A11, &[&k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10], false);
    let k12 = stage(&A12, &[&k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10, &k11], true);
    let used: [&[LaneValue]; 8] = [&k1, &k6, &k7, &k8, &k9, &k10, &k11, &k12];
    let [slope, fifth] = sums(tape, [&B, &E5], &used);
    let mut y1: Vec<LaneValue> =
        y.iter().zip(&slope).map(|(&y, &slope)| tape.multiply_add(slope, h, y)).collect();
    normalise(tape, problem.unit_quaternions, &mut y1);
    health.look(tape, &y1);
    let k13 = field.rates(tape, &y1, &mut health);
    health.look(tape, &k13);

    let third: Vec<LaneValue> = {
        let others = sum(tape, &B3.map(|b| -b), &[&k1, &k9, &k12]);
        slope.iter().zip(others).map(|(&slope, other)| tape.add(slope, other)).collect()
    };
    let square = error(tape, problem, h, (&y, &y1), (&fifth, &third));

    // Whether the step is accepted, and the length of the next one.
    let well = health.mask(tape);
    let one = tape.constant(1.0);
    let small = tape.binary(Binary::LessOrEqual, square, one);
    let stands = tape.binary(Binary::And, small, well);
    let [safety, shrinking, growth, half] =
        [SAFETY, SHRINKING, GROWTH, 0.5].map(|value| tape.constant(value));
    let root = inverse_sixteenth_root(tape, square);
    let factor = tape.multiply(root, safety);
    let factor = tape.binary(Binary::Greater, factor, shrinking); // also for a NaN
    let most = tape.select(refused, one, growth);
    let factor = tape.binary(Binary::Lesser, factor, most);
    let halved = tape.binary(Binary::Lesser, factor, half);
    let factor = tape.select(well, factor, halved);
    let size = tape.size(h);
    let mut next = tape.multiply(size, factor);
    if let Some(longest) = problem.plan.longest {
        let longest = tape.constant(longest);
        next = tape.binary(Binary::Lesser, next, longest);
    }

    // A step too short to change t is a failure, unless it reaches the end.
    let (all, none) = (tape.bits(u64::MAX), tape.bits(0));
    let least = tape.constant(4.0 * f64::EPSILON);
    let time_size = tape.size(t);
    let least = tape.multiply(least, time_size);
    let short = tape.binary(Binary::LessOrEqual, size, least);
    let at_end = tape.select(stands, ends, none);
    let stalled = tape.select(at_end, none, short);
    let counted = tape.binary(Binary::And, stands, one);
    let (steps, tries) = ([steps, tape.add(steps, counted)], [tries, tape.add(tries, one)]);
    let zero = tape.constant(0.0);
    let first_size = tape.size(first);
    let is_first = tape.binary(Binary::LessOrEqual, first_size, zero);
    let is_first = tape.binary(Binary::And, is_first, stands);
    let first_now = tape.select(is_first, h, first);
    let most_steps = tape.constant(problem.plan.max_steps as f64);
    let too_many = tape.binary(Binary::Less, most_steps, steps[1]);
    let mut broken = tape.binary(Binary::Or, stalled, too_many);
    if problem.plan.watches_stiffness {
        let counters = Counters { suspect, clear };
        let (counted, is_stiff) = counters.count(tape, h, [&y1, &argument], [&k13, &k12]);
        let is_stiff = tape.binary(Binary::And, is_stiff, stands);
        broken = tape.binary(Binary::Or, broken, is_stiff);
        for (old, new) in [(suspect, counted.suspect), (clear, counted.clear)] {
            let value = tape.select(stands, new, old);
            tape.replace(old, value);
        }
    }
    let since_due = tape.subtract(t1, due);
    let since_due = tape.multiply(since_due, direction);
    let is_due = tape.binary(Binary::LessOrEqual, zero, since_due);
    let is_due = tape.binary(Binary::And, is_due, stands);
    let attention = tape.binary(Binary::Or, is_due, broken);
    let attention = tape.binary(Binary::And, attention, active);

    for (value, place) in
        [(attention, Output::Attention), (broken, Output::Broken), (t, Output::From), (h, Output::Signed)]
    {
        let row = tape.output(value);
        debug_assert_eq!(row, place as usize);
    }
    if inside {
        for row in [&y, &k1, &k6, &k7, &k8, &k9, &k10, &k11, &k12] {
            row.iter().for_each(|&value| {
                tape.output(value);
            });
        }
    }
    let now = tape.select(stands, t1, t);
    let refused_now = tape.binary(Binary::Xor, stands, all);
    for (input, value) in [
        (t, now),
        (length, next),
        (refused, refused_now),
        (steps[0], steps[1]),
        (tries[0], tries[1]),
        (first, first_now),
    ] {
        tape.replace(input, value);
    }
    for (old, new) in [(&y, &y1), (&k1, &k13)] {
        for (&old, &new) in old.iter().zip(new) {
            let value = tape.select(stands, new, old);
            tape.replace(old, value);
        }
    }
    std::mem::take(tape)
}

/// The square of the error, h² e₅⁴ / (n (e₅² + 0.01 e₃²)); a step is accepted if it is at most 1.
fn error(
    tape: &mut LaneTape,
    problem: &Problem<'_>,
    h: LaneValue,
    (y, y1): (&[LaneValue], &[LaneValue]),
    (fifth, third): (&[LaneValue], &[LaneValue]),
) -> LaneValue {
    let relative = tape.constant(problem.plan.relative);
    let [mut fifths, mut thirds] = [tape.constant(0.0); 2];
    for i in 0..y.len() {
        let (a, b) = (tape.size(y[i]), tape.size(y1[i]));
        let largest = tape.binary(Binary::Greater, a, b);
        let absolute = tape.constant(problem.absolute[i]);
        let tolerance = tape.multiply_add(largest, relative, absolute);
        let weight = inverse(tape, tolerance);
        let (a, b) = (tape.multiply(fifth[i], weight), tape.multiply(third[i], weight));
        fifths = tape.multiply_add(a, a, fifths);
        thirds = tape.multiply_add(b, b, thirds);
    }
    let [hundredth, least, n] = [0.01, f64::MIN_POSITIVE, y.len() as f64].map(|value| tape.constant(value));
    let both = tape.multiply_add(thirds, hundredth, fifths);
    // Avoids 0/0 without an error; a NaN remains.
    let both = tape.binary(Binary::Greater, least, both);
    let both = tape.multiply(both, n);
    let part = tape.multiply(h, fifths);
    let square = tape.multiply(part, part);
    tape.binary(Binary::Divide, square, both)
}

/// 1/x for a positive normal number, at most 0.3 % too small, from its bits and a step of Newton's
/// method.
fn inverse(tape: &mut LaneTape, x: LaneValue) -> LaneValue {
    let one = tape.constant(1.0);
    let bits = tape.bits(0x7fde_6238_22fc_16e6);
    let value = tape.binary(Binary::IntegerSubtract, bits, x);
    let rest = tape.fused(Fused::NegateMultiplyAdd, x, value, one);
    tape.multiply_add(value, rest, value)
}

/// x^(−1/16), at most 1 % too small, from its bits and a step of Newton's method; NaN if x is NaN,
/// −∞ if x is infinite.
fn inverse_sixteenth_root(tape: &mut LaneTape, x: LaneValue) -> LaneValue {
    // For so small an error, the length grows by the maximum anyway.
    let least = tape.constant(1e-60);
    let x = tape.binary(Binary::Greater, least, x);
    let [one, part] = [1.0, 1.0 / 16.0].map(|value| tape.constant(value));
    // 17/16 of the bits of 1, less a correction since the bits are only piecewise linear in the
    // logarithm.
    let bits = tape.bits((0x3ff0_0000_0000_0000_u64 / 16) * 17 - 0x0000_c000_0000_0000);
    let sixteenth = tape.shift_right(x, 4);
    let value = tape.binary(Binary::IntegerSubtract, bits, sixteenth);
    let mut power = value;
    for _ in 0..4 {
        power = tape.multiply(power, power);
    }
    let rest = tape.fused(Fused::NegateMultiplyAdd, x, power, one);
    let change = tape.multiply(value, part);
    tape.multiply_add(change, rest, value)
}
