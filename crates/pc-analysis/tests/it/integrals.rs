//! First integrals found from an ansatz.

use crate::common;
use pc_analysis::{Ansatz, Conservation, ConservationVerdict, Integral, Integrals, PoissonBracket, Rates};
use pc_mech::{Expr, Graph, LieAlgebra, Neighbourhood, System};

fn top<'g>(graph: &'g Graph, inertia: [f64; 3], m: [f64; 3]) -> System<'g> {
    common::top(graph, inertia, m).build().unwrap()
}

/// Whether `f` is a function of `others`, by the rank of the gradients.
fn is_function_of<'g>(graph: &'g Graph, f: Expr<'g>, others: &[Expr<'g>]) -> bool {
    let variables = graph.symbols_of(&[others, &[f]].concat());
    let mut rows: Vec<Vec<Expr<'g>>> = others.iter().map(|&g| graph.gradient(g, &variables)).collect();
    let rank = graph.generic_rank(&rows);
    rows.push(graph.gradient(f, &variables));
    graph.generic_rank(&rows) == rank
}

fn texts(found: &[Expr<'_>]) -> Vec<String> {
    found.iter().map(Expr::to_string).collect()
}

fn all_conserved<'g>(rates: &Rates<'g>, found: &[Expr<'g>]) {
    assert!(found.iter().all(|&f| rates.verdict(f).unwrap() == Conservation::Conserved), "{found:?}");
}

#[test]
fn lagranges_top_has_four() {
    let graph = Graph::new();
    let rates = Rates::poincare(&top(&graph, [1.0, 1.0, 0.5], [0.0, 0.0, 1.0]).poincare().unwrap());
    let found = rates.integrals(&rates.ansatz(2, 2)).unwrap();
    all_conserved(&rates, &found);
    let expected = ["γ1^2 + γ2^2 + γ3^2", "ω3", "2*γ1*ω1 + 2*γ2*ω2 + γ3*ω3", "2*γ3 + ω1^2 + ω2^2"];
    assert_eq!(texts(&found), expected);
    // Known integrals are not found again.
    let ansatz = Ansatz { known: found[..3].to_vec(), ..rates.ansatz(2, 2) };
    assert_eq!(rates.integrals(&ansatz).unwrap(), found[3..]);
}

#[test]
fn a_triaxial_top_has_three() {
    let graph = Graph::new();
    for (inertia, m) in [
        ([2.0, 3.0, 4.0], [0.1, 0.2, 0.3]),
        ([4.0, 4.0, 1.0], [1.0, 0.0, 0.0]), // Goryachev–Chaplygin: a fourth for γ·y = 0 only
    ] {
        let rates = Rates::poincare(&top(&graph, inertia, m).poincare().unwrap());
        let found = rates.integrals(&rates.ansatz(3, 2)).unwrap();
        assert_eq!(found.len(), 3, "{found:?}");
        all_conserved(&rates, &found);
    }
}

/// (ω1² − ω2² − μγ1)² + (2ω1ω2 − μγ2)² with A = B = 2C, μ = m_1/C: S. V. Kovalevskaya's integral.
#[test]
fn kovalevskayas_top_has_her_integral() {
    let graph = Graph::new();
    let system = top(&graph, [2.0, 2.0, 1.0], [1.0, 0.0, 0.0]);
    let [g1, g2, w1, w2] = graph.symbols(["γ1", "γ2", "ω1", "ω2"]);
    let kovalevskaya = (w1.square() - w2.square() - g1).square() + (2.0 * w1 * w2 - g2).square();
    let rates = Rates::poincare(&system.poincare().unwrap());
    assert_eq!(rates.integrals(&rates.ansatz(3, 2)).unwrap().len(), 3);
    let found = rates.integrals(&rates.ansatz(4, 2)).unwrap();
    assert_eq!(found.len(), 4, "{found:?}");
    all_conserved(&rates, &found);
    assert_eq!(found[3], kovalevskaya);
    // With a weight of many digits: μ = 29.4312, μ² = 866.19553344.
    let heavy = Rates::poincare(&top(&graph, [2.0, 2.0, 1.0], [29.4312, 0.0, 0.0]).poincare().unwrap());
    let (g1, g2) = (29.4312 * g1, 29.4312 * g2);
    let found = heavy.integrals(&heavy.ansatz(4, 2)).unwrap();
    let expected = (w1.square() - w2.square() - g1).square() + (2.0 * w1 * w2 - g2).square();
    assert!(found.len() == 4 && is_function_of(&graph, expected, &found));
    // In momenta, where the Casimirs are known.
    let canonical = system.canonical().unwrap();
    let rates = Rates::canonical(&canonical);
    let mut known = PoissonBracket::new(&system).casimirs(2);
    known.push(canonical.hamiltonian());
    let found = rates.integrals(&Ansatz { known: known.clone(), ..rates.ansatz(4, 2) }).unwrap();
    assert_eq!(found.len(), 1);
    known.extend(&found);
    assert!(is_function_of(&graph, canonical.in_momenta(kovalevskaya), &known));
    // In involution with the energy, as with every function that commutes with it.
    assert!(PoissonBracket::new(&system).of(found[0], canonical.hamiltonian()).unwrap().is_zero());
}

/// Coefficients that are sines and cosines: the area integral in Euler's angles.
#[test]
fn angles_enter_by_sine_and_cosine() {
    let graph = Graph::new();
    let system = common::in_eulers_angles(&graph)
        .lagrangian(|_, x, w| {
            (2.0 * w[0].square() + 3.0 * w[1].square() + 4.0 * w[2].square()) / 2.0
                - x[1].cos()
                - x[1].sin() * x[2].cos()
        })
        .build()
        .unwrap();
    let [theta, phi, y1, y2, y3] = graph.symbols(["θ", "φ", "p_ω1", "p_ω2", "p_ω3"]);
    let canonical = system.canonical().unwrap();
    let rates = Rates::canonical(&canonical);
    let found = rates.integrals(&rates.ansatz(2, 2)).unwrap();
    let area = theta.sin() * (y1 * phi.sin() + y2 * phi.cos()) + y3 * theta.cos();
    assert_eq!(found.len(), 2, "{found:?}");
    assert_eq!(found[0], area);
    assert!(is_function_of(&graph, canonical.hamiltonian(), &found));
}

/// Momenta, angular momentum, and with time the uniform motion of the centre.
#[test]
fn a_free_particle_has_all() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| v[0].square() + v[1].square())
        .build()
        .unwrap();
    let rates = Rates::canonical(&particle.canonical().unwrap());
    assert_eq!(texts(&rates.integrals(&rates.ansatz(1, 1)).unwrap()), ["p_x", "p_y", "y*p_x - x*p_y"]);
    let [t, x, y] = graph.symbols(["t", "x", "y"]);
    let functions = vec![Expr::ONE, x, y, t];
    let found = rates.integrals(&Ansatz { degree: 1, functions, known: Vec::new() }).unwrap();
    assert_eq!(found.len(), 4); // all of them: the fifth function of (t, x, y, p) is time
    all_conserved(&rates, &found);
}

