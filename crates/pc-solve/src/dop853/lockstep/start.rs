//! The tape of a start, which computes the rates at the start and the length of the first step
//! [Hairer, Nørsett, Wanner 1993, II.4].

use pc_expr::{Binary, LaneTape, LaneValue};

use super::super::step::FIRST;
use super::field::{Health, advanced};
use super::problem::Problem;

/// The tape that reads y, the parameters of a member and its constant pivots, and writes ẏ, the
/// member's constants, the length of the first step, and a mask with all bits set where these are
/// valid.
pub(super) fn start(problem: &Problem<'_>) -> LaneTape {
    let tape = &mut LaneTape::new();
    let y = tape.inputs(problem.dim());
    let field = problem.field_of_parameters(tape);
    let mut health = Health::new(tape);
    let rates = field.rates(tape, &y, &mut health);
    for looked_at in [&y, &rates, &field.numbers] {
        health.look(tape, looked_at);
    }
    let well = health.mask(tape);
    let length = match problem.plan.first {
        Some(length) => tape.constant(length),
        None => {
            let tolerances: Vec<LaneValue> = (0..y.len())
                .map(|i| {
                    let (size, relative) = (tape.size(y[i]), tape.constant(problem.plan.relative));
                    let absolute = tape.constant(problem.absolute[i]);
                    tape.multiply_add(size, relative, absolute)
                })
                .collect();
            let farthest = (problem.plan.end() - problem.plan.start).abs();
            let farthest = tape.constant(problem.plan.longest.map_or(farthest, |most| most.min(farthest)));
            let [first, least, hundredth, direction] =
                [FIRST, 1e-5, 0.01, problem.plan.direction].map(|value| tape.constant(value));
            let (state, speed) = (norm(tape, &y, &tolerances), norm(tape, &rates, &tolerances));
            let ratio = tape.binary(Binary::Divide, state, speed);
            let ratio = tape.multiply(hundredth, ratio);
            let small = [state, speed].map(|norm| tape.binary(Binary::LessOrEqual, norm, least));
            let small = tape.binary(Binary::Or, small[0], small[1]);
            let guess = tape.select(small, first, ratio);
            let h = tape.binary(Binary::Lesser, guess, farthest);

            let signed = tape.multiply(h, direction);
            let next = advanced(tape, &y, signed, &[1.0], &[&rates]);
            let mut there = Health::new(tape);
            let rates_there = field.rates(tape, &next, &mut there);
            there.look(tape, &rates_there);
            let is_there = there.mask(tape);
            let change: Vec<LaneValue> =
                rates_there.iter().zip(&rates).map(|(&a, &b)| tape.subtract(a, b)).collect();
            let second = norm(tape, &change, &tolerances);
            let second = tape.binary(Binary::Divide, second, h);
            let largest = tape.binary(Binary::Greater, second, speed);
            let [tiny, thousandth, hundred] = [1e-15, 1e-3, 100.0].map(|value| tape.constant(value));
            let flat = tape.binary(Binary::LessOrEqual, largest, tiny);
            let mut by_rates = tape.binary(Binary::Divide, hundredth, largest);
            for _ in 0..3 {
                by_rates = tape.square_root(by_rates);
            }
            let part = tape.multiply(h, thousandth);
            let of_flat = tape.binary(Binary::Greater, first, part);
            let by_rates = tape.select(flat, of_flat, by_rates);
            let most = tape.multiply(hundred, h);
            let length = tape.binary(Binary::Lesser, most, by_rates);
            let length = tape.binary(Binary::Lesser, length, farthest);
            // Failures there are left to the step itself.
            tape.select(is_there, length, h)
        }
    };
    for value in rates.into_iter().chain(field.numbers).chain(field.fixed).chain([length, well]) {
        tape.output(value);
    }
    std::mem::take(tape)
}

/// √Σ (vᵢ/tolerance)²
fn norm(tape: &mut LaneTape, v: &[LaneValue], tolerances: &[LaneValue]) -> LaneValue {
    let mut sum = tape.constant(0.0);
    for (&v, &tolerance) in v.iter().zip(tolerances) {
        let weighed = tape.binary(Binary::Divide, v, tolerance);
        sum = tape.multiply_add(weighed, weighed, sum);
    }
    tape.square_root(sum)
}
