//! The handle with which formulas are written.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::graph::dag::Dag;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Folding, Node, NodeId};
use crate::graph::number::Number;

/// A constant, or a node of a [`Graph`]: `Copy`, with the arithmetic operators and elementary functions.
///
/// Two expressions compare equal when they are the same node, that is, with folding by value, when they are equal
/// as functions as far as the graph can decide.
///
/// # Panics
/// Combining expressions of two graphs is a programming error and panics.
#[derive(Clone, Copy)]
pub struct Expr<'g> {
    graph: Option<&'g Graph>,
    atom: Atom,
}

impl<'g> Expr<'g> {
    /// 0
    pub const ZERO: Expr<'g> = Expr { graph: None, atom: Atom::ZERO };
    /// 1
    pub const ONE: Expr<'g> = Expr { graph: None, atom: Atom::ONE };

    pub(crate) fn new(graph: &'g Graph, atom: Atom) -> Expr<'g> {
        Expr { graph: Some(graph), atom }
    }

    /// The exact rational `num / den`.
    pub fn ratio(num: i64, den: i64) -> Expr<'g> {
        Number::ratio(num, den).into()
    }

    /// The constant, if this is one.
    pub fn constant(self) -> Option<Number> {
        match self.atom {
            Atom::Constant(c) => Some(c),
            Atom::Node(_) => None,
        }
    }

    /// Whether this is 0 exactly.
    pub fn is_zero(self) -> bool {
        self.atom.is_zero()
    }

    /// Whether this is undefined, because of a division by zero.
    pub fn is_undefined(self) -> bool {
        matches!(self.atom, Atom::Constant(c) if !c.is_finite())
    }

    /// The leading numerical factor, 1 if there is none; for a constant, the constant itself.
    ///
    /// ```
    /// # use pc_expr::{Graph, Number};
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert_eq!((-3.0 * x / y).numerical_factor(), Number::integer(-3));
    /// assert_eq!((2.0 * x + y).numerical_factor(), Number::ONE);
    /// ```
    pub fn numerical_factor(self) -> Number {
        let (Some(graph), Atom::Node(id)) = (self.graph, self.atom) else {
            return self.constant().unwrap_or(Number::ONE);
        };
        graph.with(|dag| match dag.node(id) {
            Node::Sum { constant, terms } if constant.is_zero() => match dag.terms(terms) {
                [(_, factor)] => *factor,
                _ => Number::ONE,
            },
            _ => Number::ONE,
        })
    }

    /// The name, if this is a symbol.
    pub fn symbol_name(self) -> Option<String> {
        let (Some(graph), Atom::Node(id)) = (self.graph, self.atom) else { return None };
        graph.with(|dag| match dag.node(id) {
            Node::Symbol(index) => Some(dag.symbol_name(index).to_owned()),
            _ => None,
        })
    }

    /// Number of operations when written out as a tree (saturating), with each function counted as ten.
    pub fn tree_cost(self) -> u32 {
        match (self.graph, self.atom) {
            (Some(graph), Atom::Node(id)) => graph.with(|dag| dag.cost(id)),
            _ => 0,
        }
    }

