//! Motions of systems with nonholonomic constraints.

/// State (x, y, z; ẋ, ẏ, ż) of Appell's and Hamel's machine, k = ¾, g = 10, from the origin with ż = −1 in the direction
/// (0.6, 0.8): v̇ = k g/(1 + k²), z̈ = −g/(1 + k²) [Hamel 1949].
pub fn appell_hamel(t: f64) -> [f64; 6] {
    let (k, g) = (0.75, 10.0);
    let fall = g / (1.0 + k * k);
    let (way, speed) = (k * (t + fall * t * t / 2.0), k * (1.0 + fall * t));
    [0.6 * way, 0.8 * way, -way / k, 0.6 * speed, 0.8 * speed, -speed / k]
}

/// Velocity (ẋ, ẏ) and way (x, y) of a particle that keeps the speed v under the gravity g, from (0, 0) with ẋ > 0 and
/// ẏ = −v tanh τ_0: with τ = τ_0 + g t/v, ẋ = v sech τ, ẏ = −v tanh τ, x = (v²/g)(gd τ − gd τ_0),
/// y = −(v²/g) ln(cosh τ/cosh τ_0), gd τ = 2 arctan tanh(τ/2).
pub fn constant_speed(v: f64, g: f64, tau_0: f64, t: f64) -> [f64; 4] {
    let tau = tau_0 + g * t / v;
    let gd = |tau: f64| 2.0 * (tau / 2.0).tanh().atan();
    let length = v * v / g;
    let fall = (tau.cosh() / tau_0.cosh()).ln();
    [length * (gd(tau) - gd(tau_0)), -length * fall, v / tau.cosh(), -v * tau.tanh()]
}

/// State (X, Y, φ, v, ω) of Chaplygin's sleigh, m = J = 1, a = ½, from v = 0, ω = 1 at the origin: v = W tanh kt,
/// ω = sech kt, φ = (2/k) arctan tanh(kt/2), W = √5/2, k = 1/√5 [Chaplygin 1911]; X and Y by Simpson's rule.
pub fn chaplygin_sleigh(t: f64) -> [f64; 5] {
    const INTERVALS: usize = 4000; // error (5/4000)⁴/180 · 5 of some derivatives of order one
    let (limit, k) = (5f64.sqrt() / 2.0, 1.0 / 5f64.sqrt());
    let heading = |t: f64| 2.0 / k * (k * t / 2.0).tanh().atan();
    let speed = |t: f64| limit * (k * t).tanh();
    let simpson = |f: &dyn Fn(f64) -> f64| {
        let h = t / INTERVALS as f64;
        let weight = |i: usize| [2.0, 4.0][i % 2];
        let inner: f64 = (1..INTERVALS).map(|i| weight(i) * f(h * i as f64)).sum();
        h / 3.0 * (f(0.0) + inner + f(t))
    };
    let x = simpson(&|t| speed(t) * heading(t).cos());
    let y = simpson(&|t| speed(t) * heading(t).sin());
    [x, y, heading(t), speed(t), 1.0 / (k * t).cosh()]
}

/// State (X, Y, φ, θ, θ̇, φ̇) of the vertical disk, R = ½, I + mR² = ¾, under a torque, from (1, −1, 0.2, 0; 3, ½): with
/// f = τ/(I + mR²), u = 3 + f t, α = 0.2 + t/2: X = 1 + R [(u sin α − u_0 sin α_0)/w + f (cos α − cos α_0)/w²], and so Y.
pub fn vertical_disk(torque: f64, t: f64) -> [f64; 6] {
    let (radius, turn, first) = (0.5, 0.5, 0.2f64);
    let f = torque / 0.75;
    let (u, angle) = (3.0 + f * t, first + turn * t);
    let ((sin, cos), (sin0, cos0)) = (angle.sin_cos(), first.sin_cos());
    let x = 1.0 + radius * ((u * sin - 3.0 * sin0) / turn + f * (cos - cos0) / (turn * turn));
    let y = -1.0 - radius * ((u * cos - 3.0 * cos0) / turn - f * (sin - sin0) / (turn * turn));
    [x, y, angle, 3.0 * t + f * t * t / 2.0, u, turn]
}

