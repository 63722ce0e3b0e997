//! Reactions as forces and torques on bodies, derived twice.

use pc_model::{Document, Model, Source};
use pc_verify::{Agreement, Options, verify};

fn agreement(text: &str) -> Agreement {
    let model = Model::new(Document::parse(Source::new("bodies.toml", text)).unwrap());
    model.derived(|assembly| verify(&model, assembly, &Options { states: 30, ..Options::default() })).unwrap()
}

/// A door on a hinge with forces and torques, a weight on a thread from its edge, and kinetic energy that
/// belongs to no body.
const DOOR: &str = r#"
[coordinates]
x = 0.0
y = 0.0
"φ" = 0.3
q = 0.1
X = 1.2
Y = -0.4
[quasi_velocities]
"x'" = 0.0
"y'" = 0.0
"φ'" = 0.0
"q'" = 0.0
"X'" = 0.0
"Y'" = 0.0
[lagrangian]
kinetic = "0.3*q'^2*(1 + φ^2) + 0.1*q'^4"
potential = "q^2"
[bodies.door]
mass = 2.0
position = ["x + 0.5*cos(φ)", "y + 0.5*sin(φ)", 0]
rotation = ["cos(φ)", "-sin(φ)", 0, "sin(φ)", "cos(φ)", 0, 0, 0, 1]
inertia = [1, 2, 0.4]
force = [0, -20, 0]
[bodies.weight]
mass = 0.7
position = ["X", "Y", 0]
force = [0, -7, 0]
[constraints]
hinge_x = "x"
hinge_y = "y"
thread = "(X - x - cos(φ))^2 + (Y - y - sin(φ))^2 - (1.2 - cos(0.3))^2 - (0.4 + sin(0.3))^2"
gear = "q' - 0.5*φ'"
[outputs]
pull = "sqrt(F_thread_weight_x^2 + F_thread_weight_y^2)"
turn = "N_hinge_y_door_3 + 2*N_gear_door_3"
"#;

#[test]
fn forces_and_torques_of_reactions_agree_by_both_routes() {
    let agreement = agreement(DOOR);
    assert!(agreement.not_compared.is_empty() && agreement.states == 30, "{agreement:?}");
    assert!(agreement.error < 1e-12, "{agreement:?}");
}
