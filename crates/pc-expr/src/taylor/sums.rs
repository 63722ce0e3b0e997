//! Sums of products of coefficients, many at a time.

/// Sums in a vector; tables of them are that many numbers wide, or a multiple of it.
pub(crate) const LANES: usize = 8;

/// Coefficients of orders 1, 2, …: each order a row of so many numbers, which begins with the first factors of all sums, followed by
/// the second factors.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    pub(crate) numbers: &'a [f64],
    pub(crate) stride: usize,
    pub(crate) sums: usize,
}

/// Writes Σ_{j=1}^{k−1} a_j b_{k−j} of all sums, for k ≥ 2.
#[inline(always)]
pub(crate) fn sums_by(rows: Rows<'_>, k: usize, sums: &mut [f64], add: impl Fn(f64, f64, f64) -> f64 + Copy) {
    let Rows { numbers, stride, sums: width } = rows;
    for (place, sums) in (0..width).step_by(LANES).zip(sums.chunks_exact_mut(LANES)) {
        let first = |j: usize| &numbers[(j - 1) * stride + place..][..LANES];
        let second = |j: usize| &numbers[(j - 1) * stride + width + place..][..LANES];
        // Several partial sums, so that one addition need not wait for the other.
        let mut parts = [[0.0; LANES]; 4];
        let mut j = 1;
        while j + 3 < k {
            for (i, part) in parts.iter_mut().enumerate() {
                let (a, b) = (first(j + i), second(k - j - i));
                for l in 0..LANES {
                    part[l] = add(a[l], b[l], part[l]);
                }
            }
            j += 4;
        }
        while j < k {
            let (a, b) = (first(j), second(k - j));
            for l in 0..LANES {
                parts[0][l] = add(a[l], b[l], parts[0][l]);
            }
            j += 1;
        }
        for l in 0..LANES {
            sums[l] = (parts[0][l] + parts[1][l]) + (parts[2][l] + parts[3][l]);
        }
    }
}

/// The same, products and sums rounded one by one, as the interpreter does.
pub(crate) fn sums(rows: Rows<'_>, k: usize, out: &mut [f64]) {
    sums_by(rows, k, out, |a, b, sum| a * b + sum);
}
