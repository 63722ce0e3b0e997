//! The properties of a frame are independent of the units of coordinates and quasi-velocities, and of
//! rounding.

use pc_algebra::{AlgebraError, Frame, Integrability, LieAlgebra, Neighbourhood, discontinuities};
use pc_expr::{Expr, Graph};

/// ẋ = u, ẏ = w and ż as given, in the `units` of z, u and w.
fn frame<'g>(graph: &'g Graph, units: [f64; 3], z_dot: impl Fn([Expr<'g>; 5]) -> Expr<'g>) -> Frame<'g> {
    let symbols @ [x, y, z, u, w] = graph.symbols(["x", "y", "z", "u", "w"]);
    let [of_z, of_u, of_w] = units;
    let z_dot = graph.substitute(&[of_z * z_dot(symbols)], &[(u, of_u * u), (w, of_w * w), (z, z / of_z)])[0];
    let velocities = [of_u * u, of_w * w, z_dot];
    Frame::from_velocities(graph, graph.symbol("t"), vec![x, y, z], &[u, w], &velocities).unwrap()
}

const SCALES: [[f64; 3]; 6] =
    [[1.0; 3], [1e-10, 1.0, 1.0], [1e10, 1.0, 1.0], [1.0, 1e-10, 1e10], [1e-14, 1e7, 1.0], [1e8, 1e-8, 1e8]];

/// ż = y u is not closed in any units.
#[test]
fn a_frame_that_is_not_closed_is_refused_in_all_units() {
    for units in SCALES {
        let graph = Graph::new();
        let frame = frame(&graph, units, |[_, y, _, u, _]| y * u);
        let near = Neighbourhood::default();
        let error = frame.structure_coefficients(&near).unwrap_err();
        assert!(
            matches!(error, AlgebraError::NotClosed { pair: (1, 2), residual } if residual > 0.1),
            "{units:?}: {error:?}"
        );
        let verdict = frame.integrability(&near);
        assert!(
            matches!(verdict, Integrability::NotIntegrable { pair: (1, 2), residual } if residual > 0.1),
            "{units:?}: {verdict:?}"
        );
    }
}

/// log(xy) − log x − log y is zero, though the graph does not know it.
#[test]
fn a_frame_that_is_closed_up_to_rounding_is_accepted_in_all_units() {
    for units in SCALES {
        let graph = Graph::new();
        let frame = frame(&graph, units, |[x, y, _, u, w]| {
            let zero = (x * y).log() - x.log() - y.log();
            u * (zero * y + y) + w * (x + zero)
        });
        let near = Neighbourhood::default();
        let c = frame.structure_coefficients(&near).unwrap_or_else(|error| panic!("{units:?}: {error}"));
        assert!(frame.closure_residual(&c, &near) < 1e-14, "a few roundings"); // not 0: the graph is not sure
        assert_eq!(frame.integrability(&near), Integrability::Integrable { dimension: 2 }, "{units:?}");
    }
}

/// A small part that is not closed beside a large closed one: rotations, and ż = 10⁻¹⁰ w1 q2.
#[test]
fn a_small_part_is_detected_beside_a_large_one() {
    let graph = Graph::new();
    let [t, a, b, c, z] = graph.symbols(["t", "a", "b", "c", "z"]);
    let eta = graph.symbols(["w1", "w2", "w3"]);
    let across = eta[0] * c.sin() + eta[1] * c.cos();
    let turning = [across / b.sin(), eta[0] * c.cos() - eta[1] * c.sin(), eta[2] - b.cot() * across];
    let near = Neighbourhood::default();
    let with = |z_dot| {
        let velocities = [turning[0], turning[1], turning[2], z_dot];
        Frame::from_velocities(&graph, t, vec![a, b, c, z], &eta, &velocities).unwrap()
    };
    let closed = with(1e-7 * turning[1]);
    assert_eq!(
        closed.structure_coefficients(&near).unwrap().lie_algebra(),
        Some(LieAlgebra::so3()),
        "z is the angle b in another unit"
    );
    let torn = with(1e-10 * b * eta[0]);
    assert!(matches!(torn.structure_coefficients(&near), Err(AlgebraError::NotClosed { .. })));
    assert!(matches!(torn.integrability(&near), Integrability::NotIntegrable { .. }));
}

