//! Poisson brackets (12) and their extension by time.

use crate::common::{self, top_of_parameters};
use pc_analysis::{PoissonBracket, Rates};
use pc_mech::{Expr, Graph, LieAlgebra, System};
use proptest::prelude::*;

/// The frame of meridian and parallel on the sphere: c_12^2 = −cot θ is not constant.
fn sphere(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["θ", "φ"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| [eta[0], eta[1] / x[0].sin()])
        .lagrangian(|_, x, eta| (eta[0].square() + eta[1].square()) / 2.0 - 3.0 * x[0].cos())
        .build()
        .unwrap()
}

/// A driven frame: b, b_0 and L depend on time, b_0 ≠ 0 and c_0s ≠ 0, L has terms linear in η.
fn driven(graph: &Graph) -> System<'_> {
    common::driven(graph)
        .lagrangian(|t, x, eta| {
            let kinetic = (eta[0].square() + t * eta[0] * eta[1] + 3.0 * eta[1].square()) / 2.0;
            kinetic + t * x[1] * eta[0] + x[0] * eta[1] - x[0].square() * x[1] / 2.0
        })
        .build()
        .unwrap()
}

#[test]
fn the_bracket_generates_stationary_motion() {
    let graph = Graph::new();
    for system in [top_of_parameters(&graph).build().unwrap(), sphere(&graph)] {
        let canonical = system.canonical().unwrap();
        let field = PoissonBracket::new(&system).field(canonical.hamiltonian()).unwrap();
        let expected: Vec<Expr<'_>> =
            canonical.velocities().iter().chain(canonical.right_hand_side()).copied().collect();
        assert_eq!(field, expected);
    }
}

/// (10) and (11) with b_0 ≠ 0, c_0s ≠ 0, all depending on time; ẏ_0 = −dH/dt.
#[test]
fn the_extended_bracket_generates_every_motion() {
    let graph = Graph::new();
    for system in [driven(&graph), top_of_parameters(&graph).build().unwrap()] {
        let canonical = system.canonical().unwrap();
        let bracket = PoissonBracket::extended(&system);
        let y0 = bracket.time_momentum().unwrap();
        let h = canonical.hamiltonian();
        let field = bracket.field(h + y0).unwrap();
        let n = system.frame().coordinates().len();
        assert_eq!(field[0], Expr::ONE);
        assert_eq!(field[1..=n], *canonical.velocities());
        assert_eq!(field[n + 2..], *canonical.right_hand_side());
        let z: Vec<_> = bracket.variables().iter().copied().zip(field.iter().copied()).collect();
        assert_eq!(field[n + 1], -graph.directional(&[h], &z)[0]);
    }
    // df/dt = (f, H + y_0)
    let driven = driven(&graph);
    let canonical = driven.canonical().unwrap();
    let bracket = PoissonBracket::extended(&driven);
    let [t, x, p] = graph.symbols(["t", "x", "p_u"]);
    let f = t.square() * x * p + x.sin() * p.square() - t.cos();
    let h = canonical.hamiltonian() + bracket.time_momentum().unwrap();
    assert_eq!(bracket.of(f, h).unwrap(), Rates::canonical(&canonical).of(f).unwrap());
    assert!(driven.frame().b0().iter().all(|b| !b.is_zero()));
    assert!(driven.structure().nonzero().any(|(r, ..)| r == 0));
    // (12) alone does not generate it.
    let field = PoissonBracket::new(&driven).field(canonical.hamiltonian()).unwrap();
    assert_ne!(field[..2], *canonical.velocities());
    assert_ne!(field[2..], *canonical.right_hand_side());
}

#[test]
fn the_tensor_is_that_of_the_variables() {
    let graph = Graph::new();
    let bracket = PoissonBracket::new(&top_of_parameters(&graph).build().unwrap());
    let names: Vec<String> = bracket.variables().iter().map(Expr::to_string).collect();
    assert_eq!(names, ["γ1", "γ2", "γ3", "p_ω1", "p_ω2", "p_ω3"]);
    let shown: Vec<String> = bracket.tensor().row(3).iter().map(Expr::to_string).collect();
    assert_eq!(shown, ["0", "-γ3", "γ2", "0", "-p_ω3", "p_ω2"]);
    assert_eq!((bracket.rank(), bracket.corank()), (4, 2));
    let names: Vec<String> =
        PoissonBracket::extended(&driven(&graph)).variables().iter().map(Expr::to_string).collect();
    assert_eq!(names, ["t", "x", "y", "p_t", "p_u", "p_v"]);
}

/// Angular momenta about fixed axes generate each other (Poisson's theorem).
#[test]
fn integrals_generate_integrals() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
        .build()
        .unwrap();
    let [x, y, z, p, q, r] = graph.symbols(["x", "y", "z", "p_x", "p_y", "p_z"]);
    let bracket = PoissonBracket::new(&particle);
    let [l1, l2, l3] = [y * r - z * q, z * p - x * r, x * q - y * p];
    assert_eq!(bracket.of(l1, l2).unwrap(), l3);
    assert_eq!(bracket.closure(&[l1, l2, l1 * l2]).unwrap(), [l1, l2, l3]);
    // With one more momentum all momenta follow, five independent functions in total.
    let generated = bracket.closure(&[p, l2, l3]).unwrap();
    assert_eq!(generated.len(), 5);
    let rates = Rates::canonical(&particle.canonical().unwrap());
    assert!(generated.iter().all(|&f| rates.verdict(f).unwrap().is_conserved()));
}

/// Σ c z_i z_j over random pairs, with linear terms.
fn polynomial<'g>(bracket: &PoissonBracket<'g>, terms: &[(i32, usize, usize)]) -> Expr<'g> {
    let z = bracket.variables();
    let term = |&(c, i, j): &(i32, usize, usize)| {
        let factor = if j % (z.len() + 1) == z.len() { Expr::ONE } else { z[j % (z.len() + 1)] };
        Expr::from(c) * z[i % z.len()] * factor
    };
    bracket.graph().sum(terms.iter().map(term))
}

fn terms() -> impl Strategy<Value = Vec<(i32, usize, usize)>> {
    prop::collection::vec((-5..6, 0usize..64, 0usize..64), 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        rng_seed: prop::test_runner::RngSeed::Fixed(12),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn brackets_are_skew_and_obey_jacobi(f in terms(), g in terms(), h in terms()) {
        let graph = Graph::new();
        let brackets = [
            PoissonBracket::new(&top_of_parameters(&graph).build().unwrap()),
            PoissonBracket::new(&sphere(&graph)),
            PoissonBracket::new(&driven(&graph)),
            PoissonBracket::extended(&driven(&graph)),
            PoissonBracket::lie_poisson(&graph, &LieAlgebra::se3()),
        ];
        for bracket in brackets {
            let [f, g, h] = [&f, &g, &h].map(|terms| polynomial(&bracket, terms));
            prop_assert_eq!(bracket.of(f, g).unwrap(), -bracket.of(g, f).unwrap());
            prop_assert_eq!(bracket.of(f, g * h).unwrap(), bracket.of(f, g).unwrap() * h + g * bracket.of(f, h).unwrap()); // Leibniz
            prop_assert!(bracket.jacobi_defect(f, g, h).unwrap().is_zero());
        }
    }
}
