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
        Pose { xyz: settled(xyz), rpy: angles(rotation) }
    }

    /// A pose without rotation.
    pub(crate) fn at(xyz: [f64; 3]) -> Pose {
        Pose { xyz, rpy: [0.0; 3] }
    }

    /// The pose to fifteen digits, without the rounding errors of frames that were put together.
    pub(crate) fn tidied(&self) -> Pose {
        Pose { xyz: tidy(self.xyz), rpy: self.rpy.map(|angle| rounded(angle, 1.0)) }
    }

    /// R = Rz(yaw) Ry(pitch) Rx(roll).
    pub(crate) fn rotation(&self) -> Rotation {
        let [roll, pitch, yaw] = self.rpy;
        product(&about(2, yaw), &product(&about(1, pitch), &about(0, roll)))
    }

    /// The pose in the frame F of what has the pose `inner` in the frame at this pose of F:
    /// p = p_1 + R_1 p_2, R = R_1 R_2.
    pub(crate) fn then(&self, inner: &Pose) -> Pose {
        if self.rpy == [0.0; 3] {
            return Pose { xyz: settled(sum(self.xyz, inner.xyz)), rpy: inner.rpy };
        }
        let own = self.rotation();
        let xyz = sum(self.xyz, applied(&own, inner.xyz));
        if inner.rpy == [0.0; 3] {
            return Pose { xyz: settled(xyz), rpy: self.rpy };
        }
        Pose::new(xyz, &product(&own, &inner.rotation()))
    }

    /// The pose of the frame F in the frame at this pose of F: p = −Rᵀ p_1, R = R_1ᵀ.
    pub(crate) fn inverse(&self) -> Pose {
        let back = transposed(&self.rotation());
        let xyz = applied(&back, self.xyz).map(|part| 0.0 - part);
        match self.rpy == [0.0; 3] {
            true => Pose::at(xyz),
            false => Pose::new(xyz, &back),
        }
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

/// R v.
pub(crate) fn applied(r: &Rotation, v: [f64; 3]) -> [f64; 3] {
    r.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// v + w.
pub(crate) fn sum(v: [f64; 3], w: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| v[i] + w[i])
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
    [roll, pitch, yaw].map(|angle| if angle.abs() < 1e-14 { 0.0 } else { angle })
}

/// The vector without components that are rounding errors of the largest one.
fn settled(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    v.map(|part| if part.abs() <= 1e-14 * largest { 0.0 } else { part })
}

/// The components to fifteen digits of the largest one.
pub(crate) fn tidy(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0_f64, |largest, part| largest.max(part.abs()));
    v.map(|part| rounded(part, largest))
}

/// The number to fifteen digits of another one.
fn rounded(number: f64, largest: f64) -> f64 {
    let decimals = 15_i64.saturating_sub(largest.log10().ceil() as i64);
    match usize::try_from(decimals) {
        Ok(decimals @ 0..=300) => {
            let rounded: f64 = format!("{number:.decimals$}").parse().unwrap_or(number);
            if rounded == 0.0 { 0.0 } else { rounded }
        }
        _ => number,
    }
}

/// The rotation by an angle about an axis of any length but 0: R = 1 + sin φ N + (1 − cos φ) N².
pub(crate) fn about_axis(axis: [f64; 3], angle: f64) -> Rotation {
    let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
    let half = angle / 2.0;
    let [x, y, z] = axis.map(|part| part / length * half.sin());
    of_quaternion([x, y, z, half.cos()])
}

/// The rotation about a horizontal axis that turns z into a direction.
pub(crate) fn shortest_from_z(direction: [f64; 3]) -> Rotation {
    let length = direction.iter().map(|part| part * part).sum::<f64>().sqrt();
    let [x, y, z] = direction.map(|part| part / length);
    match x == 0.0 && y == 0.0 {
        true if z < 0.0 => about(0, std::f64::consts::PI),
        true => about(0, 0.0),
        false => about_axis([-y, x, 0.0], x.hypot(y).atan2(z)),
    }
}
