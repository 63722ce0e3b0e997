//! Brackets of frames with coordinates that are functions of others, against closed forms.

use pc_algebra::{Frame, Neighbourhood, StructureCoefficients};
use pc_expr::{Expr, Graph};

/// c_rs^m at a place; that of a short expression is accurate to some roundings.
fn assert_coefficient<'g>(
    graph: &'g Graph,
    c: &StructureCoefficients<'g>,
    [r, s, m]: [usize; 3],
    at: &[(Expr<'g>, f64)],
    expected: f64,
) {
    let found = graph.evaluate(&[c.get(r, s, m)], at).unwrap()[0];
    assert!((found - expected).abs() <= 1e-13 * expected.abs(), "c_{r}{s}^{m} is {found}, not {expected}");
}

/// y' = φ² η_1, φ' = η_2 + a η_1, z = cos φ: [∂_φ, φ² ∂_y + a ∂_φ] = 2 φ ∂_y + a' ∂_φ = 2/φ X_1 + (a' − 2a/φ)
/// X_2. Least squares over all coordinates would lose a² φ⁻⁴ roundings.
#[test]
fn brackets_are_known_to_rounding_near_a_place_where_the_frame_is_singular() {
    let graph = Graph::new();
    let [t, x, y, phi, z] = graph.symbols(["t", "x", "y", "φ", "z"]);
    let eta = graph.symbols(["w2", "w", "w1"]);
    let a = -0.24 / (2.0 + phi.square());
    let turning = eta[1] + a * eta[0];
    let velocities = [1.27 * eta[2], phi.square() * eta[0], turning, -phi.sin() * turning];
    let frame = Frame::from_velocities(&graph, t, vec![x, y, phi, z], &eta, &velocities).unwrap();
    let c = frame.structure_coefficients(&Neighbourhood::default()).unwrap();
    for at in [-0.008_133_851_f64, 0.7, 1e-3] {
        let place = [(x, 0.18), (y, 0.51), (phi, at), (z, at.cos())];
        let slope = 0.48 * at / (2.0 + at * at).powi(2);
        assert_coefficient(&graph, &c, [2, 1, 1], &place, 2.0 / at);
        let expected = slope + 0.48 / (2.0 + at * at) / at;
        assert_coefficient(&graph, &c, [2, 1, 2], &place, expected);
    }
}

/// x' = √x η_1, y' = (1 + x²) η_2 + 0.92 (1 + y²) η_1, φ' = (1 + φ²) η_3 + √(1.15 y) η_1, and z and h
/// functions of y and φ: [X_1, X_3] = 2 √(1.15 y) φ/(1 + φ²) X_3. Rounded constants such as 1.19² hide that
/// without x the rank is 2.
fn assert_brackets_without_x(z_by_phi: f64, h_by_y: f64) {
    let graph = Graph::new();
    let [t, x, y, phi, z, h] = graph.symbols(["t", "x", "y", "φ", "z", "h"]);
    let eta = graph.symbols(["w1", "w2", "w3"]);
    let across = (1.0 + x.square()) * eta[1] + 0.92 * (1.0 + y.square()) * eta[0];
    let turning = (1.0 + phi.square()) * eta[2] + Expr::from(1.15).sqrt() * y.sqrt() * eta[0];
    let height = 1.19 * (y.square() + 1.0) * across + z_by_phi * phi * turning;
    let root = turning / (2.0 * phi.sqrt()) + h_by_y * across;
    let velocities = [x.sqrt() * eta[0], across, turning, height, root];
    let frame = Frame::from_velocities(&graph, t, vec![x, y, phi, z, h], &eta, &velocities).unwrap();
    let c = frame.structure_coefficients(&Neighbourhood::default()).unwrap();
    let place = [(x, 1.01), (y, 0.8), (phi, 0.42), (z, 1.2), (h, 0.65)];
    let expected = 2.0 * (1.15f64 * 0.8).sqrt() * 0.42 / (1.0 + 0.42 * 0.42);
    assert_coefficient(&graph, &c, [1, 3, 3], &place, expected);
}

#[test]
fn brackets_do_not_depend_on_what_rounding_hides() {
    assert_brackets_without_x(0.0, 0.0);
}

#[test]
fn brackets_do_not_depend_on_rounding_where_coordinates_are_functions_of_several() {
    assert_brackets_without_x(0.3, 0.7);
}

/// (u, v) on an ellipse, u' = −v S, v' = 1.19 u S, and (p, s) on a circle, p' = −s T, s' = p T, where no
/// coordinate follows another, with S = (1 + x²) η_2 + 0.92 (1 + u²) η_1, T = (1 + p²) η_3 + √(1.15 u) η_1,
/// x' = √x η_1: [X_1, X_3] = −2 √(1.15 u) p s/(1 + p²) X_3, which contains no x, but is not found by setting
/// x = 0.
#[test]
fn brackets_do_not_depend_on_rounding_on_curves() {
    let graph = Graph::new();
    let [t, x, u, v, p, s] = graph.symbols(["t", "x", "u", "v", "p", "s"]);
    let eta = graph.symbols(["w1", "w2", "w3"]);
    let along = (1.0 + x.square()) * eta[1] + 0.92 * (1.0 + u.square()) * eta[0];
    let turning = (1.0 + p.square()) * eta[2] + Expr::from(1.15).sqrt() * u.sqrt() * eta[0];
    let velocities = [x.sqrt() * eta[0], -v * along, 1.19 * u * along, -s * turning, p * turning];
    let frame = Frame::from_velocities(&graph, t, vec![x, u, v, p, s], &eta, &velocities).unwrap();
    let c = frame.structure_coefficients(&Neighbourhood::default()).unwrap();
    let place = [(x, 1.01), (u, 0.8), (v, 0.7), (p, 0.42), (s, 0.65)];
    let expected = -2.0 * (1.15f64 * 0.8).sqrt() * 0.42 * 0.65 / (1.0 + 0.42 * 0.42);
    assert_coefficient(&graph, &c, [1, 3, 3], &place, expected);
}
