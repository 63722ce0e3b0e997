//! Jacobians of bodies and of their momenta against the outputs of the text, which are sums over bodies, and their rates.

use pc_mech::{Graph, VelocityMap};
use pc_model::{Assembly, Document, Flow, Model, ModelError, Source, Variables};

use crate::verified::derived_twice;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

/// The state (x, η) of a flow at its start, the accelerations there where the state has no momenta, and a row of the
/// outputs.
struct Start {
    t: f64,
    state: Vec<f64>,
    rates: Option<Vec<f64>>,
    columns: Vec<String>,
    row: Vec<f64>,
    coordinates: usize,
}

impl Start {
    fn of(model: &Model, assembly: &Assembly<'_>, variables: Variables) -> Start {
        let mut flow = Flow::new(model, assembly, variables).unwrap_or_else(|error| panic!("{error}"));
        let (t, y) = (assembly.t_start, flow.start.clone());
        let (state, rates) = match variables.has_momenta() {
            false => (y.clone(), Some(flow.motion.rates(t, &y).unwrap())),
            true => {
                let mut transform = assembly.legendre_transform(variables).unwrap();
                (transform.to_quasi_velocities(t, &y).unwrap(), None)
            }
        };
        let (columns, row, coordinates) = (flow.columns(), flow.row(t, &y), flow.motion.coordinates());
        Start { t, state, rates, columns, row, coordinates }
    }

    fn outputs(&self, names: &[&str]) -> Vec<f64> {
        let place = |name: &&str| self.columns.iter().position(|column| column == name);
        names.iter().map(|name| self.row[place(name).unwrap_or_else(|| panic!("{name}"))]).collect()
    }

    /// w and, where accelerations are known, ẇ.
    fn values(&self, map: &mut VelocityMap) -> (Vec<f64>, Option<Vec<f64>>) {
        let (m, k) = (map.functions(), map.quasi_velocities());
        let (mut matrix, mut rest, mut rates) = (vec![0.0; m * k], vec![0.0; m], vec![0.0; m]);
        map.map(self.t, &self.state, &mut matrix, &mut rest).unwrap();
        map.rates(self.t, &self.state, &mut rates).unwrap();
        let n = self.coordinates;
        let affine = |eta: &[f64], rest: &[f64]| -> Vec<f64> {
            (0..m).map(|i| (0..k).map(|s| matrix[i + m * s] * eta[s]).sum::<f64>() + rest[i]).collect()
        };
        let rate = self.rates.as_ref().map(|all| affine(&all[n..n + k], &rates));
        (affine(&self.state[n..n + k], &rest), rate)
    }

    #[track_caller]
    fn check(&self, map: &mut VelocityMap, names: &[&str]) {
        let (values, rates) = self.values(map);
        close(&values, &self.outputs(names));
        if let Some(rates) = rates {
            let of_rates: Vec<String> = names.iter().map(|name| format!("d{name}")).collect();
            let of_rates: Vec<&str> = of_rates.iter().map(String::as_str).collect();
            close(&rates, &self.outputs(&of_rates));
        }
    }
}

/// Some hundred operations with numbers up to some tens, and those of the accelerations.
#[track_caller]
fn close(found: &[f64], expected: &[f64]) {
    let size = expected.iter().chain(found).fold(1.0f64, |size, x| size.max(x.abs()));
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-11 * size, "{found:?} instead of {expected:?}");
    }
}

const MOMENTA: [&str; 6] = ["Px", "Py", "Pz", "Lx", "Ly", "Lz"];
const CENTRE: [&str; 3] = ["Cx", "Cy", "Cz"];
const HAND: [&str; 6] = ["vx", "vy", "vz", "wx", "wy", "wz"];

/// The momenta and the velocity of the mass centre, each with its rate.
fn outputs() -> String {
    let mut text = "[outputs]\n".to_owned();
    for axis in ["x", "y", "z"] {
        text += &format!(
            "P{axis} = \"P_{axis}\"\ndP{axis} = \"d(P_{axis})\"\nL{axis} = \"L_{axis}\"\ndL{axis} = \"d(L_{axis})\"\n\
             O{axis} = \"COM_{axis}\"\nC{axis} = \"d(COM_{axis})\"\ndC{axis} = \"d(d(COM_{axis}))\"\n"
        );
    }
    text
}

