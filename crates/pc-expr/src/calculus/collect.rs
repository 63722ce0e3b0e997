//! Short forms: expressions rebuilt as polynomials whose coefficients no longer contain what they do not depend on.
//!
//! Correctness does not depend on this module: a form is adopted only where its fingerprint says that it is the same
//! function, and only where it is cheaper. With [`Folding::Structural`] expressions stay as they are.

use std::collections::HashSet;

use rustc_hash::FxHashMap;

use crate::calculus::polynomial::Polynomial;
use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Folding, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::places::SymbolPlaces;
use crate::graph::subgraph::Cone;
use crate::identity::blocks::independent_blocks;

/// Greatest degree in one variable that is looked for.
const MAX_DEGREE: usize = 4;
/// Most terms of a polynomial in several variables.
const MOST_TERMS: usize = 10_000;
/// A sum of more terms is looked at for groups of terms that have nothing to do with each other.
const MANY_TERMS: usize = 64;
/// Expressions longer than this when written out are left as they are.
const TOO_LONG: u32 = 20_000;
/// A number at which no divisor is likely to vanish.
const ODD: Number = Number::Rational { num: 355, den: 452 };

impl Graph {
    /// Each expression in the shortest form found: collected by powers of `variables` in this order, every
    /// coefficient without the symbols it does not depend on.
    ///
    /// Symbols that a value does not depend on are set to a number; those of the `variables` only to 0, so that no
    /// other number takes their place.
    pub fn shorten<'g>(&'g self, expressions: &[Expr<'g>], variables: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let places = SymbolPlaces::of(variables);
        expressions.iter().map(|&e| self.collect(e, (variables, &places), 0)).collect()
    }

    /// e collected by the variables from place `first` on.
    fn collect<'g>(
        &'g self,
        e: Expr<'g>,
        (variables, places): (&[Expr<'g>], &SymbolPlaces),
        first: usize,
    ) -> Expr<'g> {
        if self.folding() == Folding::Structural || e.constant().is_some() || e.tree_cost() > TOO_LONG {
            return e;
        }
        if let Some(collected) = self.collect_apart(e, (variables, places), first) {
            return collected;
        }
        let mut present: Vec<usize> =
            self.symbols_of(&[e]).into_iter().filter_map(|symbol| places.get(symbol)).collect();
        present.sort_unstable();
        let Some((position, powers)) =
            present.into_iter().filter(|&position| position >= first).find_map(|position| {
                let powers = self.powers(e, variables[position])?;
                (powers.len() > 1).then_some((position, powers))
            })
        else {
            return self.forget(e, places);
        };
        let z = variables[position];
        let collected = |c: Expr<'g>| self.collect(c, (variables, places), position + 1);
        let terms = powers.into_iter().enumerate().map(|(i, c)| collected(c) * z.powi(i as i32));
        let collected = self.sum(terms.collect::<Vec<_>>());
        if collected.tree_cost() <= e.tree_cost() { collected } else { self.forget(e, places) }
    }

    /// A long sum whose terms fall into groups without common variables, each group collected by itself: to go through all its
    /// variables in turn takes the square of their number. `None` where that is no shorter, or the sum is none.
    fn collect_apart<'g>(
        &'g self,
        e: Expr<'g>,
        (variables, places): (&[Expr<'g>], &SymbolPlaces),
        first: usize,
    ) -> Option<Expr<'g>> {
        let Atom::Node(mut node) = e.atom() else { return None };
        let (constant, terms) = self.with(|dag| {
            let mut factor = Number::ONE;
            loop {
                match dag.node(node) {
                    // A common factor stands before the sum.
                    Node::Sum { constant, terms } if constant.is_zero() && dag.terms(terms).len() == 1 => {
                        let (inner, q) = dag.terms(terms)[0];
                        (node, factor) = (inner, factor * q);
                    }
                    Node::Sum { constant, terms } if dag.terms(terms).len() > MANY_TERMS => {
                        let terms = dag.terms(terms).iter().map(|&(term, q)| (term, factor * q));
                        return Some((factor * constant, terms.collect::<Vec<_>>()));
                    }
                    _ => return None,
                }
            }
        })?;
        let of_term = |&(node, _): &(NodeId, Number)| {
            let symbols = self.symbols_of(&[self.expr(Atom::Node(node))]).into_iter();
            symbols.filter_map(|symbol| places.get(symbol)).filter(|&place| place >= first).collect()
        };
        let entries: Vec<Vec<usize>> = terms.iter().map(of_term).collect();
        let mut groups: Vec<Vec<usize>> =
            independent_blocks(variables.len(), &entries).into_iter().map(|(rows, _)| rows).collect();
        if groups.len() <= 1 {
            return None;
        }
        groups.push((0..terms.len()).filter(|&i| entries[i].is_empty()).collect());
        let mut parts = vec![Expr::from(constant)];
        for group in groups.into_iter().filter(|group| !group.is_empty()) {
            let part: Vec<(Atom, Number)> =
                group.into_iter().map(|i| (Atom::Node(terms[i].0), terms[i].1)).collect();
            let part = self.build(|dag| dag.sum_of(&part));
            let collected = self.collect(part, (variables, places), first);
            if collected.tree_cost() > part.tree_cost() {
                return None;
            }
            parts.push(collected);
        }
        Some(self.sum(parts))
    }

