//! The numerical solution of equations with multipliers, in terms of independent unknowns.

use pc_expr::Pattern;
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::dense_ldl::DenseLdl;
use crate::compiled::failure::EvaluationFailure;

/// A pivot of the constraints this small relative to their largest coefficient is treated as rounding error.
const VANISHING_PIVOT: f64 = 1e-12;

/// A spare row replaces another row if the spare row's pivot is larger even when multiplied by this.
const SPARE: f64 = 1e-2;

/// The symmetric matrix
///
///   ⎡ M  Cᵀ ⎤
///   ⎣ C  0  ⎦
///
/// where M has k rows and C has m, of which r are independent, usually all. C is eliminated first, always with
/// the largest remaining coefficient as pivot, so that r unknowns depend on the others, w_D = G w_I + C_D⁻¹ γ,
/// and (1, Gᵀ) M (1, Gᵀ)ᵀ is factorised. The remaining m − r rows are assumed consistent. The independent
/// unknowns are chosen anew each time; the solution does not depend on the choice.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Saddle {
    k: usize,
    m: usize,
    rank: usize,
    /// The k × k matrix M, row by row.
    mass: Vec<f64>,
    /// The m × k matrix C, later its factors: L below the diagonal of the pivots and U on it and to the right.
    constraints: Vec<f64>,
    /// The index of the constraint eliminated at each step.
    rows: Vec<usize>,
    /// The index of the unknown eliminated at each step, then the independent ones.
    columns: Vec<usize>,
    /// The r × (k − r) matrix G = −C_D⁻¹ C_I, row by row, with D and I in the order of `columns`.
    dependence: Vec<f64>,
    reduced: DenseLdl,
    full: Pattern,
    /// Storage for a right-hand side.
    room: Vec<f64>,
    /// Storage for the factorisation: weights of unknowns, sizes of rows, M_DD G + M_DI over M_ID G + M_II,
    /// the reduced mass and the sizes of its diagonal.
    weights: Vec<f64>,
    row_sizes: Vec<f64>,
    moved: Vec<f64>,
    reduced_mass: Vec<f64>,
    reduced_sizes: Vec<f64>,
}

impl Saddle {
    /// The matrix of k unknowns and m ≤ k multipliers.
    #[cfg(test)]
    pub(crate) fn new(k: usize, m: usize) -> Saddle {
        Saddle::of_rank(k, m, m)
    }

    /// The matrix of k unknowns and m multipliers, where `rank` ≤ k rows of the constraints are independent.
    /// The rows after the first `rank` are spare: they replace other rows only where the other rows are
    /// nearly dependent.
    pub(crate) fn of_rank(k: usize, m: usize, rank: usize) -> Saddle {
        let free = k - rank;
        Saddle {
            k,
            m,
            rank,
            mass: vec![0.0; k * k],
            constraints: vec![0.0; m * k],
            rows: (0..m).collect(),
            columns: (0..k).collect(),
            dependence: vec![0.0; rank * free],
            reduced: DenseLdl::new(free),
            full: Pattern::from_columns(free, (0..free).map(|j| j..free)),
            room: vec![0.0; k + rank],
            weights: vec![0.0; k],
            row_sizes: vec![0.0; m],
            moved: vec![0.0; k * free],
            reduced_mass: vec![0.0; free * (free + 1) / 2],
            reduced_sizes: vec![0.0; free],
        }
    }

    /// Factorises the matrix, given by its `values` at the indices `lower` on and below the diagonal; all
    /// values must be finite.
    ///
    /// # Errors
    /// [`EvaluationFailure::Constraint`] with k plus the index of the constraint whose unknowns the others
    /// already determine; [`EvaluationFailure::Pivot`] with the index of the unknown whose pivot vanishes.
    pub(crate) fn factorise(&mut self, lower: &Pattern, values: &[f64]) -> Result<(), EvaluationFailure> {
        self.eliminate(lower, values)?;
        self.express_dependent();
        self.reduce_mass();
        let sizes = self.reduced_sizes.iter().copied();
        let outcome = self.reduced.factorise_sum(&self.full, &self.reduced_mass, sizes);
        outcome.map_err(|failure| failure.at_place(|index| self.columns[self.rank + index]))
    }

