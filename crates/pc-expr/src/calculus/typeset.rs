//! Expressions as a book prints them: short to read, however costly to compute.
//!
//! Sums are rewritten from the inside outwards by identities that hold wherever both sides have values: cos a
//! cos b + sin a sin b is cos(a − b), p/d + q/d is (p + q)/d, and common factors are taken out of sums.

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// Sums with more terms than this are left as they are, as all pairs of terms would have to be compared.
const MOST_TERMS: usize = 60;

/// Powers of nodes, in ascending order of the nodes.
pub(super) type Factors = Vec<(NodeId, i32)>;

/// q Π nᵢ^eᵢ
#[derive(Clone, Debug)]
pub(super) struct Term {
    pub(super) q: Number,
    pub(super) factors: Factors,
}

impl Graph {
    /// The expressions as a book prints them, in the graph of a page, with symbols that have the same names.
    ///
    /// ```
    /// # use pc_expr::{Folding, Graph};
    /// let (graph, page) = (Graph::new(), Graph::with_folding(Folding::Structural));
    /// let [a, b, m, l] = graph.symbols(["a", "b", "m", "l"]);
    /// let sum = m * a.sin() * b.cos() / l - m * a.cos() * b.sin() / l;
    /// assert_eq!(graph.typeset(&[sum], &page)[0].to_string(), "m*sin(a - b)/l");
    /// ```
    pub fn typeset<'g, 'p>(&'g self, expressions: &[Expr<'g>], page: &'p Graph) -> Vec<Expr<'p>> {
        let roots: Vec<Atom> = expressions.iter().map(|expression| expression.atom_in(self)).collect();
        let set = self.with(|dag| {
            page.with(|paper| {
                let mut set: FxHashMap<NodeId, Atom> = FxHashMap::default();
                for node in Cone::below(dag, roots.iter().copied()).order {
                    let atom = match dag.node(node) {
                        Node::Constant(c) => Atom::Constant(c),
                        Node::Symbol(index) => Atom::Node(paper.symbol(dag.symbol_name(index))),
                        Node::Call { function, args } => {
                            let args: Vec<Atom> =
                                Dag::args(function, &args).iter().map(|arg| set[arg]).collect();
                            // A call of numbers is kept: it was not evaluated, on purpose.
                            match args.iter().all(|arg| matches!(arg, Atom::Constant(_))) {
                                true => paper.call_unfolded(function, &args),
                                false => paper.call(function, &args),
                            }
                        }
                        Node::Applied { function, args } => {
                            let args: Vec<Atom> = function.args(&args).iter().map(|arg| set[arg]).collect();
                            paper.applied_as(dag, function, &args)
                        }
                        Node::Product { factors } => {
                            let powers: Vec<(Atom, i32)> =
                                dag.factors(factors).iter().map(|&(n, e)| (set[&n], e)).collect();
                            let powers: Vec<Atom> =
                                powers.into_iter().map(|(x, e)| paper.powi(x, e)).collect();
                            let product = paper.product_of(Number::ONE, &powers);
                            paper.cancelled(product)
                        }
                        Node::Sum { constant, terms } => {
                            let terms: Vec<(Atom, Number)> =
                                dag.terms(terms).iter().map(|&(n, q)| (set[&n], q)).collect();
                            paper.typeset_sum(constant, &terms)
                        }
                    };
                    set.insert(node, atom);
                }
                let atom = |root: &Atom| match root {
                    Atom::Constant(_) => *root,
                    Atom::Node(node) => set[node],
                };
                roots.iter().map(atom).collect::<Vec<Atom>>()
            })
        });
        set.into_iter().map(|atom| page.expr(atom)).collect()
    }
}

impl Dag {
    /// c + Σ qᵢ xᵢ
    fn typeset_sum(&mut self, constant: Number, terms: &[(Atom, Number)]) -> Atom {
        let with_constant: Vec<(Atom, Number)> =
            terms.iter().copied().chain([(Atom::Constant(constant), Number::ONE)]).collect();
        let sum = self.sum_of(&with_constant);
        self.rewritten(sum)
    }

