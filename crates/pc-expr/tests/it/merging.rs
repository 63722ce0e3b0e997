//! Random sequences of operations on shared nodes, rich in hidden identities, against direct evaluation.

use crate::common::{Bounded, call};
use pc_expr::{Expr, Folding, Function, Graph, Scalar};
use proptest::prelude::*;

/// One step: what to do with earlier entries of the pool.
#[derive(Clone, Debug)]
enum Step {
    Add(usize, usize),
    Subtract(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    Scale(usize, f64),
    Power(usize, i32),
    Call(Function, [usize; 3]),
    /// Σ of three
    Sum([usize; 3]),
    /// cos a cos b + sin a sin b
    CosineOfDifference(usize, usize),
    /// 2 sin a cos a
    SineOfDouble(usize),
    /// (a + b)² − (a − b)², which is 4 a b
    Polarised(usize, usize),
    /// (a b + a)/a, which is b + 1
    Cancelled(usize, usize),
    /// sin² a + cos² a + b, which is b + 1
    Shifted(usize, usize),
    /// e^a e^b
    Exponentials(usize, usize),
    /// 1 + a + … + a⁵
    Geometric(usize),
    /// (a⁶ − 1)/(a − 1), which is the same
    GeometricQuotient(usize),
    /// (√a + b)(√a − b), which is a − b²
    Conjugates(usize, usize),
    /// 1/(√(a² + 1) − b)
    Conjugate(usize, usize),
    /// √(a²b), which is |a|√b
    RootOfProduct(usize, usize),
    /// √(ab)
    RootOfPair(usize, usize),
    /// a^(p/q)
    Fraction(usize, i32, i32),
    /// (a^(1/4) + 1)(a^(1/4) − 1)(√a + 1), which is a − 1
    Quarters(usize),
    /// e^(b log a)
    ThroughLogarithm(usize, i32),
    /// cos(2 acos a + b)
    ThroughAngle(usize, usize),
}

/// Scales, those of the order of 1 first.
const SCALES: [f64; 9] =
    [-1.0, 2.0, -0.5, 1.0 / 3.0, 0.1, 1e200, -1e-200, 2_305_843_009_213_693_952.0, 1.0 / 1_073_741_824.0];

fn steps(count: usize, scales: &'static [f64]) -> impl Strategy<Value = Vec<Step>> {
    let i = || 0..count;
    let scale = prop::sample::select(scales);
    let step = prop_oneof![
        2 => (i(), i()).prop_map(|(a, b)| Step::Add(a, b)),
        2 => (i(), i()).prop_map(|(a, b)| Step::Subtract(a, b)),
        2 => (i(), i()).prop_map(|(a, b)| Step::Multiply(a, b)),
        1 => (i(), i()).prop_map(|(a, b)| Step::Divide(a, b)),
        2 => (i(), scale).prop_map(|(a, q)| Step::Scale(a, q)),
        1 => (i(), -3i32..5).prop_map(|(a, e)| Step::Power(a, e)),
        2 => (0..Function::ALL.len(), prop::array::uniform3(i())).prop_map(|(f, x)| Step::Call(Function::ALL[f], x)),
        1 => prop::array::uniform3(i()).prop_map(Step::Sum),
        1 => (i(), i()).prop_map(|(a, b)| Step::CosineOfDifference(a, b)),
        1 => i().prop_map(Step::SineOfDouble),
        1 => (i(), i()).prop_map(|(a, b)| Step::Polarised(a, b)),
        1 => (i(), i()).prop_map(|(a, b)| Step::Cancelled(a, b)),
        1 => (i(), i()).prop_map(|(a, b)| Step::Shifted(a, b)),
        1 => (i(), i()).prop_map(|(a, b)| Step::Exponentials(a, b)),
        1 => i().prop_map(Step::Geometric),
        1 => i().prop_map(Step::GeometricQuotient),
        1 => (i(), i()).prop_map(|(a, b)| Step::Conjugates(a, b)),
        1 => (i(), i()).prop_map(|(a, b)| Step::Conjugate(a, b)),
        1 => (i(), i()).prop_map(|(a, b)| Step::RootOfProduct(a, b)),
        1 => (i(), i()).prop_map(|(a, b)| Step::RootOfPair(a, b)),
        1 => (i(), -7i32..8, prop::sample::select(&[4, 5, 10][..])).prop_map(|(a, p, q)| Step::Fraction(a, p, q)),
        1 => i().prop_map(Step::Quarters),
        1 => (i(), -2i32..3).prop_map(|(a, e)| Step::ThroughLogarithm(a, e)),
        1 => (i(), i()).prop_map(|(a, b)| Step::ThroughAngle(a, b)),
    ];
    prop::collection::vec(step, count)
}

/// The operations a step is written with, over expressions or numbers.
trait Algebra: Copy {
    fn plus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn power(self, e: i32) -> Self;
    fn constant(&self, value: f64) -> Self;
    fn apply(function: Function, x: &[Self]) -> Self;
}

impl Algebra for Expr<'_> {
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn power(self, e: i32) -> Self {
        self.powi(e)
    }
    fn constant(&self, value: f64) -> Self {
        value.into()
    }
    fn apply(function: Function, x: &[Self]) -> Self {
        call(function, x)
    }
}