/// Checks the maps of momenta and of the mass centre in these variables.
#[track_caller]
fn momenta(model: &Model, variables: Variables) {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let start = Start::of(model, &assembly, variables);
    let mut map = model.centroidal_map(&assembly, variables).unwrap_or_else(|error| panic!("{error}"));
    start.check(&mut map, &MOMENTA);
    let mut centre = model.centre_of_mass(&assembly, variables).unwrap();
    start.check(&mut centre.velocity, &CENTRE);
    let parameters: Vec<f64> = model.parameters().map(|(_, value)| value).collect();
    let mut position = [f64::NAN; 3];
    centre.position.eval(start.t, &start.state, &parameters, &mut position);
    close(&position, &start.outputs(&["Ox", "Oy", "Oz"]));
}

/// A cart with an arm and a hand on a ball, under weight; the hand on the third joint carries a point.
const ROBOT: &str = r#"
[parameters]
m = 2
[coordinates]
cart = 0.2
arm = 0.4
hand_q0 = "cos(0.3)"
hand_q1 = "sin(0.3)"
[quasi_velocities]
"cart'" = 0.7
"arm'" = -0.9
"hand_ω1" = 0.3
"hand_ω2" = 0.8
"hand_ω3" = -0.4
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
mass = "m"
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
at = [0.1, 0, 0]
[points.floor]
body = "world"
at = [0, 1, 0]
"#;

/// ω̂ = Ṙ Rᵀ along fixed axes, and the velocity of the point, each with its rate.
const OF_TIP: &str = r#"
vx = "tip_x'"
vy = "tip_y'"
vz = "tip_z'"
dvx = "d(tip_x')"
dvy = "d(tip_y')"
dvz = "d(tip_z')"
wx = "tip_31'*tip_21 + tip_32'*tip_22 + tip_33'*tip_23"
wy = "tip_11'*tip_31 + tip_12'*tip_32 + tip_13'*tip_33"
wz = "tip_21'*tip_11 + tip_22'*tip_12 + tip_23'*tip_13"
dwx = "d(tip_31'*tip_21 + tip_32'*tip_22 + tip_33'*tip_23)"
dwy = "d(tip_11'*tip_31 + tip_12'*tip_32 + tip_13'*tip_33)"
dwz = "d(tip_21'*tip_11 + tip_22'*tip_12 + tip_23'*tip_13)"
"#;

#[test]
fn momenta_of_bodies_on_joints_are_linear_in_the_velocities() {
    let model = model(&format!("{ROBOT}{}", outputs()));
    for variables in [Variables::QuasiVelocities, Variables::Momenta, Variables::Orthonormal] {
        momenta(&model, variables);
    }
}

#[test]
fn points_of_bodies_have_jacobians() {
    let model = model(&format!("{ROBOT}[outputs]{OF_TIP}"));
    for variables in [Variables::QuasiVelocities, Variables::Momenta] {
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let start = Start::of(&model, &assembly, variables);
        // The point by its name, and from two other places of its body.
        for (name, at) in [("tip", [0.0; 3]), ("hand", [0.1, -0.2, 0.3]), ("palm", [0.0, -0.2, 0.3])] {
            let mut map = model.body_map(&assembly, variables, name).unwrap();
            map.arguments_mut().copy_from_slice(&at);
            start.check(&mut map, &HAND);
        }
        let mut map = model.body_map(&assembly, variables, "floor").unwrap();
        assert_eq!(start.values(&mut map).0, [0.0; 6]);
    }
}

/// Bodies placed by functions of coordinates and time, so that they move where η = 0.
const CARRIED: &str = r#"
[parameters]
w = 0.7
[coordinates]
r = 0.5
a = 0.3
[quasi_velocities]
"r'" = 0.4
"a'" = -0.6
[bodies.bead]
mass = 2
position = ["r*cos(w*t)", "r*sin(w*t)", "a*r"]
inertia = [0.1, 0.2, 0.3]
rotation = ["cos(a + w*t)", "-sin(a + w*t)", 0, "sin(a + w*t)", "cos(a + w*t)", 0, 0, 0, 1]
[bodies.ball]
mass = 1
position = ["a", "0.5*t^2", "1 + r"]
[simulation]
t_start = 0.8
t_end = 1.0
"#;

