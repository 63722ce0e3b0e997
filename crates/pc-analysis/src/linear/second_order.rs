//! Linear equations of the second order in independent coordinates.

use std::ops::Range;

use pc_mech::Matrix;

use crate::linear::leaf::independent_rows;
use crate::numeric::dense::{product, solve};

/// M q̈ + G q̇ + K q = F u, for small deviations q of coordinates whose velocities are independent.
///
/// With M η̇ = r, q̇ = D q + B η and η̇ = A_q q + A_η η + B_u u near the state,
///
///   M_q = B⁻ᵀ M B⁻¹,   G = −M_q (D + B A_η B⁻¹),   K = −M_q (B A_q − B A_η B⁻¹ D),   F = M_q B B_u.
///
/// The skew part of G is gyroscopic, its symmetric part damping; the skew part of K is circulatory. Under nonholonomic
/// constraints none of these parts need vanish.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondOrder {
    /// The names of q, in the order of the state.
    pub coordinates: Vec<String>,
    /// M_q, symmetric.
    pub mass: Matrix<f64>,
    /// G, the matrix that multiplies the velocities.
    pub velocity: Matrix<f64>,
    /// K, the matrix that multiplies the coordinates.
    pub stiffness: Matrix<f64>,
    /// F, the matrix that multiplies the inputs.
    pub input: Matrix<f64>,
}

/// The reasons why there are no equations of the second order.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoSecondOrder {
    /// The velocities change at the state.
    #[error("the state is not steady")]
    NotSteady,
    /// The mass matrix is not written out, since the tree is large.
    #[error("the mass matrix of a large tree is not written out")]
    LargeTree,
    /// The equations depend on more coordinates than there are velocities, which may happen under
    /// nonholonomic constraints.
    #[error(
        "the equations depend on {coordinates} independent coordinates, but only {velocities} velocities are independent"
    )]
    TooManyCoordinates {
        /// The coordinates.
        coordinates: usize,
        /// The velocities.
        velocities: usize,
    },
    /// The frame has fewer coordinates than quasi-velocities.
    #[error("only {coordinates} coordinates have independent velocities, of {velocities} quasi-velocities")]
    TooFewCoordinates {
        /// The number of coordinates with independent velocities.
        coordinates: usize,
        /// The number of quasi-velocities.
        velocities: usize,
    },
    /// First-order states act on the velocities.
    #[error("the first-order state {state} acts on the velocities")]
    FirstOrderState {
        /// The name of the first of the states that act on the velocities.
        state: String,
    },
}

/// A row is linearly dependent on others if less than this fraction of it is independent of them.
const ZERO: f64 = 1e-10;

/// The reduced state: its components, and all components of the state in terms of them.
pub(super) struct Reduced {
    /// The indices of its components: coordinates, quasi-velocities, first-order states.
    pub(super) kept: Vec<usize>,
    /// The numbers of coordinates and quasi-velocities among them.
    pub(super) coordinates: usize,
    pub(super) velocities: usize,
    /// E in δy = E δ(reduced).
    pub(super) extension: Matrix<f64>,
}

/// The data for equations of the second order.
pub(super) struct Parts<'a> {
    /// The names of the components of the state.
    pub(super) names: &'a [String],
    /// The range of its quasi-velocities.
    pub(super) quasi_velocities: Range<usize>,
    /// ∂f/∂y, and the derivative of f with respect to the reduced state.
    pub(super) jacobian: &'a Matrix<f64>,
    pub(super) moved: &'a Matrix<f64>,
    /// ∂f/∂u
    pub(super) by_inputs: &'a Matrix<f64>,
    /// The mass matrix M for all quasi-velocities of the state.
    pub(super) mass: &'a Matrix<f64>,
    /// The cyclic coordinates, and those of them whose rates depend on moving ones.
    pub(super) cyclic: &'a [usize],
    pub(super) acted_on: &'a [usize],
    /// The reduced state without cyclic coordinates.
    pub(super) reduced: &'a Reduced,
}