    /// Like [`factorise`](Saddle::factorise), but stops once the dependent unknowns are known.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn eliminate(&mut self, lower: &Pattern, values: &[f64]) -> Result<(), EvaluationFailure> {
        let k = self.k;
        self.mass.fill(0.0);
        self.constraints.fill(0.0);
        for ((i, j), &value) in lower.entries().zip(values) {
            if i < k {
                self.mass[i * k + j] = value;
                self.mass[j * k + i] = value;
            } else if j < k {
                self.constraints[(i - k) * k + j] = value;
            }
        }
        self.pivot()
    }

    /// The dependent unknowns.
    pub(crate) fn dependent(&self) -> &[usize] {
        &self.columns[..self.rank]
    }

    /// Whether some spare rows have replaced others.
    pub(crate) fn takes_spare(&self) -> bool {
        self.rows[..self.rank].iter().any(|&row| row >= self.rank)
    }

    /// Writes how far C is from losing rank.
    pub(crate) fn independence_to(&self, found: &mut Independence) {
        let (rows, columns) = (&self.rows[..self.rank], &self.columns[..self.rank]);
        let factors = |step: usize| (rows[step], columns[step], self.factor(step, step));
        let pivot = |step: usize| {
            let (constraint, unknown, factor) = factors(step);
            Pivot { constraint, unknown, size: (factor * self.weights[unknown]).abs() }
        };
        let negative = (0..self.rank).filter(|&step| factors(step).2 < 0.0).count() % 2 == 1;
        found.is_negative = negative ^ is_odd(rows) ^ is_odd(columns);
        found.pivots.clear();
        found.pivots.extend((0..self.rank).map(pivot));
        found.row_sizes.clone_from(&self.row_sizes);
        sort_to(rows, &mut found.rows);
        sort_to(columns, &mut found.columns);
    }

    /// Factorises C = L U, up to the order of rows and columns, with complete pivoting. Coefficients are compared after
    /// division by the largest of their row and by the square root of the mass of their unknown, so that units do not
    /// matter; an unknown without mass is treated as if it had the smallest of the other masses.
    fn pivot(&mut self) -> Result<(), EvaluationFailure> {
        let (k, m) = (self.k, self.m);
        let (mass, constraints) = (&self.mass, &self.constraints);
        let masses = || (0..k).map(|s| mass[s * k + s]);
        let lightest = masses().filter(|&mass| mass > 0.0).fold(f64::INFINITY, f64::min);
        let lightest = if lightest.is_finite() { lightest } else { 1.0 };
        let weight = |mass: f64| (if mass > 0.0 { mass } else { lightest }).sqrt().recip();
        self.weights.iter_mut().zip(masses()).for_each(|(place, mass)| *place = weight(mass));
        let weights = &self.weights;
        let size_of_row =
            |a: usize| (0..k).fold(0.0f64, |size, s| size.max((constraints[a * k + s] * weights[s]).abs()));
        self.row_sizes.iter_mut().enumerate().for_each(|(a, place)| *place = size_of_row(a));
        let sizes = &self.row_sizes;
        (0..m).for_each(|a| self.rows[a] = a);
        (0..k).for_each(|s| self.columns[s] = s);
        for step in 0..self.rank {
            let size = |row: usize, column: usize| {
                let (a, s) = (self.rows[row], self.columns[column]);
                let size = (self.constraints[a * k + s] * weights[s] / sizes[a]).abs();
                if a < self.rank { size } else { SPARE * size }
            };
            let places = (step..m).flat_map(|row| (step..k).map(move |column| (row, column)));
            let (row, column, largest) = places.fold((step, step, 0.0), |best, (row, column)| {
                let this = size(row, column);
                if this > best.2 { (row, column, this) } else { best }
            });
            if largest <= VANISHING_PIVOT {
                return Err(EvaluationFailure::Constraint { index: k + self.rows[step] });
            }
            self.rows.swap(step, row);
            self.columns.swap(step, column);
            let (pivot_row, pivot_column) = (self.rows[step] * k, self.columns[step]);
            let pivot = self.constraints[pivot_row + pivot_column];
            for below in step + 1..m {
                let row = self.rows[below] * k;
                let factor = self.constraints[row + pivot_column] / pivot;
                self.constraints[row + pivot_column] = factor;
                for &s in &self.columns[step + 1..] {
                    self.constraints[row + s] -= factor * self.constraints[pivot_row + s];
                }
            }
        }
        Ok(())
    }

    /// An entry of the factors of C; row and column are numbered in the order of the elimination.
    fn factor(&self, row: usize, column: usize) -> f64 {
        self.constraints[self.rows[row] * self.k + self.columns[column]]
    }

    /// G, from U_D G = −U_I.
    fn express_dependent(&mut self) {
        let (m, free) = (self.rank, self.k - self.rank);
        for column in 0..free {
            for row in (0..m).rev() {
                let known: f64 = (row + 1..m)
                    .map(|later| self.factor(row, later) * self.dependence[later * free + column])
                    .sum();
                let value = -(self.factor(row, m + column) + known) / self.factor(row, row);
                self.dependence[row * free + column] = value;
            }
        }
    }

    fn mass(&self, row: usize, column: usize) -> f64 {
        self.mass[self.columns[row] * self.k + self.columns[column]]
    }

    /// Computes the reduced mass M_II + M_ID G + (M_ID G)ᵀ + Gᵀ M_DD G: its lower triangle, column by column, and
    /// the sizes of its diagonal.
    fn reduce_mass(&mut self) {
        let (m, free) = (self.rank, self.k - self.rank);
        let (mut moved, mut reduced) =
            (std::mem::take(&mut self.moved), std::mem::take(&mut self.reduced_mass));
        let mut sizes = std::mem::take(&mut self.reduced_sizes);
        let g = |row: usize, column: usize| self.dependence[row * free + column];
        let places = (0..self.k).flat_map(|row| (0..free).map(move |column| (row, column)));
        for (place, (row, column)) in moved.iter_mut().zip(places) {
            let through: f64 = (0..m).map(|d| self.mass(row, d) * g(d, column)).sum();
            *place = self.mass(row, m + column) + through;
        }
        let places = (0..free).flat_map(|j| (j..free).map(move |i| (i, j)));
        for (place, (i, j)) in reduced.iter_mut().zip(places) {
            let through: f64 = (0..m).map(|d| g(d, i) * moved[d * free + j]).sum();
            *place = moved[(m + i) * free + j] + through;
        }
        sizes.iter_mut().enumerate().for_each(|(i, size)| *size = self.size_of_reduced(i));
        (self.moved, self.reduced_mass, self.reduced_sizes) = (moved, reduced, sizes);
    }

    /// The sum of the absolute values of all terms of the diagonal entry i of the reduced mass.
    fn size_of_reduced(&self, i: usize) -> f64 {
        let (m, free) = (self.rank, self.k - self.rank);
        let g = |row: usize| self.dependence[row * free + i].abs();
        let across = |row: usize| (0..m).map(|d| self.mass(row, d).abs() * g(d)).sum::<f64>();
        self.mass(m + i, m + i).abs() + 2.0 * across(m + i) + (0..m).map(|d| g(d) * across(d)).sum::<f64>()
    }

    /// One entry of r − M w, computed from the first `known` entries of w in the order of the elimination.
    fn rest(&self, right: &[f64], w: &[f64], row: usize, known: usize) -> f64 {
        right[self.columns[row]] - (0..known).map(|s| self.mass(row, s) * w[s]).sum::<f64>()
    }

    /// Replaces each of the columns (r, γ), of length k + m, by the solution (w, μ) of M w + Cᵀ μ = r, C w = γ.
    pub(crate) fn solve(&mut self, columns: &mut [f64]) {
        for column in columns.chunks_exact_mut(self.k + self.m) {
            self.solve_one(column);
        }
    }

    fn solve_one(&mut self, column: &mut [f64]) {
        let (k, m) = (self.k, self.rank);
        let free = k - m;
        let mut room = std::mem::take(&mut self.room);
        let (w, mu) = room.split_at_mut(k);
        // w_D at w_I = 0: L U_D w_D = γ
        for row in 0..m {
            let known: f64 = (0..row).map(|earlier| self.factor(row, earlier) * w[earlier]).sum();
            w[row] = column[k + self.rows[row]] - known;
        }
        for row in (0..m).rev() {
            let known: f64 = (row + 1..m).map(|later| self.factor(row, later) * w[later]).sum();
            w[row] = (w[row] - known) / self.factor(row, row);
        }
        // r − M w there, then along (1, Gᵀ)
        for row in 0..m {
            mu[row] = self.rest(column, w, row, m);
        }
        for i in 0..free {
            let across: f64 = (0..m).map(|d| self.dependence[d * free + i] * mu[d]).sum();
            w[m + i] = self.rest(column, w, m + i, m) + across;
        }
        self.reduced.solve(&mut w[m..]);
        for d in 0..m {
            w[d] += (0..free).map(|i| self.dependence[d * free + i] * w[m + i]).sum::<f64>();
        }
        // U_Dᵀ Lᵀ μ = (r − M w)_D
        for row in 0..m {
            let known: f64 = (0..row).map(|earlier| self.factor(earlier, row) * mu[earlier]).sum();
            mu[row] = (self.rest(column, w, row, k) - known) / self.factor(row, row);
        }
        for row in (0..m).rev() {
            let known: f64 = (row + 1..m).map(|later| self.factor(later, row) * mu[later]).sum();
            mu[row] -= known;
        }
        for (s, &place) in self.columns.iter().enumerate() {
            column[place] = w[s];
        }
        column[k..].fill(0.0);
        for (a, &place) in self.rows[..m].iter().enumerate() {
            column[k + place] = mu[a];
        }
        self.room = room;
    }
}

