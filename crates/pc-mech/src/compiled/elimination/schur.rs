//! Trees with loops: finds the accelerations of the tree alone, then the forces that close the loops.
//!
//! With M⁻¹ applied joint by joint, M η̇ = r + Cᵀ λ and C η̇ = γ are
//!
//!   S λ = γ − C a,   η̇ = a + Y λ,   S = C Y,   Y = M⁻¹ Cᵀ,   a = M⁻¹ r,
//!
//! which takes O(N c) operations plus c³ for c constraints, whereas the mass matrix bordered by C takes N³.
//! The condition number of S is the square of that of C: where a pivot of S is small, the bordered matrix is
//! used instead.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Graph, Inputs, Pattern, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::columns::{nonzeros, sparse};
use crate::compiled::elimination::pivots::check;
use crate::compiled::point::Point;
use crate::tree::equations::TreeEquations;

/// A pivot of S smaller than this fraction of its diagonal entry loses digits.
const SMALL_PIVOT: f64 = 1e-4;

/// Solves for η̇ and λ of a tree with loops.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Schur {
    /// Computes, from (t, y): a, γ − C a, the lower triangle of S column by column, Y, then the pivots of M
    /// and its diagonal entries.
    equations: Evaluator,
    values: Vec<f64>,
    /// The number of components of η̇, of constraints, and of pivots.
    k: usize,
    m: usize,
    watched: usize,
    /// The pattern of Y.
    solved: Pattern,
}

impl Schur {
    /// The solver for a tree with the given rows of C and entries of γ; `None` if a joint has inertia only
    /// through a loop.
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        tree: &TreeEquations<'g>,
        (rows, right): (&[Vec<Expr<'g>>], &[Expr<'g>]),
        backend: Backend,
    ) -> Result<Option<Schur>, ExprError> {
        let (system, dynamics) = (&tree.system, &tree.dynamics);
        if dynamics.articulated.pivots().any(|pivot| pivot.is_massless) {
            return Ok(None);
        }
        let free = system.in_order(&dynamics.accelerations());
        let (k, m) = (free.len(), rows.len());
        let along = |row: &[Expr<'g>], v: &[Expr<'g>]| graph.dot(row.iter().copied(), v.iter().copied());
        let pushed = |row: &Vec<Expr<'g>>| {
            let applied = system.by_link(row);
            system.in_order(&dynamics.articulated.solve(vec![None; applied.len()], &applied))
        };
        let columns: Vec<Vec<Expr<'g>>> = rows.iter().map(pushed).collect();
        let mut outputs = free.clone();
        outputs.extend((0..m).map(|a| right[a] - along(&rows[a], &free)));
        outputs.extend(
            (0..m).flat_map(|b| (b..m).map(move |a| (a, b))).map(|(a, b)| along(&rows[a], &columns[b])),
        );
        let (solved, entries) = nonzeros(k, columns.iter().map(|column| sparse(column)));
        outputs.extend(entries);
        let watched: Vec<(Expr<'g>, Expr<'g>)> =
            dynamics.articulated.pivots().filter_map(|pivot| pivot.watched).collect();
        outputs.extend(watched.iter().map(|&(pivot, _)| pivot));
        outputs.extend(watched.iter().map(|&(_, size)| size));
        let equations = Evaluator::new(Program::new(graph, inputs, &outputs)?, backend);
        Ok(Some(Schur { equations, values: vec![0.0; outputs.len()], k, m, watched: watched.len(), solved }))
    }

    /// The number of operations of an evaluation; each operation of the factorisation counts as `of_a_loop`
    /// operations of straight-line code.
    pub(crate) fn operations(&self, of_a_loop: usize) -> usize {
        let m = self.m;
        let factors = m * m * m / 6 + 2 * m * m + self.solved.len();
        self.equations.program().cost().total() + of_a_loop * factors
    }

    /// Writes η̇, then λ, and zeros after them; false if another method has to be used.
    pub(crate) fn solve(&mut self, Point { t, y, p }: Point<'_>, unknowns: &mut [f64]) -> bool {
        self.equations.eval(t, y, p, &mut self.values);
        let (k, m) = (self.k, self.m);
        let (free, rest) = self.values.split_at_mut(k);
        let (lambda, rest) = rest.split_at_mut(m);
        let (s, rest) = rest.split_at_mut(m * (m + 1) / 2);
        let (columns, watched) = rest.split_at(self.solved.len());
        let (pivots, sizes) = watched.split_at(self.watched);
        if check(pivots, sizes).is_err() || !factorised(s, m) {
            return false;
        }
        solve(s, lambda);
        let (accelerations, multipliers) = unknowns.split_at_mut(k);
        accelerations.copy_from_slice(free);
        for ((i, a), y) in self.solved.entries().zip(columns) {
            accelerations[i] += y * lambda[a];
        }
        multipliers.fill(0.0);
        multipliers[..m].copy_from_slice(lambda);
        unknowns.iter().all(|value| value.is_finite())
    }
}

/// The index at which column b of a lower triangle starts, with its diagonal entry.
fn column(m: usize, b: usize) -> usize {
    b * m - b * b.saturating_sub(1) / 2
}

/// Factorises S = L D Lᵀ in place: D on the diagonal, L below. False if a pivot is small or NaN.
fn factorised(s: &mut [f64], m: usize) -> bool {
    for b in 0..m {
        let at = column(m, b);
        let whole = s[at];
        for q in 0..b {
            let before = column(m, q);
            let share = s[before + b - q] * s[before];
            for a in b..m {
                s[at + a - b] -= share * s[before + a - q];
            }
        }
        let pivot = s[at];
        if pivot.is_nan() || pivot <= SMALL_PIVOT * whole {
            return false;
        }
        s[at + 1..at + m - b].iter_mut().for_each(|entry| *entry /= pivot);
    }
    true
}

/// Replaces a right-hand side by the solution.
fn solve(s: &[f64], x: &mut [f64]) {
    let m = x.len();
    for b in 0..m {
        let at = column(m, b);
        for a in b + 1..m {
            x[a] -= s[at + a - b] * x[b];
        }
    }
    for b in (0..m).rev() {
        let at = column(m, b);
        let below: f64 = (b + 1..m).map(|a| s[at + a - b] * x[a]).sum();
        x[b] = x[b] / s[at] - below;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_solve_and_small_pivots_are_detected() {
        // S = Nᵀ N with N = ((2, 1, 0), (0, 1, 3), (1, 0, 1)), of determinant 25.
        let whole = [[5.0, 2.0, 1.0], [2.0, 2.0, 3.0], [1.0, 3.0, 10.0]];
        let lower = || (0..3).flat_map(|b| (b..3).map(move |a| whole[a][b])).collect::<Vec<f64>>();
        let mut s = lower();
        assert!(factorised(&mut s, 3));
        let determinant: f64 = (0..3).map(|b| s[column(3, b)]).product();
        assert!((determinant - 25.0).abs() < 1e-13, "{determinant}");
        let x = [1.0, -2.0, 0.5];
        let mut found: Vec<f64> =
            whole.iter().map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect();
        solve(&s, &mut found);
        assert!(found.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");

        // The third row is the sum of the first two, up to 1e-6.
        let mut s = vec![5.0, 2.0, 7.0, 2.0, 4.0, 11.0 * (1.0 + 1e-6)];
        assert!(!factorised(&mut s, 3));
        assert!(!factorised(&mut [f64::NAN], 1));
        assert!(!factorised(&mut [-1.0], 1) && !factorised(&mut [0.0], 1));
    }
}
