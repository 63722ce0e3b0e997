//! Systems with nonholonomic constraints, as Newton's and Euler's equations with the reactions eliminated give them.

use super::tops::{Vector, cross, vector};

/// q̇ = ½ (−q·ω, q_0 ω ± q × ω), scalar part first: + for ω in body axes, − for ω in space axes.
fn turn(q: &[f64], omega: Vector, side: f64, dq: &mut [f64]) {
    let part = vector(&q[1..]);
    let turned = cross(part, omega);
    dq[0] = -(part[0] * omega[0] + part[1] * omega[1] + part[2] * omega[2]) / 2.0;
    for i in 0..3 {
        dq[1 + i] = (q[0] * omega[i] + side * turned[i]) / 2.0;
    }
}

/// Appell's and Hamel's machine, k = ¾, g = 10. y = (x, y, z, ẋ, ẏ, ż): ẍ = λ ẋ, ÿ = λ ẏ, z̈ = −g − λ k² ż, where λ is such
/// that ẋ² + ẏ² − k² ż² keeps its value [Hamel 1949].
pub fn appell_hamel(y: &[f64], dy: &mut [f64]) {
    let (k2, g) = (0.5625, 10.0);
    let lambda = -k2 * g * y[5] / (y[3] * y[3] + y[4] * y[4] + k2 * k2 * y[5] * y[5]);
    dy[..3].copy_from_slice(&y[3..]);
    dy[3] = lambda * y[3];
    dy[4] = lambda * y[4];
    dy[5] = -g - lambda * k2 * y[5];
}

/// Chaplygin's sleigh, m = J = 1, a = ½, under a force along the blade and a moment. y = (X, Y, φ, v, ω):
/// m v̇ = m a ω² + F, (J + m a²) ω̇ = −m a v ω + N [Chaplygin 1911].
fn sleigh(force: f64, moment: f64, y: &[f64], dy: &mut [f64]) {
    let ((sin, cos), [v, omega]) = (y[2].sin_cos(), [y[3], y[4]]);
    dy[0] = v * cos;
    dy[1] = v * sin;
    dy[2] = omega;
    dy[3] = omega * omega / 2.0 + force;
    dy[4] = (moment - v * omega / 2.0) / 1.25;
}

/// Chaplygin's sleigh on smooth ice.
pub fn chaplygin_sleigh(y: &[f64], dy: &mut [f64]) {
    sleigh(0.0, 0.0, y, dy);
}

/// The sleigh steered by a stiff spring and a damper, F = 2 sin 2t − v/5 − ½ (1 + e^(−4v²)) tanh 10v.
pub fn stiff_sleigh(t: f64, y: &[f64], dy: &mut [f64]) {
    let moment = -1.25e6 * (y[2] - t.sin() / 2.0) - 1.25e6 * y[4];
    sleigh(along_the_blade(t, y[3]), moment, y, dy);
}

/// The sleigh with m = J = k = 1, a = 0.1 on a spring to a peg at rest, with friction 0.8 along the blade: ahead for σ = 1, back
/// for σ = −1, and what holds it for σ = 0. y = (ξ, η, φ, σ, v, ω), (ξ, η) the place seen from the peg, in the sleigh's axes.
pub fn stick_slip_sleigh(y: &[f64], dy: &mut [f64]) {
    let [along, across, mode, v, omega] = [y[0], y[1], y[3], y[4], y[5]];
    let ahead = 0.1 * omega * omega - along;
    let held = (1.0 - mode * mode) * ahead;
    dy.copy_from_slice(&[
        v + omega * across,
        -omega * along,
        omega,
        0.0,
        ahead - 0.8 * mode - held,
        -0.1 * v * omega / 1.01,
    ]);
}

/// A disk with m = R = 1, J = 0.3, its mass centre ½ under its centre. y = (X, θ, ω): the moments about the point of contact.
pub fn rocking_disk(y: &[f64], dy: &mut [f64]) {
    let ((sin, cos), omega) = (y[1].sin_cos(), y[2]);
    let inertia = 0.3 + 0.25 * sin * sin + (1.0 - 0.5 * cos).powi(2);
    dy.copy_from_slice(&[omega, omega, -0.5 * sin * (9.81 + omega * omega) / inertia]);
}

/// Drive and friction of the steered sleigh.
pub(crate) fn along_the_blade(t: f64, v: f64) -> f64 {
    let friction = v / 5.0 + (0.5 + 0.5 * (-4.0 * v * v).exp()) * (10.0 * v).tanh();
    2.0 * (2.0 * t).sin() - friction
}

/// A vertical disk with m = 2, R = ½, I = ¼, J = ⅛. y = (X, Y, φ, θ, Ẋ, Ẏ, φ̇, θ̇): θ̈ = φ̈ = 0, and
/// Ẋ = R θ̇ cos φ, Ẏ = R θ̇ sin φ differentiated.
pub fn vertical_disk(y: &[f64], dy: &mut [f64]) {
    let ((sin, cos), [turn, roll]) = (y[2].sin_cos(), [y[6], y[7]]);
    dy[..4].copy_from_slice(&y[4..]);
    dy[4] = -0.5 * roll * turn * sin;
    dy[5] = 0.5 * roll * turn * cos;
    dy[6] = 0.0;
    dy[7] = 0.0;
}

