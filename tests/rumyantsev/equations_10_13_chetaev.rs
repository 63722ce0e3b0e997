//! Chetaev's canonical equations (10), (11), their bracket (12) and the equations by brackets (13).

use pc_analysis::{PoissonBracket, hamilton_jacobi};
use pc_mech::{Canonical, Expr, Graph, System};

use crate::{along, assert_all_equal, assert_identities};

/// b, b_0, L and Q depend on time, b_0 ≠ 0 and c_0s ≠ 0.
fn rheonomic(graph: &Graph) -> System<'_> {
    driven(graph, true)
}

fn driven(graph: &Graph, forced: bool) -> System<'_> {
    let builder = System::builder(graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["u", "v"])
        .kinematics(|t, x, eta| {
            [eta[0] * (1.0 + t.square()) + t * x[1], eta[1] * x[0] - t * eta[0] + x[0].square()]
        })
        .lagrangian(|t, x, eta| {
            let kinetic = (eta[0].square() + t * eta[0] * eta[1] + 3.0 * eta[1].square()) / 2.0;
            kinetic + t * x[1] * eta[0] - x[0].square() * x[1] / 2.0
        });
    let builder =
        if forced { builder.forces(|t, x, eta| [t - eta[0] * x[1], x[0] * eta[1]]) } else { builder };
    builder.build().unwrap()
}

/// Meridian and parallel of a sphere: stationary, and c_12^2 = −cot θ is not constant.
fn sphere(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["θ", "φ"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| [eta[0], eta[1] / x[0].sin()])
        .lagrangian(|_, x, eta| (eta[0].square() + eta[1].square()) / 2.0 - 3.0 * x[0].cos())
        .build()
        .unwrap()
}

/// c_rs^m ∂H/∂y_r + c_0s^m, summed with y_m.
fn gyroscopic<'g>(canonical: &Canonical<'g>, s: usize) -> Expr<'g> {
    let system = canonical.system();
    let (graph, c, y) = (system.graph(), system.structure(), canonical.momenta());
    let slopes = graph.gradient(canonical.hamiltonian(), y);
    graph.sum((1..=y.len()).map(|m| {
        let turning = graph.sum((1..=y.len()).map(|r| c.get(r, s, m) * slopes[r - 1]));
        (turning + c.get(0, s, m)) * y[m - 1]
    }))
}

/// ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − X_s H + Q_s, at y = ∂L/∂η the rate of ∂L/∂η_s along the motion (9).
#[test]
fn equation_10_gives_the_rates_of_the_momenta() {
    let graph = Graph::new();
    let system = rheonomic(&graph);
    let canonical = system.canonical().unwrap();
    let eta: Vec<_> = system
        .quasi_velocities()
        .iter()
        .copied()
        .zip(canonical.closed_quasi_velocities().unwrap().iter().copied())
        .collect();
    let forces = graph.substitute(system.forces(), &eta);
    let right = |s: usize| {
        gyroscopic(&canonical, s) - system.frame().apply(s, &[canonical.hamiltonian()])[0] + forces[s - 1]
    };
    assert_identities("(10)", (1..=2).map(|s| (canonical.right_hand_side()[s - 1], right(s))));

    let rates = graph.directional(&system.momenta(), &along(&system.poincare().unwrap()));
    let known: Vec<_> = canonical.momenta().iter().copied().zip(system.momenta()).collect();
    let right = graph.substitute(canonical.right_hand_side(), &known);
    assert_all_equal("(10) along (9)", right, rates);
}

/// ẋ_i = b_i0 + b_is ∂H/∂y_s.
#[test]
fn equation_11_gives_the_velocities() {
    let graph = Graph::new();
    let system = rheonomic(&graph);
    let canonical = system.canonical().unwrap();
    let slopes = graph.gradient(canonical.hamiltonian(), canonical.momenta());
    let velocities = system.frame().velocities(&slopes);
    assert_all_equal("(11)", canonical.velocities().iter().copied(), velocities);
}

/// (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + c_rs^m ∂f/∂y_s ∂g/∂y_r y_m.
#[test]
fn equation_12_is_the_bracket() {
    let graph = Graph::new();
    let system = sphere(&graph);
    let (frame, c, bracket) = (system.frame(), system.structure(), PoissonBracket::new(&system));
    let y = system.momentum_symbols();
    let [theta, phi] = graph.symbols(["θ", "φ"]);
    let (f, g) = (theta * y[0].square() + phi.sin() * y[1], phi * y[0] * y[1] - theta.square());
    let (df, dg) = (graph.gradient(f, &y), graph.gradient(g, &y));
    let moving = (1..=2)
        .map(|s| dg[s - 1] * frame.apply(s, &[f])[0] - df[s - 1] * frame.apply(s, &[g])[0])
        .collect::<Vec<_>>();
    let indices = (1..=2).flat_map(|r| (1..=2).flat_map(move |s| (1..=2).map(move |m| (r, s, m))));
    let algebra = indices.map(|(r, s, m)| c.get(r, s, m) * df[s - 1] * dg[r - 1] * y[m - 1]);
    let expected = graph.sum(moving.into_iter().chain(algebra));
    assert_identities("(f, g)", [(bracket.of(f, g).unwrap(), expected)]);
}

