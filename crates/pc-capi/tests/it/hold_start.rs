//! A start that is moved onto the constraints keeps the components that are held.

use crate::common::{Model, Refusal, c, call};
use pc::pc_status::PC_NOT_FOUND;
use pc::*;

/// A particle on the circle of radius 1, started off it.
const CIRCLE: &str = r#"
[coordinates]
x = 0.6
y = 1.0
[constraints]
circle = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
"#;

/// The moved start (x, y), with `held` kept.
fn moved(held: &[&str]) -> Result<Vec<f64>, Refusal> {
    let model = Model::text(CIRCLE)?;
    // SAFETY: a live model.
    call(|error| unsafe { pc_model_project_start(model.0, 1, error) })?;
    for name in held {
        let name = c(name);
        // SAFETY: a live model and a text.
        call(|error| unsafe { pc_model_hold_start(model.0, name.as_ptr(), error) })?;
    }
    Ok(model.system(pc_form::PC_POINCARE)?.start().1[..2].to_vec())
}

#[test]
fn held_components_are_not_moved() {
    // Newton's method ends at roundings of numbers near 1.
    let near = |found: Vec<f64>, expected: [f64; 2]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
    };
    near(moved(&["x"]).unwrap(), [0.6, 0.8]);
    let free = moved(&[]).unwrap();
    assert!((free[0].hypot(free[1]) - 1.0).abs() < 1e-14 && free[0] < 0.58, "{free:?}");
}

#[test]
fn unknown_names_are_refused() {
    let refusal = moved(&["z"]).unwrap_err();
    assert_eq!(refusal.status, PC_NOT_FOUND);
    assert!(refusal.message.contains("`z`") && refusal.message.contains("x, y"), "{refusal:?}");
}
