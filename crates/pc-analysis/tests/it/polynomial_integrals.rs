//! Integrals that are polynomials in the velocities over a span of functions, and the fields they belong to.

use pc_analysis::{AnsatzSearch, Integral, Integrals, NoetherField, Origin, PolynomialAnsatz};
use pc_mech::{Equations, Expr, Graph, Neighbourhood, System};

/// The integrals that the ansatz adds to those known without it.
fn found<'g>(
    equations: &Equations<'g>,
    degree: u32,
    functions: Vec<Expr<'g>>,
) -> (Vec<Integral<'g>>, AnsatzSearch) {
    let graph = equations.system().graph();
    let state = equations.system().state().into_iter().chain([graph.symbol("t")]);
    let near = Neighbourhood { centre: state.zip([0.7, -0.4, 0.9, 0.3, 0.8, -0.5, 0.0]).collect() };
    let mut all = Integrals::known(equations, &near);
    let ansatz = PolynomialAnsatz { functions, ..PolynomialAnsatz::of_degree(degree) };
    let made = all.add_polynomials(equations, &near, &ansatz).unwrap();
    assert!(all.list().iter().all(Integral::is_conserved), "{all:?}");
    (all.list().iter().filter(|integral| integral.origin == Origin::Found).cloned().collect(), made)
}

fn texts(found: &[Integral<'_>]) -> Vec<String> {
    found.iter().map(|integral| integral.value.to_string()).collect()
}

/// Whether f/g is independent of all variables.
fn is_multiple<'g>(graph: &'g Graph, f: Expr<'g>, g: Expr<'g>) -> bool {
    let moving = graph.symbols(["x", "y", "z", "x'", "y'", "z'"]);
    graph.gradient(f / g, &moving).iter().all(|slope| slope.is_zero())
}

fn oscillator<'g>(graph: &'g Graph, stiffness: [f64; 2]) -> Equations<'g> {
    let [m, k1, k2] = graph.symbols(["m", "k1", "k2"]);
    System::builder(graph)
        .parameter(m, 2.0)
        .parameter(k1, stiffness[0])
        .parameter(k2, stiffness[1])
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| {
            m * (v[0].square() + v[1].square()) / 2.0 - (k1 * x[0].square() + k2 * x[1].square()) / 2.0
        })
        .build()
        .unwrap()
        .poincare()
        .unwrap()
}

#[test]
fn an_anisotropic_oscillator_keeps_two_energies() {
    let graph = Graph::new();
    let (list, made) = found(&oscillator(&graph, [3.0, 5.5]), 2, Vec::new());
    assert_eq!(texts(&list), ["m*x'^2 + k1*x^2", "m*y'^2 + k2*y^2"]);
    assert_eq!([list[0].dependent, list[1].dependent], [false, true], "with the energy there are two");
    assert!(matches!(made, AnsatzSearch::Made { coefficients: 4, functions: 89 }), "{made:?}");
}

/// Fradkin's tensor and the area, only for these values of the parameters unless they are equal by
/// definition.
#[test]
fn an_isotropic_oscillator_keeps_a_tensor() {
    let graph = Graph::new();
    let (list, _) = found(&oscillator(&graph, [3.0, 3.0]), 2, Vec::new());
    let found = texts(&list);
    assert!(found.contains(&"y*x' - x*y'".to_owned()), "{found:?}");
    assert_eq!(found.len(), 4, "{found:?}");
    assert_eq!(
        list.iter().filter(|integral| !integral.dependent).count(),
        2,
        "three of four, with the energy"
    );
}

