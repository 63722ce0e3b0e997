//! Frames that determine their brackets, and frames that do not.

use pc_mech::{AlgebraError, Expr, Frame, Graph, LieAlgebra, MechError, Neighbourhood, System, VectorField};
use pc_tests::classical::{SplitMix64, classical};

fn cross<'g>(u: &[Expr<'g>], v: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn heavy_top<'g>(graph: &'g Graph, inertia: [f64; 3], r: [f64; 3], mg: f64) -> Result<System<'g>, MechError> {
    System::builder(graph)
        .coordinates(["g1", "g2", "g3"])
        .quasi_velocities(["w1", "w2", "w3"])
        .kinematics(|_, g, w| cross(g, w))
        .lagrangian(|_, g, w| {
            let kinetic: Expr<'g> = (0..3).map(|i| w[i].square() * inertia[i] / 2.0).sum();
            let potential: Expr<'g> = (0..3).map(|i| g[i] * (mg * r[i])).sum();
            kinetic - potential
        })
        .build()
}

/// The trap of the least-squares solution: it closes the commutators and gives a wrong torque wherever Iω·γ ≠ 0.
#[test]
fn constant_brackets_of_the_rank_deficient_top_are_found() {
    let cases = [
        ("heavy-top-lagrange", [1.0, 1.0, 0.5], [0.0, 0.0, 1.0]),
        ("heavy-top-kovalevskaya", [2.0, 2.0, 1.0], [1.0, 0.0, 0.0]),
    ];
    for (name, inertia, r) in cases {
        let graph = Graph::new();
        let system = heavy_top(&graph, inertia, r, 1.0).unwrap();
        assert_eq!(system.frame().rank(), 2);
        assert_eq!(system.structure().lie_algebra(), Some(LieAlgebra::so3()));
        let mut motion = system.poincare().unwrap().compile().unwrap();
        let classical = classical(name).unwrap();
        let mut random = SplitMix64::new(3);
        for _ in 0..100 {
            let y: Vec<f64> = (0..6).map(|_| random.normal()).collect();
            let (mut derived, mut expected) = ([0.0; 6], [0.0; 6]);
            motion.rhs(0.0, &y, &mut derived).unwrap();
            classical(0.0, &y, &mut expected);
            for (d, e) in derived.iter().zip(&expected) {
                assert!((d - e).abs() <= 1e-12 * (1.0 + e.abs()), "{name}: {derived:?} against {expected:?}");
            }
        }
    }
}

/// X_1 = ∂_x, X_2 = x² ∂_x: [X_1, X_2] = 2x ∂_x is no constant combination of them.
#[test]
fn a_rank_deficient_frame_without_constant_brackets_is_refused() {
    let graph = Graph::new();
    let error = System::builder(&graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| [eta[0] + x[0].square() * eta[1], Expr::ZERO])
        .lagrangian(|_, _, eta| (eta[0].square() + eta[1].square()) / 2.0)
        .build()
        .unwrap_err();
    assert_eq!(error, AlgebraError::RankDeficient { rank: 1, operators: 2, pair: (1, 2) }.into());
    assert_eq!(
        error.to_string(),
        "the frame has rank 1 with 2 operators, so its structure coefficients can be found only if they are constant, and \
         [X_1, X_2] is not a constant combination of the X_m: the algebra must be given"
    );
}

/// ẋ = u, ẏ = v, ż = y u is the constraint ż = y ẋ, which is not integrable.
#[test]
fn a_frame_that_is_not_closed_is_refused_with_its_pair() {
    let graph = Graph::new();
    let [t, x, y, z, u, v] = graph.symbols(["t", "x", "y", "z", "u", "v"]);
    let frame = Frame::from_velocities(&graph, t, vec![x, y, z], &[u, v], &[u, v, y * u]).unwrap();
    let error = frame.structure_coefficients(&Neighbourhood::default()).unwrap_err();
    assert!(matches!(error, AlgebraError::NotClosed { pair: (1, 2), residual } if residual > 0.1), "{error}");
}

#[test]
fn a_given_algebra_is_checked_against_the_frame() {
    let graph = Graph::new();
    let [t, x, y, u, v] = graph.symbols(["t", "x", "y", "u", "v"]);
    let frame = Frame::from_velocities(&graph, t, vec![x, y], &[u, v], &[u, x * v]).unwrap();
    let commutative = LieAlgebra::commutative(2).structure_coefficients();
    let error = frame.check(&commutative, &Neighbourhood::default()).unwrap_err();
    assert!(matches!(error, AlgebraError::Contradiction { pair: (1, 2), .. }), "{error}");
}
