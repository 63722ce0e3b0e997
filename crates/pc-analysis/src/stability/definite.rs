//! The search for a positive definite combination of quadratic forms.

use pc_mech::{Matrix, MechError};

use crate::numeric::dense::{norm, symmetric_eigenvalues};

/// The number of steps of the search for each pair of forms; each step reduces the volume by the factor
/// e^(−1/(2K + 2)).
const STEPS: usize = 1000;

/// Numbers c, not all zero, for which W(c) = Σ c_i W_i is positive definite, with a least eigenvalue above
/// `tolerance` |c|; `None` if there are none.
///
/// The least eigenvalue φ(c) is concave, and the numbers vᵀ W_i v, where v is its eigenvector, form a slope
/// (supergradient) of φ, since φ(c') ≤ vᵀ W(c') v for all c'. So each step cuts off half of the remaining
/// part of the unit ball (the ellipsoid method of D. B. Yudin and A. S. Nemirovski), until a c is found or
/// the slope shows that φ nowhere exceeds the tolerance.
/// # Errors
/// [`MatrixError::NoEigenvalues`](pc_mech::MatrixError::NoEigenvalues) if an entry is not finite.
pub(crate) fn definite_combination(
    forms: &[Matrix<f64>],
    tolerance: f64,
) -> Result<Option<Vec<f64>>, MechError> {
    let count = forms.len();
    if count < 2 {
        return single(forms, tolerance);
    }
    let k = count as f64;
    let mut centre = vec![0.0; count];
    let mut ellipsoid = Matrix::from_fn(count, count, |i, j| f64::from(u8::from(i == j)));
    for _ in 0..STEPS * count * count {
        let (least, slope) = least_eigenvalue(forms, &centre)?;
        if least > tolerance * norm(&centre) {
            return Ok(Some(centre));
        }
        let inward = norm(&centre) > 1.0;
        let slope: Vec<f64> = if inward { centre.iter().map(|c| -c).collect() } else { slope };
        let across: Vec<f64> = (0..count).map(|i| dot(&ellipsoid.row(i), &slope)).collect();
        let width = dot(&across, &slope).max(0.0).sqrt();
        if width == 0.0 || !inward && least + width <= tolerance {
            return Ok(None);
        }
        for i in 0..count {
            centre[i] += across[i] / (width * (k + 1.0));
        }
        let cut = |i: usize, j: usize| 2.0 / (k + 1.0) * across[i] * across[j] / (width * width);
        ellipsoid =
            Matrix::from_fn(count, count, |i, j| k * k / (k * k - 1.0) * (ellipsoid[(i, j)] - cut(i, j)));
    }
    Ok(None)
}

/// The result if there is one form or none.
fn single(forms: &[Matrix<f64>], tolerance: f64) -> Result<Option<Vec<f64>>, MechError> {
    for sign in [1.0, -1.0].into_iter().take(2 * forms.len()) {
        if least_eigenvalue(forms, &[sign])?.0 > tolerance {
            return Ok(Some(vec![sign]));
        }
    }
    Ok(None)
}

/// φ(c), with a slope of φ there; φ = +∞ on a space of dimension 0.
fn least_eigenvalue(forms: &[Matrix<f64>], c: &[f64]) -> Result<(f64, Vec<f64>), MechError> {
    let (values, vectors) = symmetric_eigenvalues(&combination(forms, c))?;
    let Some(&least) = values.first() else { return Ok((f64::INFINITY, vec![0.0; c.len()])) };
    let v: Vec<f64> = vectors.column(0).collect();
    let at = |form: &Matrix<f64>| (0..v.len()).map(|i| v[i] * dot(&form.row(i), &v)).sum();
    Ok((least, forms.iter().map(at).collect()))
}

/// Σ c_i W_i
pub(crate) fn combination(forms: &[Matrix<f64>], c: &[f64]) -> Matrix<f64> {
    let size = forms.first().map_or(0, Matrix::rows);
    Matrix::from_fn(size, size, |i, j| forms.iter().zip(c).map(|(form, c)| c * form[(i, j)]).sum())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(entries: [f64; 4]) -> Matrix<f64> {
        Matrix::from_fn(2, 2, |i, j| entries[2 * i + j])
    }

    /// diag(1, −1) + μ diag(−1, 2) is definite only for ½ < μ < 1; with diag(−1, 1) as the second form, it is
    /// definite for no μ.
    #[test]
    fn a_narrow_range_is_found_and_an_empty_one_refused() {
        let first = form([1.0, 0.0, 0.0, -1.0]);
        let found =
            definite_combination(&[first.clone(), form([-1.0, 0.0, 0.0, 2.0])], 1e-14).unwrap().unwrap();
        assert!((0.5..1.0).contains(&(found[1] / found[0])), "{found:?}");
        let none = definite_combination(&[first, form([-1.0, 0.0, 0.0, 1.0])], 1e-14).unwrap();
        assert_eq!(none, None);
    }

    /// Three forms whose combinations are definite only in a range of width 10⁻⁶.
    #[test]
    fn three_forms_are_combined() {
        let forms = [form([1.0, 0.0, 0.0, 0.0]), form([0.0, 1.0, 1.0, 0.0]), form([-1.0, 0.0, 0.0, 1e-6])];
        let found = definite_combination(&forms, 1e-14).unwrap().unwrap();
        assert!(found[2] > 0.0 && found[0] > found[2], "{found:?}");
    }
}
