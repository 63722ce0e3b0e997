//! Polynomials with expressions as coefficients, written as in a book.

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::Atom;
use crate::graph::number::Number;

/// Brackets are kept unless expanding them saves this many columns.
const WORTH_A_BRACKET: usize = 4;

/// A polynomial Σ c·z_1^e_1 z_2^e_2 ….
#[derive(Clone, Debug)]
pub struct Polynomial<'g> {
    /// The variables z.
    pub variables: Vec<Expr<'g>>,
    /// The exponents of the variables, and the coefficient.
    pub terms: Vec<(Vec<u32>, Expr<'g>)>,
}

impl<'g> Polynomial<'g> {
    /// Polynomials written out in another graph, without nesting and with coefficients in front of their monomials;
    /// monomials with the same coefficient are collected behind it if that is shorter.
    ///
    /// Parts common to several coefficients are typeset once.
    pub fn expanded<'h>(polynomials: &[Self], from: &'g Graph, into: &'h Graph) -> Vec<Expr<'h>> {
        let coefficients: Vec<Expr<'g>> =
            polynomials.iter().flat_map(|polynomial| &polynomial.terms).map(|&(_, c)| c).collect();
        let mut coefficients = from.typeset(&coefficients, into).into_iter();
        let mut expanded = |polynomial: &Self| {
            let monomials =
                polynomial.terms.iter().map(|(exponents, _)| polynomial.monomial(exponents, into));
            let terms: Vec<(Atom, Atom)> = monomials
                .zip(coefficients.by_ref())
                .map(|(z, c)| (c.atom_in(into), z.atom_in(into)))
                .collect();
            into.expr(into.with(|dag| dag.collected_by_coefficient(&terms)))
        };
        polynomials.iter().map(&mut expanded).collect()
    }

    /// z_1^e_1 z_2^e_2 … in another graph.
    fn monomial<'h>(&self, exponents: &[u32], into: &'h Graph) -> Expr<'h> {
        self.variables.iter().zip(exponents).fold(Expr::ONE, |product, (z, &e)| {
            product * into.symbol(&z.symbol_name().unwrap_or_default()).powi(e as i32)
        })
    }
}

impl Dag {
    /// Σ c z, with terms that have equal coefficients collected.
    fn collected_by_coefficient(&mut self, terms: &[(Atom, Atom)]) -> Atom {
        let mut groups: Vec<(Atom, Vec<(Atom, Number)>)> = Vec::new();
        for &(coefficient, monomial) in terms {
            let (size, q) = match coefficient {
                Atom::Node(node) => {
                    let (node, q) = self.split_coefficient(node, Number::ONE);
                    let (size, rest) =
                        if q.is_negative() { (-q, Number::MINUS_ONE) } else { (q, Number::ONE) };
                    (self.scale(size, Atom::Node(node)), rest)
                }
                constant @ Atom::Constant(_) => (constant, Number::ONE),
            };
            match groups.iter_mut().find(|(known, _)| *known == size) {
                Some((_, monomials)) => monomials.push((monomial, q)),
                None => groups.push((size, vec![(monomial, q)])),
            }
        }
        let mut all = Vec::with_capacity(terms.len());
        for (coefficient, monomials) in groups {
            let products: Vec<(Atom, Number)> = monomials
                .iter()
                .map(|&(monomial, q)| (self.product_of(Number::ONE, &[coefficient, monomial]), q))
                .collect();
            if monomials.len() > 1 {
                let separate = self.sum_of(&products);
                let bracket = self.sum_of(&monomials);
                let bracket = self.common_factors_first(bracket);
                let together = self.product_of(Number::ONE, &[coefficient, bracket]);
                if self.columns(together) + WORTH_A_BRACKET <= self.columns(separate) {
                    all.push((together, Number::ONE));
                    continue;
                }
            }
            all.extend(products);
        }
        self.sum_of(&all)
    }

    /// A sum of products with their common factors in front.
    fn common_factors_first(&mut self, sum: Atom) -> Atom {
        let Some((scale, constant, terms)) = self.terms_of(sum) else { return sum };
        let Some(product) = self.before_brackets(constant, &terms) else { return sum };
        self.scale(scale, product)
    }
}
