//! Rational functions read back from their values in GF(2⁶¹ − 1).
//!
//! The degree in each variable is found along a line, on which the simplest quotient of polynomials through the values
//! is unique. With these degrees the quotient N/D in lowest terms is the only solution of the linear equations
//! N(x_k) − y_k D(x_k) = 0 at sufficiently many points.

use crate::graph::number::Number;
use crate::identity::echelon::ResidueEchelon;
use crate::identity::linear_relations::fraction;
use crate::identity::prime_field::Residue;

/// The greatest sum of the degrees of numerator and denominator in one variable.
const MOST_DEGREE: usize = 10;
/// This many points in addition to those that determine a function confirm it.
const MORE_POINTS: usize = 2;
/// The greatest number of coefficients of numerator and denominator together.
const MOST_COEFFICIENTS: usize = 250;

/// A term: the exponents of the variables, and the coefficient.
pub(super) type Term = (Vec<u32>, Number);

/// N/D in lowest terms.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RationalFunction {
    pub(super) numerator: Vec<Term>,
    pub(super) denominator: Vec<Term>,
}

/// Values at the points of a grid: each variable is given the place of its value on its own line.
pub(super) trait Grid {
    /// The number of variables.
    fn variables(&self) -> usize;
    /// The value of a variable at a place.
    fn variable(&self, variable: usize, place: usize) -> Residue;
    /// The value of the function where the variables are at these places, if it has one.
    fn value(&mut self, places: &[usize]) -> Option<Residue>;
}

impl RationalFunction {
    /// The function with the values of the grid; `None` if its degrees are too large.
    pub(super) fn of(grid: &mut impl Grid) -> Option<RationalFunction> {
        let variables = grid.variables();
        let degrees: Vec<(usize, usize)> =
            (0..variables).map(|variable| degrees(grid, variable)).collect::<Option<_>>()?;
        let numerator = exponents(degrees.iter().map(|&(n, _)| n))?;
        let denominator = exponents(degrees.iter().map(|&(_, d)| d))?;
        let unknowns = numerator.len() + denominator.len();
        if unknowns > MOST_COEFFICIENTS {
            return None;
        }
        let mut echelon = ResidueEchelon::new(unknowns);
        for place in 0..unknowns - 1 + MORE_POINTS {
            let x: Vec<Residue> = (0..variables).map(|variable| grid.variable(variable, place)).collect();
            let y = grid.value(&vec![place; variables])?;
            let above = numerator.iter().map(|e| monomial(&x, e));
            let below = denominator.iter().map(|e| -(y * monomial(&x, e)));
            echelon.insert(above.chain(below).collect());
        }
        let [solution] = &echelon.null_space()[..] else { return None };
        let terms = |exponents: &[Vec<u32>], coefficients: &[Residue]| -> Vec<Term> {
            let terms = exponents.iter().zip(coefficients).filter(|(_, a)| **a != Residue::ZERO);
            terms.map(|(e, &a)| (e.clone(), fraction(a))).collect()
        };
        let (above, below) = solution.split_at(numerator.len());
        Some(RationalFunction {
            numerator: terms(&numerator, above),
            denominator: terms(&denominator, below),
        })
    }
}

/// The degrees of numerator and denominator in one variable, while the others stay at their place 0.
pub(super) fn degrees(grid: &mut impl Grid, variable: usize) -> Option<(usize, usize)> {
    let mut line: Vec<(Residue, Residue)> = Vec::new();
    for total in 0..=MOST_DEGREE {
        while line.len() <= total + MORE_POINTS {
            let mut places = vec![0; grid.variables()];
            places[variable] = line.len();
            let y = grid.value(&places)?;
            line.push((grid.variable(variable, line.len()), y));
        }
        if let Some(below) = (0..=total).find(|&below| fits(&line, total - below, below)) {
            return Some((total - below, below));
        }
    }
    None
}

/// Whether a quotient of polynomials of these degrees has the values of the line.
fn fits(line: &[(Residue, Residue)], above: usize, below: usize) -> bool {
    let mut echelon = ResidueEchelon::new(above + below + 2);
    for &(x, y) in line {
        let powers = |y: Residue| std::iter::successors(Some(y), move |&power| Some(power * x));
        echelon.insert(powers(Residue::ONE).take(above + 1).chain(powers(y).take(below + 1)).collect());
    }
    echelon.rank() < above + below + 2
}

/// The exponents up to these degrees, unless there are too many.
fn exponents(degrees: impl Iterator<Item = usize>) -> Option<Vec<Vec<u32>>> {
    let mut all = vec![Vec::new()];
    for degree in degrees {
        if all.len() * (degree + 1) > MOST_COEFFICIENTS {
            return None;
        }
        let with = |start: Vec<u32>| (0..=degree as u32).map(move |e| [start.as_slice(), &[e]].concat());
        all = all.into_iter().flat_map(with).collect();
    }
    Some(all)
}

fn monomial(x: &[Residue], exponents: &[u32]) -> Residue {
    x.iter().zip(exponents).fold(Residue::ONE, |product, (x, &e)| product * x.pow(u64::from(e)))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Quotient;

    impl Grid for Quotient {
        fn variables(&self) -> usize {
            3
        }
        fn variable(&self, variable: usize, place: usize) -> Residue {
            Residue::sequence(1 + variable as u64).nth(place).unwrap_or_default()
        }
        /// (x² − 2/3)/(x − y), independent of z
        fn value(&mut self, places: &[usize]) -> Option<Residue> {
            let (x, y) = (self.variable(0, places[0]), self.variable(1, places[1]));
            let two_thirds = Residue::integer(2) * Residue::integer(3).inverse();
            Some((x * x - two_thirds) * (x - y).inverse())
        }
    }

    #[test]
    fn a_quotient_is_read_back() {
        let found = RationalFunction::of(&mut Quotient).expect("of low degree");
        let ratio = |(e, a): &Term, (of, b): &Term| (e.clone(), of.clone(), *a * b.recip());
        let [constant, square] = &found.numerator[..] else { panic!("{found:?}") };
        let [y, x] = &found.denominator[..] else { panic!("{found:?}") };
        let three = |a: u32, b: u32| vec![a, b, 0];
        assert_eq!(ratio(constant, square), (three(0, 0), three(2, 0), Number::ratio(-2, 3)));
        assert_eq!(ratio(y, x), (three(0, 1), three(1, 0), Number::MINUS_ONE));
        assert_eq!(square.1, x.1);
    }
}
