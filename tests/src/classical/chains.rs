//! Chains: pendulums that hang on each other, bodies that repel their neighbours.

const GRAVITY: f64 = 10.0;

/// A pendulum of N links, of unit masses and lengths, with y = (θ, θ̇), i, j = 1..N:
/// Σ_j (N + 1 − max(i, j)) (cos(θ_i − θ_j) θ̈_j + sin(θ_i − θ_j) θ̇_j²) = −(N + 1 − i) g sin θ_i.
pub fn pendulum_chain(y: &[f64], dy: &mut [f64]) {
    let (angle, rate) = y.split_at(y.len() / 2);
    dy[..rate.len()].copy_from_slice(rate);
    let directions: Vec<[f64; 2]> = angle.iter().map(|angle| angle.sin_cos().into()).collect();
    dy[rate.len()..].copy_from_slice(&angular_accelerations(&directions, rate));
}

/// The same with y = (x_1, y_1, .., x_N, y_N, θ̇), y upwards: the links are d_i = (x_i − x_(i−1), y_i − y_(i−1)),
/// (ẋ_i, ẏ_i) = Σ_(j ≤ i) θ̇_j (−d_jy, d_jx), and sines and cosines of θ are those of the links.
pub fn pendulum_chain_in_the_plane(y: &[f64], dy: &mut [f64]) {
    let (place, rate) = y.split_at(y.len() / 3 * 2);
    let mut joint = [0.0; 2];
    let links: Vec<[f64; 2]> = place
        .chunks(2)
        .map(|end| {
            let link = [end[0] - joint[0], end[1] - joint[1]];
            joint = [end[0], end[1]];
            link
        })
        .collect();
    let mut velocity = [0.0; 2];
    for (i, link) in links.iter().enumerate() {
        velocity = [velocity[0] - link[1] * rate[i], velocity[1] + link[0] * rate[i]];
        dy[2 * i..2 * i + 2].copy_from_slice(&velocity);
    }
    let directions: Vec<[f64; 2]> = links.iter().map(|&[x, y]| [x, -y]).collect();
    dy[place.len()..].copy_from_slice(&angular_accelerations(&directions, rate));
}

/// θ̈ from (l_i sin θ_i, l_i cos θ_i) and θ̇, the links of lengths l_i: with them the products cos(θ_i − θ_j) of the
/// equations are those of the links, and g sin θ_i is g l_i sin θ_i.
fn angular_accelerations(directions: &[[f64; 2]], rate: &[f64]) -> Vec<f64> {
    let links = rate.len();
    let hanging = |i: usize, j: usize| (links - i.max(j)) as f64;
    let pair = |i: usize, j: usize| (directions[i], directions[j]);
    let cosine = |i: usize, j: usize| {
        let ([sin, cos], [other_sin, other_cos]) = pair(i, j);
        cos * other_cos + sin * other_sin
    };
    let sine = |i: usize, j: usize| {
        let ([sin, cos], [other_sin, other_cos]) = pair(i, j);
        sin * other_cos - cos * other_sin
    };
    let matrix = (0..links).map(|i| (0..links).map(|j| hanging(i, j) * cosine(i, j)).collect()).collect();
    let forces = (0..links).map(|i| {
        let centrifugal: f64 = (0..links).map(|j| hanging(i, j) * sine(i, j) * rate[j] * rate[j]).sum();
        -hanging(i, i) * GRAVITY * directions[i][0] - centrifugal
    });
    eliminate(matrix, forces.collect())
}

/// Solves a linear system by Gauss's elimination; the matrix is positive definite.
fn eliminate(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let size = right.len();
    for column in 0..size {
        for row in column + 1..size {
            let factor = matrix[row][column] / matrix[column][column];
            for j in column..size {
                matrix[row][j] -= factor * matrix[column][j];
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..size).rev() {
        let known: f64 = (row + 1..size).map(|j| matrix[row][j] * right[j]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right
}

/// Toda's open chain with y = (q, η), η_1 = q̇_1, η_i = q̇_i − q̇_(i−1): q̈_i = e^(q_(i−1) − q_i) − e^(q_i − q_(i+1)).
pub fn toda_chain(y: &[f64], dy: &mut [f64]) {
    let bodies = y.len() / 2;
    let (q, eta) = y.split_at(bodies);
    let push = |i: usize| if i == 0 || i == bodies { 0.0 } else { (q[i - 1] - q[i]).exp() };
    let (mut velocity, mut before) = (0.0, 0.0);
    for i in 0..bodies {
        velocity += eta[i];
        let acceleration = push(i) - push(i + 1);
        dy[i] = velocity;
        dy[bodies + i] = acceleration - before;
        before = acceleration;
    }
}
