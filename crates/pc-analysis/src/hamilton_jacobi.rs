//! Hamilton–Jacobi's equation in quasi-velocities, and Jacobi's theorem.
//!
//! The equation is below; `roots` decides identities between square roots. A frame whose operators reach only part of the
//! coordinates moves on an `orbit`. `proposed_action` gives a verdict on a function S, `complete_integral` turns a solution with
//! enough constants into motions, `explicit` in closed form, `jacobi_motion` follows one of them, and `series` is the motion by power series with which it is
//! compared. `separated` finds actions where all coordinates but one are cyclic, with integrals by `quadrature`.

pub(crate) mod complete_integral;
mod explicit;
pub(crate) mod jacobi_motion;
pub(crate) mod orbit;
pub(crate) mod proposed_action;
mod quadrature;
mod roots;
pub(crate) mod separated;
mod series;

use pc_mech::{Canonical, Expr};

use crate::error::AnalysisError;
use orbit::Orbit;
use roots::vanishes;

/// The left-hand side of Hamilton–Jacobi's equation
///
///   X_0 S + H(t, x, X_s S) = 0
///
/// for S = `action`, a function of t, x and any constants. S is a solution if this [is zero](Expr::is_zero);
/// in that case y_s = X_s S satisfies (10) along the motion (11). The constant zero is a proof, since a
/// difference of expressions of equal value is folded to zero. Square roots are resolved if the radicand is
/// linear in some symbol, for example the energy.
///
/// # Errors
/// [`AnalysisError::Forced`] if a generalised force is not zero;
/// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic) if H is not
/// [closed](Canonical::is_closed).
///
/// ```
/// # use pc_analysis::hamilton_jacobi;
/// # use pc_mech::{Graph, System};
/// let graph = Graph::new();
/// let particle =
///     System::builder(&graph).coordinates(["x"]).lagrangian(|_, _, v| v[0].square() / 2.0).build()?;
/// let [t, x, a] = graph.symbols(["t", "x", "a"]);
/// let canonical = particle.canonical()?;
/// assert!(hamilton_jacobi(&canonical, (x - a).square() / (2.0 * t))?.is_zero());
/// assert!(!hamilton_jacobi(&canonical, x * x - t)?.is_zero());
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
pub fn hamilton_jacobi<'g>(canonical: &Canonical<'g>, action: Expr<'g>) -> Result<Expr<'g>, AnalysisError> {
    canonical.closed_quasi_velocities()?;
    let system = canonical.system();
    if let Some(s) = system.forces().iter().position(|force| !force.is_zero()) {
        return Err(AnalysisError::Forced { quasi_velocity: system.quasi_velocities()[s].to_string() });
    }
    let momenta: Vec<_> = canonical.momenta().iter().copied().zip(slopes(canonical, action)).collect();
    let hamiltonian = system.graph().substitute(&[canonical.hamiltonian()], &momenta)[0];
    let left = system.frame().apply(0, &[action])[0] + hamiltonian;
    system.graph().check(&[left])?;
    Ok(if vanishes(system.graph(), left) { Expr::ZERO } else { left })
}

/// [`hamilton_jacobi`] where the positions are on an orbit.
fn remainder_on<'g>(
    canonical: &Canonical<'g>,
    action: Expr<'g>,
    orbit: &Orbit<'g>,
) -> Result<Expr<'g>, AnalysisError> {
    let left = hamilton_jacobi(canonical, action)?;
    let graph = canonical.system().graph();
    let there = orbit.restricted(graph, &[left])[0];
    Ok(if vanishes(graph, there) { Expr::ZERO } else { left })
}

/// X_s S, length k.
fn slopes<'g>(canonical: &Canonical<'g>, action: Expr<'g>) -> Vec<Expr<'g>> {
    let frame = canonical.system().frame();
    frame.contract(&canonical.system().graph().gradient(action, frame.coordinates()))
}