    pub(crate) fn graph(self) -> Option<&'g Graph> {
        self.graph
    }

    pub(crate) fn atom(self) -> Atom {
        self.atom
    }

    pub(crate) fn atom_in(self, graph: &Graph) -> Atom {
        if let (Some(own), Atom::Node(_)) = (self.graph, self.atom) {
            assert!(std::ptr::eq(own, graph), "expressions of two graphs were combined");
        }
        self.atom
    }

    pub(crate) fn symbol_in(self, graph: &Graph) -> NodeId {
        let Atom::Node(id) = self.atom_in(graph) else { panic!("expected a symbol, found a constant") };
        let is_symbol = graph.with(|dag| matches!(dag.node(id), Node::Symbol(_)));
        assert!(is_symbol, "expected a symbol, found `{self}`");
        id
    }

    /// The function applied to the first n of `args`, where n is its arity.
    ///
    /// # Panics
    /// If there are fewer arguments.
    pub fn apply(function: Function, args: &[Expr<'g>]) -> Expr<'g> {
        assert!(args.len() >= function.arity(), "{} takes {} arguments", function.name(), function.arity());
        Expr::combined(args, |dag, atoms| dag.call(function, &atoms[..function.arity()]))
    }

    /// The result of `f` on the operands, in the graph to which they belong.
    fn combined(operands: &[Expr<'g>], f: impl FnOnce(&mut Dag, &[Atom]) -> Atom) -> Expr<'g> {
        if let Some(graph) = operands.iter().find_map(|x| x.graph) {
            let atoms: Vec<Atom> = operands.iter().map(|x| x.atom_in(graph)).collect();
            return graph.build(|dag| f(dag, &atoms));
        }
        // Constants belong to no graph, and combine to the same number in every graph.
        let atoms: Vec<Atom> = operands.iter().map(|x| x.atom).collect();
        match f(&mut Dag::new(Folding::Structural, None), &atoms) {
            Atom::Constant(c) => c.into(),
            Atom::Node(_) => Number::UNDEFINED.into(),
        }
    }

    /// self^`exponent`
    #[must_use]
    pub fn powi(self, exponent: i32) -> Expr<'g> {
        if exponent < 0 {
            let positive =
                exponent.checked_neg().map_or_else(|| self.powi(i32::MAX) * self, |e| self.powi(e));
            return Expr::ONE / positive;
        }
        Expr::combined(&[self], |dag, x| dag.powi(x[0], exponent))
    }

    /// self^`exponent`; a constant exponent that is an integer or half-integer gives powers of x or √x.
    #[must_use]
    pub fn pow(self, exponent: impl Into<Expr<'g>>) -> Expr<'g> {
        let exponent = exponent.into();
        if let Some(e) = exponent.constant().and_then(Number::as_integer) {
            return self.powi(e);
        }
        Expr::apply(Function::Pow, &[self, exponent])
    }

    /// The angle of the point (`x`, self).
    #[must_use]
    pub fn atan2(self, x: impl Into<Expr<'g>>) -> Expr<'g> {
        Expr::apply(Function::Atan2, &[self, x.into()])
    }

    /// The smaller of the two expressions.
    #[must_use]
    pub fn min(self, other: impl Into<Expr<'g>>) -> Expr<'g> {
        Expr::apply(Function::Min, &[self, other.into()])
    }

    /// The larger of the two expressions.
    #[must_use]
    pub fn max(self, other: impl Into<Expr<'g>>) -> Expr<'g> {
        Expr::apply(Function::Max, &[self, other.into()])
    }

    /// `at_or_above` where self ≥ 0, else `below`.
    #[must_use]
    pub fn step(self, at_or_above: impl Into<Expr<'g>>, below: impl Into<Expr<'g>>) -> Expr<'g> {
        Expr::apply(Function::Step, &[self, at_or_above.into(), below.into()])
    }

    /// self²
    #[must_use]
    pub fn square(self) -> Expr<'g> {
        self.powi(2)
    }

    /// tan x = sin x / cos x
    #[must_use]
    pub fn tan(self) -> Expr<'g> {
        self.sin() / self.cos()
    }

    /// cot x = cos x / sin x
    #[must_use]
    pub fn cot(self) -> Expr<'g> {
        self.cos() / self.sin()
    }
}

impl Graph {
    /// The symbol with that name; the same name always gives the same symbol.
    pub fn symbol(&self, name: &str) -> Expr<'_> {
        let node = self.with(|dag| dag.symbol(name));
        self.expr(Atom::Node(node))
    }

    /// The symbols with those names.
    pub fn symbols<const N: usize>(&self, names: [&str; N]) -> [Expr<'_>; N] {
        names.map(|name| self.symbol(name))
    }

    /// Σ xᵢ as one n-ary sum.
    pub fn sum<'g>(&'g self, terms: impl IntoIterator<Item = Expr<'g>>) -> Expr<'g> {
        let atoms: Vec<(Atom, Number)> = terms.into_iter().map(|x| (x.atom_in(self), Number::ONE)).collect();
        self.build(|dag| dag.sum_of(&atoms))
    }

    /// Σ xᵢ yᵢ as one n-ary sum.
    ///
    /// The longer of the two sequences is cut to the length of the other.
    pub fn dot<'g>(
        &'g self,
        x: impl IntoIterator<Item = Expr<'g>>,
        y: impl IntoIterator<Item = Expr<'g>>,
    ) -> Expr<'g> {
        self.sum(x.into_iter().zip(y).map(|(x, y)| x * y))
    }

    pub(crate) fn expr(&self, atom: Atom) -> Expr<'_> {
        Expr::new(self, atom)
    }

    pub(crate) fn build(&self, f: impl FnOnce(&mut Dag) -> Atom) -> Expr<'_> {
        self.expr(self.with(f))
    }

    pub(crate) fn build_all(&self, f: impl FnOnce(&mut Dag) -> Vec<Atom>) -> Vec<Expr<'_>> {
        self.with(f).into_iter().map(|atom| self.expr(atom)).collect()
    }
}

