//! The tapes that compute states inside a step: one computes the [polynomial](super::super::dense)
//! of the step, the other a value of the polynomial.

use pc_expr::{Fused, LaneTape, LaneValue};

use super::super::coefficients::{A14, A15, A16, D};
use super::field::{Health, advanced, normalise, sum};
use super::problem::Problem;

/// The number of terms of the polynomial.
pub(super) const TERMS: usize = 8;

/// The tape that reads the step's length with its sign, y, ẏ and stages 6 to 12, then y and ẏ at
/// the end, then a member's constants; it writes the terms, and a mask with all bits set where they
/// are valid.
pub(super) fn polynomial(problem: &Problem<'_>) -> LaneTape {
    let tape = &mut LaneTape::new();
    let h = tape.input();
    let rows: [Vec<LaneValue>; 11] = std::array::from_fn(|_| tape.inputs(problem.dim()));
    let [y, k1, k6, k7, k8, k9, k10, k11, k12, y1, k13] = &rows;
    let field = problem.field(tape);
    let mut health = Health::new(tape);
    let mut stage = |a: &[f64], k: &[&[LaneValue]]| {
        let argument = advanced(tape, y, h, a, k);
        let rates = field.rates(tape, &argument, &mut health);
        health.look(tape, &rates);
        rates
    };
    let k14 = &stage(&A14, &[k1, k7, k8, k9, k10, k11, k12, k13]);
    let k15 = &stage(&A15, &[k1, k6, k7, k8, k11, k12, k13, k14]);
    let k16 = &stage(&A16, &[k1, k6, k7, k8, k9, k13, k14, k15]);
    let k: [&[LaneValue]; 12] = [k1, k6, k7, k8, k9, k10, k11, k12, k13, k14, k15, k16];
    let mut terms: [Vec<LaneValue>; 4] = Default::default();
    for i in 0..y.len() {
        let difference = tape.subtract(y1[i], y[i]);
        let bend = tape.fused(Fused::MultiplySubtract, h, k1[i], difference);
        let fourth = tape.fused(Fused::NegateMultiplyAdd, h, k13[i], difference);
        let fourth = tape.subtract(fourth, bend);
        for (term, value) in terms.iter_mut().zip([y[i], difference, bend, fourth]) {
            term.push(value);
        }
    }
    for term in terms {
        term.into_iter().for_each(|value| {
            tape.output(value);
        });
    }
    for weights in &D {
        for value in sum(tape, weights, &k) {
            let value = tape.multiply(value, h);
            tape.output(value);
        }
    }
    let well = health.mask(tape);
    tape.output(well);
    std::mem::take(tape)
}

/// The tape that reads the terms and the fraction s of the step, and writes y there.
pub(super) fn value(problem: &Problem<'_>) -> LaneTape {
    let tape = &mut LaneTape::new();
    let dim = problem.dim();
    let terms: [Vec<LaneValue>; TERMS] = std::array::from_fn(|_| tape.inputs(dim));
    let s = tape.input();
    let one = tape.constant(1.0);
    let rest = tape.subtract(one, s);
    // r₁ + s (r₂ + (1−s) (r₃ + …
    let mut y = terms[TERMS - 1].clone();
    for (i, value) in y.iter_mut().enumerate() {
        for j in (0..TERMS - 1).rev() {
            *value = tape.multiply_add(*value, if j % 2 == 0 { s } else { rest }, terms[j][i]);
        }
    }
    normalise(tape, problem.unit_quaternions, &mut y);
    for value in y {
        tape.output(value);
    }
    std::mem::take(tape)
}
