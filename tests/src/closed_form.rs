//! Motions known in closed form.
//!
//! Where a function takes no parameters, they and the start are those of the built-in model of the same name.

mod nonholonomic;

pub use nonholonomic::{
    appell_hamel, ball_in_cylinder, carriage_turn, chaplygin_sleigh, constant_speed, nonholonomic_particle,
    suslov, turntable_centre, vertical_disk,
};

/// Jacobi's elliptic functions (sn, cn, dn) of the argument `u` and the parameter m = k², 0 ≤ m < 1, by the
/// arithmetic-geometric mean [Abramowitz and Stegun 1964, 16.4].
pub fn jacobi(u: f64, m: f64) -> (f64, f64, f64) {
    let (mut mean, mut geometric) = (1.0, (1.0 - m).sqrt());
    let mut steps = vec![(mean, m.sqrt())]; // (a_n, c_n)
    while steps.last().is_some_and(|&(a, c)| c > 1e-17 * a) && steps.len() < 16 {
        let half_difference = (mean - geometric) / 2.0;
        (mean, geometric) = ((mean + geometric) / 2.0, (mean * geometric).sqrt());
        steps.push((mean, half_difference));
    }
    let mut amplitude = (1u64 << (steps.len() - 1)) as f64 * mean * u;
    for &(a, c) in steps.iter().skip(1).rev() {
        amplitude = (amplitude + (c / a * amplitude.sin()).asin()) / 2.0;
    }
    let (sn, cn) = amplitude.sin_cos();
    (sn, cn, (1.0 - m * sn * sn).sqrt())
}

/// The complete elliptic integral K of the first kind, parameter m = k² < 1 [Abramowitz and Stegun 1964, 17.6.3].
pub fn quarter_period(m: f64) -> f64 {
    let (mut mean, mut geometric) = (1.0_f64, (1.0 - m).sqrt());
    while (mean - geometric).abs() > 1e-15 * mean {
        (mean, geometric) = ((mean + geometric) / 2.0, (mean * geometric).sqrt());
    }
    std::f64::consts::PI / (mean + geometric)
}

/// Euler's top with I_1 < I_2 < I_3 and M² > 2E I_2, from ω_2 = 0, ω_1 > 0, ω_3 > 0:
/// ω_1 = √((2E I_3 − M²)/(I_1 (I_3 − I_1))) cn τ, ω_2 = √((2E I_3 − M²)/(I_2 (I_3 − I_2))) sn τ,
/// ω_3 = √((M² − 2E I_1)/(I_3 (I_3 − I_1))) dn τ, with τ = t √((I_3 − I_2)(M² − 2E I_1)/(I_1 I_2 I_3)) and
/// m = (I_2 − I_1)(2E I_3 − M²)/((I_3 − I_2)(M² − 2E I_1)) [Jacobi 1850].
pub fn euler_top_elliptic(inertia: [f64; 3], twice_energy: f64, momentum_squared: f64, t: f64) -> [f64; 3] {
    let [i1, i2, i3] = inertia;
    let (low, high) = (momentum_squared - twice_energy * i1, twice_energy * i3 - momentum_squared);
    let tau = t * ((i3 - i2) * low / (i1 * i2 * i3)).sqrt();
    let (sn, cn, dn) = jacobi(tau, (i2 - i1) * high / ((i3 - i2) * low));
    [
        (high / (i1 * (i3 - i1))).sqrt() * cn,
        (high / (i2 * (i3 - i2))).sqrt() * sn,
        (low / (i3 * (i3 - i1))).sqrt() * dn,
    ]
}

/// Euler's top with I = (1, 2, 3) from ω = (1, 0, 1): ω = (cn t, sn t, dn t), m = 1/3.
pub fn euler_top(t: f64) -> [f64; 3] {
    euler_top_elliptic([1.0, 2.0, 3.0], 4.0, 10.0, t)
}

/// Euler's top with I = (1, 2, 3) on the separatrix M² = 2E I_2, from ω = (√3, 0, 1):
/// ω = (√3 sech t, √3 tanh t, sech t).
pub fn euler_top_separatrix(t: f64) -> [f64; 3] {
    let (sech, root) = (1.0 / t.cosh(), 3.0_f64.sqrt());
    [root * sech, root * t.tanh(), sech]
}

