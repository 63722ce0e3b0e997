//! Whether new variables are canonical.

use pc_analysis::PoissonBracket;
use pc_mech::{Expr, Graph, LieAlgebra, System};

fn plane(graph: &Graph) -> PoissonBracket<'_> {
    let system = System::builder(graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    PoissonBracket::new(&system)
}

#[test]
fn polar_coordinates_are_canonical() {
    let graph = Graph::new();
    let [x, y, p, q] = graph.symbols(["x", "y", "p_x", "p_y"]);
    let r = (x.square() + y.square()).sqrt();
    let found =
        plane(&graph).canonical_variables(&[r, y.atan2(x)], &[(x * p + y * q) / r, x * q - y * p]).unwrap();
    assert!(found.are_canonical() && found.are_complete);
    assert_eq!(found.multiplier, Expr::ONE);
    // One pair alone is canonical, but does not determine the state.
    let found = plane(&graph).canonical_variables(&[r], &[(x * p + y * q) / r]).unwrap();
    assert!(found.are_canonical() && !found.are_complete);
}

/// MᵀJM = c J with c = a b.
#[test]
fn units_are_a_multiplier() {
    let graph = Graph::new();
    let [x, y, p, q, a, b] = graph.symbols(["x", "y", "p_x", "p_y", "a", "b"]);
    let bracket = plane(&graph).with_constants([a, b]);
    let found = bracket.canonical_variables(&[a * y, a * x], &[b * q, b * p]).unwrap();
    assert!(found.are_canonical());
    assert_eq!(found.multiplier, a * b);
    // Different units along x and y do not have one.
    let found = bracket.canonical_variables(&[a * x, a * y], &[b * p, a * q]).unwrap();
    assert_eq!(found.multiplier, a * b);
    let [violation] = found.violations[..] else { panic!("{found:?}") };
    assert_eq!((violation.pair, violation.value, violation.expected), ([1, 3], a.square(), a * b));
}

#[test]
fn what_fails_is_named() {
    let graph = Graph::new();
    let [x, y, p, q] = graph.symbols(["x", "y", "p_x", "p_y"]);
    let found = plane(&graph).canonical_variables(&[x, y + p], &[p, q * y]).unwrap();
    assert!(!found.are_canonical());
    let failed: Vec<_> = found.violations.iter().map(|v| (v.pair, v.value.to_string())).collect();
    assert_eq!(failed, [([0, 1], "1".to_owned()), ([1, 3], "y".to_owned())]);
    let error = plane(&graph).canonical_variables(&[x, y], &[p]).unwrap_err();
    assert_eq!(error.to_string(), "the list of new momenta has 1 entries where 2 are needed");
}

/// The variables of Serret and Andoyer on the spheres of the angular momentum of a body: with (y_1, y_2) = y_3, the angle
/// atan(y_2, y_1) and the component y_3, in the opposite order in body axes.
#[test]
fn andoyers_variables_on_a_degenerate_bracket() {
    let graph = Graph::new();
    let bracket = PoissonBracket::lie_poisson(&graph, &LieAlgebra::so3());
    let [y1, y2, y3] = graph.symbols(["y1", "y2", "y3"]);
    let found = bracket.canonical_variables(&[y2.atan2(y1)], &[y3]).unwrap();
    assert!(found.are_canonical() && found.are_complete);
    assert!(found.multiplier == Expr::ONE || found.multiplier == -Expr::ONE);
    let body = bracket.canonical_variables(&[y1.atan2(y2)], &[y3]).unwrap();
    assert_eq!(body.multiplier, -found.multiplier);
}

/// A generating function of the second kind, F = x P + ε x² P²: p = ∂F/∂x, X = ∂F/∂P give canonical variables; to first order
/// in ε alone they are not.
#[test]
fn a_generating_function_makes_canonical_variables() {
    let graph = Graph::new();
    let system =
        System::builder(&graph).coordinates(["x"]).lagrangian(|_, _, v| v[0].square() / 2.0).build().unwrap();
    let [x, p, e] = graph.symbols(["x", "p_x", "ε"]);
    let bracket = PoissonBracket::new(&system).with_constants([e]);
    // p = P + 2 ε x P²
    let new_p = ((1.0 + 8.0 * e * x * p).sqrt() - 1.0) / (4.0 * e * x);
    let new_x = x + 2.0 * e * x.square() * new_p;
    assert!(bracket.canonical_variables(&[new_x], &[new_p]).unwrap().are_canonical());
    let first = bracket
        .canonical_variables(&[x + 2.0 * e * x.square() * p], &[p - 2.0 * e * x * p.square()])
        .unwrap();
    assert!(!first.are_canonical());
}
