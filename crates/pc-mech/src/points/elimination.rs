//! The elimination M = Lᵀ D L of the mass matrix of links, from the tips to the root.
//!
//! Beyond its hinge, which has the acceleration a, a link needs the force f there and the forces τ_s on its own
//! quasi-velocities:
//!
//!   f = Φ a + Φ_s η̇_s + p,   τ_s = Φ_s · a + φ_sr η̇_r + p_s,
//!
//! sums over its arms of inertia matrices A = m + Σ Φ of the links carried, with Φ = Σ A, Φ_s = Σ A u_s, φ_sr = Σ u_s ·
//! A u_r. Its own quasi-velocities are eliminated one by one, the last first: η̇_s = (τ_s − p_s − Φ_s · a − …)/φ_ss, Φ ←
//! Φ − Φ_s Φ_sᵀ/φ_ss, p ← p + Φ_s (τ_s − p_s)/φ_ss. There is no fill-in (Featherstone 1983).

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph};

use crate::points::links::{Arm, Link};
use crate::tree::spatial::{Tensor, Vector, ZERO, dot, tensor, vector};

/// The factors of a mass matrix.
#[derive(Clone, Debug)]
pub(crate) struct Elimination<'g> {
    graph: &'g Graph,
    links: Vec<Link<'g>>,
    /// For each link, A of each arm.
    inertias: Vec<Vec<Tensor<'g>>>,
    /// For each link, what is left of each of its own quasi-velocities when it is eliminated.
    eliminated: Vec<Vec<Column<'g>>>,
}

#[derive(Clone, Debug)]
struct Column<'g> {
    /// Φ_s
    of_hinge: Vector<'g>,
    /// φ_sr for the r before s.
    before: Vec<Expr<'g>>,
    /// φ_ss
    pivot: Expr<'g>,
    /// φ_ss before anything is eliminated.
    size: Expr<'g>,
}

