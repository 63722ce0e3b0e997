//! The bracket under nonholonomic constraints.

use pc_mech::{Expr, Matrix};
use pc_nonholo::Constrained;

use crate::brackets::poisson_bracket::PoissonBracket;
use crate::error::AnalysisError;

impl<'g> PoissonBracket<'g> {
    /// The almost-Poisson bracket of coordinates and momenta y_s = ∂θ/∂η_s of the free quasi-velocities,
    ///
    ///   (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + (c_rs^m y_m + c_rs^α (∂L/∂η_α)_0) ∂f/∂y_s ∂g/∂y_r,   r, s, m ≤ l,
    ///
    /// the (∂L/∂η_α)_0 as functions of (x, y). This bracket is skew and generates the motion (34) of a stationary
    /// system without forces, ẋ_i = (x_i, H), ẏ_s = (y_s, H); Jacobi's identity holds if and only if the constraints
    /// are integrable [van der Schaft, Maschke, Rep. Math. Phys. 34 (1994) 225], which
    /// [`jacobi_violation`](PoissonBracket::jacobi_violation) decides.
    ///
    /// # Errors
    /// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic) if H has no closed form.
    ///
    /// ```
    /// use pc_analysis::PoissonBracket;
    /// use pc_mech::{Constraint, Graph, System};
    /// use pc_nonholo::Adapted;
    ///
    /// // The particle with ż = y ẋ.
    /// let graph = Graph::new();
    /// let [y, vx, vz] = graph.symbols(["y", "x'", "z'"]);
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x", "y", "z"])
    ///     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
    ///     .build()?;
    /// let held = particle.with_multipliers(&[Constraint::new("knife", vz - y * vx)])?;
    /// let at: Vec<_> = ["x", "y", "z", "x'", "y'", "z'", "t"].map(|name| (graph.symbol(name), 0.5)).into();
    /// let constrained = Adapted::new(&held, &at)?.constrained()?;
    /// let bracket = PoissonBracket::almost_poisson(&constrained)?;
    /// assert!(bracket.jacobi_violation().is_some());
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn almost_poisson(constrained: &Constrained<'g>) -> Result<PoissonBracket<'g>, AnalysisError> {
        let (system, graph) = (constrained.free_system()?, constrained.system().graph());
        let canonical = system.canonical()?;
        let dropped = dropped_momenta(constrained, canonical.closed_quasi_velocities()?);
        let (n, l) = (system.frame().coordinates().len(), dropped.1);
        let structure = constrained.system().structure();
        let plain = PoissonBracket::new(&system);
        let more = |s: usize, r: usize| {
            graph.dot(
                (0..dropped.0.len()).map(|a| structure.get(r + 1, s + 1, l + a + 1)),
                dropped.0.iter().copied(),
            )
        };
        let tensor = Matrix::from_fn(n + l, n + l, |i, j| {
            let known = plain.tensor()[(i, j)];
            if i < n || j < n { known } else { known + more(i - n, j - n) }
        });
        let bracket = PoissonBracket::of_tensor(graph, plain.variables().to_vec(), tensor)?;
        Ok(bracket.with_constants(plain.constants().iter().copied()))
    }
}

/// (∂L/∂η_α)_0 in terms of the symbols `free` of the free quasi-velocities, and the number of free
/// quasi-velocities.
fn dropped_momenta<'g>(constrained: &Constrained<'g>, free: &[Expr<'g>]) -> (Vec<Expr<'g>>, usize) {
    let (system, l) = (constrained.system(), free.len());
    let eta = system.quasi_velocities();
    let known: Vec<_> = eta[..l].iter().copied().zip(free.iter().copied()).collect();
    let zeros = eta[l..].iter().map(|&eta| (eta, Expr::ZERO));
    let values: Vec<_> = known.into_iter().chain(zeros).collect();
    (system.graph().substitute(&system.momenta()[l..], &values), l)
}
