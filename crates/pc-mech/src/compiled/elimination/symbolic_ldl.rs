//! The factorisation M = L D Lᵀ, unrolled into expressions.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use pc_algebra::{Matrix, determinant, inverse};
use pc_expr::{Expr, Graph};

use crate::points::equations::PointEquations;
use crate::tree::equations::TreeEquations;
use crate::tree::open_couplings::Pivot;

/// The inverse of a symmetric matrix in the form in which it is applied. Zeros of the matrix cost nothing.
pub(crate) enum Factors<'g> {
    /// L D Lᵀ, in an order of elimination chosen for little fill-in.
    Ldl(Ldl<'g>),
    /// The inverse itself: for a small indefinite matrix, such as that of L = ẋẏ, where a pivot may vanish
    /// though the matrix is regular; for a matrix without a usable pivot on its diagonal; and for a matrix of
    /// two rows whose determinant is a much shorter expression than its pivots.
    Inverse(Matrix<Expr<'g>>),
    /// Elimination joint by joint.
    Tree(Rc<TreeEquations<'g>>),
    /// Elimination link by link.
    Points(Rc<PointEquations<'g>>),
}

/// The maximum number of rows of an indefinite matrix that is inverted as a whole; larger inverses are long
/// expressions.
const MOST_INVERTED: usize = 3;

/// An expression that vanishes where M is singular, or where its factors are undefined.
pub(crate) struct Watched<'g> {
    /// The index of the unknown that is undetermined there.
    pub(crate) place: usize,
    pub(crate) pivot: Expr<'g>,
    /// The scale of the rounding error of `pivot`.
    pub(crate) size: Expr<'g>,
}

/// L D Lᵀ with L unit lower triangular in the order of elimination, and D diagonal; both have the indices of
/// M.
pub(crate) struct Ldl<'g> {
    order: Vec<usize>,
    /// The position of each row in the order of elimination.
    turn: Vec<usize>,
    /// The L_iq of each row i that are neither 0 nor on the diagonal, as (q, L_iq).
    rows: Vec<Entries<'g>>,
    /// The same entries for each column q, as (i, L_iq).
    columns: Vec<Entries<'g>>,
    diagonal: Vec<Expr<'g>>,
}

type Entries<'g> = Vec<(usize, Expr<'g>)>;

impl<'g> Factors<'g> {
    /// Factorises a matrix that is regular at almost all states.
    pub(crate) fn of(graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Factors<'g> {
        let undefined = || Matrix::from_fn(m.rows(), m.rows(), |_, _| Expr::ONE / Expr::ZERO);
        let lacks = (0..m.rows()).any(|s| m[(s, s)].is_zero());
        let inverted = |ldl: &Ldl<'g>| {
            m.rows() <= MOST_INVERTED && (lacks || ldl.has_both_signs(graph)) || ldl.is_longer(graph, m)
        };
        match Ldl::of(graph, m).filter(|ldl| !inverted(ldl)) {
            Some(ldl) => Factors::Ldl(ldl),
            None => Factors::Inverse(inverse(graph, m).unwrap_or_else(undefined)), // a regular M has an inverse
        }
    }

    /// The pivots D with the diagonal entries of M before elimination; or, if a small M is inverted, the
    /// determinant of M with a scale computed from its largest entry.
    pub(crate) fn watched(&self, graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Vec<Watched<'g>> {
        let rows = m.rows();
        match self {
            Factors::Ldl(ldl) => {
                let pivots = ldl.diagonal.iter().enumerate();
                pivots.map(|(place, &pivot)| Watched { place, pivot, size: m[(place, place)] }).collect()
            }
            Factors::Inverse(_) if rows <= MOST_INVERTED => {
                let largest =
                    m.entries().iter().copied().fold(Expr::ZERO, |largest, entry| largest.max(entry.abs()));
                let size = largest.powi(rows as i32);
                let pivot = determinant(graph, m).into_iter();
                pivot.map(|pivot| Watched { place: rows - 1, pivot, size }).collect()
            }
            Factors::Inverse(_) => Vec::new(),
            Factors::Tree(tree) => {
                let watched = |known: Pivot<'g>| {
                    let place = tree.system.places[known.link][known.component];
                    known.watched.map(|(pivot, size)| Watched { place, pivot, size })
                };
                tree.dynamics.articulated.pivots().filter_map(watched).collect()
            }
            Factors::Points(points) => {
                let pivots = points.elimination.pivots();
                pivots.map(|(place, pivot, size)| Watched { place, pivot, size }).collect()
            }
        }
    }

    /// k
    fn rows(&self) -> usize {
        match self {
            Factors::Ldl(ldl) => ldl.diagonal.len(),
            Factors::Inverse(inverse) => inverse.rows(),
            Factors::Tree(tree) => tree.system.places.iter().map(Vec::len).sum(),
            Factors::Points(points) => points.elimination.size(),
        }
    }

    /// M⁻¹ r
    pub(crate) fn solve(&self, graph: &'g Graph, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        match self {
            Factors::Ldl(ldl) => ldl.solve(graph, right),
            Factors::Inverse(inverse) => (0..right.len())
                .map(|i| graph.sum(inverse.nonzero(i).map(|(j, entry)| entry * right[j])))
                .collect(),
            Factors::Tree(tree) => {
                let applied = tree.system.by_link(right);
                tree.system.in_order(&tree.dynamics.articulated.solve(vec![None; applied.len()], &applied))
            }
            Factors::Points(points) => points.elimination.solve(None, right),
        }
    }

    /// The nonzero entries of M⁻¹ r with their indices, computed from the nonzero entries of r.
    pub(crate) fn solve_nonzero(&self, graph: &'g Graph, right: &[(usize, Expr<'g>)]) -> Entries<'g> {
        match self {
            _ if right.is_empty() => Vec::new(),
            Factors::Ldl(ldl) => ldl.solve_nonzero(graph, right),
            Factors::Inverse(_) | Factors::Tree(_) | Factors::Points(_) => {
                let mut whole = vec![Expr::ZERO; self.rows()];
                right.iter().for_each(|&(i, entry)| whole[i] = entry);
                let solution = self.solve(graph, &whole).into_iter().enumerate();
                solution.filter(|(_, entry)| !entry.is_zero()).collect()
            }
        }
    }
}

