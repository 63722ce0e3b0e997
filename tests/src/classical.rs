//! Equations of motion as the textbooks print them, for comparison with the derived ones.
//!
//! Every function writes ẏ for y = (coordinates, quasi-velocities), in the order of the columns of the built-in
//! model. [`classical`] binds them to the parameters of the models; [`sample`] draws states at which to compare.

/// A right-hand side ẏ = f(t, y): time, state, and where to write the derivative.
pub type Rhs = fn(f64, &[f64], &mut [f64]);

type Vector = [f64; 3];

fn vector(slice: &[f64]) -> Vector {
    [slice[0], slice[1], slice[2]]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A heavy rigid body with a fixed point.
#[derive(Clone, Copy, Debug)]
pub struct HeavyTop {
    /// Principal moments of inertia I at the fixed point.
    pub inertia: [f64; 3],
    /// Mass centre r, from the fixed point, on the principal axes.
    pub centre: [f64; 3],
    /// Weight mg.
    pub weight: f64,
}

impl HeavyTop {
    /// Euler's equations under gravity: I ω̇ = Iω × ω + mg γ × r, with γ the upward vertical in body axes.
    pub fn angular_acceleration(&self, vertical: [f64; 3], omega: [f64; 3]) -> [f64; 3] {
        let momentum: Vector = std::array::from_fn(|i| self.inertia[i] * omega[i]);
        let (gyroscopic, arm) = (cross(momentum, omega), cross(vertical, self.centre));
        std::array::from_fn(|i| (gyroscopic[i] + self.weight * arm[i]) / self.inertia[i])
    }

    /// y = (γ, ω): γ̇ = γ × ω, I ω̇ = Iω × ω + mg γ × r [Poisson 1813].
    pub fn in_poisson_variables(&self, y: &[f64], dy: &mut [f64]) {
        let (vertical, omega) = (vector(y), vector(&y[3..]));
        dy[..3].copy_from_slice(&cross(vertical, omega));
        dy[3..].copy_from_slice(&self.angular_acceleration(vertical, omega));
    }

    /// y = (ψ, θ, φ, ω), angles 3-1-3:
    /// ψ̇ = (ω_1 sin φ + ω_2 cos φ)/sin θ, θ̇ = ω_1 cos φ − ω_2 sin φ, φ̇ = ω_3 − ψ̇ cos θ,
    /// I ω̇ = Iω × ω + mg γ × r with γ = (sin θ sin φ, sin θ cos φ, cos θ) [Euler 1758].
    pub fn in_euler_angles(&self, y: &[f64], dy: &mut [f64]) {
        let ((sin_theta, cos_theta), (sin_phi, cos_phi)) = (y[1].sin_cos(), y[2].sin_cos());
        let omega = vector(&y[3..]);
        let precession = (omega[0] * sin_phi + omega[1] * cos_phi) / sin_theta;
        dy[0] = precession;
        dy[1] = omega[0] * cos_phi - omega[1] * sin_phi;
        dy[2] = omega[2] - precession * cos_theta;
        let vertical = [sin_theta * sin_phi, sin_theta * cos_phi, cos_theta];
        dy[3..].copy_from_slice(&self.angular_acceleration(vertical, omega));
    }

    /// y = (q, ω), q scalar first: q̇_0 = −½ q·ω, q̇ = ½ (q_0 ω + q × ω) for the vector part,
    /// I ω̇ = Iω × ω + mg γ × r with γ = (2(q_1 q_3 − q_0 q_2), 2(q_2 q_3 + q_0 q_1), q_0² − q_1² − q_2² + q_3²).
    pub fn in_quaternion(&self, y: &[f64], dy: &mut [f64]) {
        let (scalar, part, omega) = (y[0], vector(&y[1..]), vector(&y[4..]));
        let turned = cross(part, omega);
        dy[0] = -(part[0] * omega[0] + part[1] * omega[1] + part[2] * omega[2]) / 2.0;
        for i in 0..3 {
            dy[1 + i] = (scalar * omega[i] + turned[i]) / 2.0;
        }
        let [q1, q2, q3] = part;
        let vertical = [
            2.0 * (q1 * q3 - scalar * q2),
            2.0 * (q2 * q3 + scalar * q1),
            scalar * scalar - q1 * q1 - q2 * q2 + q3 * q3,
        ];
        dy[4..].copy_from_slice(&self.angular_acceleration(vertical, omega));
    }
}

/// Euler's top: ω̇_1 = (I_2 − I_3) ω_2 ω_3/I_1 and cyclically [Euler 1758].
pub fn euler_top(inertia: [f64; 3], omega: &[f64], dy: &mut [f64]) {
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        dy[i] = (inertia[j] - inertia[k]) * omega[j] * omega[k] / inertia[i];
    }
}

