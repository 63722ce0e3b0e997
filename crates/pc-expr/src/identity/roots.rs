//! Sums of products of roots, Σ_S c_S Π_R R^{k_R}, with coefficients in the two prime fields.
//!
//! A root is an unknown R with known R^q, as for √e and |e| (q = 2) and e^{1/q}. The powers R^k with k < q
//! are kept separate and R^q is replaced by its value, which decides exactly the consequences of these laws:
//! no sign is ever chosen, √(x²) is neither x nor −x. This holds as long as there are few roots: beyond
//! [`MOST_TERMS`], a value is only its fingerprint, with random roots.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::identity::fingerprint::Fingerprint;

/// A value with more terms than this is no longer kept as a sum.
const MOST_TERMS: usize = 48;
/// Products of sums with more terms than this in total are not multiplied out.
const MOST_PRODUCTS: usize = 512;
/// Once this many products of roots are known, products of sums are no longer multiplied out.
const MOST_MONOMIALS: usize = 1 << 16;
/// A sum with more square roots than this is not inverted by its conjugates.
const MOST_CONJUGATES: usize = 3;

/// Index of a product of roots; [`Monomial::ONE`] is that of the empty product.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Monomial(u32);

impl Monomial {
    const ONE: Monomial = Monomial(0);
}

/// The value of an expression: its fingerprint, where the roots are random, and its terms if it contains roots.
#[derive(Clone, Debug)]
pub(crate) struct Value {
    pub(crate) fingerprint: Fingerprint,
    /// The terms in the order of their monomials, each of which occurs once.
    terms: Option<Terms>,
}

/// Terms c·Π R^k.
pub(crate) type Terms = Arc<[(Monomial, Fingerprint)]>;

impl From<Fingerprint> for Value {
    fn from(fingerprint: Fingerprint) -> Value {
        Value { fingerprint, terms: None }
    }
}

impl Value {
    pub(crate) const ONE: Value = Value { fingerprint: Fingerprint::ONE, terms: None };

    pub(crate) fn new(fingerprint: Fingerprint, terms: Option<Terms>) -> Value {
        Value { fingerprint, terms }
    }

    pub(crate) fn into_terms(self) -> Option<Terms> {
        self.terms
    }

    pub(crate) fn is_zero(&self) -> bool {
        self.fingerprint == Fingerprint::ZERO
    }

    /// The number of its terms, if they are kept.
    pub(crate) fn own_terms(&self) -> usize {
        self.terms.as_ref().map_or(0, |terms| terms.len())
    }

    /// q·x of a number q.
    pub(crate) fn scaled(&self, q: Fingerprint) -> Value {
        if q == Fingerprint::ZERO {
            return q.into();
        }
        let scaled = |terms: &Terms| terms.iter().map(|&(m, c)| (m, c.times(q))).collect();
        Value { fingerprint: self.fingerprint.times(q), terms: self.terms.as_ref().map(scaled) }
    }

    pub(crate) fn negated(&self) -> Value {
        self.scaled(Fingerprint::ONE.negated())
    }

    fn for_each_term(&self, mut visit: impl FnMut(Monomial, Fingerprint)) {
        match &self.terms {
            None => visit(Monomial::ONE, self.fingerprint),
            Some(terms) => terms.iter().for_each(|&(m, c)| visit(m, c)),
        }
    }

    fn len(&self) -> usize {
        self.terms.as_ref().map_or(1, |terms| terms.len())
    }
}

#[derive(Debug)]
struct Root {
    value: Fingerprint,
    order: u32,
    /// R^order
    power: Value,
    /// R^−order, once it has been asked for: each root of a tower is inverted once, not once for every root above it.
    reciprocal: Option<Value>,
}

/// The roots that occur, and their products.
#[derive(Debug)]
pub(crate) struct Roots {
    roots: Vec<Root>,
    known: FxHashMap<Fingerprint, u32>,
    /// The roots of each product, in ascending order, with their exponents.
    monomials: Vec<Vec<(u32, u32)>>,
    /// Their values.
    values: Vec<Fingerprint>,
    known_monomials: FxHashMap<Vec<(u32, u32)>, Monomial>,
    products: FxHashMap<(Monomial, Monomial), Value>,
}

