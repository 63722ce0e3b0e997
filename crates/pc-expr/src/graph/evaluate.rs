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
use crate::graph::stand_in::StandIn;
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
    /// The value of an undetermined function, differentiated as often with respect to each argument as
    /// `orders` says: that of its [stand-in](StandIn).
    fn undetermined(name: &str, orders: &[u8], args: &[Self]) -> Self {
        StandIn::new(name, args.len()).value(orders, args)
    }
}

impl StandIn {
    /// The value at `args` of the function differentiated as often with respect to each argument as `orders`
    /// says.
    pub fn value<S: Scalar>(&self, orders: &[u8], args: &[S]) -> S {
        let order: u32 = orders.iter().map(|&order| u32::from(order)).sum();
        let level = if order == 0 { StandIn::LEVEL } else { 0.0 };
        self.waves.iter().fold(S::from_f64(level), |sum, wave| {
            let angle = wave
                .frequencies
                .iter()
                .zip(args)
                .fold(S::from_f64(wave.phase), |angle, (&frequency, &arg)| {
                    angle + S::from_f64(frequency) * arg
                });
            let factors = wave.frequencies.iter().zip(orders);
            let size = factors.fold(wave.amplitude, |size, (f, &order)| size * f.powi(order.into()));
            let function = if order.is_multiple_of(2) { Function::Sin } else { Function::Cos };
            let size = if order % 4 < 2 { size } else { -size };
            sum + S::from_f64(size) * S::call(function, &[angle])
        })
    }
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
    /// The function itself, as long as one of the arguments belongs to a graph.
    fn undetermined(name: &str, orders: &[u8], args: &[Expr<'h>]) -> Expr<'h> {
        match args.iter().find_map(|arg| arg.graph()) {
            Some(graph) => graph.applied(name, orders, args),
            None => StandIn::new(name, args.len()).value(orders, args),
        }
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
            Node::Applied { function, args } => {
                let args: Vec<S> = function.args(&args).iter().map(|child| values[child]).collect();
                S::undetermined(dag.function_name(function), function.orders(), &args)
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
    /// [`ExprError::UnboundSymbol`] for a symbol without a value; [`ExprError::Spent`] if the budget is spent.
    pub fn evaluate<'g, S: Scalar>(
        &'g self,
        outputs: &[Expr<'g>],
        values: &[(Expr<'g>, S)],
    ) -> Result<Vec<S>, ExprError> {
        self.check_budget()?;
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        let values: Vec<(NodeId, S)> = values.iter().map(|(s, value)| (s.symbol_in(self), *value)).collect();
        self.with(|dag| evaluate(dag, &outputs, &values))
    }
}
