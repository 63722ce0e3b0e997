//! Redundant coordinates: equations (14)–(17), of a particle in a moving bowl z = (x² + y²)/2 + t x.

use pc_mech::{Constraint, Expr, Graph, System};

use crate::{along, assert_all_equal, assert_identities};

/// L of three velocities; x z makes it depend on the redundant coordinate.
fn lagrangian<'g>(x: &[Expr<'g>], v: &[Expr<'g>]) -> Expr<'g> {
    (v[0].square() + v[1].square() + v[2].square()) / 2.0 - x[2] + x[0] * x[2]
}

/// The bowl's z, and its rate.
fn height<'g>(t: Expr<'g>, x: &[Expr<'g>], v: &[Expr<'g>]) -> [Expr<'g>; 2] {
    [(x[0].square() + x[1].square()) / 2.0 + t * x[0], (x[0] + t) * v[0] + x[1] * v[1] + x[0]]
}

/// The particle in coordinates x, y, z with velocities ẋ, ẏ, under a force −ẏ along y.
fn bowl(graph: &Graph) -> System<'_> {
    let particle = System::builder(graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| lagrangian(x, v))
        .force_on_coordinates(|_, _, v| [Expr::ZERO, -v[1], Expr::ZERO])
        .build()
        .unwrap();
    let [t, x, y, z, vx, vy, vz] = graph.symbols(["t", "x", "y", "z", "x'", "y'", "z'"]);
    let wall = Constraint::new("wall", z - height(t, &[x, y], &[vx, vy])[0]);
    let at = [(t, 0.2), (x, 0.1), (y, -0.3), (z, 0.07), (vx, 0.0), (vy, 0.0), (vz, 0.1)];
    particle.with_multipliers(&[wall]).unwrap().in_independent_velocities(&at).unwrap()
}

/// X_s f = ∂f/∂x_s + b_zs ∂f/∂z, with b_zs written out.
fn operators<'g>(graph: &'g Graph, f: Expr<'g>) -> [Expr<'g>; 2] {
    let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
    [f.derivative(x) + (x + t) * f.derivative(z), f.derivative(y) + y * f.derivative(z)]
}

/// ẋ_j = b_js ẋ_s + b_j0.
#[test]
fn equation_14_gives_the_dependent_velocity() {
    let graph = Graph::new();
    let system = bowl(&graph);
    let [t, x, y, vx, vy] = graph.symbols(["t", "x", "y", "x'", "y'"]);
    assert_eq!(system.quasi_velocities(), [vx, vy]);
    let expected = [vx, vy, height(t, &[x, y], &[vx, vy])[1]];
    assert_all_equal("ẋ", system.frame().velocities(&[vx, vy]), expected);
}

/// X_s = ∂/∂x_s + b_js ∂/∂x_j, and X_0: they commute.
#[test]
fn equation_15_operators_commute() {
    let graph = Graph::new();
    let system = bowl(&graph);
    let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
    let f = x * z.square() + (y * t).sin();
    let expected = operators(&graph, f);
    assert_identities("X_s f", (1..=2).map(|s| (system.frame().apply(s, &[f])[0], expected[s - 1])));
    assert_eq!(system.structure().nonzero().count(), 0);
}

/// d/dt ∂L/∂ẋ_s − ∂L/∂x_s − b_js ∂L/∂x_j = Q_s.
#[test]
fn equation_16_holds_along_the_motion() {
    let graph = Graph::new();
    let system = bowl(&graph);
    let rates = graph.directional(&system.momenta(), &along(&system.poincare().unwrap()));
    let slopes = operators(&graph, system.lagrangian());
    let forces = [Expr::ZERO, -graph.symbol("y'")];
    assert_identities("(16)", (0..2).map(|s| (rates[s] - slopes[s], forces[s])));
}

/// On the bowl they are Lagrange's equations in x and y, from which z was eliminated before.
#[test]
fn equation_16_is_lagranges_without_the_redundant_coordinate() {
    let graph = Graph::new();
    let redundant = bowl(&graph).poincare().unwrap().accelerations();
    let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
    let minimal = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|t, x, v| {
            let [z, rate] = height(t, x, v);
            lagrangian(&[x[0], x[1], z], &[v[0], v[1], rate])
        })
        .forces(|_, _, v| [Expr::ZERO, -v[1]])
        .build()
        .unwrap();
    let place = [(z, height(t, &[x, y], &[Expr::ZERO, Expr::ZERO])[0])];
    let found = graph.substitute(&redundant, &place);
    assert_all_equal("ẍ", found, minimal.poincare().unwrap().accelerations());
}

/// ẏ_s = −∂H/∂x_s − b_js ∂H/∂x_j + Q_s, ẋ_s = ∂H/∂y_s, and the dependent velocity by (14).
#[test]
fn equation_17_is_canonical() {
    let graph = Graph::new();
    let system = bowl(&graph);
    let canonical = system.canonical().unwrap();
    let (h, y) = (canonical.hamiltonian(), canonical.momenta());
    let slopes = operators(&graph, h);
    let velocities = graph.gradient(h, y);
    let forces = [Expr::ZERO, -velocities[1]];
    let found = canonical.right_hand_side();
    assert_identities("ẏ", (0..2).map(|s| (found[s], -slopes[s] + forces[s])));
    let [t, x, y] = graph.symbols(["t", "x", "y"]);
    let dependent = height(t, &[x, y], &velocities)[1];
    assert_all_equal("ẋ", canonical.velocities().to_vec(), [velocities[0], velocities[1], dependent]);
}