/// The same disk under a torque. y = (X, Y, φ, θ, θ̇, φ̇): (I + mR²) θ̈ = τ, J φ̈ = 0.
pub fn vertical_disk_driven(torque: f64, y: &[f64], dy: &mut [f64]) {
    let (sin, cos) = y[2].sin_cos();
    dy[0] = 0.5 * y[4] * cos;
    dy[1] = 0.5 * y[4] * sin;
    dy[2] = y[5];
    dy[3] = y[4];
    dy[4] = torque / (0.25 + 2.0 * 0.25);
    dy[5] = 0.0;
}

/// A disk that leans, m = r = 1, A = ¼, C = ½, g = 10. y = (X, Y, ψ, θ, φ, ω_1, ω_2, ω_3):
/// (A + mr²) ω̇_1 = A ω_2² cot θ − (C + mr²) ω_2 ω_3 − mgr cos θ, A ω̇_2 = C ω_1 ω_3 − A ω_1 ω_2 cot θ,
/// (C + mr²) ω̇_3 = mr² ω_1 ω_2 [Appell 1896].
pub fn tilted_disk(y: &[f64], dy: &mut [f64]) {
    let (a, c) = (0.25, 0.5);
    let ((sin_psi, cos_psi), cot) = (y[2].sin_cos(), y[3].tan().recip());
    let [w1, w2, w3] = vector(&y[5..]);
    let roll = w3 - w2 * cot;
    dy[0] = -roll * cos_psi;
    dy[1] = -roll * sin_psi;
    dy[2] = w2 / y[3].sin();
    dy[3] = w1;
    dy[4] = roll;
    dy[5] = (a * w2 * w2 * cot - (c + 1.0) * w2 * w3 - 10.0 * y[3].cos()) / (a + 1.0);
    dy[6] = (c * w1 * w3 - a * w1 * w2 * cot) / a;
    dy[7] = w1 * w2 / (c + 1.0);
}

/// A particle with ż = y ẋ. y = (x, y, z, ẋ, ẏ): (1 + y²) ẍ = −y ẋ ẏ, ÿ = 0.
pub fn nonholonomic_particle(y: &[f64], dy: &mut [f64]) {
    dy[0] = y[3];
    dy[1] = y[4];
    dy[2] = y[1] * y[3];
    dy[3] = -y[1] * y[3] * y[4] / (1.0 + y[1] * y[1]);
    dy[4] = 0.0;
}

/// Suslov's body, I = ((2, 0, ½), (0, 3, −0.8), (½, −0.8, 4)). y = (q, ω_1, ω_2): I_1 ω̇_1 = −M_3 ω_2, I_2 ω̇_2 = M_3 ω_1,
/// M_3 = I_13 ω_1 + I_23 ω_2.
pub fn suslov(y: &[f64], dy: &mut [f64]) {
    let (w1, w2) = (y[4], y[5]);
    let momentum = 0.5 * w1 - 0.8 * w2;
    turn(y, [w1, w2, 0.0], 1.0, dy);
    dy[4] = -momentum * w2 / 2.0;
    dy[5] = momentum * w1 / 3.0;
}

/// Suslov's body in gravity, I = diag(1, 2, 3), r = (3/2, 1, 0), mg = 1. y = (q, ω_1, ω_2): I_1 ω̇_1 = −r_2 γ_3,
/// I_2 ω̇_2 = r_1 γ_3, γ the upward vertical in body axes, homogeneous in q.
pub fn suslov_in_gravity(y: &[f64], dy: &mut [f64]) {
    let vertical = y[0] * y[0] - y[1] * y[1] - y[2] * y[2] + y[3] * y[3];
    turn(y, [y[4], y[5], 0.0], 1.0, dy);
    dy[4] = -vertical;
    dy[5] = 1.5 * vertical / 2.0;
}

/// A ball of m = 1, R = ½, J = 2mR²/5 on a table that turns at the rate Ω(t) with the derivative `growth`.
/// y = (q, X, Y, ω_x, ω_y, ω_z), ω in space axes: Ẍ = −κ (ΩY)˙, Ÿ = κ (ΩX)˙, J ω̇_x = mR Ÿ, J ω̇_y = −mR Ẍ, κ = J/(J + mR²).
pub fn ball_on_turntable(rate: f64, growth: f64, y: &[f64], dy: &mut [f64]) {
    let (centre, omega) = ([y[4], y[5]], vector(&y[6..]));
    let velocity = [0.5 * omega[1] - rate * centre[1], -0.5 * omega[0] + rate * centre[0]];
    let kappa = 0.1 / (0.1 + 0.25);
    let moved: [f64; 2] = std::array::from_fn(|i| growth * centre[i] + rate * velocity[i]); // (ΩX)˙ and (ΩY)˙
    let acceleration = [-kappa * moved[1], kappa * moved[0]];
    turn(y, omega, -1.0, dy);
    dy[4] = velocity[0];
    dy[5] = velocity[1];
    dy[6] = 0.5 * acceleration[1] / 0.1;
    dy[7] = -0.5 * acceleration[0] / 0.1;
    dy[8] = 0.0;
}