    /// e as a polynomial in all of `variables`, if it is one of at most ten thousand terms.
    pub fn polynomial<'g>(&'g self, e: Expr<'g>, variables: &[Expr<'g>]) -> Option<Polynomial<'g>> {
        let places = SymbolPlaces::of(variables);
        let mut terms = vec![(vec![0; variables.len()], e)];
        let mut first = 0;
        loop {
            let written = self.symbols_of(&terms.iter().map(|&(_, c)| c).collect::<Vec<_>>());
            let written = written.into_iter().filter_map(|symbol| places.get(symbol));
            let Some(place) = written.filter(|&place| place >= first).min() else { break };
            let mut next = Vec::new();
            for (exponents, coefficient) in terms {
                for (i, c) in self.powers(coefficient, variables[place])?.into_iter().enumerate() {
                    if !c.is_zero() {
                        let mut exponents: Vec<u32> = exponents.clone();
                        exponents[place] = i as u32;
                        next.push((exponents, c));
                    }
                }
            }
            if next.len() > MOST_TERMS {
                return None; // nobody would read it
            }
            (terms, first) = (next, place + 1);
        }
        terms.retain(|(_, c)| !c.is_zero());
        Some(Polynomial { variables: variables.to_vec(), terms })
    }

    /// The coefficients c_i = (1/i!) ∂ⁱe/∂zⁱ at z = 0 of a polynomial in z, if e is one of moderate degree.
    fn powers<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Option<Vec<Expr<'g>>> {
        let (symbol, output) = (z.symbol_in(self), e.atom_in(self));
        match self.with(|dag| dag.powers(symbol, output)) {
            Powers::Coefficients(coefficients) => {
                return Some(coefficients.into_iter().map(|c| self.expr(c)).collect());
            }
            Powers::BelowACall => return None, // four derivatives of a root would show the same
            Powers::Unknown => {}
        }
        let mut derivatives = vec![e];
        loop {
            let next = derivatives[derivatives.len() - 1].derivative(z);
            if next.is_zero() {
                break;
            }
            // The derivatives of a polynomial become shorter; where they grow, or are past counting, there is none to be found.
            let most = derivatives[derivatives.len() - 1].tree_cost().saturating_mul(2).checked_add(8);
            let growing = most.is_none_or(|most| next.tree_cost() > most);
            if derivatives.len() > MAX_DEGREE || growing {
                return None;
            }
            derivatives.push(next);
        }
        let before = self.zero_divisions();
        let mut at_zero = self.substitute(&derivatives, &[(z, Expr::ZERO)]);
        if self.zero_divisions() > before || at_zero.iter().any(|c| c.is_undefined()) {
            return None; // a polynomial, but written with a quotient that is singular at 0
        }
        let mut factorial = 1;
        for (i, c) in at_zero.iter_mut().enumerate().skip(1) {
            factorial *= i as i64;
            *c *= Expr::ratio(1, factorial);
        }
        Some(at_zero)
    }

    /// e written without the symbols and angles that it contains but does not depend on: they are put to a regular
    /// value, `variables` to 0 if that is one.
    fn forget<'g>(&'g self, e: Expr<'g>, variables: &SymbolPlaces) -> Expr<'g> {
        let mut short = e;
        for z in self.repeated_symbols(e) {
            if self.symbols_of(&[short]).contains(&z) && !short.depends_on(z) {
                short = match variables.contains(z) {
                    true => self.at_zero(short, z),
                    false => self.at_regular_point(short, z),
                };
            }
        }
        for angle in self.composite_angles(short) {
            short = self.at_regular_angle(short, angle);
        }
        short
    }

    /// e with z = 0, if that does not change its value; e itself otherwise.
    fn at_zero<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        let form = self.at(e, z, Number::ZERO);
        if !form.is_undefined() && self.is_same_value(form, e) { form } else { e }
    }

    /// e with sin z and cos z at a point of the circle, and z at a number, that do not change its value; e itself if there
    /// are none. The first point is taken at which no new divisor comes in, else the first.
    fn at_regular_point<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        self.most_regular(e, self.forms_without(e, z, true))
    }

    /// The same with sin z and cos z only.
    fn at_regular_angle<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        self.most_regular(e, self.forms_without(e, z, false))
    }

    /// The first of the forms of e in which no new divisor comes in, else the first, else e.
    fn most_regular<'g>(&'g self, e: Expr<'g>, forms: impl Iterator<Item = Expr<'g>>) -> Expr<'g> {
        let mut forms = forms.peekable();
        let first = forms.peek().copied();
        forms.find(|&form| self.is_as_regular(form, e)).or(first).unwrap_or(e)
    }

    /// e, which does not depend on the symbol z, written without it: so that no new divisor comes in, or else one
    /// that only vanishes at odd places.
    pub(crate) fn without_symbol<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        let is_without = |form: &Expr<'g>| !form.is_undefined() && !self.symbols_of(&[*form]).contains(&z);
        let mut odd = None;
        for form in self.forms_without(e, z, true).filter(is_without) {
            if self.is_as_regular(form, e) {
                return form;
            }
            odd = Some(form);
        }
        // Where constants are rounded, every form has a value a little different.
        let rounded = || {
            [ODD, Number::ONE, Number::ZERO].into_iter().map(|value| self.at(e, z, value)).find(is_without)
        };
        odd.or_else(rounded).unwrap_or(e)
    }

    /// `outputs` written without symbols other than `known`, as far as they do not depend on them. Such a symbol
    /// cancels; it appears where a result has the value of an older and cheaper expression that contains it.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [a, b, z] = graph.symbols(["a", "b", "z"]);
    /// let written = graph.written_in(&[a * b, a + z], &[a, b]);
    /// assert_eq!(written, [a * b, a + z]); // z is needed
    /// ```
    pub fn written_in<'g>(&'g self, outputs: &[Expr<'g>], known: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let known: HashSet<String> = known.iter().filter_map(|symbol| symbol.symbol_name()).collect();
        let is_foreign = |symbol: &Expr<'g>| symbol.symbol_name().is_none_or(|name| !known.contains(&name));
        let foreign = |list: &[Expr<'g>]| -> Vec<Expr<'g>> {
            self.symbols_of(list).into_iter().filter(is_foreign).collect()
        };
        if foreign(outputs).is_empty() {
            return outputs.to_vec();
        }
        let without = |e: Expr<'g>, z: Expr<'g>| {
            let is_without =
                |form: &Expr<'g>| !form.is_undefined() && !self.symbols_of(&[*form]).contains(&z);
            let mut forms = self.forms_without(e, z, true).filter(is_without).peekable();
            let first = forms.peek().copied();
            forms.find(|&form| self.is_as_regular(form, e)).or(first).unwrap_or(e)
        };
        outputs.iter().map(|&e| foreign(&[e]).into_iter().fold(e, without)).collect()
    }

    /// e at those points of z, from simple to odd ones, that do not change its value.
    fn forms_without<'g>(
        &'g self,
        e: Expr<'g>,
        z: Expr<'g>,
        whole: bool,
    ) -> impl Iterator<Item = Expr<'g>> + 'g {
        // A form with a vanishing denominator or another value is not taken: try the next point.
        let oblique = [Number::ratio(3, 5), Number::ratio(4, 5)];
        [
            (Number::ZERO, [Number::ZERO, Number::ONE]),
            (Number::ZERO, [Number::ONE, Number::ZERO]),
            (Number::ZERO, oblique),
            (Number::ONE, oblique),
            (ODD, [Number::ratio(696, 985), Number::ratio(697, 985)]),
        ]
        .into_iter()
        .map(move |(value, circle)| self.at_point(e, z, whole.then_some(value), circle))
        .filter(move |&form| self.is_same_value(form, e))
    }

    /// The angles that are no symbols, of which e contains both sine and cosine: Ω t in sin Ω t and cos Ω t.
    fn composite_angles<'g>(&'g self, e: Expr<'g>) -> Vec<Expr<'g>> {
        let Atom::Node(root) = e.atom_in(self) else { return Vec::new() };
        let angles: Vec<NodeId> = self.with(|dag| {
            let cone = Cone::below(dag, [Atom::Node(root)]);
            let (mut sines, mut cosines) = (Vec::new(), Vec::new());
            for &node in &cone.order {
                if let Node::Call { function, args } = dag.node(node)
                    && !matches!(dag.node(args[0]), Node::Symbol(_))
                {
                    match function {
                        Function::Sin => sines.push(args[0]),
                        Function::Cos => cosines.push(args[0]),
                        _ => {}
                    }
                }
            }
            sines.retain(|angle| cosines.contains(angle));
            sines
        });
        angles.into_iter().map(|node| self.expr(Atom::Node(node))).collect()
    }

    /// The symbols that occur more than once when e is written out: what occurs once does not cancel.
    fn repeated_symbols<'g>(&'g self, e: Expr<'g>) -> Vec<Expr<'g>> {
        let Atom::Node(root) = e.atom_in(self) else { return Vec::new() };
        let repeated: Vec<NodeId> = self.with(|dag| {
            let cone = Cone::below(dag, [Atom::Node(root)]);
            let mut occurrences: FxHashMap<NodeId, u32> = FxHashMap::default();
            occurrences.insert(root, 1);
            for &node in cone.order.iter().rev() {
                let above = occurrences[&node];
                dag.for_each_child(node, |child| {
                    let count = occurrences.entry(child).or_insert(0);
                    *count = count.saturating_add(above);
                });
            }
            let is_repeated =
                |node: &NodeId| matches!(dag.node(*node), Node::Symbol(_)) && occurrences[node] > 1;
            cone.order.iter().copied().filter(is_repeated).collect()
        });
        repeated.into_iter().map(|node| self.expr(Atom::Node(node))).collect()
    }

    /// e with sin z and cos z as given, and z itself if there is a `value`.
    fn at_point<'g>(
        &'g self,
        e: Expr<'g>,
        z: Expr<'g>,
        value: Option<Number>,
        [sin, cos]: [Number; 2],
    ) -> Expr<'g> {
        let Atom::Node(angle) = z.atom_in(self) else { return e };
        let mut replacements: Vec<(NodeId, Atom)> =
            value.map(|value| (angle, Atom::Constant(value))).into_iter().collect();
        for (function, value) in [(Function::Sin, sin), (Function::Cos, cos)] {
            if let Some(node) = self.with(|dag| call_node(dag, function, angle)) {
                replacements.push((node, Atom::Constant(value)));
            }
        }
        self.trial(e, &replacements)
    }

    /// e at a value of the symbol z.
    fn at<'g>(&'g self, e: Expr<'g>, z: Expr<'g>, value: Number) -> Expr<'g> {
        self.trial(e, &[(z.symbol_in(self), Atom::Constant(value))])
    }

    /// e with nodes replaced; a division by zero that it leads to is forgotten.
    fn trial<'g>(&'g self, e: Expr<'g>, replacements: &[(NodeId, Atom)]) -> Expr<'g> {
        let output = e.atom_in(self);
        self.build(|dag| {
            let divisions = dag.zero_divisions().len();
            let value = dag.substitute(&[output], replacements)[0];
            dag.forget_zero_divisions(divisions);
            value
        })
    }

    /// Whether no divisor of the first expression vanishes where the second has a value, judged by the factors of their divisors.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert!(graph.is_as_regular((x * y) / y, x) && !graph.is_as_regular(y / x, x));
    /// ```
    pub fn is_as_regular<'g>(&'g self, some: Expr<'g>, other: Expr<'g>) -> bool {
        let (some, other) = (some.atom_in(self), other.atom_in(self));
        self.with(|dag| dag.is_as_regular(some, other))
    }

    /// Whether a form has the fingerprint of an expression, and its numbers.
    fn is_same_value<'g>(&'g self, form: Expr<'g>, e: Expr<'g>) -> bool {
        (form - e).is_zero() && self.has_numbers_of(form, e)
    }
}