/// A unit charge of unit mass in the field B(t), y = (ρ, φ, η_1, η_2) with η the velocity along and across the
/// radius: ρ̇ = η_1, φ̇ = η_2/ρ, η̇_1 = η_2²/ρ + B η_2, η̇_2 = −η_1 η_2/ρ − B η_1 − ½ Ḃ ρ.
pub fn charged_particle(field: f64, field_rate: f64, y: &[f64], dy: &mut [f64]) {
    let (radius, along, across) = (y[0], y[2], y[3]);
    dy[0] = along;
    dy[1] = across / radius;
    dy[2] = across * across / radius + field * across;
    dy[3] = -along * across / radius - field * along - field_rate * radius / 2.0;
}

/// Acceleration of the damped oscillator, ẍ = −2δ ẋ − ω² x.
pub fn damped_acceleration(damping: f64, frequency: f64, x: f64, velocity: f64) -> f64 {
    -2.0 * damping * velocity - frequency * frequency * x
}

/// The damped oscillator with y = (x, ẋ): ẍ = −2δ ẋ − ω² x.
pub fn damped_oscillator(damping: f64, frequency: f64, y: &[f64], dy: &mut [f64]) {
    dy[0] = y[1];
    dy[1] = damped_acceleration(damping, frequency, y[0], y[1]);
}

/// The damped oscillator with y = (x, η), η = e^(δt) (ẋ − δx): ẋ = e^(−δt) η + δx and
/// η̇ = δη + e^(δt) (ẍ − δẋ), ẍ = −2δ ẋ − ω² x.
pub fn damped_oscillator_in_scaled_frame(damping: f64, frequency: f64, t: f64, y: &[f64], dy: &mut [f64]) {
    let growth = (damping * t).exp();
    let velocity = y[1] / growth + damping * y[0];
    let acceleration = damped_acceleration(damping, frequency, y[0], velocity);
    dy[0] = velocity;
    dy[1] = damping * y[1] + growth * (acceleration - damping * velocity);
}

/// Kepler's problem in special relativity, rest mass one, y = (ρ, φ, η_1, η_2) with η the velocity along and across
/// the radius: ρ̇ = η_1, φ̇ = η_2/ρ and, with F = −κ/ρ² and γ = (1 − |η|²/c²)^(−½),
/// η̇_1 = F (1 − η_1²/c²)/γ + η_2²/ρ, η̇_2 = −F η_1 η_2/(c²γ) − η_1 η_2/ρ.
pub fn relativistic_particle(light: f64, attraction: f64, y: &[f64], dy: &mut [f64]) {
    let (radius, along, across) = (y[0], y[2], y[3]);
    let light_squared = light * light;
    let force = -attraction / (radius * radius);
    let inverse_gamma = (1.0 - (along * along + across * across) / light_squared).sqrt();
    dy[0] = along;
    dy[1] = across / radius;
    dy[2] = force * (1.0 - along * along / light_squared) * inverse_gamma + across * across / radius;
    dy[3] = -force * along * across * inverse_gamma / light_squared - along * across / radius;
}

