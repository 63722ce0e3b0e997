//! The value of a node in two prime fields, from the values of its operands.

use crate::graph::dag::Dag;
use crate::graph::function::{Function, Parity};
use crate::graph::node::{Candidate, Node, NodeId, hash_of};
use crate::graph::number::Number;
use crate::identity::circle_point::CirclePoint;
use crate::identity::fingerprint::Fingerprint;
use crate::identity::roots::Value;

/// sin, cos and exp of q·z are composed from those of z/FRACTION where q·FRACTION is an integer.
const FRACTION: i32 = 12;
/// The largest integer q·FRACTION for which this is done.
const MAX_MULTIPLE: i32 = 100 * FRACTION;
/// Sums inside the argument of a sine or exponential are flattened up to this many terms; the remainder
/// counts as one term.
const MAX_TERMS: usize = 1 << 14;

/// A term m/12·z in the argument of a sine or exponential.
struct LinearTerm {
    /// z, if it is a node; otherwise a constant or a scaled node.
    node: Option<NodeId>,
    z: Fingerprint,
    m: i32,
}

/// An expression as a product: powers of factors that are nonnegative wherever the root or logarithm of the
/// whole is real, and a remaining factor of unknown sign.
struct PowerProduct {
    known: Vec<(Value, i32)>,
    rest: Option<Value>,
}

const SALT_CIRCLE: u64 = 0x5ca1_ab1e;
const SALT_EXP: u64 = 0xe4b0_4e47;
const SALT_APPLIED: u64 = 0x0f0f_2b1d;
const SALT_ORDER: u64 = 0x0bde_500f;
/// The largest denominator of an exponent that still counts as the order of a root.
const MAX_ORDER: i64 = 1000;
/// Exponents up to this size are taken out of powers.
const MAX_EXPONENT: i32 = 1 << 10;

impl Dag {
    /// The value of a candidate: its fingerprint, and its terms if there are roots in it.
    pub(crate) fn value_of(&mut self, candidate: &Candidate<'_>) -> Value {
        match *candidate {
            Candidate::Constant(c) => c.fingerprint().into(),
            Candidate::Symbol(name) => Fingerprint::symbol(name).into(),
            Candidate::Sum(constant, terms) => {
                if terms.iter().all(|&(node, _)| self.is_plain(node)) {
                    let plain = terms.iter().fold(constant.fingerprint(), |sum, &(node, q)| {
                        sum.plus(self.scaled_fingerprint(node, q))
                    });
                    return plain.into();
                }
                let scaled = |&(node, q): &(NodeId, Number)| self.value(node).scaled(q.fingerprint());
                let mut values: Vec<Value> = terms.iter().map(scaled).collect();
                values.push(constant.fingerprint().into());
                self.roots_mut().plus(&values)
            }
            Candidate::Product(factors) => {
                let mut product: Value = factors
                    .iter()
                    .filter(|&&(node, _)| self.is_plain(node))
                    .fold(Fingerprint::ONE, |product, &(node, e)| {
                        product.times(self.fingerprint(node).powi(e))
                    })
                    .into();
                for &(node, e) in factors {
                    if self.is_plain(node) {
                        continue;
                    }
                    let value = self.value(node);
                    let power = self.roots_mut().power(&value, e);
                    product = self.roots_mut().times(&product, &power);
                }
                product
            }
            Candidate::Call(function, args) => self.call_value(function, Dag::args(function, &args)),
            Candidate::Applied(function, args) => {
                let key = hash_of(&(SALT_APPLIED, self.function_name(function), function.orders()));
                let key = function.args(&args).iter().fold(key, |key, &arg| self.fingerprint(arg).key(key));
                Fingerprint::random(key).into()
            }
        }
    }

    fn scaled_fingerprint(&self, node: NodeId, q: Number) -> Fingerprint {
        let value = self.fingerprint(node);
        if q.is_one() {
            value
        } else if (-q).is_one() {
            value.negated()
        } else {
            value.times(q.fingerprint())
        }
    }

