//! Expressions as text.

use std::fmt;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::print::piece::{Binding, Piece, number};
use crate::print::{book, latex};

/// How an expression is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// The expression language, which the parser reads back.
    Text,
    /// As a book sets it, in plain characters: `½ m v² cos(θ)`.
    Book,
    /// LaTeX for mathematics mode: Greek letters by name, `x'` as ẋ, digits of names as indices.
    Latex,
}

/// Sub-expressions nested deeper than this, or longer than `LONG` when written out, are abbreviated to `…`.
const DEEP: usize = 60;
const LONG: u32 = 20_000;

fn print(expr: Expr<'_>, style: Style) -> String {
    match (expr.graph(), expr.atom()) {
        (_, Atom::Constant(c)) => style.number(c).text,
        (None, Atom::Node(_)) => "?".to_owned(),
        (Some(graph), Atom::Node(id)) => graph.with(|dag| Printer { dag, style }.piece(id, 0).text),
    }
}

impl Expr<'_> {
    /// The text in another style than [`Display`](fmt::Display)'s.
    pub fn display(self, style: Style) -> String {
        print(self, style)
    }
}

impl fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for Expr<'_> {
    /// The text in the expression language.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.display(Style::Text))
    }
}

impl Style {
    fn number(self, c: Number) -> Piece {
        match self {
            Style::Text => number(c),
            Style::Book => book::number(c),
            Style::Latex => latex::number(c),
        }
    }

    fn symbol(self, name: &str) -> Piece {
        Piece::atom(match self {
            Style::Text | Style::Book => name.to_owned(),
            Style::Latex => latex::symbol(name),
        })
    }

    fn call(self, function: Function, args: Vec<Piece>) -> Piece {
        match self {
            Style::Text | Style::Book => {
                let args: Vec<String> = args.into_iter().map(|arg| arg.text).collect();
                Piece::atom(format!("{}({})", function.name(), args.join(", ")))
            }
            Style::Latex => latex::call(function, args),
        }
    }

    fn power(self, base: Piece, exponent: Piece) -> Piece {
        let text = match self {
            Style::Text => format!("{}^{}", base.at_least(Binding::Atom), exponent.at_least(Binding::Atom)),
            Style::Book => book::power(base, exponent),
            Style::Latex => latex::power(&base, &exponent.text),
        };
        Piece { text, binding: Binding::Power }
    }

    fn product(self, factors: Vec<Piece>) -> String {
        let factors: Vec<String> = factors.into_iter().map(|p| p.at_least(Binding::Product)).collect();
        match self {
            Style::Text => factors.join("*"),
            Style::Book => factors.join(" "),
            Style::Latex => latex::juxtaposed(&factors),
        }
    }

    fn quotient(self, above: Vec<Piece>, mut below: Vec<Piece>) -> String {
        match self {
            Style::Latex => format!("\\frac{{{}}}{{{}}}", latex::alone(above), latex::alone(below)),
            _ if below.len() == 1 => {
                format!("{}/{}", self.product(above), below.remove(0).at_least(Binding::Power))
            }
            _ => format!("{}/({})", self.product(above), self.product(below)),
        }
    }
}

struct Printer<'d> {
    dag: &'d Dag,
    style: Style,
}