/// A = ẋ × (x × ẋ) − (k/m) x/r, whose length is a function of area and energy.
#[test]
fn keplers_problem_keeps_the_vector_of_runge_and_lenz() {
    let graph = Graph::new();
    let [m, k] = graph.symbols(["m", "k"]);
    let x = graph.symbols(["x", "y", "z"]);
    let v = graph.symbols(["x'", "y'", "z'"]);
    let r = (x[0].square() + x[1].square() + x[2].square()).sqrt();
    let planet = System::builder(&graph)
        .parameter(m, 2.0)
        .parameter(k, 3.0)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| m * (v[0].square() + v[1].square() + v[2].square()) / 2.0 + k / r)
        .build()
        .unwrap();
    let (list, _) = found(&planet.poincare().unwrap(), 2, vec![1.0 / r]);
    let (speed, along) = (graph.dot(v, v), graph.dot(x, v));
    let lenz = [0, 1, 2].map(|i| speed * x[i] - along * v[i] - k / m * x[i] / r);
    let area = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| x[i] * v[j] - x[j] * v[i]);
    for expected in lenz.into_iter().chain(area) {
        let is_found = |f: &Integral<'_>| is_multiple(&graph, f.value, expected);
        assert!(list.iter().any(is_found), "{expected} is not among {:?}", texts(&list));
    }
    assert_eq!(list.len(), 6, "{:?}", texts(&list));
    // Of the seven, energy included, five are independent.
    assert_eq!(list.iter().filter(|integral| !integral.dependent).count(), 4);
    // Without the function that it contains it is not found.
    assert_eq!(found(&planet.poincare().unwrap(), 2, Vec::new()).0.len(), 3);
}

#[test]
fn functions_of_foreign_symbols_are_refused() {
    let graph = Graph::new();
    let equations = oscillator(&graph, [1.0, 2.0]);
    let near = Neighbourhood::default();
    let ansatz = PolynomialAnsatz { functions: vec![graph.symbol("s")], ..PolynomialAnsatz::of_degree(2) };
    let refusal = Integrals::known(&equations, &near).add_polynomials(&equations, &near, &ansatz);
    let message = refusal.unwrap_err().to_string();
    assert!(
        message.starts_with("`s` stands in a function along the motion, which can contain "),
        "{message}"
    );
}

/// A body in its own axes, in directions γ and Euler's angles: the rotations in space commute with the
/// operators of the body.
#[test]
fn rotations_in_space_commute_with_those_of_the_body() {
    let graph = Graph::new();
    let [a, c] = graph.symbols(["A", "C"]);
    let top = System::builder(&graph)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&pc_mech::LieAlgebra::so3())
        .lagrangian(|_, g, w| (a * (w[0].square() + w[1].square()) + c * w[2].square()) / 2.0 - g[2])
        .build()
        .unwrap();
    let canonical = top.canonical().unwrap();
    let [g1, g2, g3, w1, w2, w3] = graph.symbols(["γ1", "γ2", "γ3", "ω1", "ω2", "ω3"]);
    let area = NoetherField::of(&canonical, a * (g1 * w1 + g2 * w2) + c * g3 * w3).unwrap();
    assert_eq!((area.coefficients.as_slice(), area.commutes), ([g1, g2, g3].as_slice(), true));
    // The spin belongs to a symmetry of the body, whose operator does not commute with the others.
    let spin = NoetherField::of(&canonical, c * w3).unwrap();
    assert_eq!((spin.coefficients[2], spin.commutes), (Expr::ONE, false));
    assert!(
        NoetherField::of(&canonical, top.energy()).is_none() && NoetherField::of(&canonical, g3).is_none()
    );
}

/// In a uniform magnetic field, a translation changes L by a total derivative.
#[test]
fn translations_in_a_magnetic_field_have_a_gauge() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 + (x[0] * v[1] - x[1] * v[0]) / 2.0)
        .build()
        .unwrap();
    let [x, vy] = graph.symbols(["x", "y'"]);
    let field = NoetherField::of(&particle.canonical().unwrap(), vy + x).unwrap();
    assert_eq!(field.coefficients, [Expr::ZERO, Expr::ONE]);
    assert_eq!((field.gauge, field.commutes), (x / 2.0, true));
}

/// A particle of mass 1 with this potential.
fn in_plane<'g>(graph: &'g Graph, potential: Expr<'g>) -> Equations<'g> {
    let builder = System::builder(graph).coordinates(["x", "y"]);
    let system = builder.lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0 - potential);
    system.build().unwrap().poincare().unwrap()
}

/// Constants in the text that are rounded stand for any value: an oscillator of stiffness √2, and Kepler's problem.
#[test]
fn rounded_constants_are_no_obstacle() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let square = x.square() + y.square();
    let (oscillating, _) = found(&in_plane(&graph, 2f64.sqrt() * square / 2.0), 2, Vec::new());
    let (planet, _) =
        found(&in_plane(&graph, -std::f64::consts::PI / square.sqrt()), 2, vec![1.0 / square.sqrt()]);
    assert_eq!(texts(&oscillating).len(), 4, "{oscillating:?}");
    assert_eq!(texts(&planet).len(), 3, "{planet:?}");
}
