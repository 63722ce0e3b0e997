//! Vectors in space, and the corners of what is drawn.

use std::f64::consts::TAU;

/// The number of corners with which a circle is drawn.
pub(super) const CORNERS: usize = 48;

/// The vector of the three numbers from index `i` on.
pub(super) fn vector(numbers: &[f32], i: usize) -> [f64; 3] {
    [numbers[i], numbers[i + 1], numbers[i + 2]].map(f64::from)
}

/// |a|.
pub(super) fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// a × b.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a / |a|; 0 for the vector 0.
pub(super) fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = length(a);
    a.map(|x| if length > 0.0 { x / length } else { 0.0 })
}

/// The point `at` + R v, with R given row by row.
pub(super) fn turned(at: [f64; 3], rotation: &[f32], v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let row = vector(rotation, 3 * k);
        at[k] + row[0] * v[0] + row[1] * v[1] + row[2] * v[2]
    })
}

/// The points of the rim of a disc perpendicular to a normal.
pub(super) fn rim(middle: [f64; 3], normal: [f64; 3], radius: f64) -> impl Iterator<Item = [f64; 3]> {
    let n = unit(normal);
    let a = unit(cross(n, if n[0].abs() > 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] }));
    let b = cross(n, a);
    (0..CORNERS).map(move |i| {
        let (sin, cos) = (TAU * i as f64 / CORNERS as f64).sin_cos();
        [0, 1, 2].map(|k| middle[k] + radius * (cos * a[k] + sin * b[k]))
    })
}

/// The corners of a box; the bits of each index select the ends of its edges.
pub(super) fn corners_of_box(numbers: &[f32]) -> [[f64; 3]; 8] {
    let (at, edges) = (vector(numbers, 0), vector(numbers, 3));
    std::array::from_fn(|bits| {
        let end = |k: usize| ((bits >> k & 1) as f64 - 0.5) * edges[k];
        turned(at, &numbers[6..], [end(0), end(1), end(2)])
    })
}
