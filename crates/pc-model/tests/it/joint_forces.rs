//! Forces and torques of joints where constraints act on points of bodies: the balance of each body, and the free directions of
//! joints, along which nothing acts.

use pc_mech::{Graph, Motion, VectorField};
use pc_model::{Document, Model, ModelError, Source};

use crate::random::numbers;
use crate::verified::derived_twice;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn compiled(text: &str) -> (Motion, Vec<f64>) {
    let (model, graph) = (model(text), Graph::new());
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    model.compile(&assembly).unwrap_or_else(|error| panic!("{error}"))
}

fn observed(motion: &mut Motion, state: &[f64], names: &[String]) -> Vec<f64> {
    let values = motion.observe(0.0, state);
    let known = motion.observable_names();
    let place = |name: &String| known.iter().position(|known| known == name);
    names.iter().map(|name| values[place(name).unwrap_or_else(|| panic!("{name}"))]).collect()
}

/// A cart with an arm and a hand on a ball.
const ROBOT: &str = r#"
[coordinates]
arm = 0.4
hand_q0 = "cos(0.3)"
hand_q1 = "sin(0.3)"
[gravity]
acceleration = [0, 0, -9.8]
[bodies.cart]
joint = { kind = "prismatic", axis = [1, 0, 0], damping = 0.3 }
mass = 3
center = [0.1, 0, 0.2]
inertia = [0.2, 0.3, 0.4]
[bodies.arm]
parent = "cart"
joint = { kind = "revolute", axis = [0, 1, 0], at = [0, 0, 0.4] }
mass = 2
center = [0, 0.1, 0.4]
inertia = [0.1, 0.2, 0.05, 0.01, 0, 0.02]
[bodies.hand]
parent = "arm"
joint = { kind = "spherical", at = [0.1, 0, 0.7] }
mass = 1
center = [0.1, 0, 0.2]
inertia = [0.03, 0.02, 0.01]
[points.tip]
body = "hand"
at = [0.1, -0.2, 0.3]
[points.palm]
body = "hand"
[points.side]
body = "cart"
at = [0.5, 0.3, 0]
"#;

/// The value of an expression at the start without constraints.
fn at_start(expression: &str) -> f64 {
    let (mut motion, start) = compiled(&format!("{ROBOT}[outputs]\nvalue = \"{expression}\"\n"));
    observed(&mut motion, &start, &["value".to_owned()])[0]
}

/// Checks that these outputs vanish at states that satisfy the constraints.
fn vanish(constraints: &str, outputs: &[&str]) {
    let names: Vec<String> = (0..outputs.len()).map(|i| format!("left{i}")).collect();
    let lines = names.iter().zip(outputs).map(|(name, output)| format!("{name} = \"{output}\"\n"));
    let (mut motion, start) =
        compiled(&format!("{ROBOT}{constraints}[outputs]\n{}", lines.collect::<String>()));
    let mut next = numbers(5);
    for _ in 0..20 {
        let mut state: Vec<f64> = start.iter().map(|x| x + 0.2 * next()).collect();
        motion.project(0.0, &mut state).unwrap();
        for (output, left) in outputs.iter().zip(observed(&mut motion, &state, &names)) {
            // Some hundred operations with forces up to some hundreds, through the solution for the multipliers.
            assert!(left.abs() < 1e-10, "{output}: {left}");
        }
    }
}

/// Along the free directions of joints without motors.
const FREE: [&str; 5] = ["N_hand_1", "N_hand_2", "N_hand_3", "N_arm_2", "F_cart_x + 0.3*cart'"];

#[test]
fn a_rod_to_the_world_pulls_at_its_point() {
    let rod = at_start("tip_x^2 + tip_y^2 + tip_z^2");
    let hand = [
        "d(p_hand_x) - F_hand_x - 2*λ_rod*tip_x",
        "d(p_hand_y) - F_hand_y - 2*λ_rod*tip_y",
        "d(p_hand_z) - F_hand_z - 2*λ_rod*tip_z + 9.8",
        "d(P_x) - F_cart_x - 2*λ_rod*tip_x",
        "d(P_z) - F_cart_z - 2*λ_rod*tip_z + 6*9.8",
        "d(L_hand_y) - (palm_z - COM_hand_z)*F_hand_x + (palm_x - COM_hand_x)*F_hand_z \
         - 2*λ_rod*((tip_z - COM_hand_z)*tip_x - (tip_x - COM_hand_x)*tip_z)",
    ];
    let text = format!("[constraints]\nrod = \"tip_x^2 + tip_y^2 + tip_z^2 - {rod:?}\"\n");
    vanish(&text, &[&hand[..], &FREE].concat());
}

#[test]
fn a_condition_on_directions_turns_the_body() {
    // λ col_3 × e_x = λ (0, R_33, −R_23)
    let lean = at_start("tip_13");
    let hand = [
        "d(p_hand_x) - F_hand_x",
        "d(L_hand_y) - (palm_z - COM_hand_z)*F_hand_x + (palm_x - COM_hand_x)*F_hand_z - λ_lean*tip_33",
        "d(L_hand_z) - (palm_x - COM_hand_x)*F_hand_y + (palm_y - COM_hand_y)*F_hand_x + λ_lean*tip_23",
    ];
    vanish(&format!("[constraints]\nlean = \"tip_13 - ({lean:?})\"\n"), &[&hand[..], &FREE].concat());
}

#[test]
fn a_loop_transmits_its_force_within_the_bodies() {
    let length = at_start("sqrt((tip_x - side_x)^2 + (tip_y - side_y)^2 + (tip_z - side_z)^2)");
    let whole = ["d(P_x) - F_cart_x", "d(P_y) - F_cart_y", "d(P_z) - F_cart_z + 6*9.8"];
    let text = format!(
        "[loops.link]\nbodies = [\"cart\", \"hand\"]\nkind = \"rod\"\nat = [[0.5, 0.3, 0], [0.1, -0.2, 0.3]]\nlength = {length:?}\n"
    );
    vanish(&text, &[&whole[..], &FREE].concat());
}

#[test]
fn forces_that_are_not_determined_are_refused() {
    let refused = |constraints: &str| {
        let text = format!("{ROBOT}{constraints}[outputs]\nforce = \"F_hand_x\"\n");
        let document = Document::parse(Source::new("m.toml", text.as_str())).unwrap();
        let found: Result<(), ModelError> = Model::new(document).derived(|_| Ok(()));
        found.unwrap_err().to_string()
    };
    let of_coordinates = refused("[constraints]\ntied = \"cart - 0.1*(arm - 0.4)\"\n");
    let [z, twice] = [1.0, 2.0].map(|factor| factor * at_start("tip_z"));
    let dependent = refused(&format!("[constraints]\na = \"tip_z - {z:?}\"\nb = \"2*tip_z - {twice:?}\"\n"));
    insta::assert_snapshot!([of_coordinates, dependent].join("\n\n"));
}
