//! Linear relations whose coefficients are functions of certain symbols.
//!
//! For each set of values of these symbols in GF(2⁶¹ − 1) the relations form a null space. A basis vector of it is read
//! back as a vector of rational functions from its values at many such sets. The result is a proposal: only relations
//! that the graph itself folds to zero are returned.

use rustc_hash::FxHashMap;

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::number::Number;
use crate::identity::linear_relations::{equations, whole};
use crate::identity::prime_field::Residue;
use crate::identity::rational_function::{Grid, RationalFunction, Term};
use crate::identity::sampler::{Sampler, value_at};

impl Graph {
    /// A basis of the relations Σ_j a_j f_j = 0 between the columns f_1..f_N, each of them m expressions, over the field of
    /// the rational functions of the `constants`.
    ///
    /// The result is a list of vectors (a_1, …, a_N) of polynomials in the `constants` with integer coefficients. The last
    /// nonzero entry of each is in a column where all other vectors have zero, in ascending order, as in
    /// [`linear_relations`](Graph::linear_relations); without `constants` both are the same.
    ///
    /// Every relation is certified: Σ_j a_j f_ji folds to zero for each i. Some relations are missed: those with
    /// coefficients of high degree or with long numbers, those in which functions of the `constants` other than rational
    /// ones occur, and those that fingerprints cannot see.
    ///
    /// # Panics
    /// If the columns have different lengths.
    ///
    /// ```
    /// use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y, a, b] = graph.symbols(["x", "y", "a", "b"]);
    /// let columns = [x, y, a * x + b * y, x / (a + b)].map(|f| vec![f]);
    /// let relations = graph.linear_relations_over(&columns, &[a, b]);
    /// assert_eq!(relations, [vec![a, b, (-1).into(), 0.into()], vec![1.into(), 0.into(), 0.into(), -a - b]]);
    /// ```
    pub fn linear_relations_over<'g>(
        &'g self,
        columns: &[Vec<Expr<'g>>],
        constants: &[Expr<'g>],
    ) -> Vec<Vec<Expr<'g>>> {
        let written = self.symbols_of(&columns.concat());
        let constants: Vec<Expr<'g>> = constants.iter().copied().filter(|c| written.contains(c)).collect();
        if constants.is_empty() {
            let exact = |a: Vec<Number>| a.into_iter().map(Expr::from).collect();
            return self.linear_relations(columns).into_iter().map(exact).collect();
        }
        let vectors = self.echelon(columns, &constants).null_space().into_iter();
        vectors.filter_map(|vector| self.relation_like(&vector, columns, &constants)).collect()
    }

    /// The relation between the columns in which a null vector at one set of values of the constants is not zero.
    fn relation_like<'g>(
        &'g self,
        vector: &[Residue],
        columns: &[Vec<Expr<'g>>],
        constants: &[Expr<'g>],
    ) -> Option<Vec<Expr<'g>>> {
        let support: Vec<usize> = (0..vector.len()).filter(|&j| vector[j] != Residue::ZERO).collect();
        let chosen: Vec<Vec<Expr<'g>>> = support.iter().map(|&j| columns[j].clone()).collect();
        let components = chosen.first().map_or(0, Vec::len);
        let written = self.symbols_of(&chosen.concat());
        let constants: Vec<Expr<'g>> = constants.iter().copied().filter(|c| written.contains(c)).collect();
        let mut vectors = NullVectors {
            sampler: Sampler::new(self, &chosen.concat(), &constants),
            constants: &constants,
            columns: chosen.len(),
            components,
            known: FxHashMap::default(),
        };
        let coefficients = vectors.polynomials(self)?;
        let sum = |i: usize| self.dot(coefficients.iter().copied(), chosen.iter().map(|f| f[i]));
        if !(0..components).all(|i| sum(i).is_zero()) {
            return None;
        }
        let mut relation = vec![Expr::ZERO; columns.len()];
        support.into_iter().zip(coefficients).for_each(|(j, a)| relation[j] = a);
        Some(relation)
    }
}

/// The null vector of some columns, unique up to its factor, as a function of the constants.
struct NullVectors<'a, 'g> {
    sampler: Sampler<'g>,
    constants: &'a [Expr<'g>],
    columns: usize,
    components: usize,
    /// The vectors by the places of the constants.
    known: FxHashMap<Vec<usize>, Option<Vec<Residue>>>,
}

