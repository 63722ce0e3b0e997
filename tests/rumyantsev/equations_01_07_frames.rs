//! Frames of operators and their structure coefficients: equations (1)–(7).

use pc_algebra::{Holonomy, Integrability};
use pc_mech::{Expr, Frame, Graph, Matrix, Neighbourhood};

use crate::assert_identities;

/// A frame without symmetry: b and b_0 depend on time and place, b_0 ≠ 0.
fn general(graph: &Graph) -> Frame<'_> {
    let [t, x, y, z, u, v, w] = graph.symbols(["t", "x", "y", "z", "u", "v", "w"]);
    let rates =
        [u * (x * y).exp() + v * t, v * (2.0 + z.sin()) + x * w + t * y, w * (3.0 + (t * x).cos()) + u * y];
    Frame::from_velocities(graph, t, vec![x, y, z], &[u, v, w], &rates).unwrap()
}

/// Velocities with ż = x ẏ + y ẋ + 2t stay on z − xy − t² = const. Frobenius' test finds the same.
#[test]
fn equation_1_constraints_of_a_closed_frame_are_integrable() {
    let graph = Graph::new();
    let [t, x, y, z, u, v] = graph.symbols(["t", "x", "y", "z", "u", "v"]);
    let rates = [u, v, x * v + y * u + 2.0 * t];
    let frame = Frame::from_velocities(&graph, t, vec![x, y, z], &[u, v], &rates).unwrap();
    let relation = z - x * y - t.square();
    assert_identities("X_s f", (0..=2).map(|s| (frame.apply(s, &[relation])[0], Expr::ZERO)));
    let verdict = frame.integrability(&Neighbourhood::default());
    assert_eq!(verdict, Integrability::Integrable { dimension: 2 });
}

/// b and a = b⁻¹ give the same frame, drift and c_0s included.
#[test]
fn equations_2_and_3_a_frame_from_definitions_is_the_frame_from_kinematics() {
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

/// df/dt = X_0 f + η_s X_s f.
#[test]
fn equation_4_operators_give_the_rate_of_a_function() {
    let graph = Graph::new();
    let frame = general(&graph);
    let [t, x, y, z, u, v, w] = graph.symbols(["t", "x", "y", "z", "u", "v", "w"]);
    let eta = [u, v, w];
    let f = (x * y).sin() + t * z.square();
    let velocities = frame.velocities(&eta);
    let along: Vec<_> = [x, y, z].into_iter().zip(velocities).chain([(t, Expr::ONE)]).collect();
    let rate = graph.directional(&[f], &along)[0];
    let moving = graph.sum((1..=3).map(|s| eta[s - 1] * frame.apply(s, &[f])[0]));
    assert_identities("df/dt", [(rate, frame.apply(0, &[f])[0] + moving)]);
}

fn apply<'g>(frame: &Frame<'g>, s: usize, f: Expr<'g>) -> Expr<'g> {
    frame.apply(s, &[f])[0]
}

/// X_r X_s f − X_s X_r f = c_rs^m X_m f, r, s = 0..k; c_rs^0 = 0, as no commutator has ∂/∂t.
#[test]
fn equation_5_commutators_are_combinations_of_the_operators() {
    let graph = Graph::new();
    let frame = general(&graph);
    let c = frame.structure_coefficients(&Neighbourhood::default()).unwrap();
    let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
    let f = (x * y).sin() + t * z.square() + x.square() * z;
    for (r, s) in (0..=3).flat_map(|r| (0..=3).map(move |s| (r, s))) {
        let commutator = apply(&frame, r, apply(&frame, s, f)) - apply(&frame, s, apply(&frame, r, f));
        let combination = graph.sum((1..=3).map(|m| c.get(r, s, m) * apply(&frame, m, f)));
        assert_identities(&format!("[X_{r}, X_{s}]"), [(commutator, combination)]);
    }
}

/// c_rs^m in its two forms: from the commutators, and from the derivatives of a = b⁻¹ with index 0 included. The first form is
/// printed with the opposite sign.
#[test]
fn equation_6_both_forms_of_the_structure_coefficients_agree() {
    let graph = Graph::new();
    let frame = general(&graph);
    let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
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

/// η_m = dπ_m/dt with π = (xy, y + t²): all c vanish, and the π are found. With η_2 = x ẏ one does not.
#[test]
fn equation_7_quasi_velocities_are_velocities_where_all_c_vanish() {
    let graph = Graph::new();
    let [t, x, y, dx, dy] = graph.symbols(["t", "x", "y", "x'", "y'"]);
    let near = Neighbourhood::default();
    let first = x * dy + y * dx;
    let frame = |second| Frame::from_definitions(&graph, t, vec![x, y], &[dx, dy], &[first, second]).unwrap();
    let holonomic = frame(dy + 2.0 * t);
    let c = holonomic.structure_coefficients(&near).unwrap();
    assert_eq!(c.nonzero().count(), 0);
    assert_eq!(holonomic.holonomy(1, &c), Holonomy::Holonomic { coordinate: Some(x * y) });
    assert_eq!(holonomic.holonomy(2, &c), Holonomy::Holonomic { coordinate: Some(y + t.square()) });
    let other = frame(x * dy);
    let c = other.structure_coefficients(&near).unwrap();
    assert_eq!(other.holonomy(2, &c), Holonomy::Nonholonomic { pair: (1, 2) });
}
