//! Expressions that are affine or quadratic in some of their symbols.

use pc_expr::{Expr, Folding, Graph};

use crate::linear_algebra::matrix::Matrix;

/// The coefficients f_s and the rest f_0 of an expression f = f_s z_s + f_0 that is affine in the `symbols`
/// z; `None` if it is not affine.
///
/// |z|, max(z, 0) and the sign of z are not affine, though their second derivatives vanish.
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
    let slopes = graph.gradient(value, symbols);
    let known = smooth(graph, value, symbols) && !depend(graph, &slopes, symbols);
    let (coefficients, rest) = at_zero(graph, &slopes, value, symbols)?;
    let polynomial = || rest + graph.dot(coefficients.iter().copied(), symbols.iter().copied());
    (known || vanishes(graph, value - polynomial())).then_some((coefficients, rest))
}

/// An expression f = ½ z_r M_rs z_s + p_s z_s + f_0 in the symbols z.
#[derive(Clone, Debug)]
pub struct Quadratic<'g> {
    /// M, symmetric.
    pub matrix: Matrix<Expr<'g>>,
    /// p
    pub linear: Vec<Expr<'g>>,
    /// f_0
    pub constant: Expr<'g>,
}

/// The parts of an expression that is quadratic in the `symbols` z; `None` if it is not quadratic.
///
/// ```
/// # use pc_algebra::quadratic;
/// # use pc_expr::Graph;
/// let graph = Graph::new();
/// let [x, v] = graph.symbols(["x", "v"]);
/// let parts = quadratic(&graph, x * (v + 1.0).square(), &[v]).expect("quadratic in v");
/// assert_eq!((parts.matrix[(0, 0)], parts.linear[0], parts.constant), (2.0 * x, 2.0 * x, x));
/// assert!(quadratic(&graph, v.square() + v.abs(), &[v]).is_none());
/// ```
pub fn quadratic<'g>(graph: &'g Graph, value: Expr<'g>, symbols: &[Expr<'g>]) -> Option<Quadratic<'g>> {
    let k = symbols.len();
    let slopes = graph.gradient(value, symbols);
    let curvatures: Vec<Expr<'g>> = slopes.iter().flat_map(|&slope| graph.gradient(slope, symbols)).collect();
    let known = smooth(graph, value, symbols) && !depend(graph, &curvatures, symbols);
    let (mut parts, constant) = at_zero(graph, &[curvatures, slopes].concat(), value, symbols)?;
    let linear = parts.split_off(k * k);
    let matrix = Matrix::from_fn(k, k, |r, s| parts[r.max(s) * k + r.min(s)]);
    let dot = |row: &[Expr<'g>]| graph.dot(row.iter().copied(), symbols.iter().copied());
    let polynomial = || {
        let halves: Vec<Expr<'g>> = (0..k).map(|s| dot(&matrix.row(s)) / 2.0).collect();
        constant + dot(&halves) + dot(&linear)
    };
    (known || vanishes(graph, value - polynomial())).then_some(Quadratic { matrix, linear, constant })
}

/// The derivatives and the value at z = 0, if they are defined: an expression independent of z may still
/// contain divisions by z.
fn at_zero<'g>(
    graph: &'g Graph,
    derivatives: &[Expr<'g>],
    value: Expr<'g>,
    symbols: &[Expr<'g>],
) -> Option<(Vec<Expr<'g>>, Expr<'g>)> {
    let zeros: Vec<_> = symbols.iter().map(|&symbol| (symbol, Expr::ZERO)).collect();
    let mut parts = graph.substitute(&[derivatives, &[value]].concat(), &zeros);
    let value = parts.pop()?;
    let defined = parts.iter().chain([&value]).all(|part| !part.is_undefined());
    defined.then_some((parts, value))
}

/// Whether derivatives determine the value, up to rounding errors: true for functions without corners, jumps
/// and poles, since a function might continue differently beyond these.
fn smooth<'g>(graph: &'g Graph, value: Expr<'g>, symbols: &[Expr<'g>]) -> bool {
    !graph.applies(value, symbols, |function| !function.is_smooth()) && !graph.divides_by(value, symbols)
}

fn depend<'g>(graph: &'g Graph, values: &[Expr<'g>], symbols: &[Expr<'g>]) -> bool {
    let written: Vec<Expr<'g>> =
        graph.symbols_of(values).into_iter().filter(|symbol| symbols.contains(symbol)).collect();
    values.iter().any(|value| written.iter().any(|&symbol| value.depends_on(symbol)))
}

/// Whether the value of an expression is zero, even in a graph that merges only expressions of the same
/// structure.
fn vanishes<'g>(graph: &'g Graph, x: Expr<'g>) -> bool {
    if x.is_zero() || graph.folding() == Folding::ByValue {
        return x.is_zero();
    }
    let judge = graph.page(Folding::ByValue);
    let named = |symbol: Expr<'g>| Some((symbol, judge.symbol(&symbol.symbol_name()?)));
    let symbols: Vec<_> = graph.symbols_of(&[x]).into_iter().filter_map(named).collect();
    graph.evaluate(&[x], &symbols).is_ok_and(|values| values[0].is_zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slopes of these functions are constant wherever they exist.
    #[test]
    fn piecewise_affine_functions_are_not_affine() {
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
    fn affine_functions_are_recognised_in_any_form() {
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

    /// If factors are multiplied in another order, the coefficients differ in the last digits.
    #[test]
    fn rounded_coefficients_do_not_hide_a_polynomial() {
        let graph = Graph::new();
        let [x, y, z] = graph.symbols(["x", "y", "z"]);
        let nested = 0.1234567890123456 * (y + 0.9876543210987654 * (z + 0.7654321098765432 * x));
        assert!(affine(&graph, nested, &[y, z]).is_some());
        let square = 0.3333333333333333 * (nested + y * x.sin()).square();
        assert!(quadratic(&graph, square, &[y, z]).is_some());
        assert!(affine(&graph, square, &[y, z]).is_none());
        assert!(quadratic(&graph, square * nested, &[y, z]).is_none());
    }

    #[test]
    fn piecewise_quadratic_functions_are_not_quadratic() {
        for folding in [Folding::ByValue, Folding::Structural] {
            let graph = Graph::with_folding(folding);
            let [x, y, z] = graph.symbols(["x", "y", "z"]);
            let square = (y + x * z).square() / 2.0 + x.abs() * y;
            for more in [y.abs(), x * z.step(Expr::ONE, 2.0), y.square() * z.sign(), y * z.abs(), y * y.abs()]
            {
                assert!(quadratic(&graph, square + more, &[y, z]).is_none(), "{more}");
            }
            let parts = quadratic(&graph, square + x.cos(), &[y, z]).expect("quadratic");
            let known = [parts.matrix[(0, 0)], parts.matrix[(0, 1)], parts.matrix[(1, 1)], parts.linear[0]];
            let values = graph.evaluate(&[&known[..], &[parts.constant]].concat(), &[(x, -0.5)]);
            let expected = [1.0, -0.5, 0.25, 0.5, 0.5f64.cos()];
            assert_eq!(values.expect("values"), expected);
        }
    }
}