/// Kirchhoff's equations, n = 0: |p|², p·m and the energy of a body in a fluid.
#[test]
fn a_body_in_a_fluid_has_casimirs_and_energy() {
    let graph = Graph::new();
    let body = System::builder(&graph)
        .quasi_velocities(["w1", "w2", "w3", "v1", "v2", "v3"])
        .algebra(&LieAlgebra::se3())
        .lagrangian(|_, _, eta| {
            let weights = [2.0, 3.0, 5.0, 1.0, 4.0, 6.0];
            eta.iter().zip(weights).map(|(&eta, weight)| weight * eta.square() / 2.0).sum()
        })
        .build()
        .unwrap();
    let canonical = body.canonical().unwrap();
    let rates = Rates::canonical(&canonical);
    let found = rates.integrals(&rates.ansatz(2, 0)).unwrap();
    assert_eq!(found.len(), 3, "{found:?}");
    let casimirs = PoissonBracket::new(&body).casimirs(2);
    assert_eq!(casimirs.len(), 2);
    assert!(casimirs.iter().all(|&f| is_function_of(&graph, f, &found)));
    assert!(is_function_of(&graph, canonical.hamiltonian(), &found));
}

/// The vector of Laplace in polar coordinates, its coefficients being given functions.
#[test]
fn keplers_problem_has_laplaces_vector() {
    let graph = Graph::new();
    let kepler = System::builder(&graph)
        .coordinates(["r", "φ"])
        .lagrangian(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0 + 1.0 / x[0])
        .build()
        .unwrap();
    let [r, phi, p, l] = graph.symbols(["r", "φ", "p_r", "p_φ"]);
    let canonical = kepler.canonical().unwrap();
    let rates = Rates::canonical(&canonical);
    let functions = vec![Expr::ONE, phi.cos(), phi.sin(), phi.cos() / r, phi.sin() / r];
    let known = vec![l];
    let found = rates.integrals(&Ansatz { degree: 2, functions: functions.clone(), known }).unwrap();
    assert_eq!(found.len(), 2, "{found:?}");
    let laplace = [
        phi.cos() * (l.square() / r - 1.0) + phi.sin() * p * l,
        phi.sin() * (l.square() / r - 1.0) - phi.cos() * p * l,
    ];
    for component in laplace {
        assert_eq!(rates.verdict(component).unwrap(), Conservation::Conserved);
        assert!(is_function_of(&graph, component, &[found[0], found[1], l]));
    }
    // Poisson's theorem: one component and the angular momentum give the other.
    let bracket = PoissonBracket::new(&kepler);
    assert_eq!(bracket.of(laplace[0], l).unwrap(), -laplace[1]);
    assert_eq!(bracket.closure(&[l, laplace[0]]).unwrap().len(), 3);
    assert!(is_function_of(&graph, canonical.hamiltonian(), &bracket.closure(&[l, laplace[0]]).unwrap()));
}

