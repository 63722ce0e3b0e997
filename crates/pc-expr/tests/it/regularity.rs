//! Forms of equal value stay distinct where one of them divides by zero.

use pc_expr::{Expr, Graph};

/// Forms of one function of x and y, with all divisors that are not identically zero.
type Forms = [fn(Expr<'static>, Expr<'static>) -> Expr<'static>; 4];

fn geometric(x: Expr<'static>, n: i32) -> Expr<'static> {
    (0..n).map(|i| x.powi(i)).sum()
}

/// An expression with a value as written keeps it, whichever other forms of it the graph contains, before or
/// after.
#[test]
fn singular_forms_do_not_replace_regular_ones() {
    let functions: [Forms; 4] = [
        [
            |x, _| geometric(x, 8),
            |x, _| (x.powi(8) - 1.0) / (x - 1.0),
            |x, y| (x.powi(8) * y - y) / (x * y - y),
            |x, _| (x.powi(8) - 1.0) * (x + 1.0) / (x.square() - 1.0),
        ],
        [
            |x, y| geometric(x, 7) / (y - 2.0),
            |x, y| (x.powi(7) - 1.0) / ((x - 1.0) * (y - 2.0)),
            |x, y| (x.powi(7) - 1.0) / (x * y - 2.0 * x - y + 2.0),
            |x, y| (x.powi(7) * y - y) / (x - 1.0) / (y * y - 2.0 * y),
        ],
        [
            |x, y| geometric(x, 4) * geometric(y, 4),
            |x, y| geometric(x, 4) * (y.powi(4) - 1.0) / (y - 1.0),
            |x, y| (x.powi(4) - 1.0) / (x - 1.0) * geometric(y, 4),
            |x, y| (x.powi(4) - 1.0) * (y.powi(4) - 1.0) / ((x - 1.0) * (y - 1.0)),
        ],
        [
            |x, y| (y * geometric(x, 6)).sin() + x,
            |x, y| (y * (x.powi(6) - 1.0) / (x - 1.0)).sin() + x,
            |x, y| (y * y * (x.powi(6) - 1.0) / (x * y - y)).sin() + x,
            |x, y| (y * geometric(x, 6)).sin() * y / y + x,
        ],
    ];
    let order = [0, 1, 2, 3];
    let orders =
        order.iter().flat_map(|&i| order.iter().map(move |&j| [i, j, 6 - i - j])).collect::<Vec<_>>();
    for (f, forms) in functions.iter().enumerate() {
        for order in orders.iter().filter(|[i, j, _]| i != j) {
            // Leaked, so that the same functions can make expressions of several graphs.
            let graph: &'static Graph = Box::leak(Box::new(Graph::new()));
            let [x, y] = graph.symbols(["x", "y"]);
            let forms = order.iter().filter_map(|&form| forms.get(form));
            let made: Vec<Expr<'static>> = forms.clone().map(|form| form(x, y)).collect();
            let again: Vec<Expr<'static>> = forms.clone().map(|form| 2.0 * form(x, y) - x).collect();
            for (a, b) in
                [(1.0, 0.5), (0.5, 0.0), (-1.0, 3.0), (0.0, 1.0), (1.0, 1.0), (2.0, -1.0), (1.0, 0.0)]
            {
                let point = [(x, a), (y, b)];
                for ((form, &made), &again) in forms.clone().zip(&made).zip(&again) {
                    let page = Graph::with_folding(pc_expr::Folding::Structural);
                    let page: &'static Graph = Box::leak(Box::new(page));
                    let [u, v] = page.symbols(["x", "y"]);
                    let direct = page.evaluate(&[form(u, v)], &[(u, a), (v, b)]).unwrap()[0];
                    if direct.is_finite() {
                        let ours = graph.evaluate(&[made, again], &point).unwrap();
                        let expected = [direct, 2.0 * direct - a];
                        for (ours, expected) in ours.iter().zip(expected) {
                            // some twenty roundings of terms of one sign or of small integers
                            let close = (ours - expected).abs() <= 1e-12 * (1.0 + expected.abs());
                            assert!(close, "function {f} at {point:?}: {made} is {ours}, not {expected}");
                        }
                    }
                }
            }
        }
    }
}

/// They are still equal, and their difference is 0.
#[test]
fn forms_that_are_singular_at_different_points_are_equal() {
    let graph = Graph::new();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let (a, b) = ((x * x - y * y) / (x - y) * z.sin(), (x * z + y * z) / z * z.sin());
    assert_eq!(a, b);
    assert!((a - b).is_zero());
    let (a, b) = ((x.powi(5) - 1.0) / (x - 1.0) / (z - 1.0), (x.powi(5) * y - y) / (z - 1.0) / (x * y - y));
    assert_eq!(a, b);
    assert_eq!(-a, -b);
    assert_ne!(a, -b);
    assert!((a - b).is_zero());
    assert_eq!(a / b, Expr::ONE);
    assert_eq!(3.0 * a - 3.0 * b + z, z);
}

/// A factor alone or inside a product, under a root or not, is the same divisor; an expression that never
/// vanishes is no divisor.
#[test]
fn equal_divisors_in_different_forms_are_recognised() {
    let graph = Graph::new();
    let [m, l, x, u] = graph.symbols(["m", "l", "x", "u"]);
    let product = m * m + m * l;
    let long = (x.sin().square() * m + x.cos().square() * m) / product;
    assert_eq!(m * (m + l), product);
    let short = 1.0 / (m + l);
    assert_eq!(long, short);
    let long = (x.sin().square() * u + x.cos().square() * u) / (u * x + u.square()); // contains no factor u (x + u)
    let short = 1.0 / (x + u);
    assert_eq!((long + u).to_string(), (short + u).to_string());
    assert!((long * u).tree_cost() <= (short * u).tree_cost());
    let long = (u.exp() * x.sin().square() + u.exp() * x.cos().square() + u.exp() * x) / u.exp();
    let short = x + 1.0 + u;
    assert_eq!((long + u).to_string(), short.to_string());
}
