//! M = L D Lᵀ, unrolled over expressions.

use pc_algebra::{Matrix, determinant, inverse};
use pc_expr::{Expr, Graph};

/// The inverse of a symmetric matrix in the form in which it is applied. Zeros of the matrix cost nothing.
pub(crate) enum Factors<'g> {
    /// L D Lᵀ in the order of elimination that fills in least.
    Ldl(Ldl<'g>),
    /// The inverse itself, for a small matrix of both signs, such as that of L = ẋẏ: a pivot may vanish where it is regular.
    /// And for any without a usable pivot on its diagonal.
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
    lower: Matrix<Expr<'g>>,
    diagonal: Vec<Expr<'g>>,
}

impl<'g> Factors<'g> {
    /// Factorises a matrix that is regular at almost all states.
    pub(crate) fn of(graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Factors<'g> {
        let undefined = || Matrix::from_fn(m.rows(), m.rows(), |_, _| Expr::ONE / Expr::ZERO);
        let lacks = (0..m.rows()).any(|s| m[(s, s)].is_zero());
        let inverted = |ldl: &Ldl<'g>| m.rows() <= MOST_INVERTED && (lacks || ldl.has_both_signs(graph));
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
        self.diagonal[s].sqrt() * graph.dot(self.lower.column(s), eta.iter().copied())
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
    /// the fewest entries left; `None` if the diagonal that is left is zero.
    fn of(graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Option<Ldl<'g>> {
        let k = m.rows();
        let mut schur = m.clone();
        let mut lower = Matrix::from_fn(k, k, |i, j| if i == j { Expr::ONE } else { Expr::ZERO });
        let mut diagonal = vec![Expr::ONE; k];
        let mut open: Vec<usize> = (0..k).collect();
        let mut order = Vec::with_capacity(k);
        while !open.is_empty() {
            let entries = |p: usize| open.iter().filter(|&&i| !schur[(i, p)].is_zero()).count();
            let pivot =
                open.iter().copied().filter(|&p| !schur[(p, p)].is_zero()).min_by_key(|&p| entries(p))?;
            open.retain(|&i| i != pivot);
            order.push(pivot);
            diagonal[pivot] = schur[(pivot, pivot)];
            for &i in &open {
                lower[(i, pivot)] = schur[(i, pivot)] / diagonal[pivot];
            }
            for &i in &open {
                for &j in open.iter().filter(|&&j| j <= i) {
                    let product = lower[(i, pivot)] * schur[(j, pivot)];
                    if !product.is_zero() {
                        let reduced = graph.sum([schur[(i, j)], -product]);
                        schur[(i, j)] = reduced;
                        schur[(j, i)] = reduced;
                    }
                }
            }
        }
        Some(Ldl { order, lower, diagonal })
    }

    fn solve(&self, graph: &'g Graph, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let l = &self.lower;
        let mut z = right.to_vec();
        for (done, &i) in self.order.iter().enumerate() {
            let known = self.order[..done].iter().map(|&q| -(l[(i, q)] * z[q]));
            z[i] = graph.sum(known.chain([z[i]]).collect::<Vec<_>>());
        }
        let mut x: Vec<Expr<'g>> = z.iter().zip(&self.diagonal).map(|(&z, &d)| z / d).collect();
        for (done, &i) in self.order.iter().enumerate().rev() {
            let known = self.order[done + 1..].iter().map(|&q| -(l[(q, i)] * x[q]));
            x[i] = graph.sum(known.chain([x[i]]).collect::<Vec<_>>());
        }
        x
    }
}
