//! Sums of products by the widest vectors of the processor, rounded once a term, as compiled code does.

use crate::taylor::sums::{Rows, sums, sums_by};

/// Writes Σ_{j=1}^{k−1} a_j b_{k−j} of all sums.
pub(crate) type Sums = fn(Rows<'_>, usize, &mut [f64]);

/// What this processor does fastest. The width of vectors does not change a bit of the results.
pub(crate) fn fastest() -> Sums {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor has what the function is compiled for.
            return |rows, k, out| unsafe { sums_avx512(rows, k, out) };
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor has what the function is compiled for.
            return |rows, k, out| unsafe { sums_avx2(rows, k, out) };
        }
    }
    if cfg!(target_arch = "aarch64") { |rows, k, out| sums_by(rows, k, out, f64::mul_add) } else { sums }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,fma")]
fn sums_avx512(rows: Rows<'_>, k: usize, out: &mut [f64]) {
    sums_by(rows, k, out, |a, b, sum| a.mul_add(b, sum));
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn sums_avx2(rows: Rows<'_>, k: usize, out: &mut [f64]) {
    sums_by(rows, k, out, |a, b, sum| a.mul_add(b, sum));
}
