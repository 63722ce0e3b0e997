//! Integrability, holonomic quasi-velocities and changes of frame.

use pc_algebra::{
    AlgebraError, EulerAngles, Frame, Holonomy, Integrability, LieGroup, Matrix, Neighbourhood, PlaneMotions,
    StructureCoefficients, UnitQuaternions,
};
use pc_expr::{Expr, Graph};

fn near<'g>() -> Neighbourhood<'g> {
    Neighbourhood::default()
}

fn assert_same(c: &StructureCoefficients<'_>, d: &StructureCoefficients<'_>) {
    let k = c.operators();
    for (r, s, m) in (0..=k).flat_map(|r| (0..=k).flat_map(move |s| (1..=k).map(move |m| (r, s, m)))) {
        assert_eq!(c.get(r, s, m), d.get(r, s, m), "c_{r}{s}^{m}");
    }
}

#[test]
fn a_sphere_is_an_integral_manifold_of_rotations() {
    // γ̇ = γ × ω has rank 2 with three operators, and keeps |γ|.
    let graph = Graph::new();
    let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
    let b = [[Expr::ZERO, -z, y], [z, Expr::ZERO, -x], [-y, x, Expr::ZERO]];
    let frame =
        Frame::new(&graph, t, vec![x, y, z], Matrix::from_fn(3, 3, |i, s| b[i][s]), vec![Expr::ZERO; 3])
            .unwrap();
    assert_eq!(frame.integrability(&near()), Integrability::Integrable { dimension: 2 });
}

#[test]
fn integrability_takes_time_into_account() {
    // ẋ = η, ẏ = f: the line y = const moves along if f is independent of x, and is torn apart otherwise.
    let graph = Graph::new();
    let [t, x, y, eta] = graph.symbols(["t", "x", "y", "eta"]);
    let verdict = |f| {
        let frame = Frame::from_velocities(&graph, t, vec![x, y], &[eta], &[eta, f]).unwrap();
        frame.integrability(&near())
    };
    assert_eq!(verdict(t.sin() * y), Integrability::Integrable { dimension: 1 });
    let torn = verdict(x * t);
    assert!(
        matches!(torn, Integrability::NotIntegrable { pair: (0, 1), residual } if residual > 0.1),
        "{torn:?}"
    );
}

#[test]
fn unknown_identities_are_decided_by_numbers() {
    // log(xy) = log x + log y is unknown to the graph.
    let graph = Graph::new();
    let [t, x, y, a, b] = graph.symbols(["t", "x", "y", "a", "b"]);
    let z = graph.symbol("z");
    let f = (x * y).log() - x.log() - y.log();
    let velocities = [a, b, a * (f * z + y) + b * x];
    let frame = Frame::from_velocities(&graph, t, vec![x, y, z], &[a, b], &velocities).unwrap();
    assert_eq!(frame.integrability(&near()), Integrability::Integrable { dimension: 2 });
}

#[test]
fn coordinate_velocities_are_holonomic() {
    let graph = Graph::new();
    let [t, x, y] = graph.symbols(["t", "x", "y"]);
    let frame = Frame::coordinate(&graph, t, vec![x, y]);
    let c = frame.structure_coefficients(&near()).unwrap();
    assert_eq!(frame.holonomy(2, &c), Holonomy::Holonomic { coordinate: Some(y) });
}

#[test]
fn a_polynomial_quasi_coordinate_with_time() {
    // π_1 = x²y + t x + a t², π_2 = y.
    let graph = Graph::new();
    let [t, x, y, a, dx, dy] = graph.symbols(["t", "x", "y", "a", "dx", "dy"]);
    let eta = [2.0 * x * y * dx + x * x * dy + t * dx + x + 2.0 * a * t, dy];
    let frame = Frame::from_definitions(&graph, t, vec![x, y], &[dx, dy], &eta).unwrap();
    let c = frame.structure_coefficients(&near()).unwrap();
    let expected = x * x * y + t * x + a * t * t;
    assert_eq!(frame.holonomy(1, &c), Holonomy::Holonomic { coordinate: Some(expected) });
    assert_eq!(frame.holonomy(2, &c), Holonomy::Holonomic { coordinate: Some(y) });
}

#[test]
fn a_quasi_coordinate_that_is_not_found_is_reported_without_a_formula() {
    let graph = Graph::new();
    let [t, x, dx] = graph.symbols(["t", "x", "dx"]);
    for (definition, coordinate) in [(x.cos(), Some(x.sin())), (x.square().exp(), None)] {
        let frame = Frame::from_definitions(&graph, t, vec![x], &[dx], &[definition * dx]).unwrap();
        let c = frame.structure_coefficients(&near()).unwrap();
        assert_eq!(frame.holonomy(1, &c), Holonomy::Holonomic { coordinate });
    }
}

#[test]
fn body_velocities_of_the_plane_are_holonomic_in_the_angle_alone() {
    let graph = Graph::new();
    let [t, phi, x, y] = graph.symbols(["t", "phi", "x", "y"]);
    let frame = PlaneMotions.left_frame(&graph, t, vec![phi, x, y]).unwrap();
    let c = frame.structure_coefficients(&near()).unwrap();
    assert_eq!(frame.holonomy(1, &c), Holonomy::Holonomic { coordinate: Some(phi) });
    assert_eq!(frame.holonomy(2, &c), Holonomy::Nonholonomic { pair: (1, 3) });
    assert_eq!(frame.holonomy(3, &c), Holonomy::Nonholonomic { pair: (1, 2) });
}

