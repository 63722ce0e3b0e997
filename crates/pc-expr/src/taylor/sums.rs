//! Sums of products of coefficients, computed in vectors.

/// The number of sums in a vector; the width of tables is a multiple of it.
pub(crate) const LANES: usize = 8;

/// Coefficients of orders 1, 2, …: each order is a row that begins with the first factors of all sums,
/// followed by the second factors.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    pub(crate) numbers: &'a [f64],
    pub(crate) stride: usize,
    pub(crate) sums: usize,
}

#[cfg(all(feature = "jit", target_arch = "x86_64"))]
impl Rows<'_> {
    /// Whether the rows reach to order k − 1 and `out` has room for its sums.
    pub(crate) fn hold(self, k: usize, out: &[f64]) -> bool {
        k >= 2 && self.numbers.len() >= (k - 2) * self.stride + 2 * self.sums && out.len() >= self.sums
    }
}

/// The order in which the terms j = 1, …, k − 1 are added, four sums in turn: those with the newest
/// coefficients come last, so that the others need not wait for them.
pub(crate) fn order_of_terms(k: usize) -> impl Iterator<Item = usize> {
    (2..k.max(3) - 1).chain(1..2).chain((k > 2).then(|| k - 1))
}

/// Writes Σ_{j=1}^{k−1} a_j b_{k−j} for all sums, k ≥ 2; products and sums are rounded one by one, as in the
/// interpreter.
///
/// # Panics
/// If there are too few rows.
pub(crate) fn sums(rows: Rows<'_>, k: usize, out: &mut [f64]) {
    sums_by(rows, k, out, |a, b, sum| a * b + sum);
}

/// As [`sums`], with a different way of adding a product.
pub(crate) fn sums_by(rows: Rows<'_>, k: usize, out: &mut [f64], add: impl Fn(f64, f64, f64) -> f64) {
    let Rows { numbers, stride, sums: width } = rows;
    for (place, sums) in (0..width).step_by(LANES).zip(out.chunks_exact_mut(LANES)) {
        let mut parts = [[0.0; LANES]; 4];
        for (i, j) in order_of_terms(k).enumerate() {
            let a = &numbers[(j - 1) * stride + place..][..LANES];
            let b = &numbers[(k - j - 1) * stride + width + place..][..LANES];
            for l in 0..LANES {
                parts[i % 4][l] = add(a[l], b[l], parts[i % 4][l]);
            }
        }
        for l in 0..LANES {
            sums[l] = (parts[0][l] + parts[1][l]) + (parts[2][l] + parts[3][l]);
        }
    }
}