impl Printer<'_> {
    fn piece(&self, id: NodeId, depth: usize) -> Piece {
        if depth > DEEP || (depth > 0 && self.dag.cost(id) > LONG) {
            return Piece::atom("…");
        }
        match self.dag.node(id) {
            Node::Constant(c) => self.style.number(c),
            Node::Symbol(index) => self.style.symbol(self.dag.symbol_name(index)),
            Node::Call { function, args } => {
                let mut args: Vec<Piece> =
                    Dag::args(function, &args).iter().map(|&arg| self.piece(arg, depth + 1)).collect();
                match function {
                    Function::Pow => {
                        let exponent = args.remove(1);
                        self.style.power(args.remove(0), exponent)
                    }
                    _ => self.style.call(function, args),
                }
            }
            Node::Product { .. } => self.monomial(Number::ONE, id, depth),
            Node::Sum { constant, terms } => {
                let mut signed = Vec::new();
                self.signed_terms(Number::ONE, constant, self.dag.terms(terms), depth, &mut signed);
                join(signed)
            }
        }
    }

    /// The terms of q·(c + Σ…), each with its sign taken out; a scaled sum in brackets stays one term.
    fn signed_terms(
        &self,
        q: Number,
        constant: Number,
        terms: &[(NodeId, Number)],
        depth: usize,
        out: &mut Vec<(bool, Piece)>,
    ) {
        let mut terms: Vec<(NodeId, Number)> = terms.to_vec();
        terms.sort_by_cached_key(|&(node, _)| order_key(self.dag, node));
        for (node, coefficient) in terms {
            let coefficient = coefficient * q;
            match self.dag.node(node) {
                Node::Sum { constant, terms }
                    if depth <= DEEP && opens(coefficient, constant, self.dag.terms(terms)) =>
                {
                    self.signed_terms(coefficient, constant, self.dag.terms(terms), depth + 1, out);
                }
                _ => out.push((coefficient.is_negative(), self.monomial(coefficient.abs(), node, depth))),
            }
        }
        let constant = constant * q;
        if !constant.is_zero() {
            out.push((constant.is_negative(), self.style.number(constant.abs())));
        }
    }

    /// q·n as a product of factors over a product of divisors.
    fn monomial(&self, q: Number, node: NodeId, depth: usize) -> Piece {
        let single = [(node, 1)];
        let mut factors = match self.dag.node(node) {
            Node::Product { factors } => self.dag.factors(factors).to_vec(),
            _ => single.to_vec(),
        };
        factors.sort_by_cached_key(|&(factor, _)| factor_key(self.dag, factor));
        let power = |factor: NodeId, e: i32| {
            let base = self.piece(factor, depth + 1);
            if e == 1 && matches!(self.dag.node(factor), Node::Sum { .. }) {
                let alone = factors.len() == 1 && q.is_one();
                if alone { base } else { Piece::atom(base.at_least(Binding::Power)) }
            } else if e == 1 {
                base
            } else {
                self.style.power(base, Piece::atom(e.to_string()))
            }
        };
        let collect = |sign: i32| -> Vec<Piece> {
            factors
                .iter()
                .filter(|(_, e)| e.signum() == sign)
                .map(|&(factor, e)| power(factor, e.abs()))
                .collect()
        };
        let (mut above, mut below) = (collect(1), collect(-1));
        let mut front = q;
        if let Number::Rational { num, den } = q
            && !below.is_empty()
            && number(q).binding == Binding::Product
        {
            front = Number::ratio(num, 1);
            below.insert(0, self.style.number(Number::ratio(den, 1)));
        }
        if !front.is_one() || above.is_empty() {
            above.insert(0, self.style.number(front));
        }
        if above.len() == 1 && below.is_empty() {
            return above.remove(0);
        }
        let text =
            if below.is_empty() { self.style.product(above) } else { self.style.quotient(above, below) };
        Piece { text, binding: Binding::Product }
    }
}

/// Whether q·(c + Σ…) is shorter with q multiplied in: −(a − b) is b − a, and (2·a − 1)/2 is a − 1/2.
fn opens(q: Number, constant: Number, terms: &[(NodeId, Number)]) -> bool {
    let whole = |c: Number| matches!(c, Number::Rational { num, den: 1 } if num != 0);
    let fraction = matches!(q, Number::Rational { den, .. } if den > 1);
    let becomes_whole = || whole(q * constant) || terms.iter().any(|&(_, c)| whole(q * c));
    let several = terms.len() > 1 || !constant.is_zero();
    (-q).is_one() || fraction && several && becomes_whole()
}

fn join(mut signed: Vec<(bool, Piece)>) -> Piece {
    if let Some(first_positive) = signed.iter().position(|(negative, _)| !negative) {
        signed[..=first_positive].rotate_right(1);
    }
    let alone = signed.len() == 1;
    let mut text = String::new();
    let mut binding = Binding::Sum;
    for (i, (negative, piece)) in signed.into_iter().enumerate() {
        if alone && !negative {
            binding = piece.binding;
        }
        match (i, negative) {
            (0, false) => {}
            (0, true) => text.push('-'),
            (_, false) => text.push_str(" + "),
            (_, true) => text.push_str(" - "),
        }
        text.push_str(&if alone && !negative { piece.text } else { piece.at_least(Binding::Product) });
    }
    Piece { text, binding }
}

/// Symbols in the order of their making, then calls, then sums.
fn factor_key(dag: &Dag, id: NodeId) -> (u8, u32) {
    match dag.node(id) {
        Node::Constant(_) => (0, 0),
        Node::Symbol(index) => (1, index),
        Node::Call { .. } => (2, id.0),
        Node::Product { .. } => (3, id.0),
        Node::Sum { .. } => (4, id.0),
    }
}

/// Terms are ordered as their lists of factors are.
fn order_key(dag: &Dag, id: NodeId) -> Vec<(u8, u32, i32)> {
    match dag.node(id) {
        Node::Product { factors } => {
            let mut key: Vec<(u8, u32, i32)> = dag
                .factors(factors)
                .iter()
                .map(|&(factor, e)| {
                    let (class, index) = factor_key(dag, factor);
                    (class, index, -e)
                })
                .collect();
            key.sort_unstable();
            key
        }
        _ => {
            let (class, index) = factor_key(dag, id);
            vec![(class, index, -1)]
        }
    }
}
