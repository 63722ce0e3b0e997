//! Forces, accelerations and inertias with six components.

use pc_expr::{Expr, Graph};

use crate::tree::spatial::{Tensor, Vector, cross, tensor, transpose, vector};
use crate::tree::tree::MassOnLink;
use crate::tree::turning::Turning;

/// Six components: rotation, then displacement; or moment, then force.
pub(crate) type Spatial<'g> = [Expr<'g>; 6];

pub(crate) fn joined<'g>(turning: &Vector<'g>, moving: &Vector<'g>) -> Spatial<'g> {
    std::array::from_fn(|i| if i < 3 { turning[i] } else { moving[i - 3] })
}

pub(crate) fn turning_part<'g>(a: &Spatial<'g>) -> Vector<'g> {
    vector(|i| a[i])
}

pub(crate) fn moving_part<'g>(a: &Spatial<'g>) -> Vector<'g> {
    vector(|i| a[i + 3])
}

/// A symmetric matrix with six rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia6<'g>(pub(crate) [[Expr<'g>; 6]; 6]);

impl<'g> Inertia6<'g> {
    /// The inertia of a body with this mass.
    pub(crate) fn rigid(body: &MassOnLink<'g>) -> Inertia6<'g> {
        let h = skew(&body.moment);
        Inertia6::of(&body.inertia, &h, &tensor(|i, j| if i == j { body.mass } else { Expr::ZERO }))
    }

    fn of(j: &Tensor<'g>, h: &Tensor<'g>, m: &Tensor<'g>) -> Inertia6<'g> {
        let entry = |r: usize, c: usize| match (r < 3, c < 3) {
            (true, true) => j[r][c],
            (true, false) => h[r][c - 3],
            (false, true) => h[c][r - 3],
            (false, false) => m[r - 3][c - 3],
        };
        Inertia6(std::array::from_fn(|r| std::array::from_fn(|c| entry(r, c))))
    }

    pub(crate) fn plus(&self, other: &Inertia6<'g>, graph: &'g Graph) -> Inertia6<'g> {
        self.map(|r, c, entry| graph.keep(entry + other.0[r][c]))
    }

    /// The symmetric matrix with `put` applied to each entry on and below the diagonal.
    pub(crate) fn map(&self, put: impl Fn(usize, usize, Expr<'g>) -> Expr<'g>) -> Inertia6<'g> {
        let mut mapped = *self;
        for r in 0..6 {
            for c in 0..=r {
                mapped.0[r][c] = put(r, c, self.0[r][c]);
                mapped.0[c][r] = mapped.0[r][c];
            }
        }
        mapped
    }

    fn blocks(&self) -> (Tensor<'g>, Tensor<'g>, Tensor<'g>) {
        (tensor(|i, j| self.0[i][j]), tensor(|i, j| self.0[i][j + 3]), tensor(|i, j| self.0[i + 3][j + 3]))
    }

    /// The inertia seen from the parent: rotated to the parent's axes, then taken about the parent's origin;
    /// the origin of the link is at `place` relative to the parent's origin.
    ///
    ///   G = Hᵀ − M r̂,   J ← J − H r̂ + r̂ G,   H ← Gᵀ
    pub(crate) fn seen(&self, graph: &'g Graph, turning: &Turning<'g>, place: &Vector<'g>) -> Inertia6<'g> {
        let (j, h, m) = self.blocks();
        let turned = |block: &Tensor<'g>| turning.matrix_to_parent(graph, block);
        let (j, h, m) = (turned(&j), turned(&h), turned(&m));
        let keep = |x: Expr<'g>| graph.keep(x);
        // In symmetric blocks the entries below the diagonal are those above.
        let symmetric = |a: Tensor<'g>| tensor(|i, k| if i <= k { a[i][k] } else { a[k][i] });
        let (j, m) = (symmetric(j), symmetric(m));
        // a r̂, row by row: r × over the columns
        let times_skew = |a: &Tensor<'g>| a.map(|row| cross(&row, place));
        let mr = times_skew(&m);
        let g = tensor(|i, k| keep(h[k][i] - mr[i][k]));
        let (hr, g_columns) = (times_skew(&h), transpose(&g));
        let rg = transpose(&g_columns.map(|column| cross(place, &column)));
        let moved =
            symmetric(tensor(
                |i, k| if i <= k { keep(keep(j[i][k] - hr[i][k]) + rg[i][k]) } else { Expr::ZERO },
            ));
        Inertia6::of(&moved, &g_columns, &m)
    }
}

/// A force expressed along the parent's axes and about its origin: f, n + r × f.
pub(crate) fn force_seen<'g>(
    graph: &'g Graph,
    turning: &Turning<'g>,
    place: &Vector<'g>,
    p: &Spatial<'g>,
) -> Spatial<'g> {
    let n = turning.to_parent(graph, &turning_part(p));
    let f = turning.to_parent(graph, &moving_part(p));
    let arm = cross(place, &f);
    joined(&vector(|i| graph.keep(n[i] + arm[i])), &f)
}

/// The parent's acceleration at the origin of the link: α, a + α × r.
pub(crate) fn acceleration_seen<'g>(
    graph: &'g Graph,
    turning: &Turning<'g>,
    place: &Vector<'g>,
    a: &Spatial<'g>,
) -> Spatial<'g> {
    let carried = cross(&turning_part(a), place);
    let moving = moving_part(a);
    let carried = vector(|i| graph.keep(moving[i] + carried[i]));
    joined(&turning.to_link(graph, &turning_part(a)), &turning.to_link(graph, &carried))
}

/// r̂ with r̂ v = r × v.
fn skew<'g>(r: &Vector<'g>) -> Tensor<'g> {
    [[Expr::ZERO, -r[2], r[1]], [r[2], Expr::ZERO, -r[0]], [-r[1], r[0], Expr::ZERO]]
}
