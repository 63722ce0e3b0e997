//! Derivatives against dual numbers, at ordinary and at awkward points.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Mul, Neg};

use crate::common::{Bounded, Tree, call, trees};
use num_dual::{Dual64, DualNum, HyperDual64};
use pc_expr::{Expr, Folding, Function, Graph, Scalar};
use proptest::prelude::*;

/// A dual number as a scalar of the graph. Where a function is not differentiable, the conventions are the
/// graph's: |x|' = 0 at 0 and a jump has no derivative. Ties of min and max have a test of their own and are NaN here.
#[derive(Clone, Copy, Debug)]
struct Dual<T>(T);

impl<T: Add<Output = T>> Add for Dual<T> {
    type Output = Dual<T>;
    fn add(self, other: Dual<T>) -> Dual<T> {
        Dual(self.0 + other.0)
    }
}

impl<T: Mul<Output = T>> Mul for Dual<T> {
    type Output = Dual<T>;
    fn mul(self, other: Dual<T>) -> Dual<T> {
        Dual(self.0 * other.0)
    }
}

impl<T: Neg<Output = T>> Neg for Dual<T> {
    type Output = Dual<T>;
    fn neg(self) -> Dual<T> {
        Dual(-self.0)
    }
}

/// Whether the derivative parts are zero.
trait Constant {
    fn is_constant(&self) -> bool;
}

impl Constant for Dual64 {
    fn is_constant(&self) -> bool {
        self.eps == 0.0
    }
}

impl Constant for HyperDual64 {
    fn is_constant(&self) -> bool {
        [self.eps1, self.eps2, self.eps1eps2] == [0.0; 3]
    }
}

impl<T: DualNum<Primitive = f64> + Constant + Copy> Scalar for Dual<T> {
    fn from_f64(value: f64) -> Dual<T> {
        Dual(T::from(value))
    }

    /// By squaring: num-dual computes powers from x^(n−3), which overflows for small x.
    fn powi(self, exponent: i32) -> Dual<T> {
        let mut square = if exponent < 0 { self.0.recip() } else { self.0 };
        let mut result = T::from(1.0);
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result *= square;
            }
            square = square * square;
            rest >>= 1;
        }
        Dual(result)
    }

    fn call(function: Function, args: &[Dual<T>]) -> Dual<T> {
        let x = args[0].0;
        let zero = T::from(0.0);
        let shifted = |x: T, value: f64| x + T::from(value - x.re());
        let y = args.get(1).map_or(zero, |y| y.0);
        Dual(match function {
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Asin => x.asin(),
            Function::Acos => x.acos(),
            Function::Atan => x.atan(),
            // by the arc tangent of the smaller quotient: the atan2 of num-dual loses its digits near the axes
            Function::Atan2 if x.re().abs() <= y.re().abs() => shifted((x / y).atan(), x.re().atan2(y.re())),
            Function::Atan2 => shifted(-(y / x).atan(), x.re().atan2(y.re())),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Exp => x.exp(),
            Function::Log => x.ln(),
            Function::Sqrt => x.sqrt(),
            Function::Abs => x * T::from(Function::Sign.eval(&[x.re()])),
            Function::Sign => T::from(Function::Sign.eval(&[x.re()])),
            Function::Min if x.re() < y.re() => x,
            Function::Min if x.re() > y.re() => y,
            Function::Max if x.re() > y.re() => x,
            Function::Max if x.re() < y.re() => y,
            Function::Step if x.re() >= 0.0 => y,
            Function::Step if x.re() < 0.0 => args[2].0,
            Function::Min | Function::Max | Function::Step => T::from(f64::NAN) * x,
            Function::Pow if y.is_constant() => x.powf(y.re()),
            Function::Pow => x.powd(y),
        })
    }
}

/// A value and its derivative along a direction, each with a bound of the rounding errors of dual numbers:
/// δ(Σ f_i x_i') ≤ Σ |f_i| δx_i' + Σ |f_ij| |x_i'| δx_j + ε|…|.
#[derive(Clone, Copy, Debug)]
struct Traced {
    value: Bounded,
    rate: f64,
    error: f64,
}

