//! Structure coefficients of a frame.

use std::convert::Infallible;

use pc_expr::{Expr, Graph, Number};

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::{LieAlgebra, check_jacobi};

/// The coefficients of [X_r, X_s] = c_rs^m X_m (5), for r, s = 0..k and m = 1..k; index 0 is time, c_rs^0 =
/// 0.
#[derive(Clone, Debug)]
pub struct StructureCoefficients<'g> {
    operators: usize,
    /// c_rs^m for r < s, at (r·(k+1) + s)·k + (m − 1).
    upper: Vec<Expr<'g>>,
}

impl<'g> StructureCoefficients<'g> {
    /// The coefficients c_rs^m = `c(r, s, m)` for r < s ≤ k; r and s count from 0, which is time, and m from 0 to k − 1.
    ///
    /// Nothing is checked: [`Frame::check`](crate::Frame::check) and [`Frame::check_jacobi`](crate::Frame::check_jacobi)
    /// say whether a frame has them.
    ///
    /// ```
    /// # use pc_algebra::StructureCoefficients;
    /// # use pc_expr::{Expr, Graph};
    /// // A plane that turns at the rate Ω: [X_0, X_1] = Ω X_2, [X_0, X_2] = −Ω X_1.
    /// let graph = Graph::new();
    /// let rate = graph.symbol("Ω");
    /// let c = StructureCoefficients::new(2, |r, s, m| match (r, s, m) {
    ///     (0, 1, 1) => rate,
    ///     (0, 2, 0) => -rate,
    ///     _ => Expr::ZERO,
    /// });
    /// assert_eq!(c.get(2, 0, 1), rate);
    /// ```
    pub fn new(operators: usize, c: impl Fn(usize, usize, usize) -> Expr<'g>) -> StructureCoefficients<'g> {
        let pair = |r: usize, s: usize| -> Result<Vec<Expr<'g>>, Infallible> {
            Ok((0..operators).map(|m| c(r, s, m)).collect())
        };
        match StructureCoefficients::from_pairs(operators, pair) {
            Ok(structure) => structure,
            Err(never) => match never {},
        }
    }

    /// The coefficients with `c(r, s)` = (c_rs^1, …, c_rs^k) for r < s, r from 0.
    pub(crate) fn from_pairs<E>(
        operators: usize,
        mut c: impl FnMut(usize, usize) -> Result<Vec<Expr<'g>>, E>,
    ) -> Result<StructureCoefficients<'g>, E> {
        let mut upper = Vec::with_capacity((operators + 1) * (operators + 1) * operators);
        for r in 0..=operators {
            for s in 0..=operators {
                if r < s {
                    upper.extend(c(r, s)?);
                } else {
                    upper.extend((0..operators).map(|_| Expr::ZERO));
                }
            }
        }
        Ok(StructureCoefficients { operators, upper })
    }

    /// The coefficients of the same operators in another order: `order` is a permutation of 0..k.
    ///
    /// # Panics
    /// If it is not.
    #[must_use]
    pub fn permuted(&self, order: &[usize]) -> StructureCoefficients<'g> {
        let old = |s: usize| if s == 0 { 0 } else { order[s - 1] + 1 };
        StructureCoefficients::new(self.operators, |r, s, m| self.get(old(r), old(s), old(m + 1)))
    }

    /// The coefficients c_rs^m with r, s, m ≤ `operators`, as many as there are at most.
    #[must_use]
    pub fn restricted(&self, operators: usize) -> StructureCoefficients<'g> {
        let operators = operators.min(self.operators);
        StructureCoefficients::new(operators, |r, s, m| self.get(r, s, m + 1))
    }

    /// The coefficients passed through `f`.
    #[must_use]
    pub fn map(&self, f: impl FnMut(Expr<'g>) -> Expr<'g>) -> StructureCoefficients<'g> {
        StructureCoefficients {
            operators: self.operators,
            upper: self.upper.iter().copied().map(f).collect(),
        }
    }

    /// Number k of operators, time not counted.
    pub fn operators(&self) -> usize {
        self.operators
    }

    /// c_rs^m with r, s in 0..=k and m in 1..=k.
    ///
    /// It is the Boltzmann–Hamel symbol γ_rs^m = (∂a_mi/∂x_j − ∂a_mj/∂x_i) b_ir b_js. Authors differ in its sign and in the
    /// order of its indices: with d/dt ∂L/∂η_s + γ_sr^m η_r ∂L/∂η_m − ∂L/∂π_s = Q_s it is this one.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn get(&self, r: usize, s: usize, m: usize) -> Expr<'g> {
        let k = self.operators;
        let at = |r: usize, s: usize| self.upper[(r * (k + 1) + s) * k + m - 1];
        match r.cmp(&s) {
            std::cmp::Ordering::Less => at(r, s),
            std::cmp::Ordering::Equal => Expr::ZERO,
            std::cmp::Ordering::Greater => -at(s, r),
        }
    }

    /// The coefficients that are not 0, as (r, s, m, c_rs^m) with r < s.
    pub fn nonzero(&self) -> impl Iterator<Item = (usize, usize, usize, Expr<'g>)> + '_ {
        let k = self.operators;
        (0..=k)
            .flat_map(move |r| (r + 1..=k).flat_map(move |s| (1..=k).map(move |m| (r, s, m))))
            .map(|(r, s, m)| (r, s, m, self.get(r, s, m)))
            .filter(|(.., c)| !c.is_zero())
    }

    /// Whether all are constants: then the X_s form a Lie algebra.
    pub fn are_constant(&self) -> bool {
        self.upper.iter().all(|c| c.constant().is_some())
    }

    /// The algebra of X_1..X_k, if its coefficients are constant.
    pub fn lie_algebra(&self) -> Option<LieAlgebra> {
        let k = self.operators;
        let mut constants = Vec::with_capacity(k * k * k);
        for r in 1..=k {
            for s in 1..=k {
                for m in 1..=k {
                    constants.push(self.get(r, s, m).constant()?);
                }
            }
        }
        Some(LieAlgebra::from_constants(k, |r, s, m| constants[(r * k + s) * k + m]))
    }

    /// v_s = (c_rs^m η_r + c_0s^m) p_m for s = 1..k, the terms that brackets give the equations (9).
    ///
    /// `eta` and `p` have length k.
    pub fn gyroscopic(&self, graph: &'g Graph, eta: &[Expr<'g>], p: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let k = self.operators;
        let mut terms: Vec<Vec<Expr<'g>>> = vec![Vec::new(); k];
        for (r, s, m, c) in self.nonzero() {
            let momentum = p[m - 1];
            if r == 0 {
                terms[s - 1].push(c * momentum);
            } else {
                terms[s - 1].push(c * eta[r - 1] * momentum);
                terms[r - 1].push(-(c * eta[s - 1] * momentum)); // c_sr = −c_rs
            }
        }
        terms.into_iter().map(|v| graph.sum(v)).collect()
    }
}