/// What is seen of an expression's powers of a symbol without differentiating.
enum Powers {
    /// The coefficients.
    Coefficients(Vec<Atom>),
    /// The symbol stands in a denominator, or its powers are high.
    Unknown,
    /// It is an argument of a function.
    BelowACall,
}

impl Dag {
    /// The powers of a symbol in sums and products, multiplied out.
    fn powers(&mut self, symbol: NodeId, output: Atom) -> Powers {
        let cone = Cone::below(self, [output]);
        let active = cone.depending_on(self, &[symbol]);
        if active.iter().any(|&node| matches!(self.node(node), Node::Call { .. })) {
            return Powers::BelowACall;
        }
        let mut known: FxHashMap<NodeId, Vec<Atom>> = FxHashMap::default();
        known.insert(symbol, vec![Atom::ZERO, Atom::ONE]);
        for &node in cone.order.iter().filter(|&node| active.contains(node)) {
            let powers = match self.node(node) {
                Node::Sum { constant, terms } => {
                    let mut sums = vec![vec![(Atom::Constant(constant), Number::ONE)]];
                    for &(term, q) in self.terms(terms) {
                        let own = [Atom::Node(term)];
                        let powers = known.get(&term).map_or(&own[..], Vec::as_slice);
                        sums.resize(sums.len().max(powers.len()), Vec::new());
                        for (sum, &c) in sums.iter_mut().zip(powers) {
                            sum.push((c, q));
                        }
                    }
                    sums.iter().map(|terms| self.sum_of(terms)).collect()
                }
                Node::Product { factors } => {
                    let (moving, fixed): (Vec<_>, Vec<_>) =
                        self.factors(factors).iter().partition(|(factor, _)| active.contains(factor));
                    let mut powers = vec![self.product(Number::ONE, &fixed)];
                    for (factor, exponent) in moving {
                        if exponent < 0 {
                            return Powers::Unknown;
                        }
                        for _ in 0..exponent {
                            powers = self.multiply_powers(&powers, &known[&factor]);
                            if powers.len() > MAX_DEGREE + 1 {
                                return Powers::Unknown;
                            }
                        }
                    }
                    powers
                }
                _ => continue,
            };
            known.insert(node, powers);
        }
        let mut powers = match output {
            Atom::Node(node) => known.remove(&node).unwrap_or_else(|| vec![output]),
            Atom::Constant(_) => vec![output],
        };
        while powers.len() > 1 && powers.last().is_some_and(|c| c.is_zero()) {
            powers.pop();
        }
        Powers::Coefficients(powers)
    }

