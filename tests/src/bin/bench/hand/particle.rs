//! Particles in the plane, y = (ρ, φ, η_1, η_2) in the orthonormal polar frame.

use super::{Hand, fma, for_this_host};

/// η̇_1 = (η_2/ρ + B) η_2, η̇_2 = −(η_2/ρ + B) η_1 with B = 2.
#[inline(always)]
fn in_magnetic_field<const FMA: bool>(&[radius, _, along, across]: &[f64; 4], dy: &mut [f64; 4]) {
    let rate = across / radius;
    let turn = rate + 2.0;
    *dy = [along, rate, turn * across, -(turn * along)];
}

/// η̇_1 = F (1 − η_1²/c²)/γ + η_2²/ρ, η̇_2 = −(F η_1/(c²γ) + η_1/ρ) η_2 with F = −1/ρ² and c² = 4.
#[inline(always)]
fn relativistic_about_a_centre<const FMA: bool>(&[radius, _, along, across]: &[f64; 4], dy: &mut [f64; 4]) {
    let inverse = 1.0 / radius;
    let rate = across * inverse;
    let forward = fma::<FMA>(-0.25 * along, along, 1.0);
    let inverse_gamma = fma::<FMA>(-0.25 * across, across, forward).sqrt();
    let pull = inverse * inverse * inverse_gamma;
    *dy = [
        along,
        rate,
        fma::<FMA>(across, rate, -(pull * forward)),
        along * fma::<FMA>(0.25 * pull, across, -rate),
    ];
}

/// A unit charge in the field B = 2.
pub(crate) fn charged() -> Hand {
    for_this_host!(in_magnetic_field, [f64; 4])
}

/// Kepler's problem with c = 2 and κ = 1.
pub(crate) fn relativistic() -> Hand {
    for_this_host!(relativistic_about_a_centre, [f64; 4])
}