/// Angle of nutation θ(t) of the symmetric heavy top I = (1, 1, ½), r = (0, 0, 1), mg = 1, let go from θ_0 = ½ with
/// ψ̇ = θ̇ = 0 and ω_3 = 4.
///
/// With β = 2 mg r_3/I_1, a = I_3 ω_3/I_1, u = cos θ: u̇² = (u_0 − u)[β (1 − u²) − a² (u_0 − u)], a cubic with
/// roots u_1 < u_0 < u_3, and u = u_1 + (u_0 − u_1) sn²(½ √(β (u_3 − u_1)) t + K), m = (u_0 − u_1)/(u_3 − u_1)
/// [Whittaker 1937, ch. VI].
pub fn symmetric_top_nutation(t: f64) -> f64 {
    let (beta, a_squared, top): (f64, f64, f64) = (2.0, 4.0, 0.5_f64.cos());
    // the other two roots: βu² − a²u + a²u_0 − β = 0
    let middle = a_squared / (2.0 * beta);
    let half_gap = (middle * middle - 2.0 * middle * top + 1.0).sqrt();
    let (low, high) = (middle - half_gap, middle + half_gap);
    let m = (top - low) / (high - low);
    let (sn, _, _) = jacobi((beta * (high - low)).sqrt() / 2.0 * t + quarter_period(m), m);
    (low + (top - low) * sn * sn).acos()
}

/// State (ρ, φ, η_1, η_2) of the charge in a constant field B, from (1, 0; ½, 1): the circle
/// x + iy = 1 + (½ + i)(1 − e^(−iBt))/(iB), with η_1 + iη_2 = (ẋ + iẏ) e^(−iφ).
///
/// φ is given in (−π, π]; for B = 2 the circle does not go round the origin, and no turn is lost.
pub fn charged_particle(field: f64, t: f64) -> [f64; 4] {
    let (sin, cos) = (field * t).sin_cos();
    let velocity = [0.5 * cos + sin, cos - 0.5 * sin]; // (½ + i) e^(−iBt)
    // (½ + i − velocity)/(iB): dividing by i turns (a, b) into (b, −a)
    let (x, y) = (1.0 + (1.0 - velocity[1]) / field, -(0.5 - velocity[0]) / field);
    let radius = x.hypot(y);
    [
        radius,
        y.atan2(x),
        (velocity[0] * x + velocity[1] * y) / radius,
        (velocity[1] * x - velocity[0] * y) / radius,
    ]
}

/// (x, ẋ) of the damped oscillator ẍ = −½ẋ − 4x from (1, 1): x = e^(−t/4) (cos wt + 5/(4w) sin wt), w² = 4 − 1/16.
pub fn damped_oscillator(t: f64) -> [f64; 2] {
    let w = (4.0 - 1.0 / 16.0_f64).sqrt();
    let ((sin, cos), decay) = ((w * t).sin_cos(), (-t / 4.0).exp());
    let amplitude = 1.25 / w;
    let x = decay * (cos + amplitude * sin);
    [x, -x / 4.0 + decay * w * (amplitude * cos - sin)]
}

/// Velocity of light in the relativistic model.
const LIGHT: f64 = 2.0;

/// (E, ℓ, u_0, Γ) of the relativistic orbit from (1, 0; 0, 1.1) with c = 2, κ = 1: E = γc² − κ/ρ, ℓ = γρη_2,
/// Γ² = 1 − κ²/(c²ℓ²), u_0 = κE/(c²ℓ²Γ²).
fn relativistic_constants() -> (f64, f64, f64, f64) {
    let gamma = 1.0 / (1.0 - (1.1 / LIGHT).powi(2)).sqrt();
    let (energy, momentum) = (gamma * LIGHT * LIGHT - 1.0, gamma * 1.1);
    let scale = (LIGHT * momentum).powi(2);
    let square = 1.0 - 1.0 / scale;
    (energy, momentum, energy / (scale * square), square.sqrt())
}

/// 1/ρ at the angle φ on the relativistic Kepler orbit, 1/ρ = u_0 + (1/ρ_0 − u_0) cos Γφ [Sommerfeld 1916].
pub fn relativistic_orbit(angle: f64) -> f64 {
    let (_, _, centre, turning) = relativistic_constants();
    centre + (1.0 - centre) * (turning * angle).cos()
}

/// State (ρ, φ, η_1, η_2) at the angle φ on the relativistic Kepler orbit: η_2 = ℓu/γ with γ = (E + κu)/c², u = 1/ρ,
/// and η_1 = −(du/dφ) η_2/u.
pub fn relativistic_state(angle: f64) -> [f64; 4] {
    let (energy, momentum, centre, turning) = relativistic_constants();
    let u = relativistic_orbit(angle);
    let slope = -(1.0 - centre) * turning * (turning * angle).sin();
    let across = momentum * u * LIGHT * LIGHT / (energy + u);
    [1.0 / u, angle, -slope * across / u, across]
}