    /// A sum rewritten, if that makes it shorter; anything else unchanged.
    fn rewritten(&mut self, sum: Atom) -> Atom {
        let Some((scale, constant, mut terms)) = self.terms_of(sum) else { return sum };
        if terms.len() < 2 && constant.is_zero() || terms.len() > MOST_TERMS {
            return sum;
        }
        let other = if self.merge_angles(&mut terms) {
            let merged = self.sum_of_terms(constant, &terms);
            self.rewritten(merged)
        } else if let Some(collected) = self.over_common_divisors(constant, &terms) {
            self.rewritten(collected)
        } else if let Some(product) = self.before_brackets(constant, &terms) {
            product
        } else if let Some(grouped) = self.in_groups(constant, &terms) {
            self.rewritten(grouped)
        } else {
            return sum;
        };
        let other = self.scale(scale, other);
        if self.columns(other) < self.columns(sum) { other } else { sum }
    }

    /// A product in which factors common to all terms of a sum and to its divisors are cancelled: (a² + a
    /// b)/a is a + b.
    fn cancelled(&mut self, product: Atom) -> Atom {
        let Atom::Node(node) = product else { return product };
        let Node::Product { factors } = self.node(node) else { return product };
        let factors = self.factors(factors).to_vec();
        let divisors: Factors = factors.iter().filter(|(_, e)| *e < 0).map(|&(node, e)| (node, -e)).collect();
        if divisors.is_empty() {
            return product;
        }
        for (place, &(sum, e)) in factors.iter().enumerate() {
            let is_sum = e == 1 && matches!(self.node(sum), Node::Sum { .. });
            let Some((scale, constant, terms)) = self.terms_of(Atom::Node(sum)).filter(|_| is_sum) else {
                continue;
            };
            if !constant.is_zero() {
                continue;
            }
            let common = terms.iter().fold(divisors.clone(), |common, term| shared(&common, &term.factors));
            if common.is_empty() {
                continue;
            }
            let inverse: Factors = common.iter().map(|&(node, e)| (node, -e)).collect();
            let divided = |term: Term| Term { factors: [term.factors, inverse.clone()].concat(), ..term };
            let terms: Vec<Term> = terms.into_iter().map(divided).collect();
            let bracket = self.sum_of_terms(Number::ZERO, &terms);
            let others: Factors = [&factors[..place], &factors[place + 1..], &common].concat();
            let others = self.product(scale, &others);
            let shorter = self.product_of(Number::ONE, &[others, bracket]);
            return self.cancelled(shorter);
        }
        product
    }

    /// q and the terms of a sum q (c + Σ …).
    pub(super) fn terms_of(&self, sum: Atom) -> Option<(Number, Number, Vec<Term>)> {
        let Atom::Node(node) = sum else { return None };
        let (node, scale) = self.split_coefficient(node, Number::ONE);
        let Node::Sum { constant, terms } = self.node(node) else { return None };
        let term = |&(node, q): &(NodeId, Number)| {
            let factors = match self.node(node) {
                Node::Product { factors } => self.factors(factors).to_vec(),
                _ => vec![(node, 1)],
            };
            Term { q, factors }
        };
        Some((scale, constant, self.terms(terms).iter().map(term).collect()))
    }

    pub(super) fn sum_of_terms(&mut self, constant: Number, terms: &[Term]) -> Atom {
        let mut all = vec![(Atom::Constant(constant), Number::ONE)];
        for term in terms {
            all.push((self.product(term.q, &term.factors), Number::ONE));
        }
        self.sum_of(&all)
    }

