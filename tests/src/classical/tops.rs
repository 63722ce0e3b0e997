//! Rigid bodies with a fixed point, and one in orbit.

pub(super) type Vector = [f64; 3];

pub(super) fn vector(slice: &[f64]) -> Vector {
    [slice[0], slice[1], slice[2]]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
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