#[test]
fn a_frame_that_moves_carries_momentum() {
    let text = format!("{CARRIED}{}", outputs());
    for variables in [Variables::QuasiVelocities, Variables::Momenta] {
        momenta(&model(&text), variables);
    }
}

#[test]
fn points_of_placed_bodies_have_jacobians() {
    let text = r#"
[definitions]
x = "r*cos(w*t) + 0.1*cos(a + w*t) + 0.2*sin(a + w*t)"
y = "r*sin(w*t) + 0.1*sin(a + w*t) - 0.2*cos(a + w*t)"
z = "a*r + 0.3"
[outputs]
vx = "d(x)"
vy = "d(y)"
vz = "d(z)"
dvx = "d(d(x))"
dvy = "d(d(y))"
dvz = "d(d(z))"
wx = "0"
wy = "0"
wz = "a' + w"
dwx = "0"
dwy = "0"
dwz = "a''"
"#;
    let text = format!("{CARRIED}{text}").replace("dwz = \"a''\"", "dwz = \"d(a')\"");
    let (model, graph) = (model(&text), Graph::new());
    let assembly = model.assemble(&graph).unwrap();
    let start = Start::of(&model, &assembly, Variables::QuasiVelocities);
    let mut map = model.body_map(&assembly, Variables::QuasiVelocities, "bead").unwrap();
    map.arguments_mut().copy_from_slice(&[0.1, -0.2, 0.3]);
    start.check(&mut map, &HAND);
}

/// Rolling, with quasi-velocities that vanish; and a loop, with multipliers.
#[test]
fn momenta_under_constraints_are_those_of_the_motion() {
    let rolling = r#"
[coordinates]
x = 0.1
y = 0.2
"θ" = 0.3
[quasi_velocities]
v = { is = "x'*cos(θ) + y'*sin(θ)", start = 0.7 }
"ω" = { is = "θ'", start = -0.4 }
[bodies.sled]
mass = 2
position = ["x + 0.3*cos(θ)", "y + 0.3*sin(θ)", 0]
inertia = [0.1, 0.1, 0.2]
rotation = ["cos(θ)", "-sin(θ)", 0, "sin(θ)", "cos(θ)", 0, 0, 0, 1]
[constraints]
blade = "-x'*sin(θ) + y'*cos(θ)"
"#;
    let text = format!("{rolling}{}", outputs());
    for variables in [Variables::QuasiVelocities, Variables::Momenta, Variables::IndependentVelocities] {
        momenta(&model(&text), variables);
    }
    let held = r#"
[coordinates]
x = 0.6
y = -0.8
[quasi_velocities]
"x'" = 0.8
"y'" = 0.6
[gravity]
acceleration = [0, -9.8, 0]
[bodies.bob]
mass = 2
position = ["x", "y", 0]
[constraints]
rod = "(x^2 + y^2 - 1)/2"
"#;
    momenta(&model(&format!("{held}{}", outputs())), Variables::QuasiVelocities);
}

#[test]
fn what_has_no_map_is_refused_with_what_to_do() {
    let error = |text: &str, made: &dyn Fn(&Model, &Assembly<'_>) -> Option<ModelError>| {
        let (model, graph) = (model(text), Graph::new());
        let assembly = model.assemble(&graph).unwrap();
        made(&model, &assembly).map(|error| error.to_string()).unwrap_or_default()
    };
    let own = Variables::QuasiVelocities;
    let momentum = |model: &Model, assembly: &Assembly<'_>| model.centroidal_map(assembly, own).err();
    let spring = "[coordinates]\nx = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\n";
    let hand = |model: &Model, assembly: &Assembly<'_>| model.body_map(assembly, own, "hnd").err();
    let turning = r#"
[coordinates]
a = 0
[quasi_velocities]
"a'" = 1
[bodies.top]
mass = 1
position = [0, 0, 0]
inertia = [1, 2, 3]
angular_velocity = [0, 0, "a'"]
"#;
    let top = |model: &Model, assembly: &Assembly<'_>| model.body_map(assembly, own, "top").err();
    let all =
        [error(spring, &momentum), error(ROBOT, &hand), error(turning, &momentum), error(turning, &top)];
    insta::assert_snapshot!(all.join("\n\n"));
}
