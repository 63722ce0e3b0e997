//! Orthonormal columns.

/// Replaces the columns of a dim × k matrix A = QR, column-major, by those of Q, and returns the
/// diagonal of R.
///
/// Uses modified Gram–Schmidt, twice for each column, so that the columns are orthogonal up to
/// rounding error whatever their original angles [Giraud, Langou, Rozložník, van den Eshof, Numer.
/// Math. 101 (2005) 87]. The entries of the diagonal are not negative; where an entry is zero or
/// not finite, the column is not a unit vector.
pub(crate) fn orthonormalise(columns: &mut [f64], dim: usize) -> Vec<f64> {
    let mut diagonal = Vec::with_capacity(columns.len() / dim);
    for k in 0..columns.len() / dim {
        let (before, from) = columns.split_at_mut(k * dim);
        let column = &mut from[..dim];
        for _ in 0..2 {
            for q in before.chunks_exact(dim) {
                let along: f64 = q.iter().zip(&*column).map(|(q, a)| q * a).sum();
                for (a, q) in column.iter_mut().zip(q) {
                    *a -= along * q;
                }
            }
        }
        let length = length(column);
        for a in column {
            *a /= length;
        }
        diagonal.push(length);
    }
    diagonal
}

/// |v|, without intermediate overflow.
pub(crate) fn length(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |length: f64, v| length.hypot(*v))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A = QR with Q orthonormal; the product of the diagonal of R is |det A|.
    #[test]
    fn columns_become_orthonormal() {
        // Two columns at an angle of 1e-9, where a single pass loses seven digits.
        let mut columns = [1.0, 1.0, 1.0, 1.0, 1.0 + 1e-9, 1.0, 2.0, 0.0, 5.0];
        let diagonal = orthonormalise(&mut columns, 3);
        for (i, p) in columns.chunks(3).enumerate() {
            for (j, q) in columns.chunks(3).enumerate() {
                let product: f64 = p.iter().zip(q).map(|(p, q)| p * q).sum();
                let expected = f64::from(u8::from(i == j));
                assert!((product - expected).abs() < 1e-15, "{i} {j}: {product}"); // a few roundings
            }
        }
        // det = ε (5 − 2) from the second column (ε = 1e-9, known to ε_machine/1e-9).
        let volume: f64 = diagonal.iter().product();
        assert!((volume / 3e-9 - 1.0).abs() < 1e-6, "{volume}");
    }

    #[test]
    fn dependent_columns_have_length_zero() {
        let diagonal = orthonormalise(&mut [1.0, 0.0, 2.0, 0.0], 2);
        assert_eq!(diagonal, [1.0, 0.0]);
    }
}
