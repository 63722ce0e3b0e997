//! The derivative of the exponential map, if ad x has the eigenvalue 0 and eigenvalues ±iθ that are at most
//! double.

use nalgebra::DMatrix;

use crate::group::group::Side;
use crate::group::stumpff::stumpff;

/// The series Σ (±A)^i/(i + 1)!, with the minus sign for the left side, where A = `ad` and A(A² + θ²)² = 0.
/// The series is computed as 1 + d_1(±A) + d_2 A² + d_3(±A³) + d_4 A⁴, with the d_i found by interpolation at
/// 0 and, doubly, at ±iθ.
pub(crate) fn dexp(side: Side, ad: &DMatrix<f64>, angle: f64) -> DMatrix<f64> {
    let [_, c1, c2, c3, c4, c5] = stumpff(angle);
    polynomial(
        side,
        ad,
        [2.0 * c2 - c1 / 2.0, (5.0 * c3 - c2) / 2.0, (c3 - 2.0 * c4) / 2.0, (c4 - 3.0 * c5) / 2.0],
    )
}

/// The inverse of [`dexp`]: the function ζ/(e^ζ − 1) = ½ζ(coth ½ζ − 1) of ζ = ±A, with plus for the right
/// side and minus for the left; its only odd term is −½ζ.
pub(crate) fn dexp_inverse(side: Side, ad: &DMatrix<f64>, angle: f64) -> DMatrix<f64> {
    let [_, c1, c2, c3, c4, c5] = stumpff(angle / 2.0);
    let square = (3.0 * (c2 - c3) * c1 - c3 * (1.0 + c1)) / (8.0 * c1 * c1);
    let fourth = -(c4 - 3.0 * c5 + c3 * (c2 - 2.0 * c3)) / (32.0 * c1 * c1);
    polynomial(side, ad, [-0.5, square, 0.0, fourth])
}

/// 1 + Σ d_i (±A)^i
fn polynomial(side: Side, ad: &DMatrix<f64>, d: [f64; 4]) -> DMatrix<f64> {
    let k = ad.nrows();
    let a = match side {
        Side::Left => -ad,
        Side::Right => ad.clone(),
    };
    let one = DMatrix::<f64>::identity(k, k);
    let nested = d.iter().rev().fold(DMatrix::zeros(k, k), |rest, &d| &a * (rest + &one * d));
    nested + one
}
