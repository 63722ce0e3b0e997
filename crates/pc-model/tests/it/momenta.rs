//! Mass centres, momenta, energies and the zero-moment point as names: closed forms and the balance of forces.

use pc_mech::{Graph, Motion, VectorField};
use pc_model::{Document, Model, ModelError, Source};

use crate::random::numbers;
use crate::verified::derived_twice;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap())
}

fn refused(text: &str) -> String {
    let document = Document::parse(Source::new("m.toml", text)).unwrap();
    let found: Result<(), ModelError> = Model::new(document).derived(|_| Ok(()));
    found.unwrap_err().to_string()
}

/// The motion of a model with its start.
struct Watched {
    motion: Motion,
    start: Vec<f64>,
}

impl Watched {
    fn new(text: &str) -> Watched {
        let (model, graph) = (model(text), Graph::new());
        let assembly = model.assemble(&graph).unwrap();
        let (motion, start) = model.compile(&assembly).unwrap();
        Watched { motion, start }
    }

    fn at<const N: usize>(&mut self, state: &[f64], names: [&str; N]) -> [f64; N] {
        let values = self.motion.observe(0.0, state);
        let known = self.motion.observable_names();
        names.map(|name| {
            values[known.iter().position(|known| known == name).unwrap_or_else(|| panic!("{name}"))]
        })
    }

    fn near_start(&mut self, next: &mut impl FnMut() -> f64) -> Vec<f64> {
        let mut state: Vec<f64> = self.start.iter().map(|x| x + 0.3 * next()).collect();
        self.motion.project(0.0, &mut state).unwrap();
        state
    }
}

#[track_caller]
fn close(found: &[f64], expected: &[f64]) {
    let size = expected.iter().chain(found).fold(1.0f64, |size, x| size.max(x.abs()));
    for (a, b) in found.iter().zip(expected) {
        // Some hundred operations with numbers up to some tens.
        assert!((a - b).abs() <= 1e-12 * size, "{found:?} instead of {expected:?}");
    }
}

/// A cart with an arm and a hand on a ball, under weight and a force on the hand.
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
force = [1, 2, -3]
torque = [0, 0.1, 0]
"#;

/// Ṗ is the sum of the forces, and L̇ about the common mass centre that of their moments about it.
#[test]
fn momenta_change_by_the_forces_on_all_bodies() {
    let outputs = r#"
[points.hand]
body = "hand"
[outputs]
dP_x = "d(P_x) - F_cart_x - 1"
dP_y = "d(P_y) - F_cart_y - 2"
dP_z = "d(P_z) - F_cart_z + 3 + 6*9.8"
own = "P_y - p_cart_y - p_arm_y - p_hand_y"
N_y = "0.1*hand_22"
dL_y = "d(L_y) - N_cart_2 - 0.1*hand_22 + COM_z*F_cart_x + (cart - COM_x)*F_cart_z - (COM_hand_z - COM_z) - (COM_hand_x - COM_x)*3"
dL_z = "d(L_z) - N_cart_3 - 0.1*hand_32 - (cart - COM_x)*F_cart_y - COM_y*F_cart_x - (COM_hand_x - COM_x)*2 + (COM_hand_y - COM_y)"
"#;
    let mut robot = Watched::new(&format!("{ROBOT}{outputs}"));
    let mut next = numbers(3);
    for _ in 0..50 {
        let state = robot.near_start(&mut next);
        close(&robot.at(&state, ["dP_x", "dP_y", "dP_z", "own", "dL_y", "dL_z"]), &[0.0; 6]);
    }
}

