//! DOP853 as one writes it who knows how many numbers a state has, and wants nothing but the state at the end.
//!
//! [Hairer, Nørsett, Wanner 1993], II.5, with their step control; states are arrays, so that every loop unrolls. No
//! dense output, no events, no statistics.

#[path = "../../../../../crates/pc-solve/src/dop853/coefficients.rs"]
#[expect(dead_code, reason = "those of dense output")]
mod coefficients;
pub(super) mod lockstep;

use coefficients::{A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, B, B3, E5};

/// y(end) of ẏ = f(y) from y(0) = y, and the number of steps.
pub(crate) fn integrate<const N: usize>(
    mut f: impl FnMut(&[f64; N], &mut [f64; N]),
    mut y: [f64; N],
    end: f64,
    (relative, absolute): (f64, f64),
) -> ([f64; N], u64) {
    let mut k1 = [0.0; N];
    f(&y, &mut k1);
    let (mut t, mut steps, mut refused) = (0.0, 0, false);
    let mut h = first_length(&mut f, &y, &k1, end, (relative, absolute));
    let mut k = [[0.0; N]; 11];
    let mut stage = [0.0; N];
    while t < end {
        let last = t + 1.01 * h >= end;
        if last {
            h = end - t;
        }
        let [k2, k3, k4, k5, k6, k7, k8, k9, k10, k11, k12] = &mut k;
        add(&mut stage, &y, h, A2, [&k1]);
        f(&stage, k2);
        add(&mut stage, &y, h, A3, [&k1, k2]);
        f(&stage, k3);
        add(&mut stage, &y, h, A4, [&k1, k3]);
        f(&stage, k4);
        add(&mut stage, &y, h, A5, [&k1, k3, k4]);
        f(&stage, k5);
        add(&mut stage, &y, h, A6, [&k1, k4, k5]);
        f(&stage, k6);
        add(&mut stage, &y, h, A7, [&k1, k4, k5, k6]);
        f(&stage, k7);
        add(&mut stage, &y, h, A8, [&k1, k4, k5, k6, k7]);
        f(&stage, k8);
        add(&mut stage, &y, h, A9, [&k1, k4, k5, k6, k7, k8]);
        f(&stage, k9);
        add(&mut stage, &y, h, A10, [&k1, k4, k5, k6, k7, k8, k9]);
        f(&stage, k10);
        add(&mut stage, &y, h, A11, [&k1, k4, k5, k6, k7, k8, k9, k10]);
        f(&stage, k11);
        add(&mut stage, &y, h, A12, [&k1, k4, k5, k6, k7, k8, k9, k10, k11]);
        f(&stage, k12);
        let used = [&k1, &*k6, &*k7, &*k8, &*k9, &*k10, &*k11, &*k12];
        let (mut fifth, mut third) = (0.0, 0.0);
        for i in 0..N {
            let slope: f64 = (0..8).map(|j| B[j] * used[j][i]).sum();
            let error: f64 = (0..8).map(|j| E5[j] * used[j][i]).sum();
            stage[i] = y[i] + h * slope;
            let weight = 1.0 / (absolute + relative * y[i].abs().max(stage[i].abs()));
            let other = slope - B3[0] * k1[i] - B3[1] * k9[i] - B3[2] * k12[i];
            fifth += (error * weight).powi(2);
            third += (other * weight).powi(2);
        }
        let error = h * fifth / (N as f64 * (fifth + 0.01 * third)).sqrt();
        let factor = 0.9 / error.sqrt().sqrt().sqrt();
        if error > 1.0 {
            h *= factor.max(1.0 / 3.0);
            refused = true;
            continue;
        }
        t = if last { end } else { t + h };
        h *= factor.clamp(1.0 / 3.0, if refused { 1.0 } else { 6.0 });
        y = stage;
        f(&y, &mut k1);
        refused = false;
        steps += 1;
    }
    (y, steps)
}

#[inline(always)]
fn add<const N: usize, const TERMS: usize>(
    sum: &mut [f64; N],
    y: &[f64; N],
    h: f64,
    a: [f64; TERMS],
    k: [&[f64; N]; TERMS],
) {
    let scaled = a.map(|a| h * a);
    for i in 0..N {
        let mut value = scaled[0] * k[0][i];
        for j in 1..TERMS {
            value += scaled[j] * k[j][i];
        }
        sum[i] = y[i] + value;
    }
}

fn first_length<const N: usize>(
    f: &mut impl FnMut(&[f64; N], &mut [f64; N]),
    y: &[f64; N],
    k1: &[f64; N],
    end: f64,
    (relative, absolute): (f64, f64),
) -> f64 {
    let norm = |v: &[f64; N]| -> f64 {
        (0..N).map(|i| (v[i] / (absolute + relative * y[i].abs())).powi(2)).sum::<f64>().sqrt()
    };
    let h = (0.01 * norm(y) / norm(k1)).min(end);
    let (mut stage, mut k2) = ([0.0; N], [0.0; N]);
    add(&mut stage, y, h, [1.0], [k1]);
    f(&stage, &mut k2);
    let change: [f64; N] = std::array::from_fn(|i| k2[i] - k1[i]);
    let largest = (norm(&change) / h).max(norm(k1));
    (100.0 * h).min((0.01 / largest).powf(0.125)).min(end)
}
