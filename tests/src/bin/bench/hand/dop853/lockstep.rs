//! Many heavy tops at once, as one writes it who knows the equations and the vectors of the processor.
//!
//! DOP853 for as many tops as a vector has lanes, all with the same step, which the largest of their errors determines. The
//! state and the stages are arrays of vectors, which unroll; the first length is a good guess.

use std::sync::atomic::{AtomicUsize, Ordering};

/// The states at the end, in place of those at the start, by so many threads; none without AVX2.
pub(crate) fn tops(states: &mut [[f64; 6]], end: f64, rtol: f64, threads: usize) -> Option<()> {
    #[cfg(target_arch = "x86_64")]
    {
        let fma = is_x86_feature_detected!("fma");
        if fma && is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor has been asked.
            in_groups(states, threads, |group| unsafe { avx512::integrate(group, end, rtol) });
            return Some(());
        }
        if fma && is_x86_feature_detected!("avx2") {
            // SAFETY: likewise.
            in_groups(states, threads, |group| unsafe { avx2::integrate(group, end, rtol) });
            return Some(());
        }
    }
    let _ = (states, end, rtol, threads);
    None
}

/// Groups of LANES states each, the last filled up, by threads that take the next.
fn in_groups<const LANES: usize>(
    states: &mut [[f64; 6]],
    threads: usize,
    integrate: impl Fn(&mut [[f64; LANES]; 6]) + Sync,
) {
    let groups = states.len().div_ceil(LANES);
    let next = AtomicUsize::new(0);
    let given: &[[f64; 6]] = states;
    let work = || {
        let mut done = Vec::new();
        loop {
            let group = next.fetch_add(1, Ordering::Relaxed);
            if group >= groups {
                return done;
            }
            let member = |lane: usize| (group * LANES + lane).min(given.len() - 1);
            let mut y: [[f64; LANES]; 6] =
                std::array::from_fn(|i| std::array::from_fn(|lane| given[member(lane)][i]));
            integrate(&mut y);
            done.push((group, y));
        }
    };
    let done: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let mut done = work();
        for thread in threads {
            done.extend(thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        done
    });
    for (group, y) in done {
        for (lane, state) in states[group * LANES..].iter_mut().take(LANES).enumerate() {
            *state = std::array::from_fn(|i| y[i][lane]);
        }
    }
}