/// m v of the mass centre, and the energies of all bodies, which are all the energy of the robot.
#[test]
fn momenta_and_energies_belong_to_the_bodies() {
    let outputs = r#"
[outputs]
p_x = "p_hand_x - d(COM_hand_x)"
p_z = "P_z - 6*d(COM_z)"
all = "T_cart + T_arm + T_hand + V_cart + V_arm + V_hand"
own = "T_cart - 1.5*cart'^2"
weight = "V_arm - 19.6*COM_arm_z"
"#;
    let mut robot = Watched::new(&format!("{ROBOT}{outputs}"));
    let mut next = numbers(4);
    for _ in 0..50 {
        let state = robot.near_start(&mut next);
        let [p_x, p_z, all, own, weight, energy] =
            robot.at(&state, ["p_x", "p_z", "all", "own", "weight", "energy"]);
        close(&[p_x, p_z, all, own, weight], &[0.0, 0.0, energy, 0.0, 0.0]);
    }
}

/// A force function of the force on a body is part of its potential energy, in any coordinates.
#[test]
fn energies_of_placed_bodies_sum_to_the_whole() {
    let text = r#"
[coordinates]
r = 1.0
"φ" = 0.3
[quasi_velocities]
"r'" = 0.2
"φ'" = 0.7
[gravity]
acceleration = [0, -9.8, 0]
[bodies.bob]
mass = 2
position = ["r*cos(φ)", "r*sin(φ)", 0]
rotation = ["cos(φ)", "-sin(φ)", 0, "sin(φ)", "cos(φ)", 0, 0, 0, 1]
inertia = [0.1, 0.2, "0.3 + 0.1*r^2"]
force = ["-5*r*cos(φ)", "-5*r*sin(φ)", 0]
[outputs]
T = "T_bob"
V = "V_bob"
L = "L_bob_z"
about = "L_z - L_bob_z"
"#;
    let mut bob = Watched::new(text);
    let mut next = numbers(5);
    for _ in 0..20 {
        let state = bob.near_start(&mut next);
        let [r, phi, u, w] = state[..] else { panic!() };
        let inertia = 0.3 + 0.1 * r * r;
        let kinetic = u * u + r * r * w * w + inertia * w * w / 2.0;
        let potential = 2.0 * 9.8 * r * phi.sin() + 2.5 * r * r;
        let [t, v, l, about, energy] = bob.at(&state, ["T", "V", "L", "about", "energy"]);
        close(&[t, v, l, about, energy], &[kinetic, potential, inertia * w, 0.0, kinetic + potential]);
    }
}

/// The cart and its table (Kajita 2003): x − z ẍ/g.
#[test]
fn the_zero_moment_point_of_a_mass_at_one_height() {
    let text = r#"
[parameters]
h = 0.8
g = 9.81
[coordinates]
x = 0.1
y = -0.2
[gravity]
acceleration = [0, 0, "-g"]
[bodies.cart]
mass = 7
position = ["x", "y", "h"]
[forces]
x = "7*sin(x)"
y = "3*y'"
[outputs]
px = "ZMP_x"
py = "ZMP_y"
"#;
    let mut cart = Watched::new(text);
    let mut next = numbers(6);
    for _ in 0..20 {
        let state = cart.near_start(&mut next);
        let [x, y, _, v] = state[..] else { panic!() };
        let expected = [x - 0.8 * x.sin() / 9.81, y - 0.8 * (3.0 / 7.0) * v / 9.81];
        close(&cart.at(&state, ["px", "py"]), &expected);
    }
}

/// At rest it lies below the mass centre; when the body turns about a horizontal axis through its mass centre, it
/// moves by I α/(m g).
#[test]
fn the_zero_moment_point_of_a_body_at_rest_is_below_its_mass_centre() {
    let text = r#"
[coordinates]
leg = 0.4
wheel = 0.0
[gravity]
acceleration = [0, 0, -10]
[bodies.leg]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 2
center = [0.3, 0.1, 0.5]
inertia = [1, 1, 1]
[bodies.wheel]
parent = "leg"
joint = { kind = "revolute", axis = [0, 1, 0], at = [0.2, 0, 0.7] }
mass = 3
inertia = [0.1, 0.2, 0.1]
[forces]
wheel = "6*wheel"
[outputs]
x = "ZMP_x - COM_x"
y = "ZMP_y - COM_y"
"#;
    let mut robot = Watched::new(text);
    close(&robot.at(&[0.4, 0.0, 0.0, 0.0], ["x", "y"]), &[0.0, 0.0]);
    // α = 6/0.2 about the axis at 0.4: M_y = 6 cos 0.4, M_x = −6 sin 0.4, M g = 50.
    let (sin, cos) = 0.4f64.sin_cos();
    close(&robot.at(&[0.4, 1.0, 0.0, 0.0], ["x", "y"]), &[-6.0 * cos / 50.0, -6.0 * sin / 50.0]);
}