#[test]
fn equation_12_is_skew_and_satisfies_jacobis_identity() {
    let graph = Graph::new();
    let bracket = PoissonBracket::new(&sphere(&graph));
    let [theta, phi, p, q] = graph.symbols(["θ", "φ", "p_u", "p_v"]);
    let (f, g, h) =
        (theta * p.square() + phi.sin() * q, phi * p * q - theta.square(), q.square() + theta * p);
    let (forth, back) = (bracket.of(f, g).unwrap(), bracket.of(g, f).unwrap());
    assert!(!forth.is_zero());
    assert_identities("(f, g) + (g, f)", [(forth, -back)]);
    assert_identities("Jacobi's identity", [(bracket.jacobi_defect(f, g, h).unwrap(), Expr::ZERO)]);
}

/// With the printed term c_0s^m ∂f/∂y_s y_m the bracket of f with itself would not vanish; the bracket extended by time does
/// without that term, and its (f, f) is zero.
#[test]
fn equation_12_is_extended_by_time_where_c_0s_is_not_zero() {
    let graph = Graph::new();
    let system = driven(&graph, false);
    let (c, y) = (system.structure(), system.momentum_symbols());
    let f = y[0].square() + graph.symbol("x") * y[1];
    let df = graph.gradient(f, &y);
    let pairs = (1..=2).flat_map(|s| (1..=2).map(move |m| (s, m)));
    let printed = graph.sum(pairs.map(|(s, m)| c.get(0, s, m) * df[s - 1] * y[m - 1]));
    assert!(!printed.is_zero());
    assert!(PoissonBracket::extended(&system).of(f, f).unwrap().is_zero());
}

/// ẋ_i = (x_i, H), ẏ_s = (y_s, H) in a stationary frame, and with the extended bracket and H + y_0 in any. In the paper (11) is
/// so only where b_0 = 0.
#[test]
fn equation_13_the_brackets_with_the_energy_are_the_motion() {
    let graph = Graph::new();
    let system = sphere(&graph);
    let canonical = system.canonical().unwrap();
    let field = PoissonBracket::new(&system).field(canonical.hamiltonian()).unwrap();
    let rates = || canonical.velocities().iter().chain(canonical.right_hand_side()).copied();
    assert_all_equal("stationary", field, rates());

    let system = driven(&graph, false);
    let canonical = system.canonical().unwrap();
    let bracket = PoissonBracket::extended(&system);
    let energy = canonical.hamiltonian() + bracket.time_momentum().unwrap();
    let state: Vec<_> = system.frame().coordinates().iter().chain(canonical.momenta()).copied().collect();
    let rates = || canonical.velocities().iter().chain(canonical.right_hand_side()).copied();
    assert_all_equal("rheonomic", bracket.rates(&state, energy).unwrap(), rates());
}

/// X_0 S + H(t, x, X_s S) = 0: y_s = X_s S then satisfies (10) along (11). Free fall in the frame ẋ = 2η, g = 1.
#[test]
fn equations_10_and_11_are_satisfied_by_a_solution_of_hamilton_and_jacobi() {
    let graph = Graph::new();
    let [t, x, start] = graph.symbols(["t", "x", "α"]);
    let system = System::builder(&graph)
        .coordinates(["x"])
        .quasi_velocities(["η"])
        .kinematics(|_, _, eta| [2.0 * eta[0]])
        .lagrangian(|_, x, eta| 2.0 * eta[0].square() - x[0])
        .build()
        .unwrap();
    let canonical = system.canonical().unwrap();
    let action = (x - start).square() / (2.0 * t) - t * (x + start) / 2.0 - t.powi(3) / 24.0;
    assert!(hamilton_jacobi(&canonical, action).unwrap().is_zero());
    let momentum = system.frame().apply(1, &[action])[0];
    let known = [(canonical.momenta()[0], momentum)];
    let velocity = graph.substitute(canonical.velocities(), &known)[0];
    let rate = graph.directional(&[momentum], &[(t, Expr::ONE), (x, velocity)])[0];
    assert_identities("ẏ", [(rate, graph.substitute(canonical.right_hand_side(), &known)[0])]);
}