/// The integration by vectors of one set of instructions.
macro_rules! by_vectors {
    ($set:ident, $features:literal, $lanes:literal, $vector:ident, $load:ident, $store:ident, $splat:ident,
     $add:ident, $mul:ident, $div:ident, $max:ident, $fma:ident, $sub:ident) => {
        #[cfg(target_arch = "x86_64")]
        mod $set {
            use std::arch::x86_64::*;

            use super::super::super::top::{BACK, FORTH, GYROSCOPIC};
            use super::super::coefficients::{A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, B, B3, E5};

            type Row = [$vector; 6];

            #[inline]
            #[target_feature(enable = $features)]
            fn top(y: &Row) -> Row {
                let [g1, g2, g3, w1, w2, w3] = *y;
                let cross = |a, b, c, d| $sub(a, b, $mul(c, d));
                let turn = |i: usize, a, b, c, d| {
                    let torque = $fma($splat(BACK[i]), a, $mul($splat(FORTH[i]), b));
                    $fma($mul($splat(GYROSCOPIC[i]), c), d, torque)
                };
                [
                    cross(g2, w3, g3, w2),
                    cross(g3, w1, g1, w3),
                    cross(g1, w2, g2, w1),
                    turn(0, g3, g2, w2, w3),
                    turn(1, g1, g3, w3, w1),
                    turn(2, g2, g1, w1, w2),
                ]
            }

            #[inline]
            #[target_feature(enable = $features)]
            fn sum<const TERMS: usize>(a: &[f64; TERMS], k: [&Row; TERMS]) -> Row {
                let mut sum = [$splat(0.0); 6];
                for i in 0..6 {
                    sum[i] = $mul($splat(a[0]), k[0][i]);
                }
                for j in 1..TERMS {
                    for i in 0..6 {
                        sum[i] = $fma($splat(a[j]), k[j][i], sum[i]);
                    }
                }
                sum
            }

            #[inline]
            #[target_feature(enable = $features)]
            fn stage<const TERMS: usize>(y: &Row, h: f64, a: &[f64; TERMS], k: [&Row; TERMS]) -> Row {
                let mut argument = sum(a, k);
                for i in 0..6 {
                    argument[i] = $fma(argument[i], $splat(h), y[i]);
                }
                top(&argument)
            }

            #[target_feature(enable = $features)]
            pub(super) fn integrate(group: &mut [[f64; $lanes]; 6], end: f64, rtol: f64) {
                // SAFETY: as many numbers as lanes.
                let mut y: Row = std::array::from_fn(|i| unsafe { $load(group[i].as_ptr()) });
                let mut k1 = top(&y);
                let mut h = 0.05 * (rtol * 1e9).powf(0.125);
                let (mut t, mut refused) = (0.0, false);
                while t < end {
                    let last = t + 1.01 * h >= end;
                    if last {
                        h = end - t;
                    }
                    let k2 = stage(&y, h, &A2, [&k1]);
                    let k3 = stage(&y, h, &A3, [&k1, &k2]);
                    let k4 = stage(&y, h, &A4, [&k1, &k3]);
                    let k5 = stage(&y, h, &A5, [&k1, &k3, &k4]);
                    let k6 = stage(&y, h, &A6, [&k1, &k4, &k5]);
                    let k7 = stage(&y, h, &A7, [&k1, &k4, &k5, &k6]);
                    let k8 = stage(&y, h, &A8, [&k1, &k4, &k5, &k6, &k7]);
                    let k9 = stage(&y, h, &A9, [&k1, &k4, &k5, &k6, &k7, &k8]);
                    let k10 = stage(&y, h, &A10, [&k1, &k4, &k5, &k6, &k7, &k8, &k9]);
                    let k11 = stage(&y, h, &A11, [&k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10]);
                    let k12 = stage(&y, h, &A12, [&k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10, &k11]);
                    let used = [&k1, &k6, &k7, &k8, &k9, &k10, &k11, &k12];
                    let (slope, error) = (sum(&B, used), sum(&E5, used));
                    let other = sum(&B3, [&k1, &k9, &k12]);
                    let (mut y1, mut fifth, mut third) = (y, $splat(0.0), $splat(0.0));
                    for i in 0..6 {
                        y1[i] = $fma(slope[i], $splat(h), y[i]);
                        let minus = |v| $mul(v, $splat(-1.0));
                        let size = $max($max(y[i], minus(y[i])), $max(y1[i], minus(y1[i])));
                        let weight = $div($splat(1.0), $fma($splat(rtol), size, $splat(rtol * 1e-3)));
                        let (a, b) = ($mul(error[i], weight), $mul($add(slope[i], minus(other[i])), weight));
                        fifth = $fma(a, a, fifth);
                        third = $fma(b, b, third);
                    }
                    let both = $mul($splat(6.0), $fma($splat(0.01), third, fifth));
                    let part = $mul($splat(h), fifth);
                    let mut squares = [0.0; $lanes];
                    // SAFETY: as many numbers as lanes.
                    unsafe { $store(squares.as_mut_ptr(), $div($mul(part, part), both)) };
                    let error = squares.iter().fold(0.0_f64, |most, square| most.max(*square)).sqrt();
                    let factor = 0.9 / error.sqrt().sqrt().sqrt();
                    if error > 1.0 {
                        h *= factor.max(1.0 / 3.0);
                        refused = true;
                        continue;
                    }
                    t = if last { end } else { t + h };
                    h *= factor.clamp(1.0 / 3.0, if refused { 1.0 } else { 6.0 });
                    y = y1;
                    k1 = top(&y);
                    refused = false;
                }
                for (row, y) in group.iter_mut().zip(y) {
                    // SAFETY: as many numbers as lanes.
                    unsafe { $store(row.as_mut_ptr(), y) };
                }
            }
        }
    };
}

by_vectors!(
    avx512,
    "avx512f,fma",
    8,
    __m512d,
    _mm512_loadu_pd,
    _mm512_storeu_pd,
    _mm512_set1_pd,
    _mm512_add_pd,
    _mm512_mul_pd,
    _mm512_div_pd,
    _mm512_max_pd,
    _mm512_fmadd_pd,
    _mm512_fmsub_pd
);
by_vectors!(
    avx2,
    "avx2,fma",
    4,
    __m256d,
    _mm256_loadu_pd,
    _mm256_storeu_pd,
    _mm256_set1_pd,
    _mm256_add_pd,
    _mm256_mul_pd,
    _mm256_div_pd,
    _mm256_max_pd,
    _mm256_fmadd_pd,
    _mm256_fmsub_pd
);