    fn call_value(&mut self, function: Function, args: &[NodeId]) -> Value {
        match function {
            Function::Sin => self.circle_point(args[0]).sin,
            Function::Cos => self.circle_point(args[0]).cos,
            Function::Exp => self.exponential(args[0]),
            Function::Sinh | Function::Cosh | Function::Tanh => {
                let exp = self.exponential(args[0]);
                let half = Number::ratio(1, 2).fingerprint();
                let roots = self.roots_mut();
                let inverse = roots.inverse(&exp);
                let cosh = roots.plus(&[exp.clone(), inverse.clone()]).scaled(half);
                let sinh = roots.plus(&[exp, inverse.negated()]).scaled(half);
                match function {
                    Function::Sinh => sinh,
                    Function::Cosh => cosh,
                    _ => {
                        let inverse = roots.inverse(&cosh);
                        roots.times(&sinh, &inverse)
                    }
                }
            }
            Function::Sqrt => self.root(args[0], 2, 1),
            Function::Abs => self.absolute(args[0]),
            Function::Log => self.logarithm(args[0]),
            Function::Pow => self.general_power(args[0], args[1]),
            _ => {
                let values: Vec<Fingerprint> = args.iter().map(|&arg| self.fingerprint(arg)).collect();
                unknown(function, &values).into()
            }
        }
    }

    /// |u|, as a product over the factors of u.
    fn absolute(&mut self, u: NodeId) -> Value {
        let (c, factors) = self.factors_of(u);
        let mut product: Value = c.abs().fingerprint().into();
        for (node, e) in factors {
            let size = self.size_of(node);
            let power = self.roots_mut().power(&size, e);
            product = self.roots_mut().times(&product, &power);
        }
        product
    }

    /// |f| of a factor f that is not written as a product.
    fn size_of(&mut self, f: NodeId) -> Value {
        let value = self.value(f);
        if self.is_nonnegative(f) {
            return value;
        }
        if self.is_nonpositive(f) {
            return value.negated();
        }
        let key = unknown(Function::Abs, &[value.fingerprint]);
        self.roots_mut().root(key, 2, |roots| roots.times(&value, &value), 1)
    }

    /// u^(exponent/order)
    fn root(&mut self, u: NodeId, order: u32, exponent: i32) -> Value {
        let (c, factors) = self.factors_of(u);
        let PowerProduct { mut known, rest } = self.power_product(c, factors);
        known.extend(rest.map(|rest| (rest, 1)));
        let (mut product, order) = (Value::ONE, order.cast_signed());
        for (base, e) in known {
            let e = e * exponent;
            let (whole, part) = (e.div_euclid(order), e.rem_euclid(order));
            let whole = self.roots_mut().power(&base, whole);
            let key = match order {
                2 => unknown(Function::Sqrt, &[base.fingerprint]),
                _ => Fingerprint::random(base.fingerprint.key(SALT_ORDER ^ u64::from(order.unsigned_abs()))),
            };
            let part = self.roots_mut().root(key, order.unsigned_abs(), |_| base, part.unsigned_abs());
            product = self.roots_mut().times(&product, &whole);
            product = self.roots_mut().times(&product, &part);
        }
        product
    }

    /// u as c·Π f^e, factored only as far as its node is factored.
    fn factors_of(&self, u: NodeId) -> (Number, Vec<(NodeId, i32)>) {
        let (inner, c) = self.split_coefficient(u, Number::ONE);
        match self.node(inner) {
            Node::Product { factors } => (c, self.factors(factors).to_vec()),
            Node::Constant(value) => (c * value, Vec::new()),
            _ => (c, vec![(inner, 1)]),
        }
    }

