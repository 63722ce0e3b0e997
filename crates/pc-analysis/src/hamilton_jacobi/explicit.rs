//! Motions in closed form, where Jacobi's equations are linear in the coordinates.

use pc_algebra::{affine, inverse};
use pc_mech::{Canonical, Expr, Matrix};

use crate::hamilton_jacobi::complete_integral::CompleteIntegral;

impl<'g> CompleteIntegral<'g> {
    /// x as a function of t, α and the symbols β, each in the order of its components, where the equations ∂S/∂α_s = β_s are
    /// linear in x; `None` elsewhere. It is proved by substitution.
    ///
    /// ```
    /// use pc_analysis::CompleteIntegral;
    /// use pc_mech::{Graph, System};
    ///
    /// // Free fall, g = 1, with the momentum α at t = 0.
    /// let graph = Graph::new();
    /// let [t, x, a, b] = graph.symbols(["t", "x", "α", "β"]);
    /// let body =
    ///     System::builder(&graph).coordinates(["x"]).lagrangian(|_, x, v| v[0].square() / 2.0 - x[0]).build()?;
    /// let canonical = body.canonical()?;
    /// let integral = CompleteIntegral::new(&canonical, (a - t) * x + (a - t).powi(3) / 6.0, &["α"])?;
    /// let motion = integral.positions(&canonical, &[b]).expect("linear in x");
    /// assert_eq!(motion, [b - (a - t).square() / 2.0]);
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn positions(&self, canonical: &Canonical<'g>, betas: &[Expr<'g>]) -> Option<Vec<Expr<'g>>> {
        let (graph, x) = (canonical.system().graph(), canonical.system().frame().coordinates());
        let n = x.len();
        if betas.len() != n || self.conjugates().len() != n {
            return None;
        }
        let equations: Option<Vec<_>> = self.conjugates().iter().map(|&f| affine(graph, f, x)).collect();
        let (rows, rest): (Vec<_>, Vec<_>) = equations?.into_iter().unzip();
        let inverse = inverse(graph, &Matrix::from_fn(n, n, |s, i| rows[s][i]))?;
        let right: Vec<Expr<'g>> = betas.iter().zip(&rest).map(|(&beta, &rest)| beta - rest).collect();
        let positions: Vec<Expr<'g>> =
            (0..n).map(|i| graph.dot(inverse.row(i).iter().copied(), right.iter().copied())).collect();
        let known: Vec<_> = x.iter().copied().zip(positions.iter().copied()).collect();
        let there = graph.substitute(self.conjugates(), &known);
        there.iter().zip(betas).all(|(&f, &beta)| (f - beta).is_zero()).then_some(positions)
    }
}
