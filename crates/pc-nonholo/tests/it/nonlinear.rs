//! Constraints that are nonlinear in the velocities, together with affine ones.

use pc_mech::{Constraint, ConstraintError, Expr, Graph, MechError, System};
use pc_nonholo::{Adapted, ConstraintClassification, ConstraintKind, NonholoError, Voronets};

fn particle(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0 - x[2])
        .build()
        .unwrap()
}

fn at(graph: &Graph) -> Vec<(Expr<'_>, f64)> {
    let symbols = graph.symbols(["x", "y", "z", "x'", "y'", "z'", "t"]);
    symbols.into_iter().zip([1.0, 2.0, 3.0, 0.6, 0.8, 1.2, 0.0]).collect()
}

/// The knife ż = y ẋ is nonholonomic, the plane ẏ = 0 integrable, for any condition on the speed.
#[test]
fn affine_constraints_keep_their_kinds() {
    let graph = Graph::new();
    let [y, vx, vy, vz] = graph.symbols(["y", "x'", "y'", "z'"]);
    let speed = Constraint::nonlinear("speed", vx.square() + vy.square() - 1.0);
    let knife = Constraint::new("knife", vz - y * vx);
    let sorted =
        ConstraintClassification::new(&particle(&graph), &[speed.clone(), knife], &at(&graph)).unwrap();
    assert!(
        matches!(sorted.kinds(), [ConstraintKind::Nonlinear, ConstraintKind::Nonholonomic { .. }]),
        "{:?}",
        sorted.kinds()
    );
    let plane = Constraint::new("plane", vy);
    let sorted =
        ConstraintClassification::new(&particle(&graph), &[plane, speed.clone()], &at(&graph)).unwrap();
    assert_eq!(sorted.kinds(), [ConstraintKind::Integrable, ConstraintKind::Nonlinear]);
    assert!(!sorted.is_holonomic());
    let again = Constraint::nonlinear("again", 2.0 * vx.square() + 2.0 * vy.square() - 2.0);
    let error = ConstraintClassification::new(&particle(&graph), &[speed, again], &at(&graph)).unwrap_err();
    let expected = MechError::Constraint(ConstraintError::Dependent { constraint: "again".to_owned() });
    assert_eq!(error, NonholoError::Mech(expected));
}

#[test]
fn forms_in_independent_velocities_refuse_nonlinear_constraints() {
    let graph = Graph::new();
    let [vx, vy] = graph.symbols(["x'", "y'"]);
    let speed = Constraint::nonlinear("speed", vx.square() + vy.square() - 1.0);
    let held = particle(&graph).with_multipliers(&[speed]).unwrap();
    let message = "adapted frames need constraints that are affine in the velocities; `speed` is not";
    assert_eq!(Adapted::new(&held, &at(&graph)).unwrap_err().to_string(), message);
    let message = "Voronets' equations need constraints that are affine in the velocities; `speed` is not";
    assert_eq!(Voronets::new(&held, &at(&graph)).unwrap_err().to_string(), message);
    let error = held.in_independent_velocities(&at(&graph)).unwrap_err();
    assert_eq!(error, MechError::Constraint(ConstraintError::NotAffine { constraint: "speed".to_owned() }));
}

/// For an affine constraint, λ(t, x, η) is the reaction of the equations (30), with the same rates.
#[test]
fn reactions_of_affine_constraints_are_those_of_the_adapted_frame() {
    let graph = Graph::new();
    let [y, vx, vy, vz] = graph.symbols(["y", "x'", "y'", "z'"]);
    let held = particle(&graph).with_multipliers(&[Constraint::new("knife", vz - y * vx)]).unwrap();
    // ż = y ẋ: λ = z̈ + 1, z̈ = y ẍ + ẋ ẏ, ẍ = −y λ
    let expected = (1.0 + vx * vy) / (1.0 + y.square());
    let found = held.reactions_of_state().unwrap()[0];
    assert!((found - expected).is_zero(), "{found}");
    let rates = held.with_reactions_put_in().unwrap().poincare().unwrap();
    assert!((rates.right_hand_side()[2] - (expected - 1.0)).is_zero());
}
