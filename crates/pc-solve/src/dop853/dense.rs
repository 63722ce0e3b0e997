//! States inside a step, from a polynomial of degree 7.
//!
//! ```text
//! u(s) = r₁ + s (r₂ + (1−s) (r₃ + s (r₄ + (1−s) (r₅ + s (r₆ + (1−s) (r₇ + s r₈))))))
//! ```
//! The first four terms are the cubic Hermite interpolant; the others combine the stages with three
//! further ones, which are evaluated when a state inside the step is first needed [Hairer, Nørsett,
//! Wanner 1993, II.6].

use pc_expr::{Failure, VectorField};

use super::arithmetic::add;
use super::coefficients::{A14, A15, A16, D, DENSE_C};
use super::stages::{Early, Node, Stages, evaluate};

/// The degree of the polynomial.
pub(super) const DEGREE: u32 = 7;

/// The products of powers of s and 1−s that multiply the terms, expanded in ascending powers of s.
const BASIS: [[f64; 8]; 8] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, -2.0, 1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 1.0, -2.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 1.0, -3.0, 3.0, -1.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 1.0, -3.0, 3.0, -1.0],
];

/// The polynomial of a step.
#[derive(Debug, Clone)]
pub(super) struct Polynomial {
    start: f64,
    length: f64,
    terms: [Vec<f64>; 8],
}

impl Polynomial {
    pub(super) fn new(row: usize) -> Polynomial {
        Polynomial { start: f64::NAN, length: f64::NAN, terms: std::array::from_fn(|_| vec![0.0; row]) }
    }

    /// Sets the polynomial to that of the step between two nodes with these stages.
    ///
    /// # Errors
    /// A failure of the field, with the time at which it occurred; the polynomial is then invalid.
    pub(super) fn make<F: VectorField>(
        &mut self,
        (field, count): (&mut F, &mut u64),
        (from, to): (&Node, &Node),
        stages: &Stages,
        early: &mut Early,
        argument: &mut [f64],
    ) -> Result<(), (f64, Failure)> {
        let (t, h) = (from.t, to.t - from.t);
        (self.start, self.length) = (t, h);
        let (y, k1, k13) = (&from.y[..], &from.rates[..], &to.rates[..]);
        let [k6, k7, k8, k9, k10, k11, k12] = stages.each_ref().map(Vec::as_slice);
        let [k14, k15, k16, none] = early.each_mut().map(Vec::as_mut_slice);
        add(argument, y, h, &A14, [k1, k7, k8, k9, k10, k11, k12, k13]);
        evaluate((field, count), t + DENSE_C[0] * h, argument, k14)?;
        add(argument, y, h, &A15, [k1, k6, k7, k8, k11, k12, k13, k14]);
        evaluate((field, count), t + DENSE_C[1] * h, argument, k15)?;
        add(argument, y, h, &A16, [k1, k6, k7, k8, k9, k13, k14, k15]);
        evaluate((field, count), t + DENSE_C[2] * h, argument, k16)?;
        none.fill(0.0);
        let k = [k1, k6, k7, k8, k9, k10, k11, k12, k13, k14, k15, k16];
        let [r1, r2, r3, r4, later @ ..] = &mut self.terms;
        for i in 0..y.len() {
            let difference = to.y[i] - y[i];
            let bend = h * k1[i] - difference;
            (r1[i], r2[i], r3[i], r4[i]) = (y[i], difference, bend, difference - h * k13[i] - bend);
        }
        for (term, weights) in later.iter_mut().zip(&D) {
            add(term, none, h, weights, k);
        }
        Ok(())
    }

    /// Writes the coefficients of the powers of the time since the start of the step; each
    /// coefficient has `dim` components.
    pub(super) fn coefficients(&self, dim: usize, coefficients: &mut Vec<f64>) {
        coefficients.clear();
        let mut scale = 1.0;
        for power in 0..8 {
            let of_component = |i: usize| (0..8).map(|j| BASIS[j][power] * self.terms[j][i]).sum::<f64>();
            coefficients.extend((0..dim).map(|i| of_component(i) * scale));
            scale /= self.length;
        }
    }

    /// Writes the derivative of this order at t.
    pub(super) fn evaluate(&self, t: f64, order: u32, value: &mut [f64]) {
        let s = (t - self.start) / self.length;
        let factors = if order == 0 { basis(s) } else { derivatives(s, order, self.length) };
        let terms = self.terms.each_ref().map(|term| &term[..value.len()]);
        for (i, value) in value.iter_mut().enumerate() {
            // The smallest terms, the last ones, are added first.
            *value = (0..8).rev().map(|j| factors[j] * terms[j][i]).sum();
        }
    }
}

/// The basis at s.
fn basis(s: f64) -> [f64; 8] {
    let mut factors = [1.0; 8];
    for j in 1..8 {
        factors[j] = factors[j - 1] * if j % 2 == 1 { s } else { 1.0 - s };
    }
    factors
}

/// The derivatives, of positive order and with respect to t, of the basis at s, for a step of this
/// length.
fn derivatives(s: f64, order: u32, length: f64) -> [f64; 8] {
    let falling = |power: u32| (0..order).map(|j| f64::from(power) - f64::from(j)).product::<f64>();
    let scale = length.powi(-i32::try_from(order).unwrap_or(i32::MAX));
    BASIS.map(|powers| {
        let terms = (order..8).rev().map(|power| falling(power) * powers[power as usize]);
        scale * terms.fold(0.0, |value, term| value * s + term)
    })
}
