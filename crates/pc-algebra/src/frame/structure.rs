//! Structure coefficients of a frame.

use pc_expr::{Expr, Graph, Number};

use crate::error::AlgebraError;
use crate::lie_algebra::jacobi::check_jacobi;
use crate::lie_algebra::lie_algebra::LieAlgebra;

/// The coefficients of [X_r, X_s] = c_rs^m X_m (5), for r, s = 0..k and m = 1..k; index 0 is time, c_rs^0 =
/// 0.
#[derive(Clone, Debug)]
pub struct StructureCoefficients<'g> {
    operators: usize,
    /// The c_rs^m that are not 0, with r < s, as (r, s, m, c_rs^m) in the order of (r, s, m): most of the k³
    /// coefficients of a frame are 0.
    nonzero: Vec<(usize, usize, usize, Expr<'g>)>,
}

impl<'g> StructureCoefficients<'g> {
    /// The coefficients c_rs^m = `c(r, s, m)` for r < s ≤ k; r and s count from 0, which is time, and m from
    /// 0 to k − 1.
    ///
    /// Nothing is checked: [`Frame::check`](crate::Frame::check) and
    /// [`Frame::check_jacobi`](crate::Frame::check_jacobi) check whether the coefficients are those of a
    /// frame.
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
        let indices = pairs(operators).flat_map(|(r, s)| (0..operators).map(move |m| (r, s, m)));
        StructureCoefficients::from_nonzero(operators, indices.map(|(r, s, m)| (r, s, m + 1, c(r, s, m))))
    }

    /// The coefficients c_rs^m listed as (r, s, m, c_rs^m), with r ≠ s counted from 0 and m from 1, none
    /// listed twice; all others are 0.
    pub(crate) fn from_nonzero(
        operators: usize,
        listed: impl IntoIterator<Item = (usize, usize, usize, Expr<'g>)>,
    ) -> StructureCoefficients<'g> {
        let ordered =
            |(r, s, m, c): (usize, usize, usize, Expr<'g>)| if r < s { (r, s, m, c) } else { (s, r, m, -c) };
        let mut nonzero: Vec<_> = listed.into_iter().filter(|(.., c)| !c.is_zero()).map(ordered).collect();
        nonzero.sort_unstable_by_key(|&(r, s, m, _)| (r, s, m));
        StructureCoefficients { operators, nonzero }
    }

    /// The coefficients with `c(r, s)` = (c_rs^1, …, c_rs^k) for the `pairs` r < s, counted from 0; all other
    /// pairs commute.
    pub(crate) fn from_pairs<E>(
        operators: usize,
        pairs: impl IntoIterator<Item = (usize, usize)>,
        mut c: impl FnMut(usize, usize) -> Result<Vec<Expr<'g>>, E>,
    ) -> Result<StructureCoefficients<'g>, E> {
        let mut listed = Vec::new();
        for (r, s) in pairs {
            listed.extend(c(r, s)?.into_iter().enumerate().map(|(m, c)| (r, s, m + 1, c)));
        }
        Ok(StructureCoefficients::from_nonzero(operators, listed))
    }

    /// The coefficients of the same operators in another order: `order` is a permutation of 0..k.
    ///
    /// # Panics
    /// If `order` is not a permutation.
    #[must_use]
    pub fn permuted(&self, order: &[usize]) -> StructureCoefficients<'g> {
        let mut new = vec![0; order.len() + 1];
        order.iter().enumerate().for_each(|(new_place, &old)| new[old + 1] = new_place + 1);
        let moved = self.nonzero.iter().map(|&(r, s, m, c)| (new[r], new[s], new[m], c));
        StructureCoefficients::from_nonzero(self.operators, moved)
    }

    /// The coefficients c_rs^m with r, s, m ≤ `operators`, or all coefficients if there are fewer operators.
    #[must_use]
    pub fn restricted(&self, operators: usize) -> StructureCoefficients<'g> {
        let kept = self.nonzero.iter().copied().filter(|&(_, s, m, _)| s.max(m) <= operators);
        StructureCoefficients::from_nonzero(operators.min(self.operators), kept)
    }

    /// The coefficients with `f` applied to each of them; `f` must map 0 to 0.
    #[must_use]
    pub fn map<'n>(&self, mut f: impl FnMut(Expr<'g>) -> Expr<'n>) -> StructureCoefficients<'n> {
        let mapped = self.nonzero.iter().map(|&(r, s, m, c)| (r, s, m, f(c)));
        StructureCoefficients::from_nonzero(self.operators, mapped)
    }

    /// Number k of operators, not counting time.
    pub fn operators(&self) -> usize {
        self.operators
    }

    /// The coefficient c_rs^m with r, s in 0..=k and m in 1..=k.
    ///
    /// The coefficient is the Boltzmann–Hamel symbol γ_rs^m = (∂a_mi/∂x_j − ∂a_mj/∂x_i) b_ir b_js. Authors
    /// differ in its sign and in the order of its indices: the convention here is that of the equation d/dt
    /// ∂L/∂η_s + γ_sr^m η_r ∂L/∂η_m − ∂L/∂π_s = Q_s.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn get(&self, r: usize, s: usize, m: usize) -> Expr<'g> {
        assert!(r.max(s) <= self.operators && (1..=self.operators).contains(&m), "an index is out of range");
        let at = |r: usize, s: usize| {
            let place = self.nonzero.binary_search_by_key(&(r, s, m), |&(r, s, m, _)| (r, s, m));
            place.map_or(Expr::ZERO, |place| self.nonzero[place].3)
        };
        match r.cmp(&s) {
            std::cmp::Ordering::Less => at(r, s),
            std::cmp::Ordering::Equal => Expr::ZERO,
            std::cmp::Ordering::Greater => -at(s, r),
        }
    }

    /// The coefficients that are not 0, as (r, s, m, c_rs^m) with r < s.
    pub fn nonzero(&self) -> impl Iterator<Item = (usize, usize, usize, Expr<'g>)> + '_ {
        self.nonzero.iter().copied()
    }

    /// (c_rs^1, …, c_rs^k)
    pub(crate) fn of_pair(&self, r: usize, s: usize) -> Vec<Expr<'g>> {
        let mut c = vec![Expr::ZERO; self.operators];
        let first = self.nonzero.partition_point(|&(p, q, ..)| (p, q) < (r, s));
        let listed = self.nonzero[first..].iter().take_while(|&&(p, q, ..)| (p, q) == (r, s));
        listed.for_each(|&(.., m, value)| c[m - 1] = value);
        c
    }

    /// The c_rs^m that are not 0, in order, each listed both as (r, s, m) and as (s, r, m).
    pub(crate) fn both_ways(&self) -> Vec<(usize, usize, usize, Expr<'g>)> {
        let mut all: Vec<_> =
            self.nonzero.iter().flat_map(|&(r, s, m, c)| [(r, s, m, c), (s, r, m, -c)]).collect();
        all.sort_unstable_by_key(|&(r, s, m, _)| (r, s, m));
        all
    }

    /// Whether all coefficients are constants: then the X_s form a Lie algebra.
    pub fn are_constant(&self) -> bool {
        self.nonzero.iter().all(|(.., c)| c.constant().is_some())
    }

    /// The algebra of X_1..X_k, if its coefficients are constant.
    pub fn lie_algebra(&self) -> Option<LieAlgebra> {
        let constants = self.nonzero.iter().map(|&(r, s, m, c)| Some((r, s, m, c.constant()?)));
        let constants: Vec<_> = constants.collect::<Option<_>>()?;
        let stationary = constants.into_iter().filter(|&(r, ..)| r > 0);
        Some(LieAlgebra::from_upper(self.operators, stationary.map(|(r, s, m, c)| (r - 1, s - 1, m - 1, c))))
    }

    /// The terms v_s = (c_rs^m η_r + c_0s^m) p_m, s = 1..k, that brackets contribute to the equations (9).
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
        self.and_drift(&[])
    }

    /// The structure coefficients with these c_rs^m and `drift(s, m)` = c_0s^m, with indices counted from 0.
    ///
    /// # Errors
    /// [`AlgebraError::Jacobi`], with index 0 for time, if \[X_0, ·\] is not a derivation of the algebra:
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
        let drift = self.drift(&drift);
        let stationary = self.nonzero().map(|(r, s, m, c)| (r + 1, s + 1, m + 1, c));
        let opposite = drift.iter().map(|&(s, m, c)| (s, 0, m, -c));
        let all: Vec<_> =
            drift.iter().map(|&(s, m, c)| (0, s, m, c)).chain(opposite).chain(stationary).collect();
        check_jacobi(self.dim(), &all)?;
        Ok(self.and_drift(&drift))
    }

    /// The c_0s^m that are not 0, with s and m counted from 1.
    fn drift(&self, drift: impl Fn(usize, usize) -> Number) -> Vec<(usize, usize, Number)> {
        let k = self.dim();
        let all = (0..k).flat_map(|s| (0..k).map(move |m| (s, m)));
        all.map(|(s, m)| (s + 1, m + 1, drift(s, m))).filter(|(.., c)| !c.is_zero()).collect()
    }

    fn and_drift<'g>(&self, drift: &[(usize, usize, Number)]) -> StructureCoefficients<'g> {
        let stationary = self.nonzero().filter(|(r, s, ..)| r < s);
        let stationary = stationary.map(|(r, s, m, c)| (r + 1, s + 1, m + 1, c.into()));
        let drift = drift.iter().map(|&(s, m, c)| (0, s, m, c.into()));
        StructureCoefficients::from_nonzero(self.dim(), drift.chain(stationary))
    }
}

/// The pairs r < s of 0..=k.
pub(crate) fn pairs(k: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..=k).flat_map(move |r| (r + 1..=k).map(move |s| (r, s)))
}
