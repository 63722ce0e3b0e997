//! Moments of inertia in other axes and about other points, and whether a body can have them.

use crate::import::pose::{Pose, Rotation, product, transposed};
use crate::import::robot::Inertial;

/// The matrix of six entries Ixx, Iyy, Izz, Ixy, Iyz, Ixz.
pub(crate) fn matrix([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> Rotation {
    [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
}

/// Ixx, Iyy, Izz, Ixy, Iyz, Ixz of a matrix.
fn entries(matrix: &Rotation) -> [f64; 6] {
    [matrix[0][0], matrix[1][1], matrix[2][2], matrix[0][1], matrix[1][2], matrix[0][2]]
}

/// The inertia matrix R I Rᵀ, where R is the rotation of the inertial's origin.
pub(crate) fn along_axes_of_the_link(inertial: &Inertial) -> [f64; 6] {
    if inertial.origin.rpy == [0.0; 3] {
        return inertial.inertia;
    }
    let r = inertial.origin.rotation();
    let turned = entries(&product(&r, &product(&matrix(inertial.inertia), &transposed(&r))));
    let largest = turned.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    turned.map(|entry| if entry.abs() <= 4.0 * f64::EPSILON * largest { 0.0 } else { entry })
}

/// One body made of several: masses add up, the mass centre is their mean, and the moments about it are
/// Σ (R I Rᵀ + m (r² − r rᵀ)).
pub(crate) fn joined(parts: &[Inertial]) -> Option<Inertial> {
    if let [part] = parts {
        return Some(part.clone());
    }
    let mass: f64 = parts.iter().map(|part| part.mass).sum();
    if parts.is_empty() {
        return None;
    }
    let center: [f64; 3] = std::array::from_fn(|i| {
        let moment: f64 = parts.iter().map(|part| part.mass * part.origin.xyz[i]).sum();
        if mass == 0.0 { 0.0 } else { moment / mass }
    });
    let mut inertia = [0.0; 6];
    for part in parts {
        let [x, y, z] = std::array::from_fn(|i| part.origin.xyz[i] - center[i]);
        let steiner = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -y * z, -x * z];
        for ((entry, own), arm) in inertia.iter_mut().zip(along_axes_of_the_link(part)).zip(steiner) {
            *entry += own + part.mass * arm;
        }
    }
    Some(Inertial { origin: Pose::at(center), mass, inertia })
}

/// The principal moments, in ascending order, by Jacobi's rotations.
fn principal_moments(inertia: [f64; 6]) -> [f64; 3] {
    let mut a = matrix(inertia);
    for _ in 0..30 {
        for (p, q) in [(0, 1), (1, 2), (0, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let angle = 0.5 * (2.0 * a[p][q]).atan2(a[q][q] - a[p][p]);
            let (sin, cos) = angle.sin_cos();
            let mut turn: Rotation = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
            (turn[p][p], turn[q][q], turn[p][q], turn[q][p]) = (cos, cos, sin, -sin);
            a = product(&transposed(&turn), &product(&a, &turn));
        }
    }
    let mut moments = [a[0][0], a[1][1], a[2][2]];
    moments.sort_by(f64::total_cmp);
    moments
}

/// The principal moments that no body has: one of them is negative or larger than the sum of the others, by
/// more than the digits of a file leave open.
pub(crate) fn impossible(inertial: &Inertial) -> Option<[f64; 3]> {
    let moments = principal_moments(inertial.inertia);
    let [a, b, c] = moments;
    let open = 1e-6 * c.abs();
    (a < -open || c > a + b + open).then_some(moments)
}