impl Parts<'_> {
    /// The equations at a steady state.
    pub(super) fn second_order(&self) -> Result<SecondOrder, NoSecondOrder> {
        let Reduced { kept, coordinates: d, velocities: l, extension } = self.reduced;
        let (d, l, moved) = (*d, *l, self.moved);
        for (column, &state) in kept.iter().enumerate().skip(d + l) {
            if kept[d..d + l].iter().any(|&s| moved[(s, column)] != 0.0) {
                return Err(NoSecondOrder::FirstOrderState { state: self.names[state].clone() });
            }
        }
        let independent = &kept[..d];
        if d > l {
            return Err(NoSecondOrder::TooManyCoordinates { coordinates: d, velocities: l });
        }
        let q = self.completed(independent).ok_or(NoSecondOrder::TooFewCoordinates {
            coordinates: self.with_own_velocities(),
            velocities: l,
        })?;
        // The rates of components `rows` by q at rest; zero by cyclic ones.
        let by_coordinates = |rows: &[usize]| {
            let column = |j: usize| independent.iter().position(|&known| known == q[j]);
            let entry = |i: usize, j: usize| column(j).map_or(0.0, |column| moved[(rows[i], column)]);
            Matrix::from_fn(rows.len(), l, entry)
        };
        let of_eta =
            Matrix::from_fn(self.mass.rows(), l, |s, j| extension[(self.quasi_velocities.start + s, d + j)]);
        let reduced_mass = product(&of_eta.transpose(), &product(self.mass, &of_eta));
        let accelerations = &kept[d..d + l];
        let b = Matrix::from_fn(l, l, |i, s| moved[(q[i], d + s)]);
        let at_rest = by_coordinates(&q);
        let inverse = solve(&b, &Matrix::from_fn(l, l, |i, j| f64::from(u8::from(i == j))));
        let of_eta = Matrix::from_fn(l, l, |i, j| moved[(accelerations[i], d + j)]);
        let of_u = Matrix::from_fn(l, self.by_inputs.columns(), |i, j| self.by_inputs[(accelerations[i], j)]);

        let whole = product(&inverse.transpose(), &product(&reduced_mass, &inverse));
        let mass = Matrix::from_fn(l, l, |i, j| (whole[(i, j)] + whole[(j, i)]) / 2.0);
        let eta_part = product(&product(&b, &of_eta), &inverse);
        let from_positions = product(&b, &by_coordinates(accelerations));
        let through_d = product(&eta_part, &at_rest);
        let g = Matrix::from_fn(l, l, |i, j| -(at_rest[(i, j)] + eta_part[(i, j)]));
        let k = Matrix::from_fn(l, l, |i, j| through_d[(i, j)] - from_positions[(i, j)]);
        Ok(SecondOrder {
            coordinates: q.iter().map(|&i| self.names[i].clone()).collect(),
            // Zero without a sign.
            velocity: product(&mass, &g).map(|x| x + 0.0),
            stiffness: product(&mass, &k).map(|x| x + 0.0),
            input: product(&mass, &product(&b, &of_u)).map(|x| x + 0.0),
            mass,
        })
    }

    /// The independent coordinates and enough cyclic ones to match the velocities, in the order of the state;
    /// none if these are too few or their velocities are dependent.
    fn completed(&self, independent: &[usize]) -> Option<Vec<usize>> {
        let (l, jacobian) = (self.reduced.velocities, self.jacobian);
        let row = |i: usize| self.velocity_row(i);
        // A coordinate whose rate depends on another cyclic one has no equation with constant coefficients.
        let is_free =
            |&i: &usize| self.cyclic.iter().all(|&j| jacobian[(i, j)] == 0.0) && !self.acted_on.contains(&i);
        let more: Vec<usize> = self.cyclic.iter().copied().filter(is_free).collect();
        let mut left: Vec<Vec<f64>> = more.iter().map(|&i| row(i)).collect();
        let own: Vec<Vec<f64>> = independent.iter().map(|&i| row(i)).collect();
        let matrix = |rows: &[Vec<f64>]| Matrix::from_fn(rows.len(), l, |i, j| rows[i][j]);
        let size = largest(&own).max(largest(&left));
        if independent_rows(&matrix(&own), ZERO * size).len() < own.len() {
            return None;
        }
        // The cyclic ones add the parts of their rows that are independent of the others.
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for own in own {
            let mut direction = own;
            for _ in 0..2 {
                basis.iter().for_each(|known| remove(&mut direction, known));
            }
            let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
            direction.iter_mut().for_each(|x| *x /= length);
            left.iter_mut().for_each(|row| remove(row, &direction));
            basis.push(direction);
        }
        let picked = independent_rows(&matrix(&left), ZERO * size);
        if independent.len() + picked.len() < l {
            return None;
        }
        let mut q: Vec<usize> =
            independent.iter().copied().chain(picked.into_iter().map(|i| more[i])).collect();
        q.sort_unstable();
        Some(q)
    }

    /// The number of coordinates with independent velocities.
    fn with_own_velocities(&self) -> usize {
        let rows: Vec<Vec<f64>> = (0..self.quasi_velocities.start).map(|i| self.velocity_row(i)).collect();
        let all = Matrix::from_fn(rows.len(), self.reduced.velocities, |i, s| rows[i][s]);
        independent_rows(&all, ZERO * largest(&rows)).len()
    }

    /// The coefficients of the independent quasi-velocities in the rate of a coordinate.
    fn velocity_row(&self, i: usize) -> Vec<f64> {
        let first = self.reduced.coordinates;
        (first..first + self.reduced.velocities).map(|column| self.moved[(i, column)]).collect()
    }
}

/// The largest entry. Rows of accelerations are not included: those of stiff springs are larger by orders of
/// magnitude.
fn largest(rows: &[Vec<f64>]) -> f64 {
    rows.iter().flatten().fold(0.0f64, |size, x| size.max(x.abs()))
}

/// Removes from a row its component along a direction of length 1.
fn remove(row: &mut [f64], direction: &[f64]) {
    let along: f64 = row.iter().zip(direction).map(|(a, b)| a * b).sum();
    row.iter_mut().zip(direction).for_each(|(x, d)| *x -= along * d);
}
