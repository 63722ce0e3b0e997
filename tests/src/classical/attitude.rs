//! Bodies that turn themselves: a gyroscope in gimbals, a satellite with reaction wheels, a quadrotor.

use super::tops::{Vector, cross, vector};

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// y = (α, β, γ, α̇, β̇, n) of a rotor (A, A, C) in gimbals of A_0 and (A_1, B_1, C_1), K = A + A_1 − C_1:
/// (A_0 + (A + A_1) cos²β + C_1 sin²β) α̈ = 2K α̇ β̇ sin β cos β − C n β̇ cos β,
/// (A + B_1) β̈ = C n α̇ cos β − K α̇² sin β cos β, ṅ = 0 [Magnus 1955].
pub fn gimbals(y: &[f64], dy: &mut [f64]) {
    let (a0, [a1, b1, c1], [a, c]) = (0.5, [0.3, 0.2, 0.4], [0.6, 1.0]);
    let (sin, cos) = y[1].sin_cos();
    let [u, v, n] = vector(&y[3..]);
    let k = a + a1 - c1;
    let outer = a0 + (a + a1) * cos * cos + c1 * sin * sin;
    let rates = [
        u,
        v,
        n - u * sin,
        (2.0 * k * u * v * sin - c * n * v) * cos / outer,
        (c * n - k * u * sin) * u * cos / (a + b1),
        0.0,
    ];
    dy.copy_from_slice(&rates);
}

/// y = (q, ω, Ω) of a body I with wheels of axes a_j, h_j = J (Ω_j + a_j·ω):
/// I ω̇ + ω × (I ω + Σ h_j a_j) = −T, ḣ_j = τ_j with T = k_p q + k_d ω of the vector part of q, shared by the wheels with the
/// least Σ τ_j²: τ_j = ¾ a_j·T, as the axes lean alike in all directions, Σ a_j a_jᵀ = 4/3 [Markley and Crassidis 2014].
pub fn reaction_wheels(y: &[f64], dy: &mut [f64]) {
    let (inertia, wheel, [proportional, derivative]) = ([3.0, 4.0, 2.5], 0.05, [2.0, 3.0]);
    let (cos, sin) = ((2.0f64 / 3.0).sqrt(), (1.0f64 / 3.0).sqrt());
    let axes = [[cos, 0.0, sin], [0.0, cos, sin], [-cos, 0.0, sin], [0.0, -cos, sin]];
    let (scalar, part, omega) = (y[0], vector(&y[1..]), vector(&y[4..]));
    let torque: Vector = std::array::from_fn(|i| proportional * part[i] + derivative * omega[i]);
    let momentum: Vector = std::array::from_fn(|i| {
        let stored = axes.iter().zip(&y[7..]).map(|(a, rate)| wheel * (rate + dot(*a, omega)) * a[i]);
        inertia[i] * omega[i] + stored.sum::<f64>()
    });
    let (gyroscopic, across) = (cross(momentum, omega), cross(part, omega));
    dy[0] = -dot(part, omega) / 2.0;
    for i in 0..3 {
        dy[1 + i] = (scalar * omega[i] + across[i]) / 2.0;
        dy[4 + i] = (gyroscopic[i] - torque[i]) / inertia[i];
    }
    let acceleration = vector(&dy[4..]);
    for (rate, &axis) in dy[7..].iter_mut().zip(&axes) {
        *rate = 0.75 * dot(axis, torque) / wheel - dot(axis, acceleration);
    }
}

/// y = (r, ψ, θ, φ, ṙ, ω): m r̈ = −m g e_z + F R e_z, I ω̇ = I ω × ω + M with R = R_z(ψ) R_y(θ) R_x(φ), and the rates of the
/// angles from ω = φ̇ e_1 + R_xᵀ(θ̇ e_2 + R_yᵀ ψ̇ e_3) [Mellinger and Kumar 2011].
pub fn quadrotor(y: &[f64], dy: &mut [f64]) {
    let (mass, inertia, [arm, drag], g) = (0.5, [2.32e-3, 2.32e-3, 4e-3], [0.17, 0.016], 9.81);
    let f: [f64; 4] = [1.24, 1.2305, 1.239, 1.23];
    let (thrust, omega) = (f.iter().sum::<f64>(), vector(&y[9..]));
    let [(sin_psi, cos_psi), (sin_theta, cos_theta), (sin_phi, cos_phi)] =
        [y[3], y[4], y[5]].map(f64::sin_cos);
    // R_x e_z, then R_y of it, then R_z of that.
    let rolled = [0.0, -sin_phi, cos_phi];
    let pitched = [rolled[2] * sin_theta, rolled[1], rolled[2] * cos_theta];
    let up = [
        pitched[0] * cos_psi - pitched[1] * sin_psi,
        pitched[0] * sin_psi + pitched[1] * cos_psi,
        pitched[2],
    ];
    let torque = [arm * (f[1] - f[3]), arm * (f[2] - f[0]), drag * (f[0] - f[1] + f[2] - f[3])];
    let gyroscopic = cross(std::array::from_fn(|i| inertia[i] * omega[i]), omega);
    dy[..3].copy_from_slice(&y[6..9]);
    dy[3] = (omega[1] * sin_phi + omega[2] * cos_phi) / cos_theta;
    dy[4] = omega[1] * cos_phi - omega[2] * sin_phi;
    dy[5] = omega[0] + dy[3] * sin_theta;
    for i in 0..3 {
        dy[6 + i] = thrust * up[i] / mass - if i == 2 { g } else { 0.0 };
        dy[9 + i] = (gyroscopic[i] + torque[i]) / inertia[i];
    }
}