/// A rigid body with a spring from the space origin to one of its points.
#[derive(Clone, Copy, Debug)]
pub struct BodyOnSpring {
    /// Mass m.
    pub mass: f64,
    /// Principal moments of inertia I at the mass centre.
    pub inertia: [f64; 3],
    /// The point a at which the spring is fixed, from the mass centre on the principal axes.
    pub point: [f64; 3],
    /// Stiffness κ.
    pub stiffness: f64,
}

impl BodyOnSpring {
    /// y = (r, q, ω, v), ω and v on the principal axes, q of unit length and scalar first: ṙ = R v, q̇ as in
    /// [`HeavyTop::in_quaternion`], I ω̇ = Iω × ω + a × RᵀF, v̇ = v × ω + RᵀF/m with F = −κ (r + R a)
    /// [Newton and Euler].
    pub fn on_se3(&self, y: &[f64], dy: &mut [f64]) {
        let (place, scalar, part) = (vector(y), y[3], vector(&y[4..]));
        let (omega, v) = (vector(&y[7..]), vector(&y[10..]));
        // x + 2 p × (p × x ± q_0 x): the rotation of x, with minus the inverse one
        let turned = |x: Vector, sign: f64| -> Vector {
            let once = cross(part, x);
            let twice = cross(part, std::array::from_fn(|i| once[i] + sign * scalar * x[i]));
            std::array::from_fn(|i| x[i] + 2.0 * twice[i])
        };
        let arm = turned(self.point, 1.0);
        let force = std::array::from_fn(|i| -self.stiffness * (place[i] + arm[i]));
        let pull = turned(force, -1.0);
        let momentum: Vector = std::array::from_fn(|i| self.inertia[i] * omega[i]);
        let (gyroscopic, torque, drag) = (cross(momentum, omega), cross(self.point, pull), cross(v, omega));
        dy[..3].copy_from_slice(&turned(v, 1.0));
        dy[3] = -(part[0] * omega[0] + part[1] * omega[1] + part[2] * omega[2]) / 2.0;
        let across = cross(part, omega);
        for i in 0..3 {
            dy[4 + i] = (scalar * omega[i] + across[i]) / 2.0;
            dy[7 + i] = (gyroscopic[i] + torque[i]) / self.inertia[i];
            dy[10 + i] = drag[i] + pull[i] / self.mass;
        }
    }
}

const LAGRANGE: HeavyTop = HeavyTop { inertia: [1.0, 1.0, 0.5], centre: [0.0, 0.0, 1.0], weight: 1.0 };
const KOVALEVSKAYA: HeavyTop = HeavyTop { inertia: [2.0, 2.0, 1.0], centre: [1.0, 0.0, 0.0], weight: 1.0 };
const GORYACHEV_CHAPLYGIN: HeavyTop =
    HeavyTop { inertia: [4.0, 4.0, 1.0], centre: [1.0, 0.0, 0.0], weight: 1.0 };
const TRIAXIAL: HeavyTop = HeavyTop { inertia: [2.0, 3.0, 4.0], centre: [0.1, 0.2, 0.3], weight: 10.0 };
const ON_SPRING: BodyOnSpring =
    BodyOnSpring { mass: 2.0, inertia: [1.0, 2.0, 3.0], point: [0.5, 0.0, 0.25], stiffness: 5.0 };

/// Names of the models that [`classical`] and [`sample`] know, in order.
pub const MODELS: &[&str] = &[
    "charged-particle",
    "charged-particle-induction",
    "damped-oscillator",
    "damped-oscillator-scaled-frame",
    "euler-top",
    "heavy-top-euler",
    "heavy-top-euler-symmetric",
    "heavy-top-goryachev-chaplygin",
    "heavy-top-kovalevskaya",
    "heavy-top-lagrange",
    "heavy-top-quaternion",
    "relativistic-particle",
    "rigid-body-spring",
];

