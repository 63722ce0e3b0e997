//! The field of displacements to which an integral linear in the momenta belongs (Noether).

use pc_algebra::affine;
use pc_mech::{Canonical, Expr};

/// A field X = a_s X_s, a_s functions of (t, x), with whose momentum a_s y_s the motion keeps a_s y_s + f(t, x).
///
/// It is a symmetry of L up to the rate of f. Where it [commutes](NoetherField::commutes) with all operators it is cyclic in
/// Chetaev's sense: (9) of the frame with X among its operators has d/dt (a_s y_s) = X L + a_s Q_s. A coordinate that is cyclic
/// in Lagrange's sense is X = ∂/∂x; the rotations in space of a body described in its own axes are others.
#[derive(Clone, Debug)]
pub struct NoetherField<'g> {
    /// a_1..a_k
    pub coefficients: Vec<Expr<'g>>,
    /// f, zero unless L changes along X by a rate.
    pub gauge: Expr<'g>,
    /// Whether [X_r, X] = (X_r a_m + a_s c_rs^m) X_m is seen to vanish for r = 0..k.
    pub commutes: bool,
}

impl<'g> NoetherField<'g> {
    /// That of an integral of (t, x, η), if it is linear in the momenta and the equations are
    /// [closed](Canonical::is_closed).
    ///
    /// ```
    /// use pc_analysis::NoetherField;
    /// use pc_mech::{Graph, System};
    ///
    /// // The area of a central motion belongs to the rotation x ∂/∂y − y ∂/∂x.
    /// let graph = Graph::new();
    /// let plane = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| v[0].square() + v[1].square() - x[0].square() - x[1].square())
    ///     .build()?;
    /// let [x, y, vx, vy] = graph.symbols(["x", "y", "x'", "y'"]);
    /// let field = NoetherField::of(&plane.canonical()?, 2.0 * (x * vy - y * vx)).unwrap();
    /// assert_eq!(field.coefficients, [-y, x]);
    /// assert!(!field.commutes); // with ∂/∂x
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn of(canonical: &Canonical<'g>, integral: Expr<'g>) -> Option<NoetherField<'g>> {
        let (system, graph) = (canonical.system(), canonical.system().graph());
        if !canonical.is_closed() {
            return None;
        }
        let (coefficients, gauge) = affine(graph, canonical.in_momenta(integral), canonical.momenta())?;
        if coefficients.iter().all(|a| a.is_zero()) {
            return None;
        }
        let (frame, structure, k) = (system.frame(), system.structure(), coefficients.len());
        let commutes = structure.operators() == k
            && (0..=k).all(|r| {
                let slopes = frame.apply(r, &coefficients);
                let brackets = |m: usize| (1..=k).map(move |s| structure.get(r, s, m));
                (1..=k)
                    .all(|m| (slopes[m - 1] + graph.dot(coefficients.iter().copied(), brackets(m))).is_zero())
            });
        Some(NoetherField { coefficients, gauge, commutes })
    }
}
