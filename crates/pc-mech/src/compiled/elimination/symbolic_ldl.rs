//! M = L D Lᵀ, unrolled over expressions.

use std::collections::{BTreeMap, BTreeSet};

use pc_algebra::{Matrix, determinant, inverse};
use pc_expr::{Expr, Graph};

/// The inverse of a symmetric matrix in the form in which it is applied. Zeros of the matrix cost nothing.
pub(crate) enum Factors<'g> {
    /// L D Lᵀ in the order of elimination that fills in least.
    Ldl(Ldl<'g>),
    /// The inverse itself, for a small matrix of both signs, such as that of L = ẋẏ: a pivot may vanish where it is regular.
    /// And for any without a usable pivot on its diagonal, and one of two rows whose determinant is much shorter than its
    /// pivots.
    Inverse(Matrix<Expr<'g>>),
}

/// The rows up to which a matrix of both signs is inverted whole; the inverse of more is long.
const MOST_INVERTED: usize = 3;

/// What vanishes where M is singular, or where its factors have no numbers.
pub(crate) struct Watched<'g> {
    /// The unknown that is undetermined there.
    pub(crate) place: usize,
    pub(crate) pivot: Expr<'g>,
    /// What its rounding is proportional to.
    pub(crate) size: Expr<'g>,
}

/// L is unit lower triangular in the order of elimination, D diagonal; both indexed as M is.
pub(crate) struct Ldl<'g> {
    order: Vec<usize>,
    /// The L_iq of each row i that are neither 0 nor on the diagonal, as (q, L_iq).
    rows: Vec<Entries<'g>>,
    /// The same of each column q, as (i, L_iq).
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

    /// The pivots D with the diagonal of M, of which they are what is left; or the determinant of an inverted M of few rows,
    /// with what that of its largest entry would be.
    pub(crate) fn watched(&self, graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Vec<Watched<'g>> {
        let rows = m.rows();
        match self {
            Factors::Ldl(ldl) => {
                let pivots = ldl.diagonal.iter().enumerate();
                pivots.map(|(place, &pivot)| Watched { place, pivot, size: m[(place, place)] }).collect()
            }
            Factors::Inverse(_) if rows <= MOST_INVERTED => {
                let largest = m.entries().iter().fold(Expr::ZERO, |largest, entry| largest.max(entry.abs()));
                let size = largest.powi(rows as i32);
                let pivot = determinant(graph, m).into_iter();
                pivot.map(|pivot| Watched { place: rows - 1, pivot, size }).collect()
            }
            Factors::Inverse(_) => Vec::new(),
        }
    }

    /// M⁻¹ r
    pub(crate) fn solve(&self, graph: &'g Graph, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        match self {
            Factors::Ldl(ldl) => ldl.solve(graph, right),
            Factors::Inverse(inverse) => (0..right.len())
                .map(|i| graph.dot(inverse.row(i).iter().copied(), right.iter().copied()))
                .collect(),
        }
    }
}

impl<'g> Ldl<'g> {
    /// √D_s L_is η_i
    pub(crate) fn orthonormal(&self, graph: &'g Graph, s: usize, eta: &[Expr<'g>]) -> Expr<'g> {
        let below = self.columns[s].iter().map(|&(i, l)| l * eta[i]);
        graph.exact_root(self.diagonal[s]) * graph.sum(below.chain([eta[s]]))
    }

    /// Whether two rows have a determinant that is much shorter than the pivots of which it is the product: of a relativistic
    /// particle it is a power of what stands under the root of its Lagrangian.
    fn is_longer(&self, graph: &'g Graph, m: &Matrix<Expr<'g>>) -> bool {
        let (2, Some(&last)) = (m.rows(), self.order.last()) else { return false };
        if !graph.know_root_powers(m.entries()) {
            return false;
        }
        let pivot = self.diagonal[last].tree_cost();
        determinant(graph, m).is_some_and(|determinant| determinant.tree_cost().saturating_mul(2) <= pivot)
    }

    /// Whether D has entries of both signs at some point; parameters that are positive as a rule are so there.
    fn has_both_signs(&self, graph: &'g Graph) -> bool {
        let symbols = graph.symbols_of(&self.diagonal);
        [0.0, 0.2, 0.6, 1.7].into_iter().any(|spread| {
            let place = |i: usize| (1.0 + spread * (1.0 + i as f64).sin()).abs();
            let values: Vec<_> = symbols.iter().enumerate().map(|(i, &symbol)| (symbol, place(i))).collect();
            let signs = graph.evaluate(&self.diagonal, &values).unwrap_or_default(); // every symbol has a value
            signs.iter().any(|&d| d > 0.0) && signs.iter().any(|&d| d < 0.0)
        })
    }

    /// Eliminates one row after the other, L_ip = S_ip/S_pp, S_ij ← S_ij − L_ip S_pp L_jp, always the row that has
    /// the fewest entries left, of these one whose pivot is a symbol: a wheel before the body that carries it. `None` if the diagonal that is left is zero.
    fn of(graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Option<Ldl<'g>> {
        let k = m.rows();
        let entries = |i: usize| m.row(i).iter().copied().enumerate().filter(|(_, x)| !x.is_zero()).collect();
        let mut schur: Vec<BTreeMap<usize, Expr<'g>>> = (0..k).map(entries).collect();
        let mut ldl = Ldl {
            order: Vec::new(),
            rows: vec![Vec::new(); k],
            columns: vec![Vec::new(); k],
            diagonal: vec![Expr::ONE; k],
        };
        let mut open: BTreeSet<usize> = (0..k).collect();
        while !open.is_empty() {
            let usable = open.iter().copied().filter(|&p| schur[p].contains_key(&p));
            let pivot = usable.min_by_key(|&p| (schur[p].len(), schur[p][&p].tree_cost() > 0))?;
            open.remove(&pivot);
            ldl.order.push(pivot);
            let mut eliminated = std::mem::take(&mut schur[pivot]);
            let d = eliminated.remove(&pivot)?; // the pivot is there, as its row was usable
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
        }
        Some(ldl)
    }

    fn solve(&self, graph: &'g Graph, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut z = right.to_vec();
        for &i in &self.order {
            z[i] = rest(graph, z[i], &self.rows[i], &z);
        }
        let divided = |(&z, &d): (&Expr<'g>, &Expr<'g>)| if z.is_zero() { z } else { z / d };
        let mut x: Vec<Expr<'g>> = z.iter().zip(&self.diagonal).map(divided).collect();
        for &i in self.order.iter().rev() {
            x[i] = rest(graph, x[i], &self.columns[i], &x);
        }
        x
    }
}

/// r − Σ_q l_q z_q
fn rest<'g>(graph: &'g Graph, r: Expr<'g>, l: &Entries<'g>, z: &[Expr<'g>]) -> Expr<'g> {
    let known: Vec<Expr<'g>> =
        l.iter().filter(|(q, _)| !z[*q].is_zero()).map(|&(q, l)| -(l * z[q])).collect();
    if known.is_empty() { r } else { graph.sum(known.into_iter().chain([r])) }
}