/// Path of a particle of rest mass one from rest under the constant force f: x = (c²/f)(√(1 + (ft/c)²) − 1).
pub fn relativistic_fall(light: f64, force: f64, t: f64) -> f64 {
    light * light / force * ((force * t / light).hypot(1.0) - 1.0)
}

/// State (X, Y, η) of the bead on the turning wire, Ω = 1, g = 3, from r = 1, ṙ = −½: r = cosh t − 2 sinh t + (3/2) sin t,
/// X + iY = r e^(it), η = (1 + t/2) ṙ.
pub fn turning_wire(t: f64) -> [f64; 3] {
    let (sin, cos) = t.sin_cos();
    let distance = t.cosh() - 2.0 * t.sinh() + 1.5 * sin;
    let speed = t.sinh() - 2.0 * t.cosh() + 1.5 * cos;
    [distance * cos, distance * sin, (1.0 + t / 2.0) * speed]
}

/// State (X, Y, η_1, η_2) of the oscillator on the turning table, Ω = 0.7, from (1, 0; 0, 1.5).
///
/// Ẍ = 2ΩẎ − pX and Ÿ = −2ΩẊ − qY, p = 1 − Ω², q = 4 − Ω², have solutions X = a cos λt,
/// Y = a (p − λ²)/(2Ωλ) sin λt, where (p − λ²)(q − λ²) = 4Ω²λ²: two such, with X = 1 and Ẏ = 1.5 − Ω at the start.
pub fn rotating_oscillator(t: f64) -> [f64; 4] {
    let omega: f64 = 0.7;
    let (p, q) = (1.0 - omega * omega, 4.0 - omega * omega);
    let middle = (p + q) / 2.0 + 2.0 * omega * omega;
    let root = (middle * middle - p * q).sqrt();
    let squares = [middle - root, middle + root];
    // Σ a = 1 and Σ a (p − λ²) = 2Ω (1.5 − Ω)
    let first = (2.0 * omega * (1.5 - omega) - p + squares[1]) / (squares[1] - squares[0]);
    let mut state = [0.0; 4]; // X, Y, Ẋ, Ẏ
    for (square, a) in squares.into_iter().zip([first, 1.0 - first]) {
        let rate = square.sqrt();
        let ((sin, cos), ratio) = ((rate * t).sin_cos(), (p - square) / (2.0 * omega * rate));
        state[0] += a * cos;
        state[1] += a * ratio * sin;
        state[2] -= a * rate * sin;
        state[3] += a * ratio * rate * cos;
    }
    let [x, y, x_rate, y_rate] = state;
    [x, y, x_rate - omega * y, y_rate + omega * x]
}

/// Height z(t) of the spherical pendulum of length one, g = 10, from (0.6, 0, −0.8) with the velocity (0, 1.5, 0).
///
/// ż² = 2 (E − gz)(1 − z²) − ℓ², a cubic with roots z_1 < z_2 < z_3, z_2 the height of the start, and
/// z = z_1 + (z_2 − z_1) sn²(√(g (z_3 − z_1)/2) t + K), m = (z_2 − z_1)/(z_3 − z_1) [Whittaker 1937, ch. IV].
pub fn spherical_pendulum_height(t: f64) -> f64 {
    let (g, start, momentum): (f64, f64, f64) = (10.0, -0.8, 0.9);
    let energy = 1.5 * 1.5 / 2.0 + g * start;
    // the other two roots: z² + (z_2 − E/g) z − (2E − ℓ²)/(2g z_2) = 0
    let middle = (energy / g - start) / 2.0;
    let half_gap = (middle * middle + (2.0 * energy - momentum * momentum) / (2.0 * g * start)).sqrt();
    let (low, high) = (middle - half_gap, middle + half_gap);
    let m = (start - low) / (high - low);
    let (sn, _, _) = jacobi((g * (high - low) / 2.0).sqrt() * t + quarter_period(m), m);
    low + (start - low) * sn * sn
}

