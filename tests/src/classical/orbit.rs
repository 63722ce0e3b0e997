//! A rigid body in the field of a centre of attraction.

use super::tops::cross;

type Vector = [f64; 3];
type Rotation = [Vector; 3];

fn dot(u: Vector, v: Vector) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

fn times(matrix: &Rotation, v: Vector) -> Vector {
    matrix.map(|row| dot(row, v))
}

fn transposed(matrix: &Rotation) -> Rotation {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]))
}

/// The body axes in space, as columns, of a unit quaternion: v + 2q_0 q × v + 2q × (q × v) for v = e_j [Rodrigues 1840].
fn rotation(quaternion: &[f64]) -> Rotation {
    let (scalar, part) = (quaternion[0], [quaternion[1], quaternion[2], quaternion[3]]);
    let axes: Rotation = std::array::from_fn(|j| {
        let axis: Vector = std::array::from_fn(|i| f64::from(u8::from(i == j)));
        let once = cross(part, axis);
        let twice = cross(part, once);
        std::array::from_fn(|i| axis[i] + 2.0 * (scalar * once[i] + twice[i]))
    });
    transposed(&axes)
}

/// A rigid body near a centre with μ = 1, in the first approximation that feels its shape.
#[derive(Clone, Copy, Debug)]
pub struct Satellite {
    /// Principal moments of inertia I at the mass centre.
    pub inertia: [f64; 3],
    /// Mass m.
    pub mass: f64,
}

impl Satellite {
    /// Force F in space axes and torque N in body axes at the place r of a body with the axes R:
    /// with n = r/ρ and n_b = Rᵀn, F = −[m/ρ² + 3 (tr I − 5 n_b·I n_b)/(2ρ⁴)] n − (3/ρ⁴) R I n_b,
    /// N = (3/ρ³) n_b × I n_b.
    fn load(&self, place: Vector, axes: &Rotation) -> [Vector; 2] {
        let distance = dot(place, place).sqrt();
        let direction = place.map(|r| r / distance);
        let seen = times(&transposed(axes), direction);
        let moment: Vector = std::array::from_fn(|i| self.inertia[i] * seen[i]);
        let turned = times(axes, moment);
        let (square, trace) = (distance * distance, self.inertia.iter().sum::<f64>());
        let central = (self.mass + 1.5 * (trace - 5.0 * dot(seen, moment)) / square) / square;
        let force = std::array::from_fn(|i| -central * direction[i] - 3.0 * turned[i] / (square * square));
        [force, cross(seen, moment).map(|torque| 3.0 * torque / (square * distance))]
    }

    /// y = (r, q, ω, v), r in space, q a unit quaternion, scalar first, ω and v on the body axes:
    /// ṙ = R v, q̇ = ½ q ∘ ω, Iω̇ = Iω × ω + N, m (v̇ − v × ω) = RᵀF [Newton; Euler].
    pub fn in_gravity_gradient(&self, y: &[f64], dy: &mut [f64]) {
        let triple = |from: usize| [y[from], y[from + 1], y[from + 2]];
        let (place, part, omega, velocity) = (triple(0), triple(4), triple(7), triple(10));
        let axes = rotation(&y[3..7]);
        let [force, torque] = self.load(place, &axes);
        let momentum: Vector = std::array::from_fn(|i| self.inertia[i] * omega[i]);
        let (gyroscopic, turned) = (cross(momentum, omega), cross(velocity, omega));
        let (pull, across) = (times(&transposed(&axes), force), cross(part, omega));
        dy[..3].copy_from_slice(&times(&axes, velocity));
        dy[3] = -dot(part, omega) / 2.0;
        for i in 0..3 {
            dy[4 + i] = (y[3] * omega[i] + across[i]) / 2.0;
            dy[7 + i] = (gyroscopic[i] + torque[i]) / self.inertia[i];
            dy[10 + i] = turned[i] + pull[i] / self.mass;
        }
    }
}