/// The classical equations of a built-in model with its parameters, or `None` for a name not in [`MODELS`].
pub fn classical(model: &str) -> Option<Rhs> {
    Some(match model {
        "charged-particle" => |_, y, dy| charged_particle(2.0, 0.0, y, dy),
        "charged-particle-induction" => {
            |t, y, dy| charged_particle(1.0 + t.sin() / 2.0, t.cos() / 2.0, y, dy)
        }
        "damped-oscillator" => |_, y, dy| damped_oscillator(0.25, 2.0, y, dy),
        "damped-oscillator-scaled-frame" => |t, y, dy| damped_oscillator_in_scaled_frame(0.25, 2.0, t, y, dy),
        "euler-top" => |_, y, dy| euler_top([1.0, 2.0, 3.0], y, dy),
        "heavy-top-euler" => |_, y, dy| TRIAXIAL.in_euler_angles(y, dy),
        "heavy-top-euler-symmetric" => |_, y, dy| LAGRANGE.in_euler_angles(y, dy),
        "heavy-top-goryachev-chaplygin" => |_, y, dy| GORYACHEV_CHAPLYGIN.in_poisson_variables(y, dy),
        "heavy-top-kovalevskaya" => |_, y, dy| KOVALEVSKAYA.in_poisson_variables(y, dy),
        "heavy-top-lagrange" => |_, y, dy| LAGRANGE.in_poisson_variables(y, dy),
        "heavy-top-quaternion" => |_, y, dy| TRIAXIAL.in_quaternion(y, dy),
        "relativistic-particle" => |_, y, dy| relativistic_particle(2.0, 1.0, y, dy),
        "rigid-body-spring" => |_, y, dy| ON_SPRING.on_se3(y, dy),
        _ => return None,
    })
}

/// A small generator of random numbers: a counter, well mixed [Steele, Lea and Flood 2014, SplitMix64].
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// The generator that starts from `seed`; the same seed gives the same numbers on every machine.
    pub fn new(seed: u64) -> Self {
        SplitMix64(seed)
    }

    /// The next 64 bits.
    pub fn next_bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next_bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// Normal with mean 0 and variance 1 [Box and Muller 1958].
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform(0.0, 1.0)).ln()).sqrt();
        radius * self.uniform(0.0, std::f64::consts::TAU).cos()
    }

    fn normals(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.normal()).collect()
    }
}

