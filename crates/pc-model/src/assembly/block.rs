//! The homogeneous box with the mass and the inertia of a body, by which the body is drawn.

use pc_mech::{Matrix, SingularValues};

/// The least edge, as a fraction of the largest: a thin rod or disc remains visible.
const THIN: f64 = 0.02;

/// What is nothing beside the largest moment of inertia.
const NOTHING: f64 = 1e-9;

/// A box with edges along principal axes.
#[derive(Debug)]
pub(super) struct Block {
    pub(super) edges: [f64; 3],
    /// The principal axes, column by column, in components along the axes of the body.
    pub(super) axes: Matrix<f64>,
}

impl Block {
    /// From I_1 = m (a_2² + a_3²)/12 and cyclically, a_1² = 6 (I_2 + I_3 − I_1)/m. None without a positive mass and a moment of
    /// inertia, since nothing tells the size then.
    pub(super) fn of(mass: f64, inertia: &Matrix<f64>) -> Option<Block> {
        let (moments, axes) = principal(inertia)?;
        let sum: f64 = moments.iter().sum();
        let edges = moments.map(|moment| (6.0 * (sum - 2.0 * moment) / mass).max(0.0).sqrt());
        let largest = edges.iter().copied().fold(0.0, f64::max);
        let is_known = mass > 0.0 && sum > 0.0 && largest > 0.0 && largest.is_finite();
        is_known.then(|| Block { edges: edges.map(|edge| edge.max(THIN * largest)), axes })
    }
}

/// The principal moments and axes of a symmetric matrix, which has no negative eigenvalues; the axes of the body where these are
/// principal, and a right-handed system always.
fn principal(inertia: &Matrix<f64>) -> Option<([f64; 3], Matrix<f64>)> {
    let entry = |i: usize, j: usize| inertia[(i, j)];
    let largest = (0..3).map(|i| entry(i, i).abs()).fold(0.0, f64::max);
    let products = [(0, 1), (1, 2), (0, 2)];
    if products.iter().all(|&(i, j)| entry(i, j).abs() <= NOTHING * largest) {
        let unit = Matrix::from_fn(3, 3, |i, j| if i == j { 1.0 } else { 0.0 });
        return Some(([0, 1, 2].map(|i| entry(i, i)), unit));
    }
    let SingularValues { values, right, .. } = SingularValues::of(inertia).ok()?;
    let column = |j: usize| [0, 1, 2].map(|i| right[(i, j)]);
    let ([a, b], c) = ([column(0), column(1)], column(2));
    let across = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let handed: f64 = across.iter().zip(c).map(|(x, y)| x * y).sum::<f64>().signum();
    let axes = Matrix::from_fn(3, 3, |i, j| if j == 2 { handed * c[i] } else { right[(i, j)] });
    Some(([values[0], values[1], values[2]], axes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The moments of a box of 1 kg with edges 1, 2 and 3.
    const MOMENTS: [f64; 3] = [(4.0 + 9.0) / 12.0, (9.0 + 1.0) / 12.0, (1.0 + 4.0) / 12.0];

    fn near(found: [f64; 3], expected: [f64; 3]) -> bool {
        found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-12)
    }

    #[test]
    fn a_box_has_its_own_edges() {
        let inertia = Matrix::from_fn(3, 3, |i, j| if i == j { 2.0 * MOMENTS[i] } else { 0.0 });
        let block = Block::of(2.0, &inertia).unwrap();
        assert!(near(block.edges, [1.0, 2.0, 3.0]), "{block:?}");
        assert!(Block::of(0.0, &inertia).is_none() && Block::of(-1.0, &inertia).is_none());
        assert!(Block::of(1.0, &Matrix::from_fn(3, 3, |_, _| 0.0)).is_none());
    }

    /// Turned by 0.3 about the third axis: I = R diag(I_k) Rᵀ, whose principal axes are the columns of R.
    #[test]
    fn a_turned_box_has_the_same_edges_along_turned_axes() {
        let (sin, cos) = 0.3f64.sin_cos();
        let r = [[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]];
        let inertia = Matrix::from_fn(3, 3, |i, j| (0..3).map(|k| r[i][k] * MOMENTS[k] * r[j][k]).sum());
        let block = Block::of(1.0, &inertia).unwrap();
        // In the order of descending moments, which is that of ascending edges.
        assert!(near(block.edges, [1.0, 2.0, 3.0]), "{block:?}");
        for k in 0..3 {
            let along: f64 = (0..3).map(|i| block.axes[(i, k)] * r[i][k]).sum();
            assert!((along.abs() - 1.0).abs() < 1e-12, "{block:?}");
        }
        let axis = |i: usize, j: usize| block.axes[(i, j)];
        let determinant: f64 = (0..3)
            .map(|j| {
                let (k, l) = ((j + 1) % 3, (j + 2) % 3);
                axis(0, j) * (axis(1, k) * axis(2, l) - axis(1, l) * axis(2, k))
            })
            .sum();
        assert!((determinant - 1.0).abs() < 1e-12, "{block:?}");
    }

    /// A rod has no width, and is drawn with a little.
    #[test]
    fn a_rod_is_thin() {
        let rod = Matrix::from_fn(3, 3, |i, j| if i == j && i > 0 { 1.0 / 12.0 } else { 0.0 });
        assert!(near(Block::of(1.0, &rod).unwrap().edges, [1.0, THIN, THIN]));
    }
}
