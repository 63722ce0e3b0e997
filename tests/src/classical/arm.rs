//! An arm whose tool slides along a wall.

use nalgebra::{Matrix4, Vector4};

use super::random::SplitMix64;

const LENGTHS: [f64; 3] = [0.5, 0.4, 0.3];

/// How far the wall is.
const WALL: f64 = 0.7;

/// A random state of the arm with its elbow bent and its tool on the wall.
pub fn arm_sample(rng: &mut SplitMix64) -> [f64; 5] {
    loop {
        let (shoulder, elbow) = (rng.uniform(0.6, 1.2), rng.uniform(-1.3, -0.5));
        let left = WALL - LENGTHS[0] * shoulder.cos() - LENGTHS[1] * (shoulder + elbow).cos();
        let cosine = left / LENGTHS[2];
        if cosine.abs() < 0.95 {
            return [shoulder, elbow, cosine.acos() - shoulder - elbow, rng.normal(), rng.normal()];
        }
    }
}

/// y = (q, v, ω_3), v the velocity of the tool along the wall: for the directions φ_i = q_1 + … + q_i of the links
///
///   Σ_j M_ij φ̈_j = −Σ_j M'_ij φ̇_j² − g μ_i cos φ_i + τ_i − τ_{i+1} − λ l_i sin φ_i,   Σ_i (l_i sin φ_i)· φ̇_i = 0,
///
/// M_ij = μ_ij cos(φ_i − φ_j), M'_ij = μ_ij sin(φ_i − φ_j), as of any chain of slender rods, with the reaction λ of the wall
/// [Murray, Li and Sastry 1994, §6.1]; the four equations are solved together.
pub fn arm_on_wall(y: &[f64], dy: &mut [f64]) {
    let (masses, torques, g): ([f64; 3], _, _) = ([3.0, 2.0, 1.0], [25.0, 10.0, 2.0, 0.0], 9.81);
    let directions = [y[0], y[0] + y[1], y[0] + y[1] + y[2]];
    let (tool, last) = (y[3], y[4]);
    let up: [f64; 3] = std::array::from_fn(|i| LENGTHS[i] * directions[i].sin());
    let ahead: [f64; 3] = std::array::from_fn(|i| LENGTHS[i] * directions[i].cos());
    // Σ l_i sin φ_i φ̇_i = 0 and Σ l_i cos φ_i φ̇_i = v by Cramer's rule
    let determinant = up[0] * ahead[1] - up[1] * ahead[0];
    let (across, along) = (-up[2] * last, tool - ahead[2] * last);
    let rates = [
        (across * ahead[1] - up[1] * along) / determinant,
        (up[0] * along - ahead[0] * across) / determinant,
        last,
    ];
    let carried = |i: usize| masses[i + 1..].iter().sum::<f64>();
    let moment = |i: usize| LENGTHS[i] * (masses[i] / 2.0 + carried(i));
    let (mut matrix, mut right) = (Matrix4::zeros(), Vector4::zeros());
    for i in 0..3 {
        matrix[(i, i)] = LENGTHS[i] * LENGTHS[i] * (masses[i] / 3.0 + carried(i));
        right[i] = torques[i] - torques[i + 1] - g * moment(i) * directions[i].cos();
        for j in (0..3).filter(|&j| j != i) {
            let coupling = LENGTHS[i.min(j)] * moment(i.max(j));
            matrix[(i, j)] = coupling * (directions[i] - directions[j]).cos();
            right[i] -= coupling * (directions[i] - directions[j]).sin() * rates[j] * rates[j];
        }
        matrix[(i, 3)] = up[i];
        matrix[(3, i)] = up[i];
        right[3] -= ahead[i] * rates[i] * rates[i];
    }
    let solved = matrix.lu().solve(&right).unwrap_or_else(|| Vector4::repeat(f64::NAN));
    let rise: f64 = (0..3).map(|i| ahead[i] * solved[i] - up[i] * rates[i] * rates[i]).sum();
    dy.copy_from_slice(&[rates[0], rates[1] - rates[0], rates[2] - rates[1], rise, solved[2]]);
}