/// A random time and state at which the equations of a built-in model are regular, or `None` for a name not in
/// [`MODELS`].
///
/// Kept away from the poles of Euler's angles (θ between 0.4 and 2.6), from the centre of polar coordinates
/// (ρ between 0.5 and 2) and from the velocity of light (speed at most 0.9 c). Vertical and quaternion are not
/// normalised, but for the quaternion of a body that moves: the equations of the tops hold off the unit sphere too.
pub fn sample(model: &str, rng: &mut SplitMix64) -> Option<(f64, Vec<f64>)> {
    Some(match model {
        "charged-particle" | "charged-particle-induction" => {
            let t = rng.uniform(0.0, 3.0);
            let mut y = vec![rng.uniform(0.5, 2.0)];
            y.extend(rng.normals(3));
            (t, y)
        }
        "damped-oscillator" | "damped-oscillator-scaled-frame" => (rng.uniform(0.0, 3.0), rng.normals(2)),
        "euler-top" => (0.0, rng.normals(3)),
        "heavy-top-euler" | "heavy-top-euler-symmetric" => {
            let mut y: Vec<f64> = (0..3).map(|_| rng.uniform(0.4, 2.6)).collect();
            y.extend(rng.normals(3));
            (0.0, y)
        }
        "heavy-top-goryachev-chaplygin" | "heavy-top-kovalevskaya" | "heavy-top-lagrange" => {
            (0.0, rng.normals(6))
        }
        "heavy-top-quaternion" => (0.0, rng.normals(7)),
        "relativistic-particle" => {
            let (radius, angle) = (rng.uniform(0.5, 2.0), rng.normal());
            let (speed, direction) = (rng.uniform(0.0, 1.8), rng.uniform(0.0, std::f64::consts::TAU));
            (0.0, vec![radius, angle, speed * direction.cos(), speed * direction.sin()])
        }
        "rigid-body-spring" => {
            let mut y = rng.normals(13);
            let length = y[3..7].iter().map(|q| q * q).sum::<f64>().sqrt();
            y[3..7].iter_mut().for_each(|q| *q /= length);
            (0.0, y)
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{self, derivative};

    fn assert_tangent(model: &str, motion: impl Fn(f64) -> Vec<f64>, times: &[f64]) {
        let f = classical(model).expect(model);
        for &t in times {
            let y = motion(t);
            let mut dy = vec![0.0; y.len()];
            f(t, &y, &mut dy);
            for i in 0..y.len() {
                let slope = derivative(|t| motion(t)[i], t);
                assert!(
                    (slope - dy[i]).abs() < 1e-10,
                    "{model}, component {i}, t = {t}: {slope} instead of {}",
                    dy[i]
                );
            }
        }
    }

    #[test]
    fn closed_forms_satisfy_the_classical_equations() {
        let times = [0.1, 0.7, 1.9, 3.3, 4.8];
        assert_tangent("euler-top", |t| closed_form::euler_top(t).to_vec(), &times);
        assert_tangent("euler-top", |t| closed_form::euler_top_separatrix(t).to_vec(), &times);
        assert_tangent("charged-particle", |t| closed_form::charged_particle(2.0, t).to_vec(), &times);
        assert_tangent("damped-oscillator", |t| closed_form::damped_oscillator(t).to_vec(), &times);
        let scaled = |t: f64| {
            let [x, velocity] = closed_form::damped_oscillator(t);
            vec![x, (t / 4.0).exp() * (velocity - x / 4.0)]
        };
        assert_tangent("damped-oscillator-scaled-frame", scaled, &times);
    }

    /// Any motion of Euler's top, not the tabulated one alone.
    #[test]
    fn elliptic_motion_of_a_general_body_satisfies_eulers_equations() {
        let inertia = [0.7, 1.1, 2.3];
        let motion = |t| closed_form::euler_top_elliptic(inertia, 4.1, 5.9, t);
        for t in [0.0, 0.4, 2.2] {
            let mut dy = [0.0; 3];
            euler_top(inertia, &motion(t), &mut dy);
            for i in 0..3 {
                assert!((derivative(|t| motion(t)[i], t) - dy[i]).abs() < 1e-10, "t = {t}");
            }
        }
    }

    /// dy/dt = dy/dφ φ̇ along the rosette.
    #[test]
    fn relativistic_orbit_satisfies_the_classical_equations() {
        let f = classical("relativistic-particle").expect("listed");
        for angle in [0.2, 1.3, 3.0, 5.5] {
            let y = closed_form::relativistic_state(angle);
            let mut dy = [0.0; 4];
            f(0.0, &y, &mut dy);
            for i in 0..4 {
                let slope = derivative(|angle| closed_form::relativistic_state(angle)[i], angle) * dy[1];
                assert!((slope - dy[i]).abs() < 1e-10, "component {i} at φ = {angle}");
            }
        }
    }

    /// θ̈ of the equations is θ̈ of the closed form, for any angle φ of the symmetric body.
    #[test]
    fn nutation_of_the_symmetric_top_satisfies_the_classical_equations() {
        let f = classical("heavy-top-euler-symmetric").expect("listed");
        let nutation = closed_form::symmetric_top_nutation;
        for (t, phi) in [(0.3, 0.0_f64), (0.9, 0.7), (2.0, 2.9), (3.1, -1.4)] {
            let (theta, rate) = (nutation(t), derivative(nutation, t));
            // I_1 ψ̇ sin²θ + I_3 ω_3 cos θ keeps its value at the start, where ψ̇ = 0
            let precession = 0.5 * 4.0 * (0.5_f64.cos() - theta.cos()) / theta.sin().powi(2);
            let (sin_phi, cos_phi) = phi.sin_cos();
            let omega = [
                precession * theta.sin() * sin_phi + rate * cos_phi,
                precession * theta.sin() * cos_phi - rate * sin_phi,
            ];
            let mut dy = [0.0; 6];
            f(t, &[0.0, theta, phi, omega[0], omega[1], 4.0], &mut dy);
            assert!((dy[0] - precession).abs() < 1e-11 && (dy[1] - rate).abs() < 1e-11);
            let acceleration =
                dy[3] * cos_phi - dy[4] * sin_phi - dy[2] * (omega[0] * sin_phi + omega[1] * cos_phi);
            // a difference of differences: 1e-16 twice divided by the step 1e-2
            assert!((acceleration - derivative(|t| derivative(nutation, t), t)).abs() < 1e-9, "t = {t}");
        }
    }

    /// The three descriptions of one top give the same γ̇ and ω̇.
    #[test]
    fn descriptions_of_the_heavy_top_agree() {
        let mut rng = SplitMix64::new(1);
        for _ in 0..20 {
            let (_, y) = sample("heavy-top-euler", &mut rng).expect("listed");
            let vertical = |psi_theta_phi: &[f64]| {
                let (theta, phi) = (psi_theta_phi[1], psi_theta_phi[2]);
                [theta.sin() * phi.sin(), theta.sin() * phi.cos(), theta.cos()]
            };
            let (mut angles, mut poisson) = ([0.0; 6], [0.0; 6]);
            TRIAXIAL.in_euler_angles(&y, &mut angles);
            let mut state = vertical(&y).to_vec();
            state.extend(&y[3..]);
            TRIAXIAL.in_poisson_variables(&state, &mut poisson);
            assert_eq!(angles[3..], poisson[3..]);
            for i in 0..3 {
                let along = |s: f64| vertical(&std::array::from_fn::<f64, 3, _>(|j| y[j] + s * angles[j]))[i];
                assert!((derivative(along, 0.0) - poisson[i]).abs() < 1e-10);
            }

            let (_, y) = sample("heavy-top-quaternion", &mut rng).expect("listed");
            let vertical = |q: &[f64]| {
                let [a, b, c, d] = [q[0], q[1], q[2], q[3]];
                [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d]
            };
            let mut quaternion = [0.0; 7];
            TRIAXIAL.in_quaternion(&y, &mut quaternion);
            let mut state = vertical(&y).to_vec();
            state.extend(&y[4..]);
            TRIAXIAL.in_poisson_variables(&state, &mut poisson);
            assert_eq!(quaternion[4..], poisson[3..]);
            for i in 0..3 {
                let along =
                    |s: f64| vertical(&std::array::from_fn::<f64, 4, _>(|j| y[j] + s * quaternion[j]))[i];
                let error = (derivative(along, 0.0) - poisson[i]).abs();
                assert!(error < 1e-10 * (1.0 + poisson[i].abs()), "{error:e}");
            }
        }
    }

    #[test]
    fn samples_are_repeatable_and_regular() {
        for &model in MODELS {
            let f = classical(model).expect(model);
            let (mut rng, mut again) = (SplitMix64::new(7), SplitMix64::new(7));
            for _ in 0..100 {
                let (t, y) = sample(model, &mut rng).expect(model);
                assert_eq!(sample(model, &mut again), Some((t, y.clone())));
                let mut dy = vec![f64::NAN; y.len()];
                f(t, &y, &mut dy);
                assert!(dy.iter().all(|rate| rate.is_finite()), "{model} at t = {t}, {y:?}");
            }
        }
        assert!(classical("no such model").is_none());
        assert!(sample("no such model", &mut SplitMix64::new(0)).is_none());
    }

    /// The first numbers from the seed 1234567, as published with the generator.
    #[test]
    fn generator_is_splitmix64() {
        let mut rng = SplitMix64::new(1_234_567);
        assert_eq!(rng.next_bits(), 6_457_827_717_110_365_317);
        assert_eq!(rng.next_bits(), 3_203_168_211_198_807_973);
    }
}