/// A measure of how far the rows of C are from linear dependence.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Independence {
    /// The pivots of C in the order of the elimination.
    pub(crate) pivots: Vec<Pivot>,
    /// The largest coefficient of each row, in units in which the mass of each unknown is 1.
    pub(crate) row_sizes: Vec<f64>,
    /// The rows and columns of the minor that was eliminated, and its sign.
    pub(crate) rows: Vec<usize>,
    columns: Vec<usize>,
    is_negative: bool,
}

/// A pivot of C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pivot {
    /// The index of the constraint to which the pivot belongs.
    pub(crate) constraint: usize,
    /// The unknown that the constraint determines.
    pub(crate) unknown: usize,
    /// The size of the pivot, in units in which the mass of that unknown is 1.
    pub(crate) size: f64,
}

impl Independence {
    /// Whether the sign of the minor has changed: then the minor vanishes in between, and rank may be lost.
    /// `None` if the two minors are different.
    pub(crate) fn is_reversed(&self, later: &Independence) -> Option<bool> {
        let same = self.rows == later.rows && self.columns == later.columns;
        same.then_some(self.is_negative != later.is_negative)
    }
}

fn sort_to(places: &[usize], sorted: &mut Vec<usize>) {
    sorted.clear();
    sorted.extend_from_slice(places);
    sorted.sort_unstable();
}

