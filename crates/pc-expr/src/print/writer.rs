//! The text of each node below some expressions, built from the texts of its children.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::graph::dag::Dag;
use crate::graph::function::Function;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::print::piece::{Binding, Piece, number};
use crate::print::style::Style;

/// The greatest depth of nested sums that are merged into the sum around them.
const DEEP: usize = 60;

/// A character that no name contains.
const GAP: &str = "\u{0}";

/// Writes nodes one by one, children before parents, so that no depth overflows the stack.
pub(super) struct Writer<'d> {
    pub(super) dag: &'d Dag,
    style: Style,
    /// How nodes appear in their parents: written out, or as their names.
    pieces: FxHashMap<NodeId, Piece>,
    named: FxHashSet<NodeId>,
}

impl<'d> Writer<'d> {
    pub(super) fn new(dag: &'d Dag, style: Style) -> Writer<'d> {
        Writer { dag, style, pieces: FxHashMap::default(), named: FxHashSet::default() }
    }

    /// Makes a node appear written out in its parents.
    pub(super) fn write(&mut self, id: NodeId) {
        let piece = self.composed(id);
        self.pieces.insert(id, piece);
    }

    /// Makes a node appear as a name.
    pub(super) fn name(&mut self, id: NodeId, name: &str) {
        self.pieces.insert(id, self.style.symbol(name));
        self.named.insert(id);
    }

    /// All pieces that were written.
    pub(super) fn into_pieces(self) -> FxHashMap<NodeId, Piece> {
        self.pieces
    }

    pub(super) fn is_named(&self, id: NodeId) -> bool {
        self.named.contains(&id)
    }

    /// Number of bytes of a node when it is part of its parents.
    pub(super) fn size(&self, id: NodeId) -> usize {
        self.pieces.get(&id).map_or(0, |piece| piece.text.len())
    }

    /// Number of columns of a node when it is part of its parents.
    pub(super) fn columns(&self, id: NodeId) -> usize {
        self.pieces.get(&id).map_or(1, Piece::columns)
    }

    /// A node as part of its parents.
    fn piece(&self, id: NodeId) -> Piece {
        // The order of writing is complete: every piece is there.
        self.pieces.get(&id).cloned().unwrap_or_else(|| Piece::atom("?"))
    }

    /// A node written out, with its children as they appear in it.
    pub(super) fn composed(&self, id: NodeId) -> Piece {
        match self.dag.node(id) {
            Node::Constant(c) => self.style.number(c),
            Node::Symbol(index) => self.style.symbol(self.dag.symbol_name(index)),
            Node::Call { function, args } => {
                let mut args: Vec<Piece> =
                    Dag::args(function, &args).iter().map(|&arg| self.piece(arg)).collect();
                match function {
                    Function::Pow => {
                        let exponent = args.remove(1);
                        self.style.power(args.remove(0), exponent)
                    }
                    _ => self.style.call(function, args),
                }
            }
            Node::Applied { function, args } => {
                let args: Vec<Piece> = function.args(&args).iter().map(|&arg| self.piece(arg)).collect();
                self.style.applied(function, self.dag.function_name(function), args)
            }
            Node::Product { .. } => self.monomial(Number::ONE, id, None),
            Node::Sum { .. } => join(self.style, self.terms(id)),
        }
    }

    /// The terms of a line with marks on those that are subtracted; a term that is added comes first. A line
    /// may also end between the terms inside brackets.
    pub(super) fn line(&self, id: NodeId) -> Vec<(bool, Piece)> {
        let (product, q) = match self.dag.node(id) {
            Node::Sum { constant, terms } => match *self.dag.terms(terms) {
                [(node, q)] if constant.is_zero() => (node, q),
                _ => return self.terms(id),
            },
            _ => (id, Number::ONE),
        };
        self.bracket(q, product).unwrap_or_else(|| self.terms(id))
    }

    /// The terms of a node written out.
    fn terms(&self, id: NodeId) -> Vec<(bool, Piece)> {
        let Node::Sum { constant, terms } = self.dag.node(id) else {
            return vec![(false, self.composed(id))];
        };
        let terms = self.dag.terms(terms);
        if let (true, &[(node, q)]) = (constant.is_zero(), terms)
            && let Some(turned) = self.turned(node, q, subtracts)
        {
            return vec![(false, turned)];
        }
        let mut signed = Vec::new();
        self.signed_terms(Number::ONE, constant, terms, 0, &mut signed);
        positive_first(signed)
    }

    /// An expression as part of other expressions.
    pub(super) fn atom(&self, atom: Atom) -> Piece {
        match atom {
            Atom::Constant(c) => self.style.number(c),
            Atom::Node(id) => self.piece(id),
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
            match self.opened(node, coefficient) {
                Some((constant, terms)) if depth < DEEP => {
                    self.signed_terms(coefficient, constant, terms, depth + 1, out);
                }
                _ => out.push(match self.turned(node, coefficient, subtracts_most) {
                    Some(turned) => (false, turned),
                    None => (coefficient.is_negative(), self.term(coefficient.abs(), node)),
                }),
            }
        }
        let constant = constant * q;
        if !constant.is_zero() {
            out.push((constant.is_negative(), self.style.number(constant.abs())));
        }
    }

    /// The sum at the end of a product, if a line may end between the terms in its bracket.
    pub(super) fn bracketed(&self, product: NodeId) -> Option<NodeId> {
        let Node::Product { factors } = self.dag.node(product) else { return None };
        let is_sum = |&(node, _): &(NodeId, i32)| {
            matches!(self.dag.node(node), Node::Sum { .. }) && !self.named.contains(&node)
        };
        let factors = self.dag.factors(factors);
        let mut sums = factors.iter().filter(|factor| is_sum(factor));
        let (&(sum, e), None) = (sums.next()?, sums.next()) else { return None };
        let whole = e == 1 && factors.iter().all(|&(_, e)| e > 0) && !self.named.contains(&product);
        (whole && self.style != Style::Text).then_some(sum)
    }

    /// The terms of q x (a + b + …); the first carries what precedes the bracket, the last what follows it.
    fn bracket(&self, q: Number, product: NodeId) -> Option<Vec<(bool, Piece)>> {
        let sum = self.bracketed(product)?;
        // The product is set with a placeholder for its bracket, so that the factor before it is closed.
        let whole = self.monomial(q.abs(), product, Some(&(sum, Piece::atom(GAP)))).text;
        let (before, behind) = whole.split_once(GAP)?;
        let [open, close] = self.style.large_brackets();
        let turned = q.is_negative().then(|| self.turned_sum(sum)).flatten();
        let negative = q.is_negative() && turned.is_none();
        let inside = bracketed(self.style, turned.unwrap_or_else(|| self.terms(sum)));
        let last = inside.len() - 1;
        let term = |(i, (subtracted, text)): (usize, (bool, String))| {
            let end = if i == last { format!("{close}{behind}") } else { String::new() };
            match (i, subtracted) {
                (0, true) => {
                    (negative, Piece::product(format!("{before}{open}{}{text}{end}", self.style.minus())))
                }
                (0, false) => (negative, Piece::product(format!("{before}{open}{text}{end}"))),
                _ => (subtracted, Piece::product(format!("{text}{end}"))),
            }
        };
        Some(inside.into_iter().enumerate().map(term).collect())
    }

    /// q x (a − b) with q < 0, written as −q x (b − a) if `to_turn` contains the bracket.
    fn turned(
        &self,
        node: NodeId,
        q: Number,
        to_turn: fn(Number, &[(NodeId, Number)]) -> bool,
    ) -> Option<Piece> {
        if !q.is_negative() || self.named.contains(&node) {
            return None;
        }
        let own = [(node, 1)];
        if self.opened(node, q).is_some() {
            return None;
        }
        let factors = match self.dag.node(node) {
            Node::Product { factors } => self.dag.factors(factors),
            _ => &own,
        };
        let turned = |&(factor, e): &(NodeId, i32)| {
            let Node::Sum { constant, terms } = self.dag.node(factor) else { return None };
            let is_one = e == 1 && to_turn(constant, self.dag.terms(terms));
            Some((factor, join(self.style, is_one.then(|| self.turned_sum(factor)).flatten()?)))
        };
        let given = factors.iter().find_map(turned)?;
        Some(self.monomial(q.abs(), node, Some(&given)))
    }

    /// The terms of the negative of a sum that subtracts something.
    fn turned_sum(&self, sum: NodeId) -> Option<Vec<(bool, Piece)>> {
        let Node::Sum { constant, terms } = self.dag.node(sum) else { return None };
        let terms = self.dag.terms(terms);
        if !subtracts(constant, terms) || self.named.contains(&sum) {
            return None;
        }
        let mut signed = Vec::new();
        self.signed_terms(Number::MINUS_ONE, constant, terms, 0, &mut signed);
        Some(positive_first(signed))
    }

    /// The sum as which q·n is written, if that is shorter.
    pub(super) fn opened(&self, node: NodeId, q: Number) -> Option<(Number, &'d [(NodeId, Number)])> {
        match self.dag.node(node) {
            Node::Sum { constant, terms } if !self.named.contains(&node) => {
                let terms = self.dag.terms(terms);
                opens(q, constant, terms).then_some((constant, terms))
            }
            _ => None,
        }
    }

    /// q·n as part of a sum.
    fn term(&self, q: Number, node: NodeId) -> Piece {
        match self.dag.node(node) {
            Node::Product { .. } if !self.named.contains(&node) => self.monomial(q, node, None),
            _ => self.quotient(q, &[(node, 1)], None),
        }
    }

    /// q·n of a product n, with one of its factors written as `given`, if there is one.
    fn monomial(&self, q: Number, node: NodeId, given: Option<&(NodeId, Piece)>) -> Piece {
        match self.dag.node(node) {
            Node::Product { factors } => self.quotient(q, self.dag.factors(factors), given),
            _ => self.quotient(q, &[(node, 1)], given),
        }
    }

    /// q Π nᵢ^eᵢ as a product of factors over a product of divisors.
    fn quotient(&self, q: Number, factors: &[(NodeId, i32)], given: Option<&(NodeId, Piece)>) -> Piece {
        let mut factors = factors.to_vec();
        factors.sort_by_cached_key(|&(factor, _)| factor_key(self.dag, factor));
        let power = |factor: NodeId, e: i32| {
            let other = given.filter(|(known, _)| *known == factor);
            let base = other.map_or_else(|| self.piece(factor), |(_, piece)| piece.clone());
            if e == 1 && matches!(self.dag.node(factor), Node::Sum { .. }) {
                let alone = factors.len() == 1 && q.is_one();
                if alone { base } else { Piece::atom(self.style.at_least(base, Binding::Power)) }
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

/// Whether q·(c + Σ…) is shorter with q multiplied in: −(a − b) is b − a, +(a − b) is a − b, and (2·a − 1)/2
/// is a − 1/2.
fn opens(q: Number, constant: Number, terms: &[(NodeId, Number)]) -> bool {
    let whole = |c: Number| matches!(c, Number::Rational { num, den: 1 } if num != 0);
    let fraction = matches!(q, Number::Rational { den, .. } if den > 1);
    let becomes_whole = || whole(q * constant) || terms.iter().any(|&(_, c)| whole(q * c));
    let several = terms.len() > 1 || !constant.is_zero();
    q.abs().is_one() || fraction && several && becomes_whole()
}

/// Whether a sum subtracts something.
fn subtracts(constant: Number, terms: &[(NodeId, Number)]) -> bool {
    constant.is_negative() || terms.iter().any(|(_, q)| q.is_negative())
}

/// Whether it subtracts as many terms as it adds, so that its negative is not longer.
fn subtracts_most(constant: Number, terms: &[(NodeId, Number)]) -> bool {
    let signs = terms.iter().map(|&(_, q)| q).chain((!constant.is_zero()).then_some(constant));
    let (negative, positive): (Vec<Number>, Vec<Number>) = signs.partition(|q| q.is_negative());
    negative.len() >= positive.len()
}

fn positive_first(mut signed: Vec<(bool, Piece)>) -> Vec<(bool, Piece)> {
    if let Some(first_positive) = signed.iter().position(|(negative, _)| !negative) {
        signed[..=first_positive].rotate_right(1);
    }
    signed
}

/// Terms side by side.
fn join(style: Style, terms: Vec<(bool, Piece)>) -> Piece {
    match terms.as_slice() {
        [(false, piece)] => piece.clone(),
        _ => Piece { text: signed(style, terms).join(" "), binding: Binding::Sum },
    }
}

/// Terms side by side, all except the first with their sign before them.
pub(super) fn signed(style: Style, terms: Vec<(bool, Piece)>) -> Vec<String> {
    let term = |(i, (negative, text)): (usize, (bool, String))| {
        let sign = match (i, negative) {
            (0, false) => "",
            (0, true) => style.minus(),
            _ => style.sign(negative),
        };
        format!("{sign}{text}")
    };
    bracketed(style, terms).into_iter().enumerate().map(term).collect()
}

/// Terms, with brackets if necessary and marks on those that are subtracted.
fn bracketed(style: Style, terms: Vec<(bool, Piece)>) -> Vec<(bool, String)> {
    let alone = terms.len() == 1;
    let text = |(negative, piece): (bool, Piece)| {
        let whole = alone && !negative;
        (negative, if whole { piece.text } else { style.at_least(piece, Binding::Product) })
    };
    terms.into_iter().map(text).collect()
}

/// Symbols in order of creation, then calls, then sums.
fn factor_key(dag: &Dag, id: NodeId) -> (u8, u32) {
    match dag.node(id) {
        Node::Constant(_) => (0, 0),
        Node::Symbol(index) => (1, index),
        Node::Call { .. } | Node::Applied { .. } => (2, id.0),
        Node::Product { .. } => (3, id.0),
        Node::Sum { .. } => (4, id.0),
    }
}

/// Terms are ordered by their lists of factors.
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
