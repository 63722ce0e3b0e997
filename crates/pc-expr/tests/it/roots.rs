//! Identities of roots, absolute values, fractional powers and inverse functions that are recognised, and
//! those that are not.

use pc_expr::{Expr, Graph, Number};

fn power<'g>(x: Expr<'g>, num: i64, den: i64) -> Expr<'g> {
    x.pow(Expr::ratio(num, den))
}

#[test]
fn roots_cancel_inside_sums() {
    let graph = Graph::new();
    let [x, y, q] = graph.symbols(["x", "y", "q"]);
    let (root, s) = ((1.0 + x.square()).sqrt(), (x * x.sin() + y).sqrt());
    let nested = (2.0 + root).sqrt();
    let q2 = 4.0 * q.square() + 1.0;
    let cube = power(y, 1, 3);
    let zeros = [
        (s + x) * (s - x) - (x * x.sin() + y - x.square()),
        (root + s).square() - root.square() - s.square() - 2.0 * root * s,
        1.0 / (root - x) - (root + x),
        x / (root - 1.0) - (root + 1.0) / x,
        1.0 / (1.0 + s + root) - (1.0 + s - root) / ((1.0 + s).square() - 1.0 - x.square()),
        (nested + root) * (nested - root) - (2.0 + root - 1.0 - x.square()),
        (nested + 1.0).powi(3) * (nested - 1.0).powi(3) - (1.0 + root).powi(3),
        (q2 * q.sqrt()).square() - (4.0 * q.powi(3) + q) * q2,
        (q.sqrt() + 4.0 * q.square() * q.sqrt()).square() - (4.0 * q.powi(3) + q) * q2,
        (cube + 1.0) * (cube.square() - cube + 1.0) - y - 1.0,
        (power(y, 2, 3) - 1.0) * (power(y, 4, 3) + power(y, 2, 3) + 1.0) - y.square() + 1.0,
        y * (1.0 + power(y, -1, 3)) - y - power(y, 2, 3),
        (x.abs() + y) * (x.abs() - y) - (x.square() - y.square()),
    ];
    for (i, zero) in zeros.into_iter().enumerate() {
        assert!(zero.is_zero(), "{i}: {zero}");
    }
}

#[test]
fn roots_of_products_are_products_where_signs_are_known() {
    let graph = Graph::new();
    let [x, y, k] = graph.symbols(["x", "y", "k"]);
    let (p, r) = (1.0 + x.square(), y.exp());
    let zeros = [
        (p * r).sqrt() - p.sqrt() * r.sqrt(),
        (x.square() * p).sqrt() - x.abs() * p.sqrt(),
        (x.square() * y).sqrt() - x.abs() * y.sqrt(),
        x.powi(3).sqrt() - x * x.sqrt(),
        (x.powi(2) / p).sqrt() - x.abs() / p.sqrt(),
        (x / p).sqrt() - x.sqrt() / p.sqrt(),
        x.square().sqrt() - x.abs(),
        p.powi(2).sqrt() - p,
        (1.0 - x.sin()).powi(2).sqrt() - (1.0 - x.sin()),
        p.abs() - p,
        (x * y).abs() - x.abs() * y.abs(),
        (x.powi(3) / y).abs() - x.abs().powi(3) / y.abs(),
        power(p * r, 1, 3) - power(p, 1, 3) * power(r, 1, 3),
        power(x.powi(4), 1, 3) - x.abs() * power(x.abs(), 1, 3),
        Expr::apply(pc_expr::Function::Pow, &[x, k - 1.0]) * x - x.pow(k),
    ];
    for (i, zero) in zeros.into_iter().enumerate() {
        assert!(zero.is_zero(), "{i}: {zero}");
    }
}

#[test]
fn functions_and_their_inverses_cancel() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let p = 1.0 + x.square();
    let zeros = [
        x.log().exp() - x,
        (3.0 * x.log() + y).exp() - x.powi(3) * y.exp(),
        (x.log() / 2.0).exp() - x.sqrt(),
        p.sqrt().log() - p.log() / 2.0,
        (p * y.exp()).log() - p.log() - y,
        x.square().log() - 2.0 * x.abs().log(),
        x.powi(3).log() - 3.0 * x.log(),
        x.asin().sin() - x,
        x.asin().cos() - (1.0 - x.square()).sqrt(),
        (2.0 * x.acos()).cos() - 2.0 * x.square() + 1.0,
        (y + x.acos()).cos() - x * y.cos() + y.sin() * (1.0 - x.square()).sqrt(),
        x.atan().tan() - x,
    ];
    for (i, zero) in zeros.into_iter().enumerate() {
        assert!(zero.is_zero(), "{i}: {zero}");
    }
}

/// True for some signs of x and y only.
#[test]
fn one_sided_identities_are_not_merged() {
    let graph = Graph::new();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let differences = [
        x.square().sqrt() - x,
        (x.square() + 2.0 * x + 1.0).sqrt() - x - 1.0,
        x.abs() - x,
        x.abs() + x,
        x.abs() * y.abs() - x * y,
        (x.powi(2) * y.powi(2)).sqrt() - x * y,
        (x.square() * y).sqrt() - x * y.sqrt(),
        (x * y).sqrt() * (x / y).sqrt() - x,
        (x * y).sqrt() * (y * z).sqrt() * (x * z).sqrt() - x * y * z,
        power(x.square(), 1, 3) - power(x, 2, 3),
        power(x.powi(6), 1, 3) - x.square() * x.abs() / x,
        x.square().log() - 2.0 * x.log(),
        (x * y).log() - x.log() - y.log(),
        x.sin().asin() - x,
        x.cos().acos() - x,
        (1.0 - x.cos().square()).sqrt() - x.sin(),
        x.sign().square() - 1.0,
        (x - 1.0).abs() - 1.0 + x,
    ];
    for (i, difference) in differences.into_iter().enumerate() {
        assert!(!difference.is_zero(), "{i}");
    }
}

