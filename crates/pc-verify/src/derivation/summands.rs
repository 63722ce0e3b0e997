//! The sizes of the terms of a sum, which determine the rounding error after cancellation.

use crate::derivation::point::Point;
use crate::error::Irregular;
use crate::numbers::number::Number;
use crate::text::term::Term;

impl Point<'_, f64> {
    /// The largest summand of a term, found through its sums, products and definitions: for x − y it is the
    /// larger of |x| and |y|, however small the difference is. Arguments of functions and powers count as
    /// exact; the effect of their errors is found by deliberate rounding errors.
    pub(crate) fn largest_term(&self, term: &Term) -> Result<f64, Irregular> {
        Ok(match term {
            Term::Negative(inner) => self.largest_term(inner)?,
            Term::Definition(j) => match self.text().definitions.get(*j) {
                Some(definition) => match self.largest[*j].get() {
                    Some(known) => *known,
                    None => {
                        let largest = self.largest_term(definition)?;
                        *self.largest[*j].get_or_init(|| largest)
                    }
                },
                None => self.value(term)?.abs(),
            },
            Term::Sum(terms) => {
                let sizes = terms.iter().map(|(_, term)| self.largest_term(term));
                sizes.collect::<Result<Vec<f64>, Irregular>>()?.into_iter().fold(0.0, f64::max)
            }
            Term::Product(factors) => {
                let mut product = 1.0f64;
                for (divided, factor) in factors {
                    product *= match divided {
                        true => self.value(factor)?.real().abs().recip(),
                        false => self.largest_term(factor)?,
                    };
                }
                product
            }
            _ => self.value(term)?.abs(),
        })
    }
}