impl Algebra for Bounded {
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn power(self, e: i32) -> Self {
        Scalar::powi(self, e)
    }
    fn constant(&self, value: f64) -> Self {
        Bounded::from_f64(value)
    }
    fn apply(function: Function, x: &[Self]) -> Self {
        Scalar::call(function, x)
    }
}

fn perform<A: Algebra>(step: &Step, pool: &[A]) -> A {
    let at = |i: usize| pool[i % pool.len()];
    let call = |f, x: A| A::apply(f, &[x]);
    let minus = |x: A| x.times(x.constant(-1.0));
    match *step {
        Step::Add(a, b) => at(a).plus(at(b)),
        Step::Subtract(a, b) => at(a).plus(minus(at(b))),
        Step::Multiply(a, b) => at(a).times(at(b)),
        Step::Divide(a, b) => at(a).times(at(b).power(-1)),
        Step::Scale(a, q) => at(a).times(at(a).constant(q)),
        Step::Power(a, e) => at(a).power(e),
        Step::Call(function, x) => A::apply(function, &x.map(at)[..function.arity()]),
        Step::Sum([a, b, c]) => at(a).plus(at(b)).plus(at(c)),
        Step::CosineOfDifference(a, b) => {
            let [cosines, sines] =
                [Function::Cos, Function::Sin].map(|f| call(f, at(a)).times(call(f, at(b))));
            cosines.plus(sines)
        }
        Step::SineOfDouble(a) => {
            call(Function::Sin, at(a)).times(call(Function::Cos, at(a))).times(at(a).constant(2.0))
        }
        Step::Polarised(a, b) => at(a).plus(at(b)).power(2).plus(minus(at(a).plus(minus(at(b))).power(2))),
        Step::Cancelled(a, b) => at(a).times(at(b)).plus(at(a)).times(at(a).power(-1)),
        Step::Shifted(a, b) => {
            let [sin, cos] = [Function::Sin, Function::Cos].map(|f| call(f, at(a)).power(2));
            sin.plus(cos).plus(at(b))
        }
        Step::Exponentials(a, b) => call(Function::Exp, at(a)).times(call(Function::Exp, at(b))),
        Step::Geometric(a) => (1..6).fold(at(a).constant(1.0), |sum, e| sum.plus(at(a).power(e))),
        Step::GeometricQuotient(a) => {
            let less = |x: A| x.plus(x.constant(-1.0));
            less(at(a).power(6)).times(less(at(a)).power(-1))
        }
        Step::Conjugates(a, b) => {
            let root = call(Function::Sqrt, at(a));
            root.plus(at(b)).times(root.plus(minus(at(b))))
        }
        Step::Conjugate(a, b) => {
            call(Function::Sqrt, at(a).power(2).plus(at(a).constant(1.0))).plus(minus(at(b))).power(-1)
        }
        Step::RootOfProduct(a, b) => call(Function::Sqrt, at(a).power(2).times(at(b))),
        Step::RootOfPair(a, b) => call(Function::Sqrt, at(a).times(at(b))),
        Step::Fraction(a, p, q) => fraction(at(a), p, q),
        Step::Quarters(a) => {
            let (one, root) = (at(a).constant(1.0), fraction(at(a), 1, 4));
            root.plus(one).times(root.plus(minus(one))).times(call(Function::Sqrt, at(a)).plus(one))
        }
        Step::ThroughLogarithm(a, e) => {
            call(Function::Exp, call(Function::Log, at(a)).times(at(a).constant(e.into())))
        }
        Step::ThroughAngle(a, b) => {
            let angle = call(Function::Acos, at(a)).times(at(a).constant(2.0));
            call(Function::Cos, angle.plus(at(b)))
        }
    }
}