    /// Merges products of sines and cosines into sines and cosines of sums of angles wherever possible.
    /// Returns whether any were merged.
    pub(super) fn merge_angles(&mut self, terms: &mut Vec<Term>) -> bool {
        let mut merged = false;
        'again: loop {
            for i in 0..terms.len() {
                for j in i + 1..terms.len() {
                    if let Some(term) = self.merged(&terms[i], &terms[j]) {
                        terms[i] = term;
                        terms.remove(j);
                        merged = true;
                        continue 'again;
                    }
                }
            }
            return merged;
        }
    }

    /// q c (cos a cos b ± sin a sin b), q c (sin a cos b ± cos a sin b) or q c (cos² a ± sin² a) as one term.
    fn merged(&mut self, one: &Term, other: &Term) -> Option<Term> {
        let same_sign = one.q == other.q;
        if !same_sign && one.q != -other.q {
            return None;
        }
        let (common, [left, right]) = split(&one.factors, &other.factors);
        let angle = |dag: &Dag, (node, e): (NodeId, i32), power: i32| match dag.node(node) {
            Node::Call { function: function @ (Function::Sin | Function::Cos), args } if e == power => {
                Some((function, args[0]))
            }
            _ => None,
        };
        let (function, angle) = match (left.as_slice(), right.as_slice()) {
            (&[p], &[r]) => {
                let ((f, a), (g, b)) = (angle(self, p, 2)?, angle(self, r, 2)?);
                if a != b || f == g {
                    return None;
                }
                if same_sign {
                    return Some(Term { q: one.q, factors: common }); // cos² a + sin² a = 1
                }
                let twice = self.scale(Number::integer(2), Atom::Node(a));
                let cosine = self.call(Function::Cos, &[twice]);
                let q = if f == Function::Cos { one.q } else { other.q };
                return self.with_factor(q, common, cosine);
            }
            (&[p, p2], &[r, r2]) => {
                let (one, two) = (angle(self, p, 1)?, angle(self, p2, 1)?);
                let (three, four) = (angle(self, r, 1)?, angle(self, r2, 1)?);
                let is = |(f, _): (Function, NodeId), g: Function| f == g;
                let cross = |x: (Function, NodeId), y: (Function, NodeId)| {
                    // the same two angles, sines and cosines exchanged
                    let other = |f: Function| if f == Function::Sin { Function::Cos } else { Function::Sin };
                    (other(x.0), x.1) == y
                };
                let pairs =
                    (cross(one, three) && cross(two, four)) || (cross(one, four) && cross(two, three));
                if !pairs || one.1 == two.1 {
                    return None;
                }
                if is(one, Function::Cos) && is(two, Function::Cos) {
                    (Function::Cos, (one.1, two.1, if same_sign { -1 } else { 1 }))
                } else if is(one, Function::Sin) && is(two, Function::Sin) {
                    // the sines come first: −(cos a cos b − sin a sin b) where the signs differ
                    let sign = if same_sign { -1 } else { 1 };
                    let sum = self.sum_of(&[
                        (Atom::Node(one.1), Number::ONE),
                        (Atom::Node(two.1), Number::integer(sign)),
                    ]);
                    let cosine = self.call(Function::Cos, &[sum]);
                    return self.with_factor(other.q, common, cosine);
                } else {
                    let (sine, cosine) = if is(one, Function::Sin) { (one.1, two.1) } else { (two.1, one.1) };
                    (Function::Sin, (sine, cosine, if same_sign { 1 } else { -1 }))
                }
            }
            _ => return None,
        };
        let (a, b, sign) = angle;
        let sum = self.sum_of(&[(Atom::Node(a), Number::ONE), (Atom::Node(b), Number::integer(sign))]);
        let call = self.call(function, &[sum]);
        self.with_factor(one.q, common, call)
    }

    /// q x Π nᵢ^eᵢ as a term, if it is one.
    fn with_factor(&mut self, q: Number, mut factors: Factors, x: Atom) -> Option<Term> {
        let Atom::Node(node) = x else { return None };
        let (node, sign) = self.split_coefficient(node, Number::ONE);
        factors.push((node, 1));
        Some(Term { q: q * sign, factors })
    }

    /// The sum with terms over the same divisor combined into one quotient, if there are such terms.
    fn over_common_divisors(&mut self, constant: Number, terms: &[Term]) -> Option<Atom> {
        let mut groups: Vec<(Factors, Vec<Term>)> = Vec::new();
        for term in terms {
            let (divisors, factors) = term.factors.iter().partition::<Factors, _>(|(_, e)| *e < 0);
            let numerator = Term { q: term.q, factors };
            match groups.iter_mut().find(|(known, _)| *known == divisors) {
                Some((_, numerators)) => numerators.push(numerator),
                None => groups.push((divisors, vec![numerator])),
            }
        }
        let is_quotient =
            |(divisors, numerators): &(Factors, Vec<Term>)| !divisors.is_empty() && numerators.len() > 1;
        // A single quotient is left to the extraction of common factors.
        if !groups.iter().any(is_quotient) || groups.len() == 1 && constant.is_zero() {
            return None;
        }
        let mut all = vec![(Atom::Constant(constant), Number::ONE)];
        for (divisors, numerators) in groups {
            if numerators.len() == 1 || divisors.is_empty() {
                for term in numerators {
                    let factors: Factors = term.factors.into_iter().chain(divisors.iter().copied()).collect();
                    all.push((self.product(term.q, &factors), Number::ONE));
                }
                continue;
            }
            let numerator = self.sum_of_terms(Number::ZERO, &numerators);
            let numerator = self.rewritten(numerator);
            let divisor = self.product(Number::ONE, &divisors);
            all.push((self.product_of(Number::ONE, &[numerator, divisor]), Number::ONE));
        }
        Some(self.sum_of(&all))
    }

    /// The sum with its common factors in front of brackets, if there are common factors.
    pub(super) fn before_brackets(&mut self, constant: Number, terms: &[Term]) -> Option<Atom> {
        let (first, rest) = terms.split_first().filter(|_| constant.is_zero())?;
        let common = rest.iter().fold(first.factors.clone(), |common, term| shared(&common, &term.factors));
        if common.is_empty() {
            return None;
        }
        let inverse: Factors = common.iter().map(|&(node, e)| (node, -e)).collect();
        let mut left = Vec::with_capacity(terms.len());
        for term in terms {
            let factors: Factors = term.factors.iter().chain(&inverse).copied().collect();
            left.push((self.product(term.q, &factors), Number::ONE));
        }
        let brackets = self.sum_of(&left);
        let brackets = self.rewritten(brackets);
        let common = self.product(Number::ONE, &common);
        Some(self.product_of(Number::ONE, &[common, brackets]))
    }
}

