//! How calls of functions are normalised: constants folded, signs taken out, powers written as products and roots.

use crate::graph::dag::Dag;
use crate::graph::function::{Function, Parity};
use crate::graph::node::{Atom, Candidate, Node, NodeId};
use crate::graph::normal_form::MAX_EXPONENT;
use crate::graph::number::Number;

impl Dag {
    /// f(x…)
    pub(crate) fn call(&mut self, function: Function, args: &[Atom]) -> Atom {
        if args.iter().any(|a| matches!(a, Atom::Constant(c) if !c.is_finite())) {
            return Atom::Constant(Number::UNDEFINED);
        }
        if let Some(value) = folded_call(function, args) {
            return Atom::Constant(value);
        }
        if let (Atom::Node(node), parity @ (Parity::Even | Parity::Odd)) = (args[0], function.parity()) {
            let (inner, q) = self.split_coefficient(node, Number::ONE);
            if q.is_negative() {
                let positive = self.scale(-q, Atom::Node(inner));
                let value = self.call(function, &[positive]);
                return if parity == Parity::Odd { self.scale(Number::MINUS_ONE, value) } else { value };
            }
        }
        match (function, args) {
            (Function::Sqrt, &[Atom::Node(node)]) => {
                let (inner, q) = self.split_coefficient(node, Number::ONE);
                if let Some(root) = q.exact_sqrt().filter(|_| !q.is_one()) {
                    let rest = self.call_unfolded(Function::Sqrt, &[Atom::Node(inner)]);
                    return self.scale(root, rest);
                }
                self.call_unfolded(function, args)
            }
            (Function::Min | Function::Max, &[a, b]) if a == b => a,
            (Function::Step, &[_, a, b]) if a == b => a,
            (Function::Step, &[Atom::Constant(x), a, b]) => {
                if x.is_negative() {
                    b
                } else {
                    a
                }
            }
            (Function::Pow, &[x, Atom::Constant(y)]) => self.constant_power(x, y),
            _ => self.call_unfolded(function, args),
        }
    }

    /// √x, kept as a root if x is not a perfect square: the square of a rounded root is not x.
    pub(crate) fn exact_root(&mut self, x: Atom) -> Atom {
        match x {
            Atom::Constant(c) if !c.is_negative() && c.exact_sqrt().is_none() => {
                self.call_unfolded(Function::Sqrt, &[x])
            }
            _ => self.call(Function::Sqrt, &[x]),
        }
    }

    /// x^y: integer powers are products, half-integer powers are powers of a square root, powers of fractional powers are single
    /// powers.
    fn constant_power(&mut self, x: Atom, y: Number) -> Atom {
        let small = |q: Number| q.as_integer().filter(|e| e.unsigned_abs() <= MAX_EXPONENT);
        if let Some(e) = small(y) {
            return self.powi(x, e);
        }
        let (x, y) = self.power_of_power(x, y).unwrap_or((x, y));
        if let Some(e) = small(y * Number::integer(2)) {
            let root = self.call(Function::Sqrt, &[x]);
            return self.powi(root, e);
        }
        self.call_unfolded(Function::Pow, &[x, Atom::Constant(y)])
    }

    pub(crate) fn call_unfolded(&mut self, function: Function, args: &[Atom]) -> Atom {
        let mut ids = [NodeId::NONE; 3];
        for (id, &arg) in ids.iter_mut().zip(args) {
            *id = self.argument(arg);
        }
        if matches!(function, Function::Min | Function::Max) && ids[0] > ids[1] {
            ids.swap(0, 1);
        }
        self.admit(&Candidate::Call(function, ids))
    }

    /// The constant itself, if the atom is a node that holds one; otherwise the atom.
    pub(crate) fn constant_of(&self, atom: Atom) -> Atom {
        match atom {
            Atom::Node(id) => match self.node(id) {
                Node::Constant(c) => Atom::Constant(c),
                _ => atom,
            },
            Atom::Constant(_) => atom,
        }
    }

    pub(super) fn argument(&mut self, atom: Atom) -> NodeId {
        match atom {
            Atom::Constant(c) => {
                let candidate = Candidate::Constant(c);
                self.find(&candidate).unwrap_or_else(|| self.push(&candidate, c.fingerprint().into()))
            }
            Atom::Node(node) => match self.representative(node) {
                (node, sign) if sign.is_one() => node,
                (node, sign) => match self.signed(node, sign) {
                    Atom::Node(signed) => signed,
                    Atom::Constant(_) => node,
                },
            },
        }
    }
}

/// The value of a call with constant arguments, if it is finite.
fn folded_call(function: Function, args: &[Atom]) -> Option<Number> {
    let mut values = [0.0; 3];
    for (value, arg) in values.iter_mut().zip(args) {
        let Atom::Constant(c) = arg else { return None };
        *value = c.to_f64();
    }
    if let (Function::Sqrt, Atom::Constant(c)) = (function, args[0])
        && let Some(root) = c.exact_sqrt()
    {
        return Some(root);
    }
    let value = function.eval(&values[..function.arity()]);
    value.is_finite().then(|| Number::from(value))
}
