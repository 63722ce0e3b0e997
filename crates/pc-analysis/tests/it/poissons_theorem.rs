//! Poisson's theorem: the brackets of integrals, and whether integrals suffice.

use crate::common::in_eulers_angles;
use pc_analysis::{BracketAlgebra, BracketMeaning, DenotedFunction, PoissonBracket, Rates};
use pc_mech::{Expr, Graph, LieAlgebra, System};

/// The functions under the symbols with these names.
fn denoted<'g, const N: usize>(
    graph: &'g Graph,
    names: [&str; N],
    values: [Expr<'g>; N],
) -> Vec<DenotedFunction<'g>> {
    names
        .iter()
        .zip(values)
        .map(|(name, value)| DenotedFunction { symbol: graph.symbol(name), value })
        .collect()
}

/// The brackets that are not zero, as texts.
fn nonzero(algebra: &BracketAlgebra<'_>) -> Vec<String> {
    let name = |i: usize| algebra.functions()[i].symbol;
    let shown = algebra.pairs().iter().filter(|pair| !pair.value.is_zero()).map(|pair| {
        let [i, j] = pair.pair;
        let right = match pair.meaning {
            BracketMeaning::Polynomial(polynomial) => polynomial.to_string(),
            BracketMeaning::New(place) => format!("new {}", name(place)),
            other => format!("{other:?}"),
        };
        format!("({}, {}) = {right}", name(i), name(j))
    });
    shown.collect()
}

/// A planet of mass m in the potential −k/r.
fn planet<'g>(graph: &'g Graph) -> System<'g> {
    let [m, k] = graph.symbols(["m", "k"]);
    System::builder(graph)
        .parameter(m, 2.0)
        .parameter(k, 3.0)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| {
            let square = |v: &[Expr<'g>]| v[0].square() + v[1].square() + v[2].square();
            m * square(v) / 2.0 + k / square(x).sqrt()
        })
        .build()
        .unwrap()
}

/// The angular momentum and the vector of Laplace, Runge and Lenz, A = p × K − m k r/|r|.
fn vectors(graph: &Graph) -> ([Expr<'_>; 3], [Expr<'_>; 3]) {
    let [x, y, z, p, q, r, m, k] = graph.symbols(["x", "y", "z", "p_x", "p_y", "p_z", "m", "k"]);
    let angular = [y * r - z * q, z * p - x * r, x * q - y * p];
    let size = (x.square() + y.square() + z.square()).sqrt();
    let lenz = [
        q * angular[2] - r * angular[1] - m * k * x / size,
        r * angular[0] - p * angular[2] - m * k * y / size,
        p * angular[1] - q * angular[0] - m * k * z / size,
    ];
    (angular, lenz)
}

/// (K_i, K_j) = ε_ijk K_k, (K_i, A_j) = ε_ijk A_k, (A_i, A_j) = −2 m H ε_ijk K_k [Goldstein, Classical Mechanics, 3rd ed., §9.7]:
/// so(4) where H < 0.
#[test]
fn the_integrals_of_a_planet_form_so4() {
    let graph = Graph::new();
    let planet = planet(&graph);
    let canonical = planet.canonical().unwrap();
    let ([k1, k2, k3], [a1, a2, a3]) = vectors(&graph);
    let names = ["H", "K1", "K2", "K3", "A1", "A2", "A3"];
    let given = denoted(&graph, names, [canonical.hamiltonian(), k1, k2, k3, a1, a2, a3]);
    let bracket = PoissonBracket::new(&planet);
    let algebra = bracket.algebra(&given, &[]).unwrap();
    assert!(algebra.is_closed() && !algebra.is_commutative());
    assert_eq!(
        nonzero(&algebra),
        [
            "(K1, K2) = K3",
            "(K1, K3) = -K2",
            "(K1, A2) = A3",
            "(K1, A3) = -A2",
            "(K2, K3) = K1",
            "(K2, A1) = -A3",
            "(K2, A3) = A1",
            "(K3, A1) = A2",
            "(K3, A2) = -A1",
            "(A1, A2) = -2*m*H*K3",
            "(A1, A3) = 2*m*H*K2",
            "(A2, A3) = -2*m*H*K1",
        ]
    );
    // Five of the seven are independent; closed orbits are tori of dimension 1.
    let values: Vec<Expr<'_>> = given.iter().map(|f| f.value).collect();
    let found = bracket.integrability(&values).unwrap();
    assert_eq!((found.independent, found.bracket_rank, found.leaf, found.torus()), (5, 4, 6, Some(1)));
    // Energy, a component of the angular momentum and its square are in involution (Liouville).
    let found = bracket.integrability(&[values[0], k3, k1.square() + k2.square() + k3.square()]).unwrap();
    assert_eq!((found.independent, found.bracket_rank, found.torus()), (3, 0, Some(3)));
    assert_eq!(bracket.integrability(&[values[0], k3]).unwrap().torus(), None);
}