impl<'g> NullVectors<'_, 'g> {
    fn at(&mut self, places: &[usize]) -> Option<&Vec<Residue>> {
        if !self.known.contains_key(places) {
            let null_space = equations(&self.sampler, self.columns, self.components, places).null_space();
            let vector = <[_; 1]>::try_from(null_space).ok().map(|[vector]| vector);
            self.known.insert(places.to_vec(), vector);
        }
        self.known[places].as_ref()
    }

    /// The vector, scaled to polynomials with integer coefficients. The entry in relation to which the others are simplest
    /// decides its factor.
    fn polynomials(&mut self, graph: &'g Graph) -> Option<Vec<Expr<'g>>> {
        let mut best: Option<(usize, Vec<RationalFunction>)> = None;
        for unit in (0..self.columns).rev() {
            let entries =
                (0..self.columns).map(|entry| self.quotient(entry, unit)).collect::<Option<Vec<_>>>();
            let Some(entries) = entries else { continue };
            let size = entries.iter().map(|f| f.numerator.len() + 2 * f.denominator.len()).sum();
            let is_whole = entries.iter().all(|f| is_number(&f.denominator));
            if best.as_ref().is_none_or(|&(least, _)| size < least) {
                best = Some((size, entries));
            }
            if is_whole {
                break;
            }
        }
        let (_, entries) = best?;
        Some(self.common_denominator(graph, &entries))
    }

    /// The entry divided by the entry `unit`.
    fn quotient(&mut self, entry: usize, unit: usize) -> Option<RationalFunction> {
        RationalFunction::of(&mut Quotient { vectors: self, entry, unit })
    }

    /// The entries multiplied by a common denominator, and by the number that makes them coprime integers; they have no constant
    /// as a common factor.
    fn common_denominator(&self, graph: &'g Graph, entries: &[RationalFunction]) -> Vec<Expr<'g>> {
        let entries: Vec<(Vec<Term>, Vec<Term>)> = entries.iter().map(in_integers).collect();
        let of_denominators: Vec<Monomial> = entries.iter().map(|(_, d)| common_monomial([d])).collect();
        let least: Monomial = (0..self.constants.len())
            .map(|p| of_denominators.iter().map(|monomial| monomial[p]).max().unwrap_or(0))
            .collect();
        let whole_entries: Vec<(Vec<Term>, Vec<Term>)> = entries
            .into_iter()
            .zip(&of_denominators)
            .map(|((n, d), own)| (divided(&times(&n, &least), own), divided(&d, own)))
            .collect();
        let common = common_monomial(whole_entries.iter().map(|(n, _)| n).filter(|n| !n.is_empty()));
        let entries: Vec<(Vec<Term>, Vec<Term>)> =
            whole_entries.into_iter().map(|(n, d)| (divided(&n, &common), d)).collect();
        let mut denominators: Vec<&Vec<Term>> = Vec::new();
        for (_, denominator) in &entries {
            if !denominators.contains(&denominator) {
                denominators.push(denominator);
            }
        }
        let others = |own: &Vec<Term>| {
            let others = denominators.iter().filter(|&&d| d != own);
            others.fold(Expr::ONE, |product, d| product * self.polynomial(graph, d))
        };
        let numbers: Vec<Number> = entries.iter().flat_map(|(n, _)| n).map(|&(_, a)| a).collect();
        let factor = factor_to(&numbers, &whole(&numbers));
        let entry = |(numerator, denominator): &(Vec<Term>, Vec<Term>)| {
            self.polynomial(graph, &scaled(numerator, factor)) * others(denominator)
        };
        entries.iter().map(entry).collect()
    }

    fn polynomial(&self, graph: &'g Graph, terms: &[Term]) -> Expr<'g> {
        graph.sum(terms.iter().map(|(exponents, a)| {
            let powers = self.constants.iter().zip(exponents);
            powers.fold(Expr::from(*a), |product, (p, &e)| product * p.powi(e as i32))
        }))
    }
}

struct Quotient<'q, 'a, 'g> {
    vectors: &'q mut NullVectors<'a, 'g>,
    entry: usize,
    unit: usize,
}

impl Grid for Quotient<'_, '_, '_> {
    fn variables(&self) -> usize {
        self.vectors.constants.len()
    }

    fn variable(&self, variable: usize, place: usize) -> Residue {
        value_at(self.vectors.constants[variable], place)
    }

    fn value(&mut self, places: &[usize]) -> Option<Residue> {
        let vector = self.vectors.at(places)?;
        (vector[self.unit] != Residue::ZERO).then(|| vector[self.entry] * vector[self.unit].inverse())
    }
}

