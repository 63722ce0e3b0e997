//! Nonholonomic constraints as quasi-velocities that vanish: equations (27)–(33), of a particle with ż = y ẋ.

use pc_algebra::Integrability;
use pc_mech::{Constraint, Expr, Graph, Neighbourhood, System};
use pc_nonholo::{Adapted, Constrained};

use crate::{assert_all_equal, assert_identities};

/// The particle in the quasi-velocities x', y' and slip = ż − y ẋ, with the force function U.
fn particle<'g>(graph: &'g Graph, force_function: Expr<'g>) -> Adapted<'g> {
    let system = System::builder(graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0 + force_function)
        .build()
        .unwrap();
    let [x, y, z, vx, vy, vz] = graph.symbols(["x", "y", "z", "x'", "y'", "z'"]);
    let slip = Constraint::new("slip", vz - y * vx);
    let at = [(x, 0.1), (y, 0.3), (z, 0.2), (vx, 0.0), (vy, 0.0), (vz, 0.0)];
    Adapted::new(&system.with_multipliers(&[slip]).unwrap(), &at).unwrap()
}

fn constrained<'g>(graph: &'g Graph, force_function: Expr<'g>) -> Constrained<'g> {
    particle(graph, force_function).constrained().unwrap()
}

/// a_αi ẋ_i + a_α0 = 0 that is no derivative: the commutator of the velocities it allows leaves their span.
#[test]
fn equation_27_the_constraint_is_not_integrable() {
    let graph = Graph::new();
    let adapted = particle(&graph, Expr::ZERO);
    let allowed = adapted.system().frame().restricted(adapted.free());
    let verdict = allowed.integrability(&Neighbourhood::default());
    assert!(matches!(verdict, Integrability::NotIntegrable { pair: (1, 2), .. }), "{verdict:?}");
}

/// η_s = a_si ẋ_i, the last one the left-hand side of the constraint.
#[test]
fn equation_28_the_constraint_is_a_quasi_velocity() {
    let graph = Graph::new();
    let adapted = particle(&graph, Expr::ZERO);
    assert_eq!(adapted.free(), 2);
    let names: Vec<_> = adapted.system().quasi_velocities().iter().map(Expr::to_string).collect();
    assert_eq!(names, ["x'", "y'", "slip"]);
    let (a, a0) = adapted.system().frame().definitions().unwrap();
    let (zero, one, y) = (Expr::ZERO, Expr::ONE, graph.symbol("y"));
    let expected = [one, zero, zero, zero, one, zero, -y, zero, one];
    assert_all_equal("a", a.entries().iter().copied(), expected);
    assert_identities("a_0", a0.into_iter().map(|a| (a, zero)));
}

/// ẋ_i = b_is η_s + b_i0, s = 1..l: velocities that satisfy the constraint.
#[test]
fn equation_29_velocities_satisfy_the_constraint() {
    let graph = Graph::new();
    let constrained = constrained(&graph, Expr::ZERO);
    let [y, vx, vy] = graph.symbols(["y", "x'", "y'"]);
    let found = constrained.equations().velocities().iter().copied();
    assert_all_equal("ẋ", found, [vx, vy, y * vx]);
}

/// θ = T for η_α = 0, the kinetic energy in (32).
#[test]
fn equation_32_contains_the_kinetic_energy_on_the_constraint() {
    let graph = Graph::new();
    let free = constrained(&graph, Expr::ZERO).free_system().unwrap();
    let [y, vx, vy] = graph.symbols(["y", "x'", "y'"]);
    let theta = ((1.0 + y.square()) * vx.square() + vy.square()) / 2.0;
    assert_identities("θ", [(free.lagrangian(), theta)]);
}

/// With η_s = ẋ_s the c_rs^m, m ≤ l, vanish, and
///
///   d/dt ∂θ/∂ẋ_s = c_rs^α ẋ_r (∂T/∂η_α)_0 + X_s (θ + U):
///
/// (1 + y²) ẍ = −y ẋ ẏ + ∂U/∂x + y ∂U/∂z and ÿ = ∂U/∂y, as Newton's law with a reaction along (−y, 0, 1) says.
#[test]
fn equation_33_has_only_the_brackets_of_the_constraint() {
    let graph = Graph::new();
    let [x, y, z, vx, vy] = graph.symbols(["x", "y", "z", "x'", "y'"]);
    let force_function = x.square() * y - z * y.sin();
    let adapted = particle(&graph, force_function);
    let c = adapted.system().structure();
    let brackets: Vec<_> = c.nonzero().filter(|&(r, s, ..)| r < s && s <= 2).collect();
    assert_eq!(brackets, [(1, 2, 3, -Expr::ONE)]);
    let constrained = adapted.constrained().unwrap();
    let found = constrained.equations().accelerations();
    let [ux, uy, uz] = [x, y, z].map(|x| force_function.derivative(x));
    let along_x = (ux + y * uz - y * vx * vy) / (1.0 + y.square());
    assert_all_equal("ẍ", found, [along_x, uy]);
}