impl Default for Roots {
    fn default() -> Roots {
        Roots {
            roots: Vec::new(),
            known: FxHashMap::default(),
            monomials: vec![Vec::new()],
            values: vec![Fingerprint::ONE],
            known_monomials: FxHashMap::from_iter([(Vec::new(), Monomial::ONE)]),
            products: FxHashMap::default(),
        }
    }
}

impl Roots {
    /// R^exponent, where R is the root of that order with that value; `power` gives R^order.
    pub(crate) fn root(
        &mut self,
        value: Fingerprint,
        order: u32,
        power: impl FnOnce(&mut Roots) -> Value,
        exponent: u32,
    ) -> Value {
        let root = match self.known.get(&value) {
            Some(&root) => root,
            None => {
                let power = power(self);
                let root = self.roots.len() as u32;
                self.roots.push(Root { value, order, power, reciprocal: None });
                self.known.insert(value, root);
                root
            }
        };
        if exponent == 0 {
            return Value::ONE;
        }
        let monomial = self.monomial(vec![(root, exponent)]);
        self.sum([(monomial, Fingerprint::ONE)])
    }

    fn monomial(&mut self, roots: Vec<(u32, u32)>) -> Monomial {
        if let Some(&known) = self.known_monomials.get(&roots) {
            return known;
        }
        let power = |&(root, k): &(u32, u32)| self.roots[root as usize].value.powi(k.cast_signed());
        let value = roots.iter().map(power).fold(Fingerprint::ONE, Fingerprint::times);
        let monomial = Monomial(self.monomials.len() as u32);
        self.monomials.push(roots.clone());
        self.values.push(value);
        self.known_monomials.insert(roots, monomial);
        monomial
    }

