//! Momenta and energies of bodies as outputs, derived twice.

use pc_model::{Document, Model, Source};
use pc_verify::{Options, verify};

/// A trolley placed by its coordinates with a free body, and a tree of two bodies.
const BODIES: &str = r#"
[parameters]
m = 1.5
[coordinates]
arm = 0.3
hand_q0 = 1.0
x = 0.2
"φ" = 0.4
[gravity]
acceleration = [0.2, 0, -9.8]
[bodies.trolley]
mass = "m*(1 + 0.1*x^2)"
position = ["x", "0.2*cos(φ)", "0.3*sin(φ)"]
rotation = [1, 0, 0, 0, "cos(φ)", "-sin(φ)", 0, "sin(φ)", "cos(φ)"]
inertia = [0.1, 0.2, 0.3, 0.01, 0, 0.02]
force = ["-3*x", 0, 0]
[bodies.arm]
joint = { kind = "revolute", axis = [0.6, 0.8, 0], armature = 0.1, stiffness = 4 }
mass = 2
center = [0, 0.1, 0.4]
inertia = [0.1, 0.2, 0.05]
[bodies.hand]
parent = "arm"
joint = { kind = "spherical", at = [0.1, 0, 0.7] }
mass = 1
center = [0.1, 0, 0.2]
inertia = [0.03, 0.02, 0.01]
[integrals]
sideways = "P_y"
[outputs]
center = "COM_x + COM_hand_y"
moves = "p_trolley_x + p_hand_z + P_z"
spins = "L_trolley_x + L_hand_y + L_arm_z"
turns = "L_x + 2*L_y + 3*L_z"
energies = "T_trolley + V_trolley + T_hand + V_hand + T_arm"
grows = "d(P_x) + d(L_y) + d(T_arm)"
foot = "ZMP_x + 2*ZMP_y"
"#;

#[test]
fn momenta_of_bodies_agree_by_both_routes() {
    let model = Model::new(Document::parse(Source::new("bodies.toml", BODIES)).unwrap());
    let options = Options { states: 30, ..Options::default() };
    let agreement = model.derived(|assembly| verify(&model, assembly, &options)).unwrap();
    assert!(agreement.not_compared.is_empty() && agreement.states == 30, "{agreement:?}");
    // Some thousand operations.
    assert!(agreement.error < 1e-11, "{agreement:?}");
}
