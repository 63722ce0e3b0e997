//! The Coriolis matrix of the equations.

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::equations::poincare::Equations;
use crate::error::{LagrangianError, MechError};

impl<'g> Equations<'g> {
    /// The k × k Coriolis matrix C(t, x, η), linear in η: C η consists of the terms of M η̇ + h = Q that are quadratic in η,
    ///
    ///   C_sm = Γ_{s,rm} η_r,
    ///   Γ_{s,rm} = ½ (X_r M_sm + X_m M_sr − X_s M_rm + c_rm^l M_ls − c_rs^l M_lm − c_ms^l M_lr).
    ///
    /// Γ are the coefficients of the Levi-Civita connection of the metric M in the frame (Koszul's formula; [Bullo & Lewis
    /// 2005]): Christoffel's symbols of the first kind where the operators commute. Of the many matrices with the same C η,
    ///
    ///   C = ½ ∂h/∂η + ½ M c(η),   c(η)_lm = c_rm^l η_r,
    ///
    /// with the quadratic part of h, is the one for which
    ///
    ///   C + Cᵀ = η_r X_r M.
    ///
    /// Where neither the frame nor M depends on t or on first-order states, this is Ṁ, and Ṁ − 2C is skew-symmetric [Murray,
    /// Li & Sastry 1994]. Where they do, Ṁ has further terms, and h has further terms that are linear in η; these are no part
    /// of C η, nor are those of terms of L that are linear in η.
    ///
    /// Under the constraints η_α = 0 of the equations (30), with r, s, m = 1..l and sums over all k in c_rm^l M_ls, C is that of
    /// the projected connection, which has the same property.
    ///
    /// ```
    /// use pc_mech::{Graph, System};
    ///
    /// // A particle in polar coordinates.
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["r", "φ"])
    ///     .kinetic(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0)
    ///     .build()?;
    /// let c = particle.poincare()?.coriolis_matrix()?;
    /// let [r, dr, turn] = graph.symbols(["r", "r'", "φ'"]);
    /// assert_eq!((c[(0, 0)], c[(0, 1)]), (0.into(), -r * turn));
    /// assert_eq!((c[(1, 0)], c[(1, 1)]), (r * turn, r * dr));
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    ///
    /// # Errors
    /// [`LagrangianError::NoCoriolisMatrix`] where M depends on η; [`MechError::Expr`] if the limits of the graph are reached.
    pub fn coriolis_matrix(&self) -> Result<Matrix<Expr<'g>>, MechError> {
        let (system, graph) = (&self.system, self.system.graph());
        let (frame, eta) = (&system.frame, &system.quasi_velocities);
        let (k, x) = (eta.len(), frame.coordinates());
        let mass = self.mass_matrix();
        let entries = mass.nonzero_entries();
        let written = graph.symbols_of(&entries);
        if let Some(eta) = eta.iter().find(|eta| written.contains(eta)) {
            return Err(LagrangianError::NoCoriolisMatrix { quasi_velocity: eta.to_string() }.into());
        }
        // M_ls and p_l = M_ls η_s, with s = 1..k and l = 1..k and beyond.
        let mut rows = mass.nonzero_rows();
        rows.extend(graph.jacobian(self.vanished_momenta(), eta));
        let momentum = |row: &Vec<(usize, Expr<'g>)>| graph.sum(row.iter().map(|&(s, m)| m * eta[s]));
        let momenta: Vec<Expr<'g>> = rows.iter().map(momentum).collect();
        // η_r X_r M
        let drift = |i: usize| graph.sum(frame.b().nonzero(i).map(|(s, b)| b * eta[s]));
        let along: Vec<_> = x.iter().copied().zip((0..x.len()).map(drift)).collect();
        let rate = mass.with_nonzero_entries(&graph.directional(&entries, &along));
        // X_m p_s
        let slopes: Vec<Vec<Expr<'g>>> =
            momenta[..k].iter().map(|&p| frame.contract(&graph.gradient(p, x))).collect();
        let mut terms: Vec<Vec<Vec<Expr<'g>>>> = vec![vec![Vec::new(); k]; k];
        for s in 0..k {
            for (m, entry) in rate.nonzero(s) {
                terms[s][m].push(entry);
            }
            for m in 0..k {
                terms[s][m].extend([slopes[s][m], -slopes[m][s]]);
            }
        }
        for (r, m, l, c) in system.structure.nonzero().filter(|&(r, m, ..)| r > 0 && m <= k) {
            let (r, m, l) = (r - 1, m - 1, l - 1);
            // c_rm^l η_r M_ls, and the same with r and m exchanged, in C_s. and, with the other sign, in C_.s
            for &(s, entry) in &rows[l] {
                for (column, carried) in [(m, c * eta[r] * entry), (r, -(c * eta[m] * entry))] {
                    terms[s][column].push(carried);
                    terms[column][s].push(-carried);
                }
            }
            // −c_ms^l p_l
            terms[m][r].push(-(c * momenta[l]));
            terms[r][m].push(c * momenta[l]);
        }
        let values: Vec<Expr<'g>> = terms.into_iter().flatten().map(|terms| graph.sum(terms) / 2.0).collect();
        graph.check(&values)?;
        let values = graph.shorten(&values, &system.collecting_order());
        Ok(Matrix::from_fn(k, k, |s, m| values[s * k + m]))
    }
}