    /// The value of a sum whose terms may come in any order and more than once.
    fn sum(&self, terms: impl IntoIterator<Item = (Monomial, Fingerprint)>) -> Value {
        let mut terms: Vec<(Monomial, Fingerprint)> = terms.into_iter().collect();
        terms.sort_unstable_by_key(|&(m, _)| m);
        terms.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 = kept.1.plus(next.1);
            }
            same
        });
        terms.retain(|&(_, c)| c != Fingerprint::ZERO);
        let value = |&(m, c): &(Monomial, Fingerprint)| self.values[m.0 as usize].times(c);
        let fingerprint = terms.iter().map(value).fold(Fingerprint::ZERO, Fingerprint::plus);
        let plain = terms.len() > MOST_TERMS || terms.iter().all(|&(m, _)| m == Monomial::ONE);
        Value { fingerprint, terms: (!plain).then(|| terms.into()) }
    }

    /// Σ x
    pub(crate) fn plus(&self, values: &[Value]) -> Value {
        if values.iter().all(|x| x.terms.is_none())
            || values.iter().map(Value::len).sum::<usize>() > MOST_PRODUCTS
        {
            let sum = values.iter().map(|x| x.fingerprint).fold(Fingerprint::ZERO, Fingerprint::plus);
            return sum.into();
        }
        let mut terms = Vec::new();
        values.iter().for_each(|x| x.for_each_term(|m, c| terms.push((m, c))));
        self.sum(terms)
    }

    /// x y
    pub(crate) fn times(&mut self, x: &Value, y: &Value) -> Value {
        match (&x.terms, &y.terms) {
            (None, _) => return y.scaled(x.fingerprint),
            (_, None) => return x.scaled(y.fingerprint),
            _ if x.len() * y.len() > MOST_PRODUCTS || self.monomials.len() > MOST_MONOMIALS => {
                return x.fingerprint.times(y.fingerprint).into();
            }
            _ => {}
        }
        let mut pairs = Vec::with_capacity(x.len() * y.len());
        x.for_each_term(|m, c| y.for_each_term(|n, d| pairs.push((m, n, c.times(d)))));
        let mut terms = Vec::with_capacity(pairs.len());
        for (m, n, c) in pairs {
            self.product(m, n).for_each_term(|m, d| terms.push((m, c.times(d))));
        }
        self.sum(terms)
    }

    /// The product of two products of roots.
    fn product(&mut self, m: Monomial, n: Monomial) -> Value {
        let key = (m.min(n), m.max(n));
        if let Some(known) = self.products.get(&key) {
            return known.clone();
        }
        let mut roots = [&self.monomials[m.0 as usize][..], &self.monomials[n.0 as usize]].concat();
        roots.sort_unstable_by_key(|&(root, _)| root);
        roots.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        // A root raised to its order is a value of older roots, which may also occur here.
        let mut full = Vec::new();
        for (root, k) in &mut roots {
            let Root { order, power, .. } = &self.roots[*root as usize];
            if *k >= *order {
                *k -= order;
                full.push(power.clone());
            }
        }
        roots.retain(|&(_, k)| k > 0);
        let rest = self.monomial(roots);
        let rest = self.sum([(rest, Fingerprint::ONE)]);
        let product = full.iter().fold(rest, |product, power| self.times(&product, power));
        self.products.insert(key, product.clone());
        product
    }

    /// x^e
    pub(crate) fn power(&mut self, x: &Value, exponent: i32) -> Value {
        if x.terms.is_none() {
            return x.fingerprint.powi(exponent).into();
        }
        let base = if exponent < 0 { self.inverse(x) } else { x.clone() };
        let (mut result, mut square, mut rest) = (Value::ONE, base, exponent.unsigned_abs());
        while rest > 0 {
            if rest & 1 == 1 {
                result = self.times(&result, &square);
            }
            rest >>= 1;
            if rest > 0 {
                square = self.times(&square, &square);
            }
        }
        result
    }

    /// R^−q of a root R with a known R^q.
    fn reciprocal(&mut self, root: u32) -> Value {
        let Root { power, reciprocal, .. } = &self.roots[root as usize];
        if let Some(known) = reciprocal {
            return known.clone();
        }
        let found = self.inverse(&power.clone());
        self.roots[root as usize].reciprocal = Some(found.clone());
        found
    }

    /// 1/x. Square roots are taken out of the divisor one after the other, 1/(a + bR) = (a − bR)/(a² − b²R²).
    pub(crate) fn inverse(&mut self, x: &Value) -> Value {
        let plain: Value = x.fingerprint.powi(-1).into();
        let Some(terms) = x.terms.clone() else { return plain };
        if let [(monomial, c)] = *terms {
            let roots = self.monomials[monomial.0 as usize].clone();
            let mut inverse: Value = c.powi(-1).into();
            for (root, k) in roots {
                let rest = self.monomial(vec![(root, self.roots[root as usize].order - k)]);
                let rest = self.sum([(rest, Fingerprint::ONE)]);
                let divisor = self.reciprocal(root);
                inverse = self.times(&inverse, &rest);
                inverse = self.times(&inverse, &divisor);
            }
            return inverse;
        }
        let mut roots: Vec<u32> =
            terms.iter().flat_map(|&(m, _)| self.monomials[m.0 as usize].iter().map(|&(r, _)| r)).collect();
        roots.sort_unstable();
        roots.dedup();
        // The youngest root: it does not occur in the square of any other.
        let Some(&youngest) = roots.last() else { return plain };
        if roots.len() > MOST_CONJUGATES || self.roots[youngest as usize].order != 2 {
            return plain;
        }
        let conjugate = self.sum(terms.iter().map(|&(m, c)| {
            let odd = self.monomials[m.0 as usize].iter().any(|&(root, _)| root == youngest);
            (m, if odd { c.negated() } else { c })
        }));
        let norm = self.times(x, &conjugate);
        if norm.is_zero() {
            return plain; // x may vanish on one side, as √(x²) − x does
        }
        let inverse = self.inverse(&norm);
        self.times(&conjugate, &inverse)
    }
}
