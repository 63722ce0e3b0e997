//! Generalised forces (8) and Poincaré's equations (9).

use pc_mech::{Expr, Graph, Particle, System};

use crate::{along, assert_identities};

/// On a wire that turns: r = (ρ cos t, ρ sin t, z).
fn place<'g>(t: Expr<'g>, x: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [x[0] * t.cos(), x[0] * t.sin(), x[1]]
}

/// A force without a force function.
fn push<'g>(t: Expr<'g>, x: &[Expr<'g>], eta: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [eta[0].square(), eta[0] * t.sin(), eta[1] * x[0]]
}

/// Q_s = F · X_s r, whose power Q_s η_s is F · ṙ without what the turning of the wire gives, F · X_0 r.
#[test]
fn equation_8_generalised_forces_are_components_along_the_operators() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["ρ", "z"])
        .quasi_velocities(["u", "w"])
        .kinematics(|t, x, eta| [eta[0] * t.exp(), eta[1] + x[0] * eta[0]])
        .particle(|t, x, eta| Particle::new(2, place(t, x)).force(push(t, x, eta)))
        .build()
        .unwrap();
    let (frame, eta, q) = (system.frame(), system.quasi_velocities(), system.forces());
    let (t, x) = (frame.time(), frame.coordinates());
    let (r, force) = (place(t, x), push(t, x, eta));
    let work = |s: usize| graph.dot(force, frame.apply(s, &r));
    assert_identities("Q_s", (1..=2).map(|s| (q[s - 1], work(s))));

    let velocities = x.iter().copied().zip(frame.velocities(eta));
    let rates: Vec<_> = velocities.chain([(t, Expr::ONE)]).collect();
    let power = graph.dot(force, graph.directional(&r, &rates));
    assert_identities("power", [(graph.dot(q.iter().copied(), eta.iter().copied()), power - work(0))]);
}

fn velocities<'g>(t: Expr<'g>, x: &[Expr<'g>], eta: &[Expr<'g>]) -> [Expr<'g>; 2] {
    [eta[0] * (1.0 + x[0].square()) + t * x[1], eta[1] * (2.0 + t.sin() + x[1].square()) + x[0] * eta[0]]
}

/// L(t, x, ẋ)
fn lagrangian<'g>(t: Expr<'g>, x: &[Expr<'g>], v: &[Expr<'g>]) -> Expr<'g> {
    let kinetic = (v[0].square() + x[0] * v[0] * v[1] + (3.0 + x[0].square()) * v[1].square()) / 2.0;
    kinetic + t * x[0] * v[1] - x[0].square() * x[1]
}

/// F_i
fn forces<'g>(t: Expr<'g>, x: &[Expr<'g>], v: &[Expr<'g>]) -> [Expr<'g>; 2] {
    [-x[1] * v[0], t * x[0]]
}

/// A system in a frame that depends on time, with b_0 ≠ 0.
fn rheonomic(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["u", "v"])
        .kinematics(velocities)
        .lagrangian_in_velocities(lagrangian)
        .force_on_coordinates(|t, x, eta| forces(t, x, &velocities(t, x, eta)))
        .build()
        .unwrap()
}

/// d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s, term by term.
#[test]
fn equation_9_of_poincare_holds_along_the_motion() {
    let graph = Graph::new();
    let system = rheonomic(&graph);
    let (frame, c, eta) = (system.frame(), system.structure(), system.quasi_velocities());
    let p = system.momenta();
    let rates = graph.directional(&p, &along(&system.poincare().unwrap()));
    let right = |s: usize| {
        let gyroscopic = (1..=2).map(|m| {
            let turning = graph.sum((1..=2).map(|r| c.get(r, s, m) * eta[r - 1])) + c.get(0, s, m);
            turning * p[m - 1]
        });
        graph.sum(gyroscopic) + frame.apply(s, &[system.lagrangian()])[0] + system.forces()[s - 1]
    };
    assert_identities("(9)", (1..=2).map(|s| (rates[s - 1], right(s))));
    // All its terms are there.
    assert!(c.nonzero().any(|(r, ..)| r == 0) && c.nonzero().any(|(r, ..)| r > 0));
}

/// Lagrange's equations d/dt ∂L/∂ẋ_i − ∂L/∂x_i = F_i, which know of no frame, hold along the motion (9).
#[test]
fn equation_9_is_lagranges_in_the_velocities() {
    let graph = Graph::new();
    let equations = rheonomic(&graph).poincare().unwrap();
    let accelerations = graph.directional(equations.velocities(), &along(&equations));
    let [t, x, y, vx, vy, ax, ay] = graph.symbols(["t", "x", "y", "vx", "vy", "ax", "ay"]);
    let l = lagrangian(t, &[x, y], &[vx, vy]);
    let momenta = graph.gradient(l, &[vx, vy]);
    let rates = graph.directional(&momenta, &[(t, Expr::ONE), (x, vx), (y, vy), (vx, ax), (vy, ay)]);
    let slopes = graph.gradient(l, &[x, y]);
    let forces = forces(t, &[x, y], &[vx, vy]);
    let left: Vec<_> = (0..2).map(|i| rates[i] - slopes[i] - forces[i]).collect();
    let known: Vec<_> = [vx, vy, ax, ay]
        .into_iter()
        .zip(equations.velocities().iter().copied().chain(accelerations))
        .collect();
    let left = graph.substitute(&left, &known);
    assert_identities("Lagrange's equations", left.into_iter().map(|left| (left, Expr::ZERO)));
}
