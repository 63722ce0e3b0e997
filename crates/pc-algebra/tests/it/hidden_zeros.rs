//! Random frames whose Gram matrices are full of well-hidden zeros, against difference quotients.

use pc_algebra::{Frame, Neighbourhood};
use pc_expr::{Expr, Graph};
use proptest::prelude::*;

/// A function of one variable that is defined everywhere but at a few points.
#[derive(Clone, Debug)]
enum Function {
    Variable,
    /// x + c with rational c
    Shifted(f64),
    Sum(Box<Function>, Box<Function>),
    Product(Box<Function>, Box<Function>),
    /// √(f² + 1)
    Root(Box<Function>),
    /// √(f² g), g = e^h
    RootOfProduct(Box<Function>, Box<Function>),
    /// |f|
    Size(Box<Function>),
    /// (f² + 1)^(1/3)
    CubeRoot(Box<Function>),
    /// log(f² + 2)
    Logarithm(Box<Function>),
    /// 1/(√(f² + 1) + 2)
    Reciprocal(Box<Function>),
    /// cos(atan f)
    Cosine(Box<Function>),
}

impl Function {
    fn of<'g>(&self, x: Expr<'g>) -> Expr<'g> {
        let square = |f: &Function| f.of(x).square();
        match self {
            Function::Variable => x,
            Function::Shifted(c) => x + *c,
            Function::Sum(f, g) => f.of(x) + g.of(x),
            Function::Product(f, g) => f.of(x) * g.of(x),
            Function::Root(f) => (square(f) + 1.0).sqrt(),
            Function::RootOfProduct(f, g) => (square(f) * g.of(x).exp()).sqrt(),
            Function::Size(f) => f.of(x).abs(),
            Function::CubeRoot(f) => (square(f) + 1.0).pow(Expr::ratio(1, 3)),
            Function::Logarithm(f) => (square(f) + 2.0).log(),
            Function::Reciprocal(f) => 1.0 / ((square(f) + 1.0).sqrt() + 2.0),
            Function::Cosine(f) => f.of(x).atan().cos(),
        }
    }
}

fn functions() -> impl Strategy<Value = Function> {
    let shift = prop::sample::select(&[-1.5, -1.0, 0.5, 2.0][..]);
    let leaf = prop_oneof![3 => Just(Function::Variable), 1 => shift.prop_map(Function::Shifted)];
    leaf.prop_recursive(4, 12, 2, |inner| {
        let one = || inner.clone().prop_map(Box::new);
        prop_oneof![
            2 => (one(), one()).prop_map(|(f, g)| Function::Sum(f, g)),
            2 => (one(), one()).prop_map(|(f, g)| Function::Product(f, g)),
            2 => one().prop_map(Function::Root),
            1 => (one(), one()).prop_map(|(f, g)| Function::RootOfProduct(f, g)),
            1 => one().prop_map(Function::Size),
            1 => one().prop_map(Function::CubeRoot),
            1 => one().prop_map(Function::Logarithm),
            1 => one().prop_map(Function::Reciprocal),
            1 => one().prop_map(Function::Cosine),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: prop::test_runner::RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// X_1 = a ∂_q, X_2 = r ∂_q + ∂_h, and z = f(q) is carried along: [X_1, X_2] = (r' − r a'/a) X_1.
    #[test]
    fn brackets_agree_with_difference_quotients(
        (a, r, f) in (functions(), functions(), functions()),
        at in prop_oneof![-0.9..-0.2, 0.2..0.9],
    ) {
        let graph = Graph::new();
        let [t, q, z, h, u, w] = graph.symbols(["t", "q", "z", "h", "u", "w"]);
        let (a, r, f) = (a.of(q).square() + 0.5, r.of(q), f.of(q));
        let rate = a * u + r * w;
        let velocities = [rate, f.derivative(q) * rate, w];
        let value = |x: Expr<'_>, q0: f64| graph.evaluate(&[x], &[(q, q0)]).unwrap()[0];
        let step = 1e-5;
        let slope = |x: Expr<'_>| (value(x, at + step) - value(x, at - step)) / (2.0 * step);
        // Beyond corners and on steep slopes a difference quotient says little.
        let curvature = |x: Expr<'_>| (value(x, at + step) - 2.0 * value(x, at) + value(x, at - step)).abs() / step;
        let size = [a, r, f, f.derivative(q)].map(|x| value(x, at).abs().max(slope(x).abs())).into_iter().fold(1.0, f64::max);
        prop_assume!(size < 1e2 && [a, r, f].into_iter().all(|x| curvature(x) < 1e-2));

        let frame = Frame::from_velocities(&graph, t, vec![q, z, h], &[u, w], &velocities).unwrap();
        let near = Neighbourhood { centre: vec![(q, at)] };
        let c = frame.structure_coefficients(&near).unwrap();
        let expected = slope(r) - value(r, at) * slope(a) / value(a, at);
        let found = graph.evaluate(&[c.get(1, 2, 1), c.get(1, 2, 2)], &[(q, at)]).unwrap();
        // h² times third derivatives, and rounding over h
        prop_assert!((found[0] - expected).abs() < 1e-6 * size * size, "{found:?}, not {expected}: {c:?}");
        prop_assert!(found[1].abs() < 1e-9, "{found:?}");
    }
}
