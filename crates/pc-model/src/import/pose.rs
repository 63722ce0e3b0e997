//! Positions and rotations of frames.

/// A rotation matrix, row by row.
pub(crate) type Rotation = [[f64; 3]; 3];

/// A position, and rotations by roll, pitch and yaw about the fixed axes x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pose {
    pub(crate) xyz: [f64; 3],
    pub(crate) rpy: [f64; 3],
}

impl Pose {
    /// The pose at a position, with a rotation.
    pub(crate) fn new(xyz: [f64; 3], rotation: &Rotation) -> Pose {
        Pose { xyz: tidy(xyz), rpy: angles(rotation) }
    }

    /// R = Rz(yaw) Ry(pitch) Rx(roll).
    pub(crate) fn rotation(&self) -> Rotation {
        let [roll, pitch, yaw] = self.rpy;
        product(&about(2, yaw), &product(&about(1, pitch), &about(0, roll)))
    }
}

/// A B.
pub(crate) fn product(a: &Rotation, b: &Rotation) -> Rotation {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|l| a[i][l] * b[l][j]).sum()))
}

/// Rᵀ.
pub(crate) fn transposed(r: &Rotation) -> Rotation {
    std::array::from_fn(|i| std::array::from_fn(|j| r[j][i]))
}

/// The rotation by an angle about an axis of the frame.
pub(crate) fn about(axis: usize, angle: f64) -> Rotation {
    let (sin, cos) = angle.sin_cos();
    match axis {
        0 => [[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]],
        1 => [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]],
        _ => [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]],
    }
}

/// The rotation of a quaternion of any length but 0, scalar last.
pub(crate) fn of_quaternion([x, y, z, w]: [f64; 4]) -> Rotation {
    let two = 2.0 / (x * x + y * y + z * z + w * w);
    let square = |a: f64, b: f64| 1.0 - two * (a * a + b * b);
    [
        [square(y, z), two * (x * y - z * w), two * (x * z + y * w)],
        [two * (x * y + z * w), square(x, z), two * (y * z - x * w)],
        [two * (x * z - y * w), two * (y * z + x * w), square(x, y)],
    ]
}

/// Roll, pitch and yaw of a rotation. The yaw is found first, then the roll of what is left, which is well
/// determined near a pitch of ±π/2, too.
pub(crate) fn angles(r: &Rotation) -> [f64; 3] {
    let level = r[0][0].hypot(r[1][0]);
    let yaw = if level < 1e-12 { 0.0 } else { r[1][0].atan2(r[0][0]) };
    let (sin, cos) = yaw.sin_cos();
    let pitch = (-r[2][0]).atan2(cos * r[0][0] + sin * r[1][0]);
    let roll = (sin * r[0][2] - cos * r[1][2]).atan2(cos * r[1][1] - sin * r[0][1]);
    [roll, pitch, yaw].map(|angle| if angle.abs() < 1e-15 { 0.0 } else { angle })
}

/// The vector without components that are rounding errors of the largest one.
pub(crate) fn tidy(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    v.map(|part| if part.abs() <= 4.0 * f64::EPSILON * largest { 0.0 } else { part })
}