/// (√x − 1)² + 2√x − 1 is x, which also has a value for x < 0.
#[test]
fn a_form_with_roots_does_not_replace_one_without() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let rooted = (x.sqrt() - 1.0) * (x.sqrt() + 1.0) + 1.0;
    assert_eq!(rooted, x);
    // cheaper, but without a value where y < 0
    let root = y.sqrt();
    let short = (root + 1.0) * (root - 1.0);
    let long = (y.square() + 2.0 * y - 3.0) / (y + 3.0);
    assert_eq!(short, long);
    assert_eq!(graph.evaluate(&[long, short], &[(y, -2.0)]).unwrap()[0], -3.0);
    let known = (x.square() * y).sqrt();
    let apart = x.abs() * root;
    let values = graph.evaluate(&[known, apart], &[(x, 0.0), (y, -1.0)]).unwrap();
    assert!(values[0] == 0.0 && (known - apart).is_zero());
}

#[test]
fn ranks_see_through_roots() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let (r, s) = (x.sqrt(), (1.0 + y.square()).sqrt());
    let rows = vec![vec![r, s, x], vec![x, r * s, x * r], vec![r * s, 1.0 + y.square(), x * s]];
    assert_eq!(graph.generic_rank(&rows), 1);
    let rows = vec![vec![x.abs(), x], vec![x, x.abs()]];
    assert_eq!(graph.generic_rank(&rows), 1);
    assert_eq!(graph.generic_rank(&[vec![x.abs(), x], vec![x, y]]), 2);
}

#[test]
fn relations_between_roots_are_found() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let r = (x.square() + y).sqrt();
    let columns = [(1.0 + r).square(), 1.0.into(), r, y, x.square()].map(|f| vec![f]);
    let expected = [[1, -1, -2, -1, -1].map(Number::integer).to_vec()];
    assert_eq!(graph.linear_relations(&columns), expected);
}

/// Many roots cost no more than their number.
#[test]
fn many_roots_stay_cheap() {
    let graph = Graph::new();
    let bodies: Vec<_> = (0..24).map(|i| graph.symbol(&format!("x{i}"))).collect();
    let pairs = (0..24).flat_map(|i| (0..i).map(move |j| (i, j)));
    let potential = graph.sum(pairs.map(|(i, j)| ((bodies[i] - bodies[j]).square() + 1.0).sqrt().powi(-1)));
    let forces = graph.gradient(potential, &bodies);
    let product = forces.iter().fold(Expr::ONE, |product, &force| product * (1.0 + force));
    assert!(!product.is_zero() && graph.len() < 10_000, "{} nodes", graph.len());
}

/// A tower of roots, (…(x^1.5)^1.5…)^1.5 = x^(1.5^n), takes work that grows with its height, not twice as much for
/// each storey: at twenty storeys that would be a million times as much.
#[test]
fn towers_of_roots_stay_small() {
    const HEIGHT: i32 = 20;
    let graph = Graph::new();
    let x = graph.symbol("x");
    let tower = (0..HEIGHT).fold(x, |storey, _| power(storey, 3, 2));
    let derivative = graph.gradient(tower, &[x])[0];
    let quotient = derivative / tower;
    let value = graph.evaluate(&[tower, derivative, quotient], &[(x, 1.0)]).unwrap();
    let exponent = 1.5f64.powi(HEIGHT);
    assert_eq!(value[0], 1.0);
    // Some two hundred roundings.
    assert!(value[1..].iter().all(|value| (value / exponent - 1.0).abs() < 1e-13), "{value:?}");
    assert!(graph.len() < 10_000, "{} nodes", graph.len());
}

/// Both sides are real for x ≥ 0 only. A power of a power that would be real for more x stays as it is.
#[test]
fn a_power_of_a_fractional_power_is_one_power() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    assert_eq!(power(x * x.sqrt(), 3, 2), power(x, 9, 4));
    assert_eq!(power(power(x, 9, 4), 3, 2), power(x, 27, 8));
    assert_eq!(power(power(y, 1, 3), 3, 2), y.sqrt());
    assert_eq!(power(x.sqrt().sqrt(), 3, 10), power(x, 3, 40));
    assert_eq!(power(power(x + y, -3, 2), 1, 5), power(x + y, -3, 10));
    for kept in [power(x.square(), 3, 2), power(x * y.sqrt(), 3, 2), power(power(x, 2, 3), 3, 2)] {
        let values = graph.evaluate(&[kept], &[(x, 0.7), (y, 1.9)]).unwrap();
        assert!(values[0].is_finite());
    }
    assert_ne!(power(x.square(), 3, 2), x.powi(3));
}

/// Each level of a tower of products of roots would double the work of the next.
#[test]
fn a_tower_of_powers_is_short() {
    let graph = Graph::new();
    let x = graph.symbol("x");
    let tower = (0..40).fold(x, |power, _| power.pow(1.1));
    let slope = tower.derivative(x);
    assert!(graph.len() < 200, "{} nodes", graph.len());
    let [value, slope] = graph.evaluate(&[tower, slope], &[(x, 1.01)]).unwrap()[..] else { unreachable!() };
    let exponent = 1.1f64.powi(40);
    // Some dozens of roundings of an exponent of 45.
    assert!((value / 1.01f64.powf(exponent) - 1.0).abs() < 1e-13);
    assert!((slope / (exponent * 1.01f64.powf(exponent - 1.0)) - 1.0).abs() < 1e-13);
}