/// The transformed structure coefficients are those found from the new frame, in both directions.
fn assert_transforms<'g>(from: &Frame<'g>, to: &Frame<'g>) {
    let [c, d] = [from, to].map(|frame| frame.structure_coefficients(&near()).unwrap());
    let there = from.change_to(to, &near()).unwrap();
    assert_same(&there.structure_coefficients(&c).unwrap(), &d);
    let back = to.change_to(from, &near()).unwrap();
    assert_same(&back.structure_coefficients(&d).unwrap(), &c);
    // η → η' → η, and the same velocity in both frames.
    let graph = from.graph();
    let eta: Vec<Expr<'g>> = (0..from.operators()).map(|s| graph.symbol(&format!("eta{s}"))).collect();
    let primed = there.quasi_velocities(&eta);
    assert_eq!(back.quasi_velocities(&primed), eta);
    assert_eq!(to.velocities(&primed), from.velocities(&eta));
}

#[test]
fn from_body_to_space() {
    let graph = Graph::new();
    let t = graph.symbol("t");
    let angles = graph.symbols(["psi", "theta", "phi"]).to_vec();
    for sequence in ["zxz", "zyx"] {
        let group = EulerAngles::about(sequence).unwrap();
        let body = group.left_frame(&graph, t, angles.clone()).unwrap();
        let space = group.right_frame(&graph, t, angles.clone()).unwrap();
        assert_transforms(&body, &space);
    }
}

#[test]
fn to_axes_that_turn_and_drift_with_time() {
    let graph = Graph::new();
    let [t, phi, x, y, w, u, v, rate] = graph.symbols(["t", "phi", "x", "y", "w", "u", "v", "rate"]);
    let coordinates = vec![phi, x, y];
    let body = PlaneMotions.left_frame(&graph, t, coordinates.clone()).unwrap();
    // Velocities relative to axes that turn at a rate of their own and are stretched by 1 + x².
    let (s, c, stretch) = ((rate * t).sin(), (rate * t).cos(), 1.0 + x * x);
    let velocities = [w + rate, stretch * (c * u - s * v) - rate * y, s * u + c * v + rate * x + t];
    let turning = Frame::from_velocities(&graph, t, coordinates.clone(), &[w, u, v], &velocities).unwrap();
    assert_transforms(&body, &turning);
    assert_transforms(&turning, &Frame::coordinate(&graph, t, coordinates));
}

#[test]
fn with_redundant_coordinates() {
    // Body and spatial velocities of a quaternion: n = 4, k = 3.
    let graph = Graph::new();
    let q = graph.symbols(["q0", "q1", "q2", "q3"]).to_vec();
    let t = graph.symbol("t");
    let body = UnitQuaternions.left_frame(&graph, t, q.clone()).unwrap();
    let space = UnitQuaternions.right_frame(&graph, t, q).unwrap();
    assert_transforms(&body, &space);
}

#[test]
fn frames_of_different_spaces_are_refused() {
    let graph = Graph::new();
    let [t, x, y, u, v] = graph.symbols(["t", "x", "y", "u", "v"]);
    let zero = Expr::ZERO;
    let frame = Frame::from_velocities;
    let along_x = frame(&graph, t, vec![x, y], &[u], &[u, zero]).unwrap();
    let along_y = frame(&graph, t, vec![x, y], &[u], &[zero, u]).unwrap();
    let drifting = frame(&graph, t, vec![x, y], &[u], &[u, t]).unwrap();
    let both = frame(&graph, t, vec![x, y], &[u, v], &[u, v]).unwrap();
    let twice = frame(&graph, t, vec![x, y], &[u, v], &[u + v, zero]).unwrap();
    let swapped = frame(&graph, t, vec![y, x], &[u], &[zero, u]).unwrap();
    let error = |to| along_x.change_to(to, &near()).unwrap_err();
    assert_eq!(error(&along_y), AlgebraError::DifferentVelocities { operator: 1 });
    assert_eq!(error(&drifting), AlgebraError::DifferentVelocities { operator: 0 });
    assert_eq!(error(&swapped), AlgebraError::DifferentSpaces);
    assert_eq!(
        error(&both).to_string(),
        "the list of operators of the other frame has 2 entries where 1 are needed"
    );
    let dependent = AlgebraError::DependentOperators { rank: 1, operators: 2 };
    assert_eq!(both.change_to(&twice, &near()).unwrap_err(), dependent);
    assert_eq!(twice.change_to(&both, &near()).unwrap_err(), dependent);
    assert_eq!(twice.definitions().unwrap_err(), dependent);
}

/// log(xy) − log x − log y is zero, though the graph does not know it: fields that differ by it are
/// dependent.
#[test]
fn operators_that_are_dependent_in_numbers_are_dependent() {
    let graph = Graph::new();
    let [t, x, y, u, w] = graph.symbols(["t", "x", "y", "u", "w"]);
    let zero = (x * y).log() - x.log() - y.log();
    let [hidden, small, none] = [zero * y, 1e-6 * y, Expr::ZERO].map(|more| {
        let velocities = [u * x + w * x.square(), u * y + w * (x * y + more)];
        Frame::from_velocities(&graph, t, vec![x, y], &[u, w], &velocities).unwrap()
    });
    assert_eq!([&hidden, &small, &none].map(Frame::rank), [1, 2, 1]);
    let error = hidden.definitions().unwrap_err();
    assert!(matches!(error, AlgebraError::DependentOperators { rank: 1, operators: 2 }), "{error:?}");
}
