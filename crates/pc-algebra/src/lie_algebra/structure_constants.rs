//! Structure constants as rationals of any size.
//!
//! [`Number`] holds numerators and denominators up to 2⁵³ and rounds beyond that; elimination soon exceeds
//! this range. Exact properties of an algebra are therefore computed with [`BigRational`] and converted
//! back to [`Number`] at the end.

use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// Largest numerator and denominator of an exact [`Number`].
const LARGEST: i64 = 1 << 53;

/// `value` as a rational number; `None` for a rounded real number.
pub(crate) fn exact(value: Number) -> Option<BigRational> {
    match value {
        Number::Rational { num, den } => Some(BigRational::new(num.into(), den.into())),
        Number::Scaled { num, den, exponent } => {
            let ten = BigRational::from_integer(10.into());
            Some(BigRational::new(num.into(), den.into()) * ten.pow(exponent.into()))
        }
        Number::Real(_) => None,
    }
}

/// `value` as a number, if its numerator and denominator are small enough.
pub(crate) fn small(value: &BigRational) -> Option<Number> {
    let num: i64 = value.numer().to_i64()?;
    let den: i64 = value.denom().to_i64()?;
    (num.abs() <= LARGEST && den <= LARGEST).then(|| Number::ratio(num, den))
}

/// The number nearest to `value`, equal to it if its numerator and denominator are small enough.
pub(crate) fn rounded(value: &BigRational) -> Number {
    small(value).unwrap_or_else(|| Number::Real(value.to_f64().unwrap_or(f64::NAN)))
}

/// A multiple of `vector` with integer entries that have no common factor and whose first nonzero entry is
/// positive.
pub(crate) fn primitive(vector: &[BigRational]) -> Vec<BigRational> {
    let Some(first) = vector.iter().find(|x| !x.is_zero()) else { return vector.to_vec() };
    let scale = vector.iter().filter(|x| !x.is_zero()).fold(first.abs(), |g, x| common_divisor(&g, x));
    let scale = if first.is_negative() { -scale } else { scale };
    vector.iter().map(|x| x / &scale).collect()
}

/// The greatest rational number of which both numbers are integer multiples, found by Euclid's algorithm.
fn common_divisor(a: &BigRational, b: &BigRational) -> BigRational {
    let (mut a, mut b) = (a.abs(), b.abs());
    while !b.is_zero() {
        let rest = &a - (&a / &b).floor() * &b;
        (a, b) = (b, rest);
    }
    a
}

/// The entries of `matrix` as rationals.
///
/// # Errors
/// [`AlgebraError::IrrationalEntry`] with the first entry that is not rational.
pub(crate) fn exact_matrix(
    what: &'static str,
    matrix: &Matrix<Number>,
) -> Result<Vec<Vec<BigRational>>, AlgebraError> {
    let entry = |i: usize, j: usize| {
        exact(matrix[(i, j)]).ok_or_else(|| AlgebraError::IrrationalEntry {
            what,
            row: i + 1,
            column: j + 1,
            value: matrix[(i, j)].to_string(),
        })
    };
    (0..matrix.rows()).map(|i| (0..matrix.columns()).map(|j| entry(i, j)).collect()).collect()
}

/// The structure constants that are not 0.
pub(crate) struct ExactConstants {
    dim: usize,
    /// The pairs (m, c_rs^m) at index r·k + s; r, s and m are counted from 0.
    pairs: Vec<Vec<(usize, BigRational)>>,
}

impl ExactConstants {
    pub(crate) fn dim(&self) -> usize {
        self.dim
    }

    /// All (r, s, m, c_rs^m), with indices counted from 0.
    pub(crate) fn nonzero(&self) -> impl Iterator<Item = (usize, usize, usize, &BigRational)> {
        let k = self.dim;
        let pairs = self.pairs.iter().enumerate();
        pairs.flat_map(move |(i, c)| c.iter().map(move |(m, c)| (i / k, i % k, *m, c)))
    }

    /// The components of [X_r, X_s].
    pub(crate) fn pair(&self, r: usize, s: usize) -> Vec<BigRational> {
        let mut bracket = vec![BigRational::zero(); self.dim];
        for (m, c) in &self.pairs[r * self.dim + s] {
            bracket[*m].clone_from(c);
        }
        bracket
    }

    /// [u, v]^m = c_rs^m u_r v_s
    pub(crate) fn bracket(&self, u: &[BigRational], v: &[BigRational]) -> Vec<BigRational> {
        let mut result = vec![BigRational::zero(); self.dim];
        for (r, x) in u.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
            for (s, y) in v.iter().enumerate().filter(|(_, y)| !y.is_zero()) {
                let product = x * y;
                for (m, c) in &self.pairs[r * self.dim + s] {
                    result[*m] += c * &product;
                }
            }
        }
        result
    }
}

impl LieAlgebra {
    /// The structure constants as rationals of any size.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`] with the first constant that is a rounded real number.
    pub(crate) fn exact(&self) -> Result<ExactConstants, AlgebraError> {
        let mut pairs = vec![Vec::new(); self.dim() * self.dim()];
        for (r, s, m, value) in self.nonzero() {
            let c = exact(value).ok_or_else(|| AlgebraError::NotRational {
                r: r + 1,
                s: s + 1,
                m: m + 1,
                value: value.to_string(),
            })?;
            pairs[r * self.dim() + s].push((m, c));
        }
        Ok(ExactConstants { dim: self.dim(), pairs })
    }

    /// The algebra with rational constants that are known to satisfy Jacobi's identity.
    ///
    /// # Errors
    /// [`AlgebraError::TooLarge`] with the first constant that no [`Number`] can hold exactly.
    pub(crate) fn from_exact(
        dim: usize,
        c: impl Fn(usize, usize, usize) -> BigRational,
    ) -> Result<LieAlgebra, AlgebraError> {
        let mut constants = Vec::with_capacity(dim * dim * dim);
        for index in 0..dim * dim * dim {
            let (r, s, m) = (index / (dim * dim), index / dim % dim, index % dim);
            let value = c(r, s, m);
            constants.push(small(&value).ok_or_else(|| AlgebraError::TooLarge {
                r: r + 1,
                s: s + 1,
                m: m + 1,
                value: value.to_string(),
            })?);
        }
        Ok(LieAlgebra::from_constants(dim, |r, s, m| constants[(r * dim + s) * dim + m]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ratio(num: i64, den: i64) -> BigRational {
        BigRational::new(num.into(), den.into())
    }

    #[test]
    fn a_number_just_beyond_the_range_is_rounded_and_marked_so() {
        let just_beyond = ratio((1 << 54) + 1, 1 << 54);
        assert_eq!(small(&just_beyond), None);
        assert_eq!(rounded(&just_beyond).to_f64(), 1.0);
        assert_eq!(small(&ratio(-7, 21)), Some(Number::ratio(-1, 3)));
    }

    #[test]
    fn primitive_vectors_are_whole_and_coprime() {
        let vector = [ratio(0, 1), ratio(-2, 3), ratio(4, 9)];
        assert_eq!(primitive(&vector), [ratio(0, 1), ratio(3, 1), ratio(-2, 1)]);
    }
}