macro_rules! functions {
    ($($(#[$doc:meta])* $name:ident => $function:ident;)*) => {
        impl<'g> Expr<'g> {
            $($(#[$doc])* #[must_use] pub fn $name(self) -> Expr<'g> { Expr::apply(Function::$function, &[self]) })*
        }
    };
}

functions! {
    /// Sine.
    sin => Sin;
    /// Cosine.
    cos => Cos;
    /// Arc sine.
    asin => Asin;
    /// Arc cosine.
    acos => Acos;
    /// Arc tangent.
    atan => Atan;
    /// Hyperbolic sine.
    sinh => Sinh;
    /// Hyperbolic cosine.
    cosh => Cosh;
    /// Hyperbolic tangent.
    tanh => Tanh;
    /// Exponential.
    exp => Exp;
    /// Natural logarithm.
    log => Log;
    /// Square root.
    sqrt => Sqrt;
    /// Absolute value.
    abs => Abs;
    /// −1, 0 or 1.
    sign => Sign;
}

impl PartialEq for Expr<'_> {
    fn eq(&self, other: &Self) -> bool {
        match (self.graph, other.graph) {
            (Some(a), Some(b)) if !std::ptr::eq(a, b) => self.constant().is_some() && self.atom == other.atom,
            (Some(graph), _) | (None, Some(graph)) => graph.with(|dag| dag.same(self.atom, other.atom)),
            (None, None) => self.atom == other.atom,
        }
    }
}

impl From<Number> for Expr<'_> {
    fn from(value: Number) -> Self {
        Expr { graph: None, atom: Atom::Constant(value) }
    }
}

impl From<f64> for Expr<'_> {
    /// The constant; see [`Number::from`] for the value of a decimal.
    fn from(value: f64) -> Self {
        Number::from(value).into()
    }
}

impl From<i32> for Expr<'_> {
    fn from(value: i32) -> Self {
        Number::integer(value).into()
    }
}

impl<'g> Neg for Expr<'g> {
    type Output = Expr<'g>;
    fn neg(self) -> Expr<'g> {
        Expr::combined(&[self], |dag, x| dag.scale(Number::MINUS_ONE, x[0]))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $body:expr) => {
        impl<'g, T: Into<Expr<'g>>> $trait<T> for Expr<'g> {
            type Output = Expr<'g>;
            fn $method(self, other: T) -> Expr<'g> {
                Expr::combined(&[self, other.into()], $body)
            }
        }
        impl<'g> $trait<Expr<'g>> for f64 {
            type Output = Expr<'g>;
            fn $method(self, other: Expr<'g>) -> Expr<'g> {
                Expr::from(self).$method(other)
            }
        }
    };
}

operator!(Add, add, |dag, x| dag.sum_of(&[(x[0], Number::ONE), (x[1], Number::ONE)]));
operator!(Sub, sub, |dag, x| dag.sum_of(&[(x[0], Number::ONE), (x[1], Number::MINUS_ONE)]));
operator!(Mul, mul, |dag, x| dag.product_of(Number::ONE, x));
operator!(Div, div, |dag, x| dag.divide(x[0], x[1]));

impl<'g, T: Into<Expr<'g>>> AddAssign<T> for Expr<'g> {
    fn add_assign(&mut self, other: T) {
        *self = *self + other;
    }
}

impl<'g, T: Into<Expr<'g>>> SubAssign<T> for Expr<'g> {
    fn sub_assign(&mut self, other: T) {
        *self = *self - other;
    }
}

impl<'g, T: Into<Expr<'g>>> MulAssign<T> for Expr<'g> {
    fn mul_assign(&mut self, other: T) {
        *self = *self * other;
    }
}

impl<'g> Sum for Expr<'g> {
    /// The terms added up as one n-ary sum.
    fn sum<I: Iterator<Item = Expr<'g>>>(terms: I) -> Expr<'g> {
        let terms: Vec<Expr<'g>> = terms.collect();
        match terms.iter().find_map(|x| x.graph) {
            Some(graph) => graph.sum(terms),
            None => terms.into_iter().fold(Expr::ZERO, |sum, x| sum + x),
        }
    }
}