impl<'g> Ldl<'g> {
    /// √D_s L_is η_i
    pub(crate) fn orthonormal(&self, graph: &'g Graph, s: usize, eta: &[Expr<'g>]) -> Expr<'g> {
        let below = self.columns[s].iter().map(|&(i, l)| l * eta[i]);
        graph.exact_root(self.diagonal[s]) * graph.sum(below.chain([eta[s]]))
    }

    /// Whether the determinant of a matrix of two rows is a much shorter expression than the pivots whose
    /// product it is: for a relativistic particle the determinant is a power of the radicand in the
    /// Lagrangian.
    fn is_longer(&self, graph: &'g Graph, m: &Matrix<Expr<'g>>) -> bool {
        let (2, Some(&last)) = (m.rows(), self.order.last()) else { return false };
        if !graph.know_root_powers(&m.nonzero_entries()) {
            return false;
        }
        let pivot = self.diagonal[last].tree_cost();
        determinant(graph, m).is_some_and(|determinant| determinant.tree_cost().saturating_mul(2) <= pivot)
    }

    /// Whether D has entries of both signs at a point with positive parameters.
    fn has_both_signs(&self, graph: &'g Graph) -> bool {
        let symbols = graph.symbols_of(&self.diagonal);
        [0.0, 0.2, 0.6, 1.7].into_iter().any(|spread| {
            let place = |i: usize| (1.0 + spread * (1.0 + i as f64).sin()).abs();
            let values: Vec<_> = symbols.iter().enumerate().map(|(i, &symbol)| (symbol, place(i))).collect();
            let signs = graph.evaluate(&self.diagonal, &values).unwrap_or_default(); // every symbol has a value
            signs.iter().any(|&d| d > 0.0) && signs.iter().any(|&d| d < 0.0)
        })
    }

    /// Eliminates row by row, L_ip = S_ip/S_pp, S_ij ← S_ij − L_ip S_pp L_jp, always choosing a row with the
    /// fewest entries left, preferably one with a symbol as pivot: for example, the row of a wheel before
    /// that of the body that carries the wheel. `None` if all remaining diagonal entries are zero.
    fn of(graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Option<Ldl<'g>> {
        let k = m.rows();
        let mut schur: Vec<BTreeMap<usize, Expr<'g>>> = (0..k).map(|i| m.nonzero(i).collect()).collect();
        let mut ldl = Ldl {
            order: Vec::new(),
            turn: vec![0; k],
            rows: vec![Vec::new(); k],
            columns: vec![Vec::new(); k],
            diagonal: vec![Expr::ONE; k],
        };
        // The remaining rows with a usable pivot, by their number of entries; among equals a symbol first.
        let usable = |schur: &[BTreeMap<usize, Expr<'g>>], p: usize| {
            schur[p].get(&p).map(|pivot| (schur[p].len(), pivot.tree_cost() > 0, p))
        };
        let mut open: BTreeSet<(usize, bool, usize)> = (0..k).filter_map(|p| usable(&schur, p)).collect();
        while ldl.order.len() < k {
            let (_, _, pivot) = open.pop_first()?;
            ldl.turn[pivot] = ldl.order.len();
            ldl.order.push(pivot);
            let mut eliminated = std::mem::take(&mut schur[pivot]);
            let before: Vec<_> = eliminated.keys().map(|&i| usable(&schur, i)).collect();
            for row in before.into_iter().flatten() {
                open.remove(&row);
            }
            let d = eliminated.remove(&pivot)?; // a usable row has its pivot
            ldl.diagonal[pivot] = d;
            for (&i, &s) in &eliminated {
                let l = s / d;
                schur[i].remove(&pivot);
                ldl.rows[i].push((pivot, l));
                ldl.columns[pivot].push((i, l));
                for (&j, &t) in eliminated.range(..=i) {
                    let reduced = graph.sum([schur[i].get(&j).copied().unwrap_or(Expr::ZERO), -(l * t)]);
                    for (row, column) in [(i, j), (j, i)] {
                        match reduced.is_zero() {
                            true => schur[row].remove(&column),
                            false => schur[row].insert(column, reduced),
                        };
                    }
                }
            }
            open.extend(eliminated.keys().filter_map(|&i| usable(&schur, i)));
        }
        Some(ldl)
    }

    /// Like `solve`, but only for the unknowns that depend on the given entries of r.
    fn solve_nonzero(&self, graph: &'g Graph, right: &[(usize, Expr<'g>)]) -> Entries<'g> {
        let mut z: BTreeMap<usize, Expr<'g>> = right.iter().copied().collect();
        let zero = |z: &BTreeMap<usize, Expr<'g>>, i: usize| z.get(&i).copied().unwrap_or(Expr::ZERO);
        let mut reached: BTreeSet<usize> = right.iter().map(|&(i, _)| self.turn[i]).collect();
        let mut next = reached.first().copied();
        while let Some(turn) = next {
            let i = self.order[turn];
            let value = rest(graph, zero(&z, i), &self.rows[i], |q| zero(&z, q));
            z.insert(i, value);
            reached.extend(self.columns[i].iter().map(|&(below, _)| self.turn[below]));
            next = reached.range(turn + 1..).next().copied();
        }
        let mut x: BTreeMap<usize, Expr<'g>> =
            z.into_iter().map(|(i, z)| (i, if z.is_zero() { z } else { z / self.diagonal[i] })).collect();
        let mut next = reached.last().copied();
        while let Some(turn) = next {
            let i = self.order[turn];
            let value = rest(graph, zero(&x, i), &self.columns[i], |q| zero(&x, q));
            x.insert(i, value);
            reached.extend(self.rows[i].iter().map(|&(above, _)| self.turn[above]));
            next = reached.range(..turn).next_back().copied();
        }
        x.into_iter().filter(|(_, x)| !x.is_zero()).collect()
    }

    fn solve(&self, graph: &'g Graph, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut z = right.to_vec();
        for &i in &self.order {
            z[i] = rest(graph, z[i], &self.rows[i], |q| z[q]);
        }
        let divided = |(&z, &d): (&Expr<'g>, &Expr<'g>)| if z.is_zero() { z } else { z / d };
        let mut x: Vec<Expr<'g>> = z.iter().zip(&self.diagonal).map(divided).collect();
        for &i in self.order.iter().rev() {
            x[i] = rest(graph, x[i], &self.columns[i], |q| x[q]);
        }
        x
    }
}

