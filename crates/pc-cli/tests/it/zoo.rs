//! The robots of `tests/zoo` against dynamics of another author, whose numbers Pinocchio confirms: accelerations, the
//! forces that hold these at zero, mass matrices, and derivatives.

use std::collections::HashMap;
use std::path::PathBuf;

use pc_mech::{Graph, InverseDynamics, VectorField};
use pc_model::import::model_of_urdf;
use pc_model::{Assembly, Document, Flow, Model, Source, Variables};
use serde_json::Value;

/// Rounding of the recursion, times the condition of a mass matrix: 8e5 for a snake of forty links.
const ROUNDING: f64 = 1e-10;

fn zoo(file: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/zoo").join(file);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The child link of each joint.
fn children(urdf: &str) -> HashMap<String, String> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(urdf, options).unwrap();
    let joints = document.root_element().children().filter(|node| node.tag_name().name() == "joint");
    let pair = |joint: roxmltree::Node<'_, '_>| {
        let child = joint.children().find(|node| node.tag_name().name() == "child")?;
        Some((joint.attribute("name")?.to_owned(), child.attribute("link")?.to_owned()))
    };
    joints.filter_map(pair).collect()
}

/// The body of each link: of the same name, unless a comment below the head of its section says of which link it is.
fn bodies(document: &Document, model: &str) -> HashMap<String, String> {
    let link = |body: &str, place: usize| {
        let below = model[place..].lines().nth(1).unwrap_or_default();
        below.strip_prefix("# the link ").unwrap_or(body).to_owned()
    };
    let tree = document.tree.iter();
    tree.map(|body| {
        let label = body.name.text.clone();
        (link(&label, body.name.place.span.start), label)
    })
    .collect()
}

/// A robot of the zoo in the state of `dynamics.json`, and what is known of it there.
struct Robot {
    name: String,
    model: Model,
    /// The state y by pc's names.
    names: Vec<String>,
    state: Vec<f64>,
    /// A direction of states, in the order of y.
    direction: Vec<f64>,
    /// Place of each velocity in y.
    velocities: Vec<usize>,
    acceleration: Vec<f64>,
    /// The derivative of the accelerations along the direction.
    derivative: Vec<f64>,
    bias: Vec<f64>,
    diagonal: Vec<f64>,
    /// The lower triangle of the mass matrix, of small robots.
    mass_matrix: Vec<f64>,
}

impl Robot {
    fn new(name: &str, known: &Value) -> Robot {
        let urdf = zoo(&format!("{name}.urdf"));
        let source = Source::from_bytes(format!("{name}.urdf"), urdf.as_bytes());
        let floats = known["floating"].as_bool().unwrap();
        let (text, _) = model_of_urdf(&source, floats).unwrap_or_else(|error| panic!("{error}"));
        let document = Document::parse(Source::new(format!("{name}.toml"), &text)).unwrap();
        let (children, bodies) = (children(urdf.trim_start_matches('\u{feff}')), bodies(&document, &text));
        let tree = document.tree.iter();
        let names: Vec<String> = tree
            .clone()
            .flat_map(|body| &body.joint.coordinates)
            .chain(tree.clone().flat_map(|body| &body.joint.quasi_velocities))
            .map(|name| name.text.clone())
            .collect();
        let mut robot = Robot {
            name: name.to_owned(),
            state: vec![0.0; names.len()],
            direction: vec![0.0; names.len()],
            names,
            velocities: Vec::new(),
            acceleration: Vec::new(),
            derivative: Vec::new(),
            bias: Vec::new(),
            diagonal: Vec::new(),
            mass_matrix: known["mass_matrix"].as_array().into_iter().flatten().flat_map(numbers).collect(),
            model: Model::new(document),
        };
        for joint in known["joints"].as_array().unwrap() {
            // The root hangs on the world by the joint without a name.
            let child = joint["name"].as_str().filter(|name| !name.is_empty()).map(|name| &children[name]);
            let root = robot.model.document().tree[0].name.text.clone();
            robot.place(joint, child.map_or(&root, |link| &bodies[link]));
        }
        robot
    }

    /// Takes the numbers of the joint that carries a body.
    fn place(&mut self, joint: &Value, body: &str) {
        let tree = &self.model.document().tree;
        let of_text = &tree.iter().find(|known| known.name.text == *body).unwrap().joint;
        let place = |name: &str| self.names.iter().position(|known| known == name).unwrap();
        let q: Vec<usize> = of_text.coordinates.iter().map(|x| place(&x.text)).collect();
        let v: Vec<usize> = of_text.quasi_velocities.iter().map(|eta| place(&eta.text)).collect();
        let moved = [(&q, &joint["q"], &joint["along"][0]), (&v, &joint["v"], &joint["along"][1])];
        for (places, values, along) in moved {
            for (&place, (value, along)) in places.iter().zip(numbers(values).into_iter().zip(numbers(along)))
            {
                (self.state[place], self.direction[place]) = (value, along);
            }
        }
        self.velocities.extend(v);
        self.acceleration.extend(numbers(&joint["acceleration"]));
        self.derivative.extend(numbers(&joint["derivative"]));
        self.bias.extend(numbers(&joint["bias"]));
        self.diagonal.extend(numbers(&joint["mass"]));
    }

