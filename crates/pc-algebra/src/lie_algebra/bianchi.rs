//! The nine types of three-dimensional Lie algebras that Bianchi distinguished.

use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::LieAlgebra;

impl LieAlgebra {
    /// Bianchi's type VI_h, h ≤ 0: \[X_1, X_2\] = −aX_2 − X_3, \[X_2, X_3\] = 0, \[X_3, X_1\] = X_2 + aX_3
    /// with a = √−h. Type III is VI_h with h = −1.
    ///
    /// The constants are rational if h is minus the square of a rational; otherwise a is rounded, and only
    /// numerical methods can be used.
    ///
    /// # Errors
    /// [`AlgebraError::BianchiParameter`] for h > 0 or NaN.
    pub fn bianchi6(h: Number) -> Result<LieAlgebra, AlgebraError> {
        let a =
            root(-h)
                .ok_or(AlgebraError::BianchiParameter { kind: "VI", range: "≤ 0", h: h.to_string() })?;
        Ok(behr(a, [0, 1, -1]))
    }

    /// Bianchi's type VII_h, h ≥ 0: \[X_1, X_2\] = −aX_2 + X_3, \[X_2, X_3\] = 0, \[X_3, X_1\] = X_2 + aX_3
    /// with a = √h; h = 0 is se(2). The constant a is rounded as in [`bianchi6`](LieAlgebra::bianchi6).
    ///
    /// # Errors
    /// [`AlgebraError::BianchiParameter`] for h < 0 or NaN.
    pub fn bianchi7(h: Number) -> Result<LieAlgebra, AlgebraError> {
        let a =
            root(h)
                .ok_or(AlgebraError::BianchiParameter { kind: "VII", range: "≥ 0", h: h.to_string() })?;
        Ok(behr(a, [0, 1, 1]))
    }
}

/// The algebra \[X_1, X_2\] = −aX_2 + n_3 X_3, \[X_2, X_3\] = n_1 X_1, \[X_3, X_1\] = n_2 X_2 + aX_3, where a
/// n_1 = 0 (L. D. Landau, E. M. Lifshitz, *The Classical Theory of Fields*, §116).
pub(crate) fn behr(a: Number, n: [i32; 3]) -> LieAlgebra {
    let [n1, n2, n3] = n.map(Number::from);
    let listed = |r: usize, s: usize, m: usize| match (r, s, m) {
        (0, 1, 1) => -a,
        (0, 1, 2) => n3,
        (1, 2, 0) => n1,
        (2, 0, 1) => n2,
        (2, 0, 2) => a,
        _ => Number::ZERO,
    };
    LieAlgebra::from_constants(3, |r, s, m| {
        let direct = listed(r, s, m);
        if direct.is_zero() { -listed(s, r, m) } else { direct }
    })
}

/// The square root √x, exact if it is rational; `None` if it is not real.
fn root(x: Number) -> Option<Number> {
    (x.is_finite() && (x.is_zero() || !x.is_negative()))
        .then(|| x.exact_sqrt().unwrap_or_else(|| Number::Real(x.to_f64().sqrt())))
}
