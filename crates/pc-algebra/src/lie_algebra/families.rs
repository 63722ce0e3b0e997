//! The classical algebras of each size, and other well-known ones.

use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::LieAlgebra;

impl LieAlgebra {
    /// The rotations of space with c_12^3 = c_23^1 = c_31^2 = 1 (22): the signs of the body angular velocity.
    pub fn so3() -> LieAlgebra {
        LieAlgebra::from_constants(3, |r, s, m| levi_civita(r, s, m).into())
    }

    /// The rotations of ℝⁿ, of dimension n(n − 1)/2. The element R_ij turns axis i towards axis j, R_ij e_i =
    /// e_j; the basis is R_23, R_31, R_12 as in [`so3`](LieAlgebra::so3), then R_14, R_24, R_34, then R_15
    /// and so on, so that the basis of so(n − 1) comes first. \[R_ij, R_jl\] = −R_il for different i, j, l.
    ///
    /// # Errors
    /// [`AlgebraError::TooLargeFamily`] beyond n = 12.
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// assert_eq!(LieAlgebra::so(3)?, LieAlgebra::so3());
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn so(n: usize) -> Result<LieAlgebra, AlgebraError> {
        family_size("so", n, 12)?;
        Ok(rotations(n))
    }

    /// All n × n matrices, of dimension n². The basis consists of the matrices E_ij with a single entry 1,
    /// row by row: \[E_ij, E_kl\] = δ_jk E_il − δ_li E_kj.
    ///
    /// # Errors
    /// [`AlgebraError::TooLargeFamily`] beyond n = 8.
    pub fn gl(n: usize) -> Result<LieAlgebra, AlgebraError> {
        family_size("gl", n, 8)?;
        Ok(matrices(n))
    }

    /// The traceless real 2 × 2 matrices with basis H, E, F: \[H, E\] = 2E, \[H, F\] = −2F, \[E, F\] = H.
    pub fn sl2() -> LieAlgebra {
        known(3, &[(0, 1, 1, 2), (0, 2, 2, -2), (1, 2, 0, 1)])
    }

    /// The motions of the plane: rotation, then the two translations, in body axes: \[X_1, X_2\] = X_3,
    /// \[X_1, X_3\] = −X_2, \[X_2, X_3\] = 0.
    pub fn se2() -> LieAlgebra {
        known(3, &[(0, 1, 2, 1), (0, 2, 1, -1)])
    }

    /// The motions of space: rotations ω_1..ω_3, then translations v_1..v_3, in body axes:
    /// \[ω_i, ω_j\] = ε_ijk ω_k, \[ω_i, v_j\] = ε_ijk v_k, \[v_i, v_j\] = 0.
    pub fn se3() -> LieAlgebra {
        let rotation = |i: usize| i < 3;
        LieAlgebra::from_constants(6, |r, s, m| {
            let fits = match (rotation(r), rotation(s)) {
                (true, true) => rotation(m),
                (false, false) => false,
                _ => !rotation(m),
            };
            if fits { levi_civita(r % 3, s % 3, m % 3).into() } else { Number::ZERO }
        })
    }

    /// The Heisenberg algebra h_(2n+1) with basis X_1..X_n, Y_1..Y_n, Z: \[X_i, Y_i\] = Z, all other brackets
    /// 0.
    pub fn heisenberg(n: usize) -> LieAlgebra {
        LieAlgebra::from_constants(2 * n + 1, |r, s, m| match m == 2 * n {
            true if r < n && s == r + n => Number::ONE,
            true if s < n && r == s + n => Number::MINUS_ONE,
            _ => Number::ZERO,
        })
    }

    /// The affine maps x ↦ ax + b of the line: \[X_1, X_2\] = X_2 with X_1 the scaling and X_2 the
    /// translation.
    pub fn aff1() -> LieAlgebra {
        known(2, &[(0, 1, 1, 1)])
    }
}

/// The algebra with these brackets [X_r, X_s] = value·X_m, r < s, which are known to satisfy Jacobi's
/// identity.
pub(crate) fn known(dim: usize, brackets: &[(usize, usize, usize, i32)]) -> LieAlgebra {
    let listed = |r: usize, s: usize, m: usize| -> i32 {
        brackets.iter().filter(|b| (b.0, b.1, b.2) == (r, s, m)).map(|b| b.3).sum()
    };
    LieAlgebra::from_constants(dim, |r, s, m| (listed(r, s, m) - listed(s, r, m)).into())
}

/// The algebra so(n), with constants computed from R_ij R_kl − R_kl R_ij.
pub(crate) fn rotations(n: usize) -> LieAlgebra {
    let planes = planes(n);
    let entry = |(i, j): (usize, usize), a: usize, b: usize| {
        i32::from((a, b) == (j, i)) - i32::from((a, b) == (i, j))
    };
    LieAlgebra::from_constants(planes.len(), |r, s, m| {
        let ((x, y), (i, j)) = ((planes[r], planes[s]), planes[m]);
        let terms = (0..n).map(|l| entry(x, j, l) * entry(y, l, i) - entry(y, j, l) * entry(x, l, i));
        terms.sum::<i32>().into()
    })
}

/// gl(n)
pub(crate) fn matrices(n: usize) -> LieAlgebra {
    let place = |index: usize| (index / n, index % n);
    LieAlgebra::from_constants(n * n, |r, s, m| {
        let ((i, j), (k, l), unit) = (place(r), place(s), place(m));
        (i32::from(j == k && unit == (i, l)) - i32::from(l == i && unit == (k, j))).into()
    })
}

fn family_size(family: &'static str, n: usize, largest: usize) -> Result<(), AlgebraError> {
    if n <= largest { Ok(()) } else { Err(AlgebraError::TooLargeFamily { family, n, largest }) }
}

/// ε_ijk
fn levi_civita(i: usize, j: usize, k: usize) -> i32 {
    match ((j + 3 - i) % 3, (k + 3 - j) % 3) {
        (1, 1) => 1,
        (2, 2) => -1,
        _ => 0,
    }
}

/// The planes (i, j) of the basis R_ij of so(n), with axes counted from 0.
fn planes(n: usize) -> Vec<(usize, usize)> {
    let first: &[(usize, usize)] = match n {
        0 | 1 => &[],
        2 => &[(0, 1)],
        _ => &[(1, 2), (2, 0), (0, 1)],
    };
    first.iter().copied().chain((3..n).flat_map(|j| (0..j).map(move |i| (i, j)))).collect()
}
