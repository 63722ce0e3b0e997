//! Sums, products and vectors of terms, without what is 0 or 1 as written.

use crate::text::term::{Function, Term};

/// Whether a term is this number.
pub(super) fn is(term: &Term, value: f64) -> bool {
    matches!(term, Term::Number(number) if *number == value)
}

/// The unit vector along a fixed axis.
pub(super) fn unit(axis: usize) -> Vec<Term> {
    (0..3).map(|i| Term::Number(f64::from(u8::from(i == axis)))).collect()
}

/// A product, without factors of 1.
pub(super) fn times<const N: usize>(factors: [&Term; N]) -> Term {
    if factors.iter().any(|factor| is(factor, 0.0)) {
        return Term::Number(0.0);
    }
    let mut factors: Vec<(bool, Term)> =
        factors.into_iter().filter(|factor| !is(factor, 1.0)).map(|factor| (false, factor.clone())).collect();
    match factors.len() {
        0 => Term::Number(1.0),
        1 => factors.remove(0).1,
        _ => Term::Product(factors),
    }
}

/// A quotient.
pub(super) fn quotient(term: Term, by: &Term) -> Term {
    if is(&term, 0.0) || is(by, 1.0) { term } else { Term::Product(vec![(false, term), (true, by.clone())]) }
}

/// A sum, without zeros.
pub(super) fn sum(terms: Vec<Term>) -> Term {
    let mut terms: Vec<(bool, Term)> =
        terms.into_iter().filter(|term| !is(term, 0.0)).map(|term| (false, term)).collect();
    match terms.len() {
        0 => Term::Number(0.0),
        1 => terms.remove(0).1,
        _ => Term::Sum(terms),
    }
}

/// −a
pub(super) fn negative(term: Term) -> Term {
    if is(&term, 0.0) { term } else { Term::Negative(Box::new(term)) }
}

/// a − b
pub(super) fn difference(a: Term, b: Term) -> Term {
    match (is(&a, 0.0), is(&b, 0.0)) {
        (_, true) => a,
        (true, false) => negative(b),
        (false, false) => Term::Sum(vec![(false, a), (true, b)]),
    }
}

/// √a
pub(super) fn root(term: Term) -> Term {
    if is(&term, 1.0) { term } else { Term::Call(Function::Sqrt, vec![term]) }
}

/// a·b
pub(super) fn dot(a: &[Term], b: &[Term]) -> Term {
    sum(a.iter().zip(b).map(|(a, b)| times([a, b])).collect())
}

/// a + b of vectors.
pub(super) fn added(a: &[Term], b: &[Term]) -> Vec<Term> {
    a.iter().zip(b).map(|(a, b)| sum(vec![a.clone(), b.clone()])).collect()
}

/// The rates of terms.
pub(super) fn rates(terms: &[Term]) -> Vec<Term> {
    let rate = |term: &Term| match term {
        Term::Number(_) => Term::Number(0.0),
        term => Term::Rate(Box::new(term.clone())),
    };
    terms.iter().map(rate).collect()
}

/// a × b
pub(super) fn cross(a: &[Term], b: &[Term]) -> Vec<Term> {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| difference(times([&a[i], &b[j]]), times([&a[j], &b[i]]))).to_vec()
}