/// so(3) with brackets that grow with a coordinate violates Jacobi's identity by their derivatives.
#[test]
fn the_defect_of_jacobis_identity_does_not_depend_on_units() {
    for unit in [1.0, 1e-10, 1e10] {
        let graph = Graph::new();
        let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
        let frame = Frame::coordinate(&graph, t, vec![x, y, z]);
        let near = Neighbourhood::default();
        let so3 = LieAlgebra::so3().structure_coefficients();
        assert_eq!(frame.jacobi_residual(&so3, &near), 0.0);
        let growing = so3.map(|c| unit * x * c);
        assert_eq!(frame.jacobi_residual(&growing, &near), 1.0);
    }
}

/// Time is an operator, too: [X_1, X_2] = X_2 and [X_0, X_1] = 2 X_1 leave 2 X_2.
#[test]
fn a_drift_that_is_not_a_derivation_is_refused() {
    for unit in [1, 1_000_000_000] {
        let unit = pc_expr::Number::ratio(1, unit);
        let algebra = LieAlgebra::from_brackets(2, &[(0, 1, 1, unit)]).unwrap();
        let drift = |s: usize, m: usize| if (s, m) == (0, 0) { unit + unit } else { 0.into() };
        let error = algebra.with_time(drift).unwrap_err();
        let defect = (unit * (unit + unit)).to_string();
        assert_eq!(error, AlgebraError::Jacobi { triple: (0, 1, 2), component: 2, defect });
    }
}

const LENGTHS: [f64; 5] = [1e-9, 1e-6, 1.0, 1e6, 1e9];

/// x' = l u, y' = l exp(−(x/l)²) v in the unit l: [u, v] = −2 (x/l) v. At x = 1 nothing is left of the exponential function where l is
/// small, and it is 1 where l is large.
#[test]
fn brackets_change_with_the_place_in_all_units() {
    for length in LENGTHS {
        let graph = Graph::new();
        let [t, x, y, u, v] = graph.symbols(["t", "x", "y", "u", "v"]);
        let velocities = [length * u, length * (-(x / length).square()).exp() * v];
        let frame = Frame::from_velocities(&graph, t, vec![x, y], &[u, v], &velocities).unwrap();
        assert_eq!(frame.rank(), 2, "{length}");
        for near in [Neighbourhood { centre: vec![(x, length / 2.0), (y, 0.0)] }, Neighbourhood::default()] {
            let c = frame.structure_coefficients(&near).unwrap_or_else(|error| panic!("{length}: {error}"));
            assert_eq!(c.nonzero().count(), 1, "{length}: {c:?}");
            let found = graph.evaluate(&[c.get(1, 2, 2)], &[(x, 0.75 * length)]).unwrap()[0];
            assert!((found + 1.5).abs() < 1e-12, "{length}: {found}, some roundings from -3/2");
        }
    }
}

/// What is small at x = 1 in the wrong unit is no zero, and what is zero is one in any unit.
#[test]
fn what_vanishes_does_so_in_all_units() {
    for length in LENGTHS {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let z = x / length;
        let nears = [Neighbourhood { centre: vec![(x, 0.3 * length)] }, Neighbourhood::default()];
        let zero = [(z.square() + 4.0 * z + 4.0).log(), -2.0 * (z + 2.0).log()];
        let present =
            [(-z.square()).exp(), (z.square() + 1.0).sqrt() - 1.0, z.atan() - z, (z + 2.0).log() - z];
        for near in nears {
            for (i, present) in present.into_iter().enumerate() {
                assert!(!near.vanishes(&graph, present), "{length}: number {i}");
                assert!(near.residual(&graph, &[vec![present]]) > 1e-6, "{length}: number {i}");
            }
            assert!(
                near.residual(&graph, &[zero.to_vec()]) < 1e-12,
                "{length}: log((z + 2)²) = 2 log(z + 2)"
            );
        }
    }
}

/// A force that jumps at x = l and is felt within some l only.
#[test]
fn jumps_are_seen_in_all_units() {
    for length in LENGTHS {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let z = x / length;
        let force = (z - 1.0).step(1.0, 2.0) * (-z.square()).exp();
        let near = Neighbourhood { centre: vec![(x, 0.2 * length)] };
        let jump = near.jump(&graph, force, &[x]).unwrap_or_else(|| panic!("{length}"));
        assert!((jump.at[0].1 / length - 1.0).abs() < 1e-9, "{length}: {jump:?}");
        assert!((jump.size + (-1f64).exp()).abs() < 1e-9, "{length}: {jump:?}");
        let found = discontinuities(&graph, &[force], &[x], &[]).unwrap();
        assert_eq!(found.len(), 1, "{length}: {found:?}");
    }
}
