//! The remaining Hamiltonian structure under constraints: the bracket, phase volume.

use pc_analysis::{PoissonBracket, divergence, invariant_measure};
use pc_mech::{Constraint, Expr, Graph, LieAlgebra, System};
use pc_nonholo::{Adapted, Constrained};

/// A particle in space under the force function −x² with a constraint on its velocities.
fn particle<'g>(graph: &'g Graph, constraint: Expr<'g>) -> Constrained<'g> {
    let system = System::builder(graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0 - x[0].square())
        .build()
        .unwrap();
    let held = system.with_multipliers(&[Constraint::new("c", constraint)]).unwrap();
    let at: Vec<_> = ["x", "y", "z", "x'", "y'", "z'", "t"].map(|name| (graph.symbol(name), 0.3)).into();
    Adapted::new(&held, &at).unwrap().constrained().unwrap()
}

fn knife(graph: &Graph) -> Constrained<'_> {
    let [y, vx, vz] = graph.symbols(["y", "x'", "z'"]);
    particle(graph, vz - y * vx)
}

/// dy = 2x dx: a surface.
fn surface(graph: &Graph) -> Constrained<'_> {
    let [x, vx, vy] = graph.symbols(["x", "x'", "y'"]);
    particle(graph, vy - 2.0 * x * vx)
}

fn sleigh(graph: &Graph) -> Constrained<'_> {
    let [m, j, a, u] = graph.symbols(["m", "J", "a", "u"]);
    let system = System::builder(graph)
        .coordinates(["x", "y", "φ"])
        .quasi_velocities(["v", "ω", "u"])
        .kinematics(|_, x, eta| {
            let (s, c) = (x[2].sin(), x[2].cos());
            [eta[0] * c - eta[2] * s, eta[0] * s + eta[2] * c, eta[1]]
        })
        .lagrangian(|_, _, eta| {
            (m * (eta[0].square() + (eta[2] + a * eta[1]).square()) + j * eta[1].square()) / 2.0
        })
        .build()
        .unwrap();
    Constrained::new(&system, &[u]).unwrap()
}

/// Suslov's body: ω3 = 0, with products of inertia.
fn suslov<'g>(graph: &'g Graph, product: f64) -> Constrained<'g> {
    let system = System::builder(graph)
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, _, w| {
            let diagonal = w[0].square() + 1.5 * w[1].square() + 2.0 * w[2].square();
            diagonal + product * w[0] * w[2] - 0.8 * w[1] * w[2]
        })
        .build()
        .unwrap();
    Constrained::new(&system, &[graph.symbol("ω3")]).unwrap()
}

#[test]
fn the_bracket_generates_the_motion() {
    let graph = Graph::new();
    for constrained in [knife(&graph), surface(&graph), sleigh(&graph), suslov(&graph, 0.5)] {
        let bracket = PoissonBracket::almost_poisson(&constrained).unwrap();
        let canonical = constrained.free_system().unwrap().canonical().unwrap();
        let rates = [canonical.velocities(), canonical.right_hand_side()].concat();
        for (found, expected) in bracket.field(canonical.hamiltonian()).unwrap().iter().zip(&rates) {
            assert!((*found - *expected).is_zero(), "{found} instead of {expected}");
        }
    }
}

#[test]
fn jacobis_identity_holds_for_integrable_constraints_only() {
    let graph = Graph::new();
    assert!(PoissonBracket::almost_poisson(&surface(&graph)).unwrap().jacobi_violation().is_none());
    for constrained in [knife(&graph), sleigh(&graph)] {
        let violation = PoissonBracket::almost_poisson(&constrained).unwrap().jacobi_violation();
        assert!(violation.is_some_and(|(_, defect)| !defect.is_zero()));
    }
}

