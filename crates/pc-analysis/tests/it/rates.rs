//! Rates along the motion, the energy's among them, and cyclic displacements.

use crate::common;
use pc_analysis::{Conservation, CyclicDisplacement, PoissonBracket, Rates};
use pc_mech::{Expr, Graph, LieAlgebra, Number, System, SystemBuilder, VectorField};

/// A top with the moments of inertia A, B, C as parameters.
fn top<'g>(graph: &'g Graph, inertia: [f64; 3], m: [f64; 3]) -> System<'g> {
    let symbols = graph.symbols(["A", "B", "C"]);
    let builder = common::top(graph, symbols, m.map(Expr::from));
    let builder =
        symbols.into_iter().zip(inertia).fold(builder, |builder, (i, value)| builder.parameter(i, value));
    builder.build().unwrap()
}

/// b, b_0, L and Q depend on time, b_0 ≠ 0, c_0s ≠ 0, L has terms linear in η.
fn driven(graph: &Graph) -> SystemBuilder<'_> {
    common::driven(graph).forces(|t, x, eta| [x[1] - eta[0] / 3.0, t * eta[1] * x[0]])
}

fn quadratic<'g>(t: Expr<'g>, x: &[Expr<'g>], eta: &[Expr<'g>]) -> Expr<'g> {
    let kinetic = (eta[0].square() + t.sin() * eta[0] * eta[1] + 3.0 * eta[1].square()) / 2.0;
    kinetic + t * x[1] * eta[0] + x[0] * eta[1] - x[0].square() * x[1] / 2.0
}

#[test]
fn verdicts_on_the_top() {
    let graph = Graph::new();
    let lagrange = top(&graph, [1.0, 1.0, 0.5], [0.0, 0.0, 1.0]);
    let [a, b, c, g1, g2, g3, w1, w2, w3] =
        graph.symbols(["A", "B", "C", "γ1", "γ2", "γ3", "ω1", "ω2", "ω3"]);
    let rates = Rates::poincare(&lagrange.poincare().unwrap());
    let area = a * w1 * g1 + b * w2 * g2 + c * w3 * g3;
    for integral in [lagrange.energy(), area, g1.square() + g2.square() + g3.square()] {
        assert_eq!(rates.verdict(integral).unwrap(), Conservation::Conserved);
    }
    assert_eq!(rates.verdict(w3).unwrap(), Conservation::ConservedHere); // A = B
    assert_eq!(rates.with_parameters_bound().verdict(w3).unwrap(), Conservation::Conserved);
    assert_eq!(rates.verdict(g3).unwrap(), Conservation::Changing(g1 * w2 - g2 * w1));
    assert!(!rates.verdict(g3).unwrap().is_conserved() && rates.verdict(w3).unwrap().is_conserved());
    // η̇ may stand in the function: C ω3' = (A − B) ω1 ω2.
    let w3_rate = graph.symbol("ω3'");
    assert_eq!(rates.verdict(c * w3_rate - (a - b) * w1 * w2).unwrap(), Conservation::Conserved);
    // The verdicts in momenta.
    let canonical = lagrange.canonical().unwrap();
    let rates = Rates::canonical(&canonical);
    assert_eq!(rates.verdict(canonical.hamiltonian()).unwrap(), Conservation::Conserved);
    assert_eq!(canonical.in_momenta(lagrange.energy()), canonical.hamiltonian());
    assert_eq!(rates.verdict(canonical.in_momenta(area)).unwrap(), Conservation::Conserved);
    assert_eq!(rates.verdict(canonical.in_momenta(w3)).unwrap(), Conservation::ConservedHere);
}

/// A jump of the potential is not a force, yet the energy jumps with it.
#[test]
fn a_vanishing_rate_does_not_prove_a_jumping_function_conserved() {
    let graph = Graph::new();
    let [depth, x, v] = graph.symbols(["U", "x", "x'"]);
    let builder = || System::builder(&graph).parameter(depth, 5.0).coordinates(["x"]);
    let free = builder().lagrangian(|_, _, v| v[0].square() / 2.0).build().unwrap();
    let rates = Rates::poincare(&free.poincare().unwrap());
    let between = Conservation::ConservedBetweenJumps;
    assert_eq!(rates.verdict(free.energy() + x.step(depth, Expr::ZERO)).unwrap(), between);
    assert!(!between.is_conserved());
    assert_eq!(rates.verdict(v + (depth - 5.0) * x + x.sign()).unwrap(), between);
    assert_eq!(rates.verdict(v).unwrap(), Conservation::Conserved);
    assert_eq!(rates.verdict(v + depth.sign()).unwrap(), Conservation::Conserved);
    assert_eq!(rates.verdict(x.sign() * v.square() + x).unwrap(), Conservation::Changing(v));
    // A corner is not a jump.
    let bent = builder().lagrangian(|_, x, v| v[0].square() / 2.0 - depth * x[0].abs()).build().unwrap();
    assert_eq!(
        Rates::poincare(&bent.poincare().unwrap()).verdict(bent.energy()).unwrap(),
        Conservation::Conserved
    );
}