/// a^(p/q)
fn fraction<A: Algebra>(a: A, p: i32, q: i32) -> A {
    A::apply(Function::Pow, &[a, a.constant(f64::from(p) / f64::from(q))])
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: CASES,
        rng_seed: prop::test_runner::RngSeed::Fixed(2),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn values_survive_merging(steps in steps(40, &SCALES), point in prop::array::uniform3(-2.0..2.0)) {
        for folding in [Folding::ByValue, Folding::Structural] {
            let graph = Graph::with_folding(folding);
            let symbols = graph.symbols(["x", "y", "z"]);
            let mut pool = symbols.to_vec();
            let mut direct: Vec<Bounded> = point.iter().map(|&x| Bounded::exact(x)).collect();
            let values: Vec<(Expr, Bounded)> = symbols.iter().copied().zip(direct.iter().copied()).collect();
            for step in &steps {
                let (expr, value) = (perform(step, &pool), perform(step, &direct));
                if value.value.is_finite() && value.error.is_finite() && !expr.is_undefined() {
                    pool.push(expr);
                    direct.push(value);
                }
            }
            let ours = graph.evaluate(&pool, &values).unwrap();
            for ((expr, ours), direct) in pool.iter().zip(&ours).zip(&direct) {
                let tolerance = 1e-12 * (ours.size() + direct.size());
                let difference = (ours.value - direct.value).abs();
                let known = ours.error.is_finite() && ours.value.is_finite();
                prop_assert!(difference <= tolerance || !known, "{expr}: {ours:?}, directly {direct:?}");
            }
            // Expressions that compare equal have equal values.
            for (i, a) in pool.iter().enumerate() {
                for (j, b) in pool.iter().enumerate().take(i).filter(|(_, b)| *b == a) {
                    let tolerance = 1e-12 * (direct[i].size() + direct[j].size());
                    prop_assert!((direct[i].value - direct[j].value).abs() <= tolerance, "{a} == {b}");
                }
            }
        }
    }

    /// Where divisors vanish, a form that is regular is not replaced by a singular one.
    #[test]
    fn regular_expressions_stay_regular(steps in steps(40, &SCALES[..5]), point in prop::array::uniform3(-1i32..3)) {
        let graph = Graph::new();
        let symbols = graph.symbols(["x", "y", "z"]);
        let mut pool = symbols.to_vec();
        let mut direct: Vec<Bounded> = point.iter().map(|&x| Bounded::exact(x.into())).collect();
        let values: Vec<(Expr, Bounded)> = symbols.iter().copied().zip(direct.iter().copied()).collect();
        for step in &steps {
            let (expr, value) = (perform(step, &pool), perform(step, &direct));
            // Values of moderate size do not overflow in another order of operations.
            if value.value.abs() < 1e20 && value.error.is_finite() && !expr.is_undefined() {
                pool.push(expr);
                direct.push(value);
            }
        }
        let ours = graph.evaluate(&pool, &values).unwrap();
        for ((expr, ours), direct) in pool.iter().zip(&ours).zip(&direct) {
            let tolerance = 1e-12 * (ours.size() + direct.size());
            let difference = (ours.value - direct.value).abs();
            let agrees = ours.value.is_finite() && difference <= tolerance;
            prop_assert!(agrees, "{expr} at {point:?}: {ours:?}, directly {direct:?}");
        }
    }
}

const CASES: u32 = 1000;
