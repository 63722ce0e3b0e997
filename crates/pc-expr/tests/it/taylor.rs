//! Taylor coefficients of solutions against series in twice the precision, composed from the definitions of
//! the functions.

use std::ops::{Add, Mul, Neg};

use crate::common::{Tree, trees};
use pc_expr::{Backend, Function, Graph, Inputs, Program, Scalar, TaylorSeries};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// A number as the sum of two [Dekker 1971].
#[derive(Clone, Copy, Debug, Default)]
struct Double(f64, f64);

impl Double {
    fn fast(a: f64, b: f64) -> Double {
        let s = a + b;
        Double(s, b - (s - a))
    }
    fn recip(self) -> Double {
        let q = Double(1.0 / self.0, 0.0);
        let correction = |q: Double| q + q * (Double(1.0, 0.0) + -(q * self));
        correction(correction(q))
    }
}

impl Add for Double {
    type Output = Double;
    fn add(self, other: Double) -> Double {
        let s = self.0 + other.0;
        let v = s - self.0;
        let e = (self.0 - (s - v)) + (other.0 - v);
        Double::fast(s, e + self.1 + other.1)
    }
}

impl Mul for Double {
    type Output = Double;
    fn mul(self, other: Double) -> Double {
        let p = self.0 * other.0;
        let e = self.0.mul_add(other.0, -p);
        Double::fast(p, e + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Neg for Double {
    type Output = Double;
    fn neg(self) -> Double {
        Double(-self.0, -self.1)
    }
}

const ORDER: usize = 14;

/// Σ c_k tᵏ up to the order.
#[derive(Clone, Copy, Debug)]
struct Series([Double; ORDER + 1]);

impl Series {
    fn number(value: f64) -> Series {
        let mut series = Series([Double::default(); ORDER + 1]);
        series.0[0] = Double(value, 0.0);
        series
    }
    fn time(t: f64) -> Series {
        let mut series = Series::number(t);
        series.0[1] = Double(1.0, 0.0);
        series
    }
    fn scale(self, factor: Double) -> Series {
        Series(self.0.map(|c| c * factor))
    }
    /// Σ f_n (u − u₀)ⁿ, f_n from its predecessor and n.
    fn compose(self, first: f64, next: impl Fn(Double, usize, Double) -> Double) -> Series {
        let mut v = self;
        let centre = std::mem::take(&mut v.0[0]);
        let mut factors = vec![Double(first, 0.0)];
        for n in 1..=ORDER {
            factors.push(next(factors[n - 1], n, centre));
        }
        factors.iter().rev().fold(Series::number(0.0), |sum, &f| {
            let mut constant = Series::number(0.0);
            constant.0[0] = f;
            sum * v + constant
        })
    }
    fn integral(self, constant: f64) -> Series {
        let mut series = Series::number(constant);
        for k in 1..=ORDER {
            series.0[k] = self.0[k - 1] * Double(k as f64, 0.0).recip();
        }
        series
    }
    fn rate(self) -> Series {
        let mut series = Series::number(0.0);
        for k in 0..ORDER {
            series.0[k] = self.0[k + 1] * Double((k + 1) as f64, 0.0);
        }
        series
    }
    fn value(self) -> f64 {
        self.0[0].0
    }
    /// u^c for u₀ > 0: f_n = f_{n−1} (c − n + 1)/(n u₀)
    fn power(self, c: f64) -> Series {
        self.compose(self.value().powf(c), |f, n, u| {
            f * Double(c - (n - 1) as f64, 0.0) * (u * Double(n as f64, 0.0)).recip()
        })
    }
    fn recip(self) -> Series {
        let series = self.compose(1.0, |f, _, u| -(f * u.recip()));
        series.scale(self.0[0].recip())
    }
    fn exp(self, even: f64, odd: f64, sign: f64) -> Series {
        // The n-th derivative is that of order n − 2 times the sign.
        let mut v = self;
        v.0[0] = Double::default();
        let (mut sum, mut power) = (Series::number(0.0), Series::number(1.0));
        for n in 0..=ORDER {
            let derivative = if n % 2 == 0 { even } else { odd } * sign.powi(n as i32 / 2);
            sum = sum + power.scale(Double(derivative, 0.0));
            power = (power * v).scale(Double((n + 1) as f64, 0.0).recip());
        }
        sum
    }
}

impl Add for Series {
    type Output = Series;
    fn add(self, other: Series) -> Series {
        Series(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Mul for Series {
    type Output = Series;
    fn mul(self, other: Series) -> Series {
        Series(std::array::from_fn(|k| {
            (0..=k).fold(Double::default(), |sum, j| sum + self.0[j] * other.0[k - j])
        }))
    }
}

impl Neg for Series {
    type Output = Series;
    fn neg(self) -> Series {
        Series(self.0.map(|c| -c))
    }
}

impl Scalar for Series {
    fn from_f64(value: f64) -> Series {
        Series::number(value)
    }
    fn powi(self, exponent: i32) -> Series {
        let power = (0..exponent.unsigned_abs()).fold(Series::number(1.0), |power, _| power * self);
        if exponent < 0 { power.recip() } else { power }
    }
    fn call(function: Function, args: &[Series]) -> Series {
        let u = args[0];
        let x = u.value();
        let one = Series::number(1.0);
        if args.iter().take(2).any(|u| u.value().is_nan()) {
            return Series::number(f64::NAN);
        }
        let leads = |u: Series| u.0.iter().map(|c| c.0).find(|c| *c != 0.0).unwrap_or(0.0);
        match function {
            Function::Sin => u.exp(x.sin(), x.cos(), -1.0),
            Function::Cos => u.exp(x.cos(), -x.sin(), -1.0),
            Function::Sinh => u.exp(x.sinh(), x.cosh(), 1.0),
            Function::Cosh => u.exp(x.cosh(), x.sinh(), 1.0),
            Function::Exp => u.exp(x.exp(), x.exp(), 1.0),
            Function::Tanh => {
                let [sinh, cosh] = [Function::Sinh, Function::Cosh].map(|f| Series::call(f, args));
                (sinh * cosh.recip()).rate().integral(x.tanh())
            }
            Function::Log => (u.rate() * u.recip()).integral(x.ln()),
            Function::Sqrt => u.power(0.5),
            Function::Atan => (u.rate() * (one + u * u).recip()).integral(x.atan()),
            Function::Asin => (u.rate() * (one + -(u * u)).power(-0.5)).integral(x.asin()),
            Function::Acos => (-(u.rate() * (one + -(u * u)).power(-0.5))).integral(x.acos()),
            Function::Atan2 => {
                let (y, x) = (u, args[1]);
                let moment = x * y.rate() + -(y * x.rate());
                (moment * (x * x + y * y).recip()).integral(y.value().atan2(x.value()))
            }
            Function::Pow if args[1].0[1..].iter().all(|c| c.0 == 0.0) => u.power(args[1].value()),
            Function::Pow => {
                let log = Series::call(Function::Log, &[u]);
                let value = x.powf(args[1].value());
                (args[1] * log).exp(value, value, 1.0)
            }
            Function::Abs if leads(u) >= 0.0 => u,
            Function::Abs => -u,
            Function::Sign => Series::number(if leads(u) == 0.0 { 0.0 } else { leads(u).signum() }),
            Function::Min if leads(args[1] + -u) >= 0.0 => u,
            Function::Max if leads(u + -args[1]) >= 0.0 => u,
            Function::Min | Function::Max => args[1],
            Function::Step if leads(u) >= 0.0 => args[1],
            Function::Step => args[2],
        }
    }
}

/// The coefficients by Picard's iteration, each step of which gives one more.
fn expected(rates: &[Tree], t: f64, start: &[f64]) -> Vec<Series> {
    let mut solution: Vec<Series> = start.iter().map(|&y| Series::number(y)).collect();
    for _ in 0..ORDER {
        let mut symbols = vec![Series::time(t)];
        symbols.extend(&solution);
        solution = rates.iter().zip(start).map(|(rate, &y)| rate.value(&symbols).integral(y)).collect();
    }
    solution
}

/// The coefficients of orders 1 to `ORDER` by the recurrences, and the coefficients of the branch functions.
fn found(rates: &[Tree], t: f64, start: &[f64], backend: Backend) -> Option<Vec<Vec<f64>>> {
    let graph = Graph::new();
    let symbols: Vec<_> = (0..=rates.len()).map(|i| graph.symbol(&format!("s{i}"))).collect();
    let inputs = Inputs { time: Some(symbols[0]), state: symbols[1..].to_vec(), parameters: Vec::new() };
    let outputs: Vec<_> = rates.iter().map(|rate| rate.expr(&symbols)).collect();
    let program = Program::new(&graph, &inputs, &outputs).ok()?;
    let mut series = TaylorSeries::new(&program, backend);
    let mut sides = vec![0.0; series.branches().len()];
    // Signs at zero follow from the first nonzero coefficient.
    for _ in 0..8 {
        series.expand(t, start, &sides, &[], ORDER);
        let leading = |i: usize| {
            (0..ORDER).map(|k| series.branch_coefficients(k)[i]).find(|c| *c != 0.0).unwrap_or(0.0)
        };
        sides = (0..sides.len()).map(|i| if leading(i) == 0.0 { 0.0 } else { leading(i).signum() }).collect();
    }
    Some((1..=ORDER).map(|k| series.coefficients(k).to_vec()).collect())
}

/// u̇ = 0.3 − u w/2, ẇ = u + t/5, and the given `rate`, a function of (t, u, w).
fn with_carrier(rate: Tree) -> Vec<Tree> {
    use Tree::{Difference, Number, Product, Sum, Symbol};
    let product = |a, b| Box::new(Product(Box::new(a), Box::new(b)));
    let half = product(Number(0.5), *product(Symbol(1), Symbol(2)));
    let first = Difference(Box::new(Number(0.3)), half);
    let second = Sum(Box::new(Symbol(1)), product(Number(0.2), Symbol(0)));
    vec![first, second, rate]
}

/// Compares relative to the coefficients of neighbouring orders, as a single one may be small by chance.
fn check(rates: &[Tree], t: f64, start: &[f64], tolerance: f64) {
    let right = expected(rates, t, start);
    for backend in [Backend::Fastest, Backend::Interpreter] {
        let found = found(rates, t, start, backend).unwrap();
        for k in 1..=ORDER {
            for (i, right) in right.iter().enumerate() {
                let near = (k.max(3) - 2..=ORDER.min(k + 2)).map(|j| right.0[j].0.abs());
                let size = near.fold(0.0, f64::max);
                let error = (found[k - 1][i] - right.0[k].0).abs();
                assert!(error <= tolerance * size, "{rates:?}: y{i}, order {k}: {error:e} of {size:e}");
            }
        }
    }
}

/// The rounding of some tens of terms, each of the size of neighbouring coefficients: 14 orders of at most
/// two sums.
const ROUNDING: f64 = 1e-14;

#[test]
fn each_recurrence_is_exact() {
    let start = [0.4, 0.7, 0.1];
    let (u, w) = (|| Tree::Symbol(1), || Tree::Symbol(2));
    for function in Function::ALL {
        let args = [u(), w(), Tree::Product(Box::new(u()), Box::new(w()))];
        let args = args[..function.arity()].to_vec();
        check(&with_carrier(Tree::Call(function, args)), 0.3, &start, ROUNDING);
    }
    let pair = || (Box::new(u()), Box::new(w()));
    let (a, b) = pair();
    check(&with_carrier(Tree::Quotient(a, b)), 0.3, &start, ROUNDING);
    for exponent in [-3, -1, 2, 3, 7] {
        check(&with_carrier(Tree::Power(Box::new(u()), exponent)), 0.3, &start, ROUNDING);
    }
    for (first, second) in [(u(), Tree::Number(1.7)), (Tree::Number(1.7), u()), (u(), Tree::Number(-0.3))] {
        check(
            &with_carrier(Tree::Call(Function::Pow, vec![first.clone(), second.clone()])),
            0.3,
            &start,
            ROUNDING,
        );
        check(&with_carrier(Tree::Call(Function::Atan2, vec![first, second])), 0.3, &start, ROUNDING);
    }
}

#[test]
fn branches_at_a_corner_follow_the_motion() {
    // |u|, sign u, min(u, w), max(u, w), step(u, …) where u and w begin at the same 0.
    let start = [0.0, 0.0, 0.1];
    let (u, w) = (|| Tree::Symbol(1), || Tree::Symbol(2));
    for function in [Function::Abs, Function::Sign, Function::Min, Function::Max, Function::Step] {
        let args = [u(), w(), Tree::Product(Box::new(u()), Box::new(w()))];
        check(&with_carrier(Tree::Call(function, args[..function.arity()].to_vec())), -0.3, &start, ROUNDING);
    }
}

#[test]
fn time_and_constants_are_series() {
    let t = || Tree::Symbol(0);
    let sine = Tree::Call(Function::Sin, vec![Tree::Product(Box::new(t()), Box::new(t()))]);
    check(&[sine, Tree::Number(2.0), t()], 0.8, &[1.0, 0.0, 3.0], ROUNDING);
    check(&[Tree::Symbol(2), Tree::Symbol(1)], 0.0, &[1.0, 0.5], ROUNDING);
    let angle = Tree::Call(Function::Atan2, vec![Tree::Number(0.5), t()]);
    check(&[angle], 0.7, &[1.0], ROUNDING);
}

/// The series of all parts of an expression.
fn collect(tree: &Tree, symbols: &[Series], parts: &mut Vec<Series>) {
    parts.push(tree.value(symbols));
    match tree {
        Tree::Symbol(_) | Tree::Number(_) => {}
        Tree::Sum(a, b) | Tree::Difference(a, b) | Tree::Product(a, b) | Tree::Quotient(a, b) => {
            if matches!(tree, Tree::Quotient(..)) {
                parts.push(b.value::<Series>(symbols).recip());
            }
            collect(a, symbols, parts);
            collect(b, symbols, parts);
        }
        Tree::Power(a, exponent) => {
            if *exponent < 0 {
                parts.push(a.value::<Series>(symbols).recip());
            }
            collect(a, symbols, parts);
        }
        Tree::Call(_, args) => args.iter().for_each(|arg| collect(arg, symbols, parts)),
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1000,
        rng_seed: RngSeed::Fixed(21),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn random_fields_have_the_series_of_their_solutions(
        rates in prop::collection::vec(trees(3), 2),
        t in -1.0..1.0f64,
        start in prop::collection::vec(-1.5..1.5f64, 2),
    ) {
        let right = expected(&rates, t, &start);
        prop_assume!(right.iter().all(|r| r.0.iter().all(|c| c.0.abs() < 1e30)));
        let Some(found) = found(&rates, t, &start, Backend::Fastest) else { return Ok(()) };
        // Cancellation leaves rounding errors, which the coefficients magnify like a change of the start.
        let moved: Vec<Vec<Series>> = [1.0 - 3e-13, 1.0 + 3e-13]
            .map(|factor| {
                let start: Vec<f64> = start.iter().map(|y| y * factor).collect();
                expected(&rates, t * factor, &start)
            })
            .into();
        // So do smooth functions of singular parts, such as sin u/u: the coefficients of the parts grow.
        let mut symbols = vec![Series::time(t)];
        symbols.extend(&right);
        let largest = right.iter().chain(&symbols).map(|r| r.0[0].0.abs()).fold(1.0, f64::max);
        let mut parts = right.clone();
        rates.iter().for_each(|rate| collect(rate, &symbols, &mut parts));
        prop_assume!(parts.iter().all(|r| r.0.iter().all(|c| c.0.is_finite())));
        let growth = |r: &Series| (1..=ORDER).map(|k| (r.0[k].0.abs() / largest).powf(1.0 / k as f64)).fold(1.0, f64::max);
        let growth = parts.iter().map(growth).fold(1.0, f64::max);
        prop_assume!(growth.powi(ORDER as i32) < 1e14); // beyond that, double-double precision does not suffice
        for k in 1..=ORDER {
            for i in 0..2 {
                let spread = moved.iter().map(|moved| (moved[i].0[k] + -right[i].0[k]).0.abs()).fold(0.0, f64::max);
                let error = (found[k - 1][i] - right[i].0[k].0).abs();
                prop_assert!(error <= spread + 1e-12 * growth.powi(k as i32) * largest, "y{i}, order {k}: {} for {}", found[k - 1][i], right[i].0[k].0);
            }
        }
    }
}