/// Two components of the angular momentum and one of Lenz's vector bring the others, which are integrals.
#[test]
fn brackets_of_integrals_are_new_integrals() {
    let graph = Graph::new();
    let planet = planet(&graph);
    let rates = Rates::canonical(&planet.canonical().unwrap());
    let ([k1, k2, k3], [a1, a2, a3]) = vectors(&graph);
    let bracket = PoissonBracket::new(&planet);
    let new = graph.symbols(["N1", "N2", "N3"]);
    let algebra = bracket.algebra(&denoted(&graph, ["K1", "K2"], [k1, k2]), &new).unwrap();
    assert_eq!(nonzero(&algebra), ["(K1, K2) = new N1", "(K1, N1) = -K2", "(K2, N1) = K1"]);
    assert_eq!(algebra.new_functions()[0].value, k3);

    let algebra = bracket.algebra(&denoted(&graph, ["K1", "K2", "A2"], [k1, k2, a2]), &new).unwrap();
    let values: Vec<Expr<'_>> = algebra.new_functions().iter().map(|f| f.value).collect();
    assert_eq!(values, [k3, a3]);
    assert!(values.iter().all(|&f| rates.verdict(f).unwrap().is_conserved()));
    // The last component is a function of these five: of K, A2, A3, by A · K = 0.
    let seen = nonzero(&algebra);
    assert!(seen.contains(&"(K2, N2) = Dependent".to_owned()), "{seen:?}");
    let pair = algebra.pairs().iter().find(|pair| pair.pair == [1, 4]).unwrap();
    assert_eq!(pair.value, a1);
    // Without symbols for new functions they stay undecided.
    let algebra = bracket.algebra(&denoted(&graph, ["K1", "K2"], [k1, k2]), &[]).unwrap();
    assert_eq!(nonzero(&algebra), ["(K1, K2) = Undecided"]);
    assert!(!algebra.is_closed());
}

/// The angular momentum of a body: so(3) in space, (M_i, M_j) = ε_ijk M_k; in the body with the opposite sign; each component in
/// space commutes with each in the body [Arnold, Mathematical Methods of Classical Mechanics, app. 2].
#[test]
fn the_angular_momenta_of_a_body_in_space_and_in_the_body() {
    let graph = Graph::new();
    let body = in_eulers_angles(&graph)
        .lagrangian(|_, _, w| w[0].square() / 2.0 + w[1].square() + 1.5 * w[2].square())
        .build()
        .unwrap();
    let [psi, theta, phi, p1, p2, p3] = graph.symbols(["ψ", "θ", "φ", "p_ω1", "p_ω2", "p_ω3"]);
    let across = p1 * phi.sin() + p2 * phi.cos();
    let along_nodes = p1 * phi.cos() - p2 * phi.sin();
    let tilted = across * theta.cos() - p3 * theta.sin();
    let space = [
        along_nodes * psi.cos() - tilted * psi.sin(),
        along_nodes * psi.sin() + tilted * psi.cos(),
        across * theta.sin() + p3 * theta.cos(),
    ];
    let [m1, m2, m3] = space;
    let names = ["M1", "M2", "M3", "L1", "L2", "L3"];
    let bracket = PoissonBracket::new(&body);
    let algebra = bracket.algebra(&denoted(&graph, names, [m1, m2, m3, p1, p2, p3]), &[]).unwrap();
    assert_eq!(
        nonzero(&algebra),
        [
            "(M1, M2) = M3",
            "(M1, M3) = -M2",
            "(M2, M3) = M1",
            "(L1, L2) = -L3",
            "(L1, L3) = L2",
            "(L2, L3) = -L1",
        ]
    );
    // The free motion: two frequencies in six dimensions, for M does not commute.
    let h = body.canonical().unwrap().hamiltonian();
    let found = bracket.integrability(&[h, m1, m2, m3]).unwrap();
    assert_eq!((found.independent, found.bracket_rank, found.torus()), (4, 2, Some(2)));
}

/// In a degenerate bracket Casimirs commute with all functions, and are no fields.
#[test]
fn casimirs_do_not_count() {
    let graph = Graph::new();
    let bracket = PoissonBracket::lie_poisson(&graph, &LieAlgebra::so3());
    let [x, y, z] = graph.symbols(["y1", "y2", "y3"]);
    let square = x.square() + y.square() + z.square();
    let energy = x.square() + 2.0 * y.square() + 3.0 * z.square();
    let algebra = bracket.algebra(&denoted(&graph, ["C", "H"], [square, energy]), &[]).unwrap();
    assert!(algebra.is_commutative());
    let found = bracket.integrability(&[square, energy]).unwrap();
    assert_eq!((found.independent, found.leaf, found.torus()), (1, 2, Some(1)));
}

/// Parameters may stand in the coefficients: a charge in a field B, (P, Q) = −B.
#[test]
fn coefficients_are_functions_of_parameters() {
    let graph = Graph::new();
    let [b, m, x, y, p, q] = graph.symbols(["B", "m", "x", "y", "p_x", "p_y"]);
    let charge = System::builder(&graph)
        .parameter(b, 2.0)
        .parameter(m, 3.0)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| {
            m * (v[0].square() + v[1].square()) / 2.0 + b * (x[0] * v[1] - x[1] * v[0]) / 2.0
        })
        .build()
        .unwrap();
    let canonical = charge.canonical().unwrap();
    let rates = Rates::canonical(&canonical);
    // The centre of the circle times B, and the angular momentum.
    let centre = [p - b * y / 2.0, q + b * x / 2.0];
    let turn = x * q - y * p;
    assert!([centre[0], centre[1], turn].iter().all(|&f| rates.verdict(f).unwrap().is_conserved()));
    let given = denoted(&graph, ["P", "Q", "J"], [centre[0], centre[1], turn]);
    let algebra = PoissonBracket::new(&charge).algebra(&given, &[]).unwrap();
    assert_eq!(nonzero(&algebra), ["(P, Q) = -B", "(P, J) = -Q", "(Q, J) = P"]);
}

#[test]
fn other_symbols_are_refused() {
    let graph = Graph::new();
    let bracket = PoissonBracket::new(&planet(&graph));
    let error = bracket.algebra(&denoted(&graph, ["F"], [graph.symbol("x'")]), &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`x'` stands in a function in a Poisson bracket, which can contain `x`, `y`, `z`, `p_x`, `p_y`, `p_z`, `t`, `m`, `k`"
    );
}
