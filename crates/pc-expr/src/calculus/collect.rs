//! Short forms: expressions rebuilt as polynomials whose coefficients are free of symbols that cancel.
//!
//! Correctness does not depend on this module: a form is adopted only if its fingerprint shows the same
//! function, and only if it is cheaper. With [`Folding::Structural`], expressions are left unchanged.

use crate::calculus::polynomial::Polynomial;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Folding, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::places::SymbolPlaces;
use crate::identity::blocks::independent_blocks;

/// The maximum number of terms of a polynomial in several variables.
const MOST_TERMS: usize = 10_000;
/// A sum with more terms than this is searched for groups of terms that have no variables in common.
const MANY_TERMS: usize = 64;
/// Expressions longer than this when written out are left as they are.
const TOO_LONG: u32 = 20_000;

impl Graph {
    /// Each expression in the shortest form found: collected by powers of `variables` in this order, with
    /// every coefficient written without the symbols it does not depend on.
    ///
    /// Symbols that a value does not depend on are set to a number; the `variables` among them are set only to 0,
    /// so that no other number replaces a variable.
    pub fn shorten<'g>(&'g self, expressions: &[Expr<'g>], variables: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let places = SymbolPlaces::of(variables);
        expressions.iter().map(|&e| self.collect(e, (variables, &places), 0)).collect()
    }

    /// e collected by powers of the variables with index `first` and above.
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

    /// A long sum whose terms fall into groups with no variables in common, with each group collected on its
    /// own: the cost of collecting by one variable after the other is quadratic in their number. `None` if
    /// the result is not shorter, or e is not a sum.
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
                    // A common factor is kept in front of the sum.
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

    /// e as a polynomial in all of `variables`, if it is a polynomial of at most ten thousand terms.
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
                return None; // too long to be read
            }
            (terms, first) = (next, place + 1);
        }
        terms.retain(|(_, c)| !c.is_zero());
        Some(Polynomial { variables: variables.to_vec(), terms })
    }
}