/// r − Σ_q l_q z_q
fn rest<'g>(graph: &'g Graph, r: Expr<'g>, l: &Entries<'g>, z: impl Fn(usize) -> Expr<'g>) -> Expr<'g> {
    let known: Vec<Expr<'g>> =
        l.iter().map(|&(q, l)| (l, z(q))).filter(|(_, z)| !z.is_zero()).map(|(l, z)| -(l * z)).collect();
    if known.is_empty() { r } else { graph.sum(known.into_iter().chain([r])) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests the sparsity patterns of a chain, an arrow and a ring with a hub, with each unit vector and with
    /// a few entries at once.
    #[test]
    fn sparse_right_sides_have_the_full_solution() {
        let graph = Graph::new();
        let k = 9;
        let patterns: [fn(usize, usize) -> bool; 3] = [
            |i, j| i.abs_diff(j) == 1,
            |i, j| i == 0 || j == 0,
            |i, j| i.abs_diff(j) % 8 == 1 || i == 4 || j == 4,
        ];
        for coupled in patterns {
            let entry = |i: usize, j: usize| match i == j {
                true => graph.symbol(&format!("m{i}")),
                false if coupled(i, j) => graph.symbol(&format!("c{}_{}", i.min(j), i.max(j))),
                false => Expr::ZERO,
            };
            let factors = Factors::of(&graph, &Matrix::from_fn(k, k, entry));
            let right = |s: usize| graph.symbol(&format!("r{s}"));
            for places in (0..k).map(|s| vec![s]).chain([vec![], vec![2, 7], vec![0, 3, 8]]) {
                let nonzero: Vec<_> = places.iter().map(|&s| (s, right(s))).collect();
                let whole: Vec<Expr<'_>> =
                    (0..k).map(|s| if places.contains(&s) { right(s) } else { Expr::ZERO }).collect();
                let expected = factors.solve(&graph, &whole).into_iter().enumerate();
                let expected: Vec<_> = expected.filter(|(_, x)| !x.is_zero()).collect();
                assert_eq!(factors.solve_nonzero(&graph, &nonzero), expected);
            }
        }
    }
}
