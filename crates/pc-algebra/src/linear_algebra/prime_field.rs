//! Numbers modulo the prime 2⁶¹ − 1, for ranks of matrices that hold at almost all points.

use pc_expr::Number;

use crate::linear_algebra::matrix::Matrix;

const PRIME: u64 = (1 << 61) - 1;

/// An element of the field of 2⁶¹ − 1 elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Residue(u64);

impl Residue {
    pub(crate) const ZERO: Residue = Residue(0);

    fn of(value: u128) -> Residue {
        Residue((value % u128::from(PRIME)) as u64)
    }

    /// num·den⁻¹; `None` for a rounded real. Denominators are below the prime, so none is 0.
    pub(crate) fn of_number(value: Number) -> Option<Residue> {
        let Number::Rational { num, den } = value else { return None };
        let size = Residue::of(num.unsigned_abs().into()) * Residue::of(den.unsigned_abs().into()).inverse();
        Some(if num < 0 { Residue::ZERO - size } else { size })
    }

    /// x^(p − 2), which is x⁻¹ for x ≠ 0.
    fn inverse(self) -> Residue {
        let (mut power, mut square, mut exponent) = (Residue(1), self, PRIME - 2);
        while exponent > 0 {
            if exponent & 1 == 1 {
                power = power * square;
            }
            square = square * square;
            exponent >>= 1;
        }
        power
    }
}

impl std::ops::Add for Residue {
    type Output = Residue;
    fn add(self, other: Residue) -> Residue {
        Residue::of(u128::from(self.0) + u128::from(other.0))
    }
}

impl std::ops::Sub for Residue {
    type Output = Residue;
    fn sub(self, other: Residue) -> Residue {
        Residue::of(u128::from(self.0) + u128::from(PRIME - other.0))
    }
}

impl std::ops::Mul for Residue {
    type Output = Residue;
    fn mul(self, other: Residue) -> Residue {
        Residue::of(u128::from(self.0) * u128::from(other.0))
    }
}

impl std::iter::Sum for Residue {
    fn sum<I: Iterator<Item = Residue>>(terms: I) -> Residue {
        terms.fold(Residue::ZERO, |sum, x| sum + x)
    }
}

/// Point number `index` of a fixed pseudo-random sequence (splitmix64).
pub(crate) fn point(dim: usize, index: u64) -> Vec<Residue> {
    let mut state = index << 32;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Residue::of((z ^ (z >> 31)).into())
    };
    (0..dim).map(|_| next()).collect()
}

/// Rank of a matrix, by elimination.
pub(crate) fn rank(mut matrix: Matrix<Residue>) -> usize {
    let (rows, columns) = (matrix.rows(), matrix.columns());
    let mut rank = 0;
    for column in 0..columns {
        let Some(pivot) = (rank..rows).find(|&i| matrix[(i, column)] != Residue::ZERO) else { continue };
        for j in 0..columns {
            (matrix[(rank, j)], matrix[(pivot, j)]) = (matrix[(pivot, j)], matrix[(rank, j)]);
        }
        let inverse = matrix[(rank, column)].inverse();
        for i in rank + 1..rows {
            let factor = matrix[(i, column)] * inverse;
            for j in column..columns {
                matrix[(i, j)] = matrix[(i, j)] - factor * matrix[(rank, j)];
            }
        }
        rank += 1;
    }
    rank
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_multiply_as_they_should() {
        let residue = |num, den| Residue::of_number(Number::ratio(num, den)).unwrap();
        assert_eq!(residue(-2, 3) * residue(9, 4), residue(-3, 2));
        assert_eq!(residue(-2, 3) + residue(1, 6), residue(-1, 2));
        assert_eq!(residue(1, 3) - residue(1, 3), Residue::ZERO);
        assert_eq!(Residue::of_number(Number::UNDEFINED), None);
    }

    #[test]
    fn the_rank_counts_independent_rows() {
        let rows = [[1, 2, 3], [2, 4, 6], [0, 0, 5], [1, 2, 8]];
        let entry = |i: usize, j: usize| Residue::of_number(Number::from(rows[i][j])).unwrap();
        assert_eq!(rank(Matrix::from_fn(4, 3, entry)), 2);
    }
}
