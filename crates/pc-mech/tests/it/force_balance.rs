//! Kane's, Gibbs–Appell's and Maggi's equations against closed forms, the definition of the energy of accelerations, and
//! Poincaré's equations.

use pc_mech::{Constraint, Expr, Graph, LagrangianError, Maggi, MechError, System};

/// Chaplygin's sleigh with the velocity u across its blade, v along it, and its rate of turn ω.
fn sleigh<'g>(graph: &'g Graph, [m, j, a]: [Expr<'g>; 3]) -> System<'g> {
    System::builder(graph)
        .coordinates(["x", "y", "φ"])
        .quasi_velocities(["u", "v", "ω"])
        .kinematics(|_, x, eta| {
            let (s, c) = (x[2].sin(), x[2].cos());
            [eta[1] * c - eta[0] * s, eta[1] * s + eta[0] * c, eta[2]]
        })
        .lagrangian(|_, _, eta| {
            (m * (eta[1].square() + (eta[0] + a * eta[2]).square()) + j * eta[2].square()) / 2.0
        })
        .build()
        .unwrap()
}

/// The mass centre has the accelerations v̇ − aω² along the blade and vω + aω̇ across it [Neimark, Fufaev 1972].
#[test]
fn gibbs_function_of_the_sleigh() {
    let graph = Graph::new();
    let [m, j, a, v, w] = graph.symbols(["m", "J", "a", "v", "ω"]);
    let system = sleigh(&graph, [m, j, a]);
    let balance = system.force_balance(&[v, w], &[Expr::from(0.0), v, w]).unwrap();
    let [dv, dw] = graph.symbols(["v'", "ω'"]);
    let squares = (dv - a * w.square()).square() + (v * w + a * dw).square();
    let energy = (m * squares + j * dw.square()) / 2.0;
    for (rate, slope) in [dv, dw].into_iter().zip(balance.slopes()) {
        assert!((energy.derivative(rate) - slope).is_zero());
        assert!((balance.gibbs_function().derivative(rate) - slope).is_zero());
    }
    assert!(balance.active().iter().all(|force| force.is_zero()));
    assert!((balance.of_inertia()[0] - m * (a * w.square() - dv)).is_zero());
}

/// A particle in a plane, in a frame that moves and turns with time, with a magnetic force, a potential and friction.
fn charged(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["u", "w"])
        .kinematics(|t, x, eta| {
            [eta[0] * t.cos() - eta[1] * x[1] + t * x[0], eta[0] * t.sin() + eta[1] * (2.0 + x[0].square())]
        })
        .lagrangian_in_velocities(|t, x, v| {
            let kinetic = (3.0 * v[0].square() + 2.0 * v[1].square()) / 2.0;
            kinetic + x[0] * x[1] * v[1] - t * x[0].square()
        })
        .force_on_coordinates(|t, x, eta| [-eta[0] * x[1], t * eta[1]])
        .build()
        .unwrap()
}

/// The affine constraint u = t + x w of the particle.
fn constraint<'g>(graph: &'g Graph) -> (Expr<'g>, Vec<Expr<'g>>) {
    let [t, x, u, w] = graph.symbols(["t", "x", "u", "w"]);
    (u - t - x * w, vec![t + x * w, w])
}

/// S = ½ (3 ẍ² + 2 ÿ²) by its definition, and F = −∂V/∂x·∂ẋ/∂η + … by virtual work.
#[test]
fn the_energy_of_accelerations_in_a_moving_frame() {
    let graph = Graph::new();
    let system = charged(&graph);
    let [t, x, y, w, dw] = graph.symbols(["t", "x", "y", "w", "w'"]);
    let (_, values) = constraint(&graph);
    let balance = system.force_balance(&[w], &values).unwrap();
    let velocities = graph.substitute(&system.frame().velocities(&values), &[]);
    let along = [(x, velocities[0]), (y, velocities[1]), (w, dw), (t, 1.into())];
    let accelerations = graph.directional(&velocities, &along);
    let energy = 1.5 * accelerations[0].square() + accelerations[1].square();
    assert!((energy.derivative(dw) - balance.slopes()[0]).is_zero());
    assert!((balance.gibbs_function().derivative(dw) - balance.slopes()[0]).is_zero());
    // The magnetic force is B (ẏ, −ẋ) with B = ∂A_y/∂x − ∂A_x/∂y = y.
    let friction = [-values[0] * y, t * values[1]];
    let force = [y * velocities[1] - 2.0 * t * x + friction[0], -y * velocities[0] + friction[1]];
    let partial = [velocities[0].derivative(w), velocities[1].derivative(w)];
    let power = graph.dot(force, partial);
    assert!((power - balance.active()[0]).is_zero());
}