    /// The product of two polynomials given by their coefficients.
    fn multiply_powers(&mut self, a: &[Atom], b: &[Atom]) -> Vec<Atom> {
        let mut sums = vec![Vec::new(); a.len() + b.len() - 1];
        for (i, &a) in a.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
            for (j, &b) in b.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
                sums[i + j].push((self.product_of(Number::ONE, &[a, b]), Number::ONE));
            }
        }
        sums.iter().map(|terms| self.sum_of(terms)).collect()
    }
}

fn call_node(dag: &mut Dag, function: Function, angle: NodeId) -> Option<NodeId> {
    match dag.call(function, &[Atom::Node(angle)]) {
        Atom::Node(node) => Some(node),
        Atom::Constant(_) => None,
    }
}

impl Graph {
    /// The expressions rebuilt in another graph, symbols of the same names.
    pub fn transcribe<'g, 'h>(&'g self, expressions: &[Expr<'g>], into: &'h Graph) -> Vec<Expr<'h>> {
        let symbols: Vec<(Expr<'g>, Expr<'h>)> = self
            .symbols_of(expressions)
            .into_iter()
            .map(|symbol| (symbol, into.symbol(&symbol.symbol_name().unwrap_or_default())))
            .collect();
        self.evaluate(expressions, &symbols).unwrap_or_default() // every symbol has its value
    }
}
