//! Expressions of several pieces, held on one of them.

use pc_expr::Graph;

/// 1 + (z + a)³ written with a side that cancels is shorter than its expansion, and is not taken for it.
#[test]
fn a_side_that_cancels_does_not_come_back() {
    let graph = Graph::new();
    let [x, z, a] = graph.symbols(["x", "z", "a"]);
    let side = graph.held(&[x.sign()], &[x]).surfaces[0].side;
    let cancelling = graph.sum([(side + 1.0).square(), -side.square(), (z + a).powi(3), -2.0 * side]);
    assert_eq!(graph.symbols_of(&[cancelling]), [z, a, side]);
    let expanded =
        graph.sum([z.powi(3), 3.0 * a * z.square(), 3.0 * a.square() * z, a.powi(3), pc_expr::Expr::ONE]);
    assert_eq!(graph.symbols_of(&[expanded]), [z, a]);
    // Nor is an expression without it shared with one that contains it.
    let again = graph.sum([(side + 1.0).square(), -side.square(), (z + a).powi(3), -2.0 * side]);
    assert_eq!(graph.symbols_of(&[again]), [z, a, side]);
}

/// A piece that is held comes back where it cancels, with an older expression of the same value.
#[test]
fn pieces_that_cancel_end_the_search_for_pieces() {
    let graph = Graph::new();
    let [x, z] = graph.symbols(["x", "z"]);
    let piece = x.abs();
    let cancelling = graph.sum([(piece + 1.0).square(), -piece.square(), z.exp(), -2.0 * piece]);
    let held = graph.held(&[cancelling, cancelling * piece], &[x]);
    assert_eq!(held.surfaces.len(), 1);
    let values = |at: f64| {
        let place = [(x, at), (z, 0.3), (held.surfaces[0].side, at.signum())];
        graph.evaluate(&held.values, &place).unwrap()
    };
    for at in [-0.7, 1.2] {
        let right = 1.0 + f64::exp(0.3);
        for (value, right) in values(at).into_iter().zip([right, right * at.abs()]) {
            assert!((value - right).abs() <= 1e-14, "{value}, not {right}");
        }
    }
}
