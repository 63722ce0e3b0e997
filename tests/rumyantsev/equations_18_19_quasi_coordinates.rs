//! Quasi-coordinates, ∂/∂π_s for X_s: equations (18) of Boltzmann and Hamel and their canonical form (19).

use pc_mech::{Expr, Graph, System};

use crate::{assert_all_equal, assert_identities};

/// The spherical pendulum by its velocities along the meridian and the parallel, u = θ', v = sin θ ψ'; g = l = m = 1, θ from
/// below.
fn pendulum(graph: &Graph) -> System<'_> {
    let [theta, rate, turn] = graph.symbols(["θ", "θ'", "ψ'"]);
    System::builder(graph)
        .coordinates(["θ", "ψ"])
        .lagrangian(|_, x, v| (v[0].square() + (x[0].sin() * v[1]).square()) / 2.0 + x[0].cos())
        .build()
        .unwrap()
        .in_quasi_velocities(["u", "v"], &[rate, theta.sin() * turn])
        .unwrap()
}

/// The coefficients of Boltzmann and Hamel: c_12^2 = −c_21^2 = −cot θ alone, so that dπ_1 is a differential and dπ_2 is none.
#[test]
fn equation_18_has_the_coefficients_of_boltzmann_and_hamel() {
    let graph = Graph::new();
    let cot = graph.symbol("θ").cot();
    let system = pendulum(&graph);
    let found: Vec<_> = system.structure().nonzero().filter(|&(r, s, ..)| r < s).collect();
    assert_eq!(found.len(), 1);
    let (r, s, m, c) = found[0];
    assert_eq!((r, s, m), (1, 2, 2));
    assert_identities("c_12^2", [(c, -cot)]);
}

/// From Lagrange's θ'' = ψ'² sin θ cos θ − sin θ and (sin² θ ψ')' = 0.
#[test]
fn equation_18_is_the_motion_of_the_spherical_pendulum() {
    let graph = Graph::new();
    let [theta, u, v] = graph.symbols(["θ", "u", "v"]);
    let found = pendulum(&graph).poincare().unwrap().accelerations();
    assert_all_equal("η̇", found, [v.square() * theta.cot() - theta.sin(), -u * v * theta.cot()]);
}

/// ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − ∂H/∂π_s + Q_s with y = η, the mass matrix being the unit matrix.
#[test]
fn equation_19_is_the_canonical_form() {
    let graph = Graph::new();
    let canonical = pendulum(&graph).canonical().unwrap();
    let theta = graph.symbol("θ");
    let [p, q]: [Expr<'_>; 2] = canonical.momenta().try_into().unwrap();
    let energy = (p.square() + q.square()) / 2.0 - theta.cos();
    assert_identities("H", [(canonical.hamiltonian(), energy)]);
    let expected = [q.square() * theta.cot() - theta.sin(), -p * q * theta.cot()];
    assert_all_equal("ẏ", canonical.right_hand_side().iter().copied(), expected);
    let velocities = [p, q / theta.sin()];
    assert_all_equal("ẋ", canonical.velocities().iter().copied(), velocities);
}