impl Dag {
    /// The sum with some terms collected in brackets: those that share the function or sum that is a factor
    /// of most terms.
    fn in_groups(&mut self, constant: Number, terms: &[Term]) -> Option<Atom> {
        let is_long = |node: NodeId| {
            matches!(self.node(node), Node::Call { .. } | Node::Applied { .. } | Node::Sum { .. })
        };
        let has = |term: &Term, node: NodeId| term.factors.iter().any(|&(factor, e)| factor == node && e > 0);
        let mut best: Option<(usize, NodeId)> = None;
        for &(node, _) in
            terms.iter().flat_map(|term| &term.factors).filter(|(node, e)| *e > 0 && is_long(*node))
        {
            let count = terms.iter().filter(|term| has(term, node)).count();
            if count > best.map_or(1, |(most, _)| most) {
                best = Some((count, node));
            }
        }
        let (_, node) = best?;
        let (group, others): (Vec<Term>, Vec<Term>) = terms.iter().cloned().partition(|term| has(term, node));
        let bracket = self.before_brackets(Number::ZERO, &group)?;
        let rest = self.sum_of_terms(constant, &others);
        Some(self.sum_of(&[(bracket, Number::ONE), (rest, Number::ONE)]))
    }
}

/// The common factors of two products, and the remaining factors of each.
fn split(one: &Factors, other: &Factors) -> (Factors, [Factors; 2]) {
    let common = shared(one, other);
    let besides = |factors: &Factors| -> Factors {
        let left = factors.iter().map(|&(node, e)| {
            let taken = common.iter().find(|(known, _)| *known == node).map_or(0, |&(_, e)| e);
            (node, e - taken)
        });
        left.filter(|&(_, e)| e != 0).collect()
    };
    let both = [besides(one), besides(other)];
    (common, both)
}

/// The powers that two products have in common: for each factor, the smaller power, if both are above or
/// both below the fraction bar.
fn shared(one: &Factors, other: &Factors) -> Factors {
    let power = |&(node, e): &(NodeId, i32)| {
        let &(_, f) = other.iter().find(|(known, _)| *known == node)?;
        let common = if e > 0 && f > 0 {
            e.min(f)
        } else if e < 0 && f < 0 {
            e.max(f)
        } else {
            0
        };
        (common != 0).then_some((node, common))
    };
    one.iter().filter_map(power).collect()
}