/// ∂E/∂t + ẋ ∂E/∂x + η̇ ∂E/∂η with E = y·η − L and the rates that the compiled motion has.
fn energy_rate_along<'g>(system: &System<'g>, point: &[(Expr<'g>, f64)]) -> f64 {
    let graph = system.graph();
    let (t, x) = (system.frame().time(), system.frame().coordinates());
    let symbols: Vec<Expr<'g>> = x.iter().chain(system.quasi_velocities()).chain([&t]).copied().collect();
    let at = |symbol: Expr<'g>| point.iter().find(|(s, _)| *s == symbol).map_or(0.0, |&(_, value)| value);
    let state: Vec<f64> = symbols[..symbols.len() - 1].iter().map(|&symbol| at(symbol)).collect();
    let mut rates = vec![1.0; symbols.len()];
    let mut motion = system.poincare().unwrap().compile().unwrap();
    motion.rhs(at(t), &state, &mut rates[..state.len()]).unwrap();
    let slopes = graph.evaluate(&graph.gradient(system.energy(), &symbols), point).unwrap();
    slopes.iter().zip(&rates).map(|(slope, rate)| slope * rate).sum()
}

/// dH/dt = X_0 H + c_0r^m η_r y_m + Q_s η_s against the derivative of y·η − L along the motion: in numbers to
/// the rounding of some hundred operations, and as expressions if there are no roots.
#[test]
fn the_energy_rate_agrees_with_the_motion() {
    let graph = Graph::new();
    let hoop = System::builder(&graph)
        .coordinates(["θ"])
        .quasi_velocities(["η"])
        .kinematics(|t, x, eta| [eta[0] * (-t / 5.0).exp() + t.sin() * x[0].cos()])
        .lagrangian(|t, x, eta| (eta[0].square() + 9.0 * x[0].sin().square()) / 2.0 + (4.0 + t) * x[0].cos())
        .build()
        .unwrap();
    // A bead on a wire that turns in its plane, n > k: η = (1 + t/2) ṙ, c_01^1 = −1/(2 + t).
    let wire = System::builder(&graph)
        .coordinates(["X", "Y"])
        .quasi_velocities(["η"])
        .kinematics(|t, x, eta| {
            let slide = eta[0] / (1.0 + t / 2.0);
            [slide * t.cos() - x[1], slide * t.sin() + x[0]]
        })
        .lagrangian(|t, x, eta| {
            let slide = eta[0] / (1.0 + t / 2.0);
            let velocity = [slide * t.cos() - x[1], slide * t.sin() + x[0]];
            (velocity[0].square() + velocity[1].square()) / 2.0 - 3.0 * x[1]
        })
        .build()
        .unwrap();
    let relativistic = driven(&graph)
        .lagrangian(|t, x, eta| {
            t.cos() * x[0] - 9.0 * (1.0 - (eta[0].square() + eta[1].square()) / 9.0).sqrt()
        })
        .build()
        .unwrap();
    let quadratic = driven(&graph).lagrangian(quadratic).build().unwrap();
    for system in [&quadratic, &hoop, &wire, &relativistic] {
        assert!(system.structure().nonzero().any(|(r, ..)| r == 0));
        for i in 0..20 {
            let value = |j: usize| 0.7 * ((i * 7 + j * 13) as f64 * 0.618).sin();
            let eta = system.quasi_velocities();
            let symbols = [system.frame().time()];
            let symbols = symbols.iter().chain(system.frame().coordinates()).chain(eta);
            let point: Vec<_> = symbols.enumerate().map(|(j, &symbol)| (symbol, value(j))).collect();
            let found = graph.evaluate(&[system.energy_rate()], &point).unwrap()[0];
            let expected = energy_rate_along(system, &point);
            assert!((found - expected).abs() <= 1e-12 * (1.0 + expected.abs()), "{found} {expected}");
        }
    }
    for system in [&quadratic, &hoop, &wire] {
        assert_eq!(
            Rates::poincare(&system.poincare().unwrap()).of(system.energy()).unwrap(),
            system.energy_rate()
        );
    }
    assert!(top(&graph, [1.0, 2.0, 3.0], [1.0, 0.0, 1.0]).energy_rate().is_zero());
}

fn cyclic(system: &System<'_>) -> Vec<(Vec<Number>, bool)> {
    let rates = Rates::poincare(&system.poincare().unwrap());
    let displacements = CyclicDisplacement::all(system);
    for displacement in &displacements {
        assert_eq!(
            rates.verdict(displacement.momentum).unwrap(),
            Conservation::Conserved,
            "{displacement:?}"
        );
    }
    displacements.into_iter().map(|d| (d.coefficients, d.commutes)).collect()
}

fn whole<const N: usize>(coefficients: [i32; N]) -> Vec<Number> {
    coefficients.map(Number::integer).to_vec()
}

/// Coordinates that do not occur in L are cyclic, and so are directions in which L does not change.
#[test]
fn cyclic_coordinates_are_cyclic_displacements() {
    let graph = Graph::new();
    let m = graph.symbol("m");
    let top = System::builder(&graph)
        .coordinates(["ψ", "θ", "φ"])
        .lagrangian(|_, x, v| {
            let (precession, spin) = (v[0] * x[1].sin(), v[2] + v[0] * x[1].cos());
            (v[1].square() + precession.square() + spin.square() / 2.0) / 2.0 - m * x[1].cos()
        })
        .build()
        .unwrap();
    assert_eq!(cyclic(&top), [(whole([1, 0, 0]), true), (whole([0, 0, 1]), true)]);
    let slope = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| {
            let kinetic = v[0].square() + v[1].square() + v[2].square();
            m * kinetic / 2.0 - m * (2.0 * x[0] + 3.0 * x[1] - x[2])
        })
        .build()
        .unwrap();
    let expected = [(whole([3, -2, 0]), true), (whole([1, 0, 2]), true)];
    assert_eq!(cyclic(&slope), expected);
    // Friction along x excludes integrals that contain x.
    let rough = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .forces(|_, _, v| [-v[0], Expr::ZERO])
        .build()
        .unwrap();
    assert_eq!(cyclic(&rough), [(whole([0, 1]), true)]);
}