impl Traced {
    fn new(value: Bounded, args: &[Traced], f: impl Fn(&[Dual<HyperDual64>]) -> Dual<HyperDual64>) -> Traced {
        let (mut rate, mut error) = (0.0, f64::MIN_POSITIVE);
        for i in 0..args.len() {
            for j in 0..args.len() {
                let at = |k: usize| {
                    let unit = |l: usize| f64::from(u8::from(k == l));
                    Dual(HyperDual64::new(args[k].value.value, unit(i), unit(j), 0.0))
                };
                let f = f(&(0..args.len()).map(at).collect::<Vec<_>>()).0;
                if i == j {
                    rate += f.eps1 * args[i].rate;
                    error +=
                        f.eps1.abs() * args[i].error + 4.0 * f64::EPSILON * (f.eps1 * args[i].rate).abs();
                }
                if args[i].rate != 0.0 && args[j].value.error > 0.0 {
                    error += (f.eps1eps2 * args[i].rate).abs() * args[j].value.error;
                }
            }
        }
        Traced { value, rate, error: if error.is_nan() { f64::INFINITY } else { error } }
    }

    fn size(self) -> f64 {
        self.error / f64::EPSILON + self.rate.abs()
    }
}

impl Add for Traced {
    type Output = Traced;
    fn add(self, other: Traced) -> Traced {
        Traced::new(self.value + other.value, &[self, other], |x| x[0] + x[1])
    }
}

impl Mul for Traced {
    type Output = Traced;
    fn mul(self, other: Traced) -> Traced {
        Traced::new(self.value * other.value, &[self, other], |x| x[0] * x[1])
    }
}

impl Neg for Traced {
    type Output = Traced;
    fn neg(self) -> Traced {
        Traced { value: -self.value, rate: -self.rate, ..self }
    }
}

impl Scalar for Traced {
    fn from_f64(value: f64) -> Traced {
        Traced { value: Bounded::from_f64(value), rate: 0.0, error: 0.0 }
    }
    fn powi(self, exponent: i32) -> Traced {
        let mut power = Traced::new(self.value.powi(exponent), &[self], |x| x[0].powi(exponent));
        power.error += f64::from(exponent).abs() * f64::EPSILON * power.rate.abs();
        power
    }
    fn call(function: Function, args: &[Traced]) -> Traced {
        let values: Vec<Bounded> = args.iter().map(|x| x.value).collect();
        Traced::new(Bounded::call(function, &values), args, |x| Dual::call(function, x))
    }
}

/// The tolerance, relative to the size of the terms.
const PROMISED: f64 = 1e-12;

fn bind<'g, S: Copy>(symbols: &[Expr<'g>], values: &[S]) -> Vec<(Expr<'g>, S)> {
    symbols.iter().copied().zip(values.iter().copied()).collect()
}

