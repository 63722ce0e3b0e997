//! Casimirs of Lie–Poisson brackets and of the heavy top.
//!
//! Three-dimensional algebras: J. Patera, R. T. Sharp, P. Winternitz, H. Zassenhaus, *Invariants of real low
//! dimension Lie algebras*, J. Math. Phys. 17 (1976) 986, have a table of them. Every invariant here is
//! proved by the bracket itself.

use pc_analysis::PoissonBracket;
use pc_mech::{Expr, Graph, LieAlgebra, Number, System};

fn bracket<'g>(graph: &'g Graph, name: &str) -> PoissonBracket<'g> {
    PoissonBracket::lie_poisson(graph, &LieAlgebra::named(name).unwrap())
}

fn found(name: &str, degree: u32) -> Vec<String> {
    let graph = Graph::new();
    bracket(&graph, name).casimirs(degree).iter().map(Expr::to_string).collect()
}

#[test]
fn polynomial_casimirs_of_bianchi_algebras() {
    let table: [(&str, &[&str]); 11] = [
        ("bianchi1", &["y1", "y2", "y3"]),
        ("bianchi2", &["y1"]),
        ("bianchi3", &["y2 - y3"]),
        ("bianchi4", &[]),
        ("bianchi5", &[]),
        ("bianchi6", &["y2^2 - y3^2"]),
        ("bianchi6(-4)", &[]),
        ("bianchi7", &["y2^2 + y3^2"]),
        ("bianchi7(1)", &[]),
        ("bianchi8", &["y1^2 + y2^2 - y3^2"]),
        ("bianchi9", &["y1^2 + y2^2 + y3^2"]),
    ];
    for (name, expected) in table {
        let shown: Vec<String> = found(name, 2);
        assert_eq!(shown, expected, "{name}");
        let graph = Graph::new();
        let corank = bracket(&graph, name).corank();
        assert_eq!(corank, if name == "bianchi1" { 3 } else { 1 }, "{name}");
        assert_eq!(corank, LieAlgebra::named(name).unwrap().index().unwrap(), "{name}");
    }
}

/// Casimirs that are not polynomials, or of higher degree: with u = y2 + y3 and v = y2 − y3 for type VI, h =
/// −a².
#[test]
fn other_casimirs_of_bianchi_algebras() {
    let graph = Graph::new();
    let [y1, y2, y3] = graph.symbols(["y1", "y2", "y3"]);
    let (u, v) = (y2 + y3, y2 - y3);
    let radius = y2.square() + y3.square();
    for (name, casimir) in [
        ("bianchi4", y3 * (y2 / y3).exp()),
        ("bianchi5", y2 / y3),
        ("bianchi6(-4)", v.powi(3) / u),  // u^(1−a) v^(1+a), a = 2
        ("bianchi6(-9)", v.square() / u), // its root, a = 3
        ("bianchi7(1)", radius.log() - 2.0 * y3.atan2(y2)), // log |y|² − 2a arg y, a = 1
        ("bianchi7(1/4)", radius.log() - y3.atan2(y2)),
    ] {
        let bracket = bracket(&graph, name);
        assert!(bracket.is_casimir(casimir).unwrap(), "{name}: {casimir}");
        assert!(!bracket.is_casimir(y1).unwrap() && !bracket.is_casimir(casimir * y2).unwrap(), "{name}");
    }
    // a = 1/3: u²ᐟ³ v⁴ᐟ³ is the root of a polynomial.
    let third = bracket(&graph, "bianchi6(-1/9)");
    assert!(third.casimirs(2).is_empty());
    let cubic = third.casimirs(3);
    assert_eq!(cubic.len(), 1);
    assert_eq!(cubic[0], u * v.square());
    // Rational Casimirs of type V, from an ansatz: numerators and denominators.
    let five = bracket(&graph, "bianchi5");
    assert_eq!(five.casimirs_among(&[y1 / y2, y3 / y2, y3 / y1]).unwrap(), [y3 / y2]);
}