/// div (N f) = 0, written out.
fn assert_invariant<'g>(constrained: &Constrained<'g>, density: Expr<'g>) {
    let system = constrained.free_system().unwrap();
    let canonical = system.canonical().unwrap();
    let graph = system.graph();
    let flow = |(z, rate): (&Expr<'g>, &Expr<'g>)| graph.gradient(density * *rate, &[*z])[0];
    let x = system.frame().coordinates().iter().zip(canonical.velocities()).map(flow);
    let y = canonical.momenta().iter().zip(canonical.right_hand_side()).map(flow);
    let total = graph.sum(x.chain(y));
    let values: Vec<_> = graph.symbols_of(&[total]).into_iter().map(|symbol| (symbol, 0.7)).collect();
    // Up to rounding: the graph does not recognise the root.
    assert!(graph.evaluate(&[total], &values).unwrap()[0].abs() < 1e-14, "{total}");
}

#[test]
fn phase_volume_is_kept_or_not() {
    let graph = Graph::new();
    let measure = invariant_measure(&knife(&graph).free_system().unwrap(), &[]).unwrap().unwrap();
    assert_invariant(&knife(&graph), measure.density());
    assert_eq!(measure.factors, [(1.0 + graph.symbol("y").square(), pc_mech::Number::ratio(-1, 2))]);
    let found = invariant_measure(&surface(&graph).free_system().unwrap(), &[]).unwrap().unwrap();
    assert_invariant(&surface(&graph), found.density());

    // Sleigh and Suslov's body go from one steady motion to another [Chaplygin 1911; Suslov 1902].
    assert!(invariant_measure(&sleigh(&graph).free_system().unwrap(), &[]).unwrap().is_none());
    let body = suslov(&graph, 0.5);
    assert!(!divergence(&body.free_system().unwrap()).unwrap().is_zero());
    assert!(invariant_measure(&body.free_system().unwrap(), &[]).unwrap().is_none());
    // … unless the fixed axis is principal [Kozlov 1988].
    let graph = Graph::new();
    let balanced = System::builder(&graph)
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, _, w| w[0].square() + 1.5 * w[1].square() + 2.0 * w[2].square())
        .build()
        .unwrap();
    let balanced = Constrained::new(&balanced, &[graph.symbol("ω3")]).unwrap();
    assert!(divergence(&balanced.free_system().unwrap()).unwrap().is_zero());
}

/// y = bᵀp turns Liouville's measure dx dp into dx dy/det b, whatever the Lagrangian.
#[test]
fn every_holonomic_system_with_a_square_frame_has_liouvilles_measure() {
    let graph = Graph::new();
    // A vehicle: its velocity in its own axes, its attitude by Euler angles. det b = ±1/sin θ.
    let names = ["x", "y", "z", "θ", "ψ", "φ"];
    let vehicle = System::builder(&graph)
        .coordinates(names)
        .quasi_velocities(["u", "v", "w", "p", "q", "r"])
        .kinematics(|_, x, eta| {
            let [(st, ct), (sf, cf)] = [(x[3].sin(), x[3].cos()), (x[5].sin(), x[5].cos())];
            let turn = (eta[3] * sf + eta[4] * cf) / st;
            let lean = [eta[0] * cf - eta[1] * sf, eta[0] * sf + eta[1] * cf];
            let (s, c) = (x[4].sin(), x[4].cos());
            let ahead = ct * lean[1] - st * eta[2];
            [
                c * lean[0] - s * ahead,
                s * lean[0] + c * ahead,
                st * lean[1] + ct * eta[2],
                eta[3] * cf - eta[4] * sf,
                turn,
                eta[5] - ct * turn,
            ]
        })
        .lagrangian(|_, x, eta| {
            let squares: Expr<'_> = eta.iter().enumerate().map(|(s, e)| e.square() * (1.0 + s as f64)).sum();
            squares / 2.0 + eta[0] * eta[5] * 0.3 - x[2] - (x[3] * 2.0).sin()
        })
        .build()
        .unwrap();
    let measure = invariant_measure(&vehicle, &[]).unwrap().unwrap();
    let ratio = measure.density() / graph.symbol("θ").sin();
    assert!(ratio.constant().is_some(), "{ratio}");
}
