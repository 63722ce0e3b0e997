//! Nonholonomic constraints in canonical variables, equation (31).

use pc_algebra::{affine, inverse};
use pc_mech::{Expr, Matrix};
use pc_nonholo::Constrained;

use crate::error::AnalysisError;

/// The motion under nonholonomic constraints η_α = 0, α = l+1..k, with the Hamiltonian H of all k momenta (31):
///
///   ∂H/∂y_α = 0,   ẋ_i = b_is ∂H/∂y_s + b_i0,   s ≤ l.
///
/// The y_α do not vanish; the first equations determine them as functions of t, x and the independent momenta y_s.
///
/// ```
/// use pc_analysis::DependentMomenta;
/// use pc_mech::{Graph, System};
/// use pc_nonholo::Constrained;
///
/// // A sleigh with its mass centre in front of the blade: L = ½ (v² + (u + a ω)² + ω²), u = 0.
/// let graph = Graph::new();
/// let [a, u] = graph.symbols(["a", "u"]);
/// let sleigh = System::builder(&graph)
///     .parameter(a, 0.5)
///     .coordinates(["X", "Y", "φ"])
///     .quasi_velocities(["v", "ω", "u"])
///     .kinematics(|_, x, w| {
///         let (c, s) = (x[2].cos(), x[2].sin());
///         [w[0] * c - w[2] * s, w[0] * s + w[2] * c, w[1]]
///     })
///     .lagrangian(|_, _, w| (w[0].square() + (w[2] + a * w[1]).square() + w[1].square()) / 2.0)
///     .build()?;
/// let found = DependentMomenta::of(&Constrained::new(&sleigh, &[u])?)?.expect("H is quadratic in y_α");
/// let [(momentum, value)] = found.values[..] else { panic!("one constraint") };
/// assert_eq!(momentum.to_string(), "p_u");
/// assert_eq!(value, a * graph.symbol("p_ω") / (1.0 + a.square()));
/// assert!(found.are_proved);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct DependentMomenta<'g> {
    /// H(t, x, y) of all momenta.
    pub hamiltonian: Expr<'g>,
    /// ∂H/∂y_α, each with its y_α.
    pub conditions: Vec<(Expr<'g>, Expr<'g>)>,
    /// Each y_α as a function of (t, x, y_s), s ≤ l.
    pub values: Vec<(Expr<'g>, Expr<'g>)>,
    /// Whether it is proved that the values are (∂L/∂η_α)_0 at y_s = (∂L/∂η_s)_0, and b_is ∂H/∂y_s + b_i0 the velocities (29).
    pub are_proved: bool,
}

impl<'g> DependentMomenta<'g> {
    /// The dependent momenta of a system in the frame of its constraints; `None` where H is not in closed form, or the
    /// conditions are not linear in the y_α.
    ///
    /// # Errors
    /// [`AnalysisError::Mech`] if y = ∂L/∂η does not determine all η.
    pub fn of(constrained: &Constrained<'g>) -> Result<Option<DependentMomenta<'g>>, AnalysisError> {
        let system = constrained.system();
        let (graph, canonical) = (system.graph(), system.canonical()?);
        if !canonical.is_closed() {
            return Ok(None);
        }
        let (hamiltonian, y) = (canonical.hamiltonian(), canonical.momenta());
        let l = y.len() - constrained.vanishing().len();
        let slopes = graph.gradient(hamiltonian, y);
        let Some(solution) = solved(&slopes[l..], &y[l..], constrained) else { return Ok(None) };
        let values: Vec<(Expr<'g>, Expr<'g>)> = y[l..].iter().copied().zip(solution).collect();
        // (∂L/∂η_m)_0, m = 1..k
        let zeros: Vec<_> = constrained.vanishing().iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let momenta = graph.substitute(&system.momenta(), &zeros);
        let free: Vec<_> = y[..l].iter().copied().zip(momenta[..l].iter().copied()).collect();
        let there = |functions: &[Expr<'g>]| graph.substitute(&graph.substitute(functions, &values), &free);
        let found = there(&values.iter().map(|&(_, value)| value).collect::<Vec<_>>());
        let frame = system.frame();
        let velocity = |i: usize| {
            graph.sum([graph.dot((0..l).map(|s| frame.b()[(i, s)]), slopes.iter().copied()), frame.b0()[i]])
        };
        let velocities = there(&(0..frame.coordinates().len()).map(velocity).collect::<Vec<_>>());
        let are_equal = |a: &[Expr<'g>], b: &[Expr<'g>]| a.iter().zip(b).all(|(&a, &b)| (a - b).is_zero());
        let are_proved =
            are_equal(&found, &momenta[l..]) && are_equal(&velocities, constrained.equations().velocities());
        let conditions = y[l..].iter().copied().zip(slopes[l..].iter().copied()).collect();
        Ok(Some(DependentMomenta { hamiltonian, conditions, values, are_proved }))
    }
}

/// The y_α for which the slopes ∂H/∂y_α vanish.
fn solved<'g>(slopes: &[Expr<'g>], y: &[Expr<'g>], constrained: &Constrained<'g>) -> Option<Vec<Expr<'g>>> {
    let (graph, size) = (constrained.system().graph(), y.len());
    let equations: Option<Vec<_>> = slopes.iter().map(|&slope| affine(graph, slope, y)).collect();
    let (rows, rest): (Vec<_>, Vec<_>) = equations?.into_iter().unzip();
    let inverse = inverse(graph, &Matrix::from_fn(size, size, |a, b| rows[a][b]))?;
    Some((0..size).map(|a| -graph.dot(inverse.row(a).iter().copied(), rest.iter().copied())).collect())
}
