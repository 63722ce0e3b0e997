//! Pendulums in Cartesian coordinates.

const GRAVITY: f64 = 10.0;

/// The plane double pendulum of masses m_1, m_2 in their Cartesian coordinates x = (x_1, y_1, x_2, y_2), y upwards.
///
/// The lengths of the links are those that the coordinates have.
#[derive(Clone, Copy, Debug)]
pub struct DoublePendulum {
    /// The masses m_1, m_2.
    pub masses: [f64; 2],
}

impl DoublePendulum {
    /// Angular accelerations of the two links at place x and rates θ̇; with r_1 = (x_1, y_1), r_2 = (p, r) from the
    /// first mass to the second,
    /// (m_1 + m_2) |r_1|² θ̈_1 + m_2 r_1·r_2 θ̈_2 = m_2 (r_1 × r_2) θ̇_2² − (m_1 + m_2) g x_1,
    /// m_2 r_1·r_2 θ̈_1 + m_2 |r_2|² θ̈_2 = −m_2 (r_1 × r_2) θ̇_1² − m_2 g p.
    fn angular_accelerations(&self, x: &[f64], rate: [f64; 2]) -> [f64; 2] {
        let [first, second] = self.masses;
        let (p, r) = (x[2] - x[0], x[3] - x[1]);
        let (along, across) = (x[0] * p + x[1] * r, x[0] * r - x[1] * p);
        let (a, b, c) =
            ((first + second) * (x[0] * x[0] + x[1] * x[1]), second * along, second * (p * p + r * r));
        let f = [
            second * across * rate[1] * rate[1] - (first + second) * GRAVITY * x[0],
            -second * across * rate[0] * rate[0] - second * GRAVITY * p,
        ];
        let determinant = a * c - b * b;
        [(c * f[0] - b * f[1]) / determinant, (a * f[1] - b * f[0]) / determinant]
    }

    /// y = (x, ẋ_1, ẋ_2): θ̇_1 = −ẋ_1/y_1 and θ̇_2 = −(ẋ_2 − ẋ_1)/(y_2 − y_1), by which
    /// ẍ_1 = −y_1 θ̈_1 − x_1 θ̇_1², ẍ_2 = ẍ_1 − (y_2 − y_1) θ̈_2 − (x_2 − x_1) θ̇_2².
    pub fn by_horizontal_velocities(&self, y: &[f64], dy: &mut [f64]) {
        let (p, r) = (y[2] - y[0], y[3] - y[1]);
        let rate = [-y[4] / y[1], -(y[5] - y[4]) / r];
        let [first, second] = self.angular_accelerations(y, rate);
        dy[0] = y[4];
        dy[1] = y[0] * rate[0];
        dy[2] = y[5];
        dy[3] = y[0] * rate[0] + p * rate[1];
        dy[4] = -first * y[1] - rate[0] * rate[0] * y[0];
        dy[5] = dy[4] - second * r - rate[1] * rate[1] * p;
    }

    /// y = (x, θ̇_1, θ̇_2): ẋ_1 = −y_1 θ̇_1, ẏ_1 = x_1 θ̇_1, and for the second mass likewise about the first.
    pub fn by_rates_of_links(&self, y: &[f64], dy: &mut [f64]) {
        let rate = [y[4], y[5]];
        dy[0] = -y[1] * rate[0];
        dy[1] = y[0] * rate[0];
        dy[2] = dy[0] - (y[3] - y[1]) * rate[1];
        dy[3] = dy[1] + (y[2] - y[0]) * rate[1];
        dy[4..].copy_from_slice(&self.angular_accelerations(y, rate));
    }
}

/// The spherical pendulum with y = (r, ẋ, ẏ), z upwards: r̈ = −g e_z + λ r with λ = (gz − |ṙ|²)/|r|², ż = −(xẋ + yẏ)/z.
pub fn spherical_pendulum(y: &[f64], dy: &mut [f64]) {
    let [x, across, z, u, v] = [y[0], y[1], y[2], y[3], y[4]];
    let rise = -(x * u + across * v) / z;
    let lambda = (GRAVITY * z - u * u - v * v - rise * rise) / (x * x + across * across + z * z);
    dy.copy_from_slice(&[u, v, rise, lambda * x, lambda * across]);
}

/// The spherical pendulum with y = (r, η_1, η_2), velocities down the meridian and along the parallel:
/// R² η̇_1 = zη_2²/ρ + gρ, η̇_2 = −zη_1η_2/ρ, R² = |r|², ρ² = x² + y².
pub fn spherical_pendulum_on_meridians(y: &[f64], dy: &mut [f64]) {
    let [x, across, z, down, along] = [y[0], y[1], y[2], y[3], y[4]];
    let rho = x.hypot(across);
    dy[0] = (x * z * down - across * along) / rho;
    dy[1] = (across * z * down + x * along) / rho;
    dy[2] = -rho * down;
    dy[3] = (z * along * along / rho + GRAVITY * rho) / (rho * rho + z * z);
    dy[4] = -z * down * along / rho;
}
