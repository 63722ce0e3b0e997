//! Evaluation of the graph itself over any scalar: the reference against which programs and derivatives are
//! tested.

use std::ops::{Add, Mul, Neg};

use rustc_hash::FxHashMap;

use crate::error::ExprError;
use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// A type of number with which expressions can be evaluated: `f64`, or a dual number.
pub trait Scalar: Copy + Add<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {
    /// The constant.
    fn from_f64(value: f64) -> Self;
    /// The constant as a number of this type, exact where possible.
    fn constant(value: Number) -> Self {
        Self::from_f64(value.to_f64())
    }
    /// x^exponent
    #[must_use]
    fn powi(self, exponent: i32) -> Self;
    /// The value of the function at `args`, which has one entry for each of its arguments.
    fn call(function: Function, args: &[Self]) -> Self;
}

impl Scalar for f64 {
    fn from_f64(value: f64) -> f64 {
        value
    }
    fn powi(self, exponent: i32) -> f64 {
        f64::powi(self, exponent)
    }
    fn call(function: Function, args: &[f64]) -> f64 {
        function.eval(args)
    }
}

impl<'h> Scalar for Expr<'h> {
    fn from_f64(value: f64) -> Expr<'h> {
        value.into()
    }
    fn constant(value: Number) -> Expr<'h> {
        value.into()
    }
    fn powi(self, exponent: i32) -> Expr<'h> {
        Expr::powi(self, exponent)
    }
    fn call(function: Function, args: &[Expr<'h>]) -> Expr<'h> {
        Expr::apply(function, args)
    }
}

fn evaluate<S: Scalar>(dag: &Dag, outputs: &[Atom], symbols: &[(NodeId, S)]) -> Result<Vec<S>, ExprError> {
    let cone = Cone::below(dag, outputs.iter().copied());
    let mut values: FxHashMap<NodeId, S> = symbols.iter().copied().collect();
    for &id in &cone.order {
        let value = match dag.node(id) {
            Node::Constant(c) => S::constant(c),
            Node::Symbol(_) if values.contains_key(&id) => continue,
            Node::Symbol(index) => {
                return Err(ExprError::UnboundSymbol { symbol: dag.symbol_name(index).to_owned() });
            }
            Node::Sum { constant, terms } => dag
                .terms(terms)
                .iter()
                .fold(S::constant(constant), |sum, (child, q)| sum + S::constant(*q) * values[child]),
            Node::Product { factors } => dag
                .factors(factors)
                .iter()
                .fold(S::constant(Number::ONE), |product, (child, e)| product * values[child].powi(*e)),
            Node::Call { function, args } => {
                let args: Vec<S> = Dag::args(function, &args).iter().map(|child| values[child]).collect();
                S::call(function, &args)
            }
        };
        values.insert(id, value);
    }
    Ok(outputs
        .iter()
        .map(|output| match output {
            Atom::Constant(c) => S::constant(*c),
            Atom::Node(id) => values[id],
        })
        .collect())
}

impl Graph {
    /// The values of `outputs`, over any scalar, when the symbols have the values given.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`] for a symbol without a value.
    pub fn evaluate<'g, S: Scalar>(
        &'g self,
        outputs: &[Expr<'g>],
        values: &[(Expr<'g>, S)],
    ) -> Result<Vec<S>, ExprError> {
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        let values: Vec<(NodeId, S)> = values.iter().map(|(s, value)| (s.symbol_in(self), *value)).collect();
        self.with(|dag| evaluate(dag, &outputs, &values))
    }
}