/// Poincaré's equations (30) with brackets, Kane's without, and Maggi's by Lagrange's expressions are the same.
#[test]
fn three_principles_give_one_equation() {
    let graph = Graph::new();
    let system = charged(&graph);
    let [t, x, y, w, dw] = graph.symbols(["t", "x", "y", "w", "w'"]);
    let (condition, values) = constraint(&graph);
    let balance = system.force_balance(&[w], &values).unwrap();
    let held = system.with_multipliers(&[Constraint::new("slope", condition)]).unwrap();
    // C M⁻¹ Cᵀ and the reaction eliminated: the residual along the free velocity.
    let rates = graph.directional(
        &values,
        &[
            (x, system.frame().velocities(&values)[0]),
            (y, system.frame().velocities(&values)[1]),
            (w, dw),
            (t, 1.into()),
        ],
    );
    let equations = system.poincare().unwrap();
    let (mass, right) = (equations.mass_matrix(), equations.right_hand_side());
    let known = [(graph.symbol("u"), values[0])];
    let rests = (0..2).map(|s| graph.dot(mass.row(s).iter().copied(), rates.iter().copied()) - right[s]);
    let rests = graph.substitute(&rests.collect::<Vec<_>>(), &known);
    let free = [values[0].derivative(w), values[1].derivative(w)];
    let along = graph.dot(rests.iter().copied(), free);
    assert!((along - (balance.slopes()[0] - balance.active()[0])).is_zero());
    // The reaction does no work along it.
    let reaction = graph.substitute(&held.reaction_forces(), &known);
    assert!(graph.dot(reaction, free).is_zero());

    let lagrange = system.in_velocities().unwrap().poincare().unwrap();
    let b = system.frame().b();
    let partial = b.times(&graph, &pc_mech::Matrix::from_fn(2, 1, |s, _| free[s]));
    let maggi = Maggi::new(lagrange, partial);
    let velocities = system.frame().velocities(&values);
    let accelerations =
        graph.directional(&velocities, &[(x, velocities[0]), (y, velocities[1]), (w, dw), (t, 1.into())]);
    let symbols = graph.symbols(["x'", "y'", "x''", "y''"]);
    let moving: Vec<_> = symbols.into_iter().zip([&velocities[..], &accelerations].concat()).collect();
    let expressions = graph.substitute(&maggi.expressions(), &moving);
    let known: Vec<_> = maggi.symbols().iter().copied().zip(expressions).collect();
    let sum = graph.substitute(&maggi.sums(), &known)[0];
    assert!((sum - along).is_zero());
}

/// Of L = −c²√(1 − ẋ²/c²) − x, the potential is the force and everything else is inertia.
#[test]
fn a_relativistic_particle_has_inertia_of_its_own() {
    let graph = Graph::new();
    let [c, v, dv] = graph.symbols(["c", "x'", "x''"]);
    let particle = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| -c.square() * (1.0 - v[0].square() / c.square()).sqrt() - x[0])
        .build()
        .unwrap();
    let balance = particle.force_balance(&[v], &[v]).unwrap();
    assert!((balance.active()[0] + 1.0).is_zero());
    let slowness = (1.0 - v.square() / c.square()).sqrt();
    assert!((balance.slopes()[0] - dv / slowness.powi(3)).is_zero());
}

#[test]
fn what_has_no_value_at_rest_is_refused() {
    let graph = Graph::new();
    let v = graph.symbol("x'");
    let particle = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, _, v| v[0].square() + 1.0 / v[0])
        .build()
        .unwrap();
    let error = particle.force_balance(&[v], &[v]).unwrap_err();
    assert_eq!(error, MechError::Lagrangian(LagrangianError::NoRest));
    let error = particle.force_balance(&[v], &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the list of quasi-velocities as functions of independent ones has 0 entries where 1 are needed"
    );
}