/// A ball of m = 1, a = ½, J = 2ma²/5 in a vertical cylinder of radius 3/2, g = 10. y = (q, φ, z, ω_r, ω_φ, ω_z):
/// ω̇_z = 0, ω̇_r = Ω ω_φ, (J + ma²) ω̇_φ = −J Ω ω_r − m a g, Ω = φ̇ = −a ω_z/ρ: Euler's equation about the point of contact
/// in the radius, the tangent and the vertical, which turn with Ω.
pub fn ball_in_cylinder(y: &[f64], dy: &mut [f64]) {
    let ((sin, cos), [out, around, up]) = (y[4].sin_cos(), vector(&y[6..]));
    let rate = -0.5 * up;
    turn(y, [out * cos - around * sin, out * sin + around * cos, up], -1.0, dy);
    dy[4] = rate;
    dy[5] = 0.5 * around;
    dy[6] = rate * around;
    dy[7] = -(0.1 * rate * out + 5.0) / (0.1 + 0.25);
    dy[8] = 0.0;
}

/// A snakeboard with m = 2, r = ½, J_0 = ¼, J_1 = 0.1 under torques on rotor and steering.
/// y = (X, Y, θ, ψ, φ, ψ̇, φ̇, w): J_0 (1 − J_0 sin²φ/(mr²)) ψ̈ = τ_1 − J_0 w φ̇ cos φ, 2 J_1 φ̈ = τ_2, mr² ẇ = −J_0 sin φ ψ̈.
pub fn snakeboard(torques: [f64; 2], y: &[f64], dy: &mut [f64]) {
    let ((sin_theta, cos_theta), (sin, cos)) = (y[2].sin_cos(), y[4].sin_cos());
    let [rotor, steering, w] = vector(&y[5..]);
    let along = -0.5 * w * cos;
    dy[0] = along * cos_theta;
    dy[1] = along * sin_theta;
    dy[2] = w * sin;
    dy[3] = rotor;
    dy[4] = steering;
    dy[5] = (torques[0] - 0.25 * w * steering * cos) / (0.25 * (1.0 - 0.5 * sin * sin));
    dy[6] = torques[1] / 0.2;
    dy[7] = -0.5 * sin * dy[5];
}

/// A carriage with m = 2, J = ½, a = 0.3, b = 0.4, r = 0.2, C = 0.02. y = (x, y, φ, ψ_1, ψ_2) and their velocities:
/// (m + 2C/r²) v̇ = m a φ̇², (J + ma² + 2Cb²/r²) φ̈ = −m a v φ̇, and the constraints differentiated.
pub fn carriage(y: &[f64], dy: &mut [f64]) {
    let ((sin, cos), turn) = (y[2].sin_cos(), y[7]);
    let v = y[5] * cos + y[6] * sin;
    let ahead = 0.6 * turn * turn / (2.0 + 1.0);
    let about = -0.6 * v * turn / (0.5 + 0.18 + 0.16);
    dy[..5].copy_from_slice(&y[5..]);
    dy[5] = ahead * cos - v * turn * sin;
    dy[6] = ahead * sin + v * turn * cos;
    dy[7] = about;
    dy[8] = (ahead - 0.4 * about) / 0.2;
    dy[9] = (ahead + 0.4 * about) / 0.2;
}

/// A particle with ż = Aẋ + Bẏ + D, A = y + z²/2, B = xz, in the potential z²/2 + xz/4. y = (x, y, z, ẋ, ẏ):
/// ẍ = −z/4 − Aλ, ÿ = −Bλ, (1 + A² + B²) λ = z + x/4 − Az/4 + Ȧẋ + Ḃẏ + Ḋ. D = `drift[0]` + y/10 + z/5 with the rate
/// `drift[1]` of its first part, or 0.
pub fn voronets(drift: Option<[f64; 2]>, y: &[f64], dy: &mut [f64]) {
    let [x, place, z] = vector(y);
    let [vx, vy] = [y[3], y[4]];
    let (a, b) = (place + z * z / 2.0, x * z);
    let d = drift.map_or(0.0, |[value, _]| value + place / 10.0 + z / 5.0);
    let vz = a * vx + b * vy + d;
    let d_rate = drift.map_or(0.0, |[_, rate]| rate + vy / 10.0 + vz / 5.0);
    let transport = (vy + z * vz) * vx + (vx * z + x * vz) * vy + d_rate;
    let lambda = (z + x / 4.0 - a * z / 4.0 + transport) / (1.0 + a * a + b * b);
    dy[0] = vx;
    dy[1] = vy;
    dy[2] = vz;
    dy[3] = -z / 4.0 - a * lambda;
    dy[4] = -b * lambda;
}