impl LieAlgebra {
    /// The structure coefficients of a stationary frame with this algebra (all c_0s = 0).
    pub fn structure_coefficients<'g>(&self) -> StructureCoefficients<'g> {
        self.and_drift(|_, _| Number::ZERO)
    }

    /// The structure coefficients with these c_rs^m and `drift(s, m)` = c_0s^m, indices from 0.
    ///
    /// # Errors
    /// [`AlgebraError::Jacobi`], with index 0 for time, where \[X_0, ·\] is no derivation of the algebra:
    /// \[X_0, \[X_r, X_s\]\] = \[\[X_0, X_r\], X_s\] + \[X_r, \[X_0, X_s\]\].
    ///
    /// ```
    /// # use pc_algebra::{AlgebraError, LieAlgebra};
    /// // [X_1, X_2] = X_2: X_0 may stretch X_2 but not X_1.
    /// let algebra = LieAlgebra::from_brackets(2, &[(0, 1, 1, 1.into())])?;
    /// let stretch = |which: usize| algebra.with_time(move |s, m| i32::from((s, m) == (which, which)).into());
    /// assert_eq!(stretch(1)?.get(0, 2, 2), 1.into());
    /// assert!(matches!(stretch(0), Err(AlgebraError::Jacobi { triple: (0, 1, 2), .. })));
    /// # Ok::<(), AlgebraError>(())
    /// ```
    pub fn with_time<'g>(
        &self,
        drift: impl Fn(usize, usize) -> Number,
    ) -> Result<StructureCoefficients<'g>, AlgebraError> {
        check_jacobi(0..=self.dim(), |r, s, m| match (r, s) {
            (0, 0) => Number::ZERO,
            (0, s) => drift(s - 1, m - 1),
            (r, 0) => -drift(r - 1, m - 1),
            (r, s) => self.constant(r - 1, s - 1, m - 1),
        })?;
        Ok(self.and_drift(drift))
    }

    fn and_drift<'g>(&self, drift: impl Fn(usize, usize) -> Number) -> StructureCoefficients<'g> {
        StructureCoefficients::new(self.dim(), |r, s, m| {
            if r == 0 { drift(s - 1, m) } else { self.constant(r - 1, s - 1, m) }.into()
        })
    }
}
