//! Bodies on a blade and on an edge, y = (coordinates, free quasi-velocities).

use super::{Hand, fma, for_this_host};

/// y = (x, y, φ, v, ω): v̇ = a ω², ω̇ = −m a/(J + m a²) v ω with m = J = 1, a = ½.
#[inline(always)]
fn on_a_blade<const FMA: bool>(&[_, _, phi, v, w]: &[f64; 5], dy: &mut [f64; 5]) {
    let (sin, cos) = phi.sin_cos();
    *dy = [v * cos, v * sin, w, 0.5 * w * w, -0.4 * v * w];
}

/// y = (X, Y, ψ, θ, φ, ω_1, ω_2, ω_3), with m = r = 1, A = ¼, C = ½, g = 10: (A + mr²) ω̇_1 = A ω_2² cot θ −
/// (C + mr²) ω_2 ω_3 − mgr cos θ, A ω̇_2 = C ω_1 ω_3 − A ω_1 ω_2 cot θ, (C + mr²) ω̇_3 = mr² ω_1 ω_2; ψ̇ =
/// ω_2/sin θ, φ̇ = ω_3 − ψ̇ cos θ, and the point of contact moves back by r φ̇.
#[inline(always)]
fn on_an_edge<const FMA: bool>(&[_, _, psi, theta, _, w1, w2, w3]: &[f64; 8], dy: &mut [f64; 8]) {
    let ((sin_psi, cos_psi), (sin_theta, cos_theta)) = (psi.sin_cos(), theta.sin_cos());
    let precession = w2 / sin_theta;
    let turn = precession * cos_theta;
    let roll = turn - w3;
    *dy = [
        roll * cos_psi,
        roll * sin_psi,
        precession,
        w1,
        -roll,
        fma::<FMA>(fma::<FMA>(-1.2, w3, 0.2 * turn), w2, -8.0 * cos_theta),
        w1 * fma::<FMA>(2.0, w3, -turn),
        w1 * w2 * (2.0 / 3.0),
    ];
}

/// The Chaplygin sleigh.
pub(crate) fn sleigh() -> Hand {
    for_this_host!(on_a_blade, [f64; 5])
}

/// The disk that rolls, tilted.
pub(crate) fn disk() -> Hand {
    for_this_host!(on_an_edge, [f64; 8])
}