/// f′(t) by a central difference of order 8 with the step 1/100: error below 1e-11 for the functions of this module.
pub fn derivative(f: impl Fn(f64) -> f64, t: f64) -> f64 {
    const STEP: f64 = 1e-2;
    const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let pair = |j: usize| f(t + j as f64 * STEP) - f(t - j as f64 * STEP);
    (1..=4).map(|j| WEIGHTS[j - 1] * pair(j)).sum::<f64>() / STEP
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobi_functions_have_their_special_values() {
        for u in [0.0, 0.3, 1.7, 40.0] {
            let (sn, cn, dn) = jacobi(u, 0.0);
            assert!((sn - u.sin()).abs() < 1e-14 && (cn - u.cos()).abs() < 1e-14 && dn == 1.0);
        }
        for m in [0.1, 1.0 / 3.0, 0.9, 0.999] {
            let (sn, cn, dn) = jacobi(quarter_period(m), m);
            assert!((sn - 1.0).abs() < 1e-14 && cn.abs() < 1e-12 && (dn - (1.0 - m).sqrt()).abs() < 1e-13);
            // sn(K/2) = 1/√(1 + √(1 − m))
            let (sn, _, _) = jacobi(quarter_period(m) / 2.0, m);
            assert!((sn - 1.0 / (1.0 + (1.0 - m).sqrt()).sqrt()).abs() < 1e-13);
        }
        // K(1/2) = Γ(1/4)²/(4√π)
        assert!((quarter_period(0.5) - 1.854_074_677_301_372).abs() < 1e-15);
    }

    #[test]
    fn jacobi_functions_satisfy_their_equations() {
        for m in [0.2, 0.7, 0.99] {
            for u in [-1.3, 0.4, 2.9, 11.0] {
                let (sn, cn, dn) = jacobi(u, m);
                assert!((derivative(|u| jacobi(u, m).0, u) - cn * dn).abs() < 1e-10);
                assert!((derivative(|u| jacobi(u, m).1, u) + sn * dn).abs() < 1e-10);
                assert!((derivative(|u| jacobi(u, m).2, u) + m * sn * cn).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn motions_start_where_the_models_start() {
        assert_eq!(euler_top(0.0), [1.0, 0.0, 1.0]);
        assert_eq!(euler_top_separatrix(0.0), [3.0_f64.sqrt(), 0.0, 1.0]);
        assert!((symmetric_top_nutation(0.0) - 0.5).abs() < 1e-12);
        assert_eq!(charged_particle(2.0, 0.0), [1.0, 0.0, 0.5, 1.0]);
        assert_eq!(damped_oscillator(0.0), [1.0, 1.0]);
        let state = relativistic_state(0.0);
        assert!((0..4).all(|i| (state[i] - [1.0, 0.0, 0.0, 1.1][i]).abs() < 1e-15));
        assert_eq!(relativistic_fall(2.0, 3.0, 0.0), 0.0);
        assert_eq!(turning_wire(0.0), [1.0, 0.0, -0.5]);
        let state = rotating_oscillator(0.0);
        assert!((0..4).all(|i| (state[i] - [1.0, 0.0, 0.0, 1.5][i]).abs() < 1e-14), "{state:?}");
        assert!((spherical_pendulum_height(0.0) + 0.8).abs() < 1e-15);
    }

    /// The nutation never rises above the start, and returns to it at the end of each period.
    #[test]
    fn nutation_stays_below_its_cusps() {
        for step in 0..200 {
            assert!(symmetric_top_nutation(f64::from(step) / 10.0) >= 0.5 - 1e-12);
        }
    }

    /// d(γẋ)/dt = f.
    #[test]
    fn constant_force_raises_the_momentum_evenly() {
        let (light, force) = (2.0, 3.0);
        let momentum = |t: f64| {
            let velocity = derivative(|t| relativistic_fall(light, force, t), t);
            velocity / (1.0 - (velocity / light).powi(2)).sqrt()
        };
        for t in [0.0, 0.5, 1.0, 2.0] {
            assert!((momentum(t) - force * t).abs() < 1e-9, "t = {t}");
        }
    }

    #[test]
    fn relativistic_orbit_keeps_energy_and_momentum() {
        for angle in [0.0, 0.9, 3.1, 17.0] {
            let [radius, _, along, across] = relativistic_state(angle);
            let gamma = 1.0 / (1.0 - (along * along + across * across) / (LIGHT * LIGHT)).sqrt();
            let (energy, momentum, _, _) = relativistic_constants();
            assert!((gamma * LIGHT * LIGHT - 1.0 / radius - energy).abs() < 1e-13);
            assert!((gamma * radius * across - momentum).abs() < 1e-13);
        }
    }
}
