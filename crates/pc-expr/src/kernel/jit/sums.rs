//! Sums of products with the widest vectors of the processor, rounded once per term, as in compiled
//! code.

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

use crate::taylor::sums::{Rows, sums, sums_by};

/// Writes Σ_{j=1}^{k−1} a_j b_{k−j} for all sums.
#[derive(Clone, Copy)]
pub(crate) struct Sums(unsafe fn(Rows<'_>, usize, &mut [f64]));

impl Sums {
    #[inline]
    pub(crate) fn write(self, rows: Rows<'_>, k: usize, out: &mut [f64]) {
        // SAFETY: the processor has the features of the function, which checks the lengths.
        unsafe { (self.0)(rows, k, out) };
    }
}

/// The fastest implementation on this processor. The results are the same, to the last bit, for every
/// width of vectors.
pub(crate) fn fastest() -> Sums {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("fma") {
            return Sums(by_eight);
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            return Sums(by_four);
        }
    }
    if cfg!(target_arch = "aarch64") {
        Sums(|rows, k, out| sums_by(rows, k, out, f64::mul_add))
    } else {
        Sums(sums)
    }
}

/// A function that adds the terms in the order of
/// [`order_of_terms`](crate::taylor::sums::order_of_terms) with vectors of this width.
#[cfg(target_arch = "x86_64")]
macro_rules! by_vectors {
    ($name:ident, $features:literal, $lanes:literal, $load:ident, $store:ident, $fma:ident, $add:ident, $zero:ident) => {
        #[target_feature(enable = $features)]
        fn $name(rows: Rows<'_>, k: usize, out: &mut [f64]) {
            assert!(rows.hold(k, out), "rows for all terms");
            let Rows { numbers, stride, sums: width } = rows;
            for place in (0..width).step_by($lanes) {
                // SAFETY: `place` leaves a vector in both halves of a row, widths being multiples
                // of 8, and j and k − j are at least 1 and at most k − 1, the number of rows; `out`
                // is as wide.
                unsafe {
                    let (a, b) = (numbers.as_ptr().add(place), numbers.as_ptr().add(width + place));
                    let term = |j: usize, sum| {
                        $fma($load(a.add((j - 1) * stride)), $load(b.add((k - j - 1) * stride)), sum)
                    };
                    let mut parts = [$zero(); 4];
                    let mut j = 2;
                    while j + 4 < k {
                        parts[0] = term(j, parts[0]);
                        parts[1] = term(j + 1, parts[1]);
                        parts[2] = term(j + 2, parts[2]);
                        parts[3] = term(j + 3, parts[3]);
                        j += 4;
                    }
                    // The remaining terms begin with the first part again.
                    let mut left = 0;
                    while j + 1 < k {
                        parts[left] = term(j, parts[left]);
                        left += 1;
                        j += 1;
                    }
                    parts[left % 4] = term(1, parts[left % 4]);
                    if k > 2 {
                        parts[(left + 1) % 4] = term(k - 1, parts[(left + 1) % 4]);
                    }
                    let sum = $add($add(parts[0], parts[1]), $add(parts[2], parts[3]));
                    $store(out.as_mut_ptr().add(place), sum);
                }
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
by_vectors!(
    by_eight,
    "avx512f,fma",
    8,
    _mm512_loadu_pd,
    _mm512_storeu_pd,
    _mm512_fmadd_pd,
    _mm512_add_pd,
    _mm512_setzero_pd
);
#[cfg(target_arch = "x86_64")]
by_vectors!(
    by_four,
    "avx2,fma",
    4,
    _mm256_loadu_pd,
    _mm256_storeu_pd,
    _mm256_fmadd_pd,
    _mm256_add_pd,
    _mm256_setzero_pd
);

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::{Rows, by_eight, by_four, sums_by};

    #[test]
    fn the_width_of_vectors_does_not_change_a_bit() {
        let (stride, sums) = (56_usize, 24);
        let numbers: Vec<f64> =
            (0..20 * stride).map(|i| (1.0 + i as f64).sin() * 3.0_f64.powi(i as i32 % 7)).collect();
        for k in 2..=20 {
            let rows = Rows { numbers: &numbers, stride, sums };
            let mut expected = vec![0.0; sums];
            sums_by(rows, k, &mut expected, f64::mul_add);
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                let mut found = vec![0.0; sums];
                // SAFETY: the processor has these features.
                unsafe { by_four(rows, k, &mut found) };
                assert_eq!(found, expected, "order {k}");
            }
            if is_x86_feature_detected!("avx512f") {
                let mut found = vec![0.0; sums];
                // SAFETY: the processor has these features.
                unsafe { by_eight(rows, k, &mut found) };
                assert_eq!(found, expected, "order {k}");
            }
        }
    }
}