    /// The derivatives of all velocities in the order of y, picked from rates of the state y.
    fn of_velocities(&self, rates: &[f64]) -> Vec<f64> {
        self.velocities.iter().map(|&place| rates[place]).collect()
    }

    /// Accelerations and their derivative along the direction: the product of ∂f/∂y with it.
    fn motion(&self, assembly: &Assembly<'_>) -> (Vec<f64>, Vec<f64>) {
        let mut flow = Flow::new(&self.model, assembly, Variables::QuasiVelocities)
            .unwrap_or_else(|error| panic!("{}: {error}", self.name));
        assert_eq!(flow.motion.names(), self.names, "{}", self.name);
        let n = self.state.len();
        let (mut rates, mut jacobian) = (vec![f64::NAN; n], vec![f64::NAN; n * n]);
        flow.motion.rhs(0.0, &self.state, &mut rates).unwrap();
        flow.motion.jacobian(0.0, &self.state, &mut jacobian).unwrap();
        let row = |i: usize| (0..n).map(|j| jacobian[i + n * j] * self.direction[j]).sum();
        let along: Vec<f64> = (0..n).map(row).collect();
        (self.of_velocities(&rates), self.of_velocities(&along))
    }

    /// The forces that hold the accelerations at zero, and the mass matrix, by columns.
    fn forces(&self, assembly: &Assembly<'_>) -> (Vec<f64>, Vec<f64>) {
        let equations = assembly.equations_in(Variables::QuasiVelocities).unwrap();
        let mut inverse: InverseDynamics = equations.inverse_dynamics_of_motion().unwrap();
        let k = inverse.len();
        let first = self.state.len() - k;
        let (mut bias, mut mass) = (vec![f64::NAN; k], vec![f64::NAN; k * k]);
        inverse.bias(0.0, &self.state, &mut bias).unwrap();
        inverse.mass_matrix(0.0, &self.state, &mut mass).unwrap();
        let places: Vec<usize> = self.velocities.iter().map(|place| place - first).collect();
        let bias = places.iter().map(|&i| bias[i]).collect();
        (bias, places.iter().flat_map(|&i| places.iter().map(move |&j| i + k * j)).map(|i| mass[i]).collect())
    }
}

/// The largest difference, relative to the largest number of its kind.
fn apart(found: &[f64], known: &[f64]) -> f64 {
    assert_eq!(found.len(), known.len());
    let size = known.iter().fold(0.0, |size: f64, known| size.max(known.abs()));
    let apart = found.iter().zip(known).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, |most: f64, apart| if apart.is_nan() { f64::INFINITY } else { most.max(apart / size) })
}

#[test]
fn robots_of_the_zoo_have_the_dynamics_of_another_author() {
    let known: HashMap<String, Value> = serde_json::from_str(&zoo("dynamics.json")).unwrap();
    let mut complaints = Vec::new();
    for (name, known) in &known {
        let robot = Robot::new(name, known);
        let graph = Graph::new();
        let assembly = robot.model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
        let (accelerations, derivative) = robot.motion(&assembly);
        let (bias, mass) = robot.forces(&assembly);
        let k = bias.len();
        let diagonal: Vec<f64> = (0..k).map(|i| mass[i * (k + 1)]).collect();
        let compared = [
            ("accelerations", apart(&accelerations, &robot.acceleration)),
            ("forces", apart(&bias, &robot.bias)),
            ("diagonal of the mass matrix", apart(&diagonal, &robot.diagonal)),
            ("derivative", apart(&derivative, &robot.derivative)),
        ];
        let triangle: Vec<f64> =
            (0..k).flat_map(|i| (0..=i).map(move |j| i * k + j)).map(|at| mass[at]).collect();
        let whole =
            (!robot.mass_matrix.is_empty()).then(|| ("mass matrix", apart(&triangle, &robot.mass_matrix)));
        let wrong = compared.into_iter().chain(whole).filter(|(_, apart)| *apart > ROUNDING);
        complaints.extend(wrong.map(|(what, apart)| format!("{name}: {what} apart by {apart:e}")));
    }
    assert!(known.len() >= 60 && complaints.is_empty(), "{complaints:#?}");
}
