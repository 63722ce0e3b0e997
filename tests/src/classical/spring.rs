//! A free rigid body on a spring.

use super::tops::{Vector, cross, vector};

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
    /// [`HeavyTop::in_quaternion`](super::HeavyTop::in_quaternion), I ω̇ = Iω × ω + a × RᵀF, v̇ = v × ω + RᵀF/m with F = −κ (r + R a)
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