impl<'g> Elimination<'g> {
    /// Factorises the mass matrix of links, to which `rest` adds for quasi-velocities of one link.
    pub(crate) fn of(graph: &'g Graph, links: Vec<Link<'g>>, rest: &Matrix<Expr<'g>>) -> Elimination<'g> {
        let keep = |x: Expr<'g>| graph.keep(x);
        let mut seen: Vec<Tensor<'g>> = vec![[ZERO; 3]; links.len()]; // Φ of each link after elimination
        let mut masses = vec![Expr::ZERO; links.len()]; // of all that a link carries
        let mut inertias = vec![Vec::new(); links.len()];
        let mut eliminated = vec![Vec::new(); links.len()];
        for (l, Link { own, arms, .. }) in links.iter().enumerate().rev() {
            let carried = |arm: &Arm<'g>| {
                arm.mass + arm.carried.iter().map(|&c| masses[c]).fold(Expr::ZERO, |a, b| a + b)
            };
            let of_arm = |arm: &Arm<'g>| {
                symmetric(|i, j| {
                    let own = if i == j { arm.mass } else { Expr::ZERO };
                    keep(graph.sum(arm.carried.iter().map(|&c| seen[c][i][j]).chain([own])))
                })
            };
            let arms_inertia: Vec<Tensor<'g>> = arms.iter().map(of_arm).collect();
            let total = |i: usize, j: usize| keep(graph.sum(arms_inertia.iter().map(|a| a[i][j])));
            let mut of_hinge = symmetric(total);
            // A u_s of each arm
            let moved: Vec<Vec<Vector<'g>>> = arms
                .iter()
                .zip(&arms_inertia)
                .map(|(arm, inertia)| {
                    arm.directions.iter().map(|u| vector(|i| keep(dot(graph, &inertia[i], u)))).collect()
                })
                .collect();
            let mut columns: Vec<Vector<'g>> = (0..own.len())
                .map(|s| vector(|i| keep(graph.sum(moved.iter().map(|moved| moved[s][i])))))
                .collect();
            let entry = |s: usize, r: usize| {
                let of_arms =
                    arms.iter().zip(&moved).map(|(arm, moved)| dot(graph, &arm.directions[r], &moved[s]));
                keep(graph.sum(of_arms.chain([rest[(own[s], own[r])]])))
            };
            let mut own_entries: Vec<Vec<Expr<'g>>> =
                (0..own.len()).map(|s| (0..=s).map(|r| entry(s, r)).collect()).collect();
            let size = |s: usize| {
                let of_arms =
                    arms.iter().map(|arm| carried(arm) * dot(graph, &arm.directions[s], &arm.directions[s]));
                graph.sum(of_arms.chain([rest[(own[s], own[s])]]))
            };
            let sizes: Vec<Expr<'g>> = (0..own.len()).map(size).collect();
            let mut left = Vec::new();
            for s in (0..own.len()).rev() {
                let pivot = own_entries[s][s];
                let (column, before) = (columns[s], own_entries[s][..s].to_vec());
                let of_column = column.map(|c| keep(c / pivot));
                let of_before: Vec<Expr<'g>> = before.iter().map(|&b| keep(b / pivot)).collect();
                of_hinge = symmetric(|i, j| keep(of_hinge[i][j] - of_column[i] * column[j]));
                for r in 0..s {
                    columns[r] = vector(|i| keep(columns[r][i] - of_before[r] * column[i]));
                    for q in 0..=r {
                        own_entries[r][q] = keep(own_entries[r][q] - of_before[r] * before[q]);
                    }
                }
                left.push(Column { of_hinge: column, before, pivot, size: sizes[s] });
            }
            left.reverse();
            masses[l] = graph.sum(arms.iter().map(carried));
            (seen[l], inertias[l], eliminated[l]) = (of_hinge, arms_inertia, left);
        }
        Elimination { graph, links, inertias, eliminated }
    }

    /// The number of quasi-velocities.
    pub(crate) fn size(&self) -> usize {
        self.links.iter().map(|link| link.own.len()).sum()
    }

    /// Each quasi-velocity with its pivot, and with the diagonal entry of M.
    pub(crate) fn pivots(&self) -> impl Iterator<Item = (usize, Expr<'g>, Expr<'g>)> + '_ {
        let links = self.links.iter().zip(&self.eliminated);
        links
            .flat_map(|(link, columns)| link.own.iter().zip(columns))
            .map(|(&s, column)| (s, column.pivot, column.size))
    }

    /// The η̇ of M η̇ + Σ m (∂v/∂η) · c = τ, where c is the acceleration of each point where all η̇ are 0: the sum of
    /// those of its arm, `biases`, and of the arms that carry it. Without biases c = 0.
    pub(crate) fn solve(&self, biases: Option<&[Vec<Vector<'g>>]>, tau: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let graph = self.graph;
        let keep = |x: Expr<'g>| graph.keep(x);
        let mut seen = vec![ZERO; self.links.len()]; // p of each link after elimination
        let mut driven: Vec<Vec<Expr<'g>>> = vec![Vec::new(); self.links.len()];
        for (l, Link { own, arms, .. }) in self.links.iter().enumerate().rev() {
            let of_arm = |(a, arm): (usize, &Arm<'g>)| {
                vector(|i| {
                    let bias = biases
                        .map_or(Expr::ZERO, |biases| dot(graph, &self.inertias[l][a][i], &biases[l][a]));
                    keep(graph.sum(arm.carried.iter().map(|&c| seen[c][i]).chain([bias])))
                })
            };
            let forces: Vec<Vector<'g>> = arms.iter().enumerate().map(of_arm).collect();
            let mut at_hinge = vector(|i| keep(graph.sum(forces.iter().map(|f| f[i]))));
            let mut left: Vec<Expr<'g>> = (0..own.len())
                .map(|s| {
                    let carried = arms.iter().zip(&forces).map(|(arm, f)| -dot(graph, &arm.directions[s], f));
                    keep(graph.sum(carried.chain([tau[own[s]]])))
                })
                .collect();
            for (s, column) in self.eliminated[l].iter().enumerate().rev() {
                let part = keep(left[s] / column.pivot);
                at_hinge = vector(|i| keep(at_hinge[i] + column.of_hinge[i] * part));
                for (r, &entry) in column.before.iter().enumerate() {
                    left[r] = keep(left[r] - entry * part);
                }
            }
            (seen[l], driven[l]) = (at_hinge, left);
        }
        let mut accelerations = vec![Expr::ZERO; self.size()];
        let mut of_arms: Vec<Vec<Vector<'g>>> = Vec::with_capacity(self.links.len());
        for (l, Link { own, hinge, arms, .. }) in self.links.iter().enumerate() {
            let at_hinge = hinge.map_or(ZERO, |(carrier, arm)| of_arms[carrier][arm]);
            let mut found: Vec<Expr<'g>> = Vec::with_capacity(own.len());
            for (s, column) in self.eliminated[l].iter().enumerate() {
                let known = found.iter().zip(&column.before).map(|(&w, &entry)| -(entry * w));
                let rest = known.chain([driven[l][s], -dot(graph, &column.of_hinge, &at_hinge)]);
                found.push(keep(graph.sum(rest) / column.pivot));
            }
            let moves = |(a, arm): (usize, &Arm<'g>)| {
                vector(|i| {
                    let bias = biases.map_or(Expr::ZERO, |biases| biases[l][a][i]);
                    let own = found.iter().zip(&arm.directions).map(|(&w, u)| w * u[i]);
                    keep(graph.sum(own.chain([at_hinge[i], bias])))
                })
            };
            of_arms.push(arms.iter().enumerate().map(moves).collect());
            own.iter().zip(found).for_each(|(&s, w)| accelerations[s] = w);
        }
        accelerations
    }
}

/// The symmetric matrix with these entries on and above the diagonal.
fn symmetric<'g>(entry: impl Fn(usize, usize) -> Expr<'g>) -> Tensor<'g> {
    let upper = tensor(|i, j| if i <= j { entry(i, j) } else { Expr::ZERO });
    tensor(|i, j| upper[i.min(j)][i.max(j)])
}