/// The exponents of the constants in a product of powers of them.
type Monomial = Vec<u32>;

/// The monomial of the highest degree that divides all terms of these polynomials.
fn common_monomial<'t>(polynomials: impl IntoIterator<Item = &'t Vec<Term>>) -> Monomial {
    let exponents = polynomials.into_iter().flatten().map(|(exponents, _)| exponents.clone());
    let lower = |a: Monomial, b: Monomial| a.into_iter().zip(b).map(|(a, b)| a.min(b)).collect();
    exponents.reduce(lower).unwrap_or_default()
}

fn times(polynomial: &[Term], monomial: &Monomial) -> Vec<Term> {
    let higher = |exponents: &Monomial| exponents.iter().zip(monomial).map(|(e, m)| e + m).collect();
    polynomial.iter().map(|(exponents, a)| (higher(exponents), *a)).collect()
}

/// The polynomial divided by a monomial that divides it.
fn divided(polynomial: &[Term], monomial: &Monomial) -> Vec<Term> {
    let lower = |exponents: &Monomial| exponents.iter().zip(monomial).map(|(e, m)| e - m).collect();
    polynomial.iter().map(|(exponents, a)| (lower(exponents), *a)).collect()
}

fn is_number(polynomial: &[Term]) -> bool {
    polynomial.iter().all(|(exponents, _)| exponents.iter().all(|&e| e == 0))
}

fn scaled(polynomial: &[Term], factor: Number) -> Vec<Term> {
    polynomial.iter().map(|(exponents, a)| (exponents.clone(), *a * factor)).collect()
}

/// Numerator and denominator, the latter with coprime integer coefficients.
fn in_integers(function: &RationalFunction) -> (Vec<Term>, Vec<Term>) {
    let numbers: Vec<Number> = function.denominator.iter().map(|&(_, a)| a).collect();
    let factor = factor_to(&numbers, &whole(&numbers));
    (scaled(&function.numerator, factor), scaled(&function.denominator, factor))
}

/// The factor by which the second list is a multiple of the first.
fn factor_to(from: &[Number], to: &[Number]) -> Number {
    let pair = from.iter().zip(to).find(|(a, _)| !a.is_zero());
    pair.map_or(Number::ONE, |(a, &b)| b * a.recip())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn denominators_are_removed() {
        let graph = Graph::new();
        let [x, y, a, b] = graph.symbols(["x", "y", "a", "b"]);
        // x/(a − b) + y/(a + b) = z, with neither entry a unit of all.
        let columns = [x, y, x / (a - b) + y / (a + b), x * y].map(|f| vec![f]);
        let found = graph.linear_relations_over(&columns, &[a, b]);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0][0] / found[0][2], found[0][1] / found[0][2]), (-1.0 / (a - b), -1.0 / (a + b)));
        assert!(graph.polynomial(found[0][2], &[a, b]).is_some());
    }

    /// Denominators with common factors have no product that is a factor of all coefficients.
    #[test]
    fn constants_are_no_common_factors() {
        let graph = Graph::new();
        let [x, y, z, a, b] = graph.symbols(["x", "y", "z", "a", "b"]);
        let columns = [x, y, z, x / a + y / (a * b) + z / a.square()].map(|f| vec![f]);
        let found = graph.linear_relations_over(&columns, &[a, b]);
        assert_eq!(found, [vec![a * b, a, b, -a.square() * b]]);
    }

    /// Relations at special values of the constants are none over their field.
    #[test]
    fn a_relation_holds_for_all_values() {
        let graph = Graph::new();
        let [x, y, a] = graph.symbols(["x", "y", "a"]);
        let columns = [vec![x, y], vec![a * y, x], vec![a * x, a * y]];
        assert_eq!(graph.linear_relations_over(&columns, &[a]), [[a, Expr::ZERO, -Expr::ONE]]);
        assert_eq!(graph.linear_relations_over(&columns[..2], &[a]), Vec::<Vec<Expr<'_>>>::new());
        let roots = [(a + y.square()).sqrt() * x, a * (a + y.square()).sqrt() * x].map(|f| vec![f]);
        assert_eq!(graph.linear_relations_over(&roots, &[a]), [[a, -Expr::ONE]]);
    }
}
