//! Names of operators and the two sides of equations, whatever they are printed as.

use pc_mech::{Canonical, Expr, Style, System};

/// Names of X_0..X_k: that of time, then of the quasi-velocities.
pub(crate) fn operator_names(quasi_velocities: &[Expr<'_>], time: &str) -> Vec<String> {
    std::iter::once(time.to_owned()).chain(quasi_velocities.iter().map(Expr::to_string)).collect()
}

/// y_s = ∂L/∂η_s, the two sides of each.
pub(crate) fn momenta(equations: &Canonical<'_>, style: Style) -> Vec<(String, String)> {
    let pairs = equations.momenta().iter().zip(equations.momenta_of_velocities());
    pairs.map(|(y, value)| (y.display(style), value.display(style))).collect()
}

/// ż of the first-order states.
pub(crate) fn rates_of_states<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
    system.states().iter().map(|&(_, rate)| rate).collect()
}

/// The two sides of ż = `rates`.
pub(crate) fn state_rates(system: &System<'_>, rates: &[Expr<'_>], style: Style) -> Vec<(String, String)> {
    let left = |z: &Expr<'_>| system.graph().symbol(&format!("{z}'")).display(style);
    system.states().iter().zip(rates).map(|((z, _), rate)| (left(z), rate.display(style))).collect()
}
