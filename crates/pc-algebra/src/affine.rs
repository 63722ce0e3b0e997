//! Expressions that are affine in some of their symbols.

use pc_expr::{Expr, Folding, Graph};

/// The coefficients f_s and the rest f_0 of an expression f = f_s z_s + f_0 that is affine in the `symbols` z; `None` for
/// one that is not.
///
/// Tested is the identity itself: of |z|, max(z, 0) and the sign of z all second derivatives vanish, too.
///
/// ```
/// # use pc_algebra::affine;
/// # use pc_expr::Graph;
/// let graph = Graph::new();
/// let [x, v] = graph.symbols(["x", "v"]);
/// assert_eq!(affine(&graph, x * (v + 2.0), &[v]), Some((vec![x], 2.0 * x)));
/// assert_eq!(affine(&graph, x * v.abs(), &[v]), None);
/// ```
pub fn affine<'g>(
    graph: &'g Graph,
    value: Expr<'g>,
    symbols: &[Expr<'g>],
) -> Option<(Vec<Expr<'g>>, Expr<'g>)> {
    let at_zero: Vec<_> = symbols.iter().map(|&symbol| (symbol, Expr::ZERO)).collect();
    let mut parts = graph.gradient(value, symbols);
    parts.push(value);
    // A coefficient written with a quotient of the symbols may hide its independence of them only at zero.
    let mut coefficients = graph.substitute(&parts, &at_zero);
    let rest = coefficients.pop()?;
    let linear = graph.dot(coefficients.iter().copied(), symbols.iter().copied());
    vanishes(graph, value - rest - linear).then_some((coefficients, rest))
}

/// Whether an expression is zero by its value, also where the graph merges only what is written alike.
fn vanishes<'g>(graph: &'g Graph, x: Expr<'g>) -> bool {
    if x.is_zero() || graph.folding() == Folding::ByValue {
        return x.is_zero();
    }
    let judge = Graph::new();
    let named = |symbol: Expr<'g>| Some((symbol, judge.symbol(&symbol.symbol_name()?)));
    let symbols: Vec<_> = graph.symbols_of(&[x]).into_iter().filter_map(named).collect();
    graph.evaluate(&[x], &symbols).is_ok_and(|values| values[0].is_zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Their slopes do not change with z wherever there are any.
    #[test]
    fn what_is_affine_in_pieces_only_is_not_affine() {
        let graph = Graph::new();
        let [x, z] = graph.symbols(["x", "z"]);
        for value in [
            z.abs(),
            z.sign(),
            z.max(Expr::ZERO),
            z.min(Expr::ZERO),
            z.max(x),
            z.step(Expr::ONE, 2.0),
            x + (2.0 * z + 1.0).abs(),
            z.square(),
            z * z.sign(),
        ] {
            assert_eq!(affine(&graph, value, &[z]), None, "{value}");
        }
    }

    #[test]
    fn what_is_affine_may_look_otherwise() {
        for folding in [Folding::ByValue, Folding::Structural] {
            let graph = Graph::with_folding(folding);
            let [x, y, z] = graph.symbols(["x", "y", "z"]);
            let value = (y * x.sin() + z * x.cos()) / 2.0 + x.cos() * (y - x * (z - y)) + x.abs();
            let (coefficients, rest) = affine(&graph, value, &[y, z]).expect("affine");
            let found = graph.evaluate(&[coefficients[0], coefficients[1], rest], &[(x, 0.5)]);
            let (sin, cos) = 0.5f64.sin_cos();
            let expected = [sin / 2.0 + 1.5 * cos, cos / 2.0 - 0.5 * cos, 0.5];
            for (found, expected) in found.expect("values").into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{found} {expected}"); // a few roundings
            }
            assert_eq!(affine(&graph, value + y * z, &[y, z]), None);
            assert_eq!(affine(&graph, value + z.abs(), &[y, z]), None);
        }
    }
}
