//! The field of displacements to which an integral linear in the momenta belongs (Noether).

use std::collections::BTreeMap;

use pc_algebra::affine;
use pc_mech::{Canonical, Expr, System};

/// A field X = a_s X_s, in which the a_s are functions of (t, x), such that the motion conserves a_s y_s +
/// f(t, x), where a_s y_s is the momentum of X.
///
/// X is a symmetry of L up to the rate of f. Where X [commutes](NoetherField::commutes) with all operators,
/// it is cyclic in Chetaev's sense: equations (9) in a frame with X among its operators contain d/dt (a_s
/// y_s) = X L + a_s Q_s. A coordinate that is cyclic in Lagrange's sense corresponds to X = ∂/∂x; other
/// examples are the rotations in space of a body described in its own axes.
#[derive(Clone, Debug)]
pub struct NoetherField<'g> {
    /// a_1..a_k
    pub coefficients: Vec<Expr<'g>>,
    /// f, zero unless L changes along X by the rate of a function.
    pub gauge: Expr<'g>,
    /// Whether [X_r, X] = (X_r a_m + a_s c_rs^m) X_m is found to vanish for r = 0..k.
    pub commutes: bool,
}

impl<'g> NoetherField<'g> {
    /// The field that belongs to an integral, a function of (t, x, η), if it is linear in the momenta and the
    /// equations are [closed](Canonical::is_closed).
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
        let commutes = commutes(system, &coefficients);
        Some(NoetherField { coefficients, gauge, commutes })
    }
}

/// Whether X_r a_m + a_s c_rs^m = 0 for r = 0..k, m = 1..k, as far as the graph can decide.
fn commutes<'g>(system: &System<'g>, a: &[Expr<'g>]) -> bool {
    let (frame, structure, k) = (system.frame(), system.structure(), a.len());
    if structure.operators() != k {
        return false;
    }
    let mut along: BTreeMap<(usize, usize), Vec<Expr<'g>>> = BTreeMap::new();
    for r in 0..=k {
        let slopes = (1..).zip(frame.apply(r, a)).filter(|(_, slope)| !slope.is_zero());
        slopes.for_each(|(m, slope)| along.entry((r, m)).or_default().push(slope));
    }
    for (r, s, m, c) in structure.nonzero() {
        along.entry((r, m)).or_default().push(a[s - 1] * c);
        if r > 0 {
            along.entry((s, m)).or_default().push(-(a[r - 1] * c));
        }
    }
    along.into_values().all(|terms| system.graph().sum(terms).is_zero())
}