/// In Cartesian coordinates, with a root in the coefficients.
#[test]
fn keplers_problem_in_cartesian_coordinates() {
    let graph = Graph::new();
    let kepler = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| {
            let r = (x[0].square() + x[1].square()).sqrt();
            (v[0].square() + v[1].square()) / 2.0 + 1.0 / r
        })
        .build()
        .unwrap();
    let [x, y, p, q] = graph.symbols(["x", "y", "p_x", "p_y"]);
    let r = (x.square() + y.square()).sqrt();
    let rates = Rates::canonical(&kepler.canonical().unwrap());
    let functions = vec![Expr::ONE, x, y, 1.0 / r, x / r, y / r];
    let found = rates.integrals(&Ansatz { degree: 2, functions, known: Vec::new() }).unwrap();
    let moment = x * q - y * p;
    assert_eq!(found, [-moment, y / r + p * moment, 2.0 / r - p.square() - q.square()]);
    all_conserved(&rates, &found);
}

/// Three particles of Toda's open chain: momentum, energy and a cubic integral, with exponentials as
/// coefficients.
#[test]
fn todas_chain_has_a_cubic_one() {
    let graph = Graph::new();
    let chain = System::builder(&graph)
        .coordinates(["q1", "q2", "q3"])
        .lagrangian(|_, q, v| {
            let kinetic = (v[0].square() + v[1].square() + v[2].square()) / 2.0;
            kinetic - (q[0] - q[1]).exp() - (q[1] - q[2]).exp()
        })
        .build()
        .unwrap();
    let [q1, q2, q3, p1, p2, p3] = graph.symbols(["q1", "q2", "q3", "p_q1", "p_q2", "p_q3"]);
    let (e1, e2) = ((q1 - q2).exp(), (q2 - q3).exp());
    let rates = Rates::canonical(&chain.canonical().unwrap());
    let found = rates
        .integrals(&Ansatz { degree: 3, functions: vec![Expr::ONE, e1, e2], known: Vec::new() })
        .unwrap();
    assert_eq!(found.len(), 3, "{found:?}");
    all_conserved(&rates, &found);
    let cubic = p1.powi(3) + p2.powi(3) + p3.powi(3) + 3.0 * e1 * (p1 + p2) + 3.0 * e2 * (p2 + p3);
    assert_eq!(rates.verdict(cubic).unwrap(), Conservation::Conserved);
    assert!(is_function_of(&graph, cubic, &found) && !is_function_of(&graph, cubic, &found[..2]));
}

/// Chaplygin's sleigh, I + m a² = 5/4, m = 1, a = ½: a nonholonomic system, whose energy alone is found.
#[test]
fn a_sleigh_keeps_its_energy() {
    let graph = Graph::new();
    let sleigh = System::builder(&graph)
        .coordinates(["X", "Y", "φ"])
        .quasi_velocities(["v", "ω", "u"])
        .kinematics(|_, x, eta| {
            let (sin, cos) = (x[2].sin(), x[2].cos());
            [eta[0] * cos - eta[2] * sin, eta[0] * sin + eta[2] * cos, eta[1]]
        })
        .lagrangian(|_, _, eta| (eta[0].square() + (eta[2] + eta[1] / 2.0).square() + eta[1].square()) / 2.0)
        .build()
        .unwrap();
    let rates = Rates::poincare(&sleigh.poincare_constrained(2).unwrap());
    let found = rates.integrals(&rates.ansatz(2, 0)).unwrap();
    assert_eq!(texts(&found), ["4*v^2 + 5*ω^2"]);
}

