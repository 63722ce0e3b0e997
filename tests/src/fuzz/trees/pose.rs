//! Rotations and places, in numbers and as text.

use super::generator::{Body, Kind, Tree};

pub(super) type Vector = [f64; 3];
pub(super) type Matrix = [[f64; 3]; 3];

pub(super) fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

pub(super) fn applied(a: &Matrix, v: &Vector) -> Vector {
    std::array::from_fn(|i| (0..3).map(|k| a[i][k] * v[k]).sum())
}

pub(super) fn transposed(a: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

pub(super) fn sum(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

pub(super) fn unit(axis: &Vector) -> Vector {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    axis.map(|x| x / length)
}

/// cos α 1 + sin α [n]× + (1 − cos α) n nᵀ for a unit vector n (Rodrigues).
pub(super) fn about(n: &Vector, angle: f64) -> Matrix {
    let (sin, cos) = angle.sin_cos();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| cos * delta(i, j) + sin * cross(n, i, j) + (1.0 - cos) * n[i] * n[j])
    })
}

fn delta(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}

/// ([n]×)ᵢⱼ
fn cross(n: &Vector, i: usize, j: usize) -> f64 {
    match (3 + j - i) % 3 {
        0 => 0.0,
        1 => -n[3 - i - j],
        _ => n[3 - i - j],
    }
}

/// The rotation of turns about axes, each as turned by those before it.
pub(super) fn turned(turns: &[(usize, f64)]) -> Matrix {
    let axis = |axis: usize| std::array::from_fn(|i| delta(i, axis));
    turns
        .iter()
        .fold(about(&axis(0), 0.0), |all, &(number, angle)| product(&all, &about(&axis(number), angle)))
}

/// The same as [`about`], of an angle with a name.
pub(super) fn about_written(n: &Vector, angle: &str) -> [[String; 3]; 3] {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let (cos, sin, rest) = (delta(i, j), cross(n, i, j), n[i] * n[j]);
            format!("({cos:?}*cos({angle}) + ({sin:?})*sin({angle}) + ({rest:?})*(1 - cos({angle})))")
        })
    })
}

/// The rotation of a unit quaternion, scalar part first.
pub(super) fn of_quaternion(q: &[f64]) -> Matrix {
    let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// Where the joint of a body has moved it at the start, in axes of the joint.
fn moved(body: &Body) -> (Matrix, Vector) {
    let still = about(&[1.0, 0.0, 0.0], 0.0);
    let along = |n: &Vector, by: f64| n.map(|n| n * by);
    let (x, n) = (&body.x, unit(&body.axes[0]));
    match body.kind {
        Kind::Fixed => (still, [0.0; 3]),
        Kind::Revolute => (about(&n, x[0]), [0.0; 3]),
        Kind::Prismatic => (still, along(&n, x[0])),
        Kind::Screw => (about(&n, x[0]), along(&n, body.pitch * x[0])),
        Kind::Cylindrical => (about(&n, x[1]), along(&n, x[0])),
        Kind::Universal => (product(&about(&n, x[0]), &about(&unit(&body.axes[1]), x[1])), [0.0; 3]),
        Kind::Planar => {
            let normal = body.normal();
            let mut place = [0.0; 3];
            (place[(normal + 1) % 3], place[(normal + 2) % 3]) = (x[0], x[1]);
            (about(&n, x[2]), place)
        }
        Kind::Spherical => (of_quaternion(x), [0.0; 3]),
        Kind::Free => (of_quaternion(&x[3..]), [x[0], x[1], x[2]]),
    }
}

/// Rotation and origin of each body at the start.
pub(super) fn at_start(tree: &Tree) -> Vec<(Matrix, Vector)> {
    let mut poses: Vec<(Matrix, Vector)> = Vec::new();
    for body in &tree.bodies {
        let (rotation, origin) =
            body.parent.map_or((about(&[1.0, 0.0, 0.0], 0.0), [0.0; 3]), |parent| poses[parent]);
        let (turn, shift) = moved(body);
        let joint = turned(&body.turns);
        let place = applied(&rotation, &sum(&body.at, &applied(&joint, &shift)));
        poses.push((product(&product(&rotation, &joint), &turn), sum(&origin, &place)));
    }
    poses
}
