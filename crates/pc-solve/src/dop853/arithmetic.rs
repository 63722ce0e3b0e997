//! Sums of stages over the components of a state.
//!
//! Rows are as long as a state, padded with 0 to a multiple of four, the numbers in a vector. For
//! short rows the length is a compile-time constant, so that the loops are unrolled without bounds
//! checks. The order of operations, and so each bit of the results, depends neither on whether the
//! length is constant nor on the vectors of the processor.

use super::coefficients::{B, B3, E5};

/// The length of rows is a multiple of this.
const WIDTH: usize = 4;

/// The length of a row that holds a state of length `dim`.
pub(super) fn padded(dim: usize) -> usize {
    dim.next_multiple_of(WIDTH)
}

/// sum = y + h Σ aⱼ kⱼ
pub(super) fn add<const TERMS: usize>(
    sum: &mut [f64],
    y: &[f64],
    h: f64,
    a: &[f64; TERMS],
    k: [&[f64]; TERMS],
) {
    add_of::<0, TERMS>(sum, y, h, a, k);
}

/// The same for rows of length LENGTH, or of any length if LENGTH is 0.
#[inline(always)]
pub(super) fn add_of<const LENGTH: usize, const TERMS: usize>(
    sum: &mut [f64],
    y: &[f64],
    h: f64,
    a: &[f64; TERMS],
    k: [&[f64]; TERMS],
) {
    let n = if LENGTH == 0 { sum.len() } else { LENGTH };
    let (sum, y, k) = (&mut sum[..n], &y[..n], rows_of(n, k));
    // A loop, since `map` over arrays is a call in some builds.
    let mut scaled = [0.0; TERMS];
    for j in 0..TERMS {
        scaled[j] = h * a[j];
    }
    for i in 0..n {
        let mut value = scaled[0] * k[0][i];
        for j in 1..TERMS {
            value += scaled[j] * k[j][i];
        }
        sum[i] = y[i] + value;
    }
}

/// The rows, known to be of length n.
#[inline(always)]
fn rows_of<const ROWS: usize>(n: usize, mut rows: [&[f64]; ROWS]) -> [&[f64]; ROWS] {
    for row in &mut rows {
        *row = &row[..n];
    }
    rows
}

/// The tolerances that weight the error of a step.
#[derive(Clone, Copy)]
pub(super) struct Weights<'a> {
    pub(super) relative: f64,
    /// The absolute tolerance of each component, padded to a row.
    pub(super) absolute: &'a [f64],
}

/// Writes y₁ = y + h Σ bᵢ kᵢ from stages 1 and 6 to 12, and returns the sums over the components of
/// the squares of the two error estimates over h, of orders 5 and 3, weighted by the tolerances.
/// The sums are not finite where y₁ is not finite. Rows have length LENGTH, or any length if LENGTH
/// is 0.
#[inline(always)]
pub(super) fn finish_of<const LENGTH: usize>(
    y1: &mut [f64],
    y: &[f64],
    h: f64,
    k: [&[f64]; 8],
    Weights { relative, absolute }: Weights<'_>,
) -> (f64, f64) {
    let n = if LENGTH == 0 { y1.len() } else { LENGTH };
    let (y1, y, absolute, k) = (&mut y1[..n], &y[..n], &absolute[..n], rows_of(n, k));
    // A sum for each place in a vector.
    let (mut fifth, mut third) = ([0.0; WIDTH], [0.0; WIDTH]);
    for i in 0..n {
        let (mut slope, mut error) = (B[0] * k[0][i], E5[0] * k[0][i]);
        for j in 1..8 {
            slope += B[j] * k[j][i];
            error += E5[j] * k[j][i];
        }
        let end = y[i] + h * slope;
        y1[i] = end;
        let weight = 1.0 / (absolute[i] + relative * y[i].abs().max(end.abs()));
        let other = slope - B3[0] * k[0][i] - B3[1] * k[4][i] - B3[2] * k[7][i];
        // An infinite component has weight 0, so its error alone would not show.
        fifth[i % WIDTH] += (error * weight) * (error * weight) + 0.0 * end;
        third[i % WIDTH] += (other * weight) * (other * weight);
    }
    let sum = |sums: [f64; WIDTH]| (sums[0] + sums[1]) + (sums[2] + sums[3]);
    (sum(fifth), sum(third))
}

/// Σ (aᵢ − bᵢ)²
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}