/// Coefficients are functions of the parameters: Euler's top with symbols for its moments of inertia.
#[test]
fn parameters_may_stay_symbols() {
    let graph = Graph::new();
    let [a, b, c] = graph.symbols(["A", "B", "C"]);
    let top = System::builder(&graph)
        .parameter(a, 1.0)
        .parameter(b, 2.0)
        .parameter(c, 3.0)
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, _, w| (a * w[0].square() + b * w[1].square() + c * w[2].square()) / 2.0)
        .build()
        .unwrap();
    let rates = Rates::poincare(&top.poincare().unwrap());
    let [w1, w2, w3] = graph.symbols(["ω1", "ω2", "ω3"]);
    let [x, y, z] = [a * w1.square(), b * w2.square(), c * w3.square()];
    for functions in [[x, y, z], [a * x, b * y, c * z], [w1, w2, w3].map(Expr::square)] {
        let found = rates.integrals_among(&functions).unwrap();
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|&f| rates.verdict(f).unwrap() == Conservation::Conserved));
    }
    assert!(rates.integrals_among(&[w1.square(), w1 * w2]).unwrap().is_empty());
    assert_eq!(rates.with_parameters_bound().integrals(&rates.ansatz(2, 0)).unwrap().len(), 2);
}

/// A free rigid body in a quaternion, scalar first: q̇ = ½ Ξ(q) ω, L = ½ ω·Iω with any inertia matrix I.
fn free_body(graph: &Graph) -> System<'_> {
    let inertia = inertia();
    System::builder(graph)
        .coordinates(["q0", "q1", "q2", "q3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, q, w| {
            [
                -(q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) / 2.0,
                (q[0] * w[0] - q[3] * w[1] + q[2] * w[2]) / 2.0,
                (q[3] * w[0] + q[0] * w[1] - q[1] * w[2]) / 2.0,
                (-q[2] * w[0] + q[1] * w[1] + q[0] * w[2]) / 2.0,
            ]
        })
        .lagrangian(|_, _, w| {
            (0..3).map(|i| graph.dot(inertia[i], w.iter().copied()) * w[i]).sum::<Expr<'_>>() / 2.0
        })
        .build()
        .unwrap()
}

/// Neither diagonal nor on principal axes.
fn inertia<'g>() -> [[Expr<'g>; 3]; 3] {
    [[2.0, 0.0, 0.5], [0.0, 3.0, -0.8], [0.5, -0.8, 4.0]].map(|row| row.map(Expr::from))
}

/// Of the integrals linear in ω with coefficients quadratic in q: the angular momentum in space, R(q) I ω,
/// where R is |q|² times a rotation, and |q|², which does not depend on ω.
#[test]
fn a_free_body_keeps_its_angular_momentum_in_space() {
    let graph = Graph::new();
    let body = free_body(&graph);
    let [q0, q1, q2, q3, w1, w2, w3] = graph.symbols(["q0", "q1", "q2", "q3", "ω1", "ω2", "ω3"]);
    let (q, w) = ([q0, q1, q2, q3], [w1, w2, w3]);
    let quadratic: Vec<Expr<'_>> = (0..4).flat_map(|i| (i..4).map(move |j| q[i] * q[j])).collect();
    assert_eq!(quadratic.len(), 10);
    let rotation = [
        [q0 * q0 + q1 * q1 - q2 * q2 - q3 * q3, 2.0 * (q1 * q2 - q0 * q3), 2.0 * (q1 * q3 + q0 * q2)],
        [2.0 * (q1 * q2 + q0 * q3), q0 * q0 - q1 * q1 + q2 * q2 - q3 * q3, 2.0 * (q2 * q3 - q0 * q1)],
        [2.0 * (q1 * q3 - q0 * q2), 2.0 * (q2 * q3 + q0 * q1), q0 * q0 - q1 * q1 - q2 * q2 + q3 * q3],
    ];
    let spin = inertia().map(|row| graph.dot(row, w));
    let moment = rotation.map(|row| graph.dot(row, spin));
    let norm: Expr<'_> = q.map(Expr::square).into_iter().sum();

    // 30 products q_i q_j ω_s: exactly three dimensions of their span are integrals.
    let rates = Rates::poincare(&body.poincare().unwrap());
    let products: Vec<Expr<'_>> = w.iter().flat_map(|&w| quadratic.iter().map(move |&f| f * w)).collect();
    let linear = rates.integrals_among(&products).unwrap();
    assert_eq!(linear.len(), 3, "{linear:?}");
    all_conserved(&rates, &linear);
    // The moments are combinations of the results with numerical coefficients: they add nothing to the span.
    let columns: Vec<_> = linear.iter().chain(&moment).map(|&f| vec![f]).collect();
    assert_eq!(graph.linear_relations(&columns[3..]).len(), 0);
    assert_eq!(graph.linear_relations(&columns).len(), 3);

    // For the ten functions alone, |q|² is the fourth integral, and the ansatz returns these four.
    let found = rates.integrals(&Ansatz { degree: 1, functions: quadratic, known: Vec::new() }).unwrap();
    assert_eq!(found.len(), 4, "{found:?}");
    all_conserved(&rates, &found);
    assert!(found.contains(&norm));
    assert!(moment.iter().all(|&component| is_function_of(&graph, component, &found)));
}