fn check_first_derivatives(tree: &Tree, point: &[f64]) {
    for folding in [Folding::ByValue, Folding::Structural] {
        let graph = Graph::with_folding(folding);
        let symbols: Vec<Expr> =
            ["x", "y", "z"][..point.len()].iter().map(|name| graph.symbol(name)).collect();
        let expr = tree.expr(&symbols);
        if expr.is_undefined() {
            continue; // a quotient by zero somewhere, or a constant such as log(0)
        }
        let bounded: Vec<Bounded> = point.iter().map(|&x| Bounded::exact(x)).collect();
        let values = bind(&symbols, &bounded);

        let direct: Bounded = tree.value(&bounded);
        let ours = graph.evaluate(&[expr], &values).unwrap()[0];
        if direct.value.is_finite() && direct.error.is_finite() {
            let difference = (direct.value - ours.value).abs();
            let tolerance = PROMISED * (direct.size() + ours.size());
            assert!(
                difference <= tolerance || ours.error == f64::INFINITY,
                "{expr} at {point:?}: {direct:?}, {ours:?}"
            );
        }

        let gradient = graph.gradient(expr, &symbols);
        for (i, &symbol) in symbols.iter().enumerate() {
            let unit = |j: usize| f64::from(u8::from(i == j));
            let duals: Vec<Dual<Dual64>> =
                point.iter().enumerate().map(|(j, &x)| Dual(Dual64::new(x, unit(j)))).collect();
            let traced: Vec<Traced> =
                (0..point.len()).map(|j| Traced { value: bounded[j], rate: unit(j), error: 0.0 }).collect();
            let reference = tree.value(&duals).0.eps;
            let size = tree.value(&traced).size();
            if !reference.is_finite() || !size.is_finite() {
                continue;
            }
            let rates: Vec<(Expr, Expr)> = (0..point.len()).map(|j| (symbols[j], unit(j).into())).collect();
            let forward = graph.directional(&[expr], &rates)[0];
            for derivative in [gradient[i], forward, expr.derivative(symbol)] {
                let ours = graph.evaluate(&[derivative], &values).unwrap()[0];
                let difference = (reference - ours.value).abs();
                assert!(
                    difference <= PROMISED * (size + ours.size()) || ours.error == f64::INFINITY,
                    "∂/∂{symbol} of {expr} ({folding:?}) at {point:?}: {reference} by dual numbers, \
                     {derivative} = {ours:?}, size {size:e}"
                );
            }
        }
    }
}