/// State (x, y, z, ẋ, ẏ) of the particle with ż = y ẋ, from (0, −1, 0; 1, ½): y = −1 + t/2, ẋ = √2/√(1 + y²),
/// x = 2√2 (asinh y + asinh 1), z = 2√2 (√(1 + y²) − √2).
pub fn nonholonomic_particle(t: f64) -> [f64; 5] {
    let (root, y) = (2f64.sqrt(), t / 2.0 - 1.0);
    let length = y.hypot(1.0);
    [2.0 * root * (y.asinh() + 1f64.asinh()), y, 2.0 * root * (length - root), root / length, 0.5]
}

/// (ω_1, ω_2) of Suslov's body, I_1 = 2, I_2 = 3, I_13 = ½, I_23 = −0.8, from (1, ½): √I_1 ω_1 = ρ cos α, √I_2 ω_2 = ρ sin α,
/// α = α* + gd(κt + δ), gd z = 2 arctan tanh(z/2), α* = arg(I_13/√I_1 + i I_23/√I_2),
/// κ = ρ √(I_13²/I_1 + I_23²/I_2)/√(I_1 I_2).
pub fn suslov(t: f64) -> [f64; 2] {
    let roots = [2f64.sqrt(), 3f64.sqrt()];
    let across = [0.5 / roots[0], -0.8 / roots[1]];
    let (rho, start) = (roots[0].hypot(roots[1] / 2.0), (roots[1] / 2.0).atan2(roots[0]));
    let fixed = across[1].atan2(across[0]);
    let rate = rho * across[0].hypot(across[1]) / (roots[0] * roots[1]);
    let delta = (start - fixed).tan().asinh(); // the inverse of gd, for |α − α*| < π/2
    let angle = fixed + 2.0 * ((rate * t + delta) / 2.0).tanh().atan();
    [rho * angle.cos() / roots[0], rho * angle.sin() / roots[1]]
}

/// Centre of the ball on the table that turns with Ω = 2, from (1, 0) with the velocity v_0 = ½ + ½i:
/// 1 + v_0 (e^(iκΩt) − 1)/(iκΩ), κ = 2/7 [Earnshaw 1844].
pub fn turntable_centre(t: f64) -> [f64; 2] {
    let rate = 4.0 / 7.0;
    let (sin, cos) = (rate * t).sin_cos();
    // (½ + ½i)(cos − 1 + i sin)/i = ½ (cos − 1 + sin) + ½ i (1 − cos + sin)
    [1.0 + (cos - 1.0 + sin) / (2.0 * rate), (1.0 - cos + sin) / (2.0 * rate)]
}

/// (φ, z, ω_r, ω_φ, ω_z) of the ball in the cylinder, a = ½, ρ = 1, κ = 2/7, g = 10, from (0, 0; 2, 1, −6): φ = Ωt with Ω = 3,
/// z = z* (1 − cos νt) + (a/ν) sin νt, ν = √κ Ω, z* = −(κ a Ω ω_r + (1 − κ) g)/ν² at the start, ω_r = 2 + Ωz/a.
pub fn ball_in_cylinder(t: f64) -> [f64; 5] {
    let (kappa, rate, radius) = (2.0 / 7.0, 3.0, 0.5);
    let nu = f64::sqrt(kappa) * rate;
    let middle = -(kappa * radius * rate * 2.0 + (1.0 - kappa) * 10.0) / (nu * nu);
    let (sin, cos) = (nu * t).sin_cos();
    let height = middle * (1.0 - cos) + radius / nu * sin;
    let climb = middle * nu * sin + radius * cos;
    [rate * t, height, 2.0 + rate * height / radius, climb / radius, -6.0]
}

/// (φ̇) of the carriage from v = 1, φ̇ = 0.8: M v̇ = h φ̇², K φ̈ = −h v φ̇ with M = 3, K = 0.84, h = 0.6 have v = W tanh(kt + δ),
/// φ̇ = √(M/K) W sech(kt + δ), W² = v² + (K/M) φ̇², k = h W/K.
pub fn carriage_turn(t: f64) -> [f64; 1] {
    let (mass, inertia, arm): (f64, f64, f64) = (3.0, 0.84, 0.6);
    let limit = (1.0 + inertia / mass * 0.64).sqrt();
    let delta = (1.0 / limit).atanh();
    [(mass / inertia).sqrt() * limit / (arm * limit / inertia * t + delta).cosh()]
}