/// Lagrange's top in body axes: X_3 does not commute with X_1 and X_2, but A = B.
#[test]
fn lagranges_top_has_a_cyclic_displacement_by_its_symmetry() {
    let graph = Graph::new();
    let lagrange = top(&graph, [1.0, 1.0, 0.5], [0.0, 0.0, 1.0]);
    assert_eq!(cyclic(&lagrange), []);
    assert_eq!(cyclic(&lagrange.with_parameters_bound()), [(whole([0, 0, 1]), false)]);
    let ball = top(&graph, [2.0, 2.0, 2.0], [3.0, 0.0, 4.0]).with_parameters_bound();
    assert_eq!(cyclic(&ball), [(whole([3, 0, 4]), false)]);
    // The central displacement of Heisenberg's algebra, for any metric.
    let heisenberg = System::builder(&graph)
        .quasi_velocities(["u", "v", "w"])
        .algebra(&LieAlgebra::named("heisenberg").unwrap())
        .lagrangian(|_, _, eta| (eta[0].square() + (eta[1] + 2.0 * eta[2]).square() + eta[2].square()) / 2.0)
        .build()
        .unwrap();
    assert_eq!(cyclic(&heisenberg), [(whole([0, 0, 1]), true)]);
}

/// Among more rates than are compared with all others: each of 68 masses has a spring of its own, two are joined by one that
/// lets them move together, and two are free.
#[test]
fn cyclic_displacements_are_found_among_many_coordinates() {
    let graph = Graph::new();
    let names: Vec<String> = (0..72).map(|i| format!("q{i}")).collect();
    let masses = System::builder(&graph)
        .coordinates(names.iter().map(String::as_str))
        .lagrangian(|_, q, v| {
            let kinetic: Expr<'_> = v.iter().map(|v| v.square()).sum();
            let springs: Expr<'_> = q[..68].iter().map(|q| q.square()).sum();
            (kinetic - springs - (q[68] - 2.0 * q[69]).square()) / 2.0
        })
        .build()
        .unwrap();
    let along = |displacement: &[(usize, i32)]| {
        let mut coefficients = vec![Number::integer(0); 72];
        displacement.iter().for_each(|&(i, a)| coefficients[i] = Number::integer(a));
        (coefficients, true)
    };
    assert_eq!(cyclic(&masses), [along(&[(68, 2), (69, 1)]), along(&[(70, 1)]), along(&[(71, 1)])]);
}

/// A symbol foreign to the motion is not an integral, and a quasi-velocity is not a momentum.
#[test]
fn functions_of_foreign_symbols_have_neither_rate_nor_bracket() {
    let graph = Graph::new();
    let system = top(&graph, [1.0, 1.0, 0.5], [0.0, 0.0, 1.0]);
    let [a, typo, g1, w1, y1] = graph.symbols(["A", "omega1", "γ1", "ω1", "p_ω1"]);
    let rates = Rates::poincare(&system.poincare().unwrap());
    let error = rates.verdict(a * w1 + typo).unwrap_err().to_string();
    assert!(
        error.starts_with("`omega1` stands in a function along the motion, which can contain `γ1`"),
        "{error}"
    );
    assert!(rates.verdict(y1).is_err() && rates.integrals_among(&[typo]).is_err());
    let canonical = system.canonical().unwrap();
    assert!(
        Rates::canonical(&canonical).verdict(w1).is_err() && Rates::canonical(&canonical).verdict(y1).is_ok()
    );
    for bracket in [PoissonBracket::new(&system), PoissonBracket::extended(&system)] {
        assert!(bracket.of(w1, g1).is_err() && bracket.of(g1, typo).is_err());
        assert!(bracket.is_casimir(typo).is_err() && bracket.closure(&[w1]).is_err());
        assert!(bracket.of(a * y1, g1).is_ok());
        assert!(bracket.of(canonical.in_momenta(w1), g1).is_ok());
        assert!(bracket.clone().with_constants([typo]).is_casimir(typo).unwrap());
    }
}
