//! Random expressions as trees, evaluated directly and through a graph, with a bound of the rounding error.

use std::ops::{Add, Mul, Neg};

use pc_expr::{Expr, Function, Scalar};
use proptest::prelude::*;

/// An expression as written, independent of any graph.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Symbol(usize),
    Number(f64),
    Sum(Box<Tree>, Box<Tree>),
    Difference(Box<Tree>, Box<Tree>),
    Product(Box<Tree>, Box<Tree>),
    Quotient(Box<Tree>, Box<Tree>),
    Power(Box<Tree>, i32),
    Call(Function, Vec<Tree>),
}

impl Tree {
    /// The expression in the graph of the symbols.
    pub(crate) fn expr<'g>(&self, symbols: &[Expr<'g>]) -> Expr<'g> {
        let build = |tree: &Tree| tree.expr(symbols);
        match self {
            Tree::Symbol(i) => symbols[*i],
            Tree::Number(value) => (*value).into(),
            Tree::Sum(a, b) => build(a) + build(b),
            Tree::Difference(a, b) => build(a) - build(b),
            Tree::Product(a, b) => build(a) * build(b),
            Tree::Quotient(a, b) => build(a) / build(b),
            Tree::Power(a, e) => build(a).powi(*e),
            Tree::Call(function, args) => call(*function, &args.iter().map(build).collect::<Vec<_>>()),
        }
    }

    /// The value, operation by operation as written.
    pub(crate) fn value<S: Scalar>(&self, symbols: &[S]) -> S {
        let value = |tree: &Tree| tree.value(symbols);
        match self {
            Tree::Symbol(i) => symbols[*i],
            Tree::Number(value) => S::from_f64(*value),
            Tree::Sum(a, b) => value(a) + value(b),
            Tree::Difference(a, b) => value(a) + -value(b),
            Tree::Product(a, b) => value(a) * value(b),
            Tree::Quotient(a, b) => value(a) * value(b).powi(-1),
            Tree::Power(a, e) => value(a).powi(*e),
            Tree::Call(function, args) => S::call(*function, &args.iter().map(value).collect::<Vec<_>>()),
        }
    }
}

/// f(x…) by the method of that name.
pub(crate) fn call<'g>(function: Function, x: &[Expr<'g>]) -> Expr<'g> {
    match function {
        Function::Sin => x[0].sin(),
        Function::Cos => x[0].cos(),
        Function::Asin => x[0].asin(),
        Function::Acos => x[0].acos(),
        Function::Atan => x[0].atan(),
        Function::Atan2 => x[0].atan2(x[1]),
        Function::Sinh => x[0].sinh(),
        Function::Cosh => x[0].cosh(),
        Function::Tanh => x[0].tanh(),
        Function::Exp => x[0].exp(),
        Function::Log => x[0].log(),
        Function::Sqrt => x[0].sqrt(),
        Function::Abs => x[0].abs(),
        Function::Sign => x[0].sign(),
        Function::Min => x[0].min(x[1]),
        Function::Max => x[0].max(x[1]),
        Function::Step => x[0].step(x[1], x[2]),
        Function::Pow => x[0].pow(x[1]),
    }
}

/// Random trees over `symbols` symbols, of moderate depth.
pub(crate) fn trees(symbols: usize) -> impl Strategy<Value = Tree> {
    let number = prop_oneof![
        (-3i32..4).prop_map(f64::from),
        prop_oneof![Just(0.1), Just(0.5), Just(-0.25), Just(1.0 / 3.0), Just(1.7e-3), Just(3.7)],
    ];
    let leaf = prop_oneof![3 => (0..symbols).prop_map(Tree::Symbol), 1 => number.prop_map(Tree::Number)];
    leaf.prop_recursive(5, 40, 3, |inner| {
        let pair = || (inner.clone(), inner.clone()).prop_map(|(a, b)| (Box::new(a), Box::new(b)));
        prop_oneof![
            3 => pair().prop_map(|(a, b)| Tree::Sum(a, b)),
            2 => pair().prop_map(|(a, b)| Tree::Difference(a, b)),
            3 => pair().prop_map(|(a, b)| Tree::Product(a, b)),
            1 => pair().prop_map(|(a, b)| Tree::Quotient(a, b)),
            2 => (inner.clone(), -3i32..5).prop_map(|(a, e)| Tree::Power(Box::new(a), e)),
            4 => (0..Function::ALL.len(), prop::collection::vec(inner.clone(), 3)).prop_map(|(i, mut args)| {
                args.truncate(Function::ALL[i].arity());
                Tree::Call(Function::ALL[i], args)
            }),
        ]
    })
}

/// A value with a bound of its rounding error: running error analysis shows how well a result can be known,
/// whatever the arrangement of its terms.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounded {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Bounded {
    /// An exact value.
    pub(crate) fn exact(value: f64) -> Bounded {
        Bounded { value, error: 0.0 }
    }

    /// `roundings` correctly rounded operations lead to the value.
    fn rounded(value: f64, error: f64, roundings: f64) -> Bounded {
        let error = error + roundings * f64::EPSILON * value.abs() + f64::MIN_POSITIVE;
        Bounded { value, error: if error.is_nan() { f64::INFINITY } else { error } }
    }

    /// Change of `f` over the interval of the value.
    fn spread(self, f: impl Fn(f64) -> f64) -> f64 {
        if self.error == 0.0 {
            return 0.0;
        }
        let middle = f(self.value);
        let change = [self.value - self.error, self.value + self.error].map(|x| (f(x) - middle).abs());
        if change.iter().any(|c| c.is_nan()) { f64::INFINITY } else { change[0].max(change[1]) }
    }

    /// The scale of the tolerance 10⁻¹²: the size of the terms from which the value was computed.
    pub(crate) fn size(self) -> f64 {
        self.error / f64::EPSILON + self.value.abs()
    }
}

impl Add for Bounded {
    type Output = Bounded;
    fn add(self, other: Bounded) -> Bounded {
        Bounded::rounded(self.value + other.value, self.error + other.error, 1.0)
    }
}

impl Mul for Bounded {
    type Output = Bounded;
    fn mul(self, other: Bounded) -> Bounded {
        let error =
            self.value.abs() * other.error + other.value.abs() * self.error + self.error * other.error;
        Bounded::rounded(self.value * other.value, error, 1.0)
    }
}

impl Neg for Bounded {
    type Output = Bounded;
    fn neg(self) -> Bounded {
        Bounded { value: -self.value, ..self }
    }
}

impl Scalar for Bounded {
    fn from_f64(value: f64) -> Bounded {
        // decimals are not representable, integers are
        if value.fract() == 0.0 { Bounded::exact(value) } else { Bounded::rounded(value, 0.0, 1.0) }
    }
    fn powi(self, exponent: i32) -> Bounded {
        let pole = exponent < 0 && self.value.abs() <= self.error;
        let error = if pole { f64::INFINITY } else { self.spread(|x| x.powi(exponent)) };
        Bounded::rounded(self.value.powi(exponent), error, f64::from(exponent).abs() + 1.0)
    }
    fn call(function: Function, args: &[Bounded]) -> Bounded {
        let values: Vec<f64> = args.iter().map(|x| x.value).collect();
        let error = (0..args.len()).map(|i| {
            args[i].spread(|x| {
                let mut moved = values.clone();
                moved[i] = x;
                function.eval(&moved)
            })
        });
        Bounded::rounded(function.eval(&values), error.sum(), 4.0)
    }
}