/// Whether the number of transpositions that sort the list is odd.
fn is_odd(places: &[usize]) -> bool {
    let later = |i: usize| places[i + 1..].iter().filter(move |&&place| place < places[i]).count();
    (0..places.len()).map(later).sum::<usize>() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::numbers;

    /// One symmetric matrix made of M = Nᵀ N + 1 and C, with random N and C.
    fn random(k: usize, m: usize, next: &mut impl FnMut() -> f64) -> Vec<Vec<f64>> {
        let n: Vec<f64> = (0..k * k).map(|_| next()).collect();
        let mut whole = vec![vec![0.0; k + m]; k + m];
        for i in 0..k {
            for j in 0..k {
                whole[i][j] = (0..k).map(|s| n[s * k + i] * n[s * k + j]).sum::<f64>() + f64::from(i == j);
            }
        }
        for a in 0..m {
            for s in 0..k {
                whole[k + a][s] = next();
                whole[s][k + a] = whole[k + a][s];
            }
        }
        whole
    }

    fn lower(whole: &[Vec<f64>]) -> (Pattern, Vec<f64>) {
        let size = whole.len();
        let pattern = Pattern::from_columns(
            size,
            (0..size).map(|j| (j..size).filter(|&i| whole[i][j] != 0.0).collect::<Vec<_>>()),
        );
        let values = pattern.entries().map(|(i, j)| whole[i][j]).collect();
        (pattern, values)
    }

    #[test]
    fn solutions_satisfy_their_equations() {
        let mut next = numbers(7);
        for (k, m) in [(1, 0), (3, 1), (3, 3), (6, 2), (9, 5)] {
            for _ in 0..20 {
                let whole = random(k, m, &mut next);
                let (pattern, values) = lower(&whole);
                let mut saddle = Saddle::new(k, m);
                saddle.factorise(&pattern, &values).unwrap();
                let right: Vec<f64> = (0..k + m).map(|_| next()).collect();
                let mut solution = right.clone();
                saddle.solve(&mut solution);
                for (row, expected) in whole.iter().zip(&right) {
                    let found: f64 = row.iter().zip(&solution).map(|(a, b)| a * b).sum();
                    // Rounding, times the condition of random matrices of nine rows.
                    assert!((found - expected).abs() < 1e-10, "{found} {expected}");
                }
            }
        }
    }

    #[test]
    fn a_massless_unknown_is_determined_by_a_constraint() {
        // M = diag(1, 0), w_1 = w_2
        let whole = [vec![1.0, 0.0, 1.0], vec![0.0, 0.0, -1.0], vec![1.0, -1.0, 0.0]];
        let (pattern, values) = lower(&whole);
        let mut saddle = Saddle::new(2, 1);
        saddle.factorise(&pattern, &values).unwrap();
        let mut solution = [3.0, 4.0, 0.0];
        saddle.solve(&mut solution);
        assert_eq!(solution, [7.0, 7.0, -4.0]);
    }

    #[test]
    fn a_constraint_that_depends_on_others_is_found() {
        // The same constraint twice, in different units.
        let whole = [
            vec![1.0, 0.0, 1.0, 1e6],
            vec![0.0, 1.0, 2.0, 2e6],
            vec![1.0, 2.0, 0.0, 0.0],
            vec![1e6, 2e6, 0.0, 0.0],
        ];
        let (pattern, values) = lower(&whole);
        let failure = Saddle::new(2, 2).factorise(&pattern, &values).unwrap_err();
        assert!(matches!(failure, EvaluationFailure::Constraint { index: 2 | 3 }), "{failure:?}");
    }

    #[test]
    fn a_spare_row_takes_over_where_the_first_ones_are_dependent() {
        // w_1 = w_2 twice, and a spare w_2 = w_3: M = 1, r = (3, 0, 0).
        let whole = [
            vec![1.0, 0.0, 0.0, 1.0, 1.0, 0.0],
            vec![0.0, 1.0, 0.0, -1.0, -1.0, 1.0],
            vec![0.0, 0.0, 1.0, 0.0, 0.0, -1.0],
            vec![1.0, -1.0, 0.0, 0.0, 0.0, 0.0],
            vec![1.0, -1.0, 0.0, 0.0, 0.0, 0.0],
            vec![0.0, 1.0, -1.0, 0.0, 0.0, 0.0],
        ];
        let (pattern, values) = lower(&whole);
        let mut saddle = Saddle::of_rank(3, 3, 2);
        saddle.factorise(&pattern, &values).unwrap();
        assert!(saddle.takes_spare());
        let mut solution = [3.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        saddle.solve(&mut solution);
        // The reactions are 2 and 1, that of the unused row 0.
        assert_eq!(solution[..3], [1.0; 3]);
        assert_eq!((solution[3] + solution[4], solution[5]), (2.0, 1.0));
    }
}
