//! Products of powers, the terms of polynomials with unknown coefficients.

use pc_mech::{Expr, Graph, Number};

/// A factor in monomials, and the largest power to which it is raised.
pub(crate) type Generator<'g> = (Expr<'g>, u32);

/// The products of powers of the generators that have a degree in 0..=`degree`, simple ones first.
pub(crate) fn monomials<'g>(generators: &[Generator<'g>], degree: u32) -> Vec<Expr<'g>> {
    (0..=degree).flat_map(|degree| of_degree(generators, degree)).collect()
}

/// The products of a single degree.
fn of_degree<'g>(generators: &[Generator<'g>], degree: u32) -> Vec<Expr<'g>> {
    let Some((&(z, largest), rest)) = generators.split_first() else {
        return if degree == 0 { vec![Expr::ONE] } else { Vec::new() };
    };
    let powers = (0..=largest.min(degree)).rev();
    let with_power = |e: u32| {
        let power = (0..e).fold(Expr::ONE, |power, _| power * z);
        of_degree(rest, degree - e).into_iter().map(move |monomial| power * monomial)
    };
    powers.flat_map(with_power).collect()
}

/// Σ a_j f_j
pub(crate) fn combination<'g>(graph: &'g Graph, a: &[Number], functions: &[Expr<'g>]) -> Expr<'g> {
    graph.dot(a.iter().map(|&a| a.into()), functions.iter().copied())
}

/// Those of `candidates` that are independent of `known` and of earlier candidates: each raises the rank of
/// ∂f/∂z at almost all points.
pub(crate) fn independent<'g>(
    graph: &'g Graph,
    variables: &[Expr<'g>],
    known: &[Expr<'g>],
    candidates: impl IntoIterator<Item = Expr<'g>>,
) -> Vec<Expr<'g>> {
    let mut gradients: Vec<Vec<Expr<'g>>> = known.iter().map(|&f| graph.gradient(f, variables)).collect();
    let mut rank = graph.generic_rank(&gradients);
    let mut chosen = Vec::new();
    for candidate in candidates {
        gradients.push(graph.gradient(candidate, variables));
        let larger = graph.generic_rank(&gradients);
        if larger > rank {
            rank = larger;
            chosen.push(candidate);
        } else {
            gradients.pop();
        }
    }
    chosen
}