/// The indecomposable algebras A_3,1 to A_3,9 in the notation of Patera and others; of A_3,7 the real
/// logarithm.
#[test]
fn the_table_of_three_dimensional_algebras() {
    let graph = Graph::new();
    let [e1, e2, e3] = graph.symbols(["y1", "y2", "y3"]);
    let a = 3;
    type Brackets<'a> = &'a [(usize, usize, [i32; 3])];
    let table: [(Brackets<'_>, Expr<'_>, usize); 9] = [
        (&[(2, 3, [1, 0, 0])], e1, 1),
        (&[(1, 3, [1, 0, 0]), (2, 3, [1, 1, 0])], e1 * (-e2 / e1).exp(), 0),
        (&[(1, 3, [1, 0, 0]), (2, 3, [0, 1, 0])], e2 / e1, 0),
        (&[(1, 3, [1, 0, 0]), (2, 3, [0, -1, 0])], e1 * e2, 1),
        (&[(1, 3, [1, 0, 0]), (2, 3, [0, a, 0])], e2 / e1.powi(a), 0),
        (&[(1, 3, [0, -1, 0]), (2, 3, [1, 0, 0])], e1.square() + e2.square(), 1),
        (
            &[(1, 3, [a, -1, 0]), (2, 3, [1, a, 0])],
            (e1.square() + e2.square()).log() - Expr::from(2 * a) * e2.atan2(e1),
            0,
        ),
        (&[(1, 2, [1, 0, 0]), (2, 3, [0, 0, 1]), (1, 3, [0, -2, 0])], 2.0 * e2.square() + 2.0 * e1 * e3, 1),
        (
            &[(1, 2, [0, 0, 1]), (2, 3, [1, 0, 0]), (1, 3, [0, -1, 0])],
            e1.square() + e2.square() + e3.square(),
            1,
        ),
    ];
    for (number, (brackets, casimir, polynomials)) in table.into_iter().enumerate() {
        let constant = |r: usize, s: usize, m: usize| {
            let listed = |r: usize, s: usize| brackets.iter().find(|b| (b.0, b.1) == (r + 1, s + 1));
            let entry = |r, s| listed(r, s).map_or(0, |b| b.2[m]);
            Number::integer(entry(r, s) - entry(s, r))
        };
        let bracket = PoissonBracket::lie_poisson(&graph, &LieAlgebra::new(3, constant).unwrap());
        assert!(bracket.is_casimir(casimir).unwrap(), "A_3,{}", number + 1);
        assert_eq!(bracket.corank(), 1);
        assert_eq!(bracket.casimirs(2).len(), polynomials, "A_3,{}", number + 1);
    }
}

#[test]
fn casimirs_of_larger_algebras() {
    assert_eq!(found("se3", 2), ["y1*y4 + y2*y5 + y3*y6", "y4^2 + y5^2 + y6^2"]);
    assert_eq!(found("heisenberg5", 2), ["y5"]);
    assert_eq!(found("gl2", 2), ["y1 + y4", "y1*y4 - y2*y3"]);
    assert_eq!(found("so4", 2).len(), 2);
    // so(5) has index 2, with Casimirs of degree 2 and 4.
    assert_eq!(found("so5", 2).len(), 1);
    assert!(found("aff1", 2).is_empty());
}

/// |γ|² and the area integral γ·y of the heavy top, for any Lagrangian.
#[test]
fn the_top_has_two() {
    let graph = Graph::new();
    let top = System::builder(&graph)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| (w[0].square() + 2.0 * w[1].square() + w[2].square()) / 2.0 - g[0] - g[2])
        .build()
        .unwrap();
    let bracket = PoissonBracket::new(&top);
    assert_eq!((bracket.rank(), bracket.corank()), (4, 2));
    let found: Vec<String> = bracket.casimirs(2).iter().map(Expr::to_string).collect();
    assert_eq!(found, ["γ1^2 + γ2^2 + γ3^2", "γ1*p_ω1 + γ2*p_ω2 + γ3*p_ω3"]);
}

/// Where the frame is regular there are none.
#[test]
fn a_regular_bracket_has_none() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["r", "φ"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
        .lagrangian(|_, x, eta| (eta[0].square() + eta[1].square()) / 2.0 + 1.0 / x[0])
        .build()
        .unwrap();
    assert_eq!(PoissonBracket::new(&particle).corank(), 0);
    assert!(PoissonBracket::new(&particle).casimirs(2).is_empty());
    assert_eq!(PoissonBracket::extended(&particle).corank(), 0);
}
