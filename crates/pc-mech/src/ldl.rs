//! M = L D Lᵀ, unrolled over expressions.

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph};

/// The factors of a symmetric matrix: L unit lower triangular, D diagonal. Zeros of M cost nothing.
pub(crate) struct Ldl<'g> {
    graph: &'g Graph,
    lower: Matrix<Expr<'g>>,
    diagonal: Vec<Expr<'g>>,
}

impl<'g> Ldl<'g> {
    /// D_j = M_jj − Σ_q L_jq² D_q, L_ij = (M_ij − Σ_q L_iq L_jq D_q)/D_j, q < j < i.
    pub(crate) fn of(graph: &'g Graph, m: &Matrix<Expr<'g>>) -> Ldl<'g> {
        let k = m.rows();
        let mut lower = Matrix::from_fn(k, k, |i, j| if i == j { Expr::ONE } else { Expr::ZERO });
        let mut diagonal: Vec<Expr<'g>> = Vec::with_capacity(k);
        for j in 0..k {
            let reduced = |lower: &Matrix<Expr<'g>>, diagonal: &[Expr<'g>], i: usize| {
                let eliminated = (0..j).map(|q| -(lower[(i, q)] * lower[(j, q)] * diagonal[q]));
                graph.sum(eliminated.chain([m[(i, j)]]))
            };
            let pivot = reduced(&lower, &diagonal, j);
            for i in j + 1..k {
                lower[(i, j)] = reduced(&lower, &diagonal, i) / pivot;
            }
            diagonal.push(pivot);
        }
        Ldl { graph, lower, diagonal }
    }

    /// The pivots D.
    pub(crate) fn pivots(&self) -> &[Expr<'g>] {
        &self.diagonal
    }

    /// M⁻¹ r
    pub(crate) fn solve(&self, right: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let k = right.len();
        let l = &self.lower;
        let mut z: Vec<Expr<'g>> = Vec::with_capacity(k);
        for i in 0..k {
            let known = (0..i).map(|q| -(l[(i, q)] * z[q]));
            z.push(self.graph.sum(known.chain([right[i]])));
        }
        let mut x: Vec<Expr<'g>> = (0..k).map(|i| z[i] / self.diagonal[i]).collect();
        for i in (0..k).rev() {
            let known = (i + 1..k).map(|q| -(l[(q, i)] * x[q]));
            x[i] = self.graph.sum(known.chain([x[i]]));
        }
        x
    }
}