/// A charge in the uniform field B, in polar coordinates with η = (ρ̇, ρφ̇): p_φ = ρη_2 + ½Bρ², also where B depends
/// on time and its rate pushes the charge.
#[test]
fn a_charge_in_a_field_keeps_its_canonical_momentum() {
    let graph = Graph::new();
    let [t, rho, along, across] = graph.symbols(["t", "ρ", "η1", "η2"]);
    for field in [Expr::from(2.0), 1.0 + t.sin() / 2.0] {
        let charge = System::builder(&graph)
            .coordinates(["ρ", "φ"])
            .quasi_velocities(["η1", "η2"])
            .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
            .lagrangian(|_, x, eta| (eta[0].square() + eta[1].square()) / 2.0 + field * x[0] * eta[1] / 2.0)
            .build()
            .unwrap();
        let momentum = rho * across + field * rho.square() / 2.0;
        let steady = !field.depends_on(t);
        let rates = Rates::poincare(&charge.poincare().unwrap());
        let functions = [Expr::ONE, rho, rho.square(), field, field * rho, field * rho.square()];
        let functions: Vec<Expr<'_>> = functions[..if steady { 3 } else { 6 }].to_vec();
        let linear =
            rates.integrals(&Ansatz { degree: 1, functions: functions.clone(), known: Vec::new() }).unwrap();
        assert_eq!(linear.len(), 1, "{linear:?}");
        all_conserved(&rates, &linear);
        let proportional = graph.linear_relations(&[vec![linear[0]], vec![momentum]]);
        assert_eq!(proportional.len(), 1, "{}", linear[0]);
        // The speed is kept where no field is induced.
        let found = rates.integrals(&Ansatz { degree: 2, functions, known: linear.clone() }).unwrap();
        let speed = along.square() + across.square();
        assert_eq!(found.len(), usize::from(steady), "{found:?}");
        assert!(!steady || is_function_of(&graph, speed, &[linear[0], found[0]]));
    }
}

/// Integrals that exist for special values only are found, also where these values are no short rationals, and are said to
/// hold for them: the spin of a free body with two equal moments of inertia, given by two parameters.
#[test]
fn special_values_have_integrals_of_their_own() {
    for moment in [0.7, 2f64.sqrt()] {
        let graph = Graph::new();
        let [a, b, c] = graph.symbols(["A", "B", "C"]);
        let top = System::builder(&graph)
            .parameter(a, moment)
            .parameter(b, moment)
            .parameter(c, std::f64::consts::PI)
            .quasi_velocities(["ω1", "ω2", "ω3"])
            .algebra(&LieAlgebra::so3())
            .lagrangian(|_, _, w| (a * w[0].square() + b * w[1].square() + c * w[2].square()) / 2.0)
            .build()
            .unwrap();
        let at = ["t", "ω1", "ω2", "ω3"].map(|name| (graph.symbol(name), 0.5));
        let centre = at.into_iter().chain(top.parameters().iter().copied()).collect();
        let found = Integrals::find(&top.poincare().unwrap(), &Neighbourhood { centre });
        let here = |f: &&Integral<'_>| f.verdict == ConservationVerdict::ConservedHere;
        let here: Vec<String> = found.list().iter().filter(here).map(|f| f.value.to_string()).collect();
        assert_eq!(here, ["C*ω3"], "{moment}");
    }
}
