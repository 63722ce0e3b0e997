//! Roots, powers and quotients of one expression in several forms and of its negative, against direct evaluation.

use crate::common::{Bounded, Tree, call};
use pc_expr::{Expr, Folding, Function, Graph};
use proptest::prelude::*;

fn sum(a: Tree, b: Tree) -> Tree {
    Tree::Sum(a.into(), b.into())
}

fn difference(a: Tree, b: Tree) -> Tree {
    Tree::Difference(a.into(), b.into())
}

fn product(a: Tree, b: Tree) -> Tree {
    Tree::Product(a.into(), b.into())
}

fn square(a: Tree) -> Tree {
    Tree::Power(a.into(), 2)
}

fn function(f: Function, x: Tree) -> Tree {
    Tree::Call(f, vec![x])
}

/// ±E in one of several forms; E is one of six.
fn forms(which: usize, form: usize, negative: bool) -> Tree {
    let [x, y, z] = [0, 1, 2].map(Tree::Symbol);
    let number = Tree::Number;
    let exp = |x: Tree| function(Function::Exp, x);
    let written_out = |a: Tree, b: Tree, q| sum(difference(square(a), square(b)), number(q));
    let factored = |a: Tree, b: Tree, q| sum(product(difference(a.clone(), b.clone()), sum(a, b)), number(q));
    let positive = match (which, form) {
        (0, 0) => sum(difference(product(y, x.clone()), product(z, x)), number(1.0)),
        (0, _) if negative => return difference(product(difference(z, y), x), number(1.0)),
        (0, _) => sum(product(difference(y, z), x), number(1.0)),
        (1, 0) => written_out(x, y, 3.0),
        (1, _) if negative => return factored(y, x, -3.0),
        (1, _) => factored(x, y, 3.0),
        (2, 0) => sum(exp(sum(x, y)), number(1.0)),
        (2, _) => sum(product(exp(x), exp(y)), number(1.0)),
        (3, 0) => sum(product(number(2.0), square(function(Function::Sin, x))), square(y)),
        (3, _) => {
            let cos = square(function(Function::Cos, x));
            sum(difference(number(2.0), product(number(2.0), cos)), square(y))
        }
        (4, 0) => sum(product(x.clone(), z.clone()), product(y, z)),
        (4, _) => product(sum(x, y), z),
        (_, 0) => sum(square(sum(x, y)), number(1.0)),
        _ => {
            let mixed = product(number(2.0), product(x.clone(), y.clone()));
            sum(sum(sum(square(x), mixed), square(y)), number(1.0))
        }
    };
    if negative { difference(number(0.0), positive) } else { positive }
}

/// A function of ±E, to a power.
fn leaves(which: usize) -> impl Strategy<Value = Tree> {
    (0..2usize, any::<bool>(), 0..7, -3i32..4).prop_map(move |(form, negative, outer, e)| {
        let x = forms(which, form, negative);
        let power = |q| Tree::Call(Function::Pow, vec![x.clone(), Tree::Number(q)]);
        let outside = match outer {
            0 | 1 => function(Function::Sqrt, x),
            2 => power(1.5),
            3 => power(-0.5),
            4 => function(Function::Abs, x),
            5 => function(Function::Sign, x),
            _ => x,
        };
        Tree::Power(outside.into(), e)
    })
}

fn expressions() -> impl Strategy<Value = Vec<Tree>> {
    (0..6usize).prop_flat_map(|which| {
        let tree = leaves(which).prop_recursive(3, 8, 2, |inner| {
            (0..5, inner.clone(), inner).prop_map(|(operation, a, b)| match operation {
                0 => sum(a, b),
                1 => difference(a, b),
                2 => product(a, b),
                _ => Tree::Quotient(a.into(), b.into()),
            })
        });
        prop::collection::vec(tree, 6)
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1500,
        rng_seed: prop::test_runner::RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// All in one graph, in random order, so that a shorter form of ±E is made before or after an expression
    /// that contains E.
    #[test]
    fn no_sign_is_lost(trees in expressions(), point in prop::array::uniform3(0.2..2.0)) {
        for folding in [Folding::ByValue, Folding::Structural] {
            let graph = Graph::with_folding(folding);
            let symbols = graph.symbols(["x", "y", "z"]);
            let values = [0, 1, 2].map(|i| (symbols[i], Bounded::exact(point[i])));
            for tree in &trees {
                let expr = tree.expr(&symbols);
                let direct = tree.value(&values.map(|(_, value)| value));
                if direct.value.is_finite() && direct.error.is_finite() && !expr.is_undefined() {
                    let ours = graph.evaluate(&[expr], &values).unwrap()[0];
                    // The sizes are those of the terms: 1e-12 is some thousand roundings of each.
                    let tolerance = 1e-12 * (ours.size() + direct.size());
                    let difference = (ours.value - direct.value).abs();
                    prop_assert!(difference <= tolerance, "{expr}: {ours:?}, directly {direct:?}");
                }
            }
        }
    }
}

/// √E/(−E) = −1/√E where a shorter form of −E was made after √E.
#[test]
fn a_root_over_the_negative_of_its_radicand_is_negative() {
    let graph = Graph::new();
    let [a, b, x] = graph.symbols(["a", "b", "x"]);
    let root = (b * x - a * x + 1.0).sqrt();
    let negative = (a - b) * x - 1.0;
    let point = [(a, 2.0), (b, 5.0), (x, 1.0)];
    let value = |e: Expr<'_>| graph.evaluate(&[e], &point).unwrap()[0];
    assert_eq!(value(root / negative), -0.5);
    assert_eq!(value(negative / root), -2.0);
    assert_eq!(value(root.powi(3) / negative.powi(2)), 0.5);
    assert_eq!(root / negative, -1.0 / root);
    assert_eq!(call(Function::Pow, &[root.square(), Expr::ratio(3, 2)]) / negative, -root);
}