/// The same body on a joint, and placed by its coordinates.
#[test]
fn a_body_on_a_joint_has_the_momenta_of_the_body_in_its_place() {
    let outputs = "COM_x COM_arm_z p_arm_x P_z L_arm_y L_y T_arm V_arm ZMP_x";
    let outputs: String =
        outputs.split(' ').enumerate().map(|(i, name)| format!("o{i} = \"{name}\"\n")).collect();
    let head = "[coordinates]\narm = 0.3\n[gravity]\nacceleration = [0.5, 0, -9]\n";
    let joint = "[bodies.arm]\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = 2\ncenter = [0, 0, 0.5]\n\
                 inertia = [0.1, 0.2, 0.3]\n";
    let place = "[bodies.arm]\nmass = 2\nposition = [\"sin(arm)/2\", 0, \"cos(arm)/2\"]\ninertia = [0.1, 0.2, 0.3]\n\
                 rotation = [\"cos(arm)\", 0, \"sin(arm)\", 0, 1, 0, \"-sin(arm)\", 0, \"cos(arm)\"]\n";
    let mut both = [joint, place].map(|body| Watched::new(&format!("{head}{body}[outputs]\n{outputs}")));
    let names = ["o0", "o1", "o2", "o3", "o4", "o5", "o6", "o7", "o8"];
    let mut next = numbers(7);
    for _ in 0..20 {
        let state = both[0].near_start(&mut next);
        let [a, b] = both.each_mut().map(|body| body.at(&state, names));
        close(&a, &b);
    }
}

#[test]
fn names_of_the_text_come_before_those_of_bodies() {
    let text = r#"
[parameters]
T_bob = 3.0
[coordinates]
P_x = 0.5
[bodies.bob]
mass = 2
position = ["P_x", 0, 0]
[outputs]
a = "T_bob"
b = "P_x"
c = "COM_x"
"#;
    let mut bob = Watched::new(text);
    close(&bob.at(&[0.7, 0.2], ["a", "b", "c"]), &[3.0, 0.7, 0.7]);
}

/// An event may wait for a mass centre or a momentum; it may not contain accelerations, nor a force a momentum.
#[test]
fn places_for_the_names_of_bodies() {
    let with = |section: &str| {
        format!(
            "[coordinates]\nx = 0.0\n[gravity]\nacceleration = [0, 0, -1]\n[bodies.bob]\nmass = 2\n\
             position = [\"x\", 0, 1]\n{section}\n"
        )
    };
    let model = model(&with("[events.far]\nwhen = \"COM_x - 1 + p_bob_x\"\n"));
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let [x, v] = graph.symbols(["x", "x'"]);
    assert_eq!(assembly.events[0].when, x - 1.0 + 2.0 * v);
    insta::assert_snapshot!(refused(&with("[forces]\nx = \"p_bob_x\"")));
    insta::assert_snapshot!(refused(&with("[events.tips]\nwhen = \"ZMP_x - 0.1\"")));
    insta::assert_snapshot!(refused(&with("[outputs]\nL = \"L_bob_x + q_bob_x\"")));
}

#[test]
fn what_the_text_does_not_determine_is_refused() {
    let top = "[coordinates]\n\"φ\" = 0.0\n[bodies.top]\nmass = 1\nposition = [0, 0, 0]\ninertia = [1, 1, 2]\n\
               angular_velocity = [0, 0, \"φ'\"]\n[outputs]\n";
    insta::assert_snapshot!(refused(&format!("{top}turning = \"L_z\"")));
    insta::assert_snapshot!(refused(&format!("{top}foot = \"ZMP_x\"")));
}
