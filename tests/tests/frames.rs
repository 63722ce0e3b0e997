//! Frames that determine their brackets, and frames that do not.

use pc_mech::{
    AlgebraError, Expr, Frame, Graph, LieAlgebra, Matrix, MechError, Neighbourhood, System, VectorField,
};
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
        "the frame has rank 1 with 2 operators, so its structure coefficients must be constant to be found, and \
         [X_1, X_2] is no constant combination of the X_m: the algebra must be given"
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

/// b and a = b⁻¹ give the same frame, drift and c_0s included.
#[test]
fn a_frame_from_definitions_is_the_frame_from_kinematics() {
    let graph = Graph::new();
    let [t, x, y, u, v, dx, dy] = graph.symbols(["t", "x", "y", "u", "v", "x'", "y'"]);
    let rates = [u * t.cos() - v * t.sin() - y, u * t.sin() + v * t.cos() + x];
    let by_rates = Frame::from_velocities(&graph, t, vec![x, y], &[u, v], &rates).unwrap();
    let definitions = [(dx + y) * t.cos() + (dy - x) * t.sin(), (dy - x) * t.cos() - (dx + y) * t.sin()];
    let by_definitions = Frame::from_definitions(&graph, t, vec![x, y], &[dx, dy], &definitions).unwrap();
    assert_eq!(by_rates.b(), by_definitions.b());
    assert_eq!(by_rates.b0(), by_definitions.b0());
    let near = Neighbourhood::default();
    let c = by_rates.structure_coefficients(&near).unwrap();
    assert!(c.are_constant());
    assert_eq!(by_rates.closure_residual(&c, &near), 0.0);
    assert_eq!(by_rates.jacobi_residual(&c, &near), 0.0);
}

/// c_rs^m(6) in its two forms: from the commutators, and from the derivatives of a = b⁻¹ with index 0 included.
#[test]
fn both_forms_of_the_structure_coefficients_agree() {
    let graph = Graph::new();
    let [t, x, y, z, u, v, w] = graph.symbols(["t", "x", "y", "z", "u", "v", "w"]);
    let symbols = [x, y, z];
    let rates =
        [u * (x * y).exp() + v * t, v * (2.0 + z.sin()) + x * w + t * y, w * (3.0 + (t * x).cos()) + u * y];
    let frame = Frame::from_velocities(&graph, t, symbols.to_vec(), &[u, v, w], &rates).unwrap();
    let near = Neighbourhood::default();
    let c = frame.structure_coefficients(&near).unwrap();
    let a = pc_algebra::inverse(&graph, frame.b()).unwrap();
    // Extended by time: x_0 = t, b_00 = 1, b_i0 the drift, a_00 = 1, a_m0 = −a_mi b_i0.
    let extended = [t, x, y, z];
    let b = Matrix::from_fn(4, 4, |i, s| match (i, s) {
        (0, 0) => Expr::ONE,
        (0, _) => Expr::ZERO,
        (_, 0) => frame.b0()[i - 1],
        _ => frame.b()[(i - 1, s - 1)],
    });
    let a = Matrix::from_fn(4, 4, |m, i| match (m, i) {
        (0, 0) => Expr::ONE,
        (0, _) => Expr::ZERO,
        (_, 0) => -graph.dot(a.row(m - 1).iter().copied(), frame.b0().iter().copied()),
        _ => a[(m - 1, i - 1)],
    });
    for r in 0..4 {
        for s in 0..4 {
            for m in 1..4 {
                let second = graph.sum((0..4).flat_map(|i| (0..4).map(move |j| (i, j))).map(|(i, j)| {
                    (a[(m, j)].derivative(extended[i]) - a[(m, i)].derivative(extended[j]))
                        * b[(j, r)]
                        * b[(i, s)]
                }));
                assert!((c.get(r, s, m) - second).is_zero(), "c_{r}{s}^{m}");
            }
        }
    }
}
