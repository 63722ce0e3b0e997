//! The triaxial heavy top with its mass centre on no principal axis, and the same body without weight.

use super::{Hand, fma, for_this_host};

const INERTIA: [f64; 3] = [2.0, 3.0, 4.0];
const CENTRE: [f64; 3] = [0.1, 0.2, 0.3];
const WEIGHT: f64 = 10.0;

/// (I_j − I_k)/I_i
pub(super) const GYROSCOPIC: [f64; 3] = [
    (INERTIA[1] - INERTIA[2]) / INERTIA[0],
    (INERTIA[2] - INERTIA[0]) / INERTIA[1],
    (INERTIA[0] - INERTIA[1]) / INERTIA[2],
];
/// mg r_k/I_i
pub(super) const FORTH: [f64; 3] =
    [WEIGHT * CENTRE[2] / INERTIA[0], WEIGHT * CENTRE[0] / INERTIA[1], WEIGHT * CENTRE[1] / INERTIA[2]];
/// −mg r_j/I_i
pub(super) const BACK: [f64; 3] =
    [-WEIGHT * CENTRE[1] / INERTIA[0], -WEIGHT * CENTRE[2] / INERTIA[1], -WEIGHT * CENTRE[0] / INERTIA[2]];

/// ω̇_i = (I_j − I_k)/I_i ω_j ω_k + mg (γ_j r_k − γ_k r_j)/I_i, (i, j, k) cyclic.
#[inline(always)]
fn acceleration<const FMA: bool>(vertical: [f64; 3], omega: [f64; 3], out: &mut [f64; 3]) {
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let torque = fma::<FMA>(BACK[i], vertical[k], FORTH[i] * vertical[j]);
        out[i] = fma::<FMA>(GYROSCOPIC[i] * omega[j], omega[k], torque);
    }
}

#[inline(always)]
fn in_poisson_variables<const FMA: bool>(&[g1, g2, g3, w1, w2, w3]: &[f64; 6], dy: &mut [f64; 6]) {
    dy[0] = fma::<FMA>(g2, w3, -(g3 * w2));
    dy[1] = fma::<FMA>(g3, w1, -(g1 * w3));
    dy[2] = fma::<FMA>(g1, w2, -(g2 * w1));
    let mut omega = [0.0; 3];
    acceleration::<FMA>([g1, g2, g3], [w1, w2, w3], &mut omega);
    dy[3..].copy_from_slice(&omega);
}

#[inline(always)]
fn in_euler_angles<const FMA: bool>(&[_, theta, phi, w1, w2, w3]: &[f64; 6], dy: &mut [f64; 6]) {
    let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (theta.sin_cos(), phi.sin_cos());
    let precession = fma::<FMA>(w1, sin_phi, w2 * cos_phi) / sin_theta;
    dy[0] = precession;
    dy[1] = fma::<FMA>(w1, cos_phi, -(w2 * sin_phi));
    dy[2] = fma::<FMA>(-precession, cos_theta, w3);
    let mut omega = [0.0; 3];
    acceleration::<FMA>([sin_theta * sin_phi, sin_theta * cos_phi, cos_theta], [w1, w2, w3], &mut omega);
    dy[3..].copy_from_slice(&omega);
}

/// q̇ = ½ Ξ(q) ω
#[inline(always)]
fn quaternion_rates<const FMA: bool>([q0, q1, q2, q3]: [f64; 4], [w1, w2, w3]: [f64; 3]) -> [f64; 4] {
    let (h1, h2, h3) = (0.5 * w1, 0.5 * w2, 0.5 * w3);
    [
        // Unlike the others, or the compiler makes one vector of the four and shuffles longer than it saves.
        -0.5 * fma::<FMA>(q1, w1, fma::<FMA>(q2, w2, q3 * w3)),
        fma::<FMA>(q0, h1, fma::<FMA>(q2, h3, -(q3 * h2))),
        fma::<FMA>(q0, h2, fma::<FMA>(q3, h1, -(q1 * h3))),
        fma::<FMA>(q0, h3, fma::<FMA>(q1, h2, -(q2 * h1))),
    ]
}

#[inline(always)]
fn free_in_quaternion<const FMA: bool>(&[q0, q1, q2, q3, w1, w2, w3]: &[f64; 7], dy: &mut [f64; 7]) {
    let [r0, r1, r2, r3] = quaternion_rates::<FMA>([q0, q1, q2, q3], [w1, w2, w3]);
    *dy = [r0, r1, r2, r3, GYROSCOPIC[0] * w2 * w3, GYROSCOPIC[1] * w3 * w1, GYROSCOPIC[2] * w1 * w2];
}

#[inline(always)]
fn in_quaternion<const FMA: bool>(&[q0, q1, q2, q3, w1, w2, w3]: &[f64; 7], dy: &mut [f64; 7]) {
    dy[..4].copy_from_slice(&quaternion_rates::<FMA>([q0, q1, q2, q3], [w1, w2, w3]));
    let (p1, p2) = (fma::<FMA>(q1, q3, -(q0 * q2)), fma::<FMA>(q2, q3, q0 * q1));
    let vertical = [p1 + p1, p2 + p2, fma::<FMA>(q0, q0, q3 * q3) - fma::<FMA>(q1, q1, q2 * q2)];
    let mut omega = [0.0; 3];
    acceleration::<FMA>(vertical, [w1, w2, w3], &mut omega);
    dy[4..].copy_from_slice(&omega);
}

/// y = (γ, ω)
pub(crate) fn poisson() -> Hand {
    for_this_host!(in_poisson_variables, [f64; 6])
}

/// y = (ψ, θ, φ, ω)
pub(crate) fn euler() -> Hand {
    for_this_host!(in_euler_angles, [f64; 6])
}

/// y = (q, ω)
pub(crate) fn quaternion() -> Hand {
    for_this_host!(in_quaternion, [f64; 7])
}

/// y = (q, ω), without weight
pub(crate) fn free_quaternion() -> Hand {
    for_this_host!(free_in_quaternion, [f64; 7])
}
