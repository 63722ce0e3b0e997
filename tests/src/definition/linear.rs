//! Small dense linear systems.

/// A column that keeps so little of its length beside those before it depends on them.
const DEPENDENT: f64 = 1e-9;

/// The matrix P of least squares: c = P v solves Σ_m c_m columns_m = v with the least residual; by Gram and
/// Schmidt's orthogonal columns. `None` where the columns are dependent.
pub(super) fn pseudo_inverse(columns: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let k = columns.len();
    let (mut basis, mut triangle): (Vec<Vec<f64>>, _) = (Vec::new(), vec![vec![0.0; k]; k]);
    for (m, column) in columns.iter().enumerate() {
        let mut rest = column.clone();
        for _ in 0..2 {
            // The second round removes what the rounding of the first has left.
            for (q, direction) in basis.iter().enumerate() {
                let along = dot(direction, &rest);
                triangle[q][m] += along;
                (0..rest.len()).for_each(|i| rest[i] -= along * direction[i]);
            }
        }
        let length = dot(&rest, &rest).sqrt();
        if length <= DEPENDENT * dot(column, column).sqrt() {
            return None;
        }
        triangle[m][m] = length;
        basis.push(rest.iter().map(|v| v / length).collect());
    }
    // From the last row up: triangle · P = basisᵀ.
    for m in (0..k).rev() {
        for q in m + 1..k {
            let row = basis[q].clone();
            (0..row.len()).for_each(|i| basis[m][i] -= triangle[m][q] * row[i]);
        }
        basis[m].iter_mut().for_each(|v| *v /= triangle[m][m]);
    }
    Some(basis)
}

fn dot(u: &[f64], v: &[f64]) -> f64 {
    u.iter().zip(v).map(|(u, v)| u * v).sum()
}

/// The inverse of a regular matrix, by Gauss and Jordan's elimination with row interchanges.
///
/// # Panics
/// If the matrix is singular.
pub(super) fn inverse(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let size = matrix.len();
    let unit = |i: usize| (0..size).map(move |j| f64::from(u8::from(i == j)));
    let mut rows: Vec<Vec<f64>> =
        matrix.iter().enumerate().map(|(i, row)| row.iter().copied().chain(unit(i)).collect()).collect();
    for column in 0..size {
        let largest = |a: &usize, b: &usize| rows[*a][column].abs().total_cmp(&rows[*b][column].abs());
        let pivot = (column..size).max_by(largest).unwrap_or(column);
        rows.swap(column, pivot);
        let divisor = rows[column][column];
        assert!(divisor != 0.0, "the matrix is singular: {matrix:?}");
        rows[column].iter_mut().for_each(|entry| *entry /= divisor);
        let pivot_row = rows[column].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|&(i, _)| i != column) {
            let factor = row[column];
            row.iter_mut().zip(&pivot_row).for_each(|(entry, p)| *entry -= factor * p);
        }
    }
    rows.into_iter().map(|row| row[size..].to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_are_solved_and_dependent_columns_refused() {
        let matrix = [vec![0.0, 2.0, 1.0], vec![1.0, -1.0, 0.5], vec![3.0, 0.0, 4.0]];
        let inverse = inverse(&matrix);
        for i in 0..3 {
            for j in 0..3 {
                let entry: f64 = (0..3).map(|m| matrix[i][m] * inverse[m][j]).sum();
                assert!((entry - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
        let columns = [vec![1.0, 2.0, 0.0], vec![0.0, 1.0, -1.0]];
        let rows = pseudo_inverse(&columns).expect("independent columns");
        let c: Vec<f64> = rows.iter().map(|row| dot(row, &[2.0, 1.0, 3.0])).collect();
        assert!((c[0] - 2.0).abs() < 1e-14 && (c[1] + 3.0).abs() < 1e-14, "{c:?}");
        assert!(pseudo_inverse(&[columns[0].clone(), vec![0.5, 1.0, 0.0]]).is_none());
        assert!(pseudo_inverse(&[vec![]]).is_none());
    }
}