    /// The powers of which u = c·Π f^e is the product. Where the root of u is real, u ≥ 0; so if only one
    /// factor is of unknown sign, its sign follows.
    fn power_product(&mut self, c: Number, factors: Vec<(NodeId, i32)>) -> PowerProduct {
        let mut known = Vec::with_capacity(factors.len() + 1);
        let mut open = Vec::new();
        for (node, e) in factors {
            let fits = e.abs() <= MAX_EXPONENT;
            match e % 2 {
                _ if fits && self.is_nonnegative(node) => known.push((self.value(node), e)),
                0 if fits => known.push((self.size_of(node), e)),
                _ => open.push((node, e)),
            }
        }
        if !c.abs().is_one() && !c.is_zero() {
            known.push((c.abs().fingerprint().into(), 1));
        }
        let signed = |value: Value| if c.is_negative() { value.negated() } else { value };
        let rest = match open[..] {
            [] if c.is_negative() => Some(Fingerprint::ONE.negated().into()),
            [] => None,
            [(node, e)] if e.abs() <= MAX_EXPONENT => {
                known.push((signed(self.value(node)), e));
                None
            }
            _ => {
                let mut rest = Value::ONE;
                for (node, e) in open {
                    let fits = e.abs() <= MAX_EXPONENT;
                    if fits && e != 1 {
                        known.push((self.size_of(node), e - 1));
                    }
                    let value = self.value(node);
                    let power = self.roots_mut().power(&value, if fits { 1 } else { e });
                    rest = self.roots_mut().times(&rest, &power);
                }
                Some(signed(rest))
            }
        };
        PowerProduct { known, rest }
    }

    /// log u, which is known from then on: the logarithm of a root is that of its radicand, which may be a product of such roots.
    fn logarithm(&mut self, u: NodeId) -> Value {
        if let Some(known) = self.logarithms.get(&u) {
            return known.clone();
        }
        let value = self.sum_of_logarithms(u);
        self.logarithms.insert(u, value.clone());
        value
    }

    /// log u = Σ e log f over the powers f^e of u, including log √f = ½ log f and log e^f = f.
    fn sum_of_logarithms(&mut self, u: NodeId) -> Value {
        let (c, mut factors) = self.factors_of(u);
        let mut sum = Vec::new();
        factors.retain(|&(node, e)| {
            let Node::Call { function: function @ (Function::Exp | Function::Sqrt), args } = self.node(node)
            else {
                return true;
            };
            let (inner, e) = match function {
                Function::Exp => (self.value(args[0]), Number::integer(e)),
                _ => (self.logarithm(args[0]), Number::ratio(e.into(), 2)),
            };
            sum.push(inner.scaled(e.fingerprint()));
            false
        });
        let PowerProduct { known, rest } = self.power_product(c, factors);
        for (base, e) in known.into_iter().chain(rest.map(|rest| (rest, 1))) {
            let log = unknown(Function::Log, &[base.fingerprint]);
            sum.push(log.times(Fingerprint::integer(e.into())).into());
        }
        self.roots_mut().plus(&sum)
    }

    /// u^y: a root for a fraction y, otherwise u^n, with n the constant integer part of y, times an unknown.
    fn general_power(&mut self, u: NodeId, y: NodeId) -> Value {
        let constant = match self.node(y) {
            Node::Constant(c) => c,
            Node::Sum { constant, .. } => constant,
            _ => Number::ZERO,
        };
        if let (Node::Constant(Number::Rational { num, den: order @ 2..=MAX_ORDER }), true) =
            (self.node(y), constant.abs().to_f64() <= f64::from(MAX_EXPONENT))
        {
            return self.root(u, order as u32, num as i32);
        }
        let whole = constant.to_f64().floor();
        let whole = if whole.abs() <= f64::from(MAX_EXPONENT) { whole as i32 } else { 0 };
        let part = self.fingerprint(y).minus(Fingerprint::integer(i64::from(whole)));
        let base = self.value(u);
        let unknown = unknown(Function::Pow, &[base.fingerprint, part]);
        self.roots_mut().power(&base, whole).scaled(unknown)
    }

    /// (cos u, sin u), composed by the group law of the circle from one point for each term of u: a random point, or
    /// the point of an angle whose sine, cosine or tangent is known.
    fn circle_point(&mut self, u: NodeId) -> CirclePoint {
        let mut point = CirclePoint::zero();
        for LinearTerm { node, z, m } in self.linear_terms(u) {
            let inverse = node.filter(|_| m % FRACTION == 0).and_then(|node| self.known_angle(node));
            let (base, m) = match inverse {
                Some(base) => (base, m / FRACTION),
                None => {
                    let base = CirclePoint::random(z.up_to_sign().key(SALT_CIRCLE));
                    (if z.has_canonical_sign() { base } else { base.negated() }, m)
                }
            };
            let roots = self.roots_mut();
            let multiple = base.multiple(m, roots);
            point = point.plus(&multiple, roots);
        }
        point
    }

