//! The planar pendulum of N unit links and masses, y = (θ, θ̇), angles from the downward vertical, g = 10.

use super::{Hand, fma, for_this_host};

const GRAVITY: f64 = 10.0;

/// Σ_j w_max(i,j) (cos(θ_i−θ_j) θ̈_j + sin(θ_i−θ_j) θ̇_j²) = −w_i g sin θ_i with w_i = N − i, i from 0.
///
/// The right-hand side by running sums, M = L D Lᵀ row by row, so that inner loops go along memory.
#[inline(always)]
fn by_mass_matrix<const FMA: bool, const N: usize>(
    [angles, rates]: &[[f64; N]; 2],
    [velocities, accelerations]: &mut [[f64; N]; 2],
) {
    *velocities = *rates;
    let (mut sin, mut cos, mut weight) = ([0.0; N], [0.0; N], [0.0; N]);
    for i in 0..N {
        (sin[i], cos[i]) = angles[i].sin_cos();
        weight[i] = (N - i) as f64;
    }

    // r_i = cos θ_i Σ_j w_max sin θ_j θ̇_j² − sin θ_i (Σ_j w_max cos θ_j θ̇_j² + w_i g)
    let (mut below_sin, mut below_cos) = ([0.0; N], [0.0; N]); // sums over j > i, weighted with w_j
    let (mut sum_sin, mut sum_cos) = (0.0, 0.0);
    for i in (0..N).rev() {
        (below_sin[i], below_cos[i]) = (sum_sin, sum_cos);
        let pull = weight[i] * rates[i] * rates[i];
        sum_sin = fma::<FMA>(pull, sin[i], sum_sin);
        sum_cos = fma::<FMA>(pull, cos[i], sum_cos);
    }
    let mut x = [0.0; N];
    let (mut above_sin, mut above_cos) = (0.0, GRAVITY); // sums over j ≤ i, to be weighted with w_i
    for i in 0..N {
        let square = rates[i] * rates[i];
        above_sin = fma::<FMA>(square, sin[i], above_sin);
        above_cos = fma::<FMA>(square, cos[i], above_cos);
        let along = fma::<FMA>(weight[i], above_sin, below_sin[i]);
        let across = fma::<FMA>(weight[i], above_cos, below_cos[i]);
        x[i] = fma::<FMA>(cos[i], along, -(sin[i] * across));
    }

    // The upper triangle of M, row i to be row i of D Lᵀ; the lower triangle receives L.
    let mut m = [[0.0; N]; N];
    for i in 0..N {
        for j in i..N {
            m[i][j] = weight[j] * fma::<FMA>(cos[i], cos[j], sin[i] * sin[j]);
        }
    }
    let mut reciprocal = [0.0; N];
    for j in 0..N {
        let row = m[j];
        reciprocal[j] = 1.0 / row[j];
        for i in j + 1..N {
            let factor = row[i] * reciprocal[j];
            m[i][j] = factor;
            for k in i..N {
                m[i][k] = fma::<FMA>(-factor, row[k], m[i][k]);
            }
            x[i] = fma::<FMA>(-factor, x[j], x[i]);
        }
    }
    for i in 0..N {
        x[i] *= reciprocal[i];
    }
    for i in (0..N).rev() {
        for j in 0..i {
            x[j] = fma::<FMA>(-m[i][j], x[i], x[j]);
        }
    }
    *accelerations = x;
}

/// The same motion without a mass matrix, for the tensions λ_i of the links, N operations in all:
/// λ_{i−1} cos(θ_i−θ_{i−1}) − 2λ_i + λ_{i+1} cos(θ_{i+1}−θ_i) = −θ̇_i² (at the support −λ_1 and g cos θ_1 instead),
/// θ̈_i = λ_{i+1} sin(θ_{i+1}−θ_i) − λ_{i−1} sin(θ_i−θ_{i−1}) (at the support −g sin θ_1 instead of the second).
#[inline(always)]
fn by_tensions<const FMA: bool, const N: usize>(
    [angles, rates]: &[[f64; N]; 2],
    [velocities, accelerations]: &mut [[f64; N]; 2],
) {
    *velocities = *rates;
    let (mut sin, mut cos) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        (sin[i], cos[i]) = angles[i].sin_cos();
    }
    // Of θ_{i+1} − θ_i
    let (mut sine, mut cosine) = ([0.0; N], [0.0; N]);
    for i in 0..N - 1 {
        sine[i] = fma::<FMA>(sin[i + 1], cos[i], -(cos[i + 1] * sin[i]));
        cosine[i] = fma::<FMA>(cos[i + 1], cos[i], sin[i + 1] * sin[i]);
    }
    // From the free end: λ_i = tension_i + slope_i λ_{i−1}
    let (mut tension, mut slope) = ([0.0; N], [0.0; N]);
    let (mut coupling, mut load) = (0.0, 0.0);
    for i in (0..N).rev() {
        let own = if i == 0 { 1.0 } else { 2.0 };
        let drive = rates[i] * rates[i] + if i == 0 { GRAVITY * cos[0] } else { 0.0 };
        let pivot = 1.0 / (own - coupling);
        tension[i] = (drive + load) * pivot;
        if i > 0 {
            slope[i] = cosine[i - 1] * pivot;
            coupling = cosine[i - 1] * slope[i];
            load = cosine[i - 1] * tension[i];
        }
    }
    for i in 1..N {
        tension[i] = fma::<FMA>(slope[i], tension[i - 1], tension[i]);
    }
    accelerations[0] = -GRAVITY * sin[0];
    for i in 0..N - 1 {
        accelerations[i] = fma::<FMA>(tension[i + 1], sine[i], accelerations[i]);
        accelerations[i + 1] = -(tension[i] * sine[i]);
    }
}

macro_rules! by_size {
    ($function:ident, $links:expr) => {
        match $links {
            4 => for_this_host!($function, [[f64; 4]; 2], 4),
            2 => for_this_host!($function, [[f64; 2]; 2], 2),
            8 => for_this_host!($function, [[f64; 8]; 2], 8),
            16 => for_this_host!($function, [[f64; 16]; 2], 16),
            32 => for_this_host!($function, [[f64; 32]; 2], 32),
            links => unreachable!("no pendulum of {links} links is written by hand"),
        }
    };
}

/// The mass matrix formed and factorised.
///
/// # Panics
/// For any number of links but 2, 4, 8, 16 and 32.
pub(crate) fn pendulum(links: usize) -> Hand {
    by_size!(by_mass_matrix, links)
}

/// The tensions eliminated from the free end, N operations in all.
///
/// # Panics
/// As [`pendulum`].
pub(crate) fn pendulum_by_tensions(links: usize) -> Hand {
    by_size!(by_tensions, links)
}