fn check_second_derivatives(tree: &Tree, point: &[f64]) {
    for folding in [Folding::ByValue, Folding::Structural] {
        let graph = Graph::with_folding(folding);
        let symbols: Vec<Expr> =
            ["x", "y", "z"][..point.len()].iter().map(|name| graph.symbol(name)).collect();
        let expr = tree.expr(&symbols);
        if expr.is_undefined() {
            continue; // a quotient by zero somewhere, or a constant such as log(0)
        }
        let bounded: Vec<Bounded> = point.iter().map(|&x| Bounded::exact(x)).collect();
        let values = bind(&symbols, &bounded);
        let gradient = graph.gradient(expr, &symbols);
        for i in 0..symbols.len() {
            let row = graph.gradient(gradient[i], &symbols);
            for j in 0..symbols.len() {
                let unit = |k: usize, l: usize| f64::from(u8::from(k == l));
                let duals: Vec<Dual<HyperDual64>> = (0..point.len())
                    .map(|k| Dual(HyperDual64::new(point[k], unit(k, i), unit(k, j), 0.0)))
                    .collect();
                let reference = tree.value(&duals).0.eps1eps2;
                let ours = graph.evaluate(&[row[j]], &values).unwrap()[0];
                // The first derivatives at nearby points bound the size of the terms of the dual numbers only
                // roughly: a factor of 1000 allows for that.
                let first: Bounded = graph.evaluate(&[gradient[i]], &values).unwrap()[0];
                let size = ours.size() + first.size() + tree.value(&bounded).size();
                if !reference.is_finite() || !size.is_finite() || size > 1e6 {
                    continue;
                }
                assert!(
                    (reference - ours.value).abs() <= 1e3 * PROMISED * size,
                    "∂²/∂{}∂{} of {expr} ({folding:?}) at {point:?}: {reference} by dual numbers, {} = {ours:?}",
                    symbols[i],
                    symbols[j],
                    row[j]
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: CASES,
        rng_seed: prop::test_runner::RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn first_derivatives_of_random_expressions(tree in trees(3), point in prop::array::uniform3(-2.0..2.0)) {
        check_first_derivatives(&tree, &point);
    }

    #[test]
    fn derivatives_at_round_points(tree in trees(3), point in prop::array::uniform3(-2i32..3)) {
        check_first_derivatives(&tree, &point.map(f64::from));
    }

    #[test]
    fn second_derivatives_of_random_expressions(tree in trees(2), point in prop::array::uniform2(-2.0..2.0)) {
        check_second_derivatives(&tree, &point);
    }
}

const CASES: u32 = 1500;

/// A function of as many symbols as it takes arguments.
fn plain(function: Function) -> Tree {
    Tree::Call(function, (0..function.arity()).map(Tree::Symbol).collect())
}

#[test]
fn every_function_at_awkward_points() {
    let coordinates = [
        0.0,
        1e-300,
        -1e-300,
        1e-8,
        -1e-8,
        0.3,
        -0.7,
        1.0 - 1e-9,
        1e-9 - 1.0,
        1.0,
        -1.0,
        FRAC_PI_2 - 1e-8,
        3.0,
        -20.0,
        700.0,
        1e6,
    ];
    for function in Function::ALL {
        let count = coordinates.len().pow(function.arity() as u32);
        for k in 0..count {
            let digits =
                (0..function.arity() as u32).map(|i| k / coordinates.len().pow(i) % coordinates.len());
            let point: Vec<f64> = digits.map(|digit| coordinates[digit]).collect();
            check_first_derivatives(&plain(function), &point);
            check_second_derivatives(&plain(function), &point);
        }
    }
}

#[test]
fn tangent_near_its_pole_and_powers_of_negative_numbers() {
    let x = || Box::new(Tree::Symbol(0));
    let quotient =
        |f, g| Tree::Quotient(Box::new(Tree::Call(f, vec![*x()])), Box::new(Tree::Call(g, vec![*x()])));
    for point in [0.0, 1e-12, FRAC_PI_2 - 1e-4, FRAC_PI_2 + 1e-7, FRAC_PI_2, -4.7123, PI - 1e-8, 1e4] {
        check_first_derivatives(&quotient(Function::Sin, Function::Cos), &[point]);
        check_first_derivatives(&quotient(Function::Cos, Function::Sin), &[point]);
    }
    for e in [-5, -2, -1, 0, 1, 2, 3, 7, 64] {
        for point in [-1.7, -1e-3, 0.0, 1e-20, 2.5] {
            check_first_derivatives(&Tree::Power(x(), e), &[point]);
            check_first_derivatives(
                &Tree::Call(Function::Pow, vec![*x(), Tree::Number(f64::from(e))]),
                &[point],
            );
        }
    }
}

#[test]
fn kinks_and_jumps_are_one_sided() {
    for folding in [Folding::ByValue, Folding::Structural] {
        let graph = Graph::with_folding(folding);
        let [x, y] = graph.symbols(["x", "y"]);
        let at = |e: Expr<'_>, a: f64, b: f64| graph.evaluate(&[e], &[(x, a), (y, b)]).unwrap()[0];
        for f in [x.min(y), x.max(y)] {
            let gradient = graph.gradient(f, &[x, y]);
            let at_tie = [at(gradient[0], 0.5, 0.5), at(gradient[1], 0.5, 0.5)];
            assert_eq!(at_tie, [1.0, 0.0], "one of the two counts at a tie, {f}");
            for (a, b) in [(0.5, 0.5 + 1e-15), (0.5 + 1e-15, 0.5), (-1e-300, 0.0), (0.0, -1e-300)] {
                let chosen = if at(f, a, b) == a { [1.0, 0.0] } else { [0.0, 1.0] };
                assert_eq!([at(gradient[0], a, b), at(gradient[1], a, b)], chosen, "{f} at {a}, {b}");
            }
        }
        assert_eq!(at(x.abs().derivative(x), 0.0, 0.0), 0.0);
        assert_eq!(at(x.abs().derivative(x), -1e-300, 0.0), -1.0);
        assert_eq!(at(x.step(y * 3.0, y * y).derivative(y), 0.0, 5.0), 3.0);
        assert_eq!(at(x.step(y * 3.0, y * y).derivative(y), -1e-300, 5.0), 10.0);
        assert!(x.step(y, 1.0).derivative(x).is_zero());
        assert!(x.sign().derivative(x).is_zero());
    }
}

#[test]
fn powers_with_half_integer_exponents_are_differentiable_at_zero() {
    let graph = Graph::new();
    let x = graph.symbol("x");
    let at_zero = |e: Expr<'_>| graph.evaluate(&[e], &[(x, 0.0)]).unwrap()[0];
    assert_eq!(at_zero(x.pow(1.5).derivative(x)), 0.0);
    assert_eq!(at_zero(x.pow(2.5).derivative(x).derivative(x)), 0.0);
    assert_eq!(x.pow(1.5).derivative(x), 1.5 * x.sqrt());
    assert_eq!(at_zero(x.sqrt().derivative(x)), f64::INFINITY);
}

#[test]
fn directions_may_be_expressions() {
    let graph = Graph::new();
    let [x, y, u, v] = graph.symbols(["x", "y", "u", "v"]);
    let rate = graph.directional(&[x * y, 3.0.into(), u], &[(x, u), (y, v)]);
    assert_eq!(rate[0], x * v + y * u);
    assert!(rate[1].is_zero() && rate[2].is_zero());
    assert_eq!(graph.directional(&[x * x], &[(x, x)])[0], 2.0 * x * x);
    assert_eq!(graph.gradient(x * y, &[y, y, u]), [x, x, Expr::ZERO]);
    assert_eq!(graph.gradient(x, &[x]), [Expr::ONE]);
    assert_eq!(call(Function::Sin, &[x]).derivative(x), x.cos());
}

/// Values and derivatives of the first and second order ignore the branch that is not taken, on both sides of
/// a switch.
#[test]
fn a_branch_that_is_not_taken_has_no_effect() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let root = (-x).pow(Expr::ratio(3, 2));
    // with their values and slopes for x > 0 and for x < 0
    let functions = [
        ((-x).step(root * y, Expr::ZERO), Expr::ZERO, root * y),
        (x.step(x.log() + y.square(), 1.0 / (x * y)), x.log() + y.square(), 1.0 / (x * y)),
        (y * x.step((x * y).sqrt(), x.square()), y * (x * y).sqrt(), y * x.square()),
        (x.step(y, (-40.0 * (x - y)).exp()).sin(), y.sin(), (-40.0 * (x - y)).exp().sin()),
        (
            (x.step((x * y).sqrt(), (-x).sqrt()) + y).square(),
            ((x * y).sqrt() + y).square(),
            ((-x).sqrt() + y).square(),
        ),
        (x.step((x - 1.0).step((x - 1.0).sqrt(), (1.0 - x).log()), Expr::ZERO), (1.0 - x).log(), Expr::ZERO),
    ];
    for (i, (function, above, below)) in functions.into_iter().enumerate() {
        for (side, expected) in [(0.25, above), (-0.25, below)] {
            let all = |f: Expr<'_>| {
                let gradient = graph.gradient(f, &[x, y]);
                let forward = graph.directional(&[f], &[(x, y), (y, 2.0.into())]);
                let second = gradient.iter().flat_map(|&slope| graph.gradient(slope, &[x, y])).collect();
                graph
                    .evaluate(&[vec![f], gradient, forward, second].concat(), &[(x, side), (y, 0.5)])
                    .unwrap()
            };
            let (found, expected) = (all(function), all(expected));
            for (found, expected) in found.iter().zip(&expected) {
                // some ten operations
                assert!(
                    (found - expected).abs() <= 1e-14 * expected.abs(),
                    "{i} at {side}: {found} {expected}"
                );
            }
        }
    }
}

/// At the corner itself the slopes are those of the branch that is taken.
#[test]
fn slopes_of_max_are_those_of_one_branch() {
    let graph = Graph::new();
    let x = graph.symbol("x");
    let guarded = (x.sqrt() - 1.0).max(-x);
    let slope = guarded.derivative(x);
    let values = [0.0, 0.04, 4.0].map(|at| graph.evaluate(&[slope], &[(x, at)]).unwrap()[0]);
    assert_eq!(values, [-1.0, -1.0, 0.25]);
}