    /// The point of the circle at asin x, acos x or atan x.
    fn known_angle(&mut self, angle: NodeId) -> Option<CirclePoint> {
        let Node::Call { function, args } = self.node(angle) else { return None };
        let square_root = |dag: &mut Dag, radicand: Value| {
            let key = unknown(Function::Sqrt, &[radicand.fingerprint]);
            dag.roots_mut().root(key, 2, |_| radicand, 1)
        };
        let x = self.value(args[0]);
        let square = self.roots_mut().times(&x, &x);
        match function {
            Function::Asin | Function::Acos => {
                let radicand = self.roots_mut().plus(&[Value::ONE, square.negated()]);
                let other = square_root(self, radicand);
                let (cos, sin) = if function == Function::Asin { (other, x) } else { (x, other) };
                Some(CirclePoint { cos, sin })
            }
            Function::Atan => {
                let radicand = self.roots_mut().plus(&[Value::ONE, square]);
                let radius = square_root(self, radicand);
                let roots = self.roots_mut();
                let cos = roots.inverse(&radius);
                Some(CirclePoint { sin: roots.times(&x, &cos), cos })
            }
            // The angle of the point (0, 0) is 0, though the ratios to the radius have no value there.
            _ => None,
        }
    }

    /// e^u, as a product over the terms of u; e^(log z) is z.
    fn exponential(&mut self, u: NodeId) -> Value {
        let mut exponential = Value::ONE;
        for LinearTerm { node, z, m } in self.linear_terms(u) {
            let power = match node.map(|node| self.node(node)) {
                Some(Node::Call { function: Function::Log, args }) => {
                    let Number::Rational { num, den } = Number::ratio(i64::from(m), i64::from(FRACTION))
                    else {
                        continue; // a quotient of small integers is rational
                    };
                    self.root(args[0], den as u32, num as i32)
                }
                _ => {
                    let base = Fingerprint::random(z.up_to_sign().key(SALT_EXP));
                    base.powi(if z.has_canonical_sign() { m } else { -m }).into()
                }
            };
            exponential = self.roots_mut().times(&exponential, &power);
        }
        exponential
    }

    /// Writes u as Σ (m/12)·z with integers m.
    fn linear_terms(&self, u: NodeId) -> Vec<LinearTerm> {
        let multiple = |q: Number| {
            (q * Number::integer(FRACTION))
                .as_integer()
                .filter(|m| m.unsigned_abs() <= MAX_MULTIPLE.unsigned_abs())
        };
        let mut linear = Vec::new();
        let mut constant = Number::ZERO;
        let mut open = vec![(u, Number::ONE)];
        let mut opened = 0;
        while let Some((node, q)) = open.pop() {
            match self.node(node) {
                Node::Sum { constant: c, terms }
                    if opened < MAX_TERMS
                        && q.checked_mul(c).is_some()
                        && self.terms(terms).iter().all(|&(_, r)| q.checked_mul(r).is_some()) =>
                {
                    opened += terms.range().len();
                    constant = constant + q * c;
                    open.extend(
                        self.terms(terms).iter().map(|&(child, coefficient)| (child, q * coefficient)),
                    );
                }
                Node::Constant(c) => constant = constant + q * c,
                _ => linear.push(match multiple(q) {
                    Some(m) => LinearTerm { node: Some(node), z: self.fingerprint(node), m },
                    None => LinearTerm { node: None, z: self.scaled_fingerprint(node, q), m: FRACTION },
                }),
            }
        }
        if !constant.is_zero() {
            linear.push(match multiple(constant) {
                Some(m) => LinearTerm { node: None, z: Fingerprint::ONE, m },
                None => LinearTerm { node: None, z: constant.fingerprint(), m: FRACTION },
            });
        }
        linear
    }
}

/// A random value keyed by the function and its arguments; odd and even functions keep their symmetry.
fn unknown(function: Function, args: &[Fingerprint]) -> Fingerprint {
    let parity = function.parity();
    let keep_sign = parity == Parity::None;
    let key = args
        .iter()
        .fold(function as u64, |key, &arg| (if keep_sign { arg } else { arg.up_to_sign() }).key(key));
    let value = Fingerprint::random(key);
    if parity == Parity::Odd && !args[0].has_canonical_sign() { value.negated() } else { value }
}
